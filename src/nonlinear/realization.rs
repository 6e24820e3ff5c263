use super::ChainError;
use nalgebra::{DMatrix, DVector, RowDVector};

/// A transfer function as ẋ = a·x + b·u, y = c·x + d·u, at rest when x = 0.
///
/// Controllable canonical form in states scaled by powers of the fastest pole's size, so that the entries of `a` are
/// of one magnitude even where the coefficients span dozens of decades.
#[derive(Clone, Debug)]
pub(super) struct Realization {
    pub a: DMatrix<f64>,
    pub b: DVector<f64>,
    pub c: RowDVector<f64>,
    pub d: f64,
}

impl Realization {
    /// `index` is the block's place in its chain, for the error.
    pub fn new(index: usize, num: &[f64], den: &[f64]) -> Result<Self, ChainError> {
        let strip = |p: &[f64]| p.iter().copied().skip_while(|&c| c == 0.0).collect::<Vec<f64>>();
        let (num, den) = (strip(num), strip(den));
        let Some(&leading) = den.first() else { return Err(ChainError::ZeroDenominator { index }) };
        let order = den.len() - 1;
        if num.len() > den.len() {
            return Err(ChainError::Improper { index, num: num.len() - 1, den: order });
        }
        // a_k and b_k multiply s^(order - k) in denominator and numerator, both divided by `leading`.
        let a_k = |k: usize| den[k] / leading;
        let b_k = |k: usize| (k + num.len()).checked_sub(den.len()).map_or(0.0, |i| num[i] / leading);
        let fastest = (1..=order).map(|k| a_k(k).abs().powf(1.0 / k as f64)).fold(0.0, f64::max);
        let sigma = if fastest > 0.0 { fastest } else { 1.0 };

        let mut a = DMatrix::zeros(order, order);
        let mut b = DVector::zeros(order);
        let mut c = RowDVector::zeros(order);
        let d = b_k(0);
        for state in 0..order {
            let k = order - state;
            if state + 1 < order {
                a[(state, state + 1)] = sigma;
            }
            a[(order - 1, state)] -= a_k(k) * sigma.powi(1 - k as i32);
            c[state] = (b_k(k) - a_k(k) * d) * sigma.powi(-(k as i32));
        }
        if order > 0 {
            b[order - 1] = sigma;
        }
        let finite = a.iter().chain(b.iter()).chain(c.iter()).chain([&d]).all(|value| value.is_finite());
        if finite { Ok(Self { a, b, c, d }) } else { Err(ChainError::NotFinite { time_s: 0.0 }) }
    }

    pub fn order(&self) -> usize {
        self.b.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    /// c·(s − a)⁻¹·b + d, against num/den.
    #[track_caller]
    fn check(name: &str, num: &[f64], den: &[f64]) {
        let r = Realization::new(0, num, den).unwrap();
        for s in [Complex64::new(0.3, 0.7), Complex64::new(0.0, 40.0), Complex64::new(1e6, 2e6)] {
            let value = |p: &[f64]| p.iter().fold(Complex64::ZERO, |sum, &c| sum * s + c);
            let matrix = DMatrix::from_fn(r.order(), r.order(), |i, j| {
                (if i == j { s } else { Complex64::ZERO }) - r.a[(i, j)]
            });
            let x = if r.order() > 0 {
                matrix.lu().solve(&r.b.map(Complex64::from)).unwrap()
            } else {
                DVector::zeros(0)
            };
            let found = r.c.iter().zip(&x).map(|(c, x)| x * c).sum::<Complex64>() + r.d;
            let expected = value(num) / value(den);
            assert!(
                (found - expected).norm() < 1e-12 * expected.norm(),
                "{name} at {s}: {found}, {expected}"
            );
        }
    }

    #[test]
    fn the_transfer_function_comes_back() {
        check("motor", &[0.2083], &[1.0, 1.71]);
        check("motor, position", &[0.2083], &[1.0, 1.71, 0.0]);
        check("pendulum", &[-0.06, 0.0], &[0.0132, 0.0024, 0.41202, 0.05886]);
        check("gain", &[3.0], &[2.0]);
        check("as many zeros as poles", &[1.0, 2.0, 5.0], &[2.0, 3.0, 7.0]);
        check("leading zeros", &[0.0, 0.0, 1.0], &[0.0, 1.0, 1.0]);
        check("double integrator", &[2.0], &[1.0, 0.0, 0.0]);
        check("circuit in SI units", &[1e18], &[1.0, 1e6, 1e18]);
    }

    #[test]
    fn what_cannot_be_realized() {
        let error = |num: &[f64], den: &[f64]| Realization::new(2, num, den).unwrap_err();
        assert_eq!(error(&[1.0, 0.0], &[3.0]), ChainError::Improper { index: 2, num: 1, den: 0 });
        assert_eq!(error(&[1.0], &[0.0, 0.0]), ChainError::ZeroDenominator { index: 2 });
        assert_eq!(error(&[f64::NAN], &[1.0, 1.0]), ChainError::NotFinite { time_s: 0.0 });
    }
}
