//! Findings for other programs: JSON, JUnit, SARIF, GitHub annotations. Knows places in files, no lab and no mark.

mod github;
mod json;
mod junit;
mod sarif;

pub use github::github;
pub use json::json;
pub use junit::{JunitError, junit};
pub use sarif::sarif;

use crate::source::{Finding, Severity, SourceText, sanitize};

/// What a verb found out about some files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Annotations {
    /// `polemark check`, `polemark verify`.
    pub verb: &'static str,
    pub files: Vec<FileAnnotations>,
}

/// One file's part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileAnnotations {
    /// As given on the command line.
    pub file: String,
    /// What was looked at, in order.
    pub cases: Vec<Case>,
}

/// Something that was looked at, and what came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// The field of the answer, or what the check is about.
    pub name: String,
    /// Stable, dotted: `poles.unreadable`.
    pub code: String,
    /// `None` when all is well.
    pub severity: Option<Severity>,
    /// One line, safe in a terminal or a log.
    pub message: String,
    pub help: Option<String>,
    pub place: Option<Place>,
}

/// From the first character to behind the last; lines and columns count from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub line: usize,
    pub column: usize,
    pub end_line: usize,
    pub end_column: usize,
}

impl Case {
    /// All is well with `name`: `message` says what was found.
    pub fn well(name: &str, code: &str, message: &str) -> Self {
        Self {
            name: sanitize(name),
            code: code.to_owned(),
            severity: None,
            message: sanitize(message),
            help: None,
            place: None,
        }
    }

    pub fn of(name: &str, finding: &Finding, source: &SourceText) -> Self {
        let place = finding.span.map(|span| {
            let (start, end) = (source.position(span.start), source.position(span.end));
            Place { line: start.line, column: start.column, end_line: end.line, end_column: end.column }
        });
        Self {
            name: sanitize(name),
            code: finding.code.to_owned(),
            severity: Some(finding.severity),
            message: sanitize(&finding.message),
            help: finding.help.as_deref().map(sanitize),
            place,
        }
    }

    /// The message, and what to do about it.
    fn told(&self) -> String {
        match &self.help {
            Some(help) => format!("{} {help}", self.message),
            None => self.message.clone(),
        }
    }
}

/// A path as other systems write it, with `/` between its parts.
fn with_slashes(file: &str) -> String {
    sanitize(file).replace('\\', "/")
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A file with everything in it that could break out of a format.
    pub fn hostile() -> Annotations {
        let source = SourceText::new("a b/ü,:%.yaml", "x: 1\ny: ]]>\n");
        let finding = Finding::warning(
            "poles.unreadable",
            "`\n::error::x ##[set-env]y \u{1b}[31m<b> & \"q\" ]]> %0A \u{fffe}` was found, 50% of it.",
        )
        .with_help("Write `-1`.")
        .at(crate::source::Span { start: 8, end: 11 });
        let cases =
            vec![Case::well("a", "read", "read as 1"), Case::of("b\r\n::notice::", &finding, &source)];
        Annotations {
            verb: "polemark check",
            files: vec![FileAnnotations { file: source.name.clone(), cases }],
        }
    }
}
