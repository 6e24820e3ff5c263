use super::outcome::{Failure, load_lab, write_output};
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
    /// Write to this file instead of standard output; an existing file is left alone.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let template = load_lab(arguments.lab.as_deref())?.answer_template();
    match &arguments.out {
        None => write_output(None, &template)?,
        // Somebody's answers may already be in it.
        Some(path) => std::fs::File::create_new(path)
            .and_then(|mut file| std::io::Write::write_all(&mut file, template.as_bytes()))
            .map_err(|error| Failure::Write { path: path.clone(), error })?,
    }
    Ok(ExitCode::SUCCESS)
}
