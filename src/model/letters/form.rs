//! Polynomials in letters as a teacher writes them: common letters pulled out, sums in parentheses, positive terms first.

use super::Trouble;
use super::ring::{Fraction, Ring, S, node, number};
use crate::algebra::{
    Budget, Expression, Letter, MultivariatePolynomial as Poly, NodeKind, Rational, to_f64,
};

/// A formula without its sign.
#[derive(Clone, Debug)]
pub(super) struct Signed {
    pub negative: bool,
    pub size: Expression,
}

impl Signed {
    pub fn into_expression(self) -> Expression {
        if self.negative { negated(self.size) } else { self.size }
    }

    /// How many letters and numbers one has to write.
    pub fn cost(&self) -> usize {
        cost(&self.size)
    }
}

/// The sign goes to the first factor: −a·b, not −(a·b).
fn negated(expression: Expression) -> Expression {
    match expression.kind {
        NodeKind::Multiply(a, b) => node(NodeKind::Multiply(Box::new(negated(*a)), b)),
        NodeKind::Divide(a, b) => node(NodeKind::Divide(Box::new(negated(*a)), b)),
        NodeKind::Number(value) => number(-value),
        _ => node(NodeKind::Negate(Box::new(expression))),
    }
}

fn cost(expression: &Expression) -> usize {
    match &expression.kind {
        NodeKind::Power(base, _) => cost(base),
        _ => {
            let children: usize = expression.children().map(cost).sum();
            children.max(1)
        }
    }
}

/// Σ of signed parts, those without a minus first where `sorted`; 0 for none.
pub(super) fn sum(parts: Vec<Signed>, positive_first: bool) -> Expression {
    let (first, second): (Vec<_>, Vec<_>) =
        if positive_first { parts.into_iter().partition(|part| !part.negative) } else { (parts, Vec::new()) };
    let mut all = first.into_iter().chain(second);
    let Some(head) = all.next() else { return number(Rational::ZERO) };
    all.fold(head.into_expression(), |sum, part| {
        let (a, b) = (Box::new(sum), Box::new(part.size));
        node(if part.negative { NodeKind::Subtract(a, b) } else { NodeKind::Add(a, b) })
    })
}

pub(super) fn product(factors: Vec<Expression>) -> Expression {
    let mut all = factors.into_iter();
    let Some(head) = all.next() else { return number(Rational::ONE) };
    all.fold(head, |product, factor| node(NodeKind::Multiply(Box::new(product), Box::new(factor))))
}

/// Sums with more terms than this are left as they are.
const MOST_GROUPED: usize = 40;

impl Ring {
    /// A polynomial, lightly factored.
    pub fn form(&self, poly: &Poly, budget: &mut Budget) -> Result<Signed, Trouble> {
        let (coefficient, factors) = poly.light_factors(budget)?;
        self.factored(&coefficient, factors, budget)
    }

    /// number · ∏ factors.
    pub fn factored(
        &self,
        coefficient: &Rational,
        mut factors: Vec<(Poly, u32)>,
        budget: &mut Budget,
    ) -> Result<Signed, Trouble> {
        let mut negative = *coefficient < Rational::ZERO;
        let size = if negative { -coefficient } else { coefficient.clone() };
        if size.is_zero() {
            return Ok(Signed { negative: false, size: number(Rational::ZERO) });
        }
        // Letters as they come, then sums, short ones first.
        factors.sort_by(|(a, _), (b, _)| {
            let terms = |p: &Poly| if p.term_count() == 1 { 0 } else { p.term_count() };
            terms(a)
                .cmp(&terms(b))
                .then_with(|| b.leading().map(|(m, _)| m).cmp(&a.leading().map(|(m, _)| m)))
        });
        let (top, bottom) = split(&size);
        let mut written = Vec::new();
        if top != Rational::ONE || factors.is_empty() {
            written.push(number(top));
        }
        for (factor, power) in &factors {
            match factor.leading().filter(|_| factor.term_count() == 1) {
                Some((monomial, _)) => {
                    for (letter, exponent) in monomial.powers() {
                        written.extend(self.letter_form(*letter, exponent * power, budget)?);
                    }
                }
                None => {
                    let (turned, inside) = self.terms_form(factor, budget)?;
                    negative ^= turned && power % 2 == 1;
                    written.push(match power {
                        1 => inside,
                        n => node(NodeKind::Power(Box::new(inside), Box::new(number(Rational::from(*n))))),
                    });
                }
            }
        }
        let whole = product(written);
        let size = if bottom == Rational::ONE {
            whole
        } else {
            node(NodeKind::Divide(Box::new(whole), Box::new(number(bottom))))
        };
        Ok(Signed { negative, size })
    }

    fn letter_form(
        &self,
        letter: Letter,
        power: u32,
        budget: &mut Budget,
    ) -> Result<Vec<Expression>, Trouble> {
        let failed = std::cell::Cell::new(None);
        let inner = std::cell::RefCell::new(budget);
        let shown = self.shown(letter, power, &|fraction| match self
            .fraction_form(fraction, &mut inner.borrow_mut())
        {
            Ok(form) => form.into_expression(),
            Err(trouble) => {
                failed.set(Some(trouble));
                number(Rational::ZERO)
            }
        });
        match failed.into_inner() {
            Some(trouble) => Err(trouble),
            None => Ok(shown),
        }
    }

    /// A sum of two terms or more that share nothing; whether its sign was turned so that it begins without a minus.
    fn terms_form(&self, poly: &Poly, budget: &mut Budget) -> Result<(bool, Expression), Trouble> {
        let negatives = poly.terms().filter(|(_, c)| **c < Rational::ZERO).count();
        let turned = 2 * negatives > poly.term_count()
            || (2 * negatives == poly.term_count() && self.first_is_negative(poly));
        let poly = if turned { poly.negated() } else { poly.clone() };
        let plain = self.plain_sum(&poly, budget)?;
        if poly.term_count() <= 2 || poly.term_count() > MOST_GROUPED {
            return Ok((turned, plain));
        }
        let grouped = self.grouped_sum(&poly, budget)?;
        let best = if cost(&grouped) < cost(&plain) { grouped } else { plain };
        Ok((turned, best))
    }

    fn first_is_negative(&self, poly: &Poly) -> bool {
        let first = poly.terms().min_by_key(|(m, _)| m.degree());
        first.is_some_and(|(_, c)| *c < Rational::ZERO)
    }

    /// Term after term: those of few letters first.
    fn plain_sum(&self, poly: &Poly, budget: &mut Budget) -> Result<Expression, Trouble> {
        let mut terms: Vec<_> = poly.terms().collect();
        terms.sort_by(|(a, _), (b, _)| a.degree().cmp(&b.degree()).then(b.cmp(a)));
        let mut parts = Vec::new();
        for (monomial, coefficient) in terms {
            let letters = monomial.powers().iter().map(|(l, p)| (Poly::letter(*l), *p)).collect();
            parts.push(self.factored(coefficient, letters, budget)?);
        }
        Ok(sum(parts, true))
    }

    /// Terms that share a letter put together, where what they share it with is simplest.
    fn grouped_sum(&self, poly: &Poly, budget: &mut Budget) -> Result<Expression, Trouble> {
        let mut rest = poly.clone();
        let mut parts = Vec::new();
        while rest.term_count() > 2 {
            let mut best: Option<((u32, usize, Letter), Poly)> = None;
            for letter in rest.letters() {
                let mut holding = rest.terms().filter(|(m, _)| m.power_of(letter) > 0);
                let with = holding.try_fold(Poly::zero(), |sum, (m, c)| {
                    sum.plus(&Poly::term(c.clone(), m.clone()), budget)
                })?;
                if with.term_count() < 2 || with.term_count() == rest.term_count() {
                    continue;
                }
                let shared = Poly::term(Rational::ONE, with.shared_monomial());
                let cofactor = with.exact_quotient(&shared, budget)?.unwrap_or_default();
                let degree = cofactor.terms().map(|(m, _)| m.degree()).max().unwrap_or(0);
                let rank = (degree, usize::MAX - with.term_count(), letter);
                if best.as_ref().is_none_or(|(known, _)| rank < *known) {
                    best = Some((rank, with));
                }
            }
            let Some((_, group)) = best else { break };
            rest = rest.minus(&group, budget)?;
            parts.push((
                group.terms().map(|(m, _)| m.degree()).min().unwrap_or(0),
                self.form(&group, budget)?,
            ));
        }
        for (monomial, coefficient) in rest.terms() {
            let term = Poly::term(coefficient.clone(), monomial.clone());
            parts.push((monomial.degree(), self.form(&term, budget)?));
        }
        parts.sort_by_key(|(degree, _)| *degree);
        Ok(sum(parts.into_iter().map(|(_, part)| part).collect(), true))
    }

    /// A fraction, numbers that divide among those below.
    pub fn fraction_form(&self, fraction: &Fraction, budget: &mut Budget) -> Result<Signed, Trouble> {
        let (coefficient, above) = fraction.num.light_factors(budget)?;
        let (below_number, below) = fraction.den.light_factors(budget)?;
        let coefficient = coefficient / below_number;
        if below.is_empty() {
            return self.factored(&coefficient, above, budget);
        }
        let negative = coefficient < Rational::ZERO;
        let (top, bottom) = split(&if negative { -&coefficient } else { coefficient });
        let top = self.factored(&top, above, budget)?;
        let bottom = self.factored(&bottom, below, budget)?;
        let size = node(NodeKind::Divide(Box::new(top.size), Box::new(bottom.size)));
        Ok(Signed { negative: negative ^ top.negative ^ bottom.negative, size })
    }

    /// Σ coefficient · s^power, highest power first.
    pub fn by_powers_of_s(&self, coefficients: Vec<(u32, Signed)>) -> Expression {
        let mut parts = Vec::new();
        for (power, coefficient) in coefficients.into_iter().rev() {
            let s = (power > 0).then(|| power_of_s(power));
            // What stands without s is added term by term.
            if power == 0 && !coefficient.negative {
                terms_of(coefficient.size, false, &mut parts);
                continue;
            }
            let is_one = matches!(&coefficient.size.kind, NodeKind::Number(n) if *n == Rational::ONE);
            let size = match (s, is_one) {
                (Some(s), true) => s,
                (Some(s), false) => product(vec![coefficient.size, s]),
                (None, _) => coefficient.size,
            };
            parts.push(Signed { negative: coefficient.negative, size });
        }
        sum(parts, false)
    }

    /// A polynomial in s and letters, collected by powers of s.
    pub fn collected(&self, poly: &Poly, budget: &mut Budget) -> Result<Expression, Trouble> {
        let mut coefficients = Vec::new();
        for (power, part) in poly.coefficients_of(S).iter().enumerate().filter(|(_, part)| !part.is_zero()) {
            coefficients.push((power as u32, self.form(part, budget)?));
        }
        Ok(self.by_powers_of_s(coefficients))
    }
}

/// The terms of a sum, with their signs.
fn terms_of(expression: Expression, negative: bool, parts: &mut Vec<Signed>) {
    match expression.kind {
        NodeKind::Add(a, b) if !negative => {
            terms_of(*a, false, parts);
            terms_of(*b, false, parts);
        }
        NodeKind::Subtract(a, b) if !negative => {
            terms_of(*a, false, parts);
            terms_of(*b, true, parts);
        }
        _ => parts.push(Signed { negative, size: expression }),
    }
}

pub(super) fn power_of_s(power: u32) -> Expression {
    let s = node(NodeKind::Symbol { name: "s".to_owned(), primes: 0 });
    match power {
        1 => s,
        n => node(NodeKind::Power(Box::new(s), Box::new(number(Rational::from(n))))),
    }
}

/// A positive number as one writes it before and below letters: 3/2 is (3, 2), and 0.06 stays (0.06, 1).
fn split(value: &Rational) -> (Rational, Rational) {
    let bottom = to_f64(&Rational::from(value.denominator().clone()));
    let decimal = (0..=6).any(|places| (value * Rational::from(10).pow(places)).is_int());
    if bottom <= 12.0 || !decimal {
        (Rational::from(value.numerator().clone()), Rational::from(value.denominator().clone()))
    } else {
        (value.clone(), Rational::ONE)
    }
}
