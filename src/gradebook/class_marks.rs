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
    /// Students are not to see their points.
    pub withhold_marks: bool,
}

impl Rules {
    /// The mark of a record, not scaled, or why there is none to pass on.
    ///
    /// It is the sum of the cover sheet with the adjustments. As it stands, what waits for a person counts for nothing.
    pub fn mark(&self, record: &Record) -> Result<Points, Why> {
        match Why::not_final(record) {
            Some(Why::HandedNothingIn) if self.zero_for_missing => Ok(Points::ZERO),
            Some(why @ (Why::Failed | Why::HandedNothingIn)) => Err(why),
            Some(why) if !self.as_it_stands => Err(why),
            _ if record.mark.is_some() => Ok(record.mark.map_or(Points::ZERO, |mark| mark.earned)),
            _ => {
                let known = || {
                    record.so_far.unwrap_or_else(|| record.cover.iter().filter_map(|one| one.earned).sum())
                };
                let adjustments: Points = record.adjustments.iter().filter_map(|one| one.points).sum();
                let sum = record.cover_total.unwrap_or_else(known) + adjustments;
                Ok(sum.clamp(Points::ZERO, out_of(record).max(Points::ZERO)))
            }
        }
    }
}

/// What a record's mark is out of.
pub fn out_of(record: &Record) -> Points {
    record.cover.iter().map(|one| one.possible).sum()
}

/// Tells students apart by their ids, however those are typed.
pub fn key(id: &str) -> String {
    let folded = folded_id(id);
    if folded.is_empty() { id.to_owned() } else { folded }
}

/// What an export needs to know of a student: small, for all students are in memory at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person {
    pub id: String,
    /// By the roster, else as they wrote it.
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
        let key = key(&student.id);
        if let Some(first) = seen.get(&key).and_then(|at| self.people.get_mut(*at)) {
            // Which of them counts is for a person to say, whatever else is asked for.
            match &mut first.mark {
                Err(Why::SeveralFiles(files)) => files.push(record.file.clone()),
                mark => *mark = Err(Why::SeveralFiles(vec![first.file.clone(), record.file.clone()])),
            }
            return;
        }
        seen.insert(key, self.people.len());
        let on_roster = student.roster.as_deref().map(|row| &row.name);
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
            name: on_roster.filter(|name| !name.is_empty()).unwrap_or(&student.name).clone(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gradebook::tests::record;
    use crate::lab::Points;

    /// Each student with the mark or the reason.
    #[track_caller]
    fn check(what: &str, records: Vec<Record>, rules: Rules, people: &[&str]) {
        let class = ClassMarks::read(records.into_iter().map(Ok), &rules).unwrap();
        let shown: Vec<String> = class
            .people
            .iter()
            .map(|one| match &one.mark {
                Ok(mark) => format!("{} {mark}", one.id),
                Err(why) => format!("{}: {why}", one.id),
            })
            .collect();
        assert_eq!(shown, people, "{what}");
    }

    fn finding(code: &str) -> crate::class::FindingRecord {
        crate::class::FindingRecord {
            severity: "warning".to_owned(),
            code: code.to_owned(),
            message: "somebody has to look".to_owned(),
            line: None,
            column: None,
        }
    }

    #[test]
    fn only_final_marks_are_passed_on() {
        let all = || {
            let mut group = record("EE-001", "Jane");
            group.students.extend(record("EE-002", "John").students);
            let mut held = record("EE-003", "");
            held.findings.push(finding("student.not_on_roster"));
            let mut noted = record("EE-004", "");
            noted.findings.push(finding("intake.owner"));
            let mut provisional = record("EE-005", "");
            provisional.total.provisional = Points(50);
            let mut box_empty = record("EE-006", "");
            (box_empty.cover[1].earned, box_empty.cover_total) = (None, None);
            let mut missing = record("EE-007", "");
            (missing.status, missing.cover_total) = (Status::Missing, None);
            missing.cover.iter_mut().for_each(|one| one.earned = None);
            let mut adjusted = record("EE-010", "");
            adjusted.adjustments = serde_json::from_str(r#"[{"points": -5, "reason": "late"}]"#).unwrap();
            let mut half_adjusted = record("EE-011", "");
            half_adjusted.adjustments =
                serde_json::from_str(r#"[{"points": null, "reason": "late"}]"#).unwrap();
            let mut failed = record("EE-008", "");
            failed.failed = true;
            let mut superseded = record("EE-004", "");
            superseded.status = Status::Superseded;
            let (first, again) = (record("EE-009", ""), record("ee 009", ""));
            vec![
                group,
                held,
                noted,
                provisional,
                box_empty,
                missing,
                failed,
                superseded,
                first,
                again,
                adjusted,
                half_adjusted,
            ]
        };
        let several = "EE-009: several files count for this student: EE-009.yaml, ee 009.yaml";
        let failed = "EE-008: polemark failed on the answer file";
        check(
            "as a rule",
            all(),
            Rules::default(),
            &[
                "EE-001 7.5",
                "EE-002 7.5",
                "EE-003: somebody has to look",
                "EE-004 7.5",
                "EE-005: 1 criterion waits for a person",
                "EE-006: 1 box of the cover sheet is not filled in yet",
                "EE-007: handed nothing in",
                failed,
                several,
                "EE-010 2.5",
                "EE-011: 1 adjustment waits for a person",
            ],
        );
        let rules = Rules {
            as_it_stands: true,
            zero_for_missing: true,
            scale_to: Some(Points(10_000)),
            ..Rules::default()
        };
        let out = [
            "EE-001 75",
            "EE-002 75",
            "EE-003 75",
            "EE-004 75",
            "EE-005 75",
            "EE-006 45",
            "EE-007 0",
            failed,
            several,
            "EE-010 25",
            "EE-011 75",
        ];
        check("as it stands, of 100", all(), rules, &out);
    }

    #[test]
    fn as_it_stands_what_is_known_of_a_box_counts() {
        let mut half = record("EE-001", "");
        half.cover.iter_mut().for_each(|one| one.earned = None);
        (half.cover_total, half.mark, half.so_far) = (None, None, Some(Points(641)));
        half.adjustments = serde_json::from_str(r#"[{"points": -5, "reason": "late"}]"#).unwrap();
        assert!(Rules::default().mark(&half).is_err());
        let rules = Rules { as_it_stands: true, ..Rules::default() };
        assert_eq!(rules.mark(&half), Ok(Points(141)));
    }

    #[test]
    fn marks_of_two_labs_are_not_mixed() {
        let mut other = record("EE-002", "");
        other.cover[0].possible = Points(100);
        let read = ClassMarks::read([Ok(record("EE-001", "")), Ok(other)].into_iter(), &Rules::default());
        assert!(matches!(read, Err(ExportError::TwoScales { .. })));
        assert!(matches!(ClassMarks::read(std::iter::empty(), &Rules::default()), Err(ExportError::Empty)));
    }
}
