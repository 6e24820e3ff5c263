use crate::algebra::Rational;
use std::collections::BTreeMap;

/// A number r + k·π held exactly, or the exact value of an `f64` when it could not be.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact {
    /// rational + pi · π
    Known {
        rational: Rational,
        pi: Rational,
    },
    Approximate(f64),
}

/// Where nothing moves: coordinates and inputs, in plant units; rates are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    pub values: BTreeMap<String, Exact>,
}
