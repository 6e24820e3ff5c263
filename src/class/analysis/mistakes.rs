use crate::class::Record;
use crate::class::record::ExplanationRecord;
use crate::lab::LabDefinition;
use crate::report::{Explanation, MistakeMade, People};
use std::collections::{BTreeMap, BTreeSet};

/// More different explanations are counted together.
const MOST: usize = 1000;

/// Which mistakes explain the wrong transfer functions of a class, and how many submissions have each.
///
/// What several mistakes explain alike is counted once, for all of them together: a row for each set of mistakes, and no answer in
/// two rows. Parameter values that were taken on the way (`With g = 9.8, …`) make no other mistake. Slips of digits are one
/// mistake a question, whatever the digits.
pub struct Mistakes {
    /// Place of the question by the criterion's id.
    questions: BTreeMap<String, usize>,
    /// By question and, for each mistake of the set, code and words (none of a slip).
    made: BTreeMap<(usize, BTreeSet<(String, String)>), MistakeMade>,
    ids: Vec<String>,
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
            not_listed: 0,
        }
    }

    /// `who` is how the submission is named, `link` leads to it.
    pub fn add(&mut self, record: &Record, who: &str, link: &str) {
        for item in &record.items {
            let (Some(diagnosis), Some(&question)) = (&item.diagnosis, self.questions.get(&item.id)) else {
                continue;
            };
            let mut set = BTreeSet::new();
            let mut explanations = Vec::new();
            for one in &diagnosis.explanations {
                let (words, for_example) = (words(one), is_slip(&one.code));
                let key = if for_example { String::new() } else { words.clone() };
                if set.insert((one.code.clone(), key)) {
                    explanations.push(Explanation { words, for_example });
                }
            }
            let key = (question, set);
            if self.made.len() >= MOST && !self.made.contains_key(&key) {
                self.not_listed += 1;
                continue;
            }
            let made = self.made.entry(key).or_insert_with(|| MistakeMade {
                question: self.ids[question].clone(),
                explanations,
                people: People::default(),
            });
            made.people.add(who, link);
        }
    }

    /// The most frequent first, then in the lab's order, what nothing explains at the end; and how many answers had explanations
    /// that were too many to be kept apart.
    pub fn list(&self) -> (Vec<MistakeMade>, usize) {
        let mut list: Vec<MistakeMade> = self.made.values().cloned().collect();
        // Stable: what is as frequent stays in the lab's order.
        list.sort_by_key(|one| (one.explanations.is_empty(), std::cmp::Reverse(one.people.count)));
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
    use serde_json::json;

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
    fn every_answer_is_counted_once_whatever_explains_it() {
        let lab = crate::lab::load(crate::lab::DEFAULT).expect("it is checked");
        let question = &lab.questions[0];
        let mut mistakes = Mistakes::new(&lab);
        for explained in [
            &[("term.sign", "A.")][..],
            &[("term.sign", "A."), ("point.other", "B.")],
            &[("point.other", "B."), ("term.sign", "A.")],
            &[("slip.digit", "1 for 2.")],
            &[("slip.digit", "3 for 4.")],
            &[],
            &[],
            &[],
        ] {
            let mut item = crate::class::analysis::samples::item(&question.criteria[0].id, "wrong", "");
            let one = |(code, words): &(&str, &str)| json!({"code": code, "words": words, "changes": []});
            let explanations: Vec<_> = explained.iter().map(one).collect();
            item["diagnosis"] = json!({"explanations": explanations, "searched": 9});
            mistakes.add(&crate::class::analysis::samples::record_of(&[item]), "A", "a.html");
        }
        let (list, not_listed) = mistakes.list();
        let found: Vec<_> = list
            .iter()
            .map(|one| {
                let words: Vec<_> = one.explanations.iter().map(|one| one.words.as_str()).collect();
                (one.people.count, words)
            })
            .collect();
        let want = [(2, vec!["1 for 2."]), (2, vec!["A.", "B."]), (1, vec!["A."]), (3, vec![])];
        assert_eq!(not_listed, 0);
        assert_eq!(found.len(), want.len());
        assert!(want.iter().all(|one| found.contains(one)), "{found:?}");
        assert_eq!(found.last(), Some(&(3, vec![])), "what nothing explains is at the end, however frequent");
        assert_eq!(found[2].0, 1, "the most frequent first");
    }

    #[test]
    fn digits_make_no_other_mistake() {
        assert!(is_slip("slip.digit") && is_slip("term.sign+slip.exchanged"));
        assert!(!is_slip("term.sign") && !is_slip("point.other"));
    }
}
