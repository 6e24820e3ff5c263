use super::outcome::{Failure, write_output};
use crate::class::{ClassError, MarksStub, NewFile, Results, appended};
use crate::source::sanitize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Write down what still waits for a person, as a marks file to be filled in.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark marks out --out marks.yaml\n  polemark marks out --out marks.csv --suggest\n  polemark grade submissions --out out --marks marks.yaml\n\nA YAML file is only written where there is none. To a CSV file the rows are added that are not there; nothing in it is ever changed."
)]
pub struct Arguments {
    /// Output folder of `grade`.
    #[arg(value_name = "OUT")]
    folder: PathBuf,
    /// Marks file, .yaml or .csv; without it YAML is printed.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Fill in the points that polemark gave, with `confirmed` as the reason: look through them, and change what you do not agree
    /// with.
    #[arg(long)]
    suggest: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let stub = stub(&arguments.folder)?.with_suggestions(arguments.suggest);
    if stub.is_empty() {
        eprintln!("{}", stub.in_short());
        return Ok(ExitCode::SUCCESS);
    }
    let Some(path) = &arguments.out else {
        write_output(None, &stub.to_yaml())?;
        return Ok(ExitCode::SUCCESS);
    };
    let written = |error| Failure::Write { path: path.clone(), error };
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        let before = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(Failure::Read { path: path.clone(), error }),
        };
        let (bytes, added) = appended(&before, &stub)
            .map_err(|error| written(io::Error::new(io::ErrorKind::InvalidData, error.to_string())))?;
        // What is there is not touched: only what comes after it is written, all of it or nothing.
        if let Some(more) = bytes.get(before.len()..).filter(|more| !more.is_empty() && added > 0) {
            let mut file =
                std::fs::OpenOptions::new().create(true).append(true).open(path).map_err(written)?;
            if let Err(error) = file.write_all(more) {
                let _ = file.set_len(before.len() as u64);
                return Err(written(error));
            }
        }
        eprintln!("{}: {added} rows added; {}", sanitize(&path.to_string_lossy()), stub.in_short());
    } else {
        if path.exists() {
            return Err(Failure::Exists { path: path.clone() });
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut new = NewFile::create(path.clone(), folder)?;
        new.file.as_file_mut().write_all(stub.to_yaml().as_bytes()).map_err(written)?;
        new.finish_new().map_err(|error| match error {
            ClassError::Write { error, .. } if error.kind() == io::ErrorKind::AlreadyExists => {
                Failure::Exists { path: path.clone() }
            }
            other => other.into(),
        })?;
        eprintln!("{}: {}", sanitize(&path.to_string_lossy()), stub.in_short());
    }
    Ok(ExitCode::SUCCESS)
}

/// What waits in an output folder.
fn stub(folder: &Path) -> Result<MarksStub, Failure> {
    let results = Results::open(folder)?;
    let mut stub = MarksStub::new(results.facts().map(|facts| facts.lab.clone()).unwrap_or_default());
    for record in results {
        stub.add(&record?);
    }
    Ok(stub)
}
