//! What a person gives, from the stub to the mark: tests/it/small.yaml is not enough, since it has no observed rows.

use crate::program::Program;
use polemark::class::Record;
use std::fs;

const TIPS: &str = "It jiggles a bit.";

fn answers(id: &str, name: &str, expects: &str) -> String {
    format!("lab: ee361-lab3\nstudent: {{id: {id}, name: {name}}}\nanswers:\n  expect_hanging: {expects}\n")
}

/// The records of an output folder.
fn records(program: &Program, out: &str) -> Vec<Record> {
    let text = fs::read_to_string(program.path(out).join("results.jsonl")).expect("results");
    text.lines().map(|line| Record::from_line(line).expect("a record")).collect()
}

#[track_caller]
fn record_of(program: &Program, out: &str, id: &str) -> Record {
    let mut all = records(program, out).into_iter();
    all.find(|record| record.counts() && record.students.iter().any(|one| one.id == id)).expect("marked")
}

fn codes(record: &Record) -> Vec<&str> {
    record.findings.iter().map(|finding| finding.code.as_str()).collect()
}

#[track_caller]
fn grade(program: &Program, more: &[&str]) -> String {
    let mut arguments = vec!["grade", "in", "--out", "out"];
    arguments.extend(more);
    program.run(&arguments).ends_with(0).out
}

#[test]
fn a_decision_for_an_answer_that_has_changed_is_held() {
    let program = Program::new();
    program.write("in/a.yaml", &answers("EE-1", "A", TIPS));
    grade(&program, &[]);
    let before = record_of(&program, "out", "EE-1");
    let hash = before.answers["expect_hanging"].clone();
    assert_eq!(hash.len(), 16);
    let item = |record: &Record| {
        record.items.iter().find(|item| item.id == "expect_hanging.settles").cloned().unwrap()
    };
    assert_eq!(item(&before).answer.as_ref(), Some(&hash));
    let group = item(&before).alike.expect("a group");
    for decision in [
        format!(
            "students: {{EE-1: {{items: {{expect_hanging.settles: {{points: 1, reason: seen, answer: {hash}}}}}}}}}\n"
        ),
        format!(
            "alike: {{expect_hanging.settles: {{{group}: {{points: 1, reason: seen, answer: [{hash}]}}}}}}\n"
        ),
    ] {
        program.write("in/a.yaml", &answers("EE-1", "A", TIPS));
        program.write("marks.yaml", &decision);
        grade(&program, &["--marks", "marks.yaml"]);
        let given = item(&record_of(&program, "out", "EE-1"));
        assert_eq!((given.earned.0, given.code.as_str(), given.provisional), (100, "by_hand", false));
        // The same words with another point: the same group, another answer.
        program.write("in/a.yaml", &answers("EE-1", "A", "It jiggles a bit!"));
        let told = grade(&program, &["--marks", "marks.yaml"]);
        assert!(told.contains("1 has an answer that a person decided about before it changed"), "{told}");
        let record = record_of(&program, "out", "EE-1");
        assert!(codes(&record).contains(&"marks.answer_changed"), "{record:?}");
        let held = item(&record);
        assert_eq!((held.earned.0, held.code.as_str(), held.provisional), (0, "concepts.missing", true));
        assert!(held.review.as_ref().is_some_and(|review| review.why.contains("1 point: seen")), "{held:?}");
        let page = fs::read_to_string(program.path("out/index.html")).unwrap();
        assert!(page.contains("decided for another answer"));
    }
}

#[test]
fn lateness_and_adjustments_make_the_mark() {
    let program = Program::new();
    let lab = polemark::lab::load(polemark::lab::DEFAULT).unwrap();
    let observed: Vec<String> =
        lab.observed.iter().map(|row| format!("{}: {}", row.id, row.points)).collect();
    let by_hand = format!("viva: 30\n    observed: {{{}}}\n", observed.join(", "));
    program.write("in/doejane_LATE_1234_56789_lab1.yaml", &answers("EE-1", "Jane Doe", TIPS));
    program.write("in/roejohn_1235_56790_lab1.yaml", &answers("EE-2", "John Roe", TIPS));
    let marks = format!(
        "late: {{points: 5}}\nstudents:\n  EE-1:\n    {by_hand}  EE-2:\n    {by_hand}    adjustments: [{{points: -2.5, reason: '<b>untidy'}}]\n"
    );
    program.write("marks.yaml", &marks);
    grade(&program, &["--marks", "marks.yaml"]);
    for (id, by, reason) in [("EE-1", -500, "handed in late"), ("EE-2", -250, "<b>untidy")] {
        let record = record_of(&program, "out", id);
        assert!(record.held().next().is_none(), "{:?}", record.findings);
        let total = record.cover_total.expect("complete");
        let mark = record.mark.expect("complete");
        assert_eq!((mark.earned.0, mark.possible.0), (total.0 + by, 10_000), "{id}");
        let adjusted: Vec<_> =
            record.adjustments.iter().map(|one| (one.points.unwrap().0, one.reason.as_str())).collect();
        assert_eq!(adjusted, [(by, reason)]);
        let page = fs::read_to_string(program.path("out").join(&record.report)).unwrap();
        assert!(page.contains("Adjustments") && !page.contains("<b>untidy"), "{id}");
    }
    let gradebook = fs::read_to_string(program.path("out/gradebook.csv")).unwrap();
    assert!(gradebook.contains("'-2.5: <b>untidy") && gradebook.contains("mark [100]"), "{gradebook}");
}

#[test]
fn what_a_person_says_settles_whose_it_is_and_which_counts() {
    let program = Program::new();
    program.write("roster.csv", "id,name\nEE-1,Jane Doe\nEE-2,John Roe\n");
    program.write("in/first.yaml", &answers("EE-1", "Jane Doe", TIPS));
    program.write("in/second.yaml", &answers("ee1", "Jane Doe", "It swings."));
    program.write("in/typo.yaml", &answers("EE-22", "J. R.", TIPS));
    let roster = ["--roster", "roster.csv"];
    let told = grade(&program, &roster);
    assert!(told.contains("2 wait for a person to say whose"), "{told}");
    program.write("marks.yaml", "files: {typo.yaml: {is: EE-2}}\nstudents: {EE-1: {counts: second.yaml}}\n");
    let more = ["--roster", "roster.csv", "--marks", "marks.yaml"];
    let told = grade(&program, &more);
    assert!(!told.contains("to say whose"), "{told}");
    let all = records(&program, "out");
    assert!(all.iter().all(|record| record.held().next().is_none()), "{all:?}");
    let first = all.iter().find(|record| record.file == "first.yaml").expect("a line");
    assert_eq!((first.status.as_str(), first.superseded_by.as_deref()), ("superseded", Some("second")));
    assert_eq!(record_of(&program, "out", "EE-2").students[0].name, "John Roe");
    assert!(!all.iter().any(|record| record.status.as_str() == "missing"));
    // Kept or not, it comes out the same; and with the other file again as before.
    let before = fs::read(program.path("out/results.jsonl")).unwrap();
    grade(&program, &more);
    assert_eq!(fs::read(program.path("out/results.jsonl")).unwrap(), before);
    fs::remove_file(program.path("in/second.yaml")).unwrap();
    let alone = program
        .run(&["grade", "in", "--out", "out", "--roster", "roster.csv", "--marks", "marks.yaml"])
        .ends_with(0);
    assert!(alone.err.contains("marks.no_such_file") && alone.err.contains("second.yaml"), "{}", alone.err);
    assert_eq!(record_of(&program, "out", "EE-1").file, "first.yaml");
}
