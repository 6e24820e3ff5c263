use super::{Answer, AnswerValue, Unit};
use crate::algebra::Rational;
use crate::lti::InputKind;
use std::collections::{BTreeMap, BTreeSet};

/// What kind of answer a field takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldKind {
    /// Text (`-0.06s/(…)`, also in letters) or `{num: […], den: […]}`.
    TransferFunction,
    /// A list of complex numbers; `±` gives two.
    Poles,
    /// A number, with `unbounded` and its like where a limit does not exist.
    Value,
    /// Stable, marginally stable, unstable.
    Stability,
    /// General shape of a response.
    Shape,
    /// Saturation, dead zone, backlash, …
    Nonlinearity,
    /// A linear function, as an equation or its right side: `y = 6x - 9`.
    Formula,
    /// Markdown with `$math$`.
    Prose,
    /// Path of a PNG or JPEG beside the answer file.
    Figure,
    /// Path of a CSV (t, y, …) beside the answer file, or the CSV itself as a text block.
    Data,
}

/// One thing the answer file may hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Dotted path in the answer file: `hanging.response.poles`.
    pub path: String,
    pub kind: FieldKind,
    /// The question it belongs to.
    pub question: String,
    /// What is asked, one line, for the answer template.
    pub prompt: String,
    /// Fields with the same tag speak of the same system and can be held against each other (`cart.hanging`).
    pub about: Option<String>,
    /// The response a value, shape, data or prose field describes: what drives the system. `None` where it describes none.
    pub response: Option<InputKind>,
    /// What a value is asked in, where the lab says so.
    pub unit: Option<Unit>,
    /// Needed for full marks.
    pub required: bool,
}

/// Everything an answer file may hold. It has no right answers in it, on purpose: `check` sees only this.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AnswerSheet {
    pub lab: String,
    pub title: String,
    pub fields: Vec<Field>,
    /// Letters that may stand in formulas, with the handout's values.
    pub symbols: BTreeMap<String, Rational>,
    /// Other spellings of them: what is written → the lab's own name.
    pub also: BTreeMap<String, String>,
    /// What besides holds for one field's letters, by its path.
    pub letters: BTreeMap<String, FieldLetters>,
}

/// Whether a formula is asked for in letters or with numbers put in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum AnsweredIn {
    #[default]
    Either,
    Letters,
    Numbers,
}

/// Letters of one field.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct FieldLetters {
    pub answered_in: AnsweredIn,
    /// Values at rest with a letter of their own, `h_0`, with the lab's values.
    pub symbols: BTreeMap<String, Rational>,
    /// Other spellings of them: `h` → `h_0`.
    pub also: BTreeMap<String, String>,
    /// The letters that are of use in this field, for whoever has to write it; empty where numbers are asked for.
    pub names: Vec<LetterName>,
    /// Of a tangent: what it is a tangent of.
    pub line: Option<LineNames>,
    /// Those of them that students are to find themselves, where nobody may tell: their values here are stand-ins.
    pub untold: BTreeSet<String>,
}

/// A letter, and other ways to write it.
#[derive(Clone, Debug, PartialEq)]
pub struct LetterName {
    pub name: String,
    pub also: Vec<String>,
}

impl FieldLetters {
    /// `in the letters A, k (or c_v)`, each name put in marks by `mark`; `None` where no letters may be used.
    pub fn words(&self, mark: impl Fn(&str) -> String) -> Option<String> {
        let each = |one: &LetterName| match one.also.as_slice() {
            [] => mark(&one.name),
            also => {
                let also: Vec<String> = also.iter().map(|name| mark(name)).collect();
                format!("{} (or {})", mark(&one.name), also.join(", "))
            }
        };
        let names: Vec<String> = self.names.iter().map(each).collect();
        let before = match self.answered_in {
            AnsweredIn::Letters => "in the letters",
            AnsweredIn::Either => "in numbers, or in the letters",
            AnsweredIn::Numbers => return None,
        };
        (!names.is_empty()).then(|| format!("{before} {}", names.join(", ")))
    }
}

/// The names in the equation of a tangent.
#[derive(Clone, Debug, PartialEq)]
pub struct LineNames {
    pub output: String,
    pub input: String,
    /// Coordinates and inputs, whose values at rest are `x_0`.
    pub at_rest: Vec<String>,
}

impl AnswerSheet {
    /// Whether an answer is a formula with a letter in it whose value is not told, so that its numbers say nothing.
    pub fn leans_on_untold(&self, answer: &Answer) -> bool {
        let Ok(AnswerValue::TransferFunction { formula: Some(formula), .. }) = &answer.value else {
            return false;
        };
        let Some(own) = self.letters.get(&answer.path) else { return false };
        formula.symbols().iter().any(|symbol| own.untold.contains(&symbol.name))
    }
}
