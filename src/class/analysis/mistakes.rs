use crate::class::Record;
use crate::class::record::ExplanationRecord;
use crate::lab::LabDefinition;
use crate::report::{MistakeMade, People};
use std::collections::BTreeMap;

/// More different mistakes are counted together.
const MOST: usize = 1000;

/// Which mistakes explain the wrong transfer functions of a class, and how many submissions have each.
///
/// Parameter values that were taken on the way (`With g = 9.8, …`) make no other mistake. Slips of digits are one mistake a
/// question, whatever the digits.
pub struct Mistakes {
    /// Place of the question by the criterion's id.
    questions: BTreeMap<String, usize>,
    /// By question, code, and words (none of a slip).
    made: BTreeMap<(usize, String, String), MistakeMade>,
    ids: Vec<String>,
    unexplained: BTreeMap<usize, People>,
    not_listed: usize,
}

impl Mistakes {
    pub fn new(lab: &LabDefinition) -> Self {
        let questions = lab.questions.iter().enumerate();
        let criteria = questions
            .flat_map(|(place, question)| question.criteria.iter().map(move |one| (one.id.clone(), place)));
        Self {
            questions: criteria.collect(),
            made: BTreeMap::new(),
            ids: lab.questions.iter().map(|question| question.id.clone()).collect(),
            unexplained: BTreeMap::new(),
            not_listed: 0,
        }
    }

    /// `who` is how the submission is named, `link` leads to it.
    pub fn add(&mut self, record: &Record, who: &str, link: &str) {
        for item in &record.items {
            let (Some(diagnosis), Some(&question)) = (&item.diagnosis, self.questions.get(&item.id)) else {
                continue;
            };
            if diagnosis.explanations.is_empty() {
                self.unexplained.entry(question).or_default().add(who, link);
            }
            let alone = diagnosis.explanations.len() == 1;
            for one in &diagnosis.explanations {
                let words = words(one);
                let key = match is_slip(&one.code) {
                    true => String::new(),
                    false => words.clone(),
                };
                let key = (question, one.code.clone(), key);
                if self.made.len() >= MOST && !self.made.contains_key(&key) {
                    self.not_listed += 1;
                    continue;
                }
                let made = self.made.entry(key).or_insert_with(|| MistakeMade {
                    question: self.ids[question].clone(),
                    code: one.code.clone(),
                    words,
                    for_example: is_slip(&one.code),
                    alone: 0,
                    among_others: 0,
                    people: People::default(),
                });
                made.alone += usize::from(alone);
                made.among_others += usize::from(!alone);
                made.people.add(who, link);
            }
        }
    }

    /// The most frequent first, then in the lab's order; and how many explanations were too many to be kept apart.
    pub fn list(&self) -> (Vec<MistakeMade>, usize) {
        let mut list: Vec<MistakeMade> = self.made.values().cloned().collect();
        list.extend(self.unexplained.iter().map(|(question, people)| MistakeMade {
            question: self.ids[*question].clone(),
            code: String::new(),
            words: "No single slip or pair of them explains it.".to_owned(),
            for_example: false,
            alone: 0,
            among_others: 0,
            people: people.clone(),
        }));
        // Stable: what is as frequent stays in the lab's order.
        list.sort_by_key(|one| (one.code.is_empty(), std::cmp::Reverse(one.people.count)));
        (list, self.not_listed)
    }
}

/// Its numbers are of one answer only.
fn is_slip(code: &str) -> bool {
    code.split('+').any(|part| part.starts_with("slip.") || part.starts_with("rounding."))
}

/// What went wrong without the parameter values taken on the way.
fn words(one: &ExplanationRecord) -> String {
    let longest = (1..one.changes.len())
        .rev()
        .find_map(|values| one.words.strip_prefix(&format!("With {}, ", one.changes[..values].join(", "))));
    longest.map_or_else(|| one.words.clone(), crate::english::capitalized)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(words_of: &str, changes: &[&str], want: &str) {
        let one = ExplanationRecord {
            code: "term.sign".to_owned(),
            words: words_of.to_owned(),
            changes: changes.iter().map(|change| (*change).to_owned()).collect(),
        };
        assert_eq!(words(&one), want);
    }

    #[test]
    fn a_mistake_is_the_same_by_any_accepted_value() {
        check("The term `b*x'` is missing.", &["equation 1: b*x' -> 0"], "The term `b*x'` is missing.");
        check("With g = 9.8, the term is missing.", &["g = 9.8", "equation 1"], "The term is missing.");
        check("With g = 9.8, b = 2, the term.", &["g = 9.8", "b = 2", "equation 1"], "The term.");
    }

    #[test]
    fn digits_make_no_other_mistake() {
        assert!(is_slip("slip.digit") && is_slip("term.sign+slip.exchanged"));
        assert!(!is_slip("term.sign") && !is_slip("point.other"));
    }
}
