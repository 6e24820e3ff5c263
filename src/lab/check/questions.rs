use super::scalars::Defaults;
use super::{Checker, Names, span};
use crate::lab::file::{FieldFile, LabFile, QuestionFile, Text};
use crate::lab::names::{list, suggestion};
use crate::lab::{Check, Criterion, FeatureKind, Points, Question, QuestionField, defaults};
use crate::submission::{AnsweredIn, FieldKind};

pub(in crate::lab) const KINDS: &[(&str, FieldKind)] = &[
    ("transfer_function", FieldKind::TransferFunction),
    ("poles", FieldKind::Poles),
    ("value", FieldKind::Value),
    ("stability", FieldKind::Stability),
    ("shape", FieldKind::Shape),
    ("nonlinearity", FieldKind::Nonlinearity),
    ("formula", FieldKind::Formula),
    ("prose", FieldKind::Prose),
    ("figure", FieldKind::Figure),
    ("data", FieldKind::Data),
];

/// As a field spells that it asks for a value at rest.
pub(in crate::lab) const REST: &str = "rest";

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
        given: &Defaults,
    ) -> Option<Vec<Question>> {
        let questions: Vec<_> = (1..)
            .zip(&file.questions.0)
            .map(|(position, (id, q))| self.question(position, id, q, file, names, given))
            .collect();
        let questions = questions.into_iter().collect::<Option<Vec<_>>>();
        let total = file.total.as_ref().and_then(|total| Some((total, self.points(total)?)));
        let questions = questions?;
        self.paths(file, &questions);
        let sum: Points = questions.iter().map(|q| q.points).sum();
        if let Some((text, total)) = total.filter(|(_, total)| *total != sum) {
            let message = format!("questions add up to {sum} points, but `total` is {total}");
            let help = format!("change `total` to {sum}, or the points of a question");
            self.error("lab.points", span(text), message, Some(help));
        }
        Some(questions)
    }

    fn question(
        &mut self,
        position: usize,
        id: &Text,
        file: &QuestionFile,
        lab: &LabFile,
        names: &Names<'_>,
        given: &Defaults,
    ) -> Option<Question> {
        self.path(id, "question id");
        self.outcomes(&file.outcomes, names);
        if let Some(about) = &file.about {
            self.about(about, names);
        }
        if let Some(response) = &file.response {
            self.input_kind(response);
        }
        let (fields, entries) = self.fields(id, file);
        let (points, criteria) = match &file.criteria {
            Some(stated) => {
                self.shorthand_is_for_usual_criteria(file);
                if stated.value.0.is_empty() {
                    let message = format!("the question `{}` has no criterion", id.value);
                    self.error("lab.criterion", span(stated), message, None);
                }
                let typed: Vec<_> = stated.value.0.iter().map(|(_, c)| c.points.as_ref()).collect();
                let (points, shares) = self.shares(id, file.points.as_ref(), &typed, "criteria");
                let criteria: Vec<_> = stated
                    .value
                    .0
                    .iter()
                    .zip(shares)
                    .map(|((name, c), share)| self.criterion(name, c, share, file, &entries, names, given))
                    .collect();
                (points, criteria)
            }
            None => {
                let typed: Vec<_> = asked(file).map(|(_, field)| field.points.as_ref()).collect();
                let (points, shares) = self.shares(id, file.points.as_ref(), &typed, "fields");
                let usual = self.usual_criteria(file, &entries, &shares);
                let criteria = usual
                    .iter()
                    .map(|(name, c, share)| self.criterion(name, c, *share, file, &entries, names, given));
                (points, criteria.collect())
            }
        };
        let criteria = criteria.into_iter().collect::<Option<Vec<_>>>()?;
        let mut fields = fields?;
        for field in fields.iter_mut().filter(|field| field.prompt.is_empty()) {
            field.prompt = prompt(field, &criteria, lab);
        }
        Some(Question {
            id: id.value.clone(),
            number: file
                .number
                .as_ref()
                .map_or_else(|| format!("Question {position}"), |n| n.trim().to_owned()),
            title: defaults::title(file.title.as_ref(), &id.value),
            text: file.text.trim().to_owned(),
            points: points?,
            outcomes: file.outcomes.iter().map(|o| o.value.clone()).collect(),
            about: file.about.as_ref().map(|about| match names.system(&about.value) {
                Some(system) => system.to_string(),
                None => about.value.clone(),
            }),
            fields,
            criteria,
        })
    }

    /// The points of a question and of its parts (`what` names them): a part that says none has an equal share of what the others
    /// leave, a question that says none is worth the sum.
    fn shares(
        &mut self,
        id: &Text,
        whole: Option<&Text>,
        parts: &[Option<&Text>],
        what: &str,
    ) -> (Option<Points>, Vec<Option<Points>>) {
        let before = self.findings.len();
        let points = whole.and_then(|text| self.points(text));
        let mut shares: Vec<Option<Points>> = parts.iter().map(|part| self.points((*part)?)).collect();
        if self.findings.len() > before {
            return (points, shares);
        }
        let sum: Points = shares.iter().flatten().copied().sum();
        let open = parts.iter().filter(|part| part.is_none()).count();
        let Some((text, points)) = whole.zip(points) else {
            if open > 0 || parts.is_empty() {
                let message = format!("it is not said how many points `{}` is worth", id.value);
                self.error("lab.points", span(id), message, Some("add `points:`".to_owned()));
                return (None, shares);
            }
            return (Some(sum), shares);
        };
        if open > 0 && sum < points {
            let mut rest = defaults::split(points - sum, &vec![1; open]).into_iter();
            shares.iter_mut().filter(|share| share.is_none()).for_each(|share| *share = rest.next());
        } else if sum != points && !parts.is_empty() || open > 0 {
            let message = format!(
                "the {what} of `{}` add up to {sum} points, but the question is worth {points}",
                id.value
            );
            let one = if what == "fields" { "field" } else { "criterion" };
            let help = match open {
                0 if sum < points => {
                    format!("change `points` to {sum}, or give {} more to a {one}", points - sum)
                }
                0 => format!("change `points` to {sum}, or take {} from a {one}", sum - points),
                _ => format!("raise `points`, since a {one} without points has a share of what is left"),
            };
            self.error("lab.points", span(text), message, Some(help));
        }
        (Some(points), shares)
    }

    fn about(&mut self, about: &Text, names: &Names<'_>) {
        if names.system(&about.value).is_some() {
            return;
        }
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
        let mut typed: Vec<(&str, String, &FieldFile)> = Vec::new();
        for (name, field) in asked(file) {
            match name {
                None => typed.push(("", id.value.clone(), field)),
                Some(name) => {
                    self.path(name, "field name");
                    typed.push((&name.value, format!("{}.{}", id.value, name.value), field));
                }
            }
        }
        if file.answer.is_some() != file.fields.0.is_empty() {
            let message = match file.answer {
                Some(_) => format!("the question `{}` has both `answer` and `fields`", id.value),
                None => format!("the question `{}` has no field to answer in", id.value),
            };
            let help = "give `answer` when there is one field, `fields` when there are several".to_owned();
            self.error("lab.question", span(id), message, Some(help));
        }
        let mut fields = Vec::new();
        let mut entries = Fields { question: id, entries: Vec::new(), units: Vec::new(), complete: true };
        for (name, path, field) in typed {
            let Some(kind) = self.kind(&path, id, field) else {
                entries.complete = false;
                continue;
            };
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
                prompt: field
                    .prompt
                    .iter()
                    .flat_map(|prompt| prompt.split_whitespace())
                    .collect::<Vec<_>>()
                    .join(" "),
                required: !field.optional,
                answered_in: self.answered_in(field, kind),
            });
        }
        (entries.complete.then_some(fields), entries)
    }

    /// Whether a transfer function is asked for in letters or numbers.
    fn answered_in(&mut self, field: &FieldFile, kind: FieldKind) -> AnsweredIn {
        let Some(word) = &field.answered_in else { return AnsweredIn::Either };
        if kind != FieldKind::TransferFunction {
            let message =
                format!("`in` is for a `transfer_function`, and this is of kind `{}`", kind_name(kind));
            self.error("lab.question", span(word), message, Some("remove `in`".to_owned()));
        }
        match word.value.as_str() {
            "letters" => AnsweredIn::Letters,
            "numbers" => AnsweredIn::Numbers,
            _ => {
                self.one_of(word, "way to answer", &["letters", "numbers"]);
                AnsweredIn::Either
            }
        }
    }

    /// The kind of a field: as it says, or of what it asks for.
    fn kind(&mut self, path: &str, id: &Text, field: &FieldFile) -> Option<FieldKind> {
        let Some(word) = &field.kind else {
            let kind = match field {
                FieldFile { feature: Some(_), .. } | FieldFile { value: Some(_), .. } => {
                    Some(FieldKind::Value)
                }
                FieldFile { expected: Some(_), .. } => Some(FieldKind::Nonlinearity),
                FieldFile { concepts: Some(_), .. } => Some(FieldKind::Prose),
                _ => None,
            };
            if kind.is_none() {
                let message = format!("it is not said of which kind the field `{path}` is");
                self.error("lab.question", span(id), message, Some("add `kind:` to the field".to_owned()));
            }
            return kind;
        };
        if let Some((_, kind)) = KINDS.iter().find(|(name, _)| *name == word.value) {
            return Some(*kind);
        }
        let features: Vec<&str> = FeatureKind::all().map(FeatureKind::as_str).collect();
        if word.value == REST || features.contains(&word.value.as_str()) && field.feature.is_none() {
            return Some(FieldKind::Value);
        }
        let kinds: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
        let all: Vec<&str> = kinds.iter().chain(&features).chain(&[REST]).copied().collect();
        let near = suggestion(&word.value, &all);
        let help = if near.starts_with("did you mean") { near } else { suggestion(&word.value, &kinds) };
        let message = format!("there is no kind of field `{}`", word.value);
        self.error("lab.unknown_name", span(word), message, Some(help));
        None
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

/// The fields of a question, with their names; the one field of `answer` has none.
pub(super) fn asked(file: &QuestionFile) -> impl Iterator<Item = (Option<&Text>, &FieldFile)> {
    let several = file.fields.0.iter().filter(|_| file.answer.is_none());
    file.answer.iter().map(|form| (None, &form.0)).chain(several.map(|(name, form)| (Some(name), &form.0)))
}

/// What a field asks for, from the criterion that judges it.
fn prompt(field: &QuestionField, criteria: &[Criterion], lab: &LabFile) -> String {
    let check =
        criteria.iter().find(|criterion| criterion.field == field.path).map(|criterion| &criterion.check);
    let signals = check.and_then(Check::system).and_then(|of| {
        let (_, model) = lab.models.0.iter().find(|(id, _)| id.value == of.model)?;
        let (_, point) =
            model.operating_points.value.0.iter().find(|(id, _)| id.value == of.operating_point)?;
        Some((point.output.value.as_str(), point.input.value.as_str()))
    });
    defaults::prompt(field.kind, check, signals)
}
