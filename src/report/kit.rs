use super::anchor::question_anchor;
use super::drawn::Drawn;
use super::figure::FigureError;
use super::figures::parting_words;
use super::pictures::{self, Picture};
use super::tangent::good_words;
use super::{answers, prose};
use crate::lab::{LabDefinition, Question, SystemRef};
use crate::reference::Reference;
use crate::submission::{AnsweredIn, FieldKind};
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior};

/// Everything in the reports that does not depend on a student: templates read, question texts and reference figures rendered.
///
/// Made once a lab and shared between threads.
pub struct ReportKit {
    pub(super) environment: Environment<'static>,
    pub(super) lab: LabDefinition,
    pub(super) reference: Reference,
    pub(super) questions: Vec<QuestionKit>,
    pub(super) drawn: Drawn,
}

/// A question, ready to be shown.
pub(super) struct QuestionKit {
    pub anchor: String,
    pub text_html: String,
    pub fields: Vec<FieldKit>,
    pub pictures: Vec<Picture>,
    /// Below the figures: how far the linear model may be trusted. Empty where nothing linear is asked about.
    pub remark: String,
}

/// A field of the answer and what would have been right.
pub(super) struct FieldKit {
    pub path: String,
    pub prompt: String,
    pub kind: FieldKind,
    pub reference_html: String,
    /// The same in letters, to stand before it; empty where there are none.
    pub letters_html: String,
    pub answered_in: AnsweredIn,
}

#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error("a figure of question `{question}` cannot be drawn: {source}")]
    Figure { question: String, source: FigureError },
    #[error("the template `{name}` cannot be read: {source}")]
    Template { name: &'static str, source: minijinja::Error },
}

/// Bytes of students' figures that are kept; where students have numbers of their own there are many kits.
const MOST_DRAWN: usize = 32 << 20;
const MOST_DRAWN_OF_MANY: usize = 1 << 20;

const TEMPLATES: [(&str, &str); 9] = [
    ("base.html", include_str!("../../templates/base.html")),
    ("parts.html", include_str!("../../templates/parts.html")),
    ("style.css", include_str!("../../templates/style.css")),
    ("student.html", include_str!("../../templates/student.html")),
    ("derivation.html", include_str!("../../templates/derivation.html")),
    ("reference.html", include_str!("../../templates/reference.html")),
    ("handout.html", include_str!("../../templates/handout.html")),
    ("compare.html", include_str!("../../templates/compare.html")),
    ("class.html", include_str!("../../templates/class.html")),
];

impl ReportKit {
    /// Errors: a reference curve that cannot be drawn.
    pub fn new(lab: &LabDefinition, reference: &Reference) -> Result<Self, ReportError> {
        Self::within(environment()?, lab, reference, MOST_DRAWN)
    }

    /// The same for a lab with other numbers, and what is right by them.
    pub fn with_numbers(&self, lab: &LabDefinition, reference: &Reference) -> Result<Self, ReportError> {
        Self::within(self.environment.clone(), lab, reference, MOST_DRAWN_OF_MANY)
    }

    fn within(
        environment: Environment<'static>,
        lab: &LabDefinition,
        reference: &Reference,
        most_drawn: usize,
    ) -> Result<Self, ReportError> {
        let questions =
            lab.questions.iter().map(|q| QuestionKit::new(lab, reference, q)).collect::<Result<_, _>>()?;
        let drawn = Drawn::new(most_drawn);
        Ok(Self { environment, lab: lab.clone(), reference: reference.clone(), questions, drawn })
    }
}

/// The templates, read.
pub(super) fn environment() -> Result<Environment<'static>, ReportError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build();
    environment.set_syntax(syntax.map_err(|source| ReportError::Template { name: "base.html", source })?);
    for (name, source) in TEMPLATES {
        environment.add_template(name, source).map_err(|source| ReportError::Template { name, source })?;
    }
    environment.add_global("version", env!("CARGO_PKG_VERSION"));
    Ok(environment)
}

/// A page.
pub(super) fn render(environment: &Environment<'_>, template: &str, page: &impl serde::Serialize) -> String {
    let mut bytes = Vec::new();
    render_into(&mut bytes, environment, template, page);
    String::from_utf8(bytes).unwrap_or_default()
}

/// A page at the end of `bytes`, in UTF-8.
pub(super) fn render_into(
    bytes: &mut Vec<u8>,
    environment: &Environment<'_>,
    template: &str,
    page: &impl serde::Serialize,
) {
    let before = bytes.len();
    let rendered =
        environment.get_template(template).and_then(|t| t.render_captured_to(Serde(page), &mut *bytes));
    // Templates and views are ours, and tested together; if they disagree all the same, the reader is told.
    if let Err(e) = rendered {
        let words = prose::as_typed(&format!("polemark could not write this page: {e:#}"));
        bytes.truncate(before);
        bytes.extend(format!("<!doctype html><html lang=\"en\"><title>Report</title>{words}</html>").bytes());
    }
}

impl QuestionKit {
    fn new(lab: &LabDefinition, reference: &Reference, question: &Question) -> Result<Self, ReportError> {
        let fields = question
            .fields
            .iter()
            .map(|f| FieldKit {
                path: f.path.clone(),
                prompt: f.prompt.trim().trim_end_matches('.').to_owned(),
                kind: f.kind,
                reference_html: answers::reference(reference, &question.criteria, &f.path),
                letters_html: match f.answered_in {
                    AnsweredIn::Numbers => String::new(),
                    _ => answers::letters(reference, &question.criteria, &f.path),
                },
                answered_in: f.answered_in,
            })
            .collect();
        let pictures = pictures::of_question(lab, reference, question)
            .map_err(|source| ReportError::Figure { question: question.id.clone(), source })?;
        let remark = pictures::systems(question)
            .iter()
            .filter_map(|system| trust(reference, system))
            .collect::<Vec<_>>()
            .join(" ");
        Ok(Self {
            anchor: question_anchor(&question.id),
            text_html: prose::to_html(&question.text),
            fields,
            pictures,
            remark,
        })
    }
}

/// How far the linear model of `system` may be trusted, in words.
pub(super) fn trust(reference: &Reference, system: &SystemRef) -> Option<String> {
    let point = answers::find(reference, system)?;
    if let Some(tangent) = &point.tangent {
        return Some(good_words(point, tangent));
    }
    let run = point.comparison.as_ref()?;
    Some(parting_words(point, &run.asked, run))
}
