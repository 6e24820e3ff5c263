//! Whether answers that are wrong for a student's own numbers are right for those of another student. For the instructor alone:
//! it changes no mark and stands on no student's page.

use super::accepted::{coefficient_tolerance, operating_point};
use super::{ItemScore, Scorecard, Verdict};
use crate::algebra::{Polynomial, to_f64};
use crate::lab::{Check, Criterion, FeatureKind, LabDefinition};
use crate::lti::{Features, InputKind, Limit};
use crate::reference::{LinearReference, Reference};
use crate::submission::{AnswerValue, FinalValue, Submission};
use std::collections::{BTreeMap, BTreeSet};

/// The numbers of an answer, in a fixed order for each field: coefficients, poles of the upper half-plane, a value.
pub type Numbers = BTreeMap<String, Vec<f64>>;

/// A wrong number is taken to lie anywhere within a factor of ten of the right one, evenly on a logarithmic scale: the part of
/// that range that is within the tolerance on both sides of some other number, for a tolerance of 1.
const PART: f64 = 2.0 / (2.0 * std::f64::consts::LN_10);

/// Chance agreements likelier than this are not told.
pub const LIKELIEST_CHANCE: f64 = 0.05;

/// What the criteria of `lab` that differ from student to student take for right, for the values `lab` has.
pub fn right_numbers(lab: &LabDefinition, reference: &Reference) -> Numbers {
    let mut numbers = Numbers::new();
    for criterion in varied(lab) {
        if let Some(right) = right(reference, criterion) {
            numbers.insert(criterion.field.clone(), right);
        }
    }
    numbers
}

/// The same of what was answered.
pub fn typed_numbers(lab: &LabDefinition, submission: &Submission) -> Numbers {
    let mut numbers = Numbers::new();
    for criterion in varied(lab) {
        let answer = submission.answers.get(&criterion.field).and_then(|answer| answer.value.as_ref().ok());
        if let Some(typed) = answer.and_then(|answer| typed(criterion, answer)) {
            numbers.insert(criterion.field.clone(), typed);
        }
    }
    numbers
}

/// Fields whose criteria are not all right by the student's own numbers: what merely follows from another answer of theirs is not.
pub fn wrong_fields(lab: &LabDefinition, card: &Scorecard) -> BTreeSet<String> {
    let items = items(card);
    let wrong = |criterion: &&Criterion| {
        items.get(criterion.id.as_str()).is_some_and(|item| {
            matches!(item.verdict, Verdict::Wrong | Verdict::Partly)
                || (item.verdict == Verdict::Right && item.follow_through.is_some())
        })
    };
    varied(lab).filter(wrong).map(|criterion| criterion.field.clone()).collect()
}

/// Which of `fields` are wholly right in a scorecard, without following from anything.
pub fn right_fields(lab: &LabDefinition, card: &Scorecard, fields: &BTreeSet<String>) -> BTreeSet<String> {
    let items = items(card);
    let right = |criterion: &Criterion| {
        items
            .get(criterion.id.as_str())
            .is_some_and(|item| item.verdict == Verdict::Right && item.follow_through.is_none())
    };
    let all_right = |field: &&String| varied(lab).filter(|criterion| criterion.field == **field).all(&right);
    fields.iter().filter(all_right).cloned().collect()
}

/// Fields among `fields` in which what was typed is near what is right by other numbers.
pub fn near_fields(typed: &Numbers, other: &Numbers, fields: &BTreeSet<String>) -> BTreeSet<String> {
    const NEAR: f64 = 0.03;
    let near = |a: f64, b: f64| (a - b).abs() <= NEAR * b.abs().max(1e-9);
    let alike = |field: &&String| match (typed.get(*field), other.get(*field)) {
        (Some(typed), Some(other)) => {
            typed.len() == other.len() && typed.iter().zip(other).all(|(a, b)| near(*a, *b))
        }
        _ => false,
    };
    fields.iter().filter(alike).cloned().collect()
}

/// What agrees with other numbers, and how likely that is by chance.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// Fields that are right by the others, and clearly not by the student's own.
    pub fields: Vec<String>,
    /// How many wrong answer sheets in so many agree like this with one of the class by chance, at most.
    pub chance: f64,
}

/// Weighs `fields`, wrong by `own` numbers and right by `other`; `differing` parameters are not the same, in the same way for
/// `alike` variants of the class. `None` when it is too little to tell.
///
/// Enough is a transfer function, or two other answers, that differ clearly and not only by a small whole number.
pub fn weigh(
    lab: &LabDefinition,
    own: &Numbers,
    other: &Numbers,
    fields: &BTreeSet<String>,
    differing: usize,
    alike: usize,
) -> Option<Evidence> {
    let mut told = Vec::new();
    let (mut numbers, mut widest, mut functions) = (0, 0.0_f64, 0);
    for field in fields {
        let Some(criterion) = varied(lab).find(|criterion| criterion.field == *field) else { continue };
        let width = width(lab, criterion);
        let (Some(own), Some(other)) = (own.get(field), other.get(field)) else { continue };
        let telling = match own.len() == other.len() {
            true => own.iter().zip(other).filter(|(own, other)| tells(**own, **other, width)).count(),
            false => 0,
        };
        if telling > 0 {
            numbers += telling;
            widest = widest.max(width);
            functions += usize::from(criterion.check.transfer_function().is_some());
            told.push(field.clone());
        }
    }
    // Numbers that follow from the same parameter are wrong together: they count once.
    let independent = i32::try_from(numbers.min(differing)).unwrap_or(i32::MAX);
    let chance = alike.max(1) as f64 * (PART * widest).min(1.0).powi(independent);
    let enough = functions > 0 || told.len() > 1;
    (enough && independent > 0 && chance <= LIKELIEST_CHANCE).then_some(Evidence { fields: told, chance })
}

/// Whether a number clearly belongs to one and not to the other, and is none that comes up anyway.
fn tells(own: f64, other: f64, width: f64) -> bool {
    let common = other.fract() == 0.0 && other.abs() <= 12.0;
    !common && (own - other).abs() > 3.0 * width * own.abs().max(other.abs())
}

/// The relative tolerance of what a criterion judges.
fn width(lab: &LabDefinition, criterion: &Criterion) -> f64 {
    match &criterion.check {
        Check::Poles { tolerance, .. } | Check::Feature { tolerance, .. } | Check::Rest { tolerance, .. } => {
            to_f64(&tolerance.relative)
        }
        check => check.transfer_function().map_or(0.01, |of| to_f64(&coefficient_tolerance(lab, of))),
    }
    .max(1e-4)
}

fn varied(lab: &LabDefinition) -> impl Iterator<Item = &Criterion> {
    let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
    criteria.filter(|criterion| lab.judges_varied(criterion))
}

fn items(card: &Scorecard) -> BTreeMap<&str, &ItemScore> {
    let items = card.questions.iter().flat_map(|question| &question.items);
    items.map(|item| (item.id.as_str(), item)).collect()
}

fn right(reference: &Reference, criterion: &Criterion) -> Option<Vec<f64>> {
    let main = operating_point(reference, criterion.check.system()?)?.main();
    match &criterion.check {
        Check::Structure { .. } | Check::Numerator { .. } | Check::Denominator { .. } => {
            let g = main.linearization.transfer_function.monic();
            Some(coefficients(&g.num, &g.den))
        }
        Check::Poles { .. } => {
            let each =
                main.poles.iter().flat_map(|pole| std::iter::repeat_n((pole.re, pole.im), pole.multiplicity));
            Some(upper(each.collect()))
        }
        Check::Feature { response, feature, .. } if feature.unit == feature.native => {
            Some(vec![value(&features(main, *response)?, feature.kind)?])
        }
        Check::Rest { asked, .. } if asked.unit == asked.native => {
            Some(vec![to_f64(main.values.get(&asked.signal)?)])
        }
        _ => None,
    }
}

fn typed(criterion: &Criterion, answer: &AnswerValue) -> Option<Vec<f64>> {
    match (&criterion.check, answer) {
        (check, AnswerValue::TransferFunction { transfer_function, .. })
            if check.transfer_function().is_some() =>
        {
            let g = transfer_function.cancelled().0.monic();
            Some(coefficients(&g.num, &g.den))
        }
        (Check::Poles { .. }, AnswerValue::Poles(poles)) => {
            Some(upper(poles.iter().map(|pole| (to_f64(&pole.re.value), to_f64(&pole.im.value))).collect()))
        }
        (Check::Feature { feature, .. }, AnswerValue::Value(FinalValue::Number(number, unit)))
            if feature.unit == feature.native && (unit.is_none() || *unit == feature.unit) =>
        {
            Some(vec![to_f64(&number.value)])
        }
        (Check::Rest { asked, .. }, AnswerValue::Value(FinalValue::Number(number, unit)))
            if asked.unit == asked.native && (unit.is_none() || *unit == asked.unit) =>
        {
            Some(vec![to_f64(&number.value)])
        }
        _ => None,
    }
}

fn coefficients(num: &Polynomial, den: &Polynomial) -> Vec<f64> {
    num.coefficients().iter().chain(den.coefficients()).map(to_f64).collect()
}

/// Real and imaginary parts of those on or above the real axis, in order.
fn upper(mut poles: Vec<(f64, f64)>) -> Vec<f64> {
    poles.retain(|(_, im)| *im >= 0.0);
    poles.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
    poles.into_iter().flat_map(|(re, im)| [re, im]).collect()
}

fn features(main: &LinearReference, response: InputKind) -> Option<Features> {
    let known = match response {
        InputKind::Impulse => &main.impulse,
        InputKind::Step => &main.step,
    };
    known.as_ref().map(|known| known.features.clone())
}

/// In the unit it is computed in; `None` where it is no number.
pub fn value(features: &Features, kind: FeatureKind) -> Option<f64> {
    match kind {
        FeatureKind::InitialValue => Some(features.initial_value),
        FeatureKind::FinalValue => match features.final_value {
            Limit::Value(value) => Some(value),
            _ => None,
        },
        FeatureKind::Peak => features.peak.as_ref().map(|peak| peak.value),
        FeatureKind::PeakTimeS => features.peak.as_ref().map(|peak| peak.time_s),
        // No feature of a response.
        FeatureKind::DcGain => None,
        FeatureKind::PeriodS => features.period_s,
        FeatureKind::DampingRatio => features.damping_ratio,
        FeatureKind::NaturalFrequencyRadS => features.natural_frequency_rad_s,
        FeatureKind::DampedFrequencyRadS => features.damped_frequency_rad_s(),
        FeatureKind::SettlingTime2PercentS => features.settling_time_2_percent_s,
        FeatureKind::SettlingTime5PercentS => features.settling_time_5_percent_s,
        FeatureKind::OvershootPercent => features.overshoot_percent,
        FeatureKind::RiseTime1090S => features.rise_time_10_90_s,
        FeatureKind::RiseTime0100S => features.rise_time_0_100_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_whole_numbers_tell_nothing() {
        for (own, other, tells_it) in
            [(0.5, 0.0, false), (0.5, 2.0, false), (0.5, 0.51, true), (0.5, 0.505, false), (1.3, 25.0, true)]
        {
            assert_eq!(tells(own, other, 0.005), tells_it, "{own} {other}");
        }
    }

    #[test]
    fn conjugates_are_one_and_order_plays_no_part() {
        assert_eq!(upper(vec![(-1.0, 2.0), (-1.0, -2.0), (-3.0, 0.0)]), [-3.0, 0.0, -1.0, 2.0]);
    }
}
