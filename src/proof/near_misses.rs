use super::Check;
use crate::grading::{Catalogue, Scorecard, grade};
use crate::lab::{LabDefinition, NearMiss, Points};
use crate::reference::Reference;

/// Each near miss is marked by itself, and must earn what the lab says: tolerances and partial points hold as they are meant.
pub(super) fn near_misses(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let failed: Vec<Check> = lab.near_misses.iter().filter_map(|miss| failed(lab, reference, miss)).collect();
    if !failed.is_empty() || lab.near_misses.is_empty() {
        return failed;
    }
    vec![Check {
        what: "near misses".to_owned(),
        found: format!("{} answers that are not quite right earn what they must", lab.near_misses.len()),
        holds: true,
        span: None,
    }]
}

fn failed(lab: &LabDefinition, reference: &Reference, miss: &NearMiss) -> Option<Check> {
    let card = grade(lab, reference, &Catalogue::default(), &miss.submission(lab), None);
    let (earned, items) = of_question(&card, &miss.question);
    (earned != miss.points).then(|| {
        let why = if miss.why.is_empty() { String::new() } else { format!(" ({})", miss.why) };
        Check {
            what: format!("near miss of `{}`", miss.question),
            found: format!("must earn {}{why}, and earns {earned}: {items}", miss.points),
            holds: false,
            span: Some(miss.span),
        }
    })
}

/// What a question earns, and by which items.
fn of_question(card: &Scorecard, question: &str) -> (Points, String) {
    let items = || card.questions.iter().filter(|one| one.id == question).flat_map(|one| &one.items);
    let listed: Vec<String> = items()
        .map(|item| format!("{} {} of {} ({})", item.id, item.earned, item.possible, item.code))
        .collect();
    (items().map(|item| item.earned).sum(), listed.join(", "))
}
