use super::Rational;

/// A dense matrix of exact rationals, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix {
    pub rows: Vec<Vec<Rational>>,
}
