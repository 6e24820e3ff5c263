//! The answer file of a lab as a JSON Schema, for editors: which keys there are, and every way to write behind them.

use super::LabDefinition;
use crate::lti::{Shape, Stability};
use crate::submission::{
    AnswerSheet, Field, FieldKind, NonlinearityKind, nonlinearity_name, shape_name, stability_name,
};
use serde_json::{Map, Value, json};

impl LabDefinition {
    /// Draft 7, made from the sheet: no right answer is in it.
    pub fn answers_schema(&self) -> Value {
        let definitions: Map<String, Value> =
            self.sheet.fields.iter().map(|field| (field.path.clone(), answer(field, &self.sheet))).collect();
        let fields: Vec<&str> = self.sheet.fields.iter().map(|field| field.path.as_str()).collect();
        let answers = json!({ "description": "The answers, by key.", "anyOf": [{ "type": "null" }, keys(&fields, "")] });
        json!({
            "$schema": "http://json-schema.org/draft-07/schema#",
            "title": format!("Answers to {}", self.title),
            "type": "object",
            "properties": {
                "lab": { "description": "The lab that is answered.", "anyOf": [{ "enum": [self.id, null] }, { "type": "string", "pattern": any_capitals(&self.id) }] },
                "student": { "description": "Who hands it in.", "anyOf": [student(), { "type": "array", "items": student() }] },
                "students": {
                    "description": "A group.",
                    "anyOf": [student(), { "type": "array", "items": student(), "maxItems": 20 }],
                },
                "answers": answers,
            },
            "additionalProperties": false,
            "definitions": definitions,
        })
    }
}

fn student() -> Value {
    let text = json!({ "type": ["string", "number", "null"] });
    json!({
        "anyOf": [
            text,
            { "type": "object", "properties": { "id": text, "name": text }, "additionalProperties": false },
        ],
    })
}

/// A mapping that holds the fields below `above`: keys may be dotted, nested, or both.
fn keys(fields: &[&str], above: &str) -> Value {
    let mut properties = Map::new();
    let mut spelled = Map::new();
    for path in fields {
        let Some(rest) = path.strip_prefix(above) else { continue };
        for (end, _) in rest.match_indices('.').chain([(rest.len(), "")]) {
            let key = &rest[..end];
            if properties.contains_key(key) {
                continue;
            }
            let value = if end == rest.len() {
                json!({ "$ref": format!("#/definitions/{path}") })
            } else {
                let below = keys(fields, &format!("{above}{key}."));
                json!({ "anyOf": [{ "type": "null" }, below] })
            };
            spelled.insert(any_spelling(key), value.clone());
            properties.insert(key.to_owned(), value);
        }
    }
    json!({
        "type": "object",
        "properties": properties,
        "patternProperties": spelled,
        "additionalProperties": false,
    })
}

fn any_capitals(text: &str) -> String {
    let letter = |c: char| match c {
        c if c.is_ascii_lowercase() => format!("[{c}{}]", c.to_ascii_uppercase()),
        '.' => "\\.".to_owned(),
        c => c.to_string(),
    };
    format!("^{}$", text.chars().map(letter).collect::<String>())
}

/// Capitals do not matter in a key, nor whether words are joined by `_`, `-` or a space.
fn any_spelling(key: &str) -> String {
    any_capitals(key).replace(['_', '-'], "[-_ ]")
}

fn answer(field: &Field, sheet: &AnswerSheet) -> Value {
    let mut description = field.prompt.clone();
    if let Some(unit) = field.unit.as_ref().filter(|unit| !unit.symbol().is_empty()) {
        description.push_str(&format!(" (in {})", unit.symbol()));
    }
    if let Some(words) = sheet.letters.get(&field.path).and_then(|own| own.words(|name| format!("`{name}`")))
    {
        description.push_str(&format!(" ({words})"));
    }
    let mut schema = spellings(field.kind);
    if let Some(entries) = schema.as_object_mut() {
        entries.insert("description".to_owned(), json!(description));
    }
    schema
}

/// Every form an answer may have. What a text says is read later; here it is text.
fn spellings(kind: FieldKind) -> Value {
    let number = || json!({ "type": ["number", "string", "null"] });
    match kind {
        FieldKind::TransferFunction => {
            let polynomial = json!({
                "anyOf": [number(), { "type": "array", "items": number(), "minItems": 1, "maxItems": 31 }],
            });
            json!({
                "anyOf": [
                    number(),
                    { "type": "array", "maxItems": 1 },
                    {
                        "type": "object",
                        "patternProperties": {
                            "^([Nn][Uu][Mm]([Ee][Rr][Aa][Tt][Oo][Rr])?|[Dd][Ee][Nn]([Oo][Mm][Ii][Nn][Aa][Tt][Oo][Rr])?)$": polynomial,
                        },
                        "additionalProperties": false,
                    },
                ],
                "examples": ["(2s + 1)/(s^2 + 3s + 7)", { "num": [2, 1], "den": [1, 3, 7] }],
            })
        }
        FieldKind::Poles => {
            let pole = json!({ "anyOf": [number(), { "type": "object", "minProperties": 1 }] });
            json!({
                "anyOf": [pole, { "type": "array", "items": pole, "maxItems": 60 }],
                "examples": [["-4", "-2 ± 3j"]],
            })
        }
        FieldKind::Value => json!({
            "anyOf": [number(), { "type": "array", "maxItems": 1 }],
            "examples": ["unbounded", "does not exist"],
        }),
        FieldKind::Stability => words(&[
            stability_name(Stability::AsymptoticallyStable),
            stability_name(Stability::MarginallyStable),
            stability_name(Stability::Unstable),
        ]),
        FieldKind::Shape => words(
            &[
                Shape::DecayingOscillation,
                Shape::SustainedOscillation,
                Shape::GrowingOscillation,
                Shape::ExponentialDecay,
                Shape::ExponentialGrowth,
                Shape::PolynomialGrowth,
                Shape::Constant,
            ]
            .map(shape_name),
        ),
        FieldKind::Nonlinearity => words(
            &[
                NonlinearityKind::Saturation,
                NonlinearityKind::DeadZone,
                NonlinearityKind::Backlash,
                NonlinearityKind::Relay,
                NonlinearityKind::CoulombFriction,
                NonlinearityKind::Hysteresis,
                NonlinearityKind::Quantization,
                NonlinearityKind::RateLimit,
            ]
            .map(nonlinearity_name),
        ),
        FieldKind::Prose => json!({ "anyOf": [number(), { "type": "array", "items": number() }] }),
        FieldKind::Figure => json!({ "type": ["string", "null"], "examples": ["my-plot.png"] }),
        FieldKind::Data => json!({
            "anyOf": [{ "type": ["string", "null"] }, { "type": "array" }],
            "examples": ["my-run.csv"],
        }),
        FieldKind::Formula => json!({ "type": ["string", "number", "null"] }),
    }
}

/// Words to choose from, and other words for them; `yes` and `no` are not words to every YAML.
fn words(known: &[&str]) -> Value {
    json!({
        "anyOf": [
            { "enum": known },
            { "type": ["string", "boolean", "null"] },
            { "type": "array", "items": { "type": "string" }, "maxItems": 1 },
        ],
    })
}
