//! Words of prose that do not go with the numbers: marked where they stand, and what is against them below.

use super::prose::{Highlight, sentences};
use super::view::{AgainstView, ConflictView};
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
    // Words and what they claim, with all that is against them.
    let mut claims: Vec<(Range<usize>, Vec<&Conflict>)> = Vec::new();
    for conflict in items.iter().filter(judges).flat_map(|item| &item.evidence.conflicts) {
        let bytes = conflict.span.start..conflict.span.end;
        if prose.get(bytes.clone()).is_none_or(str::is_empty) {
            continue;
        }
        match claims.iter_mut().find(|(at, known)| *at == bytes && known[0].claim == conflict.claim) {
            Some((_, known)) if known.iter().any(|one| one.against == conflict.against) => {}
            Some((_, known)) => known.push(conflict),
            None => claims.push((bytes, vec![conflict])),
        }
    }
    claims.sort_by_key(|(bytes, _)| (bytes.start, bytes.end));
    claims.truncate(MOST);
    let mut marks: Vec<Highlight> = Vec::new();
    let mut views = Vec::new();
    for (i, (bytes, conflicts)) in claims.into_iter().enumerate() {
        let number = i + 1;
        views.push(view(number, &prose[bytes.clone()], &conflicts));
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

/// What stands above them.
pub fn title(views: &[ConflictView]) -> &'static str {
    match views.iter().flat_map(|view| &view.against).any(|against| against.own) {
        true => "These words do not go with the numbers:",
        false => "These words do not go with the reference:",
    }
}

fn view(number: usize, words: &str, conflicts: &[&Conflict]) -> ConflictView {
    let start: String = words.chars().take(LONGEST).collect();
    let more = if start.len() < words.len() { "…" } else { "" };
    let claim = conflicts.first().map_or("", |conflict| conflict.claim.as_str());
    let against = conflicts.iter().map(|conflict| AgainstView {
        own: conflict.own,
        who: if conflict.own { "Your own answer" } else { "Reference" },
        words_html: sentences(&sanitize(&conflict.against)),
    });
    ConflictView {
        number,
        words: format!("{}{more}", sanitize(&start)),
        // `unstable` need not be told to mean that it is unstable.
        claim: if claim.ends_with(words) { String::new() } else { sanitize(claim) },
        against: against.collect(),
    }
}
