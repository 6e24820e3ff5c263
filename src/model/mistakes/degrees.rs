use super::edit::{Edit, WholeEdit};
use super::{Derivation, Mistake, MistakeKind};
use crate::algebra::{Rational, from_f64, significant};
use crate::model::Exact;

/// Degrees for radians: of the output, of the input, and of the angles at rest.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let mut all = Vec::new();
    let half_turn = from_f64(180.0 / std::f64::consts::PI).unwrap_or(Rational::ONE);
    let mut whole = |words: String, change: String, factor: Rational| {
        all.push(Mistake {
            kind: MistakeKind::Degrees,
            words,
            change,
            places: Vec::new(),
            edit: Edit::Whole(WholeEdit::Scaled(factor)),
        });
    };
    if is_angle(&of.output_unit) {
        let name = &of.output;
        whole(
            format!("the output `{name}` is in degrees instead of radians"),
            format!("{name} in degrees"),
            half_turn.clone(),
        );
    }
    if is_angle(&of.input_unit) {
        let name = &of.input;
        whole(
            format!("the input `{name}` is in degrees instead of radians"),
            format!("{name} in degrees"),
            Rational::ONE / half_turn,
        );
    }
    let Some(at) = of.at() else { return all };
    let angles = of.model.coordinates.iter().filter(|coordinate| is_angle(&coordinate.unit));
    for name in angles.map(|coordinate| &coordinate.name) {
        let Some(degrees) = at.values.get(name).filter(|value| !value.is_zero()).and_then(in_degrees) else {
            continue;
        };
        let shown = significant(degrees.to_f64(), 4);
        all.push(Mistake {
            kind: MistakeKind::Degrees,
            words: format!(
                "the operating point `{name}` = {shown} degrees is taken as {shown} radians (a calculator in the wrong mode)"
            ),
            change: format!("at: {name} = {shown}"),
            places: Vec::new(),
            edit: Edit::Rest(name.clone(), degrees),
        });
    }
    all
}

fn is_angle(unit: &str) -> bool {
    ["rad", "radian", "radians"].contains(&unit.trim())
}

fn in_degrees(value: &Exact) -> Option<Exact> {
    match value {
        Exact::Known { rational, pi } if rational.is_zero() => {
            Some(Exact::rational(pi * Rational::from(180)))
        }
        other => from_f64(other.to_f64().to_degrees()).map(Exact::rational),
    }
}
