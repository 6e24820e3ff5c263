//! Where a system rests: values as stated or found, for any values of the parameters.

use super::{Equilibrium, Exact, Model, ModelError, ParameterValues};
use crate::algebra::{Expression, Rational};
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
        for (name, value) in &self.entries {
            match value {
                RestValue::Formula(formula) => {
                    let lookup =
                        |name: &str, primes: u8| parameters.get(name).filter(|_| primes == 0).cloned();
                    let value = Exact::evaluate(formula, &lookup)
                        .map_err(|error| ModelError::Rest { name: name.clone(), error: Box::new(error) })?;
                    at.values.insert(name.clone(), value);
                }
            }
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
        })
    }
}

impl RestValue {
    /// Reads a formula of `parameters`.
    pub fn parse(text: &str, parameters: &[&str]) -> Result<Self, crate::algebra::ExpressionError> {
        let formula = Expression::parse(text)?;
        formula.check_names(parameters)?;
        Ok(Self::Formula(formula))
    }
}
