//! What prose claims, held against the student's own answers and the reference.

use super::grade::{Field, Grader};
use super::mark::Mark;
use super::truth::Truth;
use super::{Conflict, Verdict};
use crate::english::capitalized;
use crate::lab::{Check, Criterion, Described, LabDefinition, Question};
use crate::prose::Claim;
use crate::submission::{AnswerValue, contradicted_claims};

/// Notes at each prose criterion which of the claims cannot be true by other answers of the student's, or by the reference.
///
/// No mark changes: what it is worth is for a person to say.
pub(super) fn note_conflicts(lab: &LabDefinition, grader: &Grader<'_>, marks: &mut [Vec<Mark>]) {
    for (question, marks) in lab.questions.iter().zip(marks) {
        for (index, criterion) in question.criteria.iter().enumerate() {
            let Some(described) = in_charge(question, criterion) else { continue };
            let Some(mark) = marks.get_mut(index).filter(|mark| mark.verdict != Verdict::Blank) else {
                continue;
            };
            mark.evidence.conflicts = conflicts(lab, grader, criterion, described);
        }
    }
}

/// Whether conflicts of its field are noted at this criterion: at those that say which response the prose describes, else at
/// the first. `None` where they are not; the response where the lab names it.
fn in_charge<'a>(question: &'a Question, criterion: &'a Criterion) -> Option<Option<&'a Described>> {
    let Check::Concepts { describes, .. } = &criterion.check else { return None };
    let mut same = question.criteria.iter().filter(|one| one.field == criterion.field);
    match describes {
        Some(described) => Some(Some(described)),
        None => {
            let first = same.clone().find(|one| matches!(one.check, Check::Concepts { .. }))?;
            let none = same.all(|one| !matches!(one.check, Check::Concepts { describes: Some(_), .. }));
            (none && first.id == criterion.id).then_some(None)
        }
    }
}

fn conflicts(
    lab: &LabDefinition,
    grader: &Grader<'_>,
    criterion: &Criterion,
    described: Option<&Described>,
) -> Vec<Conflict> {
    let Field::Value(_, AnswerValue::Prose(prose)) = grader.field(&criterion.field) else {
        return Vec::new();
    };
    let own = contradicted_claims(grader.submission, &lab.sheet, &criterion.field, grader.known)
        .into_iter()
        .map(|one| Conflict { span: one.claim.span, claim: one.claim.words(), against: one.says, own: true });
    let mut all: Vec<Conflict> = own.collect();
    if let Some(described) = described {
        let found = grader.claims_of(prose, described);
        all.extend(found.iter().filter_map(|claim| against_reference(claim, described, grader)));
    }
    // The student's own answer first.
    all.sort_by_key(|conflict| (conflict.span, !conflict.own));
    all
}

/// False for every accepted set of parameter values.
fn against_reference(claim: &Claim, described: &Described, grader: &Grader<'_>) -> Option<Conflict> {
    let truth = Truth::Reference(grader.reference);
    let (responses, words) =
        (truth.responses(&described.of, described.response), truth.stability(&described.of));
    let main = responses.first().zip(words.first())?;
    let false_for_all = responses
        .iter()
        .zip(&words)
        .all(|(response, word)| claim.holds(&response.what.features, *word.what) == Some(false));
    false_for_all.then(|| Conflict {
        span: claim.span,
        claim: claim.words(),
        against: format!("{}.", capitalized(&claim.fact(&main.0.what.features, *main.1.what))),
        own: false,
    })
}
