use super::parameters::{Parameters, reason};
use super::{Checker, span};
use crate::lab::file::{ComparisonFile, LabFile, ModelFile, OperatingPointFile, Text};
use crate::lab::names::list;
use crate::lab::{OperatingPointDefinition, defaults};
use crate::model::{self, Comparison, Equilibrium, Model, ModelError, Rest, RestValue};
use crate::submission::Unit;
use std::collections::{BTreeMap, BTreeSet};

impl Checker<'_> {
    /// `None` when it cannot be built, or the model or the parameters could not.
    pub(super) fn operating_point(
        &mut self,
        id: &Text,
        file: &OperatingPointFile,
        model: &ModelFile,
        parameter_names: &[&str],
        checked: Option<(&Model, &Parameters)>,
    ) -> Option<OperatingPointDefinition> {
        let coordinates: Vec<&str> = names(&model.coordinates.value.0);
        let inputs: Vec<&str> = names(&model.inputs.value.0);
        let both: Vec<&str> = coordinates.iter().chain(&inputs).copied().collect();
        let before = self.findings.len();
        let mut entries = Vec::new();
        for (name, text) in &file.at.0 {
            self.at_rest(name, &both, &names(&model.outputs.0));
            if let Some(value) = self.rest_value(text, parameter_names) {
                entries.push((name.value.clone(), value));
            }
        }
        let input = self.signal(&file.input, "input", &inputs);
        let watched: Vec<(&str, &str)> = units(model);
        let known: Vec<&str> = watched.iter().map(|(name, _)| *name).collect();
        let output = self.signal(&file.output, "coordinate or output", &known);
        let comparison = match &file.comparison {
            Some(comparison) => self.comparison(comparison).map(Some),
            None => Some(None),
        };
        let (model_is, parameters) = checked?;
        if self.findings.len() > before {
            return None;
        }
        let solved: BTreeSet<String> = entries
            .iter()
            .filter(|(_, value)| matches!(value, RestValue::Solve { .. }))
            .map(|(name, _)| name.clone())
            .collect();
        let rest = Rest::new(entries);
        let at = self.balance(id, file, model_is, parameters, &rest)?;
        let tangent = self.tangent(file, model_is, &at);
        let at_text = file.at.0.iter().map(|(name, text)| {
            let found = at.values.get(&name.value).filter(|_| solved.contains(&name.value));
            (name.value.clone(), found.map_or_else(|| text.value.clone(), ToString::to_string))
        });
        Some(OperatingPointDefinition {
            at_text: at_text.collect(),
            solved,
            id: id.value.clone(),
            title: defaults::title(file.title.as_ref(), &id.value),
            at,
            rest,
            input: file.input.value.clone(),
            input_unit: model.inputs.value.0[input?].1.unit.clone(),
            output: file.output.value.clone(),
            output_unit: watched[output?].1.to_owned(),
            comparison: comparison?,
            tangent: tangent?,
            span: span(id),
        })
    }

    fn at_rest(&mut self, name: &Text, known: &[&str], outputs: &[&str]) {
        if outputs.contains(&name.value.as_str()) {
            let message = format!("`{}` is an output: where it rests follows from its formula", name.value);
            self.error("lab.equilibrium", span(name), message, Some("leave it out".to_owned()));
        } else {
            self.one_of(name, "coordinate or input", known);
        }
    }

    /// A coordinate or an input at rest.
    fn rest_value(&mut self, text: &Text, parameters: &[&str]) -> Option<RestValue> {
        match RestValue::parse(&text.value, parameters) {
            Ok(value) => Some(value),
            Err(mut error) => {
                if let Some(help) = unit_help(&text.value) {
                    error.help = Some(help);
                }
                self.expression_error("lab.equilibrium", text, error);
                None
            }
        }
    }

    fn comparison(&mut self, comparison: &ComparisonFile) -> Option<Comparison> {
        let horizon_s = self.positive(&comparison.horizon_s, "a horizon");
        let departure = self.positive(&comparison.departure, "a departure");
        let pushes: Vec<Option<f64>> = comparison
            .pushes
            .value
            .iter()
            .map(|text| {
                let push = self.float(text)?;
                if push == 0.0 {
                    self.error("lab.number", span(text), "a push of 0 moves nothing", None);
                }
                Some(push)
            })
            .collect();
        if pushes.is_empty() {
            self.error("lab.number", span(&comparison.pushes), "at least one push is needed", None);
        }
        Some(Comparison {
            horizon_s: horizon_s?,
            departure: departure?,
            pushes: pushes.into_iter().collect::<Option<_>>()?,
        })
    }

    /// Nothing may move at the operating point, and the equations must be solvable for the accelerations there.
    fn balance(
        &mut self,
        id: &Text,
        file: &OperatingPointFile,
        model: &Model,
        parameters: &Parameters,
        rest: &Rest,
    ) -> Option<Equilibrium> {
        let values: BTreeMap<_, _> =
            parameters.list.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
        let at = rest.at(model, &values).and_then(|at| {
            model::linearize(model, &values, &at, &file.input.value, &file.output.value)?;
            Ok(at)
        });
        let error = match at {
            Ok(at) => return Some(at),
            Err(error) => error,
        };
        let typed = |name: &String| {
            let own = file.at.0.iter().find(|(known, _)| known.value == *name);
            own.map(|(_, text)| span(text))
        };
        let first = file.at.0.first().map_or(span(id), |(_, text)| span(text));
        let (place, message, help) = match &error {
            ModelError::NotAnEquilibrium { .. } => (
                first,
                error.to_string(),
                Some("give the values of coordinates and inputs at which nothing moves".to_owned()),
            ),
            ModelError::Free { name } => {
                (typed(name).unwrap_or(first), error.to_string(), Some("give it a value".to_owned()))
            }
            ModelError::Undetermined { names }
            | ModelError::NotFound { names }
            | ModelError::Several { names, .. }
            | ModelError::Indistinct { names, .. } => {
                let help = match &error {
                    ModelError::Undetermined { .. } => "give one of them a value".to_owned(),
                    ModelError::NotFound { .. } => {
                        "check the equations and what is given, or say where to look: `solve near 0.3`"
                            .to_owned()
                    }
                    ModelError::Several { values, .. } => {
                        let value =
                            values.first().and_then(|first| first.rsplit(" = ").next()).unwrap_or("0.3");
                        format!("say which one is meant, such as `solve near {value}`")
                    }
                    _ => "give a value, or choose another operating point".to_owned(),
                };
                (names.iter().find_map(typed).unwrap_or(first), error.to_string(), Some(help))
            }
            ModelError::Rest { name, error } => (
                typed(name).unwrap_or(first),
                format!("`{name}` has no value at rest: {}", reason(error)),
                None,
            ),
            _ => (first, error.to_string(), None),
        };
        let names = model.coordinates.iter().map(|c| &c.name).chain(&model.inputs);
        let left_out: Vec<&str> = names
            .filter(|name| !model.outputs.contains(name) && typed(name).is_none())
            .map(String::as_str)
            .collect();
        let taken = match left_out.as_slice() {
            [] => None,
            [one] => Some(format!("`{one}` is not given, so it is taken for 0")),
            several => Some(format!("{} are not given, so they are taken for 0", list(several))),
        };
        let help = match (help, taken) {
            (Some(help), Some(taken)) => Some(format!("{help}; {taken}")),
            (help, taken) => help.or(taken),
        };
        self.error("lab.equilibrium", place, message, help);
        None
    }

    /// Which of `known` a point names; of several it has to say it.
    fn signal(&mut self, text: &Text, what: &str, known: &[&str]) -> Option<usize> {
        if !text.value.is_empty() || known.is_empty() {
            return self.one_of(text, what, known);
        }
        let key = if what == "input" { "input" } else { "output" };
        let message = format!("it is not said which {what} this point is about");
        let help = format!("add `{key}:` with one of {}", list(known));
        self.error("lab.missing_key", span(text), message, Some(help));
        None
    }
}

/// What to do about `30 deg` and its like.
fn unit_help(text: &str) -> Option<String> {
    let text = text.trim();
    let number = text.find(|c: char| !c.is_ascii_digit() && !matches!(c, '.' | '-' | '+'))?;
    let (number, unit) = text.split_at(number);
    let unit = Unit::parse(unit).filter(|_| !number.is_empty())?;
    Some(match unit.symbol() {
        "deg" => format!("angles are in radians: write `{number}*pi/180`"),
        _ => format!("write the number alone, `{number}`, in the unit that the coordinate has"),
    })
}

fn names<T>(entries: &[(Text, T)]) -> Vec<&str> {
    entries.iter().map(|(name, _)| name.value.as_str()).collect()
}

/// What can be watched, each with its unit: coordinates, then outputs.
pub(super) fn units(model: &ModelFile) -> Vec<(&str, &str)> {
    let coordinates = model.coordinates.value.0.iter();
    let coordinates = coordinates.map(|(name, quantity)| (name.value.as_str(), quantity.unit.trim()));
    let outputs = model.outputs.0.iter();
    coordinates.chain(outputs.map(|(name, output)| (name.value.as_str(), output.unit.trim()))).collect()
}

/// Coordinates, outputs and inputs of each model, each with its unit.
pub(super) fn signals(file: &LabFile) -> Vec<(String, Vec<(String, String)>)> {
    let of = |model: &ModelFile| {
        let inputs = model
            .inputs
            .value
            .0
            .iter()
            .map(|(name, input)| (name.value.clone(), input.unit.trim().to_owned()));
        let watched = units(model).into_iter().map(|(name, unit)| (name.to_owned(), unit.to_owned()));
        watched.chain(inputs).collect()
    };
    file.models.0.iter().map(|(id, model)| (id.value.clone(), of(model))).collect()
}
