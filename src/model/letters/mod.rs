//! The transfer function in the lab's own letters, derived step by step: linearized, transformed, eliminated, cancelled.

mod derive;
mod determinant;
mod equality;
mod form;
mod order;
mod places;
mod rest;
mod ring;
mod signal;
mod symbolic;
mod used;

use super::{Equilibrium, Model};
use crate::algebra::{Expression, MultivariatePolynomial, OverBudget, Polynomial, Rational, to_f64};
use crate::lti::TransferFunction;
pub use equality::is_light;
pub use places::LetterPlace;
pub use rest::{LetterAtRest, known_at_rest, letters_at_rest};
use ring::Ring;
pub use signal::Signal;
use std::collections::BTreeMap;
pub use used::letters_used;

/// Every step from the equations to the transfer function, in letters.
///
/// Values at rest that are neither 0 nor a multiple of π are letters with the index 0: `h_0`. What is shown can be read back
/// by [`Expression::parse_typed`].
#[derive(Clone, Debug)]
pub struct LetterDerivation {
    /// Coordinates and inputs that are not at rest at 0, in the order of the model.
    pub rest: Vec<AtRest>,
    /// The equations at rest, left and right, where they are not 0 = 0.
    pub rest_equations: Vec<(Expression, Expression)>,
    /// The linearized equations in deviations from rest, the input on the right.
    pub linear: Vec<LetterEquation>,
    /// Their Laplace transforms, everything at rest before.
    pub transformed: Vec<LetterEquation>,
    /// The same without fractions; `None` where there are none.
    pub without_fractions: Option<Vec<LetterEquation>>,
    /// matrix · unknowns = forcing · input.
    pub matrix: Vec<Vec<Expression>>,
    pub unknowns: Vec<Signal>,
    pub forcing: Vec<Expression>,
    pub input: Signal,
    /// Which of the unknowns is asked for.
    pub output: usize,
    /// The determinant with the forcing in the output's column, and that of the matrix, collected by powers of s.
    pub numerator: Expression,
    pub denominator: Expression,
    /// What both share and is cancelled; `None` when there is nothing but a number.
    pub cancelled: Option<Expression>,
    /// The transfer function.
    pub num: Expression,
    pub den: Expression,
    /// The coefficient of each power of s in both, lowest power first, zeros left out.
    pub num_coefficients: Vec<(u32, Expression)>,
    pub den_coefficients: Vec<(u32, Expression)>,
    function: LetterFunction,
    /// What is 0 or a multiple of π at rest, by the name it would have as a letter: `theta_0`.
    known: BTreeMap<String, Expression>,
    /// What is 0 among the letters: the equations at rest, and parameters that follow from others.
    relations: Vec<MultivariatePolynomial>,
    /// The same of roots that are letters.
    roots: Vec<MultivariatePolynomial>,
}

/// A coordinate or input away from 0 at rest.
#[derive(Clone, Debug)]
pub struct AtRest {
    pub name: String,
    /// Its letter, `h_0`, or its value where that is a multiple of π.
    pub is: Expression,
    pub value: f64,
}

/// Σ left = Σ right; nothing is 0.
#[derive(Clone, Debug)]
pub struct LetterEquation {
    pub left: Vec<LetterTerm>,
    pub right: Vec<LetterTerm>,
}

/// ± coefficient · signal.
#[derive(Clone, Debug)]
pub struct LetterTerm {
    pub negative: bool,
    pub coefficient: Expression,
    pub signal: Signal,
}

/// Why there is no derivation in letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LettersError {
    #[error("in letters the transfer function takes more terms than a page holds")]
    OverBudget,
    #[error("in letters the equations cannot be solved")]
    Unsolvable,
}

/// How the letters, the lab's numbers put in, agree with the transfer function computed from numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LetterAgreement {
    /// Exactly.
    Exact,
    /// The largest relative difference at several places s, where a number at rest is irrational.
    Within(f64),
    Differs,
}

/// A quotient of polynomials in s and letters.
#[derive(Clone, Debug)]
struct LetterFunction {
    ring: Ring,
    num: MultivariatePolynomial,
    den: MultivariatePolynomial,
}

/// What stops a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    OverBudget,
    Undefined,
    /// The slope of |u| where u is 0.
    Kink,
}

impl From<OverBudget> for Trouble {
    fn from(_: OverBudget) -> Self {
        Self::OverBudget
    }
}

impl From<Trouble> for LettersError {
    fn from(trouble: Trouble) -> Self {
        match trouble {
            Trouble::OverBudget => Self::OverBudget,
            Trouble::Undefined | Trouble::Kink => Self::Unsolvable,
        }
    }
}

impl LetterDerivation {
    /// Derives the transfer function from `input` to `output` at an equilibrium, in letters.
    ///
    /// `parameters` give the signs of what stands under |…|, and the sign of the leading coefficient.
    /// Errors: more work than the budget, or no solution.
    pub fn derive(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        at: &Equilibrium,
        input: &str,
        output: &str,
    ) -> Result<Self, LettersError> {
        derive::derive(model, parameters, at, input, output).map_err(LettersError::from)
    }

    /// num/den as one formula.
    pub fn transfer_function(&self) -> Expression {
        let one = matches!(&self.den.kind, crate::algebra::NodeKind::Number(n) if *n == Rational::ONE);
        if one {
            return self.num.clone();
        }
        ring::node(crate::algebra::NodeKind::Divide(Box::new(self.num.clone()), Box::new(self.den.clone())))
    }

    /// Every letter that may stand in an answer: parameters and values at rest.
    pub fn letters(&self) -> Vec<&str> {
        let named = self.function.ring.generators.iter().filter_map(|generator| match &generator.atom {
            ring::Atom::Name { name, .. } => Some(name.as_str()),
            _ => None,
        });
        named.collect()
    }

    /// The formula with what is 0 or a multiple of π at rest put in: cos(π/6) for `cos(theta_0)`.
    pub fn with_rest(&self, formula: &Expression) -> Expression {
        formula.replaced(&|node| match &node.kind {
            crate::algebra::NodeKind::Symbol { name, primes: 0 } => self.known.get(name).cloned(),
            _ => None,
        })
    }

    /// Whether a letter is needed at all: without any, numbers are the answer.
    pub fn has_letters(&self) -> bool {
        let polys = [&self.function.num, &self.function.den];
        polys.iter().any(|poly| poly.letters().iter().any(|letter| *letter != ring::S))
    }

    /// Puts the lab's numbers in and compares with what was computed from numbers.
    pub fn agreement(&self, numeric: &TransferFunction) -> LetterAgreement {
        match self.function.in_numbers() {
            Some(own) if own.equals(numeric) => LetterAgreement::Exact,
            Some(_) => LetterAgreement::Differs,
            None => self.function.nearness(numeric),
        }
    }
}

impl LetterFunction {
    /// With the lab's numbers; `None` when one of them is irrational.
    fn in_numbers(&self) -> Option<TransferFunction> {
        let polynomial = |poly: &MultivariatePolynomial| {
            let mut coefficients = Vec::new();
            for part in poly.coefficients_of(ring::S).iter().rev() {
                let known =
                    part.letters().iter().all(|l| self.ring.generators[usize::from(*l)].exact.is_some());
                let value =
                    |l: u16| self.ring.generators[usize::from(l)].exact.clone().unwrap_or(Rational::ZERO);
                coefficients.push(known.then(|| part.eval(&value, &Rational::clone))?);
            }
            Some(Polynomial::new(coefficients))
        };
        TransferFunction::new(polynomial(&self.num)?, polynomial(&self.den)?)
    }

    fn nearness(&self, numeric: &TransferFunction) -> LetterAgreement {
        let value = |poly: &MultivariatePolynomial, s: f64| {
            let parts = poly.coefficients_of(ring::S);
            parts.iter().rev().fold(0.0, |sum, part| sum * s + self.ring.value(part))
        };
        let horner = |p: &Polynomial, s: f64| p.coefficients().iter().fold(0.0, |sum, c| sum * s + to_f64(c));
        let mut worst: f64 = 0.0;
        for s in [0.37, 1.9, 7.3, 31.0] {
            let (a, b) = (
                value(&self.num, s) * horner(&numeric.den, s),
                value(&self.den, s) * horner(&numeric.num, s),
            );
            let size = a.abs().max(b.abs());
            let off = if size == 0.0 { 0.0 } else { (a - b).abs() / size };
            worst = if off.is_finite() { worst.max(off) } else { f64::INFINITY };
        }
        if worst < 1e-9 { LetterAgreement::Within(worst) } else { LetterAgreement::Differs }
    }
}

#[cfg(test)]
mod tests;
