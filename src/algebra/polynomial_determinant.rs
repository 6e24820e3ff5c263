use super::Polynomial;

/// The determinant of a square matrix of polynomials, row by row; 1 for 0×0.
///
/// Source: fraction-free elimination; Bareiss, *Math. Comp.* 22 (1968).
pub fn polynomial_determinant(mut rows: Vec<Vec<Polynomial>>) -> Polynomial {
    let n = rows.len();
    let mut previous = Polynomial::one();
    let mut negative = false;
    for k in 0..n {
        let Some(pivot) = (k..n).find(|&i| !rows[i][k].is_zero()) else {
            return Polynomial::zero();
        };
        if pivot != k {
            rows.swap(pivot, k);
            negative = !negative;
        }
        let (above, below) = rows.split_at_mut(k + 1);
        let pivot_row = &above[k];
        for row in below {
            for j in k + 1..n {
                let cross = &(&row[j] * &pivot_row[k]) - &(&row[k] * &pivot_row[j]);
                row[j] = cross.exact_quotient(&previous);
            }
        }
        previous = pivot_row[k].clone();
    }
    if negative { -&previous } else { previous }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[&[i64]]]) -> Vec<Vec<Polynomial>> {
        rows.iter().map(|row| row.iter().map(|c| Polynomial::from_integers(c)).collect()).collect()
    }

    /// Name, entries, determinant.
    type Row<'a> = (&'a str, &'a [&'a [&'a [i64]]], &'a [i64]);

    #[track_caller]
    fn check(rows: &[Row]) {
        for (name, m, expected) in rows {
            assert_eq!(polynomial_determinant(matrix(m)), Polynomial::from_integers(expected), "{name}");
        }
    }

    #[test]
    fn determinants() {
        check(&[
            ("nothing", &[], &[1]),
            ("one", &[&[&[1, 2]]], &[1, 2]),
            ("two", &[&[&[1, 0], &[1]], &[&[2], &[1, 1]]], &[1, 1, -2]),
            ("needs a swap", &[&[&[], &[1, 0]], &[&[1, 1], &[5]]], &[-1, -1, 0]),
            ("singular", &[&[&[1, 0], &[2, 0]], &[&[3], &[6]]], &[]),
            (
                "characteristic polynomial of a companion matrix",
                &[&[&[1, 0], &[-1], &[]], &[&[], &[1, 0], &[-1]], &[&[6], &[11], &[1, 6]]],
                &[1, 6, 11, 6],
            ),
        ]);
    }
}
