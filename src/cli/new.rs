use super::outcome::{Failure, load_lab_of, write_output};
use super::scaffold::scaffold;
use std::path::PathBuf;
use std::process::ExitCode;

/// Print a commented answer file to fill in, or make the folder of a new lab.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark new > answers.yaml\n  polemark new labs/mine/lab.yaml --out answers.yaml\n  polemark new --lab labs/mine\n\nA new lab is a small one that `polemark verify` proves as it is, to be changed step by step."
)]
pub struct Arguments {
    /// Embedded lab, or path of a lab file [default: ee361-lab3].
    lab: Option<String>,
    /// A student's own: with the id filled in, and the values that follow from it.
    #[arg(long, value_name = "ID")]
    student: Option<String>,
    /// Write to this file instead of standard output; an existing file is left alone.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Make this folder with a new lab in it; existing files are left alone.
    #[arg(long = "lab", value_name = "DIR", conflicts_with_all = ["lab", "out", "student"])]
    folder: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if let Some(folder) = &arguments.folder {
        write_output(None, &scaffold(folder)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let id = arguments.student.as_deref();
    let template = load_lab_of(arguments.lab.as_deref(), id)?.answer_template_for(id.unwrap_or_default(), "");
    match &arguments.out {
        None => write_output(None, &template)?,
        // Somebody's answers may already be in it.
        Some(path) => std::fs::File::create_new(path)
            .and_then(|mut file| std::io::Write::write_all(&mut file, template.as_bytes()))
            .map_err(|error| Failure::Write { path: path.clone(), error })?,
    }
    Ok(ExitCode::SUCCESS)
}
