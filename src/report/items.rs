//! The marks of one question, criterion by criterion, as views.

use super::anchor::item_anchor;
use super::ledger::kept_words;
use super::marked_equation;
use super::numbers::typeset;
use super::places;
use super::prose;
use super::quotes::quotes;
use super::view::{BlankView, DiagnosisView, ExplanationView, FollowView, ItemGroup, ItemView, VerdictView};
use crate::grading::{Diagnosis, Guard, ItemScore, QuestionScore, Scorecard, Stance, Verdict};
use crate::lab::{Check, LabDefinition, Question};
use crate::source::sanitize;
use crate::submission::{AnswerValue, Submission};

/// The marks in the order of the criteria; those left blank in a row stand together, since all there is to say of them is that.
pub fn groups(
    lab: &LabDefinition,
    question: &Question,
    score: &QuestionScore,
    scorecard: &Scorecard,
    submission: &Submission,
) -> Vec<ItemGroup> {
    let mut groups: Vec<ItemGroup> = Vec::new();
    let mut last_found = String::new();
    for item in &score.items {
        if is_plainly_blank(item) {
            let blank = blank(item);
            match groups.last_mut() {
                Some(group) if group.item.is_none() => group.blanks.push(blank),
                _ => groups.push(ItemGroup { item: None, blanks: vec![blank] }),
            }
            continue;
        }
        let mut view = view(lab, question, item, scorecard, submission);
        // Criteria that judge the same answer need not repeat it.
        if view.found == last_found {
            view.found.clear();
        } else if !view.found.is_empty() {
            last_found.clone_from(&view.found);
        }
        groups.push(ItemGroup { item: Some(view), blanks: Vec::new() });
    }
    groups
}

fn is_plainly_blank(item: &ItemScore) -> bool {
    item.verdict == Verdict::Blank
        && item.override_reason.is_none()
        && item.follow_through.is_none()
        && item.evidence.phrases.is_empty()
}

fn blank(item: &ItemScore) -> BlankView {
    BlankView {
        anchor: item_anchor(&item.id),
        title: item.title.clone(),
        earned: item.earned.to_string(),
        possible: item.possible.to_string(),
    }
}

fn view(
    lab: &LabDefinition,
    question: &Question,
    item: &ItemScore,
    scorecard: &Scorecard,
    submission: &Submission,
) -> ItemView {
    let criterion = question.criteria.iter().find(|c| c.id == item.id);
    let answer = criterion.and_then(|c| submission.answers.get(&c.field)).and_then(|a| a.value.as_ref().ok());
    let quotes = match answer {
        Some(AnswerValue::Prose(text)) => quotes(text, &item.evidence.phrases),
        _ => Vec::new(),
    };
    // The reason says what the words were taken for; that is repeated only to tell quotations apart.
    let labelled = quotes.iter().all(|q| !q.concept.is_empty())
        && quotes.iter().any(|q| (q.stance, &q.concept) != (quotes[0].stance, &quotes[0].concept));
    let credited = item.follow_through.as_ref().is_some_and(|follow| follow.credited);
    let verdict = match item.verdict {
        Verdict::Right if credited => VerdictView::follows(kept_words(item)),
        verdict => VerdictView::of(verdict),
    };
    let mut view = ItemView {
        anchor: item_anchor(&item.id),
        title: item.title.clone(),
        verdict,
        earned: item.earned.to_string(),
        possible: item.possible.to_string(),
        expected: typeset(&sanitize(&item.evidence.expected)),
        found: typeset(&cropped(&item.evidence.found)),
        reason_html: prose::sentences(&sanitize(&item.evidence.reason)),
        quotes,
        labelled,
        follow: follow(lab, item, scorecard),
        provisional: item.provisional,
        override_reason: item.override_reason.as_deref().map(sanitize),
        place: item.position.map(|p| format!("line {}, column {}", p.line, p.column)),
    };
    // The whole text and what is looked for stand above. The words that count are quoted, so `found` adds nothing; and
    // only beside words that speak against it does it help to be told again what was looked for.
    if criterion.is_some_and(|c| matches!(c.check, Check::Concepts { .. })) && answer.is_some() {
        view.found.clear();
        if item.evidence.phrases.iter().all(|phrase| phrase.stance == Stance::Claims) {
            view.expected.clear();
        }
    }
    view
}

/// How the answer stands to an earlier one.
fn follow(lab: &LabDefinition, item: &ItemScore, scorecard: &Scorecard) -> Option<FollowView> {
    let follow = item.follow_through.as_ref()?;
    let own = &follow.own;
    let words = match (follow.credited, follow.guard) {
        (true, _) if item.verdict == Verdict::Right => String::new(),
        (true, _) => kept_words(item),
        // That it does not follow either stands in the reason.
        (false, Guard::Passed) => return None,
        (false, _) => format!("{own} not followed"),
    };
    let root = places::find(lab, scorecard, &follow.root).map(|place| place.full());
    Some(FollowView { words, root })
}

/// What may have gone wrong on the way to a transfer function.
pub fn diagnosis(lab: &LabDefinition, diagnosis: &Diagnosis) -> DiagnosisView {
    let lead = match diagnosis.explanations.len() {
        0 => format!(
            "No single slip explains what you wrote; {} wrong turns were followed to their end. Going through the \
             derivation line by line, beside the reference, is the way to find it.",
            diagnosis.searched
        ),
        1 => "What you wrote comes out when one follows the equations with this change:".to_owned(),
        _ => "What you wrote comes out when one follows the equations with any one of these changes:"
            .to_owned(),
    };
    let explanations = diagnosis.explanations.iter().map(|e| ExplanationView {
        words_html: prose::sentences(&sanitize(&e.words)),
        equations: marked_equation::of_places(lab, &e.places),
    });
    DiagnosisView { lead, explanations: explanations.collect() }
}

/// What was found, on one line and not longer than a paragraph.
fn cropped(found: &str) -> String {
    const LONGEST: usize = 300;
    let start: String = found.chars().take(LONGEST).collect();
    let more = if start.len() < found.len() { " …" } else { "" };
    format!("{}{more}", sanitize(&start))
}
