use super::allowed::{Allowed, Findings, apart};
use super::{
    Adjustment, AlikeMarks, HandMarks, HandMarksFile, LateCost, LateRule, Override, identity, quoted,
};
use crate::lab::Points;
use crate::source::{Finding, SourceText, Span, StrayQuote, sanitize, separator, stray_quote};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Columns of a marks file in CSV, in the order polemark writes them. Others are the reader's own and are not read.
pub const COLUMNS: [&str; 6] = ["student_id", "item", "group", "points", "reason", "answer"];

/// Reads a marks file in CSV, a row a decision. Where `points` is empty nothing is given yet.
///
/// `item` is a criterion; `viva` or another box of the cover sheet that is filled by hand; `observed.<row>`; `adjustment`; `late`
/// (points, `10 %`, or `no` for one student); `counts` and `is`, with a file's name in the column `answer`. Without a student id and
/// with a `group` it is about like answers. The separator is what the first line has: comma, semicolon or tab.
pub fn read(source: &SourceText, allowed: Allowed<'_>) -> (HandMarksFile, Vec<Finding>) {
    let mut reader = Reader { allowed, findings: Findings::default(), seen: BTreeMap::new() };
    let file = reader.file(&source.text);
    (file, reader.findings.0)
}

struct Reader<'a> {
    allowed: Allowed<'a>,
    findings: Findings,
    /// For each (student, item, group) that is decided so far, for which answers: none stands for any.
    seen: BTreeMap<(String, String, String), BTreeSet<BTreeSet<String>>>,
}

/// One row, its cells without spaces around.
struct Row {
    student: String,
    item: String,
    group: String,
    points: String,
    reason: String,
    answer: String,
    span: Span,
}

impl Reader<'_> {
    fn file(&mut self, text: &str) -> HandMarksFile {
        let mut file = HandMarksFile::default();
        let mark = text.len() - text.trim_start_matches('\u{feff}').len();
        let body = &text[mark..];
        let delimiter = separator(body.as_bytes());
        if let Some(quote) = stray_quote(body.as_bytes(), delimiter) {
            self.stray_quote(quote, text, mark);
            return file;
        }
        let mut table = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(body.as_bytes());
        let header = match table.headers() {
            Ok(header) => header.clone(),
            Err(error) => {
                self.not_csv(&error, text, 0);
                return file;
            }
        };
        let folded: Vec<String> =
            header.iter().map(|name| name.to_lowercase().replace([' ', '-'], "_")).collect();
        let column = |name: &str| folded.iter().position(|one| one == name);
        let places = COLUMNS.map(column);
        if places[1].is_none() || places[3].is_none() {
            let message = format!(
                "A table of marks has a first line with the columns {}.",
                COLUMNS.map(|name| format!("`{name}`")).join(", ")
            );
            self.findings.report(Some(line_at(text, mark)), "marks.shape", message, None);
            return file;
        }
        let mut alike = AlikeMarks::new();
        let mut record = csv::StringRecord::new();
        loop {
            let from = mark + usize::try_from(table.position().byte()).unwrap_or(0);
            match table.read_record(&mut record) {
                Ok(false) => break,
                Ok(true) => {}
                Err(error) => {
                    self.not_csv(&error, text, from);
                    break;
                }
            }
            let at =
                record.position().map_or(from, |place| mark + usize::try_from(place.byte()).unwrap_or(0));
            let cell = |place: usize| {
                let cell = places[place].and_then(|place| record.get(place)).unwrap_or_default();
                armed(cell).to_owned()
            };
            let row = Row {
                student: cell(0),
                item: cell(1),
                group: cell(2),
                points: cell(3),
                reason: cell(4),
                answer: cell(5),
                span: line_at(text, at),
            };
            let comma = delimiter == b',';
            if record.len() > header.len() && record.iter().any(|cell| !cell.is_empty()) {
                let (found, wanted) = (record.len(), header.len());
                let message = format!("This row has {found} cells, the first line has {wanted}.");
                let help = "Put a cell with a separator in it into quotes: `\"1,5\"`.";
                self.findings.report(Some(row.span), "marks.csv", message, Some(help));
                continue;
            }
            // `1,5` in a table with commas.
            if comma
                && !row.points.is_empty()
                && row.reason.bytes().all(|byte| byte.is_ascii_digit())
                && !row.reason.is_empty()
            {
                let (points, part) = (quoted(&row.points), quoted(&row.reason));
                let message = format!("The points are {points} and the reason is only {part}.");
                let help = "For a decimal comma write a point, or put the number into quotes; else say why in words.";
                self.findings.report(Some(row.span), "marks.points_unreadable", message, Some(help));
                continue;
            }
            self.row(&row, &mut file, &mut alike);
        }
        file.others.alike = Arc::new(alike);
        file
    }

    fn not_csv(&mut self, error: &csv::Error, text: &str, at: usize) {
        let message = format!("This table cannot be read: {}.", sanitize(&error.to_string()));
        self.findings.report(Some(line_at(text, at)), "marks.csv", message, None);
    }

    /// Rows may have gone into a cell, and with them marks: nothing of the table is read.
    fn stray_quote(&mut self, quote: StrayQuote, text: &str, mark: usize) {
        let (at, message) = match quote {
            StrayQuote::NotClosed(at) => (at, "This quote is not closed: every row after it would be lost."),
            StrayQuote::GoesOn(at) => (at, "Behind the closing quote of this cell stands more text."),
        };
        let help = "Put a quote at both ends of the cell, and write a quote inside it twice.";
        self.findings.report(Some(line_at(text, mark + at)), "marks.csv", message.to_owned(), Some(help));
    }

    /// Whether a decision was made before, for the same answers or for any.
    fn is_twice(&mut self, row: &Row) -> bool {
        let Row { student, item, group, answer, .. } = row;
        let of_file = if item == "is" { answer.as_str() } else { "" };
        let key = (identity(student), item.clone(), format!("{group}{of_file}"));
        let answers: BTreeSet<String> = match self.allowed.items.contains_key(item.as_str()) {
            true => apart(answer).collect(),
            false => BTreeSet::new(),
        };
        let before = self.seen.entry(key).or_default();
        let for_any = answers.is_empty() && !before.is_empty() || before.contains(&BTreeSet::new());
        !before.insert(answers) || for_any
    }

    fn row(&mut self, row: &Row, file: &mut HandMarksFile, alike: &mut AlikeMarks) {
        let Row { student, item, group, points, reason, answer, span } = row;
        if [student, item, group, points].into_iter().all(String::is_empty) {
            return;
        }
        let given = !points.is_empty();
        let said = given || (matches!(item.as_str(), "is" | "counts") && !answer.is_empty());
        if item.is_empty() {
            let help =
                "The column `item` has a criterion, `viva`, `observed.<row>` or another name from the stub.";
            let message = "What these points are for is missing.".to_owned();
            self.findings.report(Some(*span), "marks.shape", message, Some(help));
            return;
        }
        if !given && !reason.is_empty() && !matches!(item.as_str(), "is" | "counts") {
            let message = format!("{} has a reason and no points: it is not given yet.", quoted(item));
            self.findings.0.push(Finding::warning("marks.points_missing", message).at(*span));
        }
        if said && item != "adjustment" && self.is_twice(row) {
            self.findings.twice(*span, &format!("{} is decided", quoted(item)));
        }
        if given && (student.is_empty() || group.is_empty()) {
            let who = if student.is_empty() { String::new() } else { identity(student) };
            file.said.insert((who, item.clone()), (*span).into());
        }
        match (item.as_str(), student.is_empty(), group.is_empty()) {
            ("late", true, _) => {
                if given {
                    file.others.late_rule = self.late_rule(points, reason, *span);
                }
            }
            (_, true, false) => {
                let Some(most) = self.criterion(item, *span) else { return };
                file.groups.insert((item.clone(), group.clone()), (*span).into());
                let name = format!("{item}/{group}");
                if let Some(given) = self.decision(row, (Points::ZERO, most), &name) {
                    alike.entry(item.clone()).or_default().entry(group.clone()).or_default().push(given);
                }
            }
            (_, true, true) => {
                let message = "Whose mark this is, is missing.".to_owned();
                let help = "Give a student's id, or the group of like answers.";
                self.findings.report(Some(*span), "marks.shape", message, Some(help));
            }
            ("is", false, _) => {
                if !answer.is_empty() {
                    let (students, _) =
                        file.files.entry(answer.clone()).or_insert((Vec::new(), (*span).into()));
                    students.push(student.clone());
                }
            }
            ("counts", false, _) => {
                if !answer.is_empty() {
                    file.counts.insert(identity(student), (answer.clone(), (*span).into()));
                }
            }
            _ => self.of_student(row, file),
        }
    }

    fn of_student(&mut self, row: &Row, file: &mut HandMarksFile) {
        let Row { student, item, points, span, .. } = row;
        let (box_of_cover, row_name) =
            (self.allowed.cover.get(item.as_str()), item.strip_prefix("observed."));
        let observed = row_name.map(|name| (name, self.allowed.observed.get(name).copied()));
        let range = |most| (Points::ZERO, most);
        let (_, marks) =
            file.students.entry(identity(student)).or_insert_with(|| (student.clone(), HandMarks::default()));
        match (item.as_str(), box_of_cover.copied(), observed) {
            (_, Some(most), _) => {
                if let Some(points) = self.points(points, *span, range(most), item) {
                    marks.cover.insert(item.clone(), points);
                }
            }
            (_, _, Some((name, Some(most)))) => {
                if let Some(points) = self.points(points, *span, range(most), item) {
                    marks.observed.insert(name.to_owned(), points);
                }
            }
            (_, _, Some((name, None))) => {
                let known = self.allowed.observed.keys().copied();
                self.findings.unknown(name, *span, known, "row of the observation sheet");
            }
            ("adjustment", ..) => {
                let most = self.allowed.total;
                if let Some(given) = self.decision(row, (Points::ZERO - most, most), item) {
                    marks.adjustments.push(Adjustment { points: Some(given.points), reason: given.reason });
                }
            }
            ("late", ..) => match points.to_lowercase().as_str() {
                "" => {}
                "yes" | "true" => marks.late = Some(true),
                "no" | "false" => marks.late = Some(false),
                _ => {
                    let message = format!("Whether {} is late is `yes` or `no`.", quoted(student));
                    self.findings.report(Some(*span), "marks.shape", message, None);
                }
            },
            _ => {
                let Some(most) = self.criterion(item, *span) else { return };
                if let Some(given) = self.decision(row, range(most), item) {
                    marks.items.entry(item.clone()).or_default().push(given);
                }
            }
        }
    }

    fn late_rule(&mut self, points: &str, reason: &str, span: Span) -> Option<LateRule> {
        let (cost, words) = match points.strip_suffix('%') {
            Some(percent) => {
                let percent = self.points(percent.trim(), span, (Points::ZERO, Points(10_000)), "late")?;
                (LateCost::Percent(percent), format!("handed in late: {percent} % of what was earned"))
            }
            None => {
                let points = self.points(points, span, (Points::ZERO, self.allowed.total), "late")?;
                (LateCost::Points(points), "handed in late".to_owned())
            }
        };
        Some(LateRule { cost, reason: if reason.is_empty() { words } else { reason.to_owned() } })
    }

    fn criterion(&mut self, item: &str, span: Span) -> Option<Points> {
        let most = self.allowed.items.get(item).copied();
        if most.is_none() {
            let others = ["adjustment", "late", "counts", "is"].into_iter();
            let rows: Vec<String> =
                self.allowed.observed.keys().map(|row| format!("observed.{row}")).collect();
            let known = self.allowed.cover.keys().chain(self.allowed.items.keys()).copied().chain(others);
            self.findings.unknown(item, span, known.chain(rows.iter().map(String::as_str)), "criterion");
        }
        most
    }

    /// `None` while it is not given, too.
    fn decision(&mut self, row: &Row, range: (Points, Points), id: &str) -> Option<Override> {
        if row.points.is_empty() {
            return None;
        }
        let points = self.points(&row.points, row.span, range, id);
        if row.reason.is_empty() {
            let message = format!("The reason for the mark of `{id}` is missing; the student will read it.");
            let help = "Write it in the column `reason`.";
            self.findings.report(Some(row.span), "marks.reason_missing", message, Some(help));
            return None;
        }
        let answers = self.findings.hashes(&row.answer, row.span);
        Some(Override { points: points?, reason: row.reason.clone(), answers })
    }

    /// A spreadsheet may write a decimal comma.
    fn points(&mut self, text: &str, span: Span, range: (Points, Points), id: &str) -> Option<Points> {
        if text.is_empty() {
            return None;
        }
        self.findings.points(&text.replacen(',', ".", 1), span, range, id)
    }
}

/// Without the apostrophe that keeps a spreadsheet from running a text as a formula.
fn armed(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(rest) if rest.trim_start().starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠']) => rest,
        _ => cell,
    }
}

/// The line that has byte `at`, from there on.
fn line_at(text: &str, at: usize) -> Span {
    let mut start = at.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let skipped = text[start..].len() - text[start..].trim_start_matches(['\r', '\n']).len();
    let start = start + skipped;
    let length = text[start..].find(['\r', '\n']).unwrap_or(text.len() - start);
    Span { start, end: start + length }
}
