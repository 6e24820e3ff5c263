//! Where a system rests: values as stated or found, for any values of the parameters.

mod form;
mod interval;
mod nonlinear;
mod proof;
mod solve;
#[cfg(test)]
mod tests;

use self::nonlinear::Unknown;
use super::{Equilibrium, Exact, Model, ModelError, ParameterValues};
use crate::algebra::{Expression, ExpressionError, Rational};
use std::collections::BTreeMap;

/// What a lab says of an operating point: coordinates and inputs at rest. What is not listed is 0.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Rest {
    entries: Vec<(String, RestValue)>,
}

/// A coordinate or an input at rest.
#[derive(Clone, Debug, PartialEq)]
pub enum RestValue {
    /// Of parameters, numbers and pi.
    Formula(Expression),
    /// Whatever balances the equations, looked for near the value of that formula first.
    Solve { near: Option<Expression> },
}

impl Rest {
    pub fn new(entries: Vec<(String, RestValue)>) -> Self {
        Self { entries }
    }

    /// Reads values such as `pi` or `k*sqrt(4)`.
    ///
    /// Errors: names that the model does not have, and texts that are no formula of its parameters.
    pub fn parse(model: &Model, pairs: &[(String, String)]) -> Result<Self, ModelError> {
        let outer = |name: &&str| !model.outputs.iter().any(|output| output == name);
        let coordinates = model.coordinates.iter().map(|c| c.name.as_str()).filter(outer);
        let known: Vec<&str> = coordinates.chain(model.inputs.iter().map(String::as_str)).collect();
        let parameters: Vec<&str> = model.parameters.iter().map(String::as_str).collect();
        let mut entries = Vec::new();
        for (name, text) in pairs {
            if !known.contains(&name.as_str()) {
                let list: Vec<String> = known.iter().map(|n| format!("`{n}`")).collect();
                let known = format!("these are {}", list.join(", "));
                return Err(ModelError::UnknownName { name: name.clone(), known });
            }
            let value = RestValue::parse(text, &parameters).map_err(|e| ModelError::Value {
                name: name.to_owned(),
                start: e.start,
                end: e.end,
                message: e.message,
                help: e.help,
            })?;
            entries.push((name.clone(), value));
        }
        Ok(Self { entries })
    }

    /// Coordinates, inputs and outputs at rest with these values of the parameters; what follows from them is worked out.
    ///
    /// Errors: a formula that has no value. Whether the equations balance there is not looked at.
    pub fn at(
        &self,
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
    ) -> Result<Equilibrium, ModelError> {
        let parameters = model.derived.values(parameters)?;
        self.with(model, &parameters)
    }

    pub(super) fn with(
        &self,
        model: &Model,
        parameters: &ParameterValues,
    ) -> Result<Equilibrium, ModelError> {
        let names = model.coordinates.iter().map(|c| &c.name).chain(&model.inputs);
        let mut at = Equilibrium { values: names.map(|name| (name.clone(), Exact::zero())).collect() };
        let mut unknowns = Vec::new();
        for (name, value) in &self.entries {
            let formula = match value {
                RestValue::Formula(formula) => Some(formula),
                RestValue::Solve { near } => near.as_ref(),
            };
            let lookup = |name: &str, primes: u8| parameters.get(name).filter(|_| primes == 0).cloned();
            let stated = formula.map(|formula| Exact::evaluate(formula, &lookup)).transpose();
            let stated =
                stated.map_err(|error| ModelError::Rest { name: name.clone(), error: Box::new(error) })?;
            match (value, stated) {
                (RestValue::Formula(_), Some(value)) => {
                    at.values.insert(name.clone(), value);
                }
                (_, near) => {
                    unknowns.push(Unknown { name: name.clone(), near: near.map(|near| near.to_f64()) });
                }
            }
        }
        if !unknowns.is_empty() {
            let known = |name: &str| at.values.get(name).or_else(|| parameters.get(name)).cloned();
            let found = solve::solve(model, &known, unknowns)?;
            at.values.extend(found);
        }
        for (name, formula) in model.output_formulas() {
            let value = Exact::evaluate(formula, &|name, primes| at.lookup(parameters, name, primes))
                .map_err(|error| ModelError::Rest { name: name.to_owned(), error: Box::new(error) })?;
            at.values.insert(name.to_owned(), value);
        }
        Ok(at)
    }

    /// Whether it is another place when `parameter` has another value.
    pub(super) fn depends_on(&self, model: &Model, parameter: &str) -> bool {
        let follows = |name: &str| name == parameter || model.derived.depends(name, parameter);
        self.entries.iter().any(|(_, value)| match value {
            RestValue::Formula(formula) => formula.symbols().iter().any(|symbol| follows(&symbol.name)),
            // It follows from all that stands in the equations, which counts already.
            RestValue::Solve { near } => {
                near.iter().flat_map(Expression::symbols).any(|symbol| follows(&symbol.name))
            }
        })
    }
}

impl RestValue {
    /// Reads a formula of `parameters`, `solve`, or `solve near` such a formula.
    pub fn parse(text: &str, parameters: &[&str]) -> Result<Self, ExpressionError> {
        let Some(start) = after_solve(text) else { return Ok(Self::Formula(formula(text, parameters)?)) };
        let rest = &text[start..];
        if rest.trim().is_empty() {
            return Ok(Self::Solve { near: None });
        }
        let before = start + rest.len() - rest.trim_start().len();
        let near = text[before..].strip_prefix("near").filter(|near| {
            near.trim_start().len() < near.len() || near.starts_with(['(', '-', '+', '.']) || near.is_empty()
        });
        let Some(near) = near.filter(|near| !near.trim().is_empty()) else {
            return Err(ExpressionError {
                start: before,
                end: text.trim_end().len(),
                message: format!("`{}` cannot stand after `solve`", rest.trim()),
                help: Some("write `solve`, or `solve near 0.3`".to_owned()),
            });
        };
        let moved = text.len() - near.len();
        let near = formula(near, parameters).map_err(|error| ExpressionError {
            start: error.start + moved,
            end: error.end + moved,
            ..error
        })?;
        Ok(Self::Solve { near: Some(near) })
    }
}

/// Where the word `solve`, when that is the first, ends.
fn after_solve(text: &str) -> Option<usize> {
    let begin = text.len() - text.trim_start().len();
    let rest = text[begin..].strip_prefix("solve")?;
    (rest.is_empty() || rest.starts_with(char::is_whitespace)).then_some(begin + "solve".len())
}

fn formula(text: &str, parameters: &[&str]) -> Result<Expression, ExpressionError> {
    let formula = Expression::parse(text)?;
    formula.check_names(parameters)?;
    match formula.symbols().into_iter().find(|symbol| symbol.primes > 0) {
        Some(symbol) => Err(ExpressionError {
            start: symbol.start,
            end: symbol.end,
            message: format!("`{}` is a parameter, so it has no derivative", symbol.name),
            help: Some(format!("write `{}` without primes", symbol.name)),
        }),
        None => Ok(formula),
    }
}
