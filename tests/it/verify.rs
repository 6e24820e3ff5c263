//! `verify` proves the embedded lab, and notices when any number the key depends on is changed.

use polemark::grading::{Catalogue, grade};
use polemark::lab::{self, LabDefinition};
use polemark::proof::prove;
use polemark::reference::{Reference, check_expectations};
use polemark::source::{Node, SourceText, Value, parse};
use rayon::prelude::*;
use std::ops::Range;

fn embedded() -> &'static str {
    lab::embedded().iter().find(|(id, _)| *id == lab::DEFAULT).expect("the default lab is embedded").1
}

#[test]
fn the_embedded_lab_is_proven() {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab parses");
    let reference = Reference::compute(&lab).expect("the embedded lab has a reference");
    let failed: Vec<String> = prove(&lab, &reference)
        .into_iter()
        .filter(|check| !check.holds)
        .map(|check| format!("{}: {}", check.what, check.found))
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn every_number_the_key_depends_on_is_guarded() {
    let text = embedded();
    assert!(proven(text), "an unchanged lab must be proven, or this test notices nothing");
    let places = numbers_of_the_key(text);
    assert!(places.len() > 50, "only {} numbers were found in the lab", places.len());
    let unnoticed: Vec<String> = places
        .par_iter()
        .map(|place| (place, replaced(text, place.clone(), &changed(&text[place.clone()]))))
        .filter(|(_, copy)| proven(copy))
        .map(|(place, copy)| {
            let position = SourceText::new("lab.yaml", text).position(place.start);
            let line = copy.lines().nth(position.line - 1).unwrap_or_default();
            format!("line {} column {}: {line}", position.line, position.column)
        })
        .collect();
    assert!(unnoticed.is_empty(), "changed and still proven:\n{}", unnoticed.join("\n"));
}

/// The checks about mistakes that fail, each with the line it points to.
fn failing(text: &str) -> Vec<String> {
    let lab = LabDefinition::parse(SourceText::new("lab.yaml", text)).expect("the lab parses");
    let reference = Reference::compute(&lab).expect("the lab has a reference");
    let about_mistakes = |what: &str| what.contains("mistakes") || what.contains("without effect");
    prove(&lab, &reference)
        .into_iter()
        .filter(|check| !check.holds && about_mistakes(&check.what))
        .map(|check| {
            let line = check.span.map(|span| lab.text.position(span.start).line);
            let line = line.and_then(|line| text.lines().nth(line - 1)).unwrap_or("nowhere");
            format!("{}: {} @ {}", check.what, check.found, line.trim())
        })
        .collect()
}

#[test]
fn a_mistake_that_no_answer_shows_must_be_declared() {
    const DECLARED: &str = "- \"equation 1: m*l*theta'^2*sin(theta)\"";
    let text = embedded();
    assert!(text.contains(DECLARED));
    // Declared one by one instead, and one of them forgotten.
    let some = text.replacen(
        DECLARED,
        "- \"equation 1: m*l*theta'^2*sin(theta) -> -m*l*theta'^2*sin(theta)\"\n    \
         - \"equation 1: m*l*theta'^2*sin(theta) -> 0\"\n    \
         - \"equation 1: m -> 1 in m*l*theta'^2*sin(theta)\"\n    \
         - \"equation 1: sin(theta) -> -sin(theta)\"",
        1,
    );
    let found = failing(&some);
    assert_eq!(found.len(), 2, "{found:#?}");
    for (found, point) in found.iter().zip(["hanging", "upright"]) {
        assert!(found.starts_with(&format!("mistakes without effect at cart.{point}: no answer shows ")));
        assert!(found.contains("`equation 1: l -> 1 in m*l*theta'^2*sin(theta)`; declare"), "{found}");
        assert!(found.ends_with(&format!("@ {point}:")), "{found}");
    }
    // Declared although every answer shows it.
    let stale = text.replacen(DECLARED, &format!("{DECLARED}\n    - \"equation 1: b*x'\""), 1);
    assert_eq!(
        failing(&stale),
        [
            "without effect: `equation 1: b*x'`: is declared, but every mistake it covers changes a transfer function \
          @ - \"equation 1: b*x'\""
        ]
    );
}

#[test]
fn mistakes_that_no_answer_tells_apart_are_listed() {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab parses");
    let reference = Reference::compute(&lab).expect("the embedded lab has a reference");
    let checks = prove(&lab, &reference);
    let found = |what: &str| &checks.iter().find(|check| check.what == what).expect("it is checked").found;
    assert!(found("mistakes at cart.hanging").contains("`equation 1: F -> -F`  =  `G -> -G`"));
    let upright = found("mistakes at cart.upright");
    assert!(upright.contains(
        "`equation 2: m*g*l*sin(theta) -> -m*g*l*sin(theta)`  =  `equation 2: sin(theta) -> -sin(theta)`"
    ));
    assert_eq!(found("mistakes without effect at cart.hanging"), "4, all declared");
}

/// The parts of the proof that do not recompute everything a second time.
fn proven(text: &str) -> bool {
    let Ok(lab) = LabDefinition::parse(SourceText::new("lab.yaml", text)) else { return false };
    let Ok(reference) = Reference::compute(&lab) else { return false };
    let card = grade(&lab, &reference, &Catalogue::default(), &lab.model_answer, None);
    check_expectations(&reference, &lab.expectations).is_empty() && card.total.earned == card.total.possible
}

/// Where numbers stand under the keys that make the reference, inside equation strings too.
fn numbers_of_the_key(text: &str) -> Vec<Range<usize>> {
    let tree = parse(text).expect("the embedded lab is YAML");
    let Value::Mapping(entries) = &tree.value else { panic!("the lab is a mapping") };
    let mut places = Vec::new();
    for (key, _, node) in entries {
        if ["parameters", "models", "simulations"].contains(&key.as_str()) {
            collect(text, node, &mut places);
        }
    }
    places
}

fn collect(text: &str, node: &Node, places: &mut Vec<Range<usize>>) {
    /// Text for people, and values that are wrong: changing a digit in it changes no answer.
    const PROSE: [&str; 7] =
        ["title", "description", "unit", "input_unit", "output_unit", "shown_in", "mistaken"];
    match &node.value {
        Value::Mapping(entries) => {
            for (key, _, value) in entries {
                if !PROSE.contains(&key.as_str()) {
                    collect(text, value, places);
                }
            }
        }
        Value::Sequence(items) => items.iter().for_each(|item| collect(text, item, places)),
        Value::Scalar(_) => places.extend(numbers_in(text, node.span.start..node.span.end)),
        Value::Null => {}
    }
}

fn numbers_in(text: &str, range: Range<usize>) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let part_of_number = |i: usize| bytes[i].is_ascii_digit() || bytes[i] == b'.';
    let mut found = Vec::new();
    let mut at = range.start;
    while at < range.end {
        let begins = bytes[at].is_ascii_digit()
            && !(at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_'));
        if !begins {
            at += 1;
            continue;
        }
        let end = (at..range.end).find(|i| !part_of_number(*i)).unwrap_or(range.end);
        found.push(at..end);
        at = end;
    }
    found
}

/// A little more than the number: one per cent, or the next integer.
fn changed(number: &str) -> String {
    match number.parse::<i64>() {
        Ok(integer) => (integer + 1).to_string(),
        Err(_) => format!("{}1", number.trim_end_matches('.')).replace(".01", ".011"),
    }
}

fn replaced(text: &str, place: Range<usize>, with: &str) -> String {
    format!("{}{with}{}", &text[..place.start], &text[place.end..])
}
