//! Scorecard → view → figure → svg → html. Solves and awards nothing.

mod anchor;
mod class_summary;
mod escape;
pub mod figure;
pub mod numbers;
pub mod prose;
pub mod svg;

pub use anchor::{item_anchor, question_anchor};
pub use class_summary::{ClassRow, ClassSummary, QuestionMean, ReviewEntry};
