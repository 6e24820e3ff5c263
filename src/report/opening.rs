//! A few sentences at the top of a report: what is right, the one thing to look at again, and what it did not cost. Each is
//! put together from the scorecard; where there is nothing to say, nothing is said.

use super::escape::escape;
use super::numbers::counted;
use super::places::{self, Place, question_link};
use super::prose;
use super::view::LinkView;
use crate::grading::{Cause, Diagnosis, Scorecard};
use crate::lab::{LabDefinition, Points};
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

/// The questions with all their points.
fn complete(lab: &LabDefinition, scorecard: &Scorecard) -> Option<String> {
    let scores = scorecard.questions.iter();
    let full: Vec<&str> =
        scores.filter(|q| q.tally.earned == q.tally.possible).map(|q| q.id.as_str()).collect();
    let links: Vec<String> = lab
        .questions
        .iter()
        .filter(|q| full.contains(&q.id.as_str()))
        .map(|q| link(&question_link(q)))
        .collect();
    match links.len() {
        0 => None,
        n if n == lab.questions.len() => Some("Every question has all its points.".to_owned()),
        _ => Some(format!("All points for {}.", listed(&links))),
    }
}

/// The mistake that weighs most among those that can be explained: where, what, and what it did not cost.
fn lesson(lab: &LabDefinition, scorecard: &Scorecard) -> Option<String> {
    let items = scorecard.questions.iter().flat_map(|q| &q.items);
    let explained = items.filter(|i| i.diagnosis.as_ref().is_some_and(|d| !d.explanations.is_empty()));
    let places = explained.filter_map(|item| places::find(lab, scorecard, &item.id));
    let (place, _) = places
        .map(|place| (place, weight(scorecard, &place)))
        .reduce(|most, next| if next.1 > most.1 { next } else { most })?;
    let diagnosis = place.item.diagnosis.as_ref()?;
    let charged = charged(scorecard, &place);
    let mut words =
        format!("Look first at {}. {}", link(&question_link(place.question)), explained_words(diagnosis));
    if charged > Points::ZERO {
        words += &format!(" It cost {} there.", counted(charged, "point"));
    }
    words += &kept(lab, scorecard, &place);
    Some(words)
}

/// What rests on the mistake and was not charged again, by question.
fn kept(lab: &LabDefinition, scorecard: &Scorecard, root: &Place<'_>) -> String {
    let mut questions: Vec<(&str, Points, Vec<String>)> = Vec::new();
    for spared in scorecard.ledger.spared.iter().filter(|spared| in_question(root, &spared.root)) {
        let Some(at) = places::find(lab, scorecard, &spared.item) else { continue };
        let title = link(&at.title());
        match questions.iter_mut().find(|(number, ..)| *number == at.question.number) {
            Some((_, points, titles)) => {
                *points += spared.points;
                titles.push(title);
            }
            None => questions.push((&at.question.number, spared.points, vec![title])),
        }
    }
    if questions.is_empty() {
        return String::new();
    }
    let parts = questions.into_iter().map(|(number, points, titles)| {
        let mut name = String::new();
        escape(&mut name, number);
        format!("{} in {name} ({})", counted(points, "point"), titles.join(", "))
    });
    format!(" It was charged once: what follows from it kept {}.", listed(&parts.collect::<Vec<_>>()))
}

fn explained_words(diagnosis: &Diagnosis) -> String {
    match diagnosis.explanations.as_slice() {
        [one] => format!("What explains it: {}", prose::sentences(&sanitize(&one.words))),
        several => {
            format!("{} mistakes lead to what you wrote alike; they are listed there.", several.len())
        }
    }
}

/// What was lost where nothing, or nothing readable, was written.
fn unanswered(scorecard: &Scorecard) -> Option<String> {
    let lost: Points = scorecard.ledger.lost.iter().map(|loss| loss.points).sum();
    let blank = lost_to(scorecard, |cause| *cause == Cause::Blank);
    let unreadable = lost_to(scorecard, |cause| *cause == Cause::Unreadable);
    let of = |points: Points| {
        if points == lost {
            format!("All {lost} lost points")
        } else {
            format!("{points} of the {lost} lost points")
        }
    };
    let mut words = Vec::new();
    if blank > Points::ZERO {
        words.push(format!("{} stand where nothing was written.", of(blank)));
    }
    if unreadable > Points::ZERO {
        words.push(format!("{} stand where what was written cannot be read.", of(unreadable)));
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

/// `a, b and c`
fn listed(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
