//! Linear models as they are given: a transfer function, zeros, poles and gain, or A, B, C, D, in letters or numbers.

mod coefficient;
mod quotient;

use self::coefficient::Letters;
use super::Equation;
use crate::algebra::{Expression, ExpressionError, Rational};

/// How a linear model was given, in the letters of the lab.
#[derive(Clone, Debug, PartialEq)]
pub enum LinearForm {
    /// Coefficients, the highest power of s first; neither is empty. `formula` is it as typed, where it was one.
    TransferFunction { num: Vec<Expression>, den: Vec<Expression>, formula: Option<Expression> },
    /// gain · Π (s − zero) / Π (s − pole), and the same as coefficients.
    ZerosPolesGain {
        zeros: Vec<Root>,
        poles: Vec<Root>,
        gain: Expression,
        num: Vec<Expression>,
        den: Vec<Expression>,
    },
    /// ẋ = a x + b u, y = c x + d u; n×n, n×m, p×n, p×m.
    StateSpace { a: Rows, b: Rows, c: Rows, d: Rows },
}

type Rows = Vec<Vec<Expression>>;

/// A zero or a pole, or two of them at once.
#[derive(Clone, Debug, PartialEq)]
pub enum Root {
    Real(Expression),
    /// re ± im·j
    Conjugate {
        re: Expression,
        im: Expression,
    },
    /// middle ± by
    Pair {
        middle: Expression,
        by: Expression,
    },
}

impl LinearForm {
    /// A formula in s, multiplied out and not cancelled.
    pub fn of_formula(formula: Expression) -> Result<Self, ExpressionError> {
        let (num, den) = quotient::quotient(&formula)?;
        let (start, end) = (formula.start, formula.end);
        if num.is_empty() {
            let message = "this transfer function is zero".to_owned();
            return Err(ExpressionError { start, end, message, help: None });
        }
        Ok(Self::TransferFunction { num, den, formula: Some(formula) })
    }

    /// From zeros and poles; multiple ones are repeated.
    pub fn of_roots(zeros: Vec<Root>, poles: Vec<Root>, gain: Expression) -> Result<Self, ExpressionError> {
        let (num, den) = quotient::quotient(&of_roots(&zeros, &poles, &gain))?;
        Ok(Self::ZerosPolesGain { zeros, poles, gain, num, den })
    }

    /// It as one formula in s; none for A, B, C, D.
    pub fn formula(&self) -> Option<Expression> {
        match self {
            Self::TransferFunction { formula: Some(formula), .. } => Some(formula.clone()),
            Self::TransferFunction { num, den, .. } => Some(polynomial(num).over(polynomial(den))),
            Self::ZerosPolesGain { zeros, poles, gain, .. } => Some(of_roots(zeros, poles, gain)),
            Self::StateSpace { .. } => None,
        }
    }

    pub fn output_count(&self) -> usize {
        match self {
            Self::StateSpace { c, .. } => c.len(),
            _ => 1,
        }
    }

    /// The equations of motion: at rest where everything is 0.
    ///
    /// A transfer function becomes den(d/dt) z = u, y = num(d/dt) z: `coordinates` are a z that nobody sees, and the output.
    /// These equations have no text, since nobody has printed them. Of A, B, C, D the coordinates are the states, then the
    /// outputs.
    pub fn equations(&self, inputs: &[String], coordinates: &[String]) -> Vec<Equation> {
        match self {
            Self::StateSpace { a, b, c, d } => of_state_space([a, b, c, d], inputs, coordinates),
            Self::TransferFunction { num, den, .. } | Self::ZerosPolesGain { num, den, .. } => {
                let ([inner, output], [input]) = (coordinates, inputs) else { return Vec::new() };
                let acting = |coefficients: &[Expression]| {
                    let powers = coefficients.iter().rev().enumerate().rev().map(|(power, coefficient)| {
                        let primes = u8::try_from(power).unwrap_or(u8::MAX);
                        coefficient.clone().times(Expression::of_symbol(inner, primes))
                    });
                    Expression::sum(powers.collect())
                };
                let symbol = |name: &str| Expression::of_symbol(name, 0);
                vec![
                    Equation { text: String::new(), left: acting(den), right: symbol(input) },
                    Equation { text: String::new(), left: symbol(output), right: acting(num) },
                ]
            }
        }
    }
}

impl Root {
    /// s − root, or (s − re)² + im² of a pair; the letters multiplied out.
    fn factor(&self) -> Expression {
        let s = || Expression::of_symbol("s", 0);
        let minus = |e: &Expression| s().plus(negated(e));
        let squared = |e: &Expression| {
            let mut letters = Letters::default();
            let value = letters.coefficient(e).and_then(|value| letters.product(&value, &value));
            value.map_or_else(|_| e.clone().to_power(2), |value| value.expression(&letters))
        };
        let around = |middle: &Expression| match minus(middle) {
            alone if alone == s() => s().to_power(2),
            shifted => shifted.to_power(2),
        };
        match self {
            Self::Real(at) => minus(at),
            Self::Conjugate { re, im } => around(re).plus(squared(im)),
            Self::Pair { middle, by } => around(middle).plus(negated(&squared(by))),
        }
    }
}

fn of_roots(zeros: &[Root], poles: &[Root], gain: &Expression) -> Expression {
    let product = |roots: &[Root]| {
        let one = Expression::of_number(Rational::ONE);
        roots.iter().fold(one, |product, root| product.times(root.factor()))
    };
    gain.clone().times(product(zeros)).over(product(poles))
}

fn negated(e: &Expression) -> Expression {
    e.clone().negated()
}

/// Σ coefficient · s^k
fn polynomial(coefficients: &[Expression]) -> Expression {
    let terms = coefficients.iter().enumerate().map(|(i, coefficient)| {
        let power = coefficients.len() - 1 - i;
        coefficient.clone().times(Expression::of_symbol("s", 0).to_power(power))
    });
    terms.fold(Expression::of_number(Rational::ZERO), |sum, term| sum.plus(term))
}

fn of_state_space([a, b, c, d]: [&Rows; 4], inputs: &[String], coordinates: &[String]) -> Vec<Equation> {
    let (states, outputs) = coordinates.split_at(a.len().min(coordinates.len()));
    let sum = |from_states: &[Expression], from_inputs: &[Expression]| {
        let factors = from_states.iter().zip(states).chain(from_inputs.iter().zip(inputs));
        let terms = factors.map(|(factor, name)| factor.clone().times(Expression::of_symbol(name, 0)));
        terms.fold(Expression::of_number(Rational::ZERO), Expression::plus)
    };
    let rates = states
        .iter()
        .zip(a.iter().zip(b))
        .map(|(name, (a, b))| printed(Expression::of_symbol(name, 1), sum(a, b)));
    let seen = outputs
        .iter()
        .zip(c.iter().zip(d))
        .map(|(name, (c, d))| printed(Expression::of_symbol(name, 0), sum(c, d)));
    rates.chain(seen).collect()
}

/// With the text one would print, and each node at its place in it.
fn printed(left: Expression, right: Expression) -> Equation {
    let text = format!("{left} = {right}");
    match Expression::parse_equation(&text) {
        Ok((left, right)) => Equation { text, left, right },
        Err(_) => Equation { text: String::new(), left, right },
    }
}
