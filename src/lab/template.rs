use super::{LabDefinition, Question};
use crate::submission::{AnswerSheet, AnsweredIn, FieldKind};
use std::collections::BTreeMap;

/// Columns a comment may take.
const WIDTH: usize = 96;

impl LabDefinition {
    /// An answer file to fill in: every question with its points, what is asked, and how to write it.
    ///
    /// It is YAML that reads as blank, and its examples belong to no question.
    pub fn answer_template(&self) -> String {
        self.answer_template_for("", "")
    }

    /// The same with a student's id and name filled in, and in a lab where values differ from student to student the ones
    /// this definition has. Empty texts stay blank.
    pub fn answer_template_for(&self, id: &str, name: &str) -> String {
        let total: super::Points = self.questions.iter().map(|q| q.points).sum();
        let units: BTreeMap<&str, &str> = self
            .sheet
            .fields
            .iter()
            .filter_map(|field| Some((field.path.as_str(), field.unit.as_ref()?.symbol())))
            .filter(|(_, unit)| !unit.is_empty())
            .collect();
        let mut page = Page::default();
        page.comment("#", &format!("{} ({total} points)", self.title));
        page.comment("#", "Write behind the colons and below the bars; what stays empty is not answered.");
        page.comment("#", "Indent with spaces, as it is. Lines that begin with # are only read by you.");
        page.blank();
        page.line(&format!("lab: {}", self.id));
        page.line("student:");
        page.line(format!("  id: {}", quoted(id)).trim_end());
        page.line(format!("  name: {}", quoted(name)).trim_end());
        if let Some(rule) = self.variants.as_ref().filter(|_| !id.is_empty()) {
            page.blank();
            page.comment("#", "Your values, which are not everyone's:");
            let varied = |name: &str| rule.parameters.iter().any(|one| one.name == name);
            for one in self.parameters.iter().filter(|one| varied(&one.name)) {
                page.comment("#", &format!("{} = {} {}", one.name, one.text, one.unit));
            }
        } else if self.variants.is_some() {
            page.blank();
            page.comment(
                "#",
                "Write your id above: values differ from student to student, and yours follow from it.",
            );
        }
        page.blank();
        page.line("answers:");
        for question in &self.questions {
            page.question(question, &units, &self.sheet);
        }
        page.text
    }
}

/// Anybody's text as a YAML scalar on one line: in double quotes, what a file cannot show written as escapes. Nothing for
/// an empty text.
pub(super) fn quoted(text: &str) -> String {
    if text.is_empty() {
        return String::new();
    }
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            letter if letter.is_control() || is_invisible(letter) => {
                quoted.push_str(&format!("\\U{:08X}", u32::from(letter)));
            }
            letter => quoted.push(letter),
        }
    }
    quoted + "\""
}

/// Marks that reverse the reading direction, line separators, and the byte order mark.
fn is_invisible(letter: char) -> bool {
    matches!(letter, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}')
}

#[derive(Default)]
struct Page {
    text: String,
}

impl Page {
    fn question(&mut self, question: &Question, units: &BTreeMap<&str, &str>, sheet: &AnswerSheet) {
        let points = question.points;
        let word = if points == super::Points(100) { "point" } else { "points" };
        self.blank();
        self.comment("  #", &format!("{}: {} ({points} {word})", question.number, question.title));
        for paragraph in question.text.split("\n\n").filter(|p| !p.trim().is_empty()) {
            self.comment("  #", paragraph);
        }
        let mut indent = "  ";
        let own = question.fields.iter().all(|field| field.path == question.id);
        if !own {
            self.line(&format!("  {}:", question.id));
            indent = "    ";
        }
        for field in &question.fields {
            self.comment(&format!("{indent}#"), &field.prompt);
            match units.get(field.path.as_str()) {
                Some(unit) => self.line(&format!("{indent}#   a number in {unit}, or unbounded")),
                None if field.answered_in == AnsweredIn::Letters => {
                    self.line(&format!("{indent}#   such as (2p*s + q)/(r*s^2 + 3q*s + 1)"));
                }
                None => {
                    how_to_write(field.kind).iter().for_each(|line| self.line(&format!("{indent}#   {line}")))
                }
            }
            if let Some(words) = sheet.letters.get(&field.path).and_then(|own| own.words(str::to_owned)) {
                self.comment(&format!("{indent}#  "), &words);
            }
            let name = match field.path.strip_prefix(&question.id).and_then(|rest| rest.strip_prefix('.')) {
                Some(name) if !own => name,
                _ => &field.path,
            };
            let bar = if field.kind == FieldKind::Prose { " |" } else { "" };
            self.line(&format!("{indent}{name}:{bar}"));
        }
    }

    /// Words in comment lines of [`WIDTH`] columns, which begin with `start`.
    fn comment(&mut self, start: &str, text: &str) {
        let mut line = start.to_owned();
        let bare = line.chars().count();
        for word in text.split_whitespace() {
            if line.chars().count() > bare && line.chars().count() + 1 + word.chars().count() > WIDTH {
                self.line(&line);
                line.truncate(start.len());
            }
            line.push(' ');
            line.push_str(word);
        }
        if line.chars().count() > bare {
            self.line(&line);
        }
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn blank(&mut self) {
        self.text.push('\n');
    }
}

fn how_to_write(kind: FieldKind) -> &'static [&'static str] {
    match kind {
        FieldKind::TransferFunction => {
            &["such as (2s + 1)/(s^2 + 3s + 7)", "or {num: [2, 1], den: [1, 3, 7]}, highest power of s first"]
        }
        FieldKind::Poles => &["such as [-4, -2 ± 3j], rad/s; a pole that is there twice is written twice"],
        FieldKind::Value => &["a number, or unbounded"],
        FieldKind::Stability => &["stable, marginally stable or unstable"],
        FieldKind::Shape => &[
            "decaying oscillation, sustained oscillation, growing oscillation,",
            "exponential decay, exponential growth, polynomial growth or constant",
        ],
        FieldKind::Nonlinearity => &[
            "saturation, dead zone, backlash, relay, Coulomb friction, hysteresis, quantization or rate limit",
        ],
        FieldKind::Formula => &["such as y = 2x + 1, or dy = 2 dx in deviations"],
        FieldKind::Prose => &["sentences below the bar, indented; Markdown with $math$ if you like"],
        FieldKind::Figure => &["a PNG or JPEG beside this file, such as my-plot.png"],
        FieldKind::Data => &[
            "a CSV beside this file with columns t, y, such as my-run.csv",
            "or the rows themselves: | behind the colon, then lines such as 0.0, 1.0 below, indented",
        ],
    }
}
