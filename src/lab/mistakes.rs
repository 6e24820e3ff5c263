use super::{ModelDefinition, OperatingPointDefinition, Parameter};
use crate::model::{Derivation, Mistake, MistakeKind, Model};
use crate::source::Span;
use std::collections::BTreeMap;

/// What is looked for in a wrong transfer function, and what the author knows of it.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct MistakesRule {
    /// By code, where the lab differs from the defaults.
    pub weights: BTreeMap<String, u32>,
    /// Mistakes that change no transfer function, declared.
    pub without_effect: Vec<WithoutEffect>,
}

/// A mistake that makes no difference, or all of those within a term.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WithoutEffect {
    /// `equation 1: b*x'`, or a change: `equation 1: b*x' -> 0`.
    pub text: String,
    pub span: Span,
}

/// What goes wrong after the derivation, each with its weight.
const AFTERWARDS: [(&str, u32); 3] = [("slip.digit", 12), ("slip.exchanged", 10), ("rounding.coarse", 20)];

/// The codes of all mistakes that are looked for.
pub fn mistake_codes() -> Vec<&'static str> {
    let kinds = MistakeKind::ALL.into_iter().map(MistakeKind::code);
    kinds.chain(AFTERWARDS.into_iter().map(|(code, _)| code)).collect()
}

impl MistakesRule {
    /// How likely the mistake of that code is beside the others; 0 when it is not looked for.
    pub fn weight(&self, code: &str) -> u32 {
        let default = || {
            let kind = MistakeKind::ALL.into_iter().find(|kind| kind.code() == code).map(MistakeKind::weight);
            kind.or_else(|| {
                AFTERWARDS.into_iter().find(|(known, _)| *known == code).map(|(_, weight)| weight)
            })
        };
        self.weights.get(code).copied().or_else(default).unwrap_or(0)
    }
}

impl WithoutEffect {
    /// Whether it is that mistake, or the term it is made in.
    pub fn covers(&self, mistake: &Mistake, model: &Model) -> bool {
        if self.text == mistake.change {
            return true;
        }
        let Some((equation, term)) = self.term(model) else { return false };
        let text = &model.equations[equation].text;
        let within = |start: usize, end: usize| {
            text.match_indices(term).any(|(at, _)| at <= start && end <= at + term.len())
        };
        !mistake.places.is_empty()
            && mistake.places.iter().all(|place| place.equation == equation && within(place.start, place.end))
    }

    /// The equation, counted from 0, and a part of it.
    fn term(&self, model: &Model) -> Option<(usize, &str)> {
        let (number, term) = self.text.strip_prefix("equation ")?.split_once(':')?;
        let index = number.trim().parse::<usize>().ok()?.checked_sub(1)?;
        let term = term.trim();
        (!term.is_empty() && model.equations.get(index)?.text.contains(term)).then_some((index, term))
    }
}

impl ModelDefinition {
    /// How the transfer function at `point` is derived, with the lab's own parameter values.
    pub fn derivation(&self, point: &OperatingPointDefinition, parameters: &[Parameter]) -> Derivation {
        let others = self.operating_points.iter().filter(|other| other.id != point.id);
        Derivation {
            model: self.model.clone(),
            parameters: parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect(),
            units: parameters.iter().map(|p| (p.name.clone(), p.unit.clone())).collect(),
            mistaken: parameters.iter().map(|p| (p.name.clone(), p.mistaken.clone())).collect(),
            rest: point.rest.clone(),
            others: others.map(|other| (other.title.clone(), other.rest.clone())).collect(),
            input: point.input.clone(),
            input_unit: point.input_unit.clone(),
            output: point.output.clone(),
            output_unit: point.output_unit.clone(),
        }
    }
}
