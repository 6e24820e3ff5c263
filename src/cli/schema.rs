use super::outcome::{Failure, load_lab, write_output};
use crate::lab::{lab_reference, lab_schema};
use std::path::PathBuf;
use std::process::ExitCode;

/// Print what a lab file or an answer file may hold: a JSON Schema for editors, or the reference of the lab file's keys.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark schema lab --out lab.schema.json\n  polemark schema answers labs/mine/lab.yaml --out answers.schema.json\n\nAn editor with YAML support uses it when the file begins with `# yaml-language-server: $schema=lab.schema.json`."
)]
pub struct Arguments {
    /// `lab`: every lab file; `answers`: the answer files of one lab.
    #[arg(value_enum)]
    what: What,
    /// For `answers`: embedded lab, or path of a lab file [default: ee361-lab3].
    lab: Option<String>,
    /// `json`; for `lab` also `markdown`, a table of the keys.
    #[arg(long, value_enum, default_value_t = Format::Json)]
    format: Format,
    /// Write to this file instead of standard output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum What {
    Lab,
    Answers,
}

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Format {
    Json,
    Markdown,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let text = match (arguments.what, arguments.format) {
        (What::Lab, Format::Markdown) => lab_reference(),
        (What::Lab, Format::Json) => serde_json::to_string_pretty(&lab_schema())? + "\n",
        // The keys of an answer file are those of its template, which says more in fewer words.
        (What::Answers, Format::Markdown) => load_lab(arguments.lab.as_deref())?.answer_template(),
        (What::Answers, Format::Json) => {
            serde_json::to_string_pretty(&load_lab(arguments.lab.as_deref())?.answers_schema())? + "\n"
        }
    };
    write_output(arguments.out.as_ref(), &text)?;
    Ok(ExitCode::SUCCESS)
}
