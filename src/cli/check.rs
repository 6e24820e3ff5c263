use super::format::Format;
use super::outcome::{Failure, THEIRS, colour_on_stdout, write_output};
use crate::annotations::{Annotations, Case, FileAnnotations};
use crate::lab::{DEFAULT, StudentEdition, load_student_edition};
use crate::report::numbers::counted;
use crate::source::{Finding, Severity, Value, sanitize};
use crate::submission::{Answer, AnswerSheet, AnswerValue, Folder, Submission, read, self_check};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Check an answer file before handing it in: can it be read, what is missing, does it contradict itself.
///
/// The right answers are not computed and cannot be seen here. Of a lab only its student edition is looked at, so that the
/// file that `polemark handout` writes for students says as much as the lab itself.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark check answers.yaml\n  polemark check answers.yaml --lab mine.student.yaml\n  polemark check answers.yaml --format github\n\nExit code: 0 when there is nothing to look at (blanks are nothing), 1 when something cannot be read, does not\nagree with itself, or is read with a warning."
)]
pub struct Arguments {
    /// Answer files.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Embedded lab, or path of a lab file or of its student edition [default: the embedded lab that the file names, else ee361-lab3].
    #[arg(long)]
    lab: Option<String>,
    /// How to tell it.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let mut all_well = true;
    let mut annotations = Annotations { verb: "polemark check", files: Vec::new() };
    let mut labs: BTreeMap<Option<String>, StudentEdition> = BTreeMap::new();
    for path in &arguments.files {
        let bytes = crate::class::read_capped(path)
            .map_err(|error| Failure::Read { path: path.to_path_buf(), error })?;
        let lab = match labs.entry(arguments.lab.clone().or_else(|| named_lab(&bytes))) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => {
                let name = place.key().as_deref().unwrap_or(DEFAULT);
                let edition = load_student_edition(name).map_err(Failure::Load)?;
                place.insert(edition)
            }
        };
        let checked = check_file(lab, path, &bytes);
        if arguments.format == Format::Text {
            write_output(None, &checked.text)?;
        }
        annotations.files.push(checked.annotations);
        all_well &= checked.well;
    }
    if arguments.format != Format::Text {
        write_output(None, &arguments.format.output(String::new(), &annotations)?)?;
    }
    Ok(if all_well { ExitCode::SUCCESS } else { ExitCode::from(THEIRS) })
}

/// The embedded lab that the file says it answers.
fn named_lab(bytes: &[u8]) -> Option<String> {
    let tree = crate::source::parse(&crate::source::decode(bytes).ok()?).ok()?;
    let Value::Scalar(name) = &tree.get("lab")?.value else { return None };
    crate::lab::embedded().iter().find(|(id, _)| id == name).map(|(id, _)| (*id).to_owned())
}

/// What came of checking one file.
struct Checked {
    text: String,
    annotations: FileAnnotations,
    /// There is nothing to look at.
    well: bool,
}

fn check_file(lab: &StudentEdition, path: &Path, bytes: &[u8]) -> Checked {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = Folder(path.parent().unwrap_or(Path::new("")).to_path_buf());
    let (submission, sheet, values) = crate::class::read_with_own_values(lab, &|sheet| {
        read(&stem, &path.to_string_lossy(), bytes, sheet, &folder)
    });
    let mut findings = submission.findings.clone();
    if submission.readable {
        findings.extend(self_check(&submission, &sheet));
    }
    if values.as_ref().is_some_and(Vec::is_empty) {
        findings.push(no_values());
    }
    let (missing, others): (Vec<_>, Vec<_>) = findings.iter().partition(|f| f.code == "answer.missing");

    let colour = colour_on_stdout();
    let mut text = own_values(&submission, values.as_deref().unwrap_or_default());
    text.push_str(&echo(&sheet, &submission));
    for finding in &others {
        text.push_str(&finding.render(&submission.source, colour));
        text.push_str("\n\n");
    }
    if !missing.is_empty() {
        text.push_str("Not answered yet:\n");
        for finding in &missing {
            text.push_str(&format!("  {}\n", sanitize(&finding.message)));
        }
        text.push('\n');
    }
    // Disagreements are warnings: only blanks and notes leave a file well.
    let wrong = others.iter().filter(|f| f.severity != Severity::Note).count();
    let name = sanitize(&path.to_string_lossy());
    let counts = format!(
        "{} read, {} to look at, {} still blank",
        counted(submission.answers.values().filter(|a| a.value.is_ok()).count(), "answer"),
        wrong,
        missing.len()
    );
    text.push_str(&format!("{name}: {counts}\n"));
    Checked {
        text,
        annotations: annotations(&sheet, &submission, &findings),
        well: wrong == 0 && submission.readable,
    }
}

/// How each answer was read, and every finding under the field it is about.
fn annotations(sheet: &AnswerSheet, submission: &Submission, findings: &[Finding]) -> FileAnnotations {
    let mut cases = Vec::new();
    for field in &sheet.fields {
        if let Some(answer) = submission.answers.get(&field.path).filter(|answer| answer.value.is_ok()) {
            cases.push(Case::well(
                &field.path,
                "answer.read",
                &format!("read as {}", read_as(sheet, answer)),
            ));
        }
    }
    for finding in findings {
        let about = finding.span.and_then(|span| {
            let answers = submission.answers.values();
            answers
                .filter(|one| one.span.start <= span.start && span.end <= one.span.end)
                .min_by_key(|one| one.span.end - one.span.start)
        });
        let name = about.map_or("answer file", |answer| answer.path.as_str());
        let mut case = Case::of(name, finding, &submission.source);
        // A blank is nothing to look at.
        if finding.code == "answer.missing" {
            case.severity = Some(Severity::Note);
        }
        cases.push(case);
    }
    FileAnnotations { file: submission.source.name.clone(), cases }
}

/// Whose values stand for the letters, so that a mistyped id is noticed.
fn own_values(submission: &Submission, values: &[(String, String)]) -> String {
    let (Some(first), false) = (submission.students.first(), values.is_empty()) else { return String::new() };
    let values: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    format!("The values of {} are {}.\n\n", sanitize(&first.id), values.join(", "))
}

fn no_values() -> Finding {
    Finding::warning(
        "variant.unknown",
        "Values differ from student to student in this lab, and without your id nobody knows which are yours.",
    )
    .with_help("Write `student: {id: EE-001, name: A. Student}` with your own id.")
}

/// How each answer was read, so that a misreading is noticed before the deadline.
fn echo(sheet: &AnswerSheet, submission: &Submission) -> String {
    let mut text = String::new();
    for field in &sheet.fields {
        if let Some(answer) = submission.answers.get(&field.path).filter(|answer| answer.value.is_ok()) {
            text.push_str(&format!("  {}: {}\n", field.path, sanitize(&read_as(sheet, answer))));
        }
    }
    if text.is_empty() { text } else { format!("Read as:\n{text}\n") }
}

/// Numbers in place of its letters would tell what is to be found at rest.
fn read_as(sheet: &AnswerSheet, answer: &Answer) -> String {
    match &answer.value {
        Ok(AnswerValue::TransferFunction { formula: Some(formula), .. }) if sheet.leans_on_untold(answer) => {
            formula.to_string()
        }
        _ => answer.read_as(),
    }
}
