use super::intake::AnswerFile;
use super::marked::{Marked, our_failure, unreadable_submission};
use super::new_file::NewFile;
use super::numbers::{Bench, Benches, Numbers, WithoutNumbers, numbers};
use super::run::{ClassError, ClassJob, read_capped};
use crate::grading::{
    Catalogue, HandMarks, MemberCard, Scorecard, grade, grade_beside_members, grade_without_numbers,
    leave_to_a_person,
};
use crate::source::{Finding, Severity, sanitize};
use crate::submission::{AnswerSheet, Folder, Student, Submission, read};
use rayon::prelude::*;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// A submission, by whose numbers it is marked, and where its report goes.
pub struct Named {
    pub submission: Submission,
    pub numbers: Numbers,
    pub report: String,
}

/// What submissions are marked with.
pub struct Desk<'a> {
    pub job: &'a ClassJob<'a>,
    pub benches: Benches<'a>,
    pub without: WithoutNumbers,
}

impl Desk<'_> {
    /// Reads an answer file with the values that its student has in place of letters.
    pub fn read(&self, file: &AnswerFile) -> (Submission, Numbers) {
        let lab = self.job.lab;
        let mut submission = read_submission(file, &lab.sheet);
        let mut own = numbers(lab, &mut submission, self.job.roster);
        let theirs = own.variant().map(|variant| self.benches.lab(variant));
        // That a lab does not work with somebody's values is told by marking.
        if let Some(Ok(theirs)) = theirs.as_deref() {
            submission = read_submission(file, &theirs.sheet);
            own = numbers(lab, &mut submission, self.job.roster);
        }
        (submission, own)
    }

    /// In the order given. Submissions with the same numbers are marked one after another, so that what these need is at hand.
    pub fn mark_all(&self, named: Vec<Named>) -> Result<Vec<Marked>, ClassError> {
        let mut numbered: Vec<(usize, Named)> = named.into_iter().enumerate().collect();
        numbered.sort_by(|(_, one), (_, two)| one.numbers.cmp(&two.numbers));
        let marked = numbered.into_par_iter().map(|(place, named)| Ok((place, self.mark_and_write(named)?)));
        let mut marked: Vec<(usize, Marked)> = marked.collect::<Result<_, ClassError>>()?;
        marked.sort_by_key(|(place, _)| *place);
        Ok(marked.into_iter().map(|(_, marked)| marked).collect())
    }

    fn mark_and_write(&self, named: Named) -> Result<Marked, ClassError> {
        let Named { mut submission, numbers, report } = named;
        let job = self.job;
        // Members of a group that are still together were given the same.
        let marks = job.marks.and_then(|file| Some(file.marks_for(&submission.students.first()?.id)));
        let mut failed = submission.findings.iter().any(|f| f.code == our_failure().code);
        let bench = numbers.variant().map(|variant| self.benches.get(variant));
        let bench = bench.as_deref();
        let marking = AssertUnwindSafe(|| self.marked(&numbers, bench, &submission, marks));
        let scorecard = match catch_unwind(marking) {
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
        let kit = match (&numbers, bench) {
            (Numbers::Lab, _) => job.kit,
            (_, Some(Ok(bench))) => &bench.kit,
            _ => self.without.kit(job.kit),
        };
        let page = match catch_unwind(AssertUnwindSafe(|| kit.student_page(&submission, &scorecard))) {
            Ok(page) => page,
            Err(_) => {
                failed = true;
                "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>polemark</title>\
                 <p>polemark could not write this report. The marks are in gradebook.csv and results.jsonl.</p></html>"
                    .to_owned()
            }
        };
        NewFile::create(job.out.join(&report))?.write_all(page.as_bytes())?;
        Ok(Marked {
            parameters: numbers.values(job.lab),
            variant: numbers.variant().cloned(),
            other_variants: Vec::new(),
            submission,
            scorecard,
            report,
            failed,
        })
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
        match (numbers, bench) {
            (Numbers::Own { members, .. }, Some(Ok(own))) => {
                if members.is_empty() {
                    return Ok(grade(&own.lab, &own.reference, &own.catalogue, submission, marks));
                }
                let cards = members.iter().filter_map(|(id, variant)| {
                    let theirs = self.benches.get(variant);
                    let theirs = theirs.as_ref().as_ref().ok()?;
                    let none = Catalogue::default();
                    let scorecard = grade(&theirs.lab, &theirs.reference, &none, submission, None);
                    Some(MemberCard { id: id.clone(), scorecard })
                });
                let cards: Vec<MemberCard> = cards.collect();
                let Bench { lab, reference, catalogue, .. } = own;
                Ok(grade_beside_members(lab, reference, catalogue, submission, marks, &cards))
            }
            (Numbers::Own { .. }, Some(Err(why))) => Err(does_not_work(why)),
            (Numbers::Unknown, _) => {
                let reference = self.without.reference(job.reference);
                Ok(grade_without_numbers(job.lab, reference, job.catalogue, submission, marks))
            }
            _ => Ok(grade(job.lab, job.reference, job.catalogue, submission, marks)),
        }
    }
}

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

fn read_submission(file: &AnswerFile, sheet: &AnswerSheet) -> Submission {
    let read = || match read_capped(&file.path) {
        Ok(bytes) => {
            let folder = Folder(file.path.parent().unwrap_or(Path::new("")).to_path_buf());
            read(&file.id, &file.name, &bytes, sheet, &folder)
        }
        Err(error) => unreadable_submission(&file.id, &file.name, not_opened(&error)),
    };
    let mut submission = if file.path.is_symlink() && !file.followed {
        unreadable_submission(&file.id, &file.name, is_a_link())
    } else {
        catch_unwind(AssertUnwindSafe(read))
            .unwrap_or_else(|_| unreadable_submission(&file.id, &file.name, our_failure()))
    };
    if submission.students.is_empty() {
        submission.students.push(Student { id: file.id.clone(), name: String::new() });
    }
    submission
}

fn is_a_link() -> Finding {
    Finding {
        severity: Severity::Error,
        code: "file.link",
        message: "This is a link to another file, which is not followed.".to_owned(),
        help: Some("Hand in the file itself.".to_owned()),
        span: None,
    }
}

fn not_opened(error: &io::Error) -> Finding {
    Finding {
        severity: Severity::Error,
        code: "file.not_opened",
        message: format!("The file could not be opened: {error}."),
        help: None,
        span: None,
    }
}
