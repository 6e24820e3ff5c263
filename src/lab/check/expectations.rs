use super::{Checker, Names, span};
use crate::algebra::{Rational, parse_decimal, to_f64};
use crate::lab::file::{Entries, ExpectFile, Text};
use crate::lab::names::suggestion;
use crate::lab::{Expectation, ExpectedValue};

const OF_A_LINEAR_MODEL: &[&str] = &[
    "transfer_function.num",
    "transfer_function.den",
    "poles",
    "zeros",
    "stability",
    "internal_poles",
    "internal_stability",
];

const OF_A_RESPONSE: &[&str] = &[
    "initial_value",
    "final_value",
    "shape",
    "peak_value",
    "peak_time_s",
    "period_s",
    "damping_ratio",
    "natural_frequency_rad_s",
    "slowest_time_constant_s",
    "settling_time_2_percent_s",
    "settling_time_5_percent_s",
    "damped_frequency_rad_s",
    "overshoot_percent",
    "rise_time_10_90_s",
    "rise_time_0_100_s",
    "dc_gain",
    "horizon_s",
];

const OF_A_COMPARISON: &[&str] = &["end_linear", "end_nonlinear", "parting_push", "parting_amplitude"];

const OF_A_TANGENT: &[&str] = &["slope", "good_from", "good_to"];

const OF_A_SIMULATION: &[&str] =
    &["peak_with", "peak_without", "switch_times", "end_with", "end_without", "end_time_s"];

/// Agreement demanded when none is stated.
const RELATIVE: f64 = 1e-9;

impl Checker<'_> {
    pub(super) fn expectations(
        &mut self,
        file: &Entries<ExpectFile>,
        names: &Names<'_>,
    ) -> Option<Vec<Expectation>> {
        let expectations = file.0.iter().map(|(path, expect)| {
            self.expected_path(path, names);
            let typed: Vec<&Text> = match (&expect.value, &expect.values) {
                (Some(value), None) => vec![value],
                (None, Some(values)) => values.value.iter().collect(),
                _ => {
                    let message = format!("`{}` needs either `value` or `values`", path.value);
                    self.error("lab.expectation", span(path), message, None);
                    return None;
                }
            };
            let values: Vec<_> = typed.into_iter().map(|text| self.expected_value(text)).collect();
            let relative = match &expect.relative {
                Some(text) => self.fraction(text, "a relative agreement").map(|r| to_f64(&r)),
                None => Some(RELATIVE),
            };
            Some(Expectation {
                path: path.value.clone(),
                values: values.into_iter().collect::<Option<_>>()?,
                relative: relative?,
                span: span(path),
            })
        });
        let expectations: Vec<_> = expectations.collect();
        expectations.into_iter().collect()
    }

    fn expected_path(&mut self, path: &Text, names: &Names<'_>) {
        let text = path.value.as_str();
        let subjects: Vec<&str> =
            names.systems.iter().map(String::as_str).chain(names.simulations.iter().copied()).collect();
        let rest = subjects.iter().find_map(|s| Some((*s, text.strip_prefix(s)?.strip_prefix('.')?)));
        let Some((subject, rest)) = rest else {
            let message = format!("`{text}` begins with no operating point or simulation of this lab");
            let head = text.splitn(3, '.').take(2).collect::<Vec<_>>().join(".");
            self.error("lab.expectation", span(path), message, Some(suggestion(&head, &subjects)));
            return;
        };
        let known: Vec<String> = if names.simulations.contains(&subject) {
            OF_A_SIMULATION.iter().map(|&s| s.to_owned()).collect()
        } else {
            let comparison = OF_A_COMPARISON.iter().map(|s| format!("comparison.{s}"));
            let tangent = OF_A_TANGENT.iter().map(|s| format!("tangent.{s}"));
            let at_rest = ["equilibrium".to_owned()].into_iter().chain(at_rest(subject, names));
            linear().chain(comparison).chain(tangent).chain(at_rest).collect()
        };
        let (end, known) = match alternative(rest) {
            Some(end) if !names.simulations.contains(&subject) => {
                (end, linear().chain(at_rest(subject, names)).collect())
            }
            _ => (rest, known),
        };
        if !known.iter().any(|k| k == end) {
            let message = format!("`{subject}` has no `{rest}` in the reference");
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            self.error("lab.expectation", span(path), message, Some(suggestion(end, &known)));
        }
    }

    /// A number, a complex number with `j` at its end, or a word.
    fn expected_value(&mut self, text: &Text) -> Option<ExpectedValue> {
        let value = text.value.trim();
        if let Ok(number) = parse_decimal(value) {
            return Some(ExpectedValue::Number(to_f64(&number)));
        }
        if let Some((re, im)) = complex(value) {
            return Some(ExpectedValue::Complex(to_f64(&re), to_f64(&im)));
        }
        if !value.is_empty() && value.chars().all(|c| c.is_ascii_lowercase() || c == '_') {
            return Some(ExpectedValue::Word(value.to_owned()));
        }
        let message = format!("`{value}` is no number, complex number or word");
        let help = "write `0.25`, `-0.25 + 5.5j` or `unstable`".to_owned();
        self.error("lab.expectation", span(text), message, Some(help));
        None
    }
}

/// Each value at rest by itself: `equilibrium.u`.
fn at_rest(system: &str, names: &Names<'_>) -> Vec<String> {
    let signals = names.system(system).map(|of| names.signals_of(&of)).unwrap_or_default();
    signals.iter().map(|(name, _)| format!("equilibrium.{name}")).collect()
}

fn linear() -> impl Iterator<Item = String> {
    let responses = ["impulse", "step"].into_iter();
    let features = responses.flat_map(|kind| OF_A_RESPONSE.iter().map(move |f| format!("{kind}.{f}")));
    OF_A_LINEAR_MODEL.iter().map(|&s| s.to_owned()).chain(features)
}

/// What follows `accepted[i].`.
fn alternative(rest: &str) -> Option<&str> {
    let (index, end) = rest.strip_prefix("accepted[")?.split_once("].")?;
    index.parse::<usize>().ok().map(|_| end)
}

/// `a + bj`.
fn complex(text: &str) -> Option<(Rational, Rational)> {
    let compact: String = text.strip_suffix('j')?.split_whitespace().collect();
    let sign =
        |(i, c): &(usize, char)| *i > 0 && matches!(c, '+' | '-') && !compact[..*i].ends_with(['e', 'E']);
    let split = compact.char_indices().rev().find(sign).map(|(i, _)| i);
    let (re, im) = compact.split_at(split.unwrap_or(0));
    let re = if re.is_empty() { Rational::ZERO } else { parse_decimal(re).ok()? };
    Some((re, parse_decimal(im.strip_prefix('+').unwrap_or(im)).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complex_numbers_are_read() {
        #[track_caller]
        fn check(text: &str, expected: Option<(f64, f64)>) {
            assert_eq!(complex(text).map(|(re, im)| (to_f64(&re), to_f64(&im))), expected, "{text}");
        }
        check("-0.25 + 5.5j", Some((-0.25, 5.5)));
        check("1e-3-2e-1j", Some((0.001, -0.2)));
        check("2j", Some((0.0, 2.0)));
        check("-2j", Some((0.0, -2.0)));
        check("1 + 2", None);
        check("j", None);
        check("a + 2j", None);
    }
}
