use super::table::TableError;
use crate::class::ResultsError;
use crate::lab::Points;
use std::io;

/// Why nothing was exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    #[error(transparent)]
    Results(#[from] ResultsError),
    #[error("the file cannot be written: {0}")]
    Write(#[from] io::Error),
    #[error("nobody's answers are in the results")]
    Empty,
    #[error("some marks are out of {one} points and some out of {two}: the results are of two labs")]
    TwoScales { one: Points, two: Points },
    #[error("marks are out of 0 points and cannot be scaled")]
    NothingToScale,
    #[error("the file of the LMS cannot be read as CSV: {0}")]
    Table(#[from] TableError),
    #[error("the file of the LMS is no Canvas gradebook: {0}")]
    NotCanvas(&'static str),
    #[error("the file of the LMS is no grading worksheet of Moodle: {what}; its columns are {columns}")]
    NotWorksheet { what: &'static str, columns: String },
    #[error("no assignment in the gradebook is called `{wanted}`; there are {candidates}")]
    NoAssignment { wanted: String, candidates: String },
    #[error(
        "several assignments in the gradebook are called `{wanted}`: {candidates}; give the number in brackets"
    )]
    SeveralAssignments { wanted: String, candidates: String },
    #[error("say with `--assignment` which assignment the marks are for: {candidates}")]
    WhichAssignment { candidates: String },
    #[error("there is no assignment in the gradebook: make it in Canvas first, then export the gradebook")]
    NoAssignments,
    #[error(
        "without `--lms`, `--assignment` must be as Canvas writes it, `Title (id)`: Canvas would take `{0}` for a new assignment"
    )]
    NoCanvasId(String),
    #[error("Canvas would not read a column called `{0}`: it takes it for one of its own totals")]
    TakenForTotal(String),
    #[error("Canvas says that `{0}` is read only")]
    ReadOnly(String),
    #[error(
        "the assignment is out of {theirs} points in the file, the marks are out of {ours}: add `--scale-to {theirs}`, or change \
         the assignment"
    )]
    Scale { theirs: Points, ours: Points },
    #[error("`{0}` in the file of the LMS is no number of points")]
    NoMaximum(String),
    #[error("the assignment is graded by a scale of words, not by points")]
    ScaleOfWords,
    #[error("no submission of the results is by `{0}`")]
    NoSubmission(String),
    #[error("several submissions of the results are by `{who}`: {files}; choose one with `--file`")]
    SeveralSubmissions { who: String, files: String },
    #[error("nothing is written for {who}: {why}; to write it all the same, add `--as-it-stands`")]
    NotReady { who: String, why: String },
    #[error("this cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error("this cannot be written as CSV: {0}")]
    Csv(#[from] csv::Error),
    #[error("the workbook cannot be written: {0}")]
    Workbook(#[from] rust_xlsxwriter::XlsxError),
    #[error("the zip file cannot be written: {0}")]
    Zip(#[from] zip::result::ZipError),
}
