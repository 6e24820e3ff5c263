use crate::source::separator;
use std::ops::Range;

/// A CSV file of an LMS, as places in its bytes, so that what is not changed stays as it is.
///
/// The separator is the comma, semicolon or tab that the first line has most of; cells may be quoted and then hold line ends;
/// lines end in LF, CRLF or CR. Any encoding in which these are single bytes will do: UTF-8, Latin-1.
/// Source: RFC 4180.
#[derive(Clone, Debug)]
pub struct Table<'a> {
    bytes: &'a [u8],
    pub separator: u8,
    pub rows: Vec<Row>,
}

/// A line with something in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// From 1.
    pub line: usize,
    /// Places of the cells, quotes included.
    pub cells: Vec<Range<usize>>,
}

/// Why a file is no table.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum TableError {
    #[error("it has more than the {limit} bytes that are read")]
    TooLarge { size: usize, limit: usize },
    #[error("it is UTF-16 text; save it as CSV in UTF-8")]
    Utf16,
    #[error("it is empty")]
    Empty,
    #[error("line {line} has {found} cells and the first line {wanted}")]
    Ragged { line: usize, found: usize, wanted: usize },
    #[error("a quote that is opened in line {line} is not closed")]
    OpenQuote { line: usize },
}

const MOST_BYTES: usize = 64 << 20;
const BOM: &[u8] = b"\xef\xbb\xbf";

impl<'a> Table<'a> {
    pub fn parse(bytes: &'a [u8]) -> Result<Self, TableError> {
        if bytes.len() > MOST_BYTES {
            return Err(TableError::TooLarge { size: bytes.len(), limit: MOST_BYTES });
        }
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") || bytes.contains(&0) {
            return Err(TableError::Utf16);
        }
        let start = if bytes.starts_with(BOM) { BOM.len() } else { 0 };
        let separator = separator(&bytes[start..]);
        let mut rows = Vec::new();
        let (mut at, mut line) = (start, 1);
        while at < bytes.len() {
            let row = Self::row(bytes, separator, &mut at, &mut line)?;
            if row.cells.len() > 1
                || row.cells.iter().any(|cell| !bytes[cell.clone()].trim_ascii().is_empty())
            {
                rows.push(row);
            }
        }
        let Some(wanted) = rows.first().map(|row| row.cells.len()) else { return Err(TableError::Empty) };
        if let Some(row) = rows.iter().find(|row| row.cells.len() != wanted) {
            return Err(TableError::Ragged { line: row.line, found: row.cells.len(), wanted });
        }
        Ok(Self { bytes, separator, rows })
    }

    fn row(bytes: &[u8], separator: u8, at: &mut usize, line: &mut usize) -> Result<Row, TableError> {
        let mut row = Row { line: *line, cells: Vec::new() };
        loop {
            let start = *at;
            if bytes.get(*at) == Some(&b'"') {
                let opened = *line;
                *at += 1;
                loop {
                    match (bytes.get(*at), bytes.get(*at + 1)) {
                        (None, _) => return Err(TableError::OpenQuote { line: opened }),
                        (Some(b'"'), Some(b'"')) => *at += 2,
                        (Some(b'"'), _) => break *at += 1,
                        (Some(byte), next) => {
                            *line += usize::from(*byte == b'\n' || (*byte == b'\r' && next != Some(&b'\n')));
                            *at += 1;
                        }
                    }
                }
            }
            while bytes.get(*at).is_some_and(|byte| *byte != separator && !matches!(byte, b'\r' | b'\n')) {
                *at += 1;
            }
            row.cells.push(start..*at);
            match bytes.get(*at) {
                Some(byte) if *byte == separator => *at += 1,
                Some(b'\r') if bytes.get(*at + 1) == Some(&b'\n') => break *at += 2,
                Some(_) => break *at += 1,
                None => break,
            }
        }
        *line += 1;
        Ok(row)
    }

    /// The names of the columns.
    pub fn header(&self) -> Vec<String> {
        self.rows
            .first()
            .map_or_else(Vec::new, |row| (0..row.cells.len()).map(|at| self.text(row, at)).collect())
    }

    /// As in the file, quotes included; nothing where there is no such cell.
    pub fn raw(&self, row: &Row, column: usize) -> &'a [u8] {
        row.cells.get(column).map_or(&[], |place| &self.bytes[place.clone()])
    }

    /// What a cell says, without quotes and space around it.
    pub fn text(&self, row: &Row, column: usize) -> String {
        let raw = self.raw(row, column);
        let text = match std::str::from_utf8(raw) {
            Ok(text) => text.to_owned(),
            // Latin-1 has the code points of its bytes.
            Err(_) => raw.iter().map(|byte| char::from(*byte)).collect(),
        };
        let inner =
            text.strip_prefix('"').map(|rest| rest.strip_suffix('"').unwrap_or(rest).replace("\"\"", "\""));
        inner.unwrap_or(text).trim().to_owned()
    }

    /// The whole file with other cells in some places, which are in order and apart.
    pub fn with(&self, cells: &[(Range<usize>, Vec<u8>)]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.bytes.len() + cells.len() * 8);
        let mut from = 0;
        for (place, cell) in cells {
            bytes.extend_from_slice(&self.bytes[from..place.start]);
            bytes.extend_from_slice(cell);
            from = place.end;
        }
        bytes.extend_from_slice(&self.bytes[from..]);
        bytes
    }

    /// `text` as a cell: quoted where the cell that it takes the place of was, or where it must be.
    pub fn cell(&self, text: &str, instead_of: &[u8]) -> Vec<u8> {
        let must = text.bytes().any(|byte| byte == self.separator || matches!(byte, b'"' | b'\r' | b'\n'));
        if must || instead_of.starts_with(b"\"") {
            format!("\"{}\"", text.replace('"', "\"\"")).into_bytes()
        } else {
            text.as_bytes().to_vec()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells with `|` between, rows with `/` between.
    #[track_caller]
    fn check(what: &str, bytes: &[u8], cells: &str) {
        let shown = match Table::parse(bytes) {
            Ok(table) => {
                let row = |row: &Row| {
                    (0..row.cells.len()).map(|at| table.text(row, at)).collect::<Vec<_>>().join("|")
                };
                assert_eq!(table.with(&[]), bytes, "{what}: bytes change");
                table.rows.iter().map(row).collect::<Vec<_>>().join("/")
            }
            Err(error) => error.to_string(),
        };
        assert_eq!(shown, cells, "{what}");
    }

    #[test]
    fn cells_are_found_whatever_parts_them() {
        check("commas", b"a,b\n1,2\n", "a|b/1|2");
        check("semicolons, CRLF, no end", b"a;b\r\n1,5;2", "a|b/1,5|2");
        check("tabs, CR", b"a\tb\r1\t2\r", "a|b/1|2");
        check("byte order mark", b"\xef\xbb\xbfa,b\n1,2\n", "a|b/1|2");
        check("quotes", b"\"a\",b\n\"1,\"\"x\"\"\",2\n", "a|b/1,\"x\"|2");
        check("line end in quotes", b"a,b\n\"1\r\n1\",2\n", "a|b/1\r\n1|2");
        check("empty cells", b"a,b\n,\n", "a|b/|");
        check("blank lines", b"a,b\n\n1,2\n\n", "a|b/1|2");
        check("Latin-1", b"n\xe4,b\n1,2\n", "nä|b/1|2");
        check("separator in quotes of the header", b"\"a;b;c\",d\n1,2\n", "a;b;c|d/1|2");
        check("one column", b"a\n1\n", "a/1");
        check("nothing", b"\n\n", "it is empty");
        check("ragged", b"a,b\n1\n", "line 2 has 1 cells and the first line 2");
        check(
            "line numbers count quoted line ends",
            b"a,b\n\"1\n1\",2\n3\n",
            "line 4 has 1 cells and the first line 2",
        );
        check("open quote", b"a,b\n\"1,2\n", "a quote that is opened in line 2 is not closed");
        check("UTF-16", b"\xff\xfea\0", "it is UTF-16 text; save it as CSV in UTF-8");
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(0_u8..=255, 0..200)) {
            let few: Vec<u8> = bytes.iter().map(|byte| b",;\"\n\ra1\t"[usize::from(byte % 8)]).collect();
            for bytes in [bytes, few] {
                if let Ok(table) = Table::parse(&bytes) {
                    assert_eq!(table.with(&[]), bytes);
                    for row in &table.rows {
                        (0..=row.cells.len()).for_each(|column| drop(table.text(row, column)));
                    }
                }
            }
        }

        #[test]
        fn a_cell_says_what_was_put_into_it(text in "[a-z,;\"\r\n=]{0,12}") {
            let table = Table::parse(b"a,b\n1,2\n").unwrap();
            let row = table.rows[1].clone();
            let bytes = table.with(&[(row.cells[0].clone(), table.cell(&text, b"1"))]);
            let again = Table::parse(&bytes).unwrap();
            assert_eq!(again.text(&again.rows[1], 0), text.trim());
            assert_eq!(again.text(&again.rows[1], 1), "2");
        }
    }

    #[test]
    fn other_cells_take_their_places() {
        let table = Table::parse(b"a;b\r\n1;\"x\"\r\n").unwrap();
        let row = table.rows[1].clone();
        let cells = [
            (row.cells[0].clone(), table.cell("2;3", table.raw(&row, 0))),
            (row.cells[1].clone(), table.cell("y\"", table.raw(&row, 1))),
        ];
        assert_eq!(table.with(&cells), b"a;b\r\n\"2;3\";\"y\"\"\"\r\n");
    }
}
