//! How long a time axis must be.

use super::{Mode, Response, settling};
use std::f64::consts::TAU;

/// Without any time constant to go by.
const DEFAULT_S: f64 = 10.0;
const MOST_PERIODS: f64 = 400.0;

/// See [`Response::horizon_s`].
pub(super) fn horizon_s(response: &Response) -> f64 {
    let moving: Vec<&Mode> = response.present().filter(|mode| !mode.is_constant()).collect();
    let rightmost = moving.iter().map(|mode| mode.re).fold(f64::NEG_INFINITY, f64::max);
    let wanted = if moving.is_empty() {
        DEFAULT_S
    } else if rightmost > 0.0 {
        growth_time(response)
    } else if rightmost == 0.0 {
        lasting_time(&moving)
    } else {
        let deviation = settling::largest_excursion(response, response.constant(), f64::INFINITY);
        deviation.map_or(DEFAULT_S, |peak| {
            let band = 0.05 * (peak.value - response.constant()).abs();
            1.02 * settling::last_crossing(response, band)
        })
    };
    let fastest = moving.iter().map(|mode| mode.im).fold(0.0, f64::max);
    let most = if fastest > 0.0 { MOST_PERIODS * TAU / fastest } else { f64::INFINITY };
    rounded_up(wanted.min(most))
}

/// When the envelope of the growing terms is a hundred times that of the whole at the start.
fn growth_time(response: &Response) -> f64 {
    let growing = || response.modes().iter().filter(|mode| mode.re > 0.0);
    let fastest = growing().map(|mode| mode.re).fold(0.0, f64::max);
    if response.pieces().is_some() {
        return seen_to_grow(response, 1.0 / fastest);
    }
    let start = response
        .moving_envelope(0.0)
        .max(growing().map(|mode| mode.envelope(1.0 / fastest) / std::f64::consts::E).sum());
    let short_of = |t: f64| growing().map(|mode| mode.envelope(t)).sum::<f64>() < 100.0 * start;
    let mut end = 1.0 / fastest;
    let mut begin = 0.0;
    while short_of(end) && end * fastest < 500.0 {
        (begin, end) = (end, 1.5 * end);
    }
    for _ in 0..20 {
        let middle = 0.5 * (begin + end);
        if short_of(middle) { begin = middle } else { end = middle }
    }
    end
}

/// The same from the curve itself, for terms that cancel: a hundred times its height within one time constant.
fn seen_to_grow(response: &Response, time_constant: f64) -> f64 {
    let height = |t: f64| (0..=20).map(|k| response.at(t * f64::from(k) / 20.0).abs()).fold(0.0, f64::max);
    let start = height(time_constant);
    let mut end = time_constant;
    while height(end) < 100.0 * start && end < 50.0 * time_constant {
        end *= 1.2;
    }
    end
}

/// Eight periods of the slowest oscillation that stays, and five time constants of the slowest term that does not.
fn lasting_time(moving: &[&Mode]) -> f64 {
    let slowest_turn =
        moving.iter().filter(|m| m.re == 0.0 && m.im > 0.0).map(|m| m.im).fold(f64::INFINITY, f64::min);
    let slowest_decay = moving.iter().filter(|m| m.re < 0.0).map(|m| -m.re).fold(f64::INFINITY, f64::min);
    let wanted = (8.0 * TAU / slowest_turn).max(5.0 / slowest_decay);
    if wanted > 0.0 { wanted } else { DEFAULT_S }
}

/// The next of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten.
fn rounded_up(time: f64) -> f64 {
    if !(time > 0.0 && time.is_finite()) {
        return DEFAULT_S;
    }
    let exponent = time.log10().floor() as i32;
    let scaled =
        |step: f64| if exponent < 0 { step / 10f64.powi(-exponent) } else { step * 10f64.powi(exponent) };
    let steps = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    steps.into_iter().map(scaled).find(|&nice| nice >= time * (1.0 - 1e-9)).unwrap_or_else(|| scaled(20.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_rounded_up_to_what_an_axis_likes() {
        #[track_caller]
        fn check(time: f64, nice: f64) {
            assert_eq!(rounded_up(time), nice, "{time}");
        }
        check(1.0, 1.0);
        check(1.01, 1.5);
        check(170.3, 200.0);
        check(0.0031, 0.004);
        check(8.5e-7, 1e-6);
        check(9.9e9, 1e10);
        check(0.0, DEFAULT_S);
        check(f64::INFINITY, DEFAULT_S);
    }
}
