//! Prose as words, each with the bytes it stands on.

use crate::source::Span;
use unicode_normalization::UnicodeNormalization;

/// A word as it is compared: lower case, apostrophes plain, `n't` split off as `not`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    pub text: String,
    pub span: Span,
    /// What stands between this word and the one before it.
    pub gap: Gap,
}

/// The strongest thing that stands before a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gap {
    Space,
    /// `,`
    Comma,
    /// `;`, `:`, a dash, parentheses
    Break,
    /// `.`, `!`, `?`, an empty line, a list item
    Sentence,
}

/// A formula in `$…$` is one word of this text, which no phrase matches.
const FORMULA: &str = "$";
/// A `$` without its partner within so many bytes is a dollar.
const LONGEST_FORMULA: usize = 2_000;
/// What a full stop does not end a sentence after.
const ABBREVIATIONS: &[&str] =
    &["e.g", "i.e", "eg", "ie", "vs", "approx", "fig", "eq", "no", "resp", "ca", "cf"];
/// Written without their apostrophe, as is done in haste.
const BARE_CONTRACTIONS: &[&str] = &[
    "dont", "doesnt", "didnt", "isnt", "wasnt", "arent", "werent", "cant", "wont", "couldnt", "wouldnt",
    "shouldnt", "hasnt", "havent", "hadnt",
];

/// The words of `text` one space apart: what is left when capitals, punctuation and line ends make no difference.
pub fn normalized(text: &str) -> String {
    let word = |token: &Token| match token.text.as_str() {
        FORMULA => text.get(token.span.start..token.span.end).unwrap_or_default().to_owned(),
        word => word.to_owned(),
    };
    words(text).iter().map(word).collect::<Vec<_>>().join(" ")
}

/// The words of `text` in order. Linear in the length of the text.
pub fn words(text: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut gap = Gap::Sentence;
    let mut at = 0;
    while let Some(letter) = text[at..].chars().next() {
        let next = at + letter.len_utf8();
        if letter == '$'
            && let Some(end) = formula_end(text, at)
        {
            found.push(Token { text: FORMULA.to_owned(), span: Span { start: at, end }, gap });
            (gap, at) = (Gap::Space, end);
            continue;
        }
        if is_word(letter) {
            let end = word_end(text, at);
            push_word(&mut found, text, Span { start: at, end }, gap);
            (gap, at) = (Gap::Space, end);
            continue;
        }
        gap = gap.max(separator(text, at, letter, found.last()));
        at = next;
    }
    found
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || is_combining(letter)
}

/// Accents that stand as characters of their own.
fn is_combining(letter: char) -> bool {
    matches!(letter, '\u{300}'..='\u{36f}')
}

fn is_apostrophe(letter: char) -> bool {
    matches!(letter, '\'' | '’' | '‘' | 'ʼ' | '＇')
}

/// Letters with apostrophes inside, or digits with points inside; a digit beside a letter starts a new word (`5V`).
fn word_end(text: &str, start: usize) -> usize {
    let mut letters = text[start..].char_indices().peekable();
    let Some((_, first)) = letters.next() else { return start };
    let number = first.is_numeric();
    let mut end = start + first.len_utf8();
    while let Some((offset, letter)) = letters.next() {
        let joined = if number {
            letter.is_numeric()
                || (matches!(letter, '.' | ',') && letters.peek().is_some_and(|(_, next)| next.is_numeric()))
        } else {
            (is_word(letter) && !letter.is_numeric())
                || (is_apostrophe(letter) && letters.peek().is_some_and(|(_, next)| next.is_alphabetic()))
        };
        if !joined {
            break;
        }
        end = start + offset + letter.len_utf8();
    }
    end
}

fn push_word(found: &mut Vec<Token>, text: &str, span: Span, gap: Gap) {
    // Letters copied from a typeset formula (𝑠𝑖𝑛) and ligatures (ﬁ) are the letters they show.
    let raw = &text[span.start..span.end];
    let plain = if raw.is_ascii() {
        raw.to_ascii_lowercase()
    } else {
        let shown = raw.nfkc().collect::<String>().to_lowercase();
        shown.chars().map(|letter| if is_apostrophe(letter) { '\'' } else { letter }).collect()
    };
    let negated = match plain.strip_suffix("n't") {
        Some("ca") => Some("can".to_owned()),
        Some("wo") => Some("will".to_owned()),
        Some("sha") => Some("shall".to_owned()),
        Some(stem) if !stem.is_empty() => Some(stem.to_owned()),
        _ if plain == "cannot" || plain == "cant" => Some("can".to_owned()),
        _ if plain == "wont" => Some("will".to_owned()),
        _ if BARE_CONTRACTIONS.contains(&plain.as_str()) => plain.strip_suffix("nt").map(str::to_owned),
        _ => None,
    };
    match negated {
        // Both words stand on the bytes of the contraction.
        Some(verb) => {
            found.push(Token { text: verb, span, gap });
            found.push(Token { text: "not".to_owned(), span, gap: Gap::Space });
        }
        None => {
            let bare = plain.strip_suffix("'s").map(str::to_owned).unwrap_or(plain);
            found.push(Token { text: bare, span, gap });
        }
    }
}

fn separator(text: &str, at: usize, letter: char, last: Option<&Token>) -> Gap {
    let after = &text[at + letter.len_utf8()..];
    match letter {
        ',' => Gap::Comma,
        ';' | ':' | '(' | ')' | '[' | ']' | '–' | '—' => Gap::Break,
        '-' if after.starts_with(['-', ' ']) && text[..at].ends_with([' ', '-']) => Gap::Break,
        '!' | '?' | '。' | '…' => Gap::Sentence,
        '.' if ends_sentence(after, last) => Gap::Sentence,
        '\n' if starts_block(after) => Gap::Sentence,
        _ => Gap::Space,
    }
}

/// Whether a full stop ends its sentence: not within `e.g.`; but `5 V.The motor` is two.
fn ends_sentence(after: &str, last: Option<&Token>) -> bool {
    let abbreviated =
        last.is_some_and(|last| ABBREVIATIONS.contains(&last.text.as_str()) || last.text.len() == 1);
    match after.chars().next() {
        None => true,
        Some(next) if next.is_uppercase() => true,
        Some(next) if next.is_alphanumeric() => false,
        Some(_) => {
            // The next sentence begins with a capital where people write capitals; an abbreviation goes on.
            let goes_on = after.trim_start().chars().next().is_some_and(|next| !next.is_uppercase());
            !(abbreviated && goes_on)
        }
    }
}

/// Whether a line begins a paragraph, a list item, a heading or a quotation.
fn starts_block(line: &str) -> bool {
    let line = line.trim_start_matches([' ', '\t', '\r']);
    let numbered = line.trim_start_matches(|c: char| c.is_ascii_digit());
    line.is_empty()
        || line.starts_with(['\n', '#', '>', '|'])
        || ["- ", "* ", "+ ", "• "].iter().any(|item| line.starts_with(item))
        || (numbered.len() < line.len() && (numbered.starts_with(". ") || numbered.starts_with(") ")))
}

/// The end of a formula that opens at `start`: `$x$` or `$$x$$`, as Markdown reads it, within one paragraph.
fn formula_end(text: &str, start: usize) -> Option<usize> {
    let rest = &text[start..];
    let fence = if rest.starts_with("$$") { "$$" } else { "$" };
    let inside = &rest[fence.len()..];
    if fence == "$" && inside.starts_with(char::is_whitespace) {
        return None;
    }
    let reach = &inside[..inside.floor_char_boundary(LONGEST_FORMULA + fence.len())];
    let paragraph = reach.split_once("\n\n").map_or(reach, |(before, _)| before);
    let closes = |end: &usize| {
        let (body, after) = (&inside[..*end], inside[end + fence.len()..].chars().next());
        let single = !body.ends_with(char::is_whitespace)
            && !body.ends_with('\\')
            && !after.is_some_and(|next| next.is_ascii_digit());
        !body.is_empty() && (fence == "$$" || single)
    };
    let end = paragraph.match_indices(fence).map(|(end, _)| end).find(closes)?;
    Some(start + fence.len() + end + fence.len())
}

#[cfg(test)]
mod tests {
    use super::super::sentence::{Sentence, sentences};
    use super::*;

    fn shown(text: &str) -> String {
        let sentence = |sentence: &Sentence| {
            sentence
                .iter()
                .map(|token| match token.gap {
                    Gap::Comma => format!(", {}", token.text),
                    Gap::Break => format!("; {}", token.text),
                    Gap::Space | Gap::Sentence => token.text.clone(),
                })
                .collect::<Vec<_>>()
                .join(" ")
        };
        sentences(text).iter().map(sentence).collect::<Vec<_>>().join(" | ")
    }

    #[track_caller]
    fn check(rows: &[(&str, &str)]) {
        for (text, want) in rows {
            assert_eq!(shown(text), *want, "{text:?}");
        }
    }

    #[test]
    fn words_and_sentences() {
        check(&[
            ("It swings. It stops!", "it swings | it stops"),
            ("It doesn't settle, it can’t.", "it does not settle , it can not"),
            ("It cannot; it wont (dont ask)", "it can not ; it will not ; do not ask"),
            ("a dead-zone at 5V, ±1.5 V", "a dead zone at 5 v , 1.5 v"),
            ("saturated at + 5𝑉.The motor", "saturated at 5 v | the motor"),
            ("about $\\theta = 0$ it rests", "about $ it rests"),
            ("costs $5 and $10 a day", "costs 5 and 10 a day"),
            ("$$a\n=b$$ holds", "$ holds"),
            ("one\n\ntwo", "one | two"),
            ("one\ntwo\n- three\n2. four", "one two | three | 2 four"),
            ("small values, e.g. 5.58, i.e. near 0", "small values , e g 5.58 , i e near 0"),
            ("the motor’s speed", "the motor speed"),
            ("falls – it leaves", "falls ; it leaves"),
            ("𝑡ℎ𝑖𝑠 ﬁts", "this fits"),
            ("", ""),
            ("$", ""),
            ("'' . - $$ \u{0}", ""),
        ]);
    }

    #[test]
    fn capitals_and_punctuation_make_no_difference() {
        for (one, other, same) in [
            ("It swings,\nthen stops.", "it swings - then STOPS!", true),
            ("It doesn't", "it does not", true),
            ("about $x = 0$", "About $x = 0$.", true),
            ("about $x = 0$", "about $x = 1$", false),
            ("it swings", "it stops", false),
        ] {
            assert_eq!(normalized(one) == normalized(other), same, "{one:?} {other:?}");
        }
    }

    #[test]
    fn spans_are_bytes_of_the_text() {
        let text = "Über 5𝑉, doesn’t";
        for token in words(text) {
            let slice = &text[token.span.start..token.span.end];
            assert!(!slice.is_empty(), "{token:?}");
        }
        let last = words(text).pop().unwrap();
        assert_eq!(&text[last.span.start..last.span.end], "doesn’t");
    }

    proptest::proptest! {
        #[test]
        fn any_text_can_be_read(text in "\\PC{0,60}|[$ .a\\n-]{0,40}") {
            let found = words(&text);
            for pair in found.windows(2) {
                proptest::prop_assert!(pair[0].span.start <= pair[1].span.start);
            }
            for token in &found {
                proptest::prop_assert!(text.get(token.span.start..token.span.end).is_some());
            }
        }
    }
}
