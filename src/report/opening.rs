//! A few sentences at the top of a report: what is right, the one thing to look at again, and what it did not cost. Each is
//! put together from the scorecard; where there is nothing to say, nothing is said.

use super::escape::escape;
use super::ledger::guard_words;
use super::numbers::counted;
use super::places::{self, Place, question_link};
use super::prose;
use super::view::LinkView;
use crate::english::listed;
use crate::grading::{Cause, Guard, ItemScore, Scorecard};
use crate::lab::{LabDefinition, Points, Question};
use crate::source::sanitize;

/// Paragraphs as HTML.
pub fn paragraphs(lab: &LabDefinition, scorecard: &Scorecard) -> Vec<String> {
    let parts = [total(scorecard), complete(lab, scorecard), lesson(lab, scorecard), unanswered(scorecard)];
    parts.into_iter().flatten().collect()
}

fn total(scorecard: &Scorecard) -> Option<String> {
    let total = &scorecard.total;
    let mut words =
        format!("<strong>{} of {}</strong> points in the questions.", total.earned, total.possible);
    if total.provisional > Points::ZERO {
        let points = total.provisional;
        words += &match points == total.earned {
            true => " A person has yet to confirm them.".to_owned(),
            false => format!(" A person has yet to confirm {points} of them."),
        };
    }
    let open = lost_to(scorecard, |cause| *cause == Cause::Unmarked);
    if open > Points::ZERO {
        words += &format!(" Another {} wait for a person to be given.", counted(open, "point"));
    }
    Some(words)
}

/// The questions with all their points, or, when they are fewer, those without.
fn complete(lab: &LabDefinition, scorecard: &Scorecard) -> Option<String> {
    let is_full = |id: &str| {
        let score = scorecard.questions.iter().find(|q| q.id == id);
        score.is_some_and(|q| q.tally.earned == q.tally.possible)
    };
    let (full, rest): (Vec<&Question>, Vec<&Question>) = lab.questions.iter().partition(|q| is_full(&q.id));
    let links = |questions: &[&Question]| {
        listed(&questions.iter().map(|q| link(&question_link(q))).collect::<Vec<_>>(), "and")
    };
    match (full.len(), rest.len()) {
        (0, _) => None,
        (_, 0) => Some("Every question has all its points.".to_owned()),
        (full, missing) if missing < full => {
            Some(format!("Every question but {} has all its points.", links(&rest)))
        }
        _ => Some(format!("All points for {}.", links(&full))),
    }
}

/// The mistake that weighs most among those that can be explained or on which something rests: where, what, and what it did
/// and did not cost elsewhere.
fn lesson(lab: &LabDefinition, scorecard: &Scorecard) -> Option<String> {
    let explained = |item: &ItemScore| item.diagnosis.as_ref().is_some_and(|d| !d.explanations.is_empty());
    let is_root = |item: &ItemScore| scorecard.ledger.spared.iter().any(|spared| spared.root == item.id);
    let items = scorecard.questions.iter().flat_map(|q| &q.items);
    let places = items
        .filter(|item| explained(item) || is_root(item))
        .filter_map(|item| places::find(lab, scorecard, &item.id));
    let (place, _) = places
        .map(|place| (place, weight(scorecard, &place)))
        .reduce(|most, next| if next.1 > most.1 { next } else { most })?;
    let diagnosis = place.score.items.iter().find(|item| explained(item)).and_then(|i| i.diagnosis.as_ref());
    let words = match diagnosis.map(|d| d.explanations.as_slice()) {
        Some([one]) => format!("What explains it: {}", prose::sentences(&sanitize(&one.words))),
        Some([_, _, ..]) => {
            "Several mistakes lead to what you wrote alike; they are listed there.".to_owned()
        }
        _ => prose::sentences(&sanitize(&place.item.evidence.reason)),
    };
    let mut words = format!("Look first at {}. {words}", link(&question_link(place.question)));
    // Reasons that are not released leave nothing.
    words.truncate(words.trim_end().len());
    let charged = charged(scorecard, &place);
    let kept = kept(lab, scorecard, &place);
    words += &match (charged > Points::ZERO, kept) {
        (true, Some(kept)) => {
            format!(" It cost {} there and was not charged again: {kept}", counted(charged, "point"))
        }
        (true, None) => format!(" It cost {} there.", counted(charged, "point")),
        (false, Some(kept)) => format!(" It was charged once: {kept}"),
        (false, None) => String::new(),
    };
    let refused = scorecard.ledger.lost.iter().filter_map(|loss| match &loss.cause {
        Cause::Refused { root, guard } if in_question(&place, root) => Some((loss.points, *guard)),
        _ => None,
    });
    let refused: Vec<(Points, Guard)> = refused.collect();
    if let Some((_, guard)) = refused.first() {
        let points = counted(refused.iter().map(|(points, _)| *points).sum::<Points>(), "point");
        words += &format!(" With it went {points} of what rests on it, since {}.", guard_words(*guard));
    }
    Some(words)
}

/// What rests on the mistake and was not charged again, by question; `None` when there is nothing.
fn kept(lab: &LabDefinition, scorecard: &Scorecard, root: &Place<'_>) -> Option<String> {
    let mut total = Points::ZERO;
    let mut questions: Vec<(&str, Vec<String>)> = Vec::new();
    for spared in scorecard.ledger.spared.iter().filter(|spared| in_question(root, &spared.root)) {
        let Some(at) = places::find(lab, scorecard, &spared.item) else { continue };
        total += spared.points;
        let title = link(&at.title());
        match questions.iter_mut().find(|(number, _)| *number == at.question.number) {
            Some((_, titles)) => titles.push(title),
            None => questions.push((&at.question.number, vec![title])),
        }
    }
    let were = if total == Points(100) { "was" } else { "were" };
    let parts = questions.iter().map(|(number, titles)| {
        let mut name = String::new();
        escape(&mut name, number);
        format!("{name} ({})", titles.join(", "))
    });
    let parts = parts.collect::<Vec<_>>();
    (!parts.is_empty())
        .then(|| format!("{} {were} kept in {}.", counted(total, "point"), listed(&parts, "and")))
}

/// What was lost where nothing, or nothing readable, was written.
fn unanswered(scorecard: &Scorecard) -> Option<String> {
    let lost: Points = scorecard.ledger.lost.iter().map(|loss| loss.points).sum();
    let blank = lost_to(scorecard, |cause| *cause == Cause::Blank);
    let unreadable = lost_to(scorecard, |cause| *cause == Cause::Unreadable);
    let of = |points: Points| match points == lost {
        true => format!("all {lost} lost points"),
        false => format!("{points} of the {lost} lost points"),
    };
    let mut words = Vec::new();
    if blank > Points::ZERO {
        words.push(format!("Left blank: {}.", of(blank)));
    }
    if unreadable > Points::ZERO {
        words.push(format!("Written, but not readable: {}.", of(unreadable)));
    }
    (!words.is_empty()).then(|| words.join(" "))
}

fn lost_to(scorecard: &Scorecard, cause: impl Fn(&Cause) -> bool) -> Points {
    scorecard.ledger.lost.iter().filter(|loss| cause(&loss.cause)).map(|loss| loss.points).sum()
}

/// What a mistake cost at its own question, and would have cost elsewhere.
fn weight(scorecard: &Scorecard, place: &Place<'_>) -> Points {
    let spared = scorecard.ledger.spared.iter().filter(|spared| in_question(place, &spared.root));
    charged(scorecard, place) + spared.map(|spared| spared.points).sum()
}

fn charged(scorecard: &Scorecard, place: &Place<'_>) -> Points {
    let lost = scorecard.ledger.lost.iter().filter(|loss| in_question(place, &loss.item));
    lost.map(|loss| loss.points).sum()
}

fn in_question(place: &Place<'_>, item: &str) -> bool {
    place.score.items.iter().any(|i| i.id == item)
}

fn link(to: &LinkView) -> String {
    let mut words = String::new();
    escape(&mut words, &to.words);
    format!("<a href=\"#{}\">{words}</a>", to.anchor)
}
