use serde::de::{Deserialize, Deserializer};
use serde_yaml::Location;

/// A value of the lab file, and where it stands; of what an alias repeats, where it was first written.
///
/// Our own, so that what is said of such values in a schema can be said here.
#[derive(Clone, Debug)]
pub(super) struct Spanned<T> {
    pub value: T,
    pub defined: Location,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Spanned<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        serde_yaml::Spanned::deserialize(deserializer)
            .map(|serde_yaml::Spanned { value, defined, .. }| Self { value, defined })
    }
}
