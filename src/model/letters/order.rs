use super::super::Model;
use crate::algebra::{Expression, NodeKind};

/// `letters` in the order in which the equations multiply them (m g l, not g l m), else in their own.
pub(super) fn as_written(model: &Model, letters: Vec<String>) -> Vec<String> {
    let mut before: Vec<(usize, usize)> = Vec::new();
    let place = |name: &str| letters.iter().position(|l| l == name);
    for equation in &model.equations {
        for side in [&equation.left, &equation.right] {
            products(side, &mut |names| {
                let known: Vec<usize> = names.iter().filter_map(|name| place(name)).collect();
                for (i, a) in known.iter().enumerate() {
                    before.extend(known[i + 1..].iter().filter(|b| *b != a).map(|b| (*a, *b)));
                }
            });
        }
    }
    // What is written both ways says nothing.
    let opposed: Vec<(usize, usize)> =
        before.iter().filter(|(a, b)| before.contains(&(*b, *a))).copied().collect();
    before.retain(|pair| !opposed.contains(pair));
    let mut open: Vec<usize> = (0..letters.len()).collect();
    let mut order = Vec::with_capacity(letters.len());
    while !open.is_empty() {
        let free = |i: &usize| !before.iter().any(|(a, b)| b == i && open.contains(a));
        let next = open.iter().position(free).unwrap_or(0);
        order.push(open.remove(next));
    }
    order.into_iter().map(|i| letters[i].clone()).collect()
}

/// Calls `with` for the names of every product, left to right.
fn products(node: &Expression, with: &mut dyn FnMut(&[String])) {
    if matches!(node.kind, NodeKind::Multiply(..)) {
        let mut names = Vec::new();
        factors(node, &mut names);
        with(&names);
    }
    for child in node.children() {
        products(child, with);
    }
}

fn factors(node: &Expression, names: &mut Vec<String>) {
    match &node.kind {
        NodeKind::Multiply(a, b) => {
            factors(a, names);
            factors(b, names);
        }
        NodeKind::Power(a, _) | NodeKind::Call(_, a) | NodeKind::Negate(a) | NodeKind::Divide(a, _) => {
            factors(a, names)
        }
        NodeKind::Symbol { name, .. } => names.push(name.clone()),
        _ => {}
    }
}
