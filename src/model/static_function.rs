use super::program::{Meaning, Program};
use super::{Equilibrium, Model, ModelError};
use crate::algebra::Rational;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// A system in which nothing is differentiated: one coordinate as a function of one input, the other inputs at rest.
pub struct StaticFunction {
    /// left − right of each equation; slots: the coordinates, then the input.
    residuals: Vec<Program>,
    /// Their slopes along the coordinates, row by row.
    slopes: Vec<Program>,
    /// Whether no coordinate stands in a slope, so that one step solves the equations.
    is_linear: bool,
    rest: Vec<f64>,
    x0: f64,
    output: usize,
}

/// Steps from rest to a point, where the equations are not linear in the coordinates.
const STEPS: usize = 64;
/// Newton's steps at each.
const MOST_NEWTON: usize = 30;

impl Model {
    /// Whether nothing in it is differentiated, so that it has no states and no responses.
    pub fn is_static(&self) -> bool {
        let mut sides = self.equations.iter().flat_map(|equation| [&equation.left, &equation.right]);
        sides.all(|side| side.symbols().iter().all(|symbol| symbol.primes == 0))
    }
}

impl StaticFunction {
    /// `None` when `model` is not static.
    pub fn new(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        at: &Equilibrium,
        input: &str,
        output: &str,
    ) -> Result<Option<Self>, ModelError> {
        if !model.is_static() {
            return Ok(None);
        }
        let parameters = &model.derived.values(parameters)?;
        let names: Vec<&str> = model.coordinates.iter().map(|c| c.name.as_str()).collect();
        let meaning = |name: &str, primes: u8| {
            if let Some(slot) = names.iter().position(|known| *known == name) {
                return Some(Meaning::Slot(slot));
            }
            if name == input {
                return Some(Meaning::Slot(names.len()));
            }
            at.lookup(parameters, name, primes).map(|value| Meaning::Constant(value.to_f64()))
        };
        let (mut residuals, mut slopes, mut is_linear) = (Vec::new(), Vec::new(), true);
        for equation in 0..model.equations.len() {
            let residual = model.residual(equation);
            for name in &names {
                let slope = residual.differentiate(name, 0);
                is_linear &= slope.symbols().iter().all(|symbol| !names.contains(&symbol.name.as_str()));
                slopes.push(Program::new(&slope, &meaning)?);
            }
            residuals.push(Program::new(&residual, &meaning)?);
        }
        let rest_of = |name: &str| at.value(name, 0).map_or(0.0, |value| value.to_f64());
        let no_value = || ModelError::NoValue { name: output.to_owned() };
        Ok(Some(Self {
            rest: names.iter().map(|name| rest_of(name)).collect(),
            x0: rest_of(input),
            output: names.iter().position(|name| *name == output).ok_or_else(no_value)?,
            residuals,
            slopes,
            is_linear,
        }))
    }

    /// Input and output at rest.
    pub fn rest(&self) -> (f64, f64) {
        (self.x0, self.rest[self.output])
    }

    /// The output at `x`; NaN where it has no value, or none that one comes to from rest.
    ///
    /// Accuracy: that of floating point, where the equations are well conditioned.
    pub fn at(&self, x: f64) -> f64 {
        let steps = if self.is_linear { 1 } else { STEPS };
        let mut values = self.rest.clone();
        for step in 1..=steps {
            let part = step as f64 / steps as f64;
            let here = if step == steps { x } else { self.x0 + part * (x - self.x0) };
            match self.solved(&values, here) {
                Some(next) => values = next,
                None => return f64::NAN,
            }
        }
        values[self.output]
    }

    fn solved(&self, start: &[f64], x: f64) -> Option<Vec<f64>> {
        let n = start.len();
        let mut values = start.to_vec();
        values.push(x);
        let mut stack = Vec::new();
        for _ in 0..MOST_NEWTON {
            let residual =
                DVector::from_iterator(n, self.residuals.iter().map(|p| p.run(&values, &mut stack)));
            let slopes: Vec<f64> = self.slopes.iter().map(|p| p.run(&values, &mut stack)).collect();
            if residual.iter().chain(&slopes).any(|value| !value.is_finite()) {
                return None;
            }
            let step = DMatrix::from_row_slice(n, n, &slopes).lu().solve(&residual)?;
            let mut moved = false;
            for (value, step) in values.iter_mut().zip(step.iter()) {
                moved |= step.abs() > 1e-14 * value.abs().max(1e-300);
                *value -= step;
            }
            if self.is_linear || !moved {
                values.truncate(n);
                return values.iter().all(|value| value.is_finite()).then_some(values);
            }
        }
        let small = |p: &Program| p.run(&values, &mut Vec::new()).abs() < 1e-10;
        let settled = self.residuals.iter().all(small);
        values.truncate(n);
        settled.then_some(values)
    }
}
