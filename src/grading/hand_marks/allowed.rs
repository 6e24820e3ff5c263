use super::quoted;
use crate::algebra::{Rational, parse_decimal};
use crate::lab::{CoverSource, LabDefinition, Points};
use crate::names::nearest;
use crate::source::{Finding, Severity, Span};
use std::collections::BTreeMap;

/// What may be given, and how many points at most.
pub struct Allowed<'a> {
    pub lab: &'a str,
    pub cover: BTreeMap<&'a str, Points>,
    pub observed: BTreeMap<&'a str, Points>,
    pub items: BTreeMap<&'a str, Points>,
    /// All the points there are.
    pub total: Points,
}

impl<'a> Allowed<'a> {
    pub fn new(lab: &'a LabDefinition) -> Self {
        let by_hand = lab.cover.rows.iter().filter(|row| row.from == CoverSource::ByHand);
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        Self {
            lab: &lab.id,
            cover: by_hand.map(|row| (row.id.as_str(), row.points)).collect(),
            observed: lab.observed.iter().map(|row| (row.id.as_str(), row.points)).collect(),
            items: criteria.map(|criterion| (criterion.id.as_str(), criterion.points)).collect(),
            total: lab.cover.total,
        }
    }
}

/// What was found while reading.
#[derive(Default)]
pub struct Findings(pub Vec<Finding>);

impl Findings {
    pub fn report(&mut self, span: Option<Span>, code: &'static str, message: String, help: Option<&str>) {
        let help = help.map(str::to_owned);
        self.0.push(Finding { severity: Severity::Error, code, message, help, span });
    }

    /// Points within a range, in hundredths.
    pub fn points(&mut self, text: &str, span: Span, range: (Points, Points), id: &str) -> Option<Points> {
        let (least, most) = range;
        match hundredths(text) {
            None => {
                let message = format!("{} is not a number of points in steps of a hundredth.", quoted(text));
                self.report(Some(span), "marks.points_unreadable", message, Some("Write `1.5`, say."));
                None
            }
            Some(points) if points < least || points > most => {
                let message = format!("{points} points for `{id}` are not between {least} and {most}.");
                self.report(Some(span), "marks.points_out_of_range", message, None);
                None
            }
            found => found,
        }
    }

    /// Hashes of answers, apart by spaces or commas; in tables with `#` before each.
    pub fn hashes(&mut self, text: &str, span: Span) -> Vec<String> {
        let hashes: Vec<String> = apart(text).collect();
        let is_hash = |hash: &String| {
            hash == super::NO_ANSWER || (hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()))
        };
        if let Some(other) = hashes.iter().find(|hash| !is_hash(hash)) {
            let message = format!("{} does not tell which answer it is.", quoted(other));
            let help = "Copy the 16 digits under `answer` from the stub that `polemark marks` writes.";
            self.report(Some(span), "marks.answer_unreadable", message, Some(help));
        }
        hashes
    }

    pub fn unknown<'n>(
        &mut self,
        name: &str,
        span: Span,
        known: impl IntoIterator<Item = &'n str>,
        what: &str,
    ) {
        let known: Vec<&str> = known.into_iter().collect();
        let help = match nearest(name, known.iter().copied()) {
            Some(near) => format!("Did you mean `{near}`?"),
            None if known.is_empty() => "This lab has none.".to_owned(),
            None => {
                let names: Vec<_> = known.iter().take(12).map(|one| format!("`{one}`")).collect();
                let more = if known.len() > 12 { " and others" } else { "" };
                format!("There are {}{more}.", names.join(", "))
            }
        };
        let message = format!("There is no {what} {}.", quoted(name));
        self.report(Some(span), "marks.unknown", message, Some(&help));
    }

    pub fn twice(&mut self, span: Span, what: &str) {
        self.report(Some(span), "marks.twice", format!("{what} twice."), Some("Keep one."));
    }
}

/// Hashes that stand in one place, as they are compared.
pub fn apart(text: &str) -> impl Iterator<Item = String> {
    let hashes = text.split([' ', ',', ';', '\n', '\t', '#']).map(str::trim);
    hashes.filter(|hash| !hash.is_empty()).map(str::to_lowercase)
}

fn hundredths(text: &str) -> Option<Points> {
    let value = parse_decimal(text.trim()).ok()? * Rational::from(100);
    value.is_int().then(|| i64::try_from(value.floor()).ok())?.map(Points)
}
