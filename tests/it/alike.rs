//! Like answers: which are together, and what one decision does for them.

use crate::program::run_in;
use polemark::grading::{self, Catalogue, HandMarksFile, ItemScore};
use polemark::lab::{self, LabDefinition, Points};
use polemark::reference::Reference;
use polemark::source::SourceText;
use polemark::submission::{self, NoFiles};
use std::sync::OnceLock;

fn bench() -> &'static (LabDefinition, Reference) {
    static BENCH: OnceLock<(LabDefinition, Reference)> = OnceLock::new();
    BENCH.get_or_init(|| {
        let lab = lab::load(lab::DEFAULT).expect("the embedded lab is right");
        let reference = Reference::compute(&lab).expect("the lab has a reference");
        (lab, reference)
    })
}

/// The mark of `criterion` when `answers` (lines apart by `; `) come in a file of this name, with these marks by hand.
fn item(file: &str, answers: &str, criterion: &str, marks: &str) -> ItemScore {
    let (lab, reference) = bench();
    let answers: String = answers.split("; ").map(|line| format!("  {line}\n")).collect();
    let text = format!("lab: ee361-lab3\nstudent: {{id: EE-1, name: A}}\nanswers:\n{answers}");
    let submission = submission::read(file, &format!("{file}.yaml"), text.as_bytes(), &lab.sheet, &NoFiles);
    assert_eq!(submission.findings, [], "{answers}");
    let (by_hand, findings) = HandMarksFile::parse(&SourceText::new("marks.yaml", marks), lab);
    assert_eq!(findings, [], "{marks}");
    let hand = Some(by_hand.marks_for("EE-1"));
    let card = grading::grade(lab, reference, &Catalogue::default(), &submission, hand);
    let mut items = card.questions.into_iter().flat_map(|question| question.items);
    items.find(|item| item.id == criterion).unwrap_or_else(|| panic!("no criterion `{criterion}`"))
}

fn group(answers: &str, criterion: &str) -> Option<String> {
    let one = item("one", answers, criterion, "");
    let other = item("other name", answers, criterion, "");
    assert_eq!(one.alike, other.alike, "the file's name makes a difference: {answers}");
    one.alike
}

#[test]
fn like_answers_are_together() {
    const OSCILLATES: &str = "expect_hanging.oscillates";
    const DESCRIPTION: &str = "hanging.response.description";
    for (criterion, one, other, together) in [
        // the same is claimed
        (OSCILLATES, "expect_hanging: It swings.", "expect_hanging: It will swing for a while.", true),
        (
            OSCILLATES,
            "expect_hanging: It swings.",
            "expect_hanging: It wobbles about; expect_upright: It falls.",
            true,
        ),
        (OSCILLATES, "expect_hanging: It swings.", "expect_hanging: It does not oscillate.", false),
        (OSCILLATES, "expect_hanging: It swings.", "expect_hanging: It falls over.", false),
        (OSCILLATES, "expect_hanging: It does not oscillate.", "expect_hanging: It never oscillates.", true),
        // nothing is found: the words themselves
        (OSCILLATES, "expect_hanging: It tips.", "expect_hanging: it tips!", true),
        (OSCILLATES, "expect_hanging: It tips.", "expect_hanging: It tumbles.", false),
        (OSCILLATES, "expect_hanging: about $x = 1$", "expect_hanging: about $x = 2$", false),
        // and what they do not go with
        (
            DESCRIPTION,
            "hanging.response.description: It decays and is stable.",
            "hanging.response.description: It decays and is marginally stable.",
            false,
        ),
        (
            DESCRIPTION,
            "hanging.response.description: It is damped.",
            "hanging.response.description: It decays; hanging.response.final_value: unbounded",
            false,
        ),
        (
            DESCRIPTION,
            "hanging.response.description: It is damped; hanging.response.final_value: 1",
            "hanging.response.description: It decays; hanging.response.final_value: 0",
            true,
        ),
    ] {
        let (first, second) = (group(one, criterion), group(other, criterion));
        assert!(first.is_some() && second.is_some(), "{one} / {other}");
        assert_eq!(first == second, together, "{one} / {other}: {first:?} {second:?}");
    }
}

#[test]
fn groups_have_names_that_stay() {
    for (criterion, answers, name) in [
        ("expect_hanging.oscillates", "expect_hanging: It swings.", Some("said-")),
        ("expect_hanging.settles", "expect_hanging: It swings.", Some("text-")),
        ("expect_hanging.settles", "expect_hanging: ''", None),
        ("battery.nonlinearity.class", "battery.nonlinearity: dead zone", None),
        ("hanging.response.stability", "hanging.response.stability: stable", None),
    ] {
        let group = group(answers, criterion);
        let kind = group.as_deref().map(|id| id.split_inclusive('-').next().unwrap_or(id));
        assert_eq!(kind, name, "{answers}: {group:?}");
        let digits = group.as_deref().and_then(|id| id.split_once('-')).map(|(_, digits)| digits.len());
        assert_eq!(digits, name.map(|_| 8), "{answers}: {group:?}");
    }
    // The same words are another group at another criterion.
    let answers = "expect_hanging: It tips.";
    assert_ne!(group(answers, "expect_hanging.oscillates"), group(answers, "expect_hanging.settles"));
}

#[test]
fn one_decision_serves_a_group_and_a_students_own_mark_comes_first() {
    const CRITERION: &str = "expect_hanging.oscillates";
    const TIPS: &str = "expect_hanging: It jiggles a bit.";
    let id = group(TIPS, CRITERION).expect("provisional");
    let decided = format!("alike: {{{CRITERION}: {{{id}: {{points: 1, reason: jiggling is swinging}}}}}}\n");
    let own = "students: {EE-1: {items: {expect_hanging.oscillates: {points: 0.5, reason: in person}}}}\n";
    let other = "students: {EE-1: {viva: 30}}\n";
    for (answers, marks, points, code, reason) in [
        (TIPS, String::new(), 0, "concepts.missing", None),
        (TIPS, decided.clone(), 100, "by_hand", Some("jiggling is swinging")),
        ("expect_hanging: It JIGGLES a bit!", decided.clone(), 100, "by_hand", Some("jiggling is swinging")),
        ("expect_hanging: It tips.", decided.clone(), 0, "concepts.missing", None),
        ("expect_hanging: ''", decided.clone(), 0, "blank", None),
        (TIPS, format!("{own}{decided}"), 50, "by_hand", Some("in person")),
        (TIPS, format!("{decided}{other}"), 100, "by_hand", Some("jiggling is swinging")),
    ] {
        let item = item("one", answers, CRITERION, &marks);
        let got = (item.earned, item.code, item.override_reason.as_deref());
        assert_eq!(got, (Points(points), code, reason), "{answers} {marks}");
        assert_eq!(item.provisional, code.starts_with("concepts"), "{answers} {marks}");
        assert!(item.alike.is_some() || code == "blank", "{answers} {marks}");
    }
}

#[test]
fn a_decision_for_nobody_is_told_with_its_place() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write(
        "a.yaml",
        "lab: ee361-lab3\nstudent: {id: EE-1, name: A}\nanswers:\n  expect_hanging: It jiggles a bit.\n",
    );
    let id = group("expect_hanging: It jiggles a bit.", "expect_hanging.oscillates").expect("provisional");
    write(
        "marks.yaml",
        &format!(
            "lab: ee361-lab3\nalike:\n  expect_hanging.oscillates:\n    {id}: {{points: 1, reason: it is a swing}}\n    \
             text-00000000: {{points: 0, reason: nobody says so}}\n"
        ),
    );
    let arguments = ["grade", "a.yaml", "--marks", "marks.yaml", "--out", "out"];
    let told = run_in(folder.path(), &arguments).ends_with(0).err;
    assert!(told.contains("marks.yaml:5:5") && told.contains("text-00000000"), "{told}");
    assert!(!told.contains(&id), "{told}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).expect("written");
    let results: serde_json::Value = serde_json::from_str(&read("results.jsonl")).expect("JSON");
    let items = results["items"].as_array().expect("items");
    let named = |name: &str| items.iter().find(|item| item["id"] == name).expect("marked");
    assert_eq!(named("expect_hanging.oscillates")["code"], "by_hand");
    assert_eq!(named("expect_hanging.oscillates")["alike"], *id);
    let other = named("expect_hanging.settles")["alike"].as_str().expect("a group");
    let page = read("index.html");
    assert!(page.contains(other) && !page.contains(&id), "{other}");
}
