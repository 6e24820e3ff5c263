use super::{Check, Criterion, Curve, Described, ModelDefinition, Parameter, Question, QuestionField};
use crate::algebra::from_f64;
use crate::lti::InputKind;
use crate::model::letters_at_rest;
use crate::submission::{AnswerSheet, AnsweredIn, Field, FieldKind, FieldLetters, Unit};
use std::collections::BTreeMap;

/// What an answer file may hold. Nothing of the right answers goes in.
///
/// `also`: other spellings of parameters.
pub(super) fn sheet(
    id: &str,
    title: &str,
    questions: &[Question],
    parameters: &[Parameter],
    models: &[ModelDefinition],
    also: BTreeMap<String, String>,
) -> AnswerSheet {
    let asked =
        questions.iter().flat_map(|question| question.fields.iter().map(move |field| (question, field)));
    let letters = asked.filter(|(_, field)| field.kind == FieldKind::TransferFunction).filter_map(
        |(question, field)| {
            let own = letters(models, about(question, field).as_deref(), field.answered_in);
            (own != FieldLetters::default()).then(|| (field.path.clone(), own))
        },
    );
    let letters = letters.collect();
    let fields = questions.iter().flat_map(|question| {
        question.fields.iter().map(move |field| Field {
            path: field.path.clone(),
            kind: field.kind,
            question: question.id.clone(),
            prompt: field.prompt.clone(),
            about: about(question, field),
            response: response(question, &field.path),
            unit: unit(question, &field.path),
            required: field.required,
        })
    });
    AnswerSheet {
        lab: id.to_owned(),
        title: title.to_owned(),
        fields: fields.collect(),
        symbols: parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect(),
        also,
        letters,
    }
}

/// Values at rest that may stand in a formula about `system`: as `h_0`, or `h` alone, which can mean nothing else there.
fn letters(models: &[ModelDefinition], system: Option<&str>, answered_in: AnsweredIn) -> FieldLetters {
    let mut own = FieldLetters { answered_in, ..FieldLetters::default() };
    let found = models.iter().find_map(|model| {
        let point =
            model.operating_points.iter().find(|p| Some(format!("{}.{}", model.id, p.id).as_str()) == system);
        point.map(|point| letters_at_rest(&model.model, &point.at))
    });
    for one in found.unwrap_or_default() {
        let value = one.value.as_rational().cloned();
        let Some(value) = value.or_else(|| from_f64(one.value.to_f64())) else { continue };
        own.symbols.insert(one.letter.clone(), value);
        own.also.insert(one.name, one.letter);
    }
    own
}

/// The system a field speaks of: the one its criteria judge it against, else the one its question is about.
fn about(question: &Question, field: &QuestionField) -> Option<String> {
    let judged = judging(question, &field.path).find_map(|criterion| match &criterion.check {
        Check::Plot { curve: Curve::Simulation { id }, .. } => Some(id.clone()),
        check => check.system().map(ToString::to_string),
    });
    judged.or_else(|| question.about.clone())
}

/// The response a field describes.
fn response(question: &Question, path: &str) -> Option<InputKind> {
    judging(question, path).find_map(|criterion| match &criterion.check {
        Check::Feature { response, .. }
        | Check::Shape { response, .. }
        | Check::Concepts { describes: Some(Described { response, .. }), .. }
        | Check::Plot { curve: Curve::Response { response, .. }, .. } => Some(*response),
        _ => None,
    })
}

/// The unit a value is asked in.
fn unit(question: &Question, path: &str) -> Option<Unit> {
    judging(question, path).find_map(|criterion| match &criterion.check {
        Check::Feature { feature, .. } => feature.unit.clone(),
        Check::Rest { asked, .. } => asked.unit.clone(),
        _ => None,
    })
}

/// Criteria that judge a field, as their own field or as a plot's data.
fn judging<'a>(question: &'a Question, path: &'a str) -> impl Iterator<Item = &'a Criterion> {
    question.criteria.iter().filter(move |criterion| {
        let data = match &criterion.check {
            Check::Plot { data, .. } => data.as_deref(),
            _ => None,
        };
        criterion.field == path || data == Some(path)
    })
}
