use super::record::StudentRecord;
use super::{HandedIn, OtherVariant};
use crate::grading::Scorecard;
use crate::lab::Variant;
use crate::source::{Finding, Severity, SourceText};
use crate::submission::{Student, Submission};
use std::collections::BTreeMap;

/// A submission and what became of it.
#[derive(Clone, Debug)]
pub struct Marked {
    pub submission: Submission,
    pub scorecard: Scorecard,
    /// Who handed it in, where an LMS says so.
    pub handed_in: Option<HandedIn>,
    /// Its students, with what the roster says of them.
    pub students: Vec<StudentRecord>,
    /// The report, relative to the output folder: `reports/EE-001.html`.
    pub report: String,
    /// The instructor's edition, where the report withholds something: `instructor/EE-001.html`.
    pub instructor: Option<String>,
    /// (parameter, value as typed) it was marked by; `None` where everyone has the lab's own, empty when it is not known whose
    /// it is.
    pub parameters: Option<Vec<(String, String)>>,
    /// The variant it was marked by, where there is one.
    pub variant: Option<Variant>,
    /// Other students whose numbers its wrong answers are right for: for the instructor, on no student's page.
    pub other_variants: Vec<OtherVariant>,
    /// polemark itself failed on it.
    pub failed: bool,
}

/// A submission of which nothing could be read, for the reason `finding` gives.
pub fn unreadable_submission(id: &str, name: &str, finding: Finding) -> Submission {
    Submission {
        id: id.to_owned(),
        source: SourceText::new(name, ""),
        lab: None,
        students: vec![Student { id: id.to_owned(), name: String::new() }],
        answers: BTreeMap::new(),
        findings: vec![finding],
        readable: false,
    }
}

/// What is said when polemark fails on a submission: nobody loses a mark for it.
pub fn our_failure() -> Finding {
    Finding {
        severity: Severity::Error,
        code: "polemark.failed",
        message: "polemark failed on this submission, which is our fault, not yours. A person will mark it."
            .to_owned(),
        help: None,
        span: None,
    }
}
