//! What one reads off a response, read off a dense sampling of the matrix exponential.

use super::{Agreement, digits, eigenvalues};
use crate::algebra::{Polynomial, to_f64};
use crate::lti::{ExponentialResponse, Features, InputKind, Stability, TransferFunction, stability};
use crate::reference::{OperatingPointReference, ResponseReference};
use std::f64::consts::TAU;

/// Samples in equal steps, and as many whose steps grow with the time.
const SAMPLES: u32 = 1_500;
/// The shortest time looked at, as a part of the longest.
const SHORTEST: f64 = 1e-9;

/// For impulse and step: the limit, times and heights, and what the dominant poles say.
pub(super) fn feature_routes(name: &str, point: &OperatingPointReference) -> Vec<Agreement> {
    let main = point.main();
    let g = &main.linearization.transfer_function;
    let mut agreements = Vec::new();
    for (what, kind, response) in
        [("impulse", InputKind::Impulse, &main.impulse), ("step", InputKind::Step, &main.step)]
    {
        let Some(response) = response else { continue };
        let features = &response.features;
        agreements.push(limit(format!("{name} {what}: final value"), g, kind, features));
        if let Some(read) = read_off(g, kind, response) {
            agreements.push(read.agreement(
                format!("{name} {what}: features"),
                "closed form against a dense sampling of the matrix exponential",
                6.0,
            ));
        }
        if let Some(spectrum) = spectrum(g, features) {
            let wanted = 6.0 / main.poles.iter().map(|p| p.multiplicity).max().unwrap_or(1) as f64;
            agreements.push(spectrum.agreement(
                format!("{name} {what}: frequencies"),
                "certified poles against eigenvalues of the companion matrix",
                wanted,
            ));
        }
    }
    agreements
}

/// Several numbers, each with its digits of agreement.
#[derive(Default)]
struct Read(Vec<(&'static str, f64)>);

impl Read {
    fn near(&mut self, what: &'static str, found: f64, expected: f64) {
        self.0.push((what, digits((found - expected).abs(), expected.abs().max(found.abs()))));
    }

    /// Of `whole`, where what is compared may be zero.
    fn within(&mut self, what: &'static str, found: f64, expected: f64, whole: f64) {
        self.0.push((what, digits((found - expected).abs(), whole)));
    }

    fn fails(&mut self, what: &'static str) {
        self.0.push((what, 0.0));
    }

    fn agreement(self, what: String, routes: &'static str, wanted: f64) -> Agreement {
        let note: Vec<String> = self
            .0
            .iter()
            .map(|(what, digits)| match digits {
                d if d.is_infinite() => format!("{what} exactly"),
                d => format!("{what} {d:.1}"),
            })
            .collect();
        let digits = self.0.iter().map(|(_, digits)| *digits).fold(f64::INFINITY, f64::min);
        Agreement { what, routes, digits, wanted, note: note.join(", ") }
    }
}

/// By the final value theorem, whose condition is decided exactly.
fn limit(what: String, g: &TransferFunction, kind: InputKind, features: &Features) -> Agreement {
    let (num, den) = match kind {
        InputKind::Step => (g.num.clone(), g.den.clone()),
        InputKind::Impulse => {
            // Without the direct feed-through, whose impulse is over at once.
            let rest = g.num.div_rem(&g.den).map_or_else(|| g.num.clone(), |(_, rest)| rest);
            (&rest * &Polynomial::from_integers(&[1, 0]), g.den.clone())
        }
    };
    let (s_times, _) = TransferFunction { num, den }.cancelled();
    let settles = s_times.num.is_zero() || stability(&s_times.den) == Stability::AsymptoticallyStable;
    let expected = settles.then(|| to_f64(&(s_times.num.coefficient(0) / s_times.den.coefficient(0))));
    let found = features.final_value.value();
    let digits = match (found, expected) {
        (None, None) => f64::INFINITY,
        (Some(found), Some(expected)) => digits((found - expected).abs(), expected.abs()),
        _ => 0.0,
    };
    Agreement {
        what,
        routes: "closed form against the final value theorem in exact fractions",
        digits,
        wanted: 12.0,
        note: if expected.is_some() { String::new() } else { "there is none".to_owned() },
    }
}

/// `None` when the exponential cannot be computed.
fn read_off(g: &TransferFunction, kind: InputKind, reference: &ResponseReference) -> Option<Read> {
    let features = &reference.features;
    let exponential = ExponentialResponse::new(g, kind).ok()?;
    let y = |t: f64| exponential.at(t).unwrap_or(f64::NAN);
    let settled = [features.settling_time_2_percent_s, features.settling_time_5_percent_s];
    let end = settled.into_iter().flatten().fold(reference.horizon_s, |end, t| end.max(1.05 * t));
    let mut times: Vec<f64> = vec![0.0];
    times.extend((1..=SAMPLES).map(|k| end * f64::from(k) / f64::from(SAMPLES)));
    times.extend((0..SAMPLES).map(|k| end * SHORTEST.powf(f64::from(k) / f64::from(SAMPLES))));
    times.extend(features.peak.map(|peak| peak.time_s));
    times.extend(features.extrema.iter().map(|extremum| extremum.time_s).filter(|t| *t <= end));
    times.sort_by(f64::total_cmp);
    let samples: Vec<(f64, f64)> = times.into_iter().map(|t| (t, y(t))).collect();
    let height = samples.iter().map(|(_, y)| y.abs()).fold(0.0, f64::max);
    if !(height > 0.0 && height.is_finite()) {
        return None;
    }

    let mut read = Read::default();
    read.within("initial value", y(0.0), features.initial_value, height);
    if let Some(peak) = features.peak {
        read.near("peak", highest(&samples, &y, 0.0), peak.value.abs());
    }
    let Some(level) = features.final_value.value() else { return Some(read) };
    let deviation = highest(&samples, &y, level);
    for (what, share, time_s) in [
        ("settling 2 %", 0.02, features.settling_time_2_percent_s),
        ("settling 5 %", 0.05, features.settling_time_5_percent_s),
    ] {
        let Some(time_s) = time_s else { continue };
        let band = share * deviation;
        let after = samples.iter().filter(|(t, _)| *t > time_s);
        if after.map(|(_, y)| (y - level).abs()).fold(0.0, f64::max) > band * (1.0 + 1e-6) {
            read.fails(what);
        } else {
            read.near(what, (y(time_s) - level).abs(), band);
        }
    }
    if let Some(percent) = features.overshoot_percent {
        let beyond = |y: f64| (y / level - 1.0).max(0.0);
        let most = highest_of(&samples, &y, &beyond);
        read.within("overshoot", 100.0 * most, percent, 100.0);
    }
    let first = |share: f64| first_crossing(&samples, &y, share * level);
    if let Some(rise) = features.rise_time_10_90_s {
        match first(0.9).zip(first(0.1)) {
            Some((late, early)) => read.near("rise 10-90 %", late - early, rise),
            None => read.fails("rise 10-90 %"),
        }
    }
    // A response that only touches its final value crosses it, among samples, anywhere near.
    let crosses = features.overshoot_percent.is_none_or(|percent| percent >= 0.1);
    if let Some(rise) = features.rise_time_0_100_s.filter(|_| crosses) {
        match first(1.0) {
            Some(time_s) => read.near("rise 0-100 %", time_s, rise),
            None => read.fails("rise 0-100 %"),
        }
    }
    Some(read)
}

/// The largest |y − level|.
fn highest(samples: &[(f64, f64)], y: &impl Fn(f64) -> f64, level: f64) -> f64 {
    highest_of(samples, y, &|y| (y - level).abs())
}

/// The largest `of(y)`: the highest sample, and what lies between its neighbours.
fn highest_of(samples: &[(f64, f64)], y: &impl Fn(f64) -> f64, of: &impl Fn(f64) -> f64) -> f64 {
    let best = (0..samples.len()).max_by(|i, j| of(samples[*i].1).total_cmp(&of(samples[*j].1)));
    let Some(best) = best else { return 0.0 };
    let (mut a, mut b) = (samples[best.saturating_sub(1)].0, samples[(best + 1).min(samples.len() - 1)].0);
    let mut most = of(samples[best].1);
    // Golden section.
    let share = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..40 {
        let (left, right) = (b - share * (b - a), a + share * (b - a));
        let (at_left, at_right) = (of(y(left)), of(y(right)));
        most = most.max(at_left).max(at_right);
        if at_left > at_right { b = right } else { a = left }
    }
    most
}

/// When y first reaches `level`, coming from y(0).
fn first_crossing(samples: &[(f64, f64)], y: &impl Fn(f64) -> f64, level: f64) -> Option<f64> {
    let before = samples.first()?.1 - level;
    let crossed = samples.iter().position(|(_, y)| (y - level) * before < 0.0)?;
    let (mut a, mut b) = (samples[crossed - 1].0, samples[crossed].0);
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (y(middle) - level) * before < 0.0 { b = middle } else { a = middle }
    }
    Some(0.5 * (a + b))
}

/// Each is said of poles that must be among the eigenvalues.
fn spectrum(g: &TransferFunction, features: &Features) -> Option<Read> {
    let eigenvalues = eigenvalues::of_polynomial(&g.den)?;
    let mut read = Read::default();
    let mut nearest = |what: &'static str, re: f64, im: f64| {
        let distance = eigenvalues.iter().map(|z| (z.re - re).hypot(z.im.abs() - im.abs()));
        read.0.push((what, digits(distance.fold(f64::INFINITY, f64::min), re.hypot(im))));
    };
    if let (Some(zeta), Some(speed)) = (features.damping_ratio, features.natural_frequency_rad_s) {
        match features.period_s {
            Some(period_s) => nearest("damping and period", -zeta * speed, TAU / period_s),
            None => {
                let apart = speed * (zeta * zeta - 1.0).max(0.0).sqrt();
                nearest("damping", -zeta * speed - apart, 0.0);
                nearest("damping", -zeta * speed + apart, 0.0);
            }
        }
    }
    if let Some(time_s) = features.slowest_time_constant_s {
        let gap = eigenvalues.iter().map(|z| (z.re * time_s + 1.0).abs()).fold(f64::INFINITY, f64::min);
        read.0.push(("slowest time constant", digits(gap, 1.0)));
    }
    (!read.0.is_empty()).then_some(read)
}
