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
/// Within the span no two neighbouring points may be farther apart than this part of it.
const LARGEST_GAP: f64 = 0.25;
/// Where the curve is still below this part of its largest value in the span, it counts as this large: noise beside an
/// exact 0 is no error. Points where it is larger must agree by themselves, so that zeros prove nothing.
const FLOOR: f64 = 0.01;
/// A limit is never missed by its last bit: this part of it is given.
const LAST_BIT: f64 = 1e-9;
/// A point so many times the curve's largest value away is no glitch of an export.
const GROSS: f64 = 10.0;
/// A common factor is read off no fewer points than these.
const FACTOR_POINTS: usize = 5;
/// A scope may export its input beside its outputs; no more columns than this are tried.
const COLUMNS_TRIED: usize = 4;

/// A curve to hold data against, and the parameter values it follows from.
pub(super) struct Target<'a> {
    /// ` with g = 9.8`, or nothing.
    pub with: String,
    pub at: Box<dyn Fn(f64) -> f64 + 'a>,
    /// Points of the curve in order of time, its extrema among them.
    pub turns: &'a [(f64, f64)],
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
        "Data at {} or more times that cover 0 to {} s without large gaps, {} % of the points within {} of the largest value \
         the curve has had by then; or a figure, which a person looks at.",
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
    format!("{} (at least {})", percent(&tolerance.relative), significant(to_f64(&tolerance.absolute), 3))
}

/// Data decides where there is enough of it; a figure alone earns the points until a person has looked.
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
    let best = targets
        .iter()
        .filter_map(|target| Rows::new(series, target, demands))
        .flat_map(|rows| (1..columns).map(move |column| rows.compare(series, column)).collect::<Vec<_>>())
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
    let too_few = best.all.points < demands.min_points;
    let figure_decides = too_few && figure.is_some();
    if !best.agrees() && !figure_decides {
        return Mark::wrong("plot.differs", evidence(best.why_not(figure.is_some())));
    }
    let so_far = if best.agrees() { "The data agrees with the curve" } else { "The data does not agree" };
    if too_few {
        let reason = format!(
            "{so_far}, but has points at {} different times only; {} are needed to see the shape.",
            best.all.points, demands.min_points
        );
        return with_figure_or(points, expected, series, figure, "plot.too_few_points", reason);
    }
    if best.first_s > EDGE * demands.span_s * (1.0 + LAST_BIT)
        || best.last_s < (1.0 - EDGE) * demands.span_s * (1.0 - LAST_BIT)
    {
        let reason = format!(
            "{so_far}, but covers {} s to {} s only; 0 to {} s is needed to see the shape.",
            significant(best.first_s, 4),
            significant(best.last_s, 4),
            significant(demands.span_s, 4)
        );
        return with_figure_or(points, expected, series, figure, "plot.too_short", reason);
    }
    if best.widest_gap.1 - best.widest_gap.0 > LARGEST_GAP * demands.span_s * (1.0 + LAST_BIT) {
        let reason = format!(
            "{so_far}, but has no point between {} s and {} s; gaps of more than {} s hide the shape.",
            significant(best.widest_gap.0, 4),
            significant(best.widest_gap.1, 4),
            significant(LARGEST_GAP * demands.span_s, 4)
        );
        return with_figure_or(points, expected, series, figure, "plot.too_few_points", reason);
    }
    Mark::right(points, evidence(best.why()))
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

/// The rows that can be compared with one curve, in order of time, and what is accepted at each.
struct Rows<'a> {
    with: &'a str,
    /// (index of the row, what the curve says of it).
    rows: Vec<(usize, Accepted)>,
    /// Of |curve| within the span.
    peak: f64,
    relative: f64,
    first_s: f64,
    last_s: f64,
    /// The longest time within the span without a point: (from, to).
    widest_gap: (f64, f64),
}

/// What the curve says of a point.
#[derive(Clone, Copy)]
struct Accepted {
    time: f64,
    reference: f64,
    /// max(absolute, relative · max(largest |curve| so far, floor)).
    width: f64,
    /// Farther off than this is no glitch.
    gross: f64,
    in_span: bool,
    /// The curve is above the floor.
    telling: bool,
}

impl<'a> Rows<'a> {
    /// `None` when no point can be compared. Times before 0 are left out: nothing has happened yet.
    fn new(series: &Series, target: &'a Target<'_>, demands: &Demands<'_>) -> Option<Self> {
        let mut times: Vec<(usize, f64)> = series
            .rows
            .iter()
            .enumerate()
            .filter_map(|(index, row)| Some((index, *row.first()?)))
            .filter(|(_, t)| t.is_finite() && *t >= 0.0 && *t <= target.until_s * (1.0 + LAST_BIT))
            .collect();
        times.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (first_s, last_s) = (times.first()?.1, times.last()?.1);

        let span_s = demands.span_s;
        let span_end = span_s * (1.0 + EDGE);
        let early = target.turns.iter().take_while(|(time, _)| *time <= span_s).map(|(_, y)| y.abs());
        let at_end = (target.at)(span_s.min(target.until_s)).abs();
        let peak = early.fold(if at_end.is_finite() { at_end } else { 0.0 }, f64::max);
        let floor = FLOOR * peak;
        let (relative, absolute) = (to_f64(&demands.tolerance.relative), to_f64(&demands.tolerance.absolute));

        let mut turns = target.turns.iter().peekable();
        let mut largest: f64 = 0.0;
        let rows = times
            .iter()
            .map(|&(index, time)| {
                while let Some((_, y)) = turns.next_if(|(turn, _)| *turn <= time) {
                    largest = largest.max(y.abs());
                }
                let reference = (target.at)(time);
                largest = largest.max(reference.abs());
                let accepted = Accepted {
                    time,
                    reference,
                    width: absolute.max(relative * largest.max(floor)),
                    gross: GROSS * largest.max(peak).max(absolute),
                    in_span: time <= span_end,
                    telling: reference.abs() > floor,
                };
                (index, accepted)
            })
            .collect();

        let within = times.iter().map(|(_, t)| t.min(span_s));
        let widest_gap = std::iter::once(0.0)
            .chain(within.clone())
            .zip(within.chain(std::iter::once(span_s)))
            .reduce(|widest, next| if next.1 - next.0 > widest.1 - widest.0 { next } else { widest })
            .unwrap_or((0.0, span_s));
        Some(Self { with: &target.with, rows, peak, relative, first_s, last_s, widest_gap })
    }

    fn compare(&self, series: &Series, column: usize) -> Comparison {
        let values: Vec<f64> = self
            .rows
            .iter()
            .map(|(row, _)| {
                series.rows.get(*row).and_then(|row| row.get(column)).copied().unwrap_or(f64::NAN)
            })
            .collect();
        let rounding = half_a_digit(&values).min(self.relative * self.peak);
        let mut comparison = self.held_against(&values, rounding, column);
        if !comparison.agrees() {
            comparison.factor = self.common_factor(&values).filter(|factor| {
                let divided: Vec<f64> = values.iter().map(|y| y / factor).collect();
                self.held_against(&divided, rounding / factor.abs(), column).agrees()
            });
        }
        comparison
    }

    fn held_against(&self, values: &[f64], rounding: f64, column: usize) -> Comparison {
        let mut comparison = Comparison {
            column,
            with: self.with.to_owned(),
            all: Share::default(),
            in_span: Share::default(),
            telling: Share::default(),
            first_s: self.first_s,
            last_s: self.last_s,
            widest_gap: self.widest_gap,
            worst: (0.0, -1.0),
            first_off: None,
            gross: false,
            factor: None,
        };
        let off = |accepted: &Accepted, y: f64| {
            let off = (y - accepted.reference).abs();
            if off.is_nan() { f64::INFINITY } else { off }
        };
        let points: Vec<(Accepted, f64)> =
            self.rows.iter().zip(values).map(|((_, accepted), y)| (*accepted, *y)).collect();
        // Rows of one time are one point: the one farthest off.
        for rows in points.chunk_by(|(a, _), (b, _)| a.time == b.time) {
            let farthest = rows.iter().max_by(|(a, y), (b, z)| off(a, *y).total_cmp(&off(b, *z)));
            let Some(&(accepted, y)) = farthest else { continue };
            let off = off(&accepted, y);
            let on_curve = off <= (accepted.width + rounding) * (1.0 + LAST_BIT);
            comparison.all.count(on_curve);
            if accepted.in_span {
                comparison.in_span.count(on_curve);
            }
            if accepted.telling {
                comparison.telling.count(on_curve);
            }
            comparison.gross |= off > accepted.gross;
            if off > comparison.worst.1 {
                comparison.worst = (accepted.time, off);
            }
            if !on_curve && comparison.first_off.is_none() {
                comparison.first_off = Some((accepted.time, y, accepted.reference));
            }
        }
        comparison
    }

    /// The factor (sign included) by which the data may differ as a whole: the median over all points that tell.
    fn common_factor(&self, values: &[f64]) -> Option<f64> {
        let telling = self.rows.iter().zip(values).filter(|((_, accepted), _)| accepted.telling);
        let mut ratios: Vec<f64> = telling.map(|((_, accepted), y)| y / accepted.reference).collect();
        ratios.sort_by(f64::total_cmp);
        let factor = *ratios.get(ratios.len() / 2)?;
        let means_something = factor.is_finite() && factor != 0.0 && (factor - 1.0).abs() > self.relative;
        (ratios.len() >= FACTOR_POINTS && means_something).then_some(factor)
    }
}

/// Half a unit of the last place that any of the values has.
fn half_a_digit(values: &[f64]) -> f64 {
    let places = values
        .iter()
        .map(|y| y.to_string().split_once('.').map_or(0, |(_, decimals)| decimals.len()))
        .max()
        .unwrap_or(0);
    0.5 * 10f64.powi(-i32::try_from(places).unwrap_or(i32::MAX))
}

/// How many of some points are on the curve.
#[derive(Clone, Copy, Default)]
struct Share {
    points: usize,
    on_curve: usize,
}

impl Share {
    fn count(&mut self, on_curve: bool) {
        self.points += 1;
        self.on_curve += usize::from(on_curve);
    }

    fn is_enough(self) -> bool {
        self.on_curve as f64 >= ON_THE_CURVE * self.points as f64 * (1.0 - LAST_BIT)
    }
}

/// One column beside one curve.
struct Comparison {
    column: usize,
    with: String,
    all: Share,
    in_span: Share,
    /// Where the curve is above its floor.
    telling: Share,
    first_s: f64,
    last_s: f64,
    widest_gap: (f64, f64),
    /// (time, distance) of the point farthest off.
    worst: (f64, f64),
    /// The first point that is off: (time, written, expected).
    first_off: Option<(f64, f64, f64)>,
    /// A point is so far off that no share of others makes up for it.
    gross: bool,
    /// The data agrees once divided by this.
    factor: Option<f64>,
}

impl Comparison {
    fn agrees(&self) -> bool {
        !self.gross && [self.all, self.in_span, self.telling].into_iter().all(Share::is_enough)
    }

    fn rank(&self) -> (bool, f64) {
        (self.agrees(), self.all.on_curve as f64 / self.all.points as f64)
    }

    fn on_the_curve(&self) -> String {
        format!("{} of {} points lie on the curve{}", self.all.on_curve, self.all.points, self.with)
    }

    fn why(&self) -> String {
        if self.all.on_curve == self.all.points {
            return format!("All {} points lie on the curve{}.", self.all.points, self.with);
        }
        format!(
            "{}; {} % are enough. The farthest is {} off, at {} s.",
            self.on_the_curve(),
            significant(ON_THE_CURVE * 100.0, 3),
            significant(self.worst.1, 3),
            significant(self.worst.0, 4)
        )
    }

    fn why_not(&self, has_figure: bool) -> String {
        let mut reason = format!(
            "{}. The farthest is {} off, at {} s",
            self.on_the_curve(),
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
            reason.push_str(&format!(" It would agree {}.", remedy(factor)));
        } else if self.gross {
            reason.push_str(" So far off, one point is enough to spoil the data.");
        } else if self.all.is_enough() {
            reason.push_str(" Too many of those that tell the curve from others are off.");
        }
        if has_figure {
            reason.push_str(" A figure beside data that does not agree earns nothing by itself.");
        }
        reason
    }
}

/// `with its sign reversed`, `if it were divided by 57.3, that is, given in radians rather than degrees`.
fn remedy(factor: f64) -> String {
    let is_about = |value: f64| (factor.abs() / value - 1.0).abs() < 0.005;
    let sign = if factor < 0.0 { "with its sign reversed" } else { "" };
    let and = if factor < 0.0 { " and " } else { "" };
    if is_about(1.0) {
        return sign.to_owned();
    }
    let degrees = if is_about(180.0 / std::f64::consts::PI) { ", as degrees are for radians" } else { "" };
    format!("{sign}{and}if it were divided by {}{degrees}", significant(factor.abs(), 3))
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
            turns: samples,
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
        // 10 of the 200 may be off, but only 9 of those where the curve is not close to 0.
        check("9 of 200", spoiled(9), false, 100, "right");
        check("10 of 200", spoiled(10), false, 0, "plot.differs");
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

    #[test]
    fn noise_and_few_decimals_are_no_errors() {
        let decimals = |y: f64, places: i32| (y * 10f64.powi(places)).round() / 10f64.powi(places);
        check("noise", Some(series(200, 10.0, |t| vec![curve(t) + 1e-13])), false, 100, "right");
        check("two decimals", Some(series(200, 10.0, |t| vec![decimals(curve(t), 2)])), false, 100, "right");
        check("no decimals", Some(series(200, 10.0, |t| vec![curve(t).round()])), false, 0, "plot.differs");
    }

    /// Grows from 0 without bound; stays 0 up to 2 s and grows then.
    #[track_caller]
    fn check_other(what: &str, curve: fn(f64) -> f64, data: Series, code: &str) {
        let tolerance = tolerance("0", "0.005", None);
        let demands = Demands { tolerance: &tolerance, min_points: 10, span_s: 3.0 };
        let samples: Vec<_> = (0..=300).map(|i| f64::from(i) / 100.0).map(|t| (t, curve(t))).collect();
        let target =
            Target { with: String::new(), at: Box::new(curve), turns: &samples, until_s: f64::INFINITY };
        let mark = judge(Points(100), &[target], &demands, Some(&data), None);
        assert_eq!(mark.code, code, "{what}: {}", mark.evidence.reason);
    }

    fn growing(t: f64) -> f64 {
        (2.0 * t).sinh()
    }

    fn late(t: f64) -> f64 {
        if t < 0.5 { 0.0 } else { t - 0.5 }
    }

    #[test]
    fn curves_that_begin_with_zero_and_curves_that_grow() {
        let two_decimals = |t: f64| vec![(growing(t) * 100.0).round() / 100.0];
        let noisy = |curve: fn(f64) -> f64| move |t: f64| vec![curve(t) * (1.0 + 1e-13) + 1e-15];
        check_other("growing", growing, series(31, 3.0, noisy(growing)), "right");
        check_other("growing, two decimals", growing, series(61, 3.0, two_decimals), "right");
        check_other("growing, mostly after the span", growing, series(101, 50.0, noisy(growing)), "right");
        check_other("growing, zeros", growing, series(31, 3.0, |_| vec![0.0]), "plot.differs");
        check_other("another growth", growing, series(101, 50.0, |t| vec![(2.2 * t).sinh()]), "plot.differs");
        check_other("late", late, series(61, 3.0, noisy(late)), "right");
        check_other("late, without its delay", late, series(61, 3.0, |t| vec![t]), "plot.differs");
        check_other("late, from 0.05 below", late, series(61, 3.0, |t| vec![late(t + 0.05)]), "plot.differs");
        check_other("late, zeros", late, series(61, 3.0, |_| vec![0.0]), "plot.differs");
        check_other("late, dense zeros", late, series(61, 0.6, |_| vec![0.0]), "plot.differs");
    }

    fn rows(all: &[(usize, f64, f64)]) -> Option<Series> {
        let rows: Vec<_> = all.iter().flat_map(|&(count, t, y)| vec![vec![t, y]; count]).collect();
        Some(Series { file_name: "x".into(), headers: vec![String::new(); 2], rows })
    }

    #[test]
    fn junk_earns_nothing() {
        check(
            "repeated zeros",
            rows(&[(30, 0.0, 1.0), (1, 10.0, curve(10.0))]),
            false,
            0,
            "plot.too_few_points",
        );
        check(
            "repeated zeros and a spike",
            rows(&[(60, 0.0, 1.0), (1, 10.0, 1e9)]),
            false,
            0,
            "plot.differs",
        );
        let with_gap = |from: f64, to: f64| {
            let mut data = series(201, 10.0, |t| vec![curve(t)]);
            data.rows.retain(|row| row[0] <= from || row[0] >= to);
            Some(data)
        };
        check("a gap of a quarter", with_gap(2.0, 4.5), false, 100, "right");
        check("a larger one", with_gap(2.0, 4.55), false, 0, "plot.too_few_points");
        check("a larger one beside a figure", with_gap(2.0, 4.55), true, 100, "plot.figure_only");
        let spike = |y: f64| {
            let mut data = series(200, 10.0, |t| vec![curve(t)]);
            data.rows[77][1] = y;
            Some(data)
        };
        check("a lone glitch", spike(3.0), false, 100, "right");
        check("a lone 1e9", spike(1e9), false, 0, "plot.differs");
        // Each row of a repeated time counts: one of the two is not the curve.
        let mut twice = series(200, 10.0, |t| vec![curve(t)]);
        twice.rows = twice.rows.iter().flat_map(|row| [row.clone(), vec![row[0], -row[1]]]).collect();
        check("two curves in one", Some(twice), false, 0, "plot.differs");
    }

    #[test]
    fn too_little_data_is_no_worse_than_none() {
        check("two rows, one wrong", rows(&[(1, 0.0, 1.0), (1, 10.0, 7.0)]), true, 100, "plot.figure_only");
        check("without a figure", rows(&[(1, 0.0, 1.0), (1, 10.0, 7.0)]), false, 0, "plot.differs");
    }

    #[test]
    fn reasons_read_plainly() {
        let tolerance = tolerance("0", "0.02", None);
        let demands = Demands { tolerance: &tolerance, min_points: 30, span_s: 10.0 };
        let samples = samples(1.0);
        let reason = |data: Series| {
            judge(Points(100), &[target("", 1.0, &samples)], &demands, Some(&data), None).evidence.reason
        };
        assert_eq!(reason(series(200, 10.0, |t| vec![curve(t) + 1e-9])), "All 200 points lie on the curve.");
        let reversed = reason(series(200, 10.0, |t| vec![-curve(t)]));
        assert!(reversed.ends_with(" It would agree with its sign reversed."), "{reversed}");
        let degrees = reason(series(200, 10.0, |t| vec![-curve(t).to_degrees()]));
        assert!(
            degrees.ends_with(
                " It would agree with its sign reversed and if it were divided by 57.3, as degrees are for radians."
            ),
            "{degrees}"
        );
        let half_wrong = reason(series(200, 10.0, |t| vec![if t < 8.0 { curve(t) } else { 0.5 }]));
        assert!(!half_wrong.contains("would agree"), "{half_wrong}");
        let few = reason(series(3, 10.0, |t| vec![3.0 * curve(t)]));
        assert!(!few.contains("would agree"), "{few}");
    }
}
