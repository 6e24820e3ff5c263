use super::{Derivation, Mistake, MistakeKind};
use crate::algebra::{Polynomial, Rational};
use crate::lti::TransferFunction;

/// Another point, input or output; and what can happen to a transfer function once it is right.
pub(super) fn mistakes(of: &Derivation<'_>) -> Vec<(Mistake, TransferFunction)> {
    let mut all = Vec::new();
    let mut add = |kind, words: String, change: String, function: Option<TransferFunction>| {
        all.extend(function.map(|function| (Mistake { kind, words, change, places: Vec::new() }, function)));
    };
    for (title, at) in of.others {
        add(
            MistakeKind::OtherPoint,
            format!("it is linearized at another operating point ({title})"),
            format!("at: {title}"),
            Derivation { at, ..*of }.result(),
        );
    }
    for name in of.model.coordinates.iter().map(|c| c.name.as_str()).filter(|name| *name != of.output) {
        add(
            MistakeKind::OtherOutput,
            format!("`{name}` is taken as the output instead of `{}`", of.output),
            format!("output: {name}"),
            Derivation { output: name, ..*of }.result(),
        );
    }
    for name in of.model.inputs.iter().map(String::as_str).filter(|name| *name != of.input) {
        add(
            MistakeKind::OtherInput,
            format!("`{name}` is taken as the input instead of `{}`", of.input),
            format!("input: {name}"),
            Derivation { input: name, ..*of }.result(),
        );
    }
    let Some(TransferFunction { num, den }) = of.result() else { return all };
    add(
        MistakeKind::WholeSign,
        "the sign of the whole function is turned".to_owned(),
        "G -> -G".to_owned(),
        TransferFunction::new(-&num, den.clone()),
    );
    add(
        MistakeKind::Inverted,
        "numerator and denominator have changed places".to_owned(),
        "G -> 1/G".to_owned(),
        TransferFunction::new(den.clone(), num.clone()),
    );
    // Only where something stands at the origin can it be cancelled wrongly.
    if num.trailing_zeros() + den.trailing_zeros() > 0 {
        let s = Polynomial::monomial(Rational::ONE, 1);
        add(
            MistakeKind::Origin,
            "there is one factor `s` too many (cancelled in the denominator only)".to_owned(),
            "G -> s*G".to_owned(),
            TransferFunction::new(&num * &s, den.clone()),
        );
        add(
            MistakeKind::Origin,
            "there is one factor `s` too few (cancelled in the numerator only)".to_owned(),
            "G -> G/s".to_owned(),
            TransferFunction::new(num, &den * &s),
        );
    }
    all
}
