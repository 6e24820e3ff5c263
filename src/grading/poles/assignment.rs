use super::typed_pole::TypedPole;
use crate::lab::Tolerance;
use crate::lti::Pole;
use num_complex::Complex64;
use pathfinding::prelude::{Matrix, kuhn_munkres};

/// Which expected pole each typed one stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Assignment {
    /// (typed, expected, accepted): as many pairs as the shorter list has entries, in the order typed.
    pairs: Vec<(usize, usize, bool)>,
}

impl Assignment {
    /// As many accepted pairs as can be; among those assignments the one with the smallest sum of distances.
    ///
    /// Pairs that are not accepted are the nearest that are left, so that a message names the pole that was meant.
    /// At most 60 poles each. Source: Kuhn–Munkres (Hungarian) algorithm, O(n³), in whole numbers.
    pub fn best(expected: &[Pole], typed: &[TypedPole], tolerance: &Tolerance) -> Self {
        let accepted: Vec<Vec<bool>> = typed
            .iter()
            .map(|one| expected.iter().map(|pole| one.accepted_for(pole, tolerance)).collect())
            .collect();
        let distance = distances(expected, typed);
        let weight = |typed: usize, expected: usize| {
            if accepted[typed][expected] {
                ACCEPTED - distance[typed][expected]
            } else {
                -distance[typed][expected]
            }
        };
        let mut pairs: Vec<(usize, usize, bool)> = if typed.len() <= expected.len() {
            solve(typed.len(), expected.len(), weight)
        } else {
            let turned = solve(expected.len(), typed.len(), |expected, typed| weight(typed, expected));
            turned.into_iter().map(|(expected, typed)| (typed, expected)).collect()
        }
        .into_iter()
        .map(|(typed, expected)| (typed, expected, accepted[typed][expected]))
        .collect();
        pairs.sort_unstable();
        Self { pairs }
    }

    /// How many typed poles are accepted.
    pub fn accepted(&self) -> usize {
        self.pairs.iter().filter(|pair| pair.2).count()
    }

    /// The expected pole that the typed one stands for, right or wrong.
    pub fn partner(&self, typed: usize) -> Option<usize> {
        self.pairs.iter().find(|pair| pair.0 == typed).map(|pair| pair.1)
    }

    /// (typed, expected) of the pairs that are not accepted.
    pub fn wrong_pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        self.pairs.iter().filter(|pair| !pair.2).map(|pair| (pair.0, pair.1))
    }

    /// Expected poles without a pair that is accepted.
    pub fn not_found(&self, expected: usize) -> Vec<usize> {
        (0..expected).filter(|index| !self.pairs.iter().any(|pair| pair.1 == *index && pair.2)).collect()
    }

    /// Typed poles without a pair that is accepted.
    pub fn not_right(&self, typed: usize) -> Vec<usize> {
        (0..typed).filter(|index| !self.pairs.iter().any(|pair| pair.0 == *index && pair.2)).collect()
    }
}

/// Distances are whole numbers up to this.
const FARTHEST: i64 = 1 << 40;
/// More than all distances together: one accepted pair more always weighs more.
const ACCEPTED: i64 = FARTHEST << 8;

/// Rows by expected poles, in parts of the largest finite distance.
fn distances(expected: &[Pole], typed: &[TypedPole]) -> Vec<Vec<i64>> {
    let exact: Vec<Vec<f64>> = typed
        .iter()
        .map(|one| {
            let at = one.to_complex();
            expected.iter().map(|pole| (at - Complex64::new(pole.re, pole.im)).norm()).collect()
        })
        .collect();
    let largest = exact.iter().flatten().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    let whole = |d: f64| {
        if !d.is_finite() {
            FARTHEST
        } else if largest == 0.0 {
            0
        } else {
            (d / largest * FARTHEST as f64).round() as i64
        }
    };
    exact.into_iter().map(|row| row.into_iter().map(whole).collect()).collect()
}

/// (row, column) of the heaviest assignment of every row; no more rows than columns.
fn solve(rows: usize, columns: usize, weight: impl Fn(usize, usize) -> i64) -> Vec<(usize, usize)> {
    if rows == 0 {
        return Vec::new();
    }
    let weights = Matrix::from_fn(rows, columns, |(row, column)| weight(row, column));
    kuhn_munkres(&weights).1.into_iter().enumerate().collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::closeness::tests::{tolerance, typed};
    use super::*;

    /// (typed, expected, accepted) for real poles, within 1 %.
    #[track_caller]
    fn check(expected: &[f64], text: &str, want: &[(usize, usize, bool)]) {
        let pole = |re: &f64| Pole { re: *re, im: 0.0, multiplicity: 1, error_bound: 0.0 };
        let expected: Vec<Pole> = expected.iter().map(pole).collect();
        let typed: Vec<TypedPole> =
            text.split_whitespace().map(|re| TypedPole { re: typed(re), im: typed("0") }).collect();
        let got = Assignment::best(&expected, &typed, &tolerance("0", "0.01", None));
        assert_eq!(got.pairs, want, "{text}");
    }

    #[test]
    fn the_most_pairs_then_the_nearest() {
        check(&[], "", &[]);
        check(&[-1.0], "", &[]);
        check(&[], "-1", &[]);
        check(&[-1.0, -2.0], "-2 -1", &[(0, 1, true), (1, 0, true)]);
        // 1.005 is nearer to 1, but only so are both accepted.
        check(&[1.0, 1.014], "1.005 0.995", &[(0, 1, true), (1, 0, true)]);
        // Nothing is accepted: what was meant is what is near.
        check(&[-1.0, -3.0, -9.0], "-8 -1.2 -3.3", &[(0, 2, false), (1, 0, false), (2, 1, false)]);
        check(&[-1.0, -3.0, -9.0], "-3.3", &[(0, 1, false)]);
        check(&[-3.0], "-9 -3.3 -1", &[(1, 0, false)]);
        check(&[-1.0, -3.0], "1e400 -3.3", &[(0, 0, false), (1, 1, false)]);
        check(&[-1.0, -3.0], "1e400 -1e400", &[(0, 0, false), (1, 1, false)]);
    }
}
