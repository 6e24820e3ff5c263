use super::*;
use crate::algebra::parse_decimal;
use crate::lti::{InputKind, Shape, Stability};
use crate::source::{Finding, Severity};
use proptest::prelude::*;

/// Files in memory.
struct Files(Vec<(&'static str, Vec<u8>)>);

impl Attachments for Files {
    fn read(&self, file_name: &str) -> Result<Vec<u8>, AttachmentError> {
        let file = self.0.iter().find(|(name, _)| *name == file_name);
        file.map(|(_, bytes)| bytes.clone()).ok_or(AttachmentError::NotFound)
    }
}

fn sheet() -> AnswerSheet {
    use FieldKind::*;
    let fields = [
        ("expect", Prose, true),
        ("low.transfer_function", TransferFunction, true),
        ("low.response.poles", Poles, true),
        ("low.response.initial_value", Value, true),
        ("low.response.final_value", Value, true),
        ("low.response.shape", super::FieldKind::Shape, true),
        ("low.response.stability", super::FieldKind::Stability, true),
        ("low.response.figure", Figure, false),
        ("low.response.data", Data, false),
        ("valve.nonlinearity", Nonlinearity, true),
    ];
    let fields = fields.map(|(path, kind, required)| Field {
        path: path.to_owned(),
        kind,
        question: path.rsplit_once('.').map_or(path, |(question, _)| question).to_owned(),
        prompt: format!("Prompt of {path}"),
        about: path.starts_with("low").then(|| "low".to_owned()),
        response: path.starts_with("low.response").then_some(InputKind::Impulse),
        unit: None,
        required,
    });
    let symbols = [("m", "0.2"), ("l", "0.3")].map(|(n, v)| (n.to_owned(), parse_decimal(v).unwrap()));
    AnswerSheet {
        lab: "tank".into(),
        title: "Tank".into(),
        fields: fields.into(),
        symbols: symbols.into(),
        ..AnswerSheet::default()
    }
}

const GOOD: &str = "\
lab: tank
student: {id: EE-001, name: A. Student}
answers:
  expect: |
    It settles, $e^{-t}$.
  low.transfer_function: G(s) = 2 / (s^2 + 2s + 5)
  low.response:
    poles: [-1 ± 2j]
    initial_value: 0
    final_value: 0
    shape: decaying oscillation
    stability: stable
    figure: a.png
    data: |
      t,y
      0,0
      1,0.33
  valve:
    nonlinearity: dead zone
";

fn files() -> Files {
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x40\0\0\0\x30\x08\x06\0\0\0".to_vec();
    png.extend([0; 8]);
    Files(vec![("a.png", png), ("a.csv", b"t;y\n0;0\n1;0,3\n".to_vec()), ("bad.csv", b"0,1\nx,2".to_vec())])
}

fn submit(text: &str) -> Submission {
    read("stem", "stem.yaml", text.as_bytes(), &sheet(), &files())
}

fn codes(findings: &[Finding]) -> Vec<&str> {
    findings.iter().map(|f| f.code).collect()
}

#[test]
fn a_good_file_is_read_without_findings() {
    let submission = submit(GOOD);
    assert_eq!(submission.findings, []);
    assert!(submission.readable);
    assert_eq!(submission.lab.as_deref(), Some("tank"));
    assert_eq!(submission.students, [Student { id: "EE-001".into(), name: "A. Student".into() }]);
    let echo: Vec<_> = submission.answers.values().map(|a| (a.path.as_str(), a.read_as())).collect();
    let expected = [
        ("expect", "It settles, $e^{-t}$."),
        ("low.response.data", "2 points from 0 s to 1 s"),
        ("low.response.figure", "a PNG of 64 × 48 pixels"),
        ("low.response.final_value", "0"),
        ("low.response.initial_value", "0"),
        ("low.response.poles", "-1 + 2j, -1 - 2j"),
        ("low.response.shape", "decaying oscillation"),
        ("low.response.stability", "asymptotically stable"),
        ("low.transfer_function", "2 / (s^2 + 2s + 5)"),
        ("valve.nonlinearity", "dead zone"),
    ];
    let echo: Vec<_> = echo.iter().map(|(path, text)| (*path, text.as_str())).collect();
    assert_eq!(echo, expected);
    for answer in submission.answers.values() {
        let slice = &submission.source.text[answer.span.start..answer.span.end];
        assert!(!slice.is_empty(), "{}", answer.path);
    }
    assert_eq!(self_check(&submission, &sheet()), []);
}

#[test]
fn keys_are_read_dotted_nested_and_mixed() {
    for answers in [
        "low.response.stability: stable",
        "low: {response: {stability: stable}}",
        "low:\n    response.stability: stable",
        "low.response: {stability: stable}",
        "Low.Response.Stability: stable",
        "low.response:\n    stability: stable\n  low:\n    response: {poles: }",
    ] {
        let submission = submit(&format!("lab: tank\nstudent: {{id: a}}\nanswers:\n  {answers}\n"));
        assert_eq!(submission.findings, [], "{answers}");
        let value = submission.answers.get("low.response.stability").map(|a| &a.value);
        assert_eq!(value, Some(&Ok(AnswerValue::Stability(Stability::AsymptoticallyStable))), "{answers}");
    }
}

#[test]
fn blanks_are_no_answers() {
    for value in [
        "",
        "~",
        "null",
        "\"\"",
        "'  '",
        "[]",
        "{}",
        "…",
        "...",
        "___",
        "??",
        "TODO",
        "<your answer>",
        "|",
        "\"\\u200B\"",
    ] {
        for path in [
            "expect",
            "low.transfer_function",
            "low.response.poles",
            "low.response.stability",
            "low.response",
        ] {
            let submission = submit(&format!("lab: tank\nstudent: {{id: a}}\nanswers:\n  {path}: {value}\n"));
            assert!(submission.answers.is_empty(), "{path}: {value}: {:?}", submission.answers);
            assert_eq!(submission.findings, [], "{path}: {value}");
        }
    }
    let template = "answers: {expect: Prompt of expect, low.transfer_function: {num: [], den: }}";
    assert!(submit(template).answers.is_empty());
}

#[test]
fn an_unreadable_value_costs_only_its_own_field() {
    for (path, value, code, marked, help) in [
        ("low.transfer_function", "1,500 / (s + 1)", "number.decimal_comma", "1,500", "`1.500` or `1500`"),
        (
            "low.transfer_function",
            "{num: [1], den: [0]}",
            "transfer_function.unreadable",
            "{num: [1], den: [0]}",
            "num",
        ),
        ("low.response.poles", "[-1, -2+j3..1]", "poles.unreadable", "3..1", "`-2+3.1j`"),
        ("low.response.poles", "[5,568, -5,607]", "number.decimal_comma", "5,568", "`5.568`"),
        ("low.response.poles", "{value: -1, times: x}", "poles.multiplicity", "x", "multiplicity: 2"),
        ("low.response.poles", "{re: -1, value: 2}", "poles.unreadable", "{re: -1, value: 2}", "{re: -2"),
        ("low.response.poles", "{re: x}", "poles.unreadable", "x", "{re: -2"),
        ("low.response.poles", "{val: -1}", "poles.unreadable", "val", "value"),
        ("low.response.poles", "[[-1, 2]]", "poles.unreadable", "[-1, 2]", "`-2+3.1j`"),
        ("low.response.poles", "-1,5", "number.decimal_comma", "1,5", "`-1.5`"),
        ("low.response.poles", "'5,568, -5,607'", "number.decimal_comma", "5,568", "`5.568`"),
        ("low.response.poles", "['5,568', '-2']", "number.decimal_comma", "5,568", "`5.568` or `5568`"),
        ("low.response.initial_value", "1,000", "number.decimal_comma", "1,000", "`1.000` or `1000`"),
        (
            "low.response.stability",
            "marginal / stable",
            "stability.unreadable",
            "marginal / stable",
            "Give one",
        ),
        (
            "valve.nonlinearity",
            "backlash / dead zone",
            "nonlinearity.unreadable",
            "backlash / dead zone",
            "Give one: `backlash` or `dead zone`.",
        ),
        (
            "valve.nonlinearity",
            "backlash (deadband)",
            "nonlinearity.unreadable",
            "backlash (deadband)",
            "Give one: `backlash` or `dead zone`.",
        ),
        (
            "valve.nonlinearity",
            "[backlash, relay]",
            "nonlinearity.unreadable",
            "[backlash, relay]",
            "Give one word",
        ),
        ("low.response.stability", "almost stable", "stability.unreadable", "almost stable", "Give one word"),
        ("low.response.initial_value", "[0]", "value.unreadable", "[0]", ""),
        ("low.response.stability", "maybe", "stability.unreadable", "maybe", "`stable`"),
        ("low.response.stability", "stabel", "stability.unreadable", "stabel", "Did you mean `stable`?"),
        ("low.response.stability", "not unstable", "stability.unreadable", "not unstable", "`unstable`"),
        ("low.response.shape", "wobbly", "shape.unreadable", "wobbly", "`decaying oscillation`"),
        ("low.response.figure", "b.png", "figure.not_read", "b.png", "beside"),
        ("low.response.figure", "a.csv", "figure.unreadable", "a.csv", "PNG"),
        ("low.response.data", "b.csv", "data.not_read", "b.csv", "beside"),
        ("low.response.data", "bad.csv", "data.unreadable", "bad.csv", "0.1,0.25"),
        ("low.response.data", "a.png", "data.unreadable", "a.png", "CSV"),
        ("low.response.data", "[[0, 1], 2]", "data.unreadable", "[[0, 1], 2]", ""),
        ("valve.nonlinearity", "linear", "nonlinearity.unreadable", "linear", "`dead zone`"),
        ("expect", "{a: b}", "prose.unreadable", "{a: b}", "`|`"),
    ] {
        let text = format!(
            "lab: tank\nstudent: {{id: a}}\nanswers:\n  {path}: {value}\n  low.response.final_value: 0\n"
        );
        let submission = submit(&text);
        let [finding] = submission.findings.as_slice() else { panic!("{value}: {:?}", submission.findings) };
        let answer = &submission.answers[path];
        assert_eq!(answer.value, Err(Unreadable { finding: finding.clone() }), "{value}");
        assert_eq!(answer.text, value.trim_matches('\''));
        let span = finding.span.unwrap();
        assert_eq!((finding.code, &text[span.start..span.end]), (code, marked), "{finding:?}");
        assert!(finding.help.as_deref().unwrap_or_default().contains(help), "{finding:?}");
        assert!(finding.message.starts_with(|c: char| c.is_uppercase() || c == '`'), "{finding:?}");
        assert!(finding.message.ends_with(['.', '?']), "{finding:?}");
        assert!(submission.answers["low.response.final_value"].value.is_ok());
    }
}

#[test]
fn yaml_types_do_not_matter() {
    for (path, value, read_as) in [
        ("low.response.initial_value", "0", "0"),
        ("low.response.initial_value", "1.50", "1.50"),
        ("low.response.initial_value", "\"0\"", "0"),
        ("low.response.initial_value", ".5", "0.5"),
        ("low.response.final_value", ".inf", "unbounded"),
        ("low.response.final_value", "-.inf", "-∞"),
        ("low.response.final_value", "∞", "unbounded"),
        ("low.response.final_value", "diverges", "unbounded"),
        ("low.response.poles", "-0.143", "-0.143"),
        ("low.response.poles", "-1 (x2)", "-1, -1"),
        ("low.response.poles", "{value: -1, multiplicity: 2}", "-1, -1"),
        (
            "low.response.poles",
            "[{value: -1 ± 2j, multiplicity: 2}, -3]",
            "-1 + 2j, -1 + 2j, -1 - 2j, -1 - 2j, -3",
        ),
        ("low.response.poles", "-1, -2 ± 3j", "-1, -2 + 3j, -2 - 3j"),
        ("low.response.poles", "[-1, [], ~]", "-1"),
        ("low.response.poles", "[{re: -1, im: 2}, {re: -1, im: -2}, {re: -3}]", "-1 + 2j, -1 - 2j, -3"),
        ("low.response.poles", "$-0.143$, $-0.0195 \\pm 5.59j$", "-0.143, -0.0195 + 5.59j, -0.0195 - 5.59j"),
        ("low.response.poles", "[$-1$, '`-2`']", "-1, -2"),
        ("low.response.poles", "-1, -2, all in the left half plane.", "-1, -2"),
        (
            "low.response.poles",
            "-0.143 -0.0195+5.59i -0.0195-5.59i",
            "-0.143, -0.0195 + 5.59j, -0.0195 - 5.59j",
        ),
        (
            "low.response.poles",
            "[-0.143 -0.0195+5.59i -0.0195-5.59i]",
            "-0.143, -0.0195 + 5.59j, -0.0195 - 5.59j",
        ),
        ("low.response.final_value", "$0$", "0"),
        ("low.response.final_value", "θ = 0", "0"),
        ("low.response.data", "[[0, 0], [0.5, 1]]", "2 points from 0 s to 0.5 s"),
        ("low.response.data", "a.csv", "2 points from 0 s to 1 s"),
        ("low.transfer_function", "-m*l/s", "-0.06 / s"),
        ("low.transfer_function", "5", "5"),
        ("valve.nonlinearity", "[dead zone]", "dead zone"),
        ("low.response.stability", "No!", "unstable"),
        ("expect", "3", "3"),
        ("expect", "[one, two]", "- one\n- two"),
        ("expect", "yes", "yes"),
    ] {
        let submission = submit(&format!("lab: tank\nstudent: {{id: a}}\nanswers:\n  {path}: {value}\n"));
        assert_eq!(submission.findings, [], "{value}");
        assert_eq!(submission.answers[path].read_as(), read_as, "{value}");
    }
    let shape = submit("answers: {low.response.shape: Damped sinusoid.}");
    assert_eq!(shape.answers["low.response.shape"].value, Ok(AnswerValue::Shape(Shape::DecayingOscillation)));
}

#[test]
fn decimal_commas_are_read_and_said() {
    for (path, value, read_as, marked) in [
        ("low.response.initial_value", "0,0", "0.0", "0,0"),
        ("low.response.initial_value", "-0,143 rad", "-0.143 rad", "-0,143"),
        ("low.response.poles", "-0,143", "-0.143", "-0,143"),
        (
            "low.response.poles",
            "\"-0,1429; -0,0195 + 5,586j; -0,0195 - 5,586j\"",
            "-0.1429, -0.0195 + 5.586j, -0.0195 - 5.586j",
            "-0,1429",
        ),
        ("low.response.poles", "[5,568, -5,607, -0,1428]", "5.568, -5.607, -0.1428", "5,568"),
        ("low.response.poles", "[-0,143, -2 ± 3j]", "-0.143, -2 + 3j, -2 - 3j", "-0,143"),
        (
            "low.response.poles",
            "\"-0,143, -0,0195 ± 5,59j\"",
            "-0.143, -0.0195 + 5.59j, -0.0195 - 5.59j",
            "-0,143",
        ),
        ("low.response.poles", "[-2, \"-0,143\", \"5,568\"]", "-2, -0.143, 5.568", "-0,143"),
        ("low.response.poles", "[{value: \"-1,5\", multiplicity: 2}]", "-1.5, -1.5", "-1,5"),
        ("low.transfer_function", "-0,06s / (s^2 + 5,568)", "-0.06s / (s^2 + 5.568)", "-0,06"),
    ] {
        let text = format!("lab: tank\nstudent: {{id: a}}\nanswers:\n  {path}: {value}\n");
        let submission = submit(&text);
        let [finding] = submission.findings.as_slice() else { panic!("{value}: {:?}", submission.findings) };
        assert_eq!((finding.severity, finding.code), (Severity::Warning, "number.comma_read"));
        let span = finding.span.unwrap();
        assert_eq!(&text[span.start..span.end], marked, "{finding:?}");
        assert_eq!(submission.answers[path].read_as(), read_as, "{value}");
        assert_eq!(submission.answers[path].text, value.trim_matches('"'));
    }
}

#[test]
fn half_a_shape_is_completed_by_what_stands_beside_it() {
    use super::AnswerValue::Shape as Is;
    use crate::lti::Shape::*;
    for (answers, shape) in [
        ("shape: exponential, stability: unstable", Some(ExponentialGrowth)),
        ("shape: exponential, stability: stable", Some(ExponentialDecay)),
        ("shape: exponential, final_value: unbounded", Some(ExponentialGrowth)),
        ("shape: exponential, final_value: 0, stability: stable", Some(ExponentialDecay)),
        ("shape: It oscillates., stability: stable", Some(DecayingOscillation)),
        ("shape: oscillation, stability: unstable", Some(GrowingOscillation)),
        // Nothing to go by, or two things that disagree.
        ("shape: exponential", None),
        ("shape: exponential, stability: marginally stable", None),
        ("shape: exponential, final_value: 0, stability: unstable", None),
        ("shape: exponential, stability: green", None),
        ("shape: exponential oscillation, stability: stable", None),
        ("shape: growth or decay, stability: stable", None),
        ("shape: exponential, initial_value: 0", None),
    ] {
        let text = format!("lab: tank\nstudent: {{id: a}}\nanswers: {{low.response: {{{answers}}}}}");
        let submission = submit(&text);
        let answer = &submission.answers["low.response.shape"];
        assert_eq!(answer.value.as_ref().ok(), shape.map(Is).as_ref(), "{answers}");
        let about: Vec<_> = submission.findings.iter().filter(|f| f.code.starts_with("shape.")).collect();
        let [finding] = about.as_slice() else { panic!("{answers}: {about:?}") };
        let severity = if shape.is_some() { Severity::Warning } else { Severity::Error };
        assert_eq!(finding.severity, severity, "{finding:?}");
    }
    let alone = submit("lab: tank\nstudent: {id: a}\nanswers: {low.response.shape: exponential}");
    let help = alone.findings[0].help.as_deref();
    assert_eq!(help, Some("Does it grow or decay? Write `exponential growth` or `exponential decay`."));
}

#[test]
fn a_plot_is_not_asked_for_twice() {
    let mut sheet = sheet();
    for field in &mut sheet.fields {
        if field.path.starts_with("low.response") {
            field.question = "low.response".to_owned();
            field.required = true;
        }
    }
    let missing = |answers: &str| -> Vec<String> {
        let text = format!("lab: tank\nstudent: {{id: a}}\nanswers: {{{answers}}}");
        let submission = read("stem", "stem.yaml", text.as_bytes(), &sheet, &files());
        let findings = self_check(&submission, &sheet).into_iter().map(|f| f.message);
        findings.filter(|m| m.contains(".figure") || m.contains(".data")).collect()
    };
    assert_eq!(missing("").len(), 2);
    assert_eq!(missing("low.response.figure: a.png"), [""; 0]);
    assert_eq!(missing("low.response.data: a.csv"), [""; 0]);
}

#[test]
fn findings_about_the_file() {
    let head = "lab: tank\nstudent: {id: a}\n";
    for (text, code, marked, words) in [
        (
            format!("{head}answers: {{low.respons.poles: -1}}"),
            "key.unknown",
            "low.respons.poles",
            "`low.response.poles`?",
        ),
        (
            format!("{head}answers: {{low.respons: {{poles: -1}}}}"),
            "key.unknown",
            "low.respons",
            "`low.response`?",
        ),
        (
            format!("{head}answers: {{low: {{response: {{pole: -1}}}}}}"),
            "key.unknown",
            "pole",
            "`low.response.poles`?",
        ),
        (format!("{head}answers: {{grades.total: 45}}"), "key.unknown", "grades.total", "not asked for"),
        (format!("{head}grade: 100"), "key.unknown", "grade", "not asked for"),
        (format!("{head}low.response.poles: -1"), "key.outside_answers", "low.response.poles", "beside"),
        (
            format!("{head}answers: {{low.response: -1}}"),
            "key.too_short",
            "low.response",
            "text stands there",
        ),
        (format!("{head}answers: [1, 2]"), "answers.not_a_mapping", "[1, 2]", "a list"),
        (
            format!("{head}answers: {{expect: a, low.response.shape: ramp, expect: b}}"),
            "answer.twice",
            "expect",
            "line 3",
        ),
        (
            format!("{head}answers:\n  low: {{response.poles: -1}}\n  low.response.poles: -2"),
            "answer.twice",
            "low.response.poles",
            "line 4",
        ),
        ("lab: pond\nstudent: {id: a}".into(), "lab.other", "pond", "`tank`"),
        ("lab: tank\nstudent: {name: B}".into(), "student.id_missing", "{name: B}", "`stem`"),
        ("lab: tank\nstudent: {id: a, nmae: B}".into(), "student.unknown_key", "nmae", "nmae"),
        ("lab: tank\nstudents: [{id: a}, {id: a}]".into(), "student.twice", "{id: a}", "twice"),
        ("lab: tank\nstudent: [{id: b}, [a]]".into(), "student.unreadable", "[a]", "list"),
    ] {
        let submission = submit(&text);
        let [finding] = submission.findings.as_slice() else { panic!("{text}: {:?}", submission.findings) };
        let span = finding.span.unwrap();
        assert_eq!((finding.code, &text[span.start..span.end]), (code, marked), "{finding:?}");
        assert!(finding.message.contains(words), "{finding:?}");
        assert!(submission.readable);
    }
    assert_eq!(codes(&submit("").findings), ["student.missing"]);
    assert_eq!(codes(&submit("answers: {}").findings), ["student.missing", "lab.missing"]);
    assert_eq!(codes(&submit("- a\n- b").findings), ["file.not_a_mapping", "student.missing"]);
    assert!(!submit("just words").readable && submit("# nothing\n").readable);
    let same = submit(
        "lab: Tank\nstudent: {id: a}\nanswers: {low.response.poles: -1, low: {response: {poles: -1}}}",
    );
    assert_eq!(same.findings, []);
    let many: String = (0..20_000).map(|i| format!("low.respons.poles{i}: 1\n")).collect();
    assert!(submit(&many[..250_000]).findings.len() <= 101);
}

#[test]
fn students_are_read_alone_and_in_groups() {
    for (yaml, expected) in [
        ("student: {id: EE-1, name: A. B}", vec![("EE-1", "A. B")]),
        ("student: {id: 0123, name: 7}", vec![("0123", "7")]),
        ("student: EE-1", vec![("EE-1", "")]),
        ("student: A. Student", vec![("stem", "A. Student")]),
        ("students:\n  - {id: a, name: A}\n  - {id: b}\n", vec![("a", "A"), ("b", "")]),
        ("students: [{name: A}, {name: B}]", vec![("stem", "A"), ("stem 2", "B")]),
        ("students: [a, b]", vec![("a", ""), ("b", "")]),
        ("students: {id: a}", vec![("a", "")]),
        ("student: {id: , name: }", vec![("stem", "")]),
        ("student:", vec![("stem", "")]),
    ] {
        let submission = submit(&format!("lab: tank\n{yaml}"));
        let found: Vec<_> = submission.students.iter().map(|s| (s.id.as_str(), s.name.as_str())).collect();
        assert_eq!(found, expected, "{yaml}");
    }
}

#[test]
fn a_file_that_is_not_yaml_still_names_its_students() {
    for (text, code, expected, lab) in [
        (
            "lab: tank\nstudent: {id: EE-015, name: N. Pressed}\nanswers: [\n  expect: \"open\n  low: [1\n",
            "file.not_yaml",
            vec![("EE-015", "N. Pressed")],
            Some("tank"),
        ),
        (
            "students:\n  - id: \"EE-1\"\n    name: 'A'\n  - {name: B, id: EE-2}\nanswers:\n\texpect: x\n",
            "file.not_yaml",
            vec![("EE-1", "A"), ("EE-2", "")],
            None,
        ),
        ("answers: {id: no\n", "file.not_yaml", vec![("stem", "")], None),
        ("student: {id: x}\nanswers: &a\n  <<: *a\n", "file.not_yaml", vec![("x", "")], None),
        ("student: {id: x}\n---\nstudent: {id: y}\n", "file.not_yaml", vec![("x", "")], None),
    ] {
        let submission = submit(text);
        assert!(!submission.readable, "{text:?}");
        let found: Vec<_> = submission.students.iter().map(|s| (s.id.as_str(), s.name.as_str())).collect();
        assert_eq!((found, submission.lab.as_deref()), (expected, lab), "{text:?}");
        assert_eq!(submission.findings[0].code, code);
        assert!(submission.findings[0].span.is_some(), "{:?}", submission.findings);
        assert_eq!(submission.findings.len(), 2);
    }
}

#[test]
fn an_answer_that_is_not_yaml_costs_only_itself() {
    for wrong in ["it is: so", "**bold**", "\"open", "[1, 2", "@here", "|\n  a\nb c d"] {
        let text = format!(
            "lab: tank\nstudent: {{id: x}}\nanswers:\n  low.response.poles: -1\n  expect: {wrong}\n  low.response.shape: ramp\n"
        );
        let submission = submit(&text);
        assert!(submission.readable && submission.students[0].id == "x", "{text}");
        let codes = codes(&submission.findings);
        assert_eq!(codes, ["answer.not_yaml"], "{text}: {:?}", submission.findings);
        let read = |path: &str| submission.answers.get(path).map(|answer| answer.value.is_ok());
        let found = ["low.response.poles", "expect", "low.response.shape"].map(read);
        assert_eq!(found, [Some(true), Some(false), Some(true)], "{text}");
    }
    let text = "lab: tank\nanswers:\n  low:\n    response: [a: [1\n  expect: so\n";
    let submission = submit(text);
    let lost = submission.answers.values().filter(|answer| answer.value.is_err()).count();
    assert!(lost > 1 && submission.answers["expect"].value.is_ok(), "{:?}", submission.answers);
    assert_eq!(submission.findings.iter().filter(|finding| finding.code == "answer.not_yaml").count(), 1);
}

#[test]
fn what_is_not_text_is_said_to_be_so() {
    for bytes in [&b"\xff\xfe\0\xd8"[..], b"lab: \xe9", b"a\0b"] {
        let submission = read("stem", "stem.yaml", bytes, &sheet(), &NoFiles);
        assert!(!submission.readable);
        assert_eq!(codes(&submission.findings), ["file.not_text"]);
        assert_eq!(submission.students[0].id, "stem");
    }
    let large = read("stem", "stem.yaml", &vec![b'a'; 262_145], &sheet(), &NoFiles);
    assert!(!large.readable);
    assert_eq!(codes(&large.findings), ["file.too_large"]);
    assert_eq!(large.findings[0].message, "The file is larger than the 256 kB we read.");
    assert!(large.findings[0].help.is_some());
    let many = submit(&format!("student: {{id: x}}\nanswers: [{}]", vec!["1"; 30_000].join(",")));
    assert_eq!(many.findings[0].message, "The file has more than 20,000 values.");
    assert!(many.findings[0].help.as_deref().unwrap().contains("table"));
    let utf16: Vec<u8> = "\u{feff}lab: tank".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(read("stem", "s", &utf16, &sheet(), &NoFiles).lab.as_deref(), Some("tank"));
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    assert_eq!(submit(&windows).findings, []);
    assert_eq!(submit(&windows).answers.len(), 10);
}

#[test]
fn hostile_files_are_findings() {
    let field =
        |path: &str, value: &str| format!("lab: tank\nstudent: {{id: a}}\nanswers:\n  {path}: \"{value}\"\n");
    let deep = "(".repeat(100_000);
    for path in
        ["low.transfer_function", "low.response.poles", "low.response.final_value", "low.response.stability"]
    {
        for value in [
            deep.as_str(),
            &"9".repeat(100_000),
            &"-1,".repeat(50_000),
            &"s^2+".repeat(20_000),
            "1e99999999999",
        ] {
            let submission = submit(&field(path, value));
            let [finding] = submission.findings.as_slice() else {
                panic!("{path}: {:?}", submission.findings.len())
            };
            assert!(finding.message.len() < 400, "{path}: {}", finding.message);
            assert!(finding.render(&submission.source, false).len() < 2_000);
        }
    }
    let prose = submit(&field("expect", &"x".repeat(MAX_PROSE_BYTES + 1)));
    assert_eq!(codes(&prose.findings), ["prose.too_long"]);
    for text in [
        "[".repeat(100_000),
        "{".repeat(100_000),
        "- ".repeat(100_000),
        "a: ".repeat(1_000),
        "\u{1b}[31m".into(),
    ] {
        let submission = submit(&text);
        assert!(!submission.findings.is_empty());
        for finding in &submission.findings {
            assert!(!finding.render(&submission.source, false).contains('\u{1b}'));
            assert!(!finding.render_line(&submission.source).contains('\u{1b}'));
        }
    }
    let escape =
        submit("student: {id: a}\nlab: tank\nanswers: {low.response.stability: \"\\e[31mgreen\\u202E\"}");
    assert!(!escape.findings[0].message.contains(['\u{1b}', '\u{202e}']), "{:?}", escape.findings);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_bytes_are_read(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        exercise(&bytes);
    }

    #[test]
    fn any_text_is_read(text in "\\PC{0,120}") {
        exercise(text.as_bytes());
    }

    #[test]
    fn any_value_is_read(text in "[-+±0-9.,eijs()*/^ ×x=∞≈'a-z\"\\[\\]\u{2212}]{0,30}") {
        for path in ["low.transfer_function", "low.response.poles", "low.response.final_value", "low.response.data", "low.response.shape"] {
            let quoted = text.replace('\\', "\\\\").replace('"', "\\\"");
            exercise(format!("answers:\n  {path}: \"{quoted}\"\n").as_bytes());
            exercise(format!("answers:\n  {path}: {text}\n").as_bytes());
            exercise(format!("answers:\n  {path}: [{text}]\n").as_bytes());
        }
    }

    #[test]
    fn mutated_files_are_read(cuts in proptest::collection::vec((0..GOOD.len(), 0..20usize, "[-:,\\[\\]{}&*|>'\" \n\t±0-9a]{0,3}"), 1..4)) {
        let mut bytes = GOOD.as_bytes().to_vec();
        for (at, length, insert) in cuts {
            let at = at.min(bytes.len());
            let end = (at + length).min(bytes.len());
            bytes.splice(at..end, insert.bytes());
        }
        exercise(&bytes);
    }
}

/// Everything one can do with a file that was read; spans must fit and nothing may panic.
fn exercise(bytes: &[u8]) {
    let submission = read("stem", "stem.yaml", bytes, &sheet(), &files());
    assert!(!submission.students.is_empty());
    let text = &submission.source.text;
    for finding in submission.findings.iter().chain(&self_check(&submission, &sheet())) {
        if let Some(span) = finding.span {
            assert!(text.get(span.start..span.end).is_some(), "{finding:?}");
        }
        finding.render(&submission.source, true);
    }
    for answer in submission.answers.values() {
        assert!(text.get(answer.span.start..answer.span.end).is_some_and(|t| !t.is_empty()), "{answer:?}");
        answer.read_as();
    }
}

/// The codes self_check gives for these answers about one system.
#[track_caller]
fn check_itself(answers: &str, expected: &[&str]) {
    let text = format!("lab: tank\nstudent: {{id: a}}\nanswers:\n  low:\n{}", answers.replace("; ", "\n"));
    let text: String = text
        .lines()
        .enumerate()
        .map(|(i, l)| if i > 3 { format!("    {l}\n") } else { format!("{l}\n") })
        .collect();
    let submission = submit(&text);
    assert_eq!(submission.findings, [], "{answers}");
    let findings = self_check(&submission, &sheet());
    let found: Vec<_> = codes(&findings).into_iter().filter(|code| *code != "answer.missing").collect();
    assert_eq!(found, expected, "{answers}: {findings:?}");
    for finding in findings.iter().filter(|f| f.code.starts_with("contradiction")) {
        assert!(finding.span.is_some() && finding.message.matches("(line ").count() == 2, "{finding:?}");
        assert!(!finding.message.contains("wrong"), "{finding:?}");
    }
}

#[test]
fn a_file_is_held_against_itself() {
    const G: &str = "transfer_function: 2 / (s^2 + 2s + 5)";
    let g = |rest: &str| format!("{G}; {rest}");
    let response = |rest: &str| format!("response.{rest}");
    for (answers, expected) in [
        (g("response.poles: -1 ± 2j"), &[][..]),
        (g("response.poles: -1.0 ± 2.02j"), &[]),
        (g("response.poles: -1 ± 2.4j"), &["contradiction.poles_and_transfer_function"]),
        (g("response.poles: -1.04 ± 2j"), &[]),
        (g("response.poles: -1.0 ± 3.0j"), &["contradiction.poles_and_transfer_function"]),
        (g("response.poles: -1"), &["contradiction.poles_and_transfer_function"]),
        (g("response.poles: -1 + 2j"), &["poles.conjugate_missing"]),
        (g("response.poles: [-1 ± 2j, 0]"), &["contradiction.poles_and_transfer_function"]),
        ("transfer_function: s/(s*(s+1)); response.poles: -1".into(), &[]),
        (
            "transfer_function: s/(s*(s+1)); response.poles: [-1, 0]".into(),
            &["contradiction.poles_and_transfer_function"],
        ),
        ("transfer_function: 1/(s^2+2.01s+1); response.poles: -1 (x2)".into(), &[]),
        ("transfer_function: 1/(s+1)^2; response.poles: [-1.05, -0.95]".into(), &[]),
        (
            "transfer_function: 1/(s+1)^2; response.poles: -1".into(),
            &["contradiction.poles_and_transfer_function"],
        ),
        (g("response.stability: stable"), &[]),
        (g("response.stability: unstable"), &["contradiction.stability_and_transfer_function"]),
        (g("response.stability: marginally stable"), &["contradiction.stability_and_transfer_function"]),
        (response("poles: [-1, 2]; response.stability: stable"), &["contradiction.stability_and_poles"]),
        (response("poles: [-1, 0]; response.stability: stable"), &["contradiction.stability_and_poles"]),
        (response("poles: [-1, 0]; response.stability: marginally stable"), &[]),
        (
            response("poles: [0, 0]; response.stability: marginally stable"),
            &["contradiction.stability_and_poles"],
        ),
        (response("stability: stable; response.final_value: 0"), &[]),
        (response("stability: stable; response.final_value: 1"), &["contradiction.final_value"]),
        (response("stability: stable; response.final_value: unbounded"), &["contradiction.final_value"]),
        (response("stability: unstable; response.final_value: unbounded"), &[]),
        (response("stability: unstable; response.final_value: 0"), &["contradiction.final_value"]),
        (response("stability: marginally stable; response.final_value: ∞"), &["contradiction.final_value"]),
        (response("poles: [2]; response.final_value: 0"), &["contradiction.final_value"]),
        (g("response.final_value: +∞"), &["contradiction.final_value"]),
        (response("stability: stable; response.shape: decaying oscillation"), &[]),
        (
            response("stability: stable; response.shape: exponential growth"),
            &["contradiction.shape_and_stability"],
        ),
        (
            response("stability: unstable; response.shape: decaying oscillation"),
            &["contradiction.shape_and_stability"],
        ),
        (
            response("stability: stable; response.shape: sustained oscillation"),
            &["contradiction.shape_and_stability"],
        ),
        (
            response("poles: [-1, -2]; response.shape: decaying oscillation"),
            &["contradiction.shape_and_poles"],
        ),
        (response("poles: [-1, -2 ± j]; response.shape: exponential decay"), &[]),
        (g("response.initial_value: 0"), &[]),
        (g("response.initial_value: 2"), &["contradiction.initial_value"]),
        (g("response.initial_value: ∞"), &["contradiction.initial_value"]),
        ("transfer_function: 2/(3s+1); response.initial_value: 0.667".into(), &[]),
        ("transfer_function: 2/(3s+1); response.initial_value: 0".into(), &["contradiction.initial_value"]),
        ("transfer_function: 2; response.initial_value: 7".into(), &[]),
        ("transfer_function: 1/(s+1); response.data: [[0, 1], [1, 0.37], [2, 0.14]]".into(), &[]),
        ("transfer_function: 1/(s+1); response.data: [[0, 5, 1], [1, 5, 0.37]]".into(), &[]),
        (
            "transfer_function: 1/(s+1); response.data: [[0, 0], [1, 0.63], [2, 0.86]]".into(),
            &["contradiction.data_and_transfer_function"],
        ),
    ] {
        check_itself(&answers, expected);
    }
}

#[test]
fn what_is_missing_is_named_with_its_question() {
    let submission =
        submit("lab: tank\nstudent: {id: a}\nanswers: {low.response.poles: x, valve.nonlinearity: relay}");
    let findings = self_check(&submission, &sheet());
    assert_eq!(findings.len(), 6);
    assert_eq!(findings[0].message, "`expect` has no answer: Prompt of expect.");
    assert!(findings.iter().all(|f| f.code == "answer.missing" && !f.message.contains("poles")));
    assert_eq!(self_check(&submit("a: [b"), &sheet()), []);
}
