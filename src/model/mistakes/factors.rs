use super::edit::{Edit, Replacement};
use super::{Derivation, Mistake, MistakeKind, Place};
use crate::algebra::{Expression, NodeKind};

/// Each parameter that stands as a factor in a product left out, and each of its powers taken as the parameter itself.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let mut all = Vec::new();
    for (index, equation) in of.equations() {
        let number = index + 1;
        let text = |node: &Expression| equation.text.get(node.start..node.end).unwrap_or_default().trim();
        let mut found = Vec::new();
        factors(&equation.left, None, &mut found);
        factors(&equation.right, None, &mut found);
        for (factor, product) in found {
            let place = Place { equation: index, start: factor.node.start, end: factor.node.end };
            let name = text(factor.node);
            let inside = match product {
                Some(product) => format!("in `{}` of equation {number}", text(product)),
                None => format!("in equation {number}"),
            };
            let mut add = |kind, words, change: String, to| {
                let places = vec![place];
                all.push(Mistake { kind, words, change, edit: Edit::Nodes(places.clone(), to), places });
            };
            let change = |to: &str| match product {
                Some(product) => format!("equation {number}: {name} -> {to} in {}", text(product)),
                None => format!("equation {number}: {name} -> {to}"),
            };
            if product.is_some() && of.model.parameters.contains(factor.base) {
                add(
                    MistakeKind::FactorDropped,
                    format!("the factor `{name}` {inside} is missing"),
                    change("1"),
                    Replacement::Number(1),
                );
            }
            if factor.is_power && of.model.parameters.contains(factor.base) {
                let base = factor.base;
                add(
                    MistakeKind::PowerDropped,
                    format!("`{name}` {inside} is taken as `{base}`"),
                    change(base),
                    Replacement::Name(base.clone()),
                );
            }
        }
    }
    all
}

/// A name or a power of one.
struct Factor<'a> {
    node: &'a Expression,
    base: &'a String,
    is_power: bool,
}

/// Every name and power of a name, with the product it is a factor of.
fn factors<'a>(
    node: &'a Expression,
    product: Option<&'a Expression>,
    found: &mut Vec<(Factor<'a>, Option<&'a Expression>)>,
) {
    match &node.kind {
        NodeKind::Symbol { name, .. } => {
            found.push((Factor { node, base: name, is_power: false }, product));
        }
        NodeKind::Power(base, exponent) => match &base.kind {
            NodeKind::Symbol { name, .. } => {
                found.push((Factor { node, base: name, is_power: true }, product));
                factors(exponent, None, found);
            }
            _ => node.children().for_each(|child| factors(child, None, found)),
        },
        // The outermost product of a chain is the one that is shown.
        NodeKind::Multiply(a, b) => {
            let product = product.or(Some(node));
            factors(a, product, found);
            factors(b, product, found);
        }
        // A divisor is not left out as a factor is.
        NodeKind::Divide(a, b) => {
            factors(a, product, found);
            factors(b, None, found);
        }
        _ => node.children().for_each(|child| factors(child, None, found)),
    }
}
