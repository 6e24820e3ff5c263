use crate::algebra::{Rational, to_f64};

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

    /// Half a unit of the last place: what rounding may have left out.
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
