//! Where a model rests, and how it moves away from there after the pushes of its comparison.

use super::{Agreement, digits, digits_of_agreement};
use crate::algebra::{Expression, NodeKind, Rational, to_f64};
use crate::lab::OperatingPointDefinition;
use crate::model::{Model, SmallSignal};
use crate::reference::OperatingPointReference;
use std::collections::BTreeMap;

/// Fixed steps of the second integration: at least so many, and two for each radian of the fastest pole.
const FEWEST_STEPS: usize = 4_000;
/// What is so stiff that it needs more is left out.
const MOST_STEPS: f64 = 200_000.0;

/// The equations, evaluated in floating point with everything at rest.
pub(super) fn equilibrium_route(
    name: &str,
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &OperatingPointDefinition,
) -> Agreement {
    let lookup = |name: &str, primes: u8| {
        let parameter = || parameters.get(name).filter(|_| primes == 0).map(to_f64);
        at.at.value(name, primes).map(|value| value.to_f64()).or_else(parameter)
    };
    let balance = |left: &Expression, right: &Expression| {
        let difference = left.eval_f64(&lookup).ok()? - right.eval_f64(&lookup).ok()?;
        Some(digits(difference.abs(), terms(left, &lookup) + terms(right, &lookup)))
    };
    let each = model.equations.iter().map(|equation| balance(&equation.left, &equation.right).unwrap_or(0.0));
    Agreement {
        what: format!("{name} rest"),
        routes: "exact balance of the equations against their value in floating point",
        digits: each.fold(f64::INFINITY, f64::min),
        wanted: 8.0,
        note: String::new(),
    }
}

/// Σ |term| of a sum.
fn terms(node: &Expression, lookup: &dyn Fn(&str, u8) -> Option<f64>) -> f64 {
    match &node.kind {
        NodeKind::Add(a, b) | NodeKind::Subtract(a, b) => terms(a, lookup) + terms(b, lookup),
        NodeKind::Negate(a) => terms(a, lookup),
        // What vanishes in exact numbers, sin(π) say, is of the size of its factors' rounding.
        NodeKind::Multiply(a, b) => terms(a, lookup) * terms(b, lookup),
        NodeKind::Call(..) => node.eval_f64(lookup).map_or(0.0, f64::abs).max(1e-6),
        _ => node.eval_f64(lookup).map_or(0.0, f64::abs),
    }
}

/// The curves drawn, and the push at which they part, with small fixed steps.
pub(super) fn comparison_route(
    name: &str,
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &OperatingPointDefinition,
    point: &OperatingPointReference,
) -> Option<Agreement> {
    let found = point.comparison.as_ref()?;
    let drawn = &found.asked;
    let linearization = &point.main().linearization;
    let signal =
        SmallSignal::new(model, parameters, &at.at, &at.output, linearization, drawn.horizon_s).ok()?;
    let fastest = point.main().internal_poles.iter().map(|p| p.re.hypot(p.im)).fold(0.0, f64::max);
    let wanted = 2.0 * fastest * drawn.horizon_s;
    if wanted > MOST_STEPS {
        return None;
    }
    let steps = FEWEST_STEPS * ((wanted / FEWEST_STEPS as f64).ceil() as usize).max(1);
    let mut least = f64::INFINITY;
    for (push, samples) in &found.runs {
        let second = signal.in_fixed_steps(*push, steps);
        let nearest = |t: f64| {
            let nth = (t / drawn.horizon_s * steps as f64).round();
            let on_a_step = (t - nth / steps as f64 * drawn.horizon_s).abs() <= 1e-9 * drawn.horizon_s;
            second.get(nth as usize).copied().filter(|_| on_a_step)
        };
        let pairs: Vec<(f64, f64)> =
            samples.iter().filter_map(|&(t, _, nonlinear)| Some((nonlinear, nearest(t)?))).collect();
        least = least.min(if pairs.len() < 2 { 0.0 } else { digits_of_agreement(pairs.into_iter()) });
    }
    let mut note = format!("{} pushes", found.runs.len());
    if let Some(parting) = found.parting_push {
        let departure = signal.fixed_step_departure(parting, steps);
        least = least.min(digits((departure - drawn.departure).abs(), drawn.departure));
        note.push_str(" and the parting push");
    }
    Some(Agreement {
        what: format!("{name} comparison"),
        routes: "steps of controlled error against small fixed steps",
        digits: least,
        wanted: 2.5,
        note,
    })
}
