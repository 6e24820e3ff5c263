use super::edit::{Edit, Replacement};
use super::{Derivation, Mistake, MistakeKind, Place};
use crate::algebra::{Expression, NodeKind};

/// Every summand of every equation, inside parentheses too: its sign turned, and dropped.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let mut all = Vec::new();
    for (index, equation) in of.equations() {
        let text = |node: &Expression| equation.text.get(node.start..node.end).unwrap_or_default().trim();
        let mut found = terms(&equation.left);
        found.extend(terms(&equation.right));
        if of.model.output_of(index).is_some() {
            // `y = x`: what can be done to `y`, or to `x` where it is alone, is done to the whole function.
            let outer = found.iter().filter(|term| term.sum.is_none()).count();
            let left = equation.left.end;
            found.retain(|term| term.node.start >= left && (outer > 2 || term.sum.is_some()));
        }
        for term in found {
            let (number, name) = (index + 1, text(term.node));
            let place = Place { equation: index, start: term.node.start, end: term.node.end };
            let what = match term.sum {
                Some(sum) => format!("`{name}` in `{}` of equation {number}", text(sum)),
                None => format!("the term `{name}` of equation {number}"),
            };
            let mut add = |kind, changed: String, words: String, to| {
                let change = format!("equation {number}: {name} -> {changed}");
                let places = vec![place];
                all.push(Mistake { kind, words, change, edit: Edit::Nodes(places.clone(), to), places });
            };
            add(
                MistakeKind::TermSign,
                format!("-{name}"),
                format!("{what} has the wrong sign"),
                Replacement::Negated,
            );
            add(
                MistakeKind::TermDropped,
                "0".to_owned(),
                format!("{what} is missing"),
                Replacement::Number(0),
            );
        }
    }
    all
}

/// A summand.
struct Term<'a> {
    node: &'a Expression,
    /// The sum in parentheses it belongs to; `None` for a side of the equation.
    sum: Option<&'a Expression>,
}

/// The summands of one side, each followed by those inside it.
fn terms(side: &Expression) -> Vec<Term<'_>> {
    let mut found = Vec::new();
    summands(side, None, &mut found);
    found
}

fn summands<'a>(node: &'a Expression, sum: Option<&'a Expression>, found: &mut Vec<Term<'a>>) {
    match &node.kind {
        NodeKind::Add(a, b) | NodeKind::Subtract(a, b) => {
            summands(a, sum, found);
            summands(b, sum, found);
        }
        NodeKind::Negate(a) => summands(a, sum, found),
        NodeKind::Number(value) if value.is_zero() => {}
        _ => {
            found.push(Term { node, sum });
            node.children().for_each(|child| sums_within(child, found));
        }
    }
}

/// The sums inside a factor.
fn sums_within<'a>(node: &'a Expression, found: &mut Vec<Term<'a>>) {
    match &node.kind {
        NodeKind::Add(..) | NodeKind::Subtract(..) => summands(node, Some(node), found),
        _ => node.children().for_each(|child| sums_within(child, found)),
    }
}
