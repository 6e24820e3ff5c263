use super::outcome::{Failure, load_with_reference_of, write_output};
use crate::lab::LabDefinition;
use crate::reference::{ForStudent, to_json_for, to_text};
use crate::report::ReportKit;
use crate::source::sanitize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Print the answer key, computed from the lab's equations.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark reference\n  polemark reference --format html --out key.html\n  polemark reference labs/mine/lab.yaml --student EE-001"
)]
pub struct Arguments {
    /// Embedded lab, or path of a lab file [default: ee361-lab3].
    lab: Option<String>,
    /// What to write: `text`, `json` for other programs, `html` with plots.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// The key for a student's own numbers, in a lab where they differ from student to student.
    #[arg(long, value_name = "ID")]
    student: Option<String>,
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
    let student = arguments.student.as_deref();
    let (lab, reference) = load_with_reference_of(arguments.lab.as_deref(), student)?;
    let key = match arguments.format {
        Format::Text => numbers_of(&lab, student) + &to_text(&reference),
        Format::Json => to_json_for(&reference, student.map(|id| for_student(&lab, id)))? + "\n",
        Format::Html => ReportKit::new(&lab, &reference)?.reference_page_for(student),
    };
    write_output(arguments.out.as_ref(), &key)?;
    Ok(ExitCode::SUCCESS)
}

/// A line before the key: `For EE-001: M = 0.4 kg, b = 0.1 N s/m`.
fn numbers_of(lab: &LabDefinition, student: Option<&str>) -> String {
    let (Some(id), Some(rule)) = (student, &lab.variants) else { return String::new() };
    let own =
        lab.parameters.iter().filter(|one| rule.parameters.iter().any(|varied| varied.name == one.name));
    let values: Vec<String> =
        own.map(|one| format!("{} = {} {}", one.name, one.text, one.unit).trim_end().to_owned()).collect();
    format!("For {}: {}\n", sanitize(id), values.join(", "))
}

fn for_student<'a>(lab: &'a LabDefinition, id: &'a str) -> ForStudent<'a> {
    let parameters = lab.parameters.iter().map(|one| (one.name.as_str(), one.text.as_str()));
    ForStudent { student: id, parameters: parameters.collect() }
}
