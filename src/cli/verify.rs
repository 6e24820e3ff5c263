use super::format::Format;
use super::outcome::{Failure, THEIRS, colour_on_stdout, load_with_reference, write_output};
use crate::annotations::{Annotations, Case, FileAnnotations};
use crate::lab::LabDefinition;
use crate::proof::{Check, Missing, missing, prove, to_paste};
use crate::source::{Finding, SourceText};
use std::process::ExitCode;

/// Prove a lab: its key agrees with stated values and a second route, the model answer earns full marks, a blank none.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark verify\n  polemark verify labs/mine/lab.yaml\n\nExit code: 0 when nothing fails, 1 when anything does; with --strict also when something is still to do."
)]
pub struct Arguments {
    /// Embedded lab, or path of a lab file [default: ee361-lab3].
    lab: Option<String>,
    /// End with exit code 1 also when something is still to do, so that nothing passes unproven.
    #[arg(long)]
    strict: bool,
    /// How to tell it.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (lab, reference) = load_with_reference(arguments.lab.as_deref())?;
    let checks = prove(&lab, &reference);
    let failed = checks.iter().filter(|check| !check.holds).count();
    let mut text = String::new();
    for check in &checks {
        text.push_str(&shown(check, &lab.text));
    }
    let missing = missing(&lab, &reference);
    for one in &missing {
        let mark = if one.keeps_from_proof { "TO DO" } else { "hint " };
        text.push_str(&wrapped(&format!("{mark} {}: {}", one.what, one.found)));
    }
    if let Some(lines) = to_paste(&lab, &reference) {
        text.push_str(TO_PASTE);
        text.push_str(&lines);
        text.push('\n');
    }
    let to_do = missing.iter().filter(|one| one.keeps_from_proof).count();
    text.push_str(&match (failed, to_do) {
        (0, 0) => format!("{}: proven, {} checks hold\n", lab.id, checks.len()),
        (0, n) => format!("{}: {} checks hold, but it is not proven yet: {n} to do\n", lab.id, checks.len()),
        (n, _) => format!("{}: NOT proven, {n} of {} checks fail\n", lab.id, checks.len()),
    });
    let text = arguments.format.output(text, &annotations(&lab, &checks, &missing))?;
    write_output(None, &text)?;
    let well = failed == 0 && (to_do == 0 || !arguments.strict);
    Ok(if well { ExitCode::SUCCESS } else { ExitCode::from(THEIRS) })
}

/// Each check, and what is still to do.
fn annotations(lab: &LabDefinition, checks: &[Check], missing: &[Missing]) -> Annotations {
    let checks = checks.iter().map(|check| match check.holds {
        true => Case::well(&check.what, "verify.holds", &check.found),
        false => Case::of(&check.what, &failed(check), &lab.text),
    });
    let missing = missing.iter().map(|one| {
        let finding = match one.keeps_from_proof {
            true => Finding::warning("verify.to_do", &one.found),
            false => Finding::note("verify.hint", &one.found),
        };
        Case::of(&one.what, &finding, &lab.text)
    });
    let file = FileAnnotations { file: lab.text.name.clone(), cases: checks.chain(missing).collect() };
    Annotations { verb: "polemark verify", files: vec![file] }
}

fn failed(check: &Check) -> Finding {
    Finding { span: check.span, ..Finding::error("verify.failed", &check.found) }
}

/// Said before the lines of [`to_paste`].
const TO_PASTE: &str = "
What is missing, as polemark computes it. Find each value by another route first, by hand or with another
program: pasted unread, they prove nothing but that polemark agrees with itself.

";

fn shown(check: &Check, lab: &SourceText) -> String {
    if check.holds {
        return wrapped(&format!("ok    {}: {}", check.what, check.found));
    }
    let line = wrapped(&format!("FAIL  {}: {}", check.what, check.found));
    match check.span {
        None => line,
        Some(_) => format!("{line}{}\n", failed(check).render(lab, colour_on_stdout())),
    }
}

/// Columns of a line, unless one word is longer.
const WIDTH: usize = 100;
const INDENT: &str = "        ";

/// What does not fit goes on indented, so that each check begins a line of its own.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    for line in text.lines() {
        let indent = &line[..line.len() - line.trim_start().len()];
        let mut width = 0;
        for (nth, word) in line.trim_start().split(' ').enumerate() {
            let length = word.chars().count();
            if nth == 0 {
                lines.push_str(indent);
                width = indent.len();
            } else if width + 1 + length > WIDTH {
                lines.push('\n');
                lines.push_str(INDENT);
                width = INDENT.len();
            } else {
                lines.push(' ');
                width += 1;
            }
            lines.push_str(word);
            width += length;
        }
        lines.push('\n');
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_wrapped_and_indented() {
        let word = "abcdefghi";
        let line = |n: usize| vec![word; n].join(" ");
        assert_eq!(wrapped("ok    short"), "ok    short\n");
        assert_eq!(wrapped(&line(10)), format!("{}\n", line(10)));
        assert_eq!(wrapped(&line(11)), format!("{}\n        {word}\n", line(10)));
        assert_eq!(wrapped("a\n    b"), "a\n    b\n");
        let long = "x".repeat(200);
        assert_eq!(wrapped(&format!("a {long} b")), format!("a\n        {long}\n        b\n"));
    }
}
