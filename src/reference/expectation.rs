use super::*;
use crate::algebra::{significant, to_f64};
use crate::lab::{Expectation, ExpectedValue};
use crate::lti::{Features, Limit, Pole, TransferFunction};

/// An expectation of the lab that the computed reference does not meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    pub path: String,
    /// In words: what the lab states, what was computed.
    pub message: String,
    pub span: crate::source::Span,
}

/// Holds every stated value of the lab against the computed one; empty when all agree.
pub fn check_expectations(reference: &Reference, expectations: &[Expectation]) -> Vec<Disagreement> {
    expectations.iter().filter_map(|expectation| disagreement(reference, expectation)).collect()
}

fn disagreement(reference: &Reference, expectation: &Expectation) -> Option<Disagreement> {
    let fail =
        |message| Some(Disagreement { path: expectation.path.clone(), message, span: expectation.span });
    let Some(computed) = values_at(reference, &expectation.path) else {
        return fail(format!("`{}` is not a place in the reference", expectation.path));
    };
    if computed.len() != expectation.values.len() {
        return fail(format!(
            "`{}` has {} values, the lab states {}: computed {}",
            expectation.path,
            computed.len(),
            expectation.values.len(),
            list(&computed)
        ));
    }
    let agree = computed.iter().zip(&expectation.values).all(|(a, b)| agrees(a, b, expectation.relative));
    if agree {
        return None;
    }
    fail(format!(
        "`{}` is {} by computation, the lab states {}",
        expectation.path,
        list(&computed),
        list(&expectation.values)
    ))
}

/// Within `relative` of the stated value; a stated zero must be met to 1e-12.
fn agrees(computed: &ExpectedValue, stated: &ExpectedValue, relative: f64) -> bool {
    use ExpectedValue::*;
    let near =
        |a: f64, b: f64, scale: f64| (a - b).abs() <= if scale == 0.0 { 1e-12 } else { relative * scale };
    match (computed, stated) {
        (Number(a), Number(b)) => near(*a, *b, b.abs()),
        (Complex(a, b), Complex(c, d)) => {
            let scale = c.hypot(*d);
            near(*a, *c, scale) && near(*b, *d, scale)
        }
        (Complex(a, b), Number(c)) | (Number(c), Complex(a, b)) => *b == 0.0 && near(*a, *c, c.abs()),
        (Word(a), Word(b)) => a == b,
        _ => false,
    }
}

fn list(values: &[ExpectedValue]) -> String {
    let words: Vec<String> = values
        .iter()
        .map(|value| match value {
            ExpectedValue::Number(x) => significant(*x, 12),
            ExpectedValue::Complex(re, im) => format!(
                "{} {} {}j",
                significant(*re, 12),
                if *im < 0.0 { "-" } else { "+" },
                significant(im.abs(), 12)
            ),
            ExpectedValue::Word(word) => word.clone(),
        })
        .collect();
    format!("[{}]", words.join(", "))
}

/// What stands at `path` of the reference, named as `reference --format json` nests it.
///
/// `<model>.<operating point>.poles`, `….transfer_function.den` (monic), `….accepted[1].transfer_function.den`,
/// `….impulse.peak_value`, `….comparison.parting_push`, `<simulation>.peak_with`. `None`: no such place, or no such value.
pub fn values_at(reference: &Reference, path: &str) -> Option<Vec<ExpectedValue>> {
    let (first, rest) = path.split_once('.')?;
    if let Some(simulation) = reference.simulation(first) {
        return simulation_values(simulation, rest);
    }
    let model = reference.models.iter().find(|m| m.id == first)?;
    let (point, rest) = rest.split_once('.')?;
    let point = model.operating_points.iter().find(|p| p.id == point)?;
    if let Some(rest) = rest.strip_prefix("accepted[") {
        let (index, rest) = rest.split_once("].")?;
        return linear_values(point.accepted.get(index.parse::<usize>().ok()?)?, rest);
    }
    match rest {
        "comparison.parting_push" => numbers([point.comparison.as_ref()?.parting_push?]),
        "comparison.parting_amplitude" => numbers([point.comparison.as_ref()?.parting_amplitude?]),
        "comparison.end_linear" => ends(point, |(_, linear, _)| *linear),
        "comparison.end_nonlinear" => ends(point, |(_, _, nonlinear)| *nonlinear),
        "tangent.slope" => numbers([point.tangent.as_ref()?.slope]),
        "tangent.good_from" => numbers([point.tangent.as_ref()?.good_from?]),
        "tangent.good_to" => numbers([point.tangent.as_ref()?.good_to?]),
        "equilibrium" => numbers(point.equilibrium.iter().map(|(_, value)| *value)),
        _ => linear_values(point.main(), rest),
    }
}

/// One value a push: where the output is at the end of the comparison.
fn ends(point: &OperatingPointReference, of: impl Fn(&(f64, f64, f64)) -> f64) -> Option<Vec<ExpectedValue>> {
    let ends: Option<Vec<f64>> =
        point.comparison.as_ref()?.runs.iter().map(|run| run.1.last().map(&of)).collect();
    numbers(ends?)
}

fn linear_values(linear: &LinearReference, path: &str) -> Option<Vec<ExpectedValue>> {
    let monic: TransferFunction = linear.linearization.transfer_function.monic();
    match path {
        "transfer_function.num" => numbers(monic.num.coefficients().iter().map(to_f64)),
        "transfer_function.den" => numbers(monic.den.coefficients().iter().map(to_f64)),
        "poles" => Some(complex(&linear.poles)),
        "zeros" => Some(complex(&linear.zeros)),
        "internal_poles" => Some(complex(&linear.internal_poles)),
        "stability" => word(linear.stability.as_str()),
        "internal_stability" => word(linear.internal_stability.as_str()),
        _ => {
            let (kind, feature) = path.split_once('.')?;
            match kind {
                "equilibrium" => numbers([to_f64(linear.values.get(feature)?)]),
                "impulse" => feature_value(linear.impulse.as_ref()?, feature),
                "step" => feature_value(linear.step.as_ref()?, feature),
                _ => None,
            }
        }
    }
}

fn feature_value(response: &ResponseReference, feature: &str) -> Option<Vec<ExpectedValue>> {
    let Features {
        initial_value,
        final_value,
        shape,
        peak,
        period_s,
        damping_ratio,
        natural_frequency_rad_s,
        slowest_time_constant_s,
        settling_time_2_percent_s,
        settling_time_5_percent_s,
        overshoot_percent,
        rise_time_10_90_s,
        rise_time_0_100_s,
        ..
    } = &response.features;
    match feature {
        "initial_value" => numbers([*initial_value]),
        "final_value" => match final_value {
            Limit::Value(value) => numbers([*value]),
            unbounded => word(unbounded.as_str()),
        },
        "shape" => word(shape.as_str()),
        "peak_value" => numbers([peak.as_ref()?.value]),
        "peak_time_s" => numbers([peak.as_ref()?.time_s]),
        "period_s" => numbers([(*period_s)?]),
        "damping_ratio" => numbers([(*damping_ratio)?]),
        "natural_frequency_rad_s" => numbers([(*natural_frequency_rad_s)?]),
        "slowest_time_constant_s" => numbers([(*slowest_time_constant_s)?]),
        "settling_time_2_percent_s" => numbers([(*settling_time_2_percent_s)?]),
        "settling_time_5_percent_s" => numbers([(*settling_time_5_percent_s)?]),
        "damped_frequency_rad_s" => numbers([response.features.damped_frequency_rad_s()?]),
        "overshoot_percent" => numbers([(*overshoot_percent)?]),
        "rise_time_10_90_s" => numbers([(*rise_time_10_90_s)?]),
        "rise_time_0_100_s" => numbers([(*rise_time_0_100_s)?]),
        "dc_gain" => numbers([response.features.dc_gain?]),
        "horizon_s" => numbers([response.horizon_s]),
        _ => None,
    }
}

fn simulation_values(simulation: &SimulationReference, path: &str) -> Option<Vec<ExpectedValue>> {
    match path {
        "peak_with" => numbers([simulation.with.peak.1]),
        "peak_without" => numbers([simulation.without.peak.1]),
        "switch_times" => numbers(simulation.with.switch_times.iter().copied()),
        "end_with" => numbers([simulation.samples.last()?.2]),
        "end_without" => numbers([simulation.samples.last()?.1]),
        "end_time_s" => numbers([simulation.samples.last()?.0]),
        _ => None,
    }
}

fn numbers(values: impl IntoIterator<Item = f64>) -> Option<Vec<ExpectedValue>> {
    Some(values.into_iter().map(ExpectedValue::Number).collect())
}

fn word(text: &str) -> Option<Vec<ExpectedValue>> {
    Some(vec![ExpectedValue::Word(text.to_owned())])
}

/// Each repeated by its multiplicity.
fn complex(poles: &[Pole]) -> Vec<ExpectedValue> {
    poles
        .iter()
        .flat_map(|p| std::iter::repeat_n(ExpectedValue::Complex(p.re, p.im), p.multiplicity))
        .collect()
}
