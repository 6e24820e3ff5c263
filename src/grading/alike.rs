use super::mark::Mark;
use super::{Stance, Verdict};
use crate::lab::{Check, Criterion};
use crate::prose::normalized;
use crate::submission::{AnswerValue, Submission};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;

/// Hexadecimal digits of an id: of 3,000 groups of one criterion, two meet by chance once in a thousand classes.
const DIGITS: usize = 8;

/// The group of like answers that `mark` belongs to, when a person has yet to confirm it and one decision can serve all of
/// them: `said-3f2a91c0`, `text-…`, `figure-…`.
///
/// It depends on the criterion, the mark's code and what is listed here, and on nothing else of the submission or the class:
///
/// - `said`: prose in which words were found: which concepts are claimed and which denied, and its conflicts;
/// - `text`: prose in which none were found: its words, whatever the capitals and the punctuation, and its conflicts;
/// - `figure`: a figure without data.
///
/// The digits are the first of the SHA-256 of these parts in this order, each as UTF-8 after its length in bytes as eight
/// bytes, least significant first.
pub(super) fn group(criterion: &Criterion, mark: &Mark, submission: &Submission) -> Option<String> {
    if !mark.provisional {
        return None;
    }
    let judged = mark.verdict != Verdict::Unmarked;
    let mut parts = vec![criterion.id.clone(), mark.code.to_owned()];
    let kind = match &criterion.check {
        Check::Concepts { .. } => {
            let evidence = &mark.evidence;
            let said: BTreeSet<String> = evidence
                .phrases
                .iter()
                .map(|found| {
                    let sign = if found.stance == Stance::Claims { '+' } else { '-' };
                    format!("{sign}{}", found.concept)
                })
                .collect();
            let conflicts: BTreeSet<String> = evidence
                .conflicts
                .iter()
                .map(|one| format!("{} {}", if one.own { "own" } else { "reference" }, one.claim))
                .collect();
            let found = !said.is_empty();
            if found {
                parts.push(said.len().to_string());
                parts.extend(said);
            } else {
                let answer = submission.answers.get(&criterion.field)?;
                let Ok(AnswerValue::Prose(prose)) = &answer.value else { return None };
                parts.push(normalized(prose));
            }
            parts.extend(conflicts);
            if found { "said" } else { "text" }
        }
        Check::Plot { .. } if judged => "figure",
        _ => return None,
    };
    Some(format!("{kind}-{}", digits(&parts)))
}

fn digits(parts: &[String]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    let hex: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    hex.chars().take(DIGITS).collect()
}
