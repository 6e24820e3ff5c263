//! What is given: a table of parameters.

use super::math;
use super::numbers::{typeset, typographic};
use crate::lab::LabDefinition;
use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub struct GivenView {
    pub symbol_html: String,
    pub value: String,
    pub unit: String,
    pub description: String,
    /// Differs from student to student.
    pub own: bool,
}

/// Every parameter with the value it has in `lab`.
pub fn all(lab: &LabDefinition) -> Vec<GivenView> {
    let varied =
        |name: &str| lab.variants.iter().flat_map(|rule| &rule.parameters).any(|one| one.name == name);
    let view = |one: &crate::lab::Parameter| GivenView {
        symbol_html: math::symbol(&one.name),
        value: typographic(&one.text),
        unit: typeset(&one.unit),
        description: one.description.clone(),
        own: varied(&one.name),
    };
    lab.parameters.iter().map(view).collect()
}

/// The same in a lab where values differ from student to student; none in another.
pub fn own(lab: &LabDefinition) -> Vec<GivenView> {
    if lab.variants.is_some() { all(lab) } else { Vec::new() }
}
