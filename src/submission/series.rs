use super::Series;
use super::problem::quote;
use crate::source::{Finding, Node, Value};

/// Rows of one data file.
pub(super) const MAX_ROWS: usize = 20_000;
const MAX_COLUMNS: usize = 20;

const CODE: &str = "data.unreadable";
const HELP: &str = "Give time and value on each line, separated by a comma, as in `0.1,0.25`.";

/// Columns of numbers as text: separated by semicolons, tabs, commas or spaces; a header line is optional.
///
/// Where semicolons or tabs separate, `0,5` is one half, as spreadsheets export it. Lines that begin with `#` or `%`
/// are left out. Time, the first column, must not fall.
pub(super) fn parse_series(file_name: &str, text: &str) -> Result<Series, Finding> {
    let fail = |message: String| Finding::error(CODE, message).with_help(HELP);
    let lines = || {
        let worth = |(_, line): &(usize, &str)| !line.is_empty() && !line.starts_with(['#', '%']);
        text.lines().map(str::trim).enumerate().map(|(i, line)| (i + 1, line)).filter(worth)
    };
    let separator = Separator::of(lines().map(|(_, line)| line));
    let mut headers: Option<Vec<String>> = None;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (number, line) in lines() {
        let cells = separator.split(line);
        let values: Vec<Option<f64>> = cells.iter().map(|cell| separator.number(cell)).collect();
        if rows.is_empty() && headers.is_none() && values.first().is_some_and(Option::is_none) {
            headers = Some(cells.iter().map(|cell| cell.chars().take(80).collect()).collect());
            continue;
        }
        if rows.len() == MAX_ROWS {
            return Err(Finding::error(
                "data.too_long",
                format!("The data have more than the {MAX_ROWS} rows that are read."),
            )
            .with_help("Export fewer points: a few hundred show the curve."));
        }
        let mut row = Vec::with_capacity(cells.len());
        for (cell, value) in cells.iter().zip(values) {
            let Some(value) = value else {
                return Err(fail(format!(
                    "Line {number} of the data has {}, which is not a number.",
                    quote(cell)
                )));
            };
            if !value.is_finite() {
                return Err(fail(format!(
                    "Line {number} of the data has {}, which is not finite.",
                    quote(cell)
                )));
            }
            row.push(value);
        }
        let width = rows.first().map_or(row.len(), Vec::len);
        if row.len() < 2 || row.len() > MAX_COLUMNS {
            return Err(fail(format!(
                "Line {number} of the data has {} columns; time and 1 to {} values are read.",
                row.len(),
                MAX_COLUMNS - 1
            )));
        }
        if row.len() != width {
            return Err(fail(format!(
                "Line {number} of the data has {} columns, where the lines before have {width}.",
                row.len()
            )));
        }
        if rows.last().is_some_and(|before| row[0] < before[0]) {
            return Err(Finding::error(
                "data.time_order",
                format!("Line {number} of the data goes back in time, to {}.", quote(cells[0])),
            )
            .with_help("Sort the rows by time, the first column."));
        }
        rows.push(row);
    }
    let Some(first) = rows.first() else {
        return Err(fail("The data have no row of numbers.".to_owned()));
    };
    // Spaces within names (`Time (s)  theta`) leave it open which name stands over which column.
    let headers = headers
        .filter(|names| names.len() == first.len())
        .unwrap_or_else(|| vec![String::new(); first.len()]);
    Ok(Series { file_name: file_name.to_owned(), headers, rows })
}

/// Rows given as a YAML list of lists, as the text they stand for.
pub(super) fn rows_as_text(items: &[Node]) -> Option<String> {
    let mut text = String::new();
    for item in items {
        let Value::Sequence(cells) = &item.value else { return None };
        let cells: Option<Vec<&str>> = cells.iter().map(Node::as_scalar).collect();
        text.push_str(&cells?.join(";").replace('\n', " "));
        text.push('\n');
    }
    Some(text)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Semicolon,
    Tab,
    Comma,
    Space,
}

impl Separator {
    fn of<'a>(lines: impl Iterator<Item = &'a str> + Clone) -> Self {
        // A header may hold any of them, so the last of the first lines decides.
        let mut probe = lines.take(5).collect::<Vec<_>>();
        if probe.len() > 1 {
            probe.remove(0);
        }
        let any = |c: char| probe.iter().any(|line| line.contains(c));
        match () {
            () if any(';') => Self::Semicolon,
            () if any('\t') => Self::Tab,
            () if any(',') && !probe.iter().all(|line| decimal_commas_and_spaces(line)) => Self::Comma,
            () => Self::Space,
        }
    }

    fn split(self, line: &str) -> Vec<&str> {
        let mut quoted = false;
        let parts = |c: char| {
            quoted ^= c == '"';
            !quoted
                && match self {
                    Self::Semicolon => c == ';',
                    Self::Tab => c == '\t',
                    Self::Comma => c == ',',
                    Self::Space => c.is_whitespace(),
                }
        };
        let mut cells: Vec<&str> =
            line.split(parts).map(|cell| cell.trim().trim_matches('"').trim()).collect();
        if self == Self::Space {
            cells.retain(|cell| !cell.is_empty());
        }
        // Some exports end each line with a separator.
        if cells.len() > 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }

    /// Also infinities and NaN, for the caller to refuse by name.
    fn number(self, cell: &str) -> Option<f64> {
        if cell.len() > 60 {
            return None;
        }
        let mut plain = cell.replace('\u{2212}', "-");
        if self != Self::Comma && plain.matches(',').count() == 1 && !plain.contains('.') {
            plain = plain.replace(',', ".");
        }
        plain.parse().ok()
    }
}

/// `0,5  1,25`: columns parted by spaces, the commas inside numbers.
fn decimal_commas_and_spaces(line: &str) -> bool {
    let cells: Vec<&str> = line.split_whitespace().collect();
    cells.len() > 1
        && cells.iter().all(|cell| {
            !cell.ends_with(',')
                && !cell.starts_with(',')
                && cell.matches(',').count() <= 1
                && !cell.contains('.')
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, headers: &[&str], rows: &[&[f64]]) {
        let series = parse_series("f.csv", text).unwrap_or_else(|f| panic!("{text:?}: {f:?}"));
        assert_eq!(series.headers, headers, "{text:?}");
        assert_eq!(series.rows, rows, "{text:?}");
    }

    #[test]
    fn tables_as_programs_export_them() {
        let rows: &[&[f64]] = &[&[0.0, 1.0], &[0.5, -0.25]];
        check("0,1\n0.5,-0.25\n", &["", ""], rows);
        check("t,y\n0,1\n0.5,-0.25", &["t", "y"], rows);
        check("\"Time (s)\",\"theta, rad\"\r\n0,1\r\n0.5,-0.25\r\n", &["Time (s)", "theta, rad"], rows);
        check("# MATLAB\n% export\n\nt, y\n0, 1\n\n0.5, -0.25\n", &["t", "y"], rows);
        check("t;y\n0;1\n0,5;-0,25\n", &["t", "y"], rows);
        check("t;y\n0;1\n0.5;-0.25\n", &["t", "y"], rows);
        check("t\ty\n0\t1\n0,5\t-0,25\n", &["t", "y"], rows);
        check("Time (s)\ttheta\n0\t1\n0.5\t-2.5e-1", &["Time (s)", "theta"], rows);
        check("  0   1\n  0.5  \u{2212}0.25\n", &["", ""], rows);
        check("0 1\n0,5 -0,25\n", &["", ""], rows);
        check("Time (s)  theta (rad)\n0 1\n0.5 -0.25\n", &["", ""], rows);
        check("t,y,\n0,1,\n0.5,-0.25,\n", &["t", "y"], rows);
        check("0,1,2\n0,1,3\n", &["", "", ""], &[&[0.0, 1.0, 2.0], &[0.0, 1.0, 3.0]]);
    }

    #[test]
    fn what_is_not_a_table_says_where() {
        let long = (0..=MAX_ROWS).map(|i| format!("{i},0\n")).collect::<String>();
        for (text, code, words) in [
            ("", CODE, "no row"),
            ("t,y\n", CODE, "no row"),
            ("just words", CODE, "no row"),
            ("0\n1\n", CODE, "1 columns"),
            ("0,1\n1,abc\n", CODE, "Line 2 of the data has `abc`"),
            ("0,1\n1,nan\n", CODE, "`nan`, which is not finite"),
            ("0,1\n1,inf\n", CODE, "`inf`, which is not finite"),
            ("0,1\n1,1e999\n", CODE, "`1e999`, which is not finite"),
            ("0,1\n1,\n", CODE, "1 columns"),
            ("0,1\n1,2,3\n", CODE, "3 columns, where"),
            ("t,y\n0,1\n2,1\n1,1\n", "data.time_order", "Line 4 of the data goes back in time, to `1`"),
            ("0,=1+1\n", CODE, "`=1+1`"),
            (&long, "data.too_long", "20000 rows"),
            (&"1,".repeat(100), CODE, "100 columns"),
            (&format!("0,{}\n", "9".repeat(100_000)), CODE, "not a number"),
        ] {
            let finding = parse_series("f.csv", text).expect_err(text);
            assert_eq!(finding.code, code, "{finding:?}");
            assert!(finding.message.contains(words), "{finding:?}");
            assert!(finding.help.is_some() && finding.message.len() < 200, "{finding:?}");
        }
    }

    #[test]
    fn lists_of_lists_become_text() {
        let tree = crate::source::parse("[[0, 1], [0.5, -0.25]]").unwrap();
        assert_eq!(rows_as_text(tree.as_sequence().unwrap()).as_deref(), Some("0;1\n0.5;-0.25\n"));
    }
}
