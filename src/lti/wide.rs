//! Complex floating point that neither overflows nor underflows.

use num_complex::Complex64;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `mantissa` · 2^`exponent`; the larger part of the mantissa lies in [1, 2). Zero is 0 · 2^0.
///
/// Accuracy: a few units of 2⁻⁵² for each operation, relative to its result (to the larger operand for sums).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wide {
    mantissa: Complex64,
    exponent: i64,
}

impl Wide {
    pub const ZERO: Self = Self { mantissa: Complex64::ZERO, exponent: 0 };
    pub const ONE: Self = Self { mantissa: Complex64::ONE, exponent: 0 };

    /// `value` · 2^`exponent`, for a finite `value`.
    pub fn new(value: Complex64, exponent: i64) -> Self {
        let size = value.re.abs().max(value.im.abs());
        if size == 0.0 {
            return Self::ZERO;
        }
        let shift = exponent_of(size);
        Self {
            mantissa: Complex64::new(ldexp(value.re, -shift), ldexp(value.im, -shift)),
            exponent: exponent + shift,
        }
    }

    pub fn real(value: f64, exponent: i64) -> Self {
        Self::new(Complex64::new(value, 0.0), exponent)
    }

    pub fn mantissa(self) -> Complex64 {
        self.mantissa
    }

    pub fn exponent(self) -> i64 {
        self.exponent
    }

    pub fn is_zero(self) -> bool {
        self.mantissa == Complex64::ZERO
    }

    /// |self|, real.
    pub fn abs(self) -> Self {
        Self::real(self.mantissa.norm(), self.exponent)
    }

    /// Compares |self| with |other|.
    pub fn cmp_abs(self, other: Self) -> Ordering {
        match (self.is_zero(), other.is_zero()) {
            (true, true) => Ordering::Equal,
            (true, false) => Ordering::Less,
            (false, true) => Ordering::Greater,
            (false, false) => {
                let (a, b) = (self.abs(), other.abs());
                a.exponent.cmp(&b.exponent).then(a.mantissa.re.total_cmp(&b.mantissa.re))
            }
        }
    }

    /// Times 2^`shift`, exactly.
    pub fn shifted(self, shift: i64) -> Self {
        if self.is_zero() { self } else { Self { exponent: self.exponent + shift, ..self } }
    }

    /// The nearest ordinary complex number; parts beyond its range become infinite or zero.
    pub fn to_complex(self) -> Complex64 {
        Complex64::new(ldexp(self.mantissa.re, self.exponent), ldexp(self.mantissa.im, self.exponent))
    }
}

impl Mul for Wide {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.mantissa * other.mantissa, self.exponent + other.exponent)
    }
}

impl Div for Wide {
    type Output = Self;
    /// By zero: zero, since every caller treats that case before.
    fn div(self, other: Self) -> Self {
        if other.is_zero() {
            return Self::ZERO;
        }
        Self::new(self.mantissa / other.mantissa, self.exponent - other.exponent)
    }
}

impl Add for Wide {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        let (large, small) = if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let shift = small.exponent - large.exponent;
        if shift < -120 {
            return large;
        }
        let factor = ldexp(1.0, shift);
        Self::new(large.mantissa + small.mantissa * factor, large.exponent)
    }
}

impl Neg for Wide {
    type Output = Self;
    fn neg(self) -> Self {
        Self { mantissa: -self.mantissa, ..self }
    }
}

impl Sub for Wide {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// k with 2^k ≤ x < 2^(k+1), for a positive finite x.
fn exponent_of(x: f64) -> i64 {
    let biased = (x.to_bits() >> 52) as i64;
    if biased == 0 { exponent_of(x * 2f64.powi(64)) - 64 } else { biased - 1023 }
}

/// x · 2^k, infinite or zero beyond the range.
pub(super) fn ldexp(x: f64, k: i64) -> f64 {
    let step = |k: i64| 2f64.powi(k as i32);
    match k {
        -1000..=1000 => x * step(k),
        ..-1000 => x * step(-1000) * step((k + 1000).max(-1000)),
        _ => x * step(1000) * step((k - 1000).min(1000)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_beyond_the_range_of_f64() {
        let huge = Wide::new(Complex64::new(3.0, -4.0), 5000);
        let tiny = Wide::new(Complex64::new(0.5, 0.25), -5000);
        assert_eq!((huge * tiny).to_complex(), Complex64::new(3.0, -4.0) * Complex64::new(0.5, 0.25));
        assert_eq!((huge / huge).to_complex(), Complex64::ONE);
        assert_eq!((huge - huge), Wide::ZERO);
        assert_eq!(huge + tiny, huge);
        assert_eq!(huge.abs(), Wide::real(5.0, 5000));
        assert_eq!(huge.cmp_abs(tiny), Ordering::Greater);
        assert_eq!(Wide::ZERO.cmp_abs(tiny), Ordering::Less);
        assert!(huge.to_complex().re.is_infinite());
        assert_eq!(tiny.to_complex(), Complex64::ZERO);
    }

    #[test]
    fn subnormals_keep_their_value() {
        let x = f64::from_bits(12345);
        assert_eq!(Wide::real(x, 0).to_complex().re, x);
        assert_eq!(Wide::real(x, 100).shifted(-100).to_complex().re, x);
    }
}
