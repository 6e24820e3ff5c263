//! Common factors of polynomials in letters, by exact division.

use super::multivariate::{Budget, Letter, Monomial, MultivariatePolynomial as Poly, OverBudget};
use super::{Polynomial, Rational};
use dashu_int::ops::{Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};

impl Poly {
    /// The quotient when `divisor` divides it without a remainder.
    pub fn exact_quotient(&self, divisor: &Self, budget: &mut Budget) -> Result<Option<Self>, OverBudget> {
        let Some((lead, by)) = divisor.leading() else { return Ok(None) };
        let (mut rest, mut quotient) = (self.clone(), Self::zero());
        while let Some((monomial, coefficient)) = rest.leading() {
            let Some(monomial) = monomial.over(lead) else { return Ok(None) };
            let step = Self::term(coefficient / by, monomial);
            rest = rest.minus(&divisor.times(&step, budget)?, budget)?;
            quotient = quotient.plus(&step, budget)?;
        }
        Ok(Some(quotient))
    }

    /// The positive rational that makes its coefficients integers without common divisor when divided by; 1 for zero.
    pub fn content(&self) -> Rational {
        let mut top = UBig::ZERO;
        let mut bottom = UBig::ONE;
        for (_, c) in self.terms() {
            let size = c.numerator().clone().unsigned_abs();
            top = if top == UBig::ZERO { size } else { (&top).gcd(&size) };
            let shared = (&bottom).gcd(c.denominator());
            bottom = bottom / shared * c.denominator();
        }
        if top == UBig::ZERO { Rational::ONE } else { Rational::from_parts(IBig::from(top), bottom) }
    }

    /// Divided by its content, leading coefficient positive.
    pub fn primitive(&self) -> Self {
        let content = self.content();
        let negative = self.leading().is_some_and(|(_, c)| *c < Rational::ZERO);
        self.scaled(&(Rational::ONE / if negative { -content } else { content }))
    }

    /// The greatest common divisor, primitive, leading coefficient positive; zero only when both are zero.
    ///
    /// Source: the primitive remainder sequence in one letter after another; Knuth, *TAOCP* 2, 4.6.1.
    pub fn gcd(&self, other: &Self, budget: &mut Budget) -> Result<Self, OverBudget> {
        if self.is_zero() || other.is_zero() {
            return Ok(if self.is_zero() { other.primitive() } else { self.primitive() });
        }
        let (a, b) = (self.shared_monomial(), other.shared_monomial());
        let monomial = Self::term(Rational::ONE, a.shared(&b));
        let strip = |p: &Self, m: Monomial, budget: &mut Budget| {
            let stripped = p.exact_quotient(&Self::term(Rational::ONE, m), budget)?;
            Ok::<_, OverBudget>(stripped.unwrap_or_default().primitive())
        };
        let (a, b) = (strip(self, a, budget)?, strip(other, b, budget)?);
        a.gcd_of_stripped(&b, budget)?.times(&monomial, budget)
    }

    /// Of primitive polynomials that no letter divides.
    fn gcd_of_stripped(&self, other: &Self, budget: &mut Budget) -> Result<Self, OverBudget> {
        budget.spend(self.term_count() + other.term_count())?;
        if self == other {
            return Ok(self.clone());
        }
        let (left, right) = (self.letters(), other.letters());
        let shared: Vec<Letter> = left.iter().copied().filter(|l| right.contains(l)).collect();
        if shared.is_empty() {
            return Ok(Self::one());
        }
        // What only one of them holds cannot be in the divisor.
        if let Some(letter) = left.iter().find(|l| !right.contains(l)) {
            return self.content_in(*letter, budget)?.gcd(other, budget);
        }
        if let Some(letter) = right.iter().find(|l| !left.contains(l)) {
            return other.content_in(*letter, budget)?.gcd(self, budget);
        }
        for letter in &shared {
            if self.coprime_in(other, *letter, budget)? {
                let (a, b) = (self.content_in(*letter, budget)?, other.content_in(*letter, budget)?);
                return a.gcd(&b, budget);
            }
        }
        let by_degree = |l: &&Letter| self.degree_in(**l).min(other.degree_in(**l));
        let Some(&letter) = shared.iter().min_by_key(by_degree) else { return Ok(Self::one()) };
        let (first, second) = (self.content_in(letter, budget)?, other.content_in(letter, budget)?);
        let content = first.gcd(&second, budget)?;
        let mut a = self.exact_quotient(&first, budget)?.unwrap_or_default();
        let mut b = other.exact_quotient(&second, budget)?.unwrap_or_default();
        if a.degree_in(letter) < b.degree_in(letter) {
            std::mem::swap(&mut a, &mut b);
        }
        loop {
            if b.is_zero() {
                return a.primitive().times(&content, budget).map(|g| g.primitive());
            }
            if b.degree_in(letter) == 0 {
                return Ok(content);
            }
            let rest = a.pseudo_remainder(&b, letter, budget)?;
            let rest = if rest.is_zero() {
                rest
            } else {
                let content = rest.content_in(letter, budget)?;
                rest.exact_quotient(&content, budget)?.unwrap_or_default().primitive()
            };
            (a, b) = (b, rest);
        }
    }

    /// A multiple of the remainder by `divisor` as polynomials in `letter`.
    fn pseudo_remainder(
        &self,
        divisor: &Self,
        letter: Letter,
        budget: &mut Budget,
    ) -> Result<Self, OverBudget> {
        let degree = divisor.degree_in(letter);
        let lead = divisor.coefficients_of(letter).pop().unwrap_or_default();
        let mut rest = self.clone();
        while !rest.is_zero() && rest.degree_in(letter) >= degree {
            let top = rest.coefficients_of(letter).pop().unwrap_or_default();
            let shift = Self::term(Rational::ONE, Monomial::letter(letter, rest.degree_in(letter) - degree));
            let take = divisor.times(&top, budget)?.times(&shift, budget)?;
            rest = rest.times(&lead, budget)?.minus(&take, budget)?.primitive();
        }
        Ok(rest)
    }

    /// What all its coefficients share as a polynomial in `letter`.
    pub fn content_in(&self, letter: Letter, budget: &mut Budget) -> Result<Self, OverBudget> {
        let mut parts = self.coefficients_of(letter);
        parts.retain(|part| !part.is_zero());
        parts.sort_by_key(Self::term_count);
        let mut shared = Self::zero();
        for part in &parts {
            shared = shared.gcd(part, budget)?;
            if shared.as_constant().is_some() {
                break;
            }
        }
        Ok(shared)
    }

    /// Whether numbers in place of the other letters show that the divisor is free of `letter`; `false` when they do not.
    fn coprime_in(&self, other: &Self, letter: Letter, budget: &mut Budget) -> Result<bool, OverBudget> {
        let at = |p: &Self| {
            let parts = p.coefficients_of(letter);
            let lead_before = parts.len();
            let values = parts.iter().rev().map(|part| {
                part.eval(
                    &|l| Rational::from(PLACES[usize::from(l) % PLACES.len()] + l / 16),
                    &Rational::clone,
                )
            });
            let value = Polynomial::new(values.collect());
            (value.coefficients().len() == lead_before).then_some(value)
        };
        budget.spend(4 * (self.term_count() + other.term_count()))?;
        Ok(match (at(self), at(other)) {
            (Some(a), Some(b)) => a.gcd(&b).degree() == 0,
            _ => false,
        })
    }

    /// The factors that show without trying: a number, letters, and what all coefficients of a letter share; each primitive.
    ///
    /// The product of all, each to its power, and of the number is the polynomial. Zero has the number 0 alone.
    pub fn light_factors(&self, budget: &mut Budget) -> Result<(Rational, Vec<(Self, u32)>), OverBudget> {
        if self.is_zero() {
            return Ok((Rational::ZERO, Vec::new()));
        }
        let primitive = self.primitive();
        let number = match (self.leading(), primitive.leading()) {
            (Some((_, a)), Some((_, b))) => a / b,
            _ => Rational::ONE,
        };
        let mut factors = Vec::new();
        let monomial = primitive.shared_monomial();
        for (letter, power) in monomial.powers() {
            factors.push((Self::letter(*letter), *power));
        }
        let rest =
            primitive.exact_quotient(&Self::term(Rational::ONE, monomial), budget)?.unwrap_or_default();
        let mut open = vec![rest];
        while let Some(part) = open.pop() {
            if part.as_constant().is_some() {
                continue;
            }
            let mut split = None;
            for letter in part.letters() {
                let content = part.content_in(letter, budget)?;
                if content.as_constant().is_none() {
                    split = Some(content);
                    break;
                }
            }
            match split {
                Some(content) => {
                    open.push(part.exact_quotient(&content, budget)?.unwrap_or_default());
                    open.push(content);
                }
                None => match factors.iter_mut().find(|(known, _)| *known == part) {
                    Some((_, power)) => *power += 1,
                    None => factors.push((part, 1)),
                },
            }
        }
        Ok((number, factors))
    }
}

/// What letters are set to by turns.
const PLACES: [u16; 16] = [2, 13, 5, 31, 3, 19, 11, 43, 7, 23, 17, 61, 29, 37, 53, 47];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Expression, NodeKind};

    const NAMES: [&str; 8] = ["s", "M", "m", "b", "I", "g", "l", "x"];

    /// A polynomial of the letters above, as typed.
    fn poly(text: &str) -> Poly {
        fn of(node: &Expression, budget: &mut Budget) -> Poly {
            let mut both = |a: &Expression, b: &Expression| (of(a, budget), of(b, budget));
            match &node.kind {
                NodeKind::Number(value) => Poly::constant(value.clone()),
                NodeKind::Symbol { name, .. } => {
                    Poly::letter(NAMES.iter().position(|n| n == name).unwrap() as Letter)
                }
                NodeKind::Negate(a) => of(a, budget).negated(),
                NodeKind::Add(a, b) => {
                    let (a, b) = both(a, b);
                    a.plus(&b, budget).unwrap()
                }
                NodeKind::Subtract(a, b) => {
                    let (a, b) = both(a, b);
                    a.minus(&b, budget).unwrap()
                }
                NodeKind::Multiply(a, b) => {
                    let (a, b) = both(a, b);
                    a.times(&b, budget).unwrap()
                }
                NodeKind::Power(a, b) => {
                    let (a, b) = both(a, b);
                    let power = u32::try_from(b.as_constant().unwrap().numerator().clone()).unwrap();
                    a.raised_to(power, budget).unwrap()
                }
                other => panic!("{other:?}"),
            }
        }
        of(&Expression::parse_typed(text).unwrap(), &mut Budget::new(100_000))
    }

    #[track_caller]
    fn check_gcd(rows: &[(&str, &str, &str)]) {
        for (a, b, expected) in rows {
            let found = poly(a).gcd(&poly(b), &mut Budget::new(100_000)).unwrap();
            assert_eq!(found, poly(expected).primitive(), "gcd({a}, {b})");
        }
    }

    #[test]
    fn common_factors() {
        check_gcd(&[
            ("0", "2*m", "m"),
            ("3", "6*m", "1"),
            ("m*l*s^2", "m^2*l^2*s", "m*l*s"),
            ("M + m", "M - m", "1"),
            ("(M + m)*(I + m*l^2)", "(M + m)*b", "M + m"),
            ("M^2 - m^2", "M^2 + 2*M*m + m^2", "M + m"),
            ("(s^2 + b*s + g)*(M*s + b)", "(s^2 + b*s + g)*(l*s - b)*s", "s^2 + b*s + g"),
            ("(s + x)^3*(b + g)^2", "(s + x)^2*(b + g)^3", "(s + x)^2*(b + g)^2"),
            (
                "(M*s^2 + b*s + I)*(m*s^2 + g*s + x) - I^2",
                "(M*s^2 + b*s + I)*(m*s^2 + g*s + x) - I^2 + 1",
                "1",
            ),
            ("0.5*(2*s + 4*x)", "3*s + 6*x", "s + 2*x"),
        ]);
    }

    #[test]
    fn quotients_are_exact_or_none() {
        let divide = |a: &str, b: &str| poly(a).exact_quotient(&poly(b), &mut Budget::new(10_000)).unwrap();
        assert_eq!(divide("M^3 - m^3", "M - m"), Some(poly("M^2 + M*m + m^2")));
        assert_eq!(divide("M^2 + m^2", "M - m"), None);
        assert_eq!(divide("M", "0"), None);
    }

    #[test]
    fn factors_that_show() {
        for (product, count) in [
            ("6*m*g*l*(M + m)", 4),
            ("b*I + b*m*l^2", 2),
            ("(M + m)*(I + m*l^2)", 2),
            ("(M + m)*(I + m*l^2) - m^2*l^2", 1),
            ("(M + m)^2*(s + x)", 2),
            ("-3", 0),
        ] {
            let mut budget = Budget::new(100_000);
            let (number, factors) = poly(product).light_factors(&mut budget).unwrap();
            assert_eq!(factors.len(), count, "{product}: {factors:?}");
            let back = factors.iter().fold(Poly::constant(number), |all, (factor, power)| {
                all.times(&factor.raised_to(*power, &mut budget).unwrap(), &mut budget).unwrap()
            });
            assert_eq!(back, poly(product), "{product}");
        }
    }

    #[test]
    fn a_search_for_factors_ends() {
        let (a, b) = (poly("(s + M*m + b*I*x)^6*(g + l*s)^5"), poly("(s + M*b + m*I*x)^6*(l + g*s)^5"));
        let mut budget = Budget::new(20_000);
        assert!(matches!(a.gcd(&b, &mut budget), Ok(_) | Err(OverBudget)));
    }
}
