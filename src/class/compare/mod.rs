//! Two runs side by side: which points have changed, and why.

mod standing;
mod written;

pub use standing::Standing;
pub use written::{comparison_csv, comparison_rows};

use crate::lab::Points;
use standing::{One, Part};
use std::collections::BTreeMap;

/// What has changed from one run to another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// By student, in the order of ids; within, in the lab's order.
    pub changes: Vec<Change>,
    /// Students with a change.
    pub students: usize,
    /// Changed points of criteria, rows, boxes and adjustments.
    pub items: usize,
    /// Over the students of both runs: the change of the mark, or of the points for questions while a mark waits for a person.
    pub mean_change: f64,
}

/// One difference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub student: String,
    pub name: String,
    /// A criterion; `observed.<row>`, `cover.<box>`, `adjustments`; `submission` where it is about the whole.
    pub item: String,
    /// `None` where there was no mark.
    pub old: Option<Points>,
    pub new: Option<Points>,
    /// `answer`, `marks`, `lab`, `program`, where several may be it with `or` between; of a submission `new`, `gone`, `late`.
    pub cause: String,
}

/// Compares two runs.
pub fn compare(old: &Standing, new: &Standing) -> Comparison {
    let mut comparison = Comparison::default();
    let runs = Runs::of(old, new);
    let mut both = 0_u32;
    let mut sum = Points::ZERO;
    let keys: std::collections::BTreeSet<_> = old.students.keys().chain(new.students.keys()).collect();
    for key in keys {
        let before = comparison.changes.len();
        match (old.students.get(key), new.students.get(key)) {
            (Some(one), Some(two)) => {
                both += 1;
                sum += match one.mark.zip(two.mark) {
                    Some((one, two)) => two - one,
                    None => two.earned - one.earned,
                };
                runs.of_student(&key.0, one, two, &mut comparison);
            }
            (Some(one), None) => comparison.changes.push(one.whole(&key.0, one.worth(), None, "gone")),
            (None, Some(two)) => comparison.changes.push(two.whole(&key.0, None, two.worth(), "new")),
            (None, None) => {}
        }
        comparison.students += usize::from(comparison.changes.len() > before);
    }
    comparison.items = comparison.changes.iter().filter(|change| change.item != SUBMISSION).count();
    comparison.mean_change = sum.as_f64() / f64::from(both.max(1));
    comparison
}

const SUBMISSION: &str = "submission";

impl One {
    /// What a submission is worth as a whole.
    fn worth(&self) -> Option<Points> {
        Some(self.mark.unwrap_or(self.earned))
    }

    fn whole(&self, student: &str, old: Option<Points>, new: Option<Points>, cause: &str) -> Change {
        Change {
            student: student.to_owned(),
            name: self.name.clone(),
            item: SUBMISSION.to_owned(),
            old,
            new,
            cause: cause.to_owned(),
        }
    }
}

/// What may have changed for all.
struct Runs<'a> {
    old: &'a Standing,
    new: &'a Standing,
    /// `lab`, `program`.
    causes: Vec<&'static str>,
}

impl<'a> Runs<'a> {
    fn of(old: &'a Standing, new: &'a Standing) -> Self {
        // Without a word about a run nothing can be ruled out.
        let differs = |fact: fn(&super::RunFacts) -> &str| match (&old.facts, &new.facts) {
            (Some(old), Some(new)) => fact(old) != fact(new),
            _ => true,
        };
        let causes = [("lab", differs(|run| &run.lab.hash)), ("program", differs(|run| &run.program.hash))];
        Self {
            old,
            new,
            causes: causes.into_iter().filter(|(_, differs)| *differs).map(|(cause, _)| cause).collect(),
        }
    }

    fn of_student(&self, student: &str, one: &One, two: &One, comparison: &mut Comparison) {
        if one.late != two.late {
            comparison.changes.push(two.whole(student, one.worth(), two.worth(), "late"));
        }
        let old: BTreeMap<&str, &Part> =
            one.parts.iter().map(|part| (self.old.name_of(part), part)).collect();
        let new: BTreeMap<&str, &Part> =
            two.parts.iter().map(|part| (self.new.name_of(part), part)).collect();
        let gone = one.parts.iter().map(|part| self.old.name_of(part)).filter(|name| !new.contains_key(name));
        let names = two.parts.iter().map(|part| self.new.name_of(part)).chain(gone);
        for name in names {
            let (old, new) = (old.get(name).copied(), new.get(name).copied());
            let points = |part: Option<&Part>| part.and_then(|part| part.points);
            if points(old) == points(new) {
                continue;
            }
            let cause = match name == "adjustments" && one.late != two.late {
                true => "late".to_owned(),
                false => self.cause(one, two, old, new),
            };
            comparison.changes.push(Change {
                student: student.to_owned(),
                name: two.name.clone(),
                item: name.to_owned(),
                old: points(old),
                new: points(new),
                cause,
            });
        }
    }

    /// The answer itself before anything else, then a person, then whatever else has changed: another answer it rests on, the lab,
    /// the program.
    fn cause(&self, one: &One, two: &One, old: Option<&Part>, new: Option<&Part>) -> String {
        let by_hand = |part: Option<&Part>| part.is_some_and(|part| part.by_hand);
        let (Some(old_part), Some(new_part)) = (old, new) else {
            // A criterion that only one of the labs has; or a person's row.
            return if by_hand(old.or(new)) { "marks".to_owned() } else { "lab".to_owned() };
        };
        if new_part.by_hand {
            return "marks".to_owned();
        }
        // An older polemark did not say which answers it read.
        let answers_are_known = self.old.facts.is_some() && self.new.facts.is_some();
        if answers_are_known && old_part.answer != new_part.answer {
            return "answer".to_owned();
        }
        if old_part.by_hand {
            return "marks".to_owned();
        }
        let mut causes = self.causes.clone();
        if !answers_are_known || one.answers != two.answers {
            causes.insert(0, "answer");
        }
        match causes.as_slice() {
            [] => "marks".to_owned(),
            _ => causes.join(" or "),
        }
    }
}

#[cfg(test)]
mod tests;
