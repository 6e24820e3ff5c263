use super::file::LabFile;
use super::names::suggestion;
use crate::source::{Finding, Node, SourceText, Span, sanitize};
use serde_yaml::{Error, Location};

/// The file's shape: YAML, and the keys it must and may have. The first thing wrong with the shape ends the reading.
pub(super) fn read(source: &SourceText) -> Result<(LabFile, Node), Finding> {
    let tree = crate::source::parse(&source.text).map_err(|error| {
        let finding = Finding::error("lab.yaml", error.message);
        match error.span {
            Some(span) => finding.at(span),
            None => finding,
        }
    })?;
    // The tree was read within budgets, so the second reading needs none of its own.
    let options = serde_yaml::options! { with_snippet: false };
    serde_yaml::from_str_with_options(&source.text, options).map(|file| (file, tree)).map_err(|e| finding(&e))
}

fn finding(error: &Error) -> Finding {
    let (code, message, help) = match error {
        Error::SerdeUnknownField { field, expected, .. } => {
            ("lab.unknown_key", format!("there is no key `{field}` here"), Some(suggestion(field, expected)))
        }
        Error::SerdeUnknownVariant { variant, expected, .. } => {
            ("lab.unknown_key", format!("`{variant}` is not known here"), Some(suggestion(variant, expected)))
        }
        Error::SerdeMissingField { field, .. } => {
            ("lab.missing_key", format!("the key `{field}` is missing here"), None)
        }
        other => {
            let text = other.to_string();
            let line = text.lines().next().unwrap_or_default();
            ("lab.shape", line.split(" at line ").next().unwrap_or(line).to_owned(), None)
        }
    };
    let finding = Finding::error(code, sanitize(&message));
    let finding = match help {
        Some(help) => finding.with_help(help),
        None => finding,
    };
    match error.location() {
        Some(location) => finding.at(span(location)),
        None => finding,
    }
}

/// Bytes of a place; of a list or a mapping only the beginning is known.
pub(super) fn span(location: Location) -> Span {
    let place = location.span();
    let number = |n: Option<u64>| n.and_then(|n| usize::try_from(n).ok()).unwrap_or(0);
    let start = number(place.byte_offset());
    Span { start, end: start + number(place.byte_len()) }
}
