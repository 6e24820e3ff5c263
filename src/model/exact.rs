use super::ModelError;
use crate::algebra::{
    Expression, Function, NodeKind, Rational, exact_root, from_f64, parse_decimal, significant, to_f64,
};
use dashu_int::ops::BitTest;
use std::f64::consts::PI;

/// A number r + k·π held exactly, or the exact value of an `f64` when it could not be.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact {
    /// rational + pi · π
    Known {
        rational: Rational,
        pi: Rational,
    },
    Approximate(f64),
}

/// What an expression is evaluated for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// sign(0) is 0.
    Value,
    /// A derivative: sign(0) comes from the kink of |u|, has no value, and vanishes only in a product with 0.
    Slope,
    /// The same with every value that is rounded moved a little.
    Moved(Nudge),
}

/// Which way each rounded value is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Nudge {
    /// Sources whose number has this bit go the other way; 0: all go together.
    bit: u16,
    down: bool,
}

impl Nudge {
    /// A rounded value may be off by this part of itself: far more than by one rounding, far less than anything meant.
    const PART: f64 = 1e-9;

    /// All together, and so that every two of 127 sources go against one another at least once; each of them both ways.
    pub fn all() -> impl Iterator<Item = Self> {
        let bits = [0].into_iter().chain((0..7).map(|place| 1 << place));
        bits.flat_map(|bit| [false, true].map(|down| Self { bit, down }))
    }

    /// What the value from that source is multiplied with; a source is one function, one parameter, one value at rest.
    pub fn factor(self, source: u16) -> f64 {
        let down = (source & self.bit != 0) != self.down;
        if down { 1.0 - Self::PART } else { 1.0 + Self::PART }
    }
}

/// The sources of rounded values that are no function: powers with broken exponents, then names in order.
pub(super) const POWERS: u16 = 40;
pub(super) const NAMES: u16 = POWERS + 1;

impl Exact {
    pub fn zero() -> Self {
        Self::rational(Rational::ZERO)
    }

    pub fn rational(value: Rational) -> Self {
        Self::Known { rational: value, pi: Rational::ZERO }
    }

    pub fn to_f64(&self) -> f64 {
        match self {
            Self::Known { rational, pi } => to_f64(rational) + to_f64(pi) * PI,
            Self::Approximate(value) => *value,
        }
    }

    /// The value when it is rational and known exactly.
    pub fn as_rational(&self) -> Option<&Rational> {
        match self {
            Self::Known { rational, pi } if pi.is_zero() => Some(rational),
            _ => None,
        }
    }

    /// The value of `expression`, exact as far as it goes; `lookup` gives each name's value with that many primes.
    pub fn evaluate(
        expression: &Expression,
        lookup: &dyn Fn(&str, u8) -> Option<Self>,
    ) -> Result<Self, ModelError> {
        evaluate(expression, lookup, Purpose::Value)
    }

    pub(super) fn is_zero(&self) -> bool {
        self.as_rational().is_some_and(Rational::is_zero)
    }

    fn negated(self) -> Self {
        match self {
            Self::Known { rational, pi } => Self::Known { rational: -rational, pi: -pi },
            Self::Approximate(value) => Self::Approximate(-value),
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        match (self, other) {
            (Self::Known { rational: a, pi: p }, Self::Known { rational: b, pi: q }) => {
                Self::Known { rational: a + b, pi: p + q }
            }
            (a, b) => Self::Approximate(a.to_f64() + b.to_f64()),
        }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    pub(super) fn times(self, other: Self) -> Self {
        match (self.as_rational(), other.as_rational()) {
            (Some(factor), _) => other.scaled(factor),
            (_, Some(factor)) => self.scaled(factor),
            _ => Self::Approximate(self.to_f64() * other.to_f64()),
        }
    }

    pub(super) fn scaled(&self, factor: &Rational) -> Self {
        match self {
            _ if factor.is_zero() => Self::zero(),
            Self::Known { rational, pi } => Self::Known { rational: rational * factor, pi: pi * factor },
            Self::Approximate(value) => Self::Approximate(value * to_f64(factor)),
        }
    }

    pub(super) fn over(self, other: Self) -> Result<Self, ModelError> {
        if let Some(divisor) = other.as_rational() {
            if divisor.is_zero() {
                return Err(undefined("division by zero"));
            }
            return Ok(self.scaled(&(Rational::ONE / divisor)));
        }
        if self.is_zero() {
            return Ok(Self::zero());
        }
        if let (Self::Known { rational: a, pi: p }, Self::Known { rational: b, pi: q }) = (&self, &other)
            // (a + pπ)/(b + qπ) is rational when one is a multiple of the other.
            && (a * q) == (b * p)
        {
            return Ok(Self::rational(p / q));
        }
        approximate(self.to_f64() / other.to_f64(), "division")
    }

    pub(super) fn raised_to(self, exponent: Self) -> Result<Self, ModelError> {
        if let (Some(base), Some(power)) = (self.as_rational(), exponent.as_rational()) {
            if base.is_zero() && *power < Rational::ZERO {
                return Err(undefined("division by zero"));
            }
            if let Some(value) = rational_power(base, power) {
                return Ok(Self::rational(value));
            }
        }
        if exponent.as_rational() == Some(&Rational::ONE) {
            return Ok(self);
        }
        approximate(self.to_f64().powf(exponent.to_f64()), "^")
    }
}

/// Results longer than this are rounded to an `f64`.
const MOST_BITS: usize = 20_000;

/// base^(n/d) when it is rational and not too long.
fn rational_power(base: &Rational, exponent: &Rational) -> Option<Rational> {
    let degree = u8::try_from(exponent.denominator().clone()).ok()?;
    let root = if degree == 1 { base.clone() } else { exact_root(base, degree)? };
    let times = isize::try_from(exponent.numerator().clone()).ok()?;
    let bits = root.numerator().bit_len().max(root.denominator().bit_len());
    if bits.saturating_sub(1).saturating_mul(times.unsigned_abs()) > MOST_BITS {
        return None;
    }
    if root.is_zero() && times < 0 {
        return None;
    }
    Some(root.pow(times))
}

pub(super) fn evaluate(
    node: &Expression,
    lookup: &dyn Fn(&str, u8) -> Option<Exact>,
    purpose: Purpose,
) -> Result<Exact, ModelError> {
    let of = |child: &Expression| evaluate(child, lookup, purpose);
    match &node.kind {
        NodeKind::Number(value) => Ok(Exact::rational(value.clone())),
        NodeKind::Pi => Ok(Exact::Known { rational: Rational::ZERO, pi: Rational::ONE }),
        NodeKind::Symbol { name, primes } => lookup(name, *primes)
            .ok_or_else(|| ModelError::NoValue { name: format!("{name}{}", "'".repeat((*primes).into())) }),
        NodeKind::Negate(a) => Ok(of(a)?.negated()),
        NodeKind::Add(a, b) => finite(of(a)?.plus(of(b)?), "+"),
        NodeKind::Subtract(a, b) => finite(of(a)?.minus(of(b)?), "-"),
        NodeKind::Multiply(a, b) => match (of(a), of(b)) {
            (Ok(a), Ok(b)) => finite(a.times(b), "*"),
            (Ok(zero), Err(kink)) | (Err(kink), Ok(zero)) if zero.is_zero() && is_kink(&kink) => Ok(zero),
            (Err(e), _) | (_, Err(e)) => Err(e),
        },
        NodeKind::Divide(a, b) => of(a)?.over(of(b)?),
        NodeKind::Power(a, b) => {
            let (base, exponent) = (of(a)?, of(b)?);
            // A whole power of a rounded value moves with it.
            let is_root = !exponent.as_rational().is_some_and(Rational::is_int);
            match (base.raised_to(exponent)?, purpose) {
                (Exact::Approximate(value), Purpose::Moved(nudge)) if is_root => {
                    approximate(value * nudge.factor(POWERS), "^")
                }
                (value, _) => Ok(value),
            }
        }
        NodeKind::Call(function, a) => call(*function, of(a)?, purpose),
    }
}

pub(super) fn call(function: Function, argument: Exact, purpose: Purpose) -> Result<Exact, ModelError> {
    if function == Function::Sign && purpose != Purpose::Value && argument.is_zero() {
        return Err(kink());
    }
    let exact = match &argument {
        Exact::Known { rational, pi } if rational.is_zero() => at_multiple_of_pi(function, pi)?,
        Exact::Known { rational, pi } if pi.is_zero() => at_rational(function, rational)?,
        _ => None,
    };
    if let Some(value) = exact {
        return Ok(value);
    }
    let value = argument.to_f64();
    match function {
        Function::Abs => Ok(if value < 0.0 { argument.negated() } else { argument }),
        Function::Sign => Ok(Exact::rational(Rational::from(if value < 0.0 { -1 } else { 1 }))),
        _ => {
            let moved = match purpose {
                Purpose::Moved(nudge) => nudge.factor(function as u16),
                _ => 1.0,
            };
            approximate(function.apply(value) * moved, function.name())
        }
    }
}

/// Where f(k·π) is exactly known, 0 included.
fn at_multiple_of_pi(function: Function, k: &Rational) -> Result<Option<Exact>, ModelError> {
    let half = Rational::ONE / Rational::from(2);
    let known = match function {
        Function::Sin => sine(k),
        Function::Cos => sine(&(k + half)),
        Function::Tan => match (sine(k), sine(&(k + &half))) {
            (_, Some(cosine)) if cosine.is_zero() => return Err(undefined("tan")),
            // sin and cos are both rational only at multiples of π/2; tan also at the odd multiples of π/4.
            (Some(sine), Some(cosine)) => Some(sine / cosine),
            _ => tangent_of_eighths(k),
        },
        _ if k.is_zero() => return at_rational(function, &Rational::ZERO),
        _ => None,
    };
    Ok(known.map(Exact::rational))
}

/// sin(k·π) where it is rational: k a multiple of 1/2, or of 1/6 with |sin| = 1/2 (Niven's theorem: nowhere else).
fn sine(k: &Rational) -> Option<Rational> {
    let sixths = (k * Rational::from(6)).clone();
    if !sixths.is_int() {
        return None;
    }
    let twelve = dashu_int::IBig::from(12);
    let turn = ((sixths.numerator() % &twelve) + &twelve) % &twelve;
    let halves = match u8::try_from(turn).ok()? {
        0 | 6 => 0,
        1 | 5 => 1,
        3 => 2,
        7 | 11 => -1,
        9 => -2,
        _ => return None,
    };
    Some(Rational::from(halves) / Rational::from(2))
}

/// tan(k·π) at the odd multiples of π/4.
fn tangent_of_eighths(k: &Rational) -> Option<Rational> {
    let quarters = k * Rational::from(4);
    if !quarters.is_int() {
        return None;
    }
    let four = dashu_int::IBig::from(4);
    let turn = ((quarters.numerator() % &four) + &four) % &four;
    match u8::try_from(turn).ok()? {
        1 => Some(Rational::ONE),
        3 => Some(Rational::NEG_ONE),
        _ => None,
    }
}

/// Where f of a rational is exactly known.
fn at_rational(function: Function, x: &Rational) -> Result<Option<Exact>, ModelError> {
    let negative = *x < Rational::ZERO;
    let size = if negative { -x } else { x.clone() };
    let pi_over =
        |n: i32| Some(Exact::Known { rational: Rational::ZERO, pi: Rational::ONE / Rational::from(n) });
    Ok(match function {
        Function::Sqrt if negative => return Err(undefined("sqrt")),
        Function::Ln if negative || x.is_zero() => return Err(undefined("ln")),
        Function::Asin | Function::Acos if size > Rational::ONE => return Err(undefined(function.name())),
        Function::Sqrt => exact_root(x, 2).map(Exact::rational),
        Function::Abs => Some(Exact::rational(size)),
        Function::Sign if x.is_zero() => Some(Exact::zero()),
        Function::Sign => Some(Exact::rational(Rational::from(if negative { -1 } else { 1 }))),
        Function::Cos | Function::Cosh | Function::Exp if x.is_zero() => Some(Exact::rational(Rational::ONE)),
        Function::Acos if x.is_zero() => pi_over(2),
        _ if x.is_zero() => Some(Exact::zero()),
        Function::Ln if *x == Rational::ONE => Some(Exact::zero()),
        Function::Asin if size == Rational::ONE => pi_over(if negative { -2 } else { 2 }),
        Function::Acos if size == Rational::ONE => {
            if negative {
                pi_over(1)
            } else {
                Some(Exact::zero())
            }
        }
        Function::Atan if size == Rational::ONE => pi_over(if negative { -4 } else { 4 }),
        _ => None,
    })
}

fn approximate(value: f64, function: &str) -> Result<Exact, ModelError> {
    if value.is_finite() { Ok(Exact::Approximate(value)) } else { Err(undefined(function)) }
}

fn finite(value: Exact, function: &str) -> Result<Exact, ModelError> {
    match value {
        Exact::Approximate(value) => approximate(value, function),
        known => Ok(known),
    }
}

fn undefined(function: &str) -> ModelError {
    ModelError::Undefined { function: function.to_owned() }
}

const KINK: &str = "the slope of abs";

fn kink() -> ModelError {
    undefined(KINK)
}

fn is_kink(error: &ModelError) -> bool {
    matches!(error, ModelError::Undefined { function } if function == KINK)
}

/// As one types it: `0.25`, `7/6`, `5*pi/6`; rounded to six figures where it is no such number.
impl std::fmt::Display for Exact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rounded = significant(self.to_f64(), 6);
        let short = |k: &Rational| k.numerator().bit_len() <= 20 && k.denominator().bit_len() <= 20;
        match self {
            Self::Known { rational, pi } if pi.is_zero() && short(rational) => {
                let decimal = parse_decimal(&rounded).ok();
                if decimal.as_ref() == Some(rational) {
                    f.write_str(&rounded)
                } else {
                    write!(f, "{rational}")
                }
            }
            Self::Known { rational, pi } if rational.is_zero() && short(pi) => {
                let top = match pi.numerator() {
                    one if *one == dashu_int::IBig::ONE => "pi".to_owned(),
                    one if *one == dashu_int::IBig::NEG_ONE => "-pi".to_owned(),
                    n => format!("{n}*pi"),
                };
                if pi.is_int() { f.write_str(&top) } else { write!(f, "{top}/{}", pi.denominator()) }
            }
            _ => f.write_str(&rounded),
        }
    }
}

impl Exact {
    /// The rational that stands for it, and whether it is its exact value.
    pub(super) fn to_rational(&self) -> (Rational, bool) {
        match self.as_rational() {
            Some(value) => (value.clone(), true),
            None => (from_f64(self.to_f64()).unwrap_or(Rational::ZERO), false),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<Exact, ModelError> {
        Exact::evaluate(&Expression::parse(text).unwrap(), &|name, primes| match (name, primes) {
            ("x", 0) => Some(Exact::rational(Rational::from(3))),
            ("theta", 0) => Some(Exact::Known { rational: Rational::ZERO, pi: Rational::ONE }),
            ("theta", _) => Some(Exact::zero()),
            _ => None,
        })
    }

    /// rational part and part of π, as texts.
    #[track_caller]
    fn check_exact(rows: &[(&str, &str, &str)]) {
        let number = |text: &str| match value(text) {
            Ok(Exact::Known { rational, .. }) => rational,
            other => panic!("{text}: {other:?}"),
        };
        for (text, rational, pi) in rows {
            let expected = Exact::Known { rational: number(rational), pi: number(pi) };
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn exact_where_it_can_be() {
        check_exact(&[
            ("2 + 3*pi - 1", "1", "3"),
            ("sin(theta)", "0", "0"),
            ("cos(theta)", "-1", "0"),
            ("cos(theta/2)", "0", "0"),
            ("sin(-pi/6)", "-1/2", "0"),
            ("sin(7*pi/6) + sin(11*pi/6)", "-1", "0"),
            ("cos(pi/3)", "1/2", "0"),
            ("cos(100*pi)", "1", "0"),
            ("tan(pi/4) + tan(3*pi/4)", "0", "0"),
            ("tan(-pi/4)", "-1", "0"),
            ("tan(pi)", "0", "0"),
            ("sqrt(6.25)", "2.5", "0"),
            ("8^(2/3) + 4^-0.5", "4.5", "0"),
            ("(2*pi)/pi", "2", "0"),
            ("(1 + pi)/(2 + 2*pi)", "0.5", "0"),
            ("asin(1) + acos(-1) + atan(1)", "0", "7/4"),
            ("exp(0) + cosh(0) + ln(1)", "2", "0"),
            ("abs(-x) + sign(-x)", "2", "0"),
            ("abs(-pi)", "0", "1"),
            ("0*exp(1)", "0", "0"),
            ("theta'^2", "0", "0"),
            ("0^0", "1", "0"),
        ]);
    }

    #[test]
    fn otherwise_nearly() {
        for (text, expected) in [
            ("sin(pi/4)", 0.5f64.sqrt()),
            ("cos(pi/6)", 0.75f64.sqrt()),
            ("exp(1)", std::f64::consts::E),
            ("pi^2", PI * PI),
            ("sqrt(2)", 2f64.sqrt()),
            ("sin(1)", 1f64.sin()),
            ("3/pi", 3.0 / PI),
        ] {
            match value(text) {
                Ok(Exact::Approximate(v)) => {
                    assert!((v - expected).abs() < 1e-15 * expected.abs() * 4.0, "{text}: {v}")
                }
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    #[test]
    fn undefined_is_an_error() {
        for text in [
            "1/0",
            "tan(pi/2)",
            "ln(0)",
            "sqrt(-1)",
            "asin(2)",
            "0^-1",
            "(-2)^0.5",
            "exp(10000)",
            "1/(pi - pi)",
        ] {
            assert!(matches!(value(text), Err(ModelError::Undefined { .. })), "{text}: {:?}", value(text));
        }
        assert_eq!(value("y''"), Err(ModelError::NoValue { name: "y''".to_owned() }));
    }

    #[test]
    fn shown_as_one_types_it() {
        for (text, shown) in [
            ("1/4", "0.25"),
            ("-7/6", "-7/6"),
            ("0", "0"),
            ("pi", "pi"),
            ("-pi/2", "-pi/2"),
            ("5*pi/6", "5*pi/6"),
            ("sqrt(2)", "1.41421"),
            ("1 + pi", "4.14159"),
            ("1/3^40", "8.22526e-20"),
        ] {
            assert_eq!(value(text).unwrap().to_string(), shown, "{text}");
        }
    }

    #[test]
    fn huge_powers_are_rounded_not_held() {
        assert!(matches!(value("1.0001^99999"), Ok(Exact::Approximate(_))));
        assert!(matches!(value("3^99999999999"), Err(ModelError::Undefined { .. })));
    }
}
