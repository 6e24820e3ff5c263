use crate::grading::Verdict;
use crate::grading::mark::Mark;
use crate::lab::Points;

/// Stands for no answer where the hash of one is asked for.
pub const NO_ANSWER: &str = "none";

/// A mark by a person, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    pub points: Points,
    pub reason: String,
    /// Hashes of the answers it was made for, [`NO_ANSWER`] for none; empty when it holds for whatever stands there.
    pub answers: Vec<String>,
}

impl Override {
    /// Whether it was made for the answer with this hash.
    pub fn is_for(&self, answer: Option<&str>) -> bool {
        self.answers.is_empty() || self.answers.iter().any(|hash| hash == answer.unwrap_or(NO_ANSWER))
    }

    /// The mark with the person's points; what polemark saw stays as evidence.
    pub(in crate::grading) fn apply(&self, possible: Points, mark: Mark) -> Mark {
        let verdict = match self.points {
            points if points >= possible => Verdict::Right,
            Points::ZERO => Verdict::Wrong,
            _ => Verdict::Partly,
        };
        Mark { verdict, code: "by_hand", earned: self.points, provisional: false, ..mark }
    }
}

/// What a person's decision means for the answer that stands there now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given<'a> {
    Applies(&'a Override),
    /// It was made for another answer: it does not count until a person has looked again.
    Held(&'a Override),
}

impl<'a> Given<'a> {
    pub fn applied(self) -> Option<&'a Override> {
        match self {
            Self::Applies(given) => Some(given),
            Self::Held(_) => None,
        }
    }

    pub fn held(self) -> Option<&'a Override> {
        match self {
            Self::Applies(_) => None,
            Self::Held(given) => Some(given),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::Evidence;

    #[test]
    fn a_person_has_the_last_word() {
        for (given, verdict) in [(0, Verdict::Wrong), (50, Verdict::Partly), (100, Verdict::Right)] {
            let mark = Mark { provisional: true, ..Mark::wrong("concepts.missing", Evidence::default()) };
            let given = Override { points: Points(given), reason: "seen".into(), answers: Vec::new() };
            let mark = given.apply(Points(100), mark);
            assert_eq!((mark.verdict, mark.code, mark.provisional), (verdict, "by_hand", false));
            assert_eq!(mark.earned, given.points);
        }
    }

    #[test]
    fn a_decision_is_for_the_answer_it_was_made_for() {
        for (made_for, answer, is_for) in [
            (&[][..], Some("a1"), true),
            (&[], None, true),
            (&["a1"], Some("a1"), true),
            (&["a1", "a2"], Some("a2"), true),
            (&["a1"], Some("a2"), false),
            (&["a1"], None, false),
            (&["none"], None, true),
            (&["none"], Some("a1"), false),
        ] {
            let answers = made_for.iter().map(|hash| (*hash).to_owned()).collect();
            let given = Override { points: Points::ZERO, reason: "seen".into(), answers };
            assert_eq!(given.is_for(answer), is_for, "{made_for:?} {answer:?}");
        }
    }
}
