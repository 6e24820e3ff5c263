//! The marks file to be filled in: what of a class still waits for a person, from its records alone.

mod table;
mod yaml;

pub use table::{StubError, appended};

use super::record::{ItemRecord, Record, ReviewRecord, Status};
use super::run_facts::{LabFacts, PartFacts};
use crate::grading::NO_ANSWER;
use crate::lab::{Points, folded_id};
use std::collections::{BTreeMap, BTreeSet};

/// More answers than these of one group are not listed: a decision then holds for whatever is in the group.
const MOST_ANSWERS: usize = 1000;

/// What waits for a person, gathered a record at a time.
#[derive(Clone, Debug, Default)]
pub struct MarksStub {
    lab: LabFacts,
    /// By criterion and group.
    groups: BTreeMap<(String, String), Group>,
    /// In the order of the records.
    students: Vec<OneStudent>,
    /// By folded id: the place in `students`, and the files that give the id.
    places: BTreeMap<String, (usize, Vec<String>)>,
    /// Files of which a person has to say whose they are, with what is wrong.
    files: Vec<(String, String)>,
    /// What no marks file settles: (file, what is wrong).
    elsewhere: Vec<(String, String)>,
    late: usize,
    /// Points that polemark gave are filled in.
    suggests: bool,
}

/// Like answers that one decision can serve.
#[derive(Clone, Debug)]
struct Group {
    about: About,
    count: usize,
    answers: BTreeSet<String>,
}

/// What is asked about one student.
#[derive(Clone, Debug, Default)]
struct OneStudent {
    id: String,
    name: String,
    /// Places in the lab's lists.
    cover: Vec<usize>,
    observed: Vec<usize>,
    items: Vec<(String, String, About)>,
    /// Which of several files counts has to be said.
    which_counts: bool,
}

/// What a person reads before deciding. The student's words are hostile until escaped.
#[derive(Clone, Debug)]
struct About {
    given: Points,
    possible: Points,
    why: String,
    begins: String,
    /// The points to be confirmed. `None` where polemark judged nothing, gave like answers different points, or a person decided
    /// about another answer.
    suggestion: Option<Points>,
}

/// The reason of a suggestion that a person leaves as it is.
const CONFIRMED: &str = "confirmed";

impl About {
    fn of(item: &ItemRecord, review: &ReviewRecord) -> Self {
        Self {
            given: item.earned,
            possible: item.possible,
            why: review.why.clone(),
            begins: review.answer.clone(),
            suggestion: (item.provisional && item.verdict != "unmarked" && !review.decided)
                .then_some(item.earned),
        }
    }
}

impl MarksStub {
    pub fn new(lab: LabFacts) -> Self {
        Self { lab, ..Self::default() }
    }

    /// With the points that polemark gave, and `confirmed` as the reason, where it gave any: to be looked through and confirmed.
    pub fn with_suggestions(self, suggests: bool) -> Self {
        Self { suggests, ..self }
    }

    /// What is filled in of a decision: points and the reason.
    fn filled_in(&self, about: &About) -> (String, &'static str) {
        match about.suggestion.filter(|_| self.suggests) {
            Some(points) => (points.to_string(), CONFIRMED),
            None => (String::new(), ""),
        }
    }

    pub fn add(&mut self, record: &Record) {
        if matches!(record.status, Status::Missing | Status::Superseded) {
            return;
        }
        self.late += usize::from(record.is_late() && record.adjustments.is_empty());
        let mut alone = Vec::new();
        for (item, review) in record.to_review() {
            let about = About::of(item, review);
            let answer = item.answer.clone().unwrap_or_else(|| NO_ANSWER.to_owned());
            match &item.alike {
                Some(group) if !review.decided => {
                    let key = (item.id.clone(), group.clone());
                    let suggestion = about.suggestion;
                    let group = self.groups.entry(key).or_insert_with(|| Group {
                        about,
                        count: 0,
                        answers: BTreeSet::new(),
                    });
                    group.about.suggestion =
                        group.about.suggestion.filter(|points| suggestion == Some(*points));
                    group.count += 1;
                    if group.answers.len() <= MOST_ANSWERS {
                        group.answers.insert(answer);
                    }
                }
                _ => alone.push((item.id.clone(), answer, about)),
            }
        }
        let mut whose = false;
        let mut which_counts = false;
        for finding in record.held() {
            match finding.code.as_str() {
                "student.twice" | "intake.several_files" => which_counts = true,
                "intake.other_lab" => self.elsewhere.push((record.file.clone(), finding.message.clone())),
                _ if whose => {}
                _ => {
                    whose = true;
                    self.files.push((record.file.clone(), finding.message.clone()));
                }
            }
        }
        for student in &record.students {
            let known = self.places.entry(folded_id(&student.id)).or_insert((usize::MAX, Vec::new()));
            known.1.push(record.file.clone());
            if let Some(before) = self.students.get_mut(known.0) {
                before.which_counts |= which_counts;
                continue;
            }
            // What else is asked depends on whose it is.
            let mut one = OneStudent {
                id: student.id.clone(),
                name: match (student.name.as_str(), &student.roster) {
                    ("", Some(row)) => row.name.clone(),
                    (name, _) => name.to_owned(),
                },
                which_counts,
                ..OneStudent::default()
            };
            if !whose {
                one.items.clone_from(&alone);
                let open = |rows: &[super::record::BoxRecord], id: &str| {
                    rows.iter().any(|row| row.id == id && row.earned.is_none())
                };
                let places = |parts: &[PartFacts], rows: &[super::record::BoxRecord]| {
                    let open = parts.iter().enumerate().filter(|(_, part)| open(rows, &part.id));
                    open.map(|(place, _)| place).collect::<Vec<_>>()
                };
                one.cover = places(&self.lab.by_hand, &record.cover);
                one.observed = places(&self.lab.observed, &record.observed);
            }
            known.0 = self.students.len();
            self.students.push(one);
        }
    }

    /// Whether nothing waits for a person.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty() && self.files.is_empty() && self.asked().next().is_none()
    }

    /// What waits, in a line: `3 groups of like answers, 2 answers on their own, 1 file of somebody, and 4 students`.
    pub fn in_short(&self) -> String {
        let counted = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            _ => Some(format!("{count} {many}")),
        };
        let alone: usize = self.students.iter().map(|student| student.items.len()).sum();
        let rows: usize =
            self.students.iter().map(|student| student.cover.len() + student.observed.len()).sum();
        let which = self.students.iter().filter(|student| student.which_counts).count();
        let parts: Vec<String> = [
            counted(self.groups.len(), "group of like answers", "groups of like answers"),
            counted(alone, "answer on its own", "answers on their own"),
            counted(rows, "row or box that a person fills", "rows and boxes that a person fills"),
            counted(
                self.files.len(),
                "file of which to say whose it is",
                "files of which to say whose they are",
            ),
            counted(which, "student with several files", "students with several files"),
        ]
        .into_iter()
        .flatten()
        .collect();
        match parts.as_slice() {
            [] => "nothing waits for a person".to_owned(),
            _ => crate::english::listed(&parts, "and"),
        }
    }

    /// Students of whom something is asked.
    fn asked(&self) -> impl Iterator<Item = &OneStudent> {
        self.students.iter().filter(|one| {
            one.which_counts || !one.items.is_empty() || !one.cover.is_empty() || !one.observed.is_empty()
        })
    }

    /// Groups in the lab's order of criteria, the largest of each first.
    fn ordered_groups(&self) -> Vec<(&str, &str, &Group)> {
        let places: BTreeMap<&str, usize> =
            self.lab.items.iter().enumerate().map(|(place, item)| (item.id.as_str(), place)).collect();
        let mut groups: Vec<_> =
            self.groups.iter().map(|((item, id), group)| (item.as_str(), id.as_str(), group)).collect();
        groups.sort_by_key(|(item, _, group)| {
            (places.get(item).copied().unwrap_or(usize::MAX), usize::MAX - group.count)
        });
        groups
    }

    /// The files that give a student's id.
    fn files_of(&self, student: &OneStudent) -> &[String] {
        self.places.get(&folded_id(&student.id)).map_or(&[], |(_, files)| files.as_slice())
    }

    fn title<'a>(&'a self, item: &'a str) -> &'a str {
        self.lab.items.iter().find(|one| one.id == item).map_or(item, |one| one.title.as_str())
    }
}

impl Group {
    /// Hashes of the answers it was made of; empty when there are too many to list.
    fn listed_answers(&self) -> Vec<&str> {
        match self.answers.len() > MOST_ANSWERS {
            true => Vec::new(),
            false => self.answers.iter().map(String::as_str).collect(),
        }
    }
}

/// `1 answer`, `3 answers`.
fn answers(count: usize) -> String {
    if count == 1 { "1 answer".to_owned() } else { format!("{count} answers") }
}

#[cfg(test)]
mod tests;
