use super::problem::quote;
use super::words::{HalfShape, half_a_shape, shape_name};
use super::{Answer, AnswerSheet, AnswerValue, Field, FieldKind, FinalValue};
use crate::lti::{Shape, Stability};
use crate::source::Finding;
use std::collections::BTreeMap;

/// Completes `exponential` and `oscillation` by what the student says beside it of the same response: with `unstable` it
/// grows, with `stable` it decays.
///
/// Nothing is completed where the final value says otherwise than the stability. A warning in place of the error tells
/// what was read.
pub(super) fn complete(
    sheet: &AnswerSheet,
    answers: &mut BTreeMap<String, Answer>,
    findings: &mut [Finding],
) {
    for field in sheet.fields.iter().filter(|field| field.kind == FieldKind::Shape) {
        let Some(answer) = answers.get(&field.path) else { continue };
        let Err(unreadable) = &answer.value else { continue };
        let Some(half) = half_a_shape(&answer.text) else { continue };
        let Some((shape, beside)) = whole(half, field, sheet, answers) else { continue };
        let Some(finding) = findings.iter_mut().find(|finding| **finding == unreadable.finding) else {
            continue;
        };
        let name = shape_name(shape);
        let message =
            format!("{} is read as {name}, as it stands beside {}.", quote(&answer.text), quote(&beside));
        let warning = Finding::warning("shape.completed", message).with_help(format!("Write `{name}`."));
        *finding = Finding { span: finding.span, ..warning };
        if let Some(answer) = answers.get_mut(&field.path) {
            answer.value = Ok(AnswerValue::Shape(shape));
        }
    }
}

/// The shape, and the text that completes it.
fn whole(
    half: HalfShape,
    field: &Field,
    sheet: &AnswerSheet,
    answers: &BTreeMap<String, Answer>,
) -> Option<(Shape, String)> {
    field.about.as_ref()?;
    let beside = |kind: FieldKind| {
        let same = |other: &&Field| {
            other.kind == kind
                && other.question == field.question
                && other.about == field.about
                && (kind != FieldKind::Value
                    || (other.response == field.response && other.path.ends_with("final_value")))
        };
        answers.get(&sheet.fields.iter().find(same)?.path)
    };
    let (stability, final_value) = (beside(FieldKind::Stability), beside(FieldKind::Value));
    let by_word = stability.and_then(|answer| match answer.value {
        Ok(AnswerValue::Stability(word)) => Some((word, &answer.text)),
        _ => None,
    });
    let by_value = final_value.and_then(|answer| match answer.value {
        Ok(AnswerValue::Value(FinalValue::Number(..))) => {
            Some((Stability::AsymptoticallyStable, &answer.text))
        }
        Ok(AnswerValue::Value(_)) => Some((Stability::Unstable, &answer.text)),
        _ => None,
    });
    let (word, text) = match (by_word, by_value) {
        (Some((word, _)), Some((value, _))) if word != value => return None,
        (Some(word), _) => word,
        (None, value) => value?,
    };
    let shape = match (half, word) {
        (HalfShape::Exponential, Stability::AsymptoticallyStable) => Shape::ExponentialDecay,
        (HalfShape::Exponential, Stability::Unstable) => Shape::ExponentialGrowth,
        (HalfShape::Oscillation, Stability::AsymptoticallyStable) => Shape::DecayingOscillation,
        (HalfShape::Oscillation, Stability::Unstable) => Shape::GrowingOscillation,
        (_, Stability::MarginallyStable) => return None,
    };
    Some((shape, text.trim().to_owned()))
}
