use super::scalars::Defaults;
use super::{Checker, Names, span};
use crate::algebra::Rational;
use crate::lab::file::{CriterionFile, OperatingPointFile, QuestionFile};
use crate::lab::{Check, LineForm};
use crate::model::{Equilibrium, Model, TangentRule};

/// What a tangent may be off by where the lab does not say.
const DEPARTURE: f64 = 0.1;

impl Checker<'_> {
    pub(super) fn tangent_check(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        names: &Names<'_>,
        defaults: &Defaults,
    ) -> Option<Check> {
        let tolerance = self.tolerance_or(file.tolerance.as_ref(), defaults.coefficients.clone());
        let form = match &file.form {
            Some(text) => {
                let forms = [LineForm::Line, LineForm::Deviations];
                forms.get(self.one_of(text, "form", &["line", "deviations"])?).copied()
            }
            None => Some(LineForm::Line),
        };
        let other_form = match &file.other_form {
            Some(text) => self.fraction(text, "`other_form`"),
            None => Some(Rational::ONE / Rational::from(2)),
        };
        let of = self.system(file, question, names)?;
        let is_static = |(path, why): &(String, super::Unresponsive)| {
            *path == of.to_string() && *why == super::Unresponsive::Static
        };
        if !names.unresponsive.iter().any(is_static) {
            let message = format!("`{of}` is no static function, so it has no tangent");
            self.error("lab.criterion", span(&file.check), message, None);
            return None;
        }
        Some(Check::Tangent { of, tolerance, form: form?, other_form: other_form? })
    }

    /// How a static function is shown beside its tangent: as the lab says, or around the operating point.
    pub(super) fn tangent(
        &mut self,
        file: &OperatingPointFile,
        model: &Model,
        at: &Equilibrium,
    ) -> Option<Option<TangentRule>> {
        if !model.is_static() {
            if let Some(tangent) = &file.tangent {
                let message = "`tangent` is for a system without derivatives, and this one has some";
                self.error("lab.model", span(&tangent.from), message, Some("remove it".to_owned()));
                return None;
            }
            return Some(None);
        }
        if let Some(comparison) = &file.comparison {
            let message = "without derivatives nothing moves after an impulse: there is nothing to compare";
            let help = "remove `comparison`; `tangent: {from, to, departure}` shows how far the linear model is good";
            self.error("lab.model", span(&comparison.horizon_s), message, Some(help.to_owned()));
            return None;
        }
        let x0 = at.value(&file.input.value, 0).map_or(0.0, |value| value.to_f64());
        let Some(tangent) = &file.tangent else {
            let half = (x0.abs() / 2.0).max(if x0 == 0.0 { 1.0 } else { 0.0 });
            return Some(Some(TangentRule { from: x0 - half, to: x0 + half, departure: DEPARTURE }));
        };
        let (from, to) = (self.float(&tangent.from), self.float(&tangent.to));
        let departure = match &tangent.departure {
            Some(text) => self.positive(text, "a departure"),
            None => Some(DEPARTURE),
        };
        let (from, to) = (from?, to?);
        if !(from < x0 && x0 < to) {
            let message =
                format!("the operating point, `{}` = {x0}, does not lie between these", file.input.value);
            let help = "let `from` be below it and `to` above".to_owned();
            self.error("lab.number", span(&tangent.from), message, Some(help));
            return None;
        }
        Some(Some(TangentRule { from, to, departure: departure? }))
    }
}
