use super::{Equilibrium, Model, ModelError};
use crate::algebra::Rational;
use std::collections::BTreeMap;

/// How linear and nonlinear answers to a push are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Seconds looked at.
    pub horizon_s: f64,
    /// Relative departure (of the linear peak) at which they are said to part: 0.1 is 10 %.
    pub departure: f64,
    /// Impulses (input unit · s) to draw.
    pub pushes: Vec<f64>,
}

/// Output deviation after an impulse at the input, linear beside nonlinear.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonRun {
    /// (push, samples of (t, linear, nonlinear)), output deviation from equilibrium in its unit.
    pub runs: Vec<(f64, Vec<(f64, f64, f64)>)>,
    /// The smallest impulse (input unit · s) whose departure reaches `Comparison::departure`, to three figures or better;
    /// `None` if none up to a million times the smallest push does.
    pub parting_push: Option<f64>,
    /// The largest |output| of the linear model at that push.
    pub parting_amplitude: Option<f64>,
}

/// Integrates the nonlinear equations beside the linear model after impulses at the input.
pub fn compare(
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    input: &str,
    output: &str,
    comparison: &Comparison,
) -> Result<ComparisonRun, ModelError> {
    let _ = (model, parameters, at, input, output, comparison);
    todo!()
}
