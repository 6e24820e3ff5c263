//! The criteria of a question that states none: those of the kind of each of its fields.

use super::questions::{Fields, REST, asked, kind_name};
use super::{Checker, span};
use crate::lab::file::{CriterionFile, FieldFile, QuestionFile, Text};
use crate::lab::{FeatureKind, Points, defaults};
use crate::source::Span;
use crate::submission::FieldKind;

impl Checker<'_> {
    /// The usual criteria as if they were typed, with their points. `shares` are the points of the fields.
    pub(super) fn usual_criteria(
        &mut self,
        file: &QuestionFile,
        fields: &Fields<'_>,
        shares: &[Option<Points>],
    ) -> Vec<(Text, CriterionFile, Option<Points>)> {
        // Of a field that could not be read nothing more is said.
        if !fields.complete {
            return Vec::new();
        }
        let mut criteria = Vec::new();
        for (((name, field), (_, path, kind)), share) in asked(file).zip(&fields.entries).zip(shares) {
            let usual = defaults::usual_criteria(*kind);
            let proportions: Vec<i64> = usual.iter().map(|(_, _, part)| *part).collect();
            let place = name.or(field.kind.as_ref()).unwrap_or(fields.question);
            if !self.judgeable(path, *kind, field, span(place)) {
                continue;
            }
            let points = share.map(|share| defaults::split(share, &proportions));
            if points.iter().flatten().any(|points| *points == Points::ZERO) {
                let message =
                    format!("the field `{path}` is worth too little to be shared among its criteria");
                self.error("lab.points", span(place), message, Some("give it more points".to_owned()));
            }
            for (index, (id, check, _)) in usual.iter().enumerate() {
                let check = if asks_for_rest(field) { &REST } else { check };
                let text = |value: &str| Text { value: value.to_owned(), ..place.clone() };
                let name_of_criterion = match name {
                    None => (*id).to_owned(),
                    Some(name) if usual.len() == 1 => name.value.clone(),
                    Some(name) => format!("{}.{id}", name.value),
                };
                let criterion = CriterionFile {
                    title: None,
                    points: None,
                    field: name.cloned(),
                    check: text(check),
                    of: field.of.clone(),
                    response: field.response.clone(),
                    feature: feature(field),
                    value: field.value.clone(),
                    tolerance: field.tolerance.clone().filter(|_| *check != "structure"),
                    one_slip: (*check == "denominator").then(|| text(defaults::USUAL_ONE_SLIP)),
                    other_convention: None,
                    follow_through: None,
                    data: None,
                    min_points: None,
                    span_s: None,
                    concepts: field.concepts.clone(),
                    needed: None,
                    contradictions: None,
                    describes: None,
                    expected: field.expected.clone(),
                    form: field.form.clone().filter(|_| index == 0),
                    other_form: field.other_form.clone().filter(|_| index == 0),
                };
                criteria.push((
                    text(&name_of_criterion),
                    criterion,
                    points.as_ref().map(|points| points[index]),
                ));
            }
        }
        criteria
    }

    /// Whether a field says what its usual criterion needs.
    fn judgeable(&mut self, path: &str, kind: FieldKind, field: &FieldFile, place: Span) -> bool {
        let missing = match kind {
            FieldKind::Value if asks_for_rest(field) && field.value.is_none() => "`value`",
            FieldKind::Value if feature(field).is_none() && !asks_for_rest(field) => "`feature` or `value`",
            FieldKind::Nonlinearity if field.expected.is_none() => "`expected`",
            FieldKind::Prose if field.concepts.is_none() => "`concepts`",
            FieldKind::Data => "a criterion that holds it against a curve",
            _ => return true,
        };
        let message =
            format!("the field `{path}` of kind `{}` needs {missing} to be judged", kind_name(kind));
        let help = match kind {
            FieldKind::Data => "give the question `criteria`, with one of `check: plot`",
            _ => "add it to the field, or give the question `criteria`",
        };
        self.error("lab.missing_key", place, message, Some(help.to_owned()));
        false
    }

    /// What fields may say of their usual criteria means nothing beside criteria that are stated.
    pub(super) fn shorthand_is_for_usual_criteria(&mut self, file: &QuestionFile) {
        for (_, field) in asked(file) {
            let text = |text: &Option<Text>| text.as_ref().map(span);
            let given = [
                ("points", text(&field.points)),
                ("of", text(&field.of)),
                ("response", text(&field.response)),
                ("feature", text(&field.feature)),
                ("value", text(&field.value)),
                ("tolerance", field.tolerance.as_ref().map(span)),
                ("expected", text(&field.expected)),
                ("concepts", field.concepts.as_ref().map(span)),
                ("form", text(&field.form)),
                ("other_form", text(&field.other_form)),
            ];
            for (key, place) in given.into_iter().filter_map(|(key, place)| Some((key, place?))) {
                let message = format!("`{key}` of a field means nothing beside `criteria`");
                let help = format!("say `{key}` in the criterion, or leave `criteria` out");
                self.error("lab.question", place, message, Some(help));
            }
        }
    }
}

/// The feature a field asks for, as typed.
fn feature(field: &FieldFile) -> Option<Text> {
    let kind =
        || field.kind.as_ref().filter(|word| FeatureKind::all().any(|kind| kind.as_str() == word.value));
    field.feature.as_ref().or_else(kind).cloned()
}

/// Whether a field asks for a value at rest: it says so, or names what rests and no feature.
fn asks_for_rest(field: &FieldFile) -> bool {
    field.kind.as_ref().is_some_and(|kind| kind.value == REST)
        || field.value.is_some() && feature(field).is_none()
}
