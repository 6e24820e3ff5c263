use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// An answer file, marks file or lab file may be this large, in bytes.
pub const MAX_TEXT_BYTES: usize = 256 * 1024;

/// Why bytes are not a text we read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    #[error("the file has more than the {limit} bytes that are read")]
    TooLarge { size: usize, limit: usize },
    #[error("the file is not text in UTF-8 or UTF-16 (first at byte {offset})")]
    NotText { offset: usize },
}

/// Bytes as text: UTF-8 with or without a byte order mark, or UTF-16 with one. The mark is dropped.
///
/// At most [`MAX_TEXT_BYTES`].
pub fn decode(bytes: &[u8]) -> Result<String, DecodeError> {
    decode_within(bytes, MAX_TEXT_BYTES)
}

/// The bytes of a file, and not more than one over `limit`: a device never ends.
pub fn read_within(path: &Path, limit: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Like [`decode`], with another limit on the size.
pub fn decode_within(bytes: &[u8], limit: usize) -> Result<String, DecodeError> {
    if bytes.len() > limit {
        return Err(DecodeError::TooLarge { size: bytes.len(), limit });
    }
    match bytes {
        [0xff, 0xfe, rest @ ..] => decode_utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => decode_utf16(rest, u16::from_be_bytes),
        _ => {
            let body = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
            let mark = bytes.len() - body.len();
            let text = std::str::from_utf8(body)
                .map_err(|error| DecodeError::NotText { offset: mark + error.valid_up_to() })?;
            match text.find('\0') {
                Some(offset) => Err(DecodeError::NotText { offset: mark + offset }),
                None => Ok(text.to_owned()),
            }
        }
    }
}

fn decode_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, DecodeError> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(DecodeError::NotText { offset: 2 + bytes.len() - 1 });
    }
    let mut text = String::with_capacity(bytes.len());
    let mut offset = 2;
    for unit in char::decode_utf16(pairs.iter().map(|pair| unit(*pair))) {
        match unit {
            Ok(c) if c != '\0' => {
                text.push(c);
                offset += 2 * c.len_utf16();
            }
            _ => return Err(DecodeError::NotText { offset }),
        }
    }
    Ok(text)
}

/// Text that is safe to print in a terminal or a log: one line stays one line, nothing moves the cursor, changes
/// colours or the direction of writing. Line breaks become spaces; other such characters, U+FFFD.
pub fn sanitize(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\n' | '\r' | '\t' => ' ',
            c if is_unsafe(c) => '\u{fffd}',
            c => c,
        })
        .collect()
}

/// Like [`sanitize`], but line breaks and tabs stay.
pub(super) fn sanitize_lines(text: &str) -> Cow<'_, str> {
    let hidden = |c: char| is_unsafe(c) && !matches!(c, '\n' | '\t' | '\r');
    if !text.contains(hidden) {
        return Cow::Borrowed(text);
    }
    // Byte offsets must stay valid, so each character becomes as many `?` as it has bytes.
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if hidden(c) { safe.extend(std::iter::repeat_n('?', c.len_utf8())) } else { safe.push(c) }
    }
    Cow::Owned(safe)
}

/// Control characters, invisible characters, and those that change the direction of writing.
fn is_unsafe(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
            | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_decoded() {
        let utf16 = |text: &str, le: bool| -> Vec<u8> {
            let mark = [0xfeffu16];
            mark.into_iter()
                .chain(text.encode_utf16())
                .flat_map(|u| if le { u.to_le_bytes() } else { u.to_be_bytes() })
                .collect()
        };
        for bytes in [
            "θ: ±1".as_bytes().to_vec(),
            "\u{feff}θ: ±1".as_bytes().to_vec(),
            utf16("θ: ±1", true),
            utf16("θ: ±1", false),
        ] {
            assert_eq!(decode(&bytes).as_deref(), Ok("θ: ±1"), "{bytes:?}");
        }
        assert_eq!(decode(b""), Ok(String::new()));
    }

    #[test]
    fn what_is_not_text_is_refused() {
        for (bytes, offset) in [
            (&b"a\xe9b"[..], 1),
            (b"\xef\xbb\xbfa\xff", 4),
            (b"a\0b", 1),
            (b"\xff\xfea\0\0", 4),
            (b"\xff\xfe\x00\xd8", 2),
            (b"\xff\xfe\0\0", 2),
        ] {
            assert_eq!(decode(bytes), Err(DecodeError::NotText { offset }), "{bytes:?}");
        }
        let large = vec![b'a'; MAX_TEXT_BYTES + 1];
        assert_eq!(
            decode(&large),
            Err(DecodeError::TooLarge { size: MAX_TEXT_BYTES + 1, limit: MAX_TEXT_BYTES })
        );
    }

    #[test]
    fn terminals_are_safe() {
        for (text, expected) in [
            ("plain ± θ̇ −1", "plain ± θ̇ −1"),
            ("\u{1b}[31mred\u{7}", "\u{fffd}[31mred\u{fffd}"),
            ("a\nb\tc", "a b c"),
            ("a\u{202e}b\u{200b}\u{9b}", "a\u{fffd}b\u{fffd}\u{fffd}"),
        ] {
            assert_eq!(sanitize(text), expected);
        }
        assert_eq!(sanitize_lines("a\u{1b}\n\u{202e}b"), "a?\n???b");
    }
}
