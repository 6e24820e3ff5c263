use super::file::LabFile;
use crate::source::{Finding, Node, SourceText, Span};
use crate::submission::{self, AnswerSheet, NoFiles, Submission};

/// The model answers of all questions, put together as one answer file and read like any other.
///
/// What is said about it is said of the place in the lab file it comes from.
pub(super) fn read(
    source: &SourceText,
    file: &LabFile,
    tree: &Node,
    sheet: &AnswerSheet,
) -> (Submission, Vec<Finding>) {
    let mut answers = Assembly::new(&file.lab.value);
    let mut findings = Vec::new();
    let questions = tree.get("questions").and_then(Node::as_mapping).unwrap_or_default();
    for (id, _, question) in questions {
        if let Some((key, value)) = question.entry("model_answer") {
            findings.extend(answers.add(id, &source.text, key, value));
        }
    }
    let name = format!("{} (model answer)", source.name);
    let mut answer = submission::read("model-answer", &name, answers.text.as_bytes(), sheet, &NoFiles);
    // An author who writes an improper function means it, and marking it shows whether that is right.
    answer.findings.retain(|finding| finding.code != "transfer_function.improper");
    findings.extend(answer.findings.iter().map(|finding| Finding {
        code: "lab.model_answer",
        message: format!("the model answer cannot be read: {}", finding.message),
        span: finding.span.map(|span| answers.origin(span)),
        ..finding.clone()
    }));
    (answer, findings)
}

/// An answer file in the making.
struct Assembly {
    text: String,
    /// (offset here, offset in the lab file) of the beginning of each line taken over.
    lines: Vec<(usize, usize)>,
}

impl Assembly {
    fn new(lab: &str) -> Self {
        let text = format!("lab: {lab}\nstudent: {{id: model-answer, name: Model answer}}\nanswers:\n");
        Self { text, lines: Vec::new() }
    }

    /// Takes over the lines of `model_answer: …`, with the question's id in place of the key.
    fn add(&mut self, id: &str, source: &str, key: Span, value: &Node) -> Option<Finding> {
        let first = source[..key.start].rfind('\n').map_or(0, |i| i + 1);
        let indent = key.start - first;
        if !source[first..key.start].bytes().all(|b| b == b' ') {
            let message = "the key `model_answer` does not begin its line";
            return Some(
                Finding::error("lab.model_answer", message).at(key).with_help("begin a new line with it"),
            );
        }
        self.text.push_str("  ");
        self.text.push_str(id);
        self.lines.push((self.text.len(), key.end));
        let mut at = key.end;
        for line in source[key.end..].split_inclusive('\n') {
            let blanks = line.len() - line.trim_start_matches(' ').len();
            if at > key.end {
                if at > value.span.end && blanks <= indent && !line.trim().is_empty() {
                    break;
                }
                let cut = blanks.min(indent);
                self.text.push_str("  ");
                self.lines.push((self.text.len(), at + cut));
                self.text.push_str(&line[cut..]);
            } else {
                self.text.push_str(line);
            }
            at += line.len();
        }
        if !self.text.ends_with('\n') {
            self.text.push('\n');
        }
        None
    }

    /// Where a place of the assembled text comes from.
    fn origin(&self, span: Span) -> Span {
        let line = self.lines.iter().rev().find(|(here, _)| *here <= span.start);
        let shift = |at: usize| line.map_or(0, |(here, there)| there + at.saturating_sub(*here));
        Span { start: shift(span.start), end: shift(span.end) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_taken_over_and_found_again() {
        let source = "questions:\n  a.b:\n    model_answer:\n      poles: [1,\n        2]\n      data: |\n        0, 1\n\n        2, x\n    # after\n  c:\n    model_answer: word\n";
        let tree = crate::source::parse(source).unwrap();
        let mut assembly = Assembly::new("lab");
        for (id, _, question) in tree.get("questions").unwrap().as_mapping().unwrap() {
            let (key, value) = question.entry("model_answer").unwrap();
            assert_eq!(assembly.add(id, source, key, value), None);
        }
        let expected = "answers:\n  a.b:\n    poles: [1,\n      2]\n    data: |\n      0, 1\n  \n      2, x\n  c: word\n";
        assert!(assembly.text.ends_with(expected), "{}", assembly.text);
        for part in ["[1,", "2]", "2, x", "word"] {
            let (here, there) = (assembly.text.rfind(part).unwrap(), source.rfind(part).unwrap());
            let span = assembly.origin(Span { start: here, end: here + part.len() });
            assert_eq!(span, Span { start: there, end: there + part.len() }, "{part}");
        }
    }
}
