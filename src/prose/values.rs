//! Values with their name: `the initial value is 0`, `settles at 2.5`.

use super::claims::{Claim, ClaimKind, Quantity};
use super::context::{self, Remark};
use super::number::{ClaimedNumber, Unit, number_at};
use super::phrase::{Phrase, Said};
use super::sentence::Sentence;
use super::words::{Gap, Token};
use crate::source::Span;
use std::sync::LazyLock;

/// What a number is of, and the words before it that say so; `Some(zero)`: of the number zero only.
struct Head {
    of: Quantity,
    phrase: Phrase,
    /// `goes to 0.8` may be on the way; `goes to zero` ends there.
    zero_only: bool,
    /// A verb: it needs its preposition, and its subject must be the response.
    verb: bool,
}

static HEADS: LazyLock<Vec<Head>> = LazyLock::new(|| {
    let mut all = Vec::new();
    let mut add = |of, zero_only, verb, between, texts: &[&str]| {
        for text in texts {
            all.push(Head { of, phrase: Phrase::new(text).with_between(between), zero_only, verb });
        }
    };
    use Quantity::*;
    add(
        Initial,
        false,
        false,
        0,
        &[
            "initial value",
            "initial values",
            "start value",
            "starting value",
            "initial and final value",
            "initial and final values",
        ],
    );
    add(
        Initial,
        false,
        true,
        1,
        &[
            "starts at",
            "starts from",
            "start at",
            "start from",
            "starting at",
            "starting from",
            "starts with",
            "begins at",
            "begins from",
            "begins with",
            "begin at",
            "begin from",
            "starts and ends at",
            "begins and ends at",
            "starts and finishes at",
        ],
    );
    add(
        Final,
        false,
        false,
        0,
        &[
            "final value",
            "final values",
            "end value",
            "steady state value",
            "steady state",
            "initial and final value",
            "initial and final values",
        ],
    );
    add(
        Final,
        false,
        true,
        1,
        &[
            "settles at",
            "settles to",
            "settles on",
            "settle at",
            "settle to",
            "settles around",
            "settling at",
            "converges to",
            "converge to",
            "converges towards",
            "ends at",
            "end at",
            "ends up at",
            "finishes at",
            "finish at",
            "comes to rest at",
            "come to rest at",
            "approaches",
            "tends to",
            "tends towards",
            "tend to",
            "decays to",
            "decay to",
            "decaying to",
            "dies out to",
            "dies away to",
            "starts and ends at",
            "begins and ends at",
            "starts and finishes at",
        ],
    );
    add(
        Final,
        true,
        true,
        1,
        &[
            "returns to",
            "return to",
            "returning to",
            "goes to",
            "go to",
            "goes back to",
            "go back to",
            "comes back to",
            "come back to",
            "back to",
            "falls to",
            "drops to",
        ],
    );
    add(
        Peak,
        false,
        false,
        0,
        &[
            "peak",
            "peak value",
            "peak angle",
            "peak amplitude",
            "maximum",
            "maximum value",
            "maximum angle",
            "maximum deflection",
        ],
    );
    add(
        PeriodS,
        false,
        false,
        1,
        &["period", "period of the oscillation", "period of oscillation", "period of the swings"],
    );
    all
});

/// What may stand between the words for a quantity and its number.
const FILLERS: &[&str] = &[
    "is",
    "are",
    "was",
    "were",
    "be",
    "of",
    "at",
    "to",
    "the",
    "a",
    "both",
    "equal",
    "equals",
    "about",
    "approximately",
    "around",
    "roughly",
    "nearly",
    "almost",
    "approx",
    "ca",
    "again",
    "exactly",
    "value",
    "not",
    "response",
    "angle",
    "output",
    "impulse",
    "step",
    "amounts",
    "value",
];
const ABOUT: &[&str] = &["about", "approximately", "around", "roughly", "nearly", "almost", "approx", "ca"];
/// Words between at most.
const MOST_FILLERS: usize = 6;

/// The values that `sentence` claims, in text order.
pub(super) fn values(prose: &str, sentence: &Sentence) -> Vec<Claim> {
    let mut all: Vec<(usize, Claim)> = Vec::new();
    for head in HEADS.iter() {
        for said in head.phrase.said_in(sentence) {
            if !context::speaks_of_it(sentence, &said, if head.verb { Remark::Value } else { Remark::Named })
            {
                continue;
            }
            let Some((number, end, negations)) = number_after(prose, sentence, &said, head) else { continue };
            if head.zero_only && number.value != 0.0 {
                continue;
            }
            let claim = Claim {
                span: Span { start: said.span.start, end },
                kind: ClaimKind::Value(head.of, number),
                denied: said.denied != (negations % 2 == 1),
            };
            all.push((said.first, claim));
        }
    }
    // One number is one value of a quantity: the head nearest before it, and the longest of those.
    all.sort_by_key(|(_, claim)| (claim.span.end, claim.span.start));
    let mut kept: Vec<Claim> = Vec::new();
    for (_, claim) in all {
        let same = |other: &Claim| other.span.end == claim.span.end && of(other) == of(&claim);
        if !kept.iter().any(same) {
            kept.push(claim);
        }
    }
    kept
}

pub(super) fn of(claim: &Claim) -> Option<Quantity> {
    match claim.kind {
        ClaimKind::Value(of, _) => Some(of),
        _ => None,
    }
}

/// The number that follows `said` with nothing but fillers between, where it ends, and how many fillers deny it.
fn number_after(
    prose: &str,
    sentence: &[Token],
    said: &Said,
    head: &Head,
) -> Option<(ClaimedNumber, usize, usize)> {
    let unit = if head.of == Quantity::PeriodS { Unit::Seconds } else { Unit::Output };
    let (mut about, mut negations) = (false, 0);
    for token in sentence.iter().skip(said.last + 1).take(MOST_FILLERS + 1) {
        // `initial value: 0`, `final value (0)`, `initial value = 0`
        if !(token.gap == Gap::Space || (token.gap == Gap::Break && !head.verb)) {
            return None;
        }
        let text = token.text.as_str();
        if FILLERS.contains(&text) {
            about |= ABOUT.contains(&text);
            negations += usize::from(text == "not");
            continue;
        }
        let (number, end) = number_at(prose, token.span.start, unit)?;
        return Some((ClaimedNumber { about, ..number }, end, negations));
    }
    None
}
