use super::dyadic::{Dyadic, taylor};
use super::simple_roots::{Disc, PRECISION_BITS, simple_roots};
use crate::algebra::{Polynomial, Rational};
use dashu_int::IBig;
use num_complex::Complex64;
use std::cmp::Ordering;

/// A root in rad/s with its exact multiplicity and a rigorous bound on its distance from the true root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    pub re: f64,
    pub im: f64,
    pub multiplicity: usize,
    /// |computed − true| ≤ `error_bound`, rad/s.
    pub error_bound: f64,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RootError {
    #[error("the zero polynomial has every number as a root")]
    ZeroPolynomial,
    #[error("a polynomial of degree {degree} is beyond the {limit} we solve")]
    DegreeTooHigh { degree: usize, limit: usize },
    #[error("a root is too large or too small for a floating-point number")]
    OutOfRange,
    #[error("the roots did not settle after {iterations} iterations")]
    NotConverged { iterations: usize },
}

/// The highest degree [`roots`] takes on.
const DEGREE_LIMIT: usize = 60;

/// The distinct roots of `p`, each once with its multiplicity.
///
/// Shape: the multiplicities add up to the degree. Conjugate pairs are exact mirror images, upper half first; sorted
/// by falling real part, then by rising |im|. A root on an axis has a part that is exactly zero.
/// Accuracy: each part to the last bit or two, whatever the multiplicity or how close roots lie; `error_bound` is
/// proved in exact arithmetic and covers the rounding to `f64`.
/// Errors: [`RootError`]; roots that agree in a thousand digits or more do not settle.
/// Source: Yun's square-free split for the multiplicities, then certified Ehrlich–Aberth on each factor.
pub fn roots(p: &Polynomial) -> Result<Vec<Pole>, RootError> {
    let mut poles = Vec::new();
    for root in isolated_roots_to(p, PRECISION_BITS)? {
        poles.push(root.pole);
        if root.pole.im != 0.0 {
            poles.push(Pole { im: -root.pole.im, ..root.pole });
        }
    }
    Ok(poles)
}

/// A root on or above the real axis, also with more digits than an `f64` holds.
pub(super) struct IsolatedRoot {
    pub center: Dyadic,
    pub pole: Pole,
}

/// As [`roots`], without the lower half-plane, the centers to within 2^−`precision_bits` of each part.
pub(super) fn isolated_roots_to(p: &Polynomial, precision_bits: i64) -> Result<Vec<IsolatedRoot>, RootError> {
    if p.is_zero() {
        return Err(RootError::ZeroPolynomial);
    }
    let degree = p.degree();
    if degree > DEGREE_LIMIT {
        return Err(RootError::DegreeTooHigh { degree, limit: DEGREE_LIMIT });
    }
    let mut found = Vec::new();
    let at_origin = p.trailing_zeros();
    if at_origin > 0 {
        let pole = Pole { re: 0.0, im: 0.0, multiplicity: at_origin, error_bound: 0.0 };
        found.push(IsolatedRoot { center: Dyadic::exactly(Complex64::ZERO), pole });
    }
    let rest = p.exact_quotient(&Polynomial::monomial(Rational::ONE, at_origin));
    for (factor, multiplicity) in rest.square_free() {
        // Roots that lie symmetric about the origin apart from the others: only they can be on the imaginary axis.
        let symmetric = factor.gcd(&factor.mirror());
        for (part, even) in [(factor.exact_quotient(&symmetric), false), (symmetric, true)] {
            if part.degree() > 0 {
                let coefficients = part.primitive();
                for disc in simple_roots(&coefficients, even, precision_bits)? {
                    let pole = rounded(&disc, multiplicity, &coefficients)?;
                    let is_root = pole.error_bound == 0.0;
                    let center =
                        if is_root { Dyadic::exactly(Complex64::new(pole.re, pole.im)) } else { disc.center };
                    found.push(IsolatedRoot { center, pole });
                }
            }
        }
    }
    found.sort_by(|a, b| by_falling_real_part(&a.pole, &b.pole));
    Ok(found)
}

fn by_falling_real_part(a: &Pole, b: &Pole) -> Ordering {
    b.re.total_cmp(&a.re).then(a.im.total_cmp(&b.im))
}

/// The nearest `f64`s, and a bound that covers the disc and the rounding.
fn rounded(disc: &Disc, multiplicity: usize, p: &[IBig]) -> Result<Pole, RootError> {
    let z = disc.center.to_complex();
    let lost = |part: f64, exact_is_zero: bool| !part.is_finite() || (part == 0.0 && !exact_is_zero);
    if lost(z.re, disc.center.re().is_zero()) || lost(z.im, disc.center.im().is_zero()) {
        return Err(RootError::OutOfRange);
    }
    let nearest = Dyadic::exactly(z);
    let rounding = nearest.minus(&disc.center).to_wide().abs();
    // Small whole numbers are often the root itself.
    let is_root = rounding.cmp_abs(disc.radius) != Ordering::Greater && taylor(p, &nearest, 1)[0].is_zero();
    let bound = (disc.radius + rounding).to_complex().re;
    let error_bound = if is_root { 0.0 } else { bound * (1.0 + 1e-10) + f64::from_bits(1) };
    Ok(Pole { re: z.re, im: z.im, multiplicity, error_bound })
}

#[cfg(test)]
#[allow(clippy::excessive_precision, reason = "as many digits as the source gives")]
mod tests {
    use super::*;
    use crate::lti::tests::{HANGING, UPRIGHT, polynomial};

    /// (s + 1)(s + 2)…(s + n).
    fn wilkinson(n: i64) -> Polynomial {
        (1..=n).fold(Polynomial::one(), |p, k| &p * &Polynomial::from_integers(&[1, k]))
    }

    fn power(p: &Polynomial, n: usize) -> Polynomial {
        (0..n).fold(Polynomial::one(), |product, _| &product * p)
    }

    /// `expected`: re, im ≥ 0, multiplicity, in the order of [`roots`]; the mirror images are added here.
    #[track_caller]
    fn check(what: &str, p: &Polynomial, expected: &[(f64, f64, usize)]) {
        let found = roots(p).unwrap_or_else(|error| panic!("{what}: {error}"));
        let mirrored = expected.iter().flat_map(|&(re, im, m)| {
            let lower = (im != 0.0).then_some((re, -im, m));
            std::iter::once((re, im, m)).chain(lower)
        });
        let expected: Vec<_> = mirrored.collect();
        assert_eq!(found.len(), expected.len(), "{what}: {found:?}");
        let close = |a: f64, b: f64| (a - b).abs() <= 3e-16 * b.abs();
        for (pole, &(re, im, multiplicity)) in found.iter().zip(&expected) {
            assert!(close(pole.re, re) && close(pole.im, im), "{what}: {pole:?} is not {re} + {im}j");
            assert_eq!(pole.multiplicity, multiplicity, "{what}: {pole:?}");
            let size = re.hypot(im);
            assert!((0.0..=2.3e-16 * size).contains(&pole.error_bound), "{what}: bound of {pole:?}");
        }
        assert_eq!(found.iter().map(|pole| pole.multiplicity).sum::<usize>(), p.degree(), "{what}");
    }

    #[test]
    fn by_hand() {
        let p = Polynomial::from_integers;
        check("constant", &p(&[7]), &[]);
        check("first order", &p(&[2, 3]), &[(-1.5, 0.0, 1)]);
        check("integrators", &p(&[4, 0, 0, 0]), &[(0.0, 0.0, 3)]);
        check("pair", &p(&[1, 2, 5]), &[(-1.0, 2.0, 1)]);
        check(
            "double integrator and pair",
            &p(&[1, 0, 1, 0, 0]),
            &[(0.0, 1.0, 1), (0.0, 0.0, 2)][..].iter().rev().copied().collect::<Vec<_>>(),
        );
        check("(s + 1)^10", &power(&p(&[1, 1]), 10), &[(-1.0, 0.0, 10)]);
        check(
            "(s^2 + s + 1)^3 (s - 2)",
            &(&power(&p(&[1, 1, 1]), 3) * &p(&[1, -2])),
            &[(2.0, 0.0, 1), (-0.5, 0.75f64.sqrt(), 3)],
        );
        let half = 0.5f64.sqrt();
        check(
            "s^8 - 1",
            &p(&[1, 0, 0, 0, 0, 0, 0, 0, -1]),
            &[(1.0, 0.0, 1), (half, half, 1), (0.0, 1.0, 1), (-half, half, 1), (-1.0, 0.0, 1)],
        );
        check("s^4 + 5s^2 + 4", &p(&[1, 0, 5, 0, 4]), &[(0.0, 1.0, 1), (0.0, 2.0, 1)]);
        check("real parts alike", &(&p(&[1, 2, 5]) * &p(&[1, 2, 2])), &[(-1.0, 1.0, 1), (-1.0, 2.0, 1)]);
        for n in [5, 15, 20, 40] {
            let whole: Vec<_> = (1..=n).map(|k| (-k as f64, 0.0, 1)).collect();
            check(&format!("Wilkinson {n}"), &wilkinson(n), &whole);
        }
    }

    /// mpmath 1.3, polyroots with 120 digits.
    #[test]
    fn against_many_digits() {
        check(
            "hanging pendulum",
            &polynomial(HANGING.1),
            &[(-0.019467786474327556, 5.5863847121985271, 1), (-0.14288260886952671, 0.0, 1)],
        );
        check(
            "upright pendulum",
            &polynomial(UPRIGHT.1),
            &[(5.5679556086373016, 0.0, 1), (-0.14283166170368237, 0.0, 1), (-5.606942128751801, 0.0, 1)],
        );
        check(
            "RLC in SI units",
            &polynomial("1 1e6 1e18 5e19"),
            &[(-50.000000002499875, 0.0, 1), (-499974.99999999875, 999999874.98749312, 1)],
        );
        check(
            "lightly damped and fast",
            &polynomial("1 2.00001 400000000000001.00002 4000000000.00001"),
            &[(-1e-5, 0.0, 1), (-1.0, 2e7, 1)],
        );
        check(
            "coefficients 1e-12 to 1e12",
            &polynomial("1e-12 1 1e12 1 1e-12"),
            &[(-5.0e-13, 8.6602540378443865e-13, 1), (-500000000000.0, 866025403784.43865, 1)],
        );
        check(
            "leading coefficient 1e-18",
            &polynomial("1e-18 1 3 2"),
            &[(-1.0, 0.0, 1), (-2.0, 0.0, 1), (-1e18, 0.0, 1)],
        );
        check(
            "Mignotte: two roots agree to 15 digits",
            &polynomial("1 0 0 0 0 0 0 0 -2000000 4000 -2"),
            &[
                (6.1321256096893614, 0.0, 1),
                (4.3359943783972754, 4.3362444144349159, 1),
                (0.0010000000000000007, 0.0, 1),
                (0.00099999999999999929, 0.0, 1),
                (-0.00024999999584508151, 6.1323756606525604, 1),
                (-4.3364943783972754, 4.3362444144266061, 1),
                (-6.1326256096976713, 0.0, 1),
            ],
        );
        check(
            "s^5 + 2s^4 + 2s^3 + 4s^2 + 11s + 10",
            &polynomial("1 2 2 4 11 10"),
            &[
                (0.8950167060408472, 1.4561048548820236, 1),
                (-1.2406612904699917, 1.0375047051101447, 1),
                (-1.3087108311417111, 0.0, 1),
            ],
        );
    }

    #[test]
    fn roots_closer_than_floating_point_can_tell() {
        // (s + 1)² = ±1e-60: real in one case, not in the other; the multiplicity is 1 all the same.
        let apart = polynomial("1 2 0.999999999999999999999999999999999999999999999999999999999999");
        check("real", &apart, &[(-1.0, 0.0, 1), (-1.0, 0.0, 1)]);
        let pair = polynomial("1 2 1.000000000000000000000000000000000000000000000000000000000001");
        check("a pair", &pair, &[(-1.0, 1e-30, 1)]);
        let damped = polynomial("1 2e-40 1");
        check("damping of 1e-40", &damped, &[(-1e-40, 1.0, 1)]);
    }

    #[test]
    fn sizes_and_degrees_at_the_limit() {
        check("coefficients 1e200", &polynomial("1e200 3e200 2e200"), &[(-1.0, 0.0, 1), (-2.0, 0.0, 1)]);
        check("roots 1e-150 and 1e150", &polynomial("1 1e150 1"), &[(-1e-150, 0.0, 1), (-1e150, 0.0, 1)]);
        assert_eq!(roots(&polynomial("1 1e350 1")), Err(RootError::OutOfRange));
        assert_eq!(roots(&polynomial("1 1e-350")), Err(RootError::OutOfRange));
        assert_eq!(roots(&Polynomial::zero()), Err(RootError::ZeroPolynomial));
        let high = Polynomial::monomial(Rational::ONE, 61);
        assert_eq!(roots(&high), Err(RootError::DegreeTooHigh { degree: 61, limit: 60 }));
        let unity = &Polynomial::monomial(Rational::ONE, 60) - &Polynomial::one();
        assert_eq!(roots(&unity).unwrap().len(), 60);
    }

    #[test]
    fn every_small_polynomial_settles() {
        // All of degree 6 with coefficients −1, 0, 1: companion-matrix methods hang on 19 of them.
        for code in 0..729 {
            let coefficients: Vec<i64> =
                (0..7).map(|k| if k == 0 { 1 } else { code / 3i64.pow(k - 1) % 3 - 1 }).collect();
            let p = Polynomial::from_integers(&coefficients);
            let found = roots(&p).unwrap();
            assert_eq!(found.iter().map(|pole| pole.multiplicity).sum::<usize>(), 6, "{coefficients:?}");
            let right =
                found.iter().filter(|pole| pole.re > 0.0).map(|pole| pole.multiplicity).sum::<usize>();
            assert_eq!(right, super::super::right_half_plane_roots(&p), "{coefficients:?}");
        }
    }
}
