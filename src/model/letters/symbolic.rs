//! A formula at rest, in letters.

use super::Trouble;
use super::ring::{Fraction, Ring, node, number};
use crate::algebra::{
    Budget, Expression, Function, MultivariatePolynomial as Poly, NodeKind, Rational, to_f64,
};

/// What a name with primes is at rest.
pub(super) type AtRest<'a> = dyn Fn(&str, u8, &Ring) -> Option<Fraction> + 'a;

/// The value of a formula, or of a derivative, at rest.
///
/// sin and cos of multiples of π become numbers. A kink (sign(0) in a derivative) vanishes in a product with 0.
pub(super) fn evaluate(
    ring: &mut Ring,
    expression: &Expression,
    at: &AtRest<'_>,
    budget: &mut Budget,
) -> Result<Fraction, Trouble> {
    budget.spend(1)?;
    let mut of = |node: &Expression| evaluate(ring, node, at, budget);
    match &expression.kind {
        NodeKind::Number(value) => Ok(Fraction::constant(value.clone())),
        NodeKind::Pi => Ok(Fraction::polynomial(Poly::letter(ring.pi()))),
        NodeKind::Symbol { name, primes } => at(name, *primes, ring).ok_or(Trouble::Undefined),
        NodeKind::Negate(a) => Ok(of(a)?.negated()),
        NodeKind::Add(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            ring.sum(&a, &b, budget)
        }
        NodeKind::Subtract(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            ring.sum(&a, &b.negated(), budget)
        }
        NodeKind::Multiply(a, b) => match (of(a), of(b)) {
            (Ok(a), Ok(b)) => ring.product(&a, &b, budget),
            (Ok(zero), Err(Trouble::Kink)) | (Err(Trouble::Kink), Ok(zero)) if zero.is_zero() => Ok(zero),
            (Err(trouble), _) | (_, Err(trouble)) => Err(trouble),
        },
        NodeKind::Divide(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            if b.is_zero() && a.is_zero() && is_sign_slope(expression) {
                return Err(Trouble::Kink);
            }
            ring.quotient(&a, &b, budget)
        }
        NodeKind::Power(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            power(ring, &a, &b, budget)
        }
        NodeKind::Call(function, a) => {
            let argument = of(a)?;
            call(ring, *function, &argument, budget)
        }
    }
}

/// The formula as its author wrote it, with what stands at rest in it and without what vanishes.
pub(super) fn at_rest(
    ring: &mut Ring,
    expression: &Expression,
    at: &AtRest<'_>,
    budget: &mut Budget,
) -> Result<Expression, Trouble> {
    let value = evaluate(ring, expression, at, budget)?;
    if let Some(constant) = value.as_constant() {
        return Ok(number(constant));
    }
    let is = |node: &Expression, wanted: i32| matches!(&node.kind, NodeKind::Number(n) if *n == Rational::from(wanted));
    let mut of = |node: &Expression| at_rest(ring, node, at, budget);
    let kind = match &expression.kind {
        NodeKind::Negate(a) => NodeKind::Negate(Box::new(of(a)?)),
        NodeKind::Add(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            match (is(&a, 0), is(&b, 0)) {
                (true, _) => return Ok(b),
                (_, true) => return Ok(a),
                _ => NodeKind::Add(Box::new(a), Box::new(b)),
            }
        }
        NodeKind::Subtract(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            match (is(&a, 0), is(&b, 0)) {
                (true, _) => NodeKind::Negate(Box::new(b)),
                (_, true) => return Ok(a),
                _ => NodeKind::Subtract(Box::new(a), Box::new(b)),
            }
        }
        NodeKind::Multiply(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            match (is(&a, 1), is(&b, 1)) {
                (true, _) => return Ok(b),
                (_, true) => return Ok(a),
                _ if is(&a, -1) => NodeKind::Negate(Box::new(b)),
                _ => NodeKind::Multiply(Box::new(a), Box::new(b)),
            }
        }
        NodeKind::Divide(a, b) => NodeKind::Divide(Box::new(of(a)?), Box::new(of(b)?)),
        NodeKind::Power(a, b) => NodeKind::Power(Box::new(of(a)?), Box::new(of(b)?)),
        NodeKind::Call(function, a) => {
            let inside = evaluate(ring, a, at, budget)?;
            if ring.multiple_of_pi(&inside).is_some() || matches!(function, Function::Abs | Function::Sign) {
                return Ok(ring.fraction_form(&value, budget)?.into_expression());
            }
            NodeKind::Call(*function, Box::new(at_rest(ring, a, at, budget)?))
        }
        _ => return Ok(ring.fraction_form(&value, budget)?.into_expression()),
    };
    Ok(node(kind))
}

/// 0/u, the slope of sign(u).
fn is_sign_slope(node: &Expression) -> bool {
    matches!(&node.kind, NodeKind::Divide(a, _) if matches!(&a.kind, NodeKind::Number(zero) if zero.is_zero()))
}

fn power(
    ring: &mut Ring,
    base: &Fraction,
    exponent: &Fraction,
    budget: &mut Budget,
) -> Result<Fraction, Trouble> {
    let Some(exponent) = exponent.as_constant() else {
        // aᵇ = exp(b ln a)
        let logarithm = call(ring, Function::Ln, base, budget)?;
        let inside = ring.product(exponent, &logarithm, budget)?;
        return call(ring, Function::Exp, &inside, budget);
    };
    let times = i32::try_from(exponent.numerator().clone()).map_err(|_| Trouble::Undefined)?;
    let order = u32::try_from(exponent.denominator().clone()).map_err(|_| Trouble::Undefined)?;
    if order > 12 || times.unsigned_abs() > 60 {
        return Err(Trouble::OverBudget);
    }
    if base.is_zero() {
        return if times > 0 {
            Ok(Fraction::zero())
        } else if times == 0 {
            Ok(Fraction::constant(Rational::ONE))
        } else {
            Err(Trouble::Undefined)
        };
    }
    let root = if order == 1 { base.clone() } else { ring.root(base, order, budget)? };
    ring.whole_power(&root, times, budget)
}

fn call(ring: &mut Ring, function: Function, a: &Fraction, budget: &mut Budget) -> Result<Fraction, Trouble> {
    match function {
        Function::Sqrt => ring.root(a, 2, budget),
        Function::Tan => {
            let (sine, cosine) =
                (call(ring, Function::Sin, a, budget)?, call(ring, Function::Cos, a, budget)?);
            ring.quotient(&sine, &cosine, budget)
        }
        Function::Sin | Function::Cos => circular(ring, function, a, budget),
        Function::Abs | Function::Sign => {
            if a.is_zero() {
                return if function == Function::Abs { Ok(Fraction::zero()) } else { Err(Trouble::Kink) };
            }
            let value = ring.value_of(a);
            if !value.is_finite() || value == 0.0 {
                return Err(Trouble::Undefined);
            }
            let sign = Rational::from(if value < 0.0 { -1 } else { 1 });
            let sign = Fraction::constant(sign);
            if function == Function::Abs { ring.product(&sign, a, budget) } else { Ok(sign) }
        }
        _ => {
            let one = a.as_constant() == Some(Rational::ONE);
            match function {
                Function::Exp | Function::Cosh if a.is_zero() => Ok(Fraction::constant(Rational::ONE)),
                Function::Asin | Function::Atan | Function::Sinh | Function::Tanh if a.is_zero() => {
                    Ok(Fraction::zero())
                }
                Function::Ln if one => Ok(Fraction::zero()),
                _ => Ok(Fraction::polynomial(Poly::letter(ring.call(function, a)))),
            }
        }
    }
}

fn circular(
    ring: &mut Ring,
    function: Function,
    a: &Fraction,
    budget: &mut Budget,
) -> Result<Fraction, Trouble> {
    if let Some(turns) = ring.multiple_of_pi(a)
        && let Some((negative, square)) = circular_at(function, &turns)
    {
        let size = ring.root(&Fraction::constant(square), 2, budget)?;
        return Ok(if negative { size.negated() } else { size });
    }
    // The sign of the argument comes out, so that sin(−a) and sin(a) are one letter.
    let negative = a.num.leading().is_some_and(|(_, c)| *c < Rational::ZERO);
    let argument = if negative { a.negated() } else { a.clone() };
    let (sine, cosine) = (ring.call(Function::Sin, &argument), ring.call(Function::Cos, &argument));
    Ok(match (function, negative) {
        (Function::Sin, true) => Fraction::polynomial(Poly::letter(sine)).negated(),
        (Function::Sin, false) => Fraction::polynomial(Poly::letter(sine)),
        _ => Fraction::polynomial(Poly::letter(cosine)),
    })
}

/// Sign and square of sin or cos of k·π where the square is rational: at multiples of π/6 and π/4.
fn circular_at(function: Function, k: &Rational) -> Option<(bool, Rational)> {
    let twelfths = k * Rational::from(12);
    let twelfths = if function == Function::Cos { twelfths + Rational::from(6) } else { twelfths };
    if !twelfths.is_int() {
        return None;
    }
    let turn = to_f64(&twelfths).rem_euclid(24.0) as u32;
    let quarters = match turn % 12 {
        0 => 0,
        2 | 10 => 1,
        3 | 9 => 2,
        4 | 8 => 3,
        6 => 4,
        _ => return None,
    };
    Some((turn > 12, Rational::from(quarters) / Rational::from(4)))
}
