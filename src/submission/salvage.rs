//! A file of which some answers are no YAML: those are lost, or put right where only one thing can be meant, and the
//! others are read.

use super::problem::sentence;
use crate::source::{Finding, Node, Span, YamlError, parse_with_duplicates};

/// How deep answers lie within answers.
const DEEPEST: usize = 4;

/// What could be read of a file that is not YAML as a whole.
pub(super) struct Salvaged {
    /// Places are those of the file as it was handed in.
    pub tree: Node,
    /// Answers that are left out of the tree: where the key begins, and why.
    pub lost: Vec<(usize, Finding)>,
}

/// Reads each answer by itself. `None` when there is no list of answers, or the file cannot be read without them either.
pub(super) fn salvage(text: &str) -> Option<Salvaged> {
    let lines = lines(text);
    let answers = lines.iter().position(|line| line.indent == 0 && line.is_key("answers"))?;
    let after = &lines[answers + 1..];
    let end = after.iter().position(|line| line.indent == 0 && line.key().is_some()).unwrap_or(after.len());
    let mut salvage = Salvage { text: text.as_bytes().to_vec(), lost: Vec::new() };
    salvage.items(text, &after[..end], 0);
    let plain = String::from_utf8(salvage.text).ok()?;
    let tree = parse_with_duplicates(&plain).ok()?;
    Some(Salvaged { tree, lost: salvage.lost })
}

struct Line<'t> {
    start: usize,
    text: &'t str,
    /// The line break.
    tail: &'t str,
    end: usize,
    indent: usize,
}

impl<'t> Line<'t> {
    /// `hanging.poles` of `  hanging.poles: …`
    fn key(&self) -> Option<&'t str> {
        let body = self.text.trim_start_matches('\u{feff}').trim();
        let (key, rest) = body.split_once(':')?;
        let letter = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '-' | ' ' | '"' | '\'');
        let spaced = rest.is_empty() || rest.starts_with(char::is_whitespace);
        let begins = key.starts_with(|c: char| c.is_alphabetic() || matches!(c, '_' | '"' | '\''));
        (spaced && begins && key.len() <= 80 && key.chars().all(letter)).then_some(key)
    }

    fn is_key(&self, name: &str) -> bool {
        self.key().is_some_and(|key| key.trim().eq_ignore_ascii_case(name)) && self.is_bare()
    }

    /// Nothing stands behind the key.
    fn is_bare(&self) -> bool {
        let rest = self.text.split_once(':').map_or("", |(_, rest)| rest.trim());
        rest.is_empty() || rest.starts_with('#')
    }

    fn is_blank(&self) -> bool {
        self.text.trim().is_empty()
    }
}

fn lines(text: &str) -> Vec<Line<'_>> {
    let mut start = 0;
    let line = |whole: &'_ str| {
        let from = start;
        start += whole.len();
        (from, start)
    };
    let places: Vec<(usize, usize)> = text.split_inclusive('\n').map(line).collect();
    let read = |(start, end): (usize, usize)| {
        let own = text[start..end].trim_end_matches(['\n', '\r']);
        let indent = own.len() - own.trim_start_matches(' ').len();
        Line { start, text: own, tail: &text[start + own.len()..end], end, indent }
    };
    places.into_iter().map(read).collect()
}

struct Salvage {
    text: Vec<u8>,
    lost: Vec<(usize, Finding)>,
}

impl Salvage {
    /// Reads the answers that stand on these lines.
    fn items(&mut self, text: &str, lines: &[Line<'_>], depth: usize) {
        let Some(indent) = lines.iter().find(|line| line.key().is_some()).map(|line| line.indent) else {
            return;
        };
        let starts: Vec<usize> =
            (0..lines.len()).filter(|&i| lines[i].indent == indent && lines[i].key().is_some()).collect();
        for (i, &from) in starts.iter().enumerate() {
            let to = starts.get(i + 1).copied().unwrap_or(lines.len());
            self.item(text, &lines[from..to], depth);
        }
    }

    fn item(&mut self, text: &str, lines: &[Line<'_>], depth: usize) {
        let (Some(first), Some(last)) = (lines.first(), lines.last()) else { return };
        let (start, end) = (first.start, last.end);
        let Err(error) = parse_with_duplicates(&text[start..end]) else { return };
        if let Some(straight) = straightened(lines)
            && parse_with_duplicates(&straight).is_ok()
        {
            self.text[start..end].copy_from_slice(straight.as_bytes());
            return;
        }
        if first.is_bare() && depth < DEEPEST {
            let known = self.lost.len();
            self.items(text, &lines[1..], depth + 1);
            let readable = std::str::from_utf8(&self.text[start..end]);
            if readable.is_ok_and(|text| parse_with_duplicates(text).is_ok()) {
                return;
            }
            self.lost.truncate(known);
        }
        let value = start + first.text.find(':').map_or(0, |at| at + 1);
        for byte in &mut self.text[value..end] {
            if !matches!(byte, b'\n' | b'\r') {
                *byte = b' ';
            }
        }
        let key = start + first.indent;
        self.lost.push((key, told(error, start)));
    }
}

/// Why an answer is lost, `start` bytes into the file.
fn told(error: YamlError, start: usize) -> Finding {
    let why = error.message.trim_end_matches('.');
    let message = match error.help {
        Some(_) => sentence(why),
        None => format!("This answer cannot be read as YAML: {why}."),
    };
    let help = error.help.unwrap_or(
        "Write it on lines of its own after `|`, each indented by the same spaces. The other answers are read.",
    );
    let span = error.span.map(|span| Span { start: span.start + start, end: span.end + start });
    Finding { span, ..Finding::error("answer.not_yaml", message).with_help(help) }
}

/// An answer behind `|` whose first line is indented more than a later one, with the surplus at the line's end.
///
/// As programs print a fraction. Byte for byte as long as it was.
fn straightened(lines: &[Line<'_>]) -> Option<String> {
    let (key, block) = lines.split_first()?;
    let header = key.text.trim_end().trim_end_matches(['-', '+']);
    let least = block.iter().filter(|line| !line.is_blank()).map(|line| line.indent).min()?;
    if !header.ends_with([' ', ':', '|', '>']) || !header.ends_with(['|', '>']) || least <= key.indent {
        return None;
    }
    let mut straight = format!("{}{}", key.text, key.tail);
    let mut lead = true;
    for line in block {
        let surplus = if lead && !line.is_blank() { line.indent - least } else { 0 };
        straight.push_str(&line.text[surplus..]);
        straight.push_str(&line.text[..surplus]);
        straight.push_str(line.tail);
        lead &= line.is_blank();
    }
    Some(straight)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `key=value` of each answer, `key lost` where it is left out.
    fn read(text: &str) -> Vec<String> {
        let Some(salvaged) = salvage(text) else { return vec!["nothing".to_owned()] };
        let answers = salvaged.tree.get("answers").and_then(Node::as_mapping).unwrap_or_default();
        let shown = |(key, span, node): &(String, Span, Node)| {
            if salvaged.lost.iter().any(|(at, _)| *at == span.start) {
                return format!("{key} lost");
            }
            match node.as_mapping() {
                Some(inner) => {
                    let keys = inner.iter().map(|(key, span, _)| {
                        let lost = salvaged.lost.iter().any(|(at, _)| *at == span.start);
                        format!("{key}{}", if lost { " lost" } else { "" })
                    });
                    format!("{key}: {}", keys.collect::<Vec<_>>().join(", "))
                }
                None => format!("{key}={}", node.as_scalar().unwrap_or_default().trim_end()),
            }
        };
        answers.iter().map(shown).collect()
    }

    #[track_caller]
    fn check(answers: &str, expected: &[&str]) {
        let text = format!("lab: x\nanswers:\n{answers}");
        assert_eq!(read(&text), expected, "{text}");
    }

    #[test]
    fn only_the_answer_that_is_no_yaml_is_lost() {
        check("  a: it is: so\n  b: 2\n", &["a lost", "b=2"]);
        check("  a: 1\n  b: \"open\n  c: 3\n", &["a=1", "b lost", "c=3"]);
        check("  a: [1, 2\n  b: 2\n", &["a lost", "b=2"]);
        check("  a: **bold**\n  b: 2\n", &["a lost", "b=2"]);
        check("  a: 1\n  b: @home\n  c: 2 %\n", &["a=1", "b lost", "c=2 %"]);
        check("  a:\n\t- x\n  b: 2\n", &["a lost", "b=2"]);
        check("  a: |\n  1 / s\n-----\n  2\n  b: 2\n", &["a lost", "b=2"]);
        check("  r:\n    p: [1\n    q: 2\n  b: 2\n", &["r: p lost, q", "b=2"]);
        check("  a: it is: so\n  b: \"open\n  c: 3\n", &["a lost", "b lost", "c=3"]);
        check("  a: 1\r\n  b: [2\r\n  c: 3\r\n", &["a=1", "b lost", "c=3"]);
    }

    #[test]
    fn a_first_line_indented_most_is_put_right() {
        check("  a: |\n         2 s\n    -----\n    s + 1\n  b: 2\n", &["a=2 s     \n-----\ns + 1", "b=2"]);
        check("  a: |\n\n      x\n   y\n  b: 2\n", &["a=\nx   \ny", "b=2"]);
    }

    #[test]
    fn without_a_list_of_answers_nothing_is_read() {
        for text in ["", "a: [1", "answers: [1", "lab: [x\nanswers:\n  a: 1\n", "answers:\n"] {
            assert!(salvage(text).is_none_or(|salvaged| salvaged.lost.is_empty()), "{text}");
        }
        assert!(salvage("lab: [x\nanswers:\n  a: 1\n").is_none());
    }

    #[test]
    fn each_loss_has_its_place() {
        let text = "answers:\n  a: 1\n  b: it is: so\n";
        let salvaged = salvage(text).unwrap();
        let [(key, finding)] = salvaged.lost.as_slice() else { panic!("{:?}", salvaged.lost) };
        assert!(text[*key..].starts_with("b:"));
        assert!(finding.span.is_some_and(|span| text[..span.start].contains("b:")), "{finding:?}");
    }

    #[test]
    fn hostile_files_take_no_time() {
        let many: String = (0..20_000).map(|i| format!("  a{i}: [\n")).collect();
        let deep: String = (1..500).map(|i| format!("{}a:\n", " ".repeat(i))).collect();
        for text in [format!("answers:\n{many}"), format!("answers:\n{deep}{}b: [", " ".repeat(500))] {
            let _ = salvage(&text);
        }
    }
}
