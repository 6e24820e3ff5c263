use super::mark::Mark;
use super::{Evidence, PhraseMatch, Stance};
use crate::lab::Points;
use crate::lti::{Features, Stability};
use crate::prose::Claim;

/// A response, and the stability of the system behind it.
pub(super) type Behaviour<'a> = (&'a Features, Stability);

/// More claims than these are not shown.
const MOST_SHOWN: usize = 60;

/// Prose by what it claims, where that is not so by the reference, against the student's `own` model.
///
/// Right when a claim that is false by every accepted reference is true of the own model, and none is false of it; wrong
/// when one is false of it. `None` when it claims nothing that the reference says is false, or leaves room.
pub(super) fn judge(
    points: Points,
    found: &[Claim],
    reference: &[Behaviour<'_>],
    own: Behaviour<'_>,
) -> Option<Mark> {
    let holds = |claim: &Claim, (features, stability): Behaviour<'_>| claim.holds(features, stability);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal};
    use crate::lti::{InputKind, TransferFunction, stability};
    use crate::prose::claims;
    use crate::reference::ResponseReference;

    fn behaviour(num: &str, den: &str) -> (ResponseReference, Stability) {
        let polynomial = |text: &str| {
            Polynomial::new(text.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
        };
        let g = TransferFunction::new(polynomial(num), polynomial(den)).unwrap();
        let word = stability(&g.den);
        (ResponseReference::of(&g, InputKind::Impulse).unwrap(), word)
    }

    /// The reference swings and dies away.
    #[test]
    fn claims_are_held_against_the_own_response() {
        #[track_caller]
        fn check(own: (&str, &str), rows: &[(&str, Option<bool>)]) {
            let (right, word) = behaviour("-0.06 0", "0.0132 0.0024 0.41202 0.05886");
            let own = behaviour(own.0, own.1);
            for (prose, want) in rows {
                let reference = [(&right.features, word)];
                let mark = judge(Points(50), &claims(prose, &[]), &reference, (&own.0.features, own.1));
                assert_eq!(mark.as_ref().map(|mark| mark.earned == Points(50)), *want, "{prose}: {mark:#?}");
            }
        }
        let runs_away = ("-0.06 0", "0.0132 0.0024 -0.41202 -0.05886");
        check(
            runs_away,
            &[
                // Nothing claimed, nothing false, nothing but what both have.
                ("It does something.", None),
                ("It swings and dies away. It is stable.", None),
                ("It starts at zero.", None),
                ("It grows without bound and is unstable.", Some(true)),
                ("It is unstable.", Some(true)),
                ("It is unstable and oscillates.", Some(false)),
                ("Its amplitude is constant.", Some(false)),
                ("It is marginally stable.", Some(false)),
            ],
        );
        let swings_for_ever = ("1", "1 0 4");
        check(
            swings_for_ever,
            &[
                ("It oscillates for ever with constant amplitude.", Some(true)),
                ("It grows without bound.", Some(false)),
            ],
        );
    }
}
