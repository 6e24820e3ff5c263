use super::Roster;
use super::gradebook::Gradebook;
use super::intake::{AnswerFile, UniqueNames};
use super::marked::{Marked, our_failure, unreadable_submission};
use super::numbers::{Bench, Benches, Numbers, WithoutNumbers, numbers};
use super::others::Others;
use super::outcome::Outcome;
use super::record::Record;
use super::statistics::Statistics;
use super::students_seen::StudentsSeen;
use crate::grading::{
    Catalogue, HandMarks, HandMarksFile, MemberCard, Scorecard, grade, grade_beside_members,
    grade_without_numbers, leave_to_a_person,
};
use crate::lab::LabDefinition;
use crate::reference::Reference;
use crate::report::{ReportError, ReportKit};
use crate::source::{Finding, Severity, sanitize};
use crate::submission::{AnswerSheet, Folder, Student, Submission, read};
use rayon::prelude::*;
use std::io::{self, BufWriter, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// Submissions in memory at a time; results are written in order after each such group.
const GROUP: usize = 64;
/// Answer files are refused far below this; reading stops here.
const READ_LIMIT: u64 = 1 << 20;
/// Stack of a worker: formulas and prose nest, within limits, on it.
const STACK_BYTES: usize = 16 << 20;

/// What to mark, against what, and where to write.
pub struct ClassJob<'a> {
    pub lab: &'a LabDefinition,
    pub reference: &'a Reference,
    pub catalogue: &'a Catalogue,
    pub kit: &'a ReportKit,
    pub marks: Option<&'a HandMarksFile>,
    /// The students of the course, where they are known.
    pub roster: Option<&'a Roster>,
    pub files: &'a [AnswerFile],
    pub out: &'a Path,
    /// Worker threads; 0 is one a core.
    pub threads: usize,
}

#[derive(Debug, thiserror::Error)]
pub enum ClassError {
    #[error("`{}` cannot be written: {error}", path.display())]
    Write { path: PathBuf, error: io::Error },
    #[error("the gradebook cannot be written: {0}")]
    Gradebook(#[from] csv::Error),
    #[error("a result cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error("no worker threads could be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// At most a little more than an answer file may hold, so that a huge one is refused without being read.
///
/// Errors: also for what is no plain file; a pipe could keep us waiting for ever.
pub fn read_capped(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a plain file"));
    }
    std::fs::File::open(path)?.take(READ_LIMIT).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Marks every file and writes `index.html`, `reports/…`, `gradebook.csv`, `results.jsonl` into `job.out`.
///
/// A bad file never stops the class: it gets a report and a row like any other. Files appear whole or not at all.
/// `progress` is told after each group how many submissions are done.
pub fn grade_class(job: &ClassJob<'_>, progress: &dyn Fn(usize)) -> Result<Outcome, ClassError> {
    let reports = job.out.join("reports");
    std::fs::create_dir_all(&reports).map_err(|error| ClassError::Write { path: reports, error })?;
    // More threads than submissions marked at a time would only wait.
    let threads = job.threads.min(GROUP);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK_BYTES).build()?;

    let results = NewFile::create(job.out.join("results.jsonl"))?;
    let mut lines = BufWriter::new(results.file.as_file());
    let gradebook_file = NewFile::create(job.out.join("gradebook.csv"))?;
    let mut gradebook = Gradebook::new(gradebook_file.file.as_file(), job.lab)?;
    let mut statistics = Statistics::new(job.lab);
    let mut names = UniqueNames::default();
    let mut seen = StudentsSeen::default();
    let desk = Desk {
        job,
        benches: Benches::new(job.lab, job.reference, job.kit),
        without: WithoutNumbers::new(job.lab, job.reference, job.kit)?,
    };
    let mut others = pool.install(|| Others::new(job));
    let mut done = 0;

    for group in job.files.chunks(GROUP) {
        let submissions: Vec<(Submission, Numbers)> = pool.install(|| {
            group
                .par_iter()
                .map(|file| desk.read(file))
                .flat_map_iter(|(submission, numbers)| {
                    let alone = by_hand_marks(submission, job.marks);
                    alone.into_iter().map(move |one| (one, numbers.clone()))
                })
                .collect()
        });
        // Names depend on who came before, so they are given in order.
        let named: Vec<Named> = submissions
            .into_iter()
            .map(|(mut submission, numbers)| {
                seen.add(&mut submission);
                let name = names.claim(&report_stem(&submission));
                Named { submission, numbers, report: format!("reports/{name}.html") }
            })
            .collect();
        let mut marked = pool.install(|| desk.mark_all(named))?;
        pool.install(|| others.point_out(job, &mut marked));
        for marked in &marked {
            let record = Record::of(marked, job.lab);
            writeln!(lines, "{}", record.to_line()?)
                .map_err(|error| ClassError::Write { path: results.path.clone(), error })?;
            gradebook.add(&record)?;
            statistics.add(&record);
        }
        done += group.len();
        progress(done);
    }

    lines.flush().map_err(|error| ClassError::Write { path: results.path.clone(), error })?;
    drop(lines);
    results.finish()?;
    gradebook.finish().map_err(|error| ClassError::Write { path: gradebook_file.path.clone(), error })?;
    gradebook_file.finish()?;
    let mut outcome = statistics.outcome();
    outcome.ids_given_twice = seen.given_twice();
    outcome.older_reports = older_reports(job.out, &statistics);
    if let Some(marks) = job.marks {
        outcome.marks_without_submission = statistics.absent(marks.student_ids());
        outcome.decisions_without_answers = marks.decisions_without_answers(statistics.groups());
    }
    let index = NewFile::create(job.out.join("index.html"))?;
    index.write_all(job.kit.class_page(&statistics.summary(job.lab)).as_bytes())?;
    Ok(outcome)
}

/// Reports in the folder that this run did not write: of an earlier run, so possibly out of date.
fn older_reports(out: &Path, statistics: &Statistics) -> usize {
    let Ok(entries) = std::fs::read_dir(out.join("reports")) else { return 0 };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter(|name| name.ends_with(".html") && !statistics.has_report(&format!("reports/{name}"))).count()
}

/// Group members who were given different marks by hand (a viva each, say) are marked and reported one by one.
fn by_hand_marks(submission: Submission, marks: Option<&HandMarksFile>) -> Vec<Submission> {
    let given = |student: &Student| marks.map(|file| file.marks_for(&student.id));
    let alike = submission.students.windows(2).all(|pair| given(&pair[0]) == given(&pair[1]));
    if alike {
        return vec![submission];
    }
    let alone = |student: &Student| Submission { students: vec![student.clone()], ..submission.clone() };
    submission.students.iter().map(alone).collect()
}

/// Who it is from, as far as could be read; the file's name otherwise.
fn report_stem(submission: &Submission) -> String {
    let ids: Vec<&str> =
        submission.students.iter().map(|s| s.id.as_str()).filter(|id| !id.is_empty()).collect();
    if ids.is_empty() { submission.id.clone() } else { ids.join("_") }
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

/// A submission, by whose numbers it is marked, and where its report goes.
struct Named {
    submission: Submission,
    numbers: Numbers,
    report: String,
}

/// What submissions are marked with.
struct Desk<'a> {
    job: &'a ClassJob<'a>,
    benches: Benches<'a>,
    without: WithoutNumbers,
}

impl Desk<'_> {
    /// Reads an answer file with the values that its student has in place of letters.
    fn read(&self, file: &AnswerFile) -> (Submission, Numbers) {
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
    fn mark_all(&self, named: Vec<Named>) -> Result<Vec<Marked>, ClassError> {
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

/// A file that takes its name only when it is whole.
struct NewFile {
    path: PathBuf,
    file: tempfile::NamedTempFile,
}

impl NewFile {
    fn create(path: PathBuf) -> Result<Self, ClassError> {
        let folder = path.parent().unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".polemark-");
        // Others may read it, as with any file one writes.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
        let file =
            builder.tempfile_in(folder).map_err(|error| ClassError::Write { path: path.clone(), error })?;
        Ok(Self { path, file })
    }

    fn write_all(mut self, bytes: &[u8]) -> Result<(), ClassError> {
        self.file.write_all(bytes).map_err(|error| ClassError::Write { path: self.path.clone(), error })?;
        self.finish()
    }

    fn finish(self) -> Result<(), ClassError> {
        let Self { path, file } = self;
        match file.persist(&path) {
            Ok(_) => Ok(()),
            Err(failed) => Err(ClassError::Write { path, error: failed.error }),
        }
    }
}
