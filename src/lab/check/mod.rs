//! From the file as typed to a [`LabDefinition`]: every error found is reported, with its place.

mod amounts;
mod cover;
mod criteria;
mod expectations;
mod grades;
mod linear;
mod mistakes;
#[cfg(test)]
mod model_tests;
mod models;
mod operating_points;
mod parameters;
mod questions;
mod rests;
mod scalars;
#[cfg(test)]
mod short_tests;
mod simulations;
#[cfg(test)]
mod slip_tests;
mod tangents;
#[cfg(test)]
mod tests;
mod usual;
mod variants;

pub(super) use cover::SOURCES;
pub(super) use criteria::CHECKS;
pub(super) use questions::{KINDS, REST};

use super::file::{Entries, LabFile, QuantityFile, Spanned, Text};
use super::{
    LabDefinition, LabErrors, Outcome, Points, Question, SystemRef, defaults, model_answer, near_miss, read,
    sheet,
};
use crate::algebra::Rational;
use crate::source::{Finding, Node, SourceText, Span, Value};
use std::collections::BTreeMap;

impl LabDefinition {
    /// Reads and checks a lab file.
    ///
    /// Errors of shape (YAML, unknown or missing keys) come one at a time, since nothing behind them can be read;
    /// everything else is reported at once.
    pub fn parse(text: SourceText) -> Result<Self, LabErrors> {
        Self::parse_with(text, &BTreeMap::new())
    }

    /// Reads and checks a lab file with other values (by name, as typed) in place of its parameters' own; everything that
    /// follows from them is worked out anew.
    pub fn parse_with(text: SourceText, values: &BTreeMap<String, String>) -> Result<Self, LabErrors> {
        match read::read(&text) {
            Ok((file, tree)) => definition(&file, &tree, text, values),
            Err(finding) => Err(LabErrors { source: text, findings: vec![finding] }),
        }
    }
}

fn definition(
    file: &LabFile,
    tree: &Node,
    text: SourceText,
    values: &BTreeMap<String, String>,
) -> Result<LabDefinition, LabErrors> {
    let mut checker = Checker {
        source: &text,
        values,
        parameter_names: file.parameters.0.iter().map(|(name, _)| name.value.clone()).collect(),
        parameter_values: None,
        letters_in_amounts: std::collections::BTreeSet::new(),
        findings: Vec::new(),
    };
    let lab = checker.lab(file, tree);
    let mut findings = checker.findings;
    match lab {
        Some(lab) if findings.is_empty() => Ok(LabDefinition { text, ..lab }),
        _ => {
            findings.sort_by_key(|finding| finding.span.map(|span| span.start));
            // What an alias repeats is said once.
            findings.dedup();
            Err(LabErrors { source: text, findings })
        }
    }
}

/// Collects what is wrong while the parts are built. A part that cannot be built is `None`, and has a finding.
struct Checker<'a> {
    source: &'a SourceText,
    /// What some parameters are worth in place of their own value.
    values: &'a BTreeMap<String, String>,
    parameter_names: Vec<String>,
    /// As soon as they are known.
    parameter_values: Option<crate::model::ParameterValues>,
    /// Names in the formulas of amounts that were read so far.
    letters_in_amounts: std::collections::BTreeSet<String>,
    findings: Vec<Finding>,
}

/// Names that later parts refer to, right or wrong, so that one error does not cause others.
struct Names<'a> {
    outcomes: Vec<&'a str>,
    /// `<model>.<operating point>`.
    systems: Vec<String>,
    /// What the output and the input of each of them are measured in; empty where the lab does not say.
    units: Vec<(&'a str, &'a str)>,
    /// Coordinates, outputs and inputs of each model, each with its unit.
    signals: Vec<(String, Vec<(String, String)>)>,
    simulations: Vec<&'a str>,
    /// Those of them whose output jumps, with the block that makes it jump.
    jumping: Vec<(&'a str, &'static str)>,
    questions: Vec<&'a str>,
    /// Systems that have no responses, with the reason.
    unresponsive: Vec<(String, Unresponsive)>,
}

/// Why a system has no responses.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Unresponsive {
    /// Nothing in it is differentiated: it has no poles either.
    Static,
    Improper,
}

impl Names<'_> {
    /// Units of output and input of an operating point.
    fn units_of(&self, of: &SystemRef) -> (&str, &str) {
        let path = of.to_string();
        let position = self.systems.iter().position(|system| *system == path);
        position.and_then(|i| self.units.get(i)).copied().unwrap_or_default()
    }

    /// Coordinates, outputs and inputs of an operating point, each with its unit.
    fn signals_of(&self, of: &SystemRef) -> &[(String, String)] {
        let known = self.signals.iter().find(|(model, _)| *model == of.model);
        known.map_or(&[], |(_, signals)| signals)
    }

    /// `model.operating_point`, or a model alone that has but one operating point.
    fn system(&self, path: &str) -> Option<SystemRef> {
        let of_the_model = |s: &&String| s.strip_prefix(path).is_some_and(|rest| rest.starts_with('.'));
        let mut points = self.systems.iter().filter(of_the_model);
        let only = points.next().filter(|_| points.next().is_none());
        let known = self.systems.iter().find(|s| *s == path).or(only)?;
        let (model, operating_point) = known.split_once('.')?;
        Some(SystemRef { model: model.to_owned(), operating_point: operating_point.to_owned() })
    }
}

/// What a coordinate or an input is measured in; empty where the lab does not say.
fn unit_of<'a>(quantities: &'a Entries<QuantityFile>, name: &Text) -> &'a str {
    let found = quantities.0.iter().find(|(known, _)| known.value == name.value);
    found.map_or("", |(_, quantity)| quantity.unit.trim())
}

impl Checker<'_> {
    fn lab(&mut self, file: &LabFile, tree: &Node) -> Option<LabDefinition> {
        self.id(&file.lab, "lab id");
        let mut names = Names {
            outcomes: file.outcomes.0.iter().map(|(id, _)| id.value.as_str()).collect(),
            systems: file
                .models
                .0
                .iter()
                .flat_map(|(model, m)| {
                    m.operating_points
                        .value
                        .0
                        .iter()
                        .map(move |(point, _)| format!("{}.{}", model.value, point.value))
                })
                .collect(),
            units: file
                .models
                .0
                .iter()
                .flat_map(|(_, m)| {
                    m.operating_points.value.0.iter().map(move |(_, point)| {
                        let watched = operating_points::units(m).into_iter();
                        let output = watched.into_iter().find(|(name, _)| *name == point.output.value);
                        (output.map_or("", |(_, unit)| unit), unit_of(&m.inputs.value, &point.input))
                    })
                })
                .collect(),
            simulations: file.simulations.0.iter().map(|(id, _)| id.value.as_str()).collect(),
            jumping: simulations::jumping(file),
            questions: file.questions.0.iter().map(|(id, _)| id.value.as_str()).collect(),
            unresponsive: Vec::new(),
            signals: operating_points::signals(file),
        };
        let outcomes = file.outcomes.0.iter().map(|(id, outcome)| self.learning_outcome(id, &outcome.0));
        let outcomes: Vec<Outcome> = outcomes.collect();
        let parameters = self.parameters(file);
        let variants = self.variants(file);
        let models = self.models(file, parameters.as_ref());
        if let Some((models, parameters)) = models.as_ref().zip(parameters.as_ref()) {
            names.unresponsive = linear::unresponsive(models, parameters);
        }
        let simulations = self.simulations(file, &names);
        let given = self.defaults(&file.tolerances, &file.follow_through);
        let questions = self.questions(file, &names, &given);
        let observed = self.observed(&file.observed, &names);
        let worth = questions.as_ref().map(|questions| questions.iter().map(|q| q.points).sum());
        let seen = observed.as_ref().map(|rows| rows.iter().map(|row| row.points).sum());
        let cover = self.cover(file.cover.as_ref(), worth, seen);
        let grades = self.grades(&file.grades, cover.as_ref().map(|cover| cover.total));
        let expectations = self.expectations(&file.expect, &names);
        let list = parameters.as_ref().map(|parameters| parameters.list.as_slice());
        let mistakes = self.mistakes(&file.mistakes, models.as_deref(), list);
        let (questions, parameters) = (questions?, parameters?.list);
        let title = defaults::title(file.title.as_ref(), &file.lab.value);
        let also = self.also(file);
        let models = models?;
        let sheet = sheet::sheet(&file.lab.value, &title, &questions, &parameters, &models, also);
        self.spellings_at_rest(file, &sheet);
        let model_answer = self.model_answer(file, tree, &sheet)?;
        let near_misses = near_miss::near_misses(file, tree, &self.near_misses(file, &questions));
        Some(LabDefinition {
            id: file.lab.value.clone(),
            title,
            course: file.course.trim().to_owned(),
            source_note: file.source.trim().to_owned(),
            outcomes,
            parameters,
            variants: variants?,
            models,
            simulations: simulations?,
            questions,
            observed: observed?,
            cover: cover?,
            grades: grades?,
            release: grades::release(&file.release),
            follow_through: given.follow_through,
            mistakes: mistakes?,
            expectations: expectations?,
            model_answer,
            near_misses,
            sheet,
            text: SourceText::default(),
        })
    }

    fn model_answer(
        &mut self,
        file: &LabFile,
        tree: &Node,
        sheet: &crate::submission::AnswerSheet,
    ) -> Option<crate::submission::Submission> {
        let (answer, findings) = model_answer::read(self.source, file, tree, sheet);
        let right = findings.is_empty();
        self.findings.extend(findings);
        right.then_some(answer)
    }

    /// (question, points, why) of every near miss, in file order.
    fn near_misses(&mut self, file: &LabFile, questions: &[Question]) -> Vec<(String, Points, String)> {
        let mut all = Vec::new();
        for ((id, question), checked) in file.questions.0.iter().zip(questions) {
            for miss in &question.near_misses {
                let hundredths = self.number(&miss.points).map(|points| points * Rational::from(100));
                let whole =
                    hundredths.filter(Rational::is_int).and_then(|n| i64::try_from(n.numerator()).ok());
                let points =
                    whole.map(Points).filter(|points| (Points::ZERO..=checked.points).contains(points));
                if points.is_none() {
                    let message = format!("`{}` cannot be what a near miss earns", miss.points.value);
                    let help = format!("write 0 to {}, with at most two decimals", checked.points);
                    self.error("lab.points", span(&miss.points), message, Some(help));
                }
                all.push((id.value.clone(), points.unwrap_or(Points::ZERO), miss.why.trim().to_owned()));
            }
        }
        all
    }

    fn error(&mut self, code: &'static str, span: Span, message: impl Into<String>, help: Option<String>) {
        let finding = Finding::error(code, message).at(span);
        self.findings.push(match help {
            Some(help) => finding.with_help(help),
            None => finding,
        });
    }

    /// Where bytes `start..end` of a scalar stand in the file.
    fn locate(&self, text: &Text, start: usize, end: usize) -> Span {
        let node = Node { value: Value::Scalar(text.value.clone()), span: span(text) };
        node.locate(&self.source.text, start, end)
    }
}

fn span<T>(spanned: &Spanned<T>) -> Span {
    read::span(spanned.defined)
}
