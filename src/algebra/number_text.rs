/// `value` to `figures` significant figures, trailing zeros dropped: `0.0132`, `-5.59`, `1.2e-7`, `0`.
///
/// Plain ASCII; plain notation for 1e-4 ≤ |value| < 1e6, else `e` notation. NaN and infinities are
/// written `not a number`, `∞` and `-∞`. Never prints `-0`.
pub fn significant(value: f64, figures: usize) -> String {
    if value.is_nan() {
        return "not a number".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // `{:e}` rounds correctly and always writes `d.ddde±x`.
    let places = figures.clamp(1, MOST_FIGURES) - 1;
    let scientific = format!("{:.places$e}", value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_end_matches('0');
    let sign = if value < 0.0 { "-" } else { "" };
    let (whole, fraction) = match exponent {
        -4..=-1 => ("0".to_owned(), format!("{}{digits}", "0".repeat(exponent.unsigned_abs() as usize - 1))),
        0..=5 => {
            let before = exponent as usize + 1;
            let padded = format!("{digits:0<before$}");
            (padded[..before].to_owned(), padded[before..].to_owned())
        }
        _ => (digits[..1].to_owned(), digits[1..].to_owned()),
    };
    let plain = if fraction.is_empty() { whole } else { format!("{whole}.{fraction}") };
    match exponent {
        -4..=5 => format!("{sign}{plain}"),
        _ => format!("{sign}{plain}e{exponent}"),
    }
}

/// A number written by [`significant`] as MathML: `-1.2e-7` → −1.2 · 10⁻⁷, one `<mrow>`.
pub fn number_mathml(number: &str) -> String {
    let (sign, size) = match number.strip_prefix('-') {
        Some(size) => ("<mo>−</mo>", size),
        None => ("", number),
    };
    let body = match size.split_once('e') {
        None if size == "∞" => "<mi>∞</mi>".to_owned(),
        None if size.starts_with(|c: char| c.is_ascii_digit()) => format!("<mn>{size}</mn>"),
        Some(("1", exponent)) => format!("<msup><mn>10</mn><mn>{}</mn></msup>", exponent.replace('-', "−")),
        Some((mantissa, exponent)) if mantissa.starts_with(|c: char| c.is_ascii_digit()) => {
            let exponent = exponent.replace('-', "−");
            format!("<mn>{mantissa}</mn><mo>·</mo><msup><mn>10</mn><mn>{exponent}</mn></msup>")
        }
        _ => format!("<mtext>{size}</mtext>"),
    };
    if sign.is_empty() && !body.contains("<mo>") { body } else { format!("<mrow>{sign}{body}</mrow>") }
}

const MOST_FIGURES: usize = 40;

#[cfg(test)]
mod tests {
    use super::{number_mathml, significant};

    #[track_caller]
    fn check(rows: &[(f64, usize, &str)]) {
        for (value, figures, expected) in rows {
            assert_eq!(significant(*value, *figures), *expected, "{value} to {figures}");
        }
    }

    #[test]
    fn figures_are_significant_ones() {
        check(&[
            (0.0132, 4, "0.0132"),
            (-5.5864, 3, "-5.59"),
            (1.23e-7, 2, "1.2e-7"),
            (0.0, 3, "0"),
            (-0.0, 3, "0"),
            (1.0, 3, "1"),
            (-100.0, 6, "-100"),
            (123456.0, 3, "123000"),
            (999999.0, 3, "1e6"),
            (999999.0, 6, "999999"),
            (1e6, 3, "1e6"),
            (-1.5e12, 3, "-1.5e12"),
            (0.0001, 3, "0.0001"),
            (0.00009999, 3, "0.0001"),
            (0.00009999, 4, "9.999e-5"),
            (12.5, 2, "12"),
            (0.41202, 5, "0.41202"),
            (0.1 + 0.2, 15, "0.3"),
            (5e-324, 1, "5e-324"),
            (7.9, 0, "8"),
        ]);
    }

    #[test]
    fn numbers_in_mathml() {
        for (text, expected) in [
            ("5.59", "<mn>5.59</mn>"),
            ("-5.59", "<mrow><mo>−</mo><mn>5.59</mn></mrow>"),
            ("1.2e-7", "<mrow><mn>1.2</mn><mo>·</mo><msup><mn>10</mn><mn>−7</mn></msup></mrow>"),
            ("1e6", "<msup><mn>10</mn><mn>6</mn></msup>"),
            ("-∞", "<mrow><mo>−</mo><mi>∞</mi></mrow>"),
            ("not a number", "<mtext>not a number</mtext>"),
        ] {
            assert_eq!(number_mathml(text), expected);
        }
    }

    #[test]
    fn what_is_not_finite_has_words() {
        check(&[(f64::NAN, 3, "not a number"), (f64::INFINITY, 3, "∞"), (f64::NEG_INFINITY, 3, "-∞")]);
    }
}
