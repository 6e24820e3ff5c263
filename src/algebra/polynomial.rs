use super::Rational;

/// A polynomial with exact rational coefficients, highest power first, without leading zeros.
///
/// `[1, 2, 5]` is s² + 2s + 5; the zero polynomial has no coefficients.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct Polynomial {
    coefficients: Vec<Rational>,
}

impl Polynomial {
    /// Leading zeros are dropped.
    pub fn new(coefficients: Vec<Rational>) -> Self {
        let lead = coefficients.iter().position(|c| *c != Rational::ZERO);
        match lead {
            Some(first) => Self { coefficients: coefficients[first..].to_vec() },
            None => Self::default(),
        }
    }

    /// Highest power first.
    pub fn coefficients(&self) -> &[Rational] {
        &self.coefficients
    }

    pub fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// The degree; 0 for constants and for zero.
    pub fn degree(&self) -> usize {
        self.coefficients.len().saturating_sub(1)
    }
}
