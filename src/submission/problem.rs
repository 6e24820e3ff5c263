use crate::english::capitalized;
use crate::source::{Finding, Node, sanitize};

/// Why a scalar cannot be read, before it is known where in the file it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Problem {
    pub code: &'static str,
    pub message: String,
    pub help: Option<String>,
    /// Bytes of the scalar's text.
    pub start: usize,
    pub end: usize,
}

impl Problem {
    pub fn new(code: &'static str, start: usize, end: usize, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), help: None, start, end }
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The finding, now that the scalar's node is known.
    pub fn into_finding(self, node: &Node, source: &str) -> Finding {
        let span = node.locate(source, self.start, self.end);
        Finding { help: self.help, ..Finding::error(self.code, self.message) }.at(span)
    }
}

/// A student's words between backticks in a message: one line, harmless, not too long.
pub(super) fn quote(text: &str) -> String {
    const LONGEST: usize = 60;
    let clean = sanitize(text.trim()).replace('`', "'");
    match clean.char_indices().nth(LONGEST) {
        Some((cut, _)) => format!("`{}…`", &clean[..cut]),
        None => format!("`{clean}`"),
    }
}

/// A lower-case fragment as a sentence.
pub(super) fn sentence(fragment: &str) -> String {
    let end = if fragment.ends_with(['.', '?', '!']) { "" } else { "." };
    format!("{}{end}", capitalized(fragment))
}
