use super::mark::Mark;
use super::own::OwnModel;
use super::{Catalogue, Guard};
use crate::lab::SystemRef;
use crate::lti::{InputKind, TransferFunction};
use crate::memo::Memo;
use crate::prose::Claim;
use crate::submission::{AnswerSheet, AnswerValue, Behaviour, Knowledge, behaviour, claims_about};
use std::sync::Arc;

/// What was worked out for earlier submissions, for those that hand in the same: one for each lab, reference and catalogue.
///
/// It decides how long marking takes, never what comes out.
#[derive(Clone, Debug)]
pub struct Known(Option<Kept>);

#[derive(Clone, Debug)]
struct Kept {
    marks: Memo<Judged, (AnswerValue, Vec<Mark>)>,
    /// Functions that students wrote, and the degree up to which they are followed.
    own: Memo<(TransferFunction, usize), Vec<OwnModel>>,
    guards: Memo<(SystemRef, TransferFunction), Guard>,
    /// What mistakes lead to.
    led_to: Memo<(SystemRef, Vec<String>), Vec<TransferFunction>>,
    behaviours: Memo<(TransferFunction, Option<InputKind>), Behaviour>,
    /// By text, and the system it is about.
    claims: Memo<(String, String), Vec<Claim>>,
}

/// The criterion, the first of those that are judged together, and the answer as typed.
type Judged = (String, String);

/// So many own models are kept; each takes some 10 kB.
const MOST_OWN_MODELS: usize = 512;
/// Bytes of marks, and of claims; and how many that is when answers are short.
const MOST_BYTES: usize = 8 << 20;
const MANY: usize = 4096;

impl Known {
    /// Nothing, and nothing will be: for a single submission.
    pub const NOTHING: Self = Self(None);

    pub fn new() -> Self {
        Self(Some(Kept {
            marks: Memo::of_bytes(MOST_BYTES, MANY, |(_, text), (_, marks)| {
                let words = |mark: &Mark| mark.evidence.expected.len() + mark.evidence.reason.len();
                // As typed, as read, and quoted as evidence.
                500 + 4 * text.len() + marks.iter().map(|mark| 500 + words(mark)).sum::<usize>()
            }),
            own: Memo::of(MOST_OWN_MODELS),
            guards: Memo::of(MOST_OWN_MODELS),
            led_to: Memo::of(MOST_OWN_MODELS),
            behaviours: Memo::of(MOST_OWN_MODELS),
            claims: Memo::of_bytes(MOST_BYTES, MANY, |(text, _), claims| {
                200 + text.len() + 100 * claims.len()
            }),
        }))
    }

    /// The marks of an answer by the reference; its text and what was read from it decide them, and no file.
    pub(super) fn marks(
        &self,
        criterion: &str,
        text: &str,
        value: &AnswerValue,
        judge: impl Fn() -> Vec<Mark>,
    ) -> Vec<Mark> {
        let Some(kept) = &self.0 else { return judge() };
        let known = kept.marks.get((criterion.to_owned(), text.to_owned()), |_| (value.clone(), judge()));
        // What was read depends on where it stands, seldom, and on a student's own numbers.
        if known.0.is_the_same(value) { known.1.clone() } else { judge() }
    }

    /// The ways to take a function that a student wrote: [`OwnModel::ways`].
    pub(super) fn own_models(&self, typed: &TransferFunction, most: usize) -> Arc<Vec<OwnModel>> {
        match &self.0 {
            None => Arc::new(OwnModel::ways(typed, most)),
            Some(kept) => kept.own.get((typed.clone(), most), |(typed, most)| OwnModel::ways(typed, *most)),
        }
    }

    /// Whether a function that a student wrote for `of` may be followed, as `judge` says.
    pub(super) fn guard(&self, of: &SystemRef, typed: &TransferFunction, judge: impl Fn() -> Guard) -> Guard {
        match &self.0 {
            None => judge(),
            Some(kept) => *kept.guards.get((of.clone(), typed.clone()), |_| judge()),
        }
    }

    /// [`Catalogue::led_to_by`]
    pub(super) fn led_to_by(
        &self,
        catalogue: &Catalogue,
        of: &SystemRef,
        changes: &[&str],
    ) -> Arc<Vec<TransferFunction>> {
        match &self.0 {
            None => Arc::new(catalogue.led_to_by(of, changes)),
            Some(kept) => {
                let all = changes.iter().map(|change| (*change).to_owned()).collect();
                kept.led_to.get((of.clone(), all), |_| catalogue.led_to_by(of, changes))
            }
        }
    }
}

impl Default for Known {
    fn default() -> Self {
        Self::new()
    }
}

impl Knowledge for Known {
    fn behaviour(&self, typed: &TransferFunction, response: Option<InputKind>) -> Arc<Behaviour> {
        match &self.0 {
            None => Arc::new(behaviour(typed, response)),
            Some(kept) => kept
                .behaviours
                .get((typed.clone(), response), |(typed, response)| behaviour(typed, *response)),
        }
    }

    fn claims(&self, prose: &str, about: &str, sheet: &AnswerSheet) -> Arc<Vec<Claim>> {
        match &self.0 {
            None => Arc::new(claims_about(prose, about, sheet)),
            Some(kept) => kept.claims.get((prose.to_owned(), about.to_owned()), |(prose, about)| {
                claims_about(prose, about, sheet)
            }),
        }
    }
}
