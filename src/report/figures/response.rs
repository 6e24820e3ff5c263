use super::frame::{data_series, frame, leaves_at, leaving_words};
use crate::lti::{Features, InputKind, Limit, Response, Shape};
use crate::reference::{OperatingPointReference, ResponseReference};
use crate::report::figure::{Axis, Figure, Look, Series};
use crate::report::numbers::{letter, number, quantity};
use crate::submission;
use std::f64::consts::TAU;

/// The views of one response that do not depend on a student: how far they go, and the reference curve in each.
#[derive(Clone, Debug)]
pub struct PreparedResponse {
    title: String,
    output: String,
    unit: String,
    summary: String,
    views: Vec<View>,
}

#[derive(Clone, Debug)]
struct View {
    name: String,
    end_s: f64,
    /// The periods are too dense to be told apart.
    dense: bool,
    reference: Vec<(f64, f64)>,
}

/// What a student has to be drawn over the reference.
#[derive(Clone, Copy, Debug, Default)]
pub struct StudentCurves<'a> {
    /// The response of the student's own transfer function.
    pub own: Option<&'a OwnCurves>,
    /// The numbers handed in.
    pub data: Option<&'a submission::Series>,
}

/// The response of a student's own transfer function, as it is drawn.
#[derive(Clone, Debug)]
pub struct OwnCurves {
    /// One a view: as far as it matters there.
    views: Vec<Vec<(f64, f64)>>,
    /// By itself: what follows from it. `None` where it can be seen well enough over the reference, or swings too often to be
    /// drawn lightly.
    pub alone: Option<Figure>,
}

impl OwnCurves {
    /// In bytes, about.
    pub fn size(&self) -> usize {
        let alone = self.alone.iter().flat_map(|figure| &figure.series).map(|series| &series.points);
        1000 + self.views.iter().chain(alone).map(|points| 16 * points.len()).sum::<usize>()
    }
}

/// A response of more than so many periods is shown twice: its beginning, and all of it.
const MANY_PERIODS: f64 = 14.0;
const FIRST_PERIODS: f64 = 7.0;
/// Of the height of the curve: a fifth of a pixel of a picture 240 px high.
const TOLERANCE: f64 = 8e-4;

impl PreparedResponse {
    pub fn new(point: &OperatingPointReference, reference: &ResponseReference) -> Self {
        let unit = &point.output_unit;
        let (kind, title) = match reference.response.kind {
            InputKind::Impulse => ("unit impulse", "impulse response"),
            InputKind::Step => ("unit step", "step response"),
        };
        let whole = View {
            name: String::new(),
            end_s: reference.horizon_s,
            dense: false,
            reference: reference.samples().to_vec(),
        };
        let views = match reference.features.period_s {
            Some(period) if reference.horizon_s > MANY_PERIODS * period => {
                let end_s = FIRST_PERIODS * period;
                let first = View {
                    name: format!(", first {}", quantity(end_s, 2, "s")),
                    end_s,
                    dense: false,
                    reference: reference.response.samples(end_s, TOLERANCE),
                };
                let name = ", whole decay".to_owned();
                vec![first, View { name, dense: true, ..whole }]
            }
            _ => vec![whole],
        };
        let summary = format!(
            "Answer of {} to a {kind} at {}. {}",
            letter(&point.output),
            letter(&point.input),
            feature_words(&reference.features, unit)
        );
        let title = format!("{}: {title}", point.title);
        Self { title, output: letter(&point.output), unit: unit.clone(), summary, views }
    }

    /// One figure a view, the student's curves over the reference.
    pub fn figures(&self, student: StudentCurves<'_>) -> Vec<Figure> {
        let own =
            |place: usize| student.own.and_then(|own| own.views.get(place)).map_or(&[][..], Vec::as_slice);
        let views = self.views.iter().enumerate();
        views.map(|(place, view)| self.figure(view, own(place), student.data)).collect()
    }

    /// The curves of a student's own transfer function, whose response is `own`.
    pub fn own_curves(&self, own: &Response) -> OwnCurves {
        let views: Vec<_> = self.views.iter().map(|view| sampled(own, view)).collect();
        let alone = views.first().and_then(|seen| self.alone(own, seen));
        OwnCurves { views, alone }
    }

    /// `seen`: how it stands over the reference, in the first view.
    fn alone(&self, own: &Response, seen: &[(f64, f64)]) -> Option<Figure> {
        const EARLY: f64 = 0.25;
        const MOST_POINTS: usize = 400;
        let view = self.views.first()?;
        let left = leaves_at(seen, frame(&view.reference, &[seen]))?;
        if left > EARLY * view.end_s {
            return None;
        }
        let end_s = own.horizon_s();
        let points = own.samples(end_s, 2.0 * TOLERANCE);
        let finite = points.iter().all(|(t, y)| t.is_finite() && y.is_finite());
        if !finite || points.len() > MOST_POINTS {
            return None;
        }
        let range = frame(&points, &[]);
        let x = Axis::new("time t", "s", 0.0, end_s);
        let y = Axis::new(&self.output, &self.unit, range.0, range.1);
        let mut figure = Figure::new("What follows from your transfer function".to_owned(), x, y);
        figure.zero_lines = true;
        figure.caption = feature_words(&Features::of(own), &self.unit);
        figure.summary = format!("{}, of your own transfer function. {}", self.title, figure.caption);
        figure.series.push(Series { name: "your transfer function".into(), look: Look::Student, points });
        Some(figure)
    }

    fn figure(&self, view: &View, own: &[(f64, f64)], data: Option<&submission::Series>) -> Figure {
        let data = data.map(|d| data_series(d, view.end_s)).unwrap_or_default();
        let mut others: Vec<&[(f64, f64)]> = vec![own];
        others.extend(data.iter().map(|s| s.points.as_slice()));
        let range = frame(&view.reference, &others);

        let x = Axis::new("time t", "s", 0.0, view.end_s);
        let y = Axis::new(&self.output, &self.unit, range.0, range.1);
        let mut figure = Figure::new(format!("{}{}", self.title, view.name), x, y);
        figure.zero_lines = true;
        figure.summary = self.summary.clone();
        let points = view.reference.clone();
        figure.series.push(Series { name: "reference".into(), look: Look::Reference, points });
        if !own.is_empty() {
            figure.caption += &leaving_words("The curve of your transfer function", own, range);
            let name = "your transfer function".to_owned();
            let points = own.to_vec();
            figure.series.extend(over_dense(view, Series { name, look: Look::Student, points }));
        }
        for series in data {
            figure.caption += &leaving_words("The curve of your data", &series.points, range);
            figure.series.extend(over_dense(view, series));
        }
        figure.caption = figure.caption.trim().to_owned();
        if !figure.caption.is_empty() {
            figure.summary = format!("{} {}", figure.summary, figure.caption);
        }
        figure
    }
}

/// A curve as it is drawn over the reference: where swings are too dense to be told apart, by the lines along their tops and
/// bottoms, since it would hide the reference otherwise.
fn over_dense(view: &View, series: Series) -> Vec<Series> {
    const SWINGS: usize = 8;
    let turns = |sign: f64| {
        let higher = |a: &(f64, f64), b: &(f64, f64)| sign * a.1 >= sign * b.1;
        let tops = series.points.windows(3).filter(|w| higher(&w[1], &w[0]) && higher(&w[1], &w[2]));
        tops.map(|w| w[1]).collect::<Vec<_>>()
    };
    let (tops, bottoms) = (turns(1.0), turns(-1.0));
    if !view.dense || tops.len().min(bottoms.len()) < SWINGS {
        return vec![series];
    }
    let look = series.look;
    vec![Series { points: tops, ..series }, Series { name: String::new(), look, points: bottoms }]
}

/// The curve of a student's system as far as it matters: to the end of the view, or well past where it leaves the picture.
fn sampled(response: &Response, view: &View) -> Vec<(f64, f64)> {
    const STEPS: usize = 300;
    let reach = view.reference.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
    let end_s = view.end_s;
    let far = 8.0 * if reach > 0.0 { reach } else { 1.0 };
    let instants = (1..=STEPS).map(|i| end_s * i as f64 / STEPS as f64);
    let near = |t: f64| response.at(t).abs() < far;
    let end_s = instants.clone().find(|&t| !near(t)).unwrap_or(end_s);
    let mut points = match even_steps(response, end_s).filter(|_| view.dense) {
        Some(steps) => {
            let instants = (0..=steps).map(|i| end_s * i as f64 / steps as f64);
            instants.map(|t| (t, response.at(t))).collect()
        }
        None => response.samples(end_s, TOLERANCE),
    };
    if let Some(bad) = points.iter().position(|(t, y)| !t.is_finite() || !y.is_finite()) {
        points.truncate(bad);
    }
    points
}

/// Even steps that show the height of every swing within half a percent; `None` when that would be too many.
fn even_steps(response: &Response, end_s: f64) -> Option<usize> {
    const A_PERIOD: f64 = 32.0;
    let fastest = response.modes().iter().map(|mode| mode.im).fold(0.0, f64::max);
    let steps = (A_PERIOD * end_s * fastest / TAU).max(400.0);
    (steps <= 8_000.0).then_some(steps as usize)
}

/// What one reads off the response, in full sentences.
pub fn feature_words(features: &Features, unit: &str) -> String {
    let shape = match features.shape {
        Shape::DecayingOscillation => "It swings with shrinking amplitude",
        Shape::SustainedOscillation => "It swings with constant amplitude",
        Shape::GrowingOscillation => "It swings with growing amplitude",
        Shape::ExponentialDecay => "It approaches its final value without swinging about it",
        Shape::ExponentialGrowth => "It leaves to one side, ever faster",
        Shape::PolynomialGrowth => "It grows like a power of time",
        Shape::Constant => "It stays where it is",
    };
    let mut words = format!("{shape}, from {}", quantity(features.initial_value, 4, unit));
    words += &format!(" {}.", limit_words(features.final_value, unit));
    if let Some(peak) = features.peak {
        let (value, time) = (quantity(peak.value, 4, unit), quantity(peak.time_s, 4, "s"));
        words += &format!(" It is farthest out with {value} at {time}.");
    }
    if let Some(period) = features.period_s {
        words += &format!(" Period {}.", quantity(period, 4, "s"));
    }
    if let Some(damping) = features.damping_ratio {
        words += &format!(" Damping ratio {}.", number(damping, 4));
    }
    if let Some(time) = features.settling_time_2_percent_s {
        words += &format!(" It stays within 2\u{a0}% after {}.", quantity(time, 4, "s"));
    }
    words
}

/// `to 0 rad`, `beyond every bound, upwards` …
pub fn limit_words(limit: Limit, unit: &str) -> String {
    match limit {
        Limit::Value(v) => format!("to {}", quantity(v, 4, unit)),
        Limit::PlusInfinity => "to +∞".to_owned(),
        Limit::MinusInfinity => "to −∞".to_owned(),
        Limit::Oscillates => "without a limit: it swings for ever".to_owned(),
        Limit::OscillatesUnbounded => "without a limit: its swings grow without bound".to_owned(),
    }
}
