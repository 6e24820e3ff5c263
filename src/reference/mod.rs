//! What a right answer is, curves included: computed from a [`LabDefinition`] once.

mod types;

pub use types::*;
