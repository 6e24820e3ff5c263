use crate::algebra::{Expression, NodeKind, Rational, to_f64};
use std::collections::BTreeMap;

/// How the coefficients of a transfer function were written down.
#[derive(Clone, Debug, Default)]
pub(super) struct Written {
    /// Numbers as typed: their digits without zeros around them, and how many figures were typed. `None`: as short as can be.
    numbers: Option<BTreeMap<String, usize>>,
    exact: bool,
}

/// Longer texts are not looked through for numbers.
const LONGEST_TEXT: usize = 10_000;

impl Written {
    /// Of an answer's text, and the formula it was read as when it was one.
    pub fn new(text: &str, formula: Option<&Expression>) -> Self {
        let mut numbers = BTreeMap::new();
        for word in text
            .get(..text.len().min(LONGEST_TEXT))
            .unwrap_or_default()
            .split(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',')))
        {
            // A comma may be a decimal comma or stand between two numbers.
            for number in std::iter::once(word).chain(word.split(',')) {
                let digits: String = number.chars().filter(char::is_ascii_digit).collect();
                let whole = digits.trim_start_matches('0');
                let short = whole.trim_end_matches('0');
                if short.is_empty() {
                    continue;
                }
                let known = numbers.entry(short.to_owned()).or_insert(whole.len());
                *known = whole.len().min(*known);
            }
        }
        Self { numbers: Some(numbers), exact: formula.is_some_and(is_in_letters) }
    }

    /// In letters, nothing is rounded.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// Of a coefficient that was typed as it is; `None` when it was worked out from what was typed.
    pub fn digits(&self, value: &Rational) -> Option<Digits> {
        if self.exact {
            return None;
        }
        let mut digits = Digits::of(value)?;
        let Some(numbers) = &self.numbers else { return Some(digits) };
        let text: String = digits.digits.iter().map(|digit| char::from(b'0' + digit)).collect();
        let short = text.trim_end_matches('0');
        let zeros = numbers.get(short)?.checked_sub(short.len())?.min(MOST_DIGITS as usize);
        digits.digits.truncate(short.len());
        digits.last_place += (text.len() - short.len()) as i32;
        digits.digits.extend(std::iter::repeat_n(0, zeros));
        digits.last_place -= zeros as i32;
        Some(digits)
    }
}

/// With letters other than s in it, and no number but small whole ones.
fn is_in_letters(formula: &Expression) -> bool {
    fn numbers_are_small(node: &Expression) -> bool {
        match &node.kind {
            NodeKind::Number(value) => value.is_int() && *value <= Rational::from(12),
            _ => node.children().all(numbers_are_small),
        }
    }
    formula.symbols().iter().any(|symbol| !symbol.name.eq_ignore_ascii_case("s"))
        && numbers_are_small(formula)
}

/// The digits of a typed decimal, without leading zeros, and the place of the last: 4166 and −4 for −0.4166.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Digits {
    digits: Vec<u8>,
    last_place: i32,
}

/// One slip of a digit, and the size it makes of the number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slip {
    pub code: &'static str,
    /// What is meant to have been written, no sign.
    pub meant: f64,
}

/// Longer numbers were not typed by hand.
const MOST_DIGITS: i32 = 15;

impl Digits {
    /// `None` for zero, and for what is no decimal of at most 15 places and digits.
    pub fn of(value: &Rational) -> Option<Self> {
        let mut scaled = value.clone();
        let mut last_place = 0;
        while !scaled.is_int() {
            if last_place == -MOST_DIGITS {
                return None;
            }
            scaled *= Rational::from(10);
            last_place -= 1;
        }
        let text = scaled.numerator().to_string();
        let digits: Vec<u8> = text.trim_start_matches('-').bytes().map(|digit| digit - b'0').collect();
        let short = digits.len() <= MOST_DIGITS as usize && digits.first().is_some_and(|first| *first > 0);
        short.then_some(Self { digits, last_place })
    }

    /// Half a unit of the last place typed: what rounding may have left out.
    pub fn half_a_unit(&self) -> f64 {
        0.5 * 10f64.powi(self.last_place)
    }

    /// Every number that one wrong digit, or two neighbours exchanged, makes this one.
    pub fn slips(&self) -> Vec<Slip> {
        let mut all = Vec::new();
        for place in 0..self.digits.len() {
            for digit in (0..=9).filter(|digit| *digit != self.digits[place]) {
                let mut meant = self.digits.clone();
                meant[place] = digit;
                all.push(Slip { code: "slip.digit", meant: self.value(&meant) });
            }
            if self.digits.get(place + 1).is_some_and(|next| *next != self.digits[place]) {
                let mut meant = self.digits.clone();
                meant.swap(place, place + 1);
                all.push(Slip { code: "slip.exchanged", meant: self.value(&meant) });
            }
        }
        all.retain(|slip| slip.meant > 0.0);
        all
    }

    fn value(&self, digits: &[u8]) -> f64 {
        let whole = digits
            .iter()
            .fold(Rational::ZERO, |sum, digit| sum * Rational::from(10) + Rational::from(i64::from(*digit)));
        to_f64(&(whole * Rational::from(10).pow(self.last_place as isize)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;

    fn digits(text: &str) -> Option<Digits> {
        Digits::of(&parse_decimal(text).unwrap())
    }

    #[test]
    fn digits_as_typed() {
        for (text, want) in [
            ("0.4166", Some((vec![4, 1, 6, 6], -4))),
            ("-0.0588", Some((vec![5, 8, 8], -4))),
            ("12", Some((vec![1, 2], 0))),
            ("0", None),
            ("0.1234567890123456", None),
            ("1e20", None),
        ] {
            assert_eq!(digits(text).map(|d| (d.digits, d.last_place)), want, "{text}");
        }
        assert_eq!(Digits::of(&(Rational::ONE / Rational::from(3))), None);
    }

    #[test]
    fn zeros_typed_at_the_end_are_digits() {
        for (text, number, want) in [
            ("0.0130 s^3", "0.013", Some((vec![1, 3, 0], -4))),
            ("0,0130 s^3 + 2", "0.013", Some((vec![1, 3, 0], -4))),
            ("tf([1,20],[3 4])", "20", Some((vec![2, 0], 0))),
            ("1.3e-2", "0.013", Some((vec![1, 3], -3))),
            ("(s + 0.5)(s + 4)", "4.5", None),
            ("4.50", "4.5", Some((vec![4, 5, 0], -2))),
        ] {
            let found = Written::new(text, None).digits(&parse_decimal(number).unwrap());
            assert_eq!(found.map(|d| (d.digits, d.last_place)), want, "{number} in {text}");
        }
    }

    #[test]
    fn letters_are_exact() {
        for (text, exact) in
            [("m*l*s/(2*I*s^2)", true), ("0.06*s/(I*s^2)", false), ("3*s/(s^2 + 2)", false), ("k*S", true)]
        {
            let formula = Expression::parse_typed(text).unwrap();
            assert_eq!(Written::new(text, Some(&formula)).is_exact(), exact, "{text}");
        }
    }

    #[test]
    fn slips_lead_back_to_what_was_meant() {
        for (typed, meant, code) in [
            ("0.4166", 0.4116, Some("slip.digit")),
            ("0.0042", 0.0024, Some("slip.exchanged")),
            ("-31.2", 13.2, Some("slip.exchanged")),
            ("0.4166", 0.4166, None),
            ("0.4166", 0.4611, None),
            ("0.4166", 4.166, None),
            ("5", 0.0, None),
        ] {
            let slips = digits(typed).unwrap().slips();
            let found = slips.iter().find(|slip| (slip.meant - meant).abs() < 1e-12);
            assert_eq!(found.map(|slip| slip.code), code, "{typed} for {meant}");
        }
    }
}
