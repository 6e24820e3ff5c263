//! Marks where it is in doubt whose numbers an answer is to be judged by: left to a person, never a zero.

use super::grade::{Field, Grader, marks, scorecard};
use super::known::Known;
use super::mark::{Mark, beginning};
use super::{Catalogue, Evidence, HandMarks, Scorecard, Verdict};
use crate::english::listed;
use crate::lab::{Check, Criterion, LabDefinition};
use crate::reference::Reference;
use crate::source::sanitize;
use crate::submission::Submission;
use std::collections::BTreeSet;

/// How a submission comes out by the numbers of another member of its group.
#[derive(Clone, Debug)]
pub struct MemberCard {
    pub id: String,
    pub scorecard: Scorecard,
}

/// Marks a submission of a lab whose numbers differ from student to student, when it is not known whose it is: what those
/// numbers decide is left to a person, everything else is marked as usual.
pub fn grade_without_numbers(
    known: &Known,
    lab: &LabDefinition,
    reference: &Reference,
    catalogue: &Catalogue,
    submission: &Submission,
    hand: Option<&HandMarks>,
) -> Scorecard {
    let grader = Grader { known, reference, catalogue, submission, sheet: &lab.sheet };
    let mut alike = lab.clone();
    for question in &mut alike.questions {
        question.criteria.retain(|criterion| !lab.judges_varied(criterion));
    }
    let marked = marks(&alike, &grader, hand);
    let all = lab.questions.iter().zip(marked).map(|(question, marked)| {
        let mut marked = marked.into_iter();
        let mark = |criterion: &Criterion| match lab.judges_varied(criterion) {
            true => unknown(&grader, criterion),
            false => marked.next().unwrap_or_else(|| unknown(&grader, criterion)),
        };
        question.criteria.iter().map(mark).collect()
    });
    scorecard(lab, submission, hand, all.collect())
}

fn unknown(grader: &Grader<'_>, criterion: &Criterion) -> Mark {
    let data = match &criterion.check {
        Check::Plot { data: Some(data), .. } => grader.field(data),
        _ => Field::Blank,
    };
    let field = match grader.field(&criterion.field) {
        Field::Blank => data,
        field => field,
    };
    match field {
        Field::Value(answer, _) => left(
            "variant.unknown",
            beginning(&answer.text),
            "Every student has numbers of their own in this lab, and it is not known whose answer this is: the file gives no \
             student id. A person will mark it."
                .to_owned(),
        ),
        Field::Blank | Field::Unreadable(..) => grader.without_value(criterion, String::new()),
    }
}

/// Marks a group's submission by the numbers of its first member, which `lab` and `reference` have; an answer that is not
/// right by them, but by the numbers of another member, is left to a person.
pub fn grade_beside_members(
    known: &Known,
    lab: &LabDefinition,
    reference: &Reference,
    catalogue: &Catalogue,
    submission: &Submission,
    hand: Option<&HandMarks>,
    members: &[MemberCard],
) -> Scorecard {
    let grader = Grader { known, reference, catalogue, submission, sheet: &lab.sheet };
    let mut all = marks(lab, &grader, hand);
    for (question, marks) in lab.questions.iter().zip(&mut all) {
        for (criterion, mark) in question.criteria.iter().zip(marks) {
            if !matches!(mark.verdict, Verdict::Wrong | Verdict::Partly) {
                continue;
            }
            let theirs: BTreeSet<String> = members
                .iter()
                .filter(|member| is_right(&member.scorecard, &criterion.id))
                .map(|member| format!("`{}`", sanitize(&member.id)))
                .collect();
            if !theirs.is_empty() {
                let theirs: Vec<String> = theirs.into_iter().collect();
                let first = submission.students.first().map_or("", |student| student.id.as_str());
                let reason = format!(
                    "A group is marked by the numbers of the first student listed, `{}`. By those this is not right, but by \
                     the numbers of {} it is. A person will mark it.",
                    sanitize(first),
                    listed(&theirs, "and")
                );
                let kept = mark.evidence.clone();
                let left = left("variant.member", kept.found.clone(), reason);
                *mark = Mark { evidence: Evidence { reason: left.evidence.reason.clone(), ..kept }, ..left };
            }
        }
    }
    scorecard(lab, submission, hand, all)
}

fn is_right(card: &Scorecard, criterion: &str) -> bool {
    let mut items = card.questions.iter().flat_map(|question| &question.items);
    items.any(|item| item.id == criterion && item.verdict == Verdict::Right && item.follow_through.is_none())
}

fn left(code: &'static str, found: String, reason: String) -> Mark {
    Mark { code, ..Mark::unmarked(String::new(), found, reason) }
}
