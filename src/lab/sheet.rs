use super::{
    Check, Criterion, Curve, Described, ModelDefinition, OperatingPointDefinition, Parameter, Question,
    QuestionField,
};
use crate::algebra::{Rational, from_f64};
use crate::lti::InputKind;
use crate::model::{Model, known_at_rest, letters_at_rest, letters_used};
use crate::submission::{
    AnswerSheet, AnsweredIn, Field, FieldKind, FieldLetters, LetterName, LineNames, Unit,
};
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
    let letters = asked.filter_map(|(question, field)| {
        let point = point(models, about(question, field).as_deref());
        let own = match field.kind {
            FieldKind::TransferFunction => letters(point, field.answered_in, &also),
            FieldKind::Formula => FieldLetters { line: point.map(line), ..FieldLetters::default() },
            _ => return None,
        };
        (own != FieldLetters::default()).then(|| (field.path.clone(), own))
    });
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

type Point<'a> = (&'a Model, &'a OperatingPointDefinition);

/// The operating point that a path such as `cart.hanging` means.
fn point<'a>(models: &'a [ModelDefinition], system: Option<&str>) -> Option<Point<'a>> {
    let (wanted, point) = system?.split_once('.')?;
    let model = models.iter().find(|model| model.id == wanted)?;
    let found = model.operating_points.iter().find(|one| one.id == point)?;
    Some((&model.model, found))
}

fn line((model, point): Point<'_>) -> LineNames {
    LineNames {
        output: point.output.clone(),
        input: point.input.clone(),
        at_rest: model.coordinates.iter().map(|one| &one.name).chain(&model.inputs).cloned().collect(),
    }
}

/// Values at rest that may stand in a formula about a point: as `h_0`, or `h` alone, which can mean nothing else there.
///
/// `parameters_also`: other spellings of parameters.
fn letters(
    point: Option<Point<'_>>,
    answered_in: AnsweredIn,
    parameters_also: &BTreeMap<String, String>,
) -> FieldLetters {
    let mut own = FieldLetters { answered_in, ..FieldLetters::default() };
    let found = point.map(|(model, point)| letters_at_rest(model, &point.at));
    for one in found.unwrap_or_default() {
        let value = one.value.as_rational().cloned();
        let Some(value) = value.or_else(|| from_f64(one.value.to_f64())) else { continue };
        own.symbols.insert(one.letter.clone(), value);
        own.also.insert(one.name.clone(), one.letter.clone());
        own.names.push(LetterName { name: one.letter, also: vec![one.name] });
    }
    // What is known as it is has its name too, though nobody needs it.
    let known = point.map(|(model, point)| known_at_rest(model, &point.at));
    let plain = |name: &str| name.replace('_', "");
    let taken = |letter: &str| parameters_also.keys().any(|spelled| plain(spelled) == plain(letter));
    for one in known.unwrap_or_default().into_iter().filter(|one| !taken(&one.letter)) {
        let Some(value) = from_f64(one.value.to_f64()) else { continue };
        if value != Rational::ZERO {
            own.also.insert(one.name, one.letter.clone());
        }
        own.symbols.insert(one.letter, value);
    }
    let parameters = point.map(|(model, _)| letters_used(model)).unwrap_or_default();
    let parameters = parameters.into_iter().map(|name| {
        let also = parameters_also.iter().filter(|(_, of)| **of == name).map(|(spelled, _)| spelled.clone());
        LetterName { also: also.collect(), name }
    });
    own.names.splice(0..0, parameters);
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
