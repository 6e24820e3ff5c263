use crate::lab::folded_id;
use crate::source::{self, DecodeError, SourceText, sanitize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The students of a course, in the order of the list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Roster {
    pub students: Vec<RosterStudent>,
    /// What to look at: rows without an id, ids that are the same but for spelling.
    pub warnings: Vec<String>,
    by_folded: BTreeMap<String, usize>,
}

/// A row of the list. Both are somebody's own text: hostile until escaped.
#[derive(Clone, Debug, PartialEq)]
pub struct RosterStudent {
    pub id: String,
    pub name: String,
    /// Line in the file, from 1.
    pub line: u64,
}

/// Why there is no roster.
#[derive(Debug, thiserror::Error)]
pub enum RosterError {
    #[error("`{}` cannot be read: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("`{}` cannot be read: {error}", path.display())]
    NotText { path: PathBuf, error: DecodeError },
    #[error("{name}:{line}: this is not CSV: {what}")]
    NotCsv { name: String, line: u64, what: String },
    #[error(
        "{name}:1: no column is called `id`: the first line names the columns, such as `id,name` (found {found})"
    )]
    NoId { name: String, found: String },
    #[error("{name}: nobody is on this list")]
    Empty { name: String },
}

/// A course may have so many students, and a list so many bytes.
const MOST_STUDENTS: usize = 20_000;
const MOST_BYTES: usize = 8 << 20;
/// As an answer file holds them.
const MOST_OF_AN_ID: usize = 100;
const MOST_OF_A_NAME: usize = 200;

/// Column names, as letters and digits only, the likeliest first.
const ID: &[&str] = &[
    "id",
    "studentid",
    "idnumber",
    "studentnumber",
    "matriculationnumber",
    "sisuserid",
    "sisid",
    "number",
    "username",
    "orgdefinedid",
];
const NAME: &[&str] = &["name", "fullname", "studentname", "student", "displayname"];
const FIRST: &[&str] = &["firstname", "givenname", "forename"];
const LAST: &[&str] = &["lastname", "surname", "familyname"];

impl Roster {
    pub fn load(path: &Path) -> Result<Self, RosterError> {
        let bytes =
            std::fs::read(path).map_err(|error| RosterError::Read { path: path.to_path_buf(), error })?;
        let text = source::decode_within(&bytes, MOST_BYTES)
            .map_err(|error| RosterError::NotText { path: path.to_path_buf(), error })?;
        Self::parse(&SourceText::new(path.to_string_lossy(), text))
    }

    /// Reads a CSV whose first line names the columns, whatever their order and whatever else an LMS puts beside them:
    /// `id`, and `name` or `first name` and `last name`. The separator is a comma, a semicolon or a tab, as in the first line.
    pub fn parse(source: &SourceText) -> Result<Self, RosterError> {
        let name = sanitize(&source.name).to_string();
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(separator(&source.text))
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(source.text.as_bytes());
        let not_csv = |error: &csv::Error| RosterError::NotCsv {
            name: name.clone(),
            line: error.position().map_or(1, csv::Position::line),
            what: sanitize(&error.to_string()).to_string(),
        };
        let header = reader.headers().map_err(|error| not_csv(&error))?.clone();
        let column = |names: &[&str]| {
            let folded: Vec<String> = header.iter().map(folded_id).collect();
            names.iter().find_map(|name| folded.iter().position(|column| column == name))
        };
        let Some(id) = column(ID) else {
            let found: Vec<String> =
                header.iter().take(12).map(|one| format!("`{}`", clipped(one, MOST_OF_A_NAME))).collect();
            return Err(RosterError::NoId { name, found: sanitize(&found.join(", ")).to_string() });
        };
        let (whole, first, last) = (column(NAME), column(FIRST), column(LAST));
        let mut roster = Self::default();
        for record in reader.records() {
            let record = record.map_err(|error| not_csv(&error))?;
            let line = record.position().map_or(0, csv::Position::line);
            let cell = |column: Option<usize>| column.and_then(|at| record.get(at)).unwrap_or_default();
            let name = match cell(whole) {
                "" => [cell(first), cell(last)].join(" ").trim().to_owned(),
                name => name.to_owned(),
            };
            roster.add(RosterStudent {
                id: clipped(cell(Some(id)), MOST_OF_AN_ID),
                name: clipped(&name, MOST_OF_A_NAME),
                line,
            });
            if roster.students.len() >= MOST_STUDENTS {
                roster.warnings.push(format!("only the first {MOST_STUDENTS} students are read"));
                break;
            }
        }
        if roster.students.is_empty() {
            return Err(RosterError::Empty { name });
        }
        Ok(roster)
    }

    fn add(&mut self, student: RosterStudent) {
        let folded = folded_id(&student.id);
        if folded.is_empty() {
            if !student.name.is_empty() || !student.id.is_empty() {
                let who = if student.name.is_empty() { &student.id } else { &student.name };
                let who = sanitize(who);
                self.warnings.push(format!("line {}: `{who}` has no id and gets no numbers", student.line));
            }
            return;
        }
        match self.by_folded.get(&folded).and_then(|at| self.students.get(*at)) {
            Some(other) => {
                let (one, two) = (sanitize(&other.id), sanitize(&student.id));
                let (first, line) = (other.line, student.line);
                self.warnings.push(match other.id == student.id {
                    true => format!("line {line}: the id `{two}` is on line {first} already; it counts once"),
                    false => format!(
                        "line {line}: the id `{two}` differs from `{one}` on line {first} only in spelling: to polemark they \
                         are one student, with the same numbers"
                    ),
                });
                if other.id == student.id {
                    return;
                }
            }
            None => {
                self.by_folded.insert(folded, self.students.len());
            }
        }
        self.students.push(student);
    }

    /// Whether an id is on the list, however it is spelled.
    pub fn has(&self, id: &str) -> bool {
        self.by_folded.contains_key(&folded_id(id))
    }
}

/// What separates the columns: the one of these that the first line has most of, outside quotes.
fn separator(text: &str) -> u8 {
    let line = text.lines().next().unwrap_or_default();
    let mut quoted = false;
    let mut counts = [(b',', 0_usize), (b';', 0), (b'\t', 0)];
    for byte in line.bytes() {
        quoted ^= byte == b'"';
        if let Some((_, count)) = counts.iter_mut().find(|(one, _)| *one == byte && !quoted) {
            *count += 1;
        }
    }
    counts.into_iter().rev().max_by_key(|(_, count)| *count).map_or(b',', |(one, _)| one)
}

fn clipped(text: &str, most: usize) -> String {
    text.trim().chars().take(most).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Roster, RosterError> {
        Roster::parse(&SourceText::new("roster.csv", text))
    }

    #[track_caller]
    fn check(text: &str, students: &[(&str, &str)], warnings: &[&str]) {
        let roster = parse(text).unwrap();
        let found: Vec<_> = roster.students.iter().map(|s| (s.id.as_str(), s.name.as_str())).collect();
        assert_eq!(found, students, "{text}");
        assert_eq!(roster.warnings, warnings, "{text}");
    }

    #[test]
    fn columns_are_found_by_name() {
        check("id,name\nEE-001,A. Student\n", &[("EE-001", "A. Student")], &[]);
        check("Name;Group;Student ID\r\nB;2;EE-2\r\n", &[("EE-2", "B")], &[]);
        check("Surname\tFirst name\tID number\nStudent\tAda\t7\n", &[("7", "Ada Student")], &[]);
        check("\"Last, First\",SIS User ID\nx,9\n", &[("9", "")], &[]);
        check("id,name\n1,=HYPERLINK(\"x\")\n", &[("1", "=HYPERLINK(\"x\")")], &[]);
    }

    #[test]
    fn rows_that_cannot_be_told_apart_are_said() {
        check(
            "id,name\nEE-1,A\nee 1,B\nEE-1,A\n,C\n\n",
            &[("EE-1", "A"), ("ee 1", "B")],
            &[
                "line 3: the id `ee 1` differs from `EE-1` on line 2 only in spelling: to polemark they are one student, with \
                 the same numbers",
                "line 4: the id `EE-1` is on line 2 already; it counts once",
                "line 5: `C` has no id and gets no numbers",
            ],
        );
    }

    #[test]
    fn what_is_no_roster_says_so() {
        for (text, message) in [
            (
                "a,b\n1,2\n",
                "roster.csv:1: no column is called `id`: the first line names the columns, such as `id,name` (found `a`, `b`)",
            ),
            ("id,name\n", "roster.csv: nobody is on this list"),
            (
                "",
                "roster.csv:1: no column is called `id`: the first line names the columns, such as `id,name` (found )",
            ),
        ] {
            assert_eq!(parse(text).unwrap_err().to_string(), message);
        }
    }
}
