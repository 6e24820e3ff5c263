use super::frame::{frame, leaving_words};
use crate::model::{Comparison, ComparisonRun};
use crate::reference::OperatingPointReference;
use crate::report::figure::{Axis, Figure, Look, Series};
use crate::report::numbers::{letter, number, quantity};

/// One push: the linear model's answer beside that of the nonlinear equations.
pub fn comparison_figure(point: &OperatingPointReference, push: f64, samples: &[(f64, f64, f64)]) -> Figure {
    let linear: Vec<_> = samples.iter().map(|s| (s.0, s.1)).collect();
    let nonlinear: Vec<_> = samples.iter().map(|s| (s.0, s.2)).collect();
    let range = frame(&nonlinear, &[&linear]);
    let end_s = samples.last().map_or(1.0, |s| s.0);
    let title = format!("{}: push of {}", point.title, impulse(point, push));
    let mut figure = Figure::new(
        title,
        Axis::new("time t", "s", 0.0, end_s),
        Axis::new(
            format!("{} from equilibrium", letter(&point.output)),
            &point.output_unit,
            range.0,
            range.1,
        ),
    );
    figure.zero_lines = true;
    let left = leaving_words("The linear model", &linear, range);
    figure.caption = left.trim().to_owned();
    let farthest = |points: &[(f64, f64)]| points.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
    figure.summary = format!(
        "Within {} the nonlinear equations go as far as {}, the linear model as far as {}.{left}",
        quantity(end_s, 3, "s"),
        quantity(farthest(&nonlinear), 3, &point.output_unit),
        quantity(farthest(&linear), 3, &point.output_unit),
    );
    figure.series.push(Series {
        name: "nonlinear equations".into(),
        look: Look::Reference,
        points: nonlinear,
    });
    figure.series.push(Series { name: "linear model".into(), look: Look::Other, points: linear });
    figure
}

/// Up to which push the linear model may be trusted, in full sentences.
pub fn parting_words(point: &OperatingPointReference, asked: &Comparison, run: &ComparisonRun) -> String {
    let share = format!("{}\u{a0}%", number(100.0 * asked.departure, 3));
    let over = quantity(asked.horizon_s, 3, "s");
    match (run.parting_push, run.parting_amplitude) {
        (Some(push), amplitude) => {
            let swing = amplitude.map_or(String::new(), |a| {
                format!(", at which the linear model reaches {}", quantity(a, 3, &point.output_unit))
            });
            format!(
                "Within {over} the linear model and the nonlinear equations part by {share} of the linear peak at a push of {}{swing}. \
                 Below that push one may stand for the other.",
                impulse(point, push)
            )
        }
        (None, _) => format!(
            "Within {over} the linear model and the nonlinear equations stay within {share} of the linear peak for every push tried."
        ),
    }
}

fn impulse(point: &OperatingPointReference, push: f64) -> String {
    let unit = if point.input_unit.is_empty() { "s".to_owned() } else { format!("{}·s", point.input_unit) };
    quantity(push, 3, &unit)
}
