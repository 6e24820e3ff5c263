use super::motion::Motion;
use super::{Equilibrium, Linearization, Model, ModelError};
use crate::algebra::{Rational, to_f64};
use crate::nonlinear::integrate;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// How far the nonlinear equations depart from a linear model after impulses of any size.
///
/// Shares nothing with the derivation of that model: the equations are integrated as they stand.
pub struct SmallSignal {
    motion: Motion,
    /// The state after an impulse of 1.
    start: Vec<f64>,
    /// The linear output after an impulse of 1, at each instant.
    linear: Vec<f64>,
    horizon_s: f64,
}

/// What was seen after one push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// Input unit · s.
    pub push: f64,
    /// The largest |output| of the linear model.
    pub linear_peak: f64,
    /// The largest |nonlinear − linear|, as a part of `linear_peak`; of 1 where the linear model does not move.
    pub relative: f64,
}

/// Instants at which both are looked at, after the first.
const INSTANTS: usize = 2_000;
/// Of the integrator.
const TOLERANCE: f64 = 1e-11;

impl SmallSignal {
    /// `linearization` is held against `model` at `at`, for `horizon_s` after the push.
    ///
    /// Errors: [`ModelError::NotLinear`] and [`ModelError::Singular`], when the equations cannot be solved for the highest derivatives.
    pub fn new(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        at: &Equilibrium,
        output: &str,
        linearization: &Linearization,
        horizon_s: f64,
    ) -> Result<Self, ModelError> {
        let space = linearization.state_space.as_ref().ok_or(ModelError::Singular)?;
        let n = space.a.rows.len();
        let start: Vec<f64> = space.b.rows.iter().filter_map(|row| row.first()).map(to_f64).collect();
        let output_row: Vec<f64> = space.c.rows.first().into_iter().flatten().map(to_f64).collect();
        let mut linear = vec![0.0; INSTANTS + 1];
        let a = DMatrix::from_fn(n, n, |i, j| to_f64(&space.a.rows[i][j]));
        let over_a_step = a * (horizon_s / INSTANTS as f64);
        if n > 0 && over_a_step.norm().is_finite() {
            let step = over_a_step.exp();
            let mut state = DVector::from_vec(start.clone());
            for y in &mut linear {
                *y = output_row.iter().zip(state.iter()).map(|(c, x)| c * x).sum();
                state = &step * state;
            }
        }
        Ok(Self { motion: Motion::new(model, parameters, at, output)?, start, linear, horizon_s })
    }

    /// The largest |output| of the linear model after an impulse of 1.
    pub fn linear_peak(&self) -> f64 {
        self.linear.iter().map(|y| y.abs()).fold(0.0, f64::max)
    }

    /// `None` when the equations cannot be followed after such a push.
    ///
    /// Accuracy: about 1e-10, and 1e-16 of the values at rest over the deviations from them.
    pub fn departure(&self, push: f64) -> Option<Departure> {
        let start: Vec<f64> = self.start.iter().map(|x| x * push).collect();
        let mut workspace = self.motion.workspace();
        let rates = |_, state: &[f64], rates: &mut [f64]| self.motion.rates(state, rates, &mut workspace);
        let trajectory = integrate(rates, &start, self.horizon_s, TOLERANCE).ok()?;
        let mut workspace = self.motion.workspace();
        let mut gap = 0.0f64;
        for (nth, unit) in self.linear.iter().enumerate() {
            let t = self.horizon_s * nth as f64 / INSTANTS as f64;
            let y = match self.motion.output_state() {
                Some(state) => trajectory.component(state, t),
                None => self.motion.solved_output(&trajectory.at(t), &mut workspace),
            };
            if !y.is_finite() {
                return None;
            }
            gap = gap.max((y - push * unit).abs());
        }
        let linear_peak = push.abs() * self.linear_peak();
        let scale = if linear_peak > 0.0 { linear_peak } else { 1.0 };
        Some(Departure { push, linear_peak, relative: gap / scale })
    }

    /// The output's deviation at `steps` + 1 instants, in steps of one length; not a number where it cannot be followed.
    ///
    /// Source: the classical Runge–Kutta method of order 4, with nothing in common with the integrator used elsewhere.
    pub fn in_fixed_steps(&self, push: f64, steps: usize) -> Vec<f64> {
        let mut workspace = self.motion.workspace();
        let mut state: Vec<f64> = self.start.iter().map(|x| x * push).collect();
        let n = state.len();
        let h = self.horizon_s / steps as f64;
        let mut k = [const { Vec::new() }; 4];
        k.fill(vec![0.0; n]);
        let mut outputs = Vec::with_capacity(steps + 1);
        outputs.push(self.motion.solved_output(&state, &mut workspace));
        for _ in 0..steps {
            self.motion.rates(&state, &mut k[0], &mut workspace);
            for (stage, share) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
                let between: Vec<f64> = (0..n).map(|i| state[i] + share * h * k[stage - 1][i]).collect();
                self.motion.rates(&between, &mut k[stage], &mut workspace);
            }
            for i in 0..n {
                state[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
            }
            outputs.push(self.motion.solved_output(&state, &mut workspace));
        }
        outputs
    }

    /// As [`Departure::relative`], by [`SmallSignal::in_fixed_steps`]; `steps` is rounded to a multiple of 2,000.
    pub fn fixed_step_departure(&self, push: f64, steps: usize) -> f64 {
        let between = (steps / INSTANTS).max(1);
        let outputs = self.in_fixed_steps(push, between * INSTANTS);
        let seen = outputs.iter().step_by(between).zip(&self.linear);
        seen.map(|(y, unit)| (y - push * unit).abs()).fold(0.0, f64::max) / (push.abs() * self.linear_peak())
    }
}
