//! Marks and reports for other programs: Canvas, Moodle, Gradescope, spreadsheets. Made from records alone; judges nothing.
//!
//! What an importer does with a file was read in its own source, which each module names. Two rules hold for all: a mark that
//! waits for a person is not passed on unless asked for, and whoever is left out is named with the reason.

mod canvas;
mod class_marks;
mod directory;
mod error;
mod feedback;
mod gradescope;
mod moodle;
mod numbers;
mod records;
mod summary;
mod table;
#[cfg(test)]
mod tests;
mod why;
mod workbook;
mod worksheet;

pub use canvas::{canvas_by_roster, canvas_filled};
pub use class_marks::{ClassMarks, Person, Rules};
pub use error::ExportError;
pub use feedback::{FeedbackFor, write_feedback};
pub use gradescope::{Wanted, gradescope};
pub use moodle::{Identity, moodle};
pub use numbers::points_of;
pub use records::Records;
pub use summary::{Export, LeftOut, Summary};
pub use why::Why;
pub use workbook::write_workbook;
pub use worksheet::worksheet;
