use super::{About, MarksStub, OneStudent, answers};
use crate::class::run_facts::PartFacts;
use crate::source::sanitize;
use std::fmt::Write;

/// Hashes on a line.
const HASHES: usize = 6;

impl MarksStub {
    /// A marks file in YAML in which everything is left to be filled in. It says nothing as long as it is empty.
    pub fn to_yaml(&self) -> String {
        let mut out = String::new();
        // Writing into a string does not fail.
        let _ = self.write(&mut out);
        out
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "# What waits for a person: {}.", comment(&self.lab.title))?;
        let how = match self.suggests {
            true => {
                "Points that polemark gave are filled in. Change what you do not agree with, with a reason, which the student reads; \
                 empty the points of what you have not looked at."
            }
            false => {
                "Fill in points and a reason, which the student reads; what stays empty is not given yet."
            }
        };
        writeln!(out, "# {how}")?;
        writeln!(
            out,
            "# Then run grade again with --marks and this file. An answer that changes after that is put before you again."
        )?;
        writeln!(out, "lab: {}", quoted(&self.lab.id))?;
        if self.late > 0 {
            writeln!(
                out,
                "\n# {} handed in late. What that costs, points or {{percent: 10}} of what was earned:",
                self.late
            )?;
            writeln!(out, "late: {{points: }}")?;
        }
        for (file, message) in &self.elsewhere {
            writeln!(out, "\n# {}: {}", comment(file), comment(message))?;
        }
        if !self.files.is_empty() {
            writeln!(out, "\n# Whose file it is: the student's id, or a list of ids.\nfiles:")?;
            for (file, message) in &self.files {
                writeln!(out, "  # {}\n  {}: {{is: }}", comment(message), quoted(file))?;
            }
        }
        self.write_groups(out)?;
        self.write_students(out)
    }

    fn write_groups(&self, out: &mut String) -> std::fmt::Result {
        let groups = self.ordered_groups();
        if groups.is_empty() {
            return Ok(());
        }
        writeln!(out, "\n# One decision for all like answers of the class.\nalike:")?;
        let mut last = "";
        for (item, id, group) in groups {
            if item != last {
                writeln!(out, "  {}: # {}", quoted(item), comment(self.title(item)))?;
                last = item;
            }
            writeln!(out, "    {}: # {}", quoted(id), answers(group.count))?;
            about(out, "      ", &group.about)?;
            self.write_decision(out, "      ", &group.about)?;
            let hashes = group.listed_answers();
            match hashes.as_slice() {
                [] => {}
                [only] => writeln!(out, "      answer: {}", quoted(only))?,
                many => {
                    let lines: Vec<String> = many
                        .chunks(HASHES)
                        .map(|line| line.iter().map(|hash| quoted(hash)).collect::<Vec<_>>().join(", "))
                        .collect();
                    writeln!(out, "      answer: [{}]", lines.join(",\n        "))?;
                }
            }
        }
        Ok(())
    }

    fn write_students(&self, out: &mut String) -> std::fmt::Result {
        let mut students = self.asked().peekable();
        if students.peek().is_none() {
            return Ok(());
        }
        if self.asked().any(|student| !student.observed.is_empty()) {
            writeln!(out, "\n# The rows that are observed:")?;
            for row in &self.lab.observed {
                writeln!(out, "#   {} – {}, of {}", comment(&row.id), comment(&row.title), row.possible)?;
                for level in &row.levels {
                    let words = format!("{}: {}", comment(&level.title), comment(&level.text));
                    writeln!(out, "#     {}  {}", level.points, words)?;
                }
            }
        }
        writeln!(out, "\nstudents:")?;
        for student in students {
            self.write_student(out, student)?;
        }
        Ok(())
    }

    fn write_decision(&self, out: &mut String, indent: &str, about: &About) -> std::fmt::Result {
        let (points, reason) = self.filled_in(about);
        writeln!(out, "{indent}points:{}\n{indent}reason:{}", after(&points), after(reason))
    }

    fn write_student(&self, out: &mut String, student: &OneStudent) -> std::fmt::Result {
        writeln!(out, "  {}: # {}", quoted(&student.id), comment(&student.name))?;
        if student.which_counts {
            let files: Vec<String> = self.files_of(student).iter().map(|file| comment(file)).collect();
            writeln!(out, "    # Which counts: {}", files.join(" or "))?;
            writeln!(out, "    counts:")?;
        }
        let row = |out: &mut String, indent: &str, part: &PartFacts| {
            writeln!(out, "{indent}{}: # of {}", quoted(&part.id), part.possible)
        };
        for place in &student.cover {
            row(out, "    ", &self.lab.by_hand[*place])?;
        }
        if !student.observed.is_empty() {
            writeln!(out, "    observed:")?;
            for place in &student.observed {
                row(out, "      ", &self.lab.observed[*place])?;
            }
        }
        if !student.items.is_empty() {
            writeln!(out, "    items:")?;
            for (item, answer, what) in &student.items {
                writeln!(out, "      {}: # {}", quoted(item), comment(self.title(item)))?;
                about(out, "        ", what)?;
                self.write_decision(out, "        ", what)?;
                writeln!(out, "        answer: {}", quoted(answer))?;
            }
        }
        Ok(())
    }
}

/// What stands after a colon.
fn after(value: &str) -> String {
    if value.is_empty() { String::new() } else { format!(" {value}") }
}

fn about(out: &mut String, indent: &str, about: &About) -> std::fmt::Result {
    writeln!(out, "{indent}# polemark gave {} of {}: {}", about.given, about.possible, comment(&about.why))?;
    match about.begins.is_empty() {
        true => Ok(()),
        false => writeln!(out, "{indent}# {}", comment(&about.begins)),
    }
}

/// Text that stays within its line.
fn comment(text: &str) -> String {
    const LETTERS: usize = 300;
    sanitize(&text.chars().take(LETTERS).collect::<String>())
}

/// A scalar that YAML reads back as this very text.
pub(super) fn quoted(text: &str) -> String {
    let plain = text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-'));
    // Some readers take these for something else than text.
    let word =
        ["null", "true", "false", "yes", "no", "on", "off", "y", "n"].contains(&text.to_lowercase().as_str());
    if plain && !word {
        return text.to_owned();
    }
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            // Nobody sees what these do; U+FFFD is what `sanitize` puts in their place.
            c if c.is_control() || sanitize(c.encode_utf8(&mut [0; 4])).starts_with('\u{fffd}') => {
                let code = u32::from(c);
                let _ =
                    if code < 0x1_0000 { write!(out, "\\u{code:04x}") } else { write!(out, "\\U{code:08x}") };
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
