use super::edit::{Edit, WholeEdit};
use super::{Derivation, Mistake, MistakeKind};

/// Another point, input or output; and what can happen to a transfer function once it is right.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let mut all = Vec::new();
    let mut add = |kind, words: String, change: String, edit: Edit| {
        all.push(Mistake { kind, words, change, places: Vec::new(), edit });
    };
    let mut listed = vec![of.at()];
    for (index, (title, other)) in of.others.iter().enumerate() {
        // Another input or output at the same place, or a place already listed.
        let place = other.at(&of.model, &of.parameters).ok();
        if place.is_none() || listed.contains(&place) {
            continue;
        }
        listed.push(place);
        add(
            MistakeKind::OtherPoint,
            format!("it is linearized at another operating point ({title})"),
            format!("at: {title}"),
            Edit::Point(index),
        );
    }
    let seen = of.model.coordinates.iter().filter(|_| of.model.is_printed());
    for name in seen.map(|c| &c.name).filter(|name| **name != of.output) {
        add(
            MistakeKind::OtherOutput,
            format!("`{name}` is taken as the output instead of `{}`", of.output),
            format!("output: {name}"),
            Edit::Output(name.clone()),
        );
    }
    for name in of.model.inputs.iter().filter(|name| **name != of.input) {
        add(
            MistakeKind::OtherInput,
            format!("`{name}` is taken as the input instead of `{}`", of.input),
            format!("input: {name}"),
            Edit::Input(name.clone()),
        );
    }
    let Some(right) = of.function(&[]) else { return all };
    let (short, shared) = right.cancelled();
    add(
        MistakeKind::WholeSign,
        "the sign of the whole function is turned".to_owned(),
        "G -> -G".to_owned(),
        Edit::Whole(WholeEdit::Negated),
    );
    add(
        MistakeKind::Inverted,
        "numerator and denominator have changed places".to_owned(),
        "G -> 1/G".to_owned(),
        Edit::Whole(WholeEdit::Inverted),
    );
    // Only where something stands at the origin can it be cancelled wrongly.
    if right.num.trailing_zeros() + right.den.trailing_zeros() > 0 {
        add(
            MistakeKind::Origin,
            "there is one factor `s` too many (cancelled in the denominator only)".to_owned(),
            "G -> s*G".to_owned(),
            Edit::Whole(WholeEdit::TimesS),
        );
        add(
            MistakeKind::Origin,
            "there is one factor `s` too few (cancelled in the numerator only)".to_owned(),
            "G -> G/s".to_owned(),
            Edit::Whole(WholeEdit::OverS),
        );
    }
    let (zeros, poles) = (short.num.trailing_zeros(), short.den.trailing_zeros());
    if zeros + poles > 0 {
        let part = if zeros > 0 { "denominator" } else { "numerator" };
        add(
            MistakeKind::Cancelled,
            format!("`s` is cancelled although the {part} has a term without it, which is lost"),
            "s cancelled, and a constant lost".to_owned(),
            Edit::Whole(WholeEdit::Truncated),
        );
    }
    if shared.degree() > shared.trailing_zeros() {
        for (in_denominator, done, left) in
            [(true, "numerator", "denominator"), (false, "denominator", "numerator")]
        {
            add(
                MistakeKind::Cancelled,
                format!("the common factor is cancelled in the {done} only, and left in the {left}"),
                format!("common factor left in the {left}"),
                Edit::Whole(WholeEdit::SharedLeft { in_denominator }),
            );
        }
    }
    all
}
