//! Transfer functions asked for in letters: right for every value of the letters, not only for the lab's.

use super::Evidence;
use super::accepted::Accepted;
use super::mark::Mark;
use super::scale::{Fit, Part};
use super::transfer_function::{ExactReading, read_exactly};
use crate::algebra::{Expression, Function, NodeKind, Rational};
use crate::lab::{Check, Criterion, Points, Tolerance};
use crate::model::LetterDerivation;

/// What is expected by a criterion, in letters.
pub(super) fn expected(check: &Check, derivation: &LetterDerivation) -> String {
    match check {
        Check::Numerator { .. } => format!("{}, up to a factor common to both.", shown(&derivation.num)),
        Check::Denominator { .. } => format!("{}, up to a factor common to both.", shown(&derivation.den)),
        _ => format!("The form of {}, with nothing left to cancel.", shown(&derivation.transfer_function())),
    }
}

fn shown(formula: &Expression) -> String {
    formula.to_string().replace('*', "·")
}

/// Marks in letters of all `criteria` on one transfer function, in their order; `numeric` are those by the lab's numbers.
///
/// Whether it is the derived function is decided by multiplying crosswise. What is not, or takes more than a budget, is held
/// against it at several exact places, each with other values of all letters, where the equations at rest hold: that tells
/// which criterion fails. What neither decides is marked by the lab's numbers, and left to a person.
pub(super) fn judge(
    criteria: &[&Criterion],
    derivation: &LetterDerivation,
    formula: Option<&Expression>,
    numeric: Vec<Mark>,
) -> Vec<Mark> {
    let known = derivation.letters();
    let used = formula.map(Expression::symbols).unwrap_or_default();
    let has_letters = used.iter().any(|symbol| known.contains(&symbol.name.as_str()));
    let Some(formula) = formula.filter(|_| has_letters) else {
        return numbers_only(criteria, derivation, numeric);
    };
    let formula = &derivation.with_rest(formula);
    let same = derivation.same_as(formula, variable(formula));
    let readings = readings(criteria, derivation, formula);
    // A formula can be made to agree at a few places and nowhere else.
    let seems_same = readings.iter().flatten().all(|(_, equal)| *equal);
    let decided = same == Some(true) || !seems_same;
    let unsure = has_functions(formula) || has_functions(&derivation.transfer_function());
    let marks = criteria.iter().zip(numeric).enumerate().map(|(index, (criterion, numeric))| {
        let whole = !matches!(criterion.check, Check::Structure { .. });
        let found = formula.to_string();
        let expected = expected(&criterion.check, derivation);
        // The place at which it earns least tells.
        let worst = readings.iter().flatten().map(|(reading, _)| reading);
        let worst = worst.min_by_key(|reading| reading.scores[index].1);
        let at_places = worst.is_some_and(|worst| worst.scores[index].0 == "right");
        let crosswise = same == Some(true) && numeric.code == "right" && (whole || worst.is_none());
        if at_places || crosswise {
            let reason = "It is right for every value of the letters.".to_owned();
            let right =
                Mark::right(criterion.points, Evidence { expected, found, reason, ..Evidence::default() });
            return if decided || !whole { right } else { probably(right, same) };
        }
        let Some(worst) = worst else {
            // What is wrong by the lab's numbers is not right for all others.
            return if numeric.code == "right" { left_to_a_person(numeric) } else { numeric };
        };
        let (code, earned) = worst.scores[index];
        let for_numbers = numeric.earned == criterion.points && whole;
        if for_numbers && unsure {
            return left_to_a_person(numeric);
        }
        let reason = if for_numbers {
            format!(
                "With the lab's numbers it comes out right, but not for other values of the letters. {}",
                why(code, worst, criterion, derivation)
            )
        } else {
            why(code, worst, criterion, derivation)
        };
        let evidence = Evidence { expected, found, reason, ..Evidence::default() };
        let code = if for_numbers { "letters.numbers_only" } else { code };
        if earned > Points::ZERO { Mark::partly(code, earned, evidence) } else { Mark::wrong(code, evidence) }
    });
    marks.collect()
}

/// Of an answer without any letter: its form can be judged, its coefficients are not what was asked for.
fn numbers_only(criteria: &[&Criterion], derivation: &LetterDerivation, numeric: Vec<Mark>) -> Vec<Mark> {
    let marks = criteria.iter().zip(numeric).map(|(criterion, mark)| {
        let judged = matches!(criterion.check, Check::Numerator { .. } | Check::Denominator { .. });
        if !judged || mark.code != "right" || !needs_letters(&criterion.check, derivation) {
            return mark;
        }
        let names: Vec<String> = derivation.letters().iter().map(|name| format!("`{name}`")).collect();
        let reason = format!(
            "With the lab's numbers this is right, but it was asked for in letters, so that it says what depends on what. The \
             letters that can be used are {}.",
            names.join(", ")
        );
        let expected = expected(&criterion.check, derivation);
        Mark::wrong("letters.numbers_only", Evidence { expected, reason, ..mark.evidence })
    });
    marks.collect()
}

/// Whether there are letters at all in what the criterion judges: 1 over anything is right as it is.
fn needs_letters(check: &Check, derivation: &LetterDerivation) -> bool {
    let known = derivation.letters();
    let part = match check {
        Check::Numerator { .. } => &derivation.num,
        _ => &derivation.den,
    };
    part.symbols().iter().any(|symbol| known.contains(&symbol.name.as_str()))
}

fn left_to_a_person(mark: Mark) -> Mark {
    let reason = format!(
        "{} Whether it also holds for other values of the letters could not be decided; a person will look at it.",
        mark.evidence.reason
    );
    Mark { provisional: true, evidence: Evidence { reason, ..mark.evidence }, ..mark }
}

fn probably(mark: Mark, same: Option<bool>) -> Mark {
    let but = match same {
        None => "whether for all of them could not be decided",
        Some(_) => "multiplied out it is not the same for all of them",
    };
    let reason =
        format!("It is right for several values of the letters, but {but}; a person will look at it.");
    Mark { provisional: true, evidence: Evidence { reason, ..mark.evidence }, ..mark }
}

/// Places looked at, and how many must be found.
const TRIES: usize = 12;
const PLACES: usize = 3;

/// The formula beside the derived function at several places, and whether it equals it there; `None` when it cannot be put
/// into enough of them.
fn readings(
    criteria: &[&Criterion],
    derivation: &LetterDerivation,
    formula: &Expression,
) -> Option<Vec<(ExactReading, bool)>> {
    let exact: Vec<Criterion> = criteria.iter().map(|criterion| without_tolerance(criterion)).collect();
    let exact: Vec<&Criterion> = exact.iter().collect();
    let variable = variable(formula);
    let mut found = Vec::new();
    for nth in 0..TRIES {
        let Some(place) = derivation.place(nth) else { continue };
        let Some(typed) = place.function_of(formula, variable) else { continue };
        let accepted = [Accepted { differs: &[], what: &place.function }];
        let Some(reading) = read_exactly(&exact, &accepted, &typed) else { continue };
        found.push((reading, typed.equals(&place.function)));
        if found.len() == PLACES {
            return Some(found);
        }
    }
    None
}

/// `s`, or `S` where there is no `s`.
fn variable(formula: &Expression) -> &'static str {
    if formula.symbols().iter().any(|symbol| symbol.name == "s") { "s" } else { "S" }
}

fn without_tolerance(criterion: &Criterion) -> Criterion {
    let none =
        Tolerance { absolute: Rational::ZERO, of_scale: None, relative: Rational::ZERO, figures: None };
    let mut exact = criterion.clone();
    if let Check::Numerator { tolerance, .. } | Check::Denominator { tolerance, .. } = &mut exact.check {
        *tolerance = none;
    }
    exact
}

/// Functions that are not algebraic may be equal without looking so: sin(2a) and 2 sin(a) cos(a).
fn has_functions(node: &Expression) -> bool {
    let own = matches!(&node.kind, NodeKind::Call(function, _) if !matches!(function, Function::Sqrt | Function::Abs));
    own || node.children().any(has_functions)
}

fn why(code: &str, reading: &ExactReading, criterion: &Criterion, derivation: &LetterDerivation) -> String {
    let (part, name, coefficients) = match &criterion.check {
        Check::Numerator { .. } => (Part::Numerator, "numerator", &derivation.num_coefficients),
        Check::Denominator { .. } => (Part::Denominator, "denominator", &derivation.den_coefficients),
        _ => return reading.structure.clone(),
    };
    if !reading.supported {
        return format!(
            "Too few of your coefficients stand in the proportion expected of them, so nothing in the {name} can be said to be right."
        );
    }
    let expected = |power: usize| {
        let found = coefficients.iter().find(|(known, _)| usize::try_from(*known) == Ok(power));
        found.map(|(_, coefficient)| coefficient.to_string()).unwrap_or_default()
    };
    let words: Vec<String> = reading
        .off
        .iter()
        .filter(|(known, ..)| *known == part)
        .map(|(_, power, fit)| {
            let place = super::transfer_function::place(*power);
            match fit {
                Fit::Extra => format!("The {place} should not be there."),
                Fit::Missing => format!("The {place} is missing: it should be `{}`.", expected(*power)),
                Fit::Sign => format!("The {place} has the wrong sign: it should be `{}`.", expected(*power)),
                _ => format!("The {place} should be `{}`.", expected(*power)),
            }
        })
        .collect();
    let scale =
        if words.is_empty() { "" } else { " (All up to a factor common to numerator and denominator.)" };
    match code {
        "denominator.one_slip" => {
            format!("One coefficient has a slip; the others are right. {}{scale}", words.join(" "))
        }
        _ => format!("{}{scale}", words.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Catalogue, grade};
    use super::*;
    use crate::lab::LabDefinition;
    use crate::reference::Reference;
    use crate::source::SourceText;
    use crate::submission::{NoFiles, read};

    /// Points for numerator and denominator of a tank's function, whether a person has to look, and what is said of the second.
    #[track_caller]
    fn check(formula: impl Fn(&LetterDerivation) -> String, expected: (i64, i64, bool), says: &str) {
        let text = include_str!("../../tests/it/letters.yaml");
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap();
        let reference = Reference::compute(&lab).unwrap();
        let derivation = reference.models[0].operating_points[0].letters.as_ref().unwrap();
        let formula = formula(derivation);
        let answers = format!("lab: letters\nanswers:\n  level: {formula}\n");
        let submission = read("x", "x.yaml", answers.as_bytes(), &lab.sheet, &NoFiles);
        let card = grade(&lab, &reference, &Catalogue::new(&lab, &reference), &submission, None);
        let item = |id: &str| {
            card.questions.iter().flat_map(|question| &question.items).find(|item| item.id == id).unwrap()
        };
        let (above, below) = (item("level.numerator"), item("level.denominator"));
        let provisional = above.provisional || below.provisional;
        assert_eq!(
            (above.earned.0, below.earned.0, provisional),
            expected,
            "{formula}: {above:#?} {below:#?}"
        );
        assert!(below.evidence.reason.contains(says), "{formula}: {below:#?}");
    }

    const RIGHT: &str = "1/(A*s + k/(2*sqrt(h_0)))";

    #[test]
    fn equality_is_decided_for_all_values() {
        check(|_| RIGHT.into(), (200, 200, false), "for every value");
        check(|_| format!("{RIGHT}*(A + k + h_0)^5/(A + k + h_0)^5"), (200, 200, false), "for every value");
        check(|_| "1/(A*s + k*h_0^(-1/2)/2)".into(), (200, 200, false), "for every value");
        check(|_| "1/(A*s + k/(4*sqrt(h_0)))".into(), (200, 0, false), "should be");
    }

    #[test]
    fn what_is_not_decided_is_put_before_a_person() {
        let long = "(A + k + h_0 + q_0)^25";
        check(|_| format!("{RIGHT}*{long}/{long}"), (200, 200, true), "could not be decided");
        check(|_| format!("{RIGHT}*{long}/{long}/2"), (0, 200, false), "for every value");
        let made_to_agree = |derivation: &LetterDerivation| {
            let factors = (0..PLACES).map(|nth| {
                let value = &derivation.place(nth).unwrap().values["A"];
                format!("(A - {}/{})", value.numerator(), value.denominator())
            });
            format!("{RIGHT}*(1 + {})", factors.collect::<Vec<_>>().join("*"))
        };
        check(made_to_agree, (200, 200, true), "not the same");
        check(|_| format!("{RIGHT}*sin(2*k)/(2*sin(k)*cos(k))"), (200, 200, true), "for every value");
    }
}
