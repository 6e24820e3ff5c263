use super::{Equilibrium, Model, ModelError};
use crate::algebra::{Polynomial, Rational};
use crate::lti::{StateSpace, TransferFunction};
use std::collections::BTreeMap;

/// Small deviations about an equilibrium, from one input to one output coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Names of the states in order: `x`, `x'`, `theta`, `theta'`.
    pub states: Vec<String>,
    pub state_space: StateSpace,
    /// Straight from the elimination (Cramer on the polynomial matrix), nothing cancelled.
    pub uncancelled: TransferFunction,
    /// The factor (monic gcd) that numerator and denominator share; 1 when they share none.
    pub cancelled: Polynomial,
    /// After cancelling, in the scale the elimination gives (for the cart: 0.0132 s³ + …).
    pub transfer_function: TransferFunction,
    /// The linearized equations: coefficient of each symbol (`x''`, `theta`, `F`, …) in left − right, per equation; zeros left out.
    pub linear_equations: Vec<Vec<(String, Rational)>>,
    /// False when a coefficient had to be rounded to an `f64` (an irrational equilibrium, say).
    pub exact: bool,
}

/// Exact differentiation of every equation at `at`, then elimination of the other coordinates.
///
/// Checks that `at` is an equilibrium first.
pub fn linearize(
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    input: &str,
    output: &str,
) -> Result<Linearization, ModelError> {
    let _ = (model, parameters, at, input, output);
    todo!()
}
