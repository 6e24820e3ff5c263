use super::export::ExportFailure;
use crate::annotations::JunitError;
use crate::class::{ClassError, IntakeError, ResultsError, Roster, RosterError};
use crate::gradebook::ExportError;
use crate::lab::{LabDefinition, LoadError};
use crate::reference::{Reference, ReferenceError};
use crate::report::ReportError;
use crate::source::{read_within, sanitize};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The lab's or submission's fault.
pub const THEIRS: u8 = 1;
/// Ours or the caller's fault.
pub const OURS: u8 = 2;
/// Somebody stopped it: 128 and the number of the signal, as shells count.
pub const INTERRUPTED: u8 = 130;

/// Why a verb ended early, as printed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    #[error("{}", load_error(.0))]
    Load(LoadError),
    #[error("{rendered}")]
    Reference { rendered: String },
    #[error("error: {0}")]
    Report(#[from] ReportError),
    #[error("error: {0}")]
    Intake(#[from] IntakeError),
    #[error("error: {0}")]
    Class(#[from] ClassError),
    #[error("error: `{}` cannot be read: {error}", path.display())]
    Read { path: PathBuf, error: io::Error },
    #[error("error: `{}` cannot be written: {error}", path.display())]
    Write { path: PathBuf, error: io::Error },
    #[error("error: the output cannot be written: {0}")]
    Output(#[from] io::Error),
    #[error("error: {0}")]
    Junit(#[from] JunitError),
    #[error("error: this cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error("error: {0}")]
    Roster(#[from] RosterError),
    #[error("error: {0}")]
    Student(#[from] StudentError),
    #[error("error: {0}")]
    Export(#[from] ExportError),
    #[error("error: {0}")]
    ExportArguments(#[from] ExportFailure),
    #[error("{rendered}")]
    Marks { rendered: String },
    #[error("error: `{}` would be overwritten by what polemark writes into `{}`: give another `--out`", path.display(), out.display())]
    Overwritten { path: PathBuf, out: PathBuf },
    #[error("error: `{}` holds results of the lab `{old}`, and not of `{new}`: marks of two labs cannot be compared", path.display())]
    TwoLabs { path: PathBuf, old: String, new: String },
    #[error("error: {0}")]
    Results(#[from] ResultsError),
    #[error("error: a table cannot be written: {0}")]
    Table(#[from] csv::Error),
    #[error("error: `{}` is there already, and is not changed; choose another name, or a table (.csv), to which rows are added", path.display())]
    Exists { path: PathBuf },
}

impl Failure {
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Load(LoadError::Invalid(_) | LoadError::NotText { .. })
            | Self::Reference { .. }
            | Self::Marks { .. } => THEIRS,
            _ => OURS,
        })
    }

    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

fn load_error(error: &LoadError) -> String {
    match error {
        LoadError::Invalid(errors) => errors.render(colour_on_stderr()),
        other => format!("error: {other}"),
    }
}

pub fn load_lab(lab: Option<&str>) -> Result<LabDefinition, Failure> {
    crate::lab::load(lab.unwrap_or(crate::lab::DEFAULT)).map_err(Failure::Load)
}

/// What another program exported may be this large, in bytes; more is refused where it is read.
const MOST_BYTES: usize = 64 << 20;

/// The bytes of a file, as far as it may be long.
pub fn load_bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    read_within(path, MOST_BYTES).map_err(|error| Failure::Read { path: path.to_path_buf(), error })
}

/// A roster, and on standard error what to look at in it.
pub fn load_roster(path: &Path) -> Result<Roster, Failure> {
    let roster = Roster::load(path)?;
    for warning in &roster.warnings {
        eprintln!("warning: {}: {warning}", sanitize(&path.to_string_lossy()));
    }
    Ok(roster)
}

/// Why a lab has no numbers for a student.
#[derive(Debug, thiserror::Error)]
pub enum StudentError {
    #[error("`{lab}` has the same numbers for everyone; leave out `--student`")]
    SameForAll { lab: String },
    #[error("students of `{lab}` have values of their own: say with `--roster` who they are")]
    NoRoster { lab: String },
    #[error("the student id `{id}` has no letter or digit in it")]
    NoId { id: String },
}

/// The lab with a student's own numbers.
pub fn load_lab_of(lab: Option<&str>, student: Option<&str>) -> Result<LabDefinition, Failure> {
    let lab = load_lab(lab)?;
    let Some(id) = student else { return Ok(lab) };
    let Some(rule) = &lab.variants else {
        return Err(StudentError::SameForAll { lab: lab.id.clone() }.into());
    };
    let variant = rule.of(id).ok_or_else(|| StudentError::NoId { id: sanitize(id).to_string() })?;
    lab.with_variant(&variant).map_err(|errors| Failure::Load(LoadError::Invalid(errors)))
}

pub fn load_with_reference(lab: Option<&str>) -> Result<(LabDefinition, Reference), Failure> {
    load_with_reference_of(lab, None)
}

pub fn load_with_reference_of(
    lab: Option<&str>,
    student: Option<&str>,
) -> Result<(LabDefinition, Reference), Failure> {
    let lab = load_lab_of(lab, student)?;
    let rendered = |error: ReferenceError| error.finding(&lab).render(&lab.text, colour_on_stderr());
    let reference =
        Reference::compute(&lab).map_err(|error| Failure::Reference { rendered: rendered(error) })?;
    Ok((lab, reference))
}

/// Colour only on a terminal that has colours, and never when `NO_COLOR` is set.
pub fn colour_on_stderr() -> bool {
    io::stderr().is_terminal() && colour_is_wanted()
}

pub fn colour_on_stdout() -> bool {
    io::stdout().is_terminal() && colour_is_wanted()
}

fn colour_is_wanted() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        && std::env::var_os("TERM").is_none_or(|value| value != "dumb")
}

/// To `path`, or to standard output.
pub fn write_output(path: Option<&PathBuf>, text: &str) -> Result<(), Failure> {
    match path {
        Some(path) => {
            std::fs::write(path, text).map_err(|error| Failure::Write { path: path.clone(), error })
        }
        None => {
            let mut stdout = io::stdout().lock();
            stdout.write_all(text.as_bytes())?;
            Ok(stdout.flush()?)
        }
    }
}
