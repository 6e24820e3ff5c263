use super::{Checker, span};
use crate::algebra::{Rational, parse_decimal, to_f64};
use crate::lab::Points;
use crate::lab::file::{FollowThroughFile, Spanned, Text, ToleranceFile, TolerancesFile};
use crate::lab::names::suggestion;
use crate::lab::{FollowThroughRule, Tolerance};

/// Words a formula has a meaning for already; `s` is the variable of transfer functions.
const RESERVED: &[&str] = &[
    "s", "t", "pi", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "sqrt",
    "abs", "sign",
];

/// What the lab says where a criterion does not.
pub(super) struct Defaults {
    pub coefficients: Tolerance,
    pub values: Tolerance,
    pub plots: Tolerance,
    pub follow_through: FollowThroughRule,
}

impl Checker<'_> {
    /// An id: lower-case letters, digits, `_` and `-`, a letter first.
    pub(super) fn id(&mut self, text: &Text, what: &str) {
        if !is_id(&text.value) {
            let message = format!("the {what} `{}` is not well-formed", text.value);
            let help = "use lower-case letters, digits, `_` and `-`, a letter first".to_owned();
            self.error("lab.id", span(text), message, Some(help));
        }
    }

    /// Ids joined by dots.
    pub(super) fn path(&mut self, text: &Text, what: &str) {
        if !text.value.split('.').all(is_id) {
            let message = format!("the {what} `{}` is not well-formed", text.value);
            let help =
                "use lower-case letters, digits, `_` and `-`, a letter first; dots between parts".to_owned();
            self.error("lab.id", span(text), message, Some(help));
        }
    }

    /// A letter of the equations.
    pub(super) fn symbol(&mut self, text: &Text, what: &str) {
        let name = text.value.as_str();
        let mut chars = name.chars();
        let formed = chars.next().is_some_and(|c| c.is_ascii_alphabetic())
            && chars.all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !formed {
            let message = format!("the {what} name `{name}` is not well-formed");
            let help = "use letters, digits and `_`, a letter first".to_owned();
            self.error("lab.id", span(text), message, Some(help));
        } else if RESERVED.contains(&name) {
            let message = format!("the {what} name `{name}` has another meaning in formulas");
            self.error("lab.id", span(text), message, Some("choose another name".to_owned()));
        }
    }

    /// A decimal, exactly.
    pub(super) fn number(&mut self, text: &Text) -> Option<Rational> {
        match parse_decimal(text.value.trim()) {
            Ok(value) => Some(value),
            Err(error) => {
                let pointed = text.value.trim().replacen(',', ".", 1);
                let help = match parse_decimal(&pointed) {
                    Ok(_) if text.value.contains(',') => format!("write a point: `{pointed}`"),
                    _ => "write a decimal such as `0.2083` or `1e-3`".to_owned(),
                };
                self.error("lab.number", span(text), error.to_string(), Some(help));
                None
            }
        }
    }

    pub(super) fn float(&mut self, text: &Text) -> Option<f64> {
        self.number(text).map(|value| to_f64(&value))
    }

    /// A number above zero; `what` names it.
    pub(super) fn positive(&mut self, text: &Text, what: &str) -> Option<f64> {
        let value = self.float(text)?;
        if value > 0.0 {
            return Some(value);
        }
        self.error("lab.number", span(text), format!("{what} must be above 0, not {}", text.value), None);
        None
    }

    /// A number of 0..=1; `what` names it.
    pub(super) fn fraction(&mut self, text: &Text, what: &str) -> Option<Rational> {
        let value = self.number(text)?;
        if (Rational::ZERO..=Rational::ONE).contains(&value) {
            return Some(value);
        }
        let message = format!("{what} must be 0 to 1, not {}", text.value);
        self.error("lab.number", span(text), message, Some("0.01 is 1 %".to_owned()));
        None
    }

    /// A whole number of `least..=most`; `what` names it.
    pub(super) fn whole(&mut self, text: &Text, what: &str, least: usize, most: usize) -> Option<usize> {
        match text.value.trim().parse::<usize>() {
            Ok(value) if (least..=most).contains(&value) => Some(value),
            _ => {
                let message =
                    format!("{what} must be a whole number of {least} to {most}, not `{}`", text.value);
                self.error("lab.number", span(text), message, None);
                None
            }
        }
    }

    /// Points above zero, in hundredths at the finest.
    pub(super) fn points(&mut self, text: &Text) -> Option<Points> {
        let hundredths = self.number(text)? * Rational::from(100);
        let whole = hundredths.is_int().then(|| i64::try_from(hundredths.numerator()).ok()).flatten();
        match whole {
            Some(points) if (1..=100_000_000).contains(&points) => Some(Points(points)),
            _ => {
                let message = format!("`{}` cannot be points", text.value);
                let help = "points are above 0 and have at most two decimals".to_owned();
                self.error("lab.points", span(text), message, Some(help));
                None
            }
        }
    }

    /// `text` as one of `known`, by position; `what` names what it should be.
    pub(super) fn one_of(&mut self, text: &Text, what: &str, known: &[&str]) -> Option<usize> {
        let position = known.iter().position(|k| *k == text.value);
        if position.is_none() {
            let message = format!("there is no {what} `{}`", text.value);
            self.error("lab.unknown_name", span(text), message, Some(suggestion(&text.value, known)));
        }
        position
    }

    pub(super) fn defaults(&mut self, near: &TolerancesFile, follow: &FollowThroughFile) -> Defaults {
        let mut part = |text: &Option<Text>, what: &str| match text {
            Some(text) => self.fraction(text, what).unwrap_or(Rational::ONE),
            None => Rational::ONE,
        };
        let follow_through = FollowThroughRule {
            credit: part(&follow.credit, "`credit`"),
            same_mistake: part(&follow.same_mistake, "`same_mistake`"),
        };
        Defaults {
            coefficients: self.tolerance_or(near.coefficients.as_ref(), tolerance(0, 5, None)),
            values: self.tolerance_or(near.values.as_ref(), tolerance(1, 10, Some(2))),
            plots: self.tolerance_or(near.plots.as_ref(), tolerance(0, 20, None)),
            follow_through,
        }
    }

    /// The tolerance stated, or the default when there is none (or it is wrong, which has been reported).
    pub(super) fn tolerance_or(
        &mut self,
        file: Option<&Spanned<ToleranceFile>>,
        default: Tolerance,
    ) -> Tolerance {
        file.map_or(Some(default.clone()), |file| self.tolerance(file)).unwrap_or(default)
    }

    fn tolerance(&mut self, file: &Spanned<ToleranceFile>) -> Option<Tolerance> {
        let absolute = match &file.value.absolute {
            Some(text) => self.number(text).filter(|value| {
                let right = *value >= Rational::ZERO;
                if !right {
                    let message = format!("a tolerance cannot be negative: {}", text.value);
                    self.error("lab.tolerance", span(text), message, None);
                }
                right
            }),
            None => Some(Rational::ZERO),
        };
        let relative = match &file.value.relative {
            Some(text) => self.fraction(text, "a relative tolerance"),
            None => Some(Rational::ZERO),
        };
        let figures = match &file.value.figures {
            Some(text) => self.whole(text, "figures", 1, 15).map(|n| u32::try_from(n).ok()),
            None => Some(None),
        };
        Some(Tolerance { absolute: absolute?, of_scale: None, relative: relative?, figures: figures? })
    }
}

/// `absolute` and `relative` in thousandths, `absolute` of the scale as well.
fn tolerance(absolute: i64, relative: i64, figures: Option<u32>) -> Tolerance {
    let thousandths = |n: i64| Rational::from(n) / Rational::from(1000);
    Tolerance {
        absolute: thousandths(absolute),
        of_scale: (absolute > 0).then(|| thousandths(absolute)),
        relative: thousandths(relative),
        figures,
    }
}

fn is_id(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == '-')
        && text.len() <= 64
}
