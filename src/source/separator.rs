/// What parts the columns of a table in CSV: the comma, semicolon or tab that its first row has most of, outside quotes.
///
/// The first of them where two are as frequent; a comma where nothing parts anything.
pub fn separator(bytes: &[u8]) -> u8 {
    let mut counts = [(b',', 0_usize), (b';', 0), (b'\t', 0)];
    let mut quoted = false;
    for byte in bytes {
        match byte {
            b'"' => quoted = !quoted,
            b'\r' | b'\n' if !quoted => break,
            byte if !quoted => {
                counts.iter_mut().filter(|(one, _)| one == byte).for_each(|(_, count)| *count += 1);
            }
            _ => {}
        }
    }
    // The first of those with most: a comma where nothing parts anything.
    counts.iter().rev().max_by_key(|(_, count)| *count).map_or(b',', |(one, _)| *one)
}

/// A quote of a table in CSV that most likely was not meant as it stands: rows are lost in it, or a part of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrayQuote {
    /// The cell that begins at this byte is never closed: it holds everything to the end of the table.
    NotClosed(usize),
    /// Behind the end of the quoted cell that begins at this byte stands more than spaces.
    GoesOn(usize),
}

/// The first stray quote of a table, by the rules of RFC 4180. A quote within a cell that begins without one is only a character.
pub fn stray_quote(bytes: &[u8], separator: u8) -> Option<StrayQuote> {
    let mut at = 0;
    loop {
        let start = at;
        if bytes.get(at) == Some(&b'"') {
            at += 1;
            loop {
                match (bytes.get(at), bytes.get(at + 1)) {
                    (None, _) => return Some(StrayQuote::NotClosed(start)),
                    (Some(b'"'), Some(b'"')) => at += 2,
                    (Some(b'"'), _) => break,
                    _ => at += 1,
                }
            }
            at += 1;
            while bytes.get(at) == Some(&b' ') {
                at += 1;
            }
            if bytes.get(at).is_some_and(|byte| *byte != separator && !matches!(byte, b'\r' | b'\n')) {
                return Some(StrayQuote::GoesOn(start));
            }
        }
        while bytes.get(at).is_some_and(|byte| *byte != separator && !matches!(byte, b'\r' | b'\n')) {
            at += 1;
        }
        if at >= bytes.len() {
            return None;
        }
        at += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, want: Option<StrayQuote>) {
        assert_eq!(stray_quote(text.as_bytes(), b','), want, "{text:?}");
    }

    #[test]
    fn quotes_that_take_more_than_their_cell() {
        check("", None);
        check("a,b\n1,\"x, \"\"y\"\"\nz\"\n2,\n", None);
        check("a,\"b\" ,c\r\n\"\"\r\n", None);
        check("5\" pipe,b\n", None);
        check("a,\"b\nc,d\n", Some(StrayQuote::NotClosed(2)));
        check("\"a\n\"\"", Some(StrayQuote::NotClosed(0)));
        check("a,\"he said \"no\" twice\"\n", Some(StrayQuote::GoesOn(2)));
        check("a,\"b,\nc,\"d\"\n", Some(StrayQuote::GoesOn(2)));
    }
}
