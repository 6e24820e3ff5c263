//! Chains of blocks, followed by small fixed steps.

use super::{Agreement, digits_of_agreement};
use crate::lab::SimulationDefinition;
use crate::nonlinear::{simulate_fixed_step, without_nonlinearities};
use crate::reference::SimulationReference;

/// Fixed steps of the crude second simulation; its error is then some 1e-5 of the peak.
const FIXED_STEPS: usize = 200_000;

pub(super) fn simulation_routes(
    definition: &SimulationDefinition,
    simulation: &SimulationReference,
) -> Vec<Agreement> {
    let linear = without_nonlinearities(&definition.chain);
    let both = [("with", &definition.chain, &simulation.with), ("without", &linear, &simulation.without)];
    let agreements = both.into_iter().map(|(what, chain, run)| {
        let digits = simulate_fixed_step(chain, definition.duration_s, FIXED_STEPS).map_or(0.0, |second| {
            // Within a step of a jump either side of it is right.
            let jumps = run.jumps();
            let step = definition.duration_s / FIXED_STEPS as f64;
            let jumping = |t: f64| {
                let next = jumps.partition_point(|jump| *jump < t - 2.0 * step);
                jumps.get(next).is_some_and(|jump| *jump <= t + 2.0 * step)
            };
            let samples = second.iter().step_by(97).filter(|(t, _)| !jumping(*t));
            digits_of_agreement(samples.map(|(t, y)| (run.at(*t), *y)))
        });
        Agreement {
            what: format!("{} {what} the nonlinearity", definition.id),
            routes: "located switching against small fixed steps",
            digits,
            wanted: 3.5,
            note: String::new(),
        }
    });
    agreements.collect()
}
