use super::outcome::{Failure, load_lab_of, write_output};
use std::path::PathBuf;
use std::process::ExitCode;

/// Print a commented answer file to fill in.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark new > answers.yaml\n  polemark new labs/mine/lab.yaml --out answers.yaml"
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
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
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
