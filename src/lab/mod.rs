//! What is asked: the lab file, checked, as a [`LabDefinition`].

mod definition;
mod points;

pub use definition::*;
pub use points::Points;
