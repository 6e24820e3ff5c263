//! The JSON Schemas accept every lab and every answer file that polemark reads, and no key it does not know.

use polemark::lab::{self, LabDefinition, lab_reference, lab_schema};
use polemark::source::SourceText;
use polemark::submission::{Folder, read};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn json_of(yaml: &str) -> Option<Value> {
    // As editors do: `N` and `no` are text.
    let options = serde_yaml::options! { strict_booleans: true };
    serde_yaml::from_str_with_options(yaml, options).ok()
}

/// What is wrong with `value`, first of all; a keyword this cannot judge is a failure of the test.
fn wrong(root: &Value, schema: &Value, value: &Value, path: &str) -> Result<(), String> {
    let Value::Object(keywords) = schema else { return Ok(()) };
    for (keyword, rule) in keywords {
        let rules = || rule.as_array().expect("a list");
        match keyword.as_str() {
            "$schema" | "title" | "description" | "default" | "examples" | "definitions" => {}
            "$ref" => {
                let pointer =
                    rule.as_str().and_then(|text| text.strip_prefix('#')).expect("a local reference");
                wrong(root, root.pointer(pointer).expect("it leads somewhere"), value, path)?;
            }
            "allOf" => rules().iter().try_for_each(|one| wrong(root, one, value, path))?,
            "anyOf" | "oneOf" => {
                let failures: Vec<String> =
                    rules().iter().filter_map(|one| wrong(root, one, value, path).err()).collect();
                let fit = rules().len() - failures.len();
                if fit == 0 || keyword == "oneOf" && fit > 1 {
                    return Err(format!("{path}: {fit} of {} fit: {failures:?}", rules().len()));
                }
            }
            "enum" if rules().contains(value) => {}
            "type" => {
                let types = rule.as_array().cloned().unwrap_or_else(|| vec![rule.clone()]);
                let own = match value {
                    Value::Null => "null",
                    Value::Bool(_) => "boolean",
                    Value::Number(_) => "number",
                    Value::String(_) => "string",
                    Value::Array(_) => "array",
                    Value::Object(_) => "object",
                };
                if !types.iter().any(|known| known == own) {
                    return Err(format!("{path}: {own} where {types:?} is wanted"));
                }
            }
            "pattern" => {
                if let Value::String(text) = value
                    && !matches(rule.as_str().expect("a pattern"), text)
                {
                    return Err(format!("{path}: `{text}` is not {rule}"));
                }
            }
            "required" => {
                if let Some(key) = rules()
                    .iter()
                    .find(|key| value.is_object() && value.get(key.as_str().expect("a key")).is_none())
                {
                    return Err(format!("{path}: {key} is missing"));
                }
            }
            "properties" => {
                for (key, rule) in rule.as_object().expect("a mapping") {
                    if let Some(value) = value.get(key) {
                        wrong(root, rule, value, &format!("{path}/{key}"))?;
                    }
                }
            }
            "patternProperties" | "additionalProperties" => {
                let empty = serde_json::Map::new();
                let part = |name: &str| schema[name].as_object().cloned().unwrap_or_default();
                let (known, patterns) = (part("properties"), part("patternProperties"));
                for (key, value) in value.as_object().unwrap_or(&empty) {
                    let mut fitting = patterns.iter().filter(|(pattern, _)| matches(pattern, key)).peekable();
                    let here = format!("{path}/{key}");
                    if keyword == "patternProperties" {
                        fitting.try_for_each(|(_, rule)| wrong(root, rule, value, &here))?;
                    } else if !known.contains_key(key) && fitting.peek().is_none() {
                        match rule {
                            Value::Bool(false) => return Err(format!("{here}: not known")),
                            rule => wrong(root, rule, value, &here)?,
                        }
                    }
                }
            }
            "items" => {
                for (index, value) in value.as_array().into_iter().flatten().enumerate() {
                    wrong(root, rule, value, &format!("{path}/{index}"))?;
                }
            }
            "minItems" | "maxItems" | "minProperties" => {
                let size = match (keyword.as_str(), value) {
                    ("minProperties", Value::Object(entries)) => entries.len(),
                    ("minItems" | "maxItems", Value::Array(items)) => items.len(),
                    _ => continue,
                };
                let limit = rule.as_u64().expect("a number");
                let fits = if keyword == "maxItems" { size as u64 <= limit } else { size as u64 >= limit };
                if !fits {
                    return Err(format!("{path}: {size} entries against {keyword} {limit}"));
                }
            }
            "enum" => return Err(format!("{path}: {value} is none of {rule}")),
            other => return Err(format!("the schema has `{other}`, which this test cannot judge")),
        }
    }
    Ok(())
}

/// Patterns made of letters, `[classes]`, `(groups|of)`, `?`, and escapes, between `^` and `$`.
fn matches(pattern: &str, text: &str) -> bool {
    let inner = pattern.strip_prefix('^').and_then(|rest| rest.strip_suffix('$')).expect("a whole pattern");
    rests(inner, text).contains(&"")
}

/// What may be left of `text` behind what `pattern` matches.
fn rests<'t>(pattern: &str, text: &'t str) -> Vec<&'t str> {
    let Some(first) = pattern.chars().next() else { return vec![text] };
    let head = |letter: Option<char>| letter.map(|letter| &text[letter.len_utf8()..]);
    let (length, mut behind): (usize, Vec<&str>) = match first {
        '(' => {
            let mut depth = 0;
            let end = pattern
                .char_indices()
                .find(|(_, c)| {
                    depth += i32::from(*c == '(') - i32::from(*c == ')');
                    depth == 0
                })
                .expect("a closing parenthesis")
                .0;
            let (mut parts, mut start, mut depth) = (Vec::new(), 1, 0);
            for (at, c) in pattern[..=end].char_indices().skip(1) {
                match c {
                    '(' => depth += 1,
                    ')' if depth > 0 => depth -= 1,
                    '|' | ')' if depth == 0 => {
                        parts.push(&pattern[start..at]);
                        start = at + 1;
                    }
                    _ => {}
                }
            }
            (end + 1, parts.into_iter().flat_map(|part| rests(part, text)).collect())
        }
        '[' => {
            let end = pattern.find(']').expect("a closing bracket");
            let class = &pattern[1..end];
            (end + 1, head(text.chars().next().filter(|c| class.contains(*c))).into_iter().collect())
        }
        '\\' => {
            let letter = pattern.chars().nth(1).expect("something escaped");
            (2, head(text.chars().next().filter(|c| *c == letter)).into_iter().collect())
        }
        letter => {
            (letter.len_utf8(), head(text.chars().next().filter(|c| *c == letter)).into_iter().collect())
        }
    };
    let mut rest = &pattern[length..];
    if let Some(after) = rest.strip_prefix('?') {
        behind.push(text);
        rest = after;
    }
    behind.into_iter().flat_map(|text| rests(rest, text)).collect()
}

#[track_caller]
fn judge(schema: &Value, value: &Value) -> Result<(), String> {
    wrong(schema, schema, value, "")
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "yaml")).collect();
    files.sort();
    files
}

fn labs() -> Vec<(String, String)> {
    let own = files(&root().join("tests/it"))
        .into_iter()
        .map(|path| (path.display().to_string(), std::fs::read_to_string(path).expect("text")));
    let new = ("the new lab".to_owned(), include_str!("../../templates/new-lab/lab.yaml").to_owned());
    let shelf = lab::embedded().iter().map(|(id, text)| ((*id).to_owned(), (*text).to_owned()));
    shelf.chain(own).chain([new]).collect()
}

#[test]
fn every_lab_is_valid() {
    let schema = lab_schema();
    for (name, text) in labs() {
        let value = json_of(&text).unwrap_or_else(|| panic!("{name} is YAML"));
        assert_eq!(judge(&schema, &value), Ok(()), "{name}");
    }
}

#[test]
fn what_no_lab_may_say_is_not_valid() {
    #[track_caller]
    fn check(at: &str, key: &str, value: Value) {
        let mut lab = json_of(include_str!("../../templates/new-lab/lab.yaml")).expect("YAML");
        let place = lab.pointer_mut(at).and_then(Value::as_object_mut).expect("a mapping");
        place.insert(key.to_owned(), value);
        assert!(judge(&lab_schema(), &lab).is_err(), "{at}/{key}");
    }
    check("", "totl", json!(14));
    check("", "questions", json!(["a"]));
    check("/parameters/m", "valu", json!(2));
    check("/models/spring", "equations", json!("x' = F"));
    check("/models/spring/operating_points/rest", "outputs", json!("x"));
    check("/questions/rest.transfer_function", "answer", json!("transferfunction"));
    check("/questions/rest.transfer_function", "answer", json!({"kind": "pole"}));
    check("/questions/rest.transfer_function", "response", json!("ramp"));
    check("/questions/rest.transfer_function", "criteria", json!({"a": {"check": "guess"}}));
}

#[test]
fn every_answer_file_that_reads_is_valid() {
    let lab = lab::load(lab::DEFAULT).expect("it parses");
    let schema = lab.answers_schema();
    let folder = root().join("submissions");
    let mut valid = 0;
    for path in files(&folder) {
        let bytes = std::fs::read(&path).expect("read");
        let submission = read("a", "a", &bytes, &lab.sheet, &Folder(folder.clone()));
        // Of keys alone a schema can tell; what a text says it cannot.
        let keys_are_right =
            submission.readable && !submission.findings.iter().any(|f| f.code.starts_with("key."));
        // Some are read although a strict reader refuses them: a key given twice, say.
        let Some(value) = json_of(&submission.source.text) else { continue };
        match judge(&schema, &value) {
            Ok(()) => valid += 1,
            Err(error) => assert!(!keys_are_right, "{}: {error}", path.display()),
        }
    }
    assert!(valid > 20, "{valid}");
}

#[test]
fn answers_are_valid_in_every_spelling() {
    let lab = lab::load(lab::DEFAULT).expect("it parses");
    let schema = lab.answers_schema();
    #[track_caller]
    fn check(schema: &Value, answers: &str, valid: bool) {
        let value = json_of(&format!("lab: ee361-lab3\nanswers: {answers}\n")).expect("YAML");
        assert_eq!(judge(schema, &value).is_ok(), valid, "{answers}: {:?}", judge(schema, &value));
    }
    for (answers, valid) in [
        ("", true),
        ("{hanging.response.poles: -1 ± 2j}", true),
        ("{hanging: {response: {poles: [-1, '-2+j', {re: 1, im: 2}]}}}", true),
        ("{hanging: {response.poles: -1}, Hanging.Response: {Final value: 0}}", true),
        ("{hanging.transfer_function: {num: [1], den: [1, 2]}}", true),
        ("{hanging.transfer_function: {Numerator: s, Denominator: s + 1}}", true),
        ("{hanging.transfer_function: {top: [1], den: [1, 2]}}", false),
        ("{hanging.response.final_value: 0}", true),
        ("{hanging.response.final_value: unbounded}", true),
        ("{hanging.response.stability: stable}", true),
        ("{hanging.response.stability: not stable}", true),
        ("{battery.nonlinearity: [dead zone]}", true),
        ("{hanging.response.pole: -1}", false),
        ("{hanging.response: 3}", false),
        ("{hangin: {response: {poles: 1}}}", false),
    ] {
        check(&schema, answers, valid);
    }
    assert!(!schema.to_string().contains("4.4545"), "no right answer is in it");
}

#[test]
fn the_reference_of_the_keys_is_up_to_date() {
    let path = root().join("docs/lab-file-reference.md");
    let on_disk = std::fs::read_to_string(&path).unwrap_or_default();
    let wanted = lab_reference();
    if std::env::var_os("POLEMARK_WRITE").is_some() {
        std::fs::write(&path, &wanted).expect("written");
    }
    assert!(
        on_disk == wanted,
        "docs/lab-file-reference.md is out of date: `cargo run -- schema lab --format markdown --out docs/lab-file-reference.md`"
    );
}

#[test]
fn a_schema_is_made_for_any_lab() {
    for (name, text) in labs() {
        let lab = LabDefinition::parse(SourceText::new(name.as_str(), text)).expect("it parses");
        let template = json_of(&lab.answer_template()).expect("YAML");
        assert_eq!(judge(&lab.answers_schema(), &template), Ok(()), "{name}");
    }
}
