use super::{Adjustment, Diagnosis, FollowThrough, Ledger, Override};
use crate::lab::Points;
use crate::source::{Finding, Position, Span, sanitize};
use std::collections::BTreeMap;
use std::ops::Add;

/// What became of one criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    Right,
    Partly,
    Wrong,
    /// Nothing was written.
    Blank,
    /// Something was written that cannot be read; see the finding.
    Unreadable,
    /// polemark cannot judge it; a person must.
    Unmarked,
}

impl Verdict {
    /// The word tools read: `right`, `partly`, `wrong`, `blank`, `unreadable`, `unmarked`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Partly => "partly",
            Self::Wrong => "wrong",
            Self::Blank => "blank",
            Self::Unreadable => "unreadable",
            Self::Unmarked => "unmarked",
        }
    }
}

/// Every verdict for one submission.
#[derive(Clone, Debug, PartialEq)]
pub struct Scorecard {
    pub questions: Vec<QuestionScore>,
    pub total: Tally,
    /// Observed rows, points given by a person; `None` until then.
    pub observed: Vec<(String, Option<Points>)>,
    /// Boxes of the cover sheet, (row id, possible, earned); `None` while a part waits for a person.
    pub cover: Vec<(String, Points, Option<Points>)>,
    /// Sum of the cover sheet, `None` while a box is empty.
    pub cover_total: Option<Points>,
    /// The sum of what is known of the boxes, those that wait for a person in part included.
    pub so_far: Points,
    /// Where each point of `total` was lost, and what was not charged twice.
    pub ledger: Ledger,
    /// The hash of every answer, by field.
    pub answers: BTreeMap<String, String>,
    /// What changes the sum of the cover sheet.
    pub adjustments: Vec<Adjustment>,
    /// The sum of the cover sheet with the adjustments; `None` while a part waits for a person.
    pub mark: Option<Points>,
}

impl Scorecard {
    /// A finding for each decision of a person that was made for another answer than the one that stands there now.
    pub fn decided_for_other_answers(&self) -> impl Iterator<Item = Finding> + '_ {
        let items = self.questions.iter().flat_map(|question| &question.items);
        items.filter_map(|item| {
            let Override { points, reason, .. } = item.held.as_ref()?;
            let message = format!(
                "A person gave `{}` {} ({}) for another answer than the one that stands here now. That does not count until a person has \
                 looked again; until then polemark's own mark stands, {}.",
                item.id,
                crate::english::points(*points),
                sanitize(reason),
                crate::english::points(item.earned)
            );
            Some(Finding::warning("marks.answer_changed", message))
        })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Tally {
    pub earned: Points,
    pub possible: Points,
    /// How many of the earned points wait for a person to confirm them.
    pub provisional: Points,
}

impl Tally {
    pub fn of(items: &[ItemScore]) -> Self {
        Self {
            earned: items.iter().map(|item| item.earned).sum(),
            possible: items.iter().map(|item| item.possible).sum(),
            provisional: items.iter().filter(|item| item.provisional).map(|item| item.earned).sum(),
        }
    }
}

impl Add for Tally {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            earned: self.earned + other.earned,
            possible: self.possible + other.possible,
            provisional: self.provisional + other.provisional,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct QuestionScore {
    pub id: String,
    pub tally: Tally,
    pub items: Vec<ItemScore>,
}

/// One criterion's mark and why.
#[derive(Clone, Debug, PartialEq)]
pub struct ItemScore {
    /// The criterion's id.
    pub id: String,
    pub title: String,
    pub earned: Points,
    pub possible: Points,
    pub verdict: Verdict,
    /// Stable, dotted: `denominator.sign`, `poles.mirrored`, `concepts.contradicted`.
    pub code: &'static str,
    pub evidence: Evidence,
    /// Of a wrong transfer function, at the first criterion that is not right: what may have gone wrong.
    pub diagnosis: Option<Diagnosis>,
    /// Of an answer that is not right by the reference and rests on an earlier one: how it stands to that.
    pub follow_through: Option<FollowThrough>,
    /// The group of like answers that one decision of a person can serve, or served; `None` where polemark decided.
    pub alike: Option<String>,
    /// To be confirmed by a person.
    pub provisional: bool,
    /// A person changed the mark: their reason.
    pub override_reason: Option<String>,
    /// The hash of what is judged; `None` when it is blank.
    pub answer: Option<String>,
    /// What a person decided when another answer stood here: it does not count.
    pub held: Option<Override>,
    /// Where the answer stands in the file.
    pub position: Option<Position>,
}

/// Enough to argue a mark with.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Evidence {
    /// What would have been right, with the accepted interval where there is one.
    pub expected: String,
    /// What was written, as read.
    pub found: String,
    /// Why the mark is what it is, in one or two full sentences.
    pub reason: String,
    /// Words of the prose that count, for or against.
    pub phrases: Vec<PhraseMatch>,
    /// Words of the prose that do not go with the numbers: shown to the marker, no points by themselves.
    pub conflicts: Vec<Conflict>,
}

/// Prose that says something else than the student's own fields or the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// Bytes of the prose text (not of the file).
    pub span: Span,
    /// What is claimed, in words: `it is stable`.
    pub claim: String,
    /// What says otherwise, in a sentence: `Your pole 5.57 lies in the right half-plane.`
    pub against: String,
    /// It is the student's own answer that says otherwise, not the reference.
    pub own: bool,
}

/// Words found in prose.
#[derive(Clone, Debug, PartialEq)]
pub struct PhraseMatch {
    /// Bytes of the prose text (not of the file).
    pub span: Span,
    /// The concept's title.
    pub concept: String,
    pub stance: Stance,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stance {
    /// Says what was asked for.
    Claims,
    /// Says the opposite of what was asked for, or denies it.
    Denies,
}
