//! What is asked: the lab file, checked, as a [`LabDefinition`].

mod answers_schema;
mod check;
mod defaults;
mod definition;
mod errors;
mod feature;
mod file;
mod linear_file;
mod load;
mod mistakes;
mod model_answer;
mod names;
mod near_miss;
mod points;
mod read;
mod schema;
mod schema_markdown;
mod sheet;
mod shelf;
mod spanned;
mod student_edition;
mod template;
mod variants;
mod yaml_slips;

pub use definition::*;
pub use errors::{LabErrors, LoadError};
pub use feature::{AskedFeature, AskedRest, FeatureKind};
pub use load::{DEFAULT, embedded, load, load_student_edition};
pub use mistakes::{MistakesRule, WithoutEffect, mistake_codes};
pub use near_miss::NearMiss;
pub use points::Points;
pub use schema::lab_schema;
pub use schema_markdown::lab_reference;
pub use student_edition::StudentEdition;
pub use variants::{MOST_VARIANTS, Variant, VariantRule, VariedParameter, folded_id};
