use super::mark::Mark;
use super::{Evidence, PhraseMatch, Stance};
use crate::lab::Points;
use crate::lti::{Features, Stability};
use crate::prose::{Claim, claims};

/// A response, and the stability of the system behind it.
pub(super) type Behaviour<'a> = (&'a Features, Stability);

/// More claims than these are not shown.
const MOST_SHOWN: usize = 60;

/// Prose by what it claims, where that is not so by the reference, against the student's `own` model.
///
/// Right when a claim that is false by every accepted reference is true of the own model, and none is false of it; wrong
/// when one is false of both. `None` when it claims nothing that the reference says is false. `elsewhere`: see [`claims`].
pub(super) fn judge(
    points: Points,
    prose: &str,
    elsewhere: &[&str],
    reference: &[Behaviour<'_>],
    own: Behaviour<'_>,
) -> Option<Mark> {
    let holds = |claim: &Claim, (features, stability): Behaviour<'_>| claim.holds(features, stability);
    let found = claims(prose, elsewhere);
    let is_wrong = |claim: &&Claim| reference.iter().all(|one| holds(claim, *one) == Some(false));
    if reference.is_empty() || !found.iter().any(|claim| is_wrong(&claim)) {
        return None;
    }
    let expected = format!("{}, {}.", own.0.shape.words(), own.1.words());
    if let Some(untrue) = found.iter().find(|claim| holds(claim, own) == Some(false)) {
        let reason = format!("It says that {}.", untrue.words());
        return Some(Mark::wrong(
            "concepts.contradicted",
            Evidence { expected, reason, ..Evidence::default() },
        ));
    }
    let follows = found.iter().filter(is_wrong).any(|claim| holds(claim, own) == Some(true));
    let true_of_it = found.iter().filter(|claim| holds(claim, own) == Some(true)).take(MOST_SHOWN);
    let phrases: Vec<PhraseMatch> = true_of_it
        .map(|claim| PhraseMatch { span: claim.span, concept: claim.words(), stance: Stance::Claims })
        .collect();
    let evidence = Evidence { expected, phrases, ..Evidence::default() };
    let mark = follows.then(|| Mark::right(points, evidence))?;
    Some(Mark { provisional: true, ..mark })
}
