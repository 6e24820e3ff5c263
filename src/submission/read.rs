use super::comma_to_point::{Pointed, commas_read, only_decimal_in_poles, settled};
use super::decimal_commas::{decimal_comma_between, rejoined_poles};
use super::figure::parse_figure;
use super::formula::read_transfer_function;
use super::half_said;
use super::poles::{MAX_POLES, MOST_POLE_BYTES, ReadPole, parse_poles};
use super::problem::{Problem, quote, sentence};
use super::salvage::{Salvaged, salvage};
use super::series::{parse_series, rows_as_text};
use super::value::parse_value;
use super::words::{
    NONLINEARITY_WORDS, SHAPE_WORDS, STABILITY_WORDS, half_a_shape, nonlinearities_named, shapes_named,
    stabilities_named,
};
use super::wrapping::{unwrapped, without_marks};
use super::{
    Answer, AnswerSheet, AnswerValue, Attachments, Decimal, Field, FieldKind, MAX_ATTACHMENT_BYTES,
    Submission, TypedComplex, TypedFormula, Unreadable, nonlinearity_word, people, shape_word,
    stability_word,
};
use crate::lti::InputKind;
use crate::names::nearest;
use crate::source::{
    DecodeError, Finding, Node, SourceText, Span, Value, YamlError, decode, decode_within,
    parse_with_duplicates,
};
use std::collections::BTreeMap;

/// Prose in one answer, in bytes.
pub const MAX_PROSE_BYTES: usize = 20_000;

/// Findings kept of one file; the rest are counted.
const MAX_FINDINGS: usize = 100;

/// Reads one answer file against what the sheet asks for: what could be read, and a finding for all that could not.
///
/// `id` is the file's stem, `name` the name it is shown by. Never fails: a file that cannot be read at all is a
/// [`Submission`] that says so.
pub fn read(
    id: &str,
    name: &str,
    bytes: &[u8],
    sheet: &AnswerSheet,
    attachments: &dyn Attachments,
) -> Submission {
    let submission = |text: String| Submission {
        id: id.to_owned(),
        source: SourceText::new(name, text),
        lab: None,
        students: Vec::new(),
        answers: BTreeMap::new(),
        findings: Vec::new(),
        readable: false,
    };
    let text = match decode(bytes) {
        Ok(text) => text,
        Err(error) => {
            let mut submission = submission(String::new());
            submission.students = people::nobody(id);
            submission.findings.push(match error {
                DecodeError::TooLarge { limit, .. } => Finding::error(
                    "file.too_large",
                    format!("The file is larger than the {} kB we read.", limit / 1024),
                )
                .with_help(
                    "Keep pictures and long tables in files of their own, and write their names here.",
                ),
                DecodeError::NotText { .. } => {
                    Finding::error("file.not_text", format!("The file cannot be read as text: {error}."))
                        .with_help("Save the answers as plain text in UTF-8.")
                }
            });
            return submission;
        }
    };
    let mut submission = submission(text);
    let whole = parse_with_duplicates(&submission.source.text);
    let parts = if whole.is_err() { salvage(&submission.source.text) } else { None };
    match parts.map_or_else(|| whole.map(|tree| Salvaged { tree, lost: Vec::new() }), Ok) {
        Ok(Salvaged { tree, lost }) => {
            let text = std::mem::take(&mut submission.source.text);
            let mut reader = Reader::new(&text, sheet, attachments);
            reader.lost = lost.into_iter().collect();
            reader.document(&tree, id, &mut submission);
            half_said::complete(sheet, &mut reader.answers, &mut reader.findings.kept);
            submission.answers = reader.answers;
            submission.findings = reader.findings.finish();
            submission.readable = !tree_is_text(&tree);
            submission.source.text = text;
        }
        Err(error) => {
            submission.findings.push(not_yaml(error));
            submission.lab = people::salvage_lab(&submission.source.text);
            let (students, finding) = people::salvage(&submission.source.text, id);
            submission.students = students;
            submission.findings.push(finding);
        }
    }
    submission
}

/// Text or a list at the top is not an answer file.
fn tree_is_text(tree: &Node) -> bool {
    matches!(tree.value, Value::Scalar(_) | Value::Sequence(_))
}

fn not_yaml(error: YamlError) -> Finding {
    let message = match error.help {
        Some(_) => sentence(&error.message),
        None => {
            format!("From here on the file cannot be read as YAML: {}.", error.message.trim_end_matches('.'))
        }
    };
    let finding = Finding::error("file.not_yaml", message).with_help(error.help.unwrap_or(
        "Look for an open quote or bracket, a tab where spaces should indent, or text with `: ` in it; put such text \
         on lines of its own after `|`.",
    ));
    Finding { span: error.span, ..finding }
}

/// Findings up to a limit.
#[derive(Default)]
struct Findings {
    kept: Vec<Finding>,
    dropped: usize,
}

impl Findings {
    fn is_full(&self) -> bool {
        self.kept.len() >= MAX_FINDINGS
    }

    fn push(&mut self, finding: Finding) {
        if self.is_full() {
            self.dropped += 1;
        } else {
            self.kept.push(finding);
        }
    }

    fn finish(mut self) -> Vec<Finding> {
        if self.dropped > 0 {
            let message = format!("There are {} more findings like these.", self.dropped);
            self.kept.push(Finding::note("file.more_findings", message));
        }
        self.kept
    }
}

struct Reader<'a> {
    text: &'a str,
    sheet: &'a AnswerSheet,
    attachments: &'a dyn Attachments,
    /// By path, hyphens, spaces and capitals aside.
    fields: BTreeMap<String, &'a Field>,
    answers: BTreeMap<String, Answer>,
    findings: Findings,
    /// Answers that are no YAML, by where their key begins.
    lost: BTreeMap<usize, Finding>,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, sheet: &'a AnswerSheet, attachments: &'a dyn Attachments) -> Self {
        let fields = sheet.fields.iter().map(|field| (plain_key(&field.path), field)).collect();
        let (answers, findings, lost) = (BTreeMap::new(), Findings::default(), BTreeMap::new());
        Self { text, sheet, attachments, fields, answers, findings, lost }
    }

    fn document(&mut self, tree: &Node, id: &str, submission: &mut Submission) {
        let mut people = people::People::default();
        match &tree.value {
            Value::Null => {}
            Value::Mapping(entries) => {
                for (key, span, node) in entries {
                    match plain_key(key).as_str() {
                        "lab" => self.lab(*span, node, submission),
                        "student" | "students" => people.read(*span, node),
                        "answers" | "answer" => self.answers(node),
                        other if self.is_wanted(other) => {
                            self.findings.push(
                                Finding::note(
                                    "key.outside_answers",
                                    format!(
                                        "{} stands beside `answers:` and is read as if it stood under it.",
                                        quote(key)
                                    ),
                                )
                                .at(*span),
                            );
                            self.entry("", key, *span, node);
                        }
                        _ => self.unknown_key(key, *span, true),
                    }
                }
            }
            Value::Scalar(_) | Value::Sequence(_) => self.findings.push(
                Finding::error(
                    "file.not_a_mapping",
                    format!(
                        "An answer file has keys such as `student:` and `answers:`; this one holds {}.",
                        tree.kind()
                    ),
                )
                .with_help("`polemark new` writes an answer file to fill in.")
                .at(tree.span),
            ),
        }
        let (students, findings) = people.finish(id);
        submission.students = students;
        findings.into_iter().for_each(|finding| self.findings.push(finding));
        if submission.lab.is_none() && tree.as_mapping().is_some() {
            let message =
                format!("The file does not say which lab it answers; it is read as `{}`.", self.sheet.lab);
            let help = format!("Begin the file with `lab: {}`.", self.sheet.lab);
            self.findings.push(Finding::warning("lab.missing", message).with_help(help));
        }
    }

    fn lab(&mut self, key: Span, node: &Node, submission: &mut Submission) {
        let Some(name) = node.as_scalar().map(str::trim).filter(|name| !is_blank_text(name)) else { return };
        submission.lab = Some(name.chars().take(200).collect());
        if !name.eq_ignore_ascii_case(self.sheet.lab.trim()) {
            let message = format!("The file answers {}, and is read as `{}`.", quote(name), self.sheet.lab);
            let help = format!("If these are the right answers, write `lab: {}`.", self.sheet.lab);
            let span = if node.span.start < node.span.end { node.span } else { key };
            self.findings.push(Finding::error("lab.other", message).with_help(help).at(span));
        }
    }

    fn answers(&mut self, node: &Node) {
        match &node.value {
            Value::Null => {}
            Value::Mapping(entries) => {
                entries.iter().for_each(|(key, span, child)| self.entry("", key, *span, child));
            }
            Value::Scalar(_) | Value::Sequence(_) if is_blank(node) => {}
            Value::Scalar(_) | Value::Sequence(_) => self.findings.push(
                Finding::error(
                    "answers.not_a_mapping",
                    format!("Under `answers:` each answer has its key; {} stands there.", node.kind()),
                )
                .with_help("Write an answer as `key: value` on a line of its own, indented by two spaces.")
                .at(node.span),
            ),
        }
    }

    /// Whether a field has this path, or lies beneath it.
    fn is_wanted(&self, path: &str) -> bool {
        self.fields.contains_key(path) || self.beneath(path).next().is_some()
    }

    fn beneath(&self, path: &str) -> impl Iterator<Item = &'a Field> {
        let prefix = format!("{path}.");
        self.fields
            .range(prefix.clone()..)
            .take_while(move |(key, _)| key.starts_with(&prefix))
            .map(|(_, field)| *field)
    }

    fn entry(&mut self, above: &str, key: &str, span: Span, node: &Node) {
        let own = plain_key(key);
        let path = if above.is_empty() { own } else { format!("{above}.{own}") };
        if let Some(finding) = self.lost.remove(&span.start) {
            return self.lose(&path, span, finding);
        }
        if let Some(field) = self.fields.get(path.as_str()) {
            return self.field(field, span, node);
        }
        let beneath: Vec<&Field> = self.beneath(&path).take(2).collect();
        let Some(first) = beneath.first() else {
            let shown = if above.is_empty() { key.to_owned() } else { format!("{above}.{key}") };
            return self.unknown_key(&shown, span, false);
        };
        match &node.value {
            Value::Null => {}
            Value::Mapping(entries) => {
                entries.iter().for_each(|(key, span, child)| self.entry(&path, key, *span, child));
            }
            Value::Scalar(_) | Value::Sequence(_) if is_blank(node) => {}
            Value::Scalar(_) | Value::Sequence(_) => {
                let message = format!("`{path}` has entries of its own, and {} stands there.", node.kind());
                let help = if beneath.len() > 1 { "Write, for example," } else { "Write" };
                self.findings.push(
                    Finding::error("key.too_short", message)
                        .with_help(format!("{help} `{}: …`.", first.path))
                        .at(span),
                );
            }
        }
    }

    /// An answer, or all beneath its path, that is no YAML.
    fn lose(&mut self, path: &str, span: Span, finding: Finding) {
        let own = self.fields.get(path).copied();
        for field in own.into_iter().chain(self.beneath(path)).collect::<Vec<_>>() {
            let text = self.text.get(span.start..span.end).unwrap_or_default().to_owned();
            let value = Err(Unreadable { finding: finding.clone() });
            let answer = Answer { path: field.path.clone(), span, text, value };
            self.answers.entry(field.path.clone()).or_insert(answer);
        }
        self.findings.push(finding);
    }

    fn unknown_key(&mut self, key: &str, span: Span, top: bool) {
        if self.findings.is_full() {
            self.findings.dropped += 1;
            return;
        }
        let mut known: Vec<&str> = Vec::new();
        if top {
            known.extend(["lab", "student", "students", "answers"]);
        }
        for field in &self.sheet.fields {
            let dots = field.path.match_indices('.').map(|(i, _)| &field.path[..i]);
            dots.chain([field.path.as_str()]).for_each(|path| {
                if !known.contains(&path) {
                    known.push(path);
                }
            });
        }
        let mut finding =
            Finding::error("key.unknown", format!("{} is not asked for in this lab.", quote(key)));
        if let Some(near) = nearest(&plain_key(key), known) {
            finding.message = format!("{} is not asked for; did you mean `{near}`?", quote(key));
            finding.help = Some(format!("Write `{near}:` if that is what this answers."));
        }
        self.findings.push(finding.at(span));
    }

    fn field(&mut self, field: &Field, key: Span, node: &Node) {
        if is_blank(node) || node.as_scalar().is_some_and(|text| text.trim() == field.prompt.trim()) {
            return;
        }
        let text = match node.as_scalar() {
            Some(text) => text.to_owned(),
            None => self.text.get(node.span.start..node.span.end).unwrap_or_default().to_owned(),
        };
        let span = if node.span.start < node.span.end { node.span } else { key };
        if let Some(before) = self.answers.get(&field.path) {
            if before.text == text {
                return;
            }
            let first = SourceText::new("", self.text).position(before.span.start).line;
            let message = format!(
                "`{}` is answered twice, with different answers; the first is on line {first}.",
                field.path
            );
            let finding = Finding::error("answer.twice", message).with_help("Keep one of the two.").at(key);
            self.findings.push(finding.clone());
            if let Some(answer) = self.answers.get_mut(&field.path) {
                answer.value = Err(Unreadable { finding });
            }
            return;
        }
        let value = match self.value(field, node) {
            Ok(value) => Ok(value),
            Err(mut finding) => {
                finding.span = finding.span.or(Some(span));
                self.findings.push((*finding).clone());
                Err(Unreadable { finding: *finding })
            }
        };
        self.answers.insert(field.path.clone(), Answer { path: field.path.clone(), span, text, value });
    }

    fn value(&mut self, field: &Field, node: &Node) -> Result<AnswerValue, Box<Finding>> {
        match field.kind {
            FieldKind::TransferFunction => {
                let (value, notes) = read_transfer_function(node, self.sheet, &field.path, self.text)?;
                notes.into_iter().for_each(|note| self.findings.push(note));
                Ok(value)
            }
            FieldKind::Poles => self.poles(node).map(AnswerValue::Poles),
            FieldKind::Value => {
                let text = scalar(node, "value.unreadable", "A single value is asked for here")?;
                let text = &unwrapped(text);
                let pointed = Pointed::read(text, 0, settled([&**text]))
                    .map_err(|problem| self.place(problem, node))?;
                let limit = ["initial_value", "final_value"].iter().any(|end| field.path.ends_with(end));
                let value = parse_value(&pointed.text, field.unit.as_ref(), limit)
                    .map_err(|problem| self.place(problem, node))?;
                self.say_commas(&pointed.places(node, self.text));
                Ok(AnswerValue::Value(value))
            }
            FieldKind::Stability => {
                let kind = Kind { name: "stability", code: "stability.unreadable", words: STABILITY_WORDS };
                let read = word(node, &kind, stability_word, stabilities_named);
                read.map(AnswerValue::Stability).map_err(|finding| {
                    let lower = node.as_scalar().map(str::to_lowercase).unwrap_or_default();
                    if lower.contains("not asymptotically") || lower.contains("not strictly") {
                        let help = "Does it stay bounded? Write `marginally stable` if it does, and `unstable` if not.";
                        return Box::new(finding.with_help(help));
                    }
                    finding
                })
            }
            FieldKind::Shape => {
                let kind = Kind { name: "a shape", code: "shape.unreadable", words: SHAPE_WORDS };
                // `rises exponentially` may be meant for either in the response to a step.
                let step = field.response == Some(InputKind::Step);
                let half = |text: &str| step && half_a_shape(text).is_some();
                let read = word(node, &kind, |text| shape_word(text).filter(|_| !half(text)), shapes_named);
                read.map(AnswerValue::Shape).map_err(|finding| {
                    match node.as_scalar().and_then(half_a_shape) {
                        Some(half) => Box::new(finding.with_help(half.help())),
                        None => finding,
                    }
                })
            }
            FieldKind::Nonlinearity => {
                let kind = Kind {
                    name: "a nonlinearity",
                    code: "nonlinearity.unreadable",
                    words: NONLINEARITY_WORDS,
                };
                word(node, &kind, nonlinearity_word, nonlinearities_named).map(AnswerValue::Nonlinearity)
            }
            FieldKind::Formula => {
                let text = scalar(node, "formula.unreadable", "A single formula is asked for here")?;
                TypedFormula::read(text).map(AnswerValue::Formula).map_err(|p| self.place(p, node))
            }
            FieldKind::Prose => prose(node).map(AnswerValue::Prose),
            FieldKind::Figure => {
                let name =
                    scalar(node, "figure.unreadable", "The name of one picture is asked for here")?.trim();
                let bytes = self.attached(name, "figure.not_read", "impulse.png")?;
                parse_figure(name, bytes).map(AnswerValue::Figure).map_err(|f| named(name, f))
            }
            FieldKind::Data => self.data(node).map(AnswerValue::Data),
        }
    }

    fn place(&self, problem: Problem, node: &Node) -> Box<Finding> {
        Box::new(problem.into_finding(node, self.text))
    }

    fn say_commas(&mut self, places: &[(Span, String)]) {
        commas_read(places, self.text).into_iter().for_each(|finding| self.findings.push(finding));
    }

    fn poles(&mut self, node: &Node) -> Result<Vec<TypedComplex>, Box<Finding>> {
        let (items, entry) = match &node.value {
            Value::Sequence(items) => (items.as_slice(), true),
            _ => (std::slice::from_ref(node), false),
        };
        let rejoined = rejoined_poles(items, self.text);
        let items = rejoined.as_deref().unwrap_or(items);
        if rejoined.is_none()
            && let Some(finding) = decimal_comma_between(items, self.text, true)
        {
            return Err(Box::new(finding));
        }
        let settled = settled(items.iter().filter_map(Node::as_scalar));
        let (mut poles, mut commas) = (Vec::new(), Vec::new());
        for item in items.iter().filter(|item| !is_blank(item)) {
            poles.extend(self.pole(item, entry, settled, &mut commas)?);
            if poles.len() > MAX_POLES {
                let message = format!("The list has more than the {MAX_POLES} poles we read.");
                return Err(Box::new(Finding::error("poles.too_many", message).at(node.span)));
            }
        }
        self.say_commas(&commas);
        Ok(poles)
    }

    /// One or more poles as text; `entry`: in a list of its own. Adds its decimal commas to `commas`.
    fn poles_of(
        &self,
        node: &Node,
        text: &str,
        entry: bool,
        settled: bool,
        commas: &mut Vec<(Span, String)>,
    ) -> Result<Vec<TypedComplex>, Box<Finding>> {
        if text.len() > MOST_POLE_BYTES {
            let message = format!("This list is longer than the {MOST_POLE_BYTES} bytes that are read.");
            return Err(Box::new(Finding::error("poles.too_many", message).at(node.span)));
        }
        let text = &without_marks(text);
        let pointed = match only_decimal_in_poles(text, entry) {
            true => Pointed::read(text, 0, settled),
            false => Pointed::as_typed(text),
        };
        let pointed = pointed.map_err(|problem| self.place(problem, node))?;
        let read = parse_poles(&pointed.text).map_err(|problem| self.place(problem, node))?;
        commas.extend(pointed.places(node, self.text));
        let typed = |read: ReadPole| TypedComplex {
            span: node.locate(self.text, read.start, read.end),
            re: read.re,
            im: read.im,
        };
        Ok(read.into_iter().map(typed).collect())
    }

    /// An entry of the list: text, or `{value: -1, multiplicity: 2}`.
    fn pole(
        &self,
        item: &Node,
        entry: bool,
        settled: bool,
        commas: &mut Vec<(Span, String)>,
    ) -> Result<Vec<TypedComplex>, Box<Finding>> {
        const HELP: &str =
            "Write a pole like `-2+3.1j`, `{re: -2, im: 3.1}` or `{value: -1, multiplicity: 2}`.";
        match &item.value {
            Value::Scalar(text) => self.poles_of(item, text, entry, settled, commas),
            Value::Mapping(entries) => {
                let (mut value, mut times) = (None, 1);
                let mut parts: [Option<Decimal>; 2] = [None, None];
                for (key, span, node) in entries {
                    let text = scalar(node, "poles.unreadable", "A number is asked for here")?;
                    match plain_key(key).as_str() {
                        "value" | "pole" | "at" => value = Some((node, text)),
                        "multiplicity" | "times" | "order" | "m" => match text.trim().parse::<usize>() {
                            Ok(n) if (1..=MAX_POLES).contains(&n) => times = n,
                            _ => {
                                let message = format!("{} is not a multiplicity.", quote(text));
                                let finding = Finding::error("poles.multiplicity", message).with_help(HELP);
                                return Err(Box::new(finding.at(node.span)));
                            }
                        },
                        part @ ("re" | "real" | "im" | "imag" | "imaginary") => {
                            let number = Pointed::as_typed(text).and_then(|pointed| {
                                Decimal::parse(&pointed.text).map_err(|error| {
                                    Problem::new("poles.unreadable", 0, text.len(), format!("{error}."))
                                        .help(HELP)
                                })
                            });
                            let number = number.map_err(|problem| self.place(problem, node))?;
                            parts[usize::from(part.starts_with('i'))] = Some(number);
                        }
                        _ => {
                            let message = format!("{} is not a part of a pole.", quote(key));
                            return Err(Box::new(
                                Finding::error("poles.unreadable", message).with_help(HELP).at(*span),
                            ));
                        }
                    }
                }
                if value.is_none()
                    && let [Some(_), _] | [_, Some(_)] = parts
                {
                    let [re, im] = parts.map(|part| part.unwrap_or_else(Decimal::absent));
                    return Ok(vec![TypedComplex { re, im, span: item.span }; times]);
                }
                let Some((node, text)) = value.filter(|_| parts == [None, None]) else {
                    let finding =
                        Finding::error("poles.unreadable", "A pole has either a `value`, or `re` and `im`.")
                            .with_help(HELP);
                    return Err(Box::new(finding.at(item.span)));
                };
                let once = self.poles_of(node, text, true, settled, commas)?;
                Ok(once.iter().flat_map(|pole| std::iter::repeat_n(pole.clone(), times)).collect())
            }
            Value::Sequence(_) | Value::Null => {
                let message = format!("A pole is asked for here, and {} is given.", item.kind());
                Err(Box::new(Finding::error("poles.unreadable", message).with_help(HELP).at(item.span)))
            }
        }
    }

    fn data(&self, node: &Node) -> Result<super::Series, Box<Finding>> {
        if let Value::Sequence(rows) = &node.value {
            let Some(text) = rows_as_text(rows) else {
                let message = "A table is a list of rows, each a list like `[0.1, 0.25]`.";
                return Err(Box::new(Finding::error("data.unreadable", message).at(node.span)));
            };
            return parse_series("inline", &text).map_err(Box::new);
        }
        let text =
            scalar(node, "data.unreadable", "The name of one data file, or its text, is asked for here")?;
        if text.trim().contains('\n') {
            return parse_series("inline", text).map_err(Box::new);
        }
        let name = text.trim();
        let bytes = self.attached(name, "data.not_read", "impulse.csv")?;
        let text = decode_within(&bytes, MAX_ATTACHMENT_BYTES).map_err(|error| {
            let finding =
                Finding::error("data.unreadable", format!("The data cannot be read as text: {error}."))
                    .with_help("Export the data as CSV, not as a spreadsheet.");
            named(name, finding)
        })?;
        parse_series(name, &text).map_err(|finding| named(name, finding))
    }

    fn attached(&self, name: &str, code: &'static str, example: &str) -> Result<Vec<u8>, Box<Finding>> {
        self.attachments.read(name).map_err(|error| {
            let help = format!("Put the file beside the answer file and write its name, like `{example}`.");
            Box::new(
                Finding::error(code, format!("The file {} is not read. {error}", quote(name)))
                    .with_help(help),
            )
        })
    }
}

/// The finding, with the file's name in front.
fn named(name: &str, finding: Finding) -> Box<Finding> {
    Box::new(Finding { message: format!("In {}: {}", quote(name), finding.message), ..finding })
}

fn scalar<'n>(node: &'n Node, code: &'static str, wanted: &str) -> Result<&'n str, Box<Finding>> {
    node.as_scalar().ok_or_else(|| {
        let message = format!("{wanted}, and {} is given.", node.kind());
        let help = "Write it after the key, without brackets: `key: value`.";
        Box::new(Finding::error(code, message).with_help(help).at(node.span))
    })
}

/// What one word is asked for.
struct Kind {
    name: &'static str,
    code: &'static str,
    words: &'static [&'static str],
}

/// `named`: what a text names, where it names several.
fn word<T>(
    node: &Node,
    kind: &Kind,
    read: impl Fn(&str) -> Option<T>,
    named: impl Fn(&str) -> Vec<&'static str>,
) -> Result<T, Box<Finding>> {
    let &Kind { name, code, words } = kind;
    let ticked = |words: &[&str], joint: &str| {
        words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(joint)
    };
    // `[dead zone]`: a list of one.
    let node = match node.as_sequence() {
        Some([only]) => only,
        _ => node,
    };
    let wanted = format!("A word for {} is asked for here", name.trim_start_matches("a "));
    let one_word = format!("Give one word: {}.", ticked(words, ", "));
    let text = scalar(node, code, &wanted).map_err(|finding| Box::new(finding.with_help(&one_word)))?;
    read(text).ok_or_else(|| {
        let named = named(text);
        let (message, help) = if named.len() > 1 {
            let message = format!("{} names more than one, and one is asked for.", quote(text));
            (message, format!("Give one: {}.", ticked(&named, " or ")))
        } else {
            let help = match nearest_words(text.trim(), words) {
                Some(near) => format!("Did you mean `{near}`? {one_word}"),
                None => one_word,
            };
            (format!("{} is not read as one word for {name}.", quote(text)), help)
        };
        Box::new(Finding::error(code, message).with_help(help).at(node.span))
    })
}

/// The answer that differs from `text` by slips alone, word by word: `not unstable` is not meant for `unstable`.
fn nearest_words<'w>(text: &str, answers: &[&'w str]) -> Option<&'w str> {
    let alike = |answer: &str| {
        text.split_whitespace().count() == answer.split_whitespace().count()
            && text.split_whitespace().zip(answer.split_whitespace()).all(|(a, b)| nearest(a, [b]).is_some())
    };
    nearest(text, answers.iter().copied().filter(|answer| alike(answer)))
}

fn prose(node: &Node) -> Result<String, Box<Finding>> {
    let text = match &node.value {
        Value::Scalar(text) => text.clone(),
        // Points written as a YAML list.
        Value::Sequence(items) if items.iter().all(|item| item.as_scalar().is_some()) => {
            items.iter().filter_map(Node::as_scalar).map(|item| format!("- {item}\n")).collect()
        }
        _ => {
            let message = format!("Text is asked for here, and {} is given.", node.kind());
            let help = "Write the text on lines of its own after `|`, indented by two spaces.";
            return Err(Box::new(Finding::error("prose.unreadable", message).with_help(help).at(node.span)));
        }
    };
    if text.len() > MAX_PROSE_BYTES {
        let message =
            format!("The text has {} bytes, more than the {MAX_PROSE_BYTES} that are read.", text.len());
        return Err(Box::new(Finding::error("prose.too_long", message).at(node.span)));
    }
    Ok(text)
}

/// Nothing is written, or only what the answer template holds.
fn is_blank(node: &Node) -> bool {
    match &node.value {
        Value::Null => true,
        Value::Scalar(text) => is_blank_text(text),
        Value::Sequence(items) => items.iter().all(is_blank),
        Value::Mapping(entries) => entries.iter().all(|(_, _, child)| is_blank(child)),
    }
}

/// Empty, invisible, or a place kept free: `…`, `...`, `?`, `___`, `TODO`, `<your answer>`.
fn is_blank_text(text: &str) -> bool {
    let text = text.trim_matches(|c: char| {
        c.is_whitespace() || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{feff}' | '\u{ad}')
    });
    let same = |c: char| text.chars().all(|d| d == c);
    let kept_free =
        text.starts_with('<') && text.ends_with('>') && text.len() <= 60 && !text.contains(['/', '=', '(']);
    same('_')
        || same('.')
        || same('…')
        || same('?')
        || kept_free
        || ["todo", "tbd"].contains(&text.to_lowercase().as_str())
}

/// A key as it is compared: small letters, `_` for spaces and hyphens.
fn plain_key(key: &str) -> String {
    key.trim().to_lowercase().replace([' ', '-'], "_")
}

#[cfg(test)]
mod tests {
    use super::nearest_words;

    #[test]
    fn only_slips_are_taken_for_an_answer() {
        let answers = ["stable", "unstable", "exponential decay", "dead zone"];
        for (text, expected) in [
            ("stabel", Some("stable")),
            ("expnential decay", Some("exponential decay")),
            ("daed zone", Some("dead zone")),
            ("not unstable", None),
            ("exponential rise", None),
        ] {
            assert_eq!(nearest_words(text, &answers), expected, "{text}");
        }
    }
}
