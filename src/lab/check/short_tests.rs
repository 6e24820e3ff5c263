//! Labs that say as little as they can, and what is said when that is too little.

use crate::lab::{Check, CoverSource, FeatureKind, LabDefinition, Points};
use crate::lti::InputKind;
use crate::source::SourceText;
use crate::submission::FieldKind;

/// A pendulum driven at its pivot, and whatever is asked of it.
fn pendulum(questions: &str) -> String {
    format!(
        "\
lab: pendulum
parameters: {{b: {{value: 0.02}}, g: {{value: 9.81}}}}
models:
  arm:
    coordinates: {{theta: {{unit: rad}}}}
    inputs: {{tau: {{unit: N*m}}}}
    equations: [\"theta'' + b*theta' + g*sin(theta) = tau\"]
    operating_points:
      hanging_down: {{input: tau, output: theta}}
questions:
{questions}"
    )
}

#[track_caller]
fn parse(questions: &str) -> LabDefinition {
    LabDefinition::parse(SourceText::new("lab.yaml", pendulum(questions)))
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

#[test]
fn what_a_short_lab_leaves_out() {
    let lab = parse(
        "  down.transfer_function:
    points: 5
    answer: transfer_function
  down.response:
    points: 3.01
    response: step
    fields:
      word: stability
      overshoot: {feature: overshoot_percent, points: 1}
      picture: figure
    model_answer:
      word: stable
  battery: {points: 1, answer: {expected: dead zone}}
",
    );
    assert_eq!((lab.title.as_str(), lab.models[0].title.as_str()), ("Pendulum", "Arm"));
    assert_eq!(lab.models[0].operating_points[0].title, "Hanging down");
    let questions: Vec<_> =
        lab.questions.iter().map(|q| (q.number.as_str(), q.title.as_str(), q.points)).collect();
    assert_eq!(
        questions,
        [
            ("Question 1", "Down: transfer function", Points(500)),
            ("Question 2", "Down: response", Points(301)),
            ("Question 3", "Battery", Points(100)),
        ]
    );
    let criteria: Vec<_> = lab
        .questions
        .iter()
        .flat_map(|q| &q.criteria)
        .map(|c| (c.id.as_str(), c.title.as_str(), c.points.0, c.field.as_str()))
        .collect();
    assert_eq!(
        criteria,
        [
            ("down.transfer_function.structure", "Structure", 100, "down.transfer_function"),
            ("down.transfer_function.numerator", "Numerator", 200, "down.transfer_function"),
            ("down.transfer_function.denominator", "Denominator", 200, "down.transfer_function"),
            ("down.response.word", "Word", 101, "down.response.word"),
            ("down.response.overshoot", "Overshoot", 100, "down.response.overshoot"),
            ("down.response.picture", "Picture", 100, "down.response.picture"),
            ("battery.nonlinearity", "Nonlinearity", 100, "battery"),
        ]
    );
    let prompts: Vec<_> =
        lab.questions.iter().flat_map(|q| &q.fields).map(|f| (f.kind, f.prompt.as_str())).collect();
    assert_eq!(
        prompts,
        [
            (FieldKind::TransferFunction, "Transfer function from tau to theta"),
            (FieldKind::Stability, "Is it stable?"),
            (FieldKind::Value, "Overshoot, of the step response"),
            (FieldKind::Figure, "Plot of the step response"),
            (FieldKind::Nonlinearity, "Kind of nonlinearity"),
        ]
    );
    let cover: Vec<_> = lab.cover.rows.iter().map(|row| (row.id.as_str(), row.points.0, row.from)).collect();
    assert_eq!((cover, lab.cover.total), (vec![("questions", 901, CoverSource::Questions)], Points(901)));
    let Check::Denominator { one_slip, .. } = &lab.questions[0].criteria[2].check else { panic!() };
    assert_eq!(one_slip.to_string(), "1/2");
}

#[test]
fn a_kind_may_be_a_feature() {
    #[track_caller]
    fn check(answer: &str, feature: FeatureKind, response: InputKind) {
        let lab = parse(&format!("  q: {{points: 1, answer: {answer}}}\n"));
        let Check::Feature { feature: found, response: of, .. } = &lab.questions[0].criteria[0].check else {
            panic!("{answer}");
        };
        assert_eq!((found.kind, *of), (feature, response), "{answer}");
    }
    check("period_s", FeatureKind::PeriodS, InputKind::Impulse);
    check("overshoot_percent", FeatureKind::OvershootPercent, InputKind::Step);
    check("{kind: peak}", FeatureKind::Peak, InputKind::Impulse);
    check("{kind: value, feature: peak, response: step}", FeatureKind::Peak, InputKind::Step);
    check("{feature: final_value}", FeatureKind::FinalValue, InputKind::Impulse);
}

#[test]
fn parts_share_what_the_others_leave() {
    #[track_caller]
    fn check(question: &str, points: i64, parts: &[i64]) {
        let lab = parse(&format!("  q:\n    {}\n", question.replace('\n', "\n    ")));
        let found: Vec<i64> = lab.questions[0].criteria.iter().map(|c| c.points.0).collect();
        assert_eq!((lab.questions[0].points.0, found.as_slice()), (points, parts), "{question}");
    }
    check("points: 3\nfields: {a: poles, b: stability, c: shape}", 300, &[100, 100, 100]);
    check("points: 1\nfields: {a: poles, b: stability, c: shape}", 100, &[33, 34, 33]);
    check("points: 3\nfields: {a: {kind: poles, points: 2}, b: stability, c: shape}", 300, &[200, 50, 50]);
    check("fields: {a: {kind: poles, points: 2}, b: {kind: shape, points: 1}}", 300, &[200, 100]);
    check("points: 4\nfields: {a: transfer_function, b: stability}", 400, &[40, 80, 80, 200]);
    check("answer: {kind: poles, points: 2}", 200, &[200]);
    check("points: 2\nanswer: stability\ncriteria: {word: {check: stability}}", 200, &[200]);
    check("answer: stability\ncriteria: {word: {check: stability, points: 3}}", 300, &[300]);
}

#[test]
fn too_little_is_said() {
    #[track_caller]
    fn check(question: &str, place: &str, message: &str, help: &str) {
        let text = pendulum(&format!("  q: {question}\n"));
        let errors = LabDefinition::parse(SourceText::new("lab.yaml", text.as_str())).unwrap_err();
        let found: Vec<_> = errors
            .findings
            .iter()
            .map(|f| {
                let place = f.span.map_or("nowhere", |span| &text[span.start..span.end]);
                (place, f.message.as_str(), f.help.as_deref().unwrap_or_default())
            })
            .collect();
        assert_eq!(found, [(place, message, help)], "{question}");
    }
    check("{answer: poles}", "q", "it is not said how many points `q` is worth", "add `points:`");
    check("{points: 1, answer: pole}", "pole", "there is no kind of field `pole`", "did you mean `poles`?");
    check(
        "{points: 1, answer: settling_time}",
        "settling_time",
        "there is no kind of field `settling_time`",
        "known: `transfer_function`, `poles`, `value`, `stability`, `shape`, `nonlinearity`, `formula`, `prose`, `figure`, `data`",
    );
    check(
        "{points: 1, answer: value}",
        "value",
        "the field `q` of kind `value` needs `feature` or `value` to be judged",
        "add it to the field, or give the question `criteria`",
    );
    check(
        "{points: 1, answer: nonlinearity}",
        "nonlinearity",
        "the field `q` of kind `nonlinearity` needs `expected` to be judged",
        "add it to the field, or give the question `criteria`",
    );
    check(
        "{points: 1, answer: {prompt: Which}}",
        "q",
        "it is not said of which kind the field `q` is",
        "add `kind:` to the field",
    );
    check(
        "{points: 1, answer: {feature: peak}, criteria: {c: {check: feature, feature: peak}}}",
        "peak",
        "`feature` of a field means nothing beside `criteria`",
        "say `feature` in the criterion, or leave `criteria` out",
    );
    check(
        "{points: 2, fields: {a: {kind: poles, points: 2}, b: shape}}",
        "2",
        "the fields of `q` add up to 2 points, but the question is worth 2",
        "raise `points`, since a field without points has a share of what is left",
    );
    check(
        "{points: 0.02, answer: transfer_function}",
        "transfer_function",
        "the field `q` is worth too little to be shared among its criteria",
        "give it more points",
    );
}
