use super::clip::clip;
use dashu_int::ops::UnsignedAbs;
use dashu_int::{IBig, UBig};
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

const MOST_DIGITS: usize = 400;
const LARGEST_EXPONENT: usize = 400;

/// The exact value of a decimal such as `-0.0132`, `1e-3`, `.5` or `−2` (U+2212).
///
/// White space around it is ignored. At most 400 digits and an exponent within ±400.
pub fn parse_decimal(text: &str) -> Result<Rational, NumberError> {
    let trimmed = text.trim();
    let not_a_number = || NumberError::NotANumber { text: clip(trimmed) };
    let (negative, unsigned) = split_sign(trimmed);
    let (mantissa, exponent) = match unsigned.find(['e', 'E']) {
        Some(at) => (&unsigned[..at], Some(&unsigned[at + 1..])),
        None => (unsigned, None),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = whole.len() + fraction.len();
    if digits == 0 || !all_digits(whole) || !all_digits(fraction) {
        return Err(not_a_number());
    }
    if digits > MOST_DIGITS {
        return Err(NumberError::TooLong { digits });
    }
    let exponent = match exponent {
        None => 0,
        Some(e) => {
            let (negative, digits) = split_sign(e);
            if digits.is_empty() || !all_digits(digits) {
                return Err(not_a_number());
            }
            let size = digits.trim_start_matches('0');
            let size = if size.is_empty() { Ok(0) } else { size.parse::<usize>() };
            match size {
                Ok(size) if size <= LARGEST_EXPONENT => {
                    let size = size as isize;
                    if negative { -size } else { size }
                }
                _ => return Err(NumberError::ExponentTooLarge { text: clip(trimmed) }),
            }
        }
    };
    let joined = format!("{whole}{fraction}");
    let magnitude = UBig::from_str_radix(&joined, 10).map_err(|_| not_a_number())?;
    let integer = if negative { -IBig::from(magnitude) } else { IBig::from(magnitude) };
    let shift = exponent - fraction.len() as isize;
    let power = UBig::from(10u8).pow(shift.unsigned_abs());
    Ok(if shift < 0 {
        RBig::from_parts(integer, power)
    } else {
        RBig::from_parts(integer * IBig::from(power), UBig::ONE)
    })
}

/// The nearest `f64`; infinite beyond its range.
pub fn to_f64(value: &Rational) -> f64 {
    value.to_f64().value()
}

/// The exact value of a finite `f64`; `None` for NaN and infinities.
pub fn from_f64(value: f64) -> Option<Rational> {
    RBig::try_from(value).ok()
}

/// The `n`-th root of a number that is not negative, when it is rational: the square root of 4/9 is 2/3.
pub fn exact_root(value: &Rational, n: u8) -> Option<Rational> {
    if *value < Rational::ZERO || n == 0 {
        return None;
    }
    let top = value.numerator().clone().unsigned_abs().nth_root(n.into());
    let bottom = value.denominator().nth_root(n.into());
    let root = RBig::from_parts(top.into(), bottom);
    (root.pow(n.into()) == *value).then_some(root)
}

/// Whether the sign is a minus, and the rest.
fn split_sign(text: &str) -> (bool, &str) {
    match text.chars().next() {
        Some(c @ ('-' | '\u{2212}')) => (true, &text[c.len_utf8()..]),
        Some('+') => (false, &text[1..]),
        _ => (false, text),
    }
}

fn all_digits(text: &str) -> bool {
    text.bytes().all(|b| b.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, i64, u64)]) {
        for (text, num, den) in rows {
            let expected = RBig::from_parts(IBig::from(*num), UBig::from(*den));
            assert_eq!(parse_decimal(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn decimals_are_exact() {
        check(&[
            ("0", 0, 1),
            ("-0", 0, 1),
            ("0.0132", 33, 2500),
            ("-0.0132", -33, 2500),
            ("\u{2212}2", -2, 1),
            ("+2", 2, 1),
            (".5", 1, 2),
            ("5.", 5, 1),
            ("1e-3", 1, 1000),
            ("1E3", 1000, 1),
            ("2.5e+1", 25, 1),
            ("2e\u{2212}1", 1, 5),
            (" 9.81 ", 981, 100),
            ("1e000001", 10, 1),
        ]);
    }

    #[test]
    fn what_is_not_a_number_says_so() {
        for text in ["", "-", ".", "e3", "1e", "1e+", "1,5", "0x10", "1.2.3", "--1", "1 2", "nan", "inf", "٣"]
        {
            assert!(matches!(parse_decimal(text), Err(NumberError::NotANumber { .. })), "{text}");
        }
        for text in ["1e401", "1e-401", "1e99999999999999999999999"] {
            assert!(matches!(parse_decimal(text), Err(NumberError::ExponentTooLarge { .. })), "{text}");
        }
        assert_eq!(parse_decimal(&"9".repeat(401)), Err(NumberError::TooLong { digits: 401 }));
        assert!(parse_decimal(&"9".repeat(400)).is_ok());
    }

    #[test]
    fn conversion_is_to_the_nearest() {
        for text in ["0.1", "-0.0132", "9.81", "1e308", "1e-308", "4.9e-324", "2.2250738585072011e-308", "0"]
        {
            let exact = parse_decimal(text).unwrap();
            assert_eq!(to_f64(&exact), text.parse::<f64>().unwrap(), "{text}");
        }
        assert_eq!(to_f64(&parse_decimal("1e400").unwrap()), f64::INFINITY);
        assert_eq!(to_f64(&parse_decimal("-1e400").unwrap()), f64::NEG_INFINITY);
        assert_eq!(to_f64(&parse_decimal("1e-400").unwrap()), 0.0);
    }

    #[test]
    fn roots_only_when_exact() {
        for (value, n, root) in [
            ("0", 2, Some("0")),
            ("6.25", 2, Some("2.5")),
            ("0.000001", 3, Some("0.01")),
            ("2", 2, None),
            ("-4", 2, None),
            ("7", 1, Some("7")),
            ("7", 0, None),
        ] {
            let expected = root.map(|r| parse_decimal(r).unwrap());
            assert_eq!(exact_root(&parse_decimal(value).unwrap(), n), expected, "{value}");
        }
    }

    #[test]
    fn floats_come_back() {
        for value in [0.0, 0.1, -1.5, 1e300, 5e-324, f64::MAX] {
            assert_eq!(to_f64(&from_f64(value).unwrap()), value);
        }
        assert_eq!(from_f64(f64::NAN), None);
        assert_eq!(from_f64(f64::INFINITY), None);
    }
}
