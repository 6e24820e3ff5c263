//! Transfer functions, poles, zeros, stability, responses.

use super::{Agreement, digits_of_agreement, eigenvalues};
use crate::lti::{InputKind, Pole, Stability, matrix_exponential_response};
use crate::reference::OperatingPointReference;

pub(super) fn linear_routes(name: &str, point: &OperatingPointReference) -> Vec<Agreement> {
    let main = point.main();
    let mut agreements: Vec<Agreement> = transfer_functions(name, point).into_iter().collect();
    let linearization = &main.linearization;
    let g = &linearization.transfer_function;
    for (what, routes, found, poles) in [
        (
            "poles of the whole state",
            "roots of the characteristic polynomial against eigenvalues of A",
            // Of an improper transfer function there is no A.
            match &linearization.state_space {
                Some(space) => eigenvalues::of_matrix(&space.a),
                None => eigenvalues::of_polynomial(&linearization.uncancelled.den),
            },
            &main.internal_poles,
        ),
        (
            "poles",
            "roots of the denominator against eigenvalues of its companion matrix",
            eigenvalues::of_polynomial(&g.den),
            &main.poles,
        ),
        (
            "zeros",
            "roots of the numerator against eigenvalues of its companion matrix",
            if g.num.is_zero() { Some(Vec::new()) } else { eigenvalues::of_polynomial(&g.num) },
            &main.zeros,
        ),
    ] {
        agreements.push(Agreement {
            what: format!("{name} {what}"),
            routes,
            digits: eigenvalues::digits_with(found, poles),
            wanted: eigenvalues::wanted(poles),
            note: String::new(),
        });
    }
    for (what, poles, stability) in [
        ("stability", &main.poles, main.stability),
        ("stability of the whole state", &main.internal_poles, main.internal_stability),
    ] {
        agreements.push(Agreement::exact(
            format!("{name} {what}"),
            "exact count of right half-plane roots against the signs of the poles",
            stability_by_poles(poles).is_none_or(|s| s == stability),
        ));
    }
    for (what, kind, response) in [
        ("impulse response", InputKind::Impulse, &main.impulse),
        ("step response", InputKind::Step, &main.step),
    ] {
        let Some(response) = response else { continue };
        let times: Vec<f64> = (1..=40).map(|i| response.horizon_s * f64::from(i) / 40.0).collect();
        let second = matrix_exponential_response(g, kind, &times).unwrap_or_default();
        let digits = match second.len() {
            0 => 0.0,
            _ => digits_of_agreement(times.iter().zip(second).map(|(t, y)| (response.response.at(*t), y))),
        };
        agreements.push(Agreement {
            what: format!("{name} {what}"),
            routes: "partial fractions against matrix exponential",
            digits,
            wanted: 8.0,
            note: String::new(),
        });
    }
    agreements
}

/// For every accepted choice of the parameters; of an improper transfer function there is no state space.
fn transfer_functions(name: &str, point: &OperatingPointReference) -> Option<Agreement> {
    point.main().linearization.state_space.as_ref()?;
    let differing = point.accepted.iter().find(|linear| {
        let linearization = &linear.linearization;
        let space = linearization.state_space.as_ref();
        !space.is_some_and(|space| space.transfer_function().equals(&linearization.transfer_function))
    });
    let all = Agreement::exact(
        format!("{name} transfer function"),
        "elimination against state space, in exact fractions",
        differing.is_none(),
    );
    let choice = |differs: &[(String, String, _)]| {
        let each: Vec<String> = differs.iter().map(|(name, text, _)| format!("{name} = {text}")).collect();
        each.join(", ")
    };
    let note = match (differing, point.accepted.len()) {
        (Some(linear), _) if !linear.differs.is_empty() => format!("for {}", choice(&linear.differs)),
        (None, others @ 2..) => format!("also for {} other accepted choices of parameters", others - 1),
        _ => String::new(),
    };
    Some(Agreement { note, ..all })
}

/// `None` when a pole is too near the axis for its error bound to tell the side.
fn stability_by_poles(poles: &[Pole]) -> Option<Stability> {
    // Zero exactly: on the axis.
    let on_axis = |p: &&Pole| p.re == 0.0;
    if poles.iter().any(|p| p.re > p.error_bound) || poles.iter().filter(on_axis).any(|p| p.multiplicity > 1)
    {
        return Some(Stability::Unstable);
    }
    if poles.iter().any(|p| p.re != 0.0 && p.re.abs() <= p.error_bound) {
        return None;
    }
    let marginal = poles.iter().any(|p| on_axis(&p));
    Some(if marginal { Stability::MarginallyStable } else { Stability::AsymptoticallyStable })
}
