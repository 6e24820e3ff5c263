//! The linear model against the nonlinear equations, under ever smaller pushes.

use super::Agreement;
use crate::algebra::{Rational, significant};
use crate::lab::OperatingPointDefinition;
use crate::lti::Pole;
use crate::model::{Departure, Model, SmallSignal};
use crate::reference::OperatingPointReference;
use std::collections::BTreeMap;

/// A tangent leaves an error that is of second order in the push; higher where the second derivatives happen to vanish.
const LEAST_ORDER: f64 = 1.9;
/// The departure must go on falling to 1e-6 of the response.
const DIGITS_WANTED: f64 = 6.0;
/// Pushes are made smaller by this.
const STEP: f64 = 4.0;
const MOST_PUSHES: usize = 14;
/// Relative departures with which the fall begins: no longer large, far above rounding.
const BEGIN: std::ops::Range<f64> = 1e-4..5e-2;
/// A departure that is less than this at every push is rounding.
const ROUNDING: f64 = 1e-8;

/// The error of the linear model must fall with the square of the push, down to rounding.
pub(super) fn small_signal_route(
    name: &str,
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &OperatingPointDefinition,
    point: &OperatingPointReference,
) -> Option<Agreement> {
    let main = point.main();
    // A transfer function given as such is linear by itself.
    if main.linearization.states.is_empty() || !model.is_printed() {
        return None;
    }
    let drawn_s = at.comparison.as_ref().map(|comparison| comparison.horizon_s);
    let horizon_s = horizon_s(&main.internal_poles).min(drawn_s.unwrap_or(f64::INFINITY));
    let found = SmallSignal::new(model, parameters, &at.at, &at.output, &main.linearization, horizon_s)
        .map_or_else(
            |error| Found::nothing(error.to_string()),
            |signal| {
                let parting = point.comparison.as_ref().and_then(|comparison| comparison.parting_push);
                measure(&signal, parting)
            },
        );
    Some(Agreement {
        what: format!("{name} linear model"),
        routes: "linearization against the nonlinear equations under ever smaller pushes",
        digits: found.digits,
        wanted: DIGITS_WANTED,
        note: found.note,
    })
}

struct Found {
    digits: f64,
    note: String,
}

impl Found {
    fn nothing(note: String) -> Self {
        Self { digits: 0.0, note }
    }
}

/// Long enough for the slow poles to show, short enough to be integrated at once and not to run away.
fn horizon_s(poles: &[Pole]) -> f64 {
    let speeds = || poles.iter().map(|p| p.re.hypot(p.im)).filter(|speed| *speed > 0.0);
    let (slowest, fastest) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max));
    if fastest == 0.0 {
        return 1.0;
    }
    let growth = poles.iter().map(|p| p.re).fold(0.0, f64::max);
    let wanted = (3.0 / slowest).clamp(10.0 / fastest, 60.0 / fastest);
    if growth > 0.0 { wanted.min(3.0 / growth) } else { wanted }
}

/// The order with which the error falls, and how far it falls.
fn measure(signal: &SmallSignal, parting_push: Option<f64>) -> Found {
    let peak = signal.linear_peak();
    let unit_push = if peak > 0.0 { 1.0 / peak } else { 1.0 };
    let Some(first) = begin(signal, parting_push.map_or(unit_push, |push| push / 10.0)) else {
        return Found::nothing("the equations cannot be followed after any push".to_owned());
    };
    if first.relative < ROUNDING {
        let note = if peak > 0.0 {
            "the equations are linear: equal to rounding at every push"
        } else {
            "neither moves at any push"
        };
        return Found { digits: digits(first.relative), note: note.to_owned() };
    }
    let mut fall = vec![first];
    while fall.len() < MOST_PUSHES {
        let last = fall[fall.len() - 1];
        match signal.departure(last.push / STEP) {
            // Down to where rounding keeps it from falling.
            Some(next) if next.relative < 0.8 * last.relative => fall.push(next),
            _ => break,
        }
    }
    let last = fall[fall.len() - 1];
    let Some(order) = order(&fall) else {
        return Found::nothing(format!(
            "the departure of {} at a push of {} does not fall with the push",
            significant(last.relative, 2),
            significant(last.push, 2)
        ));
    };
    let note = format!("error falls as push^{order:.2} down to a push of {}", significant(last.push, 2));
    if order < LEAST_ORDER {
        return Found::nothing(format!("{note}, where a tangent's falls as push^2"));
    }
    Found { digits: digits(last.relative), note }
}

/// A push whose departure lies in [`BEGIN`], or the largest one that can be followed when none departs that far.
fn begin(signal: &SmallSignal, push: f64) -> Option<Departure> {
    let mut push = push;
    let mut seen = signal.departure(push);
    for _ in 0..12 {
        if seen.is_some_and(|departure| departure.relative < BEGIN.end) {
            break;
        }
        push /= 10.0;
        seen = signal.departure(push);
    }
    let mut best = seen?;
    for _ in 0..6 {
        if best.relative >= BEGIN.start {
            break;
        }
        match signal.departure(best.push * 10.0) {
            Some(larger) if larger.relative < BEGIN.end => best = larger,
            _ => break,
        }
    }
    Some(best)
}

/// The median of the orders between neighbours, of the error itself: one more than that of the relative departure.
fn order(fall: &[Departure]) -> Option<f64> {
    let mut orders: Vec<f64> =
        fall.windows(2).map(|pair| 1.0 + (pair[0].relative / pair[1].relative).log(STEP)).collect();
    orders.sort_by(f64::total_cmp);
    orders.get(orders.len() / 2).copied()
}

fn digits(relative: f64) -> f64 {
    if relative == 0.0 { f64::INFINITY } else { -relative.log10() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::lti::roots;
    use crate::model::{Coordinate, Equilibrium, Linearization, linearize};

    /// One coordinate `y`, driven by `u`, with parameters k = 2 and, at rest, y = `rest.0`, u = `rest.1`.
    fn seen(equation: &str, rest: (&str, &str), spoil: impl Fn(&mut Linearization)) -> Found {
        let coordinate = Coordinate { name: "y".into(), unit: String::new(), description: String::new() };
        let model = Model::new(vec![coordinate], vec!["u".into()], vec!["k".into()], &[equation]).unwrap();
        let parameters = BTreeMap::from([("k".to_owned(), parse_decimal("2").unwrap())]);
        let pairs = [("y".to_owned(), rest.0.to_owned()), ("u".to_owned(), rest.1.to_owned())];
        let at = Equilibrium::parse(&model, &parameters, &pairs).unwrap();
        let mut linear = linearize(&model, &parameters, &at, "u", "y").unwrap();
        let horizon_s =
            horizon_s(&roots(&linear.state_space.as_ref().unwrap().characteristic_polynomial()).unwrap());
        spoil(&mut linear);
        let signal = SmallSignal::new(&model, &parameters, &at, "y", &linear, horizon_s).unwrap();
        measure(&signal, None)
    }

    #[test]
    fn the_error_falls_with_the_square_of_the_push_or_faster() {
        #[track_caller]
        fn check(what: &str, equation: &str, rest: (&str, &str), expected: &str) {
            let found = seen(equation, rest, |_| {});
            assert!(found.note.contains(expected), "{what}: {}", found.note);
            assert!(found.digits >= DIGITS_WANTED, "{what}: {} digits, {}", found.digits, found.note);
        }
        check("tank", "y' = u - k*sqrt(y)", ("4", "4"), "push^2.0");
        check("small tank", "y' = u - k*sqrt(y)", ("0.0001", "0.02"), "push^2.0");
        check("huge tank", "y' = u - k*sqrt(y)", ("1000000", "2000"), "push^2.0");
        check("drag", "1000*y' + k*y^2 = u", ("25", "1250"), "push^2.0");
        check("pendulum", "y'' + 0.1*y' + k*sin(y) = u", ("0", "0"), "push^3.0");
        check("pendulum aside", "y'' + 0.1*y' + k*sin(y) = u", ("pi/6", "1"), "push^2.0");
        check("pendulum upright", "y'' + 0.1*y' + k*sin(y) = u", ("pi", "0"), "push^3.0");
        check("hard spring", "y'' + 0.1*y' + k*y + y^5 = u", ("0", "0"), "push^5.0");
        check("linear", "y'' + 0.1*y' + k*y = u", ("0", "0"), "linear: equal to rounding");
        check("linear, away from zero", "y'' + 0.1*y' + k*y = u", ("3", "6"), "linear: equal to rounding");
        check("integrator", "y'' = k*u", ("0", "0"), "linear: equal to rounding");
        check("output that nothing moves", "y' = u*y", ("0", "0"), "neither moves");
    }

    #[test]
    fn a_wrong_linear_model_is_noticed() {
        let found = seen("y'' + 0.1*y' + k*sin(y) = u", ("pi/6", "1"), |linear| {
            let entry = &mut linear.state_space.as_mut().unwrap().a.rows[1][0];
            *entry = &*entry * parse_decimal("1.0001").unwrap();
        });
        assert!(found.digits < DIGITS_WANTED, "{} digits, {}", found.digits, found.note);
        // A corner has no tangent: the mean of both slopes is off by as much as the push.
        let found = seen("y' + k*y + abs(y - 1)^1.5 = u", ("1", "2"), |_| {});
        assert!(found.note.contains("where a tangent's falls as push^2"), "{}", found.note);
    }
}
