use super::record::{AdjustmentRecord, BoxRecord, Record, StudentRecord};
use crate::lab::{LabDefinition, Points};
use std::io::Write;

/// `gradebook.csv`: a row a student, group members each their own.
///
/// Text that a spreadsheet would run as a formula is disarmed with a leading apostrophe.
pub struct Gradebook<W: Write> {
    writer: csv::Writer<W>,
}

/// A cell of the gradebook: text is somebody's own, and hostile until it is disarmed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GradebookCell {
    Text(String),
    /// Empty where they are not given yet.
    Points(Option<Points>),
    Count(usize),
}

/// Names of the columns of a class to which `record` belongs.
pub fn gradebook_columns(record: &Record) -> Vec<String> {
    let boxes =
        |rows: &[BoxRecord]| rows.iter().map(|row| (row.id.clone(), row.possible)).collect::<Vec<_>>();
    let questions = record.questions.iter().map(|one| (one.id.clone(), one.tally.possible)).collect();
    let total = record.cover.iter().map(|row| row.possible).sum();
    columns(questions, boxes(&record.observed), boxes(&record.cover), total)
}

fn columns(
    questions: Vec<(String, Points)>,
    observed: Vec<(String, Points)>,
    cover: Vec<(String, Points)>,
    total: Points,
) -> Vec<String> {
    let mut names: Vec<String> =
        ["student_id", "student_name", "submission", "earned", "possible", "provisional"]
            .map(str::to_owned)
            .to_vec();
    names.extend(questions.iter().map(|(id, points)| format!("{id} [{points}]")));
    names.extend(observed.iter().map(|(id, points)| format!("observed.{id} [{points}]")));
    names.extend(cover.iter().map(|(id, points)| format!("cover.{id} [{points}]")));
    names.push(format!("cover.total [{total}]"));
    names.extend(["adjustments".to_owned(), "adjusted_for".to_owned(), format!("mark [{total}]")]);
    names.extend(["to_review", "findings", "status", "late", "report"].map(str::to_owned));
    names
}

/// The row of one of the students of a record.
pub fn gradebook_row(record: &Record, student: &StudentRecord) -> Vec<GradebookCell> {
    use GradebookCell::{Count, Points, Text};
    let mut row = vec![
        Text(student.id.clone()),
        Text(student.name.clone()),
        Text(record.file.clone()),
        Points(Some(record.total.earned)),
        Points(Some(record.total.possible)),
        Points(Some(record.total.provisional)),
    ];
    row.extend(record.questions.iter().map(|one| Points(Some(one.tally.earned))));
    row.extend(record.observed.iter().chain(&record.cover).map(|one| Points(one.earned)));
    row.push(Points(record.cover_total));
    row.push(Points(match record.adjustments.as_slice() {
        [] => None,
        some => some.iter().map(|one| one.points).sum(),
    }));
    row.push(Text(reasons(record)));
    row.push(Points(record.mark.map(|mark| mark.earned)));
    row.push(Count(record.to_review().count()));
    row.push(Count(record.findings.len()));
    row.push(Text(record.status.as_str().to_owned()));
    row.push(Text(if record.is_late() { "yes".to_owned() } else { String::new() }));
    row.push(Text(record.report.clone()));
    row
}

impl GradebookCell {
    fn disarmed(&self) -> String {
        match self {
            Self::Text(text) => disarmed(text),
            Self::Points(points) => points.map_or_else(String::new, |points| points.to_string()),
            Self::Count(count) => count.to_string(),
        }
    }
}

impl<W: Write> Gradebook<W> {
    pub fn new(output: W, lab: &LabDefinition) -> Result<Self, csv::Error> {
        let mut writer = csv::Writer::from_writer(output);
        writer.write_record(columns(
            lab.questions.iter().map(|one| (one.id.clone(), one.points)).collect(),
            lab.observed.iter().map(|one| (one.id.clone(), one.points)).collect(),
            lab.cover.rows.iter().map(|one| (one.id.clone(), one.points)).collect(),
            lab.cover.total,
        ))?;
        Ok(Self { writer })
    }

    pub fn add(&mut self, record: &Record) -> Result<(), csv::Error> {
        for student in &record.students {
            let row = gradebook_row(record, student);
            self.writer.write_record(row.iter().map(GradebookCell::disarmed))?;
        }
        Ok(())
    }

    pub fn finish(mut self) -> Result<(), std::io::Error> {
        self.writer.flush()
    }
}

/// `-5: handed in late; 2: helped others`.
fn reasons(record: &Record) -> String {
    let one = |one: &AdjustmentRecord| {
        let points = one.points.map_or_else(|| "?".to_owned(), |points| points.to_string());
        format!("{}: {}", points, one.reason)
    };
    record.adjustments.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// Spreadsheets run what begins with `=`, `+`, `-`, `@`, a tab or a line end: an apostrophe makes it text. Control
/// characters and those that reverse the reading direction are dropped.
pub fn disarmed(text: &str) -> String {
    let turns =
        |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let clean: String = text.chars().filter(|c| !c.is_control() && !turns(*c)).collect();
    let harmless = !clean.trim_start().starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠']);
    let began_harmless = !text.starts_with(['\t', '\r', '\n']);
    if harmless && began_harmless { clean } else { format!("'{clean}") }
}

#[cfg(test)]
mod tests {
    use super::disarmed;

    #[test]
    fn formulas_become_text() {
        for (typed, written) in [
            ("A. Student", "A. Student"),
            ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
            ("+1", "'+1"),
            ("-1", "'-1"),
            ("@SUM(A1)", "'@SUM(A1)"),
            (" =1", "' =1"),
            ("\t=1", "'=1"),
            ("\r\nx", "'x"),
            ("a\u{1b}[31mb", "a[31mb"),
            ("a\u{202e}b", "ab"),
            ("O'Neil", "O'Neil"),
        ] {
            assert_eq!(disarmed(typed), written, "from {typed:?}");
        }
    }
}
