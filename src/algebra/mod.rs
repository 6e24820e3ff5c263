//! Exact rationals, polynomials and expressions. No files, no students, no prose.

mod clip;
mod coprime;
mod expression;
mod greek;
mod matrix;
mod multivariate;
mod multivariate_gcd;
mod number_text;
mod polynomial;
mod polynomial_determinant;
mod polynomial_text;
mod rational;
mod symbol_mathml;

pub use expression::{Expression, ExpressionError, Function, NodeKind, SymbolUse};
pub use matrix::Matrix;
pub use multivariate::{Budget, Letter, Monomial, MultivariatePolynomial, OverBudget};
pub use number_text::{number_mathml, significant};
pub use polynomial::Polynomial;
pub use polynomial_determinant::polynomial_determinant;
pub use polynomial_text::{polynomial_mathml, polynomial_text};
pub use rational::{NumberError, Rational, exact_root, from_f64, parse_decimal, to_f64};
pub use symbol_mathml::symbol_mathml;
