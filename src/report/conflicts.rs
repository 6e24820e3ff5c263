//! Words of prose that do not go with the numbers: marked where they stand, and what is against them below.

use super::prose::{Highlight, sentences};
use super::view::ConflictView;
use crate::grading::{Conflict, ItemScore};
use crate::lab::Question;
use crate::source::sanitize;
use std::ops::Range;

/// More than these are not shown.
const MOST: usize = 12;
const LONGEST: usize = 120;

/// The conflicts found in the field `path`, numbered as they stand in `prose`, each said once; and the words to be marked.
pub fn of_field(
    question: &Question,
    items: &[ItemScore],
    path: &str,
    prose: &str,
) -> (Vec<Highlight>, Vec<ConflictView>) {
    let judges = |item: &&ItemScore| question.criteria.iter().any(|c| c.id == item.id && c.field == path);
    let mut conflicts: Vec<(Range<usize>, &Conflict)> = Vec::new();
    for conflict in items.iter().filter(judges).flat_map(|item| &item.evidence.conflicts) {
        let bytes = conflict.span.start..conflict.span.end;
        let known = conflicts.iter().any(|(at, one)| *at == bytes && one.against == conflict.against);
        if !known && prose.get(bytes.clone()).is_some_and(|words| !words.is_empty()) {
            conflicts.push((bytes, conflict));
        }
    }
    conflicts.sort_by_key(|(bytes, _)| (bytes.start, bytes.end));
    conflicts.truncate(MOST);
    let mut marks: Vec<Highlight> = Vec::new();
    let mut views = Vec::new();
    for (i, (bytes, conflict)) in conflicts.into_iter().enumerate() {
        let number = i + 1;
        views.push(view(number, &prose[bytes.clone()], conflict));
        match marks.last_mut() {
            // Words that overlap are marked as one.
            Some(last) if bytes.start < last.bytes.end => {
                last.bytes.end = last.bytes.end.max(bytes.end);
                last.label += &format!(", {number}");
            }
            _ => marks.push(Highlight { bytes, label: number.to_string() }),
        }
    }
    (marks, views)
}

fn view(number: usize, words: &str, conflict: &Conflict) -> ConflictView {
    let start: String = words.chars().take(LONGEST).collect();
    let more = if start.len() < words.len() { "…" } else { "" };
    ConflictView {
        number,
        words: format!("{}{more}", sanitize(&start)),
        claim: sanitize(&conflict.claim),
        against_html: sentences(&sanitize(&conflict.against)),
        with: if conflict.own { "your own answer" } else { "the reference" },
    }
}
