//! Prose as sentences.

use super::words::{Gap, Token, words};
use crate::memo::Memo;
use std::ops::Deref;
use std::sync::{Arc, LazyLock};

/// The words of a sentence; at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sentence {
    words: Vec<Token>,
    beginnings: Beginnings,
}

/// The sentences of Markdown `text`, formulas reduced to a single word each. Linear in the length of the text.
///
/// What is asked of one text is asked of its sentences many times over: those of the last few texts are kept.
pub fn sentences(text: &str) -> Arc<Vec<Sentence>> {
    const MOST: usize = 64;
    static KNOWN: LazyLock<Memo<String, Vec<Sentence>>> = LazyLock::new(|| Memo::of(MOST));
    KNOWN.get(text.to_owned(), |text| apart(text))
}

fn apart(text: &str) -> Vec<Sentence> {
    let mut sentences: Vec<Sentence> = Vec::new();
    for word in words(text) {
        let beginning = Beginnings::of_word(&word.text);
        match sentences.last_mut().filter(|_| word.gap != Gap::Sentence) {
            Some(last) => {
                last.beginnings = last.beginnings.and(beginning);
                last.words.push(word);
            }
            None => sentences.push(Sentence { words: vec![word], beginnings: beginning }),
        }
    }
    sentences
}

impl Sentence {
    /// `false` only when a word that begins so is certainly not there.
    pub(super) fn may_have(&self, all: Beginnings) -> bool {
        all.0 & !self.beginnings.0 == 0
    }
}

impl Deref for Sentence {
    type Target = [Token];

    fn deref(&self) -> &[Token] {
        &self.words
    }
}

/// The first two letters of some words, a bit for each pair; several pairs have the same bit.
///
/// With it most phrases need not be looked for in a sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct Beginnings(u128);

impl Beginnings {
    pub fn of_word(word: &str) -> Self {
        let (first, second) = match *word.as_bytes() {
            [] => return Self::default(),
            [only] => (only, 0),
            [first, second, ..] => (first, second),
        };
        Self(1 << ((usize::from(first) * 29 + usize::from(second)) % 128))
    }

    /// Of every word that begins with `stem`; nothing when that is too short to say.
    pub fn of_stem(stem: &str) -> Self {
        if stem.len() < 2 { Self::default() } else { Self::of_word(stem) }
    }

    pub fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_may_be_there() {
        let text = "It swings a while; über kurz the amplitude is 0.5 rad, and décroît vers $x$.";
        let sentence = &sentences(text)[0];
        for word in sentence.iter() {
            assert!(sentence.may_have(Beginnings::of_word(&word.text)), "{word:?}");
            for (end, letter) in word.text.char_indices() {
                let stem = &word.text[..end + letter.len_utf8()];
                assert!(sentence.may_have(Beginnings::of_stem(stem)), "{stem}");
            }
        }
        assert!(!sentence.may_have(Beginnings::of_word("oscillates")));
        assert!(!sentence.may_have(Beginnings::of_word("it").and(Beginnings::of_stem("oscill"))));
    }
}
