use super::digits::{Digits, Written};
use crate::algebra::{Rational, to_f64};
use crate::lti::TransferFunction;
use crate::model::RealFunction;

/// The degrees of numerator and denominator, and which coefficients are not zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub(super) struct Form {
    numerator: u8,
    denominator: u8,
    /// The numerator's first, highest power first.
    filled: u64,
}

/// The coefficients that are not zero, numerator first, highest power first, divided by the first of them.
///
/// Equal rows are equal functions: the last 20 bits of each value are rounded away, and with them how it was worked out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub form: Form,
    pub values: Vec<f64>,
}

/// More coefficients than these are not compared.
const MOST_COEFFICIENTS: usize = 64;

impl Row {
    /// `None` for the zero function, and for more than 64 coefficients.
    pub fn of(function: &TransferFunction) -> Option<Self> {
        Self::new(
            function.num.coefficients().iter().map(to_f64),
            function.den.coefficients().iter().map(to_f64),
        )
    }

    pub fn estimated(function: &RealFunction) -> Option<Self> {
        let highest_first = |p: &crate::model::RealPolynomial| -> Vec<f64> {
            p.coefficients().iter().rev().copied().collect()
        };
        Self::new(highest_first(&function.num).into_iter(), highest_first(&function.den).into_iter())
    }

    fn new(num: impl ExactSizeIterator<Item = f64>, den: impl ExactSizeIterator<Item = f64>) -> Option<Self> {
        let (numerator, denominator) = (num.len(), den.len());
        if numerator == 0 || denominator == 0 || numerator + denominator > MOST_COEFFICIENTS {
            return None;
        }
        let all: Vec<f64> = num.chain(den).collect();
        let first = *all.iter().find(|value| **value != 0.0)?;
        let filled = all.iter().fold(0, |bits, value| (bits << 1) | u64::from(*value != 0.0));
        let form = Form {
            numerator: u8::try_from(numerator).ok()?,
            denominator: u8::try_from(denominator).ok()?,
            filled,
        };
        let values =
            all.into_iter().filter(|value| *value != 0.0).map(|value| rounded(value / first)).collect();
        Some(Self { form, values })
    }

    /// For finding an equal row.
    pub fn key(&self) -> (Form, Vec<u64>) {
        (self.form, self.values.iter().map(|value| value.to_bits()).collect())
    }
}

/// To 32 bits of mantissa.
fn rounded(value: f64) -> f64 {
    const HALF: u64 = 1 << 19;
    const MASK: u64 = !((1 << 20) - 1);
    f64::from_bits(value.to_bits().saturating_add(HALF) & MASK)
}

fn coefficients(function: &TransferFunction) -> impl Iterator<Item = &Rational> {
    function.num.coefficients().iter().chain(function.den.coefficients()).filter(|c| !c.is_zero())
}

/// A transfer function as typed: each coefficient that is not zero with what rounding may have left out.
#[derive(Clone, Debug)]
pub(super) struct Typed {
    pub form: Form,
    pub values: Vec<f64>,
    pub widths: Vec<f64>,
    /// Of each coefficient that was typed as it is.
    digits: Vec<Option<Digits>>,
}

/// One digit of one coefficient that must be mended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mended {
    pub code: &'static str,
    /// Sizes, as typed and as meant.
    pub typed: f64,
    pub meant: f64,
}

/// Rounding to four figures may always have happened on the way; a number of one or two figures is taken for a whole one.
const LEAST_WIDTH: f64 = 5e-4;
const MOST_WIDTH: f64 = 5e-3;

/// What is left between a function in letters and the same function worked out another way.
const NO_WIDTH: f64 = 2e-9;

impl Typed {
    /// `None` for the zero function, and for more coefficients than are compared.
    pub fn new(function: &TransferFunction, written: &Written) -> Option<Self> {
        let form = Row::of(function)?.form;
        let digits: Vec<Option<Digits>> = coefficients(function).map(|c| written.digits(c)).collect();
        let values: Vec<f64> = coefficients(function).map(to_f64).collect();
        let widths = values.iter().zip(&digits).map(|(value, digits)| {
            if written.is_exact() {
                return NO_WIDTH * value.abs();
            }
            let half = digits.as_ref().map_or(0.0, Digits::half_a_unit);
            half.clamp(LEAST_WIDTH * value.abs(), MOST_WIDTH * value.abs())
        });
        Some(Self { form, widths: widths.collect(), values, digits })
    }

    /// With every coefficient allowed to be off by this part of it at least.
    pub fn widened(&self, part: f64) -> Self {
        let widths = self.values.iter().zip(&self.widths);
        Self { widths: widths.map(|(value, width)| width.max(part * value.abs())).collect(), ..self.clone() }
    }

    /// With every coefficient allowed to be off by half a unit of its last digit, however few digits there are.
    pub fn coarse(&self) -> Self {
        let widths = self.widths.iter().zip(&self.digits);
        let half = |digits: &Option<Digits>| digits.as_ref().map_or(0.0, Digits::half_a_unit);
        Self { widths: widths.map(|(width, digits)| width.max(half(digits))).collect(), ..self.clone() }
    }

    /// The coefficients that are off by more than this part of them, each as typed and as expected in the same scale.
    pub fn rounded(&self, expected: &Row, part: f64) -> Vec<(f64, f64)> {
        let Some(range) = self.factors(&expected.values, 0) else { return Vec::new() };
        let Some((_, factor)) = best_factor(&self.values, &expected.values, range) else { return Vec::new() };
        let pairs = self.values.iter().zip(&expected.values).map(|(typed, one)| (*typed, factor * one));
        pairs.filter(|(typed, meant)| (typed / meant - 1.0).abs() > part).collect()
    }

    /// How far apart they are when they are equal up to a common factor, as the sum of relative deviations; `None` when not.
    pub fn misfit(&self, expected: &Row) -> Option<f64> {
        if self.form != expected.form {
            return None;
        }
        let range = self.factors(&expected.values, 0)?;
        Some(closest(&self.values, &expected.values, range))
    }

    /// The same when one coefficient, of the right sign, has one slip of a digit in it: the slip that fits best.
    pub fn misfit_but_for_a_slip(&self, expected: &Row) -> Option<(f64, Mended)> {
        // Two others at least must agree on the factor, or it is no evidence.
        if self.form != expected.form || self.values.len() < 3 {
            return None;
        }
        let mut best: Option<(f64, Mended)> = None;
        for (place, digits) in self.digits.iter().enumerate() {
            let Some(digits) = digits else { continue };
            let Some((low, high)) = self.factors(&expected.values, 1 << place) else { continue };
            let typed = self.values[place];
            for slip in digits.slips() {
                let meant = slip.meant.copysign(typed);
                let half = digits.half_a_unit().clamp(LEAST_WIDTH * slip.meant, MOST_WIDTH * slip.meant);
                let Some(own) = interval(meant, half, expected.values[place]) else { continue };
                let (low, high) = (low.max(own.0), high.min(own.1));
                if low > high {
                    continue;
                }
                let mut mended = self.values.clone();
                mended[place] = meant;
                let misfit = closest(&mended, &expected.values, (low, high));
                if best.as_ref().is_none_or(|(least, _)| misfit < *least) {
                    let mended = Mended { code: slip.code, typed: typed.abs(), meant: slip.meant };
                    best = Some((misfit, mended));
                }
            }
        }
        best
    }

    /// The common factors that every coefficient allows, but for those left out (a bit each).
    pub fn factors(&self, expected: &[f64], left_out: u64) -> Option<(f64, f64)> {
        let mut range = (f64::NEG_INFINITY, f64::INFINITY);
        let all = self.values.iter().zip(&self.widths).zip(expected).enumerate();
        for (_, ((value, width), expected)) in all.filter(|(place, _)| left_out & (1 << place) == 0) {
            let own = interval(*value, *width, *expected)?;
            range = (range.0.max(own.0), range.1.min(own.1));
            if range.0 > range.1 {
                return None;
            }
        }
        range.0.is_finite().then_some(range)
    }

    /// The widest part of its size that a coefficient may be off by.
    pub fn relative_width(&self, place: usize) -> f64 {
        self.widths[place] / self.values[place].abs()
    }
}

/// Σ |typed − k · expected| / |k · expected| with the best k in the range.
fn closest(typed: &[f64], expected: &[f64], range: (f64, f64)) -> f64 {
    best_factor(typed, expected, range).map_or(f64::INFINITY, |(misfit, _)| misfit)
}

/// The least sum of relative deviations, and the factor in the range that gives it: an end of it, or some coefficient's own.
fn best_factor(typed: &[f64], expected: &[f64], range: (f64, f64)) -> Option<(f64, f64)> {
    let pairs = || typed.iter().zip(expected);
    let ratios = pairs().map(|(typed, expected)| typed / expected);
    ratios
        .chain([range.0, range.1])
        .filter(|k| (range.0..=range.1).contains(k) && *k != 0.0)
        .map(|k| (pairs().map(|(typed, expected)| (typed / (k * expected) - 1.0).abs()).sum(), k))
        .min_by(|a: &(f64, f64), b| a.0.total_cmp(&b.0))
}

/// The factors k with |value − k · expected| ≤ width.
fn interval(value: f64, width: f64, expected: f64) -> Option<(f64, f64)> {
    // A width at its edge counts: decimals are not exact in binary, and rows are rounded.
    const EDGE: f64 = 1e-9;
    let width = width + EDGE * value.abs();
    let (a, b) = ((value - width) / expected, (value + width) / expected);
    (a.is_finite() && b.is_finite()).then_some((a.min(b), a.max(b)))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal};

    /// `0.06 0 / 0.0132 0.0024`: coefficients, highest power first.
    pub fn function(text: &str) -> TransferFunction {
        let polynomial = |text: &str| {
            Polynomial::new(text.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
        };
        let (num, den) = text.split_once('/').unwrap();
        TransferFunction::new(polynomial(num), polynomial(den)).unwrap()
    }

    /// What it is, as typed, and what it is found to be.
    #[track_caller]
    fn check(expected: &str, rows: &[(&str, &str, &str)]) {
        let expected = Row::of(&function(expected)).unwrap();
        for (what, text, outcome) in rows {
            let typed = Typed::new(&function(text), &Written::new(text, None)).unwrap();
            let found = match (typed.misfit(&expected), typed.misfit_but_for_a_slip(&expected)) {
                (Some(_), _) => "equal".to_owned(),
                (None, Some((_, Mended { typed, meant, .. }))) => format!("{typed} for {meant}"),
                (None, None) if typed.coarse().misfit(&expected).is_some() => "coarse".to_owned(),
                (None, None) => "neither".to_owned(),
            };
            assert_eq!(found, *outcome, "{what}");
        }
    }

    #[test]
    fn up_to_a_factor_within_rounding() {
        check(
            "0.06 0 / 0.0132 0.0024 -0.41202 -0.05886",
            &[
                ("exact", "0.06 0 / 0.0132 0.0024 -0.41202 -0.05886", "equal"),
                ("turned", "-0.06 0 / -0.0132 -0.0024 0.41202 0.05886", "equal"),
                ("three figures", "0.06 0 / 0.0132 0.0024 -0.412 -0.0589", "equal"),
                ("monic", "4.545 0 / 1 0.1818 -31.21 -4.459", "equal"),
                ("a sign", "0.06 0 / 0.0132 0.0024 -0.41202 0.05886", "neither"),
                ("a digit", "0.06 0 / 0.0132 0.0024 -0.41702 -0.05886", "0.41702 for 0.41202"),
                ("neighbours", "0.06 0 / 0.0132 0.0042 -0.41202 -0.05886", "0.0042 for 0.0024"),
                ("a digit and a sign", "0.06 0 / 0.0132 0.0024 0.41702 -0.05886", "neither"),
                ("two digits", "0.06 0 / 0.0132 0.0042 -0.41702 -0.05886", "neither"),
                ("a term too few", "0.06 0 / 0.0132 0.0024 -0.41202 0", "neither"),
                ("another order", "0.06 / 0.0132 0.0024 -0.41202 -0.05886", "neither"),
                ("two figures", "0.06 0 / 0.013 0.0024 -0.41 -0.059", "coarse"),
                (
                    "a zero typed says it is not rounded there",
                    "0.06 0 / 0.0130 0.0024 -0.41 -0.059",
                    "0.013 for 0.0132",
                ),
            ],
        );
    }
}
