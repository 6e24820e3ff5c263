use super::coefficient::{Coefficient, Letters, TooLarge, whole};
use crate::algebra::{Expression, ExpressionError, NodeKind, Rational};

/// The variable of transfer functions.
const VARIABLE: &str = "s";

/// The highest power of s that is taken.
pub(super) const MOST_DEGREE: usize = 60;

/// Numerator and denominator of a formula in s, coefficients in letters, the highest power first; nothing is cancelled.
///
/// Errors: functions of s, powers that are not whole, division by zero, and what grows beyond degree 60 or beyond what
/// is worth writing out.
pub(super) fn quotient(formula: &Expression) -> Result<(Vec<Expression>, Vec<Expression>), ExpressionError> {
    let mut letters = Letters::default();
    let quotient = of(formula, &mut letters)?;
    let written = |p: &Powers| p.iter().rev().map(|c| c.expression(&letters)).collect();
    Ok((written(&quotient.num), written(&quotient.den)))
}

/// Coefficients of s⁰, s¹, …; the last is not 0; empty for 0.
type Powers = Vec<Coefficient>;

struct Quotient {
    num: Powers,
    den: Powers,
}

fn has_s(node: &Expression) -> bool {
    node.symbols().iter().any(|symbol| symbol.name == VARIABLE)
}

fn constant(value: Coefficient) -> Powers {
    if value.is_zero() { Vec::new() } else { vec![value] }
}

fn one() -> Powers {
    constant(Coefficient::number(Rational::ONE))
}

fn of(node: &Expression, letters: &mut Letters) -> Result<Quotient, ExpressionError> {
    let large = |_: TooLarge| error(node, "this grows too large to be multiplied out");
    if !has_s(node) {
        let value = letters.coefficient(node).map_err(large)?;
        return Ok(Quotient { num: constant(value), den: one() });
    }
    Ok(match &node.kind {
        NodeKind::Number(_) | NodeKind::Pi => Quotient { num: Vec::new(), den: one() },
        NodeKind::Symbol { primes, .. } => {
            if *primes > 0 {
                return Err(error(node, "`s` has no derivative"));
            }
            Quotient { num: vec![Coefficient::default(), Coefficient::number(Rational::ONE)], den: one() }
        }
        NodeKind::Negate(a) => {
            let a = of(a, letters)?;
            Quotient { num: a.num.into_iter().map(Coefficient::negated).collect(), den: a.den }
        }
        NodeKind::Call(function, _) => {
            let message = format!("`{}` of `s` is no transfer function of finite order", function.name());
            return Err(error(node, &message));
        }
        NodeKind::Add(a, b) | NodeKind::Subtract(a, b) => {
            let (a, mut b) = (of(a, letters)?, of(b, letters)?);
            if matches!(node.kind, NodeKind::Subtract(..)) {
                b.num = b.num.into_iter().map(Coefficient::negated).collect();
            }
            if a.den == b.den {
                Quotient { num: sum(a.num, &b.num), den: a.den }
            } else {
                let left = product(node, &a.num, &b.den, letters)?;
                let right = product(node, &b.num, &a.den, letters)?;
                Quotient { num: sum(left, &right), den: product(node, &a.den, &b.den, letters)? }
            }
        }
        NodeKind::Multiply(a, b) => {
            let (a, b) = (of(a, letters)?, of(b, letters)?);
            times(node, &a, &b, letters)?
        }
        NodeKind::Divide(a, b) => {
            let (a, below) = (of(a, letters)?, of(b, letters)?);
            let below = inverse(b, below, letters)?;
            times(node, &a, &below, letters)?
        }
        NodeKind::Power(a, b) => {
            let Some(power) = whole(b) else {
                return Err(error(b, "this is not a whole power"));
            };
            let base = of(a, letters)?;
            let base = if power < 0 { inverse(a, base, letters)? } else { base };
            let mut result = Quotient { num: one(), den: one() };
            for _ in 0..power.unsigned_abs() {
                result = times(node, &result, &base, letters)?;
            }
            result
        }
    })
}

fn times(
    node: &Expression,
    a: &Quotient,
    b: &Quotient,
    letters: &mut Letters,
) -> Result<Quotient, ExpressionError> {
    let num = product(node, &a.num, &b.num, letters)?;
    Ok(Quotient { num, den: product(node, &a.den, &b.den, letters)? })
}

/// A constant below goes into the numerator.
fn inverse(node: &Expression, a: Quotient, letters: &mut Letters) -> Result<Quotient, ExpressionError> {
    match a.num.as_slice() {
        [] => Err(error(node, "this is zero, and cannot be divided by")),
        [only] => {
            let inverse = letters.inverse(only).map(constant).unwrap_or_default();
            Ok(Quotient { num: product(node, &a.den, &inverse, letters)?, den: one() })
        }
        _ => Ok(Quotient { num: a.den, den: a.num }),
    }
}

fn sum(mut a: Powers, b: &Powers) -> Powers {
    a.resize(a.len().max(b.len()), Coefficient::default());
    for (k, term) in b.iter().enumerate() {
        a[k] = std::mem::take(&mut a[k]).plus(term);
    }
    trimmed(a)
}

fn product(
    node: &Expression,
    a: &Powers,
    b: &Powers,
    letters: &mut Letters,
) -> Result<Powers, ExpressionError> {
    if a.is_empty() || b.is_empty() {
        return Ok(Vec::new());
    }
    if a.len() + b.len() - 2 > MOST_DEGREE {
        return Err(error(node, &format!("this has a degree beyond {MOST_DEGREE}")));
    }
    let mut result = vec![Coefficient::default(); a.len() + b.len() - 1];
    for (i, left) in a.iter().enumerate() {
        for (j, right) in b.iter().enumerate() {
            let product = letters
                .product(left, right)
                .map_err(|_| error(node, "this grows too large to be multiplied out"))?;
            result[i + j] = std::mem::take(&mut result[i + j]).plus(&product);
        }
    }
    Ok(trimmed(result))
}

fn trimmed(mut powers: Powers) -> Powers {
    while powers.last().is_some_and(Coefficient::is_zero) {
        powers.pop();
    }
    powers
}

fn error(node: &Expression, message: &str) -> ExpressionError {
    ExpressionError { start: node.start, end: node.end, message: message.to_owned(), help: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &str, &str)]) {
        for (text, num, den) in rows {
            let found = quotient(&Expression::parse(text).unwrap()).unwrap();
            let shown = |p: Vec<Expression>| p.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
            assert_eq!((shown(found.0).as_str(), shown(found.1).as_str()), (*num, *den), "{text}");
        }
    }

    #[test]
    fn numerator_and_denominator_in_letters() {
        check(&[
            ("K/(s*(T*s + 1))", "K", "T; 1; 0"),
            ("(s + 1)/((s + 1)*(s + 2))", "1; 1", "1; 3; 2"),
            ("1/(2*s + 2) + k", "2*k; 1 + 2*k", "2; 2"),
            ("k/2/(s/2 + 1)", "0.5*k", "0.5; 1"),
            ("s/(M + m) + 1", "1/(M + m); 1", "1"),
            ("(T*s + 1)^2*s^-1", "T^2; 2*T; 1", "1; 0"),
            ("5", "5", "1"),
            ("s - s", "", "1"),
        ]);
    }

    #[test]
    fn what_is_no_transfer_function() {
        for (text, message) in [
            ("exp(-s)", "`exp` of `s`"),
            ("s^T", "not a whole power"),
            ("1/(s - s)", "this is zero"),
            ("(s + 1)^50*(s + 1)^50", "beyond 60"),
            ("s'", "no derivative"),
        ] {
            let error = quotient(&Expression::parse(text).unwrap()).unwrap_err();
            assert!(error.message.contains(message), "{text}: {error}");
        }
    }
}
