use super::coprime::surely_coprime;
use super::{Rational, to_f64};
use dashu_int::ops::{Abs, Gcd};
use dashu_int::{IBig, UBig};
use num_complex::Complex64;
use std::ops::{Add, Mul, Neg, Sub};

/// A polynomial with exact rational coefficients, highest power first, without leading zeros.
///
/// `[1, 2, 5]` is s² + 2s + 5; the zero polynomial has no coefficients.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct Polynomial {
    coefficients: Vec<Rational>,
}

impl Polynomial {
    /// Leading zeros are dropped.
    pub fn new(coefficients: Vec<Rational>) -> Self {
        let lead = coefficients.iter().position(|c| !c.is_zero());
        match lead {
            Some(0) => Self { coefficients },
            Some(first) => Self { coefficients: coefficients[first..].to_vec() },
            None => Self::default(),
        }
    }

    /// Highest power first: `from_integers(&[1, 2, 5])` is s² + 2s + 5.
    pub fn from_integers(coefficients: &[i64]) -> Self {
        Self::new(coefficients.iter().map(|&c| Rational::from(c)).collect())
    }

    pub fn zero() -> Self {
        Self::default()
    }

    pub fn one() -> Self {
        Self::constant(Rational::ONE)
    }

    pub fn constant(value: Rational) -> Self {
        Self::new(vec![value])
    }

    /// `coefficient` · s^`power`.
    pub fn monomial(coefficient: Rational, power: usize) -> Self {
        let mut coefficients = vec![Rational::ZERO; power + 1];
        coefficients[0] = coefficient;
        Self::new(coefficients)
    }

    /// Highest power first.
    pub fn coefficients(&self) -> &[Rational] {
        &self.coefficients
    }

    /// The coefficient of s^`power`; 0 beyond the degree.
    pub fn coefficient(&self, power: usize) -> Rational {
        let index = self.coefficients.len().checked_sub(power + 1);
        index.map_or(Rational::ZERO, |i| self.coefficients[i].clone())
    }

    pub fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// The degree; 0 for constants and for zero.
    pub fn degree(&self) -> usize {
        self.coefficients.len().saturating_sub(1)
    }

    /// The coefficient of the highest power; `None` for zero.
    pub fn leading(&self) -> Option<&Rational> {
        self.coefficients.first()
    }

    /// Divided by the leading coefficient; zero stays zero.
    pub fn monic(&self) -> Self {
        match self.leading() {
            Some(lead) => self.scale(&(Rational::ONE / lead)),
            None => Self::zero(),
        }
    }

    pub fn scale(&self, factor: &Rational) -> Self {
        Self::new(self.coefficients.iter().map(|c| c * factor).collect())
    }

    pub fn derivative(&self) -> Self {
        let n = self.degree();
        let terms = self.coefficients.iter().take(n).enumerate();
        Self::new(terms.map(|(i, c)| c * Rational::from(n - i)).collect())
    }

    /// p(−s).
    pub fn mirror(&self) -> Self {
        let n = self.degree();
        let terms = self.coefficients.iter().enumerate();
        Self::new(terms.map(|(i, c)| if (n - i) % 2 == 1 { -c } else { c.clone() }).collect())
    }

    /// How often s divides it; 0 for zero.
    pub fn trailing_zeros(&self) -> usize {
        self.coefficients.iter().rev().take_while(|c| c.is_zero()).count()
    }

    /// p(x), exactly.
    pub fn eval(&self, x: &Rational) -> Rational {
        self.coefficients.iter().fold(Rational::ZERO, |sum, c| sum * x + c)
    }

    /// p(x) by Horner's rule in floating point.
    pub fn eval_f64(&self, x: Complex64) -> Complex64 {
        self.coefficients.iter().fold(Complex64::ZERO, |sum, c| sum * x + to_f64(c))
    }

    /// The nearest `f64` of each coefficient, highest power first.
    pub fn to_f64(&self) -> Vec<f64> {
        self.coefficients.iter().map(to_f64).collect()
    }

    /// Quotient and remainder, the remainder of smaller degree than `divisor`; `None` when `divisor` is zero.
    pub fn div_rem(&self, divisor: &Self) -> Option<(Self, Self)> {
        let lead = divisor.leading()?;
        let steps = (self.coefficients.len() + 1).saturating_sub(divisor.coefficients.len());
        let mut rest = self.coefficients.clone();
        let mut quotient = Vec::with_capacity(steps);
        for i in 0..steps {
            let factor = &rest[i] / lead;
            if !factor.is_zero() {
                for (target, d) in rest[i..].iter_mut().zip(&divisor.coefficients) {
                    *target -= &factor * d;
                }
            }
            quotient.push(factor);
        }
        Some((Self::new(quotient), Self::new(rest.split_off(steps))))
    }

    /// The monic greatest common divisor; zero only when both are zero.
    ///
    /// Source: Euclid on integer polynomials, each remainder freed of its content; Knuth, *TAOCP* 2, 4.6.1.
    pub fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.primitive(), other.primitive());
        if surely_coprime(&a, &b) {
            return Self::one();
        }
        if a.len() < b.len() {
            std::mem::swap(&mut a, &mut b);
        }
        while !b.is_empty() {
            if b.len() == 1 {
                return Self::one();
            }
            let rest = primitive_remainder(a, &b);
            a = b;
            b = rest;
        }
        Self::new(a.into_iter().map(Rational::from).collect()).monic()
    }

    /// The monic square-free factors with their exact multiplicity, multiplicity rising: p = lead · ∏ factorᵢ^mᵢ.
    ///
    /// Empty for constants and for zero.
    /// Source: Yun's algorithm, 1976.
    pub fn square_free(&self) -> Vec<(Self, usize)> {
        let mut factors = Vec::new();
        if self.degree() == 0 {
            return factors;
        }
        let p = self.monic();
        let slope = p.derivative();
        let shared = p.gcd(&slope);
        let mut b = p.exact_quotient(&shared);
        let mut d = &slope.exact_quotient(&shared) - &b.derivative();
        let mut multiplicity = 1;
        while b.degree() > 0 {
            let factor = b.gcd(&d);
            b = b.exact_quotient(&factor);
            d = &d.exact_quotient(&factor) - &b.derivative();
            if factor.degree() > 0 {
                factors.push((factor, multiplicity));
            }
            multiplicity += 1;
        }
        factors
    }

    /// The quotient by a divisor known to be a factor.
    pub(crate) fn exact_quotient(&self, divisor: &Self) -> Self {
        self.div_rem(divisor).map_or_else(Self::zero, |(quotient, _)| quotient)
    }

    /// The integer coefficients without common factor, highest power first; empty for zero.
    pub(crate) fn primitive(&self) -> Vec<IBig> {
        let mut common = UBig::ONE;
        for c in &self.coefficients {
            let shared = (&common).gcd(c.denominator());
            common = common / shared * c.denominator();
        }
        let scaled = self.coefficients.iter().map(|c| {
            let factor = &common / c.denominator();
            c.numerator() * IBig::from(factor)
        });
        without_content(scaled.collect())
    }
}

/// A multiple of the remainder of `a` by `b`, freed of its content; empty for zero.
fn primitive_remainder(a: Vec<IBig>, b: &[IBig]) -> Vec<IBig> {
    let mut rest = a;
    while rest.len() >= b.len() {
        let shared = (&rest[0]).gcd(&b[0]);
        let keep = &b[0] / IBig::from(shared.clone());
        let take = &rest[0] / IBig::from(shared);
        for (i, value) in rest.iter_mut().enumerate() {
            *value *= &keep;
            if let Some(other) = b.get(i) {
                *value -= &take * other;
            }
        }
        rest = without_content(rest);
    }
    rest
}

/// Divided by the greatest common divisor of all coefficients, leading zeros dropped.
fn without_content(coefficients: Vec<IBig>) -> Vec<IBig> {
    let zero = IBig::ZERO;
    let Some(first) = coefficients.iter().position(|c| *c != zero) else {
        return Vec::new();
    };
    let mut content = UBig::ZERO;
    for c in &coefficients[first..] {
        if content == UBig::ONE {
            break;
        }
        if *c != zero {
            content = if content == UBig::ZERO {
                c.clone().abs().try_into().unwrap_or(UBig::ONE)
            } else {
                content.gcd(c)
            };
        }
    }
    let content = IBig::from(content);
    coefficients.into_iter().skip(first).map(|c| c / &content).collect()
}

impl Add for &Polynomial {
    type Output = Polynomial;
    fn add(self, other: Self) -> Polynomial {
        let length = self.coefficients.len().max(other.coefficients.len());
        Polynomial::new((0..length).rev().map(|k| self.coefficient(k) + other.coefficient(k)).collect())
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;
    fn sub(self, other: Self) -> Polynomial {
        let length = self.coefficients.len().max(other.coefficients.len());
        Polynomial::new((0..length).rev().map(|k| self.coefficient(k) - other.coefficient(k)).collect())
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;
    fn mul(self, other: Self) -> Polynomial {
        if self.is_zero() || other.is_zero() {
            return Polynomial::zero();
        }
        let mut product = vec![Rational::ZERO; self.degree() + other.degree() + 1];
        for (i, a) in self.coefficients.iter().enumerate() {
            if a.is_zero() {
                continue;
            }
            for (j, b) in other.coefficients.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Polynomial::new(product)
    }
}

impl Neg for &Polynomial {
    type Output = Polynomial;
    fn neg(self) -> Polynomial {
        Polynomial::new(self.coefficients.iter().map(|c| -c).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse_decimal;
    use super::*;
    use proptest::prelude::*;

    fn p(coefficients: &[i64]) -> Polynomial {
        Polynomial::from_integers(coefficients)
    }

    fn power(base: &Polynomial, exponent: usize) -> Polynomial {
        (0..exponent).fold(Polynomial::one(), |product, _| &product * base)
    }

    #[test]
    fn parts() {
        let q = p(&[0, 0, 1, 2, 0]);
        assert_eq!(q.coefficients(), p(&[1, 2, 0]).coefficients());
        assert_eq!((q.degree(), q.trailing_zeros()), (2, 1));
        assert_eq!(q.coefficient(2), Rational::ONE);
        assert_eq!(q.coefficient(0), Rational::ZERO);
        assert_eq!(q.coefficient(9), Rational::ZERO);
        assert_eq!(q.derivative(), p(&[2, 2]));
        assert_eq!(p(&[1, 2, 3, 4]).mirror(), p(&[-1, 2, -3, 4]));
        assert_eq!(p(&[2, 4]).monic(), p(&[1, 2]));
        assert_eq!(p(&[1, 2, 5]).eval(&Rational::from(3)), Rational::from(20));
        assert_eq!(p(&[1, 0, 1]).eval_f64(Complex64::new(0.0, 1.0)), Complex64::ZERO);
        assert_eq!(Polynomial::monomial(Rational::from(3), 2), p(&[3, 0, 0]));
        let zero = Polynomial::zero();
        assert_eq!((zero.degree(), zero.trailing_zeros(), zero.leading()), (0, 0, None));
        assert_eq!((zero.monic(), zero.derivative()), (zero.clone(), zero));
    }

    /// Name, two polynomials, their divisor.
    type Row<'a> = (&'a str, &'a [i64], &'a [i64], &'a [i64]);

    #[track_caller]
    fn check_gcd(rows: &[Row]) {
        for (name, a, b, expected) in rows {
            assert_eq!(p(a).gcd(&p(b)), p(expected), "{name}");
            assert_eq!(p(b).gcd(&p(a)), p(expected), "{name}, turned round");
        }
    }

    #[test]
    fn common_divisors() {
        check_gcd(&[
            ("both zero", &[], &[], &[]),
            ("one zero", &[], &[2, 4], &[1, 2]),
            ("constants", &[6], &[4], &[1]),
            ("coprime", &[1, 2], &[1, 3], &[1]),
            ("a shared root", &[1, 3, 2], &[1, 4, 3], &[1, 1]),
            ("a shared s", &[-6, 0, 0], &[1, 2, 3, 0], &[1, 0]),
            ("one divides the other", &[2, 6, 4], &[3, 3], &[1, 1]),
            ("Knuth's example", &[1, 0, 1, 0, -3, -3, 8, 2, -5], &[3, 0, 5, 0, -4, -9, 21], &[1]),
        ]);
    }

    #[test]
    fn multiplicities_are_exact() {
        let s1 = p(&[1, 1]);
        let decimal = Polynomial::new(vec![Rational::ONE, parse_decimal("1.71").unwrap()]);
        let product = &(&power(&s1, 10) * &power(&decimal, 3)) * &p(&[5, 0, 20]);
        assert_eq!(product.square_free(), vec![(p(&[1, 0, 4]), 1), (decimal, 3), (s1, 10)]);
        assert_eq!(p(&[1, 0, 0, 0]).square_free(), vec![(p(&[1, 0]), 3)]);
        assert_eq!(p(&[7]).square_free(), vec![]);
        assert_eq!(Polynomial::zero().square_free(), vec![]);
    }

    fn rational() -> impl Strategy<Value = Rational> {
        (-50i64..50, 1u64..12).prop_map(|(n, d)| Rational::from_parts(n.into(), d.into()))
    }

    fn polynomial() -> impl Strategy<Value = Polynomial> {
        prop::collection::vec(rational(), 0..6).prop_map(Polynomial::new)
    }

    proptest! {
        #[test]
        fn division_is_undone_by_multiplication(a in polynomial(), b in polynomial()) {
            match a.div_rem(&b) {
                None => prop_assert!(b.is_zero()),
                Some((quotient, rest)) => {
                    prop_assert_eq!(&(&quotient * &b) + &rest, a);
                    prop_assert!(rest.is_zero() || rest.degree() < b.degree());
                }
            }
        }

        #[test]
        fn the_gcd_divides_and_holds_every_common_factor(a in polynomial(), b in polynomial(), c in polynomial()) {
            let (left, right) = (&a * &c, &b * &c);
            let gcd = left.gcd(&right);
            if !gcd.is_zero() {
                prop_assert_eq!(gcd.leading(), Some(&Rational::ONE));
                prop_assert!(left.div_rem(&gcd).unwrap().1.is_zero());
                prop_assert!(right.div_rem(&gcd).unwrap().1.is_zero());
                prop_assert!(c.is_zero() || gcd.div_rem(&c).unwrap().1.is_zero());
            }
        }

        #[test]
        fn square_free_factors_multiply_back(a in polynomial(), b in polynomial()) {
            let product = &(&a * &b) * &b;
            let factors = product.square_free();
            if !product.is_zero() {
                let back = factors.iter().fold(Polynomial::one(), |sum, (f, m)| &sum * &power(f, *m));
                prop_assert_eq!(back, product.monic());
            }
            for (factor, _) in &factors {
                prop_assert_eq!(factor.gcd(&factor.derivative()), Polynomial::one());
            }
        }

        #[test]
        fn arithmetic_agrees_with_values(a in polynomial(), b in polynomial(), x in rational()) {
            prop_assert_eq!((&a + &b).eval(&x), a.eval(&x) + b.eval(&x));
            prop_assert_eq!((&a - &b).eval(&x), a.eval(&x) - b.eval(&x));
            prop_assert_eq!((&a * &b).eval(&x), a.eval(&x) * b.eval(&x));
            prop_assert_eq!((-&a).eval(&x), -a.eval(&x));
            prop_assert_eq!(a.mirror().eval(&x), a.eval(&-x));
        }
    }
}
