//! The program as its users run it: every verb, its outputs and its exit codes.

use crate::program::{Program, files_below, samples};
use std::path::Path;
use std::process::Command;

fn embedded_lab() -> &'static str {
    polemark::lab::embedded().iter().find(|(id, _)| *id == polemark::lab::DEFAULT).expect("embedded").1
}

#[test]
fn grade_writes_four_outputs_for_every_file_and_the_same_bytes_every_time() {
    let bench = Program::new();
    let samples = samples();
    let count = files_below(&samples).keys().filter(|name| name.ends_with(".yaml")).count();
    assert!(count >= 15);
    let source = samples.to_string_lossy();
    bench.run(&["grade", &source, "--out", "one", "--threads", "1"]).ends_with(0);
    bench.run(&["grade", &source, "--out", "two", "--threads", "2"]).ends_with(0);

    let first = files_below(&bench.path("one"));
    assert_eq!(first, files_below(&bench.path("two")), "one thread or two must not matter");
    let reports = first.keys().filter(|name| name.starts_with("reports/")).count();
    let results = String::from_utf8(first["results.jsonl"].clone()).expect("UTF-8");
    assert_eq!(reports, count);
    assert_eq!(results.lines().count(), count);
    let gradebook = String::from_utf8(first["gradebook.csv"].clone()).expect("UTF-8");
    assert!(gradebook.lines().count() > count, "a header and at least a row a file");
    let index = String::from_utf8(first["index.html"].clone()).expect("UTF-8").replace("&#x2f;", "/");
    for report in first.keys().filter(|name| name.starts_with("reports/")) {
        assert!(index.contains(report.as_str()), "the class page links {report}");
    }
}

#[test]
fn reports_stand_alone_and_carry_no_script() {
    let bench = Program::new();
    bench.run(&["grade", &samples().to_string_lossy(), "--out", "out"]).ends_with(0);
    for (name, bytes) in files_below(&bench.path("out")) {
        if !name.ends_with(".html") {
            continue;
        }
        let mut page = String::from_utf8(bytes).expect("UTF-8").to_lowercase();
        // The class page sorts its tables by a script of fixed text.
        if name == "index.html" {
            let script =
                format!("<script>{}</script>", include_str!("../../templates/tables.js").to_lowercase());
            assert_eq!(page.matches(&script).count(), 1);
            page = page.replace(&script, "");
        }
        for forbidden in [
            "<script",
            "<iframe",
            "<object",
            "<link",
            "src=\"http",
            "@import",
            "url(http",
            "=\"javascript:",
            "\u{1b}",
        ] {
            assert!(!page.contains(forbidden), "{name} contains {forbidden}");
        }
        let tags_with_handlers = page.split('<').filter(|tag| {
            let tag = tag.split('>').next().unwrap_or_default();
            tag.contains(" onload=") || tag.contains(" onerror=") || tag.contains(" onclick=")
        });
        assert_eq!(tags_with_handlers.count(), 0, "{name} has an event handler");
    }
}

#[test]
fn a_line_of_results_has_the_promised_shape() {
    let bench = Program::new();
    let file = samples().join("model-answer.yaml");
    bench.run(&["grade", &file.to_string_lossy(), "--out", "out"]).ends_with(0);
    let text = std::fs::read_to_string(bench.path("out/results.jsonl")).expect("written");
    let line: serde_json::Value = serde_json::from_str(text.trim()).expect("JSON");
    assert_eq!(line["submission"], "model-answer");
    assert_eq!(line["total"]["earned"], line["total"]["possible"]);
    assert!(line["total"]["provisional"].is_number());
    assert!(line["students"][0]["id"].is_string() && line["students"][0]["name"].is_string());
    for item in line["items"].as_array().expect("items") {
        assert!(item["id"].is_string() && item["verdict"].is_string() && item["code"].is_string());
        assert!(item["earned"].is_number() && item["possible"].is_number());
        assert!(item["line"].is_number() && item["column"].is_number(), "{item}");
        let reason = item["evidence"]["reason"].as_str().expect("a reason");
        assert!(!reason.is_empty(), "{item}");
    }
    assert!(line["findings"].as_array().expect("findings").is_empty());
}

#[test]
fn a_wrong_transfer_function_comes_with_what_explains_it() {
    let bench = Program::new();
    let file = samples().join("seed-report.yaml");
    bench.run(&["grade", &file.to_string_lossy(), "--out", "out"]).ends_with(0);
    let text = std::fs::read_to_string(bench.path("out/results.jsonl")).expect("written");
    let line: serde_json::Value = serde_json::from_str(text.trim()).expect("JSON");
    let items = line["items"].as_array().expect("items");
    let diagnosed: Vec<_> = items.iter().filter(|item| !item["diagnosis"].is_null()).collect();
    for (item, (id, code, changes)) in diagnosed.iter().zip([
        (
            "hanging.transfer_function.denominator",
            "term.sign+slip.digit",
            serde_json::json!([
                "g = 9.8",
                "equation 2: m*g*l*sin(theta) -> -m*g*l*sin(theta)",
                "0.4116 -> 0.4166"
            ]),
        ),
        (
            "upright.transfer_function.denominator",
            "slip.digit",
            serde_json::json!(["g = 9.8", "0.4116 -> 0.4166"]),
        ),
    ]) {
        let explanations = item["diagnosis"]["explanations"].as_array().expect("explanations");
        assert_eq!((item["id"].as_str(), explanations.len()), (Some(id), 1), "{item}");
        assert_eq!((explanations[0]["code"].as_str(), &explanations[0]["changes"]), (Some(code), &changes));
        assert!(item["diagnosis"]["searched"].as_u64() > Some(60), "{item}");
    }
    assert_eq!(diagnosed.len(), 2);
    let page = std::fs::read_to_string(bench.path("out/reports/EE-001.html")).expect("written");
    let words = "With g = 9.8, the term <code>m*g*l*sin(theta)</code> of equation 2 has the wrong sign, and \
                 <code>0.4166</code> was written for <code>0.4116</code>, one digit off.";
    assert!(page.contains(words));
}

#[test]
fn the_reference_is_exact_to_every_digit_json_holds() {
    let bench = Program::new();
    let json = bench.run(&["reference", "--format", "json"]).ends_with(0).out;
    let key: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let points = &key["models"][0]["operating_points"];
    // By hand, from the equations of the handout: monic, so divided by 0.0132.
    let near = |value: &serde_json::Value, truth: f64| {
        let value = value.as_f64().expect("a number");
        assert!((value - truth).abs() <= 1e-14 * truth.abs(), "{value} is not {truth}");
    };
    for (point, gravity) in [(&points[0], 1.0), (&points[1], -1.0)] {
        let g = &point["transfer_function"];
        assert_eq!(g["num"].as_array().map(Vec::len), Some(2));
        near(&g["num"][0], -gravity * 0.06 / 0.0132);
        assert_eq!(g["num"][1], 0.0);
        near(&g["den"][0], 1.0);
        near(&g["den"][1], 0.0024 / 0.0132);
        near(&g["den"][2], gravity * 0.41202 / 0.0132);
        near(&g["den"][3], gravity * 0.05886 / 0.0132);
        for pole in point["poles"].as_array().expect("poles") {
            assert!(pole["error_bound"].as_f64().expect("a bound") < 1e-12);
            assert_eq!(pole["multiplicity"], 1);
        }
    }
    assert_eq!(points[0]["stability"], "asymptotically_stable");
    assert_eq!(points[0]["internal_stability"], "marginally_stable");
    assert_eq!(points[1]["stability"], "unstable");
    assert_eq!(points[1]["internal_stability"], "unstable");
    assert_eq!(points[0]["impulse"]["final_value"], 0.0);
    assert!(points[1]["impulse"]["final_value"].is_null());
    assert!(key["simulations"].as_array().expect("simulations").len() >= 4);
    for simulation in key["simulations"].as_array().expect("simulations") {
        assert!(simulation["samples"][0].as_array().is_some_and(|s| s.len() == 3));
        assert!(!simulation["switch_times"].as_array().expect("times").is_empty());
    }
}

#[test]
fn other_formats_of_the_key() {
    let bench = Program::new();
    let text = bench.run(&["reference"]).ends_with(0).out;
    assert!(text.contains("poles") && text.contains("stable"));
    bench.run(&["reference", "--format", "html", "--out", "key.html"]).ends_with(0);
    let page = std::fs::read_to_string(bench.path("key.html")).expect("written");
    assert!(page.contains("<svg") && page.contains("<math"));
}

#[test]
fn verify_passes_the_lab_and_fails_a_changed_copy() {
    let bench = Program::new();
    let passed = bench.run(&["verify"]).ends_with(0).out;
    assert!(passed.contains("proven"));
    let copy = bench.write("copy/lab.yaml", embedded_lab());
    bench.run(&["verify", &copy.to_string_lossy()]).ends_with(0);
    let changed = embedded_lab().replace("0.2083", "0.2084");
    assert_ne!(changed, embedded_lab());
    let changed = bench.write("changed/lab.yaml", &changed);
    let failed = bench.run(&["verify", &changed.to_string_lossy()]).ends_with(1).out;
    assert!(failed.contains("FAIL"), "{failed}");
}

#[test]
fn the_template_is_blank_and_welcome() {
    let bench = Program::new();
    let template = bench.run(&["new"]).ends_with(0).out;
    let named = template.replacen("  id:\n  name:\n", "  id: EE-1\n  name: A. Student\n", 1);
    let file = bench.write("answers.yaml", &named);
    let checked = bench.run(&["check", &file.to_string_lossy()]).ends_with(0).out;
    assert!(checked.contains("0 answers read, 0 to look at"), "{checked}");
    // A file that may hold answers is never overwritten.
    bench.run(&["new", "--out", "answers.yaml"]).ends_with(2);
    assert_eq!(std::fs::read_to_string(&file).expect("still there"), named);
}

#[test]
fn check_finds_what_cannot_be_read_and_says_where() {
    let bench = Program::new();
    let file = bench.write(
        "answers.yaml",
        "lab: ee361-lab3\nstudent: {id: EE-1, name: A. Student}\nanswers:\n  hanging.response:\n    poles: [-2+j3..1]\n",
    );
    let ran = bench.run(&["check", &file.to_string_lossy()]).ends_with(1);
    assert!(ran.out.contains(":5:"), "{}", ran.out);
    assert!(ran.out.contains('^'), "{}", ran.out);
}

#[test]
fn check_finds_contradictions_within_a_file() {
    let bench = Program::new();
    let file = bench.write(
        "answers.yaml",
        "lab: ee361-lab3\nstudent: {id: EE-1, name: A. Student}\nanswers:\n  hanging.response:\n    poles: [2, -3]\n    stability: stable\n",
    );
    bench.run(&["check", &file.to_string_lossy()]).ends_with(1);
}

/// Without `--lab` each file is read as an answer to the lab it names, however that is written.
#[test]
fn check_takes_the_embedded_lab_that_a_file_names() {
    let bench = Program::new();
    let files = ["lab: cruise-control", "lab: 'ball-and-beam' # mine", "student: {id: S-2}\nlab: suspension"];
    let names = ["cruise-control", "ball-and-beam", "suspension"];
    for (lab, name) in files.into_iter().zip(names) {
        let student = if lab.starts_with("student") { "" } else { "student: {id: S-1, name: A. Student}\n" };
        let file = bench.write("answers.yaml", &format!("{lab}\n{student}answers: {{}}\n"));
        let ran = bench.run(&["check", &file.to_string_lossy()]);
        assert!(!ran.out.contains("ee361-lab3"), "{name}: {}", ran.out);
        let named = polemark::lab::load(name).expect("it is on the shelf");
        let first = &named.sheet.fields.first().expect("something is asked").path;
        assert!(ran.out.contains(first.as_str()), "{name}, {first}: {}", ran.out);
    }
}

/// `check` is built without the reference: another key must not change one byte of what it says.
#[test]
fn check_cannot_leak_the_key() {
    let bench = Program::new();
    let answers = "lab: ee361-lab3\nstudent: {id: EE-1, name: A. Student}\nanswers:\n  hanging.transfer_function: -0.06s/(0.0132s^3+0.0024s^2+0.412s+0.0589)\n  hanging.response: {stability: unstable, poles: [-1], final_value: 3}\n";
    let file = bench.write("answers.yaml", answers);
    let right = bench.write("right/lab.yaml", embedded_lab());
    let other = embedded_lab().replace("0.2083", "0.3").replace("m*g*l*sin(theta)", "2*m*g*l*sin(theta)");
    assert_ne!(other, embedded_lab());
    let other = bench.write("other/lab.yaml", &other);
    let said = |lab: &Path| bench.run(&["check", &file.to_string_lossy(), "--lab", &lab.to_string_lossy()]);
    let (a, b) = (said(&right), said(&other));
    assert_eq!((a.code, a.out), (b.code, b.out));
}

#[test]
fn exit_codes_say_whose_fault_it_is() {
    let bench = Program::new();
    let broken_lab = bench.write("broken/lab.yaml", "id: [");
    let malformed = samples().join("malformed.yaml");
    let malformed = malformed.to_string_lossy();
    let check = |arguments: &[&str], code: i32, said: &str| {
        let ran = bench.run(arguments).ends_with(code);
        assert!(ran.err.contains(said) || ran.out.contains(said), "out: {}\nerr: {}", ran.out, ran.err);
    };
    check(&["grade", &malformed, "--out", "o1"], 0, "could not be read");
    check(&["grade", &malformed, "--out", "o2", "--strict"], 1, "could not be read");
    check(&["check", &malformed], 1, "malformed.yaml");
    check(&["verify", &broken_lab.to_string_lossy()], 1, "error");
    check(&["verify", "ee361-lab4"], 2, "ee361-lab3");
    check(&["grade", "no/such/folder", "--out", "o3"], 2, "does not exist");
    check(&["grade", "--out", "o4"], 2, "PATH");
    check(&["check", "no-such-file.yaml"], 2, "no-such-file.yaml");
}

#[test]
fn marks_given_by_a_person_count_and_make_the_cover_whole() {
    let bench = Program::new();
    let file = bench.write("a.yaml", "lab: ee361-lab3\nstudent: {id: EE-1, name: A. Student}\nanswers:\n  speaker.nonlinearity: saturation\n");
    let lab = polemark::lab::load(polemark::lab::DEFAULT).expect("embedded");
    let observed: Vec<String> = lab.observed.iter().map(|row| format!("{}: 4", row.id)).collect();
    let marks = bench.write(
        "marks.yaml",
        &format!(
            "lab: ee361-lab3\nstudents:\n  EE-1:\n    viva: 30\n    observed: {{{}}}\n    items:\n      expect_hanging.oscillates: {{points: 1, reason: said so in the viva}}\n",
            observed.join(", ")
        ),
    );
    bench
        .run(&["grade", &file.to_string_lossy(), "--marks", &marks.to_string_lossy(), "--out", "out"])
        .ends_with(0);
    let mut rows = csv::Reader::from_path(bench.path("out/gradebook.csv")).expect("written");
    let headers = rows.headers().expect("headers").clone();
    let row = rows.records().next().expect("a row").expect("read");
    let value = |name: &str| {
        let at = headers.iter().position(|h| h.starts_with(name)).expect("a column");
        row[at].to_owned()
    };
    // Two of 45 by answers, 28 of 35 observed: 65 · 30 / 80 = 24.375, and 30 for the viva.
    assert_eq!(value("earned"), "2");
    assert_eq!(value("cover.total"), "54.38");
    let wrong = bench.write("wrong.yaml", "lab: ee361-lab3\nstudents:\n  EE-1:\n    viva: 99\n");
    bench
        .run(&["grade", &file.to_string_lossy(), "--marks", &wrong.to_string_lossy(), "--out", "out2"])
        .ends_with(1);
}

/// Two who hand in together may still be asked different questions in the viva.
#[test]
fn members_of_a_group_keep_their_own_marks_by_hand() {
    let bench = Program::new();
    let answers = "lab: ee361-lab3\nstudents:\n  - {id: EE-1, name: A. Student}\n  - {id: EE-2, name: B. Learner}\nanswers:\n  speaker.nonlinearity: saturation\n";
    let file = bench.write("group.yaml", answers);
    let marks =
        bench.write("marks.yaml", "lab: ee361-lab3\nstudents:\n  EE-1: {viva: 30}\n  EE-2: {viva: 12}\n");
    bench
        .run(&["grade", &file.to_string_lossy(), "--marks", &marks.to_string_lossy(), "--out", "out"])
        .ends_with(0);
    let mut rows = csv::Reader::from_path(bench.path("out/gradebook.csv")).expect("written");
    let viva =
        rows.headers().expect("headers").iter().position(|h| h.starts_with("cover.viva")).expect("a column");
    let vivas: Vec<(String, String)> = rows
        .records()
        .map(|row| row.expect("read"))
        .map(|row| (row[0].to_owned(), row[viva].to_owned()))
        .collect();
    let wanted = [("EE-1", "30"), ("EE-2", "12")].map(|(id, points)| (id.to_owned(), points.to_owned()));
    assert_eq!(vivas, wanted);
    assert!(bench.path("out/reports/EE-1.html").exists() && bench.path("out/reports/EE-2.html").exists());
}

/// A link in a folder of other people's files could quote any file of this machine in a report.
#[cfg(unix)]
#[test]
fn links_and_pipes_are_reported_not_followed() {
    let bench = Program::new();
    bench.write("class/a.yaml", "lab: ee361-lab3\nstudent: {id: EE-1, name: A. Student}\nanswers:\n");
    let secret = bench.write("secret.txt", "root: hunter2\n");
    std::os::unix::fs::symlink(&secret, bench.path("class/link.yaml")).expect("linked");
    std::os::unix::fs::symlink("nowhere", bench.path("class/dangling.yaml")).expect("linked");
    let pipe = bench.path("class/pipe.yaml");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let ran = bench.run(&["grade", "class", "--out", "out"]).ends_with(0);
    assert!(ran.out.contains("4 submissions") && ran.out.contains("3 could not be read"), "{}", ran.out);
    for bytes in files_below(&bench.path("out")).values() {
        assert!(!String::from_utf8_lossy(bytes).contains("hunter2"));
    }
    bench.run(&["check", "class/pipe.yaml"]).ends_with(2);
}

#[test]
fn ids_given_twice_and_old_reports_are_said() {
    let bench = Program::new();
    for name in ["class/a.yaml", "class/b.yaml.txt"] {
        bench.write(name, "lab: ee361-lab3\nstudent: {id: EE-1, name: A. Student}\nanswers:\n");
    }
    let first = bench.run(&["grade", "class", "--out", "out"]).ends_with(0).out;
    assert!(first.contains("several files give the id `EE-1`: a.yaml, b.yaml.txt"), "{first}");
    let results = std::fs::read_to_string(bench.path("out/results.jsonl")).expect("written");
    assert_eq!(results.matches("student.twice").count(), 1);
    bench.write("out/reports/mine.html", "not of polemark");
    let second = bench.run(&["grade", "class/a.yaml", "--out", "out"]).ends_with(0).out;
    assert!(second.contains("1 report of an answer that is not there any more was removed"), "{second}");
    assert!(!bench.path("out/reports/EE-1-2.html").exists() && bench.path("out/reports/mine.html").exists());
    assert!(second.contains("1 report of an earlier run is still in the folder"), "{second}");
}

#[test]
fn a_lab_that_cannot_be_computed_says_which_and_why() {
    let bench = Program::new();
    let lab = bench.write(
        "lab.yaml",
        &embedded_lab().replace("{limit: 5}", "{limit: 5e-324}").replace("duration_s: 12", "duration_s: 1e9"),
    );
    let ran = bench.run(&["verify", &lab.to_string_lossy()]).ends_with(1);
    assert!(ran.err.contains("simulation `backlash`") && ran.err.contains("lab.yaml"), "{}", ran.err);
}

#[test]
fn findings_are_told_in_the_formats_of_other_programs() {
    let bench = Program::new();
    let hostile = samples().join("hostile_text.yaml");
    let file = hostile.to_string_lossy();
    let told = |format: &str| bench.run(&["check", &file, "--format", format]).ends_with(1).out;
    let github = told("github");
    assert!(!github.is_empty());
    for line in github.lines() {
        let level = ["::error ", "::error::", "::warning ", "::warning::", "::notice "];
        assert!(level.iter().any(|start| line.starts_with(start)) && !line.contains("##["), "{line}");
    }
    let sarif: serde_json::Value = serde_json::from_str(&told("sarif")).expect("JSON");
    assert!(!sarif["runs"][0]["results"].as_array().expect("results").is_empty());
    let json: serde_json::Value = serde_json::from_str(&told("json")).expect("JSON");
    assert_eq!(json["verb"], "polemark check");
    let junit = told("junit");
    assert!(
        junit.starts_with("<?xml") && junit.contains("<failure") && !junit.contains("<script"),
        "{junit}"
    );

    let lab = bench.write("lab.yaml", &embedded_lab().replacen("final_value: 0", "final_value: 1", 1));
    let lab = lab.to_string_lossy();
    let told = |format: &str| bench.run(&["verify", &lab, "--format", format]).ends_with(1).out;
    assert!(told("github").contains("::error file="));
    assert!(told("junit").contains("type=\"verify.failed\""));
    let well = bench.run(&["verify", "--format", "github"]).ends_with(0).out;
    assert!(!well.contains("::error"), "{well}");
}
