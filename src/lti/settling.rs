//! The largest excursion of a response, and the times after which it stays near its final value.

use super::extrema::{crossing, step_at};
use super::{Extremum, Response};

/// Scans backwards end after this many steps; the envelope's time, a little late, then stands.
const MOST_STEPS: usize = 100_000;

/// Two swings whose heights differ by less than this, of themselves, are as high.
const AS_HIGH: f64 = 1e-12;

/// The largest |y − `level`|, at t = 0 or at an extremum; `None` when none is as large as what the response tends to.
///
/// For responses that stay bounded. Where oscillations last for ever the walk covers `enough_s`.
pub(super) fn largest_excursion(response: &Response, level: f64, enough_s: f64) -> Option<Extremum> {
    let mut best = Extremum { time_s: 0.0, value: response.at(0.0) };
    let height = |extremum: Extremum| (extremum.value - level).abs();
    let limit = (response.constant() - level).abs();
    let mut scan = response.extrema_from(0.0);
    while !scan.finished() && scan.time() <= enough_s {
        // Nothing that comes can be higher.
        if limit + response.moving_bound_from(scan.time()) <= height(best) * (1.0 + 1e-13) {
            break;
        }
        // Of those that are as high the first counts, whatever the last digit says.
        let higher = |extremum: &Extremum| height(*extremum) > height(best) * (1.0 + AS_HIGH);
        if let Some(extremum) = scan.advance().filter(higher) {
            best = extremum;
        }
    }
    let lasting = response.moving().any(|mode| mode.re >= 0.0);
    (lasting || height(best) > limit * (1.0 + 1e-12)).then_some(best)
}

/// When the envelope of a decaying response has fallen to `band` for good.
pub(super) fn envelope_time(response: &Response, band: f64) -> f64 {
    if let Some(pieces) = response.pieces() {
        return pieces.within(band);
    }
    let decay = |mode: &super::Mode| -mode.re;
    // From here on every envelope falls.
    let falling = response.moving().map(|mode| mode.power as f64 / decay(mode)).fold(0.0, f64::max);
    let excess = |t: f64| response.moving_envelope(t) - band;
    if excess(falling) <= 0.0 {
        return falling;
    }
    let slowest = response.moving().map(decay).fold(f64::INFINITY, f64::min);
    let mut end = falling + 1.0 / slowest;
    // A thousand doublings outlast every f64.
    for _ in 0..1000 {
        if excess(end) <= 0.0 {
            break;
        }
        end *= 2.0;
    }
    crossing(falling, end, excess)
}

/// The last time at which |y − final| is `band`; 0 when it never is. For decaying responses.
///
/// Source: from where the envelope enters the band, backwards to the first value or extremum outside it.
pub(super) fn last_crossing(response: &Response, band: f64) -> f64 {
    let level = response.constant();
    let excess = |t: f64| (response.at(t) - level).abs() - band;
    let start = envelope_time(response, band);
    let mut late = start;
    for _ in 0..MOST_STEPS {
        if late == 0.0 {
            return 0.0;
        }
        let early = (late - step_at(response, late)).max(0.0);
        if excess(early) > 0.0 {
            return crossing(early, late, excess);
        }
        let (rate_early, rate_late) = (response.rate(early), response.rate(late));
        if rate_early * rate_late < 0.0 {
            let turn = crossing(early, late, |t| response.rate(t));
            if excess(turn) > 0.0 {
                return crossing(turn, late, excess);
            }
        }
        late = early;
    }
    start
}

/// The first time y is `level`, coming from y(0); `None` when it never is. For decaying responses with a final value.
pub(super) fn first_crossing(response: &Response, level: f64) -> Option<f64> {
    let side = |t: f64| response.at(t) - level;
    let mut from = 0.0;
    let before = side(0.0);
    let end = envelope_time(response, 1e-6 * response.constant().abs());
    let mut scan = response.extrema_from(0.0);
    while !scan.finished() && scan.time() < end {
        if let Some(extremum) = scan.advance() {
            if (extremum.value - level) * before < 0.0 {
                return Some(crossing(from, extremum.time_s, side));
            }
            from = extremum.time_s;
        }
    }
    (from < end && side(end) * before < 0.0).then(|| crossing(from, end, side))
}
