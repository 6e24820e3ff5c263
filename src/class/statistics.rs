use super::analysis::{AnswersAlike, Attainments, Classes, ItemAnalysis, Mistakes, says_something};
use super::intake::Aside;
use super::outcome::Outcome;
use super::record::{ItemRecord, Record, Status};
use crate::english::listed;
use crate::lab::{LabDefinition, Points, folded_id};
use crate::report::{ClassRow, ClassSummary, IntakeEntry, IntakeKind, People, ReviewEntry, item_anchor};
use crate::submission::Student;
use std::collections::{BTreeMap, BTreeSet};

/// Groups of like answers that are told apart in the review list.
const MOST_GROUPS: usize = 5_000;

/// What the class page and the summary need, gathered one submission at a time.
pub struct Statistics {
    rows: Vec<ClassRow>,
    review: Vec<ReviewEntry>,
    /// Entries of a criterion, reason and group, those that are not listed too.
    review_counts: BTreeMap<(String, String, Option<String>), usize>,
    intake: Vec<IntakeEntry>,
    items: ItemAnalysis,
    mistakes: Mistakes,
    classes: Classes,
    outcomes: Attainments,
    answers: AnswersAlike,
    /// How many have each mark, in hundredths.
    marks: BTreeMap<i64, u64>,
    /// (title, how many wait for it) of each box of the cover sheet, by place.
    boxes: Vec<(String, u64)>,
    /// Of the record before.
    last_file: String,
    /// Folded, as ids are compared.
    student_ids: BTreeSet<String>,
    /// (criterion, group) of every like answer.
    groups: BTreeSet<(String, String)>,
    /// Of each criterion.
    titles: BTreeMap<String, String>,
    reports: BTreeSet<String>,
    outcome: Outcome,
}

impl Statistics {
    pub fn new(lab: &LabDefinition) -> Self {
        Self {
            rows: Vec::new(),
            review: Vec::new(),
            review_counts: BTreeMap::new(),
            intake: Vec::new(),
            items: ItemAnalysis::new(lab),
            mistakes: Mistakes::new(lab),
            classes: Classes::new(lab),
            outcomes: Attainments::new(lab),
            answers: AnswersAlike::new(lab),
            marks: BTreeMap::new(),
            boxes: lab.cover.rows.iter().map(|row| (row.title.clone(), 0)).collect(),
            last_file: String::new(),
            student_ids: BTreeSet::new(),
            groups: BTreeSet::new(),
            titles: lab
                .questions
                .iter()
                .flat_map(|question| &question.criteria)
                .map(|criterion| (criterion.id.clone(), criterion.title.clone()))
                .collect(),
            reports: BTreeSet::new(),
            outcome: Outcome::default(),
        }
    }

    pub fn add(&mut self, record: &Record) {
        self.look_at_intake(record);
        match record.status {
            Status::Marked | Status::Unreadable => {}
            Status::Superseded => {
                self.outcome.superseded += 1;
                return;
            }
            Status::Missing => {
                self.outcome.missing += 1;
                self.rows.push(class_row(record));
                return;
            }
        }
        self.outcome.late += usize::from(record.is_late());
        if says_something(record) {
            self.analyse(record);
        }
        self.student_ids.extend(record.students.iter().map(|s| folded_id(&s.id)));
        self.reports.extend([&record.report].into_iter().chain(&record.instructor).cloned());
        self.outcome.submissions += 1;
        self.outcome.possible = record.total.possible.as_f64();
        self.outcome.unreadable += usize::from(!record.readable);
        self.outcome.failed += usize::from(record.failed);
        let changed = record.findings.iter().any(|finding| finding.code == "marks.answer_changed");
        self.outcome.answers_changed += usize::from(changed);
        let empty = record.observed.iter().chain(&record.cover).any(|row| row.earned.is_none());
        self.outcome.waiting |=
            empty || record.held().next().is_some() || record.to_review().next().is_some();
        let entries = review_entries(record, &self.titles).chain(other_variant_entries(record, &self.titles));
        let entries: Vec<ReviewEntry> = entries.collect();
        self.outcome.to_review += usize::from(!entries.is_empty());
        entries.into_iter().for_each(|entry| self.list(entry));
        let groups = record.items.iter().filter_map(|item| Some((item.id.clone(), item.alike.clone()?)));
        self.groups.extend(groups);
        self.rows.push(class_row(record));
    }

    fn analyse(&mut self, record: &Record) {
        self.items.add(record);
        self.mistakes.add(record, &names(record), record.full_report());
        self.classes.add(record);
        self.outcomes.add(record);
        if let Some(mark) = record.mark {
            *self.marks.entry(mark.earned.0).or_default() += 1;
        }
        for ((_, waiting), given) in self.boxes.iter_mut().zip(&record.cover) {
            *waiting += u64::from(given.earned.is_none());
        }
        // Members of a group with reports of their own have the same answers.
        if self.last_file != record.file {
            self.answers.add(record, self.rows.len());
            self.last_file.clone_from(&record.file);
        }
    }

    /// Lists an entry, unless there are many like it already, or of very many groups.
    fn list(&mut self, mut entry: ReviewEntry) {
        let mut key = (entry.item.clone(), entry.why.clone(), entry.alike.clone());
        if self.review_counts.len() >= MOST_GROUPS && !self.review_counts.contains_key(&key) {
            (entry.alike, key.2) = (None, None);
        }
        let count = self.review_counts.entry(key).or_default();
        *count += 1;
        if *count <= People::MOST {
            self.review.push(entry);
        }
    }

    /// Notes files that are not marked.
    pub fn set_aside(&mut self, aside: &[Aside]) {
        self.outcome.aside = aside.len();
        let entries = aside.iter().map(|one| IntakeEntry {
            who: one.name.clone(),
            words: one.why.words().to_owned(),
            link: String::new(),
            kind: IntakeKind::Aside,
        });
        self.intake.extend(entries);
    }

    /// Notes (id, files) of ids that several files give.
    pub fn given_twice(&mut self, ids: &[(String, Vec<String>)]) {
        let entries = ids.iter().map(|(id, files)| IntakeEntry {
            who: id.clone(),
            words: format!("Several files give this id: {}.", listed(files, "and")),
            link: String::new(),
            kind: IntakeKind::Held,
        });
        self.intake.extend(entries);
    }

    /// What a person should know of how it was handed in.
    fn look_at_intake(&mut self, record: &Record) {
        let kind = match record.status {
            Status::Superseded => IntakeKind::Superseded,
            _ => IntakeKind::Held,
        };
        let said: Vec<&str> = match record.status {
            Status::Superseded => record.findings.iter().map(|finding| finding.message.as_str()).collect(),
            _ => record.held().chain(record.intake_notes()).map(|finding| finding.message.as_str()).collect(),
        };
        self.outcome.held += usize::from(kind == IntakeKind::Held && record.held().next().is_some());
        if !said.is_empty() {
            let who = match record.students.is_empty() {
                true => record.file.clone(),
                false => names(record),
            };
            self.intake.push(IntakeEntry {
                who,
                words: said.join(" "),
                link: record.full_report().to_owned(),
                kind,
            });
        }
    }

    pub fn outcome(&self) -> Outcome {
        Outcome { mean_earned: self.items.mean(), ..self.outcome.clone() }
    }

    pub fn summary(self) -> ClassSummary {
        let (mistakes, more_mistakes) = self.mistakes.list();
        let who = |row: usize| match self.rows.get(row) {
            Some(row) => {
                (names_of(row.students.iter().map(|one| (&*one.id, &*one.name))), row.report.clone())
            }
            None => Default::default(),
        };
        let (answers_shared, answers_not_compared) = self.answers.list(who);
        ClassSummary {
            counted: self.items.count(),
            totals: self.items.totals(),
            marks: self.marks.iter().map(|(mark, n)| (Points(*mark), *n)).collect(),
            boxes_waiting: self.boxes.into_iter().filter(|(_, waiting)| *waiting > 0).collect(),
            questions: self.items.questions(),
            criteria: self.items.criteria(),
            mistakes,
            more_mistakes,
            classes: self.classes.table(),
            outcomes: self.outcomes.list(),
            answers_shared,
            answers_not_compared,
            rows: self.rows,
            review: self.review,
            review_counts: self.review_counts,
            intake: self.intake,
        }
    }

    /// Which of `ids` nobody in the class has.
    pub fn absent<'a>(&self, ids: impl Iterator<Item = &'a str>) -> Vec<String> {
        ids.filter(|id| !self.student_ids.contains(&folded_id(id))).map(str::to_owned).collect()
    }

    /// (criterion, group) of every like answer of the class.
    pub fn groups(&self) -> &BTreeSet<(String, String)> {
        &self.groups
    }

    /// The reports of this run, relative to the output folder; they are not needed for the class page.
    pub fn take_reports(&mut self) -> BTreeSet<String> {
        std::mem::take(&mut self.reports)
    }
}

fn class_row(record: &Record) -> ClassRow {
    ClassRow {
        students: students(record),
        file: record.file.clone(),
        report: record.full_report().to_owned(),
        numbers: numbers_words(record),
        earned: record.total.earned,
        possible: record.total.possible,
        provisional: record.total.provisional,
        findings: record.findings.len(),
        to_review: record.to_review().count(),
        cover_total: record.cover_total,
        adjustments: record.adjustments.iter().map(|one| (one.points, one.reason.clone())).collect(),
        mark: record.mark.as_ref().map(|mark| mark.earned),
        readable: record.readable,
        missing: record.status == Status::Missing,
        late: record.is_late(),
        held: record.held().next().is_some(),
    }
}

/// Names of the students, ids where there are none.
fn names(record: &Record) -> String {
    names_of(record.students.iter().map(|one| (&*one.id, &*one.name)))
}

/// Of (id, name) each.
fn names_of<'a>(students: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    let names = students.map(|(id, name)| if name.is_empty() { id } else { name });
    names.collect::<Vec<_>>().join(", ")
}

fn students(record: &Record) -> Vec<Student> {
    record.students.iter().map(|one| Student { id: one.id.clone(), name: one.name.clone() }).collect()
}

/// `M = 0.4, b = 0.1`; empty where everyone has the lab's own.
fn numbers_words(record: &Record) -> String {
    match &record.parameters {
        None => String::new(),
        Some(values) if values.is_empty() => "not known".to_owned(),
        Some(values) => equalities(values),
    }
}

fn equalities(values: &BTreeMap<String, String>) -> String {
    let each = values.iter().map(|(name, value)| format!("{name} = {value}"));
    each.collect::<Vec<_>>().join(", ")
}

/// One entry a criterion that waits for a person.
fn review_entries<'a>(
    record: &'a Record,
    titles: &'a BTreeMap<String, String>,
) -> impl Iterator<Item = ReviewEntry> + 'a {
    let student = names(record);
    record.to_review().map(move |(item, review)| ReviewEntry {
        why: review.why.clone(),
        alike: item.alike.clone(),
        found: review.words.clone(),
        conflicts: conflicts(item),
        example: review.answer.clone(),
        ..entry(record, item, student.clone(), titles)
    })
}

/// One entry for each variant of other students that wrong answers are right for.
fn other_variant_entries<'a>(
    record: &'a Record,
    titles: &'a BTreeMap<String, String>,
) -> impl Iterator<Item = ReviewEntry> + 'a {
    record.other_variant.iter().filter_map(move |other| {
        let field = other.fields.first()?;
        let below = format!("{field}.");
        let item = record.items.iter().find(|item| item.id == *field || item.id.starts_with(&below))?;
        let students: Vec<&str> = record.students.iter().map(|student| student.id.as_str()).collect();
        Some(ReviewEntry {
            why: format!(
                "wrong for their own values, but right for those of {} ({}) in {}; by chance at most 1 in {} such answers. No mark rests \
                 on it",
                listed(&other.students, "and"),
                equalities(&other.parameters),
                listed(&other.fields, "and"),
                (1.0 / other.chance.max(1e-9)).floor()
            ),
            ..entry(record, item, students.join(", "), titles)
        })
    })
}

/// Where the criterion stands and what it earned.
fn entry(
    record: &Record,
    item: &ItemRecord,
    student: String,
    titles: &BTreeMap<String, String>,
) -> ReviewEntry {
    ReviewEntry {
        student,
        item: item.id.clone(),
        title: titles.get(&item.id).unwrap_or(&item.id).clone(),
        link: format!("{}#{}", record.full_report(), item_anchor(&item.id)),
        why: String::new(),
        earned: item.earned,
        possible: item.possible,
        alike: None,
        found: String::new(),
        conflicts: Vec::new(),
        example: String::new(),
    }
}

/// What does not go with the numbers, each once: `it is stable: Your pole 2 lies in the right half-plane.`
fn conflicts(item: &ItemRecord) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for conflict in &item.evidence.conflicts {
        let one = format!("{}: {}", conflict.claim, conflict.against);
        if !all.contains(&one) {
            all.push(one);
        }
    }
    all
}
