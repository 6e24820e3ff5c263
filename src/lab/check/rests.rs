use super::scalars::Defaults;
use super::{Checker, Names};
use crate::algebra::Rational;
use crate::lab::file::{CriterionFile, QuestionFile, Text};
use crate::lab::{AskedRest, Check, Tolerance};
use crate::submission::Unit;

impl Checker<'_> {
    /// What is asked of a value at rest.
    ///
    /// The lab's `absolute` is the width of a zero here: beside a small current or flow at rest it would take anything as right.
    pub(super) fn rest_check(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        unit: Option<&Text>,
        names: &Names<'_>,
        defaults: &Defaults,
    ) -> Option<Check> {
        let tolerance_of_zero = self.tolerance_or(file.tolerance.as_ref(), defaults.values.clone());
        let tolerance = match &file.tolerance {
            Some(_) => tolerance_of_zero.clone(),
            None => Tolerance { absolute: Rational::ZERO, ..tolerance_of_zero.clone() },
        };
        let text = self.required(file.value.as_ref(), file, "value");
        let of = self.system(file, question, names)?;
        let signals = names.signals_of(&of);
        let known: Vec<&str> = signals.iter().map(|(name, _)| name.as_str()).collect();
        let text = text?;
        let (signal, symbol) = &signals[self.one_of(text, "coordinate, output or input", &known)?];
        let native = match symbol.as_str() {
            "" => None,
            "1" => Some(Unit::one()),
            symbol => Some(Unit::parse(symbol).unwrap_or_else(|| Unit::named(symbol))),
        };
        let unit = match unit {
            Some(unit) => Some(self.asked_unit(unit, signal, native.as_ref())?),
            None => native.clone(),
        };
        let asked = AskedRest { signal: signal.clone(), unit, native };
        Some(Check::Rest { of, asked, tolerance, tolerance_of_zero })
    }
}
