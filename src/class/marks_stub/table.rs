use super::MarksStub;
use crate::class::gradebook::disarmed;
use crate::grading::NO_ANSWER;
use crate::source::{DecodeError, StrayQuote, decode_within, sanitize, separator, stray_quote};
use std::collections::BTreeSet;

/// The first columns are read, the others are for the reader.
const COLUMNS: [&str; 12] = [
    "student_id",
    "item",
    "group",
    "points",
    "reason",
    "answer",
    "student_name",
    "possible",
    "polemark_gave",
    "why",
    "answer_begins",
    "levels",
];

/// So many columns are read.
const READ: usize = 6;

/// A marks table may be this large, in bytes.
const MOST_BYTES: usize = 64 << 20;

/// Why a table is not added to. Full sentences but for the full stop.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StubError {
    #[error("it cannot be added to: {0}")]
    NotText(DecodeError),
    #[error("it cannot be added to, since line {line} is not CSV: {what}")]
    NotCsv { line: u64, what: String },
    #[error("it cannot be added to: its first line must have the columns {}", COLUMNS[..READ].join(", "))]
    NoColumns,
    #[error("it cannot be added to: it is not in UTF-8")]
    NotUtf8,
}

/// `before`, a marks table (empty for none), byte for byte, and after it the rows of `stub` that it does not have yet; the second
/// is how many these are. Rows are the same by student, item, group and answer.
pub fn appended(before: &[u8], stub: &MarksStub) -> Result<(Vec<u8>, usize), StubError> {
    let text = decode_within(before, MOST_BYTES).map_err(StubError::NotText)?;
    if std::str::from_utf8(before).is_err() {
        return Err(StubError::NotUtf8);
    }
    let is_new = text.trim().is_empty();
    let delimiter = if is_new { b',' } else { separator(text.as_bytes()) };
    if let Some(StrayQuote::NotClosed(at) | StrayQuote::GoesOn(at)) = stray_quote(text.as_bytes(), delimiter)
    {
        let line = 1 + text[..at].matches('\n').count() as u64;
        return Err(StubError::NotCsv {
            line,
            what: "a quote is not closed, or not at the end of its cell".to_owned(),
        });
    }
    let (columns, there) = if is_new { own_columns() } else { columns_and_rows(&text, delimiter)? };
    let ending = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut out = before.to_vec();
    let line = |cells: &[String], out: &mut Vec<u8>| {
        let cells: Vec<String> = cells.iter().map(|cell| quoted(cell, delimiter)).collect();
        out.extend(cells.join(&char::from(delimiter).to_string()).as_bytes());
        out.extend(ending.as_bytes());
    };
    if is_new {
        // By this mark Excel knows that it is UTF-8, and saves it so.
        if before.is_empty() {
            out.extend("\u{feff}".as_bytes());
        }
        line(&COLUMNS.map(str::to_owned), &mut out);
    } else if !text.ends_with(['\n', '\r']) {
        out.extend(ending.as_bytes());
    }
    let mut added = 0;
    for row in stub.rows() {
        if there.contains(&key(&row[0], &row[1], &row[2], &row[5])) {
            continue;
        }
        let cells: Vec<String> = columns
            .iter()
            .map(|column| column.map_or_else(String::new, |place| disarmed(&row[place])))
            .collect();
        line(&cells, &mut out);
        added += 1;
    }
    Ok((out, added))
}

impl MarksStub {
    /// A row for each question to a person, its cells as [`COLUMNS`] names them.
    fn rows(&self) -> Vec<[String; 12]> {
        let mut rows = Vec::new();
        let row = |cells: [&str; 12]| cells.map(|cell| cell.replace(['\r', '\n'], " "));
        for (file, message) in &self.files {
            rows.push(row(["", "is", "", "", "", file, "", "", "", message, "", ""]));
        }
        for (item, id, group) in self.ordered_groups() {
            let about = &group.about;
            let why = format!("{}: {}", super::answers(group.count), about.why);
            let (possible, given) = (about.possible.to_string(), about.given.to_string());
            let answers: Vec<String> = group.listed_answers().into_iter().map(as_text).collect();
            let answers = answers.join(" ");
            let (points, reason) = self.filled_in(about);
            rows.push(row([
                "",
                item,
                id,
                &points,
                reason,
                &answers,
                "",
                &possible,
                &given,
                &why,
                &about.begins,
                "",
            ]));
        }
        for student in self.asked() {
            let (id, name) = (student.id.as_str(), student.name.as_str());
            if student.which_counts {
                let files = self.files_of(student).join(" or ");
                rows.push(row([id, "counts", "", "", "", "", name, "", "", "which file counts", &files, ""]));
            }
            for place in &student.cover {
                let part = &self.lab.by_hand[*place];
                rows.push(row([id, &part.id, "", "", "", "", name, &part.possible, "", &part.title, "", ""]));
            }
            for place in &student.observed {
                let part = &self.lab.observed[*place];
                let item = format!("observed.{}", part.id);
                let level = |level: &super::super::run_facts::LevelFacts| {
                    format!("{} {}: {}", level.points, level.title, level.text)
                };
                let levels = part.levels.iter().map(level).collect::<Vec<_>>().join(" | ");
                rows.push(row([
                    id,
                    &item,
                    "",
                    "",
                    "",
                    "",
                    name,
                    &part.possible,
                    "",
                    &part.title,
                    "",
                    &levels,
                ]));
            }
            for (item, answer, about) in &student.items {
                let (possible, given) = (about.possible.to_string(), about.given.to_string());
                let (points, reason) = self.filled_in(about);
                rows.push(row([
                    id,
                    item,
                    "",
                    &points,
                    reason,
                    &as_text(answer),
                    name,
                    &possible,
                    &given,
                    &about.why,
                    &about.begins,
                    "",
                ]));
            }
        }
        rows
    }
}

/// A hash as a spreadsheet leaves it alone: `0350511776412266` and `35e11` would be numbers to it.
fn as_text(hash: &str) -> String {
    if hash == NO_ANSWER { hash.to_owned() } else { format!("#{hash}") }
}

type Key = (String, String, String, String);

fn key(student: &str, item: &str, group: &str, answer: &str) -> Key {
    let cell = |text: &str| disarmed(text.trim());
    // Which file counts is filled in there.
    let answer = if item.trim() == "counts" { String::new() } else { cell(&answer.replace('#', "")) };
    // Whose a file is, is filled in before.
    let student = if item.trim() == "is" { String::new() } else { cell(student) };
    (student, cell(item), cell(group), answer)
}

fn own_columns() -> (Vec<Option<usize>>, BTreeSet<Key>) {
    ((0..COLUMNS.len()).map(Some).collect(), BTreeSet::new())
}

/// For each column of a table which of ours it is, and the keys of its rows.
fn columns_and_rows(text: &str, delimiter: u8) -> Result<(Vec<Option<usize>>, BTreeSet<Key>), StubError> {
    let mut table = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let not_csv = |error: &csv::Error| StubError::NotCsv {
        line: error.position().map_or(1, csv::Position::line),
        what: sanitize(&error.to_string()),
    };
    let header = table.headers().map_err(|error| not_csv(&error))?.clone();
    let folded = header.iter().map(|name| name.to_lowercase().replace([' ', '-'], "_"));
    let columns: Vec<Option<usize>> =
        folded.map(|name| COLUMNS.iter().position(|column| *column == name)).collect();
    let place = |column: usize| columns.iter().position(|one| *one == Some(column));
    if (0..READ).any(|column| place(column).is_none()) {
        return Err(StubError::NoColumns);
    }
    let mut keys = BTreeSet::new();
    for record in table.records() {
        let record = record.map_err(|error| not_csv(&error))?;
        let cell = |column: usize| place(column).and_then(|place| record.get(place)).unwrap_or_default();
        keys.insert(key(cell(0), cell(1), cell(2), cell(5)));
    }
    Ok((columns, keys))
}

fn quoted(cell: &str, delimiter: u8) -> String {
    match cell.contains(['"', '\n', '\r', ' ', ',', ';', '\t']) || cell.contains(char::from(delimiter)) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.to_owned(),
    }
}
