use super::{Checker, span};
use crate::lab::file::MistakesFile;
use crate::lab::{MistakesRule, ModelDefinition, Parameter, WithoutEffect, mistake_codes};
use std::collections::BTreeMap;

/// Weights are products of two in `u64`, and a thousand times as likely is likely enough.
const MOST: usize = 1000;

impl Checker<'_> {
    pub(super) fn mistakes(
        &mut self,
        file: &MistakesFile,
        models: Option<&[ModelDefinition]>,
        parameters: Option<&[Parameter]>,
    ) -> Option<MistakesRule> {
        let before = self.findings.len();
        let codes = mistake_codes();
        let mut weights = BTreeMap::new();
        for (code, weight) in &file.weights.0 {
            let known = self.one_of(code, "mistake with the code", &codes);
            let value = self.whole(weight, "a weight", 0, MOST).and_then(|weight| u32::try_from(weight).ok());
            if let Some((place, value)) = known.zip(value)
                && let Some(code) = codes.get(place)
                && weights.insert((*code).to_owned(), value).is_some()
            {
                let message = format!("the weight of `{code}` is given twice");
                self.error("lab.duplicate", span(&file.weights.0[0].0), message, None);
            }
        }
        let entries = file
            .without_effect
            .iter()
            .map(|text| WithoutEffect { text: text.value.trim().to_owned(), span: span(text) });
        let without_effect: Vec<WithoutEffect> = entries.collect();
        if let (Some(models), Some(parameters)) = (models, parameters) {
            for entry in &without_effect {
                let somewhere = models.iter().any(|model| {
                    model.operating_points.iter().any(|point| {
                        let mistakes = model.derivation(point, parameters).mistakes();
                        mistakes.iter().any(|mistake| entry.covers(mistake, &model.model))
                    })
                });
                if !somewhere {
                    let message = format!("`{}` is no mistake that can be made here", entry.text);
                    let help = "name a term as its equation prints it, `equation 1: b*x'`, or a change as `verify` lists it";
                    self.error("lab.mistakes", entry.span, message, Some(help.to_owned()));
                }
            }
        }
        (self.findings.len() == before).then_some(MistakesRule { weights, without_effect })
    }
}
