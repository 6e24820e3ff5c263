use super::text::sanitize_lines;
use super::{SourceText, Span, sanitize};
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

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

impl Severity {
    /// `error`, `warning`, `note`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
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
    pub fn new(severity: Severity, code: &'static str, message: impl Into<String>) -> Self {
        Self { severity, code, message: message.into(), help: None, span: None }
    }

    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message)
    }

    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message)
    }

    pub fn note(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, message)
    }

    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub fn at(mut self, span: Span) -> Self {
        self.span = Some(span);
        self
    }

    /// The finding as a person sees it in a terminal: message, file, line, column, a caret, help.
    ///
    /// Control characters and escape sequences in the source are made harmless.
    pub fn render(&self, source: &SourceText, colour: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let title = level.primary_title(sanitize(&self.message)).id(self.code);
        let window = self.span.map(|span| Window::around(&source.text, span));
        let name = sanitize(&source.name);
        let mut group = match &window {
            Some(window) => title.element(
                Snippet::source(sanitize_lines(window.text))
                    .line_start(window.first_line)
                    .path(name)
                    .annotation(AnnotationKind::Primary.span(window.start..window.end)),
            ),
            None => title.element(annotate_snippets::Origin::path(name)),
        };
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(sanitize(help)));
        }
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        renderer.term_width(WIDTH).render(&[group])
    }

    /// One line for logs and editors: `file:line:column: message`; without a place, `file: message`.
    pub fn render_line(&self, source: &SourceText) -> String {
        let (name, message) = (sanitize(&source.name), sanitize(&self.message));
        match self.span.map(|span| source.position(span.start)) {
            Some(place) => {
                format!("{name}:{}:{}: {}: {message}", place.line, place.column, self.severity.word())
            }
            None => format!("{name}: {}: {message}", self.severity.word()),
        }
    }
}

/// Columns a rendered snippet may take.
const WIDTH: usize = 110;

/// The lines of a text that a span touches (three at most), and the span within them.
struct Window<'a> {
    text: &'a str,
    first_line: usize,
    start: usize,
    end: usize,
}

impl<'a> Window<'a> {
    fn around(text: &'a str, span: Span) -> Self {
        let floor = |mut i: usize| {
            while !text.is_char_boundary(i) {
                i -= 1;
            }
            i
        };
        let start = floor(span.start.min(text.len()));
        let end = floor(span.end.clamp(start, text.len()));
        let from = text[..start].rfind('\n').map_or(0, |i| i + 1);
        // A caret line under a long block says nothing: three lines are enough to recognise it.
        let limit = text[start..].match_indices('\n').nth(2).map_or(text.len(), |(i, _)| start + i);
        let end = end.min(limit);
        let to = text[end..].find('\n').map_or(text.len(), |i| end + i);
        let first_line = text[..from].matches('\n').count() + 1;
        Self { text: &text[from..to], first_line, start: start - from, end: end - from }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SourceText {
        SourceText::new("answers.yaml", text)
    }

    fn at(text: &str, part: &str) -> Finding {
        let start = text.find(part).unwrap();
        Finding::error("poles.unreadable", "`-2+j3..1` is not a number we can read.")
            .with_help("Write it like `-2+3.1j`.")
            .at(Span { start, end: start + part.len() })
    }

    #[test]
    fn a_finding_shows_file_line_column_caret_and_help() {
        let text = "answers:\n  poles: -2+j3..1\n";
        let page = at(text, "-2+j3..1").render(&source(text), false);
        let expected = "\
error[poles.unreadable]: `-2+j3..1` is not a number we can read.
 --> answers.yaml:2:10
  |
2 |   poles: -2+j3..1
  |          ^^^^^^^^
  |
  = help: Write it like `-2+3.1j`.";
        assert_eq!(page, expected);
        let line = at(text, "-2+j3..1").render_line(&source(text));
        assert_eq!(line, "answers.yaml:2:10: error: `-2+j3..1` is not a number we can read.");
    }

    #[test]
    fn any_span_can_be_shown() {
        let text = "θ: ±\u{1b}[31m\u{202e}\nnext\r\n\n\nlast é";
        for start in 0..=text.len() + 2 {
            for end in 0..=text.len() + 2 {
                let finding = Finding::note("x", "m").at(Span { start, end });
                for colour in [false, true] {
                    let page = finding.render(&source(text), colour);
                    assert!(colour || !page.contains('\u{1b}'), "{page:?}");
                    assert!(!page.contains('\u{202e}') && !page.contains("\u{1b}[31m\u{202e}"), "{page:?}");
                }
            }
        }
        assert!(
            Finding::note("x", "m").at(Span { start: 0, end: 9 }).render(&source(""), false).contains("m")
        );
    }

    #[test]
    fn hostile_names_and_messages_are_harmless() {
        let source = SourceText::new("a\u{1b}]0;evil\u{7}\n.yaml", "x");
        let finding =
            Finding::error("x", "\u{1b}[2J\u{202e}m\nn").with_help("\u{9b}h").at(Span { start: 0, end: 1 });
        for page in [
            finding.render(&source, false),
            finding.render_line(&source),
            Finding::note("y", "m").render(&source, false),
        ] {
            assert!(!page.contains(['\u{1b}', '\u{7}', '\u{9b}', '\u{202e}']), "{page:?}");
        }
    }

    #[test]
    fn long_lines_are_cropped() {
        let text = format!("a: {}!{}", "x".repeat(100_000), "y".repeat(100_000));
        let page = at(&text, "!").render(&source(&text), false);
        assert!(page.len() < 1_000, "{}", page.len());
    }
}
