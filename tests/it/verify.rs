//! `verify` proves every lab on the shelf, and notices when a number the key depends on is changed.

use polemark::grading::{Catalogue, grade};
use polemark::lab::{self, LabDefinition};
use polemark::proof::{missing, prove, to_paste};
use polemark::reference::{Reference, check_expectations};
use polemark::source::{Node, SourceText, Value, parse};
use rayon::prelude::*;
use std::ops::Range;

fn embedded() -> &'static str {
    lab::embedded().iter().find(|(id, _)| *id == lab::DEFAULT).expect("the default lab is embedded").1
}

#[test]
fn every_lab_on_the_shelf_is_proven() {
    for (id, text) in lab::embedded() {
        let lab = parsed(text).unwrap_or_else(|| panic!("{id} parses"));
        let reference = Reference::compute(&lab).unwrap_or_else(|error| panic!("{id}: {error}"));
        let failed: Vec<String> = prove(&lab, &reference)
            .into_iter()
            .filter(|check| !check.holds)
            .map(|check| format!("{id}: {}: {}", check.what, check.found))
            .collect();
        assert!(failed.is_empty(), "{failed:#?}");
    }
}

/// One number in so many is changed; the test below this one changes them all.
const SAMPLED: usize = 8;

#[test]
fn numbers_the_key_depends_on_are_guarded() {
    let unnoticed = lab::embedded()
        .iter()
        .enumerate()
        .flat_map(|(nth, (id, text))| unguarded(id, text, |place| place % SAMPLED == nth % SAMPLED));
    none(unnoticed.collect());
}

#[test]
#[ignore = "some minutes: every number of every lab, one after another"]
fn every_number_the_key_depends_on_is_guarded() {
    none(lab::embedded().iter().flat_map(|(id, text)| unguarded(id, text, |_| true)).collect());
}

#[track_caller]
fn none(unnoticed: Vec<String>) {
    assert!(unnoticed.is_empty(), "changed and still proven:\n{}", unnoticed.join("\n"));
}

/// Changes the numbers that `chosen` picks by their place in the list, one at a time: something must notice each. Those that
/// nothing notices.
fn unguarded(id: &str, text: &str, chosen: impl Fn(usize) -> bool) -> Vec<String> {
    let whole = parsed(text).expect("an embedded lab parses");
    let original = Reference::compute(&whole).expect("an embedded lab has a reference");
    assert!(check_expectations(&original, &whole.expectations).is_empty(), "{id} as it is");
    let places = numbers_of_the_key(text, id == lab::DEFAULT);
    assert!(places.len() > 5, "{id}: only {} numbers were found", places.len());
    let picked: Vec<&Place> =
        places.iter().enumerate().filter(|(nth, _)| chosen(*nth)).map(|(_, p)| p).collect();
    picked
        .par_iter()
        .filter(|place| {
            let number = &text[place.range.clone()];
            !noticed(&replaced(text, place.range.clone(), &changed(number)), &place.part)
        })
        .map(|place| {
            let position = SourceText::new("lab.yaml", text).position(place.range.start);
            let line = text.lines().nth(position.line - 1).unwrap_or_default();
            format!("{id} line {} column {}: {}", position.line, position.column, line.trim())
        })
        .collect()
}

fn parsed(text: &str) -> Option<LabDefinition> {
    LabDefinition::parse(SourceText::new("lab.yaml", text)).ok()
}

/// What of a lab a number has a say in.
#[derive(Clone, Debug)]
enum Part {
    Everything,
    Model(String),
    Simulation(String),
}

struct Place {
    range: Range<usize>,
    part: Part,
}

/// Whether the changed lab fails a check: the cheapest are tried first, and only of what the change can have touched.
fn noticed(text: &str, part: &Part) -> bool {
    let Some(lab) = parsed(text) else { return true };
    for with_comparisons in [false, true] {
        let mut some = lab.clone();
        match part {
            Part::Everything => {}
            Part::Model(id) => {
                some.models.retain(|model| model.id == *id);
                some.simulations.clear();
            }
            Part::Simulation(id) => {
                some.simulations.retain(|simulation| simulation.id == *id);
                some.models.clear();
            }
        }
        if !with_comparisons {
            let points = some.models.iter_mut().flat_map(|model| &mut model.operating_points);
            points.for_each(|point| point.comparison = None);
            some.expectations.retain(|expectation| !expectation.path.contains(".comparison."));
        }
        let there = |id: &str| {
            some.models.iter().any(|model| model.id == id) || some.simulations.iter().any(|s| s.id == id)
        };
        let expectations: Vec<_> = some
            .expectations
            .iter()
            .filter(|expectation| there(expectation.path.split('.').next().unwrap_or_default()))
            .cloned()
            .collect();
        match Reference::compute(&some) {
            Ok(reference) if check_expectations(&reference, &expectations).is_empty() => {}
            _ => return true,
        }
    }
    let Ok(reference) = Reference::compute(&lab) else { return true };
    let card = grade(&lab, &reference, &Catalogue::default(), &lab.model_answer, None);
    card.total.earned != card.total.possible
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

/// The mistakes that `verify` asks to be declared.
fn undeclared(text: &str) -> Vec<String> {
    let lab = LabDefinition::parse(SourceText::new("lab.yaml", text)).expect("the lab parses");
    let reference = Reference::compute(&lab).expect("the lab has a reference");
    let lines = to_paste(&lab, &reference).unwrap_or_default();
    let (_, changes) = lines.split_once("without_effect:\n").unwrap_or_default();
    let to_do = missing(&lab, &reference)
        .iter()
        .any(|one| one.what == "mistakes without effect" && one.keeps_from_proof);
    assert_eq!(to_do, !changes.is_empty(), "{lines}");
    changes.lines().map(|line| line.trim_start_matches([' ', '-']).trim_matches('"').to_owned()).collect()
}

#[test]
fn linear_models_hold_as_they_are_given() {
    let failing = failing(include_str!("linear.yaml"));
    assert!(failing.is_empty(), "{failing:#?}");
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
    assert_eq!(failing(&some), [""; 0]);
    assert_eq!(undeclared(&some), ["equation 1: l -> 1 in m*l*theta'^2*sin(theta)"]);
    assert_eq!(undeclared(text), [""; 0]);
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
fn a_term_in_one_input_need_not_matter_to_another() {
    const TWO_INPUTS: &str = r#"
lab: cart
title: A cart with a motor, in the wind
parameters:
  m: {value: 2, unit: kg}
  c: {value: 3, unit: N s/m}
models:
  cart:
    title: Cart
    coordinates: {v: {unit: m/s}}
    inputs: {F: {unit: N}, w: {unit: m/s}}
    equations: ["m*v' = F - c*(v - w)"]
    operating_points:
      motor: {title: Motor, input: F, output: v}
      wind: {title: Wind, input: w, output: v}
total: 2
questions:
  motor:
    number: Question 1
    title: Motor
    points: 1
    about: cart.motor
    answer: {kind: transfer_function, prompt: V(s)/F(s)}
    criteria: {all: {title: All, points: 1, check: denominator}}
  wind:
    number: Question 2
    title: Wind
    points: 1
    about: cart.wind
    answer: {kind: transfer_function, prompt: V(s)/W(s)}
    criteria: {all: {title: All, points: 1, check: denominator}}
cover: {total: 2, rows: {questions: {title: Questions, points: 2, from: questions}}}
"#;
    assert_eq!(failing(TWO_INPUTS), [""; 0]);
    assert_eq!(undeclared(TWO_INPUTS), [""; 0]);
    // Where only the motor is asked for, nothing would notice a mistyped wind.
    let motor_alone = TWO_INPUTS.replace("about: cart.wind", "about: cart.motor");
    assert_eq!(failing(&motor_alone), [""; 0]);
    assert_eq!(undeclared(&motor_alone), ["equation 1: w -> -w", "equation 1: w -> 0"]);
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

/// Where numbers stand under the keys that make the reference, inside equation strings too.
///
/// `comparisons`: also what only a drawn comparison shows.
fn numbers_of_the_key(text: &str, comparisons: bool) -> Vec<Place> {
    let tree = parse(text).expect("an embedded lab is YAML");
    let Value::Mapping(entries) = &tree.value else { panic!("a lab is a mapping") };
    let mut places = Vec::new();
    for (key, _, node) in entries {
        let part_of: fn(&str) -> Part = match key.as_str() {
            "parameters" => |_| Part::Everything,
            "models" => |id| Part::Model(id.to_owned()),
            "simulations" => |id| Part::Simulation(id.to_owned()),
            _ => continue,
        };
        let Value::Mapping(entries) = &node.value else { continue };
        for (id, _, node) in entries {
            let mut ranges = Vec::new();
            collect(text, node, comparisons, &mut ranges);
            places.extend(ranges.into_iter().map(|range| Place { range, part: part_of(id) }));
        }
    }
    places
}

fn collect(text: &str, node: &Node, comparisons: bool, places: &mut Vec<Range<usize>>) {
    /// Text for people, and values that are wrong or for others: changing a digit in it changes no answer.
    const PROSE: [&str; 9] = [
        "title",
        "description",
        "unit",
        "input_unit",
        "output_unit",
        "shown_in",
        "mistaken",
        "varies",
        "also",
    ];
    match &node.value {
        Value::Mapping(entries) => {
            for (key, _, value) in entries {
                if !PROSE.contains(&key.as_str()) && (comparisons || key != "comparison") {
                    collect(text, value, comparisons, places);
                }
            }
        }
        Value::Sequence(items) => items.iter().for_each(|item| collect(text, item, comparisons, places)),
        // Where to look for a value at rest: from a little beside it the same is found.
        Value::Scalar(scalar) if scalar.trim_start().starts_with("solve") => {}
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

/// With 0.001 stated for every value, a settling time of 0.39 ms could be answered by 0; what polemark chooses is narrower.
#[test]
fn a_tolerance_that_takes_0_for_the_value_is_something_to_do() {
    let lab = |tolerance: &str| {
        let text = format!(
            "lab: rc\nparameters: {{R: {{value: 1000}}, C: {{value: 1e-7}}}}\nmodels:\n  rc:\n    coordinates: {{v: {{unit: V}}}}\n    \
             inputs: {{u: {{unit: V}}}}\n    equations: [\"R*C*v' + v = u\"]\n    operating_points: {{rest: {{}}}}\n{tolerance}questions:\n  \
             step:\n    points: 2\n    response: step\n    fields: {{settling: settling_time_2_percent_s, final: final_value}}\n    model_answer: \
             {{settling: 0.000391, final: 1}}\n"
        );
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", text))
            .unwrap_or_else(|e| panic!("{}", e.render(false)));
        let reference = Reference::compute(&lab).expect("the lab has a reference");
        let all = missing(&lab, &reference);
        all.into_iter().find(|one| one.what == "tolerances").map(|one| one.found)
    };
    let stated = "tolerances: {values: {relative: 0.01, absolute: 0.001}}\n";
    let found = lab(stated).expect("0 is within 0.001 of 0.39 ms");
    assert!(found.starts_with("0 would be right at `step.settling: 0.000391 ± 0.001`:"), "{found}");
    assert_eq!(lab("tolerances: {values: {relative: 0.01, absolute: 0.00001}}\n"), None);
    assert_eq!(lab(""), None);
}

/// A near miss must earn what the lab says, and what guards it is noticed when it changes.
#[test]
fn near_misses_guard_tolerances_and_partial_points() {
    const LAB: &str = "lab: spring
models:
  spring:
    coordinates: {x: {unit: m}}
    inputs: {F: {unit: N}}
    equations: [\"2*x'' + 0.8*x' + 38*x = F\"]
    operating_points: {rest: {}}
tolerances: {coefficients: {relative: 0.01}}
questions:
  transfer_function:
    points: 5
    answer: transfer_function
    model_answer: 1/(2s^2 + 0.8s + 38)
    near_misses:
      - {answer: 0.5/(s^2 + 0.4s + 19), points: 5, why: divided by 2}
      - {answer: 1/(2s^2 + 0.8s + 38.3), points: 5, why: 0.8 % off}
      - {answer: 1/(2s^2 + 0.8s + 39), points: 4, why: one coefficient is off}
      - {answer: -1/(2s^2 + 0.8s + 38), points: 3, why: the sign}
      - {answer: stable, points: 0, why: no function at all}
  poles:
    points: 4
    fields: {poles: poles, word: stability}
    model_answer:
      poles: -0.2 ± 4.354j
      word: stable
    near_misses:
      - {answer: {word: unstable}, points: 2}
";
    #[track_caller]
    fn check(from: &str, to: &str, line: Option<&str>) {
        let text = LAB.replacen(from, to, 1);
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", text.as_str())).expect("the lab parses");
        let reference = Reference::compute(&lab).expect("the lab has a reference");
        let checks = prove(&lab, &reference);
        let failed: Vec<_> = checks.iter().filter(|check| !check.holds).collect();
        let lines: Vec<&str> = failed
            .iter()
            .filter_map(|check| text.lines().nth(lab.text.position(check.span?.start).line - 1))
            .map(str::trim)
            .collect();
        assert_eq!(lines, Vec::from_iter(line), "{failed:#?}");
        assert!(failed.iter().all(|check| check.what.starts_with("near miss of ")), "{failed:#?}");
    }
    check("", "", None);
    check(
        "relative: 0.01",
        "relative: 0.001",
        Some("- {answer: 1/(2s^2 + 0.8s + 38.3), points: 5, why: 0.8 % off}"),
    );
    check(
        "points: 4, why",
        "points: 3.5, why",
        Some("- {answer: 1/(2s^2 + 0.8s + 39), points: 3.5, why: one coefficient is off}"),
    );
    check("unstable}, points: 2", "unstable}, points: 4", Some("- {answer: {word: unstable}, points: 4}"));
    let wrong = LAB.replacen("points: 2}", "points: 4.5}", 1);
    let errors =
        LabDefinition::parse(SourceText::new("lab.yaml", wrong)).expect_err("more than the question has");
    assert!(errors.to_string().contains("`4.5` cannot be what a near miss earns"), "{errors}");
}
