//! How English sentences are put together. Knows only words.

/// With a capital first letter.
pub(crate) fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// `a, b and c`: joined by commas, and before the last by `word`.
pub(crate) fn listed(parts: &[String], word: &str) -> String {
    match parts {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} {word} {last}", first.join(", ")),
    }
}

/// `1 point`, `0.5 points`.
pub(crate) fn points(points: crate::lab::Points) -> String {
    format!("{points} {}", if points.0.abs() == 100 { "point" } else { "points" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_begin_with_a_capital() {
        for (text, want) in
            [("it swings", "It swings"), ("ängste", "Ängste"), ("2 poles", "2 poles"), ("", "")]
        {
            assert_eq!(capitalized(text), want);
        }
    }

    #[test]
    fn lists_end_in_and() {
        let parts = ["a", "b", "c"].map(str::to_owned);
        for (count, want) in [(0, ""), (1, "a"), (2, "a and b"), (3, "a, b and c")] {
            assert_eq!(listed(&parts[..count], "and"), want);
        }
    }
}
