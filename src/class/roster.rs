use crate::lab::folded_id;
use crate::source::{self, DecodeError, SourceText, StrayQuote, sanitize, separator, stray_quote};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use unicode_normalization::UnicodeNormalization;

/// The students of a course, in the order of the list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Roster {
    pub students: Vec<RosterStudent>,
    /// What to look at: rows without an id, ids that are the same but for spelling.
    pub warnings: Vec<String>,
    by_folded: BTreeMap<String, usize>,
    /// Other identifiers, names, and numbers of an LMS: to one student, or to several and so to nobody.
    by_other: BTreeMap<(Key, String), Option<usize>>,
    /// By the folded name of a group.
    by_group: BTreeMap<String, Vec<usize>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    /// SIS id, login, e-mail address.
    Identifier,
    /// Words of the full name in any order, without accents.
    Name,
    /// The full name run together, family name first or last.
    RunTogether,
    Canvas,
    Moodle,
}

/// A row of the list. All of it is somebody's own text: hostile until escaped.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RosterStudent {
    pub id: String,
    pub name: String,
    /// Canvas' number of the user.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub canvas_id: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sis_user_id: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sis_login_id: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section: Option<String>,
    /// Moodle's number of the participant, without the word before it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moodle_id: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub email: Option<String>,
    /// Names of the groups they are in, with commas between.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Line in the file, from 1.
    #[serde(skip)]
    pub line: u64,
}

/// Why there is no roster.
#[derive(Debug, thiserror::Error)]
pub enum RosterError {
    #[error("`{}` cannot be read: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("`{}` cannot be read: {error}{}", path.display(), if matches!(error, DecodeError::NotText { .. }) { SAVE_AS } else { "" })]
    NotText { path: PathBuf, error: DecodeError },
    #[error("{name}:{line}: this is not CSV: {what}")]
    NotCsv { name: String, line: u64, what: String },
    #[error("{name}:1: no column is called `id`: the first line names the columns, such as `id,name`{found}")]
    NoId { name: String, found: String },
    #[error("{name}: nobody is on this list")]
    Empty { name: String },
}

/// What to do about a table in another encoding: spreadsheets have one of their own as well.
pub const SAVE_AS: &str = "; save it as CSV in UTF-8 (in Excel: “CSV UTF-8”)";

/// A course may have so many students, and a list so many bytes.
const MOST_STUDENTS: usize = 20_000;
const MOST_BYTES: usize = 8 << 20;
/// As an answer file holds them.
const MOST_OF_AN_ID: usize = 100;
const MOST_OF_A_NAME: usize = 200;

/// Words of a name that it may begin with when it is run together.
const MOST_TURNS: usize = 8;

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
/// What stands in for an id where there is none: Canvas' gradebook, Moodle's grading worksheet and list of participants.
const INSTEAD_OF_ID: &[&str] =
    &["sisuserid", "sisloginid", "loginid", "username", "emailaddress", "email", "identifier"];
const NAME: &[&str] = &["name", "fullname", "studentname", "student", "displayname"];
const FIRST: &[&str] = &["firstname", "givenname", "forename"];
const LAST: &[&str] = &["lastname", "surname", "familyname"];
const CANVAS_ID: &[&str] = &["canvasid", "canvasuserid"];
const SIS_USER_ID: &[&str] = &["sisuserid", "sisid"];
const SIS_LOGIN_ID: &[&str] = &["sisloginid", "loginid", "username", "login"];
const SECTION: &[&str] = &["section", "sections"];
const MOODLE_ID: &[&str] = &["moodleid", "identifier", "participant", "participantnumber"];
const EMAIL: &[&str] = &["email", "emailaddress", "mail"];
const GROUP: &[&str] = &["group", "groups", "groupname", "team"];

impl Roster {
    pub fn load(path: &Path) -> Result<Self, RosterError> {
        let bytes = source::read_within(path, MOST_BYTES)
            .map_err(|error| RosterError::Read { path: path.to_path_buf(), error })?;
        let text = source::decode_within(&bytes, MOST_BYTES)
            .map_err(|error| RosterError::NotText { path: path.to_path_buf(), error })?;
        Self::parse(&SourceText::new(path.to_string_lossy(), text))
    }

    /// Reads a CSV whose first line names the columns, whatever their order and whatever else an LMS puts beside them:
    /// `id`, and `name` or `first name` and `last name`. The separator is a comma, a semicolon or a tab, as in the first line.
    pub fn parse(source: &SourceText) -> Result<Self, RosterError> {
        let name = sanitize(&source.name).to_string();
        let delimiter = separator(source.text.as_bytes());
        if let Some(StrayQuote::NotClosed(at)) = stray_quote(source.text.as_bytes(), delimiter) {
            let line = source.position(at).line as u64;
            let what = "a quote is not closed, and everybody after it would be lost".to_owned();
            return Err(RosterError::NotCsv { name, line, what });
        }
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(source.text.as_bytes());
        let not_csv = |error: &csv::Error| RosterError::NotCsv {
            name: name.clone(),
            line: error.position().map_or(1, csv::Position::line),
            what: sanitize(&error.to_string()).to_string(),
        };
        let header = reader.headers().map_err(|error| not_csv(&error))?.clone();
        let folded: Vec<String> = header.iter().map(folded_id).collect();
        let column =
            |names: &[&str]| names.iter().find_map(|name| folded.iter().position(|column| column == name));
        // Canvas calls its own number `ID`, and numbers nobody outside knows are no ids of students.
        let of_canvas = column(&["student"]).is_some() && column(&["sisuserid", "sisloginid"]).is_some();
        let ids: Vec<usize> = match of_canvas {
            true => INSTEAD_OF_ID.iter().chain(&["id"]).filter_map(|name| column(&[name])).collect(),
            false => column(ID)
                .into_iter()
                .chain(INSTEAD_OF_ID.iter().filter_map(|name| column(&[name])))
                .collect(),
        };
        if ids.is_empty() {
            let found: Vec<String> =
                header.iter().take(12).map(|one| format!("`{}`", clipped(one, MOST_OF_A_NAME))).collect();
            let found = match header.iter().all(str::is_empty) {
                true => "; it is empty".to_owned(),
                false => format!(" (found {})", sanitize(&found.join(", "))),
            };
            return Err(RosterError::NoId { name, found });
        }
        let canvas_id = if of_canvas { column(&["id"]) } else { column(CANVAS_ID) };
        let (whole, first, last) = (column(NAME), column(FIRST), column(LAST));
        let others = [SIS_USER_ID, SIS_LOGIN_ID, SECTION, MOODLE_ID, EMAIL, GROUP].map(column);
        let mut roster = Self::default();
        for record in reader.records() {
            let record = record.map_err(|error| not_csv(&error))?;
            let line = record.position().map_or(0, csv::Position::line);
            let cell =
                |column: Option<usize>| column.and_then(|at| record.get(at)).unwrap_or_default().trim();
            let name = match cell(whole) {
                "" => [cell(first), cell(last)].join(" ").trim().to_owned(),
                name if of_canvas => given_name_first(name),
                name => name.to_owned(),
            };
            if of_canvas && is_no_student(cell(whole), cell(canvas_id)) {
                continue;
            }
            let id = ids.iter().map(|at| cell(Some(*at))).find(|id| !id.is_empty()).unwrap_or_default();
            let kept = |text: &str| (!text.is_empty()).then(|| clipped(text, MOST_OF_A_NAME));
            let [sis_user_id, sis_login_id, section, moodle_id, email, group] =
                others.map(|at| kept(cell(at)));
            roster.add(RosterStudent {
                id: clipped(id, MOST_OF_AN_ID),
                name: clipped(&name, MOST_OF_A_NAME),
                canvas_id: kept(cell(canvas_id)),
                sis_user_id,
                sis_login_id,
                section,
                moodle_id: moodle_id.map(|id| id.rsplit(' ').next().unwrap_or_default().to_owned()),
                email,
                group,
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
        self.index(&student);
        self.students.push(student);
    }

    fn index(&mut self, student: &RosterStudent) {
        let mut keys = Vec::new();
        for other in [&student.sis_user_id, &student.sis_login_id, &student.email].into_iter().flatten() {
            keys.push((Key::Identifier, folded_id(other)));
        }
        let words = name_words(&student.name);
        for turn in 0..words.len().min(MOST_TURNS) {
            keys.push((Key::RunTogether, [&words[turn..], &words[..turn]].concat().concat()));
        }
        keys.push((Key::Name, sorted(words).join(" ")));
        keys.extend(student.canvas_id.iter().map(|id| (Key::Canvas, id.clone())));
        keys.extend(student.moodle_id.iter().map(|id| (Key::Moodle, id.clone())));
        keys.sort();
        keys.dedup();
        let at = self.students.len();
        for group in student.group.iter().flat_map(|groups| groups.split(',')).map(folded_id) {
            let members = self.by_group.entry(group).or_default();
            if members.last() != Some(&at) {
                members.push(at);
            }
        }
        self.by_group.remove("");
        for key in keys.into_iter().filter(|(_, text)| !text.is_empty()) {
            self.by_other.entry(key).and_modify(|other| *other = None).or_insert(Some(at));
        }
    }

    /// The student of an id, however it is spelled; or of an SIS id, a login or an e-mail address that only one has.
    pub fn find(&self, id: &str) -> Option<&RosterStudent> {
        let folded = folded_id(id);
        match self.by_folded.get(&folded) {
            Some(at) => self.students.get(*at),
            None => self.other(Key::Identifier, folded),
        }
    }

    /// The only student of this name, its words in any order.
    pub fn find_by_name(&self, name: &str) -> Option<&RosterStudent> {
        self.other(Key::Name, sorted(name_words(name)).join(" "))
    }

    /// The only student whose name, run together, is this: as Canvas writes it.
    pub fn find_by_letters(&self, letters: &str) -> Option<&RosterStudent> {
        self.other(Key::RunTogether, name_words(letters).concat())
    }

    pub fn find_by_canvas_id(&self, id: &str) -> Option<&RosterStudent> {
        self.other(Key::Canvas, id.to_owned())
    }

    pub fn find_by_moodle_id(&self, id: &str) -> Option<&RosterStudent> {
        self.other(Key::Moodle, id.to_owned())
    }

    /// Who is in a group of this name, of which only letters and digits count: Canvas leaves out the rest.
    pub fn group(&self, name: &str) -> Vec<&RosterStudent> {
        let members = self.by_group.get(&folded_id(name)).into_iter().flatten();
        members.filter_map(|at| self.students.get(*at)).collect()
    }

    fn other(&self, key: Key, text: String) -> Option<&RosterStudent> {
        self.students.get((*self.by_other.get(&(key, text))?)?)
    }
}

/// Words of a name in small letters, without accents and signs: what is left when systems have passed it on.
pub fn name_words(name: &str) -> Vec<String> {
    let plain = |word: &str| -> String {
        let letters = word.nfkd().filter(|c| c.is_alphanumeric()).collect::<String>();
        letters.to_lowercase()
    };
    let words = name.split(|c: char| c.is_whitespace() || matches!(c, ',' | '_' | '.' | '-'));
    words.map(plain).filter(|word| !word.is_empty()).collect()
}

fn sorted(mut words: Vec<String>) -> Vec<String> {
    words.sort();
    words
}

/// `Doe, Jane` as Canvas sorts it.
fn given_name_first(name: &str) -> String {
    match name.split_once(',') {
        Some((family, given)) if !given.contains(',') => format!("{} {}", given.trim(), family.trim()),
        _ => name.to_owned(),
    }
}

/// Rows of Canvas' gradebook that are about no student: points possible, how marks are posted, and the test student.
fn is_no_student(name: &str, canvas_id: &str) -> bool {
    (name.is_empty() && canvas_id.is_empty())
        || name.eq_ignore_ascii_case("points possible")
        || name.eq_ignore_ascii_case("student, test")
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
    fn lists_of_an_lms_are_lists() {
        let canvas = parse(
            "Student,ID,SIS User ID,SIS Login ID,Section,Lab 3 (77)\n,,,,,Manual Posting\n    Points Possible,,,,,45\n\
             \"Doe, Jane\",11,EE-1,jdoe,A,3\n\"Smith, Bob\",12,,bsmith,A,\n\"Poe, Ann\",13,,,B,\n\"Student, Test\",99,,abc,A,\n",
        );
        let canvas = canvas.unwrap();
        let found: Vec<_> = canvas.students.iter().map(|s| (s.id.as_str(), s.name.as_str())).collect();
        assert_eq!(found, [("EE-1", "Jane Doe"), ("bsmith", "Bob Smith"), ("13", "Ann Poe")]);
        assert_eq!(canvas.warnings, [""; 0]);
        for (who, found) in [
            (canvas.find("ee1"), Some("EE-1")),
            (canvas.find("JDOE"), Some("EE-1")),
            (canvas.find("11"), None),
            (canvas.find_by_canvas_id("11"), Some("EE-1")),
            (canvas.find_by_letters("doejane"), Some("EE-1")),
            (canvas.find_by_name("Doe Jane"), Some("EE-1")),
            (canvas.find_by_name("Jane"), None),
        ] {
            assert_eq!(who.map(|student| student.id.as_str()), found);
        }
        let moodle = parse(
            "Identifier,\"Full name\",\"ID number\",\"Email address\",Status,Group\nParticipant 501,Jane Doe,,jane@x.org,,\"A, B\"\n\
             Participant 502,Jane Doe,EE-2,j2@x.org,,B\nParticipant 503,,,,,\n",
        );
        let moodle = moodle.unwrap();
        let found: Vec<_> = moodle.students.iter().map(|s| (s.id.as_str(), s.moodle_id.as_deref())).collect();
        assert_eq!(
            found,
            [("jane@x.org", Some("501")), ("EE-2", Some("502")), ("Participant 503", Some("503"))]
        );
        assert_eq!(moodle.find_by_name("Jane Doe"), None, "two have this name");
        assert_eq!(moodle.find_by_moodle_id("502").map(|one| one.id.as_str()), Some("EE-2"));
        assert_eq!((moodle.group("b").len(), moodle.group("A").len(), moodle.group("").len()), (2, 1, 0));
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
                "id;name\nEE-1;A\nEE-2;\"B\nEE-3;C\n",
                "roster.csv:3: this is not CSV: a quote is not closed, and everybody after it would be lost",
            ),
            (
                "",
                "roster.csv:1: no column is called `id`: the first line names the columns, such as `id,name`; it is empty",
            ),
        ] {
            assert_eq!(parse(text).unwrap_err().to_string(), message);
        }
    }
}
