use super::assignment::Assignment;
use super::backward_error::{Rounded, RoundedRoot, backward_error};
use super::typed_pole::{Side, TypedPole, rounding};
use super::{ExpectedPoles, Nearness};
use crate::algebra::{Polynomial, Rational};
use crate::lti::Pole;
use crate::submission::Decimal;

/// A set of poles to be found.
pub(super) struct WantedSet<'a> {
    /// Each as often as it counts.
    pub each: Vec<Pole>,
    pub denominator: &'a Polynomial,
    pub nearness: Nearness<'a>,
}

/// Why a set is right.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Right {
    /// Each pole is near enough, or correctly rounded.
    EachPart,
    /// They are the poles of a denominator whose coefficients differ by at most this part of each.
    Denominator(Rational),
}

impl<'a> WantedSet<'a> {
    pub fn new(one: &ExpectedPoles<'a>, nearness: &Nearness<'a>) -> Self {
        let each =
            one.poles.what.iter().flat_map(|pole| std::iter::repeat_n(*pole, pole.multiplicity)).collect();
        Self { each, denominator: one.denominator, nearness: *nearness }
    }

    /// `fit` is the best assignment of `typed`.
    pub fn right(&self, typed: &[TypedPole], fit: &Assignment) -> Option<Right> {
        if typed.len() != self.each.len() {
            return None;
        }
        if fit.accepted() == typed.len() {
            return Some(Right::EachPart);
        }
        self.by_denominator(typed, fit).map(Right::Denominator)
    }

    /// The poles at the origin each by itself, the others as roots of one polynomial.
    fn by_denominator(&self, typed: &[TypedPole], fit: &Assignment) -> Option<Rational> {
        let at_origin = self.denominator.trailing_zeros();
        let mut order: Vec<usize> = (0..typed.len()).collect();
        order.sort_by(|a, b| typed[*a].to_complex().norm().total_cmp(&typed[*b].to_complex().norm()));
        let (zeros, others) = order.split_at_checked(at_origin)?;
        let origin = Pole { re: 0.0, im: 0.0, multiplicity: at_origin, error_bound: 0.0 };
        if !zeros.iter().all(|index| typed[*index].accepted_for(&origin, self.nearness.parts)) {
            return None;
        }
        let mut others = others.to_vec();
        others.sort_unstable();
        if !self.same_sides(typed, &others) {
            return None;
        }
        let rest = self.denominator.exact_quotient(&Polynomial::monomial(Rational::ONE, at_origin));
        let roots = self.roots(typed, &others, fit)?;
        backward_error(&rest, &roots, self.nearness.coefficients)
    }

    /// Whether the poles other than at the origin can be assigned with each on the side of its own.
    ///
    /// Expected poles without a side take either, so it is enough that there are as many on each side as must be there.
    fn same_sides(&self, typed: &[TypedPole], others: &[usize]) -> bool {
        let expected = |side: Side| self.each.iter().filter(|pole| Side::of(pole) == side).count();
        let given = |side: Side| others.iter().filter(|index| typed[**index].side() == side).count();
        [Side::Left, Side::Right].into_iter().all(|side| given(side) >= expected(side))
    }

    /// Real roots and pairs with what rounding leaves open; `None` when a conjugate is missing.
    fn roots(&self, typed: &[TypedPole], which: &[usize], fit: &Assignment) -> Option<Vec<RoundedRoot>> {
        let expected = |index: usize| fit.partner(index).map(|partner| self.each[partner]);
        let part = |decimal: &Decimal, expected: f64| Rounded {
            value: decimal.value.clone(),
            rounding: rounding(decimal, self.nearness.parts),
            expected,
        };
        let mut roots = Vec::new();
        let mut lower: Vec<usize> = Vec::new();
        let mut upper: Vec<usize> = Vec::new();
        for &index in which {
            let one = &typed[index];
            if one.im.value.is_zero() {
                let expected = expected(index).map_or(f64::NAN, |pole| pole.re);
                roots.push(RoundedRoot::Real(part(&one.re, expected)));
            } else if one.im.value > Rational::ZERO {
                upper.push(index);
            } else {
                lower.push(index);
            }
        }
        for index in upper {
            let one = &typed[index];
            let conjugate = lower.iter().position(|other| typed[*other].is_conjugate_of(one))?;
            lower.swap_remove(conjugate);
            let (re, im) = expected(index).map_or((f64::NAN, f64::NAN), |pole| (pole.re, pole.im.abs()));
            roots.push(RoundedRoot::Pair(part(&one.re, re), part(&one.im, im)));
        }
        lower.is_empty().then_some(roots)
    }
}
