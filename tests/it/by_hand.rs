//! What a person gives, from the stub to the mark: tests/it/small.yaml is not enough, since it has no observed rows.

use crate::program::{Program, samples};
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
    program.write("in/poesam_1236_56791_lab1.yaml", &answers("EE-3", "Sam Poe", TIPS));
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
    // The class page is about the marks, and counts the one that is not known as nothing, not as 0.
    let (late, untidy) = (record_of(&program, "out", "EE-1"), record_of(&program, "out", "EE-2"));
    let mean = (late.mark.unwrap().earned.as_f64() + untidy.mark.unwrap().earned.as_f64()) / 2.0;
    let class = fs::read_to_string(program.path("out/index.html")).unwrap();
    for part in [
        &*format!("Mean mark</dt><dd>{mean} of 100<"),
        "One mark is not known yet, and not among these: to be given by a person are still Lab performance (1) and Viva (1).",
        &format!("{}<span class=\"note\">−5: handed in late</span>", late.cover_total.unwrap()),
        &format!("{}<span class=\"note\">−2.5: &lt;b&gt;untidy</span>", untidy.cover_total.unwrap()),
        "<td class=\"num\">waiting</td>",
    ] {
        assert!(class.contains(part), "no {part} in {class}");
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

/// Fills in what the stub leaves open, by what stands before the colon.
fn filled(stub: &str) -> String {
    let line = |line: &str| {
        let bare = line.split(" #").next().unwrap_or_default();
        match bare.trim() {
            "points:" => line.replace("points:", "points: 0.5"),
            "reason:" => line.replace("reason:", "reason: looked at"),
            "viva:" => bare.replace("viva:", "viva: 30"),
            name if name.ends_with(':') && bare.starts_with("      ") && !line.contains('–') => {
                match line.split("# of ").nth(1) {
                    Some(points) => format!("{bare} {points}"),
                    None => line.to_owned(),
                }
            }
            _ => line.to_owned(),
        }
    };
    stub.lines().map(|one| line(one) + "\n").collect()
}

#[test]
fn from_the_stub_to_nothing_that_waits_and_back_when_an_answer_changes() {
    let program = Program::new();
    program.write("in/a.yaml", &answers("EE-1", "\"=A # 'b\"", TIPS));
    program.write("in/b.yaml", &answers("EE-2", "B", TIPS));
    program.write("in/c.yaml", &answers("EE-3", "C", "It swings.\n  hanging.response.plot: curve.png"));
    let told = grade(&program, &[]);
    assert!(told.contains("polemark marks out --out marks.yaml"), "{told}");
    program.run(&["marks", "out", "--out", "marks.yaml"]).ends_with(0);
    let stub = fs::read_to_string(program.path("marks.yaml")).unwrap();
    // Unfilled, it says nothing; and it is not overwritten.
    let marks = ["--marks", "marks.yaml"];
    grade(&program, &marks);
    assert!(
        program.run(&["marks", "out", "--out", "marks.yaml"]).ends_with(2).err.contains("is there already")
    );
    assert_eq!(fs::read_to_string(program.path("marks.yaml")).unwrap(), stub);
    program.write("marks.yaml", &filled(&stub));
    let told = grade(&program, &[&marks[..], &["--compare", "out"]].concat());
    assert!(!told.contains("polemark marks"), "{told}\n{}", filled(&stub));
    assert!(told.contains("because of: marks"), "{told}");
    let nothing = program.run(&["marks", "out"]).ends_with(0);
    assert!(nothing.err.contains("nothing waits for a person") && nothing.out.is_empty(), "{}", nothing.out);
    assert!(records(&program, "out").iter().all(|record| record.mark.is_some()));

    program.write("in/b.yaml", &answers("EE-2", "B", "It jiggles a lot."));
    let told = grade(&program, &marks);
    assert!(told.contains("polemark marks out"), "{told}");
    // In a table, rows are added for it, and then none.
    let table = "student_id;item;group;points;reason;answer\r\nEE-1;viva;;30;;\r\n";
    program.write("marks.csv", table);
    program.run(&["marks", "out", "--out", "marks.csv"]).ends_with(0);
    let more = fs::read_to_string(program.path("marks.csv")).unwrap();
    assert!(more.starts_with(table) && more.len() > table.len(), "{more}");
    assert!(program.run(&["marks", "out", "--out", "marks.csv"]).ends_with(0).err.contains(" 0 rows added"));
    program.run(&["grade", "in", "--out", "other", "--marks", "marks.csv"]).ends_with(0);
}

/// Nobody's points change, and of what polemark judged nothing waits any more.
#[test]
fn suggestions_left_as_they_are_confirm_what_polemark_gave() {
    for marks in ["marks.yaml", "marks.csv"] {
        let program = Program::new();
        let class = samples();
        let class = class.to_str().expect("a path");
        program.run(&["grade", class, "--out", "out"]).ends_with(0);
        let before = records(&program, "out");
        program.run(&["marks", "out", "--out", marks, "--suggest"]).ends_with(0);
        program.run(&["grade", class, "--out", "out", "--marks", marks]).ends_with(0);
        let after = records(&program, "out");
        assert_eq!(before.len(), after.len());
        let (mut confirmed, mut judged) = (0, 0);
        for (before, after) in before.iter().zip(&after) {
            assert_eq!(before.total.earned, after.total.earned, "{}", before.submission);
            for (item, now) in before.items.iter().zip(&after.items) {
                assert_eq!(item.earned, now.earned, "{} {}", before.submission, item.id);
                confirmed += usize::from(now.code == "by_hand" && item.code != "by_hand");
                let waits = now.review.is_some() && now.provisional && now.verdict != "unmarked";
                judged += usize::from(item.provisional && item.verdict != "unmarked");
                // Whose a file is has to be said first.
                assert!(!waits || after.held().next().is_some(), "{} {}", before.submission, item.id);
            }
        }
        assert!(judged > 50 && confirmed > 50, "{confirmed} of {judged} {marks}");
    }
}

#[test]
fn a_comparison_names_the_cause() {
    let program = Program::new();
    let lab = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/small.yaml")).unwrap();
    program.write("lab.yaml", &lab);
    let write = |speed: &str| {
        let text = format!("student: {{id: S-1, name: A}}\nanswers:\n  sled.final_value: {speed}\n");
        program.write("in/a.yaml", &text);
    };
    write("-4.3");
    let run = |more: &[&str]| {
        let arguments =
            [&["grade", "in", "--lab", "lab.yaml", "--out", "out", "--compare", "out"], more].concat();
        program.run(&arguments).ends_with(0).out
    };
    program.run(&["grade", "in", "--lab", "lab.yaml", "--out", "out"]).ends_with(0);
    assert!(run(&[]).contains("compared: nothing has changed"));
    write("-4.545");
    let told = run(&[]);
    assert!(told.contains("because of: answer"), "{told}");
    let table = fs::read_to_string(program.path("out/compare.csv")).unwrap();
    assert!(
        table.lines().nth(1).is_some_and(
            |line| line.starts_with("S-1,A,sled.final_value.value,0,1,1") && line.ends_with(",answer")
        ),
        "{table}"
    );
    assert!(fs::read_to_string(program.path("out/compare.html")).unwrap().contains("sled.final_value.value"));
    program.write(
        "marks.yaml",
        "students: {S-1: {items: {sled.final_value.value: {points: 0.5, reason: copied}}}}\n",
    );
    let told = run(&["--marks", "marks.yaml"]);
    assert!(told.contains("because of: marks"), "{told}");
    run(&[]);
    write("-4.3");
    run(&[]);
    let wide = lab.replace(
        "feature: final_value, response: step}",
        "feature: final_value, response: step, tolerance: {relative: 0.1}}",
    );
    assert_ne!(wide, lab);
    program.write("lab.yaml", &wide);
    let told = run(&[]);
    assert!(told.contains("because of: lab"), "{told}");
    program.run(&["compare", "nowhere", "out"]).ends_with(2);
    let same = program.run(&["compare", "out", "out/results.jsonl"]).ends_with(0);
    assert_eq!(same.out, "compared: nothing has changed\n");
}
