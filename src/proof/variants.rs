//! Every variant of a lab is solvable and equally hard, its mistakes stay distinguishable, and its answers are its own.
//!
//! Linear models, poles and responses are worked out for every variant. What takes longer (comparisons with the nonlinear
//! equations, the catalogue of mistakes, an answer sheet that is worked out and marked) is done for a few of them: every one when
//! there are no more than [`MOST_CLOSELY`], else so many, evenly spread, the first and the last among them.

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

/// Variants that are looked at closely.
pub const MOST_CLOSELY: usize = 24;
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
    let close: Vec<&Variant> = spread(&all, MOST_CLOSELY);
    let known = undeclared(lab, reference);
    let closely: Vec<(&Variant, Result<usize, String>)> =
        close.par_iter().map(|variant| (*variant, closely(lab, variant, &known))).collect();
    checks.push(told_apart(rule, lab, reference, &closely, all.len(), &check));
    checks.push(own_answers(lab, rule, &spread(&all, MOST_ANSWERED), &check));
    checks
}

/// What a variant asks of a student, system by system, in words that are the same where it is equally hard.
#[derive(Clone, Debug, PartialEq)]
struct Looked {
    difficulty: Vec<(String, String)>,
    /// The transfer functions asked for, as text of exact fractions.
    answers: String,
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
            words.push(format!("{name} response a {}, {end}", features.shape.words()));
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

/// The whole reference, and how many different wrong functions its mistakes lead to.
fn closely(lab: &LabDefinition, variant: &Variant, known: &[String]) -> Result<usize, String> {
    let lab = lab.with_variant(variant).map_err(|errors| errors.to_string())?;
    let reference = Reference::compute(&lab).map_err(|error| error.to_string())?;
    wrong_functions(&lab, &reference, known)
}

/// A variant may lose one in ten of the different wrong functions that the lab's own values have, by some coincidence of values.
fn told_apart(
    rule: &VariantRule,
    lab: &LabDefinition,
    reference: &Reference,
    closely: &[(&Variant, Result<usize, String>)],
    all: usize,
    check: &impl Fn(&str, String, bool) -> Check,
) -> Check {
    let what = "mistakes told apart";
    if let Some((variant, Err(why))) = closely.iter().find(|(_, found)| found.is_err()) {
        return check(what, format!("{}: {why}", rule.words(variant)), false);
    }
    let own = wrong_functions(lab, reference, &undeclared(lab, reference)).unwrap_or(0);
    let worst = closely.iter().filter_map(|(variant, found)| Some((found.as_ref().ok()?, *variant)));
    let Some((worst, variant)) = worst.min() else { return check(what, "none to look at".to_owned(), true) };
    let amount = if closely.len() == all {
        format!("in all {all}")
    } else {
        format!("in {} of {all}, evenly spread", closely.len())
    };
    let found = format!(
        "{amount}, at least {worst} different wrong functions (with {}); {own} with the lab's own values",
        rule.words(variant)
    );
    check(what, found, worst * 10 >= own * 9)
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
fn spread(all: &[Variant], most: usize) -> Vec<&Variant> {
    if all.len() <= most {
        return all.iter().collect();
    }
    (0..most).filter_map(|number| all.get(number * (all.len() - 1) / (most - 1))).collect()
}
