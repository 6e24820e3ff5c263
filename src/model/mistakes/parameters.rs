use super::{Derivation, Mistake, MistakeKind};
use crate::algebra::Rational;
use crate::lti::TransferFunction;
use std::collections::BTreeMap;

/// Units of what is easily taken for its double or its half: lengths and diameters.
const LENGTHS: [&str; 3] = ["m", "cm", "mm"];

/// Two parameters of the same unit taken for one another; a length taken twice or half as long.
pub(super) fn mistakes(of: &Derivation<'_>) -> Vec<(Mistake, TransferFunction)> {
    let mut all = Vec::new();
    let mut add = |mistake: Mistake, parameters: &BTreeMap<String, Rational>| {
        let result = Derivation { parameters, ..*of }.result();
        all.extend(result.map(|function| (mistake, function)));
    };
    let used: Vec<(&String, &Rational, &str)> = of
        .model
        .parameters
        .iter()
        .filter_map(|name| Some((name, of.parameters.get(name)?, of.units.get(name)?.trim())))
        .collect();
    for (index, (first, value, unit)) in used.iter().enumerate() {
        for (second, other, _) in used[index + 1..].iter().filter(|(_, _, same)| same == unit) {
            let mut parameters = of.parameters.clone();
            parameters.insert((*first).clone(), (*other).clone());
            parameters.insert((*second).clone(), (*value).clone());
            let mistake = Mistake {
                kind: MistakeKind::ParametersSwapped,
                words: format!("`{first}` and `{second}` are taken for one another"),
                change: format!("{first} <-> {second}"),
                places: Vec::new(),
            };
            add(mistake, &parameters);
        }
    }
    let two = Rational::from(2);
    for (name, value, _) in used.into_iter().filter(|(_, _, unit)| LENGTHS.contains(unit)) {
        for (kind, part, much, change) in [
            (MistakeKind::ParameterDoubled, value * &two, "twice", format!("{name} -> 2*{name}")),
            (MistakeKind::ParameterHalved, value / &two, "half", format!("{name} -> {name}/2")),
        ] {
            let mut parameters = of.parameters.clone();
            parameters.insert(name.clone(), part);
            let words = format!("`{name}` is taken {much} as large");
            add(Mistake { kind, words, change, places: Vec::new() }, &parameters);
        }
    }
    all
}
