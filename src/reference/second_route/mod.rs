//! Every reference answer a second time, by routes that share as little as possible with the first.

mod comparison;
mod eigenvalues;
mod features;
mod letters;
mod linear;
mod simulations;
mod small_signal;
mod tangent;

use super::Reference;
use crate::lab::LabDefinition;

/// How well two routes to the same answer agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// What was computed twice: `cart.hanging transfer function`.
    pub what: String,
    /// The two ways, in words.
    pub routes: &'static str,
    /// Decimal digits of agreement; infinite when exact.
    pub digits: f64,
    /// Digits demanded.
    pub wanted: f64,
    /// What else was seen, in words; empty when nothing.
    pub note: String,
}

impl Agreement {
    pub fn holds(&self) -> bool {
        self.digits >= self.wanted
    }

    /// Of something that is equal or is not.
    fn exact(what: String, routes: &'static str, equal: bool) -> Self {
        let digits = if equal { f64::INFINITY } else { 0.0 };
        Self { what, routes, digits, wanted: 16.0, note: String::new() }
    }
}

/// Recomputes every reference answer of `lab` by an independent route: operating point by operating point, then the
/// simulations.
pub fn second_route(lab: &LabDefinition, reference: &Reference) -> Vec<Agreement> {
    let mut agreements = Vec::new();
    let parameters = lab.parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
    for (definition, model) in lab.models.iter().zip(&reference.models) {
        for (at, point) in definition.operating_points.iter().zip(&model.operating_points) {
            let name = format!("{}.{}", model.id, point.id);
            let model = &definition.model;
            agreements.push(comparison::equilibrium_route(&name, model, &parameters, at));
            agreements.extend(linear::linear_routes(&name, point));
            agreements.extend(letters::letters_route(&name, point));
            agreements.extend(features::feature_routes(&name, point));
            agreements.extend(small_signal::small_signal_route(&name, model, &parameters, at, point));
            agreements.extend(tangent::tangent_routes(&name, model, &parameters, at, point));
            agreements.extend(comparison::comparison_route(&name, model, &parameters, at, point));
        }
    }
    for (definition, simulation) in lab.simulations.iter().zip(&reference.simulations) {
        agreements.extend(simulations::simulation_routes(definition, simulation));
    }
    agreements
}

/// −log10 of the largest difference, as a part of the largest value.
fn digits_of_agreement(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut difference, mut size) = (0.0f64, 0.0f64);
    for (a, b) in pairs {
        if !(a.is_finite() && b.is_finite()) {
            return 0.0;
        }
        difference = difference.max((a - b).abs());
        size = size.max(a.abs());
    }
    digits(difference, size)
}

/// −log10 of `difference` as a part of `size`; infinite when there is none.
fn digits(difference: f64, size: f64) -> f64 {
    match difference {
        0.0 => f64::INFINITY,
        d if d.is_finite() && size > 0.0 => (size / d).log10(),
        _ => 0.0,
    }
}
