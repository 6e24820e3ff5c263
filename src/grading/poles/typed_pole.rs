use super::super::closeness::{self, Expected};
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
        Self { re: self.re.negated(), im: self.im.clone() }
    }

    pub fn conjugate(&self) -> Self {
        Self { re: self.re.clone(), im: self.im.negated() }
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
        let near = |part: f64, typed: &Decimal| {
            expected_part(part, pole).is_some_and(|expected| expected.closeness(typed, tolerance).accepted())
        };
        same_side && near(pole.re, &self.re) && near(pole.im, &self.im)
    }

    /// For distances: infinite beyond the range of an `f64`.
    pub fn to_complex(&self) -> Complex64 {
        Complex64::new(to_f64(&self.re.value), to_f64(&self.im.value))
    }
}

/// The real or the imaginary part of a pole, beside the size of the pole; `None` for what is not finite.
pub(super) fn expected_part(part: f64, pole: &Pole) -> Option<Expected> {
    let size = pole.re.hypot(pole.im);
    Expected::beside(part, pole.error_bound, if size > pole.error_bound { size } else { 0.0 })
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

/// As for any other number, but zero where that is nothing, and for an exact 0.
pub(super) fn rounding(typed: &Decimal, tolerance: &Tolerance) -> Rational {
    let left_open = closeness::rounding(typed, tolerance).filter(|_| !typed.value.is_zero());
    left_open.unwrap_or(Rational::ZERO)
}

#[cfg(test)]
mod tests {
    use super::super::super::closeness::tests::{tolerance, typed};
    use super::*;
    use crate::algebra::parse_decimal;

    #[test]
    fn half_a_unit_of_the_last_place() {
        for (text, want) in [
            ("-0.143", "0.0005"),
            ("5.60", "0.005"),
            ("12", "0.5"),
            ("1300", "50"),
            ("1300.0", "0.05"),
            ("100", "5"),
            ("6", "0"),
            ("0.05", "0"),
            ("0.00", "0"),
            ("0", "0"),
        ] {
            let got = rounding(&typed(text), &tolerance("0", "0", Some(2)));
            assert_eq!(got, parse_decimal(want).unwrap(), "{text}");
        }
        assert_eq!(rounding(&typed("1.23"), &tolerance("0", "0", None)), Rational::ZERO);
    }
}
