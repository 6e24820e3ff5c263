use super::{NonlinearityKind, TypedFormula, Unit};
use crate::algebra::{Expression, Rational};
use crate::lti::{Shape, Stability, TransferFunction};
use crate::source::{Finding, SourceText, Span};
use std::collections::BTreeMap;

/// Who handed it in. Both are the student's own text: hostile until escaped.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Student {
    pub id: String,
    pub name: String,
}

/// One answer file: what could be read, and the findings about what could not.
#[derive(Clone, Debug, PartialEq)]
pub struct Submission {
    /// File stem, unique in the class: names the report.
    pub id: String,
    pub source: SourceText,
    /// The lab the file says it answers.
    pub lab: Option<String>,
    pub students: Vec<Student>,
    /// By field path. What was left blank is absent.
    pub answers: BTreeMap<String, Answer>,
    pub findings: Vec<Finding>,
    /// False when the file as a whole could not be read (not YAML, too large, not text).
    pub readable: bool,
}

/// One answered field.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub path: String,
    pub span: Span,
    /// As typed.
    pub text: String,
    pub value: Result<AnswerValue, Unreadable>,
}

/// It was answered but cannot be read; the finding says why and how to write it.
#[derive(Clone, Debug, PartialEq)]
pub struct Unreadable {
    pub finding: Finding,
}

#[derive(Clone, Debug, PartialEq)]
pub enum AnswerValue {
    TransferFunction {
        /// As typed, nothing cancelled.
        transfer_function: TransferFunction,
        /// The formula it was read from, when given as text.
        formula: Option<Expression>,
    },
    /// `a ± bj` has been expanded into two.
    Poles(Vec<TypedComplex>),
    Value(FinalValue),
    Stability(Stability),
    Shape(Shape),
    Nonlinearity(NonlinearityKind),
    Formula(TypedFormula),
    /// Markdown as typed.
    Prose(String),
    Figure(Figure),
    Data(Series),
}

impl AnswerValue {
    /// Whether both are the same answer, wherever they stand in their files.
    pub fn is_the_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Poles(one), Self::Poles(two)) => {
                let typed = |pole: &TypedComplex| (pole.re.clone(), pole.im.clone());
                one.len() == two.len() && one.iter().map(typed).eq(two.iter().map(typed))
            }
            _ => self == other,
        }
    }
}

/// A decimal as typed: its text, its exact value, and the place of its last digit.
#[derive(Clone, Debug, PartialEq)]
pub struct Decimal {
    pub text: String,
    pub value: Rational,
    /// The last digit typed stands for 10^`last_place`: −4 for `0.0132`, 0 for `12`, −5 for `1.50e-3`.
    pub last_place: i32,
}

/// A complex number as typed, rad/s where it is a pole.
#[derive(Clone, Debug, PartialEq)]
pub struct TypedComplex {
    pub re: Decimal,
    pub im: Decimal,
    pub span: Span,
}

/// A value or a limit as typed.
#[derive(Clone, Debug, PartialEq)]
pub enum FinalValue {
    /// A number, and the unit typed behind it.
    Number(Decimal, Option<Unit>),
    /// `unbounded`, `diverges`, `does not exist`, `∞` without a sign.
    Unbounded,
    PlusInfinity,
    MinusInfinity,
}

/// A picture attached to the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// As the student wrote it.
    pub file_name: String,
    /// `image/png` or `image/jpeg`, decided by the bytes.
    pub media_type: &'static str,
    pub bytes: Vec<u8>,
    pub width: u32,
    pub height: u32,
}

/// Columns of numbers: time first (s), then one or more values.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// As the student wrote it, or `inline`.
    pub file_name: String,
    /// One header a column; empty strings when the file has no header row.
    pub headers: Vec<String>,
    /// `rows[i][0]` is time; all rows have as many values as there are headers; all finite.
    pub rows: Vec<Vec<f64>>,
}
