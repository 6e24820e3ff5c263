//! A record and a class to begin with.

use super::{ClassMarks, Person, Why};
use crate::class::Record;
use crate::lab::Points;

/// (id, name, mark in hundredths of 100 points) of each.
pub fn class(people: &[(&str, &str, Result<i64, Why>)]) -> ClassMarks {
    let people = people.iter().map(|(id, name, mark)| Person {
        id: (*id).to_owned(),
        name: (*name).to_owned(),
        roster: None,
        handed_in: None,
        file: format!("{id}.yaml"),
        mark: mark.clone().map(Points),
        by_question: "a<b: 1 of 2; c: 3 of 4".to_owned(),
    });
    ClassMarks { people: people.collect(), out_of: Points(10_000), of_nobody: Vec::new() }
}

/// 2.5 of 4 and 2 of 2 in the question `q`, 3 of 3 observed; a mark of 7.5 of 10.
pub fn record(id: &str, name: &str) -> Record {
    let line = serde_json::json!({
        "submission": id, "file": format!("{id}.yaml"), "students": [{"id": id, "name": name}],
        "total": {"earned": 4.5, "possible": 6, "provisional": 0},
        "questions": [{"id": "q", "earned": 4.5, "possible": 6, "provisional": 0}],
        "items": [item("q.a", 2.5, 4.0, "partly"), item("q.b", 2.0, 2.0, "right")],
        "observed": [{"id": "tidy", "earned": 3, "possible": 3}],
        "cover": [{"id": "questions", "earned": 4.5, "possible": 7}, {"id": "rows", "earned": 3, "possible": 3}],
        "cover_total": 7.5, "ledger": {"lost": [], "spared": []}, "findings": [], "report": format!("reports/{id}.html")
    });
    Record::from_line(&line.to_string()).unwrap()
}

fn item(id: &str, earned: f64, possible: f64, verdict: &str) -> serde_json::Value {
    serde_json::json!({
        "id": id, "earned": earned, "possible": possible, "verdict": verdict, "code": "code", "provisional": false,
        "alike": null, "evidence": {"expected": "e", "found": "", "reason": "because", "conflicts": []},
        "line": null, "column": null, "diagnosis": null, "follow_through": null
    })
}
