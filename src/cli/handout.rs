use super::outcome::{Failure, StudentError, load_lab, load_roster, write_output};
use crate::class::{HandoutError, write_handouts};
use crate::report::numbers::counted;
use crate::source::sanitize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Write what students get: sheet, answer file, and what `check` needs of the lab.
///
/// In DIR, a folder for each student with handout.html, answers.yaml and LAB.student.yaml, and variants.csv, which is for you:
/// who has which values. A lab that is the same for everyone gives one of each. LAB.student.yaml is the student edition of the
/// lab: `polemark check answers.yaml --lab LAB.student.yaml` reads with it, and no right answers are in it. The lab file itself
/// has them: keep it.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark handout labs/mine/lab.yaml --roster roster.csv --out handouts\n  polemark handout --out handout"
)]
pub struct Arguments {
    /// Embedded lab, or path of a lab file [default: ee361-lab3].
    lab: Option<String>,
    /// CSV of the course's students, with a first line that names the columns: id, name.
    #[arg(long, value_name = "FILE")]
    roster: Option<PathBuf>,
    /// Folder to write to; made when it is not there. Answer files that are there already are left alone.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let lab = load_lab(arguments.lab.as_deref())?;
    let roster = arguments.roster.as_deref().map(load_roster).transpose()?;
    if lab.variants.is_some() && roster.is_none() {
        return Err(StudentError::NoRoster { lab: lab.id.clone() }.into());
    }
    let written = write_handouts(&lab, roster.as_ref(), &arguments.out).map_err(|error| match error {
        HandoutError::Lab(errors) => Failure::Load(crate::lab::LoadError::Invalid(errors)),
        HandoutError::Write { path, error } => Failure::Write { path, error },
        HandoutError::Report(error) => Failure::Report(error),
    })?;
    let out = sanitize(&arguments.out.to_string_lossy()).to_string();
    let mut text = match written.variants {
        0 => format!("one sheet for everyone in {out}: the lab has the same values for all\n"),
        variants => format!(
            "{} in {out}, {} of {} possible\n",
            counted(written.sheets, "sheet"),
            counted(variants, "different variant"),
            lab.variants.as_ref().map_or(1, crate::lab::VariantRule::count)
        ),
    };
    if written.left_alone > 0 {
        text.push_str(&format!(
            "{} left alone, with something in it already\n",
            counted(written.left_alone, "answer file")
        ));
    }
    write_output(None, &text)?;
    Ok(ExitCode::SUCCESS)
}
