use super::{AskedFeature, AskedRest, MistakesRule, NearMiss, Points, VariantRule};
use crate::algebra::{Expression, Rational};
use crate::lti::InputKind;
use crate::model::{Comparison, Equilibrium, LinearForm, Model, Rest, TangentRule};
use crate::nonlinear::{Chain, Nonlinearity};
use crate::prose::Phrase;
use crate::source::{SourceText, Span};
use crate::submission::{AnswerSheet, AnsweredIn, FieldKind, NonlinearityKind, Submission};
use std::collections::BTreeSet;
use std::fmt;

/// A lab, checked: every name resolves, points add up, equations parse.
#[derive(Clone, Debug)]
pub struct LabDefinition {
    pub id: String,
    pub title: String,
    pub course: String,
    /// Where the lab comes from, one line.
    pub source_note: String,
    pub outcomes: Vec<Outcome>,
    /// With the values this definition was made with: the lab's own, or a variant's.
    pub parameters: Vec<Parameter>,
    /// The parameters that differ from student to student; `None` when everyone has the lab's own.
    pub variants: Option<VariantRule>,
    pub models: Vec<ModelDefinition>,
    pub simulations: Vec<SimulationDefinition>,
    pub questions: Vec<Question>,
    /// Rows a person marks while watching the lab session.
    pub observed: Vec<ObservedRow>,
    pub cover: Cover,
    /// The highest first; empty where the lab states none.
    pub grades: Vec<Grade>,
    pub release: Release,
    pub follow_through: FollowThroughRule,
    pub mistakes: MistakesRule,
    /// Values stated by hand or taken from an independent program; `verify` holds the computed ones against them.
    pub expectations: Vec<Expectation>,
    /// The model answer, assembled from the questions' `model_answer`, read like any submission.
    pub model_answer: Submission,
    /// Answers that are not quite right, and what they must earn.
    pub near_misses: Vec<NearMiss>,
    /// What an answer file may hold; no right answers in it.
    pub sheet: AnswerSheet,
    pub text: SourceText,
}

/// What part of the points is earned by what is wrong by the reference, but follows rightly from an earlier answer (0..=1).
#[derive(Clone, Debug, PartialEq)]
pub struct FollowThroughRule {
    /// Poles, responses, words and prose that are right for the student's own transfer function or poles.
    pub credit: Rational,
    /// A later transfer function with the same mistake as an earlier one.
    pub same_mistake: Rational,
}

/// A learning outcome: `a`, and what it says.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    pub id: String,
    pub text: String,
    /// The share of the points assessing it that a student should earn (0..=1).
    pub target: Option<Rational>,
}

/// A grade and the fewest points of the cover sheet that earn it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grade {
    pub name: String,
    pub from: Points,
}

/// What students get to see in their reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Release {
    /// Points.
    pub marks: bool,
    /// Verdicts and reasons.
    pub feedback: bool,
    /// Right answers, and what tells them.
    pub solutions: bool,
}

impl Release {
    pub const ALL: Self = Self { marks: true, feedback: true, solutions: true };
}

#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub name: String,
    /// Of a derived one, what follows from the lab's own values of the others; the nearest `f64` when that is irrational.
    pub value: Rational,
    /// As typed in the lab file; of a derived one, its value.
    pub text: String,
    /// The formula its value follows from, and the text of it.
    pub formula: Option<(String, Expression)>,
    pub unit: String,
    pub description: String,
    /// Other values taken as right, exactly, each with its text as typed. A set, never a band.
    pub accepted: Vec<(String, Rational)>,
    /// Values often used wrongly, each with its text as typed.
    pub mistaken: Vec<(String, Rational)>,
}

#[derive(Clone, Debug)]
pub struct ModelDefinition {
    pub id: String,
    pub title: String,
    pub model: Model,
    /// How the model was given, when it was given as a linear one.
    pub linear: Option<LinearForm>,
    pub operating_points: Vec<OperatingPointDefinition>,
}

#[derive(Clone, Debug)]
pub struct OperatingPointDefinition {
    pub id: String,
    pub title: String,
    /// With the lab's own parameter values.
    pub at: Equilibrium,
    /// The same for any values of the parameters.
    pub rest: Rest,
    /// The equilibrium as typed, (name, text): `("theta", "pi")`; of a value that is solved for, what was found.
    pub at_text: Vec<(String, String)>,
    /// Names of what was solved for: students are to find it.
    pub solved: BTreeSet<String>,
    pub input: String,
    pub input_unit: String,
    pub output: String,
    pub output_unit: String,
    /// How the linear model is held against the nonlinear equations; `None` where the lab does not say.
    pub comparison: Option<Comparison>,
    /// How a static function is shown beside its tangent; `None` of what moves.
    pub tangent: Option<TangentRule>,
    pub span: Span,
}

/// A block chain simulated with and without its nonlinearity.
#[derive(Clone, Debug)]
pub struct SimulationDefinition {
    pub id: String,
    pub title: String,
    pub chain: Chain,
    pub duration_s: f64,
    /// What the output is, and its unit: `speed`, `rad/s`.
    pub output: String,
    pub output_unit: String,
    /// What drives it, and its unit: `armature voltage`, `V`.
    pub input: String,
    pub input_unit: String,
    /// The nonlinearity shown in the figures (the first in the chain).
    pub nonlinearity: Nonlinearity,
    /// Shown in the question of this id.
    pub shown_in: String,
    /// Names of parameters in its formulas.
    pub letters: BTreeSet<String>,
}

#[derive(Clone, Debug)]
pub struct Question {
    /// Dotted path, the answer's key: `hanging.response`.
    pub id: String,
    /// As on the handout: `Task 1, question 4`.
    pub number: String,
    pub title: String,
    /// Markdown.
    pub text: String,
    pub points: Points,
    pub outcomes: Vec<String>,
    /// `<model>.<operating point>` or the id of a simulation, when the lab says so.
    pub about: Option<String>,
    pub fields: Vec<QuestionField>,
    pub criteria: Vec<Criterion>,
}

/// A field of the answer: its full path, kind, prompt.
#[derive(Clone, Debug, PartialEq)]
pub struct QuestionField {
    pub path: String,
    pub kind: FieldKind,
    pub prompt: String,
    /// Needed for full marks.
    pub required: bool,
    /// For a transfer function: in letters, with numbers put in, or as one likes.
    pub answered_in: AnsweredIn,
}

/// A response of a system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Described {
    pub of: SystemRef,
    pub response: InputKind,
}

/// What earns points.
#[derive(Clone, Debug)]
pub struct Criterion {
    /// Full path: `hanging.transfer_function.numerator`.
    pub id: String,
    /// In words, for the report: `Numerator`.
    pub title: String,
    pub points: Points,
    /// The answer field that is judged.
    pub field: String,
    /// What part of the points follow-through earns here (0..=1): the lab's, unless the criterion has its own.
    pub follow_through: Rational,
    pub check: Check,
    pub span: Span,
}

impl Criterion {
    /// Every answer field that its mark may rest on: of a plot, the figure and its data.
    pub fn fields(&self) -> Vec<&str> {
        let data = match &self.check {
            Check::Plot { data, .. } => data.as_deref(),
            _ => None,
        };
        [Some(self.field.as_str()), data.filter(|data| *data != self.field)].into_iter().flatten().collect()
    }
}

/// Which model at which operating point.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SystemRef {
    pub model: String,
    pub operating_point: String,
}

/// `cart.hanging`
impl fmt::Display for SystemRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.model, self.operating_point)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Check {
    /// Orders of numerator and denominator and zeros at the origin, common factors cancelled.
    Structure {
        of: SystemRef,
    },
    /// Numerator right, given the common factor that the denominator (or most coefficients) sets.
    Numerator {
        of: SystemRef,
        tolerance: Tolerance,
    },
    /// Denominator right; a single coefficient off in its digits but of the right sign earns `one_slip` of the points (0..=1).
    Denominator {
        of: SystemRef,
        tolerance: Tolerance,
        one_slip: Rational,
    },
    /// The set of poles, with multiplicity and conjugates.
    Poles {
        of: SystemRef,
        tolerance: Tolerance,
        /// Relative tolerance of a coefficient: poles of a denominator within it are right as well.
        coefficients: Rational,
    },
    /// The word, against the transfer function's stability.
    Stability {
        of: SystemRef,
    },
    Feature {
        of: SystemRef,
        response: InputKind,
        feature: AskedFeature,
        tolerance: Tolerance,
    },
    /// What a coordinate, an output or an input is worth where nothing moves.
    Rest {
        of: SystemRef,
        asked: AskedRest,
        tolerance: Tolerance,
        /// In place of it where the value is 0.
        tolerance_of_zero: Tolerance,
    },
    Shape {
        of: SystemRef,
        response: InputKind,
    },
    /// `field` is the figure; `data` the field of the series. Data is compared with the curve; a figure alone waits for a person.
    Plot {
        data: Option<String>,
        curve: Curve,
        tolerance: Tolerance,
        min_points: usize,
        span_s: f64,
    },
    /// Stated concepts in prose. Provisional always.
    Concepts {
        concepts: Vec<Concept>,
        needed: usize,
        contradictions: Vec<Concept>,
        /// The response the prose is about, when it is about one: its claims are held against that response.
        describes: Option<Described>,
    },
    /// The tangent of a static function.
    Tangent {
        of: SystemRef,
        tolerance: Tolerance,
        form: LineForm,
        /// What part of the points is left by the other form (0..=1).
        other_form: Rational,
    },
    /// The class of a nonlinearity.
    Nonlinearity {
        expected: NonlinearityKind,
    },
}

impl Check {
    /// The system whose transfer function it judges.
    pub fn transfer_function(&self) -> Option<&SystemRef> {
        match self {
            Self::Structure { of } | Self::Numerator { of, .. } | Self::Denominator { of, .. } => Some(of),
            _ => None,
        }
    }

    /// The system behind what it judges, its transfer function included.
    pub fn system(&self) -> Option<&SystemRef> {
        match self {
            Self::Poles { of, .. }
            | Self::Stability { of }
            | Self::Feature { of, .. }
            | Self::Rest { of, .. }
            | Self::Shape { of, .. }
            | Self::Tangent { of, .. }
            | Self::Concepts { describes: Some(Described { of, .. }), .. }
            | Self::Plot { curve: Curve::Response { of, .. }, .. } => Some(of),
            _ => self.transfer_function(),
        }
    }
}

/// The two ways to write a tangent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineForm {
    /// y = 6x − 9
    Line,
    /// δy = 6 δx
    Deviations,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    Response {
        of: SystemRef,
        response: InputKind,
    },
    /// With the nonlinearity in place.
    Simulation {
        id: String,
    },
}

/// Right within max(absolute, relative · |expected|), or when correctly rounded to at least `figures` figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    pub absolute: Rational,
    /// When the lab leaves `absolute` to polemark: it is no wider than this part of the scale that the expected number
    /// belongs to, and beside a number that is not zero no wider than a tenth of it. `None`: as stated, whatever the scale.
    pub of_scale: Option<Rational>,
    pub relative: Rational,
    pub figures: Option<u32>,
}

/// Something prose may say: any of the phrases. A phrase is words in order with at most a few between;
/// `oscillat*` matches the beginning of a word.
#[derive(Clone, Debug, PartialEq)]
pub struct Concept {
    pub id: String,
    /// In words, for the report: `it oscillates about the bottom`.
    pub title: String,
    pub phrases: Vec<Phrase>,
}

/// A row of the observation sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservedRow {
    pub id: String,
    pub title: String,
    pub outcomes: Vec<String>,
    pub points: Points,
    /// Best first.
    pub levels: Vec<Level>,
}

/// `from`..=`to` points and what earns them.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    pub title: String,
    pub from: Points,
    pub to: Points,
    pub text: String,
}

/// How the parts make up the total.
#[derive(Clone, Debug, PartialEq)]
pub struct Cover {
    pub rows: Vec<CoverRow>,
    pub total: Points,
}

/// A box of the cover sheet: `Lab performance`, 65.
#[derive(Clone, Debug, PartialEq)]
pub struct CoverRow {
    pub id: String,
    pub title: String,
    pub points: Points,
    pub from: CoverSource,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoverSource {
    /// points · (earned by questions + earned by observed rows) / (possible by both), rounded to hundredths.
    QuestionsAndObserved,
    /// points · earned by questions / possible.
    Questions,
    /// points · earned by observed rows / possible.
    Observed,
    /// Given by a person.
    ByHand,
}

/// `path` into the reference, and what it must be to so many digits.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// `cart.hanging.poles`, `saturation.peak_with`: see docs/lab-file.md.
    pub path: String,
    pub values: Vec<ExpectedValue>,
    /// Relative agreement demanded of each.
    pub relative: f64,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExpectedValue {
    Number(f64),
    Complex(f64, f64),
    Word(String),
}
