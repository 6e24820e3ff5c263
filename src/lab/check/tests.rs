use super::*;
use crate::lab::{Check, CoverSource, Points, embedded};
use crate::source::Severity;
use crate::submission::FieldKind;

fn embedded_text() -> &'static str {
    embedded()[0].1
}

fn parse(text: &str) -> Result<LabDefinition, LabErrors> {
    LabDefinition::parse(SourceText::new("lab.yaml", text))
}

/// `code`, `line:column` as the text at that place, message and help of every finding.
fn findings(text: &str) -> Vec<(String, String, String)> {
    match parse(text) {
        Ok(_) => Vec::new(),
        Err(errors) => errors
            .findings
            .iter()
            .map(|finding| {
                assert_eq!(finding.severity, Severity::Error);
                let place = finding.span.map(|span| text[span.start..span.end].to_owned());
                (
                    place.unwrap_or_else(|| "nowhere".to_owned()),
                    finding.message.clone(),
                    finding.help.clone().unwrap_or_default(),
                )
            })
            .collect(),
    }
}

#[test]
fn the_embedded_lab_is_right() {
    let lab = parse(embedded_text()).unwrap();
    let points: Vec<(&str, Points)> = lab.questions.iter().map(|q| (q.id.as_str(), q.points)).collect();
    let expected = [
        ("expect_hanging", 2),
        ("expect_upright", 2),
        ("hanging.transfer_function", 5),
        ("hanging.response", 5),
        ("upright.transfer_function", 5),
        ("upright.response", 5),
        ("perception", 6),
        ("saturation", 4),
        ("dead_zone", 4),
        ("backlash", 4),
        ("battery.nonlinearity", 1),
        ("remote_car.nonlinearity", 1),
        ("speaker.nonlinearity", 1),
    ];
    assert_eq!(points, expected.map(|(id, points)| (id, Points(points * 100))));
    let total: Points = lab.questions.iter().map(|q| q.points).sum();
    assert_eq!(total, Points(4500));
    let observed: Points = lab.observed.iter().map(|row| row.points).sum();
    assert_eq!((lab.observed.len(), observed), (7, Points(3500)));
    assert_eq!(lab.cover.total, Points(10000));
    assert_eq!(lab.cover.rows[0].from, CoverSource::QuestionsAndObserved);
    assert_eq!(lab.parameters.len(), 6);
    assert_eq!(lab.simulations.len(), 4);
    assert_eq!(lab.sheet.symbols.len(), 6);
}

#[test]
fn every_field_has_a_model_answer_but_the_figures() {
    let lab = parse(embedded_text()).unwrap();
    for field in &lab.sheet.fields {
        let answered = lab.model_answer.answers.contains_key(&field.path);
        assert_eq!(answered, field.kind != FieldKind::Figure, "{}", field.path);
    }
}

#[test]
fn fields_know_what_they_are_about() {
    let lab = parse(embedded_text()).unwrap();
    let about = |path: &str| {
        let field = lab.sheet.fields.iter().find(|field| field.path == path).unwrap();
        (field.about.as_deref(), field.response, field.required)
    };
    let impulse = Some(crate::lti::InputKind::Impulse);
    assert_eq!(about("hanging.transfer_function"), (Some("cart.hanging"), None, true));
    assert_eq!(about("hanging.response.shape"), (Some("cart.hanging"), impulse, true));
    assert_eq!(about("upright.response.data"), (Some("cart.upright"), impulse, false));
    assert_eq!(about("saturation.data"), (Some("saturation"), None, false));
    assert_eq!(about("battery.nonlinearity"), (None, None, true));
}

#[test]
fn a_wrong_lab_says_where_and_what_to_do() {
    #[track_caller]
    fn check(old: &str, new: &str, place: &str, message: &str, help: &str) {
        let text = embedded_text();
        assert!(text.contains(old), "`{old}` is not in the lab");
        let text = text.replacen(old, new, 1);
        let expected = (place.to_owned(), message.to_owned(), help.to_owned());
        assert_eq!(findings(&text), [expected], "`{old}` → `{new}`");
    }

    // Grades and targets.
    check(
        "cover:\n",
        "grades:\n  - {name: A, from: 101}\ncover:\n",
        "101",
        "the grade `A` begins at 101 points, above the total",
        "",
    );
    check(
        "cover:\n",
        "grades:\n  - {name: A, from: 80}\n  - {name: B, from: 80.0}\ncover:\n",
        "80.0",
        "the grades `A` and `B` share a name or a boundary",
        "",
    );
    check(
        "outcomes:\n",
        "outcomes:\n  z: {text: x, target: 60}\n",
        "60",
        "target must be 0 to 1, not 60",
        "0.01 is 1 %",
    );

    // Names and ids.
    check(
        "lab: ee361-lab3",
        "lab: EE361",
        "EE361",
        "the lab id `EE361` is not well-formed",
        "use lower-case letters, digits, `_` and `-`, a letter first",
    );
    check(
        "        output: theta",
        "        output: thata",
        "thata",
        "there is no coordinate or output `thata`",
        "did you mean `theta`?",
    );
    check("        input: F", "        input: u", "u", "there is no input `u`", "known: `F`");
    check(
        "at: {theta: pi}",
        "at: {phi: pi}",
        "phi",
        "there is no coordinate or input `phi`",
        "known: `x`, `theta`, `F`",
    );
    check(
        "shown_in: dead_zone",
        "shown_in: deadzone",
        "deadzone",
        "there is no question `deadzone`",
        "did you mean `dead_zone`?",
    );
    check(
        "about: cart.hanging",
        "about: cart.hangin",
        "cart.hangin",
        "there is no operating point or simulation `cart.hangin`",
        "did you mean `cart.hanging`?",
    );
    check("outcomes: [a, c]", "outcomes: [a, d]", "d", "there is no outcome `d`", "known: `a`, `b`, `c`");
    check(
        "parameters:\n",
        "parameters:\n  s: {value: 1}\n",
        "s",
        "the parameter name `s` has another meaning in formulas",
        "choose another name",
    );
    check(
        "    inputs:\n",
        "    inputs:\n      M: {}\n",
        "M",
        "the input `M` has the name of something else",
        "choose another name",
    );

    // Shape.
    check("\ntotal: 45", "\ntotl: 45", "totl", "there is no key `totl` here", "did you mean `total`?");
    check(
        "- saturation: {limit: 5}",
        "- saturatoin: {limit: 5}",
        "saturatoin",
        "`saturatoin` is not known here",
        "did you mean `saturation`?",
    );
    check("\nlab: ee361-lab3\n", "\n", "title", "the key `lab` is missing here", "");
    check(
        "{limit: 5}",
        "{limit: [5]}",
        "[",
        "a single value is wanted here, not a list or a mapping",
        "write the value after the key, without brackets",
    );
    check(
        "m*l*theta''*cos(theta)",
        "m*l*theta''*cso(theta)",
        "cso",
        "`cso` is not a function we know",
        "did you mean `cos`?",
    );
    check(
        "m*l*theta''*cos(theta)",
        "m*l(theta)",
        "l",
        "`l` is not a function we know",
        "write `l*(` to multiply",
    );
    check(
        "accepted: [9.8, 9.80665, 10]",
        "accepted: 9.8",
        "9.8",
        "a list (`[a, b]`, or lines that begin with `- `) is wanted here",
        "put brackets around a single entry",
    );
    check("lab: ee361-lab3", "lab:", "", "a value is missing here", "");
    check("\ntotal: 45", "\nlab: 45", "lab", "the key `lab` is given twice", "keep one of the two");

    // Numbers.
    check("value: 9.81", "value: 9,81", "9,81", "`9,81` is not a number", "write a point: `9.81`");
    check(
        "accepted: [9.8,",
        "accepted: [9.810,",
        "9.810",
        "`g` accepts its own value `9.810` again",
        "list only the other values",
    );
    check("{limit: 5}", "{limit: -5}", "-5", "the limit of a saturation must be above 0, not -5", "");
    check("duty: 0.5", "duty: 50", "50", "a duty must be 0 to 1, not 50", "0.01 is 1 %");
    check(
        "{relative: 0.005}",
        "{relative: 5}",
        "5",
        "a relative tolerance must be 0 to 1, not 5",
        "0.01 is 1 %",
    );
    check("absolute: 0.001", "absolute: -0.001", "-0.001", "a tolerance cannot be negative: -0.001", "");
    check("figures: 2", "figures: two", "two", "figures must be a whole number of 1 to 15, not `two`", "");
    check("pushes: [0.1,", "pushes: [0,", "0", "a push of 0 moves nothing", "");
    check(
        "num: [0.2083], den: [1, 1.71]",
        "num: [1, 0, 0], den: [1, 1.71]",
        "[",
        "the transfer function is improper: its numerator (degree 2) outranks its denominator (degree 1)",
        "",
    );

    // Mistakes.
    check(
        "mistaken: [0.024]",
        "mistaken: [0.0060]",
        "0.0060",
        "`I` lists `0.0060` as mistaken, but it is right",
        "list only values that are wrong",
    );
    check(
        "mistakes:\n",
        "mistakes:\n  weights: {term.sign: 12, term.sing: 3}\n",
        "term.sing",
        "there is no mistake with the code `term.sing`",
        "did you mean `term.sign`?",
    );
    check(
        "mistakes:\n",
        "mistakes:\n  weights: {term.sign: -1}\n",
        "-1",
        "a weight must be a whole number of 0 to 1000, not `-1`",
        "",
    );
    let help = "name a term as its equation prints it, `equation 1: b*x'`, or a change as `verify` lists it";
    for entry in ["equation 1: m*l*theta'^3", "equation 3: b*x'", "b*x'", "equation 1: ", "equation 0: b*x'"]
    {
        check(
            "\"equation 1: m*l*theta'^2*sin(theta)\"",
            &format!("\"{entry}\""),
            &format!("\"{entry}\""),
            &format!("`{}` is no mistake that can be made here", entry.trim()),
            help,
        );
    }

    // Equations, with places inside them.
    check(
        "b*x' + m*l",
        "b*x' + m*L",
        "L",
        "`L` is not a name we know",
        "did you mean `l`? the names are `M`, `b`, `m`, `l`, `I`, `g`, `x`, `theta`, `F`",
    );
    check(
        "m*g*l*sin(theta)",
        "m*g'*l*sin(theta)",
        "g'",
        "`g` is a parameter, so it has no derivative",
        "write `g` without primes",
    );
    check(
        "(M + m)*x''",
        "(M + m)*x'''",
        "x'''",
        "`x` is differentiated 3 times: two is the most polemark takes",
        "did you mean `x''`?",
    );
    check(
        "at: {theta: pi}",
        "at: {theta: pi*L}",
        "L",
        "`L` is not a name we know",
        "did you mean `l`? the names are `M`, `b`, `m`, `l`, `I`, `g`",
    );

    // Points.
    check(
        "\ntotal: 45",
        "\ntotal: 50",
        "50",
        "questions add up to 45 points, but `total` is 50",
        "change `total` to 45, or the points of a question",
    );
    check(
        "title: Why it does so\n        points: 1",
        "title: Why it does so\n        points: 2.5",
        "6",
        "the criteria of `perception` add up to 7.5 points, but the question is worth 6",
        "change `points` to 7.5, or take 1.5 from a criterion",
    );
    check(
        "title: Why it does so\n        points: 1",
        "title: Why it does so\n        points: 0.25",
        "6",
        "the criteria of `perception` add up to 5.25 points, but the question is worth 6",
        "change `points` to 5.25, or give 0.75 more to a criterion",
    );
    check(
        "points: 35, from: by_hand",
        "points: 30, from: by_hand",
        "100",
        "the rows of the cover sheet add up to 95 points, but its `total` is 100",
        "change `total` to 95, or the points of a row",
    );
    check(
        "from: 4, to: 5",
        "from: 3, to: 5",
        "3",
        "the level `Meets expectation` is not below the one before it",
        "give the best level first",
    );
    check(
        "from: by_hand",
        "from: hand",
        "hand",
        "there is no source of points `hand`",
        "known: `questions_and_observed`, `questions`, `observed`, `by_hand`",
    );

    // Criteria.
    check(
        "check: nonlinearity, expected: backlash",
        "check: shape, of: cart.hanging",
        "shape",
        "the check `shape` judges a field of kind `shape`, but `remote_car.nonlinearity` is of kind `nonlinearity`",
        "",
    );
    check(
        "        one_slip: 0.5",
        "        needed: 1",
        "1",
        "`needed` means nothing to the check `denominator`",
        "it takes `of`, `tolerance`, `one_slip`",
    );
    check(
        "        data: data\n",
        "        data: shape\n",
        "shape",
        "`hanging.response.shape` is of kind `shape`, but data is needed",
        "",
    );
    check(
        "        feature: final_value",
        "        feature: final_valeu",
        "final_valeu",
        "there is no feature `final_valeu`",
        "did you mean `final_value`?",
    );
    check("        span_s: 0.5\n", "", "plot", "the check `plot` needs the key `span_s`", "");
    check(
        "expected: backlash",
        "expected: sluggish",
        "sluggish",
        "`sluggish` is no nonlinearity known here",
        "write `saturation`, `dead zone`, `backlash`, `relay`, …",
    );
    check(
        "              - sway*",
        "              - sw*ay",
        "sw*ay",
        "in the phrase `sw*ay`, a `*` is not at the end of a word",
        "`oscillat*` matches every word that begins so",
    );
    check("              - sway*", "              - \"\"", "\"\"", "the phrase is empty", "");
    check(
        "      hanging.motion:",
        "      bottom.motion:",
        "bottom.motion",
        "it is not said which field the criterion `bottom.motion` judges",
        "add `field:` with one of `hanging`, `upright`",
    );

    // Expectations.
    check(
        "  cart.hanging.zeros:",
        "  cart.hanging.zeroes:",
        "cart.hanging.zeroes",
        "`cart.hanging` has no `zeroes` in the reference",
        "did you mean `zeros`?",
    );
    check(
        "  cart.hanging.zeros:",
        "  cart.hangin.zeros:",
        "cart.hangin.zeros",
        "`cart.hangin.zeros` begins with no operating point or simulation of this lab",
        "did you mean `cart.hanging`?",
    );
    check(
        "{values: [0]}",
        "{values: [O]}",
        "O",
        "`O` is no number, complex number or word",
        "write `0.25`, `-0.25 + 5.5j` or `unstable`",
    );
}

#[test]
fn an_equilibrium_must_be_one() {
    let text = embedded_text().replacen("at: {theta: pi}", "at: {theta: 1}", 1);
    let found = findings(&text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "1");
    assert!(found[0].1.starts_with("equation 2 does not balance at this point"), "{}", found[0].1);
}

#[test]
fn all_errors_are_reported_in_file_order() {
    let text = embedded_text()
        .replacen("value: 9.81", "value: g", 1)
        .replacen("{limit: 5}", "{limit: 0}", 1)
        .replacen("check: nonlinearity, expected: backlash", "check: struct", 1)
        .replacen("points: 35, from", "points: 3.555, from", 1);
    let places: Vec<String> = findings(&text).into_iter().map(|(place, _, _)| place).collect();
    assert_eq!(places, ["g", "0", "struct", "3.555"]);
}

#[test]
fn an_error_shows_file_line_and_column() {
    let text = embedded_text().replacen("\ntotal: 45", "\ntotal: 50", 1);
    let errors = parse(&text).unwrap_err();
    let line = text[..text.find("total: 50").unwrap()].matches('\n').count() + 1;
    assert_eq!(
        errors.to_string(),
        format!("lab.yaml:{line}:8: error: questions add up to 45 points, but `total` is 50")
    );
    assert!(errors.render(false).contains(&format!("--> lab.yaml:{line}:8\n")), "{}", errors.render(false));
}

#[test]
fn a_model_answer_that_cannot_be_read_is_found_in_the_lab() {
    let text = embedded_text().replacen("0.41202s + 0.05886)", "0.41202s + 0.05886", 1);
    let errors = parse(&text).unwrap_err();
    assert_eq!(errors.findings.len(), 1, "{errors}");
    let finding = &errors.findings[0];
    assert_eq!(finding.code, "lab.model_answer");
    let position = errors.source.position(finding.span.unwrap().start);
    assert_eq!(position.line, text[..text.find("model_answer: -0.06s").unwrap()].matches('\n').count() + 1);
}

#[test]
fn the_template_reads_as_blank() {
    let lab = parse(embedded_text()).unwrap();
    let template = lab.answer_template();
    let answer = crate::submission::read(
        "template",
        "template.yaml",
        template.as_bytes(),
        &lab.sheet,
        &crate::submission::NoFiles,
    );
    let codes: Vec<&str> = answer.findings.iter().map(|finding| finding.code).collect();
    assert_eq!(codes, ["student.missing"]);
    assert_eq!(answer.answers.len(), 0);
    assert!(answer.readable);
    for field in &lab.sheet.fields {
        assert!(template.contains(field.path.rsplit('.').next().unwrap()), "{}", field.path);
    }
    assert!(template.lines().all(|line| line.chars().count() <= 110), "{template}");
}

/// The example of docs/lab-file.md is a lab.
#[test]
fn the_documented_example_is_a_lab() {
    let manual = include_str!("../../../docs/lab-file.md");
    let start = manual.find("```yaml\n").unwrap() + "```yaml\n".len();
    let end = start + manual[start..].find("```").unwrap();
    let lab = parse(&manual[start..end]).unwrap();
    assert_eq!(lab.id, "spring");
    assert!(manual[start..end].lines().count() <= 30);
}

#[test]
fn another_lab_is_only_another_file() {
    let text = "\
lab: suspension
title: Mass, spring and damper
parameters:
  mass: {value: 2}
  k: {value: 50, unit: N/m}
  c: {value: 0.4e1}
models:
  car:
    title: Quarter car
    coordinates: {z: {unit: m}}
    inputs: {u: {}}
    equations: [\"mass*z'' = u - c*z' - k*(z + 3*z^3)\"]
    operating_points:
      rest:
        title: At rest
        input: u
        output: z
        comparison: {horizon_s: 3, departure: 0.1, pushes: [1]}
total: 2.5
questions:
  g:
    number: 1
    title: Transfer function
    points: 2
    about: car.rest
    answer: {kind: transfer_function, prompt: Z/U}
    criteria:
      right: {title: Right, points: 2, check: denominator, tolerance: {relative: 0}}
  w:
    number: 2
    title: Words
    points: 0.5
    answer: {kind: prose, prompt: why}
    criteria:
      why:
        title: Why
        points: 0.5
        check: concepts
        needed: 1
        concepts:
          a: {title: damping, phrases: [damp*]}
          b: {title: energy, phrases: [energy]}
cover:
  total: 2.5
  rows: {all: {title: All, points: 2.5, from: questions}}
";
    let lab = parse(text).unwrap();
    assert_eq!(lab.questions[1].points, Points(50));
    assert!(
        matches!(&lab.questions[1].criteria[0].check, Check::Concepts { needed: 1, concepts, .. } if concepts.len() == 2)
    );
    assert_eq!(lab.models[0].operating_points[0].at.values.len(), 2);
    assert!(lab.model_answer.answers.is_empty());
}

/// Keys for units and conventions, each with the line and column of what is wrong.
#[test]
fn units_and_conventions_are_checked() {
    const LAB: &str = include_str!("../../../tests/it/oscillator.yaml");
    assert!(parse(LAB).is_ok());
    #[track_caller]
    fn check(old: &str, new: &str, mark: &str, message: &str, help: &str) {
        assert_eq!(LAB.matches(old).count(), 1, "`{old}` in the lab");
        let text = LAB.replace(old, new);
        let errors = parse(&text).unwrap_err();
        let [finding] = errors.findings.as_slice() else { panic!("`{new}`: {:#?}", errors.findings) };
        assert_eq!(
            (finding.message.as_str(), finding.help.as_deref().unwrap_or_default()),
            (message, help),
            "`{new}`"
        );
        let start = text.find(new).unwrap() + new.find(mark).unwrap();
        let line = text[..start].matches('\n').count() + 1;
        let column = start - text[..start].rfind('\n').map_or(0, |end| end + 1) + 1;
        let place = format!("lab.yaml:{line}:{column}");
        let shown = finding.render(&errors.source, false);
        assert!(shown.contains(&place), "{place} is not in\n{shown}");
    }
    check(
        "unit: rad/s, prompt",
        "unit: rads per fortnight, prompt",
        "rads per",
        "`rads per fortnight` is no unit known here",
        "write `rad/s`, `Hz`, `deg`, `s`, `ms`, `m`, `cm`, `V`, `%`, …",
    );
    check(
        "unit: rad/s, prompt",
        "unit: s, prompt",
        "s, prompt",
        "`damped_frequency_rad_s` is a frequency, but it is asked for in `s`, the unit of a time",
        "write `unit: rad/s`",
    );
    check(
        "unit: cm, prompt",
        "unit: '%', prompt",
        "'%'",
        "`final_value` is a length, but it is asked for in `%`, the unit of a ratio",
        "write `unit: m`",
    );
    check(
        "damping: {kind: value, prompt",
        "damping: {kind: value, unit: rad, prompt",
        "rad,",
        "`damping_ratio` is a ratio, but it is asked for in `rad`, the unit of an angle",
        "write `unit: 1`",
    );
    check(
        "damping: {kind: value, prompt: Damping ratio.}",
        "damping: {kind: value, prompt: Damping ratio.}\n      kind: {kind: stability, unit: s, prompt: Word., optional: true}",
        "s, prompt: Word.",
        "a unit is asked for in values, but `motion.kind` is of kind `stability`",
        "remove `unit`",
    );
    check(
        "response: step, feature: overshoot_percent",
        "response: impulse, feature: overshoot_percent",
        "overshoot_percent",
        "an impulse response has no `overshoot_percent`",
        "add `response: step`",
    );
    check(
        "feature: period_s",
        "feature: period_s, other_convention: 1",
        "1",
        "`other_convention` means nothing for `period_s`",
        "remove it",
    );
    check(
        "damped_frequency_rad_s, other_convention: 0.5",
        "damped_frequency_rad_s, other_convention: 50",
        "50",
        "`other_convention` must be 0 to 1, not 50",
        "0.01 is 1 %",
    );
    check(
        "feature: overshoot_percent",
        "feature: overshot_percent",
        "overshot_percent",
        "there is no feature `overshot_percent`",
        "did you mean `overshoot_percent`?",
    );
    // A number is a unit of its own, where a ratio is asked for.
    for (old, new) in [
        ("damping: {kind: value, prompt", "damping: {kind: value, unit: '1', prompt"),
        ("damping: {kind: value, prompt", "damping: {kind: value, unit: '%', prompt"),
        ("overshoot: {kind: value, prompt", "overshoot: {kind: value, unit: 1, prompt"),
        ("unit: rad/s, prompt", "unit: 1/s, prompt"),
    ] {
        assert!(parse(&LAB.replace(old, new)).is_ok(), "{new}");
    }
}

#[test]
fn blocks_that_switch_are_checked_where_they_stand() {
    const LAB: &str = include_str!("../../../tests/it/switches.yaml");
    #[track_caller]
    fn check(old: &str, new: &str, mark: &str, message: &str, help: &str) {
        assert!(LAB.contains(old), "`{old}` is not in the lab");
        let text = LAB.replacen(old, new, 1);
        let errors = parse(&text).unwrap_err();
        let [finding] = errors.findings.as_slice() else { panic!("`{new}`: {:#?}", errors.findings) };
        let found = (finding.message.as_str(), finding.help.as_deref().unwrap_or_default());
        assert_eq!(found, (message, help), "`{new}`");
        let start = text.find(new).unwrap() + new.find(mark).unwrap();
        let line = text[..start].matches('\n').count() + 1;
        let column = start - text[..start].rfind('\n').map_or(0, |end| end + 1) + 1;
        let (place, shown) = (format!("lab.yaml:{line}:{column}"), finding.render(&errors.source, false));
        assert!(shown.contains(&place), "{place} is not in\n{shown}");
    }
    check(
        "- relay: {amplitude: 5}",
        "- realy: {amplitude: 5}",
        "realy",
        "`realy` is not known here",
        "did you mean `relay`?",
    );
    check(
        "- quantizer:",
        "- quantiser:",
        "quantiser",
        "`quantiser` is not known here",
        "did you mean `quantizer`?",
    );
    check(
        "- rate_limit:",
        "- rate_limiter:",
        "rate_limiter",
        "`rate_limiter` is not known here",
        "did you mean `rate_limit`?",
    );
    check(
        "{amplitude: 5}",
        "{amplitud: 5}",
        "amplitud",
        "there is no key `amplitud` here",
        "did you mean `amplitude`?",
    );
    check("{amplitude: 5}", "{amplitude: 0}", "0", "the amplitude of a relay must be above 0, not 0", "");
    check(
        "hysteresis: 1, dead_zone: 4",
        "hysteresis: -1, dead_zone: 4",
        "-1",
        "the hysteresis of a relay cannot be below 0, but is -1",
        "",
    );
    check(
        "hysteresis: 1, dead_zone: 4",
        "hysteresis: 4, dead_zone: 4",
        "4",
        "the hysteresis of a relay must be below its dead zone, not 4 beside 4",
        "both are half-widths: it switches on at dead_zone + hysteresis, off at dead_zone - hysteresis",
    );
    check(
        "{interval: 0.5}",
        "{interval: -0.5}",
        "-0.5",
        "the interval of a quantizer must be above 0, not -0.5",
        "",
    );
    check("rising: 8", "rising: -8", "-8", "the rising rate of a rate limit must be above 0, not -8", "");
    check(
        "falling: -4",
        "falling: 4",
        "4",
        "the falling rate of a rate limit must be below 0, not 4",
        "did you mean `-4`?",
    );
    check("coulomb: 1", "coulomb: -1", "-1", "the Coulomb friction must be above 0, not -1", "");
    check("viscous: 0.5", "viscous: -0.5", "-0.5", "the viscous friction cannot be below 0, but is -0.5", "");
    // Data beside a jump.
    let figure = |about: &str| {
        format!(
            "fields:\n      figure: {{kind: figure, prompt: Plot.}}\n      data: {{kind: data, prompt: Data., optional: true}}\n    \
             criteria:\n      plot: {{title: Plot, points: 0, check: plot, field: figure, of: {about}, data: data, span_s: 1}}\n"
        )
    };
    let plotted = |about: &str| {
        let (fields, criteria) = ("    fields:\n", "    criteria:\n");
        let new = figure(about);
        let (new_fields, new_criteria) = new.split_once("    criteria:\n").unwrap();
        LAB.replacen(fields, &format!("    {new_fields}"), 1).replacen(
            criteria,
            &format!("    criteria:\n{new_criteria}"),
            1,
        )
    };
    for (about, refused) in
        [("staircase", true), ("relay", false), ("rate_limit", false), ("friction", false)]
    {
        let messages: Vec<String> = parse(&plotted(about))
            .err()
            .map_or(Vec::new(), |e| e.findings.into_iter().map(|f| f.message).collect());
        let told = messages.iter().any(|m| m == "the output of `staircase` jumps where its `quantizer` switches: data cannot be held against it");
        assert_eq!(told, refused, "{about}: {messages:#?}");
    }
}

#[test]
fn grades_come_highest_first_and_outcomes_with_or_without_a_target() {
    let text = embedded_text().replacen(
        "cover:\n",
        "grades:\n  - {name: pass, from: 50}\n  - {name: A, from: 85.5}\nrelease: {solutions: false}\ncover:\n",
        1,
    );
    let lab = parse(&text.replacen("outcomes:\n", "outcomes:\n  z: {text: x, target: 0.6}\n", 1)).unwrap();
    let grades: Vec<_> = lab.grades.iter().map(|grade| (grade.name.as_str(), grade.from)).collect();
    assert_eq!(grades, [("A", Points(8550)), ("pass", Points(5000))]);
    assert_eq!(lab.release, crate::lab::Release { solutions: false, ..crate::lab::Release::ALL });
    assert_eq!(lab.outcomes[0].target, crate::algebra::parse_decimal("0.6").ok());
    assert_eq!(lab.outcomes[1].target, None);
}
