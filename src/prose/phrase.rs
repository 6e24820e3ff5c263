//! Where prose says a phrase, and whether it says so or denies it.

use super::sentence::{Beginnings, Sentence};
use super::words::{Gap, Token, words};
use crate::source::Span;

/// Words that may stand between two words of a lab's phrase.
const BETWEEN: usize = 3;

/// A phrase of a lab: `does not respond`, `oscillat*`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Phrase {
    words: Vec<PhraseWord>,
    beginnings: Beginnings,
    /// How many others may stand between two of the words.
    between: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct PhraseWord {
    text: String,
    /// `stem*`: the beginning of a word.
    stem: bool,
}

impl PhraseWord {
    fn matches(&self, token: &Token) -> bool {
        if self.stem { token.text.starts_with(&self.text) } else { token.text == self.text }
    }
}

/// A phrase said in one sentence: from the first to the last of its words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    pub span: Span,
    /// Places of the first and the last of its words in the sentence.
    pub first: usize,
    pub last: usize,
    pub denied: bool,
    /// Said of what this is set against, `unlike the stable position`, or of how it begins, `at first it grows`.
    pub contrasted: bool,
}

impl Phrase {
    /// Split like the prose it is looked for in, so that `doesn't` and `does not` are one.
    pub fn new(text: &str) -> Self {
        let mut all = Vec::new();
        for piece in text.split_whitespace() {
            let (piece, stem) = piece.strip_suffix('*').map_or((piece, false), |stem| (stem, true));
            let first = all.len();
            all.extend(words(piece).into_iter().map(|token| PhraseWord { text: token.text, stem: false }));
            if all.len() > first
                && let Some(last) = all.last_mut()
            {
                last.stem = stem;
            }
        }
        let beginning = |word: &PhraseWord| {
            if word.stem { Beginnings::of_stem(&word.text) } else { Beginnings::of_word(&word.text) }
        };
        let beginnings = all.iter().map(beginning).fold(Beginnings::default(), Beginnings::and);
        Self { words: all, beginnings, between: BETWEEN }
    }

    /// With at most `between` other words between two of its own.
    pub fn with_between(self, between: usize) -> Self {
        Self { between, ..self }
    }

    /// Every place where `sentence` says the phrase: its words in order, a few others at most and no punctuation between
    /// two of them, as close together as they stand.
    pub fn said_in(&self, sentence: &Sentence) -> Vec<Said> {
        if !sentence.may_have(self.beginnings) {
            return Vec::new();
        }
        let mut all: Vec<Vec<usize>> = Vec::new();
        let Some(begins) = self.words.first() else { return Vec::new() };
        let starts = (0..sentence.len()).filter(|&start| begins.matches(&sentence[start]));
        for places in starts.filter_map(|start| self.places(sentence, start)) {
            // Of two that end with the same word the later one is the closer.
            if all.last().is_some_and(|before| before.last() == places.last()) {
                all.pop();
            }
            all.push(places);
        }
        let said = |places: Vec<usize>| {
            let (first, last) = (*places.first()?, *places.last()?);
            let span = Span { start: sentence.get(first)?.span.start, end: sentence.get(last)?.span.end };
            let denied = match stance(sentence, &places) {
                Stance::Claimed => false,
                Stance::Denied => true,
                Stance::Neither => return None,
            };
            Some(Said { span, first, last, denied, contrasted: contrasted(sentence, first) })
        };
        all.into_iter().filter_map(said).collect()
    }

    /// The places of the phrase's words when it begins at `start`, ending as early as it can; `None` when it is not there.
    fn places(&self, sentence: &[Token], start: usize) -> Option<Vec<usize>> {
        // reach[k]: for each place where word k can stand, the place of word k − 1 before it.
        let mut reach: Vec<Vec<(usize, usize)>> = Vec::new();
        for (k, word) in self.words.iter().enumerate() {
            let mut here = Vec::new();
            match k.checked_sub(1).and_then(|before| reach.get(before)) {
                None => {
                    if sentence.get(start).is_some_and(|token| word.matches(token)) {
                        here.push((start, start));
                    }
                }
                Some(before) => {
                    for (from, _) in before {
                        let end = (from + self.between + 2).min(sentence.len());
                        let near = sentence.iter().enumerate().take(end).skip(from + 1);
                        for (place, token) in near.take_while(|(_, token)| token.gap == Gap::Space) {
                            if word.matches(token) && here.iter().all(|(known, _)| *known != place) {
                                here.push((place, *from));
                            }
                        }
                    }
                }
            }
            if here.is_empty() {
                return None;
            }
            reach.push(here);
        }
        let mut places = Vec::new();
        let mut place = reach.last()?.iter().map(|(place, _)| *place).min()?;
        for here in reach.iter().rev() {
            places.push(place);
            place = here.iter().find(|(known, _)| *known == place).map(|(_, from)| *from)?;
        }
        places.reverse();
        Some(places)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stance {
    Claimed,
    Denied,
    /// `does not oscillate for ever`: denies how long, not that it does.
    Neither,
}

/// How far before a phrase a denial reaches, in words between.
const FAR: usize = 3;

/// Words looked at before a phrase; no denial reaches as far, remarks between commas included.
const LONGEST_LOOK: usize = 24;

/// Words that deny what follows them within so many words.
const DENIALS: &[(&str, usize)] = &[
    ("not", FAR),
    ("never", FAR),
    ("neither", FAR),
    ("nor", FAR),
    ("nobody", FAR),
    ("nothing", FAR),
    ("no", 2),
    ("none", 3),
    ("without", 1),
    ("hardly", 2),
    ("scarcely", 2),
    ("barely", 2),
    ("non", 0),
    ("un", 0),
    ("fails", 2),
    ("fail", 2),
    ("failed", 2),
    ("failing", 2),
    ("unable", 2),
    ("refuses", 2),
    ("lack", 2),
    ("lacks", 2),
    ("absence", 2),
];
/// Pairs that deny what follows.
const DENIAL_PAIRS: &[(&str, &str, usize)] = &[
    ("rather", "than", 3),
    ("instead", "of", 3),
    ("far", "from", 2),
    ("free", "of", 2),
    ("free", "from", 2),
    ("impossible", "to", 2),
];
/// After these, `not` and `no` deny nothing: `not only`, `no doubt`.
const NO_DENIAL_BEFORE: &[&str] =
    &["only", "just", "merely", "simply", "doubt", "sooner", "matter", "surprise"];
/// Denied with one of these, it is the extent that is denied.
const EXTENTS: &[&str] = &[
    "forever",
    "ever",
    "always",
    "indefinitely",
    "endlessly",
    "infinitely",
    "permanently",
    "constantly",
    "long",
    "immediately",
    "completely",
    "entirely",
    "fully",
    "exactly",
    "perfectly",
    "quite",
    "necessarily",
];
/// Words that begin a clause of their own.
const CLAUSE_WORDS: &[&str] = &[
    "but",
    "however",
    "although",
    "though",
    "whereas",
    "while",
    "because",
    "since",
    "yet",
    "unless",
    "until",
    "till",
    "when",
    "where",
    "if",
    "which",
    "that",
    "who",
    "then",
    "therefore",
    "thus",
    "hence",
    "instead",
];
/// Before `that`, these take its clause with them: `it is not true that it settles`.
const TAKE_THAT: &[&str] =
    &["true", "case", "likely", "mean", "means", "expect", "think", "believe", "see", "say"];
/// After `and`, these begin a clause with a subject or a verb of its own.
const FRESH_STARTS: &[&str] = &[
    "they",
    "the",
    "a",
    "an",
    "then",
    "we",
    "there",
    "will",
    "would",
    "can",
    "could",
    "finally",
    "eventually",
    "both",
    "he",
    "she",
    "i",
    "one",
    "after",
    "later",
    "now",
    "even",
];
/// After `or`, these begin another case.
const OTHER_CASES: &[&str] = &[
    "it",
    "they",
    "we",
    "there",
    "he",
    "she",
    "i",
    "then",
    "else",
    "otherwise",
    "will",
    "would",
    "can",
    "could",
];
/// Words after which a clause speaks of what this is set against, or of how it only begins.
const CONTRASTS: &[&str] = &["unlike", "whereas", "while", "whilst", "initially"];
/// The same in two words.
const CONTRAST_PAIRS: &[(&str, &str)] = &[
    ("at", "first"),
    ("contrast", "to"),
    ("contrast", "with"),
    ("contrary", "to"),
    ("opposed", "to"),
    ("opposite", "to"),
    ("opposite", "of"),
    ("compared", "to"),
    ("compared", "with"),
    ("comparison", "to"),
    ("comparison", "with"),
];
/// Verbs that may come between a noun and its `not`.
const AUXILIARIES: &[&str] = &[
    "is", "are", "was", "were", "be", "do", "does", "did", "will", "would", "can", "could", "has", "have",
    "had", "may", "should", "must",
];
/// What is denied of a thing when it is said not to be there. `The swing does not last` says that there is one.
const BEING_THERE: &[&str] = &[
    "occur",
    "happen",
    "exist",
    "appear",
    "arise",
    "seen",
    "observed",
    "visible",
    "present",
    "there",
    "possible",
    "found",
    "be",
    "true",
    "noticeable",
    "take",
];

fn stance(sentence: &[Token], places: &[usize]) -> Stance {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else { return Stance::Claimed };
    let within =
        (first..last).filter(|place| !places.contains(place) && denies_within(sentence, *place)).count();
    let before = denials_before(sentence, first);
    let after = usize::from(denied_after(sentence, last));
    if (before + within + after).is_multiple_of(2) {
        return Stance::Claimed;
    }
    let extent = |place: usize| {
        !places.contains(&place)
            && sentence.get(place).is_some_and(|token| EXTENTS.contains(&token.text.as_str()))
    };
    let near_after = (last + 1..=last + 2)
        .take_while(|&place| sentence.get(place).is_some_and(|token| token.gap < Gap::Break));
    let just_before = first.checked_sub(1).is_some_and(extent);
    if just_before || near_after.into_iter().any(extent) || (first..last).any(extent) {
        Stance::Neither
    } else {
        Stance::Denied
    }
}

/// Whether the clause says before `first` that it speaks of something else, or of the beginning: `unlike the …`, `at first …`.
fn contrasted(sentence: &[Token], first: usize) -> bool {
    for place in (first.saturating_sub(LONGEST_LOOK)..first).rev() {
        let (Some(token), Some(next)) = (sentence.get(place), sentence.get(place + 1)) else { return false };
        if next.gap != Gap::Space || matches!(token.text.as_str(), "but" | "however" | "yet") {
            return false;
        }
        let pair = CONTRAST_PAIRS.iter().any(|(one, two)| *one == token.text && *two == next.text);
        if pair || CONTRASTS.contains(&token.text.as_str()) {
            return true;
        }
    }
    false
}

/// A denial between the words of the phrase: `comes not to rest`.
fn denies_within(sentence: &[Token], place: usize) -> bool {
    let word = sentence[place].text.as_str();
    matches!(word, "not" | "never" | "no" | "nor" | "without") && !excused(sentence, place)
}

/// `not only`, `no doubt`.
///
/// Neither does `what the other lacks is` deny what follows: the verb ends the clause.
fn excused(sentence: &[Token], place: usize) -> bool {
    let next = sentence.get(place + 1).map_or("", |next| next.text.as_str());
    let lacks = matches!(sentence[place].text.as_str(), "lack" | "lacks");
    NO_DENIAL_BEFORE.contains(&next) || (lacks && matches!(next, "is" | "are" | "was" | "were"))
}

/// How many denials in the clause before `first` reach it.
fn denials_before(sentence: &[Token], first: usize) -> usize {
    let start = clause_start(sentence, first);
    // `neither … nor` and `not … nor` deny once.
    let start = (start..first).rev().find(|&place| sentence[place].text == "nor").unwrap_or(start);
    (start..first)
        .filter(|&place| {
            let between = first - place - 1;
            let word = sentence[place].text.as_str();
            let single = DENIALS.iter().any(|(denial, reach)| *denial == word && between <= *reach);
            let pair = place > start
                && DENIAL_PAIRS.iter().any(|(one, two, reach)| {
                    *one == sentence[place - 1].text && *two == word && between <= *reach
                });
            (single && !excused(sentence, place)) || pair
        })
        .count()
}

/// Where the clause that contains `place` begins.
fn clause_start(sentence: &[Token], place: usize) -> usize {
    let earliest = place.saturating_sub(LONGEST_LOOK);
    let mut start = place;
    while start > earliest {
        let token = &sentence[start];
        match token.gap {
            Gap::Break | Gap::Sentence => return start,
            Gap::Comma => match parenthesis(sentence, start) {
                // `does not, in general, oscillate`
                Some(opened) => {
                    start = opened;
                    continue;
                }
                None => return start,
            },
            Gap::Space => {}
        }
        if begins_clause(sentence, start, place) {
            return start;
        }
        start -= 1;
    }
    start
}

fn begins_clause(sentence: &[Token], at: usize, place: usize) -> bool {
    let word = |at: usize| sentence.get(at).map_or("", |token| token.text.as_str());
    let before = at.checked_sub(1).map_or("", word);
    match word(at) {
        "that" => !TAKE_THAT.contains(&before),
        // `so it settles`, but not `it will not do so`
        "so" => matches!(word(at + 1), "it" | "the" | "they" | "we" | "that"),
        // `as it settles`, but not `as fast as`
        "as" => matches!(word(at + 1), "it" | "the" | "they" | "we" | "there"),
        "and" => at < place && begins_afresh(word(at + 1)),
        // `or it settles`, but not `or settle`
        "or" => at < place && OTHER_CASES.contains(&word(at + 1)),
        // `not driven it settles`, but not `does not let it settle`
        "it" | "they" | "we" if before != "that" => {
            at < place && (word(at + 1).ends_with('s') || AUXILIARIES.contains(&word(at + 1)))
        }
        one => CLAUSE_WORDS.contains(&one) && !forms_pair(sentence, at),
    }
}

/// `instead of` and `rather than` deny, they do not begin a clause.
fn forms_pair(sentence: &[Token], place: usize) -> bool {
    let next = sentence.get(place + 1).map(|token| token.text.as_str());
    DENIAL_PAIRS.iter().any(|(one, two, _)| *one == sentence[place].text && Some(*two) == next)
}

/// A comma before `place` that closes a remark of a few words, opened by another comma right after a denial: where that
/// comma's word stands.
fn parenthesis(sentence: &[Token], place: usize) -> Option<usize> {
    let opened = (1..place).rev().take(4).find(|&other| sentence[other].gap == Gap::Comma)?;
    let denial = &sentence[opened - 1].text;
    DENIALS.iter().any(|(word, _)| word == denial).then_some(opened - 1)
}

/// After `does not oscillate and …`: whether a new clause begins (`and it settles`, `and comes to rest`), or the denial goes
/// on (`and settle`).
fn begins_afresh(next: &str) -> bool {
    next.ends_with('s') || next.ends_with("ed") || next == "it" || FRESH_STARTS.contains(&next)
}

/// `oscillation is not seen`, `oscillations never occur`.
fn denied_after(sentence: &[Token], last: usize) -> bool {
    let word = |place: usize| {
        sentence.get(place).filter(|token| token.gap == Gap::Space).map_or("", |token| token.text.as_str())
    };
    if !AUXILIARIES.contains(&word(last + 1)) {
        return word(last + 1) == "never" && being_there(word(last + 2));
    }
    match word(last + 2) {
        "not" | "never" => being_there(word(last + 3)),
        "no" => word(last + 3) == "longer" && being_there(word(last + 4)),
        "absent" | "impossible" => true,
        _ => false,
    }
}

fn being_there(verb: &str) -> bool {
    BEING_THERE.iter().any(|one| verb.trim_end_matches(['s']) == one.trim_end_matches('s') || verb == *one)
}

#[cfg(test)]
mod tests {
    use super::super::sentence::sentences;
    use super::*;

    #[track_caller]
    fn check(phrase: &str, rows: &[(&str, &str)]) {
        let phrase = Phrase::new(phrase);
        for (text, want) in rows {
            let said: Vec<_> = sentences(text).iter().flat_map(|sentence| phrase.said_in(sentence)).collect();
            let found: Vec<_> = said
                .iter()
                .map(|said| {
                    format!(
                        "{}{}",
                        if said.denied { "-" } else { "+" },
                        &text[said.span.start..said.span.end]
                    )
                })
                .collect();
            assert_eq!(found.join(" "), *want, "{text:?}");
        }
    }

    #[test]
    fn words_in_order_with_a_few_between() {
        check(
            "swings about",
            &[
                ("It swings about the bottom.", "+swings about"),
                ("It swings back and forth about it.", "+swings back and forth about"),
                ("It swings to the left and right about it.", ""),
                ("About it, it swings.", ""),
                ("It swings. About that.", ""),
                ("Swings, swings about", "+swings about"),
                // the closest words are the phrase
                ("It swings and swings about.", "+swings about"),
            ],
        );
        check(
            "never stop*",
            &[
                ("It never really stops.", "+never really stops"),
                ("Never falling over, and stops in the end.", ""),
                ("It never falls; stops", ""),
                ("It never falls: stops", ""),
                ("It never falls – stops", ""),
                ("It never (falls) stops", ""),
            ],
        );
        check(
            "oscillat*",
            &[
                ("It oscillates; an oscillation", "+oscillates +oscillation"),
                ("Self-oscillating", "+oscillating"),
                ("oscil", ""),
            ],
        );
        check(
            "origin",
            &[
                ("The pole that the other lacks is the origin.", "+origin"),
                ("It lacks an origin.", "-origin"),
                ("It lacks the origin, which is clear.", "-origin"),
            ],
        );
        check("stable", &[("It is unstable.", ""), ("It is stable.", "+stable"), ("UNSTABLE", "")]);
        check("unstable", &[("It is not stable.", "")]);
        check(
            "not stable",
            &[("It is not stable.", "+not stable"), ("It isn't very stable.", "+isn't very stable")],
        );
        check("dead zone", &[("the dead-zone", "+dead-zone"), ("the deadzone", "")]);
        check("", &[("anything", "")]);
    }

    #[test]
    fn a_claim_and_its_denial_are_told_apart() {
        check(
            "settl*",
            &[
                // text, stance
                ("It settles.", "+settles"),
                ("It does not settle.", "-settle"),
                ("It doesn't ever really settle.", "-settle"),
                ("It never settles.", "-settles"),
                ("It fails to settle.", "-settle"),
                ("It will oscillate without settling.", "-settling"),
                ("The motor without the gear quickly settles.", "+settles"),
                ("It neither grows nor settles.", "-settles"),
                ("It does not grow, nor does it settle.", "-settle"),
                ("It neither settles nor grows.", "-settles"),
                ("It keeps going rather than settling.", "-settling"),
                ("It goes on instead of settling.", "-settling"),
                ("It is not true that it settles.", "-settles"),
                // double denial
                ("It cannot fail to settle.", "+settle"),
                ("It never fails to settle.", "+settle"),
                // the denial belongs to another clause
                ("It is not pushed, it settles.", "+settles"),
                ("It does not run away but settles.", "+settles"),
                ("It does not run away; it settles.", "+settles"),
                ("It does not turn over and it settles.", "+settles"),
                ("It does not turn over and comes back, settles.", "+settles"),
                ("Because it is not driven it settles.", "+settles"),
                ("There is nothing that would make it settle.", "+settle"),
                ("It never catches up with the one that settles.", "+settles"),
                ("It will not do so, it settles.", "+settles"),
                // the denial goes on
                ("Friction does not let it settle.", "-settle"),
                ("It will not do so and settle.", "-settle"),
                ("It does not swing and settle.", "-settle"),
                ("It does not, in general, settle.", "-settle"),
                ("It does not swing or settle.", "-settle"),
                // another case
                ("It does not swing or it settles.", "+settles"),
                ("It does not swing or will settle.", "+settle"),
                // no denial at all
                ("It not only swings but also settles.", "+settles"),
                ("No doubt it settles.", "+settles"),
                // the extent is denied
                ("It does not settle immediately.", ""),
                ("It does not fully settle.", ""),
            ],
        );
        check(
            "oscillation*",
            &[
                ("Oscillations are not seen.", "-Oscillations"),
                ("Oscillations do not occur.", "-Oscillations"),
                ("There is no oscillation.", "-oscillation"),
                ("There are no visible oscillations.", "-oscillations"),
                ("Oscillations never occur.", "-Oscillations"),
                ("Oscillation is absent.", "-Oscillation"),
                ("Oscillation is clear.", "+Oscillation"),
                // that it does not last says that there is one
                ("The oscillation does not last.", "+oscillation"),
                ("The oscillation is not only clear but large.", "+oscillation"),
            ],
        );
        check(
            "comes to rest",
            &[("It comes to rest.", "+comes to rest"), ("It comes never to rest.", "-comes never to rest")],
        );
        check("oscillate", &[("It does not oscillate for ever.", "")]);
        check(
            "for ever",
            &[("It won't do so for ever.", "-for ever"), ("It goes on for ever.", "+for ever")],
        );
        check("stable", &[("It is not as stable as the other.", "-stable")]);
    }

    #[test]
    fn what_is_said_of_the_other_is_told_apart() {
        let phrase = Phrase::new("stable");
        for (text, contrasted) in [
            ("Unlike the stable bottom, it falls.", true),
            ("It falls, unlike at the stable bottom.", true),
            ("It falls whereas the other is stable.", true),
            ("While the bottom is stable, it falls.", true),
            ("In contrast to the stable bottom it falls.", true),
            ("Compared to a stable one, it falls.", true),
            ("It falls, as opposed to the stable one.", true),
            ("In contrast, it is stable.", false),
            ("Unlike the bottom, it is stable.", false),
            ("While it swings but it is stable.", false),
            ("It is stable, unlike the other.", false),
            ("At first it is stable and then it falls.", true),
            ("Initially it seems stable.", true),
            ("It is at first unclear, but it is stable.", false),
            ("It is stable.", false),
        ] {
            let said: Vec<_> = sentences(text).iter().flat_map(|sentence| phrase.said_in(sentence)).collect();
            let found: Vec<bool> = said.iter().map(|said| said.contrasted).collect();
            assert_eq!(found, [contrasted], "{text:?}");
        }
    }

    #[test]
    fn phrases_may_deny_by_themselves() {
        check(
            "does not respond",
            &[
                ("It does not respond.", "+does not respond"),
                ("It doesn't respond.", "+doesn't respond"),
                ("It responds.", ""),
            ],
        );
        check("no difference", &[("There is no difference.", "+no difference")]);
    }
}
