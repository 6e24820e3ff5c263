//! Scorecard → view → figure → svg → html. Solves and awards nothing.

mod anchor;
mod answer_key;
mod answers;
mod class_page;
mod class_summary;
mod escape;
pub mod figure;
pub mod figures;
mod kit;
mod math;
pub mod numbers;
mod pictures;
pub mod prose;
mod student;
pub mod svg;
#[cfg(test)]
mod tests;
mod view;

pub use anchor::{item_anchor, question_anchor};
pub use class_summary::{ClassRow, ClassSummary, QuestionMean, ReviewEntry};
pub use kit::{ReportError, ReportKit};
