use super::parameters::reason;
use super::{Checker, span};
use crate::algebra::{Expression, parse_decimal, to_f64};
use crate::lab::file::Text;
use crate::model::{Exact, ParameterValues};

impl Checker<'_> {
    /// A decimal, or a formula of the parameters: `V/2`, `K/R`.
    pub(super) fn amount(&mut self, text: &Text) -> Option<f64> {
        if let Ok(value) = parse_decimal(text.value.trim()) {
            return Some(to_f64(&value));
        }
        let names: Vec<&str> = self.parameter_names.iter().map(String::as_str).collect();
        let read =
            Expression::parse(&text.value).and_then(|formula| formula.check_names(&names).map(|()| formula));
        let formula = match read {
            Ok(formula) => formula,
            // A mistyped number is told as one.
            Err(_) if names.is_empty() || !text.value.contains(|c: char| c.is_ascii_alphabetic()) => {
                return self.float(text);
            }
            Err(error) => {
                self.expression_error("lab.number", text, error);
                return None;
            }
        };
        self.letters_in_amounts.extend(formula.symbols().into_iter().map(|symbol| symbol.name));
        // Without values of the parameters the lab is wrong in any case.
        let values: &ParameterValues = self.parameter_values.as_ref()?;
        let lookup = |name: &str, primes: u8| values.get(name).filter(|_| primes == 0).cloned();
        match Exact::evaluate(&formula, &lookup) {
            Ok(value) => Some(value.to_f64()),
            Err(error) => {
                let message = format!("`{}` has no value: {}", text.value, reason(&error));
                self.error("lab.number", span(text), message, None);
                None
            }
        }
    }

    pub(super) fn amount_or(&mut self, text: Option<&Text>, default: f64) -> Option<f64> {
        text.map_or(Some(default), |text| self.amount(text))
    }

    /// One above zero; `what` names it.
    pub(super) fn positive_amount(&mut self, text: &Text, what: &str) -> Option<f64> {
        let value = self.amount(text)?;
        if value > 0.0 {
            return Some(value);
        }
        self.error("lab.number", span(text), format!("{what} must be above 0, not {}", text.value), None);
        None
    }

    /// Part of a period, 0 to 1.
    pub(super) fn duty(&mut self, text: &Text) -> Option<f64> {
        let value = self.amount(text)?;
        if (0.0..=1.0).contains(&value) {
            return Some(value);
        }
        let message = format!("a duty must be 0 to 1, not {}", text.value);
        self.error("lab.number", span(text), message, Some("0.01 is 1 %".to_owned()));
        None
    }
}
