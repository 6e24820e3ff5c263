use super::Evidence;
use super::accepted::{Accepted, also};
use super::closeness::{inward, magnitude, percent};
use super::mark::{Mark, half, share};
use super::scale::{self, Coefficient, Fit, Part, Scaled, scalings};
use crate::algebra::{Polynomial, Rational, polynomial_text, significant, to_f64};
use crate::english::capitalized;
use crate::lab::{Check, Criterion, Points, Tolerance};
use crate::lti::TransferFunction;
use std::cmp::Ordering;

const FIGURES: usize = 5;

/// What is expected by a criterion on a transfer function, in words.
pub(super) fn expected(check: &Check, accepted: &[Accepted<'_, TransferFunction>]) -> String {
    let Some(main) = accepted.first() else { return String::new() };
    let (polynomial, tolerance) = match check {
        Check::Numerator { tolerance, .. } => (&main.what.num, tolerance),
        Check::Denominator { tolerance, .. } => (&main.what.den, tolerance),
        _ => return format!("{}, with nothing left to cancel.", capitalized(&orders(main.what))),
    };
    format!("{}, {}.{}", text(polynomial), up_to_a_factor(tolerance), also(accepted))
}

fn up_to_a_factor(tolerance: &Tolerance) -> String {
    format!(
        "each coefficient within {}; a common factor of numerator and denominator makes no difference",
        percent(&tolerance.relative)
    )
}

/// Marks of all `criteria` on one transfer function, in their order.
///
/// The accepted parameter values, the way of reading (common factors cancelled, or as typed) and the common factor are those
/// that give the most points together: one choice for all criteria.
pub(super) fn judge(
    criteria: &[&Criterion],
    accepted: &[Accepted<'_, TransferFunction>],
    typed: &TransferFunction,
) -> Vec<Mark> {
    let best = best_reading(criteria, accepted, typed);
    let found = typed.to_text(FIGURES);
    criteria
        .iter()
        .map(|criterion| match &best {
            Some(reading) => reading.mark(criterion, accepted, found.clone()),
            None => {
                Mark::unmarked(String::new(), found.clone(), "There is no reference to compare this with.")
            }
        })
        .collect()
}

/// What a transfer function comes to, coefficient by coefficient.
pub(super) struct ExactReading {
    /// Code and points of each criterion.
    pub scores: Vec<(&'static str, Points)>,
    /// Whether enough coefficients agree on a common factor for it to mean anything.
    pub supported: bool,
    /// Coefficients that are not right: their polynomial, power and what is wrong.
    pub off: Vec<(Part, usize, Fit)>,
    /// What is to be said of its form.
    pub structure: String,
}

/// Codes and points of all `criteria`, as [`judge`] gives them, without words about numbers.
pub(super) fn read_exactly(
    criteria: &[&Criterion],
    accepted: &[Accepted<'_, TransferFunction>],
    typed: &TransferFunction,
) -> Option<ExactReading> {
    let best = best_reading(criteria, accepted, typed)?;
    let wrong = best.scaled.coefficients.iter().filter(|coefficient| coefficient.fit != Fit::Right);
    let at_origin = (best.origin != 0).then_some((
        Part::Denominator,
        best.accepted.what.den.trailing_zeros(),
        if best.origin > 0 { Fit::Missing } else { Fit::Extra },
    ));
    let structure = match best.structure() {
        "structure.not_cancelled" => {
            "Your function is of the right form once what numerator and denominator share is cancelled, but it was left in \
             both. Half the points are for cancelling it."
                .to_owned()
        }
        code => best.why_structure(code),
    };
    Some(ExactReading {
        scores: criteria.iter().map(|criterion| best.score(criterion)).collect(),
        supported: best.scaled.supported,
        off: wrong
            .map(|coefficient| (coefficient.part, coefficient.power, coefficient.fit))
            .chain(at_origin)
            .collect(),
        structure,
    })
}

fn best_reading<'a>(
    criteria: &[&Criterion],
    accepted: &[Accepted<'a, TransferFunction>],
    typed: &TransferFunction,
) -> Option<Reading<'a>> {
    let mut best: Option<(Points, Reading<'a>)> = None;
    for reading in readings(criteria, accepted, typed) {
        let points = criteria.iter().map(|criterion| reading.score(criterion).1).sum();
        let rank = |points: Points, reading: &Reading<'_>| {
            (points, reading.scaled.agreeing, reading.scaled.identical)
        };
        if best
            .as_ref()
            .is_none_or(|(most, known)| rank(points, &reading).cmp(&rank(*most, known)) == Ordering::Greater)
        {
            best = Some((points, reading));
        }
    }
    best.map(|(_, reading)| reading)
}

/// One way of seeing the student's transfer function beside one accepted one.
struct Reading<'a> {
    accepted: Accepted<'a, TransferFunction>,
    /// The student's, without its common factor.
    short: TransferFunction,
    /// That factor, monic; 1 when there was none.
    shared: Polynomial,
    /// Coefficients of what is compared: `short`, or what was typed.
    scaled: Scaled,
    /// How many factors s the denominator has too many (too few, when negative), everything else in it being right: they are
    /// left out of what is compared, so that it still tells the scale of the numerator.
    origin: isize,
}

fn readings<'a>(
    criteria: &[&Criterion],
    accepted: &[Accepted<'a, TransferFunction>],
    typed: &TransferFunction,
) -> Vec<Reading<'a>> {
    let tolerance = |wanted: Part| {
        criteria
            .iter()
            .find_map(|criterion| match &criterion.check {
                Check::Numerator { tolerance, .. } if wanted == Part::Numerator => Some(&tolerance.relative),
                Check::Denominator { tolerance, .. } if wanted == Part::Denominator => {
                    Some(&tolerance.relative)
                }
                _ => None,
            })
            .cloned()
    };
    let (num, den) = (tolerance(Part::Numerator), tolerance(Part::Denominator));
    let num_tolerance = num.clone().or_else(|| den.clone()).unwrap_or(Rational::ZERO);
    let den_tolerance = den.or(num).unwrap_or(Rational::ZERO);

    let mut typed_ways = vec![typed.clone()];
    typed_ways.extend(without_residue(typed));
    let mut all = Vec::new();
    for way in typed_ways {
        // Nothing over a denominator is nothing: the denominator as typed still says more than 1 would.
        let (short, shared) =
            if way.num.is_zero() { (way.clone(), Polynomial::one()) } else { way.cancelled() };
        for one in accepted {
            let written = if shared.degree() == 0 { vec![&short] } else { vec![&short, &way] };
            for written in written {
                let scalings = scalings(
                    (&one.what.num, &one.what.den),
                    (&written.num, &written.den),
                    (&num_tolerance, &den_tolerance),
                );
                let reading = |(scaled, origin)| Reading {
                    accepted: *one,
                    short: short.clone(),
                    shared: shared.clone(),
                    scaled,
                    origin,
                };
                all.extend(scalings.into_iter().map(|scaled| reading((scaled, 0))));
                if let Some((den, origin)) = at_the_origin_of(&one.what.den, &written.den) {
                    let moved = scale::scalings(
                        (&one.what.num, &one.what.den),
                        (&written.num, &den),
                        (&num_tolerance, &den_tolerance),
                    );
                    let right = moved.into_iter().filter(|scaled| scaled.is_right(Part::Denominator));
                    all.extend(right.map(|scaled| reading((scaled, origin))));
                }
            }
        }
    }
    all
}

/// `written` with as many factors s as `expected` has, and how many were too many; `None` when it has just as many, or
/// nothing but powers of s was expected: of these any is right up to a factor.
fn at_the_origin_of(expected: &Polynomial, written: &Polynomial) -> Option<(Polynomial, isize)> {
    let (want, have) = (expected.trailing_zeros(), written.trailing_zeros());
    if want == have || want == expected.degree() || written.is_zero() {
        return None;
    }
    let power = |count: usize| Polynomial::monomial(Rational::ONE, count);
    let moved =
        if want > have { written * &power(want - have) } else { written.exact_quotient(&power(have - want)) };
    Some((moved, isize::try_from(have).ok()? - isize::try_from(want).ok()?))
}

/// Without coefficients below 1e-12 of the largest of their polynomial, which programs leave behind where they mean 0;
/// `None` when there are none.
pub(super) fn without_residue(typed: &TransferFunction) -> Option<TransferFunction> {
    let limit = Rational::from(10).pow(-12);
    let clean = |polynomial: &Polynomial| {
        let coefficients = polynomial.coefficients();
        let largest = coefficients.iter().map(magnitude).max().unwrap_or(Rational::ZERO) * &limit;
        let kept = |c: &Rational| if magnitude(c) <= largest { Rational::ZERO } else { c.clone() };
        Polynomial::new(coefficients.iter().map(kept).collect())
    };
    let cleaned = TransferFunction::new(clean(&typed.num), clean(&typed.den))?;
    (cleaned != *typed).then_some(cleaned)
}

impl Reading<'_> {
    fn score(&self, criterion: &Criterion) -> (&'static str, Points) {
        let points = criterion.points;
        match &criterion.check {
            Check::Structure { .. } => match self.structure() {
                "right" => ("right", points),
                "structure.not_cancelled" => ("structure.not_cancelled", share(points, &half())),
                code => (code, Points::ZERO),
            },
            Check::Numerator { .. } => match self.numerator() {
                "right" => ("right", points),
                code => (code, Points::ZERO),
            },
            Check::Denominator { one_slip, .. } => match self.denominator() {
                "right" => ("right", points),
                "denominator.one_slip" => ("denominator.one_slip", share(points, one_slip)),
                code => (code, Points::ZERO),
            },
            _ => ("unmarked", Points::ZERO),
        }
    }

    fn structure(&self) -> &'static str {
        let (want, have) = (self.accepted.what, &self.short);
        let degrees = |g: &TransferFunction| (g.num.degree(), g.den.degree());
        let at_origin = |g: &TransferFunction| (g.num.trailing_zeros(), g.den.trailing_zeros());
        if have.num.is_zero() && !want.num.is_zero() {
            "structure.zero"
        } else if degrees(want) == degrees(have) && at_origin(want) == at_origin(have) {
            if self.shared.degree() == 0 { "right" } else { "structure.not_cancelled" }
        } else if degrees(want) == (have.den.degree(), have.num.degree())
            && degrees(want).0 != degrees(want).1
        {
            "structure.inverted"
        } else if degrees(want) == degrees(have) {
            "structure.origin"
        } else {
            "structure.order"
        }
    }

    fn numerator(&self) -> &'static str {
        if self.scaled.is_right(Part::Numerator) {
            return "right";
        }
        match self.worst(Part::Numerator) {
            Worst::Terms => "numerator.terms",
            Worst::Sign => "numerator.sign",
            Worst::Value => "numerator.value",
        }
    }

    fn denominator(&self) -> &'static str {
        if self.origin != 0 {
            return "denominator.terms";
        }
        if self.scaled.is_right(Part::Denominator) {
            return "right";
        }
        let off = self.scaled.of(Part::Denominator).filter(|c| c.fit != Fit::Right).count();
        match self.worst(Part::Denominator) {
            Worst::Terms => "denominator.terms",
            Worst::Sign => "denominator.sign",
            Worst::Value if off == 1 && self.scaled.supported => "denominator.one_slip",
            Worst::Value => "denominator.value",
        }
    }

    fn worst(&self, part: Part) -> Worst {
        let has = |fit: Fit| self.scaled.of(part).any(|coefficient| coefficient.fit == fit);
        if has(Fit::Missing) || has(Fit::Extra) {
            Worst::Terms
        } else if has(Fit::Sign) && self.scaled.supported {
            Worst::Sign
        } else {
            Worst::Value
        }
    }

    fn mark(
        &self,
        criterion: &Criterion,
        accepted: &[Accepted<'_, TransferFunction>],
        found: String,
    ) -> Mark {
        let (code, earned) = self.score(criterion);
        let (expected, reason) = match &criterion.check {
            Check::Structure { .. } => (expected(&criterion.check, accepted), self.why_structure(code)),
            Check::Numerator { tolerance, .. } => self.why(Part::Numerator, tolerance, code, accepted),
            Check::Denominator { tolerance, .. } => self.why(Part::Denominator, tolerance, code, accepted),
            _ => {
                return Mark::unmarked(
                    String::new(),
                    found,
                    "This is not a question about a transfer function.",
                );
            }
        };
        let evidence = Evidence { expected, found, reason, ..Evidence::default() };
        match code {
            "right" => Mark::right(earned, evidence),
            "structure.not_cancelled" | "denominator.one_slip" => Mark::partly(code, earned, evidence),
            _ => Mark::wrong(code, evidence),
        }
    }

    fn why_structure(&self, code: &str) -> String {
        let yours = orders(&self.short);
        match code {
            "right" => "Both degrees are right, and so is what lies at the origin.".to_owned(),
            "structure.not_cancelled" => format!(
                "Your function is of the right form once the common factor {} is cancelled, but it was left in the numerator \
                 and in the denominator. Half the points are for cancelling it.",
                text(&self.shared)
            ),
            "structure.zero" => "Your transfer function is zero: its output never moves.".to_owned(),
            "structure.inverted" => format!("Yours is upside down: it has {yours}."),
            "structure.origin" => {
                format!("The orders are right, but not what stands at the origin: yours has {yours}.")
            }
            _ => format!("Yours has {yours}."),
        }
    }

    /// Expected in the student's own scale, and why.
    fn why(
        &self,
        part: Part,
        tolerance: &Tolerance,
        code: &str,
        accepted: &[Accepted<'_, TransferFunction>],
    ) -> (String, String) {
        let polynomial = match part {
            Part::Numerator => &self.accepted.what.num,
            Part::Denominator => &self.accepted.what.den,
        };
        let name = match part {
            Part::Numerator => "numerator",
            Part::Denominator => "denominator",
        };
        if !self.scaled.supported {
            let expected = format!("{}, {}.{}", text(polynomial), up_to_a_factor(tolerance), also(accepted));
            let agreeing = match self.scaled.agreeing {
                0 | 1 => "No two of your coefficients stand".to_owned(),
                several => {
                    format!(
                        "Only {several} of your coefficients (of the {} needed) stand",
                        self.scaled.needed
                    )
                }
            };
            let reason = format!(
                "{agreeing} in the proportion expected of them, so nothing in the {name} can be said to be right."
            );
            return (expected, reason);
        }
        let scale = if self.scaled.factor == Rational::ONE { "" } else { " in your scale" };
        // What else would have been right is of no use to who has it right, or has chosen.
        let chosen = code == "right" || !self.accepted.differs.is_empty();
        let others = if chosen { String::new() } else { also(accepted) };
        let expected = format!(
            "{}{scale}{}, each coefficient within {}.{others}",
            text(&polynomial.scale(&self.scaled.factor)),
            self.accepted.with(),
            percent(&tolerance.relative)
        );
        let wrong: Vec<_> = self
            .scaled
            .of(part)
            .filter(|coefficient| coefficient.fit != Fit::Right)
            .map(|coefficient| self.say(coefficient, &tolerance.relative))
            .collect();
        let reason = match code {
            "denominator.terms" if self.origin != 0 => format!(
                "There {} in it; everything else in it is right.",
                match self.origin {
                    1 => "is one factor s too many".to_owned(),
                    -1 => "is one factor s too few".to_owned(),
                    many @ 2.. => format!("are {many} factors s too many"),
                    few => format!("are {} factors s too few", few.unsigned_abs()),
                }
            ),
            "right" if self.scaled.factor == Rational::ONE => {
                format!("Each coefficient of the {name} is within {}.", percent(&tolerance.relative))
            }
            "right" => format!(
                "Each coefficient of the {name} is within {} in your scale, which is {} times the reference's.",
                percent(&tolerance.relative),
                number(&self.scaled.factor)
            ),
            "denominator.one_slip" => {
                format!("One coefficient has a slip; the others are right. {}", wrong.join(" "))
            }
            _ => wrong.join(" "),
        };
        (expected, reason)
    }

    fn say(&self, coefficient: &Coefficient, tolerance: &Rational) -> String {
        let should = &self.scaled.factor * &coefficient.expected;
        let place = place(coefficient.power);
        let (written, expected) = (number(&coefficient.written), number(&should));
        match coefficient.fit {
            Fit::Right => String::new(),
            Fit::Extra => format!("The {place} ({written}) should not be there."),
            Fit::Missing => {
                format!(
                    "The {place} is missing: it should be {expected}{}.",
                    self.interval(coefficient, tolerance)
                )
            }
            Fit::Sign => {
                let off = magnitude(&(&coefficient.written + &should)) > magnitude(&(&should * tolerance));
                let digits = if off { ", and its digits are off" } else { "" };
                format!("The {place} has the wrong sign{digits}: {written} was written, {expected} expected.")
            }
            Fit::Value => {
                let by = (&coefficient.written - &should) / &should;
                format!(
                    "The {place} is {written} where {expected} was expected, off by {}{}.",
                    percent(&magnitude(&by)),
                    self.interval(coefficient, tolerance)
                )
            }
        }
    }
}

impl Reading<'_> {
    /// `; accepted from -0.4158 to -0.4075 in your scale`, as long as the coefficients that are right stay as they are.
    fn interval(&self, coefficient: &Coefficient, tolerance: &Rational) -> String {
        let shown = self.scaled.accepted(coefficient, tolerance).and_then(|(low, high)| {
            let width = (&high - &low) / Rational::from(2);
            inward(&low, &high, &width)
        });
        let scale = if self.scaled.factor == Rational::ONE { "" } else { " in your scale" };
        shown.map_or_else(String::new, |(low, high)| format!("; accepted from {low} to {high}{scale}"))
    }
}

/// What is wrong with a polynomial, the gravest first.
enum Worst {
    Terms,
    Sign,
    Value,
}

/// `a numerator of degree 1 with a zero at the origin over a denominator of degree 3`.
fn orders(g: &TransferFunction) -> String {
    if g.num.is_zero() {
        return format!("a zero numerator over a denominator of degree {}", g.den.degree());
    }
    let origin = |count: usize, what: &str| match count {
        0 => String::new(),
        1 => format!(" with a {what} at the origin"),
        many => format!(" with {many} {what}s at the origin"),
    };
    format!(
        "a numerator of degree {}{} over a denominator of degree {}{}",
        g.num.degree(),
        origin(g.num.trailing_zeros(), "zero"),
        g.den.degree(),
        origin(g.den.trailing_zeros(), "pole")
    )
}

fn text(polynomial: &Polynomial) -> String {
    polynomial_text(polynomial, "s", FIGURES)
}

fn number(value: &Rational) -> String {
    significant(to_f64(value), FIGURES)
}

pub(super) fn place(power: usize) -> String {
    match power {
        0 => "constant term".to_owned(),
        1 => "coefficient of s".to_owned(),
        power => format!("coefficient of s^{power}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::lab::SystemRef;
    use crate::source::Span;
    use proptest::prelude::*;

    fn polynomial(coefficients: &str) -> Polynomial {
        Polynomial::new(coefficients.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
    }

    fn function(num: &str, den: &str) -> TransferFunction {
        TransferFunction::new(polynomial(num), polynomial(den)).unwrap()
    }

    fn criteria() -> Vec<Criterion> {
        let of = SystemRef { model: "cart".into(), operating_point: "hanging".into() };
        let tolerance = Tolerance {
            absolute: Rational::ZERO,
            of_scale: None,
            relative: parse_decimal("0.005").unwrap(),
            figures: None,
        };
        let check = |points, check| Criterion {
            id: String::new(),
            title: String::new(),
            points: Points(points),
            field: "g".into(),
            follow_through: Rational::ONE,
            check,
            span: Span::default(),
        };
        vec![
            check(100, Check::Structure { of: of.clone() }),
            check(200, Check::Numerator { of: of.clone(), tolerance: tolerance.clone() }),
            check(200, Check::Denominator { of, tolerance, one_slip: half() }),
        ]
    }

    fn marks(references: &[(&str, TransferFunction)], typed: &TransferFunction) -> Vec<Mark> {
        let differs: Vec<Vec<_>> =
            references
                .iter()
                .map(|(g, _)| {
                    if g.is_empty() { vec![] } else { vec![("g".to_owned(), (*g).to_owned(), Rational::ONE)] }
                })
                .collect();
        let accepted: Vec<_> =
            references.iter().zip(&differs).map(|((_, what), differs)| Accepted { differs, what }).collect();
        let criteria = criteria();
        judge(&criteria.iter().collect::<Vec<_>>(), &accepted, typed)
    }

    /// The cart, hanging: as computed, and with the accepted values of g.
    fn hanging() -> Vec<(&'static str, TransferFunction)> {
        vec![
            ("", function("-0.06 0", "0.0132 0.0024 0.41202 0.05886")),
            ("9.8", function("-0.06 0", "0.0132 0.0024 0.4116 0.0588")),
            ("10", function("-0.06 0", "0.0132 0.0024 0.42 0.06")),
        ]
    }

    fn upright() -> Vec<(&'static str, TransferFunction)> {
        vec![
            ("", function("0.06 0", "0.0132 0.0024 -0.41202 -0.05886")),
            ("9.8", function("0.06 0", "0.0132 0.0024 -0.4116 -0.0588")),
            ("10", function("0.06 0", "0.0132 0.0024 -0.42 -0.06")),
        ]
    }

    /// What it is, numerator, denominator, and points and code of structure, numerator and denominator.
    type Row<'a> = (&'a str, &'a str, &'a str, [(i64, &'a str); 3]);

    #[track_caller]
    fn check(references: &[(&str, TransferFunction)], rows: &[Row<'_>]) {
        for (what, num, den, want) in rows {
            let marks = marks(references, &function(num, den));
            let found: Vec<_> = marks.iter().map(|mark| (mark.earned.0, mark.code)).collect();
            let reasons: Vec<_> = marks.iter().map(|mark| mark.evidence.reason.clone()).collect();
            assert_eq!(found, want, "{what}: {reasons:#?}");
        }
    }

    const S: (i64, &str) = (100, "right");
    const R: (i64, &str) = (200, "right");

    /// What is right of a function with a factor s lost or added keeps its marks.
    #[test]
    fn a_factor_s_too_many_or_too_few() {
        const WRONG: (i64, &str) = (0, "denominator.terms");
        const ORDER: (i64, &str) = (0, "structure.order");
        check(
            &[("", function("2 3", "0.5 4 7 0"))],
            &[
                ("exact", "2 3", "0.5 4 7 0", [S, R, R]),
                ("the integrator lost", "2 3", "0.5 4 7", [ORDER, R, WRONG]),
                ("lost, in another scale", "4 6", "1 8 14", [ORDER, R, WRONG]),
                ("lost, and the numerator off", "2 5", "0.5 4 7", [ORDER, (0, "numerator.value"), WRONG]),
                ("twice", "2 3", "0.5 4 7 0 0", [ORDER, R, WRONG]),
                ("lost, and a slip beside it", "2 3", "0.5 4 9", [ORDER, (0, "numerator.value"), WRONG]),
            ],
        );
        check(
            &[("", function("2", "0.5 4"))],
            &[("an integrator too many", "2", "0.5 4 0", [ORDER, R, WRONG])],
        );
        let hanging = [("", function("-0.06 0", "0.0132 0.0024 0.41202 0.05886"))];
        check(
            &hanging,
            &[
                (
                    "its zero lost",
                    "-0.06",
                    "0.0132 0.0024 0.41202 0.05886",
                    [ORDER, (0, "numerator.terms"), R],
                ),
                (
                    "its zero cancelled by a pole",
                    "-0.06 0",
                    "0.0132 0.0024 0.41202 0.05886 0",
                    [ORDER, R, WRONG],
                ),
            ],
        );
    }

    #[test]
    fn the_pendulum_hanging() {
        let (num, den) = ("-0.06 0", "0.0132 0.0024 0.41202 0.05886");
        check(
            &hanging(),
            &[
                // what it is, numerator, denominator, structure, numerator, denominator
                ("exact", num, den, [S, R, R]),
                ("g = 9.8", num, "0.0132 0.0024 0.4116 0.0588", [S, R, R]),
                ("g = 10", num, "0.0132 0.0024 0.42 0.06", [S, R, R]),
                ("three figures", num, "0.0132 0.0024 0.412 0.0589", [S, R, R]),
                ("monic, three figures", "-4.55 0", "1 0.182 31.2 4.46", [S, R, R]),
                ("both signs turned", "0.06 0", "-0.0132 -0.0024 -0.41202 -0.05886", [S, R, R]),
                (
                    "s not cancelled",
                    "-0.06 0 0",
                    "0.0132 0.0024 0.41202 0.05886 0",
                    [(50, "structure.not_cancelled"), R, R],
                ),
                (
                    "s + 2 not cancelled",
                    "-0.06 -0.12 0",
                    "0.0132 0.0288 0.41682 0.8829 0.11772",
                    [(50, "structure.not_cancelled"), R, R],
                ),
                ("a program's residue", "-0.06 1e-16", den, [S, R, R]),
                (
                    "seed: signs of two and a slip",
                    "0.06 0",
                    "-0.0132 -0.0024 0.4166 0.0588",
                    [S, R, (0, "denominator.sign")],
                ),
                (
                    "upright's denominator",
                    num,
                    "0.0132 0.0024 -0.41202 -0.05886",
                    [S, R, (0, "denominator.sign")],
                ),
                ("friction's signs", num, "0.0132 -0.0024 0.41202 -0.05886", [S, R, (0, "denominator.sign")]),
                ("numerator's sign", "0.06 0", den, [S, (0, "numerator.sign"), R]),
                ("numerator's value", "-0.6 0", den, [S, (0, "numerator.value"), R]),
                ("one slip", num, "0.0132 0.0024 0.4166 0.05886", [S, R, (100, "denominator.one_slip")]),
                ("one slip, monic", "-4.545 0", "1 0.1818 31.21 4.54", [S, R, (100, "denominator.one_slip")]),
                (
                    "slip and numerator",
                    "-0.3 0",
                    "0.0132 0.0024 0.4166 0.05886",
                    [S, (0, "numerator.value"), (100, "denominator.one_slip")],
                ),
                (
                    "one sign is no slip",
                    num,
                    "0.0132 0.0024 0.41202 -0.05886",
                    [S, R, (0, "denominator.sign")],
                ),
                ("two slips", num, "0.0132 0.0042 0.4166 0.05886", [S, R, (0, "denominator.value")]),
                (
                    "constant lost",
                    num,
                    "0.0132 0.0024 0.41202 0",
                    [(0, "structure.order"), R, (0, "denominator.terms")],
                ),
                ("no zero at the origin", "-0.06", den, [(0, "structure.order"), (0, "numerator.terms"), R]),
                (
                    "a constant too many",
                    "-0.06 0.1",
                    den,
                    [(0, "structure.origin"), (0, "numerator.terms"), R],
                ),
                (
                    "order too high",
                    num,
                    "1 0.0132 0.0024 0.41202 0.05886",
                    [(0, "structure.order"), R, (0, "denominator.terms")],
                ),
                (
                    "upside down",
                    den,
                    num,
                    [(0, "structure.inverted"), (0, "numerator.terms"), (0, "denominator.terms")],
                ),
                (
                    "nothing",
                    "0",
                    "1",
                    [(0, "structure.zero"), (0, "numerator.terms"), (0, "denominator.terms")],
                ),
                (
                    "a number",
                    "5",
                    "1",
                    [(0, "structure.order"), (0, "numerator.terms"), (0, "denominator.terms")],
                ),
                // Two of five that agree with each other may do so by chance.
                (
                    "two terms",
                    "-0.06 0",
                    "0.41202 0",
                    [(0, "structure.order"), (0, "numerator.value"), (0, "denominator.terms")],
                ),
                (
                    "two of five agree",
                    num,
                    "0.0132 0.0042 0.5 0.07",
                    [S, (0, "numerator.value"), (0, "denominator.value")],
                ),
                // Any numerator agrees with itself: that alone proves nothing.
                ("all wrong", "7 0", "1 2 3 4", [S, (0, "numerator.value"), (0, "denominator.value")]),
                ("a mix of g", num, "0.0132 0.0024 0.4116 0.06", [S, R, (100, "denominator.one_slip")]),
            ],
        );
    }

    #[test]
    fn the_pendulum_upright() {
        check(
            &upright(),
            &[
                (
                    "seed: 0.4166 for 0.4116",
                    "0.06 0",
                    "0.0132 0.0024 -0.4166 -0.0588",
                    [S, R, (100, "denominator.one_slip")],
                ),
                (
                    "cos π forgotten once",
                    "0.06 0",
                    "0.0204 0.0024 -0.41202 -0.05886",
                    [S, R, (100, "denominator.one_slip")],
                ),
            ],
        );
        let seed = marks(&upright(), &function("0.06 0", "0.0132 0.0024 -0.4166 -0.0588"));
        assert_eq!(
            seed[2].evidence.reason,
            "One coefficient has a slip; the others are right. The coefficient of s is -0.4166 where -0.4116 was \
             expected, off by 1.21 %; accepted from -0.41573 to -0.40751."
        );
        assert!(seed[2].evidence.expected.contains("with g = 9.8"), "{}", seed[2].evidence.expected);
    }

    #[test]
    fn both_sides_of_the_tolerance() {
        // All but one coefficient agree exactly, so that one alone may be off by up to 1.005 / 0.995.
        let row = |den| ("-0.06 0", den);
        for ((num, den), code) in [
            (row("0.0132 0.0024 0.4161 0.05886"), "right"),
            (row("0.0132 0.0024 0.41616 0.05886"), "right"),
            (row("0.0132 0.0024 0.41617 0.05886"), "denominator.one_slip"),
            (row("0.0132 0.0024 0.40793 0.05886"), "right"),
            (row("0.0132 0.0024 0.40791 0.05886"), "denominator.one_slip"),
        ] {
            let marks = marks(&hanging()[..1], &function(num, den));
            assert_eq!(marks[2].code, code, "{den}: {}", marks[2].evidence.reason);
        }
    }

    /// Both ends that are told are accepted, and the next decimal beyond each is not.
    #[test]
    fn the_interval_told_is_the_one_decided() {
        for (what, num, den, told, beyond) in [
            (
                "in the reference's scale",
                "-0.06 0",
                "0.0132 0.0024 X 0.05886",
                "0.40793 0.41616",
                "0.40792 0.41617",
            ),
            ("turned", "0.06 0", "-0.0132 -0.0024 X -0.05886", "-0.41616 -0.40793", "-0.41617 -0.40792"),
            // The others are rounded, and leave the factor less room.
            ("monic", "-4.545 0", "1 0.1818 X 4.459", "30.904 31.524", "30.903 31.525"),
            (
                "of the numerator",
                "X 0",
                "0.0132 0.0024 0.41202 0.05886",
                "-0.0606 -0.05941",
                "-0.06061 -0.05940",
            ),
        ] {
            let with = |text: &str| function(&num.replace('X', text), &den.replace('X', text));
            let wrong = marks(&hanging()[..1], &with(if told.starts_with('-') { "-3" } else { "3" }));
            let (low, high) = told.split_once(' ').unwrap();
            let part = if num.starts_with('X') { 1 } else { 2 };
            let reason = &wrong[part].evidence.reason;
            assert!(reason.contains(&format!("accepted from {low} to {high}")), "{what}: {reason}");
            for end in told.split(' ') {
                assert_eq!(marks(&hanging()[..1], &with(end))[part].code, "right", "{what}: {end}");
            }
            for end in beyond.split(' ') {
                assert_ne!(marks(&hanging()[..1], &with(end))[part].code, "right", "{what}: {end}");
            }
        }
    }

    #[test]
    fn small_systems() {
        let motor = vec![("", function("0.2083", "1 1.71"))];
        check(
            &motor,
            &[
                ("exact", "0.2083", "1 1.71", [S, R, R]),
                ("by time constant", "0.12181", "0.5848 1", [S, R, R]),
                ("gain wrong", "0.3", "1 1.71", [S, (0, "numerator.value"), R]),
                ("pole slipped", "0.2083", "1 2", [S, R, (100, "denominator.one_slip")]),
                ("pole mirrored", "0.2083", "1 -1.71", [S, R, (0, "denominator.sign")]),
                ("all wrong", "5", "1 2", [S, (0, "numerator.value"), (0, "denominator.value")]),
            ],
        );
        let integrator = vec![("", function("2", "1 0"))];
        check(
            &integrator,
            &[
                ("exact", "4", "2 0", [S, R, R]),
                // s is s, whatever stands above it
                ("gain wrong", "5", "1 0", [S, (0, "numerator.value"), R]),
                (
                    "double",
                    "2",
                    "1 0 0",
                    [(0, "structure.order"), (0, "numerator.value"), (0, "denominator.terms")],
                ),
            ],
        );
    }

    fn earned(references: &[(&str, TransferFunction)], typed: &TransferFunction) -> i64 {
        marks(references, typed).iter().map(|mark| mark.earned.0).sum()
    }

    fn decimal() -> impl Strategy<Value = Rational> {
        (1i64..99_999, 0isize..8, any::<bool>()).prop_map(|(digits, places, negative)| {
            let value = Rational::from(digits) / Rational::from(10).pow(places);
            if negative { -value } else { value }
        })
    }

    /// The reference with some coefficients replaced.
    fn spoiled() -> impl Strategy<Value = (Vec<Rational>, Vec<(usize, Rational)>)> {
        let exact: Vec<Rational> = ["-0.06", "0.0132", "0.0024", "0.41202", "0.05886"]
            .iter()
            .map(|c| parse_decimal(c).unwrap())
            .collect();
        (Just(exact), prop::collection::vec((0usize..5, decimal()), 0..6))
    }

    fn build(c: &[Rational]) -> TransferFunction {
        TransferFunction::new(
            Polynomial::new(vec![c[0].clone(), Rational::ZERO]),
            Polynomial::new(c[1..].to_vec()),
        )
        .unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn a_common_factor_changes_nothing((exact, changes) in spoiled(), factor in decimal()) {
            let mut coefficients = exact;
            for (place, value) in changes {
                coefficients[place] = value;
            }
            let scaled: Vec<_> = coefficients.iter().map(|c| c * &factor).collect();
            let points = |c: &[Rational]| -> Vec<_> {
                marks(&hanging(), &build(c)).iter().map(|mark| (mark.earned, mark.code)).collect()
            };
            prop_assert_eq!(points(&coefficients), points(&scaled));
        }

        #[test]
        fn mending_a_coefficient_never_costs_a_mark((exact, changes) in spoiled()) {
            // Changed one after the other, mended in the reverse order; g as in the lab, so that there is one truth.
            let references = &hanging()[..1];
            let mut steps = vec![exact.clone()];
            for (place, value) in changes {
                let mut next = steps[steps.len() - 1].clone();
                // A coefficient is spoiled once: mending it makes it right again.
                if next[place] == exact[place] {
                    next[place] = value;
                    steps.push(next);
                }
            }
            // While most coefficients still stand in the reference's own proportion, that is the student's scale.
            let held = steps.iter().take(3);
            let points: Vec<i64> = held.map(|c| earned(references, &build(c))).collect();
            for pair in points.windows(2) {
                prop_assert!(pair[0] >= pair[1], "{points:?}");
            }
        }

        #[test]
        fn an_uncancelled_factor_costs_half_the_structure(root in -9i64..9) {
            prop_assume!(root != 0);
            let factor = Polynomial::from_integers(&[1, root]);
            let whole = build(&["-0.06", "0.0132", "0.0024", "0.41202", "0.05886"].map(|c| parse_decimal(c).unwrap()));
            let typed = TransferFunction::new(&whole.num * &factor, &whole.den * &factor).unwrap();
            prop_assert_eq!(earned(&hanging(), &typed), 450);
        }
    }
}
