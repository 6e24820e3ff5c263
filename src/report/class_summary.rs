use crate::lab::Points;
use crate::submission::Student;

/// What the class page shows; filled by whoever ran the class.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ClassSummary {
    /// One a submission, in the order shown.
    pub rows: Vec<ClassRow>,
    /// One a question, in the lab's order.
    pub questions: Vec<QuestionMean>,
    /// Marks that wait for a person, in the order they are best looked at.
    pub review: Vec<ReviewEntry>,
    /// What is to be known of how it was handed in.
    pub intake: Vec<IntakeEntry>,
}

/// Something about how a submission was handed in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IntakeEntry {
    /// Names of students, or of a file. Hostile until escaped.
    pub who: String,
    /// Sentences, or what follows the file's name.
    pub words: String,
    /// The report; empty where there is none.
    pub link: String,
    pub kind: IntakeKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum IntakeKind {
    /// Whose it is, or whether it counts, is for a person to say; or was found out and is to be known.
    Held,
    /// An answer file in whose place another counts.
    Superseded,
    /// A file that is not marked.
    Aside,
}

/// One submission.
#[derive(Clone, Debug, PartialEq)]
pub struct ClassRow {
    /// Empty when the file does not say.
    pub students: Vec<Student>,
    /// The answer file's name, as found.
    pub file: String,
    /// Relative, percent-encoded: `reports/a%20b.html`.
    pub report: String,
    /// The numbers it was marked by, where they differ from student to student: `M = 0.4, b = 0.1`.
    pub numbers: String,
    pub earned: Points,
    pub possible: Points,
    /// Of the earned points, how many wait for a person.
    pub provisional: Points,
    pub findings: usize,
    /// Sum of the cover sheet; `None` while a box is empty.
    pub cover_total: Option<Points>,
    /// False when the file as a whole could not be read.
    pub readable: bool,
    /// On the roster, and handed nothing in.
    pub missing: bool,
    /// It came too late, as the LMS says.
    pub late: bool,
}

/// How the class did in one question.
#[derive(Clone, Debug, PartialEq)]
pub struct QuestionMean {
    /// The question's id.
    pub id: String,
    /// Mean points earned, over all submissions.
    pub mean: f64,
    pub possible: Points,
}

/// A mark that waits for a person.
#[derive(Clone, Debug, PartialEq)]
pub struct ReviewEntry {
    /// Names or ids of the students, as shown.
    pub student: String,
    /// The criterion's id.
    pub item: String,
    /// The criterion's title.
    pub title: String,
    /// The report with the criterion's anchor, relative and percent-encoded; see [`item_anchor`](super::item_anchor).
    pub link: String,
    /// In words: `prose is judged by its words only`.
    pub why: String,
    pub earned: Points,
    pub possible: Points,
    /// The group of like answers one decision can serve; none of another group has this id.
    pub alike: Option<String>,
    /// The words found in prose, quoted; empty where there are none.
    pub found: String,
    /// What of the prose does not go with the numbers, a sentence each.
    pub conflicts: Vec<String>,
    /// How the answer begins. The student's own text: hostile until escaped.
    pub example: String,
}
