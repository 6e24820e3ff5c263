use crate::algebra::significant;

/// A number as prose gives it: `0`, `zero`, `about -0.79`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClaimedNumber {
    pub value: f64,
    /// Half a unit of the last digit written.
    pub half_place: f64,
    /// `about`, `nearly`: not meant to the digit.
    pub about: bool,
}

impl ClaimedNumber {
    /// Whether it may be meant for `actual`, where values of the size `scale` occur: 5 % off at most, 20 % when it is said to
    /// be about so much, or what rounding and 2 % of `scale` allow.
    pub fn near(self, actual: f64, scale: f64) -> bool {
        let relative = if self.about { 0.2 } else { 0.05 };
        let width = (relative * actual.abs()).max(1.2 * self.half_place).max(0.02 * scale);
        (self.value - actual).abs() <= width
    }

    pub fn words(self) -> String {
        format!("{}{}", if self.about { "about " } else { "" }, significant(self.value, 6))
    }
}

/// What may stand after a number that is a value of the output. Anything else that looks like a unit is not taken.
const UNITS: &[&str] = &["rad", "radian", "radians", "v", "volt", "volts", "m", "a"];
/// Units of time.
const SECONDS: &[&str] = &["s", "sec", "secs", "second", "seconds"];
/// Other units, and what makes a number something else than a value.
const FOREIGN: &[&str] = &[
    "deg", "degree", "degrees", "percent", "ms", "mm", "cm", "km", "mv", "kv", "ma", "hz", "khz", "hertz",
    "min", "minute", "minutes", "h", "times", "th", "st", "nd", "rd", "e", "j", "i", "or", "pi", "periods",
    "cycles", "swings",
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// A value of the output: no unit, or one that may be its.
    Output,
    Seconds,
}

/// The number that begins at byte `start` of `text` (its sign before it), when it is a plain one with a unit of that kind.
pub(super) fn number_at(text: &str, start: usize, unit: Unit) -> Option<(ClaimedNumber, usize)> {
    let rest = text.get(start..)?;
    if let Some(after) = rest.get(..4).filter(|word| word.eq_ignore_ascii_case("zero")).and(rest.get(4..)) {
        let whole = !after.starts_with(|c: char| c.is_alphanumeric() || c == '-');
        let zero = ClaimedNumber { value: 0.0, half_place: 0.0, about: false };
        return (whole && fits(after, unit)).then_some((zero, start + 4));
    }
    if let Some(inside) = rest.strip_prefix('$') {
        let end = inside.find('$')?;
        let shown = inside[..end].trim();
        let shown = shown.rsplit_once('=').map_or(shown, |(_, value)| value.trim());
        let (number, length) = plain(shown)?;
        // Of `$\theta = 0\,\mathrm{rad}$` or `$0.4 e^{5.57 t}$` nothing is taken.
        let number = (length == shown.len()).then_some(number)?;
        return fits(&inside[end + 1..], unit).then_some((number, start + end + 2));
    }
    let (mut number, length) = plain(rest)?;
    let before = text.get(..start)?;
    let mut marks = before.chars().rev();
    if marks.next().is_some_and(is_minus) {
        // `5-3` is no value, and neither is the end of a word.
        if marks.next().is_some_and(char::is_alphanumeric) {
            return None;
        }
        number.value = -number.value;
    } else if before.ends_with(['±', '/', '^', '*', '·', '×', '<', '>', '≤', '≥']) {
        return None;
    }
    fits(&rest[length..], unit).then_some((number, start + length))
}

fn is_minus(c: char) -> bool {
    matches!(c, '-' | '−' | '–')
}

/// A plain decimal at the start of `text`, and its length.
fn plain(text: &str) -> Option<(ClaimedNumber, usize)> {
    const LONGEST: usize = 24;
    let unsigned = text.trim_start_matches(['-', '−', '+']);
    let negative = text.starts_with(['-', '−']);
    let signs = text.len() - unsigned.len();
    let length = unsigned
        .char_indices()
        .find(|&(at, c)| {
            let next = unsigned[at + c.len_utf8()..].chars().next();
            !(c.is_ascii_digit()
                || (matches!(c, '.' | ',') && next.is_some_and(|next| next.is_ascii_digit())))
        })
        .map_or(unsigned.len(), |(at, _)| at);
    let digits = &unsigned[..length];
    if length == 0 || length > LONGEST || !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let places = match digits.split_once([',', '.']) {
        None => 0,
        // `1,000` and `0,500` may be either; `1.2.3` is no number.
        Some((_, places)) if places.contains([',', '.']) || (places.len() == 3 && digits.contains(',')) => {
            return None;
        }
        Some((_, places)) => places.len(),
    };
    let value: f64 = digits.replace(',', ".").parse().ok()?;
    let half_place = 0.5 * 10f64.powi(-i32::try_from(places).ok()?);
    let value = if negative { -value } else { value };
    // A whole zero is meant as it stands.
    let half_place = if value == 0.0 && places == 0 { 0.0 } else { half_place };
    Some((ClaimedNumber { value, half_place, about: false }, signs + length))
}

/// Whether what follows a number leaves it a value of that unit.
fn fits(after: &str, unit: Unit) -> bool {
    let spaced = after.trim_start_matches([' ', '\t', '\n', '\r', '\u{a0}']);
    let glued = spaced.len() == after.len();
    match spaced.chars().next() {
        Some('%' | '°' | '/' | '^' | '*' | '·' | '×' | '±' | '\'' | '′' | '$' | '\\') => return false,
        Some(c) if glued && (is_minus(c) || c == '–' || c == '+') => return false,
        _ => {}
    }
    let word: String = spaced.chars().take_while(|c| c.is_alphabetic()).collect::<String>().to_lowercase();
    let seconds = SECONDS.contains(&word.as_str());
    match unit {
        Unit::Seconds => seconds || word.is_empty(),
        Unit::Output if seconds || FOREIGN.contains(&word.as_str()) => false,
        Unit::Output => !glued || word.is_empty() || UNITS.contains(&word.as_str()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_numbers_are_read_and_others_left() {
        use Unit::{Output, Seconds};
        for (text, unit, want) in [
            ("0", Output, Some(0.0)),
            ("zero.", Output, Some(0.0)),
            ("Zero", Output, Some(0.0)),
            ("zeros", Output, None),
            ("zero-crossing", Output, None),
            ("0.79 rad", Output, Some(0.79)),
            ("-0.79rad", Output, Some(-0.79)),
            ("− 0.79", Output, None),
            ("0,79 rad", Output, Some(0.79)),
            ("1,000", Output, None),
            ("1.2.3", Output, None),
            ("5 s", Output, None),
            ("5 s", Seconds, Some(5.0)),
            ("1.12s", Seconds, Some(1.12)),
            ("1.12 rad", Seconds, None),
            ("45 degrees", Output, None),
            ("45°", Output, None),
            ("2 %", Output, None),
            ("1/2", Output, None),
            ("0 or 1", Output, None),
            ("0.397e^{5.57t}", Output, None),
            ("1e-3", Output, None),
            ("2-3", Output, None),
            ("0 and it", Output, Some(0.0)),
            ("$0$ and", Output, Some(0.0)),
            ("$-0.79$ rad", Output, Some(-0.79)),
            ("$\\theta = 0$", Output, Some(0.0)),
            ("$0.397\\,e^{5.57t}$", Output, None),
            ("$", Output, None),
            ("", Output, None),
            ("999999999999999999999999999999", Output, None),
        ] {
            let start = usize::from(text.starts_with('-'));
            let found = number_at(text, start, unit).map(|(number, _)| number.value);
            assert_eq!(found, want, "{text:?}");
        }
    }

    #[test]
    fn near_is_wide() {
        let number = |value: f64, half_place: f64, about| ClaimedNumber { value, half_place, about };
        for (claimed, actual, scale, want) in [
            (number(1.1, 0.05, false), 1.1247, 1.1, true),
            (number(1.0, 0.0, true), 1.1247, 0.0, true),
            (number(1.3, 0.05, false), 1.1247, 0.0, false),
            (number(0.0, 0.0, false), 0.0, 0.8, true),
            (number(0.01, 0.005, false), 0.0, 0.8, true),
            (number(1.0, 0.5, false), 0.0, 0.8, false),
            (number(-0.79, 0.005, false), 0.79, 0.8, false),
        ] {
            assert_eq!(claimed.near(actual, scale), want, "{claimed:?} for {actual}");
        }
    }
}
