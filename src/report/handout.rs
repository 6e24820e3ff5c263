//! The sheet a student works from: what is given, with their own values, and what is asked. Nothing of the answers is on it.

use super::anchor::question_anchor;
use super::escape::escape;
use super::given::{self, GivenView};
use super::kit::{ReportError, environment, render};
use super::math;
use super::numbers::{counted, typeset};
use super::prose;
use crate::lab::{
    Check, LabDefinition, ModelDefinition, OperatingPointDefinition, Question, SimulationDefinition,
    StudentEdition,
};
use crate::source::sanitize;
use minijinja::Environment;
use serde::Serialize;

/// Whose sheet it is: both are the student's own text.
#[derive(Clone, Copy, Debug)]
pub struct HandoutStudent<'a> {
    pub id: &'a str,
    pub name: &'a str,
}

/// Writes sheets: the templates, read.
pub struct HandoutKit {
    environment: Environment<'static>,
}

impl HandoutKit {
    pub fn new() -> Result<Self, ReportError> {
        Ok(Self { environment: environment()? })
    }

    /// One sheet with the values `lab` has, as a self-contained HTML file; for everyone when there is no student.
    pub fn sheet(&self, lab: &LabDefinition, student: Option<HandoutStudent<'_>>) -> String {
        render(&self.environment, "handout.html", &page(lab, student))
    }
}

#[derive(Serialize)]
struct HandoutPage {
    page_title: String,
    course: String,
    lab_title: String,
    name: String,
    id: String,
    total: String,
    given: Vec<GivenView>,
    /// Some of the values are the student's own.
    varied: bool,
    models: Vec<ModelView>,
    simulations: Vec<SimulationView>,
    questions: Vec<QuestionView>,
    /// The file to check one's answers with, where polemark does not have the lab inside.
    edition: Option<String>,
}

#[derive(Serialize)]
struct ModelView {
    title: String,
    given_html: String,
    equations_html: Vec<String>,
    quantities: Vec<QuantityView>,
    points: Vec<PointView>,
}

#[derive(Serialize)]
struct QuantityView {
    symbol_html: String,
    words: String,
}

#[derive(Serialize)]
struct PointView {
    title: String,
    /// `θ = π`, each.
    rest_html: Vec<String>,
    input_html: String,
    output_html: String,
}

#[derive(Serialize)]
struct SimulationView {
    title: String,
    chain: String,
}

#[derive(Serialize)]
struct QuestionView {
    anchor: String,
    number: String,
    title: String,
    points: String,
    text_html: String,
    asked: Vec<AskedView>,
}

#[derive(Serialize)]
struct AskedView {
    prompt: String,
    /// Which letters may stand in it; empty where none may.
    letters_html: String,
}

fn page(lab: &LabDefinition, student: Option<HandoutStudent<'_>>) -> HandoutPage {
    let (id, name) = student.map_or((String::new(), String::new()), |one| (shown(one.id), shown(one.name)));
    let whose = if name.is_empty() { &id } else { &name };
    HandoutPage {
        page_title: if whose.is_empty() { lab.title.clone() } else { format!("{whose} – {}", lab.title) },
        course: lab.course.clone(),
        lab_title: lab.title.clone(),
        total: counted(
            lab.questions.iter().map(|question| question.points).sum::<crate::lab::Points>(),
            "point",
        ),
        given: given::all(lab),
        varied: student.is_some() && lab.variants.is_some(),
        models: lab.models.iter().map(model).collect(),
        simulations: lab
            .simulations
            .iter()
            .filter(|one| !names_an_answer(lab, one))
            .map(|one| SimulationView {
                title: one.title.clone(),
                chain: super::answer_key::chain_words(one),
            })
            .collect(),
        questions: lab.questions.iter().map(|one| question(lab, one)).collect(),
        edition: (!is_embedded(lab)).then(|| StudentEdition::of(lab).file_name()),
        name,
        id,
    }
}

fn is_embedded(lab: &LabDefinition) -> bool {
    crate::lab::embedded().iter().any(|(id, text)| *id == lab.id && *text == lab.text.text)
}

/// Whether the question a simulation belongs to asks for the kind of a nonlinearity, which title and chain would tell.
fn names_an_answer(lab: &LabDefinition, simulation: &SimulationDefinition) -> bool {
    let mut questions = lab.questions.iter().filter(|question| question.id == simulation.shown_in);
    questions
        .any(|question| question.criteria.iter().any(|one| matches!(one.check, Check::Nonlinearity { .. })))
}

/// A line of somebody's text.
fn shown(text: &str) -> String {
    let line: String = text.chars().take(200).collect();
    sanitize(line.trim()).to_string()
}

fn model(definition: &ModelDefinition) -> ModelView {
    let model = &definition.model;
    let quantities =
        model.coordinates.iter().filter(|one| !one.description.is_empty() || !one.unit.is_empty());
    ModelView {
        title: definition.title.clone(),
        given_html: definition.linear.as_ref().map(math::linear_form).unwrap_or_default(),
        equations_html: match definition.linear {
            Some(_) if !model.is_printed() => Vec::new(),
            _ => model.equations.iter().map(math::equation).collect(),
        },
        quantities: quantities
            .map(|one| QuantityView {
                symbol_html: math::symbol(&one.name),
                words: match (one.description.as_str(), one.unit.as_str()) {
                    ("", unit) => format!("in {}", typeset(unit)),
                    (words, "") => words.to_owned(),
                    (words, unit) => format!("{words}, in {}", typeset(unit)),
                },
            })
            .collect(),
        points: definition.operating_points.iter().map(point).collect(),
    }
}

fn point(point: &OperatingPointDefinition) -> PointView {
    // What is to be found is not told.
    let stated = point.at_text.iter().filter(|(name, _)| !point.solved.contains(name));
    let with_unit = |name: &str, unit: &str| match unit {
        "" => math::symbol(name),
        unit => format!("{} ({})", math::symbol(name), typeset(unit)),
    };
    PointView {
        title: point.title.clone(),
        rest_html: stated
            .map(|(name, text)| format!("{} = {}", math::symbol(name), super::answer_key::typed_value(text)))
            .collect(),
        input_html: with_unit(&point.input, &point.input_unit),
        output_html: with_unit(&point.output, &point.output_unit),
    }
}

fn question(lab: &LabDefinition, question: &Question) -> QuestionView {
    let optional = |required: bool| if required { "" } else { " (if you like)" };
    QuestionView {
        anchor: question_anchor(&question.id),
        number: question.number.clone(),
        title: question.title.clone(),
        points: counted(question.points, "point"),
        text_html: prose::to_html(&question.text),
        asked: question
            .fields
            .iter()
            .map(|field| AskedView {
                prompt: format!("{}{}", field.prompt.trim().trim_end_matches('.'), optional(field.required)),
                letters_html: letters(lab, &field.path),
            })
            .collect(),
    }
}

fn letters(lab: &LabDefinition, path: &str) -> String {
    let code = |name: &str| {
        let mut html = "<code>".to_owned();
        escape(&mut html, name);
        html + "</code>"
    };
    lab.sheet.letters.get(path).and_then(|own| own.words(code)).unwrap_or_default()
}
