use crate::algebra::{Rational, from_f64, significant, to_f64};
use crate::lab::Tolerance;
use crate::submission::Decimal;

/// How near a typed number is to the expected one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Closeness {
    /// Within max(absolute, relative · |expected|).
    Within,
    /// Farther off, but it is the expected number correctly rounded to enough figures.
    Rounded,
    Off,
}

impl Closeness {
    pub fn accepted(self) -> bool {
        self != Self::Off
    }
}

/// Decided in exact rationals; `error_bound` is what the expected number may itself be off by, and is given to the student.
pub(super) fn closeness(
    expected: f64,
    error_bound: f64,
    typed: &Decimal,
    tolerance: &Tolerance,
) -> Closeness {
    let (Some(expected), Some(bound)) = (from_f64(expected), from_f64(error_bound)) else {
        return Closeness::Off;
    };
    let distance = magnitude(&(&typed.value - &expected));
    let relative = &tolerance.relative * magnitude(&expected);
    let width = if relative > tolerance.absolute { relative } else { tolerance.absolute.clone() };
    if distance <= width + &bound {
        return Closeness::Within;
    }
    let Some(figures) = tolerance.figures else { return Closeness::Off };
    if significant_figures(typed) < figures as usize {
        return Closeness::Off;
    }
    let half_a_digit = power_of_ten(typed.last_place) / Rational::from(2);
    if distance <= half_a_digit + bound { Closeness::Rounded } else { Closeness::Off }
}

/// Figures from the first that is not zero to the last one typed: 3 for `0.0412`, 4 for `1.500`, 0 for `0.00`.
pub(super) fn significant_figures(typed: &Decimal) -> usize {
    if typed.value.is_zero() {
        return 0;
    }
    let digits = (&typed.value / power_of_ten(typed.last_place)).round();
    digits.to_string().trim_start_matches('-').len()
}

fn power_of_ten(exponent: i32) -> Rational {
    Rational::from(10).pow(exponent.clamp(-1_000, 1_000) as isize)
}

pub(super) fn magnitude(value: &Rational) -> Rational {
    if *value < Rational::ZERO { -value.clone() } else { value.clone() }
}

/// `within 1 % or 0.001, or correctly rounded to at least 2 figures`.
pub(super) fn in_words(tolerance: &Tolerance) -> String {
    let relative = (!tolerance.relative.is_zero()).then(|| percent(&tolerance.relative));
    let absolute = (!tolerance.absolute.is_zero()).then(|| significant(to_f64(&tolerance.absolute), 3));
    let width = match (relative, absolute) {
        (Some(relative), Some(absolute)) => format!("within {relative} or {absolute}, whichever is wider"),
        (Some(only), None) | (None, Some(only)) => format!("within {only}"),
        (None, None) => "exactly".to_owned(),
    };
    match tolerance.figures {
        Some(figures) => format!("{width}, or correctly rounded to at least {figures} figures"),
        None => width,
    }
}

/// `0.5 %`.
pub(super) fn percent(part: &Rational) -> String {
    format!("{} %", significant(to_f64(part) * 100.0, 3))
}

/// An expected number as shown: to five figures, and `0` when it is nothing but rounding beside the tolerance.
pub(super) fn shown(expected: f64, tolerance: &Tolerance) -> String {
    if expected.abs() * 1e3 <= to_f64(&tolerance.absolute) {
        "0".to_owned()
    } else {
        significant(expected, 5)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::algebra::parse_decimal;

    /// A decimal as a submission gives it; plain notation only.
    pub fn typed(text: &str) -> Decimal {
        let last_place = text.split_once('.').map_or(0, |(_, digits)| -(digits.len() as i32));
        Decimal { text: text.to_owned(), value: parse_decimal(text).unwrap(), last_place }
    }

    pub fn tolerance(absolute: &str, relative: &str, figures: Option<u32>) -> Tolerance {
        let number = |text| parse_decimal(text).unwrap();
        Tolerance { absolute: number(absolute), relative: number(relative), figures }
    }

    #[track_caller]
    fn check(rows: &[(f64, &str, Closeness)]) {
        for (expected, text, want) in rows {
            let got = closeness(*expected, 0.0, &typed(text), &tolerance("0.001", "0.01", Some(2)));
            assert_eq!(got, *want, "{text} for {expected}");
        }
    }

    #[test]
    fn both_sides_of_each_tolerance() {
        use Closeness::*;
        check(&[
            // expected, typed, verdict
            (0.0, "0", Within),
            (0.0, "0.001", Within),
            (0.0, "-0.0011", Off),
            (128.0, "129.28", Within),
            (128.0, "129.29", Off),
            // 13 has two figures and is 12.6 correctly rounded; 12 is not, and 10 is not.
            (12.6, "13", Rounded),
            (12.6, "12", Off),
            // one figure is too few, however well rounded
            (5.6, "6", Off),
            (5.59, "5.6", Within),
            (0.25, "0.3", Off),
            (0.253, "0.25", Rounded),
            (0.2551, "0.25", Off),
            // trailing zeros are figures, leading ones are not
            (0.0495, "0.05", Within),
            (0.0485, "0.05", Off),
            (f64::NAN, "1", Off),
            (f64::INFINITY, "1", Off),
        ]);
    }

    #[test]
    fn figures_are_counted_as_typed() {
        for (text, want) in [("0.0412", 3), ("1.500", 4), ("0.00", 0), ("-0.1", 1), ("100", 3), ("-31.2", 3)]
        {
            assert_eq!(significant_figures(&typed(text)), want, "{text}");
        }
    }

    #[test]
    fn the_tolerance_is_said_in_words() {
        assert_eq!(
            in_words(&tolerance("0.001", "0.01", Some(2))),
            "within 1 % or 0.001, whichever is wider, or correctly rounded to at least 2 figures"
        );
        assert_eq!(in_words(&tolerance("0", "0.005", None)), "within 0.5 %");
        assert_eq!(in_words(&tolerance("0", "0", None)), "exactly");
    }
}
