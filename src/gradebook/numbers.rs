use crate::lab::Points;

/// `12.50`: two decimals and a decimal point.
pub fn two_decimals(points: Points) -> String {
    let sign = if points.0 < 0 { "-" } else { "" };
    format!("{sign}{}.{:02}", points.0.abs() / 100, points.0.abs() % 100)
}

/// Points as an LMS writes them, `12`, `12.5`, `12,50`: the last comma or point is the decimal sign, and any before it part
/// thousands. `None` for anything else, and for more than two decimals that are not zero.
///
/// Source: `decimal_comma_to_period` in Canvas' `lib/gradebook_importer.rb`; Moodle writes no thousands.
pub fn points_of(text: &str) -> Option<Points> {
    let text = text.trim();
    let (whole, decimals) = match text.rfind([',', '.']) {
        Some(at) => (&text[..at], &text[at + 1..]),
        None => (text, ""),
    };
    let digits: String = whole.chars().filter(|c| !matches!(c, ',' | '.')).collect();
    let all_digits = |text: &str| text.chars().all(|c| c.is_ascii_digit());
    if !all_digits(&digits)
        || !all_digits(decimals)
        || digits.len() > 9
        || (digits.len() + decimals.len()) == 0
    {
        return None;
    }
    let (hundredths, rest) = decimals.split_at(decimals.len().min(2));
    if rest.chars().any(|c| c != '0') {
        return None;
    }
    let number = |text: &str| if text.is_empty() { Some(0) } else { text.parse::<i64>().ok() };
    Some(Points(number(&digits)? * 100 + number(&format!("{hundredths:0<2}"))?))
}

/// `earned` of `from` points as points of `to`, to the nearest hundredth, halves up; `None` when `from` is not positive.
pub fn scaled(earned: Points, from: Points, to: Points) -> Option<Points> {
    let (earned, from, to) = (i128::from(earned.0), i128::from(from.0), i128::from(to.0));
    let hundredths = (from > 0).then(|| (2 * earned * to + from).div_euclid(2 * from))?;
    i64::try_from(hundredths).ok().map(Points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_written_with_two_decimals() {
        for (points, written) in
            [(0, "0.00"), (5, "0.05"), (1250, "12.50"), (10_000, "100.00"), (-50, "-0.50")]
        {
            assert_eq!(two_decimals(Points(points)), written);
        }
    }

    #[test]
    fn points_are_read_as_an_lms_writes_them() {
        for (text, points) in [
            ("100", Some(10_000)),
            (" 100.00 ", Some(10_000)),
            ("12,5", Some(1250)),
            ("12.25", Some(1225)),
            ("12.2500", Some(1225)),
            ("1.000,00", Some(100_000)),
            (".5", Some(50)),
            ("", None),
            (".", None),
            ("12.255", None),
            ("EX", None),
            ("-3", None),
            ("12 / 20", None),
            ("９", None),
            ("99999999999", None),
        ] {
            assert_eq!(points_of(text), points.map(Points), "{text:?}");
        }
    }

    #[test]
    fn scaling_is_exact_and_rounds_halves_up() {
        for (earned, from, to, becomes) in [
            (8550, 10_000, 2000, Some(1710)),
            (1, 200, 100, Some(1)),
            (1, 300, 100, Some(0)),
            (2, 300, 100, Some(1)),
            (10_000, 10_000, 700, Some(700)),
            (0, 10_000, 700, Some(0)),
            (1, 0, 100, None),
        ] {
            let points = scaled(Points(earned), Points(from), Points(to));
            assert_eq!(points, becomes.map(Points), "{earned} of {from} to {to}");
        }
    }
}
