//! Whether words are said of the response that is described, as a fact.

use super::phrase::Said;
use super::words::{Gap, Token};

/// What kind of claim the words are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Remark {
    /// Of the system: stable.
    System,
    /// Of how the response goes on: settles.
    Motion,
    /// A value with a verb, whose subject must be the response: `settles at 0`.
    Value,
    /// A value with its name: `the final value is 0`.
    Named,
}

/// A sentence with one of these says what might be.
const CONDITIONS: &[&str] = &[
    "if",
    "unless",
    "suppose",
    "supposing",
    "assuming",
    "imagine",
    "either",
    "whether",
    "perhaps",
    "maybe",
    "possibly",
    "wish",
    "hopefully",
    "supposed",
    "provided",
    "condition",
    "conditions",
    "criterion",
    "definition",
    "means",
    "meaning",
    "depends",
    "depending",
    "wrong",
    "incorrect",
    "mistake",
    "false",
    "impossible",
];
/// These make a clause hypothetical, unless one says or calls it so (`I would call it stable`).
const MODALS: &[&str] = &["would", "could", "should", "might", "may", "must", "ought", "shall"];
const SAYING: &[&str] = &["say", "call", "conclude", "describe", "classify", "consider", "judge", "argue"];
/// A clause with one of these tells what was thought before, unless it was `as expected`.
const EXPECTATIONS: &[&str] = &[
    "expected",
    "expecting",
    "expectation",
    "expectations",
    "thought",
    "assumed",
    "predicted",
    "prediction",
    "anticipated",
    "believed",
    "guessed",
    "guess",
    "hoped",
    "wanted",
    "intended",
    "imagined",
    "claimed",
    "supposed",
];
/// A clause with one of these speaks of another case, another system or another part of the report.
const ELSEWHERE: &[&str] = &[
    "other",
    "others",
    "another",
    "previous",
    "previously",
    "former",
    "latter",
    "unlike",
    "real",
    "reality",
    "practice",
    "ideal",
    "ideally",
    "actual",
    "nonlinear",
    "controller",
    "control",
    "controlled",
    "feedback",
    "closed",
    "open",
    "question",
    "questions",
    "task",
    "part",
    "earlier",
    "general",
    "generally",
    "usually",
    "normally",
    "typically",
    "any",
    "every",
    "systems",
    "otherwise",
    "instead",
    "than",
    "until",
    "before",
];
/// Before `stable` within a few words: what is wanted, or by how much.
const WANTED: &[&str] = &[
    "need",
    "needs",
    "needed",
    "require",
    "requires",
    "required",
    "want",
    "wants",
    "keep",
    "keeps",
    "kept",
    "order",
    "become",
    "becoming",
    "stay",
    "stays",
    "less",
    "more",
    "most",
    "as",
    "almost",
    "nearly",
    "practically",
    "approximately",
    "virtually",
    "quasi",
    "locally",
    "too",
    "barely",
    "hardly",
    "how",
    "degree",
    "towards",
    "called",
];
/// `to be stable` is a wish, but not after these: `seems to be stable`.
const APPEARS: &[&str] = &[
    "seems",
    "seem",
    "appears",
    "appear",
    "found",
    "known",
    "shown",
    "said",
    "out",
    "considered",
    "proves",
    "proved",
    "proven",
    "seen",
    "see",
];
/// A clause with one of these tells only how it begins.
const BEGINNINGS: &[&str] =
    &["first", "initially", "beginning", "start", "early", "short", "while", "moment", "briefly"];
/// What may die away or be zero without the response doing so.
const PARTS: &[&str] = &[
    "term",
    "terms",
    "mode",
    "modes",
    "component",
    "components",
    "part",
    "parts",
    "transient",
    "transients",
    "impulse",
    "force",
    "input",
    "push",
    "controller",
    "error",
    "pole",
    "poles",
    "eigenvalue",
    "eigenvalues",
    "exponential",
    "derivative",
    "numerator",
    "denominator",
    "time",
    "axis",
    "coefficient",
    "coefficients",
    "constant",
];
/// What may go to zero about another value than zero.
const MEASURES: &[&str] = &[
    "amplitude",
    "amplitudes",
    "oscillation",
    "oscillations",
    "envelope",
    "velocity",
    "speed",
    "acceleration",
    "energy",
    "peaks",
    "slope",
    "deviation",
    "difference",
    "frequency",
    "motion",
    "movement",
];

/// Whether `sentence` ends with a question mark.
pub(super) fn is_question(prose: &str, sentence: &[Token], next: Option<&Token>) -> bool {
    let Some(last) = sentence.last() else { return false };
    let end = next.map_or(prose.len(), |next| next.span.start);
    prose.get(last.span.end..end).is_some_and(|after| after.contains('?'))
}

/// Whether what is `said` is said of the response that is described, as a fact.
pub(super) fn speaks_of_it(sentence: &[Token], said: &Said, remark: Remark) -> bool {
    if said.contrasted || sentence.iter().any(|token| CONDITIONS.contains(&token.text.as_str())) {
        return false;
    }
    let word = |place: usize| sentence.get(place).map_or("", |token| token.text.as_str());
    let (start, end) = segment(sentence, said);
    let mut segment = start..end;
    if segment.any(|place| {
        let inside = (said.first..=said.last).contains(&place);
        let one = word(place);
        let hypothetical = MODALS.contains(&one) && !(1..=2).any(|next| SAYING.contains(&word(place + next)));
        let before = |back: usize| place.checked_sub(back).map_or("", word);
        let as_expected = (1..=3).any(|back| matches!(before(back), "as" | "like"));
        let once = EXPECTATIONS.contains(&one) && !as_expected;
        !inside && (hypothetical || once || ELSEWHERE.contains(&one))
    }) {
        return false;
    }
    let before = |most: usize| said.first.saturating_sub(most).max(start)..said.first;
    let subject = || {
        let begins = |place: &usize| {
            sentence[*place].gap >= Gap::Comma
                || matches!(word(*place), "as" | "that" | "which" | "since" | "when")
        };
        (start..=said.first).rev().find(begins).unwrap_or(start)..said.first
    };
    match remark {
        Remark::System => {
            let purpose = before(2).any(|place| {
                word(place) == "to" && matches!(word(place + 1), "be" | "make" | "get" | "keep" | "hold")
            }) && !before(4).any(|place| APPEARS.contains(&word(place)));
            let generic = before(4)
                .any(|place| word(place) == "a" && word(place + 1) == "system" && word(place + 2) == "is");
            let wanted = before(3).any(|place| WANTED.contains(&word(place)));
            let purpose = purpose || before(4).any(|place| word(place) == "to" && word(place + 1) == "make");
            !purpose && !generic && !wanted
        }
        Remark::Motion => {
            !(start..end).any(|place| BEGINNINGS.contains(&word(place)))
                && !subject().any(|place| PARTS.contains(&word(place)))
                && !before(1).any(|place| {
                    matches!(word(place), "almost" | "nearly" | "practically" | "quasi" | "virtually")
                })
        }
        Remark::Value => {
            // `the swings return to zero`, but not `it swings and returns to zero`
            let swing = |place: usize| {
                matches!(word(place), "swing" | "swings")
                    && place > start
                    && matches!(
                        word(place - 1),
                        "the" | "each" | "its" | "these" | "all" | "of" | "a" | "such"
                    )
            };
            !subject()
                .any(|place| PARTS.contains(&word(place)) || MEASURES.contains(&word(place)) || swing(place))
        }
        Remark::Named => !subject().any(|place| PARTS.contains(&word(place)) && word(place) != "impulse"),
    }
}

/// The part of the sentence around what is `said` up to a turn (`but`, `;`): where it begins, and the end it does not reach.
fn segment(sentence: &[Token], said: &Said) -> (usize, usize) {
    let turns = |place: usize| {
        sentence.get(place).is_none_or(|token| {
            token.gap >= Gap::Break
                || matches!(
                    token.text.as_str(),
                    "but"
                        | "however"
                        | "yet"
                        | "whereas"
                        | "though"
                        | "although"
                        | "because"
                        | "so"
                        | "hence"
                        | "thus"
                        | "therefore"
                )
        })
    };
    let start = (0..=said.first).rev().find(|&place| place == 0 || turns(place)).unwrap_or(0);
    let end = (said.last + 1..=sentence.len()).find(|&place| turns(place)).unwrap_or(sentence.len());
    (start, end)
}
