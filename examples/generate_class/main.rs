//! Writes a class of different submissions to any lab, in any form it is handed in: same seed, same bytes.
//!
//! ```text
//! cargo run --release --example generate_class -- --students 3000 --seed 1 --form moodle --out class
//! cargo run --release -- grade class/submissions.zip --roster class/roster.csv --out out
//! ```
//!
//! `--lab` takes the name of an embedded lab or the path of a lab file. Forms: `folder`, `files`, `moodle`, `moodle-flat`,
//! `moodle-hidden`, `canvas`, `canvas-hidden`, `groups`; all but the first two are zip archives. Beside what is handed in lies
//! `roster.csv`.

mod class;
mod forms;

use class::Class;
use forms::{FORMS, Form};
use polemark::lab::{self, LabDefinition};
use polemark::reference::Reference;
use polemark::source::SourceText;
use std::path::PathBuf;

const HELP: &str = "\
Writes a class of different submissions to a lab, and roster.csv beside them; the same seed gives the same bytes.

  cargo run --release --example generate_class -- --students 300 --form moodle --out class
  cargo run --release -- grade class/submissions.zip --roster class/roster.csv --out out

  --out DIR       where to
  --students N    how many [default: 100]
  --seed N        [default: 1]
  --lab LAB       embedded lab or path of a lab file [default: ee361-lab3]
  --form FORM     folder, files, moodle, moodle-flat, moodle-hidden, canvas, canvas-hidden or groups; all but the first two are
                  zip archives [default: folder]
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut students, mut seed, mut form, mut out) = (100, 1, Form::Folder, None);
    let mut lab = lab::DEFAULT.to_owned();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or_else(|| format!("{argument} needs a value"));
        match argument.as_str() {
            "--help" | "-h" => {
                print!("{HELP}");
                return Ok(());
            }
            "--students" => students = value()?.parse()?,
            "--seed" => seed = value()?.parse()?,
            "--form" => form = named(&value()?)?,
            "--lab" => lab = value()?,
            "--out" => out = Some(PathBuf::from(value()?)),
            other => {
                return Err(
                    format!("{other} is not known; see the top of examples/generate_class/main.rs").into()
                );
            }
        }
    }
    let out = out.ok_or("--out DIR says where to write")?;
    let lab = load(&lab)?;
    let reference = Reference::compute(&lab)?;
    let class = Class::new(&lab, &reference, seed);
    forms::write(&class, students, form, &out)?;
    println!("{students} students of {} in {}", lab.id, out.display());
    Ok(())
}

fn named(name: &str) -> Result<Form, String> {
    let found = FORMS.iter().find(|(one, _)| *one == name).map(|(_, form)| *form);
    let all = || FORMS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    found.ok_or_else(|| format!("{name} is no form; there are {}", all()))
}

fn load(lab: &str) -> Result<LabDefinition, Box<dyn std::error::Error>> {
    if lab::embedded().iter().any(|(id, _)| *id == lab) {
        return Ok(lab::load(lab)?);
    }
    let text = std::fs::read_to_string(lab)?;
    LabDefinition::parse(SourceText::new(lab, text)).map_err(|errors| format!("{errors}").into())
}
