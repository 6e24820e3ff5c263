use super::outcome::{Failure, load_bytes};
use crate::class::{NewFile, is_own_file};
use crate::gradebook::{
    ClassMarks, FeedbackFor, Identity, Records, Rules, Summary, Wanted, canvas_by_roster, canvas_filled,
    gradescope, moodle, points_of, worksheet, write_feedback, write_workbook,
};
use crate::lab::Points;
use crate::source::sanitize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Write the marks of a class for Canvas, Moodle, Gradescope or a spreadsheet, or its reports to hand back.
///
/// Marks that wait for a person are left out, and everyone left out is named with the reason.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark export out --to moodle-worksheet --lms worksheet.csv --out filled.csv\n  polemark export out --to canvas --lms gradebook.csv --assignment \"Lab 3\" --out import.csv\n  polemark export out --to canvas-feedback --out reports.zip\n\nExit code: 0 when the file is written, whoever is left out; 2 when it is not."
)]
pub struct Arguments {
    /// Output folder of `polemark grade`.
    #[arg(value_name = "OUT")]
    folder: PathBuf,
    /// What to write.
    #[arg(long, value_enum)]
    to: Target,
    /// File to write; never the one given with --lms.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// What the LMS exported: Canvas' gradebook, or Moodle's grading worksheet, which is filled in.
    #[arg(long, value_name = "FILE")]
    lms: Option<PathBuf>,
    /// The assignment: for Canvas its title or number as in the gradebook; for Moodle the name of the column [default: Mark].
    #[arg(long, value_name = "TITLE")]
    assignment: Option<String>,
    /// By what Moodle's grade import is to know a student.
    #[arg(long, value_enum, default_value_t = IdentityName::IdNumber)]
    identity: IdentityName,
    /// Whose results, for Gradescope.
    #[arg(long, value_name = "ID")]
    student: Option<String>,
    /// Which answer file's results, for Gradescope.
    #[arg(long, value_name = "NAME", conflicts_with = "student")]
    file: Option<String>,
    /// Scale the marks to be out of so many points.
    #[arg(long, value_name = "POINTS", value_parser = parse_points)]
    scale_to: Option<Points>,
    /// Pass on marks that wait for a person too, with what is not given yet as no points.
    #[arg(long)]
    as_it_stands: bool,
    /// Give no points to whoever handed nothing in, instead of leaving them out.
    #[arg(long)]
    zero_for_missing: bool,
    /// Write the points by question into empty feedback comments of the worksheet.
    #[arg(long)]
    comments: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Target {
    /// CSV for Canvas' gradebook import.
    Canvas,
    /// CSV for Moodle's grade import.
    Moodle,
    /// Moodle's offline grading worksheet, filled in.
    MoodleWorksheet,
    /// results.json of one submission.
    Gradescope,
    /// Excel workbook: marks, items, review list.
    Xlsx,
    /// Zip of the reports, for Canvas to hand back.
    CanvasFeedback,
    /// Zip of the reports, for Moodle to hand back.
    MoodleFeedback,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum IdentityName {
    IdNumber,
    Email,
    Username,
}

fn parse_points(text: &str) -> Result<Points, String> {
    points_of(text)
        .filter(|points| points.0 > 0)
        .ok_or_else(|| "not a number of points, such as 20 or 12.5".to_owned())
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let rules = Rules {
        as_it_stands: arguments.as_it_stands,
        zero_for_missing: arguments.zero_for_missing,
        scale_to: arguments.scale_to,
        withhold_marks: false,
    };
    if let Some(lms) = &arguments.lms
        && is_same_file(lms, &arguments.out)
    {
        return Err(ExportFailure::Overwrites { path: arguments.out.clone() }.into());
    }
    if is_own_file(&arguments.folder, &arguments.out) {
        return Err(ExportFailure::OwnFile { path: arguments.out.clone() }.into());
    }
    let records = Records::open(&arguments.folder)?;
    let rules = Rules { withhold_marks: records.withhold_marks(), ..rules };
    let folder =
        arguments.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut new = NewFile::create(arguments.out.clone(), folder)?;
    let (noun, summary) = match arguments.to {
        Target::Gradescope => {
            let wanted = match (&arguments.student, &arguments.file) {
                (Some(id), _) => Wanted::Student(id.clone()),
                (None, Some(name)) => Wanted::File(name.clone()),
                (None, None) => return Err(ExportFailure::WhichSubmission.into()),
            };
            new.write_all(&gradescope(records, &wanted, &rules)?)?;
            let mut summary = Summary { given: 1, ..Summary::default() };
            if rules.withhold_marks {
                summary.notes.push(HIDDEN_TESTS.to_owned());
            }
            ("submission", summary)
        }
        Target::Xlsx => {
            let students = write_workbook(records, folder, &mut new.file)?;
            new.finish()?;
            ("student", Summary { given: students, ..Summary::default() })
        }
        Target::CanvasFeedback | Target::MoodleFeedback => {
            let lms = match arguments.to {
                Target::CanvasFeedback => FeedbackFor::Canvas,
                _ => FeedbackFor::Moodle,
            };
            let summary = write_feedback(&arguments.folder, lms, &rules, &mut new.file)?;
            new.finish()?;
            ("report", summary)
        }
        Target::Canvas | Target::Moodle | Target::MoodleWorksheet => {
            let class = ClassMarks::read(records, &rules)?;
            let lms = arguments.lms.as_deref().map(load_bytes).transpose()?;
            let assignment = arguments.assignment.as_deref();
            let export = match (arguments.to, lms, assignment) {
                (Target::Canvas, Some(file), assignment) => canvas_filled(&class, &file, assignment)?,
                (Target::Canvas, None, Some(assignment)) => canvas_by_roster(&class, assignment)?,
                (Target::Canvas, None, None) => return Err(ExportFailure::WhichAssignment.into()),
                (Target::MoodleWorksheet, Some(_), _) if arguments.comments && rules.withhold_marks => {
                    return Err(ExportFailure::Withheld.into());
                }
                (Target::MoodleWorksheet, Some(file), _) => worksheet(&class, &file, arguments.comments)?,
                (Target::MoodleWorksheet, None, _) => return Err(ExportFailure::NoWorksheet.into()),
                (_, _, title) => {
                    let identity = match arguments.identity {
                        IdentityName::IdNumber => Identity::IdNumber,
                        IdentityName::Email => Identity::Email,
                        IdentityName::Username => Identity::Username,
                    };
                    moodle(&class, identity, title.unwrap_or("Mark"))?
                }
            };
            new.write_all(&export.bytes)?;
            ("mark", export.summary)
        }
    };
    eprint!("{}", shown(&summary, noun, &arguments.out));
    Ok(ExitCode::SUCCESS)
}

/// Why the command line cannot be followed.
#[derive(Debug, thiserror::Error)]
pub enum ExportFailure {
    #[error("`{}` is what the LMS exported: write to another file, so that it can be looked at again", path.display())]
    Overwrites { path: PathBuf },
    #[error("`{}` is what `polemark grade` wrote: write to another file", path.display())]
    OwnFile { path: PathBuf },
    #[error("Gradescope takes one submission at a time: say which with `--student` or `--file`")]
    WhichSubmission,
    #[error(
        "give Canvas' own gradebook with `--lms`, or the assignment as Canvas writes it with `--assignment \"Title (id)\"`"
    )]
    WhichAssignment,
    #[error(
        "the lab, or `--release`, withholds points from students: without `--comments` only the mark is written"
    )]
    Withheld,
    #[error("give the grading worksheet that Moodle exported with `--lms`")]
    NoWorksheet,
}

const HIDDEN_TESTS: &str =
    "marks are withheld from students: the tests are hidden from them; the mark on top is what you publish";

fn is_same_file(one: &Path, two: &Path) -> bool {
    match (one.canonicalize(), two.canonicalize()) {
        (Ok(one), Ok(two)) => one == two,
        _ => one == two,
    }
}

fn shown(summary: &Summary, noun: &str, out: &Path) -> String {
    let plural = if summary.given == 1 { "" } else { "s" };
    let mut text = format!("{} {noun}{plural} in {}\n", summary.given, sanitize(&out.to_string_lossy()));
    for note in &summary.notes {
        text.push_str(&format!("  note: {}\n", sanitize(note)));
    }
    let mut list = |title: &str, lines: Vec<String>| {
        if !lines.is_empty() {
            text.push_str(&format!("  {title} ({}):\n", lines.len()));
            lines.iter().for_each(|line| text.push_str(&format!("    {line}\n")));
        }
    };
    let escaped = |names: &[String]| names.iter().map(|name| sanitize(name)).collect();
    list(
        "left out",
        summary.left_out.iter().map(|one| format!("{}: {}", sanitize(&one.who), one.why)).collect(),
    );
    list("found by the full name alone, please check", escaped(&summary.by_name_alone));
    list("in the file of the LMS, but nobody of the class", escaped(&summary.not_in_class));
    text
}
