use super::mark::{Mark, share};
use super::{Evidence, PhraseMatch, Stance, Verdict};
use crate::algebra::Rational;
use crate::lab::{Concept, Points};
use crate::prose::{Sentence, sentences};

/// More words than these are not shown.
const MOST_SHOWN: usize = 60;
/// More quotations than these are not listed in a sentence.
const MOST_QUOTED: usize = 8;

/// What prose should say, in words.
pub(super) fn expected(concepts: &[Concept], needed: usize) -> String {
    let titles: Vec<_> = concepts.iter().map(|concept| concept.title.as_str()).collect();
    let needed = needed_of(concepts, needed);
    if needed == titles.len() {
        format!("It should say {}.", that(&titles))
    } else {
        format!("It should say at least {needed} of these: {}.", titles.join("; "))
    }
}

fn needed_of(concepts: &[Concept], needed: usize) -> usize {
    needed.clamp(1, concepts.len().max(1))
}

/// Prose by the concepts it states. Always provisional: words are evidence of a thought, not the thought.
///
/// A concept counts when one of its phrases is claimed, half when the same phrase is also denied elsewhere; a contradiction
/// that is claimed takes all, unless it is said of something this is set against (`unlike the stable position`) or of how it
/// begins (`at first it grows`).
pub(super) fn judge(
    points: Points,
    concepts: &[Concept],
    needed: usize,
    contradictions: &[Concept],
    prose: &str,
) -> Mark {
    let expected = expected(concepts, needed);
    let read = sentences(prose);
    if read.is_empty() {
        return Mark::blank(expected);
    }
    let said: Vec<(&Concept, Vec<Match>)> =
        concepts.iter().map(|concept| (concept, matches(concept, &read))).collect();
    let against: Vec<PhraseMatch> = contradictions
        .iter()
        .flat_map(|concept| matches(concept, &read))
        .filter(|one| !one.contrasted)
        .map(|one| one.found)
        .filter(|found| found.stance == Stance::Claims)
        .map(|found| PhraseMatch { stance: Stance::Denies, ..found })
        .collect();
    let mut phrases: Vec<PhraseMatch> =
        said.iter().flat_map(|(_, found)| found).map(|one| one.found.clone()).collect();
    phrases.extend(against.iter().cloned());
    phrases.sort_by_key(|found| found.span);
    phrases.truncate(MOST_SHOWN);
    let evidence = |reason: String| Evidence {
        expected: expected.clone(),
        found: found_in_words(&phrases, prose),
        reason,
        phrases: phrases.clone(),
        ..Evidence::default()
    };
    if !against.is_empty() {
        let reason = format!(
            "Your text has the words {}. They say {}, which contradicts the answer.",
            quotations(&against, prose),
            that(&distinct(against.iter().map(|found| found.concept.as_str())))
        );
        return provisional(Mark::wrong("concepts.contradicted", evidence(reason)));
    }

    let states: Vec<(&Concept, State)> =
        said.iter().map(|(concept, found)| (*concept, State::of(found))).collect();
    let titles = |wanted: State| -> Vec<&str> {
        states
            .iter()
            .filter(|(_, state)| *state == wanted)
            .map(|(concept, _)| concept.title.as_str())
            .collect()
    };
    let (claimed, both, denied) = (titles(State::Claimed), titles(State::Both), titles(State::Denied));
    let needed = needed_of(concepts, needed);
    let halves = 2 * claimed.len() + both.len();
    let part = Rational::from(halves as u64) / Rational::from(2 * needed as u64);

    let enough = halves >= 2 * needed;
    // What is not there is no news once there is enough.
    let missing = if enough { Vec::new() } else { titles(State::Missing) };
    let reason: Vec<String> = [
        ("Your text says", &claimed),
        ("Your text both says and denies", &both),
        ("Your text denies", &denied),
        ("We did not find the words that say", &missing),
    ]
    .into_iter()
    .filter(|(_, titles)| !titles.is_empty())
    .map(|(words, titles)| format!("{words} {}.", that(titles)))
    .collect();
    let evidence = evidence(reason.join(" "));
    provisional(if enough {
        Mark { code: "concepts.found", ..Mark::right(points, evidence) }
    } else if halves > 0 {
        let code = if both.is_empty() { "concepts.missing" } else { "concepts.both_ways" };
        Mark::partly(code, share(points, &part), evidence)
    } else if denied.is_empty() {
        Mark::wrong("concepts.missing", evidence)
    } else {
        Mark::wrong("concepts.denied", evidence)
    })
}

fn provisional(mark: Mark) -> Mark {
    Mark { provisional: mark.verdict != Verdict::Blank, ..mark }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Claimed,
    Denied,
    Both,
    Missing,
}

impl State {
    /// Claimed by one phrase and denied by another is claimed: `it leaves the top, but cannot leave the circle`.
    fn of(found: &[Match]) -> Self {
        let has = |phrase: usize, stance| {
            found.iter().any(|one| one.phrase == phrase && one.found.stance == stance)
        };
        let claimed = || found.iter().filter(|one| one.found.stance == Stance::Claims);
        if claimed().any(|one| !has(one.phrase, Stance::Denies)) {
            Self::Claimed
        } else if claimed().next().is_some() {
            Self::Both
        } else if found.is_empty() {
            Self::Missing
        } else {
            Self::Denied
        }
    }
}

/// Titles of concepts are clauses: `that it swings, and that it comes to rest`.
fn that(titles: &[&str]) -> String {
    titles.iter().map(|title| format!("that {title}")).collect::<Vec<_>>().join(", and ")
}

/// What was found, and which of the concept's phrases found it.
struct Match {
    phrase: usize,
    contrasted: bool,
    found: PhraseMatch,
}

/// Every place where a phrase of `concept` is said, the longer phrase where one stands within another, in text order.
fn matches(concept: &Concept, sentences: &[Sentence]) -> Vec<Match> {
    let mut all = Vec::new();
    for (phrase, words) in concept.phrases.iter().enumerate() {
        for said in sentences.iter().flat_map(|sentence| words.said_in(sentence)) {
            let stance = if said.denied { Stance::Denies } else { Stance::Claims };
            all.push(Match {
                phrase,
                contrasted: said.contrasted,
                found: PhraseMatch { span: said.span, concept: concept.title.clone(), stance },
            });
        }
    }
    // Of phrases on the same words the one that claims: it holds the `not` in itself.
    all.sort_by_key(|one| {
        let span = one.found.span;
        (span.start, usize::MAX - span.end, one.found.stance == Stance::Denies)
    });
    let mut reached = 0;
    all.retain(|one| {
        let covered = one.found.span.end <= reached;
        reached = reached.max(one.found.span.end);
        !covered
    });
    all
}

fn distinct<'t>(titles: impl Iterator<Item = &'t str>) -> Vec<&'t str> {
    let mut kept: Vec<&str> = Vec::new();
    for title in titles {
        if !kept.contains(&title) {
            kept.push(title);
        }
    }
    kept
}

fn found_in_words(phrases: &[PhraseMatch], prose: &str) -> String {
    if phrases.is_empty() { "None of the words we look for.".to_owned() } else { quotations(phrases, prose) }
}

/// `“swings about”, “dies away”`, each once.
fn quotations(phrases: &[PhraseMatch], prose: &str) -> String {
    let mut quoted: Vec<String> = Vec::new();
    for found in phrases {
        let words = prose.get(found.span.start..found.span.end).unwrap_or_default();
        let one = format!("“{}”", words.split_whitespace().collect::<Vec<_>>().join(" "));
        if quoted.len() == MOST_QUOTED {
            quoted.push("…".to_owned());
            break;
        }
        if !quoted.contains(&one) {
            quoted.push(one);
        }
    }
    quoted.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prose::Phrase;

    fn concept(id: &str, title: &str, phrases: &[&str]) -> Concept {
        Concept {
            id: id.into(),
            title: title.into(),
            phrases: phrases.iter().map(|p| Phrase::new(p)).collect(),
        }
    }

    fn pendulum() -> Vec<Concept> {
        vec![
            concept("oscillates", "it oscillates", &["oscillat*", "swings"]),
            concept("settles", "it comes to rest", &["settles", "comes to rest", "dies out"]),
            concept("period", "its period is about 1.1 s", &["1.1 s"]),
        ]
    }

    #[track_caller]
    fn check(needed: usize, rows: &[(&str, i64, Verdict, &str)]) {
        let contradictions =
            [concept("forever", "it rotates for ever", &["rotat* indefinitely", "rotat* forever"])];
        for (text, points, verdict, code) in rows {
            let mark = judge(Points(100), &pendulum(), needed, &contradictions, text);
            let got = (mark.earned, mark.verdict, mark.code);
            assert_eq!(got, (Points(*points), *verdict, *code), "{text:?}: {}", mark.evidence.reason);
            assert_eq!(mark.provisional, *verdict != Verdict::Blank, "{text:?}");
        }
    }

    #[test]
    fn concepts_are_counted() {
        use Verdict::*;
        check(
            2,
            &[
                // answer, points, verdict, code
                ("It oscillates and comes to rest.", 100, Right, "concepts.found"),
                ("It oscillates with 1.1 s.", 100, Right, "concepts.found"),
                ("It swings, and the swing dies out; period 1.1 s", 100, Right, "concepts.found"),
                ("It swings.", 50, Partly, "concepts.missing"),
                ("It falls.", 0, Wrong, "concepts.missing"),
                ("It does not oscillate.", 0, Wrong, "concepts.denied"),
                ("It oscillates. It does not oscillate. It settles.", 75, Partly, "concepts.both_ways"),
                (
                    "It oscillates; its oscillations are not seen. It swings, settles.",
                    100,
                    Right,
                    "concepts.found",
                ),
                ("It oscillates but will rotate indefinitely.", 0, Wrong, "concepts.contradicted"),
                (
                    "It oscillates and comes to rest; it does not rotate forever.",
                    100,
                    Right,
                    "concepts.found",
                ),
                ("", 0, Blank, "blank"),
                (" \n \u{200b}", 0, Blank, "blank"),
            ],
        );
        check(3, &[("It oscillates and settles.", 67, Partly, "concepts.missing")]);
        check(9, &[("It swings, settles, 1.1 s", 100, Right, "concepts.found")]);
    }

    #[test]
    fn reasons_are_sentences() {
        let contradictions = [concept("stable", "the position is stable", &["stable"])];
        let settles = [
            concept("oscillates", "it oscillates", &["oscillat*"]),
            concept("settles", "it comes to rest", &["settles"]),
        ];
        for (text, code, reason) in [
            (
                "It oscillates.",
                "concepts.missing",
                "Your text says that it oscillates. We did not find the words that say that it comes to rest.",
            ),
            (
                "It oscillates and settles.",
                "concepts.found",
                "Your text says that it oscillates, and that it comes to rest.",
            ),
            (
                "It oscillates and is stable.",
                "concepts.contradicted",
                "Your text has the words “stable”. They say that the position is stable, which contradicts the \
                 answer.",
            ),
            (
                "Unlike the stable one it does not oscillate, it settles.",
                "concepts.missing",
                "Your text says that it comes to rest. Your text denies that it oscillates.",
            ),
        ] {
            let mark = judge(Points(100), &settles, 2, &contradictions, text);
            assert_eq!((mark.code, mark.evidence.reason.as_str()), (code, reason), "{text}");
            assert_eq!(
                mark.evidence.expected,
                "It should say that it oscillates, and that it comes to rest."
            );
        }
    }

    #[test]
    fn the_longer_phrase_decides() {
        let differs = [concept("compares", "it compares", &["match*", "does not match"])];
        let mark = judge(Points(100), &differs, 1, &[], "It does not match.");
        assert_eq!((mark.earned, mark.code), (Points(100), "concepts.found"));
        assert_eq!(mark.evidence.found, "“does not match”");
    }

    #[test]
    fn a_wall_of_words_is_read_in_good_time() {
        let wall = "it does not oscillate and settles ".repeat(5_000);
        let mark = judge(Points(100), &pendulum(), 2, &[], &wall);
        assert_eq!(mark.code, "concepts.missing");
        assert_eq!(mark.evidence.phrases.len(), MOST_SHOWN);
    }

    #[test]
    fn the_words_are_shown() {
        let text = "Es ist klar: it  oscillates,\nand dies out.";
        let mark = judge(Points(100), &pendulum(), 2, &[], text);
        let words: Vec<_> =
            mark.evidence.phrases.iter().map(|found| &text[found.span.start..found.span.end]).collect();
        assert_eq!(words, ["oscillates", "dies out"]);
    }
}
