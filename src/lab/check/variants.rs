use super::{Checker, span};
use crate::algebra::{Rational, parse_decimal};
use crate::lab::file::{LabFile, ParameterFile, RangeFile, Text, VariesFile};
use crate::lab::{MOST_VARIANTS, VariantRule, VariedParameter};
use crate::source::Span;

/// A parameter may have this many values.
const MOST_VALUES: usize = 1000;
const MOST_SEED_BYTES: usize = 200;

impl Checker<'_> {
    /// What a parameter is worth here: its own value, or the one given in place of it.
    pub(super) fn value(&mut self, name: &Text, own: &Text) -> Option<Rational> {
        let own = self.number(own);
        match self.values.get(&name.value) {
            None => own,
            Some(text) => parse_decimal(text).ok(),
        }
    }

    /// The outer `None`: something is wrong, and has been said.
    pub(super) fn variants(&mut self, file: &LabFile) -> Option<Option<VariantRule>> {
        let before = self.findings.len();
        let parameters: Vec<VariedParameter> =
            file.parameters.0.iter().filter_map(|(name, p)| self.varied(name, p)).collect();
        let seed = self.seed(file);
        let varied = file.parameters.0.iter().any(|(_, p)| p.varies.is_some());
        if let Some(variants) = &file.variants
            && !varied
        {
            let help = "give a parameter `varies: [0.4, 0.5, 0.6]`, or leave out `variants`".to_owned();
            self.error("lab.variants", span(variants), "no parameter varies", Some(help));
        }
        let rule = VariantRule { seed, parameters };
        if rule.count() > MOST_VARIANTS {
            self.too_many(&rule);
        }
        (self.findings.len() == before).then_some(varied.then_some(rule))
    }

    fn seed(&mut self, file: &LabFile) -> String {
        let Some(seed) = file.variants.as_ref().and_then(|variants| variants.value.seed.as_ref()) else {
            return file.lab.value.clone();
        };
        let text = seed.value.trim();
        if text.is_empty() || text.len() > MOST_SEED_BYTES || text.chars().any(char::is_control) {
            let message = format!("a seed is one line of text, at most {MOST_SEED_BYTES} bytes");
            self.error("lab.variants", span(seed), message, Some("write `seed: spring 2027`".to_owned()));
        }
        text.to_owned()
    }

    fn varied(&mut self, name: &Text, file: &ParameterFile) -> Option<VariedParameter> {
        let varies = file.varies.as_ref()?;
        let place = span(varies);
        let values = match &varies.value {
            VariesFile::List(list) => self.listed(list)?,
            VariesFile::Range(range) => self.stepped(place, range)?,
        };
        if file.formula.is_some() {
            let message = format!("`{}` follows from a formula, so it cannot vary by itself", name.value);
            let help = "vary the parameters in its formula".to_owned();
            self.error("lab.variants", place, message, Some(help));
        }
        let name = name.value.clone();
        if values.len() < 2 || values.len() > MOST_VALUES {
            let message = match values.len() {
                0 | 1 => format!("`{name}` varies, but has fewer than two values to choose from"),
                many => format!("`{name}` has {many} values to choose from, more than {MOST_VALUES}"),
            };
            self.error("lab.variants", place, message, None);
        }
        if let Some(accepted) = file.accepted.first() {
            let message = format!("`{name}` varies, so it cannot have other accepted values");
            let help =
                "everyone's own value is right for them, and no other; leave out `accepted`".to_owned();
            self.error("lab.variants", span(accepted), message, Some(help));
        }
        for text in &file.mistaken {
            let right =
                parse_decimal(text.value.trim()).is_ok_and(|wrong| values.iter().any(|(_, v)| *v == wrong));
            if right {
                let message =
                    format!("`{name}` lists `{}` as mistaken, but some students have it", text.value);
                let help = "list only values that are wrong for everyone".to_owned();
                self.error("lab.variants", span(text), message, Some(help));
            }
        }
        Some(VariedParameter { name, values, span: place })
    }

    fn listed(&mut self, list: &[Text]) -> Option<Vec<(String, Rational)>> {
        let mut values: Vec<(String, Rational)> = Vec::new();
        for text in list {
            let value = self.number(text)?;
            if values.iter().any(|(_, known)| *known == value) {
                let message = format!("`{}` is listed twice", text.value);
                self.error("lab.variants", span(text), message, Some("list each value once".to_owned()));
            }
            values.push((text.value.trim().to_owned(), value));
        }
        Some(values)
    }

    fn stepped(&mut self, place: Span, range: &RangeFile) -> Option<Vec<(String, Rational)>> {
        let RangeFile { from, to, step } = range;
        let (first, last, by) = (self.number(from), self.number(to), self.number(step));
        let (first, last, by) = (first?, last?, by?);
        if by <= Rational::ZERO || last <= first {
            let message = "the values must rise: `to` above `from`, `step` above 0";
            self.error("lab.variants", place, message, None);
            return None;
        }
        let steps = (&last - &first) / &by;
        if !steps.denominator().is_one() {
            let message = format!("steps of {} from {} do not lead to {}", step.value, from.value, to.value);
            let help = "change `to` or `step`, or list the values".to_owned();
            self.error("lab.variants", place, message, Some(help));
            return None;
        }
        let steps = usize::try_from(steps.numerator()).unwrap_or(usize::MAX);
        if steps >= MOST_VALUES {
            let message =
                format!("there are more than {MOST_VALUES} steps from {} to {}", from.value, to.value);
            self.error("lab.variants", place, message, Some("take larger steps".to_owned()));
            return None;
        }
        let value = |number: usize| &first + &by * Rational::from(number as u64);
        Some((0..=steps).map(value).map(|value| (decimal(&value), value)).collect())
    }

    fn too_many(&mut self, rule: &VariantRule) {
        let sizes: Vec<String> =
            rule.parameters.iter().map(|one| format!("{} of `{}`", one.values.len(), one.name)).collect();
        let message = format!(
            "{} make {} variants, more than the {MOST_VARIANTS} that can be proven",
            crate::english::listed(&sizes, "and"),
            rule.count()
        );
        let help = "take fewer values each: a class needs no more variants than it has students".to_owned();
        if let Some(last) = rule.parameters.last() {
            self.error("lab.variants", last.span, message, Some(help));
        }
    }
}

/// A finite decimal written out: 3/20 is `0.15`.
fn decimal(value: &Rational) -> String {
    let ten = Rational::from(10);
    let mut places = 0;
    let mut whole = value.clone();
    // The sum of decimals is one; the bound is theirs.
    while !whole.denominator().is_one() && places < 1000 {
        whole *= &ten;
        places += 1;
    }
    let (sign, digits) = if whole < Rational::ZERO {
        ("-", (-whole).numerator().to_string())
    } else {
        ("", whole.numerator().to_string())
    };
    if places == 0 {
        return format!("{sign}{digits}");
    }
    let padded = format!("{digits:0>width$}", width = places + 1);
    let (before, after) = padded.split_at(padded.len() - places);
    format!("{sign}{before}.{after}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::{LabDefinition, LabErrors};
    use crate::source::SourceText;

    #[test]
    fn decimals_are_written_out() {
        for (text, want) in
            [("0.15", "0.15"), ("-2.50", "-2.5"), ("3e2", "300"), ("1e-3", "0.001"), ("0", "0")]
        {
            assert_eq!(decimal(&parse_decimal(text).unwrap()), want, "{text}");
        }
    }

    fn embedded() -> &'static str {
        crate::lab::embedded()[0].1
    }

    /// The embedded lab with one line more below `M`, and seeds and such at the top.
    fn varied(top: &str, old: &str, new: &str) -> Result<LabDefinition, LabErrors> {
        assert!(embedded().contains(old), "{old}");
        let text = embedded().replacen(old, new, 1).replacen("parameters:", &format!("{top}parameters:"), 1);
        LabDefinition::parse(SourceText::new("lab.yaml", text))
    }

    const B: &str = "b: {value: 0.1,";

    #[test]
    fn values_are_listed_or_stepped() {
        for (varies, values) in [
            ("[0.1, 0.20, 3e-1]", &["0.1", "0.20", "3e-1"] as &[&str]),
            ("{from: 0.1, to: 0.3, step: 0.05}", &["0.1", "0.15", "0.2", "0.25", "0.3"]),
        ] {
            let lab = varied("", B, &format!("b: {{varies: {varies}, value: 0.1,")).unwrap();
            let rule = lab.variants.as_ref().unwrap();
            let found: Vec<&str> = rule.parameters[0].values.iter().map(|(text, _)| text.as_str()).collect();
            assert_eq!((rule.seed.as_str(), found.as_slice()), ("ee361-lab3", values));
            let last = lab.with_variant(&rule.all().last().unwrap()).unwrap();
            let b = last.parameters.iter().find(|one| one.name == "b").unwrap();
            assert_eq!((b.text.as_str(), &b.value), (values[values.len() - 1], &last.sheet.symbols["b"]));
        }
        let lab = varied("variants: {seed: spring 2027}\n", B, "b: {varies: [1, 2], value: 0.1,").unwrap();
        assert_eq!(lab.variants.unwrap().seed, "spring 2027");
    }

    #[test]
    fn what_cannot_be_varied_is_said_at_its_place() {
        #[track_caller]
        fn check(top: &str, new: &str, place: &str, message: &str) {
            let errors = varied(top, B, new).unwrap_err();
            let found: Vec<_> = errors
                .findings
                .iter()
                .map(|one| (one.span.map(|s| &errors.source.text[s.start..s.end]), one.message.as_str()))
                .collect();
            assert_eq!(found, [(Some(place), message)], "{new}");
        }
        check("variants: {seed: a}\n", B, "{", "no parameter varies");
        check(
            "",
            "b: {varies: [1], value: 0.1,",
            "[",
            "`b` varies, but has fewer than two values to choose from",
        );
        check("", "b: {varies: [1, 1.0], value: 0.1,", "1.0", "`1.0` is listed twice");
        check(
            "",
            "b: {varies: [1, 2], accepted: [3], value: 0.1,",
            "3",
            "`b` varies, so it cannot have other accepted values",
        );
        check(
            "",
            "b: {varies: [1, 2], mistaken: [2], value: 0.1,",
            "2",
            "`b` lists `2` as mistaken, but some students have it",
        );
        check(
            "",
            "b: {varies: {from: 1, to: 2, step: 0.3}, value: 0.1,",
            "{",
            "steps of 0.3 from 1 do not lead to 2",
        );
        check(
            "",
            "b: {varies: {from: 2, to: 1, step: 0.3}, value: 0.1,",
            "{",
            "the values must rise: `to` above `from`, `step` above 0",
        );
        check(
            "variants: {seed: \"\"}\n",
            "b: {varies: [1, 2], value: 0.1,",
            "\"\"",
            "a seed is one line of text, at most 200 bytes",
        );
        check("", "b: {varies: [1, 2], values: 0.1,", "values", "there is no key `values` here");
        check("", "b: {varies: {from: 1, till: 2}, value: 0.1,", "till", "there is no key `till` here");
    }

    #[test]
    fn more_variants_than_can_be_proven_are_an_error() {
        let errors = varied(
            "",
            B,
            "b: {varies: {from: 1, to: 999, step: 1}, value: 1}\n  c: {varies: [1, 2, 3, 4, 5], value: 1}\n  d: {value: 0.1,",
        );
        let text = errors.unwrap_err().to_string();
        assert!(text.contains("999 of `b` and 5 of `c` make 4995 variants, more than the 4096"), "{text}");
    }
}
