use super::{Checker, span};
use crate::algebra::{Expression, ExpressionError, NodeKind, Rational, SymbolUse};
use crate::lab::file::{ComparisonFile, LabFile, ModelFile, OperatingPointFile, Text};
use crate::lab::{ModelDefinition, OperatingPointDefinition, Parameter, defaults};
use crate::model::{self, Comparison, Coordinate, Equation, Equilibrium, Exact, Model, ModelError};
use std::collections::BTreeMap;

impl Checker<'_> {
    pub(super) fn models(
        &mut self,
        file: &LabFile,
        parameters: Option<&[Parameter]>,
    ) -> Option<Vec<ModelDefinition>> {
        let letters: Vec<&str> = file.parameters.0.iter().map(|(name, _)| name.value.as_str()).collect();
        let models = file.models.0.iter().map(|(id, m)| {
            self.id(id, "model id");
            let model = self.model(m, &letters);
            let points = m.operating_points.value.0.iter().map(|(point, p)| {
                self.id(point, "operating point id");
                self.operating_point(point, p, m, model.as_ref().zip(parameters))
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
                operating_points: operating_points.into_iter().collect::<Option<_>>()?,
            })
        });
        let models: Vec<_> = models.collect();
        models.into_iter().collect()
    }

    fn model(&mut self, file: &ModelFile, letters: &[&str]) -> Option<Model> {
        let (coordinates, inputs) = (&file.coordinates.value.0, &file.inputs.value.0);
        let mut known: Vec<&str> = letters.to_vec();
        for (name, what) in coordinates
            .iter()
            .map(|(name, _)| (name, "coordinate"))
            .chain(inputs.iter().map(|(name, _)| (name, "input")))
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
        let equations = &file.equations.value;
        if equations.len() != coordinates.len() || equations.is_empty() {
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
        let equations: Vec<_> = equations.iter().map(|text| self.equation(text, &known, &moving)).collect();
        Some(Model {
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
            equations: equations.into_iter().collect::<Option<_>>()?,
        })
    }

    fn equation(&mut self, text: &Text, known: &[&str], moving: &[&str]) -> Option<Equation> {
        let (left, right) = match Expression::parse_equation(&text.value) {
            Ok(sides) => sides,
            Err(error) => {
                let error = at_function(&text.value, error);
                self.expression_error("lab.equation", text, error);
                return None;
            }
        };
        let before = self.findings.len();
        for symbol in left.symbols().into_iter().chain(right.symbols()) {
            let SymbolUse { name, primes, start, end } = symbol;
            let place = self.locate(text, start, end);
            let alone = Expression { kind: NodeKind::Symbol { name: name.clone(), primes }, start, end };
            if let Err(error) = alone.check_names(known) {
                self.expression_error("lab.equation", text, error);
            } else if primes > 0 && !moving.contains(&name.as_str()) {
                let message = format!("`{name}` is a parameter, so it has no derivative");
                self.error("lab.equation", place, message, Some(format!("write `{name}` without primes")));
            } else if primes > 2 {
                let message =
                    format!("`{name}` is differentiated {primes} times: two is the most polemark takes");
                self.error("lab.equation", place, message, None);
            }
        }
        (self.findings.len() == before).then(|| Equation { text: text.value.clone(), left, right })
    }

    fn expression_error(&mut self, code: &'static str, text: &Text, error: ExpressionError) {
        let place = self.locate(text, error.start, error.end);
        self.error(code, place, error.message, error.help);
    }

    fn operating_point(
        &mut self,
        id: &Text,
        file: &OperatingPointFile,
        model: &ModelFile,
        checked: Option<(&Model, &[Parameter])>,
    ) -> Option<OperatingPointDefinition> {
        let coordinates: Vec<&str> =
            model.coordinates.value.0.iter().map(|(n, _)| n.value.as_str()).collect();
        let inputs: Vec<&str> = model.inputs.value.0.iter().map(|(n, _)| n.value.as_str()).collect();
        let both: Vec<&str> = coordinates.iter().chain(&inputs).copied().collect();
        let still = Exact::Known { rational: Rational::ZERO, pi: Rational::ZERO };
        let mut values: BTreeMap<String, Exact> =
            both.iter().map(|name| ((*name).to_owned(), still.clone())).collect();
        let before = self.findings.len();
        for (name, text) in &file.at.0 {
            self.one_of(name, "coordinate or input", &both);
            if let Some(value) = self.rest(text) {
                values.insert(name.value.clone(), value);
            }
        }
        let input = self.one_of(&file.input, "input", &inputs);
        let output = self.one_of(&file.output, "coordinate", &coordinates);
        let before_comparison = self.findings.len();
        let comparison = file.comparison.as_ref().and_then(|comparison| self.comparison(comparison));
        let comparison_reads = self.findings.len() == before_comparison;
        let at = Equilibrium { values };
        if self.findings.len() == before
            && let Some((model, parameters)) = checked
        {
            self.balance(id, file, model, parameters, &at);
        }
        let unit = |entries: &[(Text, crate::lab::file::QuantityFile)], i: usize| entries[i].1.unit.clone();
        Some(OperatingPointDefinition {
            id: id.value.clone(),
            title: defaults::title(file.title.as_ref(), &id.value),
            at,
            at_text: file.at.0.iter().map(|(name, text)| (name.value.clone(), text.value.clone())).collect(),
            input: file.input.value.clone(),
            input_unit: unit(&model.inputs.value.0, input?),
            output: file.output.value.clone(),
            output_unit: unit(&model.coordinates.value.0, output?),
            comparison,
            span: span(id),
        })
        .filter(|_| comparison_reads)
    }

    /// A place of rest: exact when it is a rational number plus a rational multiple of pi.
    fn rest(&mut self, text: &Text) -> Option<Exact> {
        let expression = match Expression::parse(&text.value) {
            Ok(expression) => expression,
            Err(error) => {
                self.expression_error("lab.equilibrium", text, error);
                return None;
            }
        };
        if let Some(SymbolUse { name, start, end, .. }) = expression.symbols().first() {
            let place = self.locate(text, *start, *end);
            let message = format!("`{name}` cannot stand here: a place of rest is made of numbers and `pi`");
            self.error("lab.equilibrium", place, message, Some("write its value".to_owned()));
            return None;
        }
        if let Some((rational, pi)) = exact(&expression) {
            return Some(Exact::Known { rational, pi });
        }
        let value = expression.eval_f64(&|_: &str, _: u8| None).ok().filter(|value| value.is_finite());
        if value.is_none() {
            let message = format!("`{}` has no value", text.value);
            self.error("lab.equilibrium", span(text), message, None);
        }
        value.map(Exact::Approximate)
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
        parameters: &[Parameter],
        at: &Equilibrium,
    ) {
        let values = parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
        let Err(error) = model::linearize(model, &values, at, &file.input.value, &file.output.value) else {
            return;
        };
        let place = file.at.0.first().map_or(span(id), |(_, text)| span(text));
        let help = match &error {
            ModelError::NotAnEquilibrium { .. } => {
                Some("give the values of coordinates and inputs at which nothing moves".to_owned())
            }
            _ => None,
        };
        self.error("lab.equilibrium", place, error.to_string(), help);
    }
}

/// Where a bracket stands right after a name (`m*cso(theta)`), what is wrong with the name taken as a function.
fn at_function(text: &str, error: ExpressionError) -> ExpressionError {
    let (Some(before), Some("(")) =
        (text.get(..error.start), text.get(error.start..error.end).map(str::trim))
    else {
        return error;
    };
    let start = before.trim_end_matches(|c: char| c.is_alphanumeric() || c == '_').len();
    match Expression::parse(&text[start..]) {
        Err(own) if own.start == 0 && own.end == before.len() - start && own.help.is_some() => {
            ExpressionError { start, end: before.len(), ..own }
        }
        _ => error,
    }
}

/// (r, k) when the expression is r + k·π by sums and rational multiples alone.
fn exact(expression: &Expression) -> Option<(Rational, Rational)> {
    let none = Rational::ZERO;
    match &expression.kind {
        NodeKind::Number(value) => Some((value.clone(), none)),
        NodeKind::Pi => Some((none, Rational::ONE)),
        NodeKind::Negate(a) => exact(a).map(|(r, k)| (-r, -k)),
        NodeKind::Add(a, b) => exact(a).zip(exact(b)).map(|((r, k), (q, l))| (r + q, k + l)),
        NodeKind::Subtract(a, b) => exact(a).zip(exact(b)).map(|((r, k), (q, l))| (r - q, k - l)),
        NodeKind::Multiply(a, b) => match (exact(a)?, exact(b)?) {
            ((r, k), (q, l)) if l == none => Some((r * &q, k * q)),
            ((r, k), (q, l)) if k == none => Some((&r * q, r * l)),
            _ => None,
        },
        NodeKind::Divide(a, b) => match (exact(a)?, exact(b)?) {
            ((r, k), (q, l)) if l == none && q != none => Some((r / &q, k / q)),
            _ => None,
        },
        NodeKind::Symbol { .. } | NodeKind::Power(..) | NodeKind::Call(..) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::to_f64;

    #[test]
    fn places_of_rest_are_exact_where_they_can_be() {
        #[track_caller]
        fn check(text: &str, expected: Option<(f64, f64)>) {
            let expression = Expression::parse(text).unwrap();
            let found = exact(&expression).map(|(r, k)| (to_f64(&r), to_f64(&k)));
            assert_eq!(found, expected, "{text}");
        }
        check("0", Some((0.0, 0.0)));
        check("pi", Some((0.0, 1.0)));
        check("-pi/2 + 1.5", Some((1.5, -0.5)));
        check("3*pi/4", Some((0.0, 0.75)));
        check("2*(pi - 1)", Some((-2.0, 2.0)));
        check("pi*pi", None);
        check("sqrt(2)", None);
    }
}
