//! Exact numbers for the letters, at which a formula in letters can be held against the derived one.

use super::ring::{Atom, Ring, S};
use super::{LetterDerivation, LetterFunction};
use crate::algebra::{
    Expression, Function, Letter, MultivariatePolynomial as Poly, NodeKind, Polynomial, Rational, from_f64,
};
use crate::lti::TransferFunction;
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};

/// A value for every letter such that the equations at rest hold, and the transfer function there.
#[derive(Clone, Debug)]
pub struct LetterPlace {
    pub values: BTreeMap<String, Rational>,
    /// Common factors cancelled.
    pub function: TransferFunction,
}

impl LetterDerivation {
    /// The `nth` place out of many; `None` where the relations at rest cannot be met in rationals.
    pub fn place(&self, nth: usize) -> Option<LetterPlace> {
        let LetterFunction { ring, num, den } = &self.function;
        let mut values = free_values(ring, nth)?;
        let solved = solved(ring, self.relations.iter().chain(&self.roots))?;
        for (letter, relation) in solved.into_iter().rev() {
            let parts = relation.coefficients_of(letter);
            let (rest, slope) = (at(parts.first()?, &values), at(parts.get(1)?, &values));
            if slope.is_zero() {
                return None;
            }
            values[usize::from(letter)] = -rest / slope;
        }
        let polynomial = |poly: &Poly| {
            let parts = poly.coefficients_of(S);
            Polynomial::new(parts.iter().rev().map(|part| at(part, &values)).collect())
        };
        let function = TransferFunction::new(polynomial(num), polynomial(den))?.cancelled().0;
        let mut named = BTreeMap::new();
        for (generator, value) in ring.generators.iter().zip(&values) {
            if let Atom::Name { name, order } = &generator.atom {
                named.insert(name.clone(), value.pow(isize::try_from(*order).unwrap_or(1)));
            }
        }
        Some(LetterPlace { values: named, function })
    }
}

impl LetterPlace {
    /// The value of a formula as a quotient of polynomials in `variable`, nothing cancelled; `None` when it is not rational here.
    ///
    /// Functions that are not algebraic have a fixed value for each value of their argument, so that equal formulas are equal;
    /// sin² + cos² = 1 holds.
    pub fn function_of(&self, formula: &Expression, variable: &str) -> Option<TransferFunction> {
        let algebraic = self.without_calls(formula)?;
        let (num, den) = algebraic.rational_function(variable, &self.values).ok()?;
        TransferFunction::new(num, den)
    }

    fn without_calls(&self, node: &Expression) -> Option<Expression> {
        let with = |kind: NodeKind| Expression { kind, start: node.start, end: node.end };
        let of = |a: &Expression| self.without_calls(a).map(Box::new);
        Some(with(match &node.kind {
            NodeKind::Call(function, a) if !matches!(function, Function::Sqrt | Function::Abs) => {
                let argument = self.without_calls(a)?;
                let (num, den) = argument.rational_function(NO_VARIABLE, &self.values).ok()?;
                let divisor = den.coefficient(0);
                if den.degree() > 0 || num.degree() > 0 || divisor.is_zero() {
                    return None;
                }
                NodeKind::Number(call_value(*function, &(num.coefficient(0) / divisor)))
            }
            NodeKind::Call(function, a) => NodeKind::Call(*function, of(a)?),
            NodeKind::Negate(a) => NodeKind::Negate(of(a)?),
            NodeKind::Add(a, b) => NodeKind::Add(of(a)?, of(b)?),
            NodeKind::Subtract(a, b) => NodeKind::Subtract(of(a)?, of(b)?),
            NodeKind::Multiply(a, b) => NodeKind::Multiply(of(a)?, of(b)?),
            NodeKind::Divide(a, b) => NodeKind::Divide(of(a)?, of(b)?),
            NodeKind::Power(a, b) => NodeKind::Power(of(a)?, of(b)?),
            other => other.clone(),
        }))
    }
}

/// A letter for each relation, in which it is linear, such that no later relation has that letter; `None` when there are none.
///
/// What is known last is chosen first: a letter that only one relation needs can wait for all others.
pub(super) fn solved<'a>(
    ring: &Ring,
    relations: impl IntoIterator<Item = &'a Poly>,
) -> Option<Vec<(Letter, &'a Poly)>> {
    let mut open: Vec<&Poly> = relations.into_iter().collect();
    let mut solved = Vec::new();
    while !open.is_empty() {
        let (index, letter) = open.iter().enumerate().find_map(|(index, relation)| {
            let only_here = |letter: &Letter| {
                let elsewhere = open.iter().enumerate().any(|(i, p)| i != index && p.degree_in(*letter) > 0);
                !elsewhere && relation.degree_in(*letter) == 1 && is_free(ring, *letter)
            };
            Some((index, relation.letters().into_iter().rev().find(only_here)?))
        })?;
        solved.push((letter, open.remove(index)));
    }
    Some(solved)
}

/// No name is written so.
const NO_VARIABLE: &str = " ";

/// A letter whose value may follow from others: a name that stands under no root and in no function.
fn is_free(ring: &Ring, letter: Letter) -> bool {
    let in_call = ring.generators.iter().any(|generator| match &generator.atom {
        Atom::Call { argument, .. } => {
            argument.num.degree_in(letter) > 0 || argument.den.degree_in(letter) > 0
        }
        _ => false,
    });
    matches!(ring.atom(letter), Some(Atom::Name { order: 1, .. })) && !in_call
}

fn at(poly: &Poly, values: &[Rational]) -> Rational {
    poly.eval(&|letter| values.get(usize::from(letter)).cloned().unwrap_or(Rational::ZERO), &Rational::clone)
}

/// Squares for what is positive, so that square roots of products of letters are rational.
fn free_values(ring: &Ring, nth: usize) -> Option<Vec<Rational>> {
    const PRIMES: [u32; 24] =
        [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89];
    let mut values: Vec<Rational> = Vec::with_capacity(ring.generators.len());
    for (index, generator) in ring.generators.iter().enumerate() {
        let prime = |step: usize| Rational::from(PRIMES[(index * step + 7 * nth + step) % PRIMES.len()]);
        let base = prime(1) / prime(5);
        let base = if base == Rational::ONE { prime(3) + Rational::ONE } else { base };
        values.push(match &generator.atom {
            Atom::S => Rational::ZERO,
            Atom::Pi => from_f64(std::f64::consts::PI)?,
            Atom::Name { order: 1, .. } => {
                let square = &base * &base;
                if generator.value < 0.0 { -square } else { square }
            }
            Atom::Name { .. } | Atom::Root { .. } => base,
            Atom::Call { function, argument } => {
                let below = at(&argument.den, &values);
                if below.is_zero() {
                    return None;
                }
                call_value(*function, &(at(&argument.num, &values) / below))
            }
        });
    }
    Some(values)
}

/// A rational in place of a function's value, the same for the same argument; even and odd as the function is.
fn call_value(function: Function, argument: &Rational) -> Rational {
    let negative = *argument < Rational::ZERO;
    let size = if negative { -argument } else { argument.clone() };
    let odd = |value: Rational| if negative { -value } else { value };
    let circular = |code: u8| {
        let t = chosen(code, &size);
        let square = &t * &t;
        let below = Rational::ONE + &square;
        (Rational::from(2) * t / &below, (Rational::ONE - square) / below)
    };
    match function {
        Function::Sin => odd(circular(0).0),
        Function::Cos => circular(0).1,
        Function::Tan => {
            let (sine, cosine) = circular(0);
            odd(sine / cosine)
        }
        Function::Exp => {
            let value = chosen(1, &size);
            if negative { Rational::ONE / value } else { value }
        }
        Function::Sinh | Function::Cosh | Function::Tanh => {
            let value = chosen(1, &size);
            let inverse = Rational::ONE / &value;
            let two = Rational::from(2);
            match function {
                Function::Sinh => odd((value - inverse) / two),
                Function::Cosh => (value + inverse) / two,
                _ => odd((&value - &inverse) / (&value + &inverse)),
            }
        }
        Function::Asin | Function::Atan => odd(chosen(function as u8 + 8, &size)),
        Function::Sign => Rational::from(if negative { -1 } else { 1 }),
        _ => chosen(function as u8 + 8, argument),
    }
}

/// A fraction of small primes, by the argument alone.
fn chosen(code: u8, argument: &Rational) -> Rational {
    // The hasher's start is fixed, so that the same formula gives the same fraction on every machine.
    let mut hasher = Fnv(0xcbf2_9ce4_8422_2325);
    (code, argument.to_string()).hash(&mut hasher);
    let hash = hasher.finish();
    Rational::from(3 + 2 * (hash % 97)) / Rational::from(2 + 2 * ((hash >> 32) % 89))
}

/// Fowler, Noll and Vo's hash, 1a.
struct Fnv(u64);

impl Hasher for Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }
}
