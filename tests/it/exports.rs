//! What is exported, read again by rules written down a second time: the importers' own, in few words.

use crate::intake::write_zip;
use crate::program::{Program, Ran, samples};
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

const TANK: &str = r#"lab: tank
title: A tank that drains
total: 4
parameters:
  A: {value: 0.5, unit: m^2, description: area of the tank}
  k: {value: 0.2, unit: m^2.5/s, description: outflow at 1 m}
models:
  tank:
    title: Tank with a free outflow
    coordinates: {h: {unit: m, description: level}}
    inputs: {q: {unit: m^3/s, description: inflow}}
    equations: ["A*h' = q - k*sqrt(h)"]
    operating_points:
      full:
        title: Level of 4 m
        at: {h: 4, q: 0.4}
        input: q
        output: h
        comparison: {horizon_s: 60, departure: 0.1, pushes: [1]}
questions:
  full.transfer_function:
    number: Question 1
    title: From inflow to level
    points: 4
    about: tank.full
    answer: {kind: transfer_function, prompt: H(s)/Q(s) about 4 m}
    criteria:
      numerator: {title: Numerator, points: 2, check: numerator}
      denominator: {title: Denominator, points: 2, check: denominator}
    model_answer: 1/(0.5s + 0.05)
cover: {total: 4, rows: {questions: {title: Questions, points: 4, from: questions}}}
"#;

const RIGHT: &str = "1/(0.5s + 0.05)";
const HALF: &str = "1/(0.5s - 0.05)";

fn answers(id: &str, name: &str, answer: &str) -> Vec<u8> {
    format!(
        "lab: tank\nstudent: {{id: {id}, name: \"{name}\"}}\nanswers:\n  full.transfer_function: {answer}\n"
    )
    .into_bytes()
}

/// A class handed in by way of an LMS, with its own list of students as the roster.
fn graded(files: &[(&str, Vec<u8>)], roster: &str) -> Program {
    let program = Program::new();
    program.write("tank.yaml", TANK);
    program.write("lms.csv", roster);
    let files: Vec<(String, Vec<u8>)> =
        files.iter().map(|(name, bytes)| ((*name).to_owned(), bytes.clone())).collect();
    write_zip(&program.path("class.zip"), &files);
    program
        .run(&["grade", "class.zip", "--lab", "tank.yaml", "--roster", "lms.csv", "--out", "out"])
        .ends_with(0);
    program
}

fn export(program: &Program, to: &str, out: &str, more: &[&str]) -> Ran {
    let mut arguments = vec!["export", "out", "--to", to, "--out", out];
    arguments.extend(more);
    program.run(&arguments)
}

/// Rows of a CSV file by another reader than polemark's.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).flexible(true).from_path(path).expect("readable");
    reader.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect()
}

const CANVAS: &str = "Student,ID,SIS User ID,SIS Login ID,Section,Homework (7),Tank (42),Current Score,Final Score\n\
    ,,,,,,Manual Posting,,\n\
    \"    Points Possible\",,,,,10.00,4.00,(read only),(read only)\n\
    \"Doe, Jane\",11,EE-001,jdoe,S1,9.00,,90.0,90.0\n\
    \"Smith, John\",12,EE-002,jsmith,S1,8.00,1.50,80.0,80.0\n\
    \"Excused, Eve\",13,EE-003,eve,S1,8.00,EX,80.0,80.0\n\
    \"O'Brien, Sinéad\",14,EE-004,sob,S1,8.00,3.00,80.0,80.0\n\
    \"Gone, Max\",15,EE-005,max,S1,8.00,2.00,80.0,80.0\n\
    \"Student, Test\",99,,0a1b2c,S1,,,,\n";

/// What Canvas does with an upload, in few words: a student by their number; a cell that differs from the score changes it, and an empty
/// one takes it away.
fn canvas_after(scores: &BTreeMap<&str, &str>, rows: &[Vec<String>]) -> BTreeMap<String, String> {
    let mut after: BTreeMap<String, String> =
        scores.iter().map(|(id, score)| ((*id).to_owned(), (*score).to_owned())).collect();
    assert!(
        rows[0].len() > 3 && rows[0][0].contains("Student") && rows[0][1].contains("ID"),
        "{:?}",
        rows[0]
    );
    let section = rows[0].iter().position(|name| name == "Section").expect("a section");
    assert_eq!(rows[0][section + 1..], ["Tank (42)"], "one assignment and nothing else");
    for row in &rows[1..] {
        if row[0].contains("Points Possible") {
            assert_eq!(row[section + 1], "4.00");
        } else if !row.iter().all(|cell| cell.is_empty() || cell.starts_with("Manual Posting")) {
            let score = after.get_mut(&row[1]).expect("a student whom Canvas knows");
            *score = row[section + 1].clone();
        }
    }
    after
}

#[test]
fn canvas_has_the_marks_that_are_final_and_keeps_the_rest() {
    let program = graded(
        &[
            ("doejane_11_901_tank.yaml", answers("EE-001", "Jane Doe", RIGHT)),
            ("smithjohn_LATE_12_902_tank.yaml", answers("EE-002", "John Smith", HALF)),
            ("excusedeve_13_903_tank.yaml", answers("EE-003", "Eve Excused", RIGHT)),
            ("obriensinéad_14_904_tank.yaml", answers("EE-009", "Somebody Else", RIGHT)),
        ],
        CANVAS,
    );
    let ran =
        export(&program, "canvas", "import.csv", &["--lms", "lms.csv", "--assignment", "Tank"]).ends_with(0);
    let before: BTreeMap<&str, &str> =
        [("11", ""), ("12", "1.50"), ("13", "EX"), ("14", "3.00"), ("15", "2.00"), ("99", "")].into();
    let after = canvas_after(&before, &rows(&program.path("import.csv")));
    let expected = [("11", "4.00"), ("12", "2.00"), ("13", "EX"), ("14", "3.00"), ("15", "2.00"), ("99", "")];
    assert_eq!(after, expected.map(|(id, score)| (id.to_owned(), score.to_owned())).into());
    for said in [
        "2 marks in import.csv",
        "EE-003 (Eve Excused): excused in Canvas",
        "EE-005 (Max Gone): handed nothing in",
        "EE-009 (Somebody Else): The student id `EE-009` is not on the list of the course",
    ] {
        assert!(ran.err.contains(said), "{said} in {}", ran.err);
    }
    let zero = ["--lms", "lms.csv", "--assignment", "42", "--zero-for-missing"];
    export(&program, "canvas", "zero.csv", &zero).ends_with(0);
    assert_eq!(canvas_after(&before, &rows(&program.path("zero.csv")))["15"], "0.00");

    export(&program, "canvas-feedback", "back.zip", &[]).ends_with(0);
    let reports = entries(&program.path("back.zip"));
    let names: Vec<&str> = reports.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        ["doejane_11_901_report.html", "excusedeve_13_903_report.html", "smithjohn_12_902_report.html"]
    );
    assert_eq!(reports[names[0]], std::fs::read(program.path("out/reports/EE-001.html")).expect("a report"));

    let same = export(&program, "canvas", "lms.csv", &["--lms", "lms.csv"]);
    assert!(same.ends_with(2).err.contains("is what the LMS exported"));
    assert_eq!(std::fs::read_to_string(program.path("lms.csv")).expect("still there"), CANVAS);
}

fn entries(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut zip = zip::ZipArchive::new(std::fs::File::open(path).expect("a file")).expect("a zip");
    let mut entries = BTreeMap::new();
    for at in 0..zip.len() {
        let mut entry = zip.by_index(at).expect("an entry");
        let name = entry.name().expect("a name").into_owned();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).expect("readable");
        entries.insert(name, bytes);
    }
    entries
}

const MOODLE: &str = "\u{feff}Identifier,\"Full name\",\"ID number\",\"Email address\",Status,Grade,\"Maximum Grade\",\"Grade can be changed\",\"Last modified (grade)\",\"Feedback comments\"\r\n\
    \"Participant 501\",\"Jane Doe\",EE-001,jane@x.edu,\"Submitted for grading - \",,4.00,Yes,-,\r\n\
    \"Participant 502\",\"John Smith\",EE-002,john@x.edu,\"Submitted for grading - \",1.50,4.00,Yes,\"Monday, 1 June 2026, 9:00 AM\",\"ask, please\"\r\n\
    \"Participant 503\",\"Sinéad O'Brien\",EE-003,sin@x.edu,\"Submitted for grading - \",,4.00,No,-,\r\n\
    \"Participant 504\",\"Max Gone\",EE-004,max@x.edu,\"No submission - \",2.00,4.00,Yes,-,\r\n";

#[test]
fn moodle_has_the_marks_that_are_final_and_keeps_every_other_byte() {
    let program = graded(
        &[
            ("Jane Doe_501_assignsubmission_file/tank.yaml", answers("EE-001", "Jane Doe", RIGHT)),
            ("John Smith_502_assignsubmission_file/tank.yaml", answers("EE-002", "J. Smith", HALF)),
            ("Sinéad OBrien_503_assignsubmission_file/tank.yaml", answers("EE-003", "Sinéad O'Brien", RIGHT)),
        ],
        MOODLE,
    );
    let ran = export(&program, "moodle-worksheet", "filled.csv", &["--lms", "lms.csv"]).ends_with(0);
    let filled = std::fs::read_to_string(program.path("filled.csv")).expect("written");
    let expected = MOODLE.replace("- \",,4.00,Yes", "- \",4.00,4.00,Yes").replace(",1.50,", ",2.00,");
    assert_eq!(filled, expected);
    for said in ["2 marks in filled.csv", "Moodle says that the grade cannot be changed", "handed nothing in"]
    {
        assert!(ran.err.contains(said), "{said} in {}", ran.err);
    }
    let ran = export(&program, "moodle-worksheet", "x.csv", &["--lms", "lms.csv", "--scale-to", "20"]);
    assert!(ran.ends_with(2).err.contains("out of 4 points in the file, the marks are out of 20"));
    assert!(!program.path("x.csv").exists());

    export(
        &program,
        "moodle",
        "import.csv",
        &["--assignment", "Tank", "--identity", "email", "--scale-to", "100"],
    )
    .ends_with(0);
    assert_eq!(
        rows(&program.path("import.csv")),
        [
            ["Email address", "Full name", "Tank"],
            ["jane@x.edu", "Jane Doe", "100.00"],
            ["john@x.edu", "John Smith", "50.00"],
            ["sin@x.edu", "Sinéad O'Brien", "100.00"],
        ]
    );

    export(&program, "moodle-feedback", "back.zip", &[]).ends_with(0);
    let names: Vec<String> = entries(&program.path("back.zip")).into_keys().collect();
    assert_eq!(
        names,
        [
            "Jane Doe_501_assignfeedback_file_report.html",
            "John Smith_502_assignfeedback_file_report.html",
            "Sinéad OBrien_503_assignfeedback_file_report.html",
        ]
    );
}

#[test]
fn the_sample_class_waits_for_a_person_unless_it_is_to_go_as_it_stands() {
    let program = Program::new();
    let samples = samples();
    program.run(&["grade", samples.to_str().expect("a path"), "--out", "out"]).ends_with(0);
    let ran = export(&program, "moodle", "import.csv", &[]).ends_with(0);
    assert!(ran.err.starts_with("0 marks in import.csv"), "{}", ran.err);
    assert!(ran.err.contains("wait for a person") || ran.err.contains("not filled in yet"), "{}", ran.err);
    assert!(!ran.err.contains('\u{1b}'), "{}", ran.err);
    export(&program, "moodle", "as.csv", &["--as-it-stands"]).ends_with(0);
    let rows = rows(&program.path("as.csv"));
    assert!(rows.len() > 10);
    for row in &rows[1..] {
        assert!(
            row[2].parse::<f64>().is_ok() && row[2].split_once('.').is_some_and(|(_, rest)| rest.len() == 2)
        );
        assert!(!row.iter().any(|cell| cell.starts_with(['=', '+', '-', '@'])), "{row:?}");
    }

    let ran = export(&program, "gradescope", "results.json", &["--file", "blank.yaml"]);
    assert!(ran.ends_with(2).err.contains("nothing is written for blank.yaml"));
    export(&program, "gradescope", "results.json", &["--file", "blank.yaml", "--as-it-stands"]).ends_with(0);
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(program.path("results.json")).expect("written")).expect("JSON");
    assert!(json["score"].is_number() && json["tests"].as_array().is_some_and(|tests| tests.len() > 20));

    for name in ["one.xlsx", "two.xlsx"] {
        export(&program, "xlsx", name, &[]).ends_with(0);
    }
    let read = |name| std::fs::read(program.path(name)).expect("written");
    assert_eq!(read("one.xlsx"), read("two.xlsx"), "same class, same bytes");
    let parts = entries(&program.path("one.xlsx"));
    let marks = String::from_utf8(parts["xl/worksheets/sheet1.xml"].clone()).expect("text");
    let gradebook = self::rows(&program.path("out/gradebook.csv"));
    assert_eq!(marks.matches("<row ").count(), gradebook.len());
    assert!(!marks.contains("<f>"), "no formulas");

    std::fs::create_dir_all(program.path("out/.polemark/running")).expect("made");
    let ran = export(&program, "xlsx", "three.xlsx", &[]);
    assert!(ran.ends_with(2).err.contains("was stopped before its end"));
    assert!(!program.path("three.xlsx").exists());
}
