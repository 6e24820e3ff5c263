//! Lines for what is not marked: who handed nothing in, and attempts that do not count.

use super::intake::settle_people;
use super::{ClassJob, Record};
use crate::lab::folded_id;
use std::collections::{BTreeMap, BTreeSet};

/// The roster's students, of whom it is noted who has handed something in.
#[derive(Debug, Default)]
pub struct Absentees {
    present: BTreeSet<String>,
}

impl Absentees {
    /// Notes whose `record` is. One that a person must first say whose it is leaves nobody out all the same.
    pub fn add(&mut self, record: &Record) {
        for student in &record.students {
            self.present.insert(folded_id(&student.id));
        }
    }

    /// One record for each student of the roster who handed nothing in, in its order; none without a roster.
    pub fn records<'a>(&'a self, job: &'a ClassJob<'_>) -> impl Iterator<Item = Record> + 'a {
        let students = job.roster.iter().flat_map(|roster| &roster.students);
        let absent = students.filter(|student| !self.present.contains(&folded_id(&student.id)));
        absent.map(|student| Record::missing(student, job.lab))
    }
}

/// One record for each answer file that does not count, in their order.
pub fn superseded_records<'a>(job: &'a ClassJob<'_>) -> impl Iterator<Item = Record> + 'a {
    let names: BTreeMap<&str, &str> =
        job.intake.files.iter().map(|file| (file.id.as_str(), file.name.as_str())).collect();
    job.intake.superseded.iter().map(move |one| {
        let by = names.get(one.by.as_str()).copied().unwrap_or(one.by.as_str());
        let mut submission = one.file.read(&job.lab.sheet);
        let whose = job.marks.and_then(|marks| marks.whose(&one.file.name));
        settle_people(&mut submission, &one.file, &job.lab.sheet, job.roster, whose);
        Record::superseded(one, by, &submission, job.roster, job.lab)
    })
}
