//! Many submissions: intake, in parallel, gradebook, statistics. Judges nothing.

mod gradebook;
mod intake;
mod marked;
mod results;
mod run;
mod statistics;

pub use intake::{AnswerFile, IntakeError, find_answer_files};
pub use marked::Marked;
pub use run::{ClassError, ClassJob, Outcome, grade_class, read_capped};
