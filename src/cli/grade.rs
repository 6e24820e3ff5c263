use super::compare::{in_short, same_lab, write_comparison};
use super::outcome::{
    Failure, INTERRUPTED, OURS, THEIRS, colour_on_stderr, load_roster, load_with_reference, write_output,
};
use crate::algebra::significant;
use crate::class::{
    ClassJob, Intake, Outcome, Place, RunFacts, SAVE_AS, Standing, compare, find_answer_files, grade_class,
    is_own_file,
};
use crate::grading::{Catalogue, Contradiction, HandMarksFile};
use crate::lab::{LabDefinition, Release};
use crate::report::ReportKit;
use crate::source::{
    DecodeError, Finding, MAX_TEXT_BYTES, Severity, SourceText, decode, decode_within, read_within, sanitize,
};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Mark answer files: a report for each, a class page, a gradebook.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark grade submissions --out out\n  polemark grade submissions.zip --roster gradebook.csv --out out --lab labs/mine/lab.yaml --marks marks.yaml\n\nExit code: 0 when every file got its report (an unreadable file too: it says what is wrong), 1 with --strict when a file could not be read, 2 when polemark failed."
)]
pub struct Arguments {
    /// Answer files, folders of them, or zip archives as Moodle and Canvas hand them out.
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Folder for index.html, reports/, gradebook.csv and results.jsonl; made when it is not there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Embedded lab, or path of a lab file [default: ee361-lab3].
    #[arg(long)]
    lab: Option<String>,
    /// Marks given by a person: viva, observed rows, changed items; never written to. May be given several times.
    #[arg(long, value_name = "FILE")]
    marks: Vec<PathBuf>,
    /// The course's students: a CSV with columns id and name, Canvas' gradebook or Moodle's grading worksheet. Who is not on it
    /// is pointed out, and who handed nothing in gets a row.
    #[arg(long, value_name = "FILE")]
    roster: Option<PathBuf>,
    /// What students get to see in reports/, in place of what the lab says: `marks,feedback`. Where that is not all, instructor/
    /// has the full reports; `nothing` shows the answers as they were read.
    #[arg(long, value_name = "WHAT", value_delimiter = ',')]
    release: Option<Vec<Shown>>,
    /// Worker threads, 0 for one a core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Mark everything again, also what has not changed since the last run into the same folder.
    #[arg(long)]
    from_scratch: bool,
    /// Output folder of an earlier run (the one written to, too) or its results.jsonl: says which points have changed since, and why,
    /// in compare.csv and compare.html.
    #[arg(long, value_name = "OLD")]
    compare: Option<PathBuf>,
    /// End with exit code 1 when a file could not be read.
    #[arg(long)]
    strict: bool,
}

/// A part of a report.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Shown {
    Marks,
    Feedback,
    Solutions,
    Nothing,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (lab, reference) = load_with_reference(arguments.lab.as_deref())?;
    let given = load_marks(&arguments.marks, &lab)?;
    let marks = given.as_ref().map(|(marks, _)| marks);
    let roster = arguments.roster.as_deref().map(load_roster).transpose()?;
    let others = [arguments.roster.as_deref(), arguments.lab.as_deref().map(Path::new)];
    let others: Vec<&Path> =
        others.into_iter().flatten().chain(arguments.marks.iter().map(PathBuf::as_path)).collect();
    if let Some(path) = others.iter().find(|path| is_own_file(&arguments.out, path)) {
        return Err(Failure::Overwritten { path: path.to_path_buf(), out: arguments.out.clone() });
    }
    let others: Vec<PathBuf> = others.iter().filter_map(|path| path.canonicalize().ok()).collect();
    // What polemark writes is not handed in, also where it writes into the folder it reads.
    let leave_out = |path: &Path| others.iter().any(|one| one == path) || is_own_file(&arguments.out, path);
    let intake = find_answer_files(&arguments.paths, &leave_out)?.with_attempts_settled(&lab.sheet);
    warn_of_marks_files(&intake);
    warn_of_lateness(marks);
    // Read before anything is written into the same folder.
    let before = arguments.compare.as_deref().map(Standing::load).transpose()?;
    if let (Some(before), Some(path)) = (&before, &arguments.compare) {
        same_lab(path, before, &lab.id)?;
    }
    let last = RunFacts::beside(&arguments.out.join("results.jsonl"));
    let catalogue = Catalogue::new(&lab, &reference);
    let kit = ReportKit::new(&lab, &reference)?;
    let bar = progress_bar(intake.files.len());
    let job = ClassJob {
        lab: &lab,
        reference: &reference,
        catalogue: &catalogue,
        kit: &kit,
        marks,
        roster: roster.as_ref(),
        intake: &intake,
        out: &arguments.out,
        release: arguments.release.as_deref().map_or(lab.release, |shown| Release {
            marks: shown.contains(&Shown::Marks),
            feedback: shown.contains(&Shown::Feedback),
            solutions: shown.contains(&Shown::Solutions),
        }),
        threads: arguments.threads,
        from_scratch: arguments.from_scratch,
    };
    let stop = stop_on_interrupt();
    let outcome = grade_class(&job, &|progress| {
        bar.set_position(progress.done as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    bar.finish_and_clear();
    if outcome.stopped {
        eprintln!(
            "stopped after {} of {}; run the same command again to go on",
            outcome.submissions,
            counted(intake.files.len(), "submission", "submissions")
        );
        return Ok(ExitCode::from(INTERRUPTED));
    }
    for (number, source) in given.iter().flat_map(|(_, sources)| sources).enumerate() {
        let of_this = outcome.decisions_without_answers.iter().filter(|(file, _)| *file == number);
        eprint!("{}", rendered(of_this.map(|(_, finding)| finding).collect(), source));
    }
    write_output(None, &summary(&outcome, &arguments.out))?;
    if let Some(last) = &last {
        warn_of_what_the_last_run_had(last, &job);
    }
    if let Some(before) = &before {
        let now = Standing::load(&arguments.out)?;
        let comparison = compare(before, &now);
        write_comparison(&comparison, &now, &arguments.out)?;
        write_output(None, &in_short(&comparison))?;
    }
    Ok(match &outcome {
        outcome if outcome.failed > 0 => ExitCode::from(OURS),
        outcome if outcome.unreadable > 0 && arguments.strict => ExitCode::from(THEIRS),
        _ => ExitCode::SUCCESS,
    })
}

/// A marks file of a class of thousands has its room in this.
const MOST_BYTES_OF_MARKS: usize = 64 << 20;

/// Marks files as one, and their texts. An error in one of them, or a contradiction, would lose a person's mark: nothing is graded
/// until it is mended. A file that is named twice counts once.
fn load_marks(
    paths: &[PathBuf],
    lab: &LabDefinition,
) -> Result<Option<(HandMarksFile, Vec<SourceText>)>, Failure> {
    let mut seen = BTreeSet::new();
    let paths =
        paths.iter().filter(|path| seen.insert(path.canonicalize().unwrap_or_else(|_| path.to_path_buf())));
    let (mut files, mut sources) = (Vec::new(), Vec::new());
    for path in paths {
        let (file, source) = load_marks_file(path, lab)?;
        files.push(file);
        sources.push(source);
    }
    if files.is_empty() {
        return Ok(None);
    }
    let (marks, contradictions) = HandMarksFile::merged(files);
    let mut text = String::new();
    for Contradiction { what, places: [first, again] } in contradictions.iter().take(MOST_SHOWN) {
        let (Some(source), Some(other)) = (sources.get(again.file), sources.get(first.file)) else {
            continue;
        };
        let line = other.position(first.span.start).line;
        let help = format!("It is said first in `{}`, line {line}. Keep one.", sanitize(&other.name));
        let finding = Finding::error("marks.twice", format!("{what}.")).with_help(help).at(again.span);
        text.push_str(&finding.render(source, colour_on_stderr()));
        text.push('\n');
    }
    match contradictions.is_empty() {
        true => Ok(Some((marks, sources))),
        false => Err(Failure::Marks { rendered: text }),
    }
}

fn load_marks_file(path: &Path, lab: &LabDefinition) -> Result<(HandMarksFile, SourceText), Failure> {
    let read = |error| Failure::Read { path: path.to_path_buf(), error };
    let bytes = read_within(path, MOST_BYTES_OF_MARKS).map_err(read)?;
    let text = decode_within(&bytes, MOST_BYTES_OF_MARKS).map_err(|error| {
        let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        let hint = if is_table && matches!(error, DecodeError::NotText { .. }) { SAVE_AS } else { "" };
        read(std::io::Error::new(std::io::ErrorKind::InvalidData, format!("{error}{hint}")))
    })?;
    let source = SourceText::new(path.to_string_lossy(), text);
    let (marks, findings) = HandMarksFile::parse(&source, lab);
    let rendered = rendered(findings.iter().collect(), &source);
    if findings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(Failure::Marks { rendered });
    }
    eprint!("{rendered}");
    Ok((marks, source))
}

fn warn_of_lateness(marks: Option<&HandMarksFile>) {
    if let Some(id) = marks.and_then(|marks| marks.late_for_nothing().next()) {
        let id = sanitize(id);
        eprintln!(
            "warning: the marks say that `{id}` is late, and not what that costs: `late: {{points: 5}}` in YAML, `,late,,5` in CSV"
        );
    }
}

/// A marks file or a list that the last run into the same folder had may only have been forgotten.
fn warn_of_what_the_last_run_had(last: &RunFacts, job: &ClassJob<'_>) {
    let out = sanitize(&job.out.to_string_lossy());
    if job.marks.is_none() && last.marks.is_some() {
        eprintln!(
            "warning: the last run into `{out}` had a marks file: what a person gave is not in this one"
        );
    }
    if job.roster.is_none() && last.roster.is_some() {
        eprintln!(
            "warning: the last run into `{out}` had a list of the course: who handed nothing in has no row now"
        );
    }
}

/// A marks file that was put beside the answers and forgotten would be somebody's empty answers, and what it gives would not count.
fn warn_of_marks_files(intake: &Intake) {
    for file in &intake.files {
        let Place::File(path) = &file.place else { continue };
        let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase());
        if !matches!(name.as_deref(), Some("marks.yaml" | "marks.yml")) {
            continue;
        }
        let text =
            read_within(path, MAX_TEXT_BYTES).ok().and_then(|bytes| decode(&bytes).ok()).unwrap_or_default();
        let has = |key: &str| text.lines().any(|line| line.starts_with(key));
        if (has("students:") || has("alike:")) && !has("answers:") {
            let path = sanitize(&path.to_string_lossy());
            eprintln!(
                "warning: `{path}` looks like a marks file and is read as answers; if it is one, give it with `--marks`"
            );
        }
    }
}

/// So many findings are shown; a table filled in by a slip may have one in each of its rows.
const MOST_SHOWN: usize = 20;

/// The first findings, by where they stand, and how many more there are.
fn rendered(mut findings: Vec<&Finding>, source: &SourceText) -> String {
    findings
        .sort_by_key(|finding| (finding.severity != Severity::Error, finding.span.map(|span| span.start)));
    let mut text = String::new();
    for finding in findings.iter().take(MOST_SHOWN) {
        text.push_str(&finding.render(source, colour_on_stderr()));
        text.push('\n');
    }
    let more = findings.len().saturating_sub(MOST_SHOWN);
    if more > 0 {
        text.push_str(&format!("and {more} more like these, further down in `{}`\n", sanitize(&source.name)));
    }
    text
}

/// Set when the run is to end: at Ctrl-C, or when the system asks.
fn stop_on_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&stop);
    // Without a handler an interrupt ends the process at once, which loses no file either.
    let _ = ctrlc::set_handler(move || {
        // Whoever asks twice does not want to wait.
        if seen.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
    stop
}

fn progress_bar(submissions: usize) -> ProgressBar {
    // Drawn on standard error, and only when that is a terminal.
    let bar = ProgressBar::with_draw_target(Some(submissions as u64), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} marked, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

fn summary(outcome: &Outcome, out: &Path) -> String {
    let shown = |name: &str| sanitize(&out.join(name).to_string_lossy());
    let mean = outcome.mean_earned.map_or_else(String::new, |mean| {
        format!(", mean {} of {} points", significant(mean, 4), outcome.possible)
    });
    let mut text = format!("{} marked{mean}\n", counted(outcome.submissions, "submission", "submissions"));
    for (count, one, many) in [
        (
            outcome.kept,
            "is as the last run left it: nothing has changed",
            "are as the last run left them: nothing has changed",
        ),
        (outcome.unreadable, "could not be read: see its report", "could not be read: see their reports"),
        (
            outcome.missing,
            "on the list of the course handed nothing in",
            "on the list of the course handed nothing in",
        ),
        (outcome.late, "came too late", "came too late"),
        (
            outcome.held,
            "waits for a person to say whose it is or whether it counts: see the class page",
            "wait for a person to say whose they are or whether they count: see the class page",
        ),
        (
            outcome.superseded,
            "answer file does not count, since its owner handed in another",
            "answer files do not count, since their owners handed in others",
        ),
        (outcome.aside, "other file is not marked", "other files are not marked"),
        (
            outcome.to_review,
            "has marks for a person to confirm or to give",
            "have marks for a person to confirm or to give",
        ),
        (
            outcome.answers_changed,
            "has an answer that a person decided about before it changed: that decision does not count until it is confirmed",
            "have answers that a person decided about before they changed: those decisions do not count until they are confirmed",
        ),
        (
            outcome.failed,
            "made polemark fail and is left to a person: please report this",
            "made polemark fail and are left to a person: please report this",
        ),
        (
            outcome.removed_reports,
            "report of an answer that is not there any more was removed",
            "reports of answers that are not there any more were removed",
        ),
        (
            outcome.older_reports,
            "report of an earlier run is still in the folder",
            "reports of an earlier run are still in the folder",
        ),
    ] {
        if count > 0 {
            text.push_str(&format!("  {}\n", counted(count, one, many)));
        }
    }
    let twice = outcome.ids_given_twice.iter().map(|(id, files)| {
        let files: Vec<_> = files.iter().map(|file| sanitize(file)).collect();
        format!("several files give the id `{}`: {}", sanitize(id), files.join(", "))
    });
    let absent = outcome.marks_without_submission.iter();
    let absent =
        absent.map(|id| format!("the marks file has marks for `{}`, who handed nothing in", sanitize(id)));
    for lines in [twice.collect::<Vec<_>>(), absent.collect()] {
        lines.iter().take(MOST_SHOWN).for_each(|line| text.push_str(&format!("  {line}\n")));
        if let more @ 1.. = lines.len().saturating_sub(MOST_SHOWN) {
            text.push_str(&format!("  and {more} more such lines\n"));
        }
    }
    if outcome.waiting {
        let out = sanitize(&out.to_string_lossy());
        text.push_str(&format!(
            "  what waits for a person, to be filled in: polemark marks {out} --out marks.yaml\n"
        ));
    }
    for (what, name) in
        [("class page", "index.html"), ("gradebook", "gradebook.csv"), ("results", "results.jsonl")]
    {
        text.push_str(&format!("  {what}: {}\n", shown(name)));
    }
    text
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
