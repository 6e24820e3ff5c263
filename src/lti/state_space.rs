use crate::algebra::Matrix;

/// ẋ = a x + b u, y = c x + d u; a n×n, b n×m, c p×n, d p×m, exact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateSpace {
    pub a: Matrix,
    pub b: Matrix,
    pub c: Matrix,
    pub d: Matrix,
}
