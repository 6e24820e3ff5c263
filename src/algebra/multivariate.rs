use super::Rational;
use dashu_int::ops::BitTest;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// A letter of a [`MultivariatePolynomial`], by its number; who holds the polynomial knows the names.
pub type Letter = u16;

/// A product of letters, each with its power above 0, letters rising; nothing is 1.
///
/// Ordered lexicographically, letter 0 first: x² > x y > x > y² > 1.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct Monomial {
    powers: Vec<(Letter, u32)>,
}

impl Monomial {
    pub fn letter(letter: Letter, power: u32) -> Self {
        Self { powers: if power == 0 { Vec::new() } else { vec![(letter, power)] } }
    }

    /// Each letter and its power, letters rising.
    pub fn powers(&self) -> &[(Letter, u32)] {
        &self.powers
    }

    pub fn power_of(&self, letter: Letter) -> u32 {
        self.powers.iter().find(|(l, _)| *l == letter).map_or(0, |(_, power)| *power)
    }

    /// The sum of its powers.
    pub fn degree(&self) -> u32 {
        self.powers.iter().map(|(_, power)| *power).sum()
    }

    fn merged(&self, other: &Self, join: impl Fn(u32, u32) -> u32) -> Self {
        let mut powers = Vec::with_capacity(self.powers.len() + other.powers.len());
        let (mut a, mut b) = (self.powers.iter().peekable(), other.powers.iter().peekable());
        loop {
            let (letter, left, right) = match (a.peek(), b.peek()) {
                (Some((x, p)), Some((y, q))) => match x.cmp(y) {
                    Ordering::Less => (*x, *p, 0),
                    Ordering::Greater => (*y, 0, *q),
                    Ordering::Equal => (*x, *p, *q),
                },
                (Some((x, p)), None) => (*x, *p, 0),
                (None, Some((y, q))) => (*y, 0, *q),
                (None, None) => break,
            };
            if a.peek().is_some_and(|(x, _)| *x == letter) {
                a.next();
            }
            if b.peek().is_some_and(|(y, _)| *y == letter) {
                b.next();
            }
            let power = join(left, right);
            if power > 0 {
                powers.push((letter, power));
            }
        }
        Self { powers }
    }

    pub fn times(&self, other: &Self) -> Self {
        self.merged(other, |p, q| p + q)
    }

    /// What both hold.
    pub fn shared(&self, other: &Self) -> Self {
        self.merged(other, u32::min)
    }

    /// `None` when `other` is no part of it.
    pub fn over(&self, other: &Self) -> Option<Self> {
        let fits = other.powers.iter().all(|(letter, power)| self.power_of(*letter) >= *power);
        fits.then(|| self.merged(other, |p, q| p.saturating_sub(q)))
    }

    /// Without `letter`.
    pub fn without(&self, letter: Letter) -> Self {
        Self { powers: self.powers.iter().copied().filter(|(l, _)| *l != letter).collect() }
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        for ((x, p), (y, q)) in self.powers.iter().zip(&other.powers) {
            // The smaller letter weighs more, and the other has none of it.
            let order = y.cmp(x).then(p.cmp(q));
            if order != Ordering::Equal {
                return order;
            }
        }
        self.powers.len().cmp(&other.powers.len())
    }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// It would take more terms, higher powers, longer numbers or more steps than we go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("multiplied out, this takes more work than we do")]
pub struct OverBudget;

/// How much work is left: every operation on polynomials in letters is charged for its products of coefficients.
#[derive(Clone, Debug)]
pub struct Budget {
    left: usize,
}

/// Terms of one polynomial.
const MOST_TERMS: usize = 3_000;
/// Degree of a monomial.
const MOST_DEGREE: u32 = 200;
/// Length of a numerator or denominator.
const MOST_BITS: usize = 2_048;

impl Budget {
    /// `steps` products of short coefficients; long ones count for more.
    pub fn new(steps: usize) -> Self {
        Self { left: steps }
    }

    pub fn spend(&mut self, steps: usize) -> Result<(), OverBudget> {
        self.left = self.left.checked_sub(steps).ok_or(OverBudget)?;
        Ok(())
    }
}

/// A polynomial in letters with exact rational coefficients, none of them 0.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct MultivariatePolynomial {
    terms: BTreeMap<Monomial, Rational>,
}

impl MultivariatePolynomial {
    pub fn zero() -> Self {
        Self::default()
    }

    pub fn one() -> Self {
        Self::constant(Rational::ONE)
    }

    pub fn constant(value: Rational) -> Self {
        Self::term(value, Monomial::default())
    }

    pub fn letter(letter: Letter) -> Self {
        Self::term(Rational::ONE, Monomial::letter(letter, 1))
    }

    pub fn term(coefficient: Rational, monomial: Monomial) -> Self {
        let mut terms = BTreeMap::new();
        if !coefficient.is_zero() {
            terms.insert(monomial, coefficient);
        }
        Self { terms }
    }

    /// Leading term first.
    pub fn terms(&self) -> impl DoubleEndedIterator<Item = (&Monomial, &Rational)> {
        self.terms.iter().rev()
    }

    pub fn term_count(&self) -> usize {
        self.terms.len()
    }

    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// The value when there is no letter in it.
    pub fn as_constant(&self) -> Option<Rational> {
        match self.terms.iter().next() {
            None => Some(Rational::ZERO),
            Some((monomial, value)) => {
                (self.terms.len() == 1 && monomial.powers.is_empty()).then(|| value.clone())
            }
        }
    }

    /// The largest monomial and its coefficient; `None` for zero.
    pub fn leading(&self) -> Option<(&Monomial, &Rational)> {
        self.terms.iter().next_back()
    }

    /// Every letter in it, rising.
    pub fn letters(&self) -> Vec<Letter> {
        let mut letters: Vec<Letter> =
            self.terms.keys().flat_map(|m| m.powers.iter().map(|(letter, _)| *letter)).collect();
        letters.sort_unstable();
        letters.dedup();
        letters
    }

    pub fn degree_in(&self, letter: Letter) -> u32 {
        self.terms.keys().map(|monomial| monomial.power_of(letter)).max().unwrap_or(0)
    }

    pub fn negated(&self) -> Self {
        Self { terms: self.terms.iter().map(|(m, c)| (m.clone(), -c)).collect() }
    }

    pub fn scaled(&self, factor: &Rational) -> Self {
        if factor.is_zero() {
            return Self::zero();
        }
        Self { terms: self.terms.iter().map(|(m, c)| (m.clone(), c * factor)).collect() }
    }

    pub fn plus(&self, other: &Self, budget: &mut Budget) -> Result<Self, OverBudget> {
        let mut sum = self.clone();
        budget.spend(other.terms.len())?;
        for (monomial, coefficient) in &other.terms {
            sum.add(monomial.clone(), coefficient.clone())?;
        }
        Ok(sum)
    }

    pub fn minus(&self, other: &Self, budget: &mut Budget) -> Result<Self, OverBudget> {
        self.plus(&other.negated(), budget)
    }

    pub fn times(&self, other: &Self, budget: &mut Budget) -> Result<Self, OverBudget> {
        let cost = self.terms.len().saturating_mul(other.terms.len());
        budget.spend(cost.saturating_mul(1 + (self.bits() + other.bits()) / 128))?;
        let mut product = Self::zero();
        for (a, x) in &self.terms {
            for (b, y) in &other.terms {
                product.add(a.times(b), x * y)?;
            }
        }
        Ok(product)
    }

    pub fn raised_to(&self, power: u32, budget: &mut Budget) -> Result<Self, OverBudget> {
        let mut result = Self::one();
        if power > MOST_DEGREE {
            return match self.as_constant() {
                Some(value) if value.is_zero() || value == Rational::ONE => Ok(self.clone()),
                _ => Err(OverBudget),
            };
        }
        for _ in 0..power {
            result = result.times(self, budget)?;
        }
        Ok(result)
    }

    /// By powers of `letter`, lowest first; empty for zero.
    pub fn coefficients_of(&self, letter: Letter) -> Vec<Self> {
        let mut parts =
            vec![Self::zero(); if self.is_zero() { 0 } else { self.degree_in(letter) as usize + 1 }];
        for (monomial, coefficient) in &self.terms {
            let part = &mut parts[monomial.power_of(letter) as usize];
            part.terms.insert(monomial.without(letter), coefficient.clone());
        }
        parts
    }

    /// The product of letters in every term; 1 for zero.
    pub fn shared_monomial(&self) -> Monomial {
        let mut all = self.terms.keys();
        let first = all.next().cloned().unwrap_or_default();
        all.fold(first, |shared, monomial| shared.shared(monomial))
    }

    /// With `other` in place of `letter`.
    pub fn with(&self, letter: Letter, other: &Self, budget: &mut Budget) -> Result<Self, OverBudget> {
        // By Horner's rule.
        let mut result = Self::zero();
        for part in self.coefficients_of(letter).iter().rev() {
            result = result.times(other, budget)?.plus(part, budget)?;
        }
        Ok(result)
    }

    /// The value where `value` gives that of each letter.
    pub fn eval<T>(&self, value: &dyn Fn(Letter) -> T, of: &dyn Fn(&Rational) -> T) -> T
    where
        T: Clone + std::ops::Add<Output = T> + std::ops::Mul<Output = T>,
    {
        let mut sum = of(&Rational::ZERO);
        for (monomial, coefficient) in &self.terms {
            let mut product = of(coefficient);
            for (letter, power) in &monomial.powers {
                let factor = value(*letter);
                for _ in 0..*power {
                    product = product * factor.clone();
                }
            }
            sum = sum + product;
        }
        sum
    }

    /// Adds one term.
    fn add(&mut self, monomial: Monomial, coefficient: Rational) -> Result<(), OverBudget> {
        use std::collections::btree_map::Entry;
        match self.terms.entry(monomial) {
            Entry::Vacant(place) => {
                if place.key().degree() > MOST_DEGREE || bits(&coefficient) > MOST_BITS {
                    return Err(OverBudget);
                }
                if !coefficient.is_zero() {
                    place.insert(coefficient);
                }
            }
            Entry::Occupied(mut place) => {
                let sum = place.get() + coefficient;
                if bits(&sum) > MOST_BITS {
                    return Err(OverBudget);
                }
                if sum.is_zero() {
                    place.remove();
                } else {
                    place.insert(sum);
                }
            }
        }
        if self.terms.len() > MOST_TERMS { Err(OverBudget) } else { Ok(()) }
    }

    /// Length of the longest coefficient.
    fn bits(&self) -> usize {
        self.terms.values().map(bits).max().unwrap_or(0)
    }
}

fn bits(value: &Rational) -> usize {
    value.numerator().bit_len().max(value.denominator().bit_len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn letter(letter: Letter) -> MultivariatePolynomial {
        MultivariatePolynomial::letter(letter)
    }

    #[test]
    fn monomials_are_ordered_by_their_letters() {
        let falling = [
            Monomial::letter(0, 2),
            Monomial::letter(0, 1).times(&Monomial::letter(1, 1)),
            Monomial::letter(0, 1),
            Monomial::letter(1, 3),
            Monomial::letter(1, 1).times(&Monomial::letter(2, 1)),
            Monomial::letter(2, 9),
            Monomial::default(),
        ];
        for pair in falling.windows(2) {
            assert!(pair[0] > pair[1], "{pair:?}");
        }
    }

    #[test]
    fn arithmetic() {
        let mut budget = Budget::new(1_000);
        let (a, b) = (letter(0), letter(1));
        let sum = a.plus(&b, &mut budget).unwrap();
        let difference = a.minus(&b, &mut budget).unwrap();
        let squares = a.raised_to(2, &mut budget).unwrap();
        let squares = squares.minus(&b.raised_to(2, &mut budget).unwrap(), &mut budget).unwrap();
        assert_eq!(sum.times(&difference, &mut budget).unwrap(), squares);
        assert!(squares.minus(&squares, &mut budget).unwrap().is_zero());
        assert_eq!(squares.coefficients_of(0).len(), 3);
        assert_eq!(squares.with(0, &b, &mut budget).unwrap(), MultivariatePolynomial::zero());
        let at = squares.eval(&|l| Rational::from(u32::from(l) + 2), &Rational::clone);
        assert_eq!(at, Rational::from(-5));
    }

    #[test]
    fn what_takes_too_much_is_refused() {
        let mut budget = Budget::new(200_000);
        let four = (1..4).fold(letter(0), |sum, l| sum.plus(&letter(l), &mut budget).unwrap());
        assert_eq!(four.raised_to(60, &mut budget), Err(OverBudget));
        let mut budget = Budget::new(200_000);
        assert_eq!(letter(0).raised_to(201, &mut budget), Err(OverBudget));
        let two = MultivariatePolynomial::constant(Rational::from(2));
        let long = two.raised_to(200, &mut budget).unwrap();
        assert_eq!(long.raised_to(100, &mut budget), Err(OverBudget));
    }
}
