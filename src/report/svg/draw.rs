use super::backend::{Class, Paper};
use super::clip::clip;
use super::text_width::text_width;
use crate::report::escape::escape;
use crate::report::figure::{Figure, FigureError, Look, MarkerShape};
use crate::report::numbers::number;
use plotters::coord::ranged1d::{BoldPoints, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::element::{Circle, PathElement};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters_backend::DrawingBackend;
use std::convert::Infallible;

/// All lengths in tenths of a pixel. At 480 px the text stays readable when a phone shows the picture three quarters the size.
const WIDTH: i32 = 4800;
const PLOT_HEIGHT: i32 = 2350;
const EDGE: i32 = 40;
const RIGHT: i32 = 180;
const TITLE_SIZE: i32 = 170;
const TEXT_SIZE: i32 = 150;
const ROW: i32 = 215;
const SWATCH: i32 = 330;
const TICKS: usize = 6;

/// The figure as one `<svg>` element. `id` must be unique on its page: the ids of title and description begin with it.
///
/// Errors: [`FigureError`] when the data cannot be drawn; nothing reaches plotters then.
pub fn render(figure: &Figure, id: &str) -> Result<String, FigureError> {
    figure.check()?;
    let titles = wrap(&figure.title, TITLE_SIZE, WIDTH - 2 * EDGE);
    let legend = legend(figure);
    let legend_rows = legend.last().map_or(0, |l| l.row + 1);
    let top = EDGE + ROW * (titles.len() as i32 + legend_rows + 1) + 20;
    let height = top + PLOT_HEIGHT + 2 * ROW + 30;

    let mut svg = format!(
        "<svg class=\"fig\" viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\"><title id=\"{id}-t\">"
    );
    escape(&mut svg, &figure.title);
    svg.push_str(&format!("</title><desc id=\"{id}-d\">"));
    escape(&mut svg, &figure.summary);
    svg.push_str("</desc>");
    let paper = Paper::new(&mut svg, (WIDTH as u32, height as u32));
    draw(paper, figure, &titles, &legend, top)
        .map_err(|e| FigureError::Drawing { title: figure.title.clone(), reason: e.to_string() })?;
    svg.push_str("</svg>");
    Ok(svg)
}

type Drawn = Result<(), DrawingAreaErrorKind<Infallible>>;

fn draw(paper: Paper, figure: &Figure, titles: &[String], legend: &[LegendEntry], top: i32) -> Drawn {
    let height = paper.get_size().1 as i32;
    let root = paper.into_drawing_area();
    let text = |class: Class, size: i32, h, v| {
        ("sans-serif", size).into_font().color(&class.colour()).pos(Pos::new(h, v))
    };
    let title_style = text(Class::TITLE, TITLE_SIZE, HPos::Left, VPos::Center);
    for (row, line) in titles.iter().enumerate() {
        root.draw_text(line, &title_style, (EDGE, EDGE + ROW * row as i32 + ROW / 2))?;
    }
    let label_style = text(Class::LABEL, TEXT_SIZE, HPos::Left, VPos::Center);
    for entry in legend {
        let y = EDGE + ROW * (titles.len() as i32 + entry.row) + ROW / 2;
        match entry.shape {
            None => {
                let line = vec![(entry.x, y), (entry.x + SWATCH, y)];
                root.draw(&PathElement::new(line, stroke(line_class(entry.look))))?;
            }
            Some(shape) => marker(&root, (entry.x + SWATCH / 2, y), shape, entry.look)?,
        }
        root.draw_text(&entry.name, &label_style, (entry.x + SWATCH + 70, y))?;
    }
    root.draw_text(&figure.y.caption(), &label_style, (EDGE, top - ROW / 2 - 20))?;
    let x_style = text(Class::LABEL, TEXT_SIZE, HPos::Right, VPos::Center);
    root.draw_text(&figure.x.caption(), &x_style, (WIDTH - RIGHT, height - ROW / 2))?;

    let tick = |axis: (f64, f64)| move |v: &f64| tick_label(*v, axis.1 - axis.0);
    let (x_tick, y_tick) = (tick((figure.x.from, figure.x.to)), tick((figure.y.from, figure.y.to)));
    let left = EDGE + y_label_width(figure) + 90;
    let body = root.clone().shrink((0, top), (WIDTH, height - top - ROW));
    let mut chart = ChartBuilder::on(&body)
        .margin_right(RIGHT)
        .x_label_area_size(ROW + 30)
        .y_label_area_size(left)
        .build_cartesian_2d(figure.x.from..figure.x.to, figure.y.from..figure.y.to)?;
    let tick_style = text(Class::TICK, TEXT_SIZE, HPos::Left, VPos::Top);
    chart
        .configure_mesh()
        .max_light_lines(0)
        .bold_line_style(stroke(Class::GRID))
        .axis_style(stroke(Class::INK))
        .label_style(tick_style)
        .x_labels(TICKS)
        .y_labels(TICKS)
        .set_all_tick_mark_size(40)
        .x_label_formatter(&x_tick)
        .y_label_formatter(&y_tick)
        .draw()?;

    let (xs, ys) = ((figure.x.from, figure.x.to), (figure.y.from, figure.y.to));
    if figure.zero_lines {
        let lines = [vec![(xs.0, 0.0), (xs.1, 0.0)], vec![(0.0, ys.0), (0.0, ys.1)]];
        for line in lines.iter().flat_map(|l| clip(l, xs, ys)) {
            chart.draw_series([PathElement::new(line, stroke(Class::ZERO))])?;
        }
    }
    for bar in &figure.bars {
        let corners = [(bar.from, 0.0), (bar.to, bar.height)];
        chart.draw_series([Rectangle::new(corners, stroke(Class::BAR).filled())])?;
    }
    for series in &figure.series {
        for part in clip(&series.points, xs, ys) {
            chart.draw_series(LineSeries::new(part, stroke(line_class(series.look))))?;
        }
    }
    for markers in &figure.markers {
        for (x, y, words) in &markers.points {
            let inside = (xs.0..=xs.1).contains(x) && (ys.0..=ys.1).contains(y);
            if !inside {
                continue;
            }
            let at = chart.plotting_area().map_coordinate(&(*x, *y));
            marker(&root, at, markers.shape, markers.look)?;
            if !words.is_empty() {
                let room = at.0 + 110 + (text_width(words) * f64::from(TEXT_SIZE)) as i32;
                let (dx, side) = if room < WIDTH { (110, HPos::Left) } else { (-110, HPos::Right) };
                root.draw_text(
                    words,
                    &text(Class::LABEL, TEXT_SIZE, side, VPos::Center),
                    (at.0 + dx, at.1 - 90),
                )?;
            }
        }
    }
    root.present()
}

fn stroke(class: Class) -> ShapeStyle {
    class.colour().stroke_width(1)
}

fn line_class(look: Look) -> Class {
    match look {
        Look::Reference => Class::REFERENCE,
        Look::Student => Class::STUDENT,
        Look::Given => Class::GIVEN,
        Look::Other => Class::OTHER,
        Look::Faint => Class::FAINT,
    }
}

fn marker_class(look: Look) -> Class {
    match look {
        Look::Reference => Class::REFERENCE_MARK,
        Look::Student => Class::STUDENT_MARK,
        Look::Given => Class::GIVEN_MARK,
        Look::Other => Class::OTHER_MARK,
        Look::Faint => Class::FAINT,
    }
}

/// A marker drawn about `at`, in tenths of a pixel.
fn marker<T>(root: &DrawingArea<Paper, T>, at: (i32, i32), shape: MarkerShape, look: Look) -> Drawn
where
    T: plotters::coord::CoordTranslate<From = (i32, i32)>,
{
    let style = stroke(marker_class(look));
    let lines: &[&[(i32, i32)]] = match shape {
        MarkerShape::Circle => return root.draw(&Circle::new(at, 62, style)),
        MarkerShape::Cross => &[&[(-60, -60), (60, 60)], &[(-60, 60), (60, -60)]],
        MarkerShape::Plus => &[&[(-85, 0), (85, 0)], &[(0, -85), (0, 85)]],
        MarkerShape::Diamond => &[&[(0, -95), (95, 0), (0, 95), (-95, 0), (0, -95)]],
        MarkerShape::Triangle => &[&[(0, -105), (95, 65), (-95, 65), (0, -105)]],
    };
    for line in lines {
        let points: Vec<_> = line.iter().map(|(x, y)| (at.0 + x, at.1 + y)).collect();
        root.draw(&PathElement::new(points, style))?;
    }
    Ok(())
}

struct LegendEntry {
    name: String,
    look: Look,
    shape: Option<MarkerShape>,
    x: i32,
    row: i32,
}

/// Legend entries from left to right, in as many rows as they need.
fn legend(figure: &Figure) -> Vec<LegendEntry> {
    let lines = figure.series.iter().map(|s| (&s.name, s.look, None));
    let markers = figure.markers.iter().map(|m| (&m.name, m.look, Some(m.shape)));
    let (mut x, mut row) = (EDGE, 0);
    let mut entries: Vec<LegendEntry> = Vec::new();
    for (name, look, shape) in lines.chain(markers).filter(|(name, ..)| !name.is_empty()) {
        let width = SWATCH + 70 + (text_width(name) * f64::from(TEXT_SIZE)).ceil() as i32 + 150;
        if x > EDGE && x + width > WIDTH {
            (x, row) = (EDGE, row + 1);
        }
        entries.push(LegendEntry { name: name.clone(), look, shape, x, row });
        x += width;
    }
    entries
}

/// `text` in lines no wider than `width`, broken at spaces.
fn wrap(text: &str, size: i32, width: i32) -> Vec<String> {
    // Titles are bold, hence a little wider than the table says.
    let fits = |line: &str| text_width(line) * f64::from(size) * 1.06 <= f64::from(width);
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if fits(&format!("{line} {word}")) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A tick's number; rounding residue about zero is zero.
fn tick_label(value: f64, width: f64) -> String {
    number(if value.abs() < 1e-9 * width { 0.0 } else { value }, 6)
}

/// Room for the widest label of the y axis.
fn y_label_width(figure: &Figure) -> i32 {
    let range = RangedCoordf64::from(figure.y.from..figure.y.to);
    let widest = range
        .key_points(BoldPoints(TICKS))
        .iter()
        .map(|v| text_width(&tick_label(*v, figure.y.to - figure.y.from)))
        .fold(1.0, f64::max);
    (widest * f64::from(TEXT_SIZE)).ceil() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Axis, Markers, Series};

    fn sine() -> Figure {
        let mut figure = Figure::new(
            "A sine & its <friends>",
            Axis::new("time", "s", 0.0, 10.0),
            Axis::new("θ", "rad", -1.2, 1.2),
        );
        let points = (0..=500).map(|i| f64::from(i) / 50.0).map(|t| (t, t.sin())).collect();
        figure.series.push(Series { name: "reference".into(), look: Look::Reference, points });
        figure.series.push(Series {
            name: "yours".into(),
            look: Look::Student,
            points: vec![(0.0, 0.0), (10.0, 400.0)],
        });
        figure.markers.push(Markers {
            name: "pole".into(),
            look: Look::Reference,
            shape: MarkerShape::Cross,
            points: vec![(5.0, 0.0, "double".into()), (50.0, 0.0, "far".into())],
        });
        figure.zero_lines = true;
        figure.summary = "A sine of amplitude 1.".into();
        figure
    }

    #[test]
    fn the_picture_is_lean_and_carries_no_look_of_its_own() {
        let svg = render(&sine(), "f1").unwrap();
        assert!(svg.len() < 4000, "{} bytes: {svg}", svg.len());
        for word in ["#", "rgb", "style=", "font-", "NaN", "inf", "-0.0"] {
            assert!(!svg.contains(word), "{word} in {svg}");
        }
        for word in
            ["id=\"f1-t\"", "id=\"f1-d\"", "θ (rad)", "time (s)", "&amp; its &lt;friends&gt;", "double"]
        {
            assert!(svg.contains(word), "no {word} in {svg}");
        }
        assert!(!svg.contains(">far<"), "a marker outside the axes is not drawn");
        assert_eq!(svg, render(&sine(), "f1").unwrap(), "same figure, same bytes");
    }

    #[test]
    fn infinite_ranges_never_reach_plotters() {
        let mut figure = sine();
        figure.y.to = f64::INFINITY;
        assert!(matches!(render(&figure, "f"), Err(FigureError::Range { .. })));
    }

    #[test]
    fn long_titles_and_legends_are_wrapped() {
        let mut figure = sine();
        figure.title = "words of a title ".repeat(6);
        for name in ["a rather long name for a curve", "another long name for a curve"] {
            figure.series.push(Series { name: name.into(), look: Look::Other, points: vec![] });
        }
        assert_eq!(wrap(&figure.title, TITLE_SIZE, WIDTH).len(), 2);
        assert!(legend(&figure).iter().any(|l| l.row == 1));
        assert!(legend(&figure).iter().all(|l| l.x < WIDTH / 2 + 400));
    }
}
