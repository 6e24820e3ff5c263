//! Many submissions: intake, in parallel, gradebook, statistics. Judges nothing.

mod analysis;
mod compare;
mod desk;
mod fingerprint;
mod gradebook;
mod handouts;
mod intake;
mod kept;
mod marked;
mod marks_stub;
mod new_file;
mod numbers;
mod others;
mod outcome;
mod own_files;
mod record;
mod results;
mod roster;
mod run;
mod run_facts;
mod run_records;
mod statistics;
mod students_seen;
mod without_marks;
mod workplace;

pub use compare::{Change, Comparison, Standing, compare, comparison_csv, comparison_rows};
pub use gradebook::{GradebookCell, disarmed, gradebook_columns, gradebook_row};
pub use handouts::{HandoutError, Handouts, write_handouts};
pub use intake::{
    AnswerFile, Archive, ArchiveError, Aside, HandedIn, Intake, IntakeError, Lms, NotRead, Place, Superseded,
    WhyAside, find_answer_files, read_capped,
};
pub use marked::Marked;
pub use marks_stub::{MarksStub, StubError, appended};
pub(crate) use new_file::NewFile;
pub use numbers::read_with_own_values;
pub use others::OtherVariant;
pub use outcome::Outcome;
pub(crate) use own_files::is_own_file;
pub use record::{
    AdjustmentRecord, FindingRecord, HOLDS, ItemRecord, MarkRecord, Record, ReviewRecord, Status,
    StudentRecord,
};
pub use results::{Results, ResultsError, ResultsFacts};
pub use roster::{Roster, RosterError, RosterStudent};
pub(crate) use roster::{SAVE_AS, name_words};
pub use run::{ClassError, ClassJob, Progress, grade_class};
pub use run_facts::{LabFacts, LevelFacts, PartFacts, ProgramFacts, RunFacts};
pub use workplace::is_unfinished;
