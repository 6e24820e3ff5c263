use super::file::{LabFile, ModelFile, Text};
use super::linear_file;
use super::names::suggestion;
use super::student_edition;
use crate::source::{Finding, Node, SourceText, Span, Value, sanitize};
use serde_yaml::{Error, Location};

/// The file's shape: YAML, and the keys it must and may have. The first thing wrong with the shape ends the reading.
pub(super) fn read(source: &SourceText) -> Result<(LabFile, Node), Finding> {
    let tree = crate::source::parse(&source.text).map_err(|error| {
        if let (None, Some((place, message, help))) =
            (error.help, error.span.and_then(|place| super::yaml_slips::slip(&source.text, place.start)))
        {
            return Finding::error("lab.yaml", message).with_help(help).at(place);
        }
        let finding = Finding::error("lab.yaml", error.message);
        let finding = match error.help {
            Some(help) => finding.with_help(author_help(help)),
            None => finding,
        };
        match error.span {
            Some(span) => finding.at(span),
            None => finding,
        }
    })?;
    if let Some(finding) = student_edition::mark(&tree) {
        return Err(finding);
    }
    // The tree was read within budgets, so the second reading needs none of its own.
    let options = serde_yaml::options! { with_snippet: false };
    let mut file: LabFile =
        serde_yaml::from_str_with_options(&source.text, options).map_err(|error| finding(&error, &tree))?;
    linear_file::spell_out(&mut file)?;
    file.models.0.iter_mut().for_each(|(_, model)| name_the_only_ones(model));
    Ok((file, tree))
}

/// Where a point names no input or output, the only one there is; else nothing, at the place of the point.
fn name_the_only_ones(model: &mut ModelFile) {
    let only = |names: Vec<&Text>| match names.as_slice() {
        [only] => only.value.clone(),
        _ => String::new(),
    };
    let input = only(model.inputs.value.0.iter().map(|(name, _)| name).collect());
    let output = match model.outputs.0.as_slice() {
        [] => only(model.coordinates.value.0.iter().map(|(name, _)| name).collect()),
        outputs => only(outputs.iter().map(|(name, _)| name).collect()),
    };
    for (id, point) in &mut model.operating_points.value.0 {
        for (signal, only) in [(&mut point.input, &input), (&mut point.output, &output)] {
            if signal.value.is_empty() {
                *signal = Text { value: only.clone(), defined: id.defined };
            }
        }
    }
}

/// A sentence for students as a help for authors: a small letter first, no full stop.
fn author_help(help: &str) -> String {
    let mut rest = help.trim_end_matches('.').chars();
    rest.next().map_or_else(String::new, |first| format!("{}{}", first.to_lowercase(), rest.as_str()))
}

pub(super) fn finding(error: &Error, tree: &Node) -> Finding {
    let (code, message, help) = match error {
        // `{value: 0,2}` is 0, and a key 2.
        Error::SerdeUnknownField { field, .. }
            if !field.is_empty() && field.bytes().all(|b| b.is_ascii_digit()) =>
        {
            let help = format!("if `,{field}` is the end of a number, write a point: `.{field}`");
            ("lab.unknown_key", format!("there is no key `{field}` here"), Some(help))
        }
        Error::SerdeUnknownField { field, expected, .. } => {
            ("lab.unknown_key", format!("there is no key `{field}` here"), Some(suggestion(field, expected)))
        }
        Error::SerdeUnknownVariant { variant, expected, .. } => {
            ("lab.unknown_key", format!("`{variant}` is not known here"), Some(suggestion(variant, expected)))
        }
        Error::SerdeMissingField { field, .. } => {
            ("lab.missing_key", format!("the key `{field}` is missing here"), None)
        }
        Error::Unexpected { expected, .. } => {
            let wanted = match *expected {
                "mapping start" => "a mapping (`key: value`) is wanted here",
                "sequence start" => "a list (`[a, b]`, or lines that begin with `- `) is wanted here",
                _ => "a single value is wanted here, not a list or a mapping",
            };
            let help = match *expected {
                "mapping start" => "begin a new line with the key, indented further",
                "sequence start" => "put brackets around a single entry",
                _ => "write the value after the key, without brackets",
            };
            let at = error.location().map(|location| span(location).start);
            match at.and_then(|at| matrix(tree, at)) {
                Some((wanted, help)) => ("lab.shape", wanted, Some(help)),
                None => ("lab.shape", wanted.to_owned(), Some(help.to_owned())),
            }
        }
        Error::NullIntoString { .. } => ("lab.shape", "a value is missing here".to_owned(), None),
        Error::ExpectedMappingEndAfterEnumVariantValue { .. } => {
            ("lab.shape", "only one key can stand here, and this is another".to_owned(), None)
        }
        Error::Eof { .. } => ("lab.shape", "the file is empty".to_owned(), None),
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
    match error.location().map(span) {
        Some(place) if code == "lab.missing_key" => finding.at(owner(tree, place.start).unwrap_or(place)),
        Some(place) => finding.at(place),
        None => finding,
    }
}

/// What is wanted where a matrix of a state-space model was given as a list or a single value: its shape, and how to write it.
fn matrix(tree: &Node, at: usize) -> Option<(String, String)> {
    let (_, _, state_space) = entries(tree)
        .into_iter()
        .find(|(key, _, node)| *key == "state_space" && node.span.start <= at && at <= node.span.end)?;
    let own = state_space.as_mapping().unwrap_or_default();
    let (key, _, given) = own.iter().find(|(_, _, node)| node.span.start <= at && at <= node.span.end)?;
    let shape = match key.as_str() {
        "A" => "a row for each state, with a number for each state",
        "B" => "a row for each state, with a number for each input",
        "C" => "a row for each output, with a number for each state",
        "D" => "a row for each output, with a number for each input",
        _ => return None,
    };
    let numbers: Vec<&str> = match &given.value {
        Value::Sequence(items) => items.iter().map(Node::as_scalar).collect::<Option<_>>()?,
        Value::Scalar(one) => vec![one],
        _ => return None,
    };
    let rows = match key.as_str() {
        "B" => numbers.iter().map(|one| format!("[{one}]")).collect::<Vec<_>>().join(", "),
        _ => format!("[{}]", numbers.join(", ")),
    };
    Some((format!("`{key}` is a matrix: {shape}"), format!("write `{key}: [{rows}]`")))
}

/// Every key of a file with its value, those within others too.
fn entries(node: &Node) -> Vec<(&str, Span, &Node)> {
    let below: Vec<&Node> = match &node.value {
        Value::Mapping(entries) => entries.iter().map(|(_, _, child)| child).collect(),
        Value::Sequence(items) => items.iter().collect(),
        Value::Null | Value::Scalar(_) => Vec::new(),
    };
    let own =
        node.as_mapping().unwrap_or_default().iter().map(|(key, span, child)| (key.as_str(), *span, child));
    own.chain(below.into_iter().flat_map(entries)).collect()
}

/// The key whose mapping begins, or has a key, at byte `at`; of the whole file, its first key.
fn owner(node: &Node, at: usize) -> Option<Span> {
    match &node.value {
        Value::Mapping(entries) => {
            let inner = entries.iter().find_map(|(_, key, child)| match &child.value {
                Value::Mapping(below)
                    if child.span.start == at || below.iter().any(|(_, k, _)| k.start == at) =>
                {
                    Some(*key)
                }
                _ => owner(child, at),
            });
            let own = || entries.iter().any(|(_, key, _)| key.start == at).then(|| entries.first()).flatten();
            inner.or_else(|| own().map(|(_, key, _)| *key))
        }
        Value::Sequence(items) => items.iter().find_map(|item| owner(item, at)),
        Value::Null | Value::Scalar(_) => None,
    }
}

/// Bytes of a place; of a list or a mapping only the beginning is known.
pub(super) fn span(location: Location) -> Span {
    let place = location.span();
    let number = |n: Option<u64>| n.and_then(|n| usize::try_from(n).ok()).unwrap_or(0);
    let start = number(place.byte_offset());
    Span { start, end: start + number(place.byte_len()) }
}
