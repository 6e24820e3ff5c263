use super::Student;
use super::problem::quote;
use crate::names::nearest;
use crate::source::{Finding, Node, Span, Value};

/// Students in one file.
const MAX_STUDENTS: usize = 20;
const MAX_ID: usize = 100;
const MAX_NAME: usize = 200;

const HELP: &str =
    "Write `student: {id: EE-001, name: A. Student}`; for a group, `students:` with a list of these.";

/// The student of a file that names none: its stem stands for the id.
pub(super) fn nobody(stem: &str) -> Vec<Student> {
    vec![Student { id: stem.to_owned(), name: String::new() }]
}

/// Collects who handed it in, from `student:` and `students:`.
#[derive(Default)]
pub(super) struct People {
    found: Vec<(Student, Span)>,
    findings: Vec<Finding>,
}

impl People {
    pub fn read(&mut self, key: Span, node: &Node) {
        match &node.value {
            Value::Null => {}
            Value::Sequence(items) => items.iter().for_each(|item| self.person(item)),
            Value::Mapping(_) | Value::Scalar(_) => self.person(node),
        }
        if self.found.len() > MAX_STUDENTS {
            self.found.truncate(MAX_STUDENTS);
            let message =
                format!("More than {MAX_STUDENTS} students are named; the first {MAX_STUDENTS} are read.");
            self.findings.push(Finding::error("student.too_many", message).at(key));
        }
    }

    fn person(&mut self, node: &Node) {
        let mut student = Student::default();
        match &node.value {
            Value::Null => return,
            Value::Scalar(text) => {
                // `EE-001` is an id, `A. Student` a name.
                let text = text.trim();
                let place =
                    if text.contains(char::is_whitespace) { &mut student.name } else { &mut student.id };
                *place = text.to_owned();
            }
            Value::Mapping(entries) => {
                for (key, span, value) in entries {
                    let name = key.trim().to_lowercase();
                    let place = match name.as_str() {
                        "id" | "student_id" | "number" => &mut student.id,
                        "name" | "full_name" => &mut student.name,
                        _ => {
                            let near = nearest(&name, ["id", "name"]);
                            let help = near.map_or(HELP.to_owned(), |near| format!("Did you mean `{near}`?"));
                            let message = format!("{} is not asked for about a student.", quote(key));
                            self.findings.push(
                                Finding::error("student.unknown_key", message).with_help(help).at(*span),
                            );
                            continue;
                        }
                    };
                    match &value.value {
                        Value::Null => {}
                        Value::Scalar(text) if place.is_empty() => *place = text.trim().to_owned(),
                        Value::Scalar(_) => self.findings.push(
                            Finding::error(
                                "student.twice",
                                format!("{} is given twice; the first is used.", quote(key)),
                            )
                            .at(*span),
                        ),
                        _ => self.findings.push(
                            Finding::error("student.unreadable", format!("{} has to be text.", quote(key)))
                                .with_help(HELP)
                                .at(value.span),
                        ),
                    }
                }
            }
            Value::Sequence(_) => {
                let message = "A student is given by `id` and `name`; a list stands here.";
                self.findings
                    .push(Finding::error("student.unreadable", message).with_help(HELP).at(node.span));
                return;
            }
        }
        for (text, limit, what) in [(&mut student.id, MAX_ID, "id"), (&mut student.name, MAX_NAME, "name")] {
            if let Some((cut, _)) = text.char_indices().nth(limit) {
                text.truncate(cut);
                let message = format!("The student's {what} is longer than {limit} characters and is cut.");
                self.findings.push(Finding::warning("student.too_long", message).at(node.span));
            }
        }
        self.found.push((student, node.span));
    }

    /// The students; one without an id gets the file's stem.
    pub fn finish(mut self, stem: &str) -> (Vec<Student>, Vec<Finding>) {
        self.found.retain(|(student, _)| *student != Student::default());
        if self.found.is_empty() {
            let message =
                format!("The file does not say whose it is; it is kept under its own name, {}.", quote(stem));
            self.findings.push(Finding::warning("student.missing", message).with_help(HELP));
            return (nobody(stem), self.findings);
        }
        let mut students: Vec<Student> = Vec::new();
        let mut unnamed = 0;
        for (mut student, span) in self.found {
            if student.id.is_empty() {
                unnamed += 1;
                student.id = if unnamed == 1 { stem.to_owned() } else { format!("{stem} {unnamed}") };
                let message = format!(
                    "The student has no id; the name of the file, {}, stands for it.",
                    quote(&student.id)
                );
                self.findings.push(Finding::warning("student.id_missing", message).with_help(HELP).at(span));
            } else if students.iter().any(|other| other.id == student.id) {
                let message = format!("The id {} is given twice; it is counted once.", quote(&student.id));
                self.findings.push(Finding::error("student.twice", message).at(span));
                continue;
            }
            students.push(student);
        }
        (students, self.findings)
    }
}

/// The students of a file that is not YAML, from lines that look like `id: EE-001`; and what to say about it.
pub(super) fn salvage(text: &str, stem: &str) -> (Vec<Student>, Finding) {
    let mut students: Vec<Student> = Vec::new();
    let lines = text
        .lines()
        .take(200)
        .skip_while(|line| !line.trim_start().to_lowercase().starts_with("student"))
        .take_while(|line| {
            !line.trim_start().to_lowercase().starts_with("answer") && !line.starts_with("---")
        });
    for line in lines {
        for (at, key) in keys(line) {
            let value = value_after(&line[at + key.len()..]);
            if value.is_empty() {
                continue;
            }
            if key == "id" && students.len() < MAX_STUDENTS {
                students.push(Student { id: value.chars().take(MAX_ID).collect(), name: String::new() });
            } else if key == "name"
                && let Some(student) = students.last_mut().filter(|student| student.name.is_empty())
            {
                student.name = value.chars().take(MAX_NAME).collect();
            }
        }
    }
    let mut seen = std::collections::BTreeSet::new();
    students.retain(|student| seen.insert(student.id.clone()));
    if students.is_empty() {
        let message = format!(
            "Whose file it is could not be read either; it is kept under its own name, {}.",
            quote(stem)
        );
        return (nobody(stem), Finding::warning("student.missing", message).with_help(HELP));
    }
    let ids = students.iter().map(|student| quote(&student.id)).collect::<Vec<_>>().join(", ");
    let message = format!("From the lines that could be recognised, this seems to be the file of {ids}.");
    (students, Finding::note("student.salvaged", message))
}

/// The lab a file that is not YAML says it answers.
pub(super) fn salvage_lab(text: &str) -> Option<String> {
    let line = text.lines().take(200).find_map(|line| line.strip_prefix("lab:"))?;
    let value = value_after(line);
    (!value.is_empty()).then(|| value.chars().take(200).collect())
}

/// Where `id:` and `name:` stand in a line, in order.
fn keys(line: &str) -> Vec<(usize, &'static str)> {
    let mut found: Vec<(usize, &'static str)> = ["id", "name"]
        .into_iter()
        .filter_map(|key| {
            line.match_indices(key)
                .find(|(at, _)| {
                    let alone =
                        !line[..*at].ends_with(|c: char| c.is_alphanumeric() || matches!(c, '_' | '-'));
                    alone && line[at + key.len()..].trim_start().starts_with(':')
                })
                .map(|(at, _)| (at, key))
        })
        .collect();
    found.sort_unstable();
    found
}

/// The text after a colon, up to a comma or closing brace, without quotes.
fn value_after(text: &str) -> &str {
    let text = text.trim_start().strip_prefix(':').unwrap_or(text).trim();
    let end = text.find([',', '}', ']', '#']).unwrap_or(text.len());
    text[..end].trim().trim_matches(['"', '\'']).trim()
}
