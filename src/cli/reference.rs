use super::outcome::{Failure, load_with_reference, write_output};
use crate::reference::{to_json, to_text};
use crate::report::ReportKit;
use std::path::PathBuf;
use std::process::ExitCode;

/// Print the answer key, computed from the lab's equations.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark reference\n  polemark reference --format html --out key.html"
)]
pub struct Arguments {
    /// Embedded lab, or path of a lab file [default: ee361-lab3].
    lab: Option<String>,
    /// What to write: `text`, `json` for other programs, `html` with plots.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Write to this file instead of standard output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    Text,
    Json,
    Html,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (lab, reference) = load_with_reference(arguments.lab.as_deref())?;
    let key = match arguments.format {
        Format::Text => to_text(&reference),
        Format::Json => to_json(&reference)? + "\n",
        Format::Html => ReportKit::new(&lab, &reference)?.reference_page(),
    };
    write_output(arguments.out.as_ref(), &key)?;
    Ok(ExitCode::SUCCESS)
}
