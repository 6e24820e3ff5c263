use super::Decimal;
use crate::algebra::{NumberError, Rational, parse_decimal};

impl Decimal {
    /// A decimal as people type it: `-0.0132`, `1e-3`, `.5`, `5.`, `−2` (U+2212), `1.2×10^-3`.
    pub fn parse(text: &str) -> Result<Self, NumberError> {
        let not_a_number = || NumberError::NotANumber { text: text.chars().take(60).collect() };
        let text = text.trim();
        let (negative, unsigned) = match text.chars().next() {
            Some(c) if is_minus(c) => (true, text[c.len_utf8()..].trim_start()),
            Some('+') => (false, text[1..].trim_start()),
            _ => (false, text),
        };
        match scan(unsigned) {
            Some((decimal, length)) if length == unsigned.len() => {
                let decimal = decimal?;
                Ok(if negative { decimal.negated() } else { decimal })
            }
            _ => Err(not_a_number()),
        }
    }

    /// The part of a complex number that was not written: exactly zero, to any place.
    pub fn absent() -> Self {
        Self { text: "0".to_owned(), value: Rational::ZERO, last_place: -400 }
    }

    pub fn is_zero(&self) -> bool {
        self.value == Rational::ZERO
    }

    /// The same number with the other sign; 0 stays as it is typed.
    pub fn negated(&self) -> Self {
        if self.is_zero() {
            return self.clone();
        }
        let text = match self.text.strip_prefix('-') {
            Some(rest) => rest.to_owned(),
            None => format!("-{}", self.text),
        };
        Self { text, value: -self.value.clone(), last_place: self.last_place }
    }
}

/// Hyphen, minus sign, and the dashes word processors put in their place.
pub(super) fn is_minus(c: char) -> bool {
    matches!(c, '-' | '\u{2010}'..='\u{2013}' | '\u{2212}' | '\u{fe63}' | '\u{ff0d}')
}

/// An unsigned decimal at the start of `text`, and how many bytes it takes; `None` when there is none.
pub(super) fn scan(text: &str) -> Option<(Result<Decimal, NumberError>, usize)> {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(0);
    let mut end = whole;
    let mut fraction = 0;
    if text[end..].starts_with('.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    let mantissa = format!(
        "{}.{}",
        if whole == 0 { "0" } else { &text[..whole] },
        if fraction == 0 { "0" } else { &text[end - fraction..end] }
    );
    let (exponent, length) = exponent(&text[end..]);
    let typed = text[..end].trim_end_matches('.');
    let typed = if whole == 0 { format!("0{typed}") } else { typed.to_owned() };
    let typed = if length == 0 { typed } else { format!("{typed}e{exponent}") };
    let decimal = parse_decimal(&format!("{mantissa}e{}", if exponent.is_empty() { "0" } else { &exponent }))
        .map(|value| {
            let shift: i32 = exponent.parse().unwrap_or(0);
            let places = i32::try_from(fraction).unwrap_or(i32::MAX);
            Decimal { text: typed, value, last_place: shift.saturating_sub(places) }
        });
    Some((decimal, end + length))
}

/// `e-3`, `E+3`, `×10^-3`, `*10^{-3}`, `·10⁻³` at the start of `text`: the exponent in ASCII and its length in bytes.
fn exponent(text: &str) -> (String, usize) {
    let none = (String::new(), 0);
    let mut rest = text;
    let plain = rest.strip_prefix(['e', 'E']);
    if let Some(after) = plain {
        rest = after;
    } else {
        let Some(after) = rest.trim_start().strip_prefix(['×', '*', '·', 'x', '⋅']) else { return none };
        let Some(after) = after.trim_start().strip_prefix("10") else { return none };
        if let Some(power) = superscript(after) {
            return (power.0, text.len() - power.1.len());
        }
        let Some(after) = after.strip_prefix("^").or_else(|| after.strip_prefix("**")) else { return none };
        rest = after;
    }
    let braced = plain.is_none() && rest.starts_with(['{', '(']);
    if braced {
        rest = &rest[1..];
    }
    let mut power = String::new();
    match rest.chars().next() {
        Some(c) if is_minus(c) => {
            power.push('-');
            rest = &rest[c.len_utf8()..];
        }
        Some('+') => rest = &rest[1..],
        _ => {}
    }
    let count = rest.bytes().take_while(u8::is_ascii_digit).count();
    if count == 0 {
        return none;
    }
    power.push_str(&rest[..count]);
    rest = &rest[count..];
    if braced {
        let Some(after) = rest.strip_prefix(['}', ')']) else { return none };
        rest = after;
    }
    (power, text.len() - rest.len())
}

/// `⁻³` at the start of `text`: in ASCII, and what follows it.
fn superscript(text: &str) -> Option<(String, &str)> {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let mut power = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        match (c, DIGITS.iter().position(|d| *d == c)) {
            ('⁻', _) if power.is_empty() => power.push('-'),
            ('⁺', _) if power.is_empty() => {}
            (_, Some(digit)) => power.push_str(&digit.to_string()),
            _ => break,
        }
        rest = &rest[c.len_utf8()..];
    }
    power.ends_with(|c: char| c.is_ascii_digit()).then_some((power, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(typed: &str, text: &str, value: &str, last_place: i32) {
        let found = Decimal::parse(typed).unwrap_or_else(|e| panic!("{typed:?}: {e}"));
        let expected = Decimal { text: text.to_owned(), value: parse_decimal(value).unwrap(), last_place };
        assert_eq!(found, expected, "{typed:?}");
    }

    #[test]
    fn decimals_keep_their_text_and_last_place() {
        check("0.0132", "0.0132", "0.0132", -4);
        check("12", "12", "12", 0);
        check("1.50e-3", "1.50e-3", "0.0015", -5);
        check("1.50", "1.50", "1.5", -2);
        check("-0.143", "-0.143", "-0.143", -3);
        check("− 0.143", "-0.143", "-0.143", -3);
        check("\u{2013}2", "-2", "-2", 0);
        check("+.5", "0.5", "0.5", -1);
        check("5.", "5", "5", 0);
        check("1E3", "1e3", "1000", 3);
        check("1e−3", "1e-3", "0.001", -3);
        check("1.2×10^-3", "1.2e-3", "0.0012", -4);
        check("1.2 * 10^{−3}", "1.2e-3", "0.0012", -4);
        check("1.2·10⁻³", "1.2e-3", "0.0012", -4);
        check("-0", "0", "0", 0);
        check("\u{a0}7\u{a0}", "7", "7", 0);
    }

    #[test]
    fn what_is_not_a_decimal_is_refused() {
        for text in [
            "",
            "-",
            ".",
            "1,5",
            "1..2",
            "abc",
            "1e",
            "0x10",
            "1 2",
            "inf",
            "NaN",
            "--1",
            "1e99999999999",
            "٣",
        ] {
            assert!(Decimal::parse(text).is_err(), "{text:?}");
        }
        assert!(Decimal::parse(&"9".repeat(100_000)).is_err());
    }
}
