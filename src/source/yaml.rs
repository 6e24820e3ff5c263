use super::{Span, sanitize};
use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_yaml::budget::BudgetBreach;
use serde_yaml::{DuplicateKeyPolicy, Error, Location, MergeKeyPolicy, NonFiniteFloatPolicy, Spanned};
use std::fmt;

/// A YAML node and where it stands.
///
/// A scalar's span covers its source text, quotes included and a block's `|` left out; the span of a mapping or a sequence
/// reaches from its start to the end of its last entry, or to its closing bracket. An alias stands where its anchor stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    pub value: Value,
    pub span: Span,
}

/// What a node holds. Scalars stay text as typed: what they mean depends on who asks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Value {
    Null,
    Scalar(String),
    Sequence(Vec<Node>),
    /// Keys in file order, with where each key stands.
    Mapping(Vec<(String, Span, Node)>),
}

/// Why a text is not YAML we accept. Lower case, no full stop.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct YamlError {
    pub message: String,
    /// What to do, as a sentence. `None` when the text breaks the rules of YAML at this place.
    pub help: Option<&'static str>,
    pub span: Option<Span>,
}

impl Node {
    /// The value under `key` when this is a mapping that has it; the first one when it is there twice.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.entry(key).map(|(_, node)| node)
    }

    /// Like [`Node::get`], with where the key stands.
    pub fn entry(&self, key: &str) -> Option<(Span, &Node)> {
        self.as_mapping()?.iter().find(|(k, _, _)| k == key).map(|(_, span, node)| (*span, node))
    }

    /// The text of a scalar as typed (`1.50` stays `1.50`), quotes removed and escapes resolved.
    pub fn as_scalar(&self) -> Option<&str> {
        match &self.value {
            Value::Scalar(text) => Some(text),
            _ => None,
        }
    }

    pub fn as_sequence(&self) -> Option<&[Node]> {
        match &self.value {
            Value::Sequence(items) => Some(items),
            _ => None,
        }
    }

    pub fn as_mapping(&self) -> Option<&[(String, Span, Node)]> {
        match &self.value {
            Value::Mapping(entries) => Some(entries),
            _ => None,
        }
    }

    pub fn is_null(&self) -> bool {
        self.value == Value::Null
    }

    /// What it is, for messages: `text`, `a list`, `a mapping`, `nothing`.
    pub fn kind(&self) -> &'static str {
        match self.value {
            Value::Null => "nothing",
            Value::Scalar(_) => "text",
            Value::Sequence(_) => "a list",
            Value::Mapping(_) => "a mapping",
        }
    }

    /// Where bytes `start..end` of this scalar's text stand in `source`, the file it was read from.
    ///
    /// Quotes, escapes, indentation and folded lines are stepped over; the whole node's span when that fails.
    pub fn locate(&self, source: &str, start: usize, end: usize) -> Span {
        self.as_scalar()
            .and_then(|text| {
                let raw = source.get(self.span.start..self.span.end)?;
                let from = align(text, raw, start.min(text.len()))?;
                let to = match end.min(text.len()) {
                    last if last > start => align(text, raw, last - 1)? + 1,
                    _ => from + 1,
                };
                Some(Span { start: self.span.start + from, end: (self.span.start + to).min(self.span.end) })
            })
            .map(|span| snap(source, span))
            .unwrap_or(self.span)
    }
}

/// Where byte `offset` of `text` stands in `raw`, the same text as written with quotes, escapes and indentation.
fn align(text: &str, raw: &str, offset: usize) -> Option<usize> {
    if raw.len() == text.len() {
        return Some(offset);
    }
    let quote = raw.chars().next().filter(|c| matches!(c, '"' | '\'') && !text.starts_with(*c));
    let mut rest = raw.get(quote.map_or(0, char::len_utf8)..)?.char_indices().peekable();
    let skipped = usize::from(quote.is_some());
    for (i, c) in text.char_indices() {
        let place = loop {
            let (place, written) = rest.next()?;
            if written == '\\' && quote == Some('"') {
                let (_, escape) = rest.next()?;
                let digits = match escape {
                    'x' => 2,
                    'u' => 4,
                    'U' => 8,
                    _ => 0,
                };
                rest.by_ref().take(digits).for_each(|_| {});
                break place;
            }
            if written == c || (written.is_whitespace() && c.is_whitespace()) {
                break place;
            }
        };
        if i + c.len_utf8() > offset {
            return Some(skipped + place + offset - i);
        }
    }
    None
}

/// The smallest span on character boundaries that covers `span`.
fn snap(source: &str, span: Span) -> Span {
    let (mut start, mut end) = (span.start.min(source.len()), span.end.min(source.len()));
    while !source.is_char_boundary(start) {
        start -= 1;
    }
    while !source.is_char_boundary(end) {
        end += 1;
    }
    Span { start, end: end.max(start) }
}

/// Reads one YAML document within fixed budgets (size, depth, aliases), as a tree with places.
///
/// An empty document is [`Value::Null`]. Refused: keys given twice, merge keys (`<<`), a second document.
pub fn parse(text: &str) -> Result<Node, YamlError> {
    without_duplicates(parse_with_duplicates(text)?)
}

/// Like [`parse`], for a file about a whole class: a hundred times as long.
pub fn parse_of_class(text: &str) -> Result<Node, YamlError> {
    without_duplicates(parse_within(text, 100)?)
}

fn without_duplicates(tree: Node) -> Result<Node, YamlError> {
    match first_duplicate(&tree) {
        Some((key, span)) => Err(YamlError {
            message: format!("the key `{}` is given twice", sanitize(key)),
            help: Some("Keep one of the two."),
            span: Some(span),
        }),
        None => Ok(tree),
    }
}

/// Like [`parse`], but a key given twice stays in the tree twice, for the caller to judge.
pub fn parse_with_duplicates(text: &str) -> Result<Node, YamlError> {
    parse_within(text, 1)
}

/// Within so many times the usual limits.
fn parse_within(text: &str, times: usize) -> Result<Node, YamlError> {
    let start = if text.starts_with('\u{feff}') { 3 } else { 0 };
    let body = &text[start..];
    if body.lines().all(|line| line.trim().is_empty() || line.trim_start().starts_with('#')) {
        return Ok(Node { value: Value::Null, span: Span { start, end: start } });
    }
    let shifted = |span: Span| Span { start: span.start + start, end: span.end + start };
    serde_yaml::from_str_with_options::<Spanned<Raw>>(body, options(times))
        .map(|raw| raw.into_node(body))
        .map(|node| if start == 0 { node } else { node.shift(start) })
        .map_err(|error| {
            let (message, help) = explained(&error);
            YamlError { message, help, span: place(&error, body).map(shifted) }
        })
}

fn options(times: usize) -> serde_yaml::Options {
    serde_yaml::options! {
        budget: serde_yaml::budget! {
            max_depth: 24,
            flow_nesting_limit: 16,
            max_nodes: 20_000 * times,
            max_events: 60_000 * times,
            max_total_scalar_bytes: 1_000_000 * times,
            max_aliases: 100,
            max_anchors: 100,
            max_documents: 1,
        },
        with_snippet: false,
        duplicate_keys: DuplicateKeyPolicy::PassThrough,
        merge_keys: MergeKeyPolicy::Error,
        non_finite_float_policy: NonFiniteFloatPolicy::PassThrough,
        ignore_binary_tag_for_string: true,
    }
}

fn first_duplicate(node: &Node) -> Option<(&str, Span)> {
    match &node.value {
        Value::Null | Value::Scalar(_) => None,
        Value::Sequence(items) => items.iter().find_map(first_duplicate),
        Value::Mapping(entries) => {
            let mut seen = std::collections::BTreeSet::new();
            entries
                .iter()
                .find(|(key, _, _)| !seen.insert(key.as_str()))
                .map(|(key, span, _)| (key.as_str(), *span))
                .or_else(|| entries.iter().find_map(|(_, _, child)| first_duplicate(child)))
        }
    }
}

/// What is wrong, and what to do about it; without a help it is the syntax.
fn explained(error: &Error) -> (String, Option<&'static str>) {
    let explain = |message: &str, help| (message.to_owned(), Some(help));
    match cause(error) {
        Error::MultipleDocuments { .. } | Error::Budget { breach: BudgetBreach::Documents { .. }, .. } => {
            explain("a second document starts here (`---`)", "Keep one document in the file, without `---`.")
        }
        Error::Budget { breach: BudgetBreach::Nodes { .. } | BudgetBreach::Events { .. }, .. } => {
            (format!("the file has more than {MOST_NODES} values"), Some(TABLES))
        }
        Error::Budget {
            breach: BudgetBreach::ScalarBytes { .. } | BudgetBreach::InputBytes { .. }, ..
        } => explain("the file has more than 1,000,000 bytes of text, aliases written out", TABLES),
        Error::Budget { breach: BudgetBreach::Depth { .. }, .. } => {
            explain("lists and mappings are nested too deeply here", FLATTER)
        }
        Error::RecursiveReferencesRequireWeakTypes { .. } => explain(
            "an anchor (`&name`) is used within itself",
            "Write out what is meant; put text that begins with `&` or `*` in quotes.",
        ),
        Error::Budget { .. }
        | Error::AliasReplayCounterOverflow { .. }
        | Error::AliasReplayLimitExceeded { .. }
        | Error::AliasExpansionLimitExceeded { .. }
        | Error::AliasReplayStackDepthExceeded { .. } => {
            explain("the file repeats itself too often with aliases (`*name`)", "Write out what is meant.")
        }
        Error::MergeKeyNotAllowed { .. } => {
            explain("merge keys (`<<`) are not read", "Write out the keys that are meant.")
        }
        Error::UnknownAnchor { .. } => explain(
            "text that begins with `*` is an alias in YAML, and no anchor has that name",
            "Put such text in quotes, or on lines of its own after `|`.",
        ),
        error => match plain_message(error) {
            message if message.contains("recursion limit") => {
                explain("brackets are nested too deeply here", FLATTER)
            }
            message => (message, None),
        },
    }
}

const MOST_NODES: &str = "20,000";
const TABLES: &str = "Keep long tables in a file of their own beside this one, and write its name here.";
const FLATTER: &str = "Use fewer lists within lists; put text with brackets in quotes.";

/// The error behind an alias that was followed.
fn cause(error: &Error) -> &Error {
    match error {
        Error::AliasError { error, .. } | Error::WithSnippet { error, .. } => cause(error),
        error => error,
    }
}

/// The reader's message without its ` at line …` tail, first letter small, no control characters.
fn plain_message(error: &Error) -> String {
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    let cut = [" at line ", ": line ", " (line ", " at <input>"].iter().filter_map(|m| line.find(m)).min();
    let message = sanitize(cut.map_or(line, |i| &line[..i]).trim_end_matches(['.', ' ']));
    if message.is_empty() { "this is not YAML".to_owned() } else { message }
}

fn place(error: &Error, text: &str) -> Option<Span> {
    let location = error.location()?;
    let start = match location.span().byte_offset() {
        Some(offset) => usize::try_from(offset).ok()?,
        None => offset_of(text, location)?,
    };
    let length = location.span().byte_len().and_then(|n| usize::try_from(n).ok()).unwrap_or(1);
    Some(snap(text, Span { start, end: start.saturating_add(length.max(1)) }))
}

/// Byte offset of a line and column counted from 1.
fn offset_of(text: &str, location: Location) -> Option<usize> {
    let line = usize::try_from(location.line()).ok()?.checked_sub(1)?;
    let column = usize::try_from(location.column()).ok()?.checked_sub(1)?;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let rest = text.get(start..)?;
    Some(start + rest.char_indices().nth(column).map_or(rest.len(), |(i, _)| i))
}

/// What serde hands over before places are attached.
enum Raw {
    Null,
    Text(String),
    /// A plain scalar that YAML takes for a number or a boolean: its text is sliced from the source.
    Typed,
    Sequence(Vec<Spanned<Raw>>),
    Mapping(Vec<(Spanned<String>, Spanned<Raw>)>),
}

trait IntoNode {
    fn into_node(self, source: &str) -> Node;
}

impl IntoNode for Spanned<Raw> {
    fn into_node(self, source: &str) -> Node {
        let span = byte_span(self.defined, source);
        match self.value {
            Raw::Null => Node { value: Value::Null, span },
            Raw::Text(text) => Node { value: Value::Scalar(text), span },
            Raw::Typed => {
                let text = source.get(span.start..span.end).unwrap_or_default().trim();
                Node { value: Value::Scalar(text.to_owned()), span }
            }
            Raw::Sequence(items) => {
                let items: Vec<Node> = items.into_iter().map(|item| item.into_node(source)).collect();
                let span = cover(span, items.last().map(|item| item.span.end), source);
                Node { value: Value::Sequence(items), span }
            }
            Raw::Mapping(entries) => {
                let entries: Vec<_> = entries
                    .into_iter()
                    .map(|(key, value)| (byte_span(key.defined, source), key.value, value))
                    .map(|(key_span, key, value)| (key, key_span, value.into_node(source)))
                    .collect();
                let last = entries.last().map(|(_, key, node)| node.span.end.max(key.end));
                let span = cover(span, last, source);
                Node { value: Value::Mapping(entries), span }
            }
        }
    }
}

impl Node {
    /// Moves every span by `by` bytes.
    fn shift(mut self, by: usize) -> Self {
        let moved = |span: Span| Span { start: span.start + by, end: span.end + by };
        self.span = moved(self.span);
        self.value = match self.value {
            Value::Sequence(items) => Value::Sequence(items.into_iter().map(|item| item.shift(by)).collect()),
            Value::Mapping(entries) => Value::Mapping(
                entries.into_iter().map(|(key, span, node)| (key, moved(span), node.shift(by))).collect(),
            ),
            other => other,
        };
        self
    }
}

/// `span` reaching to the end of the last entry (aliases may stand before it), closing bracket included.
fn cover(span: Span, last: Option<usize>, source: &str) -> Span {
    let opening = source.get(span.start..).and_then(|rest| rest.chars().next());
    let closing = match opening {
        Some('[') => Some(']'),
        Some('{') => Some('}'),
        _ => None,
    };
    let from = last.unwrap_or(span.start).max(span.start + usize::from(closing.is_some() && last.is_none()));
    let rest = source.get(from..).unwrap_or_default();
    let bracket =
        rest.find(|c: char| !c.is_whitespace() && c != ',').filter(|i| rest[*i..].chars().next() == closing);
    Span {
        start: span.start,
        end: span.end.max(bracket.filter(|_| closing.is_some()).map_or(from, |i| from + i + 1)),
    }
}

fn byte_span(location: Location, source: &str) -> Span {
    let span = location.span();
    let at = |n: Option<u64>| n.and_then(|n| usize::try_from(n).ok());
    let start = at(span.byte_offset()).or_else(|| offset_of(source, location)).unwrap_or(0);
    let length = at(span.byte_len()).unwrap_or(0);
    let Span { start, end } = snap(source, Span { start, end: start.saturating_add(length) });
    // A block scalar's span may swallow the line breaks after it.
    let text = source[start..end].trim_end();
    Span { start, end: start + text.len() }
}

impl<'de> Deserialize<'de> for Raw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RawVisitor)
    }
}

struct RawVisitor;

impl<'de> Visitor<'de> for RawVisitor {
    type Value = Raw;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("text, a list or a mapping")
    }

    fn visit_unit<E: de::Error>(self) -> Result<Raw, E> {
        Ok(Raw::Null)
    }

    fn visit_none<E: de::Error>(self) -> Result<Raw, E> {
        Ok(Raw::Null)
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Raw, D::Error> {
        Raw::deserialize(deserializer)
    }

    fn visit_bool<E: de::Error>(self, _: bool) -> Result<Raw, E> {
        Ok(Raw::Typed)
    }

    fn visit_i64<E: de::Error>(self, _: i64) -> Result<Raw, E> {
        Ok(Raw::Typed)
    }

    fn visit_i128<E: de::Error>(self, _: i128) -> Result<Raw, E> {
        Ok(Raw::Typed)
    }

    fn visit_u64<E: de::Error>(self, _: u64) -> Result<Raw, E> {
        Ok(Raw::Typed)
    }

    fn visit_u128<E: de::Error>(self, _: u128) -> Result<Raw, E> {
        Ok(Raw::Typed)
    }

    fn visit_f64<E: de::Error>(self, _: f64) -> Result<Raw, E> {
        Ok(Raw::Typed)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Raw, E> {
        Ok(Raw::Text(text.to_owned()))
    }

    fn visit_string<E: de::Error>(self, text: String) -> Result<Raw, E> {
        Ok(Raw::Text(text))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Raw, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = access.next_element()? {
            items.push(item);
        }
        Ok(Raw::Sequence(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Raw, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = access.next_entry()? {
            entries.push(entry);
        }
        Ok(Raw::Mapping(entries))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every scalar of the tree with the source text under its span.
    #[track_caller]
    fn check(text: &str, expected: &[(&str, &str)]) {
        let node = parse(text).unwrap_or_else(|e| panic!("{text:?}: {e:?}"));
        let mut found = Vec::new();
        collect(&node, text, &mut found);
        let found: Vec<_> = found.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
        assert_eq!(found, expected, "{text:?}");
    }

    fn collect(node: &Node, text: &str, found: &mut Vec<(String, String)>) {
        let slice = |span: Span| text[span.start..span.end].to_owned();
        match &node.value {
            Value::Null => found.push(("<null>".into(), slice(node.span))),
            Value::Scalar(s) => found.push((s.clone(), slice(node.span))),
            Value::Sequence(items) => items.iter().for_each(|item| collect(item, text, found)),
            Value::Mapping(entries) => {
                for (key, span, child) in entries {
                    found.push((format!("{key}:"), slice(*span)));
                    collect(child, text, found);
                }
            }
        }
    }

    #[test]
    fn scalars_stay_as_typed() {
        check("a: 1.50", &[("a:", "a"), ("1.50", "1.50")]);
        check("a: yes", &[("a:", "a"), ("yes", "yes")]);
        check("a: .inf # far", &[("a:", "a"), (".inf", ".inf")]);
        check("a: 1e400", &[("a:", "a"), ("1e400", "1e400")]);
        check("a: 0123456", &[("a:", "a"), ("0123456", "0123456")]);
        check("a: 0x10", &[("a:", "a"), ("0x10", "0x10")]);
        check("a: -0.0195 ± 5.59j", &[("a:", "a"), ("-0.0195 ± 5.59j", "-0.0195 ± 5.59j")]);
        check("a: \"1.50\"", &[("a:", "a"), ("1.50", "\"1.50\"")]);
        check("a: ~\nb:\n", &[("a:", "a"), ("<null>", "~"), ("b:", "b"), ("<null>", "")]);
        check("'a.b': [1.0, -2 ± 3j]", &[("a.b:", "'a.b'"), ("1.0", "1.0"), ("-2 ± 3j", "-2 ± 3j")]);
        check("a: |\n  x\n  y\nb: 2", &[("a:", "a"), ("x\ny\n", "x\n  y"), ("b:", "b"), ("2", "2")]);
        check("a: &z 1.50\nb: *z", &[("a:", "a"), ("1.50", "1.50"), ("b:", "b"), ("1.50", "1.50")]);
        check("\u{feff}a: 1\r\nb: ±2\r\n", &[("a:", "a"), ("1", "1"), ("b:", "b"), ("±2", "±2")]);
        check("", &[("<null>", "")]);
        check("# only a comment\n", &[("<null>", "")]);
    }

    #[test]
    fn lists_and_mappings_reach_to_their_end() {
        for (text, expected) in [
            ("a: [1, 2]", "[1, 2]"),
            ("a: [1, 2 , ] # x", "[1, 2 , ]"),
            ("a: []", "[]"),
            ("a: {}", "{}"),
            ("a: {b: [1], c: 'x'}", "{b: [1], c: 'x'}"),
            ("a:\n  - 1\n  - 2\nb: 3", "- 1\n  - 2"),
            ("a:\n  c: 1\n  d: 2\nb: 3", "c: 1\n  d: 2"),
        ] {
            let span = parse(text).unwrap().get("a").unwrap().span;
            assert_eq!(&text[span.start..span.end], expected, "{text:?}");
        }
    }

    #[test]
    fn places_inside_scalars_are_found_again() {
        for (text, inner, expected) in [
            ("a: x = oops", "oops", "oops"),
            ("a: 'it''s oops'", "oops", "oops"),
            ("a: \"\\t oops ±\"", "±", "±"),
            ("a: |\n  first\n  second oops\n", "oops", "oops"),
            ("a: >\n  first\n  second oops\n", "second oops", "second oops"),
        ] {
            let node = parse(text).unwrap();
            let value = node.get("a").unwrap();
            let start = value.as_scalar().unwrap().find(inner).unwrap();
            let span = value.locate(text, start, start + inner.len());
            assert_eq!(&text[span.start..span.end], expected, "{text:?}");
        }
    }

    #[test]
    fn refusals_have_places() {
        for (text, line, words) in [
            ("a: 1\nb: 2\na: 3", 3, "twice"),
            ("x: {a: 1, a: 2}", 1, "twice"),
            ("a: &z {b: 1}\nc:\n  <<: *z", 3, "merge"),
            ("a: 1\n---\nb: 2", 2, "second document"),
            ("a: **bold**", 1, "alias"),
            ("a: [1, 2\nb: 3", 2, ""),
            ("a: it is: so", 1, ""),
            ("a: \"open", 1, ""),
        ] {
            let error = parse(text).unwrap_err();
            let place = error.span.map(|s| super::super::SourceText::new("f", text).position(s.start).line);
            assert_eq!(place, Some(line), "{text:?}: {error:?}");
            assert!(error.message.contains(words), "{text:?}: {error:?}");
            assert!(!error.message.contains("line "), "{text:?}: {error:?}");
        }
    }

    #[test]
    fn limits_are_told_in_plain_words() {
        #[track_caller]
        fn check(text: &str, words: &str, help: &str) {
            let error = parse(text).unwrap_err();
            assert!(error.message.contains(words), "{error:?}");
            assert!(error.help.is_some_and(|found| found.contains(help)), "{error:?}");
            for jargon in ["budget", "breach", "{", "recursi", "weak", "limit"] {
                assert!(!error.message.contains(jargon), "{error:?}");
            }
        }
        check(&format!("a: [{}]", vec!["1"; 30_000].join(",")), "more than 20,000 values", "table");
        check(&format!("a:\n{}", "- 1\n".repeat(30_000)), "more than 20,000 values", "table");
        check(&format!("a: {}", "x".repeat(1_100_000)), "1,000,000 bytes", "table");
        check(&format!("a: &a 1\nb: [{}]", vec!["*a"; 150].join(",")), "too often", "Write out");
        check("a: &a [*a]", "within itself", "quotes");
        check("a: &a\n  b: *a", "within itself", "quotes");
        check(&"[".repeat(100), "nested too deeply", "lists within lists");
        check(&format!("a: {}{}", "[".repeat(20), "]".repeat(20)), "nested too deeply", "lists within lists");
        check(&"- ".repeat(10_000), "nested too deeply", "lists within lists");
        check("a: 1\n---\nb: 2", "second document", "one document");
        check("a: **bold**", "alias", "quotes");
        for text in ["a: [1, 2\nb: 3", "a: it is: so", "a: \"open", "a:\n\t- x"] {
            assert_eq!(parse(text).unwrap_err().help, None, "{text}");
        }
    }

    #[test]
    fn hostile_texts_are_refused_quickly() {
        let bomb: String = std::iter::once("a0: &a0 [x,x,x,x,x,x,x,x,x]\n".to_owned())
            .chain((1..9).map(|i| format!("a{i}: &a{i} [{}]\n", vec![format!("*a{}", i - 1); 9].join(","))))
            .collect();
        let fat = format!("a: &a {}\nb: [{}]", "x".repeat(100_000), vec!["*a"; 5_000].join(","));
        for text in ["[".repeat(100_000), "{".repeat(100_000), "- ".repeat(10_000), bomb, fat] {
            assert!(parse(&text).is_err(), "{:.40}", text);
        }
        let blocks: String = (0..3_000).map(|i| format!("{}a:\n", " ".repeat(i))).collect();
        assert!(parse(&blocks).is_err());
        assert!(parse(&format!("a: {}", "(".repeat(100_000))).is_ok());
        assert!(parse("a: \u{1b}[31m\u{0}").is_err());
    }
}
