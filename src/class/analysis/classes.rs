use crate::class::Record;
use crate::lab::{Check, LabDefinition};
use crate::report::Confusion;
use crate::submission::{nonlinearity_name, nonlinearity_word};
use std::collections::BTreeMap;

/// Which class of nonlinearity was answered where which was right.
pub struct Classes {
    /// The right class by the criterion's id.
    asked: BTreeMap<String, &'static str>,
    counts: BTreeMap<(&'static str, &'static str), usize>,
}

/// Answers that are no class.
const BLANK: &str = "left blank";
const UNREADABLE: &str = "cannot be read";
const OTHER: &str = "not judged";

impl Classes {
    pub fn new(lab: &LabDefinition) -> Self {
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        let asked = criteria.filter_map(|criterion| match criterion.check {
            Check::Nonlinearity { expected } => Some((criterion.id.clone(), nonlinearity_name(expected))),
            _ => None,
        });
        Self { asked: asked.collect(), counts: BTreeMap::new() }
    }

    pub fn add(&mut self, record: &Record) {
        for item in &record.items {
            let Some(&right) = self.asked.get(&item.id) else { continue };
            let answered = match item.verdict.as_str() {
                _ if class(&item.evidence.found).is_some() => class(&item.evidence.found).unwrap_or(OTHER),
                "blank" => BLANK,
                "unreadable" => UNREADABLE,
                _ => OTHER,
            };
            *self.counts.entry((right, answered)).or_default() += 1;
        }
    }

    /// A row a right class, a column an answer; what is no class comes last.
    pub fn table(&self) -> Confusion {
        let mut rows: Vec<&'static str> = self.asked.values().copied().collect();
        rows.sort_unstable();
        rows.dedup();
        let mut columns: Vec<&'static str> = self.counts.keys().map(|(_, answered)| *answered).collect();
        columns.extend(&rows);
        columns.sort_unstable_by_key(|name| ([BLANK, UNREADABLE, OTHER].contains(name), *name));
        columns.dedup();
        let count = |right, answered| self.counts.get(&(right, answered)).copied().unwrap_or(0);
        let counts =
            rows.iter().map(|right| columns.iter().map(|answered| count(*right, *answered)).collect());
        Confusion { counts: counts.collect(), rows, columns }
    }
}

/// `text` as the name of a class.
fn class(text: &str) -> Option<&'static str> {
    const LONGEST: usize = 40;
    let kind = (text.len() <= LONGEST).then(|| nonlinearity_word(text)).flatten()?;
    Some(nonlinearity_name(kind)).filter(|name| *name == text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::analysis::samples::{item, record_of};

    #[test]
    fn answers_stand_beside_what_is_right() {
        let asked = [("q.a", "dead zone"), ("q.b", "backlash")];
        let mut classes = Classes {
            asked: asked.map(|(id, right)| (id.to_owned(), right)).into(),
            counts: BTreeMap::new(),
        };
        for (a, b) in [
            (("right", "dead zone"), ("wrong", "dead zone")),
            (("right", "dead zone"), ("right", "backlash")),
            (("wrong", "relay"), ("blank", "")),
            (("unreadable", "<b>dead zone"), ("unmarked", "")),
        ] {
            classes.add(&record_of(&[item("q.a", a.0, a.1), item("q.b", b.0, b.1)]));
        }
        let table = classes.table();
        assert_eq!(table.rows, ["backlash", "dead zone"]);
        let columns = ["backlash", "dead zone", "relay", "cannot be read", "left blank", "not judged"];
        assert_eq!(table.columns, columns);
        assert_eq!(table.counts, [[1, 1, 0, 0, 1, 1], [0, 2, 1, 1, 0, 0]]);
    }
}
