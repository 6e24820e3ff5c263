use crate::algebra::{Rational, from_f64, significant, to_f64};
use crate::lab::Tolerance;
use crate::submission::{Decimal, UnitRatio};

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

/// A number that is expected, what it may itself be off by, and what it is large or small beside.
///
/// Decided in exact rationals; the error bound is given to the student.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Expected {
    pub value: Rational,
    /// Not negative.
    pub error_bound: Rational,
    /// The size of what it belongs to: of the pole it is a part of, of the largest value of its response. 0 when there is
    /// nothing beside it.
    pub scale: Rational,
}

impl Expected {
    /// `None` for what is not finite.
    pub fn computed(value: f64, error_bound: f64) -> Option<Self> {
        Self::beside(value, error_bound, 0.0)
    }

    /// As [`Expected::computed`], of something as large as `scale`.
    pub fn beside(value: f64, error_bound: f64, scale: f64) -> Option<Self> {
        Some(Self {
            value: from_f64(value)?,
            error_bound: magnitude(&from_f64(error_bound)?),
            scale: magnitude(&from_f64(scale).unwrap_or(Rational::ZERO)),
        })
    }

    /// The same number in another unit, of which one of its own is `ratio`.
    pub fn in_unit(&self, ratio: &UnitRatio) -> Self {
        let (factor, bound) = ratio.value();
        let error_bound =
            &self.error_bound * magnitude(&factor) + magnitude(&self.value) * bound * Rational::from(2);
        let scale = &self.scale * magnitude(&factor);
        Self { value: &self.value * factor, error_bound, scale }
    }

    pub fn closeness(&self, typed: &Decimal, tolerance: &Tolerance) -> Closeness {
        let distance = magnitude(&(&typed.value - &self.value));
        if distance <= self.width(tolerance) + &self.error_bound {
            return Closeness::Within;
        }
        match rounding(typed, tolerance) {
            Some(half_a_unit) if distance <= &self.error_bound + &half_a_unit => Closeness::Rounded,
            _ => Closeness::Off,
        }
    }

    /// Lowest and highest number within max(absolute, relative · |expected|) and the error bound.
    ///
    /// Numbers outside may still be right, when they are the expected one correctly rounded.
    pub fn interval(&self, tolerance: &Tolerance) -> (Rational, Rational) {
        let reach = self.width(tolerance) + &self.error_bound;
        (&self.value - &reach, &self.value + reach)
    }

    /// max(absolute, relative · |expected|).
    fn width(&self, tolerance: &Tolerance) -> Rational {
        self.relative_width(tolerance).max(self.absolute(tolerance))
    }

    /// The absolute tolerance as it counts here: all of what the lab states, see [`Tolerance::of_scale`].
    pub fn absolute(&self, tolerance: &Tolerance) -> Rational {
        let Some(part) = &tolerance.of_scale else { return tolerance.absolute.clone() };
        let size = magnitude(&self.value);
        let is_zero = size <= self.error_bound;
        let of_scale = match self.scale.is_zero() {
            true if is_zero => tolerance.absolute.clone(),
            true => part * &size,
            false => part * &self.scale,
        };
        let widest = tolerance.absolute.clone().min(of_scale);
        if is_zero { widest } else { widest.min(size / Rational::from(10)) }
    }

    fn relative_width(&self, tolerance: &Tolerance) -> Rational {
        &tolerance.relative * magnitude(&self.value)
    }

    /// `accepted from -0.8023 to -0.7865 (1 %), or the value correctly rounded to at least 2 figures`: both ends are accepted.
    ///
    /// `unit` stands behind the interval; empty for none.
    pub fn accepted_in_words(&self, tolerance: &Tolerance, unit: &str) -> String {
        let interval = self.interval_in_words(tolerance, unit);
        let range = match interval {
            Some(interval) => format!("accepted {interval}"),
            None if self.width(tolerance).is_zero() => "exactly".to_owned(),
            None => return in_words(&self.stated(tolerance)),
        };
        match tolerance.figures.filter(|figures| self.rounding_reaches_farther(*figures, tolerance)) {
            Some(figures) => {
                format!("{range}, or the value correctly rounded to at least {}", counted(figures))
            }
            None => range,
        }
    }

    /// The tolerance as if the lab stated what holds here.
    pub fn stated(&self, tolerance: &Tolerance) -> Tolerance {
        Tolerance { absolute: self.absolute(tolerance), of_scale: None, ..tolerance.clone() }
    }

    /// To five figures, and `0` when it is nothing but rounding beside the tolerance.
    pub fn shown(&self, tolerance: &Tolerance) -> String {
        if magnitude(&self.value) * Rational::from(1000) <= self.absolute(tolerance) {
            "0".to_owned()
        } else {
            significant(to_f64(&self.value), 5)
        }
    }

    /// `from -0.8023 to -0.7865 (1 %)`; `None` when the interval is too narrow to be written with few digits.
    fn interval_in_words(&self, tolerance: &Tolerance, unit: &str) -> Option<String> {
        let width = self.width(tolerance);
        let (low, high) = self.interval(tolerance);
        let (low, high) = inward(&low, &high, &width)?;
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let absolute = self.absolute(tolerance);
        let how = if self.relative_width(tolerance) > absolute {
            format!(" ({})", percent(&tolerance.relative))
        } else if magnitude(&self.value) * Rational::from(1000) <= absolute {
            String::new()
        } else {
            format!(" (±{})", significant(to_f64(&absolute), 3))
        };
        Some(format!("from {low} to {high}{unit}{how}"))
    }

    /// Whether a number of so many figures may be correctly rounded and yet outside of the interval.
    fn rounding_reaches_farther(&self, figures: u32, tolerance: &Tolerance) -> bool {
        // Half a unit of the last of n figures is at most a part 1 / (2 · 10^(n−1) − 1) of the number that was rounded.
        let units = Rational::from(2) * power_of_ten(i32::try_from(figures).unwrap_or(i32::MAX) - 1);
        magnitude(&self.value) / (units - Rational::ONE) > self.width(tolerance)
    }
}

fn counted(figures: u32) -> String {
    if figures == 1 { "1 figure".to_owned() } else { format!("{figures} figures") }
}

/// Decimals of few digits just inside of `low` and `high`, as text that says exactly these; `None` when `width`, half of the
/// interval, is too narrow beside them.
pub(super) fn inward(low: &Rational, high: &Rational, width: &Rational) -> Option<(String, String)> {
    const DIGITS: usize = 15;
    let fine = to_f64(width) / 50.0;
    if !(fine.is_finite() && fine > 0.0) {
        return None;
    }
    let exponent: i32 = format!("{fine:e}").split_once('e')?.1.parse().ok()?;
    let unit = power_of_ten(exponent);
    let shown = |units: Rational| {
        let text = significant(to_f64(&(&units * &unit)), DIGITS);
        let short = magnitude(&units) < power_of_ten(DIGITS as i32);
        short.then_some(text)
    };
    let low = Rational::from((low / &unit).ceil());
    let high = Rational::from((high / &unit).floor());
    (low <= high).then_some(())?;
    Some((shown(low)?, shown(high)?))
}

/// How far the number that was rounded to `typed` may be from it: half a unit of its last place, or of an earlier one when
/// zeros at the end of a whole number may only tell its size, as those of `1300` for two figures.
///
/// `None` for fewer significant figures than the lab asks for, and where rounding is not allowed.
pub(super) fn rounding(typed: &Decimal, tolerance: &Tolerance) -> Option<Rational> {
    let figures = tolerance.figures? as usize;
    if significant_figures(typed) < figures {
        return None;
    }
    let place = typed.last_place.saturating_add(places_left_open(typed, figures));
    Some(power_of_ten(place) / Rational::from(2))
}

/// Figures from the first that is not zero to the last one typed: 3 for `0.0412`, 4 for `1.500`, 0 for `0.00`.
fn significant_figures(typed: &Decimal) -> usize {
    if typed.value.is_zero() {
        return 0;
    }
    let digits = (&typed.value / power_of_ten(typed.last_place)).round();
    digits.to_string().trim_start_matches('-').len()
}

/// How many zeros at the end of a whole number may only tell its size, when `figures` are needed: 1 of `130` for two
/// figures, and of `1300` for three; 0 of `1.30`.
fn places_left_open(typed: &Decimal, figures: usize) -> i32 {
    if typed.last_place != 0 || typed.text.contains(['.', 'e', 'E']) {
        return 0;
    }
    let zeros = typed.text.len() - typed.text.trim_end_matches('0').len();
    let spare = significant_figures(typed).saturating_sub(figures);
    i32::try_from(zeros.min(spare)).unwrap_or(0)
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
        Some(figures) => format!("{width}, or correctly rounded to at least {}", counted(figures)),
        None => width,
    }
}

/// `0.5 %`.
pub(super) fn percent(part: &Rational) -> String {
    format!("{} %", significant(to_f64(part) * 100.0, 3))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use proptest::prelude::*;

    /// A decimal as a submission gives it; plain notation only.
    pub fn typed(text: &str) -> Decimal {
        let last_place = text.split_once('.').map_or(0, |(_, digits)| -(digits.len() as i32));
        Decimal { text: text.to_owned(), value: parse_decimal(text).unwrap(), last_place }
    }

    pub fn tolerance(absolute: &str, relative: &str, figures: Option<u32>) -> Tolerance {
        let number = |text| parse_decimal(text).unwrap();
        Tolerance { absolute: number(absolute), of_scale: None, relative: number(relative), figures }
    }

    fn closeness(expected: f64, error_bound: f64, typed: &Decimal, tolerance: &Tolerance) -> Closeness {
        Expected::computed(expected, error_bound)
            .map_or(Closeness::Off, |expected| expected.closeness(typed, tolerance))
    }

    /// What the lab leaves to polemark: 0.001, and no more than a thousandth of the scale.
    pub fn usual() -> Tolerance {
        let stated = tolerance("0.001", "0.01", Some(2));
        Tolerance { of_scale: Some(stated.absolute.clone()), ..stated }
    }

    /// (expected, scale, a number that is accepted and the next that is not).
    #[test]
    fn the_usual_width_is_that_of_the_scale() {
        for (expected, scale, within, beyond) in [
            // zeros
            (0.0, 0.0, "0.001", "0.0011"),
            (0.0, 5.0, "-0.001", "-0.0011"),
            (0.0, 0.02, "0.00002", "0.000021"),
            (0.0, 4e-7, "4e-10", "4.1e-10"),
            // a real part beside an imaginary part, a final value beside a peak: on its own side of zero
            (-0.0195, 5.6, "-0.0205", "-0.0206"),
            (-0.0004, 5.6, "-0.00044", "-0.000441"),
            (-0.0004, 5.6, "-0.00036", "0.0004"),
            (-0.0004, 0.02, "-0.00042", "-0.000421"),
            // nothing beside it: 1 %
            (0.0004, 0.0, "0.000404", "0.000405"),
            (1e-4, 1e-4, "0.000101", "-0.0001"),
            (128.0, 128.0, "129.28", "129.29"),
        ] {
            let known = Expected::beside(expected, 1e-14 * scale, scale).unwrap();
            let strict = Tolerance { figures: None, ..usual() };
            let got = |text: &str| known.closeness(&Decimal::parse(text).unwrap(), &strict);
            assert_eq!(got(within), Closeness::Within, "{within} for {expected} beside {scale}");
            assert_eq!(got(beyond), Closeness::Off, "{beyond} for {expected} beside {scale}");
        }
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
            // zeros at the end of a whole number may only tell its size, those behind the point are figures
            (128.4, "130", Rounded),
            (128.4, "120", Off),
            (1284.0, "1300", Rounded),
            (128.4, "130.0", Off),
            (128.4, "100", Off),
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

    /// What is said beside an expected number, and the next decimal beyond each end, which is not accepted any more.
    #[test]
    fn an_interval_shown_is_the_one_decided() {
        let near = tolerance("0.001", "0.01", Some(2));
        for (expected, tolerance, words, beyond) in [
            (
                -0.79437,
                &near,
                "accepted from -0.8023 to -0.7865 (1 %), or the value correctly rounded to at least 2 figures",
                Some(("-0.8024", "-0.7864")),
            ),
            (0.0, &near, "accepted from -0.001 to 0.001", Some(("-0.00101", "0.00101"))),
            (
                128.0,
                &near,
                "accepted from 126.72 to 129.28 (1 %), or the value correctly rounded to at least 2 figures",
                Some(("126.71", "129.29")),
            ),
            (
                -0.0195,
                &near,
                "accepted from -0.0205 to -0.0185 (±0.001), or the value correctly rounded to at least 2 figures",
                Some(("-0.02051", "-0.01849")),
            ),
            (
                5.5864,
                &tolerance("0", "0.01", Some(3)),
                "accepted from 5.531 to 5.642 (1 %)",
                Some(("5.530", "5.643")),
            ),
            (12.5, &tolerance("0", "0", None), "exactly", None),
            (
                12.5,
                &tolerance("0", "0", Some(1)),
                "exactly, or the value correctly rounded to at least 1 figure",
                None,
            ),
            (
                1e-12,
                &tolerance("0", "0.01", None),
                "accepted from 9.9e-13 to 1.01e-12 (1 %)",
                Some(("9.89e-13", "1.011e-12")),
            ),
            (
                -2.5e8,
                &tolerance("0", "0.1", None),
                "accepted from -2.75e8 to -2.25e8 (10 %)",
                Some(("-2.76e8", "-2.24e8")),
            ),
            (1.0, &tolerance("1e-17", "0", None), "within 1e-17", None),
        ] {
            let bound = 1e-15 * f64::abs(expected);
            assert_eq!(in_interval(expected, bound, tolerance, ""), words, "{expected}");
            let Some((below, above)) = beyond else { continue };
            let mut ends = words.split(' ').skip(2).step_by(2);
            let (low, high) = (ends.next().unwrap(), ends.next().unwrap());
            let strict = Tolerance { figures: None, ..tolerance.clone() };
            let got = |text: &str| closeness(expected, bound, &Decimal::parse(text).unwrap(), &strict);
            assert_eq!(got(low), Closeness::Within, "{low} for {expected}");
            assert_eq!(got(high), Closeness::Within, "{high} for {expected}");
            assert_eq!(got(below), Closeness::Off, "{below} for {expected}");
            assert_eq!(got(above), Closeness::Off, "{above} for {expected}");
        }
        assert_eq!(
            in_interval(2.0, 0.0, &tolerance("0", "0.01", None), "rad/s"),
            "accepted from 1.98 to 2.02 rad/s (1 %)"
        );
        assert_eq!(Expected::computed(f64::INFINITY, 0.0), None);
    }

    fn in_interval(expected: f64, bound: f64, tolerance: &Tolerance, unit: &str) -> String {
        Expected::computed(expected, bound).unwrap().accepted_in_words(tolerance, unit)
    }

    proptest! {
        /// Both ends that are shown are accepted, and a thousandth of the width inside of the decided ones is as well.
        #[test]
        fn shown_ends_are_accepted(
            digits in -1_000_000i64..1_000_000,
            place in -12i32..12,
            relative in 0u32..200,
            absolute in 0u32..50,
            bound in 0u32..3,
        ) {
            let expected = digits as f64 * 10f64.powi(place);
            let bound = f64::from(bound) * 1e-12 * expected.abs();
            let tolerance = tolerance(&format!("{absolute}e-4"), &format!("{relative}e-3"), None);
            let words = in_interval(expected, bound, &tolerance, "");
            if let Some(rest) = words.strip_prefix("accepted from ") {
                let mut ends = rest.split(' ').step_by(2);
                for end in [ends.next().unwrap(), ends.next().unwrap()] {
                    let typed = Decimal::parse(end).unwrap();
                    prop_assert_eq!(closeness(expected, bound, &typed, &tolerance), Closeness::Within, "{} in {}", end, words);
                }
            }
        }
    }
}
