use dashu_ratio::RBig;

/// An exact rational number, always in lowest terms.
pub type Rational = RBig;

/// Why a text is not a number we can hold exactly.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NumberError {
    #[error("`{text}` is not a number")]
    NotANumber { text: String },
    #[error("`{text}` has an exponent beyond ±400")]
    ExponentTooLarge { text: String },
    #[error("a number of {digits} digits is longer than the 400 we read")]
    TooLong { digits: usize },
}

/// The exact value of a decimal such as `-0.0132`, `1e-3`, `.5` or `−2` (U+2212).
pub fn parse_decimal(text: &str) -> Result<Rational, NumberError> {
    let _ = text;
    todo!()
}

/// The nearest `f64`.
pub fn to_f64(value: &Rational) -> f64 {
    let _ = value;
    todo!()
}

/// The exact value of a finite `f64`; `None` for NaN and infinities.
pub fn from_f64(value: f64) -> Option<Rational> {
    let _ = value;
    todo!()
}
