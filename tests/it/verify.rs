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
    /// Text for people: changing a digit in it changes no answer.
    const PROSE: [&str; 6] = ["title", "description", "unit", "input_unit", "output_unit", "shown_in"];
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
