//! Sets of poles: how near each is to the expected one, and how near the polynomial with these roots is.

mod assignment;
mod backward_error;
mod search;
mod set;
mod typed_pole;
mod words;

use super::Evidence;
use super::accepted::{Accepted, accepted};
use super::mark::{Mark, half, share};
use crate::algebra::{Polynomial, Rational, from_f64};
use crate::lab::{Points, SystemRef, Tolerance};
use crate::lti::Pole;
use crate::reference::Reference;
use crate::submission::TypedComplex;
use assignment::Assignment;
use set::WantedSet;
use typed_pole::{Side, TypedPole};

/// More poles than this are not matched one by one.
const MOST: usize = 60;

/// One accepted set of poles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExpectedPoles<'a> {
    pub poles: Accepted<'a, [Pole]>,
    /// The polynomial whose roots they are, common factors cancelled; any scale.
    pub denominator: &'a Polynomial,
}

/// How near a set of poles has to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness<'a> {
    /// Of each real and imaginary part.
    pub parts: &'a Tolerance,
    /// Relative, of each coefficient of the denominator.
    pub coefficients: &'a Rational,
}

impl Nearness<'_> {
    /// The tolerance of parts among these poles: beside the largest of them what is left open is no wider than beside itself.
    ///
    /// A pole at the origin has no size of its own.
    fn among(&self, poles: &[Pole]) -> Tolerance {
        let mut parts = self.parts.clone();
        let largest = poles.iter().map(|pole| pole.re.hypot(pole.im)).fold(0.0, f64::max);
        if let (Some(part), Some(largest)) = (&parts.of_scale, from_f64(largest))
            && !largest.is_zero()
        {
            parts.absolute = parts.absolute.min(part * largest);
        }
        parts
    }
}

/// The poles of every accepted set of parameter values, the lab's own first; none when the reference does not know `of`.
pub(super) fn accepted_poles<'a>(reference: &'a Reference, of: &SystemRef) -> Vec<ExpectedPoles<'a>> {
    accepted(reference, of, |one| one)
        .into_iter()
        .map(|one| ExpectedPoles {
            poles: Accepted { differs: one.differs, what: one.what.poles.as_slice() },
            denominator: &one.what.linearization.transfer_function.den,
        })
        .collect()
}

/// What is expected of a set of poles, in words.
pub(super) fn expected(accepted: &[ExpectedPoles<'_>], nearness: &Nearness<'_>) -> String {
    let among = accepted.first().map(|one| nearness.among(one.poles.what));
    words::expected(accepted, &Nearness { parts: among.as_ref().unwrap_or(nearness.parts), ..*nearness })
}

/// The typed set against each accepted set, the best of them.
///
/// Both are multisets. The set is right when each pole is near enough to one of its own, and also when the poles are,
/// as rounded, those of a denominator near enough, on the same sides of the imaginary axis. What is said of a wrong set
/// rests on the best assignment. `cancelled` are values that the whole state has beyond the poles.
pub(super) fn judge(
    points: Points,
    accepted: &[ExpectedPoles<'_>],
    cancelled: &[Pole],
    nearness: &Nearness<'_>,
    typed: &[TypedComplex],
) -> Mark {
    let expected = expected(accepted, nearness);
    let found = words::typed_list(typed);
    if accepted.is_empty() || accepted.iter().any(|one| count(one.poles.what) > MOST) {
        return Mark::unmarked(expected, found, "polemark cannot compare these poles; a person will.");
    }
    let mut best: Option<Outcome> = None;
    for one in accepted {
        let among = nearness.among(one.poles.what);
        let outcome = compare(one, cancelled, &Nearness { parts: &among, ..*nearness }, typed);
        if best.as_ref().is_none_or(|known| outcome.rank() > known.rank()) {
            best = Some(outcome);
        }
    }
    let Some(outcome) = best else {
        return Mark::unmarked(expected, found, "There is no reference to compare this with.");
    };
    let evidence = Evidence { expected, found, reason: outcome.reason, ..Evidence::default() };
    match outcome.code {
        "right" => Mark::right(points, evidence),
        "poles.missing_conjugate" => Mark::partly(outcome.code, share(points, &half()), evidence),
        code => Mark::wrong(code, evidence),
    }
}

struct Outcome {
    code: &'static str,
    /// How many poles are near enough, each by itself.
    matched: usize,
    reason: String,
}

impl Outcome {
    fn rank(&self) -> (bool, bool, usize) {
        (self.code == "right", self.code == "poles.missing_conjugate", self.matched)
    }
}

fn compare(
    one: &ExpectedPoles<'_>,
    cancelled: &[Pole],
    nearness: &Nearness<'_>,
    typed: &[TypedComplex],
) -> Outcome {
    let want = one.poles.what;
    if typed.len() > MOST {
        let reason = format!("{} poles were written; there are {}.", typed.len(), count(want));
        return Outcome { code: "poles.extra", matched: 0, reason };
    }
    let set = WantedSet::new(one, nearness);
    let each = &set.each;
    let tolerance = nearness.parts;
    let values: Vec<TypedPole> = typed.iter().map(TypedPole::of).collect();
    let fit = Assignment::best(each, &values, tolerance);
    let matched = fit.accepted();
    let outcome = |code, reason| Outcome { code, matched, reason };

    if let Some(right) = set.right(&values, &fit) {
        return outcome("right", words::right(&right, one, nearness.coefficients));
    }
    if let Some(reason) = missing_conjugates(&set, &values) {
        return outcome("poles.missing_conjugate", reason);
    }
    if same_places(want, &values, tolerance) {
        return outcome("poles.multiplicity", words::multiplicities(want, &values, tolerance));
    }
    let mirrored: Vec<TypedPole> = values.iter().map(TypedPole::mirrored).collect();
    if set.right(&mirrored, &Assignment::best(each, &mirrored, tolerance)).is_some() {
        let reason =
            "Each real part has the wrong sign: the set is mirrored at the imaginary axis.".to_owned();
        return outcome("poles.mirrored", reason);
    }
    let not_found: Vec<Pole> = fit.not_found(each.len()).into_iter().map(|index| each[index]).collect();
    let not_right: Vec<&TypedPole> =
        fit.not_right(values.len()).into_iter().map(|index| &values[index]).collect();
    if matched == values.len() {
        let missing = words::is_are(&words::list_each(&not_found));
        return outcome("poles.missing", format!("Those given are right, but {missing} missing."));
    }
    if matched == each.len() {
        let extra = words::is_are(&not_right.iter().map(|value| value.text()).collect::<Vec<_>>());
        let mut reason = format!("All poles are there, but {extra} not among them.");
        let of_state = |value: &TypedPole| cancelled.iter().any(|pole| value.accepted_for(pole, tolerance));
        if not_right.iter().all(|value| of_state(value)) {
            reason.push_str(" It belongs to the whole state, but cancels in the transfer function.");
        }
        return outcome("poles.extra", reason);
    }
    let one_mirrored = not_right.iter().any(|value| {
        let mirrored = value.mirrored();
        not_found.iter().any(|pole| mirrored.accepted_for(pole, tolerance))
    }) || right_but_for_sides(&set, &values, &fit);
    let code = if one_mirrored { "poles.mirrored" } else { "poles.value" };
    let mut reason = words::wrong_pairs(each, &values, &fit);
    if one_mirrored {
        reason.push_str(" A real part has the wrong sign.");
    }
    outcome(code, reason)
}

/// The set would be right if each complex pole that stands alone had its conjugate beside it.
fn missing_conjugates(set: &WantedSet<'_>, values: &[TypedPole]) -> Option<String> {
    let complex: Vec<&TypedPole> = values.iter().filter(|value| !value.im.value.is_zero()).collect();
    let alone = |value: &&&TypedPole| !complex.iter().any(|other| other.is_conjugate_of(value));
    let completed: Vec<TypedPole> = complex.iter().filter(alone).map(|value| value.conjugate()).collect();
    if completed.is_empty() {
        return None;
    }
    let mut all = values.to_vec();
    all.extend(completed.iter().cloned());
    if all.len() != set.each.len() {
        return None;
    }
    set.right(&all, &Assignment::best(&set.each, &all, set.nearness.parts))?;
    let list: Vec<_> = completed.iter().map(TypedPole::text).collect();
    Some(format!(
        "Each pole given is right, but complex poles of a real system come in conjugate pairs: {} missing. Half the points.",
        words::is_are(&list)
    ))
}

/// The set would be right if each pole were on the side of the one it stands for.
fn right_but_for_sides(set: &WantedSet<'_>, values: &[TypedPole], fit: &Assignment) -> bool {
    let mut moved = values.to_vec();
    for (typed, expected) in fit.wrong_pairs() {
        let (is, should) = (moved[typed].side(), Side::of(&set.each[expected]));
        if matches!((is, should), (Side::Left, Side::Right) | (Side::Right, Side::Left)) {
            moved[typed] = moved[typed].mirrored();
        }
    }
    set.right(&moved, &Assignment::best(&set.each, &moved, set.nearness.parts)).is_some()
}

/// The same places, though not the same number of poles at each.
fn same_places(want: &[Pole], values: &[TypedPole], tolerance: &Tolerance) -> bool {
    !values.is_empty()
        && want.iter().all(|pole| values.iter().any(|value| value.accepted_for(pole, tolerance)))
        && values.iter().all(|value| want.iter().any(|pole| value.accepted_for(pole, tolerance)))
}

fn count(poles: &[Pole]) -> usize {
    poles.iter().map(|pole| pole.multiplicity).sum()
}

#[cfg(test)]
mod tests;
