use crate::algebra::Rational;
use crate::lab::Points;
use crate::submission::Student;
use std::collections::BTreeMap;

/// What the class page shows; filled by whoever ran the class.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ClassSummary {
    /// One a submission, in the order shown.
    pub rows: Vec<ClassRow>,
    /// Submissions that the statistics are of: handed in, and at least one criterion could be judged.
    pub counted: u64,
    /// (points earned in the questions, how many of these submissions earned them), the lowest first.
    pub totals: Vec<(Points, u64)>,
    /// (mark, how many of these submissions have it), the lowest first.
    pub marks: Vec<(Points, u64)>,
    /// (box of the cover sheet, how many of these submissions wait for it), in the lab's order.
    pub boxes_waiting: Vec<(String, u64)>,
    /// One a question, in the lab's order.
    pub questions: Vec<ItemStatistics>,
    /// One a criterion, in the lab's order.
    pub criteria: Vec<ItemStatistics>,
    /// What explains wrong transfer functions, the most frequent first.
    pub mistakes: Vec<MistakeMade>,
    /// Submissions whose explanations were too many to be kept apart.
    pub more_mistakes: usize,
    /// Classes of nonlinearities, as answered and as right.
    pub classes: Confusion,
    /// One an outcome that is assessed.
    pub outcomes: Vec<Attainment>,
    /// Unusual wrong answers that several submissions share.
    pub answers_shared: Vec<AnswersShared>,
    /// Wrong answers that could not be compared, being too many.
    pub answers_not_compared: usize,
    /// Marks that wait for a person, in the order they are best looked at; of many like ones the first.
    pub review: Vec<ReviewEntry>,
    /// How many there are, where they are more than are listed, by (criterion, reason, group).
    pub review_counts: BTreeMap<(String, String, Option<String>), usize>,
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
    /// Criteria that wait for a person.
    pub to_review: usize,
    /// Sum of the cover sheet, before adjustments; `None` while a box is empty.
    pub cover_total: Option<Points>,
    /// What changes that sum, and why; without points while it is a part of a sum that waits.
    pub adjustments: Vec<(Option<Points>, String)>,
    /// What counts in the end: that sum with the adjustments; `None` while a part waits for a person.
    pub mark: Option<Points>,
    /// False when the file as a whole could not be read.
    pub readable: bool,
    /// On the roster, and handed nothing in.
    pub missing: bool,
    /// It came too late, as the LMS says.
    pub late: bool,
    /// Whose it is, or whether it counts, is for a person to say before the mark is passed on.
    pub held: bool,
}

/// How the class did in one criterion or question. What could not be judged, or waits for a person, counts as it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct ItemStatistics {
    pub id: String,
    pub possible: Points,
    /// Mean points earned; `None` for an empty class.
    pub mean: Option<f64>,
    /// Mean points as a share of those possible, 0..=1.
    pub facility: Option<f64>,
    /// Correlation with the points earned elsewhere, −1..=1; `None` where one of the two is the same for all.
    pub discrimination: Option<f64>,
    /// Facility among the best 27 % less that among the weakest, −1..=1.
    pub upper_less_lower: Option<f64>,
    /// Submissions by verdict; of criteria only.
    pub right: usize,
    pub partly: usize,
    pub wrong: usize,
    pub blank: usize,
    /// Unreadable or unmarked: a person has to look.
    pub open: usize,
    /// Marks to be confirmed; of criteria only.
    pub provisional: usize,
}

/// Submissions with something in common: how many, and who the first are.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct People {
    pub count: usize,
    pub first: Vec<Person>,
}

/// A submission: how it is named, and where its report is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person {
    /// Hostile until escaped.
    pub name: String,
    /// Relative, percent-encoded.
    pub link: String,
}

impl People {
    /// More are counted, not named.
    pub const MOST: usize = 50;

    pub fn add(&mut self, name: &str, link: &str) {
        self.count += 1;
        if self.first.len() < Self::MOST {
            self.first.push(Person { name: name.to_owned(), link: link.to_owned() });
        }
    }
}

/// What explains wrong transfer functions of one question.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MistakeMade {
    /// The question's id.
    pub question: String,
    /// Mistakes that explain them alike, so that it was one of these; none for what nothing explains.
    pub explanations: Vec<Explanation>,
    pub people: People,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    pub words: String,
    /// The words are those of one of several like slips.
    pub for_example: bool,
}

/// How often what was answered where what was right.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Confusion {
    /// What is right.
    pub rows: Vec<&'static str>,
    /// What was answered.
    pub columns: Vec<&'static str>,
    /// By row and column.
    pub counts: Vec<Vec<usize>>,
}

/// How many students reach an outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Attainment {
    pub id: String,
    pub text: String,
    /// The share of the points that a student should earn.
    pub target: Option<Rational>,
    /// Points of all that assesses it.
    pub possible: Points,
    pub students: usize,
    /// Students who earned that share or more.
    pub reached: usize,
    /// Students of whom a part waits for a person.
    pub waiting: usize,
    /// Mean share of the points earned, 0..=1.
    pub mean_share: Option<f64>,
}

/// Submissions that share unusual wrong answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswersShared {
    pub people: People,
    pub answers: Vec<SharedAnswer>,
}

/// A wrong answer that several submissions have to the letter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharedAnswer {
    /// The question's number.
    pub question: String,
    pub prompt: String,
    pub field: String,
    /// As read. Hostile until escaped.
    pub answer: String,
    /// Submissions that have it.
    pub count: usize,
    /// Submissions with a wrong answer there that nothing explains, these included.
    pub wrong: usize,
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
