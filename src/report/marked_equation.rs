//! Equations of motion with the part marked where something went wrong.

use super::math;
use crate::grading::EquationPlace;
use crate::lab::LabDefinition;
use serde::Serialize;
use std::ops::Range;

/// An equation as printed, its marked parts in boxes, and in words which they are.
#[derive(Serialize)]
pub struct MarkedEquation {
    pub math_html: String,
    /// `Equation 2 as it is given; the box shows the place.`
    pub caption: String,
}

/// The equations that `places` point into, each once, in the order of their first place.
pub fn of_places(lab: &LabDefinition, places: &[EquationPlace]) -> Vec<MarkedEquation> {
    let mut equations: Vec<(&str, usize)> = Vec::new();
    for place in places {
        let equation = (place.model.as_str(), place.equation);
        if !equations.contains(&equation) {
            equations.push(equation);
        }
    }
    equations.into_iter().filter_map(|(model, equation)| marked(lab, model, equation, places)).collect()
}

fn marked(
    lab: &LabDefinition,
    model: &str,
    index: usize,
    places: &[EquationPlace],
) -> Option<MarkedEquation> {
    let definition = lab.models.iter().find(|m| m.id == model)?;
    let equation = definition.model.equations.get(index)?;
    let mut spans: Vec<Range<usize>> = places
        .iter()
        .filter(|place| place.model == model && place.equation == index)
        .map(|place| place.span.start..place.span.end)
        .collect();
    spans.sort_by_key(|span| (span.start, span.end));
    spans.dedup();
    spans.retain(|span| equation.text.get(span.clone()).is_some_and(|part| !part.is_empty()));
    let boxes = match spans.len() {
        0 => return None,
        1 => "box shows the place",
        _ => "boxes show the places",
    };
    let of_model = if lab.models.len() > 1 { format!(" of {}", definition.title) } else { String::new() };
    Some(MarkedEquation {
        math_html: math::marked_equation(equation, &spans),
        caption: format!("Equation {}{of_model} as it is given; the {boxes}.", index + 1),
    })
}
