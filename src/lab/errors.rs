use crate::source::{Finding, SourceText};
use std::fmt;

/// Everything that is wrong with a lab file, in file order.
#[derive(Clone, PartialEq, Eq)]
pub struct LabErrors {
    pub source: SourceText,
    pub findings: Vec<Finding>,
}

impl LabErrors {
    /// Every error with file, line, column, caret and help, for a terminal.
    pub fn render(&self, colour: bool) -> String {
        let pages: Vec<String> = self.findings.iter().map(|f| f.render(&self.source, colour)).collect();
        pages.join("\n\n")
    }
}

impl fmt::Display for LabErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self.findings.iter().map(|f| f.render_line(&self.source)).collect();
        f.write_str(&lines.join("\n"))
    }
}

/// As displayed: the text of a whole lab helps nobody.
impl fmt::Debug for LabErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for LabErrors {}

/// Why there is no lab under a name or path.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error("no lab is called `{name}`, and no file or folder is there; {help}")]
    Unknown { name: String, help: String },
    #[error("cannot read `{path}`: {source}")]
    Io { path: String, source: std::io::Error },
    #[error("cannot read `{path}`: {source}")]
    NotText { path: String, source: crate::source::DecodeError },
    #[error(transparent)]
    Invalid(#[from] LabErrors),
}
