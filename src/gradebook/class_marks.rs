use super::numbers::scaled;
use super::{ExportError, Summary, Why};
use crate::class::{HandedIn, Record, RosterStudent, Status, StudentRecord};
use crate::lab::{Points, folded_id};
use std::collections::BTreeMap;

/// Which marks are passed on, and out of how many points.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rules {
    /// Also marks that wait for a person, with empty boxes as no points.
    pub as_it_stands: bool,
    /// No points for whoever handed nothing in, instead of no mark.
    pub zero_for_missing: bool,
    /// Marks are scaled to be out of so many points.
    pub scale_to: Option<Points>,
}

impl Rules {
    /// The mark of a record, not scaled, or why there is none to pass on.
    ///
    /// It is the sum of the cover sheet. As it stands, an empty box counts for nothing.
    pub fn mark(&self, record: &Record) -> Result<Points, Why> {
        match Why::not_final(record) {
            Some(Why::HandedNothingIn) if self.zero_for_missing => Ok(Points::ZERO),
            Some(why @ (Why::Failed | Why::HandedNothingIn)) => Err(why),
            Some(why) if !self.as_it_stands => Err(why),
            _ => Ok(record
                .cover_total
                .unwrap_or_else(|| record.cover.iter().filter_map(|one| one.earned).sum())),
        }
    }
}

/// What a record's mark is out of.
pub fn out_of(record: &Record) -> Points {
    record.cover.iter().map(|one| one.possible).sum()
}

/// What an export needs to know of a student: small, for all students are in memory at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person {
    pub id: String,
    pub name: String,
    pub roster: Option<Box<RosterStudent>>,
    /// Who handed it in, where that can only be this student.
    pub handed_in: Option<HandedIn>,
    pub file: String,
    pub mark: Result<Points, Why>,
    /// Points by question, `analysis: 12 of 20; …`.
    pub by_question: String,
}

impl Person {
    /// `EE-001 (Jane Doe)`.
    pub fn who(&self) -> String {
        if self.name.is_empty() { self.id.clone() } else { format!("{} ({})", self.id, self.name) }
    }
}

/// Students of a class and their marks, in the order of the records.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMarks {
    pub people: Vec<Person>,
    /// What a full mark is, scaled.
    pub out_of: Points,
    /// Files that name no student.
    pub of_nobody: Vec<String>,
}

impl ClassMarks {
    pub fn read(
        records: impl Iterator<Item = Result<Record, ExportError>>,
        rules: &Rules,
    ) -> Result<Self, ExportError> {
        let mut class = Self { people: Vec::new(), out_of: Points::ZERO, of_nobody: Vec::new() };
        let mut possible = None;
        let mut seen = BTreeMap::new();
        for record in records {
            let record = record?;
            if !record.counts() {
                continue;
            }
            let from = out_of(&record);
            if *possible.get_or_insert(from) != from {
                return Err(ExportError::TwoScales { one: possible.unwrap_or(from), two: from });
            }
            let mark = match (rules.mark(&record), rules.scale_to) {
                (Ok(mark), Some(to)) => Ok(scaled(mark, from, to).ok_or(ExportError::NothingToScale)?),
                (mark, _) => mark,
            };
            if record.students.is_empty() {
                class.of_nobody.push(record.file.clone());
            }
            for student in &record.students {
                class.add(student, &record, mark.clone(), &mut seen);
            }
        }
        class.out_of = rules.scale_to.or(possible).ok_or(ExportError::Empty)?;
        Ok(class)
    }

    fn add(
        &mut self,
        student: &StudentRecord,
        record: &Record,
        mark: Result<Points, Why>,
        seen: &mut BTreeMap<String, usize>,
    ) {
        let folded = folded_id(&student.id);
        let key = if folded.is_empty() { student.id.clone() } else { folded };
        if let Some(first) = seen.get(&key).and_then(|at| self.people.get_mut(*at)) {
            // Which of them counts is for a person to say, whatever else is asked for.
            match &mut first.mark {
                Err(Why::SeveralFiles(files)) => files.push(record.file.clone()),
                mark => *mark = Err(Why::SeveralFiles(vec![first.file.clone(), record.file.clone()])),
            }
            return;
        }
        seen.insert(key, self.people.len());
        let alone = record.students.len() == 1;
        let handed_in = record.handed_in.clone().filter(|one| alone && one.group.is_none());
        let questions = record.questions.iter();
        let by_question: Vec<String> = questions
            .map(|question| {
                format!("{}: {} of {}", question.id, question.tally.earned, question.tally.possible)
            })
            .collect();
        self.people.push(Person {
            id: student.id.clone(),
            name: student.name.clone(),
            roster: student.roster.clone(),
            handed_in,
            file: record.file.clone(),
            mark,
            by_question: if record.status == Status::Marked { by_question.join("; ") } else { String::new() },
        });
    }

    /// Begins with those whose mark is not passed on.
    pub(super) fn summary(&self) -> Summary {
        let mut summary = Summary::default();
        for file in &self.of_nobody {
            summary.leave_out(file, Why::Nobody);
        }
        for person in &self.people {
            if let Err(why) = &person.mark {
                summary.leave_out(person.who(), why.clone());
            }
        }
        summary
    }
}
