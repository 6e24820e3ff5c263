//! What a class did, gathered one record at a time. Sums, counts and short lists only: memory does not grow with the class,
//! but for a few bytes a record.

mod answers_alike;
mod attainment;
mod classes;
mod items;
mod mistakes;

pub use answers_alike::AnswersAlike;
pub use attainment::Attainments;
pub use classes::Classes;
pub use items::ItemAnalysis;
pub use mistakes::Mistakes;

use super::record::{Record, Status};

/// Whether a record says something about the questions: it was handed in, counts, and at least one criterion could be judged.
///
/// What nobody handed in, what could not be read as a whole, and what polemark left to a person as a whole do not.
pub fn says_something(record: &Record) -> bool {
    record.status == Status::Marked
        && record.items.iter().any(|item| !matches!(item.verdict.as_str(), "unmarked" | "unreadable"))
}

#[cfg(test)]
mod samples {
    use crate::class::Record;
    use serde_json::{Value, json};

    /// A criterion worth a point, answered `found`.
    pub fn item(id: &str, verdict: &str, found: &str) -> Value {
        let earned = if verdict == "right" { 1.0 } else { 0.0 };
        json!({"id": id, "earned": earned, "possible": 1, "verdict": verdict, "code": "value.differs",
            "provisional": false, "alike": null, "line": null, "column": null, "diagnosis": null, "follow_through": null,
            "evidence": {"expected": "", "found": found, "reason": "", "conflicts": []}})
    }

    /// A criterion worth a point that earned so many hundredths.
    pub fn worth(id: &str, verdict: &str, hundredths: i64) -> Value {
        let mut item = item(id, verdict, "");
        item["earned"] = json!(hundredths as f64 / 100.0);
        item
    }

    /// A marked submission with one question `q`.
    pub fn record_of(items: &[Value]) -> Record {
        let sum = |key: &str| items.iter().filter_map(|item| item[key].as_f64()).sum::<f64>();
        let tally = json!({"earned": sum("earned"), "possible": sum("possible"), "provisional": 0});
        let line = json!({"submission": "a", "file": "a.yaml", "students": [{"id": "EE-1", "name": "A"}], "total": tally,
            "questions": [{"id": "q", "earned": tally["earned"], "possible": tally["possible"], "provisional": 0}],
            "items": items, "ledger": {"lost": [], "spared": []}, "findings": [], "report": "reports/EE-1.html"});
        Record::from_line(&line.to_string()).expect("it is a record")
    }

    #[test]
    fn what_nobody_could_judge_says_nothing() {
        for (verdicts, says) in [
            (&["right", "unreadable"][..], true),
            (&["blank"], true),
            (&["unmarked", "unreadable"], false),
            (&[], false),
        ] {
            let items: Vec<Value> = verdicts.iter().map(|verdict| item("q.a", verdict, "")).collect();
            assert_eq!(super::says_something(&record_of(&items)), says, "{verdicts:?}");
        }
    }
}
