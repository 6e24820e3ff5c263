use super::lms_names::without_resubmission;
use super::{AnswerFile, Intake, Lms};
use crate::lab::folded_id;
use crate::source::{Finding, Severity, sanitize};
use crate::submission::{AnswerSheet, Submission};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// An answer file that is not marked, since another one of its owner counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Superseded {
    pub file: AnswerFile,
    /// The `id` of the one that counts.
    pub by: String,
    pub why: WhySuperseded,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhySuperseded {
    /// Handed in before it.
    Older,
    /// The same to the byte.
    Same,
    /// It answers another lab.
    OtherLab,
    /// It answers nothing, and is called something else.
    Blank,
}

impl Superseded {
    /// What is said of it; `by` is the name of the file that counts.
    pub fn finding(&self, by: &str) -> Finding {
        let (by, file) = (sanitize(by), sanitize(&self.file.name));
        let (code, why) = match self.why {
            WhySuperseded::Older => ("intake.superseded", "was handed in later by the same owner"),
            WhySuperseded::Blank => {
                ("intake.superseded", "is by the same owner and has answers, which this file has not")
            }
            WhySuperseded::Same => ("intake.same_file", "is the same file, by the same owner"),
            WhySuperseded::OtherLab => {
                ("intake.other_lab", "is by the same owner and answers this lab, which this file does not")
            }
        };
        let message = format!("`{file}` is not marked: `{by}` {why}, and counts.");
        Finding { severity: Severity::Note, code, message, help: None, span: None }
    }
}

/// An owner with more answer files than this is left to a person without a look into them.
const MOST_ATTEMPTS: usize = 50;

impl Intake {
    /// Settles which answer file counts where an LMS has several of one owner; those that nothing settles are all kept, and
    /// each says so.
    ///
    /// What was handed in later counts when it is called the same but for the number an LMS adds, or when it answers at least
    /// as much: a blank template sent along takes nobody's marks away. Files that name different students are different
    /// people's.
    pub fn with_attempts_settled(self, sheet: &AnswerSheet) -> Self {
        let mut owners: BTreeMap<(Lms, String, String), Vec<usize>> = BTreeMap::new();
        for (at, file) in self.files.iter().enumerate().filter(|(_, file)| file.only_others.is_empty()) {
            if let Some((lms, owner, id)) = file.handed_in.owner_key() {
                owners.entry((lms, owner.to_owned(), id.to_owned())).or_default().push(at);
            }
        }
        let mut beaten: BTreeMap<usize, (usize, WhySuperseded)> = BTreeMap::new();
        let mut several: BTreeMap<usize, Vec<String>> = BTreeMap::new();
        for places in owners.into_values().filter(|places| places.len() > 1) {
            let settled = match places.len() <= MOST_ATTEMPTS {
                true => settled(&self.files, &places, sheet),
                false => BTreeMap::new(),
            };
            let left: Vec<usize> = places.iter().copied().filter(|at| !settled.contains_key(at)).collect();
            if left.len() > 1 {
                let name = |at: &usize| self.files[*at].name.clone();
                for one in &left {
                    several
                        .insert(*one, left.iter().filter(|other| *other != one).take(5).map(name).collect());
                }
            }
            beaten.extend(settled);
        }
        let ids: Vec<String> = self.files.iter().map(|file| file.id.clone()).collect();
        let mut intake = Self { files: Vec::new(), superseded: Vec::new(), aside: self.aside };
        for (at, mut file) in self.files.into_iter().enumerate() {
            match beaten.get(&at) {
                Some((by, why)) => {
                    let by = ids.get(*by).cloned().unwrap_or_default();
                    intake.superseded.push(Superseded { file, by, why: *why });
                }
                None => {
                    file.beside_others = several.remove(&at).unwrap_or_default();
                    intake.files.push(file);
                }
            }
        }
        intake
    }
}

/// What is looked at to tell attempts apart.
struct Attempt {
    at: usize,
    bytes: Vec<u8>,
    /// Ids that stand in the file.
    students: BTreeSet<String>,
    other_lab: bool,
    answers: usize,
    base: String,
    /// Canvas' number behind the name of what is handed in again.
    again: u64,
    number: Option<u64>,
    changed: Option<u64>,
}

impl Attempt {
    fn of(at: usize, file: &AnswerFile, sheet: &AnswerSheet) -> Self {
        let submission = file.read(sheet);
        let (base, again) = without_resubmission(&file.own_name);
        Self {
            at,
            bytes: file.read_capped().unwrap_or_default(),
            students: stated(&submission),
            other_lab: answers_another_lab(&submission, sheet),
            answers: submission.answers.len(),
            base,
            again,
            number: file.handed_in.attempt,
            changed: file.changed,
        }
    }

    fn is_newer(&self, other: &Self) -> bool {
        let by_number = self.number.zip(other.number).map(|(one, two)| one.cmp(&two));
        let by_name = (self.base == other.base).then(|| self.again.cmp(&other.again));
        let by_time = self.changed.zip(other.changed).map(|(one, two)| one.cmp(&two));
        let said = [by_number, by_name, by_time].into_iter().flatten();
        said.into_iter().find(|order| order.is_ne()) == Some(Ordering::Greater)
    }

    /// Why `other` does not count beside this one; `None` when nothing says so.
    fn beats(&self, other: &Self) -> Option<WhySuperseded> {
        if self.bytes == other.bytes && !self.bytes.is_empty() {
            let first = !other.is_newer(self) && (self.is_newer(other) || self.at < other.at);
            return first.then_some(WhySuperseded::Same);
        }
        let strangers = !self.students.is_empty()
            && !other.students.is_empty()
            && self.students.is_disjoint(&other.students);
        if strangers {
            return None;
        }
        if self.other_lab != other.other_lab {
            return other.other_lab.then_some(WhySuperseded::OtherLab);
        }
        if self.base != other.base && (self.answers == 0) != (other.answers == 0) {
            return (other.answers == 0).then_some(WhySuperseded::Blank);
        }
        let as_much = self.base == other.base || self.answers >= other.answers;
        (self.is_newer(other) && as_much).then_some(WhySuperseded::Older)
    }
}

/// (place, by which place, why) of the files that do not count.
fn settled(
    files: &[AnswerFile],
    places: &[usize],
    sheet: &AnswerSheet,
) -> BTreeMap<usize, (usize, WhySuperseded)> {
    let attempts: Vec<Attempt> = places.iter().map(|at| Attempt::of(*at, &files[*at], sheet)).collect();
    let unbeaten =
        |one: &&Attempt| attempts.iter().all(|other| other.at == one.at || other.beats(one).is_none());
    let left: Vec<&Attempt> = attempts.iter().filter(unbeaten).collect();
    let mut beaten = BTreeMap::new();
    for one in attempts.iter().filter(|one| left.iter().all(|other| other.at != one.at)) {
        // Only what counts itself takes another's place.
        let by = left.iter().find_map(|other| Some((other.at, other.beats(one)?)));
        if let Some(by) = by {
            beaten.insert(one.at, by);
        }
    }
    beaten
}

fn stated(submission: &Submission) -> BTreeSet<String> {
    let own = submission.students.iter().filter(|student| student.id != submission.id);
    own.map(|student| folded_id(&student.id)).filter(|id| !id.is_empty()).collect()
}

/// Whether the file names another lab and has no answer to this one.
pub fn answers_another_lab(submission: &Submission, sheet: &AnswerSheet) -> bool {
    let other = submission.lab.as_deref().is_some_and(|lab| folded_id(lab) != folded_id(&sheet.lab));
    other && submission.answers.is_empty()
}

/// What is said of a file for another lab; it is marked by nobody but a person.
pub fn other_lab(submission: &Submission, sheet: &AnswerSheet) -> Option<Finding> {
    let lab = submission.lab.as_deref().filter(|lab| folded_id(lab) != folded_id(&sheet.lab))?;
    let (lab, own) = (sanitize(lab), sanitize(&sheet.lab));
    let message = match submission.answers.is_empty() {
        true => format!(
            "The file answers `{lab}`, and nothing in it answers `{own}`. It is left to a person, and earns neither points nor \
             zeros until then."
        ),
        false => format!(
            "The file says that it answers `{lab}`, but it has answers to `{own}`. They were marked; a person has to say whether \
             they count."
        ),
    };
    Some(Finding { severity: Severity::Warning, code: "intake.other_lab", message, help: None, span: None })
}
