//! What students get of an instructor's own lab: `check` says the same with it as with the lab itself.

use crate::program::told_in as run;
use polemark::lab::{self, LabDefinition};
use std::path::{Path, PathBuf};

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// What `check` says of some files with a lab, which is what it says with the student edition.
#[track_caller]
fn same_with_the_edition(lab: &str, files: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let roster = folder.path().join("roster.csv");
    std::fs::write(&roster, "id,name\nME-001,Ada\n").expect("written");
    let (code, told) = run(folder.path(), &["handout", lab, "--roster", "roster.csv", "--out", "."]);
    assert_eq!(code, Some(0), "{told}");
    let id = lab::load(lab).expect("a lab").id;
    let edition = format!("{id}.student.yaml");
    let whole = run(folder.path(), &[&["check", "--lab", lab][..], files].concat());
    // In the folder of a student, who has nothing else of the lab.
    let own = folder.path().join("ME-001");
    let place = if own.exists() { own } else { folder.path().to_path_buf() };
    let by_edition = run(&place, &[&["check", "--lab", &edition][..], files].concat());
    assert!(whole.1.contains(" read, "), "{}", whole.1);
    assert_eq!(by_edition, whole);
    whole.1
}

#[test]
fn the_sample_submissions_read_alike() {
    let mut files: Vec<String> = std::fs::read_dir(here("submissions"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path().display().to_string())
        .filter(|path| path.ends_with(".yaml"))
        .collect();
    files.sort();
    assert!(files.len() > 20);
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let told = same_with_the_edition(lab::DEFAULT, &files);
    assert!(told.contains("do not agree") && told.contains("we take as"), "{told}");
}

#[test]
fn the_model_answers_of_every_lab_read_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let others = ["held_ball", "letters", "linear", "rest", "small", "tangent", "variants"];
    let others = others.map(|name| here(&format!("tests/it/{name}.yaml")).display().to_string());
    let shelf = lab::embedded().iter().map(|(id, _)| (*id).to_owned());
    for name in shelf.chain(others) {
        let LabDefinition { id, model_answer, .. } = lab::load(&name).expect("a lab");
        let file = folder.path().join(format!("{id}.yaml"));
        std::fs::write(&file, &model_answer.source.text).expect("written");
        same_with_the_edition(&name, &[&file.display().to_string()]);
    }
}

const OWN: &str = include_str!("held_ball.yaml");

/// The rest values that are to be found stand neither on the sheet nor in what `check` says.
#[test]
fn what_is_to_be_found_is_told_nowhere() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("lab.yaml"), OWN).expect("written");
    let (code, told) = run(folder.path(), &["handout", "lab.yaml", "--out", "."]);
    assert_eq!(code, Some(0), "{told}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("written");
    let sheet = read("handout.html");
    assert!(
        sheet.contains("<code>polemark check answers.yaml --lab held-ball.student.yaml</code>"),
        "{sheet}"
    );
    // The ball of 0.04 kg is held at 0.01 m by 2 A.
    let at_rest = |name: &str| sheet.matches(&format!("<mi>{name}</mi></mrow></math> = <math>")).count();
    assert_eq!((at_rest("x"), at_rest("i")), (1, 1), "x of the ball and i of the other: {sheet}");
    let answers = "lab: held-ball\nstudent: {id: a, name: b}\nanswers:\n  ball.transfer_function: i_0/(s + 1)\n  ball.poles: [-1]\n";
    std::fs::write(folder.path().join("answers.yaml"), answers).expect("written");
    for lab in ["lab.yaml", "held-ball.student.yaml"] {
        let (_, told) = run(folder.path(), &["check", "answers.yaml", "--lab", lab]);
        assert!(told.contains("ball.transfer_function: i_0/(s + 1)"), "{told}");
        assert!(!told.contains("do not agree"), "{told}");
    }
    assert!(
        run(folder.path(), &["check", "answers.yaml", "--lab", "lab.yaml"])
            == run(folder.path(), &["check", "answers.yaml", "--lab", "held-ball.student.yaml"])
    );
}

#[test]
fn everything_else_asks_for_the_lab_itself() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("lab.yaml"), OWN).expect("written");
    run(folder.path(), &["handout", "lab.yaml", "--out", "."]);
    const FILE: &str = "held-ball.student.yaml";
    for arguments in [
        &["grade", "answers.yaml", "--lab", FILE, "--out", "out"][..],
        &["reference", FILE],
        &["verify", FILE],
        &["new", FILE],
        &["handout", FILE, "--out", "again"],
    ] {
        let (code, told) = run(folder.path(), arguments);
        assert_eq!(code, Some(1), "{told}");
        assert!(told.contains("this is the student edition of a lab"), "{told}");
        assert!(told.contains("held-ball.student.yaml:3:1"), "{told}");
    }
}

/// With one file for all, everyone's letters have the values of their own.
#[test]
fn everyone_has_values_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut files = Vec::new();
    for id in ["ME-001", "ME-002", "me 017"] {
        let file = folder.path().join(format!("{id}.yaml"));
        let text = format!(
            "lab: pendulum-of-ones-own\nstudent: {{id: {id}, name: x}}\nanswers:\n  down.transfer_function: 1/(m*l^2*s^2 + b*s + m*g*l)\n  down.response.poles: [-1, -2]\n"
        );
        std::fs::write(&file, text).expect("written");
        files.push(file.display().to_string());
    }
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let lab = here("tests/it/variants.yaml").display().to_string();
    let told = same_with_the_edition(&lab, &files);
    assert!(
        told.contains("The values of ME-001 are m = ") && told.contains("The values of me 017 are"),
        "{told}"
    );
}
