use super::fingerprint::{Fingerprint, fingerprint};
use super::intake::{AnswerFile, NotRead, answers_another_lab, handed_in, settle_people, student_records};
use super::kept::{Entry, EntryPart, Kept, Pages, report_is_there};
use super::marked::{Marked, our_failure};
use super::new_file::NewFile;
use super::numbers::{Bench, Benches, Numbers, WithoutNumbers, numbers};
use super::record::Record;
use super::run::{ClassError, ClassJob};
use crate::grading::{
    Catalogue, HandMarks, HandMarksFile, Known, MemberCard, Scorecard, grade, grade_beside_members,
    grade_knowing, grade_without_numbers, leave_to_a_person,
};
use crate::lab::Release;
use crate::source::{Finding, Severity, sanitize};
use crate::submission::{AnswerSheet, AttachmentError, Attachments, Student, Submission};
use rayon::prelude::*;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// One report's worth of an answer file, before it has a name: group members who were given different marks by hand (a viva
/// each, say) are marked and reported one by one.
pub struct Part {
    /// What it is called where no student is known.
    pub id: String,
    pub students: Vec<Student>,
    pub found: Found,
    pub source: Arc<SourceFile>,
    /// Its place among the parts of the file.
    pub number: usize,
}

/// Whether there is work to do.
pub enum Found {
    /// An earlier run marked it, and nothing has changed that its marks rest on.
    Kept {
        part: EntryPart,
        record: Box<Record>,
        line: String,
    },
    Read {
        submission: Box<Submission>,
        numbers: Numbers,
    },
    /// A person said that another file counts for its student: its record.
    Discounted(Box<Record>),
}

/// What is known of an answer file, all its parts together.
pub struct SourceFile {
    /// Place among the files of the job.
    pub place: usize,
    pub key: String,
    pub attachments: Vec<(String, String)>,
    pub students: Vec<String>,
    pub marks: String,
}

/// A submission, by whose numbers it is marked, and where its report goes.
pub struct Named<'a> {
    pub submission: Submission,
    pub numbers: Numbers,
    pub file: &'a AnswerFile,
    pub report: String,
}

/// What submissions are marked with.
pub struct Desk<'a> {
    pub job: &'a ClassJob<'a>,
    pub benches: Benches<'a>,
    pub without: WithoutNumbers,
    /// Where everyone has the lab's own numbers, or it is not known whose they are: in one class it is one or the other.
    pub known: Known,
    /// What earlier runs marked.
    pub kept: Kept,
    /// What every mark of this run rests on; `None` when nothing is to be used again.
    pub run: Option<Fingerprint>,
    /// Where files grow.
    pub growing: PathBuf,
}

impl Desk<'_> {
    /// The parts of an answer file, as an earlier run left them, or read.
    pub fn look(&self, place: usize) -> Vec<Part> {
        let Some(file) = self.job.intake.files.get(place) else { return Vec::new() };
        let content = file.read_capped();
        let key = self.key(file, &content);
        self.kept_parts(place, file, &key).unwrap_or_else(|| self.read_parts(place, file, &content, key))
    }

    /// The same part read, whatever was kept of it: another file of the class has changed what is said of it.
    pub fn look_again(&self, part: &Part) -> Option<Part> {
        let file = self.job.intake.files.get(part.source.place)?;
        let parts = self.read_parts(part.source.place, file, &file.read_capped(), part.source.key.clone());
        parts.into_iter().nth(part.number)
    }

    fn key(&self, file: &AnswerFile, content: &Result<Vec<u8>, NotRead>) -> String {
        let Some(run) = &self.run else { return String::new() };
        let run = run.clone().with(&file.name).with(&file.id).with([u8::from(file.followed)]);
        let run =
            run.with_shown(&file.handed_in).with_shown(&file.only_others).with_shown(&file.beside_others);
        let run = run.with_shown(&self.job.marks.and_then(|marks| marks.whose(&file.name)));
        match content {
            Ok(bytes) => run.with(bytes),
            Err(why) => run.with("not read").with(why.to_string()),
        }
        .hex()
    }

    fn kept_parts(&self, place: usize, file: &AnswerFile, key: &str) -> Option<Vec<Part>> {
        self.run.as_ref()?;
        let (entry, records) = self.kept.entry(&file.name)?;
        let folder = file.attachments();
        let same = |(name, found): &(String, String)| *found == outcome(&folder.read(name));
        if entry.key != key
            || entry.marks != self.marks(entry.students.iter().map(String::as_str))
            || !entry.attachments.iter().all(same)
        {
            return None;
        }
        let Entry { attachments, students, marks, parts, .. } = entry;
        let source = Arc::new(SourceFile { place, key: key.to_owned(), attachments, students, marks });
        let parts = parts.into_iter().enumerate().map(|(number, part)| {
            let (record, line) = records.record(&part)?;
            let there = report_is_there(self.job.out, &part);
            let students = record.students.iter();
            let students =
                students.map(|one| Student { id: one.id.clone(), name: one.name.clone() }).collect();
            there.then(|| Part {
                id: record.submission.clone(),
                students,
                found: Found::Kept { part, record: Box::new(record), line },
                source: Arc::clone(&source),
                number,
            })
        });
        parts.collect()
    }

    fn read_parts(
        &self,
        place: usize,
        file: &AnswerFile,
        content: &Result<Vec<u8>, NotRead>,
        key: String,
    ) -> Vec<Part> {
        let noted = Noted { inside: file.attachments(), asked: Mutex::default() };
        let (submission, numbers) = self.read(file, content, &noted);
        let asked = noted.asked.into_inner().unwrap_or_else(PoisonError::into_inner);
        let students: Vec<String> = submission.students.iter().map(|student| student.id.clone()).collect();
        let source = Arc::new(SourceFile {
            place,
            key,
            attachments: asked.into_iter().collect(),
            marks: self.marks(students.iter().map(String::as_str)),
            students,
        });
        let submission = match self.that_count(submission, file) {
            Ok(submission) => submission,
            Err(record) => {
                let found = Found::Discounted(record);
                return vec![Part { id: file.id.clone(), students: Vec::new(), found, source, number: 0 }];
            }
        };
        let alone = by_hand_marks(submission, self.job.marks);
        let parts = alone.into_iter().enumerate().map(|(number, submission)| Part {
            id: submission.id.clone(),
            students: submission.students.clone(),
            found: Found::Read { submission: Box::new(submission), numbers: numbers.clone() },
            source: Arc::clone(&source),
            number,
        });
        parts.collect()
    }

    /// The submission with those of its students for whom a person has not said that another file of the class counts; its
    /// record, not counting, when that leaves nobody.
    fn that_count(&self, mut submission: Submission, file: &AnswerFile) -> Result<Submission, Box<Record>> {
        let mut other = None;
        let mut settled = false;
        let everybody = submission.students.clone();
        submission.students.retain(|student| {
            let Some(counting) = self.counting(&student.id) else { return true };
            settled = true;
            let own = counting.name == file.name;
            other = Some(counting).filter(|_| !own).or(other);
            own
        });
        if settled {
            submission.findings.retain(|finding| finding.code != "intake.several_files");
        }
        match other {
            Some(other) if submission.students.is_empty() => {
                submission.students = everybody;
                let by = (other.id.as_str(), other.name.as_str());
                Err(Box::new(Record::not_counting(&submission, file, by, self.job.roster, self.job.lab)))
            }
            _ => Ok(submission),
        }
    }

    /// The file of the class of which a person has said that it counts for a student.
    fn counting(&self, id: &str) -> Option<&AnswerFile> {
        let name = self.job.marks?.counts_for(id)?;
        self.job.intake.files.iter().find(|one| one.name == name)
    }

    /// Fingerprint of what a person gave these students, decisions for groups of like answers aside.
    fn marks<'s>(&self, students: impl Iterator<Item = &'s str>) -> String {
        let Some(file) = self.job.marks else { return String::new() };
        let all = Fingerprint::default();
        students
            .fold(all, |all, id| {
                all.with(file.marks_for(id).shown()).with_shown(&self.counting(id).map(|one| &one.name))
            })
            .hex()
    }

    /// Reads an answer file with the values that its student has in place of letters.
    fn read(
        &self,
        file: &AnswerFile,
        content: &Result<Vec<u8>, NotRead>,
        attachments: &dyn Attachments,
    ) -> (Submission, Numbers) {
        let lab = self.job.lab;
        let read = |sheet: &AnswerSheet| {
            let mut submission = file.read_from(content, sheet, attachments);
            let whose = self.job.marks.and_then(|marks| marks.whose(&file.name));
            settle_people(&mut submission, file, sheet, self.job.roster, whose);
            submission
        };
        let mut submission = read(&lab.sheet);
        let mut own = numbers(lab, &submission);
        let theirs = own.variant().map(|variant| self.benches.lab(variant));
        // That a lab does not work with somebody's values is told by marking.
        if let Some(Ok(theirs)) = theirs.as_deref() {
            submission = read(&theirs.sheet);
            own = numbers(lab, &submission);
        }
        (submission, own)
    }

    /// In the order given. Submissions with the same numbers are marked one after another, so that what these need is at hand.
    ///
    /// With each the fingerprints of its reports.
    pub fn mark_all(&self, named: Vec<Named<'_>>) -> Result<Vec<(Marked, Pages)>, ClassError> {
        let mut numbered: Vec<(usize, Named<'_>)> = named.into_iter().enumerate().collect();
        numbered.sort_by(|(_, one), (_, two)| one.numbers.cmp(&two.numbers));
        let marked = numbered.into_par_iter().map(|(place, named)| Ok((place, self.mark_and_write(named)?)));
        let mut marked: Vec<(usize, (Marked, Pages))> = marked.collect::<Result<_, ClassError>>()?;
        marked.sort_by_key(|(place, _)| *place);
        Ok(marked.into_iter().map(|(_, marked)| marked).collect())
    }

    fn mark_and_write(&self, named: Named<'_>) -> Result<(Marked, Pages), ClassError> {
        let Named { mut submission, numbers, file, report } = named;
        let job = self.job;
        // Members of a group that are still together were given the same.
        let marks = job.marks.and_then(|file| Some(file.marks_for(&submission.students.first()?.id)));
        let mut failed = submission.findings.iter().any(|f| f.code == our_failure().code);
        let bench = numbers.variant().map(|variant| self.benches.get(variant));
        let bench = bench.as_deref();
        let marking = AssertUnwindSafe(|| self.marked(&numbers, bench, &submission, marks));
        let mut scorecard = match catch_unwind(marking) {
            Ok(Ok(card)) if !failed => card,
            Ok(Err(finding)) if !failed => {
                let message = finding.message.clone();
                submission.findings.push(finding);
                failed = true;
                leave_to_a_person(job.lab, &submission, marks, &message)
            }
            _ => {
                // A reading that failed has said so already.
                if !failed {
                    submission.findings.push(our_failure());
                }
                failed = true;
                leave_to_a_person(job.lab, &submission, marks, &our_failure().message)
            }
        };
        let late = file.handed_in.late;
        let adjustments =
            marks.map_or_else(Vec::new, |hand| hand.adjustments_of(scorecard.cover_total, late));
        scorecard.adjust(adjustments, job.lab.cover.total);
        submission.findings.extend(scorecard.decided_for_other_answers());
        let kit = match (&numbers, bench) {
            (Numbers::Lab, _) => job.kit,
            (_, Some(Ok(bench))) => &bench.kit,
            _ => self.without.kit(job.kit),
        };
        let mut page = |release, bytes: &mut Vec<u8>| {
            bytes.clear();
            let written = AssertUnwindSafe(|| {
                kit.write_released_page(bytes, &submission, &scorecard, release);
            });
            if catch_unwind(written).is_err() {
                failed = true;
                bytes.clear();
                bytes.extend_from_slice(NO_REPORT.as_bytes());
            }
        };
        let mut write = |report: &str, release| -> Result<String, ClassError> {
            // Each thread writes all its pages into one piece of memory.
            PAGE.with_borrow_mut(|bytes| {
                page(release, bytes);
                NewFile::create(job.out.join(report), &self.growing)?.write_all(bytes)?;
                Ok(fingerprint(bytes))
            })
        };
        let mut pages = Pages { report: write(&report, job.release)?, instructor: None };
        if job.release != Release::ALL {
            let full = report.replacen("reports/", "instructor/", 1);
            let written = write(&full, Release::ALL)?;
            pages.instructor = Some((full, written));
        }
        let marked = Marked {
            parameters: numbers.values(job.lab),
            variant: numbers.variant().cloned(),
            other_variants: Vec::new(),
            handed_in: handed_in(file, job.roster),
            students: student_records(&submission, job.roster),
            submission,
            scorecard,
            report,
            instructor: pages.instructor.as_ref().map(|(path, _)| path.clone()),
            failed,
        };
        Ok((marked, pages))
    }

    /// Errors: what does not work with these numbers.
    fn marked(
        &self,
        numbers: &Numbers,
        bench: Option<&Result<Bench, String>>,
        submission: &Submission,
        marks: Option<&HandMarks>,
    ) -> Result<Scorecard, Finding> {
        let job = self.job;
        if answers_another_lab(submission, &job.lab.sheet) {
            return Ok(leave_to_a_person(job.lab, submission, marks, "The file answers another lab."));
        }
        match (numbers, bench) {
            (Numbers::Own { members, .. }, Some(Ok(own))) => {
                if members.is_empty() {
                    return Ok(grade_knowing(
                        &own.known,
                        &own.lab,
                        &own.reference,
                        &own.catalogue,
                        submission,
                        marks,
                    ));
                }
                let cards = members.iter().filter_map(|(id, variant)| {
                    let theirs = self.benches.get(variant);
                    let theirs = theirs.as_ref().as_ref().ok()?;
                    let none = Catalogue::default();
                    let scorecard = grade(&theirs.lab, &theirs.reference, &none, submission, None);
                    Some(MemberCard { id: id.clone(), scorecard })
                });
                let cards: Vec<MemberCard> = cards.collect();
                let Bench { lab, reference, catalogue, known, .. } = own;
                Ok(grade_beside_members(known, lab, reference, catalogue, submission, marks, &cards))
            }
            (Numbers::Own { .. }, Some(Err(why))) => Err(does_not_work(why)),
            (Numbers::Unknown, _) => {
                let reference = self.without.reference(job.reference);
                Ok(grade_without_numbers(&self.known, job.lab, reference, job.catalogue, submission, marks))
            }
            _ => Ok(grade_knowing(&self.known, job.lab, job.reference, job.catalogue, submission, marks)),
        }
    }
}

thread_local! {
    static PAGE: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

const NO_REPORT: &str = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>polemark</title>\
    <p>polemark could not write this report. The marks are in gradebook.csv and results.jsonl.</p></html>";

fn does_not_work(why: &str) -> Finding {
    Finding {
        severity: Severity::Error,
        code: "variant.fails",
        message: format!(
            "The right answers for your numbers could not be worked out ({}), which is not your fault. A person will mark it.",
            sanitize(why)
        ),
        help: None,
        span: None,
    }
}

/// Remembers what was asked for, and what came of it.
struct Noted {
    inside: Box<dyn Attachments>,
    asked: Mutex<BTreeMap<String, String>>,
}

impl Attachments for Noted {
    fn read(&self, file_name: &str) -> Result<Vec<u8>, AttachmentError> {
        let found = self.inside.read(file_name);
        let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        asked.insert(file_name.to_owned(), outcome(&found));
        found
    }
}

/// Fingerprint of what came of reading a file.
fn outcome(found: &Result<Vec<u8>, AttachmentError>) -> String {
    match found {
        Ok(bytes) => fingerprint(bytes),
        Err(error) => error.to_string(),
    }
}

/// Group members who were given different marks by hand, each alone.
fn by_hand_marks(submission: Submission, marks: Option<&HandMarksFile>) -> Vec<Submission> {
    let given = |student: &Student| marks.map(|file| file.marks_for(&student.id));
    let alike = submission.students.windows(2).all(|pair| given(&pair[0]) == given(&pair[1]));
    if alike {
        return vec![submission];
    }
    let alone = |student: &Student| Submission { students: vec![student.clone()], ..submission.clone() };
    submission.students.iter().map(alone).collect()
}
