mod small_signal;

use super::*;
use crate::algebra::to_f64;
use crate::lab::{LabDefinition, SimulationDefinition};
use crate::lti::{InputKind, Pole, Stability, StateSpace, matrix_exponential_response};
use crate::nonlinear::{simulate_fixed_step, without_nonlinearities};
use nalgebra::linalg::{Schur, balancing};
use nalgebra::{Complex, DMatrix};

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
}

/// Fixed steps of the crude second simulation; its error is then some 1e-5 of the peak.
const FIXED_STEPS: usize = 200_000;

/// Recomputes every reference answer of `lab` by an independent route.
pub fn second_route(lab: &LabDefinition, reference: &Reference) -> Vec<Agreement> {
    let mut agreements = Vec::new();
    let parameters = lab.parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
    for (definition, model) in lab.models.iter().zip(&reference.models) {
        for (at, point) in definition.operating_points.iter().zip(&model.operating_points) {
            let name = format!("{}.{}", model.id, point.id);
            linear_routes(&name, point, &mut agreements);
            agreements.extend(small_signal::small_signal_route(
                &name,
                &definition.model,
                &parameters,
                at,
                point,
            ));
        }
    }
    for (definition, simulation) in lab.simulations.iter().zip(&reference.simulations) {
        simulation_routes(definition, simulation, &mut agreements);
    }
    agreements
}

fn linear_routes(name: &str, point: &OperatingPointReference, agreements: &mut Vec<Agreement>) {
    for linear in &point.accepted {
        let choice: String =
            linear.differs.iter().map(|(name, text, _)| format!(" ({name} = {text})")).collect();
        let same = linear
            .linearization
            .state_space
            .transfer_function()
            .equals(&linear.linearization.transfer_function);
        agreements.push(Agreement {
            what: format!("{name} transfer function{choice}"),
            routes: "elimination against state space, in exact fractions",
            digits: if same { f64::INFINITY } else { 0.0 },
            wanted: 16.0,
            note: String::new(),
        });
    }
    let main = point.main();
    agreements.push(Agreement {
        what: format!("{name} poles of the whole state"),
        routes: "roots of the characteristic polynomial against eigenvalues of A",
        digits: eigenvalue_digits(&main.linearization.state_space, &main.internal_poles),
        wanted: 8.0 / main.internal_poles.iter().map(|p| p.multiplicity).max().unwrap_or(1) as f64,
        note: String::new(),
    });
    for (what, poles, stability) in [
        ("stability", &main.poles, main.stability),
        ("stability of the whole state", &main.internal_poles, main.internal_stability),
    ] {
        agreements.push(Agreement {
            what: format!("{name} {what}"),
            routes: "exact count of right half-plane roots against the signs of the poles",
            digits: if stability_by_poles(poles).is_none_or(|s| s == stability) {
                f64::INFINITY
            } else {
                0.0
            },
            wanted: 16.0,
            note: String::new(),
        });
    }
    for (what, kind, response) in [
        ("impulse response", InputKind::Impulse, &main.impulse),
        ("step response", InputKind::Step, &main.step),
    ] {
        let times: Vec<f64> = (1..=40).map(|i| response.horizon_s * f64::from(i) / 40.0).collect();
        let digits = matrix_exponential_response(&main.linearization.transfer_function, kind, &times).map_or(
            0.0,
            |second| {
                let pairs = times.iter().zip(second).map(|(t, y)| (response.response.at(*t), y));
                digits_of_agreement(pairs)
            },
        );
        agreements.push(Agreement {
            what: format!("{name} {what}"),
            routes: "partial fractions against matrix exponential",
            digits,
            wanted: 8.0,
            note: String::new(),
        });
    }
}

fn simulation_routes(
    definition: &SimulationDefinition,
    simulation: &SimulationReference,
    agreements: &mut Vec<Agreement>,
) {
    let linear = without_nonlinearities(&definition.chain);
    for (what, chain, run) in
        [("with", &definition.chain, &simulation.with), ("without", &linear, &simulation.without)]
    {
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
        agreements.push(Agreement {
            what: format!("{} {what} the nonlinearity", definition.id),
            routes: "located switching against small fixed steps",
            digits,
            wanted: 3.5,
            note: String::new(),
        });
    }
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
    if difference == 0.0 { f64::INFINITY } else { (size / difference).log10() }
}

/// `None` when a pole is too near the axis for its error bound to tell the side.
fn stability_by_poles(poles: &[Pole]) -> Option<Stability> {
    if poles.iter().any(|p| p.re > p.error_bound) {
        return Some(Stability::Unstable);
    }
    poles.iter().all(|p| p.re < -p.error_bound).then_some(Stability::AsymptoticallyStable)
}

/// Eigenvalues are matched greedily with the poles, nearest first; scale is the largest pole.
fn eigenvalue_digits(system: &StateSpace, poles: &[Pole]) -> f64 {
    let n = system.a.rows.len();
    if n == 0 {
        return if poles.is_empty() { f64::INFINITY } else { 0.0 };
    }
    let mut a = DMatrix::from_fn(n, n, |i, j| to_f64(&system.a.rows[i][j]));
    balancing::balance_parlett_reinsch(&mut a);
    let schur = Schur::try_new(a.clone(), f64::EPSILON, 100 * n)
        .or_else(|| Schur::try_new(a.transpose(), f64::EPSILON, 100 * n));
    let Some(schur) = schur else { return 0.0 };
    let mut left: Vec<Complex<f64>> = schur.complex_eigenvalues().iter().copied().collect();
    let scale = poles.iter().map(|p| p.re.hypot(p.im)).fold(f64::MIN_POSITIVE, f64::max);
    let mut worst = 0.0f64;
    for pole in poles.iter().flat_map(|p| std::iter::repeat_n(p, p.multiplicity)) {
        let distance = |z: &Complex<f64>| (z.re - pole.re).hypot(z.im - pole.im);
        let Some(nearest) =
            (0..left.len()).min_by(|i, j| distance(&left[*i]).total_cmp(&distance(&left[*j])))
        else {
            return 0.0;
        };
        worst = worst.max(distance(&left.swap_remove(nearest)) / scale);
    }
    if worst == 0.0 { f64::INFINITY } else { -worst.log10() }
}
