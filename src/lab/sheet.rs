use super::{Check, Criterion, Curve, Described, Parameter, Question, QuestionField};
use crate::lti::InputKind;
use crate::submission::{AnswerSheet, Field, Unit};

/// What an answer file may hold. Nothing of the right answers goes in.
pub(super) fn sheet(id: &str, title: &str, questions: &[Question], parameters: &[Parameter]) -> AnswerSheet {
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
    }
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
