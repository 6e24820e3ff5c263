use super::scalars::Defaults;
use super::{Checker, Names, span};
use crate::lab::file::{FieldFile, LabFile, QuestionFile, Text};
use crate::lab::names::list;
use crate::lab::{Points, Question, QuestionField};
use crate::submission::FieldKind;

const KINDS: &[(&str, FieldKind)] = &[
    ("transfer_function", FieldKind::TransferFunction),
    ("poles", FieldKind::Poles),
    ("value", FieldKind::Value),
    ("stability", FieldKind::Stability),
    ("shape", FieldKind::Shape),
    ("nonlinearity", FieldKind::Nonlinearity),
    ("prose", FieldKind::Prose),
    ("figure", FieldKind::Figure),
    ("data", FieldKind::Data),
];

/// As the lab file spells it.
pub(super) fn kind_name(kind: FieldKind) -> &'static str {
    KINDS.iter().find(|(_, k)| *k == kind).map_or("", |(name, _)| name)
}

/// The fields of one question as its criteria see them.
pub(super) struct Fields<'a> {
    pub question: &'a Text,
    /// (name, full path, kind); the name is empty for the one field of a question.
    pub entries: Vec<(&'a str, String, FieldKind)>,
    /// Units that fields ask for, by path.
    pub units: Vec<(String, &'a Text)>,
    /// False when a field could not be read: then nothing is said about fields that seem to be missing.
    pub complete: bool,
}

impl Checker<'_> {
    pub(super) fn questions(
        &mut self,
        file: &LabFile,
        names: &Names<'_>,
        defaults: &Defaults,
    ) -> Option<Vec<Question>> {
        let questions: Vec<_> =
            file.questions.0.iter().map(|(id, q)| self.question(id, q, names, defaults)).collect();
        let questions = questions.into_iter().collect::<Option<Vec<_>>>();
        let total = self.points(&file.total);
        let questions = questions?;
        self.paths(file, &questions);
        let sum: Points = questions.iter().map(|q| q.points).sum();
        if let Some(total) = total.filter(|total| *total != sum) {
            let message = format!("questions add up to {sum} points, but `total` is {total}");
            let help = format!("change `total` to {sum}, or the points of a question");
            self.error("lab.points", span(&file.total), message, Some(help));
        }
        Some(questions)
    }

    fn question(
        &mut self,
        id: &Text,
        file: &QuestionFile,
        names: &Names<'_>,
        defaults: &Defaults,
    ) -> Option<Question> {
        self.path(id, "question id");
        let points = self.points(&file.points);
        self.outcomes(&file.outcomes, names);
        if let Some(about) = &file.about {
            self.about(about, names);
        }
        let (fields, entries) = self.fields(id, file);
        if file.criteria.value.0.is_empty() {
            let message = format!("the question `{}` has no criterion", id.value);
            self.error("lab.criterion", span(&file.criteria), message, None);
        }
        let criteria: Vec<_> = file
            .criteria
            .value
            .0
            .iter()
            .map(|(name, c)| self.criterion(name, c, file, &entries, names, defaults))
            .collect();
        let criteria = criteria.into_iter().collect::<Option<Vec<_>>>();
        let (points, criteria) = (points?, criteria?);
        let sum: Points = criteria.iter().map(|c| c.points).sum();
        if sum != points && !criteria.is_empty() {
            let message = format!(
                "the criteria of `{}` add up to {sum} points, but the question is worth {points}",
                id.value
            );
            let more = if sum < points {
                format!("give {} more to a criterion", points - sum)
            } else {
                format!("take {} from a criterion", sum - points)
            };
            self.error(
                "lab.points",
                span(&file.points),
                message,
                Some(format!("change `points` to {sum}, or {more}")),
            );
        }
        Some(Question {
            id: id.value.clone(),
            number: file.number.trim().to_owned(),
            title: file.title.trim().to_owned(),
            text: file.text.trim().to_owned(),
            points,
            outcomes: file.outcomes.iter().map(|o| o.value.clone()).collect(),
            about: file.about.as_ref().map(|about| about.value.clone()),
            fields: fields?,
            criteria,
        })
    }

    fn about(&mut self, about: &Text, names: &Names<'_>) {
        let known: Vec<&str> =
            names.systems.iter().map(String::as_str).chain(names.simulations.iter().copied()).collect();
        self.one_of(about, "operating point or simulation", &known);
    }

    pub(super) fn outcomes(&mut self, outcomes: &[Text], names: &Names<'_>) {
        for outcome in outcomes {
            self.one_of(outcome, "outcome", &names.outcomes);
        }
    }

    fn fields<'a>(
        &mut self,
        id: &'a Text,
        file: &'a QuestionFile,
    ) -> (Option<Vec<QuestionField>>, Fields<'a>) {
        let typed: Vec<(&str, String, &FieldFile)> = match &file.answer {
            Some(answer) => vec![("", id.value.clone(), answer)],
            None => file
                .fields
                .0
                .iter()
                .map(|(name, field)| {
                    self.path(name, "field name");
                    (name.value.as_str(), format!("{}.{}", id.value, name.value), field)
                })
                .collect(),
        };
        if file.answer.is_some() != file.fields.0.is_empty() {
            let message = match file.answer {
                Some(_) => format!("the question `{}` has both `answer` and `fields`", id.value),
                None => format!("the question `{}` has no field to answer in", id.value),
            };
            let help = "give `answer` when there is one field, `fields` when there are several".to_owned();
            self.error("lab.question", span(id), message, Some(help));
        }
        let known: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
        let mut fields = Vec::new();
        let mut entries = Fields { question: id, entries: Vec::new(), units: Vec::new(), complete: true };
        for (name, path, field) in typed {
            let Some(position) = self.one_of(&field.kind, "kind of field", &known) else {
                entries.complete = false;
                continue;
            };
            let kind = KINDS[position].1;
            entries.entries.push((name, path.clone(), kind));
            match &field.unit {
                Some(unit) if kind != FieldKind::Value => {
                    let message = format!(
                        "a unit is asked for in values, but `{path}` is of kind `{}`",
                        kind_name(kind)
                    );
                    self.error("lab.question", span(unit), message, Some("remove `unit`".to_owned()));
                }
                Some(unit) => entries.units.push((path.clone(), unit)),
                None => {}
            }
            fields.push(QuestionField {
                path,
                kind,
                prompt: field.prompt.split_whitespace().collect::<Vec<_>>().join(" "),
                required: !field.optional,
            });
        }
        (entries.complete.then_some(fields), entries)
    }

    /// No path may be the same as, or lie inside, another: an answer file could not hold both.
    fn paths(&mut self, file: &LabFile, questions: &[Question]) {
        let mut seen: Vec<&str> = Vec::new();
        for ((id, _), question) in file.questions.0.iter().zip(questions) {
            for field in &question.fields {
                let inside = |outer: &str, inner: &str| {
                    inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
                };
                if let Some(other) = seen.iter().find(|s| inside(s, &field.path) || inside(&field.path, s)) {
                    let message = format!(
                        "an answer file cannot hold both {}",
                        list(&[other, &field.path]).replace(", ", " and ")
                    );
                    self.error("lab.duplicate", span(id), message, Some("rename one of them".to_owned()));
                }
                seen.push(&field.path);
            }
        }
    }
}
