//! Slips that authors make, what is said of each, and where.

use crate::lab::LabDefinition;
use crate::source::SourceText;

const LAB: &str = "lab: duffing
parameters:
  m: {value: 2, unit: kg}
  k: {value: 3, unit: N/m}
models:
  plant:
    coordinates: {x: {unit: m}}
    inputs: {F: {unit: N}}
    equations: [\"m*x'' + k*x = F\"]
    operating_points:
      rest: {at: {x: 0}}
questions:
  tf:
    points: 4
    answer: transfer_function
";

const LINEAR: &str = "lab: lin
models:
  plant:
    linear:
      state_space: {A: [[0, 1], [-2, -3]], B: [[0], [1]], C: [[1, 0]], D: [[0]]}
questions:
  tf: {points: 4, answer: transfer_function}
";

const CHAIN: &str = "lab: sim
simulations:
  sat:
    source: {sine: {amplitude: 1, frequency_rad_s: 1}}
    chain: [{saturation: {limit: 0.5}}, {transfer_function: {num: [1], den: [1, 1]}}]
    duration_s: 10
    input: {name: u}
    output: {name: y}
    shown_in: q
questions:
  q: {points: 4, answer: {kind: nonlinearity, expected: saturation}}
";

/// `text` with `from` made `to`: line and column of the first thing said, what it says, and what to do.
#[track_caller]
fn check(text: &str, from: &str, to: &str, place: (usize, usize), message: &str, help: &str) {
    assert!(text.contains(from), "{from}");
    LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap();
    let text = text.replacen(from, to, 1);
    let errors = LabDefinition::parse(SourceText::new("lab.yaml", text.as_str())).unwrap_err();
    let first = &errors.findings[0];
    assert!(first.message.contains(message), "{to}: {errors}");
    assert!(first.help.as_deref().unwrap_or_default().contains(help), "{to}: {:?}", first.help);
    let at = errors.source.position(first.span.unwrap().start);
    assert_eq!((at.line, at.column), place, "{to}: {errors}");
}

#[test]
fn indentation() {
    check(LAB, "  m: {", "\tm: {", (3, 1), "a tab stands where the line is indented", "indent with spaces");
    let glued = "a colon without a space behind it";
    check(LAB, "m: {value: 2, ", "m:{value: 2, ", (3, 4), glued, "write a space behind it: `m: …`");
    check(LAB, "points: 4", "points:4", (14, 11), glued, "`points: …`");
    check(LAB, "    answer", "   answer", (15, 4), "this line begins in column 4", "perhaps in column 5");
    check(LAB, "    answer", "     answer", (15, 6), "has its value already", "in the same column, 5");
}

#[test]
fn decimal_commas() {
    check(LAB, "value: 2", "value: 0,2", (3, 16), "there is no key `2` here", "write a point: `.2`");
    check(LAB, "value: 2", "value: \"0,2\"", (3, 14), "`0,2` is not a number", "write a point: `0.2`");
}

#[test]
fn formulas() {
    check(LAB, "k*x = F", "k*(x = F", (9, 28), "this bracket is never closed", "");
    check(LAB, "k*x = F", "sin(k*x = F", (9, 29), "this bracket is never closed", "");
    check(
        LAB,
        "x: 0",
        "x: 30 deg",
        (11, 24),
        "an operator is missing",
        "angles are in radians: write `30*pi/180`",
    );
    check(LAB, "x: 0", "x: 3 m", (11, 23), "an operator is missing", "write the number alone, `3`");
    let taken = "`x` is not given, so it is taken for 0";
    let text = LAB.replace("k*x = F", "k/(x + 1) = F").replace("at: {x: 0}", "at: {F: solve}");
    check(&text, "x + 1", "x", (11, 22), "`division by zero` is not defined", taken);
}

#[test]
fn matrices() {
    let rows = "a row for each state, with a number for each input";
    check(LINEAR, "[[0], [1]]", "[0, 1]", (5, 48), rows, "write `B: [[0], [1]]`");
    check(LINEAR, "[[1, 0]]", "[1, 0]", (5, 63), "`C` is a matrix", "write `C: [[1, 0]]`");
    check(LINEAR, "[[0]]", "0", (5, 75), "`D` is a matrix", "write `D: [[0]]`");
}

#[test]
fn equations_that_say_nothing() {
    let two = LAB
        .replace("{x: {unit: m}}", "{x: {unit: m}, y: {}}")
        .replace("k*x = F\"", "k*x = F\", \"x'' + y'' = 0\"")
        .replace("{x: 0}", "{x: 0}, output: x");
    check(
        &two,
        "m*x''",
        "2*x'' + 2*y''",
        (11, 22),
        "equation 2 says the same as those before it of `x''` and `y''`",
        "",
    );
    check(&two, "x'' + y'' = 0", "x + 0*y'' = 0", (11, 22), "equation 2 says nothing of `x''` and `y''`", "");
}

#[test]
fn simulations() {
    for (from, to, column, message) in [
        ("limit: 0.5", "limit: 0.5*(", 34, "`0.5*(` is not a number"),
        ("num: [1]", "num: [Q]", 68, "`Q`"),
        ("limit: 0.5", "limit: -0.5", 34, "must be above 0"),
        ("num: [1]", "num: [1, 2, 3]", 67, "improper"),
        ("saturation: {", "saturaton: {", 14, "`saturaton` is not known here"),
    ] {
        check(CHAIN, from, to, (5, column), message, "");
    }
}
