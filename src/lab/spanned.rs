use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Deserialize, Deserializer};
use serde_yaml::Location;
use std::borrow::Cow;

/// A value of the lab file, and where it stands; of what an alias repeats, where it was first written.
///
/// Our own, so that what is said of such values in a schema can be said here.
#[derive(Clone, Debug)]
pub(super) struct Spanned<T> {
    pub value: T,
    pub defined: Location,
}

/// What stands for a key that is not there: nothing, at no place.
impl<T: Default> Default for Spanned<T> {
    fn default() -> Self {
        Self { value: T::default(), defined: Location::UNKNOWN }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Spanned<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        serde_yaml::Spanned::deserialize(deserializer)
            .map(|serde_yaml::Spanned { value, defined, .. }| Self { value, defined })
    }
}

/// In an editor, the value alone.
impl<T: JsonSchema> JsonSchema for Spanned<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
