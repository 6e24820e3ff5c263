use super::edit::{Edit, ParameterEdit};
use super::{Derivation, Mistake, MistakeKind};
use crate::algebra::Rational;

/// Units of what is easily taken for its double or its half: lengths and diameters.
const LENGTHS: [&str; 3] = ["m", "cm", "mm"];

/// Powers of ten by which a parameter is off when its unit, or its decimal point, is.
const SHIFTS: [isize; 6] = [1, -1, 2, -2, 3, -3];

/// Two parameters of the same unit taken for one another; a length taken twice or half as long; a value that is often used
/// wrongly; a value off by a power of ten.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let mut all = Vec::new();
    let mut add = |kind, words: String, change: String, edit: ParameterEdit| {
        all.push(Mistake { kind, words, change, places: Vec::new(), edit: Edit::Parameter(edit) });
    };
    let used: Vec<(&String, &Rational, &str)> = of
        .model
        .parameters
        .iter()
        .filter(|name| is_used(of, name))
        .filter_map(|name| {
            Some((name, of.parameters.get(name)?, of.units.get(name).map_or("", |unit| unit.trim())))
        })
        .collect();
    for (index, (first, value, unit)) in used.iter().enumerate() {
        let same = |(_, other, its_unit): &&(&String, &Rational, &str)| its_unit == unit && other != value;
        for (second, _, _) in used[index + 1..].iter().filter(same) {
            add(
                MistakeKind::ParametersSwapped,
                format!("`{first}` and `{second}` are taken for one another"),
                format!("{first} <-> {second}"),
                ParameterEdit::Swapped((*first).clone(), (*second).clone()),
            );
        }
    }
    let two = || Rational::from(2);
    for (name, _, _) in used.iter().filter(|(_, _, unit)| LENGTHS.contains(unit)) {
        let scaled = |factor| ParameterEdit::Scaled((*name).clone(), factor);
        add(
            MistakeKind::ParameterDoubled,
            format!("`{name}` is taken twice as large"),
            format!("{name} -> 2*{name}"),
            scaled(two()),
        );
        add(
            MistakeKind::ParameterHalved,
            format!("`{name}` is taken half as large"),
            format!("{name} -> {name}/2"),
            scaled(Rational::ONE / two()),
        );
    }
    for (name, _, _) in &used {
        for (text, value) in of.mistaken.get(*name).into_iter().flatten() {
            add(
                MistakeKind::ParameterMistaken,
                format!("`{name}` is taken as {text}"),
                format!("{name} -> {text}"),
                ParameterEdit::Set((*name).clone(), value.clone()),
            );
        }
    }
    for (name, value, _) in used.iter().filter(|(_, value, _)| !value.is_zero()) {
        for shift in SHIFTS {
            let factor = Rational::from(10).pow(shift);
            let (much, change) = match shift {
                1.. => ("large", format!("{name} -> {}*{name}", 10u32.pow(shift.unsigned_abs() as u32))),
                _ => ("small", format!("{name} -> {name}/{}", 10u32.pow(shift.unsigned_abs() as u32))),
            };
            let _ = value;
            add(
                MistakeKind::ParameterScaled,
                format!(
                    "`{name}` is {} times too {much} (a unit, or the decimal point)",
                    10u32.pow(shift.unsigned_abs() as u32)
                ),
                change,
                ParameterEdit::Scaled((*name).clone(), factor),
            );
        }
    }
    all
}

/// Whether anything depends on it: an equation, or the place of rest.
fn is_used(of: &Derivation, name: &str) -> bool {
    let sides = of.equations().flat_map(|(_, equation)| [&equation.left, &equation.right]);
    let mut symbols = sides.flat_map(crate::algebra::Expression::symbols);
    symbols.any(|symbol| symbol.name == name || of.model.derived.depends(&symbol.name, name))
        || of.rest.depends_on(&of.model, name)
}
