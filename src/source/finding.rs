use super::{SourceText, Span};

/// How much a finding matters to the one who reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Something could not be read, or is against the rules.
    Error,
    /// Something is missing or contradicts something else.
    Warning,
    /// Worth knowing.
    Note,
}

/// Something to say about a place in a file, in full sentences and without blame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    pub severity: Severity,
    /// Stable, dotted: `poles.unreadable`.
    pub code: &'static str,
    pub message: String,
    /// How to write it instead.
    pub help: Option<String>,
    pub span: Option<Span>,
}

impl Finding {
    /// The finding as a person sees it in a terminal: message, file, line, column, a caret, help.
    ///
    /// Control characters and escape sequences in the source are made harmless.
    pub fn render(&self, source: &SourceText, colour: bool) -> String {
        let _ = (source, colour);
        todo!()
    }
}
