use super::super::Model;
use super::order;
use std::collections::BTreeSet;

/// The parameters that a model's equations need, those behind derived ones included, in the order in which they are written.
pub fn letters_used(model: &Model) -> Vec<String> {
    let sides = model.equations.iter().flat_map(|equation| [&equation.left, &equation.right]);
    let mut used: BTreeSet<String> = sides.flat_map(|side| side.symbols()).map(|one| one.name).collect();
    // Each stands after those it needs.
    let derived: Vec<_> = model.derived.iter().collect();
    for one in derived.iter().rev().filter(|one| model.parameters.contains(&one.name)) {
        if used.contains(&one.name) {
            used.extend(one.formula.symbols().into_iter().map(|symbol| symbol.name));
        }
    }
    let own = model.parameters.iter().filter(|name| used.contains(*name)).cloned().collect();
    order::as_written(model, own)
}
