//! The schema of the lab file as tables to read.

use super::lab_schema;
use serde_json::{Map, Value};
use std::fmt::Write;

const HEAD: &str = "# The keys of a lab file

Made by `polemark schema lab --format markdown` from the types that read the file. [lab-file.md](lab-file.md) is the guide: how a lab
is written, and what the keys mean together.
";

/// Every key of the lab file, in Markdown: a section for each mapping, in the order in which one meets them from the top.
pub fn lab_reference() -> String {
    let schema = lab_schema();
    let definitions = schema["definitions"].as_object().cloned().unwrap_or_default();
    let mut text = HEAD.to_owned();
    let mut sections = vec!["A lab".to_owned()];
    let mut next = 0;
    while let Some(name) = sections.get(next).cloned() {
        let section = if next == 0 { Some(&schema) } else { definitions.get(&name) };
        if let Some(section) = section {
            let _ = write!(text, "\n## {}\n\n{}\n", heading(&name), description(section));
            mapping(&mut text, section, &mut sections);
            for variant in section["oneOf"].as_array().into_iter().flatten() {
                variants(&mut text, variant, &mut sections);
            }
        }
        next += 1;
    }
    text
}

/// One of several mappings with a single key: `sine: {…}`.
fn variants(text: &mut String, variant: &Value, sections: &mut Vec<String>) {
    for (key, value) in variant["properties"].as_object().into_iter().flatten() {
        let _ = write!(text, "\n### `{key}`\n\n{}\n", description(variant));
        mapping(text, value, sections);
    }
}

fn mapping(text: &mut String, section: &Value, sections: &mut Vec<String>) {
    let Some(properties) = section["properties"].as_object().filter(|_| section["oneOf"].is_null()) else {
        return;
    };
    let required: Vec<&str> =
        section["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    text.push_str("\n| key | type | |\n|---|---|---|\n");
    let (needed, others): (Vec<_>, Vec<_>) =
        properties.iter().partition(|(key, _)| required.contains(&key.as_str()));
    for (key, value) in needed.into_iter().chain(others) {
        let need = if required.contains(&key.as_str()) { "**Needed.** " } else { "" };
        let mut what = description(value).replace('|', "\\|").replace('\n', " ");
        if let Some(words) = value["enum"].as_array() {
            let words: Vec<String> =
                words.iter().filter_map(Value::as_str).map(|word| format!("`{word}`")).collect();
            let _ = write!(what, " One of {}.", words.join(", "));
        }
        let _ = writeln!(text, "| `{key}` | {} | {need}{} |", kind(value, sections), what.trim());
    }
}

fn description(value: &Value) -> String {
    value["description"].as_str().unwrap_or_default().to_owned()
}

/// What stands behind a key, with a link to the section that tells more.
fn kind(value: &Value, sections: &mut Vec<String>) -> String {
    if let Some(name) = value["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
        if !sections.iter().any(|known| known == name) {
            sections.push(name.to_owned());
        }
        let title = heading(name);
        return format!("[{}](#{})", title.to_lowercase(), title.to_lowercase().replace(' ', "-"));
    }
    let several = ["allOf", "anyOf"].iter().find_map(|key| value[*key].as_array());
    if let Some(several) = several {
        let kinds: Vec<String> =
            several.iter().filter(|one| one["type"] != "null").map(|one| kind(one, sections)).collect();
        return kinds.join(" or ");
    }
    if value.get("enum").is_some() {
        return "word".to_owned();
    }
    let types: Vec<&str> = match &value["type"] {
        Value::String(one) => vec![one],
        Value::Array(all) => all.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    };
    match types.as_slice() {
        types if types.contains(&"object") => mapping_kind(value.as_object(), sections),
        types if types.contains(&"array") => format!("list of {}", kind(&value["items"], sections)),
        types if types.contains(&"boolean") => "true or false".to_owned(),
        types if types.contains(&"string") => "text or number".to_owned(),
        _ => "anything".to_owned(),
    }
}

fn mapping_kind(value: Option<&Map<String, Value>>, sections: &mut Vec<String>) -> String {
    match value.and_then(|value| value.get("additionalProperties")) {
        Some(entry) if entry.is_object() => format!("name → {}", kind(entry, sections)),
        _ => "mapping".to_owned(),
    }
}

/// `OperatingPointFile` is `Operating point`.
fn heading(name: &str) -> String {
    let name = name.strip_suffix("File").unwrap_or(name);
    let mut words = String::new();
    for (index, letter) in name.chars().enumerate() {
        if index > 0 && letter.is_uppercase() && !words.ends_with(' ') {
            words.push(' ');
        }
        words.push(if index == 0 { letter } else { letter.to_ascii_lowercase() });
    }
    words
}
