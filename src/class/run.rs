use super::Roster;
use super::desk::{Desk, Named};
use super::gradebook::Gradebook;
use super::intake::{AnswerFile, UniqueNames};
use super::new_file::NewFile;
use super::numbers::{Benches, Numbers, WithoutNumbers};
use super::others::Others;
use super::outcome::Outcome;
use super::record::Record;
use super::statistics::Statistics;
use super::students_seen::StudentsSeen;
use crate::grading::{Catalogue, HandMarksFile};
use crate::lab::LabDefinition;
use crate::reference::Reference;
use crate::report::{ReportError, ReportKit};
use crate::submission::{Student, Submission};
use rayon::prelude::*;
use std::io::{self, BufWriter, Read, Write};
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
