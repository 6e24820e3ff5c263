//! A second run into the same folder, and runs that are stopped on the way.

use crate::program::{Program, files_below, samples};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

const SMALL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/small.yaml");

/// The files of an output folder that are for people.
fn shown(out: &Path) -> BTreeMap<String, Vec<u8>> {
    files_below(out).into_iter().filter(|(name, _)| !name.starts_with(".polemark")).collect()
}

#[track_caller]
fn assert_same(one: &Path, two: &Path) {
    let (one, two) = (shown(one), shown(two));
    assert_eq!(one.keys().collect::<Vec<_>>(), two.keys().collect::<Vec<_>>());
    for (name, bytes) in &one {
        assert!(two[name] == *bytes, "{name} differs");
    }
}

/// The sample class in a folder where it may be changed.
fn class(program: &Program) -> PathBuf {
    let folder = program.path("in");
    fs::create_dir(&folder).unwrap();
    for (name, bytes) in files_below(&samples()) {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

#[track_caller]
fn grade(program: &Program, out: &str, more: &[&str]) -> String {
    let mut arguments = vec!["grade", "in", "--out", out];
    arguments.extend(more);
    program.run(&arguments).ends_with(0).out
}

#[test]
fn only_what_changed_is_marked_again_and_nothing_shows_it() {
    let program = Program::new();
    let folder = class(&program);
    let first = grade(&program, "out", &[]);
    assert!(!first.contains("as the last run left"), "{first}");
    let files = fs::read_dir(&folder).unwrap().filter_map(|e| e.unwrap().file_name().into_string().ok());
    let files = files.filter(|name| name.ends_with(".yaml")).count();
    let again = grade(&program, "out", &[]);
    assert!(again.contains(&format!("{files} are as the last run left them")), "{again}");

    let edit = |name: &str, change: &dyn Fn(String) -> String| {
        let path = folder.join(name);
        fs::write(&path, change(fs::read_to_string(&path).unwrap())).unwrap();
    };
    // An answer, a picture beside one, a file that is gone, a new one, a report that somebody wrote into, a second file of a student.
    edit("gravity_10.yaml", &|text| text.replace("stable", "unstable"));
    fs::copy(folder.join("figure_only_scope1.png"), folder.join("figure_only_scope2.png")).unwrap();
    fs::remove_file(folder.join("blank.yaml")).unwrap();
    fs::copy(folder.join("negations.yaml"), folder.join("again.yaml")).unwrap();
    let report = fs::read_dir(program.path("out/reports")).unwrap().next().unwrap().unwrap().path();
    fs::write(&report, "mine").unwrap();
    let partly = grade(&program, "out", &[]);
    grade(&program, "fresh", &[]);
    assert_same(&program.path("out"), &program.path("fresh"));
    let kept: usize = partly
        .lines()
        .find_map(|line| line.trim().strip_suffix(" are as the last run left them: nothing has changed"))
        .expect("some are kept")
        .parse()
        .unwrap();
    // Of the files there, three were changed, one was added and makes another one a student's second, one report was not as it was.
    assert!((files - 6..=files - 4).contains(&kept), "{kept} of {files}: {partly}");

    // Marks by hand, and then other ones.
    for points in ["30", "31"] {
        let marks = format!("students:\n  EE-002:\n    viva: {points}\n");
        let marks = program.write("marks.yaml", &marks);
        let marks = ["--marks", marks.to_str().unwrap()];
        grade(&program, "out", &marks);
        fs::remove_dir_all(program.path("fresh")).unwrap();
        grade(&program, "fresh", &marks);
        assert_same(&program.path("out"), &program.path("fresh"));
    }
    let scratch = grade(&program, "out", &["--from-scratch"]);
    assert!(!scratch.contains("as the last run left"), "{scratch}");
}

#[test]
fn what_is_kept_may_be_broken_without_harm() {
    let program = Program::new();
    class(&program);
    grade(&program, "fresh", &[]);
    grade(&program, "out", &[]);
    let results = program.path("out/results.jsonl");
    let kept = program.path("out/.polemark/kept.jsonl");
    let text = fs::read_to_string(&results).unwrap();
    for broken in ["", "{}\n", "\u{0}\n\n{\"name\": 1}\n"] {
        fs::write(&kept, broken).unwrap();
        grade(&program, "out", &[]);
        assert_same(&program.path("out"), &program.path("fresh"));
    }
    // A mark that somebody changed in the results comes back as it was.
    fs::write(&results, text.replacen("\"earned\":", "\"earned\":9", 3)).unwrap();
    grade(&program, "out", &[]);
    assert_same(&program.path("out"), &program.path("fresh"));
    fs::write(&kept, fs::read_to_string(&kept).unwrap().replace("\"at\":", "\"at\":9")).unwrap();
    grade(&program, "out", &[]);
    assert_same(&program.path("out"), &program.path("fresh"));
}

/// A class for `small.yaml` in which no two answers are alike.
fn write_small_class(folder: &Path, students: usize) {
    fs::create_dir(folder).unwrap();
    for number in 0..students {
        let text = format!(
            "student: {{id: S-{number:04}, name: \"A. Student\"}}\nanswers:\n  spring.poles: [2.{number:03}j, -2j]\n"
        );
        fs::write(folder.join(format!("{number:04}.yaml")), text).unwrap();
    }
}

/// Nothing that is seen may be half, whenever the run ended.
#[track_caller]
fn assert_whole(out: &Path, students: usize) {
    if !out.exists() {
        return;
    }
    for (name, bytes) in shown(out) {
        let text = String::from_utf8(bytes).unwrap();
        match name.as_str() {
            "results.jsonl" => {
                assert_eq!(text.lines().count(), students);
                for line in text.lines() {
                    polemark::class::Record::from_line(line).unwrap();
                }
            }
            "run.json" => assert!(text.ends_with("}\n")),
            "gradebook.csv" => assert_eq!(text.lines().count(), students + 1),
            _ => {
                assert!(name.ends_with(".html"), "{name} should not be here");
                assert!(text.trim_end().ends_with("</html>"), "{name} is half");
            }
        }
    }
}

const LOOK: Duration = Duration::from_millis(2);

/// Ends runs at `kills` moments of a run, from the first to the last, one after another in one folder; the last one finishes.
fn kill_often(kills: u32, students: usize) {
    let program = Program::new();
    let folder = program.path("in");
    write_small_class(&folder, students);
    let grade = |out: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_polemark"));
        command.current_dir(program.folder.path()).args(["grade", "in", "--lab", SMALL, "--out", out]);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    // How often one can look until a whole run is over.
    let mut looks = 0_u64;
    let mut whole = grade("fresh").spawn().unwrap();
    while whole.try_wait().unwrap().is_none() {
        std::thread::sleep(LOOK);
        looks += 1;
    }
    assert!(whole.wait().unwrap().success());
    let out = program.path("out");
    let mut seed = 361_u64;
    let mut on_the_way = 0;
    for kill in 0..kills {
        if kill % 10 == 9 {
            // Something to do again: another answer, and now and then an empty folder.
            let path = folder.join(format!("{:04}.yaml", kill as usize % students));
            let text = fs::read_to_string(&path).unwrap();
            fs::write(&path, format!("{text}\n")).unwrap();
        }
        if kill % 7 == 6 {
            fs::remove_dir_all(&out).unwrap();
        }
        // Any generator will do that spreads the moments over the run.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let moment = (seed >> 33) % (looks + 1);
        let mut run = grade("out").spawn().unwrap();
        (0..moment).for_each(|_| std::thread::sleep(LOOK));
        run.kill().unwrap();
        run.wait().unwrap();
        assert_whole(&out, students);
        on_the_way += u32::from(polemark::class::is_unfinished(&out));
    }
    // Otherwise this would have tried nothing.
    assert!(on_the_way >= kills / 20, "{on_the_way} of {kills}");
    assert!(grade("out").status().unwrap().success());
    assert!(grade("fresh").status().unwrap().success());
    assert_same(&out, &program.path("fresh"));
    assert_eq!(files_below(&out.join(".polemark")).keys().collect::<Vec<_>>(), ["kept.jsonl", "lock"]);
}

#[test]
fn a_run_may_be_killed_at_any_moment() {
    kill_often(100, 150);
}

#[test]
fn two_runs_do_not_write_into_one_folder() {
    let program = Program::new();
    class(&program);
    let busy = program.path("out/.polemark");
    fs::create_dir_all(&busy).unwrap();
    let lock = fs::File::create(busy.join("lock")).unwrap();
    lock.lock().unwrap();
    let refused = program.run(&["grade", "in", "--out", "out"]).ends_with(2);
    assert!(refused.err.contains("another polemark is writing into `out`"), "{}", refused.err);
    drop(lock);
    grade(&program, "out", &[]);
}
