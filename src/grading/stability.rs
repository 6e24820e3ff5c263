use super::Evidence;
use super::accepted::{Accepted, also};
use super::mark::Mark;
use crate::lab::Points;
use crate::lti::Stability;
use crate::submission::stability_name;

/// What is expected of the word, and which poles say so.
pub(super) fn expected(accepted: &[Accepted<'_, Stability>]) -> String {
    let Some(main) = accepted.first() else { return String::new() };
    let why = match main.what {
        Stability::AsymptoticallyStable => "every pole of the transfer function has a negative real part",
        Stability::MarginallyStable => {
            "no pole of the transfer function has a positive real part, and those on the imaginary axis are simple"
        }
        Stability::Unstable => {
            "a pole of the transfer function has a positive real part, or one on the imaginary axis is repeated"
        }
    };
    let others =
        if accepted.iter().all(|one| one.what == main.what) { String::new() } else { also(accepted) };
    format!("{}, since {why}.{others}", stability_name(*main.what))
}

/// The word against the stability of the transfer function; `whole` is that of the whole state.
pub(super) fn judge(
    points: Points,
    accepted: &[Accepted<'_, Stability>],
    whole: Option<Stability>,
    typed: Stability,
) -> Mark {
    let (expected, found) = (expected(accepted), stability_name(typed).to_owned());
    let Some(main) = accepted.first() else {
        return Mark::unmarked(expected, found, "There is no reference to compare this with.");
    };
    if let Some(one) = accepted.iter().find(|one| *one.what == typed) {
        let reason = format!("The transfer function{} is {found}.", one.with());
        return Mark::right(points, Evidence { expected, found, reason, ..Evidence::default() });
    }
    let opposite =
        !matches!((main.what, typed), (Stability::MarginallyStable, _) | (_, Stability::MarginallyStable));
    let code = if opposite { "stability.opposite" } else { "stability.marginal" };
    let mut reason = format!("The transfer function is {}, not {found}.", stability_name(*main.what));
    if whole == Some(typed) {
        reason.push_str(" The whole state is, because of a mode that does not reach the output; the question is about the output.");
    }
    Mark::wrong(code, Evidence { expected, found, reason, ..Evidence::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use Stability::*;

    #[track_caller]
    fn check(rows: &[(Stability, Option<Stability>, Stability, i64, &str)]) {
        for (truth, whole, typed, points, code) in rows {
            let accepted = [Accepted { differs: &[], what: truth }];
            let mark = judge(Points(100), &accepted, *whole, *typed);
            assert_eq!((mark.earned, mark.code), (Points(*points), *code), "{typed:?} for {truth:?}");
        }
    }

    #[test]
    fn the_word_is_held_against_the_transfer_function() {
        check(&[
            // truth, whole state, typed, points, code
            (AsymptoticallyStable, None, AsymptoticallyStable, 100, "right"),
            (AsymptoticallyStable, None, Unstable, 0, "stability.opposite"),
            (Unstable, None, AsymptoticallyStable, 0, "stability.opposite"),
            (Unstable, None, MarginallyStable, 0, "stability.marginal"),
            // the cart's free position makes the whole state marginal; the angle is asked for
            (AsymptoticallyStable, Some(MarginallyStable), MarginallyStable, 0, "stability.marginal"),
            (MarginallyStable, None, AsymptoticallyStable, 0, "stability.marginal"),
        ]);
    }

    #[test]
    fn a_word_about_the_whole_state_is_told_apart() {
        let accepted = [Accepted { differs: &[], what: &AsymptoticallyStable }];
        let mark = judge(Points(100), &accepted, Some(MarginallyStable), MarginallyStable);
        assert!(mark.evidence.reason.contains("whole state"), "{}", mark.evidence.reason);
    }

    #[test]
    fn without_a_reference_a_person_decides() {
        assert_eq!(judge(Points(100), &[], None, Unstable).code, "unmarked");
    }
}
