use crate::algebra::{Expression, NodeKind, Rational};
use crate::model::exact::{Purpose, call};
use crate::model::{Exact, ModelError};

/// A formula in the values that are not known yet.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    /// constant + Σ slope · unknown, slopes rational.
    Linear { constant: Exact, slopes: Vec<Rational> },
    /// Otherwise; which of the unknowns stand in it and are not multiplied by 0.
    Other { depends: Vec<bool> },
}

/// What a name stands for.
pub(super) enum Value {
    Known(Exact),
    /// The place of an unknown.
    Unknown(usize),
}

impl Form {
    /// `count` is how many unknowns there are.
    ///
    /// Errors: a part that has no value whatever the unknowns are.
    pub fn of(
        node: &Expression,
        count: usize,
        value: &dyn Fn(&str, u8) -> Option<Value>,
    ) -> Result<Self, ModelError> {
        let of = |child: &Expression| Self::of(child, count, value);
        match &node.kind {
            NodeKind::Number(number) => Ok(Self::known(Exact::rational(number.clone()), count)),
            NodeKind::Pi => {
                Ok(Self::known(Exact::Known { rational: Rational::ZERO, pi: Rational::ONE }, count))
            }
            NodeKind::Symbol { name, primes } => match value(name, *primes) {
                Some(Value::Known(value)) => Ok(Self::known(value, count)),
                Some(Value::Unknown(place)) => {
                    let slopes = (0..count).map(|k| if k == place { Rational::ONE } else { Rational::ZERO });
                    Ok(Self::Linear { constant: Exact::zero(), slopes: slopes.collect() })
                }
                None => {
                    Err(ModelError::NoValue { name: format!("{name}{}", "'".repeat(usize::from(*primes))) })
                }
            },
            NodeKind::Negate(a) => Ok(of(a)?.scaled(&Rational::NEG_ONE)),
            NodeKind::Add(a, b) => Ok(of(a)?.plus(of(b)?)),
            NodeKind::Subtract(a, b) => Ok(of(a)?.plus(of(b)?.scaled(&Rational::NEG_ONE))),
            NodeKind::Multiply(a, b) => Ok(of(a)?.times(of(b)?)),
            NodeKind::Divide(a, b) => {
                let (a, b) = (of(a)?, of(b)?);
                match (a.as_known(), b.as_known()) {
                    (Some(a), Some(b)) => Ok(Self::known(a.clone().over(b.clone())?, count)),
                    (_, Some(divisor)) => {
                        let inverse = Exact::rational(Rational::ONE).over(divisor.clone())?;
                        Ok(a.times(Self::known(inverse, count)))
                    }
                    (Some(zero), None) if zero.is_zero() => Ok(a),
                    _ => Ok(a.mixed(&b)),
                }
            }
            NodeKind::Power(a, b) => {
                let (a, b) = (of(a)?, of(b)?);
                match (a.as_known(), b.as_known()) {
                    (Some(a), Some(b)) => Ok(Self::known(a.clone().raised_to(b.clone())?, count)),
                    (None, Some(exponent)) if exponent.as_rational() == Some(&Rational::ONE) => Ok(a),
                    (None, Some(exponent)) if exponent.is_zero() => {
                        Ok(Self::known(Exact::rational(Rational::ONE), count))
                    }
                    _ => Ok(a.mixed(&b)),
                }
            }
            NodeKind::Call(function, a) => {
                let argument = of(a)?;
                match argument.as_known() {
                    Some(known) => Ok(Self::known(call(*function, known.clone(), Purpose::Value)?, count)),
                    None => Ok(Self::Other { depends: argument.depends() }),
                }
            }
        }
    }

    /// By place: whether an unknown makes a difference.
    pub fn depends(&self) -> Vec<bool> {
        match self {
            Self::Linear { slopes, .. } => slopes.iter().map(|slope| !slope.is_zero()).collect(),
            Self::Other { depends } => depends.clone(),
        }
    }

    fn known(constant: Exact, count: usize) -> Self {
        Self::Linear { constant, slopes: vec![Rational::ZERO; count] }
    }

    fn as_known(&self) -> Option<&Exact> {
        match self {
            Self::Linear { constant, slopes } if slopes.iter().all(Rational::is_zero) => Some(constant),
            _ => None,
        }
    }

    fn mixed(&self, other: &Self) -> Self {
        let both = self.depends().into_iter().zip(other.depends());
        Self::Other { depends: both.map(|(a, b)| a || b).collect() }
    }

    fn plus(self, other: Self) -> Self {
        match (self, other) {
            (Self::Linear { constant: a, slopes: p }, Self::Linear { constant: b, slopes: q }) => {
                Self::Linear { constant: a.plus(b), slopes: p.iter().zip(&q).map(|(p, q)| p + q).collect() }
            }
            (a, b) => a.mixed(&b),
        }
    }

    fn scaled(self, factor: &Rational) -> Self {
        match self {
            Self::Linear { constant, slopes } => Self::Linear {
                constant: constant.scaled(factor),
                slopes: slopes.iter().map(|slope| slope * factor).collect(),
            },
            other => other,
        }
    }

    fn times(self, other: Self) -> Self {
        let zero = |form: &Self| form.as_known().is_some_and(Exact::is_zero);
        if zero(&self) {
            return self;
        }
        if zero(&other) {
            return other;
        }
        let product = match (self.as_known(), other.as_known()) {
            (Some(a), Some(b)) => Some(Self::known(a.clone().times(b.clone()), self.depends().len())),
            (Some(factor), None) => factor.as_rational().map(|factor| other.clone().scaled(factor)),
            (None, Some(factor)) => factor.as_rational().map(|factor| self.clone().scaled(factor)),
            (None, None) => None,
        };
        product.unwrap_or_else(|| self.mixed(&other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_linear_and_what_is_not() {
        #[track_caller]
        fn check(text: &str, expected: &str) {
            let form = Form::of(&Expression::parse(text).unwrap(), 2, &|name, primes| match (name, primes) {
                ("u", 0) => Some(Value::Unknown(0)),
                ("v", 0) => Some(Value::Unknown(1)),
                (_, 1..) => Some(Value::Known(Exact::zero())),
                ("k", _) => Some(Value::Known(Exact::rational(Rational::from(3)))),
                _ => None,
            });
            let found = match form {
                Ok(Form::Linear { constant, slopes }) => {
                    format!("{} + {} u + {} v", constant.to_f64(), slopes[0], slopes[1])
                }
                Ok(Form::Other { depends }) => format!("of u: {}, of v: {}", depends[0], depends[1]),
                Err(error) => error.to_string(),
            };
            assert_eq!(found, expected, "{text}");
        }
        check("k*(u - 2*v)/4 + u + 1", "1 + 7/4 u + -3/2 v");
        check("(k - 3)*sin(u) + v", "0 + 0 u + 1 v");
        check("u'^2*v + 2*cos(pi)*u", "0 + -2 u + 0 v");
        check("u*v", "of u: true, of v: true");
        check("k*sqrt(u) + (v - v)", "of u: true, of v: false");
        check("u^1 + v^0", "1 + 1 u + 0 v");
        check("u*sqrt(2)", "of u: true, of v: false");
        check("u/(k - 3)", "`division by zero` is not defined at this point");
    }
}
