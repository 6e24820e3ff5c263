use super::escape::is_harmless;
use crate::grading::{PhraseMatch, Stance};
use serde::Serialize;

/// Words of the prose that counted, with a little of what stands around them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quote {
    pub parts: Vec<QuotePart>,
    /// `taken for:`, `speaks against:`
    pub stance: &'static str,
    /// The concept they were taken for.
    pub concept: String,
    /// They deny what was asked for.
    pub against: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QuotePart {
    pub words: String,
    pub marked: bool,
}

const CONTEXT: usize = 48;
const MOST: usize = 8;

/// The matches as quotations, at most eight: those of one concept that stand near each other in one.
pub fn quotes(prose: &str, phrases: &[PhraseMatch]) -> Vec<Quote> {
    let mut groups: Vec<(&PhraseMatch, Vec<(usize, usize)>)> = Vec::new();
    for phrase in phrases {
        let (start, end) = (phrase.span.start, phrase.span.end);
        if prose.get(start..end).is_none_or(str::is_empty) {
            continue;
        }
        let near = |spans: &[(usize, usize)]| {
            spans.iter().any(|(from, to)| start <= to + 2 * CONTEXT && *from <= end + 2 * CONTEXT)
        };
        let same = |of: &PhraseMatch| of.concept == phrase.concept && of.stance == phrase.stance;
        match groups.iter().position(|(of, spans)| same(of) && near(spans)) {
            Some(i) => groups[i].1.push((start, end)),
            None if groups.len() < MOST => groups.push((phrase, vec![(start, end)])),
            None => {}
        }
    }
    groups.into_iter().map(|(of, spans)| quote(prose, of, spans)).collect()
}

fn quote(prose: &str, of: &PhraseMatch, mut spans: Vec<(usize, usize)>) -> Quote {
    spans.sort_unstable();
    let mut merged: Vec<(usize, usize)> = Vec::new();
    for (start, end) in spans {
        match merged.last_mut() {
            Some(last) if start <= last.1 => last.1 = last.1.max(end),
            _ => merged.push((start, end)),
        }
    }
    let mut parts = Vec::new();
    let mut at = 0;
    for (i, (start, end)) in merged.iter().copied().enumerate() {
        let between = if i == 0 { before(&prose[..start]) } else { one_line(&prose[at..start]) };
        parts.push(QuotePart { words: between, marked: false });
        parts.push(QuotePart { words: one_line(&prose[start..end]), marked: true });
        at = end;
    }
    parts.push(QuotePart { words: after(&prose[at..]), marked: false });
    let against = of.stance == Stance::Denies;
    let stance = if against { "speaks against:" } else { "taken for:" };
    Quote { parts, stance, concept: of.concept.clone(), against }
}

/// The last words of `text`.
fn before(text: &str) -> String {
    let from = floor(text, text.len().saturating_sub(CONTEXT));
    if from == 0 {
        return one_line(text);
    }
    let from = from + text[from..].find(char::is_whitespace).map_or(0, |i| i + 1);
    format!("…{}", one_line(&text[from..]))
}

/// The first words of `text`.
fn after(text: &str) -> String {
    let to = floor(text, CONTEXT.min(text.len()));
    if to == text.len() {
        return one_line(text.trim_end());
    }
    let to = text[..to].rfind(char::is_whitespace).unwrap_or(to);
    format!("{}…", one_line(&text[..to]))
}

fn one_line(text: &str) -> String {
    text.replace(|c: char| c.is_control() || !is_harmless(c), " ")
}

/// The last character boundary at or before `index`.
fn floor(text: &str, mut index: usize) -> usize {
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    const PROSE: &str = "We expect it to oscillate\nabout θ = 0 and not to settle. Much later, when nobody looks at it \
                         any more and the lamps are out and the doors are shut and the bus has gone, it must settle.";

    fn at(words: &str, concept: &str, stance: Stance) -> PhraseMatch {
        let start = PROSE.find(words).unwrap();
        PhraseMatch { span: Span { start, end: start + words.len() }, concept: concept.into(), stance }
    }

    /// Quotations as text, marks in square brackets.
    #[track_caller]
    fn check(what: &str, phrases: &[PhraseMatch], want: &[&str]) {
        let shown = |quote: &Quote| {
            let part = |p: &QuotePart| if p.marked { format!("[{}]", p.words) } else { p.words.clone() };
            quote.parts.iter().map(part).collect::<String>()
        };
        assert_eq!(quotes(PROSE, phrases).iter().map(shown).collect::<Vec<_>>(), want, "{what}");
    }

    #[test]
    fn words_are_shown_in_their_place() {
        use Stance::{Claims, Denies};
        let far = PROSE.rfind("settle").unwrap();
        let far =
            PhraseMatch { span: Span { start: far, end: far + 6 }, concept: "s".into(), stance: Claims };
        let off = PhraseMatch { span: Span { start: 42, end: 9_000 }, ..far.clone() };
        let first = "We expect it to [oscillate] about θ = 0 and not to settle. Much later,…";
        check("one", &[at("oscillate", "o", Claims)], &[first]);
        check(
            "near ones of a concept stand together",
            &[at("settle", "s", Claims), at("oscillate", "s", Claims)],
            &[
                "We expect it to [oscillate] about θ = 0 and not to [settle]. Much later, when nobody looks at it any more…",
            ],
        );
        check(
            "overlapping ones are one",
            &[at("to oscillate", "o", Claims), at("oscillate\nabout", "o", Claims)],
            &["We expect it [to oscillate about] θ = 0 and not to settle. Much later, when…"],
        );
        check(
            "for and against stand apart",
            &[at("oscillate", "o", Claims), at("not to settle", "o", Denies)],
            &[
                first,
                "We expect it to oscillate about θ = 0 and [not to settle]. Much later, when nobody looks at it any more…",
            ],
        );
        check(
            "far ones stand apart",
            &[at("oscillate", "s", Claims), far],
            &[first, "…doors are shut and the bus has gone, it must [settle]."],
        );
        check("outside the text", &[off], &[]);
    }

    #[test]
    fn a_quotation_says_what_it_was_taken_for() {
        let quote = &quotes(PROSE, &[at("not to settle", "it settles", Stance::Denies)])[0];
        assert_eq!(
            (quote.stance, quote.concept.as_str(), quote.against),
            ("speaks against:", "it settles", true)
        );
    }
}
