use crate::algebra::Polynomial;

/// A root in rad/s with its exact multiplicity and a rigorous bound on its distance from the true root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    pub re: f64,
    pub im: f64,
    pub multiplicity: usize,
    /// |computed − true| ≤ `error_bound`, rad/s.
    pub error_bound: f64,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RootError {
    #[error("the zero polynomial has every number as a root")]
    ZeroPolynomial,
    #[error("a polynomial of degree {degree} is beyond the {limit} we solve")]
    DegreeTooHigh { degree: usize, limit: usize },
    #[error("the roots did not settle after {iterations} iterations")]
    NotConverged { iterations: usize },
}

/// The distinct roots of `p`, each once with its multiplicity.
///
/// Conjugate pairs are exact mirror images, upper half first; sorted by falling real part.
pub fn roots(p: &Polynomial) -> Result<Vec<Pole>, RootError> {
    let _ = p;
    todo!()
}
