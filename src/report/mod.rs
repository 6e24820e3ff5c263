//! Scorecard → view → figure → svg → html. Solves and awards nothing.

mod anchor;
mod answer_key;
mod answers;
mod class_analysis;
mod class_marks;
mod class_page;
mod class_summary;
mod compare_page;
mod conflicts;
mod derivation;
mod drawn;
mod escape;
#[cfg(test)]
mod explaining_tests;
pub mod figure;
pub mod figures;
mod given;
mod handout;
mod items;
mod kit;
mod ledger;
mod marked_equation;
mod math;
pub mod numbers;
mod opening;
mod pages;
mod pictures;
mod places;
pub mod prose;
mod quotes;
mod released;
mod student;
pub mod svg;
mod tangent;
#[cfg(test)]
mod tests;
mod view;

pub use anchor::{item_anchor, question_anchor};
pub use class_summary::{
    AnswersShared, Attainment, ClassRow, ClassSummary, Confusion, Explanation, IntakeEntry, IntakeKind,
    ItemStatistics, MistakeMade, People, Person, ReviewEntry, SharedAnswer,
};
pub use compare_page::compare_page;
pub use handout::{HandoutKit, HandoutStudent};
pub use kit::{ReportError, ReportKit};
