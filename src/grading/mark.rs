use super::{Diagnosis, Evidence, FollowThrough, Verdict};
use crate::algebra::Rational;
use crate::lab::Points;
use crate::submission::{Answer, Unreadable};

/// What one criterion comes to before a person has a say.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    pub verdict: Verdict,
    pub code: &'static str,
    pub earned: Points,
    pub evidence: Evidence,
    pub provisional: bool,
    pub diagnosis: Option<Diagnosis>,
    pub follow_through: Option<FollowThrough>,
    pub alike: Option<String>,
    /// What it earns beyond the mark by the reference, for following from an earlier answer.
    pub spared: Points,
    /// What would be earned besides if the lab gave all the points for that.
    pub withheld: Points,
}

impl Mark {
    fn new(verdict: Verdict, code: &'static str, earned: Points, evidence: Evidence) -> Self {
        Self {
            verdict,
            code,
            earned,
            evidence,
            provisional: false,
            diagnosis: None,
            follow_through: None,
            alike: None,
            spared: Points::ZERO,
            withheld: Points::ZERO,
        }
    }

    pub fn right(points: Points, evidence: Evidence) -> Self {
        Self::new(Verdict::Right, "right", points, evidence)
    }

    pub fn partly(code: &'static str, earned: Points, evidence: Evidence) -> Self {
        Self::new(Verdict::Partly, code, earned, evidence)
    }

    pub fn wrong(code: &'static str, evidence: Evidence) -> Self {
        Self::new(Verdict::Wrong, code, Points::ZERO, evidence)
    }

    pub fn blank(expected: String) -> Self {
        let evidence =
            Evidence { expected, reason: "Nothing was written here.".into(), ..Evidence::default() };
        Self::new(Verdict::Blank, "blank", Points::ZERO, evidence)
    }

    pub fn unreadable(expected: String, answer: &Answer, why: &Unreadable) -> Self {
        let mut reason = why.finding.message.clone();
        if let Some(help) = &why.finding.help {
            reason = format!("{reason} {help}");
        }
        let evidence = Evidence { expected, found: beginning(&answer.text), reason, ..Evidence::default() };
        Self::new(Verdict::Unreadable, "unreadable", Points::ZERO, evidence)
    }

    /// polemark has nothing to judge with, or does not know how: put before a person.
    pub fn unmarked(expected: String, found: String, reason: impl Into<String>) -> Self {
        let evidence = Evidence { expected, found, reason: reason.into(), ..Evidence::default() };
        Self { provisional: true, ..Self::new(Verdict::Unmarked, "unmarked", Points::ZERO, evidence) }
    }
}

/// As much of a student's text as evidence needs.
pub(super) fn beginning(text: &str) -> String {
    const LETTERS: usize = 200;
    match text.char_indices().nth(LETTERS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// `points · part`, rounded to hundredths, halves up, held within 0..=`points`.
pub(super) fn share(points: Points, part: &Rational) -> Points {
    let exact = Rational::from(points.0) * part;
    let rounded = (exact + half()).floor();
    Points(i64::try_from(rounded).unwrap_or(0).clamp(0, points.0.max(0)))
}

pub(super) fn half() -> Rational {
    Rational::ONE / Rational::from(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_rounded_to_hundredths() {
        let third = Rational::ONE / Rational::from(3);
        for (points, part, want) in [
            (200, half(), 100),
            (50, half(), 25),
            (25, half(), 13),
            (100, third.clone(), 33),
            (200, third, 67),
            (100, Rational::from(2), 100),
            (100, Rational::from(-1), 0),
        ] {
            assert_eq!(share(Points(points), &part), Points(want), "{points} · {part}");
        }
    }
}
