//! Every variant of a lab is solvable and equally hard, its mistakes stay distinguishable, and its answers are its own.
//!
//! Linear models, poles and responses are worked out for every variant, and its mistakes are followed by estimate. What takes longer
//! (mistakes followed exactly, an answer sheet that is worked out and marked) is done for a few of them: evenly spread, the first
//! and the last among them, and for mistakes those where the estimates differ from those for the lab's own values.

use super::Check;
use super::computed_answer::{computed_answer, is_computed};
use super::mistakes::{undeclared, wrong_functions};
use crate::grading::{Catalogue, Verdict, grade};
use crate::lab::{Check as Judged, LabDefinition, Points, Variant, VariantRule};
use crate::lti::{InputKind, Limit, Pole};
use crate::reference::{LinearReference, Reference};
use crate::submission::Submission;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Variants whose mistakes are followed exactly: so many evenly spread, and so many of those that stand out by estimate.
const MOST_EXACTLY: usize = 6;
const MOST_STANDING_OUT: usize = 24;
/// Variants whose answers are worked out and marked.
const MOST_ANSWERED: usize = 6;

pub(super) fn variants_are_fair(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let Some(rule) = &lab.variants else { return Vec::new() };
    let all: Vec<Variant> = rule.all().collect();
    let looked: Vec<Result<Looked, String>> =
        all.par_iter().map(|variant| Looked::at(lab, variant)).collect();
    let place = rule.parameters.first().map(|one| one.span);
    let check = |what: &str, found: String, holds: bool| Check {
        what: format!("variants: {what}"),
        found,
        holds,
        span: if holds { None } else { place },
    };
    let failed: Vec<(&Variant, &String)> = all
        .iter()
        .zip(&looked)
        .filter_map(|(variant, looked)| Some((variant, looked.as_ref().err()?)))
        .collect();
    let mut checks = vec![match failed.first() {
        None => check("solvable", format!("all {} have right answers", all.len()), true),
        Some((variant, why)) => check(
            "solvable",
            format!("{} of {} are not, such as {}: {why}", failed.len(), all.len(), rule.words(variant)),
            false,
        ),
    }];
    let solved: Vec<(&Variant, &Looked)> = all
        .iter()
        .zip(&looked)
        .filter_map(|(variant, looked)| Some((variant, looked.as_ref().ok()?)))
        .collect();
    checks.push(equally_hard(rule, &difficulty(lab, reference), &solved, &check));
    checks.push(different(rule, &solved, &check));
    checks.push(told_apart(rule, lab, reference, &solved, &check));
    checks.push(own_answers(lab, rule, &spread(&all.iter().collect::<Vec<_>>(), MOST_ANSWERED), &check));
    checks
}

/// What a variant asks of a student, system by system, in words that are the same where it is equally hard.
#[derive(Clone, Debug, PartialEq)]
struct Looked {
    difficulty: Vec<(String, String)>,
    /// The transfer functions asked for, as text of exact fractions.
    answers: String,
    mistakes: Mistakes,
}

/// What mistakes lead to, by estimate.
#[derive(Clone, Debug, PartialEq)]
struct Mistakes {
    wrong_functions: usize,
    without_effect: BTreeSet<(String, String)>,
}

impl Mistakes {
    fn of(lab: &LabDefinition, reference: &Reference) -> Self {
        let catalogue = Catalogue::new(lab, reference);
        Self { wrong_functions: catalogue.wrong_functions(), without_effect: catalogue.without_effect() }
    }

    /// Nine tenths as many wrong functions, and no mistake without effect that has one with the lab's own values.
    fn is_like(&self, own: &Self) -> bool {
        self.wrong_functions * 10 >= own.wrong_functions * 9
            && self.without_effect.is_subset(&own.without_effect)
    }
}

impl Looked {
    fn at(lab: &LabDefinition, variant: &Variant) -> Result<Self, String> {
        let (lab, reference) = light(lab, variant)?;
        let functions = reference.models.iter().flat_map(|model| &model.operating_points).map(|point| {
            let g = point.main().linearization.transfer_function.monic();
            let both = g.num.coefficients().iter().chain(g.den.coefficients());
            both.map(ToString::to_string).collect::<Vec<_>>().join(" ")
        });
        Ok(Self {
            answers: functions.collect::<Vec<_>>().join("; "),
            difficulty: difficulty(&lab, &reference),
            mistakes: Mistakes::of(&lab, &reference),
        })
    }
}

/// The lab with a variant's values, and what is right by them.
fn light(lab: &LabDefinition, variant: &Variant) -> Result<(LabDefinition, Reference), String> {
    let lab = lab.with_variant(variant).map_err(|errors| errors.to_string())?;
    let reference = Reference::numbers(&lab).map_err(|error| error.to_string())?;
    Ok((lab, reference))
}

/// (operating point, what is hard about it), for those with a question.
fn difficulty(lab: &LabDefinition, reference: &Reference) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for model in &reference.models {
        for point in &model.operating_points {
            let name = format!("{}.{}", model.id, point.id);
            let checks = lab.questions.iter().flat_map(|question| &question.criteria).map(|one| &one.check);
            let asked: Vec<&Judged> =
                checks.filter(|check| check.system().is_some_and(|of| of.to_string() == name)).collect();
            if !asked.is_empty() {
                all.push((name, how_hard(point.main(), &asked)));
            }
        }
    }
    all
}

fn how_hard(one: &LinearReference, asked: &[&Judged]) -> String {
    let g = &one.linearization.transfer_function;
    let zero = |values: Vec<f64>| values.iter().filter(|value| **value == 0.0).count();
    let count = |poles: &[Pole], real: bool| -> usize {
        let like = poles.iter().filter(|pole| (pole.im == 0.0) == real);
        like.map(|pole| pole.multiplicity).sum()
    };
    let mut words = vec![
        format!("order {} over {}", g.num.degree(), g.den.degree()),
        format!("cancelled degree {}", one.linearization.cancelled.degree()),
        format!("{}, whole state {}", one.stability.words(), one.internal_stability.words()),
        format!("{} real and {} complex poles", count(&one.poles, true), count(&one.poles, false)),
        format!("{} different poles", one.poles.len()),
        format!(
            "{} coefficients that are 0",
            zero(
                g.num.coefficients().iter().chain(g.den.coefficients()).map(crate::algebra::to_f64).collect()
            )
        ),
    ];
    let mut responses: BTreeSet<&str> = BTreeSet::new();
    for check in asked {
        let (kind, feature) = match check {
            Judged::Feature { response, feature, .. } => (*response, Some(feature.kind)),
            Judged::Shape { response, .. } => (*response, None),
            _ => continue,
        };
        let (name, known) = match kind {
            InputKind::Impulse => ("impulse", &one.impulse),
            InputKind::Step => ("step", &one.step),
        };
        let Some(known) = known else { continue };
        let features = &known.features;
        if responses.insert(name) {
            let end = match features.final_value {
                Limit::Value(0.0) => "to 0".to_owned(),
                Limit::Value(_) => "to a value".to_owned(),
                other => other.words().to_owned(),
            };
            words.push(format!("{name} response: {}, {end}", features.shape.words()));
        }
        if let Some(feature) = feature {
            let value = crate::grading::other_variant::value(features, feature);
            let is = match value {
                None => "no number",
                Some(0.0) => "0",
                Some(_) => "a number",
            };
            words.push(format!("{name} {} is {is}", feature.words()));
        }
    }
    words.join("; ")
}

fn equally_hard(
    rule: &VariantRule,
    own: &[(String, String)],
    solved: &[(&Variant, &Looked)],
    check: &impl Fn(&str, String, bool) -> Check,
) -> Check {
    let unlike: Vec<&(&Variant, &Looked)> =
        solved.iter().filter(|(_, looked)| looked.difficulty != own).collect();
    let Some((variant, looked)) = unlike.first() else {
        let found = "the same orders, cancelled degrees, stability, kinds of poles and shapes as with the lab's own values";
        return check("equally hard", found.to_owned(), true);
    };
    let pairs = looked.difficulty.iter().zip(own);
    let differs = pairs.filter(|(theirs, own)| theirs != own).map(|((name, theirs), (_, own))| {
        let (theirs, own): (Vec<&str>, Vec<&str>) = (theirs.split("; ").collect(), own.split("; ").collect());
        let parts = theirs.iter().zip(&own).filter(|(a, b)| a != b).map(|(a, b)| format!("{a}, not {b}"));
        format!("{name}: {}", parts.collect::<Vec<_>>().join("; "))
    });
    let found = format!(
        "{} of {} are not like the lab's own, such as {}: {}",
        unlike.len(),
        solved.len(),
        rule.words(variant),
        differs.collect::<Vec<_>>().join("; ")
    );
    check("equally hard", found, false)
}

/// Told, not demanded: two variants may have the same answers, if the lab likes.
fn different(
    rule: &VariantRule,
    solved: &[(&Variant, &Looked)],
    check: &impl Fn(&str, String, bool) -> Check,
) -> Check {
    let mut known: BTreeMap<&str, &Variant> = BTreeMap::new();
    let mut twins = Vec::new();
    for (variant, looked) in solved {
        match known.get(looked.answers.as_str()) {
            Some(other) => twins.push((*other, *variant)),
            None => {
                known.insert(&looked.answers, variant);
            }
        }
    }
    let example = twins.first().map_or_else(String::new, |(one, two)| {
        format!("; the same ones for {} and for {}", rule.words(one), rule.words(two))
    });
    check("different", format!("{} different sets of transfer functions{example}", known.len()), true)
}

/// How many different wrong functions the mistakes lead to, exactly.
fn exactly(lab: &LabDefinition, variant: &Variant, known: &[String]) -> Result<usize, String> {
    let (lab, reference) = light(lab, variant)?;
    wrong_functions(&lab, &reference, known)
}

/// A variant may lose one in ten of the different wrong functions that the lab's own values have, by some coincidence of values.
fn told_apart(
    rule: &VariantRule,
    lab: &LabDefinition,
    reference: &Reference,
    solved: &[(&Variant, &Looked)],
    check: &impl Fn(&str, String, bool) -> Check,
) -> Check {
    let what = "mistakes told apart";
    let own = Mistakes::of(lab, reference);
    let mut unlike: Vec<&(&Variant, &Looked)> =
        solved.iter().filter(|(_, looked)| !looked.mistakes.is_like(&own)).collect();
    let silent = |looked: &Looked| !looked.mistakes.without_effect.is_subset(&own.without_effect);
    // Mistakes without effect first, then the fewest functions.
    unlike.sort_by_key(|(variant, looked)| (!silent(looked), looked.mistakes.wrong_functions, *variant));
    let all: Vec<&Variant> = solved.iter().map(|(variant, _)| *variant).collect();
    let mut close: BTreeSet<&Variant> = spread(&all, MOST_EXACTLY).into_iter().collect();
    close.extend(unlike.iter().take(MOST_STANDING_OUT).map(|(variant, _)| *variant));
    let close: Vec<&Variant> = close.into_iter().collect();
    let known = undeclared(lab, reference);
    let found: Vec<(&Variant, Result<usize, String>)> =
        close.par_iter().map(|variant| (*variant, exactly(lab, variant, &known))).collect();
    if let Some((variant, Err(why))) = found.iter().find(|(_, found)| found.is_err()) {
        return check(what, format!("{}: {why}", rule.words(variant)), false);
    }
    let worst = solved.iter().map(|(variant, looked)| (looked.mistakes.wrong_functions, *variant)).min();
    let Some((worst, variant)) = worst else { return check(what, "none to look at".to_owned(), true) };
    let exact_own = wrong_functions(lab, reference, &known).unwrap_or(0);
    let poorest = found.iter().filter_map(|(variant, found)| Some((found.as_ref().ok()?, *variant))).min();
    if let Some((count, variant)) = poorest.filter(|(count, _)| **count * 10 < exact_own * 9) {
        let found = format!(
            "only {count} different wrong functions with {}; {exact_own} with the lab's own values",
            rule.words(variant)
        );
        return check(what, found, false);
    }
    let found = format!(
        "in all {}, at least {worst} different wrong functions (with {}), {} with the lab's own values; {} of them followed exactly",
        solved.len(),
        rule.words(variant),
        own.wrong_functions,
        close.len(),
    );
    check(what, found, true)
}

/// A computed answer earns everything by its own values, and not by another's.
fn own_answers(
    lab: &LabDefinition,
    rule: &VariantRule,
    few: &[&Variant],
    check: &impl Fn(&str, String, bool) -> Check,
) -> Check {
    let what = "answers are one's own";
    let solved: Vec<(&Variant, LabDefinition, Reference)> = few
        .iter()
        .filter_map(|variant| {
            let (lab, reference) = light(lab, variant).ok()?;
            Some((*variant, lab, reference))
        })
        .collect();
    let mut most = Points::ZERO;
    let mut possible = Points::ZERO;
    for (place, (variant, lab, reference)) in solved.iter().enumerate() {
        let answer = computed_answer(lab, reference);
        let (earned, all, lost) = earned(lab, reference, &answer);
        if let Some(lost) = lost {
            return check(
                what,
                format!("with {} the computed answer loses {lost}", rule.words(variant)),
                false,
            );
        }
        possible = all;
        for (_, (other, other_lab, other_reference)) in
            solved.iter().enumerate().filter(|(one, _)| *one != place)
        {
            let theirs = self::earned(other_lab, other_reference, &answer).0;
            if theirs >= earned && !same_answers(reference, other_reference) {
                let found = format!(
                    "what is right with {} earns as much with {}",
                    rule.words(variant),
                    rule.words(other)
                );
                return check(what, found, false);
            }
            most = most.max(theirs);
        }
    }
    let found = format!(
        "computed answers of {} variants earn {possible} of {possible} by their own values, at most {most} by another's",
        solved.len()
    );
    check(what, found, true)
}

/// (earned, possible, the first criterion that is not right) by what is computed.
fn earned(
    lab: &LabDefinition,
    reference: &Reference,
    answer: &Submission,
) -> (Points, Points, Option<String>) {
    let card = grade(lab, reference, &Catalogue::default(), answer, None);
    let mut sum = (Points::ZERO, Points::ZERO, None);
    let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
    let items = card.questions.iter().flat_map(|question| &question.items);
    for (_, item) in criteria.zip(items).filter(|(criterion, _)| is_computed(lab, criterion)) {
        // What follows from another answer is no answer of one's own.
        if item.verdict == Verdict::Right && item.follow_through.is_none() {
            sum.0 += item.earned;
        } else if sum.2.is_none() {
            sum.2 = Some(format!("`{}` ({}): {}", item.id, item.code, item.evidence.reason));
        }
        sum.1 += item.possible;
    }
    sum
}

fn same_answers(one: &Reference, two: &Reference) -> bool {
    let functions = |reference: &Reference| -> Vec<_> {
        let points = reference.models.iter().flat_map(|model| &model.operating_points);
        points.map(|point| point.main().linearization.transfer_function.monic()).collect()
    };
    functions(one) == functions(two)
}

/// At most `most` of them, evenly spread, the first and the last among them.
fn spread<'a>(all: &[&'a Variant], most: usize) -> Vec<&'a Variant> {
    if all.len() <= most {
        return all.to_vec();
    }
    (0..most).filter_map(|number| all.get(number * (all.len() - 1) / (most - 1)).copied()).collect()
}
