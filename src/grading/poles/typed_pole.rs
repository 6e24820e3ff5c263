use super::super::closeness::{closeness, significant_figures};
use crate::algebra::{Rational, to_f64};
use crate::lab::Tolerance;
use crate::lti::Pole;
use crate::submission::{Decimal, TypedComplex};
use num_complex::Complex64;
use std::cmp::Ordering;

/// A typed pole and its images.
#[derive(Clone, Debug)]
pub(super) struct TypedPole {
    pub re: Decimal,
    pub im: Decimal,
}

impl TypedPole {
    pub fn of(typed: &TypedComplex) -> Self {
        Self { re: typed.re.clone(), im: typed.im.clone() }
    }

    pub fn mirrored(&self) -> Self {
        Self { re: negated(&self.re), im: self.im.clone() }
    }

    pub fn conjugate(&self) -> Self {
        Self { re: self.re.clone(), im: negated(&self.im) }
    }

    pub fn is_conjugate_of(&self, other: &Self) -> bool {
        self.re.value == other.re.value && self.im.value == -other.im.value.clone()
    }

    pub fn side(&self) -> Side {
        match self.re.value.cmp(&Rational::ZERO) {
            Ordering::Less => Side::Left,
            Ordering::Greater => Side::Right,
            Ordering::Equal => Side::None,
        }
    }

    /// Both parts are near enough or correctly rounded, and the real parts have the same sign.
    pub fn accepted_for(&self, pole: &Pole, tolerance: &Tolerance) -> bool {
        let same_side = match Side::of(pole) {
            Side::None => true,
            side => self.side() == side,
        };
        same_side
            && closeness(pole.re, pole.error_bound, &self.re, tolerance).accepted()
            && closeness(pole.im, pole.error_bound, &self.im, tolerance).accepted()
    }

    /// For distances: infinite beyond the range of an `f64`.
    pub fn to_complex(&self) -> Complex64 {
        Complex64::new(to_f64(&self.re.value), to_f64(&self.im.value))
    }
}

/// Which side of the imaginary axis a pole is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
    /// Zero, as far as anyone can tell.
    None,
}

impl Side {
    pub fn of(pole: &Pole) -> Self {
        if pole.re > pole.error_bound {
            Self::Right
        } else if pole.re < -pole.error_bound {
            Self::Left
        } else {
            Self::None
        }
    }
}

/// How far the number that was rounded to `typed` may be from it: half a unit of the last place.
///
/// Zero for fewer significant figures than the lab asks for, and for an exact 0.
pub(super) fn rounding(typed: &Decimal, tolerance: &Tolerance) -> Rational {
    match tolerance.figures {
        Some(figures) if !typed.value.is_zero() && significant_figures(typed) >= figures as usize => {
            Rational::from(10).pow(typed.last_place as isize) / Rational::from(2)
        }
        _ => Rational::ZERO,
    }
}

fn negated(decimal: &Decimal) -> Decimal {
    let text = match decimal.text.strip_prefix(['-', '−']) {
        Some(positive) => positive.to_owned(),
        None => format!("-{}", decimal.text.trim_start_matches('+')),
    };
    Decimal { text, value: -decimal.value.clone(), last_place: decimal.last_place }
}
