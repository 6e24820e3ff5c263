use crate::class::{Record, Status};
use crate::source::sanitize;
use std::fmt;

/// Why somebody's mark or report is not in an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// Whose it is, or whether it counts, is for a person to say; what was noted.
    Held(String),
    /// Files that give the same student, all of which would count.
    SeveralFiles(Vec<String>),
    /// So many criteria wait for a person.
    Waits(usize),
    /// So many adjustments wait for a person.
    AdjustmentsWait(usize),
    /// So many boxes of the cover sheet are empty.
    Incomplete(usize),
    Unreadable,
    /// polemark failed on it.
    Failed,
    HandedNothingIn,
    /// The file names no student.
    Nobody,
    /// There is a roster, and they are not on it.
    NotOnRoster,
    /// Not in the file of the LMS.
    NotThere,
    /// Several rows of the LMS could be meant, or their identifiers lead to different rows.
    SeveralRows,
    /// Somebody else leads to the same row.
    SameRow,
    Excused,
    NotAssigned,
    Locked,
    /// Named after the column that is empty for them.
    NoIdentifier(&'static str),
    /// A spreadsheet would run the identifier as a formula, and changing it would make it another one.
    Formula,
    /// The file did not come from the LMS with its numbers in the name.
    NoLmsNumbers(&'static str),
    /// Several reports have the same number, so everybody of the group would get the report of one.
    SharedNumber,
    /// The report is not there, or not whole.
    NoReport,
}

impl Why {
    /// Why the mark of a record is not passed on as it is; `None` when it is final.
    pub fn not_final(record: &Record) -> Option<Self> {
        if record.failed {
            return Some(Self::Failed);
        }
        match record.status {
            Status::Missing => return Some(Self::HandedNothingIn),
            Status::Unreadable => return Some(Self::Unreadable),
            Status::Marked | Status::Superseded => {}
        }
        if let Some(finding) = record.held().next() {
            return Some(Self::Held(finding.message.clone()));
        }
        let waits = record.to_review().count().max(usize::from(record.total.provisional.0 != 0));
        if waits > 0 {
            return Some(Self::Waits(waits));
        }
        let empty = record.cover.iter().filter(|one| one.earned.is_none()).count();
        if empty > 0 {
            return Some(Self::Incomplete(empty));
        }
        let adjustments = record.adjustments.iter().filter(|one| one.points.is_none()).count();
        (adjustments > 0).then_some(Self::AdjustmentsWait(adjustments))
    }
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Held(message) => write!(f, "{}", sanitize(message)),
            Self::SeveralFiles(files) => {
                write!(f, "several files count for this student: {}", sanitize(&files.join(", ")))
            }
            Self::Waits(1) => write!(f, "1 criterion waits for a person"),
            Self::Waits(count) => write!(f, "{count} criteria wait for a person"),
            Self::AdjustmentsWait(1) => write!(f, "1 adjustment waits for a person"),
            Self::AdjustmentsWait(count) => write!(f, "{count} adjustments wait for a person"),
            Self::Incomplete(1) => write!(f, "1 box of the cover sheet is not filled in yet"),
            Self::Incomplete(count) => write!(f, "{count} boxes of the cover sheet are not filled in yet"),
            Self::Unreadable => write!(f, "the answer file could not be read"),
            Self::Failed => write!(f, "polemark failed on the answer file"),
            Self::HandedNothingIn => write!(f, "handed nothing in"),
            Self::Nobody => write!(f, "the file names no student"),
            Self::NotOnRoster => write!(f, "not on the roster"),
            Self::NotThere => write!(f, "not in the file of the LMS"),
            Self::SeveralRows => write!(f, "several rows in the file of the LMS could be meant"),
            Self::SameRow => write!(f, "somebody else leads to the same row in the file of the LMS"),
            Self::Excused => write!(f, "excused in Canvas"),
            Self::NotAssigned => write!(f, "the assignment is not assigned to them in Canvas"),
            Self::Locked => write!(f, "Moodle says that the grade cannot be changed"),
            Self::NoIdentifier(what) => write!(f, "no {what} is known of them"),
            Self::Formula => write!(f, "a spreadsheet would run their identifier as a formula"),
            Self::NoLmsNumbers(what) => write!(f, "{what}"),
            Self::SharedNumber => write!(
                f,
                "others have a report of their own under the same number of the LMS, which gives each to the whole group"
            ),
            Self::NoReport => write!(f, "the report is not there, or not whole"),
        }
    }
}
