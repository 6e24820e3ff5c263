//! Where each point went, and what was not charged twice, as a view.

use super::numbers::counted;
use super::places::{self, Place};
use super::view::LinkView;
use crate::grading::{Cause, Guard, ItemScore, Loss, Scorecard, Verdict};
use crate::lab::{LabDefinition, Points};
use serde::Serialize;

#[derive(Serialize)]
pub struct LedgerView {
    /// Instead of a table, when nothing was lost, or nothing was written that can be marked.
    pub in_a_word: Option<String>,
    pub rows: Vec<LossRow>,
    pub lost: String,
    /// `45 − 25.5 earned`
    pub sum: String,
    pub spared: Vec<SparedView>,
}

/// What was lost at one question for one cause.
#[derive(Serialize)]
pub struct LossRow {
    pub question: String,
    pub items: Vec<LinkView>,
    pub points: String,
    pub why: Why,
}

/// A cause in words, about a link to the criterion it goes back to.
#[derive(Clone, PartialEq, Serialize)]
pub struct Why {
    pub before: String,
    pub root: Option<LinkView>,
    pub after: String,
}

/// A mistake that was charged once, and what else rests on it.
#[derive(Serialize)]
pub struct SparedView {
    pub root: LinkView,
    pub kept: Vec<KeptView>,
    /// `1.5 points`
    pub total: String,
}

/// What kept its points at one question for one reason.
#[derive(Serialize)]
pub struct KeptView {
    pub question: String,
    pub items: Vec<(LinkView, String)>,
    /// `right for your own transfer function`
    pub why: String,
}

/// `None` when the losses do not add up to what was not earned: a table that is wrong explains nothing.
pub fn view(lab: &LabDefinition, scorecard: &Scorecard) -> Option<LedgerView> {
    let ledger = &scorecard.ledger;
    let total = &scorecard.total;
    let mut rows: Vec<(LossRow, Points)> = Vec::new();
    for loss in &ledger.lost {
        let Some(place) = places::find(lab, scorecard, &loss.item) else { continue };
        let why = why(lab, scorecard, loss, place.item);
        match rows.iter_mut().find(|(row, _)| row.question == place.question.number && row.why == why) {
            Some((row, points)) => {
                row.items.push(place.title());
                *points += loss.points;
                row.points = points.to_string();
            }
            None => rows.push((row(&place, loss.points, why), loss.points)),
        }
    }
    let lost: Points = rows.iter().map(|(_, points)| *points).sum();
    if lost != total.possible - total.earned {
        return None;
    }
    Some(LedgerView {
        in_a_word: in_a_word(scorecard),
        lost: lost.to_string(),
        sum: format!("{} possible − {} earned", total.possible, total.earned),
        rows: rows.into_iter().map(|(row, _)| row).collect(),
        spared: spared(lab, scorecard),
    })
}

fn in_a_word(scorecard: &Scorecard) -> Option<String> {
    let total = &scorecard.total;
    let all = counted(total.possible, "point");
    let only = |cause: Cause| scorecard.ledger.lost.iter().all(|loss| loss.cause == cause);
    if total.earned == total.possible {
        Some(format!("Nowhere: all {all} were earned."))
    } else if total.earned > Points::ZERO {
        None
    } else if only(Cause::Blank) {
        Some(format!("Nothing was written: all {all}."))
    } else if only(Cause::Unreadable) {
        Some(format!("Nothing could be read: all {all}."))
    } else {
        None
    }
}

fn row(place: &Place<'_>, points: Points, why: Why) -> LossRow {
    let question = place.question.number.clone();
    LossRow { question, items: vec![place.title()], points: points.to_string(), why }
}

fn why(lab: &LabDefinition, scorecard: &Scorecard, loss: &Loss, item: &ItemScore) -> Why {
    let alone = |words: &str| Why { before: words.to_owned(), root: None, after: String::new() };
    let about = |before: &str, root: &str, after: String| Why {
        before: before.to_owned(),
        root: places::find(lab, scorecard, root).map(|place| place.full()),
        after,
    };
    match &loss.cause {
        Cause::Here if item.provisional => alone(&format!("{}; to be confirmed", mistake_words(item))),
        Cause::Here => alone(mistake_words(item)),
        Cause::Blank => alone("left blank"),
        Cause::Unreadable => alone("cannot be read; see the finding"),
        Cause::Unmarked => alone("not given yet: a person has to mark it"),
        Cause::ByHand => alone("decided by a person"),
        Cause::Part { root } => {
            about("follows from the mistake at ", root, ", which earns a part of the points".to_owned())
        }
        Cause::Refused { root, guard } => about(
            "would follow from the mistake at ",
            root,
            match guard_words(*guard) {
                "" => String::new(),
                words => format!(", but {words}"),
            },
        ),
    }
}

/// A mistake made at a criterion, in a few words; its reason stands at the criterion.
fn mistake_words(item: &ItemScore) -> &'static str {
    match (item.code, item.verdict) {
        ("concepts.missing", _) => "not found in your text",
        (code, _) if code.starts_with("concepts.") => "your text says otherwise",
        (_, Verdict::Partly) => "a mistake here; the rest of its points were earned",
        _ => "a mistake here",
    }
}

/// Why an earlier answer is not followed, as the end of a sentence; empty when it is.
pub fn guard_words(guard: Guard) -> &'static str {
    match guard {
        Guard::Passed => "",
        Guard::Order => "that answer is not of the order asked for",
        Guard::Trivial => "that answer is too simple to show anything",
        Guard::OtherPoint => "that answer belongs to another operating point",
    }
}

/// What was not charged a second time, by the mistake it goes back to.
fn spared(lab: &LabDefinition, scorecard: &Scorecard) -> Vec<SparedView> {
    let mut groups: Vec<(&str, Points, SparedView)> = Vec::new();
    for spared in &scorecard.ledger.spared {
        let (Some(root), Some(place)) =
            (places::find(lab, scorecard, &spared.root), places::find(lab, scorecard, &spared.item))
        else {
            continue;
        };
        let item = (place.title(), spared.points.to_string());
        let (question, why) = (place.question.number.clone(), kept_words(place.item));
        match groups.iter_mut().find(|(id, ..)| *id == spared.root) {
            Some((_, points, group)) => {
                match group.kept.iter_mut().find(|kept| kept.question == question && kept.why == why) {
                    Some(kept) => kept.items.push(item),
                    None => group.kept.push(KeptView { question, items: vec![item], why }),
                }
                *points += spared.points;
                group.total = counted(*points, "point");
            }
            None => {
                let total = counted(spared.points, "point");
                let kept = vec![KeptView { question, items: vec![item], why }];
                let group = SparedView { root: root.full(), kept, total };
                groups.push((&spared.root, spared.points, group));
            }
        }
    }
    groups.into_iter().map(|(_, _, group)| group).collect()
}

/// Why points were kept though the answer is wrong by the reference.
pub fn kept_words(item: &ItemScore) -> String {
    match &item.follow_through {
        Some(_) if item.code.ends_with(".same_mistake") => "the same mistake, charged once".to_owned(),
        Some(follow) => format!("right for {}", follow.own),
        None => "it follows from that".to_owned(),
    }
}
