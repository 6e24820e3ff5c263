//! Complex points held exactly, and polynomials evaluated there without any rounding.

use super::wide::{Wide, ldexp};
use dashu_int::IBig;
use dashu_int::ops::BitTest;
use num_complex::Complex64;

/// (`re` + j `im`) · 2^`exponent`, exact.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    re: IBig,
    im: IBig,
    exponent: i64,
}

impl Dyadic {
    /// The point itself for an f64, for a [`Wide`] up to 2⁻⁶⁰ of its size.
    pub fn near(value: Wide) -> Self {
        let part = |x: f64| IBig::from(ldexp(x, 60) as i64);
        let Complex64 { re, im } = value.mantissa();
        Self { re: part(re), im: part(im), exponent: value.exponent() - 60 }
    }

    /// A finite complex number, exactly.
    pub fn exactly(value: Complex64) -> Self {
        let ((re, re_exponent), (im, im_exponent)) = (decode(value.re), decode(value.im));
        let exponent = re_exponent.min(im_exponent);
        let lift = |m: i64, e: i64| IBig::from(m) << (e - exponent) as usize;
        Self { re: lift(re, re_exponent), im: lift(im, im_exponent), exponent }
    }

    /// Moved by −`step` and rounded to about `bits` significant bits.
    pub fn moved(&self, step: Wide, bits: usize) -> Self {
        self.minus(&Self::near(step)).rounded(bits)
    }

    pub fn minus(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let (a, b) = ((self.exponent - exponent) as usize, (other.exponent - exponent) as usize);
        Self { re: (&self.re << a) - (&other.re << b), im: (&self.im << a) - (&other.im << b), exponent }
    }

    pub fn zero() -> Self {
        Self { re: IBig::ZERO, im: IBig::ZERO, exponent: 0 }
    }

    /// A finite number, exactly.
    pub fn real(value: f64) -> Self {
        Self::exactly(Complex64::new(value, 0.0))
    }

    /// Times a finite number, exactly.
    pub fn scaled(&self, factor: f64) -> Self {
        self.times(&Self::real(factor))
    }

    pub fn times(&self, other: &Self) -> Self {
        Self {
            re: &self.re * &other.re - &self.im * &other.im,
            im: &self.re * &other.im + &self.im * &other.re,
            exponent: self.exponent + other.exponent,
        }
    }

    /// To about `bits` significant bits; 0 when divided by 0.
    pub fn over(&self, other: &Self, bits: usize) -> Self {
        let size = &other.re * &other.re + &other.im * &other.im;
        if size.is_zero() {
            return Self::near(Wide::ZERO);
        }
        let above = self.times(&other.conjugate());
        let length = above.re.bit_len().max(above.im.bit_len());
        let lift = (bits + size.bit_len()).saturating_sub(length);
        Self {
            re: (above.re << lift) / &size,
            im: (above.im << lift) / &size,
            exponent: above.exponent - 2 * other.exponent - lift as i64,
        }
    }

    /// Without what goes beyond `bits` significant bits of the larger part.
    pub fn rounded(self, bits: usize) -> Self {
        let length = self.re.bit_len().max(self.im.bit_len());
        match length.checked_sub(bits) {
            None | Some(0) => self,
            Some(excess) => {
                Self { re: self.re >> excess, im: self.im >> excess, exponent: self.exponent + excess as i64 }
            }
        }
    }

    /// Both parts as whole multiples of 2^−`fraction_bits`, rounded down.
    pub fn in_fixed_point(&self, fraction_bits: usize) -> (IBig, IBig) {
        let shift = self.exponent + fraction_bits as i64;
        let part = |x: &IBig| if shift >= 0 { x << shift as usize } else { x >> (-shift) as usize };
        (part(&self.re), part(&self.im))
    }

    pub fn conjugate(&self) -> Self {
        Self { re: self.re.clone(), im: -&self.im, exponent: self.exponent }
    }

    /// Reflected in the imaginary axis.
    pub fn reflected(&self) -> Self {
        Self { re: -&self.re, im: self.im.clone(), exponent: self.exponent }
    }

    pub fn onto_real_axis(&self) -> Self {
        Self { re: self.re.clone(), im: IBig::ZERO, exponent: self.exponent }
    }

    pub fn onto_imaginary_axis(&self) -> Self {
        Self { re: IBig::ZERO, im: self.im.clone(), exponent: self.exponent }
    }

    pub fn re(&self) -> Wide {
        wide(&self.re, &IBig::ZERO, self.exponent)
    }

    pub fn im(&self) -> Wide {
        wide(&self.im, &IBig::ZERO, self.exponent)
    }

    /// Relative error below 2⁻⁵², relative to the larger part.
    pub fn to_wide(&self) -> Wide {
        wide(&self.re, &self.im, self.exponent)
    }

    /// Each part to the nearest `f64` (within half a unit and a hair in the last place).
    pub fn to_complex(&self) -> Complex64 {
        Complex64::new(self.re().to_complex().re, self.im().to_complex().re)
    }
}

/// The first `count` coefficients of p(z + h) in powers of h: p(z), p′(z), p″(z)/2 …
///
/// `p`: integer coefficients, highest power first. The arithmetic is exact and the results are rounded once, so that
/// a value is zero only when it is exactly zero.
/// Source: repeated synthetic division with everything multiplied by a power of two.
pub(super) fn taylor(p: &[IBig], z: &Dyadic, count: usize) -> Vec<Wide> {
    let mut values: Vec<Wide> = exact_taylor(p, z, count).iter().map(Dyadic::to_wide).collect();
    values.resize(count, Wide::ZERO);
    values
}

/// The same without any rounding; fewer than `count` where the degree ends.
pub(super) fn exact_taylor(p: &[IBig], z: &Dyadic, count: usize) -> Vec<Dyadic> {
    let Some(n) = p.len().checked_sub(1) else {
        return Vec::new();
    };
    let (lift, down) = (z.exponent.max(0) as usize, (-z.exponent).max(0) as usize);
    let (a, b) = (&z.re << lift, &z.im << lift);
    let on_real_axis = b.is_zero();
    let mut re: Vec<IBig> = p.iter().enumerate().map(|(j, c)| c << (down * j)).collect();
    let mut im = vec![IBig::ZERO; n + 1];
    let mut values = Vec::with_capacity(count);
    for k in 0..count.min(n + 1) {
        for j in 1..=n - k {
            if on_real_axis {
                let step = &re[j - 1] * &a;
                re[j] += step;
            } else {
                let step_re = &re[j - 1] * &a - &im[j - 1] * &b;
                let step_im = &re[j - 1] * &b + &im[j - 1] * &a;
                re[j] += step_re;
                im[j] += step_im;
            }
        }
        let (re, im) = (re[n - k].clone(), im[n - k].clone());
        values.push(Dyadic { re, im, exponent: -((down * (n - k)) as i64) });
    }
    values
}

/// (re + j im) · 2^`exponent`, each part rounded once.
fn wide(re: &IBig, im: &IBig, exponent: i64) -> Wide {
    let shift = re.bit_len().max(im.bit_len()).saturating_sub(900);
    let part = |x: &IBig| if shift == 0 { x.to_f64().value() } else { (x >> shift).to_f64().value() };
    Wide::new(Complex64::new(part(re), part(im)), exponent + shift as i64)
}

/// m and e with x = m · 2^e.
fn decode(x: f64) -> (i64, i64) {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let biased = (bits >> 52 & 0x7ff) as i64;
    let (m, e) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    (if x.is_sign_negative() { -m } else { m }, e)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_derivatives_by_hand() {
        #[track_caller]
        fn check(p: &[i64], z: (f64, f64), expected: &[(f64, f64)]) {
            let p: Vec<IBig> = p.iter().map(|&c| IBig::from(c)).collect();
            let z = Complex64::new(z.0, z.1);
            for point in [Dyadic::exactly(z), Dyadic::near(Wide::new(z, 0))] {
                let values = taylor(&p, &point, expected.len());
                let values: Vec<_> = values.iter().map(|v| (v.to_complex().re, v.to_complex().im)).collect();
                assert_eq!(values, expected);
            }
        }
        // s³ at 2 + h: 8 + 12h + 6h² + h³.
        check(&[1, 0, 0, 0], (2.0, 0.0), &[(8.0, 0.0), (12.0, 0.0), (6.0, 0.0), (1.0, 0.0), (0.0, 0.0)]);
        // s² + 2s + 5 at −1 + 2j is a root, with slope 4j.
        check(&[1, 2, 5], (-1.0, 2.0), &[(0.0, 0.0), (0.0, 4.0)]);
        // 3s + 1 at 0.25 − 0.5j.
        check(&[3, 1], (0.25, -0.5), &[(1.75, -1.5), (3.0, 0.0)]);
        check(&[7], (5.0, 1.0), &[(7.0, 0.0), (0.0, 0.0)]);
        check(&[], (5.0, 1.0), &[(0.0, 0.0)]);
        check(&[1, 0, 0], (2f64.powi(80), 0.0), &[(2f64.powi(160), 0.0), (2f64.powi(81), 0.0)]);
    }

    #[test]
    fn floating_point_numbers_are_held_exactly() {
        for x in [0.1, -5.588906250103, 1e-310, -1e300, 0.0, 3.0] {
            assert_eq!(Dyadic::exactly(Complex64::new(x, -x)).to_complex(), Complex64::new(x, -x));
        }
    }
}
