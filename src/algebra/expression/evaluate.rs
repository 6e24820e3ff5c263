use super::super::to_f64;
use super::{Expression, ExpressionError, Function, NodeKind};
use std::f64::consts::PI;

impl Expression {
    /// The value in floating point; `lookup` gives each name's value with that many primes.
    ///
    /// Outside a function's domain the result is NaN or infinite, as usual for `f64`.
    /// Errors: a name that `lookup` does not know.
    pub fn eval_f64<F>(&self, lookup: &F) -> Result<f64, ExpressionError>
    where
        F: Fn(&str, u8) -> Option<f64> + ?Sized,
    {
        Ok(match &self.kind {
            NodeKind::Number(value) => to_f64(value),
            NodeKind::Pi => PI,
            NodeKind::Symbol { name, primes } => lookup(name, *primes).ok_or_else(|| ExpressionError {
                start: self.start,
                end: self.end,
                message: format!("`{name}{}` has no value", "'".repeat(usize::from(*primes))),
                help: None,
            })?,
            NodeKind::Negate(a) => -a.eval_f64(lookup)?,
            NodeKind::Add(a, b) => a.eval_f64(lookup)? + b.eval_f64(lookup)?,
            NodeKind::Subtract(a, b) => a.eval_f64(lookup)? - b.eval_f64(lookup)?,
            NodeKind::Multiply(a, b) => a.eval_f64(lookup)? * b.eval_f64(lookup)?,
            NodeKind::Divide(a, b) => a.eval_f64(lookup)? / b.eval_f64(lookup)?,
            NodeKind::Power(a, b) => power(a.eval_f64(lookup)?, b.eval_f64(lookup)?),
            NodeKind::Call(function, a) => function.apply(a.eval_f64(lookup)?),
        })
    }
}

impl Function {
    /// The value in floating point; sign(0) is 0.
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            Self::Sign if x == 0.0 => 0.0,
            Self::Sign => x.signum(),
        }
    }
}

/// Small whole powers by multiplication, which is faster and rounds less than `powf`.
fn power(base: f64, exponent: f64) -> f64 {
    if exponent.fract() == 0.0 && exponent.abs() <= 64.0 {
        base.powi(exponent as i32)
    } else {
        base.powf(exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values() {
        let lookup = |name: &str, primes: u8| match (name, primes) {
            ("x", 0) => Some(2.0),
            ("x", 1) => Some(-3.0),
            _ => None,
        };
        for (text, expected) in [
            ("x^3 - x'*x", 14.0),
            ("cos(pi)", -1.0),
            ("sign(0) + sign(-2) + abs(x')", 2.0),
            ("sqrt(x + 2)/4", 0.5),
            ("4^0.5", 2.0),
            ("x^-1", 0.5),
        ] {
            assert_eq!(Expression::parse(text).unwrap().eval_f64(&lookup), Ok(expected), "{text}");
        }
        let missing = Expression::parse("x + y'").unwrap().eval_f64(&lookup).unwrap_err();
        assert_eq!((missing.start, missing.end, missing.message.as_str()), (4, 6, "`y'` has no value"));
    }
}
