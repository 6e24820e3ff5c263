use crate::model::Tangent;
use crate::reference::OperatingPointReference;
use crate::report::figure::{Axis, Figure, Look, MarkerShape, Markers, Series, extent, padded};
use crate::report::numbers::{letter, number, quantity};
use crate::report::tangent::good_words;

/// How far beyond the function the tangent may stretch the picture, in heights of the function.
const STRETCH: f64 = 0.35;

/// A static function, its tangent, and where the tangent stops being good.
pub fn tangent_figure(point: &OperatingPointReference, tangent: &Tangent) -> Figure {
    let rule = &tangent.rule;
    let ends = [(rule.from, tangent.line(rule.from)), (rule.to, tangent.line(rule.to))];
    let (low, high) =
        extent(tangent.samples.iter().map(|(_, y)| *y).chain([tangent.at.1])).unwrap_or((-1.0, 1.0));
    let height = if high > low { high - low } else { tangent.at.1.abs().max(1.0) };
    let (least, most) = (low - STRETCH * height, high + STRETCH * height);
    let reach = ends.iter().map(|(_, y)| y.clamp(least, most));
    let (low, high) = reach.fold((low, high), |(low, high), y| (low.min(y), high.max(y)));
    let (low, high) = padded(low, high, 0.06);
    let mut figure = Figure::new(
        format!("{}: function and tangent", point.title),
        Axis::new(letter(&point.input), &point.input_unit, rule.from, rule.to),
        Axis::new(letter(&point.output), &point.output_unit, low, high),
    );
    figure.zero_lines = true;
    figure.caption = good_words(point, tangent);
    figure.summary = format!(
        "The function goes through {} at {}, with slope {}. {}",
        quantity(tangent.at.1, 4, &point.output_unit),
        quantity(tangent.at.0, 4, &point.input_unit),
        number(tangent.slope, 4),
        figure.caption
    );
    figure.series.push(Series {
        name: "function".into(),
        look: Look::Reference,
        points: tangent.samples.clone(),
    });
    figure.series.push(Series { name: "tangent".into(), look: Look::Other, points: ends.to_vec() });
    figure.markers.push(Markers {
        name: "operating point".into(),
        look: Look::Reference,
        shape: MarkerShape::Circle,
        points: vec![(tangent.at.0, tangent.at.1, String::new())],
    });
    let parting: Vec<_> = [tangent.good_from, tangent.good_to]
        .into_iter()
        .flatten()
        .map(|x| (x, tangent.line(x), String::new()))
        .filter(|(_, y, _)| (low..=high).contains(y))
        .collect();
    if !parting.is_empty() {
        figure.markers.push(Markers {
            name: format!("off by {}\u{a0}%", number(100.0 * rule.departure, 3)),
            look: Look::Other,
            shape: MarkerShape::Diamond,
            points: parting,
        });
    }
    figure
}
