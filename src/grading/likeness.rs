use super::digits::Digits;
use crate::algebra::{Rational, to_f64};
use crate::lti::TransferFunction;

/// The coefficients of numerator and denominator in one row, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// How many of them are the numerator's.
    numerator: usize,
    pub values: Vec<f64>,
}

impl Row {
    pub fn of(function: &TransferFunction) -> Self {
        let values = coefficients(function).map(to_f64).collect();
        Self { numerator: function.num.coefficients().len(), values }
    }

    /// Of the same degrees, and zero in the same places.
    fn has_form_of(&self, other: &Self) -> bool {
        let zero = |row: &Self| row.values.iter().map(|value| *value == 0.0).collect::<Vec<_>>();
        self.numerator == other.numerator && zero(self) == zero(other)
    }
}

fn coefficients(function: &TransferFunction) -> impl Iterator<Item = &Rational> {
    function.num.coefficients().iter().chain(function.den.coefficients())
}

/// A transfer function as typed: each coefficient with what rounding may have left out.
#[derive(Clone, Debug)]
pub(super) struct Typed {
    row: Row,
    /// By coefficient.
    digits: Vec<Option<Digits>>,
    widths: Vec<f64>,
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

impl Typed {
    pub fn new(function: &TransferFunction) -> Self {
        let digits: Vec<Option<Digits>> = coefficients(function).map(Digits::of).collect();
        let row = Row::of(function);
        let widths = row.values.iter().zip(&digits).map(|(value, digits)| {
            let half = digits.as_ref().map_or(0.0, Digits::half_a_unit);
            half.clamp(LEAST_WIDTH * value.abs(), MOST_WIDTH * value.abs())
        });
        Self { widths: widths.collect(), row, digits }
    }

    /// With every coefficient allowed to be off by this part of it at least.
    pub fn widened(&self, part: f64) -> Self {
        let widths = self.row.values.iter().zip(&self.widths);
        Self { widths: widths.map(|(value, width)| width.max(part * value.abs())).collect(), ..self.clone() }
    }

    /// How far apart they are when they are equal up to a common factor, as the sum of relative deviations; `None` when not.
    pub fn misfit(&self, expected: &Row) -> Option<f64> {
        if !self.row.has_form_of(expected) {
            return None;
        }
        let (low, high) = self.factors(expected, None)?;
        Some(self.closest(expected, (low, high), &self.row.values))
    }

    /// The same when one coefficient, of the right sign, has one slip of a digit in it: the slip that fits best.
    pub fn misfit_but_for_a_slip(&self, expected: &Row) -> Option<(f64, Mended)> {
        if !self.row.has_form_of(expected) {
            return None;
        }
        let mut best: Option<(f64, Mended)> = None;
        for place in 0..self.row.values.len() {
            let Some(digits) = &self.digits[place] else { continue };
            let others = self.row.values.iter().enumerate();
            // Two others at least must agree on the factor, or it is no evidence.
            if others.filter(|(other, value)| *other != place && **value != 0.0).count() < 2 {
                continue;
            }
            let Some((low, high)) = self.factors(expected, Some(place)) else { continue };
            let typed = self.row.values[place];
            for slip in digits.slips() {
                let meant = slip.meant.copysign(typed);
                let half = digits.half_a_unit().clamp(LEAST_WIDTH * slip.meant, MOST_WIDTH * slip.meant);
                let Some(own) = interval(meant, half, expected.values[place]) else { continue };
                let (low, high) = (low.max(own.0), high.min(own.1));
                if low > high {
                    continue;
                }
                let mut mended = self.row.values.clone();
                mended[place] = meant;
                let misfit = self.closest(expected, (low, high), &mended);
                if best.as_ref().is_none_or(|(least, _)| misfit < *least) {
                    let mended = Mended { code: slip.code, typed: typed.abs(), meant: slip.meant };
                    best = Some((misfit, mended));
                }
            }
        }
        best
    }

    /// The common factors that every coefficient allows, but for the one left out.
    fn factors(&self, expected: &Row, left_out: Option<usize>) -> Option<(f64, f64)> {
        let mut range = (f64::NEG_INFINITY, f64::INFINITY);
        for (place, (value, width)) in self.row.values.iter().zip(&self.widths).enumerate() {
            if Some(place) == left_out || *value == 0.0 {
                continue;
            }
            let own = interval(*value, *width, expected.values[place])?;
            range = (range.0.max(own.0), range.1.min(own.1));
        }
        (range.0 <= range.1 && range.0.is_finite()).then_some(range)
    }

    /// Σ |typed − k · expected| / |k · expected| with the best k in the range: an end of it, or some coefficient's own.
    fn closest(&self, expected: &Row, range: (f64, f64), typed: &[f64]) -> f64 {
        let pairs = || typed.iter().zip(&expected.values).filter(|(_, expected)| **expected != 0.0);
        let ratios = pairs().map(|(typed, expected)| typed / expected);
        ratios
            .chain([range.0, range.1])
            .filter(|k| (range.0..=range.1).contains(k) && *k != 0.0)
            .map(|k| pairs().map(|(typed, expected)| (typed / (k * expected) - 1.0).abs()).sum())
            .fold(f64::INFINITY, f64::min)
    }
}

/// The factors k with |value − k · expected| ≤ width.
fn interval(value: f64, width: f64, expected: f64) -> Option<(f64, f64)> {
    // A width at its edge counts: decimals are not exact in binary.
    const EDGE: f64 = 1e-12;
    let width = width + EDGE * value.abs();
    let (a, b) = ((value - width) / expected, (value + width) / expected);
    (a.is_finite() && b.is_finite()).then_some((a.min(b), a.max(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal};

    fn function(text: &str) -> TransferFunction {
        let polynomial = |text: &str| {
            Polynomial::new(text.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
        };
        let (num, den) = text.split_once('/').unwrap();
        TransferFunction::new(polynomial(num), polynomial(den)).unwrap()
    }

    /// What it is, as typed, and what it is found to be.
    #[track_caller]
    fn check(expected: &str, rows: &[(&str, &str, &str)]) {
        let expected = Row::of(&function(expected));
        for (what, typed, outcome) in rows {
            let typed = Typed::new(&function(typed));
            let found = match (typed.misfit(&expected), typed.misfit_but_for_a_slip(&expected)) {
                (Some(_), _) => "equal".to_owned(),
                (None, Some((_, Mended { typed, meant, .. }))) => format!("{typed} for {meant}"),
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
            ],
        );
    }
}
