//! The lab file as a JSON Schema, for editors: made from the types that read it, their comments its descriptions.

use super::FeatureKind;
use super::check::{CHECKS, KINDS, REST, SOURCES};
use super::file::{
    Entries, FieldFile, FieldForm, LabFile, OutcomeFile, OutcomeForm, RangeFile, Text, VariesFile,
};
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;

/// Draft 7, which editors know best.
pub fn lab_schema() -> Value {
    let generator = SchemaSettings::draft07().with_transform(AlsoNumbers).into_generator();
    let mut schema = generator.into_root_schema_for::<LabFile>();
    schema.insert("title".to_owned(), json!("A polemark lab"));
    schema.to_value()
}

pub(super) fn kinds() -> Vec<&'static str> {
    KINDS.iter().map(|(name, _)| *name).collect()
}

pub(super) fn kinds_and_features() -> Vec<&'static str> {
    [kinds(), features(), vec![REST]].concat()
}

pub(super) fn features() -> Vec<&'static str> {
    FeatureKind::all().map(FeatureKind::as_str).collect()
}

pub(super) fn checks() -> Vec<&'static str> {
    CHECKS.iter().map(|(name, ..)| *name).collect()
}

pub(super) fn responses() -> [&'static str; 2] {
    ["impulse", "step"]
}

pub(super) fn sources() -> Vec<&'static str> {
    SOURCES.iter().map(|(name, _)| *name).collect()
}

/// A mapping whose keys are the author's.
impl<T: JsonSchema> JsonSchema for Entries<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Entries_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<T>() })
    }
}

impl JsonSchema for FieldForm {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "FieldForm".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [{ "enum": kinds_and_features() }, generator.subschema_for::<FieldFile>()],
        })
    }
}

impl JsonSchema for OutcomeForm {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "OutcomeForm".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, generator.subschema_for::<OutcomeFile>()] })
    }
}

impl JsonSchema for VariesFile {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "VariesFile".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [generator.subschema_for::<Vec<Text>>(), generator.subschema_for::<RangeFile>()],
        })
    }
}

/// Every text is read as typed, so that `0.5` may stand where text is read.
#[derive(Clone, Debug)]
struct AlsoNumbers;

impl Transform for AlsoNumbers {
    fn transform(&mut self, schema: &mut Schema) {
        let typed = match schema.get("type") {
            Some(Value::String(word)) => vec![word.clone()],
            Some(Value::Array(words)) => {
                words.iter().filter_map(|word| word.as_str().map(str::to_owned)).collect()
            }
            _ => Vec::new(),
        };
        if schema.get("enum").is_some() {
            schema.remove("type");
        } else if typed.iter().any(|word| word == "string") {
            let also = typed.into_iter().chain(["number".to_owned()]).collect::<Vec<_>>();
            schema.insert("type".to_owned(), json!(also));
        }
        transform_subschemas(self, schema);
    }
}
