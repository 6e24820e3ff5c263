//! What was answered: an answer file read into values and findings. Knows no lab and no right answer.

mod answer;
mod answer_hash;
mod attachments;
mod beside;
mod beyond_formula;
mod called;
mod comma_to_point;
mod decimal;
mod decimal_commas;
mod figure;
mod formula;
mod formula_answer;
mod half_said;
mod letters;
mod own_claims;
mod people;
mod poles;
mod printed_poles;
mod problem;
mod read;
mod read_as;
mod salvage;
mod self_check;
mod series;
mod sheet;
mod stated_line;
mod unit;
mod unworkable;
mod value;
mod words;
mod wrapping;

pub use formula_answer::TypedFormula;
pub use stated_line::{LinePlace, StatedForm, StatedLine};

/// A formula as typed, for tests of what judges it.
#[cfg(test)]
pub(crate) fn read_formula(text: &str) -> Option<TypedFormula> {
    TypedFormula::read(text).ok()
}

pub use answer::{
    Answer, AnswerValue, Decimal, Figure, FinalValue, Series, Student, Submission, TypedComplex, Unreadable,
};
pub use answer_hash::hash_of_fields;
pub use attachments::{AttachmentError, Attachments, Folder, MAX_ATTACHMENT_BYTES, NoFiles, plain_path};
pub use own_claims::{Behaviour, ContradictedClaim, Knowledge, behaviour, claims_about, contradicted_claims};
pub use read::{MAX_PROSE_BYTES, read};
pub use self_check::self_check;
pub use sheet::{AnswerSheet, AnsweredIn, Field, FieldKind, FieldLetters, LetterName, LineNames};
pub use unit::{Unit, UnitRatio};
pub use words::{
    NonlinearityKind, nonlinearity_name, nonlinearity_word, shape_name, shape_word, stability_name,
    stability_word,
};

#[cfg(test)]
mod tests;
