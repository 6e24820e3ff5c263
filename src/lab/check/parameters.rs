use super::{Checker, span};
use crate::algebra::{Expression, Rational, from_f64, significant};
use crate::lab::Parameter;
use crate::lab::file::{LabFile, ParameterFile, Text};
use crate::lab::names::list;
use crate::model::{DerivedParameter, DerivedParameters, Exact, ModelError};
use crate::submission::AnswerSheet;
use std::collections::BTreeMap;

/// The parameters of a lab, and what follows from them.
pub(super) struct Parameters {
    pub list: Vec<Parameter>,
    pub derived: DerivedParameters,
}

/// Values, each with its text as typed.
type TypedValues = Vec<(String, Rational)>;

impl Checker<'_> {
    pub(super) fn parameters(&mut self, file: &LabFile) -> Option<Parameters> {
        let names: Vec<&str> = file.parameters.0.iter().map(|(name, _)| name.value.as_str()).collect();
        let (mut given, mut derived) = (BTreeMap::new(), Vec::new());
        let mut complete = true;
        for (name, p) in &file.parameters.0 {
            self.symbol(name, "parameter");
            match (&p.value, &p.formula) {
                (Some(value), None) => match self.value(name, value) {
                    Some(value) => {
                        given.insert(name.value.clone(), value);
                    }
                    None => complete = false,
                },
                (None, Some(text)) => match self.formula("lab.parameter", text, &names) {
                    Some(formula) => derived.push(DerivedParameter { name: name.value.clone(), formula }),
                    None => complete = false,
                },
                (value, _) => {
                    let message = match value {
                        Some(_) => format!("`{}` has both `value` and `formula`", name.value),
                        None => format!("`{}` has no `value`", name.value),
                    };
                    let help = "give `value`, or `formula` when it follows from other parameters".to_owned();
                    self.error("lab.parameter", span(name), message, Some(help));
                    complete = false;
                }
            }
        }
        let lists: Vec<_> = file
            .parameters
            .0
            .iter()
            .map(|(name, p)| self.other_values(name, p, given.get(&name.value)))
            .collect();
        if !complete {
            return None;
        }
        let worked_out = DerivedParameters::new(derived).and_then(|derived| {
            let values = derived.values(&given)?;
            Ok((derived, values))
        });
        let (derived, values) = match worked_out {
            Ok(both) => both,
            Err(error) => {
                self.parameter_error(file, &error);
                return None;
            }
        };
        let list = file.parameters.0.iter().zip(lists).map(|((name, p), others)| {
            let (accepted, mistaken) = others?;
            let value = values.get(&name.value)?;
            let formula = p.formula.as_ref().and_then(|text| {
                let own = derived.iter().find(|one| one.name == name.value)?;
                Some((text.value.trim().to_owned(), own.formula.clone()))
            });
            let text = match (&p.value, &formula) {
                (Some(text), _) => self.values.get(&name.value).unwrap_or(&text.value).clone(),
                (None, Some((formula, _))) => shown(formula, value),
                (None, None) => String::new(),
            };
            Some(Parameter {
                name: name.value.clone(),
                value: value.as_rational().cloned().or_else(|| from_f64(value.to_f64()))?,
                text,
                formula,
                unit: p.unit.clone(),
                description: p.description.trim().to_owned(),
                accepted,
                mistaken,
            })
        });
        let list = list.collect::<Vec<_>>().into_iter().collect::<Option<_>>()?;
        self.parameter_values = Some(values);
        Some(Parameters { list, derived })
    }

    /// A formula of `names`; errors carry the place within it.
    pub(super) fn formula(&mut self, code: &'static str, text: &Text, names: &[&str]) -> Option<Expression> {
        let read =
            Expression::parse(&text.value).and_then(|formula| formula.check_names(names).map(|()| formula));
        let formula = match read {
            Ok(formula) => formula,
            Err(error) => {
                self.expression_error(code, text, error);
                return None;
            }
        };
        match formula.symbols().into_iter().find(|symbol| symbol.primes > 0) {
            Some(symbol) => {
                let place = self.locate(text, symbol.start, symbol.end);
                let message = format!("`{}` is a parameter, so it has no derivative", symbol.name);
                self.error(code, place, message, Some(format!("write `{}` without primes", symbol.name)));
                None
            }
            None => Some(formula),
        }
    }

    /// Other spellings of parameters, each of which means one of them only.
    pub(super) fn also(&mut self, file: &LabFile) -> BTreeMap<String, String> {
        let mut also = BTreeMap::new();
        for (name, p) in &file.parameters.0 {
            for spelling in &p.also {
                let known = file.parameters.0.iter().any(|(other, _)| other.value == spelling.value);
                if known || also.contains_key(&spelling.value) {
                    let message = format!("`{}` already means another letter", spelling.value);
                    let help = "give spellings that no other parameter has".to_owned();
                    self.error("lab.duplicate", span(spelling), message, Some(help));
                } else {
                    self.symbol(spelling, "spelling");
                    also.insert(spelling.value.clone(), name.value.clone());
                }
            }
        }
        also
    }

    /// No spelling of a parameter may be the letter of a value at rest, with or without `_`: nobody could tell which is meant.
    pub(super) fn spellings_at_rest(&mut self, file: &LabFile, sheet: &AnswerSheet) {
        let plain = |name: &str| name.replace('_', "");
        let at_rest: Vec<&String> = sheet.letters.values().flat_map(|own| own.also.values()).collect();
        for (name, p) in &file.parameters.0 {
            for spelling in &p.also {
                if let Some(letter) = at_rest.iter().find(|letter| plain(letter) == plain(&spelling.value)) {
                    let message = format!(
                        "`{}` would mean both `{}` and the value at rest `{letter}`",
                        spelling.value, name.value
                    );
                    let help = "give the parameter another spelling".to_owned();
                    self.error("lab.duplicate", span(spelling), message, Some(help));
                }
            }
        }
    }

    /// What is accepted, and what is mistaken, besides its `value`.
    fn other_values(
        &mut self,
        name: &Text,
        p: &ParameterFile,
        value: Option<&Rational>,
    ) -> Option<(TypedValues, TypedValues)> {
        if p.formula.is_some()
            && let Some(text) = p.accepted.first().or(p.mistaken.first())
        {
            let message = format!("`{}` follows from a formula, so it has no values of its own", name.value);
            let help = "give them to the parameters in its formula".to_owned();
            self.error("lab.parameter", span(text), message, Some(help));
            return None;
        }
        let accepted = p.accepted.iter().map(|text| {
            let other = self.number(text)?;
            if Some(&other) == value {
                let message = format!("`{}` accepts its own value `{}` again", name.value, text.value);
                self.error("lab.accepted", span(text), message, Some("list only the other values".into()));
            }
            Some((text.value.clone(), other))
        });
        let accepted: Vec<_> = accepted.collect();
        let mistaken = p.mistaken.iter().map(|text| {
            let other = self.number(text)?;
            let right = Some(&other) == value || accepted.iter().flatten().any(|(_, value)| *value == other);
            if right {
                let message = format!("`{}` lists `{}` as mistaken, but it is right", name.value, text.value);
                let help = "list only values that are wrong".to_owned();
                self.error("lab.mistakes", span(text), message, Some(help));
            }
            Some((text.value.clone(), other))
        });
        let mistaken: Vec<_> = mistaken.collect();
        Some((accepted.into_iter().collect::<Option<_>>()?, mistaken.into_iter().collect::<Option<_>>()?))
    }

    fn parameter_error(&mut self, file: &LabFile, error: &ModelError) {
        let formula = |name: &String| {
            let found = file.parameters.0.iter().find(|(known, _)| known.value == *name);
            found.and_then(|(_, p)| p.formula.as_ref())
        };
        match error {
            ModelError::Circle { names } => {
                let first = names.iter().find_map(formula);
                let mut once: Vec<&str> = names.iter().map(String::as_str).collect();
                once.pop();
                let help = format!("give one of {} a `value`", list(&once));
                let place = first.map_or_else(|| span(&file.lab), span);
                self.error("lab.parameter", place, error.to_string(), Some(help));
            }
            ModelError::Parameter { name, error } => {
                let place = formula(name).map_or_else(|| span(&file.lab), span);
                let message = format!("`{name}` has no value: {}", reason(error));
                self.error("lab.parameter", place, message, None);
            }
            other => self.error("lab.parameter", span(&file.lab), other.to_string(), None),
        }
    }
}

/// Why a formula has no value, in few words.
pub(super) fn reason(error: &ModelError) -> String {
    match error {
        ModelError::Undefined { function } if function == "division by zero" => {
            "it divides by zero".to_owned()
        }
        ModelError::Undefined { function } => {
            format!("`{function}` is not defined there, or too large a number")
        }
        other => other.to_string(),
    }
}

/// `k^2/(R*b) = 1.25`, or ≈ where not every digit can be shown.
fn shown(formula: &str, value: &Exact) -> String {
    let text = significant(value.to_f64(), 6);
    let whole = crate::algebra::parse_decimal(&text).ok();
    let sign = if whole.is_some() && whole.as_ref() == value.as_rational() { "=" } else { "≈" };
    format!("{formula} {sign} {text}")
}
