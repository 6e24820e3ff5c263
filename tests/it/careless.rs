//! What a careless hand does: files in the wrong place, tables gone wrong, results changed by hand.

use crate::program::{Program, files_below};
use std::fs;

fn answers(id: &str) -> String {
    format!("lab: ee361-lab3\nstudent: {{id: {id}, name: A}}\nanswers:\n  battery.nonlinearity: dead zone\n")
}

fn class() -> Program {
    let program = Program::new();
    program.write("in/a.yaml", &answers("EE-1"));
    program.write("in/b.yaml", &answers("EE-2"));
    program
}

#[track_caller]
fn refused(program: &Program, arguments: &[&str], why: &str) {
    let ran = program.run(arguments).ends_with(2);
    assert!(ran.err.contains(why), "{arguments:?}: {}", ran.err);
}

#[test]
fn results_changed_by_hand_are_not_passed_on() {
    let program = class();
    program.run(&["grade", "in", "--out", "out"]).ends_with(0);
    program.run(&["grade", "in", "--out", "before"]).ends_with(0);
    let whole = fs::read_to_string(program.path("out/results.jsonl")).unwrap();
    let (first, second) = whole.split_once('\n').unwrap();
    for changed in [
        whole.replacen("\"earned\":0.0", "\"earned\":9.0", 1),
        whole.replacen("\"total\":{\"earned\":1.0", "\"total\":{\"earned\":44.0", 1),
        format!("{first}\n{first}\n{second}"),
        second.to_owned(),
        String::new(),
    ] {
        assert_ne!(changed, whole);
        program.write("out/results.jsonl", &changed);
        for arguments in [
            &["marks", "out"][..],
            &["marks", "out", "--out", "marks.yaml"],
            &["export", "out", "--to", "moodle", "--as-it-stands", "--out", "x.csv"],
            &["export", "out", "--to", "xlsx", "--out", "x.xlsx"],
            &[
                "export",
                "out",
                "--to",
                "gradescope",
                "--student",
                "EE-1",
                "--as-it-stands",
                "--out",
                "x.json",
            ],
            &["compare", "before", "out"],
            &["compare", "out", "before"],
        ] {
            refused(&program, arguments, "`out/results.jsonl` is not as `polemark grade` wrote it");
        }
    }
    program.write("out/results.jsonl", &whole.replacen("\"earned\":0.0", "\"earned\":\"many\"", 1));
    for arguments in [&["marks", "out"][..], &["compare", "before", "out"]] {
        refused(&program, arguments, "line 1 of `out/results.jsonl` is not a result of polemark");
    }
    assert!(!program.path("marks.yaml").exists() && !program.path("x.csv").exists());
    program.run(&["grade", "in", "--out", "out"]).ends_with(0);
    assert_eq!(fs::read_to_string(program.path("out/results.jsonl")).unwrap(), whole);
    program.run(&["compare", "before", "out"]).ends_with(0);
    fs::remove_file(program.path("out/run.json")).unwrap();
    refused(&program, &["export", "out", "--to", "xlsx", "--out", "x.xlsx"], "`out/run.json` cannot be read");
}

#[test]
fn marks_of_two_labs_are_not_compared() {
    let program = class();
    program.run(&["grade", "in", "--out", "one"]).ends_with(0);
    program.run(&["grade", "in", "--out", "two", "--lab", "coupled-tanks"]).ends_with(0);
    let why = "`one` holds results of the lab `ee361-lab3`, and not of `coupled-tanks`";
    refused(&program, &["compare", "one", "two"], why);
    let grade = ["grade", "in", "--out", "three", "--lab", "coupled-tanks", "--compare", "one"];
    refused(&program, &grade, why);
    assert!(!program.path("three").exists());
}

#[test]
fn nothing_of_somebody_else_is_overwritten() {
    let program = class();
    program.write("mine/gradebook.csv", "id,name\nEE-1,A\n");
    let grade = ["grade", "in", "--roster", "mine/gradebook.csv", "--out", "mine"];
    refused(&program, &grade, "`mine/gradebook.csv` would be overwritten");
    refused(&program, &["grade", "in", "--out", "mine"], "`mine/gradebook.csv` is not by polemark");
    let left: Vec<String> = files_below(&program.path("mine")).into_keys().collect();
    assert_eq!(left, ["gradebook.csv"]);

    program.run(&["grade", "in", "--out", "out"]).ends_with(0);
    let before = files_below(&program.path("out"));
    for name in ["results.jsonl", "gradebook.csv", "reports/EE-1.html"] {
        let out = format!("out/{name}");
        let export = ["export", "out", "--to", "moodle", "--as-it-stands", "--out", out.as_str()];
        refused(&program, &export, "is what `polemark grade` wrote");
    }
    assert_eq!(files_below(&program.path("out")), before);
}

#[test]
fn what_polemark_writes_is_not_handed_in() {
    for out in ["in", "in/out"] {
        let program = class();
        program.write("in/roster.csv", "id\nEE-1\nEE-2\n");
        let grade = ["grade", "in", "--roster", "in/roster.csv", "--out", out];
        let first = program.run(&grade).ends_with(0).out;
        assert!(!first.contains("not marked"), "{first}");
        let page = fs::read(program.path(out).join("index.html")).unwrap();
        let again = program.run(&grade).ends_with(0).out;
        assert!(!again.contains("not marked"), "{again}");
        assert_eq!(fs::read(program.path(out).join("index.html")).unwrap(), page);
    }
}

#[test]
fn a_table_full_of_slips_is_told_in_short() {
    let program = class();
    let row = "EE-1,battery.nonlinearity.class,,1,seen,\n";
    program
        .write("marks.csv", &format!("student_id,item,group,points,reason,answer\n{}", row.repeat(100_000)));
    let told = program.run(&["grade", "in", "--out", "out", "--marks", "marks.csv"]).ends_with(1).err;
    assert_eq!(told.matches("error[marks.twice]").count(), 20);
    assert!(told.trim_end().ends_with("and 99979 more like these, further down in `marks.csv`"), "{told}");
    let rows: String = (0..100).map(|number| format!("XX-{number},viva,,1,,\n")).collect();
    program.write("marks.csv", &format!("student_id,item,group,points,reason,answer\n{rows}"));
    let told = program.run(&["grade", "in", "--out", "out", "--marks", "marks.csv"]).ends_with(0).out;
    assert!(told.contains("  and 80 more such lines\n"), "{told}");
}

#[cfg(target_os = "linux")]
#[test]
fn what_never_ends_is_not_read_to_its_end() {
    let program = class();
    refused(
        &program,
        &["grade", "in", "--out", "out", "--roster", "/dev/zero"],
        "more than the 8388608 bytes",
    );
    let grade = ["grade", "in", "--out", "out", "--marks", "/dev/zero"];
    refused(&program, &grade, "more than the 67108864 bytes");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said() {
    let program = class();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_polemark"))
        .args(["grade", "in", "--out", "out"])
        .current_dir(program.folder.path())
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.starts_with("error: the output cannot be written: No space left on device"), "{told}");
}

#[test]
fn the_mean_is_that_of_the_class_page() {
    let program = class();
    program.write("in/c.yaml", "lab: [\n");
    let told = program.run(&["grade", "in", "--out", "out"]).ends_with(0).out;
    assert!(told.starts_with("3 submissions marked, mean 1 of 45 points\n"), "{told}");
    assert!(
        fs::read_to_string(program.path("out/index.html"))
            .unwrap()
            .contains("Mean in the questions</dt><dd>1 of 45")
    );
}

#[test]
fn withheld_points_are_not_told_by_an_export() {
    let program = class();
    let worksheet = "Identifier,Full name,Grade,Maximum grade,Feedback comments\nParticipant 1,A,,100.00,\n";
    program.write("worksheet.csv", worksheet);
    let gradescope =
        ["export", "out", "--to", "gradescope", "--student", "EE-1", "--as-it-stands", "--out", "x.json"];
    for (release, visibility, code) in [("marks,feedback", "after_published", 0), ("feedback", "hidden", 2)] {
        program.run(&["grade", "in", "--out", "out", "--release", release]).ends_with(0);
        program.run(&gradescope).ends_with(0);
        let json = fs::read(program.path("x.json")).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
        let tests = json["tests"].as_array().unwrap();
        assert!(tests.len() > 20 && tests.iter().all(|test| test["visibility"] == visibility), "{release}");
        assert_eq!(json["visibility"], visibility);
        let comments = [
            "export",
            "out",
            "--to",
            "moodle-worksheet",
            "--lms",
            "worksheet.csv",
            "--comments",
            "--out",
            "y.csv",
        ];
        program.run(&comments).ends_with(code);
    }
}

#[test]
fn several_marks_files_are_one_unless_they_contradict_each_other() {
    let program = class();
    program.write("viva.csv", "student_id,item,points\nEE-1,viva,30\nEE-2,viva,20\n");
    program.write("marks.yaml", "students:\n  EE-1: {viva: 30, observed: {safety: 4}}\n");
    let both = [
        "grade",
        "in",
        "--out",
        "out",
        "--marks",
        "viva.csv",
        "--marks",
        "marks.yaml",
        "--marks",
        "viva.csv",
    ];
    program.run(&both).ends_with(0);
    let gradebook = fs::read_to_string(program.path("out/gradebook.csv")).unwrap();
    let column = |name: &str, row: usize| {
        let lines: Vec<Vec<&str>> = gradebook.lines().map(|line| line.split(',').collect()).collect();
        let place = lines[0].iter().position(|column| column.starts_with(name)).unwrap();
        lines[row][place].to_owned()
    };
    assert_eq!(
        [column("cover.viva", 1), column("cover.viva", 2), column("observed.safety", 1)],
        ["30", "20", "4"]
    );
    program.write("marks.yaml", "students:\n  ee 1: {viva: 25}\n");
    let told = program.run(&both).ends_with(1).err;
    assert!(
        told.starts_with("error[marks.twice]: `viva` of `ee 1` is 30 and 25.\n --> marks.yaml:2:10"),
        "{told}"
    );
    assert!(told.contains("It is said first in `viva.csv`, line 2. Keep one."), "{told}");
    // What was forgotten is said.
    let told = program.run(&["grade", "in", "--out", "out"]).ends_with(0).err;
    assert_eq!(
        told,
        "warning: the last run into `out` had a marks file: what a person gave is not in this one\n"
    );
    assert_eq!(program.run(&["grade", "in", "--out", "out"]).ends_with(0).err, "");
}

#[test]
fn an_archive_that_is_named_twice_is_read_once() {
    let program = Program::new();
    let file = fs::File::create(program.path("a.zip")).unwrap();
    let mut zip = zip::ZipWriter::new(file);
    zip.start_file("Jane Doe_1_assignsubmission_file/a.yaml", zip::write::SimpleFileOptions::default())
        .unwrap();
    std::io::Write::write_all(&mut zip, answers("EE-1").as_bytes()).unwrap();
    zip.finish().unwrap();
    let told = program.run(&["grade", "a.zip", "./a.zip", "--out", "out"]).ends_with(0).out;
    assert!(told.starts_with("1 submission marked") && !told.contains("does not count"), "{told}");
}

#[cfg(unix)]
#[test]
fn a_stub_is_whole_or_not_there() {
    let program = class();
    program.run(&["grade", "in", "--out", "out"]).ends_with(0);
    let polemark = env!("CARGO_BIN_EXE_polemark");
    let status = std::process::Command::new("sh")
        .args(["-c", &format!("ulimit -f 1; exec '{polemark}' marks out --out marks.yaml")])
        .current_dir(program.folder.path())
        .stderr(std::process::Stdio::null())
        .status()
        .unwrap();
    assert!(!status.success() && !program.path("marks.yaml").exists());
    program.run(&["marks", "out", "--out", "marks.yaml"]).ends_with(0);
    assert!(
        program.run(&["marks", "out", "--out", "marks.yaml"]).ends_with(2).err.contains("is there already")
    );
}

#[test]
fn a_table_in_another_encoding_is_refused_with_what_to_do() {
    let program = class();
    for (option, text) in [
        ("--roster", &b"id,name\nEE-1,J\xf6rg\n"[..]),
        ("--marks", b"student_id,item,points,reason\nEE-1,viva,3,gr\xfcn\n"),
    ] {
        fs::write(program.path("x.csv"), text).unwrap();
        refused(
            &program,
            &["grade", "in", "--out", "out", option, "x.csv"],
            "save it as CSV in UTF-8 (in Excel: “CSV UTF-8”)",
        );
    }
}

#[test]
fn a_marks_file_among_the_answers_is_pointed_out() {
    let program = class();
    program.write("in/marks.yaml", "students:\n  EE-1: {viva: 3}\n");
    let told = program.run(&["grade", "in", "--out", "out"]).ends_with(0).err;
    assert_eq!(
        told,
        "warning: `in/marks.yaml` looks like a marks file and is read as answers; if it is one, give it with `--marks`\n"
    );
    let ran = program.run(&["grade", "in", "--out", "out", "--marks", "in/marks.yaml"]).ends_with(0);
    assert!(ran.out.starts_with("2 submissions marked") && ran.err.is_empty(), "{}{}", ran.out, ran.err);
}

#[test]
fn lateness_that_costs_nothing_is_pointed_out() {
    let program = class();
    program.write("late.csv", "student_id,item,group,points\nEE-1,late,,yes\n");
    program.write("rule.yaml", "late: {points: 5}\n");
    let late = ["grade", "in", "--out", "out", "--marks", "late.csv", "--marks", "rule.yaml"];
    assert!(
        program
            .run(&late[..6])
            .ends_with(0)
            .err
            .starts_with("warning: the marks say that `EE-1` is late, and not")
    );
    assert_eq!(program.run(&late).ends_with(0).err, "");
}
