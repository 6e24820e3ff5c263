use super::outcome::{Failure, write_output};
use crate::class::{Comparison, NewFile, Standing, compare, comparison_csv, comparison_rows};
use crate::report::compare_page;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Say which points changed between two runs, and why.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark compare before out\n  polemark compare before/results.jsonl out --out changes\n\nExit code: 0, whatever has changed; 2 when a folder cannot be read."
)]
pub struct Arguments {
    /// Output folder of an earlier `grade`, or its results.jsonl.
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// The same of a later one.
    #[arg(value_name = "NEW")]
    new: PathBuf,
    /// Folder for compare.csv and compare.html; without it only the summary is printed, and the rows.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (old, new) = (Standing::load(&arguments.old)?, Standing::load(&arguments.new)?);
    same_lab(&arguments.old, &old, new.facts.as_ref().map_or("", |facts| &facts.lab.id))?;
    let comparison = compare(&old, &new);
    match &arguments.out {
        Some(out) => {
            std::fs::create_dir_all(out).map_err(|error| Failure::Write { path: out.clone(), error })?;
            write_comparison(&comparison, &new, out)?;
            write_output(None, &in_short(&comparison))?;
        }
        None => {
            let mut text = in_short(&comparison);
            for [student, _, item, old, new, _, cause] in comparison_rows(&comparison) {
                let cells = [student, item, format!("{} → {}", shown(&old), shown(&new)), cause];
                text.push_str(&format!(
                    "  {}\n",
                    cells.map(|cell| crate::source::sanitize(&cell)).join("  ")
                ));
            }
            write_output(None, &text)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Marks of another lab than `lab` are of other items. What an older polemark left does not say which lab it is of.
pub fn same_lab(path: &Path, old: &Standing, lab: &str) -> Result<(), Failure> {
    match old.facts.as_ref().map(|facts| &facts.lab.id) {
        Some(old) if !old.is_empty() && !lab.is_empty() && old != lab => {
            Err(Failure::TwoLabs { path: path.to_path_buf(), old: old.clone(), new: lab.to_owned() })
        }
        _ => Ok(()),
    }
}

/// Points, or a dash where there are none.
fn shown(points: &str) -> &str {
    if points.is_empty() { "–" } else { points }
}

/// Writes compare.csv and compare.html into `out`.
pub fn write_comparison(comparison: &Comparison, new: &Standing, out: &Path) -> Result<(), Failure> {
    let title = new.facts.as_ref().map_or("", |facts| facts.lab.title.as_str());
    let words = in_short(comparison);
    let page = compare_page(title, words.trim(), comparison_rows(comparison))?;
    for (name, bytes) in [("compare.csv", comparison_csv(comparison)?), ("compare.html", page.into_bytes())] {
        NewFile::create(out.join(name), out)?.write_all(&bytes)?;
    }
    Ok(())
}

/// `compared: 2 students, 3 items changed, by -0.5 points in the mean; because of: answer 2, lab 1`.
pub fn in_short(comparison: &Comparison) -> String {
    if comparison.changes.is_empty() {
        return "compared: nothing has changed\n".to_owned();
    }
    let mut causes = std::collections::BTreeMap::<&str, usize>::new();
    for change in &comparison.changes {
        *causes.entry(change.cause.as_str()).or_default() += 1;
    }
    let causes: Vec<String> = causes.iter().map(|(cause, count)| format!("{cause} {count}")).collect();
    let counted = |count: usize, one: &str| format!("{count} {one}{}", if count == 1 { "" } else { "s" });
    format!(
        "compared: {}, {} changed, by {:+.2} points in the mean; because of: {}\n",
        counted(comparison.students, "student"),
        counted(comparison.items, "item"),
        comparison.mean_change,
        causes.join(", ")
    )
}
