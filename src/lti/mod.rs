//! Linear time-invariant systems: transfer functions, state space, poles, responses.

mod dyadic;
mod extrema;
mod features;
mod horizon;
mod many_digits;
mod matrix_exponential;
mod pieces;
mod poles;
mod response;
mod sampling;
mod settling;
mod simple_roots;
mod stability;
mod state_space;
mod transfer_function;
mod wide;

pub use features::{Borderline, Extremum, Features, Limit, Shape};
pub use matrix_exponential::{ExponentialResponse, matrix_exponential_response};
pub use poles::{Pole, RootError, roots};
pub use response::{InputKind, Mode, Response, ResponseError};
pub use stability::{Stability, right_half_plane_roots, stability};
pub use state_space::StateSpace;
pub use transfer_function::TransferFunction;

#[cfg(test)]
mod tests {
    use super::TransferFunction;
    use crate::algebra::{Polynomial, parse_decimal};

    /// Pendulum on a cart, force to angle, at its two equilibria.
    pub const HANGING: (&str, &str) = ("-0.06 0", "0.0132 0.0024 0.41202 0.05886");
    pub const UPRIGHT: (&str, &str) = ("0.06 0", "0.0132 0.0024 -0.41202 -0.05886");

    /// Exact decimals, highest power first.
    pub fn polynomial(text: &str) -> Polynomial {
        Polynomial::new(text.split_whitespace().map(|t| parse_decimal(t).unwrap()).collect())
    }

    pub fn tf(num: &str, den: &str) -> TransferFunction {
        TransferFunction::new(polynomial(num), polynomial(den)).unwrap()
    }
}
