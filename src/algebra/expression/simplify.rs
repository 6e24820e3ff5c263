//! Building blocks that leave out what does not count: 0 + a, 1·a, a¹.

use super::super::Rational;
use super::{Expression, NodeKind};

pub(super) fn number(value: Rational, at: &Expression) -> Expression {
    Expression::new(NodeKind::Number(value), at.start, at.end)
}

pub(super) fn zero(at: &Expression) -> Expression {
    number(Rational::ZERO, at)
}

pub(super) fn one(at: &Expression) -> Expression {
    number(Rational::ONE, at)
}

/// The value of a node that is a number.
pub(super) fn value(node: &Expression) -> Option<&Rational> {
    match &node.kind {
        NodeKind::Number(value) => Some(value),
        _ => None,
    }
}

fn is(node: &Expression, number: &Rational) -> bool {
    value(node) == Some(number)
}

pub(super) fn negate(a: Expression, at: &Expression) -> Expression {
    match a.kind {
        NodeKind::Number(value) => number(-value, at),
        NodeKind::Negate(inner) => *inner,
        _ => Expression::new(NodeKind::Negate(Box::new(a)), at.start, at.end),
    }
}

pub(super) fn add(a: Expression, b: Expression, at: &Expression) -> Expression {
    match (&a.kind, &b.kind) {
        (NodeKind::Number(x), NodeKind::Number(y)) => number(x + y, at),
        (NodeKind::Number(x), _) if x.is_zero() => b,
        (_, NodeKind::Number(y)) if y.is_zero() => a,
        (_, NodeKind::Negate(inner)) => {
            Expression::new(NodeKind::Subtract(Box::new(a), inner.clone()), at.start, at.end)
        }
        _ => Expression::new(NodeKind::Add(Box::new(a), Box::new(b)), at.start, at.end),
    }
}

pub(super) fn subtract(a: Expression, b: Expression, at: &Expression) -> Expression {
    match (&a.kind, &b.kind) {
        (NodeKind::Number(x), NodeKind::Number(y)) => number(x - y, at),
        (NodeKind::Number(x), _) if x.is_zero() => negate(b, at),
        (_, NodeKind::Number(y)) if y.is_zero() => a,
        (_, NodeKind::Negate(inner)) => {
            Expression::new(NodeKind::Add(Box::new(a), inner.clone()), at.start, at.end)
        }
        _ => Expression::new(NodeKind::Subtract(Box::new(a), Box::new(b)), at.start, at.end),
    }
}

pub(super) fn multiply(a: Expression, b: Expression, at: &Expression) -> Expression {
    if is(&a, &Rational::ZERO) || is(&b, &Rational::ZERO) {
        return zero(at);
    }
    if is(&a, &Rational::ONE) {
        return b;
    }
    if is(&b, &Rational::ONE) {
        return a;
    }
    if is(&a, &Rational::NEG_ONE) {
        return negate(b, at);
    }
    if value(&b).is_some() && value(&a).is_none() {
        return multiply(b, a, at);
    }
    match (a.kind, b.kind) {
        (NodeKind::Number(x), NodeKind::Number(y)) => number(x * y, at),
        (NodeKind::Negate(x), NodeKind::Negate(y)) => multiply(*x, *y, at),
        (NodeKind::Negate(x), y) => {
            let b = Expression::new(y, b.start, b.end);
            negate(multiply(*x, b, at), at)
        }
        (x, NodeKind::Negate(y)) => {
            let a = Expression::new(x, a.start, a.end);
            negate(multiply(a, *y, at), at)
        }
        (x, y) => {
            let a = Expression::new(x, a.start, a.end);
            let b = Expression::new(y, b.start, b.end);
            Expression::new(NodeKind::Multiply(Box::new(a), Box::new(b)), at.start, at.end)
        }
    }
}

pub(super) fn divide(a: Expression, b: Expression, at: &Expression) -> Expression {
    match (&a.kind, &b.kind) {
        (_, NodeKind::Number(y)) if *y == Rational::ONE => a,
        (NodeKind::Number(x), NodeKind::Number(y)) if !y.is_zero() => number(x / y, at),
        // A quotient whose bottom can be 0 was undefined there before it was differentiated.
        (NodeKind::Number(x), other) if x.is_zero() && !matches!(other, NodeKind::Number(_)) => a,
        (NodeKind::Negate(x), _) => negate(divide((**x).clone(), b, at), at),
        _ => Expression::new(NodeKind::Divide(Box::new(a), Box::new(b)), at.start, at.end),
    }
}

pub(super) fn power(a: Expression, b: Expression, at: &Expression) -> Expression {
    if is(&b, &Rational::ONE) {
        return a;
    }
    if is(&b, &Rational::ZERO) {
        return one(at);
    }
    Expression::new(NodeKind::Power(Box::new(a), Box::new(b)), at.start, at.end)
}
