//! Exact rationals, polynomials and expressions. No files, no students, no prose.

mod expression;
mod matrix;
mod number_text;
mod polynomial;
mod rational;

pub use expression::{Expression, ExpressionError, Function, NodeKind};
pub use matrix::Matrix;
pub use number_text::significant;
pub use polynomial::Polynomial;
pub use rational::{NumberError, Rational, from_f64, parse_decimal, to_f64};
