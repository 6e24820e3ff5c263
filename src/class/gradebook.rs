use super::Record;
use crate::lab::{LabDefinition, Points};
use std::io::Write;

/// `gradebook.csv`: a row a student, group members each their own.
///
/// Text that a spreadsheet would run as a formula is disarmed with a leading apostrophe.
pub struct Gradebook<W: Write> {
    writer: csv::Writer<W>,
}

impl<W: Write> Gradebook<W> {
    pub fn new(output: W, lab: &LabDefinition) -> Result<Self, csv::Error> {
        let mut writer = csv::Writer::from_writer(output);
        let mut header: Vec<String> =
            ["student_id", "student_name", "submission", "earned", "possible", "provisional"]
                .map(str::to_owned)
                .to_vec();
        header.extend(lab.questions.iter().map(|q| format!("{} [{}]", q.id, q.points)));
        header.extend(lab.observed.iter().map(|row| format!("observed.{} [{}]", row.id, row.points)));
        header.extend(lab.cover.rows.iter().map(|row| format!("cover.{} [{}]", row.id, row.points)));
        header.push(format!("cover.total [{}]", lab.cover.total));
        header.extend(["to_review", "findings", "status", "late", "report"].map(str::to_owned));
        writer.write_record(&header)?;
        Ok(Self { writer })
    }

    pub fn add(&mut self, record: &Record) -> Result<(), csv::Error> {
        let shown = |points: Option<Points>| points.map_or(String::new(), |p| p.to_string());
        let to_review = record.to_review().count().to_string();
        for student in &record.students {
            let mut row = vec![
                disarmed(&student.id),
                disarmed(&student.name),
                disarmed(&record.file),
                record.total.earned.to_string(),
                record.total.possible.to_string(),
                record.total.provisional.to_string(),
            ];
            row.extend(record.questions.iter().map(|q| q.tally.earned.to_string()));
            row.extend(record.observed.iter().map(|row| shown(row.earned)));
            row.extend(record.cover.iter().map(|row| shown(row.earned)));
            row.push(shown(record.cover_total));
            row.push(to_review.clone());
            row.push(record.findings.len().to_string());
            row.push(record.status.as_str().to_owned());
            row.push(if record.is_late() { "yes".to_owned() } else { String::new() });
            row.push(disarmed(&record.report));
            self.writer.write_record(&row)?;
        }
        Ok(())
    }

    pub fn finish(mut self) -> Result<(), std::io::Error> {
        self.writer.flush()
    }
}

/// Spreadsheets run what begins with `=`, `+`, `-`, `@`, a tab or a line end: an apostrophe makes it text. Control
/// characters and those that reverse the reading direction are dropped.
pub(super) fn disarmed(text: &str) -> String {
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
