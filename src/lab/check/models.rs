use super::linear::linear_model;
use super::parameters::Parameters;
use super::{Checker, span};
use crate::algebra::{Expression, ExpressionError, NodeKind, SymbolUse};
use crate::lab::file::{LabFile, ModelFile, OutputFile, Text};
use crate::lab::{ModelDefinition, defaults};
use crate::model::{Coordinate, DerivedParameters, Equation, LinearForm, Model, ModelError};

impl Checker<'_> {
    pub(super) fn models(
        &mut self,
        file: &LabFile,
        parameters: Option<&Parameters>,
    ) -> Option<Vec<ModelDefinition>> {
        let letters: Vec<&str> = file.parameters.0.iter().map(|(name, _)| name.value.as_str()).collect();
        let models = file.models.0.iter().map(|(id, m)| {
            self.id(id, "model id");
            let derived = parameters.map(|parameters| parameters.derived.clone()).unwrap_or_default();
            let linear = self.linear_form(m, &letters);
            let model = self.model(m, &letters, derived, linear.as_ref());
            let points = m.operating_points.value.0.iter().map(|(point, p)| {
                self.id(point, "operating point id");
                self.operating_point(point, p, m, &letters, model.as_ref().zip(parameters))
            });
            let operating_points: Vec<_> = points.collect();
            if operating_points.is_empty() {
                let message = format!("the model `{}` has no operating point", id.value);
                self.error("lab.model", span(&m.operating_points), message, None);
            }
            Some(ModelDefinition {
                id: id.value.clone(),
                title: defaults::title(m.title.as_ref(), &id.value),
                model: model?,
                linear,
                operating_points: operating_points.into_iter().collect::<Option<_>>()?,
            })
        });
        let models: Vec<_> = models.collect();
        models.into_iter().collect()
    }

    fn model(
        &mut self,
        file: &ModelFile,
        letters: &[&str],
        derived: DerivedParameters,
        linear: Option<&LinearForm>,
    ) -> Option<Model> {
        let (coordinates, inputs) = (&file.coordinates.value.0, &file.inputs.value.0);
        let mut known: Vec<&str> = letters.to_vec();
        for (name, what) in coordinates
            .iter()
            .map(|(name, _)| (name, "coordinate"))
            .chain(inputs.iter().map(|(name, _)| (name, "input")))
            .chain(file.outputs.0.iter().map(|(name, _)| (name, "output")))
        {
            self.symbol(name, what);
            if known.contains(&name.value.as_str()) {
                let message = format!("the {what} `{}` has the name of something else", name.value);
                self.error("lab.duplicate", span(name), message, Some("choose another name".to_owned()));
            }
            known.push(&name.value);
        }
        if inputs.is_empty() {
            self.error("lab.model", span(&file.inputs), "a model needs an input", None);
        }
        if file.linear.is_some() {
            return linear.map(|linear| linear_model(linear, file, letters, derived));
        }
        let equations = &file.equations.value;
        if equations.len() != coordinates.len() || (equations.is_empty() && file.outputs.0.is_empty()) {
            let message = format!(
                "{} equations for {} coordinates: there must be as many of one as of the other",
                equations.len(),
                coordinates.len()
            );
            let place = equations.last().map_or(span(&file.equations), span);
            self.error("lab.equation", place, message, None);
            return None;
        }
        let moving = coordinates.iter().map(|(name, _)| name).chain(inputs.iter().map(|(name, _)| name));
        let moving: Vec<&str> = moving.map(|name| name.value.as_str()).collect();
        known.truncate(known.len() - file.outputs.0.len());
        let equations: Vec<_> = equations.iter().map(|text| self.equation(text, &known, &moving)).collect();
        let mut model = Model {
            coordinates: coordinates
                .iter()
                .map(|(name, quantity)| Coordinate {
                    name: name.value.clone(),
                    unit: quantity.unit.clone(),
                    description: quantity.description.trim().to_owned(),
                })
                .collect(),
            inputs: inputs.iter().map(|(name, _)| name.value.clone()).collect(),
            parameters: letters.iter().map(|&name| name.to_owned()).collect(),
            derived,
            equations: equations.into_iter().collect::<Option<_>>()?,
            outputs: Vec::new(),
        };
        let before = self.findings.len();
        file.outputs.0.iter().for_each(|(name, output)| self.output(&mut model, name, output));
        (self.findings.len() == before).then_some(model)
    }

    fn output(&mut self, model: &mut Model, name: &Text, file: &OutputFile) {
        let output = Coordinate {
            name: name.value.clone(),
            unit: file.unit.clone(),
            description: file.description.trim().to_owned(),
        };
        // That a formula is needed is said when the file is read.
        let Some(formula) = &file.formula else { return };
        match model.add_output(output, &formula.value) {
            Ok(()) => {}
            Err(ModelError::Value { start, end, message, help, .. }) => {
                let place = self.locate(formula, start, end);
                self.error("lab.equation", place, message, help);
            }
            // What is wrong with the name has been reported with the others.
            Err(ModelError::InvalidName { .. } | ModelError::DuplicateName { .. }) => {}
            Err(error) => self.error("lab.equation", span(formula), error.to_string(), None),
        }
    }

    fn equation(&mut self, text: &Text, known: &[&str], moving: &[&str]) -> Option<Equation> {
        let (left, right) = match Expression::parse_equation(&text.value) {
            Ok(sides) => sides,
            Err(error) => {
                self.expression_error("lab.equation", text, error);
                return None;
            }
        };
        let before = self.findings.len();
        for symbol in left.symbols().into_iter().chain(right.symbols()) {
            let SymbolUse { name, primes, start, end } = symbol;
            let place = self.locate(text, start, end);
            let alone = Expression { kind: NodeKind::Symbol { name: name.clone(), primes }, start, end };
            if let Err(mut error) = alone.check_names(known) {
                error.help = error.help.map(|help| with_primes(&help, primes, moving));
                self.expression_error("lab.equation", text, error);
            } else if primes > 0 && !moving.contains(&name.as_str()) {
                let message = format!("`{name}` is a parameter, so it has no derivative");
                self.error("lab.equation", place, message, Some(format!("write `{name}` without primes")));
            } else if primes > 2 {
                let message =
                    format!("`{name}` is differentiated {primes} times: two is the most polemark takes");
                self.error("lab.equation", place, message, Some(format!("did you mean `{name}''`?")));
            }
        }
        (self.findings.len() == before).then(|| Equation { text: text.value.clone(), left, right })
    }

    pub(super) fn expression_error(&mut self, code: &'static str, text: &Text, error: ExpressionError) {
        let place = self.locate(text, error.start, error.end);
        self.error(code, place, error.message, error.help);
    }
}

/// `did you mean `theta`?` of a name with primes: `theta''`, where it ends in something that moves.
fn with_primes(help: &str, primes: u8, moving: &[&str]) -> String {
    let (head, tail) = ("did you mean `", "`?");
    let Some((meant, rest)) = help.strip_prefix(head).and_then(|help| help.split_once(tail)) else {
        return help.to_owned();
    };
    let last = meant.rsplit('*').next().unwrap_or(meant);
    let primes = if moving.contains(&last) { usize::from(primes.min(2)) } else { 0 };
    format!("{head}{meant}{}{tail}{rest}", "'".repeat(primes))
}
