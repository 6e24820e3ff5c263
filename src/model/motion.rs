use super::program::{Meaning, Program};
use super::{Equilibrium, Model, ModelError};
use crate::algebra::Rational;
use std::collections::BTreeMap;

/// Equations of motion ready to be integrated, in deviations from an equilibrium, with every input held there.
///
/// The states are those of [`Model::states`]. The residuals are r(x) + M(x)·h in the highest derivatives h; each
/// evaluation solves the small system for h.
pub(super) struct Motion {
    /// r, with h = 0.
    residuals: Vec<Program>,
    /// M, row by row.
    matrix: Vec<Program>,
    /// Of each state: its value at rest, and where its rate comes from.
    rest: Vec<f64>,
    rates: Vec<Rate>,
    /// The highest derivatives at rest: 0 but for rounding, or the value of a coordinate that is never differentiated.
    highest_at_rest: Vec<f64>,
    output: Output,
}

#[derive(Clone, Copy)]
enum Rate {
    /// The next state is this one's derivative.
    NextState,
    /// One of the highest derivatives.
    Highest(usize),
}

#[derive(Clone, Copy)]
enum Output {
    State(usize),
    /// A coordinate that is never differentiated.
    Highest(usize),
}

/// Room for one evaluation.
pub(super) struct Workspace {
    state: Vec<f64>,
    stack: Vec<f64>,
    matrix: Vec<f64>,
    highest: Vec<f64>,
}

impl Motion {
    pub fn new(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        at: &Equilibrium,
        output: &str,
    ) -> Result<Self, ModelError> {
        let parameters = &model.derived.values(parameters)?;
        let states = model.states();
        let highest = model.highest_derivatives();
        let meaning = |name: &str, primes: u8| {
            let is = |(known, order): &(String, u8)| known == name && *order == primes;
            if let Some(slot) = states.iter().position(is) {
                return Some(Meaning::Slot(slot));
            }
            if highest.iter().any(is) {
                return Some(Meaning::Constant(0.0));
            }
            at.lookup(parameters, name, primes).map(|value| Meaning::Constant(value.to_f64()))
        };

        let mut residuals = Vec::new();
        let mut matrix = Vec::new();
        for equation in 0..model.equations.len() {
            let residual = model.residual(equation);
            residuals.push(Program::new(&residual, &meaning)?);
            for (name, order) in &highest {
                let slope = residual.differentiate(name, *order);
                let still_there = slope.symbols().into_iter().find(|symbol| {
                    highest.iter().any(|(name, order)| *name == symbol.name && *order == symbol.primes)
                });
                if let Some(symbol) = still_there {
                    let primes = "'".repeat(usize::from(symbol.primes));
                    let symbol = format!("{}{primes}", symbol.name);
                    return Err(ModelError::NotLinear { equation: equation + 1, symbol });
                }
                matrix.push(Program::new(&slope, &meaning)?);
            }
        }

        let rest_of = |name: &str, primes: u8| at.value(name, primes).map_or(0.0, |value| value.to_f64());
        let rates = states.iter().map(|(name, primes)| {
            match highest.iter().position(|(other, order)| other == name && *order == primes + 1) {
                Some(index) => Rate::Highest(index),
                None => Rate::NextState,
            }
        });
        let output_place = match states.iter().position(|(name, primes)| name == output && *primes == 0) {
            Some(state) => Output::State(state),
            None => match highest.iter().position(|(name, _)| name == output) {
                Some(index) => Output::Highest(index),
                None => return Err(ModelError::NoValue { name: output.to_owned() }),
            },
        };
        let mut motion = Self {
            rates: rates.collect(),
            rest: states.iter().map(|(name, primes)| rest_of(name, *primes)).collect(),
            highest_at_rest: vec![0.0; highest.len()],
            residuals,
            matrix,
            output: output_place,
        };
        // π is not π in floating point: what is left of gravity at an upright pendulum would topple it. `at` has been
        // proved an equilibrium in exact numbers, so this remainder is only rounding and is taken off for good.
        let mut workspace = motion.workspace();
        motion.solve(&vec![0.0; states.len()], &mut workspace);
        if workspace.highest.iter().any(|value| !value.is_finite()) {
            return Err(ModelError::Singular);
        }
        motion.highest_at_rest = workspace.highest;
        Ok(motion)
    }

    pub fn workspace(&self) -> Workspace {
        let (states, equations) = (self.rest.len(), self.residuals.len());
        Workspace {
            state: vec![0.0; states],
            stack: Vec::with_capacity(16),
            matrix: vec![0.0; equations * equations],
            highest: vec![0.0; equations],
        }
    }

    /// The rates of `deviation` (of the state from rest); NaN where the equations have no solution.
    pub fn rates(&self, deviation: &[f64], rates: &mut [f64], workspace: &mut Workspace) {
        self.solve(deviation, workspace);
        for (index, rate) in self.rates.iter().enumerate() {
            rates[index] = match *rate {
                Rate::NextState => deviation[index + 1],
                Rate::Highest(highest) => workspace.highest[highest] - self.highest_at_rest[highest],
            };
        }
    }

    /// The state that is the output, when it is one.
    pub fn output_state(&self) -> Option<usize> {
        match self.output {
            Output::State(state) => Some(state),
            Output::Highest(_) => None,
        }
    }

    /// The output's deviation from rest, also when it is not a state but solved for.
    pub fn solved_output(&self, deviation: &[f64], workspace: &mut Workspace) -> f64 {
        match self.output {
            Output::State(state) => deviation[state],
            Output::Highest(index) => {
                self.solve(deviation, workspace);
                workspace.highest[index] - self.highest_at_rest[index]
            }
        }
    }

    /// Solves M·h = −r into `workspace.highest`.
    fn solve(&self, deviation: &[f64], workspace: &mut Workspace) {
        let Workspace { state, stack, matrix, highest } = workspace;
        for (value, (rest, deviation)) in state.iter_mut().zip(self.rest.iter().zip(deviation)) {
            *value = rest + deviation;
        }
        for (right, residual) in highest.iter_mut().zip(&self.residuals) {
            *right = -residual.run(state, stack);
        }
        for (entry, program) in matrix.iter_mut().zip(&self.matrix) {
            *entry = program.run(state, stack);
        }
        eliminate(matrix, highest);
    }
}

/// Gaussian elimination with partial pivoting, in place: `right` becomes the solution, not a number where there is none.
fn eliminate(matrix: &mut [f64], right: &mut [f64]) {
    let n = right.len();
    for column in 0..n {
        let size = |row: &usize| matrix[row * n + column].abs();
        let pivot = (column..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(column);
        if pivot != column {
            (0..n).for_each(|k| matrix.swap(pivot * n + k, column * n + k));
            right.swap(pivot, column);
        }
        for row in column + 1..n {
            let factor = matrix[row * n + column] / matrix[column * n + column];
            for k in column..n {
                matrix[row * n + k] -= factor * matrix[column * n + k];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| matrix[row * n + k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row * n + row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elimination() {
        for (name, mut matrix, mut right, solution) in [
            ("one", vec![4.0], vec![2.0], vec![0.5]),
            ("pivot of zero", vec![0.0, 2.0, 1.0, 1.0], vec![6.0, 5.0], vec![2.0, 3.0]),
            (
                "three",
                vec![2.0, 1.0, -1.0, -3.0, -1.0, 2.0, -2.0, 1.0, 2.0],
                vec![8.0, -11.0, -3.0],
                vec![2.0, 3.0, -1.0],
            ),
            ("none", vec![], vec![], vec![]),
        ] {
            eliminate(&mut matrix, &mut right);
            for (found, expected) in right.iter().zip(&solution) {
                assert!((found - expected).abs() < 1e-14, "{name}: {right:?}");
            }
        }
        let mut right = [1.0, 2.0];
        eliminate(&mut [1.0, 2.0, 2.0, 4.0], &mut right);
        assert!(right.iter().any(|value| !value.is_finite()));
    }
}
