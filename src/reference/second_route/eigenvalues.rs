//! Roots as eigenvalues, by Schur's decomposition.

use super::digits;
use crate::algebra::{Matrix, Polynomial, to_f64};
use crate::lti::Pole;
use nalgebra::linalg::{Schur, balancing};
use nalgebra::{Complex, DMatrix};

/// The eigenvalues of a matrix; `None` when the iteration does not come to an end.
pub(super) fn of_matrix(matrix: &Matrix) -> Option<Vec<Complex<f64>>> {
    let n = matrix.rows.len();
    eigenvalues(DMatrix::from_fn(n, n, |i, j| to_f64(&matrix.rows[i][j])))
}

/// The roots of a polynomial: the eigenvalues of its companion matrix, and those at the origin, which it shows openly.
pub(super) fn of_polynomial(p: &Polynomial) -> Option<Vec<Complex<f64>>> {
    let (zeros, lead) = (p.trailing_zeros(), p.leading()?);
    let n = p.degree() - zeros;
    let mut roots = eigenvalues(DMatrix::from_fn(n, n, |i, j| match i {
        0 => -to_f64(&(p.coefficient(n - 1 - j + zeros) / lead)),
        _ if i == j + 1 => 1.0,
        _ => 0.0,
    }))?;
    roots.resize(p.degree(), Complex::new(0.0, 0.0));
    Some(roots)
}

fn eigenvalues(mut a: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let n = a.nrows();
    if n == 0 {
        return Some(Vec::new());
    }
    if a.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    balancing::balance_parlett_reinsch(&mut a);
    let schur = Schur::try_new(a.clone(), f64::EPSILON, 100 * n)
        .or_else(|| Schur::try_new(a.transpose(), f64::EPSILON, 100 * n))?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Digits of agreement of eigenvalues with poles, matched greedily, nearest first; of the largest pole.
pub(super) fn digits_with(found: Option<Vec<Complex<f64>>>, poles: &[Pole]) -> f64 {
    let Some(mut left) = found else { return 0.0 };
    if left.len() != poles.iter().map(|p| p.multiplicity).sum::<usize>() {
        return 0.0;
    }
    let scale = poles.iter().map(|p| p.re.hypot(p.im)).fold(f64::MIN_POSITIVE, f64::max);
    let mut worst = 0.0f64;
    for pole in poles.iter().flat_map(|p| std::iter::repeat_n(p, p.multiplicity)) {
        let distance = |z: &Complex<f64>| (z.re - pole.re).hypot(z.im - pole.im);
        let nearest = (0..left.len()).min_by(|i, j| distance(&left[*i]).total_cmp(&distance(&left[*j])));
        let Some(nearest) = nearest else { return 0.0 };
        worst = worst.max(distance(&left.swap_remove(nearest)));
    }
    digits(worst, scale)
}

/// Digits that eigenvalues of poles this often repeated can be expected to agree in.
pub(super) fn wanted(poles: &[Pole]) -> f64 {
    8.0 / poles.iter().map(|p| p.multiplicity).max().unwrap_or(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::Rational;

    /// Coefficients, highest first, and the roots.
    #[track_caller]
    fn check(coefficients: &[i64], roots: &[f64]) {
        let p = Polynomial::new(coefficients.iter().map(|c| Rational::from(*c)).collect());
        let mut found: Vec<f64> = of_polynomial(&p).unwrap().iter().map(|z| z.re).collect();
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), roots.len(), "{found:?}");
        assert!(found.iter().zip(roots).all(|(x, y)| (x - y).abs() <= 1e-12 * y.abs()), "{found:?}");
    }

    #[test]
    fn roots_at_the_origin_are_exact() {
        check(&[1, 0, 0, 0, 0], &[0.0; 4]);
        check(&[2, 6, 4, 0, 0], &[-2.0, -1.0, 0.0, 0.0]);
        check(&[5], &[]);
    }
}
