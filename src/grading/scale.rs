use super::closeness::magnitude;
use crate::algebra::{Polynomial, Rational};

/// Which polynomial of a transfer function a coefficient stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Numerator,
    Denominator,
}

/// What one coefficient is under a common factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    Right,
    /// Not zero, but of the other sign.
    Sign,
    /// Of the right sign, but off by more than the tolerance.
    Value,
    /// Zero where it should not be.
    Missing,
    /// Not zero where it should be.
    Extra,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coefficient {
    pub part: Part,
    pub power: usize,
    /// In the reference's scale.
    pub expected: Rational,
    pub written: Rational,
    pub fit: Fit,
}

/// A student's coefficients held against the expected ones, up to a common factor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scaled {
    /// The student's scale: written ≈ `factor` · expected.
    pub factor: Rational,
    /// The smallest and the largest size of a factor that all of these agree on; `None` when there are none.
    pub range: Option<(Rational, Rational)>,
    /// How many coefficients agree on it.
    pub agreeing: usize,
    /// How many have its size to the last digit, whatever their sign: tells which of several references was meant.
    pub identical: usize,
    /// How many must agree on it for it to mean anything: two, and half of the expected ones that are not zero.
    pub needed: usize,
    /// Whether the factor means anything: as many agree on it as must, or the denominator's only one sets it.
    pub supported: bool,
    pub coefficients: Vec<Coefficient>,
}

impl Scaled {
    pub fn of(&self, part: Part) -> impl Iterator<Item = &Coefficient> {
        self.coefficients.iter().filter(move |coefficient| coefficient.part == part)
    }

    /// What `coefficient` might have been written as, smallest and largest, with all that is right left as it is.
    ///
    /// `None` where nothing sets the scale, or nothing was expected.
    pub fn accepted(&self, coefficient: &Coefficient, tolerance: &Rational) -> Option<(Rational, Rational)> {
        let (low, high) = self.range.as_ref().filter(|_| !coefficient.expected.is_zero())?;
        let tolerance = widest(tolerance);
        let size = magnitude(&coefficient.expected);
        let near = &size * low * (Rational::ONE - &tolerance);
        let far = size * high * (Rational::ONE + tolerance);
        let positive = (&self.factor * &coefficient.expected) > Rational::ZERO;
        Some(if positive { (near, far) } else { (-far, -near) })
    }

    pub fn is_right(&self, part: Part) -> bool {
        self.supported && self.of(part).all(|coefficient| coefficient.fit == Fit::Right)
    }
}

/// Everything a common factor must satisfy for one coefficient: `sign` · `low` ..= `sign` · `high`.
struct Interval {
    ratio: Rational,
    low: Rational,
    high: Rational,
}

impl Interval {
    fn contains(&self, factor: &Rational) -> bool {
        let same_sign = (self.ratio > Rational::ZERO) == (*factor > Rational::ZERO);
        let size = magnitude(factor);
        same_sign && self.low <= size && size <= self.high
    }
}

/// One [`Scaled`] for each common factor on which most coefficients agree, numerator and denominator taken together.
///
/// A factor k agrees with a coefficient when |written − k · expected| ≤ tolerance · |k · expected|, which is an interval of k:
/// the most that overlap are found exactly, at the ends of intervals. A denominator of a single term sets the factor alone.
/// Source: Klee's sweep over interval ends; all in exact rationals.
pub(super) fn scalings(
    expected: (&Polynomial, &Polynomial),
    written: (&Polynomial, &Polynomial),
    tolerances: (&Rational, &Rational),
) -> Vec<Scaled> {
    let mut pairs = side_by_side(Part::Numerator, expected.0, written.0);
    pairs.extend(side_by_side(Part::Denominator, expected.1, written.1));
    let intervals: Vec<Option<Interval>> = pairs
        .iter()
        .map(|pair| interval(pair, if pair.part == Part::Numerator { tolerances.0 } else { tolerances.1 }))
        .collect();

    let only_denominator = only_term(&pairs, Part::Denominator);
    let mut best: Vec<(Rational, Vec<bool>)> = Vec::new();
    let mut most = 0;
    for (index, candidate) in intervals.iter().enumerate() {
        let Some(candidate) = candidate else { continue };
        if only_denominator.is_some_and(|only| only != index) {
            continue;
        }
        let start =
            if candidate.ratio > Rational::ZERO { candidate.low.clone() } else { -candidate.low.clone() };
        // Only the denominator's own ratio will do when it sets the factor.
        let start = if only_denominator.is_some() { candidate.ratio.clone() } else { start };
        let agree: Vec<bool> =
            intervals.iter().map(|one| one.as_ref().is_some_and(|one| one.contains(&start))).collect();
        let count = agree.iter().filter(|yes| **yes).count();
        if count > most {
            most = count;
            best.clear();
        }
        if count == most && !best.iter().any(|(_, known)| *known == agree) {
            best.push((start, agree));
        }
    }
    if best.is_empty() {
        best.push((Rational::ONE, vec![false; pairs.len()]));
    }
    let needed = pairs.iter().filter(|pair| !pair.expected.is_zero()).count().div_ceil(2).max(2);
    let supported = most >= needed || only_denominator.is_some();
    best.into_iter()
        .map(|(start, agree)| {
            let found = scaled(&pairs, &intervals, start.clone(), &agree);
            // What the denominator's only term sets is set to the last digit.
            let exact = || (magnitude(&start), magnitude(&start));
            let range = if only_denominator.is_some() { Some(exact()) } else { found.range.clone() };
            Scaled { needed, supported, range, ..found }
        })
        .collect()
}

/// Coefficients by power, both zero left out.
fn side_by_side(part: Part, expected: &Polynomial, written: &Polynomial) -> Vec<Coefficient> {
    (0..=expected.degree().max(written.degree()))
        .rev()
        .map(|power| {
            let (expected, written) = (expected.coefficient(power), written.coefficient(power));
            let fit = match (expected.is_zero(), written.is_zero()) {
                (false, true) => Fit::Missing,
                (true, false) => Fit::Extra,
                _ => Fit::Right,
            };
            Coefficient { part, power, expected, written, fit }
        })
        .filter(|pair| !(pair.expected.is_zero() && pair.written.is_zero()))
        .collect()
}

fn interval(pair: &Coefficient, tolerance: &Rational) -> Option<Interval> {
    if pair.fit != Fit::Right {
        return None;
    }
    let tolerance = widest(tolerance);
    let ratio = &pair.written / &pair.expected;
    let size = magnitude(&ratio);
    Some(Interval {
        low: &size / (Rational::ONE + &tolerance),
        high: size / (Rational::ONE - tolerance),
        ratio,
    })
}

/// A tolerance of 100 % or more would accept every factor, its sign included.
fn widest(tolerance: &Rational) -> Rational {
    tolerance.clone().min(Rational::from(99) / Rational::from(100))
}

/// The place of the part's only coefficient, when it is the only one expected and the only one written.
fn only_term(pairs: &[Coefficient], part: Part) -> Option<usize> {
    let mut of_part = pairs.iter().enumerate().filter(|(_, pair)| pair.part == part);
    match (of_part.next(), of_part.next()) {
        (Some((index, pair)), None) if pair.fit == Fit::Right => Some(index),
        _ => None,
    }
}

fn scaled(pairs: &[Coefficient], intervals: &[Option<Interval>], start: Rational, agree: &[bool]) -> Scaled {
    let agreeing: Vec<&Interval> =
        intervals.iter().zip(agree).filter(|(_, yes)| **yes).filter_map(|(one, _)| one.as_ref()).collect();
    // Shown with the ratio that most of them have to the last digit, else the denominator's first, else any.
    let mut factor = start;
    let mut most = 0;
    for one in agreeing.iter().rev() {
        let count = agreeing.iter().filter(|other| other.ratio == one.ratio).count();
        if count >= most && agreeing.iter().all(|other| other.contains(&one.ratio)) {
            (factor, most) = (one.ratio.clone(), count);
        }
    }
    let low = agreeing.iter().map(|one| one.low.clone()).max();
    let high = agreeing.iter().map(|one| one.high.clone()).min();
    let size = magnitude(&factor);
    let identical = intervals.iter().flatten().filter(|one| magnitude(&one.ratio) == size).count();
    let coefficients = pairs
        .iter()
        .zip(agree)
        .map(|(pair, agrees)| {
            let fit = match pair.fit {
                Fit::Right if *agrees => Fit::Right,
                Fit::Right
                    if (&factor * &pair.expected > Rational::ZERO) != (pair.written > Rational::ZERO) =>
                {
                    Fit::Sign
                }
                Fit::Right => Fit::Value,
                other => other,
            };
            Coefficient { fit, ..pair.clone() }
        })
        .collect();
    let range = low.zip(high);
    Scaled { factor, range, agreeing: agreeing.len(), identical, needed: 0, supported: false, coefficients }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;

    fn polynomial(coefficients: &str) -> Polynomial {
        Polynomial::new(coefficients.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
    }

    #[track_caller]
    fn check(expected: (&str, &str), rows: &[(&str, &str, &str, usize, &str)]) {
        let half_a_percent = parse_decimal("0.005").unwrap();
        let expected = (polynomial(expected.0), polynomial(expected.1));
        for (what, num, den, agreeing, fits) in rows {
            let written = (polynomial(num), polynomial(den));
            let found = scalings(
                (&expected.0, &expected.1),
                (&written.0, &written.1),
                (&half_a_percent, &half_a_percent),
            );
            let letters = |scaled: &Scaled| -> String {
                let letter = |c: &Coefficient| match c.fit {
                    Fit::Right => '=',
                    Fit::Sign => '-',
                    Fit::Value => '~',
                    Fit::Missing => '_',
                    Fit::Extra => '+',
                };
                let of = |part| scaled.of(part).map(letter).collect::<String>();
                format!("{}/{}", of(Part::Numerator), of(Part::Denominator))
            };
            let all: Vec<String> = found.iter().map(letters).collect();
            assert_eq!(all.join(" "), *fits, "{what}");
            assert_eq!(found[0].agreeing, *agreeing, "{what}");
        }
    }

    #[test]
    fn the_factor_is_the_one_most_coefficients_agree_on() {
        check(
            ("-0.06 0", "0.0132 0.0024 0.41202 0.05886"),
            &[
                // what it is, numerator, denominator, agreeing, fits
                ("exact", "-0.06 0", "0.0132 0.0024 0.41202 0.05886", 5, "=/===="),
                ("both signs turned", "0.06 0", "-0.0132 -0.0024 -0.41202 -0.05886", 5, "=/===="),
                ("monic", "-4.545 0", "1 0.1818 31.21 4.459", 5, "=/===="),
                ("seed: signs of two", "0.06 0", "-0.0132 -0.0024 0.4166 0.0588", 3, "=/==--"),
                ("one slip", "-0.06 0", "0.0132 0.0024 0.4166 0.05886", 4, "=/==~="),
                ("numerator's sign", "0.06 0", "0.0132 0.0024 0.41202 0.05886", 4, "-/===="),
                ("constant lost", "-0.06 0", "0.0132 0.0024 0.41202 0", 4, "=/===_"),
                ("order too high", "-0.06 0", "1 0.0132 0.0024 0.41202 0.05886", 5, "=/+===="),
                ("two and two", "-0.06 0", "0.0132 0.5 0.82404 0.3", 2, "=/=~~~"),
                ("zero", "0", "0.0132 0.0024 0.41202 0.05886", 4, "_/===="),
            ],
        );
        check(
            ("2", "1 0"),
            &[
                ("gain wrong: the denominator's only term sets the factor", "5", "1 0", 1, "~/="),
                ("gain wrong, scaled", "5", "3 0", 1, "~/="),
                ("all scaled", "6", "3 0", 2, "=/="),
            ],
        );
        check(("1 2", "1 3 5"), &[("a tie gives both readings", "1 2", "2 6 7", 2, "==/~~~ ~~/==~")]);
    }

    #[test]
    fn the_tolerance_has_two_sides() {
        check(
            ("1", "1 1"),
            &[
                ("both just inside, one up, one down", "1", "1.0049 0.9951", 3, "=/=="),
                ("1.005 · 1.005 is as far apart as two may be", "1", "1 1.01", 3, "=/=="),
                ("too far apart", "1", "1 1.0102", 2, "=/=~"),
            ],
        );
    }
}
