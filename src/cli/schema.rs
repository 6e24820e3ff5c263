use super::outcome::{Failure, write_output};
use std::path::PathBuf;
use std::process::ExitCode;

/// Print what a lab file or an answer file may hold: a JSON Schema for editors, or the reference of the lab file's keys.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark schema lab > lab.schema.json\n  polemark schema lab --format markdown"
)]
pub struct Arguments {
    /// What is described.
    #[arg(value_enum)]
    what: What,
    #[arg(long, value_enum, default_value_t = Format::Json)]
    format: Format,
    /// Write to this file instead of standard output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum What {
    /// Every lab file.
    Lab,
}

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Format {
    Json,
    Markdown,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let schema = match arguments.what {
        What::Lab => crate::lab::lab_schema(),
    };
    let text = match arguments.format {
        Format::Json => serde_json::to_string_pretty(&schema)? + "\n",
        Format::Markdown => String::new(),
    };
    write_output(arguments.out.as_ref(), &text)?;
    Ok(ExitCode::SUCCESS)
}
