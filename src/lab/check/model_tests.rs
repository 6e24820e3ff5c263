//! Parameters, equations and places of rest as a lab file states them.

use crate::algebra::to_f64;
use crate::lab::{LabDefinition, LabErrors};
use crate::reference::Reference;
use crate::source::SourceText;

/// Two tanks, one above the other, and the level between them as an output.
const TANKS: &str = "lab: tanks
title: Two tanks
parameters:
  r: {value: 0.5, unit: m}
  A: {formula: 2*r^2, unit: m^2, description: area}
  k: {value: 0.2, accepted: [0.4], description: outflow at 1 m}
models:
  tanks:
    title: Tanks
    coordinates: {h1: {unit: m}, h2: {unit: m}}
    inputs: {q: {unit: m^3/s}}
    outputs: {d: {unit: m, formula: h1 - h2}}
    equations: [\"A*h1' = q - k*sqrt(h1)\", \"A*h2' = k*sqrt(h1) - 2*k*sqrt(h2)\"]
    operating_points:
      full:
        title: Full
        at: {h1: 4, h2: 1, q: k*sqrt(4)}
        input: q
        output: d
total: 1
questions:
  stability:
    number: Question 1
    title: Stability
    points: 1
    about: tanks
    answer: {kind: stability, prompt: Is it stable?}
    criteria:
      word: {title: Stability, points: 1, check: stability}
    model_answer: stable
cover:
  total: 1
  rows:
    questions: {title: Questions, points: 1, from: questions}
";

fn parse(text: &str) -> Result<LabDefinition, LabErrors> {
    LabDefinition::parse(SourceText::new("lab.yaml", text))
}

#[test]
fn what_follows_is_worked_out_for_every_choice() {
    let lab = parse(TANKS).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(to_f64(&lab.parameters[1].value), 0.5);
    assert_eq!(lab.parameters[1].text, "2*r^2 = 0.5");
    assert_eq!(lab.questions[0].about.as_deref(), Some("tanks.full"));
    let reference = Reference::compute(&lab).unwrap_or_else(|error| panic!("{error}"));
    let point = &reference.models[0].operating_points[0];
    assert_eq!(point.output_unit, "m");
    assert_eq!(point.equilibrium.iter().find(|(name, _)| name == "d").map(|(_, value)| *value), Some(3.0));
    // With a = k/4 (k/(2√4)) and b = k (2k/(2√1)): D/Q = (0.5 s + b − a)/((0.5 s + a)(0.5 s + b)).
    for (k, linear) in [0.2, 0.4].into_iter().zip(&point.accepted) {
        let (a, b) = (k / 4.0, k);
        let g = &linear.linearization.transfer_function;
        let (num, den) = (g.num.to_f64(), g.den.to_f64());
        for (found, expected) in
            num.iter().zip([0.5, b - a]).chain(den.iter().zip([0.25, 0.5 * (a + b), a * b]))
        {
            let factor = den[0] / 0.25;
            assert!((found / factor - expected).abs() < 1e-15, "k = {k}: {num:?} / {den:?}");
        }
        assert!(linear.linearization.exact);
    }
}

#[test]
fn what_is_solved_for_is_shown_as_found() {
    let text = TANKS.replacen("h1: 4, h2: 1, q: k*sqrt(4)}", "h1: 9, h2: solve, q: solve}", 1);
    let lab = parse(&text).unwrap_or_else(|errors| panic!("{errors}"));
    let point = &lab.models[0].operating_points[0];
    let shown: Vec<String> = point.at_text.iter().map(|(name, text)| format!("{name} = {text}")).collect();
    assert_eq!(shown, ["h1 = 9", "h2 = 2.25", "q = 0.6"]);
    // With the other k the same level needs another inflow.
    let reference = Reference::compute(&lab).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reference.models[0].operating_points[0].accepted.len(), 2);
}

#[test]
fn blocks_take_formulas_of_the_parameters() {
    let simulation = "simulations:
  valve:
    title: Valve
    source: {sine: {amplitude: 2*k, frequency_rad_s: pi/2}}
    chain: [{saturation: {limit: k/2}}, {transfer_function: {num: [1/A], den: [r, 1]}}]
    duration_s: 10*r
    input: {name: inflow}
    output: {name: level}
    shown_in: stability
total: 1
";
    let text = TANKS.replacen("total: 1\n", simulation, 1);
    let lab = parse(&text).unwrap_or_else(|errors| panic!("{errors}"));
    let shown = format!("{:?}", lab.simulations[0].chain);
    for part in ["amplitude: 0.4", "frequency_rad_s: 1.57079632679", "limit: 0.1", "[2.0]", "[0.5, 1.0]"] {
        assert!(shown.contains(part), "`{part}` is not in {shown}");
    }
    assert_eq!(lab.simulations[0].duration_s, 5.0);
    let wrong = |old: &str, new: &str| {
        let errors =
            parse(&text.replacen(old, new, 1)).err().map(|errors| errors.findings).unwrap_or_default();
        errors.into_iter().map(|finding| finding.message).collect::<Vec<_>>()
    };
    assert_eq!(wrong("limit: k/2", "limit: K/2"), ["`K` is not a name we know"]);
    assert_eq!(
        wrong("limit: k/2", "limit: r - 0.5"),
        ["the limit of a saturation must be above 0, not r - 0.5"]
    );
    assert_eq!(wrong("limit: k/2", "limit: 1/(r - 0.5)"), ["`1/(r - 0.5)` has no value: it divides by zero"]);
}

#[test]
fn what_is_wrong_with_a_model_is_said_where_it_stands() {
    #[track_caller]
    fn check(old: &str, new: &str, place: &str, message: &str, help: &str) {
        assert!(TANKS.contains(old), "`{old}` is not in the lab");
        let text = TANKS.replacen(old, new, 1);
        let found: Vec<_> = match parse(&text) {
            Ok(_) => Vec::new(),
            Err(errors) => errors
                .findings
                .iter()
                .map(|finding| {
                    let place = finding.span.map_or("nowhere", |span| &text[span.start..span.end]);
                    (place.to_owned(), finding.message.clone(), finding.help.clone().unwrap_or_default())
                })
                .collect(),
        };
        let expected = (place.to_owned(), message.to_owned(), help.to_owned());
        assert_eq!(found, [expected], "`{old}` → `{new}`");
    }
    // Derived parameters.
    check(
        "{formula: 2*r^2,",
        "{formula: 2*R^2,",
        "R",
        "`R` is not a name we know",
        "did you mean `r`? the names are `r`, `A`, `k`",
    );
    check(
        "{formula: 2*r^2,",
        "{formula: 2*h1^2,",
        "h1",
        "`h1` is not a name we know",
        "the names are `r`, `A`, `k`",
    );
    check(
        "{formula: 2*r^2,",
        "{formula: A/2,",
        "A/2",
        "the formulas go in a circle: `A` needs `A`",
        "give one of `A` a `value`",
    );
    check(
        "{formula: 2*r^2,",
        "{formula: 1/(r - 0.5),",
        "1/(r - 0.5)",
        "`A` has no value: it divides by zero",
        "",
    );
    check(
        "{formula: 2*r^2,",
        "{formula: 2*r^2, accepted: [0.6],",
        "0.6",
        "`A` follows from a formula, so it has no values of its own",
        "give them to the parameters in its formula",
    );
    check(
        "{formula: 2*r^2,",
        "{formula: 2*r^2, value: 0.5,",
        "A",
        "`A` has both `value` and `formula`",
        "give `value`, or `formula` when it follows from other parameters",
    );
    check(
        "{formula: 2*r^2,",
        "{",
        "A",
        "`A` has no `value`",
        "give `value`, or `formula` when it follows from other parameters",
    );
    // Outputs.
    check(
        "formula: h1 - h2}",
        "formula: h1 - h11}",
        "h11",
        "`h11` is not a name we know",
        "did you mean `h1`? the names are `h1`, `h2`, `q`, `r`, `A`, `k`",
    );
    check(
        "formula: h1 - h2}",
        "formula: h1''}",
        "h1''",
        "the output `d` is of `h1''`, but the equations go no further than `h1'`",
        "",
    );
    check(
        "formula: h1 - h2}}",
        "formula: h1 - h2}, r: {formula: h1}}",
        "r",
        "the output `r` has the name of something else",
        "choose another name",
    );
    check(
        "h2: 1, q: k*sqrt(4)}",
        "h2: 1, q: k*sqrt(4), d: 3}",
        "d",
        "`d` is an output: where it rests follows from its formula",
        "leave it out",
    );
    check(
        "equations: [\"A*h1' = q - k*sqrt(h1)\"",
        "equations: [\"A*h1' = q - k*sqrt(h1) + d\"",
        "d",
        "`d` is not a name we know",
        "the names are `r`, `A`, `k`, `h1`, `h2`, `q`",
    );
    // Equations.
    check(
        "A*h1' = q",
        "Ah1' = q",
        "Ah1'",
        "`Ah1` is not a name we know",
        "did you mean `A*h1'`? the names are `r`, `A`, `k`, `h1`, `h2`, `q`",
    );
    check(
        "A*h1' = q",
        "A*h1'''' = q",
        "h1''''",
        "`h1` is differentiated 4 times: two is the most polemark takes",
        "did you mean `h1''`?",
    );
    check("k*sqrt(h1)\"", "k*sqr(h1)\"", "sqr", "`sqr` is not a function we know", "did you mean `sqrt`?");
    check("k*sqrt(h1)\"", "k*sqrt(h1\"", "(", "this bracket is never closed", "");
    // Rest.
    check(
        "q: k*sqrt(4)}",
        "q: k*sqrt(-4)}",
        "k*sqrt(-4)",
        "`q` has no value at rest: `sqrt` is not defined there, or too large a number",
        "",
    );
    check(
        "q: k*sqrt(4)}",
        "q: k*sqrt(h1)}",
        "(h1)",
        "`h1` is not a name we know",
        "the names are `r`, `A`, `k`",
    );
    // Values that are solved for.
    check(
        "h2: 1, q: k*sqrt(4)}",
        "h2: solve, q: -1}",
        "4",
        "equation 1 does not balance at this point: 0 on the left, -1.4 on the right",
        "give the values of coordinates and inputs at which nothing moves",
    );
    check(
        "h1: 4, h2: 1, q: k*sqrt(4)}",
        "h1: solve, h2: 1, q: -1}",
        "solve",
        "no value of `h1` was found at which the equations balance",
        "check the equations and what is given, or say where to look: `solve near 0.3`",
    );
    check(
        "q: k*sqrt(4)}",
        "q: solve near x}",
        "x",
        "`x` is not a name we know",
        "the names are `r`, `A`, `k`",
    );
    check(
        "q: k*sqrt(4)}",
        "q: solve 3}",
        "3",
        "`3` cannot stand after `solve`",
        "write `solve`, or `solve near 0.3`",
    );
    check(
        "about: tanks",
        "about: tank",
        "tank",
        "there is no operating point or simulation `tank`",
        "known: `tanks.full`",
    );
}
