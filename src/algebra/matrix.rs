use super::Rational;

/// A dense matrix of exact rationals, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix {
    pub rows: Vec<Vec<Rational>>,
}

impl Matrix {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows: vec![vec![Rational::ZERO; columns]; rows] }
    }

    pub fn identity(n: usize) -> Self {
        let mut m = Self::zeros(n, n);
        for (i, row) in m.rows.iter_mut().enumerate() {
            row[i] = Rational::ONE;
        }
        m
    }

    pub fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// The length of the first row; 0 for a matrix without rows.
    pub fn column_count(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    pub fn is_square(&self) -> bool {
        self.rows.iter().all(|row| row.len() == self.rows.len())
    }

    /// `None` when the shapes differ.
    pub fn add(&self, other: &Self) -> Option<Self> {
        if self.row_count() != other.row_count() {
            return None;
        }
        let mut rows = Vec::with_capacity(self.row_count());
        for (a, b) in self.rows.iter().zip(&other.rows) {
            if a.len() != b.len() {
                return None;
            }
            rows.push(a.iter().zip(b).map(|(x, y)| x + y).collect());
        }
        Some(Self { rows })
    }

    /// `self` · `other`; `None` when the shapes do not fit.
    pub fn mul(&self, other: &Self) -> Option<Self> {
        let columns = other.column_count();
        if other.rows.iter().any(|row| row.len() != columns) {
            return None;
        }
        let mut product = Self::zeros(self.row_count(), columns);
        for (row, target) in self.rows.iter().zip(&mut product.rows) {
            if row.len() != other.row_count() {
                return None;
            }
            for (factor, source) in row.iter().zip(&other.rows) {
                if factor.is_zero() {
                    continue;
                }
                for (sum, value) in target.iter_mut().zip(source) {
                    *sum += factor * value;
                }
            }
        }
        Some(product)
    }

    pub fn scale(&self, factor: &Rational) -> Self {
        Self { rows: self.rows.iter().map(|row| row.iter().map(|x| x * factor).collect()).collect() }
    }

    /// The sum of the diagonal.
    pub fn trace(&self) -> Rational {
        self.rows.iter().enumerate().filter_map(|(i, row)| row.get(i)).fold(Rational::ZERO, |sum, x| sum + x)
    }

    /// `None` when it is not square; 1 for 0×0.
    pub fn determinant(&self) -> Option<Rational> {
        if !self.is_square() {
            return None;
        }
        let mut rows = self.rows.clone();
        let mut product = Rational::ONE;
        for k in 0..rows.len() {
            let Some(pivot) = (k..rows.len()).find(|&i| !rows[i][k].is_zero()) else {
                return Some(Rational::ZERO);
            };
            if pivot != k {
                rows.swap(pivot, k);
                product = -product;
            }
            product *= &rows[k][k];
            let (above, below) = rows.split_at_mut(k + 1);
            for row in below {
                subtract_multiple(row, &above[k], k);
            }
        }
        Some(product)
    }

    /// X with `self` · X = `right`; `None` when `self` is singular or the shapes do not fit.
    pub fn solve(&self, right: &Self) -> Option<Self> {
        let n = self.row_count();
        let columns = right.column_count();
        if !self.is_square() || right.row_count() != n || right.rows.iter().any(|r| r.len() != columns) {
            return None;
        }
        let mut rows: Vec<Vec<Rational>> =
            self.rows.iter().zip(&right.rows).map(|(a, b)| a.iter().chain(b).cloned().collect()).collect();
        for k in 0..n {
            let pivot = (k..n).find(|&i| !rows[i][k].is_zero())?;
            rows.swap(pivot, k);
            let inverse = Rational::ONE / &rows[k][k];
            for value in &mut rows[k] {
                *value *= &inverse;
            }
            let pivot_row = rows[k].clone();
            for (i, row) in rows.iter_mut().enumerate() {
                if i != k {
                    subtract_multiple(row, &pivot_row, k);
                }
            }
        }
        Some(Self { rows: rows.into_iter().map(|row| row[n..].to_vec()).collect() })
    }

    /// `None` when it is singular or not square.
    pub fn inverse(&self) -> Option<Self> {
        self.solve(&Self::identity(self.row_count()))
    }
}

/// Clears `row[k]` with the help of `pivot`, whose entry `k` is not zero.
fn subtract_multiple(row: &mut [Rational], pivot: &[Rational], k: usize) {
    if row[k].is_zero() {
        return;
    }
    let factor = &row[k] / &pivot[k];
    for (value, above) in row.iter_mut().zip(pivot).skip(k) {
        *value -= &factor * above;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[i64]]) -> Matrix {
        Matrix { rows: rows.iter().map(|row| row.iter().map(|&x| Rational::from(x)).collect()).collect() }
    }

    /// Name, rows, determinant.
    type Row<'a> = (&'a str, &'a [&'a [i64]], Option<i64>);

    #[track_caller]
    fn check_determinant(rows: &[Row]) {
        for (name, m, expected) in rows {
            assert_eq!(matrix(m).determinant(), expected.map(Rational::from), "{name}");
        }
    }

    #[test]
    fn determinants() {
        check_determinant(&[
            ("nothing", &[], Some(1)),
            ("one by one", &[&[7]], Some(7)),
            ("two by two", &[&[1, 2], &[3, 4]], Some(-2)),
            ("needs a swap", &[&[0, 1], &[1, 0]], Some(-1)),
            ("singular", &[&[1, 2], &[2, 4]], Some(0)),
            ("three by three", &[&[2, 0, 1], &[1, 3, 2], &[1, 1, 4]], Some(18)),
            ("not square", &[&[1, 2]], None),
            ("ragged", &[&[1, 2], &[3]], None),
        ]);
    }

    #[test]
    fn inverse_times_matrix_is_identity() {
        for rows in [
            matrix(&[&[0, 1], &[1, 1]]),
            matrix(&[&[2, 0, 1], &[1, 3, 2], &[1, 1, 4]]),
            matrix(&[&[0, 0, 3], &[0, 5, 1], &[7, 1, 1]]),
        ] {
            let inverse = rows.inverse().unwrap();
            assert_eq!(rows.mul(&inverse), Some(Matrix::identity(rows.row_count())));
            assert_eq!(inverse.mul(&rows), Some(Matrix::identity(rows.row_count())));
        }
        assert_eq!(matrix(&[&[1, 2], &[2, 4]]).inverse(), None);
    }

    #[test]
    fn sums_products_and_traces() {
        let a = matrix(&[&[1, 2], &[3, 4]]);
        let b = matrix(&[&[0, 1], &[1, 0]]);
        assert_eq!(a.mul(&b), Some(matrix(&[&[2, 1], &[4, 3]])));
        assert_eq!(a.add(&b), Some(matrix(&[&[1, 3], &[4, 4]])));
        assert_eq!(a.scale(&Rational::from(-2)), matrix(&[&[-2, -4], &[-6, -8]]));
        assert_eq!(a.trace(), Rational::from(5));
        assert_eq!(a.mul(&matrix(&[&[1, 2]])), None);
        assert_eq!(a.add(&matrix(&[&[1, 2]])), None);
        assert_eq!(a.solve(&matrix(&[&[5], &[11]])), Some(matrix(&[&[1], &[2]])));
    }
}
