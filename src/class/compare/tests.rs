use super::*;
use crate::class::{LabFacts, ProgramFacts, Record, RunFacts};
use serde_json::json;

struct Run {
    lab: &'static str,
    program: &'static str,
    points: f64,
    code: &'static str,
    answer: &'static str,
    other_answer: &'static str,
}

const RUN: Run = Run { lab: "l", program: "p", points: 1.0, code: "right", answer: "a", other_answer: "b" };

impl Run {
    fn standing(&self, id: &str) -> Standing {
        let text = json!({"submission": id, "file": "f", "students": [{"id": id, "name": "=A"}],
            "total": {"earned": self.points, "possible": 3, "provisional": 0},
            "items": [{"id": "q.one", "earned": self.points, "possible": 2, "verdict": "right", "code": self.code, "provisional": false,
                "alike": null, "answer": self.answer, "evidence": {"expected": "", "found": "", "reason": "", "conflicts": []}, "line": null,
                "column": null, "diagnosis": null, "follow_through": null}],
            "answers": {"q.one": self.answer, "q.zero": self.other_answer}, "ledger": {"lost": [], "spared": []}, "findings": [], "report": "r"});
        let mut standing = Standing::new(Some(RunFacts {
            program: ProgramFacts { version: String::new(), hash: self.program.to_owned() },
            lab: LabFacts { hash: self.lab.to_owned(), ..LabFacts::default() },
            ..RunFacts::default()
        }));
        standing.add(&Record::from_line(&text.to_string()).unwrap());
        standing
    }
}

#[test]
fn each_change_has_its_cause() {
    for (what, new, cause) in [
        ("nothing", Run { ..RUN }, None),
        ("another answer of the same worth", Run { answer: "c", ..RUN }, None),
        ("the answer", Run { points: 2.0, answer: "c", ..RUN }, Some("answer")),
        ("the answer, and the lab too", Run { points: 2.0, answer: "c", lab: "m", ..RUN }, Some("answer")),
        ("a person", Run { points: 2.0, code: "by_hand", lab: "m", ..RUN }, Some("marks")),
        ("the lab", Run { points: 2.0, lab: "m", ..RUN }, Some("lab")),
        ("the program", Run { points: 2.0, program: "q", ..RUN }, Some("program")),
        ("either", Run { points: 2.0, lab: "m", program: "q", ..RUN }, Some("lab or program")),
        ("what it rests on", Run { points: 2.0, other_answer: "c", ..RUN }, Some("answer")),
    ] {
        let found = compare(&RUN.standing("EE-1"), &new.standing("EE-1"));
        let causes: Vec<_> = found.changes.iter().map(|change| change.cause.as_str()).collect();
        assert_eq!(causes, cause.into_iter().collect::<Vec<_>>(), "{what}");
        if let Some(cause) = cause {
            assert_eq!((found.students, found.items, found.mean_change), (1, 1, 1.0), "{what}");
            let csv = String::from_utf8(comparison_csv(&found).unwrap()).unwrap();
            assert!(csv.ends_with(&format!("EE-1,'=A,q.one,1,2,1,{cause}\n")), "{csv}");
        }
    }
}

#[test]
fn of_an_older_polemark_little_is_known() {
    let mut old = RUN.standing("EE-1");
    old.facts = None;
    let found = compare(&old, &Run { points: 2.0, answer: "c", ..RUN }.standing("EE-1"));
    assert_eq!(found.changes[0].cause, "answer or lab or program");
}

#[test]
fn who_came_and_who_went() {
    let found = compare(&RUN.standing("EE-1"), &RUN.standing("EE-2"));
    let told: Vec<_> = found.changes.iter().map(|one| (one.student.as_str(), one.cause.as_str())).collect();
    assert_eq!(told, [("EE-1", "gone"), ("EE-2", "new")]);
    assert_eq!((found.students, found.items), (2, 0));
}
