use super::{Diagnosis, Evidence, Verdict};
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
}

impl Mark {
    pub fn right(points: Points, evidence: Evidence) -> Self {
        Self {
            verdict: Verdict::Right,
            code: "right",
            earned: points,
            evidence,
            provisional: false,
            diagnosis: None,
        }
    }

    pub fn partly(code: &'static str, earned: Points, evidence: Evidence) -> Self {
        Self { verdict: Verdict::Partly, code, earned, evidence, provisional: false, diagnosis: None }
    }

    pub fn wrong(code: &'static str, evidence: Evidence) -> Self {
        Self {
            verdict: Verdict::Wrong,
            code,
            earned: Points::ZERO,
            evidence,
            provisional: false,
            diagnosis: None,
        }
    }

    pub fn blank(expected: String) -> Self {
        let evidence =
            Evidence { expected, reason: "Nothing was written here.".into(), ..Evidence::default() };
        Self {
            verdict: Verdict::Blank,
            code: "blank",
            earned: Points::ZERO,
            evidence,
            provisional: false,
            diagnosis: None,
        }
    }

    pub fn unreadable(expected: String, answer: &Answer, why: &Unreadable) -> Self {
        let mut reason = why.finding.message.clone();
        if let Some(help) = &why.finding.help {
            reason = format!("{reason} {help}");
        }
        let evidence = Evidence { expected, found: beginning(&answer.text), reason, ..Evidence::default() };
        Self {
            verdict: Verdict::Unreadable,
            code: "unreadable",
            earned: Points::ZERO,
            evidence,
            provisional: false,
            diagnosis: None,
        }
    }

    /// polemark has nothing to judge with, or does not know how: put before a person.
    pub fn unmarked(expected: String, found: String, reason: impl Into<String>) -> Self {
        let evidence = Evidence { expected, found, reason: reason.into(), ..Evidence::default() };
        Self {
            verdict: Verdict::Unmarked,
            code: "unmarked",
            earned: Points::ZERO,
            evidence,
            provisional: true,
            diagnosis: None,
        }
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
