use super::super::{Equilibrium, Exact, Model};

/// A coordinate or input that is neither 0 nor a multiple of π at rest, its letter and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct LetterAtRest {
    pub name: String,
    /// `h_0`
    pub letter: String,
    pub value: Exact,
}

/// Every value at rest that has a letter of its own, in the order of the model.
pub fn letters_at_rest(model: &Model, at: &Equilibrium) -> Vec<LetterAtRest> {
    let names = model.coordinates.iter().map(|c| &c.name).chain(&model.inputs);
    let with_letter = names.filter_map(|name| match at.value(name, 0)? {
        Exact::Known { rational, .. } if rational.is_zero() => None,
        value => Some(LetterAtRest { name: name.clone(), letter: letter_of(model, name), value }),
    });
    with_letter.collect()
}

/// Every value at rest that is 0 or a multiple of π, under the name it would have as a letter.
pub fn known_at_rest(model: &Model, at: &Equilibrium) -> Vec<LetterAtRest> {
    let names = model.coordinates.iter().map(|c| &c.name).chain(&model.inputs);
    let known = names.filter_map(|name| match at.value(name, 0)? {
        value @ Exact::Known { .. } => {
            let Exact::Known { rational, .. } = &value else { return None };
            let letter = letter_of(model, name);
            rational.is_zero().then(|| LetterAtRest { name: name.clone(), letter, value })
        }
        _ => None,
    });
    known.collect()
}

/// `h_0`, or another index where the lab has that name already, if only without `_`.
pub(super) fn letter_of(model: &Model, name: &str) -> String {
    let plain = |name: &str| name.replace('_', "");
    let taken = |letter: &str| {
        let letter = plain(letter);
        model.parameters.iter().any(|p| plain(p) == letter)
            || model.coordinates.iter().any(|c| plain(&c.name) == letter)
            || model.inputs.iter().any(|i| plain(i) == letter)
    };
    let endings = ["_0", "_e", "_rest", "_at_rest"];
    let free = endings.iter().map(|end| format!("{name}{end}")).find(|letter| !taken(letter));
    free.unwrap_or_else(|| format!("{name}__0"))
}
