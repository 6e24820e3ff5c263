//! What is asked for in letters says so wherever it is asked, and is shown in letters wherever it is answered.

use crate::bench::Bench;
use polemark::grading::grade;
use polemark::lab::LabDefinition;
use polemark::proof::to_paste;
use polemark::reference::Reference;
use polemark::report::{HandoutKit, ReportKit};
use polemark::source::SourceText;

const WANTED: &str = "in the letters A, k (or c_v), h_0 (or h), q_0 (or q)";

#[track_caller]
fn has(text: &str, wanted: &str, times: usize) {
    assert_eq!(text.matches(wanted).count(), times, "{wanted}\n{text}");
}

#[test]
fn letters_are_told_where_they_are_asked_for() {
    let lab = &Bench::letters().lab;
    let template = lab.answer_template();
    has(&template, &format!("#   {WANTED}\n"), 1);
    has(&template, "#   in the letters M, m, b, l, g\n", 1);
    has(&template, "(2p*s + q)", 2);
    // In numbers, for the third question.
    has(&template, "in the letters", 2);
    has(&template, "{num: [2, 1]", 1);
    let schema = lab.answers_schema().to_string();
    has(&schema, "(in the letters `A`, `k` (or `c_v`), `h_0` (or `h`), `q_0` (or `q`))", 1);
    has(&schema, "in the letters", 2);
    let handout = HandoutKit::new().unwrap().sheet(lab, None);
    has(&handout, "in the letters <code>A</code>, <code>k</code> (or <code>c_v</code>)", 1);
    has(&handout, "in the letters", 2);
    // Either will do.
    let either = Bench::embedded().lab.answer_template();
    assert!(either.contains("#   in numbers, or in the letters M,"), "{either}");
}

#[test]
fn what_is_right_is_shown_in_letters() {
    let bench = Bench::letters();
    let kit = ReportKit::new(&bench.lab, &bench.reference).unwrap();
    let key = kit.reference_page();
    has(&key, "(in letters)</th>", 2);
    has(&key, "in numbers</p>", 2);
    for (answers, times) in [("  level: 1/(A*s)\n", 2), ("  draining: 1/(A*s)\n", 2)] {
        let submission = bench.read(answers);
        let card = grade(&bench.lab, &bench.reference, &bench.catalogue, &submission, None);
        has(&kit.student_page(&submission, &card), "in numbers</p>", times);
    }
    // Where either will do, letters are shown to who uses them.
    let bench = Bench::embedded();
    let kit = ReportKit::new(&bench.lab, &bench.reference).unwrap();
    for (typed, times) in [("-0.06s/(0.0132s^3 + 1)", 0), ("-m*l*s/(M*s^3 + 1)", 1)] {
        let submission = bench.read(&format!("  hanging.transfer_function: {typed}\n"));
        let card = grade(&bench.lab, &bench.reference, &bench.catalogue, &submission, None);
        has(&kit.student_page(&submission, &card), "in numbers</p>", times);
    }
}

/// The lines that `verify` proposes for a lab without model answers and expectations.
fn proposed(text: &str) -> String {
    let kept: Vec<&str> = text
        .lines()
        .take_while(|line| !line.starts_with("expect:"))
        .filter(|line| !line.trim_start().starts_with("model_answer:"))
        .collect();
    let text = kept.join("\n");
    let lab = LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap();
    let reference = Reference::compute(&lab).unwrap();
    to_paste(&lab, &reference).unwrap_or_default()
}

#[test]
fn verify_proposes_what_would_be_right() {
    let lines = proposed(include_str!("letters.yaml"));
    has(&lines, "model_answer: 2*sqrt(h_0)/(2*A*sqrt(h_0)*s + k)\n", 1);
    has(&lines, "model_answer: {num:", 1);
    let lines = proposed(include_str!("tangent.yaml"));
    has(&lines, "not computed", 0);
    has(&lines, "poles", 0);
    has(&lines, "model_answer: y = 6*x - 9\n", 1);
    has(&lines, "model_answer: dy = 6*dx\n", 1);
}

#[test]
fn a_field_says_the_form_of_its_tangent() {
    let text = include_str!("tangent.yaml").replace(
        "    answer: {kind: formula}\n    criteria:\n      form: {title: Deviations, points: 2, check: tangent, form: deviations, other_form: 0.5}\n",
        "    answer: {kind: formula, form: deviations, other_form: 0.25}\n",
    );
    let lab = LabDefinition::parse(SourceText::new("lab.yaml", text.clone())).unwrap();
    let criterion =
        lab.questions.iter().find(|question| question.id == "deviations").unwrap().criteria[0].clone();
    let stated = format!("{:?}", criterion.check);
    assert!(stated.contains("Deviations"), "{stated}");
    for (from, to, says) in [
        ("form: deviations, other", "form: slope, other", "slope"),
        ("answer: dc_gain", "answer: {kind: dc_gain, form: line}", "form"),
    ] {
        let text = text.replace(from, to);
        let errors = LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap_err();
        assert!(
            errors.findings.iter().all(|error| error.message.contains(says)) && errors.findings.len() == 1,
            "{errors:#?}"
        );
    }
}

#[test]
fn a_spelling_means_one_thing() {
    let text = include_str!("letters.yaml").replace("also: [c_v]", "also: [c_v, h0]");
    let errors = LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap_err();
    let said: Vec<&str> = errors.findings.iter().map(|error| error.message.as_str()).collect();
    assert_eq!(said, ["`h0` would mean both `k` and the value at rest `h_0`"]);
    // A parameter has its own name, and the level at rest another.
    let text =
        include_str!("letters.yaml").replace("m: {value: 0.2", "h0: {value: 3, unit: m}\n  m: {value: 0.2");
    let lab =
        LabDefinition::parse(SourceText::new("lab.yaml", text.replace("sqrt(h_0)", "sqrt(h_e)"))).unwrap();
    has(&lab.answer_template(), "h_e (or h)", 1);
}
