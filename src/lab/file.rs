//! The lab file as typed: serde mirrors of the YAML, nothing checked yet. Each field's comment is its manual.

use super::linear_file::{ChannelFile, LinearFile};
use super::schema;
pub(super) use super::spanned::Spanned;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserialize, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// A scalar as typed, and where. Numbers stay text until they are read exactly.
pub(super) type Text = Spanned<String>;

/// A mapping in file order, each key with its place.
#[derive(Clone, Debug)]
pub(super) struct Entries<T>(pub Vec<(Text, T)>);

impl<T> Default for Entries<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Entries<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntriesVisitor<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for EntriesVisitor<T> {
            type Value = Entries<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a mapping")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }

        deserializer.deserialize_map(EntriesVisitor(PhantomData))
    }
}

/// A whole lab file.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LabFile {
    /// The lab's id: lower-case letters, digits, `-` and `_`. Answer files name it.
    pub lab: Text,
    /// Title, one line. Default: the id in words.
    pub title: Option<String>,
    /// Course, one line.
    #[serde(default)]
    pub course: String,
    /// Where the lab comes from, one line.
    #[serde(default)]
    pub source: String,
    /// Learning outcomes by id: `a: …`, or `a: {text: …, target: 0.6}`.
    #[serde(default)]
    pub outcomes: Entries<OutcomeForm>,
    /// Physical parameters by the letter the equations use.
    #[serde(default)]
    pub parameters: Entries<ParameterFile>,
    /// Who gets which values of the parameters that vary from student to student.
    pub variants: Option<Spanned<VariantsFile>>,
    /// Systems given by equations of motion, by id.
    #[serde(default)]
    pub models: Entries<ModelFile>,
    /// Block chains with a nonlinearity in them, by id.
    #[serde(default)]
    pub simulations: Entries<SimulationFile>,
    /// How near is right.
    #[serde(default)]
    pub tolerances: TolerancesFile,
    /// What follows rightly from a student's own earlier answer.
    #[serde(default)]
    pub follow_through: FollowThroughFile,
    /// What is looked for in a wrong transfer function.
    #[serde(default)]
    pub mistakes: MistakesFile,
    /// What all questions add up to, points. Default: what they do.
    pub total: Option<Text>,
    /// The questions by id, in the order of the handout. The id is the answer's key and may have dots.
    pub questions: Entries<QuestionFile>,
    /// The observation sheet a person fills in during the session.
    #[serde(default)]
    pub observed: ObservedFile,
    /// How the parts make up the total. Default: one row, of the questions and of what is observed.
    pub cover: Option<CoverFile>,
    /// Grades and where each begins; the class page says how far each mark is from the next boundary. Default: none.
    #[serde(default)]
    pub grades: Vec<GradeFile>,
    /// What students get to see in their reports. Default: all of it.
    #[serde(default)]
    pub release: ReleaseFile,
    /// Values known independently; `verify` holds the computed ones against them. By path into the reference.
    #[serde(default)]
    pub expect: Entries<ExpectFile>,
}

/// A learning outcome; a text stands for an outcome without a target.
#[derive(Debug)]
pub(super) struct OutcomeForm(pub OutcomeFile);

/// A learning outcome.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutcomeFile {
    /// What it says.
    pub text: String,
    /// The share of the points assessing it that a student should earn, 0 to 1; the class page says how many do. Default: none.
    pub target: Option<Text>,
}

impl<'de> Deserialize<'de> for OutcomeForm {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OutcomeVisitor;

        impl<'de> Visitor<'de> for OutcomeVisitor {
            type Value = OutcomeForm;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("what the outcome says, or `{text, target}`")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<OutcomeForm, E> {
                Ok(OutcomeForm(OutcomeFile { text: text.to_owned(), target: None }))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OutcomeForm, A::Error> {
                OutcomeFile::deserialize(MapAccessDeserializer::new(map)).map(OutcomeForm)
            }
        }

        deserializer.deserialize_any(OutcomeVisitor)
    }
}

/// A grade.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GradeFile {
    /// `A`, `pass`.
    pub name: String,
    /// The fewest points of the cover sheet that earn it.
    pub from: Text,
}

/// What a report shows to students. What is not released stands in the instructor's edition.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ReleaseFile {
    /// Points. Default true.
    pub marks: Option<bool>,
    /// Verdicts and reasons, and what may explain a mistake. Default true.
    pub feedback: Option<bool>,
    /// Right answers and reference curves, and reasons that tell them. Default true.
    pub solutions: Option<bool>,
}

/// A physical parameter.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterFile {
    /// A decimal, read exactly. Give this or `formula`.
    pub value: Option<Text>,
    /// What its value follows from, of other parameters, numbers and `pi`: `k^2/(R*b)`. It then has no `accepted` or `mistaken`.
    pub formula: Option<Text>,
    /// `kg`, `m/s^2`; empty for none.
    #[serde(default)]
    pub unit: String,
    /// What it is, in words.
    #[serde(default)]
    pub description: String,
    /// Other values taken as right, exactly: a set, never a band. The lab's own value is not repeated.
    #[serde(default)]
    pub accepted: Vec<Text>,
    /// Values often used wrongly: looked for when a transfer function is wrong.
    #[serde(default)]
    pub mistaken: Vec<Text>,
    /// Other spellings of it in answers: `[J_m, Jm]`.
    #[serde(default)]
    pub also: Vec<Text>,
    /// Values students get in place of `value`, each student one of them: `[0.4, 0.5, 0.6]`, or `{from: 0.4, to: 0.6, step: 0.1}`.
    pub varies: Option<Spanned<VariesFile>>,
}

/// Values that students get: a list of them, or a range.
#[derive(Debug)]
pub(super) enum VariesFile {
    List(Vec<Text>),
    Range(RangeFile),
}

/// From one value to another in steps, both included.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RangeFile {
    /// The lowest.
    pub from: Text,
    /// The highest, a whole number of steps above.
    pub to: Text,
    /// > 0.
    pub step: Text,
}

impl<'de> Deserialize<'de> for VariesFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct VariesVisitor;

        impl<'de> Visitor<'de> for VariesVisitor {
            type Value = VariesFile;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of values, or `{from, to, step}`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(VariesFile::List(values))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                RangeFile::deserialize(MapAccessDeserializer::new(map)).map(VariesFile::Range)
            }
        }

        deserializer.deserialize_any(VariesVisitor)
    }
}

/// How students get their values.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VariantsFile {
    /// Any text, one line: another seed gives everyone other values. Default: the lab's id.
    pub seed: Option<Text>,
}

/// A system given by its equations of motion, or a linear one by `linear`.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelFile {
    /// Title, one line. Default: the id in words.
    pub title: Option<String>,
    /// Generalized coordinates by name. Needed without `linear`.
    #[serde(default)]
    pub coordinates: Spanned<Entries<QuantityFile>>,
    /// Inputs by name. Needed without `linear`; with it, default `u` (`u1`, `u2`, … of several).
    #[serde(default)]
    pub inputs: Spanned<Entries<QuantityFile>>,
    /// As many equations as coordinates, `left = right`, as printed on the handout. Needed without `linear`.
    #[serde(default)]
    pub equations: Spanned<Vec<Text>>,
    /// What is watched and is no coordinate, by name. Of a linear model default `y` (`y1`, `y2`, … of several).
    #[serde(default)]
    pub outputs: Entries<OutputFile>,
    /// Where the system is linearized, by id. Needed without `linear`.
    #[serde(default)]
    pub operating_points: Spanned<Entries<OperatingPointFile>>,
    /// A linear model, in place of coordinates, equations and operating points; it is at rest where everything is 0.
    pub linear: Option<Spanned<LinearFile>>,
    /// For `linear` with several inputs or outputs: which one is varied and which is watched, by id. Default: the only ones,
    /// under the id `linear`.
    #[serde(default)]
    pub channels: Spanned<Entries<ChannelFile>>,
}

/// A coordinate or an input.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuantityFile {
    /// `m`, `rad`, `N`; empty for none.
    #[serde(default)]
    pub unit: String,
    /// What it is, in words.
    #[serde(default)]
    pub description: String,
}

/// An output that is no coordinate.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputFile {
    /// `m`, `rad/s`; empty for none.
    #[serde(default)]
    pub unit: String,
    /// What it is, in words.
    #[serde(default)]
    pub description: String,
    /// Of coordinates, their derivatives, inputs and parameters: `x1 - x2`, `theta'`. Needed without `linear`.
    pub formula: Option<Text>,
}

/// An equilibrium and the input and output looked at there.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OperatingPointFile {
    /// Title, one line. Default: the id in words.
    pub title: Option<String>,
    /// Coordinates and inputs at rest: formulas of numbers, `pi` and parameters; or `solve` or `solve near 0.3` for whatever balances
    /// the equations, and nothing else does (nothing nearer). What is left out is 0.
    #[serde(default)]
    pub at: Entries<Text>,
    /// The input that is varied. Default: the only one.
    #[serde(default)]
    pub input: Text,
    /// The coordinate or output that is watched. Default: the only output; without outputs, the only coordinate.
    #[serde(default)]
    pub output: Text,
    /// How the linear model is held against the nonlinear equations. Default: over the time an impulse response is shown, with the
    /// impulse at which they part by a tenth of the linear peak and a fifth of it.
    pub comparison: Option<ComparisonFile>,
    /// For a system without derivatives: how its function is shown beside the tangent. Default: from 1 (or half the input, if that is
    /// more) below the operating point to as much above.
    pub tangent: Option<TangentFile>,
}

/// A static function beside its tangent.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TangentFile {
    /// The input from which the function is shown, below the operating point.
    pub from: Text,
    /// The input up to which it is shown, above the operating point.
    pub to: Text,
    /// What the tangent may be off by, as a part of the change it foretells, > 0. Default 0.1.
    pub departure: Option<Text>,
}

/// Linear against nonlinear, after an impulse at the input.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ComparisonFile {
    /// Seconds looked at, > 0.
    pub horizon_s: Text,
    /// Departure at which they are said to part, as a fraction of the linear peak: 0.1 is 10 %.
    pub departure: Text,
    /// Impulses drawn, input unit · s; at least one, none zero.
    pub pushes: Spanned<Vec<Text>>,
}

/// A source and a chain of blocks, run with and without its nonlinearities.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SimulationFile {
    /// Title, one line. Default: the id in words.
    pub title: Option<String>,
    /// What drives the chain.
    pub source: Spanned<SourceFile>,
    /// The blocks in the order the signal passes them.
    pub chain: Spanned<Vec<Spanned<BlockFile>>>,
    /// Seconds simulated, > 0.
    pub duration_s: Text,
    /// What drives it, for the axes.
    pub input: SignalNameFile,
    /// What comes out, for the axes.
    pub output: SignalNameFile,
    /// The question it is shown in.
    pub shown_in: Text,
}

/// What a signal is called.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SignalNameFile {
    /// `speed`.
    pub name: String,
    /// `rad/s`; empty for none.
    #[serde(default)]
    pub unit: String,
}

/// A driving signal.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum SourceFile {
    /// amplitude · sin(frequency · t + phase) + bias.
    Sine {
        /// In the input's unit.
        amplitude: Text,
        /// Angular frequency, > 0.
        frequency_rad_s: Text,
        /// Default 0.
        phase_rad: Option<Text>,
        /// Default 0.
        bias: Option<Text>,
    },
    /// `high` for the first part of each period, `low` for the rest.
    Pulse {
        /// Default 0.
        low: Option<Text>,
        /// In the input's unit.
        high: Text,
        /// > 0.
        period_s: Text,
        /// Part of the period spent high, 0 to 1. Default 0.5.
        duty: Option<Text>,
        /// `low` until then. Default 0.
        delay_s: Option<Text>,
    },
    /// 0, then `amplitude`.
    Step {
        /// In the input's unit.
        amplitude: Text,
        /// When it steps. Default 0.
        time_s: Option<Text>,
    },
}

/// A block of a chain.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum BlockFile {
    /// Holds the signal within ±`limit`.
    Saturation {
        /// > 0.
        limit: Text,
    },
    /// 0 within ±`threshold`; beyond it, the signal less the threshold.
    DeadZone {
        /// > 0.
        threshold: Text,
    },
    /// The play of a gear of total width `width` (Simulink's Backlash block).
    Backlash {
        /// > 0.
        width: Text,
    },
    /// ±`amplitude` after the sign of the input.
    Relay {
        /// > 0, in the output's unit.
        amplitude: Text,
        /// Half-width of the hysteresis, ≥ 0, in the input's unit. Default 0.
        hysteresis: Option<Text>,
        /// Half-width of the dead zone, ≥ 0, in the input's unit; above the hysteresis if there are both. Default 0.
        dead_zone: Option<Text>,
    },
    /// The nearest multiple of `interval` (Simulink's Quantizer block).
    Quantizer {
        /// > 0.
        interval: Text,
    },
    /// Limits how fast the signal changes (Simulink's Rate Limiter block).
    RateLimit {
        /// > 0, per second.
        rising: Text,
        /// < 0, per second.
        falling: Text,
    },
    /// sign(u)·(viscous·|u| + coulomb) (Simulink's Coulomb & Viscous Friction block).
    CoulombFriction {
        /// The offset, > 0, in the output's unit.
        coulomb: Text,
        /// The gain, ≥ 0, in the output's unit per the input's. Default 0.
        viscous: Option<Text>,
    },
    /// A proper transfer function; coefficients highest power first.
    TransferFunction {
        /// Numerator.
        num: Spanned<Vec<Text>>,
        /// Denominator.
        den: Spanned<Vec<Text>>,
    },
}

/// What part of the points an answer earns that is wrong by the reference but right for an earlier answer, 0 to 1.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FollowThroughFile {
    /// Of poles, responses, words and prose that are right for the student's own transfer function. Default 1.
    pub credit: Option<Text>,
    /// Of a later transfer function with the same mistake in it as an earlier one. Default 1.
    pub same_mistake: Option<Text>,
}

/// What is looked for in a wrong transfer function. The mistakes themselves are found from the equations.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MistakesFile {
    /// How likely a mistake is beside the others, by its code: a whole number, 0 to leave it out.
    #[serde(default)]
    pub weights: Entries<Text>,
    /// Mistakes that change no transfer function: a term (`equation 1: b*x'`) with all that can be done to it, or one change
    /// as a report tells it (`equation 1: b*x' -> 0`).
    #[serde(default)]
    pub without_effect: Vec<Text>,
}

/// How near is right, by kind of answer. A criterion may have a `tolerance` of its own.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TolerancesFile {
    /// Of transfer function coefficients. Default: relative 0.005.
    pub coefficients: Option<Spanned<ToleranceFile>>,
    /// Of poles and of values read off a response. Default: relative 0.01, figures 2, and an absolute of 0.001 but no more than a
    /// thousandth of the scale.
    pub values: Option<Spanned<ToleranceFile>>,
    /// Of data against a curve, of its largest |y|. Default: relative 0.02.
    pub plots: Option<Spanned<ToleranceFile>>,
}

/// Right within max(absolute, relative · |expected|), or when correctly rounded to at least so many figures.
#[derive(Clone, Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ToleranceFile {
    /// In the value's unit; the width that an expected zero has. Default 0.
    pub absolute: Option<Text>,
    /// Of the expected value, 0 to 1. Default 0.
    pub relative: Option<Text>,
    /// Significant figures, 1 to 15. Default: none, rounding does not excuse.
    pub figures: Option<Text>,
}

/// A question of the handout.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuestionFile {
    /// As on the handout: `Task 1, question 4`. Default: `Question 3` for the third.
    pub number: Option<String>,
    /// Title, one line. Default: the id in words.
    pub title: Option<String>,
    /// What is asked, in Markdown.
    #[serde(default)]
    pub text: String,
    /// Points; its criteria add up to them. Default: what its criteria, or its fields, add up to.
    pub points: Option<Text>,
    /// Ids of the outcomes it assesses.
    #[serde(default)]
    pub outcomes: Vec<Text>,
    /// What it is about: `<model>.<operating point>` or the id of a simulation. Default: the only operating point of the lab.
    pub about: Option<Text>,
    /// `impulse` or `step`: the response its criteria judge unless they say otherwise. Default: `step` for features that only
    /// step responses have, else `impulse`.
    #[schemars(extend("enum" = schema::responses()))]
    pub response: Option<Text>,
    /// The one field of the answer, under the question's own id. Give this or `fields`.
    pub answer: Option<FieldForm>,
    /// The fields of the answer by name; their paths are `<question id>.<name>`.
    #[serde(default)]
    pub fields: Entries<FieldForm>,
    /// What earns the points, by id. Default: the usual criteria of each field's kind.
    pub criteria: Option<Spanned<Entries<CriterionFile>>>,
    /// The answer that earns full marks, written as a student would.
    ///
    /// Not read here: its lines become an answer file, which is read like a student's.
    #[serde(default, rename = "model_answer")]
    #[schemars(with = "serde_json::Value")]
    pub _model_answer: IgnoredAny,
    /// Answers that are not quite right, and what they must earn: `verify` marks each by itself.
    #[serde(default)]
    pub near_misses: Vec<NearMissFile>,
}

/// An answer that is not quite right.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NearMissFile {
    /// The answer, written like `model_answer`. Of a question with `fields`, those it names; the others are the model answer's.
    #[serde(rename = "answer")]
    #[schemars(with = "serde_json::Value")]
    pub _answer: IgnoredAny,
    /// What the whole question earns with it, all other answers being the model answer's.
    pub points: Text,
    /// Why, one line.
    #[serde(default)]
    pub why: String,
}

/// A field of an answer; a word stands for a field of that `kind`: `poles`, `overshoot_percent`.
#[derive(Debug)]
pub(super) struct FieldForm(pub FieldFile);

/// A field of an answer.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FieldFile {
    /// `transfer_function`, `poles`, `value`, `stability`, `shape`, `nonlinearity`, `prose`, `figure` or `data`; or a feature, for
    /// the value of it; or `rest`, for a value at rest. Default: what `feature`, `value`, `expected` or `concepts` is for.
    #[schemars(extend("enum" = schema::kinds_and_features()))]
    pub kind: Option<Text>,
    /// What is asked for, one line. Default: the kind in words.
    pub prompt: Option<String>,
    /// For a `value`: the unit it is asked in, such as `rad/s`; `1` for a pure number. Default: that of the feature.
    pub unit: Option<Text>,
    /// For a `transfer_function`: `letters` when it is asked for in the lab's letters, `numbers` when with numbers put in. Default:
    /// either, or a mixture.
    #[serde(rename = "in")]
    pub answered_in: Option<Text>,
    /// Full marks can be had without it. Default false.
    #[serde(default)]
    pub optional: bool,
    /// Its points, in a question without `criteria`. Default: an equal share of what the other fields leave.
    pub points: Option<Text>,
    /// The operating point it is judged against, in a question without `criteria`. Default: the question's `about`.
    pub of: Option<Text>,
    /// `impulse` or `step`, in a question without `criteria`. Default: the question's `response`.
    #[schemars(extend("enum" = schema::responses()))]
    pub response: Option<Text>,
    /// For a `value`, in a question without `criteria`: `final_value`, `overshoot_percent`, … as for a criterion.
    #[schemars(extend("enum" = schema::features()))]
    pub feature: Option<Text>,
    /// For a value at rest, in a question without `criteria`: the coordinate, output or input whose value where nothing moves is
    /// asked for.
    pub value: Option<Text>,
    /// In place of the lab's, in a question without `criteria`.
    pub tolerance: Option<Spanned<ToleranceFile>>,
    /// For a `nonlinearity`, in a question without `criteria`: `saturation`, `dead zone`, …
    pub expected: Option<Text>,
    /// For `prose`, in a question without `criteria`: what it should say, by id.
    pub concepts: Option<Spanned<Entries<ConceptFile>>>,
    /// For a `formula`, in a question without `criteria`: `line` (y = 6x − 9) or `deviations` (δy = 6δx). Default `line`.
    pub form: Option<Text>,
    /// For a `formula`, in a question without `criteria`: the part of the points left by the other of the two forms, 0 to 1.
    /// Default 0.5.
    pub other_form: Option<Text>,
}

impl<'de> Deserialize<'de> for FieldForm {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        enum Form {
            Word(String),
            Keys(Box<FieldFile>),
        }

        struct FormVisitor;

        impl<'de> Visitor<'de> for FormVisitor {
            type Value = Form;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a kind of field such as `poles`, or a mapping")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<Form, E> {
                Ok(Form::Word(word.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Form, A::Error> {
                FieldFile::deserialize(MapAccessDeserializer::new(map)).map(|keys| Form::Keys(Box::new(keys)))
            }
        }

        impl<'de> Deserialize<'de> for Form {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(FormVisitor)
            }
        }

        let Spanned { value, defined } = Spanned::<Form>::deserialize(deserializer)?;
        Ok(Self(match value {
            Form::Word(value) => FieldFile { kind: Some(Spanned { value, defined }), ..FieldFile::default() },
            Form::Keys(keys) => *keys,
        }))
    }
}

/// What earns points. Which keys a criterion takes depends on its `check`.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CriterionFile {
    /// In words, for the report. Default: the id in words.
    pub title: Option<String>,
    /// Points, in hundredths at the finest. Default: an equal share of what the other criteria leave.
    pub points: Option<Text>,
    /// The field judged, by name. Default: the field whose name is the criterion's id, or its beginning up to a dot; else the
    /// only field.
    pub field: Option<Text>,
    /// `structure`, `numerator`, `denominator`, `poles`, `stability`, `feature`, `rest`, `shape`, `plot`, `concepts` or `nonlinearity`.
    #[schemars(extend("enum" = schema::checks()))]
    pub check: Text,
    /// The operating point judged against. Default: the question's `about`.
    pub of: Option<Text>,
    /// `impulse` or `step`. Default: the question's `response`. For `feature`, `shape`, `plot`.
    #[schemars(extend("enum" = schema::responses()))]
    pub response: Option<Text>,
    /// For `feature`: `initial_value`, `final_value`, `peak`, `period_s`, … as the manual lists them.
    #[schemars(extend("enum" = schema::features()))]
    pub feature: Option<Text>,
    /// For `rest`: the coordinate, output or input whose value where nothing moves is asked for.
    pub value: Option<Text>,
    /// In place of the lab's.
    pub tolerance: Option<Spanned<ToleranceFile>>,
    /// For `denominator`: the part of the points that a single mistyped coefficient leaves, 0 to 1. Default 0.
    pub one_slip: Option<Text>,
    /// For `feature`: the part of the points left by what is right under another convention (5 % for 2 %), 0 to 1. Default 0.
    pub other_convention: Option<Text>,
    /// In place of the lab's `credit`, for what rests on an earlier answer: 0 to 1.
    pub follow_through: Option<Text>,
    /// For `plot`: the field with the data. Default: none, only a figure can be handed in.
    pub data: Option<Text>,
    /// For `plot`: fewest data points that are compared. Default 10.
    pub min_points: Option<Text>,
    /// For `plot`: seconds the data must span, > 0. Needed when there is `data`.
    pub span_s: Option<Text>,
    /// For `concepts`: what the prose should say, by id.
    pub concepts: Option<Spanned<Entries<ConceptFile>>>,
    /// For `concepts`: how many of them must be there. Default: all.
    pub needed: Option<Text>,
    /// For `concepts`: what it must not say, by id.
    pub contradictions: Option<Entries<ConceptFile>>,
    /// For `concepts`: `impulse` or `step` when the prose describes that response of the operating point; what it claims is
    /// then held against the numbers. Default: it describes none.
    #[schemars(extend("enum" = schema::responses()))]
    pub describes: Option<Text>,
    /// For `tangent`: `line` (y = 6x − 9) or `deviations` (δy = 6δx). Default `line`.
    pub form: Option<Text>,
    /// For `tangent`: the part of the points left by the other of the two forms, 0 to 1. Default 0.5.
    pub other_form: Option<Text>,
    /// For `nonlinearity`: `saturation`, `dead zone`, `backlash`, …
    pub expected: Option<Text>,
}

/// Something prose may say.
#[derive(Clone, Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConceptFile {
    /// In words, for the report: `it swings about the bottom`.
    pub title: String,
    /// Any of these says it. Words in order with at most a few between; `oscillat*` matches the beginning of a word.
    pub phrases: Spanned<Vec<Text>>,
}

/// The observation sheet.
#[derive(Debug, Default, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObservedFile {
    /// Levels of every row, best first.
    #[serde(default)]
    pub levels: Vec<LevelFile>,
    /// Rows by id.
    #[serde(default)]
    pub rows: Entries<ObservedRowFile>,
}

/// A level of the observation sheet: `from`..=`to` points.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LevelFile {
    /// `Meets expectation`.
    pub title: String,
    /// Fewest points of this level.
    pub from: Text,
    /// Most points of this level.
    pub to: Text,
}

/// A row of the observation sheet.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObservedRowFile {
    /// What is observed.
    pub title: String,
    /// Ids of the outcomes it assesses.
    #[serde(default)]
    pub outcomes: Vec<Text>,
    /// Most points; the best level ends there.
    pub points: Text,
    /// What earns each level, in the order of `levels`.
    pub texts: Spanned<Vec<String>>,
}

/// The cover sheet.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CoverFile {
    /// What the rows add up to, points. Default: what they do.
    pub total: Option<Text>,
    /// Boxes by id.
    pub rows: Entries<CoverRowFile>,
}

/// A box of the cover sheet.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CoverRowFile {
    /// `Lab performance`.
    pub title: String,
    /// Points of this box.
    pub points: Text,
    /// `questions_and_observed` or `questions` or `observed`, scaled to these points; or `by_hand`.
    #[schemars(extend("enum" = schema::sources()))]
    pub from: Text,
}

/// A value known independently. Give `value` or `values`.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExpectFile {
    /// A number, a complex number (`-0.0195 + 5.586j`) or a word.
    pub value: Option<Text>,
    /// Several of them, in the order of the reference.
    pub values: Option<Spanned<Vec<Text>>>,
    /// Agreement demanded of each, 0 to 1. Default 1e-9.
    pub relative: Option<Text>,
}
