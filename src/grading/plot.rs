use super::Evidence;
use super::closeness::percent;
use super::mark::{Mark, beginning};
use crate::algebra::{significant, to_f64};
use crate::lab::{Points, Tolerance};
use crate::submission::{Figure, Series};

/// So many of the points must lie on the curve.
const ON_THE_CURVE: f64 = 0.95;
/// The data may begin or end so much of the span late or early.
const EDGE: f64 = 0.02;
/// A scope may export its input beside its outputs; no more columns than this are tried.
const COLUMNS_TRIED: usize = 4;

/// A curve to hold data against, and the parameter values it follows from.
pub(super) struct Target<'a> {
    /// ` with g = 9.8`, or nothing.
    pub with: String,
    pub at: Box<dyn Fn(f64) -> f64 + 'a>,
    /// Points of the curve, dense enough to see its extrema, in order of time.
    pub samples: &'a [(f64, f64)],
    /// Nothing is known after this time, s.
    pub until_s: f64,
}

/// What is asked of data.
pub(super) struct Demands<'a> {
    pub tolerance: &'a Tolerance,
    pub min_points: usize,
    pub span_s: f64,
}

pub(super) fn expected(demands: &Demands<'_>) -> String {
    format!(
        "Data of at least {} points from 0 to {} s, {} % of them within {} of the largest value the curve has had by then; \
         or a figure, which a person looks at.",
        demands.min_points,
        significant(demands.span_s, 4),
        significant(ON_THE_CURVE * 100.0, 3),
        width_in_words(demands.tolerance)
    )
}

fn width_in_words(tolerance: &Tolerance) -> String {
    if tolerance.absolute.is_zero() {
        return percent(&tolerance.relative);
    }
    format!("{} (and {})", percent(&tolerance.relative), significant(to_f64(&tolerance.absolute), 3))
}

/// Data decides where there is any; a figure alone earns the points until a person has looked.
pub(super) fn judge(
    points: Points,
    targets: &[Target<'_>],
    demands: &Demands<'_>,
    data: Option<&Series>,
    figure: Option<&Figure>,
) -> Mark {
    let expected = expected(demands);
    let Some(series) = data else {
        return match figure {
            Some(figure) => figure_alone(points, expected, figure, "A figure was attached without its data."),
            None => Mark::blank(expected),
        };
    };
    if targets.is_empty() {
        let reason = "There is no curve to compare the data with.";
        return Mark::unmarked(expected, said(series), reason);
    }
    let columns = series.headers.len().min(COLUMNS_TRIED + 1);
    let best = (1..columns)
        .flat_map(|column| targets.iter().map(move |target| (column, target)))
        .filter_map(|(column, target)| Comparison::new(series, column, target, demands))
        .reduce(|best, next| if next.rank() > best.rank() { next } else { best });
    let Some(best) = best else {
        let reason = "No point of the data has a time at which the curve is known.";
        return with_figure_or(points, expected, series, figure, "plot.too_few_points", reason.to_owned());
    };
    let said = format!("{}, column {}", said(series), column_name(series, best.column));
    let evidence = |reason: String| Evidence {
        expected: expected.clone(),
        found: said.clone(),
        reason,
        ..Evidence::default()
    };
    if !best.agrees() {
        return Mark::wrong("plot.differs", evidence(best.why_not(figure.is_some())));
    }
    if best.in_span < demands.min_points {
        let reason = format!(
            "The data agrees with the curve, but has {} points up to {} s; {} are needed to see its shape.",
            best.in_span,
            significant(demands.span_s, 4),
            demands.min_points
        );
        return with_figure_or(points, expected, series, figure, "plot.too_few_points", reason);
    }
    if best.first_s > EDGE * demands.span_s || best.last_s < (1.0 - EDGE) * demands.span_s {
        let reason = format!(
            "The data agrees with the curve, but covers {} s to {} s only; 0 to {} s is needed to see its shape.",
            significant(best.first_s, 4),
            significant(best.last_s, 4),
            significant(demands.span_s, 4)
        );
        return with_figure_or(points, expected, series, figure, "plot.too_short", reason);
    }
    let reason = format!(
        "{} of {} points lie on the curve{}. The farthest is {} off, at {} s.",
        best.on_curve,
        best.compared,
        best.with,
        significant(best.worst.1, 3),
        significant(best.worst.0, 4)
    );
    Mark::right(points, evidence(reason))
}

/// Data that does not say enough is no worse than none: a figure beside it counts as a figure alone.
fn with_figure_or(
    points: Points,
    expected: String,
    series: &Series,
    figure: Option<&Figure>,
    code: &'static str,
    reason: String,
) -> Mark {
    match figure {
        Some(figure) => figure_alone(points, expected, figure, &reason),
        None => Mark::wrong(code, Evidence { expected, found: said(series), reason, ..Evidence::default() }),
    }
}

/// Earned until a person has looked at it.
pub(super) fn figure_alone(points: Points, expected: String, figure: &Figure, why: &str) -> Mark {
    let found =
        format!("the figure {} ({} × {} pixels)", beginning(&figure.file_name), figure.width, figure.height);
    let reason = format!(
        "{why} polemark does not look at pictures: the points count until a person has looked at it."
    );
    let evidence = Evidence { expected, found, reason, ..Evidence::default() };
    Mark { code: "plot.figure_only", provisional: true, ..Mark::right(points, evidence) }
}

fn said(series: &Series) -> String {
    format!("{} rows of data ({})", series.rows.len(), beginning(&series.file_name))
}

fn column_name(series: &Series, column: usize) -> String {
    match series.headers.get(column).map(|header| header.trim()) {
        Some(header) if !header.is_empty() => format!("{} ({})", column + 1, beginning(header)),
        _ => (column + 1).to_string(),
    }
}

/// One column beside one curve.
struct Comparison {
    column: usize,
    with: String,
    compared: usize,
    on_curve: usize,
    in_span: usize,
    on_curve_in_span: usize,
    first_s: f64,
    last_s: f64,
    /// (time, distance) of the point farthest off.
    worst: (f64, f64),
    /// The first point that is off: (time, written, expected).
    first_off: Option<(f64, f64, f64)>,
    /// The data agrees once divided by this.
    factor: Option<f64>,
}

impl Comparison {
    /// `None` when no point can be compared. Times before 0 are left out: nothing has happened yet.
    fn new(series: &Series, column: usize, target: &Target<'_>, demands: &Demands<'_>) -> Option<Self> {
        let mut points: Vec<(f64, f64)> = series
            .rows
            .iter()
            .filter_map(|row| Some((*row.first()?, *row.get(column)?)))
            .filter(|(t, y)| t.is_finite() && y.is_finite() && *t >= 0.0 && *t <= target.until_s)
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (first_s, last_s) = (points.first()?.0, points.last()?.0);
        let widths = Widths::new(&points, target, demands.tolerance);
        let span_end = demands.span_s * (1.0 + EDGE);

        let mut comparison = Self {
            column,
            with: target.with.clone(),
            compared: points.len(),
            on_curve: 0,
            in_span: 0,
            on_curve_in_span: 0,
            first_s,
            last_s,
            worst: (0.0, -1.0),
            first_off: None,
            factor: None,
        };
        for ((t, y), (reference, width)) in points.iter().zip(&widths.0) {
            let off = (y - reference).abs();
            let on_curve = off <= *width;
            comparison.on_curve += usize::from(on_curve);
            if *t <= span_end {
                comparison.in_span += 1;
                comparison.on_curve_in_span += usize::from(on_curve);
            }
            if off > comparison.worst.1 {
                comparison.worst = (*t, off);
            }
            if !on_curve && comparison.first_off.is_none() {
                comparison.first_off = Some((*t, *y, *reference));
            }
        }
        if !comparison.agrees() {
            comparison.factor = widths.common_factor(&points);
        }
        Some(comparison)
    }

    /// Up to the end of the span and over all.
    fn agrees(&self) -> bool {
        let enough = |on_curve: usize, all: usize| on_curve as f64 >= ON_THE_CURVE * all as f64;
        enough(self.on_curve, self.compared) && enough(self.on_curve_in_span, self.in_span)
    }

    fn rank(&self) -> (bool, f64) {
        (self.agrees(), self.on_curve as f64 / self.compared as f64)
    }

    fn why_not(&self, has_figure: bool) -> String {
        let mut reason = format!(
            "{} of {} points lie on the curve{}. The farthest is {} off, at {} s",
            self.on_curve,
            self.compared,
            self.with,
            significant(self.worst.1, 3),
            significant(self.worst.0, 4)
        );
        match self.first_off {
            Some((t, written, expected)) => reason.push_str(&format!(
                "; the first is at {} s: {} was given where the curve has {}.",
                significant(t, 4),
                significant(written, 4),
                significant(expected, 4)
            )),
            None => reason.push('.'),
        }
        if let Some(factor) = self.factor {
            reason.push_str(&format!(" It would agree if it were divided by {}.", significant(factor, 3)));
        }
        if has_figure {
            reason.push_str(" A figure beside data that does not agree earns nothing by itself.");
        }
        reason
    }
}

/// (reference, accepted distance) at each of the student's times.
struct Widths(Vec<(f64, f64)>);

impl Widths {
    /// relative · max over 0..=t of |reference| + absolute, the maximum taken over the curve's samples and the student's times.
    fn new(points: &[(f64, f64)], target: &Target<'_>, tolerance: &Tolerance) -> Self {
        let (relative, absolute) = (to_f64(&tolerance.relative), to_f64(&tolerance.absolute));
        let mut samples = target.samples.iter().peekable();
        let mut largest: f64 = 0.0;
        let widths = points.iter().map(|(t, _)| {
            while let Some((_, y)) = samples.next_if(|(time, _)| time <= t) {
                largest = largest.max(y.abs());
            }
            let reference = (target.at)(*t);
            largest = largest.max(reference.abs());
            (reference, relative * largest + absolute)
        });
        Self(widths.collect())
    }

    /// The factor (sign included) by which the data as a whole differs, when that is all that is wrong with it.
    fn common_factor(&self, points: &[(f64, f64)]) -> Option<f64> {
        let products: f64 = points.iter().zip(&self.0).map(|((_, y), (reference, _))| y * reference).sum();
        let squares: f64 = self.0.iter().map(|(reference, _)| reference * reference).sum();
        let factor = products / squares;
        if !factor.is_finite() || factor == 0.0 {
            return None;
        }
        let on_curve = points
            .iter()
            .zip(&self.0)
            .filter(|((_, y), (reference, width))| (y / factor - reference).abs() <= *width)
            .count();
        (on_curve as f64 >= ON_THE_CURVE * points.len() as f64).then_some(factor)
    }
}

#[cfg(test)]
mod tests {
    use super::super::closeness::tests::tolerance;
    use super::*;
    use crate::grading::Verdict;

    /// A decaying cosine over 10 s.
    fn curve(t: f64) -> f64 {
        (-0.2 * t).exp() * (3.0 * t).cos()
    }

    fn samples(scale: f64) -> Vec<(f64, f64)> {
        (0..=1000).map(|i| (f64::from(i) / 100.0, scale * curve(f64::from(i) / 100.0))).collect()
    }

    fn target<'a>(with: &str, scale: f64, samples: &'a [(f64, f64)]) -> Target<'a> {
        Target {
            with: with.to_owned(),
            at: Box::new(move |t| scale * curve(t)),
            samples,
            until_s: f64::INFINITY,
        }
    }

    fn series(points: usize, end_s: f64, y: impl Fn(f64) -> Vec<f64>) -> Series {
        let time = |i: usize| end_s * i as f64 / (points - 1) as f64;
        let rows: Vec<Vec<f64>> =
            (0..points).map(|i| std::iter::once(time(i)).chain(y(time(i))).collect()).collect();
        Series { file_name: "curve.csv".into(), headers: vec![String::new(); rows[0].len()], rows }
    }

    fn figure() -> Figure {
        Figure {
            file_name: "curve.png".into(),
            media_type: "image/png",
            bytes: Vec::new(),
            width: 8,
            height: 6,
        }
    }

    #[track_caller]
    fn check(what: &str, data: Option<Series>, with_figure: bool, points: i64, code: &str) {
        let tolerance = tolerance("0", "0.02", None);
        let demands = Demands { tolerance: &tolerance, min_points: 30, span_s: 10.0 };
        let figure = with_figure.then(figure);
        let (own, other) = (samples(1.0), samples(1.5));
        let targets = [target("", 1.0, &own), target(" with g = 10", 1.5, &other)];
        let mark = judge(Points(100), &targets, &demands, data.as_ref(), figure.as_ref());
        assert_eq!((mark.earned, mark.code), (Points(points), code), "{what}: {}", mark.evidence.reason);
        assert_eq!(mark.provisional, code == "plot.figure_only", "{what}");
        assert_eq!(mark.verdict == Verdict::Right, points > 0, "{what}");
    }

    #[test]
    fn data_decides_and_a_figure_waits() {
        let exact = |t: f64| vec![curve(t)];
        check("nothing", None, false, 0, "blank");
        check("a figure alone", None, true, 100, "plot.figure_only");
        check("exact", Some(series(200, 10.0, exact)), false, 100, "right");
        check("exact, and more of it than asked", Some(series(200, 50.0, exact)), false, 100, "right");
        check("just within 2 %", Some(series(200, 10.0, |t| vec![curve(t) + 0.0199])), false, 100, "right");
        check(
            "just beyond 2 %",
            Some(series(200, 10.0, |t| vec![curve(t) + 0.0201])),
            false,
            0,
            "plot.differs",
        );
        check(
            "an accepted alternative",
            Some(series(200, 10.0, |t| vec![1.5 * curve(t)])),
            false,
            100,
            "right",
        );
        check("turned upside down", Some(series(200, 10.0, |t| vec![-curve(t)])), false, 0, "plot.differs");
        check(
            "a figure does not rescue wrong data",
            Some(series(200, 10.0, |_| vec![0.0])),
            true,
            0,
            "plot.differs",
        );
        check("too few points", Some(series(29, 10.0, exact)), false, 0, "plot.too_few_points");
        check("just enough points", Some(series(30, 10.0, exact)), false, 100, "right");
        check("too few points beside a figure", Some(series(29, 10.0, exact)), true, 100, "plot.figure_only");
        check("too short", Some(series(200, 9.7, exact)), false, 0, "plot.too_short");
        check("short by 2 %", Some(series(200, 9.81, exact)), false, 100, "right");
        check(
            "a second column that agrees",
            Some(series(200, 10.0, |t| vec![t, curve(t)])),
            false,
            100,
            "right",
        );
        check(
            "flat, and so long that most of the curve has died away",
            Some(series(2000, 400.0, |_| vec![0.0])),
            false,
            0,
            "plot.differs",
        );
    }

    #[test]
    fn one_point_in_twenty_may_be_off() {
        let spoiled = |count: usize| {
            let mut data = series(200, 10.0, |t| vec![curve(t)]);
            data.rows.iter_mut().step_by(15).take(count).for_each(|row| row[1] += 1.0);
            Some(data)
        };
        check("10 of 200", spoiled(10), false, 100, "right");
        check("11 of 200", spoiled(11), false, 0, "plot.differs");
    }

    #[test]
    fn the_reason_names_the_farthest_point_and_a_common_factor() {
        let tolerance = tolerance("0", "0.02", None);
        let demands = Demands { tolerance: &tolerance, min_points: 30, span_s: 10.0 };
        let degrees = series(200, 10.0, |t| vec![curve(t).to_degrees()]);
        let mark = judge(Points(100), &[target("", 1.0, &samples(1.0))], &demands, Some(&degrees), None);
        assert!(mark.evidence.reason.contains("56.3 off, at 0 s"), "{}", mark.evidence.reason);
        assert!(mark.evidence.reason.contains("divided by 57.3"), "{}", mark.evidence.reason);
    }
}
