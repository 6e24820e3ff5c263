use super::ExportError;
use crate::class::{GradebookCell, Record, Status, gradebook_columns, gradebook_row};
use crate::lab::Points;
use crate::source::sanitize;
use rust_xlsxwriter::{DocProperties, ExcelDateTime, Format, FormatAlign, Workbook, Worksheet, XlsxError};
use std::io::{Seek, Write};
use std::path::Path;

/// A workbook for spreadsheets with three sheets, each with a header that stays in sight and can be filtered.
///
/// *Marks* is `gradebook.csv`, a row a student; points are numbers, and what somebody typed is text, never a formula or a link.
/// *Items* has for each criterion its facility, earned ÷ possible points over the submissions that were marked, and how many
/// were right, partly right, wrong and so on. *Review* lists what waits for a person.
///
/// Rows go to temporary files in `scratch` as they come, so that a class of any size fits in memory. Same records, same bytes: the date
/// of creation is fixed. Errors: more rows than a sheet holds (1,048,576).
/// Source: ECMA-376 by way of `rust_xlsxwriter`; inline strings are never read as formulas.
pub fn write_workbook<W: Write + Seek + Send>(
    records: impl Iterator<Item = Result<Record, ExportError>>,
    scratch: &Path,
    writer: W,
) -> Result<usize, ExportError> {
    let mut workbook = Workbook::new();
    workbook.set_tempdir(scratch)?;
    let created = ExcelDateTime::from_ymd(2000, 1, 1)?;
    workbook.set_properties(&DocProperties::new().set_creation_datetime(&created));
    let mut marks = Sheet::new(workbook.new_worksheet_with_constant_memory()?, "Marks")?;
    let mut review = Sheet::new(workbook.new_worksheet_with_constant_memory()?, "Review")?;
    let mut items = Sheet::new(workbook.new_worksheet_with_constant_memory()?, "Items")?;
    let mut facility = Vec::new();
    for record in records {
        let record = record?;
        if marks.row == 0 {
            let columns = gradebook_columns(&record);
            marks.header(&columns, |at, name| match at {
                1 | 2 => 28.0,
                0 => 16.0,
                _ => (name.chars().count() as f64 + 3.0).clamp(9.0, 30.0),
            })?;
            review.header(&REVIEW.map(str::to_owned), |at, _| {
                [16.0, 28.0, 28.0, 34.0, 10.0, 10.0, 40.0, 60.0][at.min(7)]
            })?;
        }
        for student in &record.students {
            marks.line(&gradebook_row(&record, student))?;
        }
        for (item, waits) in record.to_review() {
            let students = |of: fn(&crate::class::StudentRecord) -> &String| {
                let names: Vec<&str> = record.students.iter().map(|student| of(student).as_str()).collect();
                GradebookCell::Text(names.join(", "))
            };
            review.line(&[
                students(|student| &student.id),
                students(|student| &student.name),
                GradebookCell::Text(record.file.clone()),
                GradebookCell::Text(item.id.clone()),
                GradebookCell::Points(Some(item.earned)),
                GradebookCell::Points(Some(item.possible)),
                GradebookCell::Text(waits.why.clone()),
                GradebookCell::Text(waits.answer.clone()),
            ])?;
        }
        if record.status == Status::Marked {
            add_items(&mut facility, &record);
        }
    }
    if marks.row == 0 {
        return Err(ExportError::Empty);
    }
    write_items(&mut items, &facility)?;
    let students = marks.row.saturating_sub(1) as usize;
    for sheet in [marks, items, review] {
        workbook.push_worksheet(sheet.finish()?);
    }
    workbook.save_to_writer(writer)?;
    Ok(students)
}

const REVIEW: [&str; 8] =
    ["student_id", "student_name", "submission", "item", "earned", "possible", "why", "answer_begins"];

const VERDICTS: [&str; 6] = ["right", "partly", "wrong", "blank", "unreadable", "unmarked"];

/// A criterion over the class, in the order of the lab.
struct Item {
    id: String,
    earned: Points,
    possible: Points,
    submissions: usize,
    verdicts: [usize; 6],
    provisional: usize,
}

fn add_items(items: &mut Vec<Item>, record: &Record) {
    for (at, one) in record.items.iter().enumerate() {
        // Every record of a lab has the same criteria in the same order.
        let place = match items.get(at) {
            Some(item) if item.id == one.id => Some(at),
            _ => items.iter().position(|item| item.id == one.id),
        };
        let place = place.unwrap_or_else(|| {
            items.push(Item {
                id: one.id.clone(),
                earned: Points::ZERO,
                possible: Points::ZERO,
                submissions: 0,
                verdicts: [0; 6],
                provisional: 0,
            });
            items.len() - 1
        });
        let item = &mut items[place];
        item.earned += one.earned;
        item.possible += one.possible;
        item.submissions += 1;
        item.provisional += usize::from(one.provisional);
        if let Some(verdict) = VERDICTS.iter().position(|verdict| *verdict == one.verdict) {
            item.verdicts[verdict] += 1;
        }
    }
}

fn write_items(sheet: &mut Sheet, items: &[Item]) -> Result<(), XlsxError> {
    let mut columns = ["item", "facility", "submissions"].map(str::to_owned).to_vec();
    columns.extend(VERDICTS.map(str::to_owned));
    columns.push("provisional".to_owned());
    sheet.header(&columns, |at, _| if at == 0 { 34.0 } else { 13.0 })?;
    for item in items {
        let row = sheet.row;
        sheet.text(0, &item.id)?;
        if item.possible.0 > 0 {
            let facility = item.earned.0 as f64 / item.possible.0 as f64;
            sheet.sheet.write_number_with_format(row, 1, facility, &sheet.percent)?;
        }
        for (count, at) in
            std::iter::once(&item.submissions).chain(&item.verdicts).chain([&item.provisional]).zip(2..)
        {
            sheet.sheet.write_number(row, at, *count as f64)?;
        }
        sheet.row += 1;
    }
    Ok(())
}

/// A sheet that grows by rows.
struct Sheet {
    sheet: Worksheet,
    row: u32,
    columns: u16,
    bold: Format,
    percent: Format,
}

impl Sheet {
    fn new(mut sheet: Worksheet, name: &str) -> Result<Self, XlsxError> {
        sheet.set_name(name)?;
        Ok(Self {
            sheet,
            row: 0,
            columns: 0,
            bold: Format::new().set_bold().set_text_wrap().set_align(FormatAlign::Top),
            percent: Format::new().set_num_format("0%"),
        })
    }

    fn header(&mut self, columns: &[String], width: impl Fn(usize, &str) -> f64) -> Result<(), XlsxError> {
        self.sheet.set_freeze_panes(1, 0)?;
        for (at, (name, column)) in columns.iter().zip(0_u16..).enumerate() {
            self.sheet.set_column_width(column, width(at, name))?;
        }
        for (name, column) in columns.iter().zip(0_u16..) {
            self.sheet.write_string_with_format(self.row, column, shown(name), &self.bold)?;
            self.columns = column + 1;
        }
        self.row += 1;
        Ok(())
    }

    fn line(&mut self, cells: &[GradebookCell]) -> Result<(), XlsxError> {
        for (cell, column) in cells.iter().zip(0_u16..) {
            match cell {
                GradebookCell::Text(text) => self.text(column, text)?,
                GradebookCell::Points(Some(points)) => {
                    self.sheet.write_number(self.row, column, points.as_f64())?;
                }
                GradebookCell::Points(None) => {}
                GradebookCell::Count(count) => {
                    self.sheet.write_number(self.row, column, *count as f64)?;
                }
            }
        }
        self.row += 1;
        Ok(())
    }

    fn text(&mut self, column: u16, text: &str) -> Result<(), XlsxError> {
        if !text.is_empty() {
            self.sheet.write_string(self.row, column, shown(text))?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Worksheet, XlsxError> {
        if self.columns > 0 {
            self.sheet.autofilter(0, 0, self.row.saturating_sub(1), self.columns - 1)?;
        }
        Ok(self.sheet)
    }
}

/// One line without control characters, at most as long as a cell may be (32,767 units of UTF-16).
fn shown(text: &str) -> String {
    let clean = sanitize(text);
    if clean.len() <= 32_767 { clean } else { clean.chars().take(16_000).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gradebook::tests::record;
    use std::collections::BTreeMap;
    use std::io::{Cursor, Read};

    fn written(records: Vec<Record>) -> Vec<u8> {
        let scratch = tempfile::tempdir().unwrap();
        let mut bytes = Cursor::new(Vec::new());
        write_workbook(records.into_iter().map(Ok), scratch.path(), &mut bytes).unwrap();
        bytes.into_inner()
    }

    /// The XML files of a workbook.
    fn parts(bytes: &[u8]) -> BTreeMap<String, String> {
        let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let mut parts = BTreeMap::new();
        for at in 0..zip.len() {
            let mut file = zip.by_index(at).unwrap();
            let mut text = String::new();
            file.read_to_string(&mut text).unwrap();
            let name = file.name().unwrap().into_owned();
            parts.insert(name, text);
        }
        parts
    }

    #[test]
    fn text_is_text_and_points_are_numbers() {
        let mut hostile = record("EE-001", "=HYPERLINK(\"http://x\",\"y\")");
        hostile.students[0].id = "@SUM(A1)".to_owned();
        hostile.file = "https://x.example/<b>\u{1b}]0;x\u{7}".to_owned();
        let parts = parts(&written(vec![hostile, record("EE-002", "John")]));
        let marks = &parts["xl/worksheets/sheet1.xml"];
        assert!(!marks.contains("<f>") && !marks.contains("<hyperlink"), "{marks}");
        for text in [
            "t=\"inlineStr\"><is><t>@SUM(A1)</t></is>",
            "<t>=HYPERLINK(&quot;http://x&quot;,&quot;y&quot;)</t>",
            "<t>https://x.example/&lt;b&gt;\u{fffd}]0;x\u{fffd}</t>",
            "<t>cover.total [10]</t>",
            "<v>7.5</v>",
            "ySplit=\"1\"",
            "<autoFilter ref=\"A1:",
        ] {
            let other = text.replace("&quot;", "\"");
            assert!(marks.contains(text) || marks.contains(&other), "{text} in {marks}");
        }
        let items = &parts["xl/worksheets/sheet2.xml"];
        assert!(items.contains("<t>q.a</t>") && items.contains("<v>0.625</v>"), "{items}");
        assert!(parts["docProps/core.xml"].contains("2000-01-01T00:00:00Z"));
        let names = ["Marks", "Items", "Review"].map(|name| parts["xl/workbook.xml"].find(name).unwrap());
        assert!(names.is_sorted());
    }

    #[test]
    fn same_records_same_bytes() {
        let class = || (0..50).map(|n| record(&format!("EE-{n:03}"), "A")).collect::<Vec<_>>();
        assert_eq!(written(class()), written(class()));
        assert!(matches!(
            write_workbook(std::iter::empty(), Path::new("."), Cursor::new(Vec::new())),
            Err(ExportError::Empty)
        ));
    }
}
