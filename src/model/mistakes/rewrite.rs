use crate::algebra::{Expression, NodeKind, Rational};
use crate::model::at_rest;

/// The same tree, but the node at bytes `place` of the text is made another one.
///
/// No two nodes of a parsed equation stand at the same bytes.
pub(super) fn rewrite(
    node: &Expression,
    place: (usize, usize),
    other: &dyn Fn(&Expression) -> NodeKind,
) -> Expression {
    let inner = |child: &Expression| Box::new(rewrite(child, place, other));
    let kind = if (node.start, node.end) == place {
        other(node)
    } else if place.0 < node.start || node.end < place.1 {
        return node.clone();
    } else {
        match &node.kind {
            NodeKind::Number(_) | NodeKind::Pi | NodeKind::Symbol { .. } => node.kind.clone(),
            NodeKind::Negate(a) => NodeKind::Negate(inner(a)),
            NodeKind::Call(function, a) => NodeKind::Call(*function, inner(a)),
            NodeKind::Add(a, b) => NodeKind::Add(inner(a), inner(b)),
            NodeKind::Subtract(a, b) => NodeKind::Subtract(inner(a), inner(b)),
            NodeKind::Multiply(a, b) => NodeKind::Multiply(inner(a), inner(b)),
            NodeKind::Divide(a, b) => NodeKind::Divide(inner(a), inner(b)),
            NodeKind::Power(a, b) => NodeKind::Power(inner(a), inner(b)),
        }
    };
    Expression { kind, start: node.start, end: node.end }
}

/// The node itself, its sign turned.
pub(super) fn negated(node: &Expression) -> NodeKind {
    NodeKind::Negate(Box::new(node.clone()))
}

/// The node as it is at rest, and what it changes by from there `factor` times: the same value, another slope.
pub(super) fn with_slope(node: &Expression, factor: &Rational) -> NodeKind {
    let like = |kind| Box::new(Expression { kind, start: node.start, end: node.end });
    let times = |factor: Rational, of: Expression| {
        like(NodeKind::Multiply(like(NodeKind::Number(factor)), Box::new(of)))
    };
    NodeKind::Add(times(Rational::ONE - factor, at_rest(node)), times(factor.clone(), node.clone()))
}
