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
    node.replaced(&|node| {
        if (node.start, node.end) == place {
            return Some(Expression { kind: other(node), start: node.start, end: node.end });
        }
        let elsewhere = place.0 < node.start || node.end < place.1;
        elsewhere.then(|| node.clone())
    })
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
