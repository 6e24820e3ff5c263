//! What explains a mark: the ledger, follow-through, marked equations, words that do not go with the numbers.

use super::tests::{FIXTURE, HOSTILE, check_page, read};
use crate::grading::{
    Cause, Conflict, Diagnosis, EquationPlace, Explanation, FollowThrough, Guard, ItemScore, Ledger, Loss,
    Scorecard, Spared, Tally, Verdict, grade,
};
use crate::lab::Points;
use crate::source::Span;
use crate::submission::Submission;

fn graded(submission: &Submission) -> Scorecard {
    grade(&FIXTURE.lab, &FIXTURE.reference, &FIXTURE.catalogue, submission, None)
}

fn item<'a>(card: &'a mut Scorecard, id: &str) -> &'a mut ItemScore {
    card.questions.iter_mut().flat_map(|q| &mut q.items).find(|i| i.id == id).expect("a criterion of the lab")
}

/// A ledger of what the verdicts say, as if every mistake stood alone.
fn ledger(card: &Scorecard) -> Ledger {
    let lost = |i: &ItemScore| Loss {
        item: i.id.clone(),
        points: i.possible - i.earned,
        cause: match i.verdict {
            Verdict::Blank => Cause::Blank,
            Verdict::Unreadable => Cause::Unreadable,
            Verdict::Unmarked => Cause::Unmarked,
            _ => Cause::Here,
        },
    };
    let items = card.questions.iter().flat_map(|q| &q.items);
    Ledger { lost: items.filter(|i| i.earned < i.possible).map(lost).collect(), spared: Vec::new() }
}

const FUNCTION: &str = "0.06s / (-0.0132s^3 - 0.0024s^2 + 0.41202s + 0.05886)";
const ROOT: &str = "hanging.transfer_function.denominator";

/// A wrong function, and what follows from it; `prose` describes the response.
fn followed(prose: &str, guard: Guard) -> (Submission, Scorecard) {
    let prose = serde_json::to_string(prose).unwrap();
    let yaml = format!(
        "answers:\n  hanging.transfer_function: {FUNCTION}\n  hanging.response:\n    stability: unstable\n    shape: \
         exponential growth\n    description: {prose}\n"
    );
    let submission = read(&yaml);
    let mut card = graded(&submission);
    let credited = guard == Guard::Passed;
    let (mut spared, mut refused) = (Vec::new(), Vec::new());
    for id in ["hanging.response.stability", "hanging.response.shape"] {
        let item = item(&mut card, id);
        let (own, root) = ("your own transfer function".to_owned(), ROOT.to_owned());
        item.follow_through = Some(FollowThrough { credited, guard, root: root.clone(), own });
        if credited {
            (item.earned, item.verdict, item.code) = (item.possible, Verdict::Right, "stability.follows");
            spared.push(Spared { item: id.into(), points: item.possible, root });
        } else {
            (item.earned, item.verdict) = (Points::ZERO, Verdict::Wrong);
            refused.push(id);
        }
    }
    for question in &mut card.questions {
        question.tally = Tally::of(&question.items);
    }
    card.total = card.questions.iter().map(|q| q.tally).fold(Tally::default(), |a, b| a + b);
    card.ledger = ledger(&card);
    card.ledger.spared = spared;
    for loss in card.ledger.lost.iter_mut().filter(|loss| refused.contains(&loss.item.as_str())) {
        loss.cause = Cause::Refused { root: ROOT.into(), guard };
    }
    (submission, card)
}

#[track_caller]
fn check_has(html: &str, parts: &[&str]) {
    for part in parts {
        assert!(html.contains(part), "no {part} in\n{html}");
    }
}

fn page(submission: &Submission, card: &Scorecard) -> String {
    let html = FIXTURE.kit.student_page(submission, card);
    check_page("explained", &html);
    html
}

#[test]
fn the_ledger_says_where_each_point_went_and_what_was_spared() {
    let (submission, card) = followed("It runs away.", Guard::Passed);
    let html = page(&submission, &card);
    check_has(
        &html,
        &[
            "<a href=\"#item-hanging.response.plot\">Plot of the impulse response</a>, <a href=\"#item-hanging.response.poles\">Poles</a>",
            "<td>left blank</td>",
            &format!("({} possible − {} earned)", card.total.possible, card.total.earned),
            "is charged there only. What rests on it kept 2 points:",
            "<li>Task 1, question 4, right for your own transfer function: <a href",
            "<span aria-hidden=\"true\">↪</span> right for your own transfer function</span> <strong>Stability</strong> <span class=\"muted\">see <a href=\"#item-hanging.transfer_function.denominator\">Task 1, question 3: Denominator</a></span>",
            "and was not charged again: 2 points were kept in Task 1, question 4 (",
        ],
    );
    let lost: Points = card.ledger.lost.iter().map(|loss| loss.points).sum();
    assert_eq!(lost, card.total.possible - card.total.earned);
    check_has(&html, &[&format!("<td class=\"num\">{lost}</td></tr></tfoot>")]);
}

#[test]
fn a_refused_follow_through_says_why() {
    for (guard, words) in [
        (Guard::Order, "not of the order asked for"),
        (Guard::Trivial, "too simple"),
        (Guard::OtherPoint, "belongs to another operating point"),
    ] {
        let (submission, card) = followed("It runs away.", guard);
        let html = page(&submission, &card);
        check_has(
            &html,
            &[
                "your own transfer function not followed</span> <span class=\"muted\">see <a",
                words,
                "would follow from the mistake at <a",
            ],
        );
        assert_eq!(html.matches("your own transfer function not followed").count(), 2, "at both criteria");
    }
}

#[test]
fn nothing_lost_is_a_single_line() {
    let submission = &FIXTURE.lab.model_answer;
    let card = graded(submission);
    let html = page(submission, &card);
    check_has(&html, &["Nowhere: all 45 points were earned.", "Every question has all its points."]);
    assert!(!html.contains("class=\"ledger\""));
}

#[test]
fn what_was_not_written_at_all_is_a_single_line() {
    let submission = read("answers: {}");
    let html = page(&submission, &graded(&submission));
    check_has(&html, &["Nothing was written: all 45 points."]);
    assert!(!html.contains("class=\"ledger\""));
}

#[test]
fn a_ledger_that_does_not_add_up_is_not_shown() {
    let (submission, mut card) = followed("It runs away.", Guard::Passed);
    card.ledger.lost.pop();
    assert!(!page(&submission, &card).contains("Where the points went"));
}

#[test]
fn the_part_of_the_equation_is_marked() {
    let (submission, mut card) = followed("It runs away.", Guard::Passed);
    let model = &FIXTURE.lab.models[0];
    let text = &model.model.equations[1].text;
    let place = |part: &str| {
        let start = text.find(part).unwrap();
        EquationPlace { model: model.id.clone(), equation: 1, span: Span { start, end: start + part.len() } }
    };
    let explanation = |places| Explanation {
        code: "term.sign".into(),
        words: "The term `m*g*l*sin(theta)` of equation 2 has the wrong sign.".into(),
        changes: Vec::new(),
        mistakes: Vec::new(),
        places,
    };
    let outside =
        EquationPlace { model: "no such model".into(), equation: 7, span: Span { start: 1, end: 2 } };
    let beyond = EquationPlace { span: Span { start: 5, end: 9_000 }, ..place("l") };
    let explanations = vec![
        explanation(vec![place("m*g*l*sin(theta)"), place("m*l^2")]),
        explanation(vec![outside, beyond]),
    ];
    item(&mut card, ROOT).diagnosis = Some(Diagnosis { explanations, searched: 1 });
    let html = page(&submission, &card);
    assert_eq!(html.matches("<mrow class=\"here\">").count(), 2);
    assert_eq!(html.matches("<mtext>here</mtext></munder>").count(), 2);
    check_has(&html, &["Equation 2 as it is given; the boxes show the places."]);
}

#[test]
fn words_that_do_not_go_with_the_numbers_are_marked_and_told() {
    let conflict = |text: &str, words: &str, own| {
        let start = text.find(words).unwrap_or(0);
        Conflict {
            span: Span { start, end: start + words.len() },
            claim: "it is stable".into(),
            against: format!("Your pole `5.57` {words} lies in the right half-plane."),
            own,
        }
    };
    let show = |text: &str, conflicts: Vec<Conflict>| {
        let (submission, mut card) = followed(text, Guard::Passed);
        for id in ["hanging.response.description", "hanging.response.stability"] {
            if let Some(item) = card.questions.iter_mut().flat_map(|q| &mut q.items).find(|i| i.id == id) {
                item.evidence.conflicts.clone_from(&conflicts);
            }
        }
        let criteria = FIXTURE.lab.questions.iter().flat_map(|q| &q.criteria);
        for criterion in criteria.filter(|c| c.field == "hanging.response.description") {
            item(&mut card, &criterion.id).evidence.conflicts.clone_from(&conflicts);
        }
        page(&submission, &card)
    };
    let text = "We *think* that it is **stable** & sound.\n\nIt settles.";
    let html = show(text, vec![conflict(text, "settles", false), conflict(text, "it is **stable**", true)]);
    check_has(
        &html,
        &[
            "<mark class=\"conflict\">it is </mark><strong><mark class=\"conflict\">stable</mark><sup>1</sup></strong> &amp; sound.",
            "<mark class=\"conflict\">settles</mark><sup>2</sup>",
            "<li value=\"1\"><q>it is **stable**</q> says that it is stable. <span class=\"muted\">Your own answer:</span> Your pole <code>5.57</code>",
            "<span class=\"muted\">Reference:</span> Your pole",
        ],
    );
    for hostile in HOSTILE {
        let text = format!("{hostile} and\u{202e} so {hostile}");
        let whole = Conflict { span: Span { start: 0, end: text.len() }, ..conflict(&text, hostile, true) };
        let odd = Conflict { span: Span { start: 1, end: 9_999_999 }, ..whole.clone() };
        let html = show(&text, vec![whole, conflict(&text, "so", false), odd]);
        assert!(!html.contains('\u{202e}'), "{hostile}");
    }
    let huge = "stable ".repeat(40_000);
    let many = (0..500)
        .map(|i| Conflict { span: Span { start: 7 * i, end: 7 * i + 6 }, ..conflict(&huge, "stable", true) });
    assert!(show(&huge, many.collect()).len() < 400_000);
}
