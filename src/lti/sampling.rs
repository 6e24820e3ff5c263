//! Points to draw a response with.

use super::Response;

const MOST_POINTS: usize = 4000;
/// More swings than this are drawn as a band.
const MOST_SWINGS: usize = 1000;
const STRETCHES: usize = 1000;
/// How often the tolerance is widened.
const MOST_ROUNDS: usize = 20;

/// See [`Response::samples`].
pub(super) fn samples(response: &Response, end_s: f64, tolerance: f64) -> Vec<(f64, f64)> {
    let start = (0.0, response.at(0.0));
    if !(end_s > 0.0 && end_s.is_finite()) {
        return vec![start];
    }
    let end = (end_s, response.at(end_s));
    let Some(knots) = knots(response, start, end) else {
        return band(response, start, end);
    };
    let peak = knots.iter().map(|knot| knot.1.abs()).fold(0.0, f64::max);
    let mut allowed = tolerance.abs().max(1e-9) * peak;
    for _ in 0..MOST_ROUNDS {
        match curve(response, &knots, allowed) {
            Ok(points) => return points,
            // Half the points need four times the tolerance.
            Err(drawn) => allowed *= (1.05 * (end_s / drawn).powi(2)).clamp(1.2, 4.0),
        }
    }
    // What is left is rounding, in terms far larger than the response.
    band(response, start, end)
}

/// See [`Response::turning_points`].
pub(super) fn turning_points(response: &Response, end_s: f64) -> Vec<(f64, f64)> {
    let start = (0.0, response.at(0.0));
    if !(end_s > 0.0 && end_s.is_finite()) {
        return vec![start];
    }
    let end = (end_s, response.at(end_s));
    knots(response, start, end).unwrap_or_else(|| band(response, start, end))
}

/// Start, extrema and end; `None` when there are too many of them.
fn knots(response: &Response, start: (f64, f64), end: (f64, f64)) -> Option<Vec<(f64, f64)>> {
    let mut knots = vec![start];
    let mut scan = response.extrema_from(0.0);
    while !scan.finished() && scan.time() < end.0 {
        if let Some(extremum) = scan.advance().filter(|extremum| extremum.time_s < end.0) {
            knots.push((extremum.time_s, extremum.value));
        }
        if knots.len() > MOST_SWINGS {
            return None;
        }
    }
    if scan.gave_up() {
        return None;
    }
    knots.push(end);
    Some(knots)
}

/// Between the knots, steps as long as the chord stays within `allowed`; or the time at which the points ran out.
fn curve(response: &Response, knots: &[(f64, f64)], allowed: f64) -> Result<Vec<(f64, f64)>, f64> {
    let mut points = vec![knots[0]];
    for pair in knots.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let shortest = 1e-7 * (to.0 - from.0);
        let mut step = to.0 - from.0;
        while from.0 < to.0 {
            let mut next = to;
            if from.0 + step < to.0 {
                let t = from.0 + step;
                next = (t, response.at(t));
            }
            while next.0 - from.0 > shortest && !chord_is_close(response, from, next, allowed) {
                let t = from.0 + 0.7 * (next.0 - from.0);
                next = (t, response.at(t));
            }
            step = 1.5 * (next.0 - from.0);
            if next.0 <= from.0 {
                next = to;
            }
            points.push(next);
            from = next;
            if points.len() > MOST_POINTS {
                return Err(from.0);
            }
        }
    }
    Ok(points)
}

fn chord_is_close(response: &Response, a: (f64, f64), b: (f64, f64), allowed: f64) -> bool {
    [0.5, 0.25, 0.75, 0.125, 0.875].into_iter().all(|share| {
        let chord = a.1 + share * (b.1 - a.1);
        (response.at(a.0 + share * (b.0 - a.0)) - chord).abs() <= 0.9 * allowed
    })
}

/// The highest and lowest point near the start of each stretch, in time order.
fn band(response: &Response, start: (f64, f64), end: (f64, f64)) -> Vec<(f64, f64)> {
    let mut points = vec![start];
    let width = end.0 / STRETCHES as f64;
    for k in 0..STRETCHES {
        let (from, to) = (k as f64 * width, (k + 1) as f64 * width);
        let mut scan = response.extrema_from(from);
        let mut found = 0;
        // Two extrema in a row are a highest and a lowest point; 200 steps are four turns of the fastest oscillation.
        for _ in 0..200 {
            if found == 2 || scan.finished() || scan.time() >= to {
                break;
            }
            if let Some(extremum) =
                scan.advance().filter(|e| e.time_s > from && e.time_s < to && e.time_s < end.0)
            {
                points.push((extremum.time_s, extremum.value));
                found += 1;
            }
        }
        if found == 0 && k > 0 {
            points.push((from, response.at(from)));
        }
    }
    points.push(end);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lti::InputKind::{self, Impulse, Step};
    use crate::lti::tests::{HANGING, UPRIGHT, tf};

    /// Straight lines stay within `tolerance` of the peak; `at_most` points are enough for that.
    #[track_caller]
    fn check(what: &str, g: (&str, &str), kind: InputKind, end_s: f64, tolerance: f64, at_most: usize) {
        let response = Response::new(&tf(g.0, g.1), kind).unwrap();
        let points = samples(&response, end_s, tolerance);
        assert!(points.len() <= at_most, "{what}: {} points", points.len());
        assert_eq!(points[0], (0.0, response.at(0.0)), "{what}");
        assert_eq!(points[points.len() - 1], (end_s, response.at(end_s)), "{what}");
        let peak = points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
        for pair in points.windows(2) {
            let [(a, ya), (b, yb)] = [pair[0], pair[1]];
            assert!(a < b, "{what}: {a} s, {b} s");
            for k in 1..10 {
                let share = f64::from(k) / 10.0;
                let miss = (response.at(a + share * (b - a)) - ya - share * (yb - ya)).abs();
                assert!(miss <= tolerance * peak, "{what}: off by {miss} between {a} s and {b} s");
            }
        }
        let mut scan = response.extrema_from(0.0);
        while !scan.finished() && scan.time() < end_s {
            if let Some(extremum) = scan.advance().filter(|extremum| extremum.time_s < end_s) {
                assert!(
                    points.contains(&(extremum.time_s, extremum.value)),
                    "{what}: {extremum:?} is missing"
                );
            }
        }
        assert_eq!(points, samples(&response, end_s, tolerance), "{what}: the same again");
    }

    #[test]
    fn chords_follow_the_curve_with_few_points() {
        check("first order", ("1", "1 1"), Step, 5.0, 1e-3, 40);
        check("first order, finely", ("1", "1 1"), Step, 5.0, 1e-5, 400);
        check("stiff", ("1e6", "1 1000001 1e6"), Impulse, 5.0, 1e-3, 60);
        check("hanging, 10 s", HANGING, Impulse, 10.0, 1e-3, 1200);
        check("hanging, whole axis", HANGING, Impulse, 200.0, 5e-3, MOST_POINTS);
        check("upright", UPRIGHT, Impulse, 1.0, 1e-3, 60);
        check("ramp", ("1", "1 0"), Step, 10.0, 1e-3, 2);
        check("zero", ("0", "1 1"), Step, 10.0, 1e-3, 2);
        check("resonance", ("1", "1 0 2 0 1"), Impulse, 60.0, 2e-3, MOST_POINTS);
    }

    #[test]
    fn never_more_points_than_allowed() {
        let response = |den: &str| Response::new(&tf("1", den), Impulse).unwrap();
        let tight = samples(&response("1 0.04 31.2"), 200.0, 1e-9);
        assert!((2000..=MOST_POINTS).contains(&tight.len()), "{}", tight.len());
        // A million swings: a band, as high as the curve everywhere.
        let ringing = response("1 2e-6 1");
        let points = samples(&ringing, 1e6 * std::f64::consts::TAU, 1e-3);
        assert!((2 * STRETCHES..=MOST_POINTS).contains(&points.len()), "{}", points.len());
        assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0));
        for stretch in points.windows(4).take(1900) {
            let most = stretch.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
            assert!(most > 0.98 * ringing.moving_envelope(stretch[3].0), "{stretch:?}");
        }
        // Pairs 1e-15 apart, one of which grows: how it grows is seen after 1e15 swings, and nobody waits for that.
        let together = "1 0 2.999999999999999999999999999998 0 3.000000000000000000000000000000000000000000000000000000000001 0 1.000000000000000000000000000002000000000000000000000000000001";
        assert!(Response::new(&tf("1", together), Step).is_err());
        assert_eq!(samples(&ringing, 0.0, 1e-3).len(), 1);
        assert_eq!(samples(&ringing, f64::NAN, 1e-3).len(), 1);
    }
}
