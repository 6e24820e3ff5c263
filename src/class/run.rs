use super::Roster;
use super::desk::{Desk, Found, Named, Part, SourceFile};
use super::fingerprint::Fingerprint;
use super::gradebook::Gradebook;
use super::intake::{Intake, UniqueNames};
use super::kept::{Kept, Pages, is_as_it_was, run_fingerprint};
use super::marked::Marked;
use super::new_file::NewFile;
use super::numbers::{Benches, WithoutNumbers};
use super::others::Others;
use super::outcome::Outcome;
use super::own_files::foreign_file;
use super::record::Record;
use super::run_facts::RunFacts;
use super::run_records::{RunRecords, Written};
use super::statistics::Statistics;
use super::students_seen::StudentsSeen;
use super::without_marks::{Absentees, superseded_records};
use super::workplace::Workplace;
use crate::grading::{Catalogue, HandMarksFile, Known};
use crate::lab::{LabDefinition, Release};
use crate::reference::Reference;
use crate::report::{ReportError, ReportKit};
use crate::source::Finding;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs::File;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Submissions in memory at a time; results are written in order after each such group.
const GROUP: usize = 64;
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
    pub intake: &'a Intake,
    pub out: &'a Path,
    /// What students get to see in their reports.
    pub release: Release,
    /// Worker threads; 0 is one a core.
    pub threads: usize,
    /// Marks everything again, whatever earlier runs left.
    pub from_scratch: bool,
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Answer files dealt with.
    pub done: usize,
    /// Submissions of which nothing had changed since an earlier run.
    pub kept: usize,
}

#[derive(Debug, thiserror::Error)]
pub enum ClassError {
    #[error("`{}` cannot be written: {error}", path.display())]
    Write { path: PathBuf, error: io::Error },
    #[error(
        "`{}` is not by polemark and would be overwritten: give another folder with `--out`, or move the file away", path.display()
    )]
    Foreign { path: PathBuf },
    #[error("another polemark is writing into `{}`; wait until it has finished", out.display())]
    Busy { out: PathBuf },
    #[error("the gradebook cannot be written: {0}")]
    Gradebook(#[from] csv::Error),
    #[error("a result cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error("no worker threads could be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Marks every file and writes `index.html`, `reports/…`, `gradebook.csv`, `results.jsonl`, `run.json` into `job.out`.
///
/// A bad file never stops the class: it gets a report and a row like any other. Files appear whole or not at all. What an
/// earlier run in the same folder marked is not marked again where nothing has changed that it rests on; the files come out
/// as if it were. `progress` is told after each group how far it is; when it says stop, what is done is kept for the next run,
/// and class page, gradebook and results stay those of the last run that finished.
pub fn grade_class(
    job: &ClassJob<'_>,
    progress: &dyn Fn(Progress) -> ControlFlow<()>,
) -> Result<Outcome, ClassError> {
    if let Some(path) = foreign_file(job.out) {
        return Err(ClassError::Foreign { path });
    }
    let withheld = (job.release != Release::ALL).then(|| job.out.join("instructor"));
    for folder in withheld.into_iter().chain([job.out.join("reports")]) {
        std::fs::create_dir_all(&folder).map_err(|error| ClassError::Write { path: folder, error })?;
    }
    let workplace = Workplace::open(job.out)?;
    // More threads than submissions marked at a time would only wait.
    let threads = job.threads.min(GROUP);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK_BYTES).build()?;

    let gradebook_file = NewFile::create(job.out.join("gradebook.csv"), &workplace.running())?;
    let mut sink = Sink {
        records: RunRecords::create(job, &workplace)?,
        gradebook: Gradebook::new(gradebook_file.again()?, job.lab)?,
        statistics: Statistics::new(job.lab),
        absentees: Absentees::default(),
        done: 0,
    };
    let mut names = UniqueNames::default();
    let mut seen = StudentsSeen::default();
    let mut others = pool.install(|| Others::new(job));
    let desk = Desk {
        job,
        benches: Benches::new(job.lab, job.reference, job.kit),
        known: Known::new(),
        without: WithoutNumbers::new(job.lab, job.reference, job.kit)?,
        kept: if job.from_scratch { Kept::nothing() } else { Kept::open(job.out, &workplace) },
        run: rests_on(job, &others),
        growing: workplace.running(),
    };
    let mut discounted = Vec::new();
    // Marked, and not written yet: that is done beside marking the next group.
    let mut at_hand: Option<Batch> = None;

    for first in (0..job.intake.files.len()).step_by(GROUP) {
        let group = first..job.intake.files.len().min(first + GROUP);
        let parts: Vec<Part> =
            pool.install(|| group.clone().into_par_iter().flat_map_iter(|place| desk.look(place)).collect());
        let mut to_mark = Vec::new();
        let mut slips = Vec::new();
        // Names and what is said of one beside others depend on who came before, so they are given in order.
        for part in parts {
            if let Found::Discounted(record) = part.found {
                discounted.push(*record);
                continue;
            }
            let file = job.intake.files.get(part.source.place).map_or("", |file| file.name.as_str());
            let findings = seen.add(&part.students, file);
            let report = format!("reports/{}.html", names.claim(&report_stem(&part)));
            slips.push(settle(&desk, part, findings, report, &mut to_mark));
        }
        let before = at_hand.take();
        let (marked, written) = pool.install(|| {
            rayon::join(
                || mark(&desk, &mut others, group.len(), slips, to_mark),
                || before.map_or(Ok(()), |batch| sink.write(batch)),
            )
        });
        written?;
        at_hand = Some(marked?);
        // Who stops a run at its very end may as well have it whole.
        if progress(sink.progress()).is_break() && group.end < job.intake.files.len() {
            if let Some(batch) = at_hand {
                sink.write(batch)?;
            }
            return Ok(Outcome { stopped: true, ..sink.statistics.outcome() });
        }
    }
    if let Some(batch) = at_hand {
        sink.write(batch)?;
        // Nothing is left to be stopped.
        let _ = progress(sink.progress());
    }

    let Sink { mut records, mut gradebook, mut statistics, mut absentees, .. } = sink;
    for record in discounted.into_iter().chain(superseded_records(job)) {
        absentees.add(&record);
        records.add_unmarked(&record)?;
        statistics.add(&record);
    }
    for record in absentees.records(job) {
        records.add_unmarked(&record)?;
        gradebook.add(&record)?;
        statistics.add(&record);
    }
    statistics.set_aside(&job.intake.aside);
    statistics.given_twice(&seen.given_twice());
    gradebook.finish().map_err(|error| ClassError::Write { path: gradebook_file.path.clone(), error })?;
    let mut outcome = statistics.outcome();
    outcome.kept = records.kept();
    outcome.ids_given_twice = seen.given_twice();
    if let Some(marks) = job.marks {
        outcome.marks_without_submission = statistics.absent(marks.student_ids());
        outcome.decisions_without_answers = marks.decisions_without_answers(statistics.groups());
        let names = job.intake.files.iter().map(|file| file.name.as_str()).collect();
        outcome.decisions_without_answers.extend(marks.files_not_there(&names));
    }
    let reports = statistics.take_reports();
    let facts = NewFile::create(job.out.join("run.json"), &workplace.running())?;
    let index = NewFile::create(job.out.join("index.html"), &workplace.running())?;
    let results = records.publish(&workplace)?;
    facts.write_all(RunFacts::of(job, results).to_text()?.as_bytes())?;
    gradebook_file.finish()?;
    index.write_all(job.kit.class_page(&statistics.summary()).as_bytes())?;
    // Only now does no page link to them.
    outcome.removed_reports = remove_old_reports(job.out, &desk.kept, &reports);
    outcome.older_reports = older_reports(job.out, &reports);
    workplace.finish()?;
    Ok(outcome)
}

/// A group of submissions, marked.
struct Batch {
    /// How many answer files.
    files: usize,
    slips: Vec<Slip>,
    /// What was marked in this run, in the order of the slips that are not kept.
    fresh: Vec<Written>,
}

fn mark(
    desk: &Desk<'_>,
    others: &mut Others,
    files: usize,
    slips: Vec<Slip>,
    to_mark: Vec<Named<'_>>,
) -> Result<Batch, ClassError> {
    let job = desk.job;
    let (mut marked, pages): (Vec<Marked>, Vec<Pages>) = desk.mark_all(to_mark)?.into_iter().unzip();
    others.point_out(job, &mut marked);
    let fresh = marked.into_par_iter().zip(pages).map(|(marked, pages)| {
        let record = Record::of(&marked, job.lab);
        Ok(Written { line: record.to_line()?, record, pages, kept: false })
    });
    Ok(Batch { files, slips, fresh: fresh.collect::<Result<_, ClassError>>()? })
}

/// What is written and counted, in the order of the answer files.
struct Sink<'a> {
    records: RunRecords<'a>,
    gradebook: Gradebook<File>,
    statistics: Statistics,
    absentees: Absentees,
    /// Answer files.
    done: usize,
}

impl Sink<'_> {
    fn write(&mut self, batch: Batch) -> Result<(), ClassError> {
        let mut fresh = batch.fresh.into_iter();
        for slip in batch.slips {
            let Some(written) = slip.kept.or_else(|| fresh.next()) else { continue };
            self.records.add(&slip.source, slip.said, &written)?;
            self.gradebook.add(&written.record)?;
            self.statistics.add(&written.record);
            self.absentees.add(&written.record);
        }
        self.records.flush()?;
        self.done += batch.files;
        Ok(())
    }

    fn progress(&self) -> Progress {
        Progress { done: self.done, kept: self.records.kept() }
    }
}

/// Who it is from, as far as could be read; the file's name otherwise.
fn report_stem(part: &Part) -> String {
    let ids: Vec<&str> = part.students.iter().map(|s| s.id.as_str()).filter(|id| !id.is_empty()).collect();
    if ids.is_empty() { part.id.clone() } else { ids.join("_") }
}

/// What is to be written of one part.
struct Slip {
    source: Arc<SourceFile>,
    /// Fingerprint of what was said because of other files.
    said: String,
    /// What an earlier run wrote, where that holds; else it is the next one that is marked.
    kept: Option<Written>,
}

/// Uses again what was kept, if this class says the same of it; else it is to be marked.
fn settle<'a>(
    desk: &Desk<'a>,
    part: Part,
    findings: Vec<Finding>,
    report: String,
    to_mark: &mut Vec<Named<'a>>,
) -> Slip {
    let said = Fingerprint::default().with_shown(&findings).hex();
    let source = Arc::clone(&part.source);
    let holds = match &part.found {
        Found::Kept { part, .. } => part.said == said && part.report == report,
        Found::Read { .. } | Found::Discounted(_) => false,
    };
    let again = match part.found {
        Found::Kept { .. } if !holds => desk.look_again(&part).map(|part| part.found),
        _ => None,
    };
    match again.unwrap_or(part.found) {
        Found::Kept { part, record, line } => {
            let pages = Pages { report: part.page, instructor: part.instructor };
            let written = Written { record: *record, line, pages, kept: true };
            Slip { source, said, kept: Some(written) }
        }
        Found::Read { mut submission, numbers } => {
            submission.findings.extend(findings);
            if let Some(file) = desk.job.intake.files.get(source.place) {
                to_mark.push(Named { submission: *submission, numbers, file, report });
            }
            Slip { source, said, kept: None }
        }
        // Dealt with before.
        Found::Discounted(_) => Slip { source, said, kept: None },
    }
}

/// What the marks of all submissions rest on; `None` when nothing may be used again.
fn rests_on(job: &ClassJob<'_>, others: &Others) -> Option<Fingerprint> {
    let lab = &job.lab.text;
    let alike = job.marks.map(|marks| format!("{:?}", marks.alike()));
    let roster = format!("{:?}", job.roster);
    let (class, release) = (others.fingerprint(), format!("{:?}", job.release));
    run_fingerprint(&[&lab.name, &lab.text, &alike.unwrap_or_default(), &roster, &class, &release])
}

/// Removes reports of answers that are not there any more, if they are as polemark wrote them.
///
/// How many.
fn remove_old_reports(out: &Path, kept: &Kept, written: &BTreeSet<String>) -> usize {
    let removed = kept.reports().filter(|(report, page)| {
        let plain = report
            .strip_prefix("reports/")
            .or(report.strip_prefix("instructor/"))
            .is_some_and(|name| !name.contains(['/', '\\']));
        let path = out.join(report);
        plain
            && !written.contains(report)
            && is_as_it_was(&path, page)
            // One that cannot be removed is counted as an older report.
            && std::fs::remove_file(path).is_ok()
    });
    removed.count()
}

/// Reports in the folder that this run did not write: of an earlier run, so possibly out of date.
fn older_reports(out: &Path, written: &BTreeSet<String>) -> usize {
    let Ok(entries) = std::fs::read_dir(out.join("reports")) else { return 0 };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter(|name| name.ends_with(".html") && !written.contains(&format!("reports/{name}"))).count()
}
