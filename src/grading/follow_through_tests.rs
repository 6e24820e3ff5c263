//! What follows from a student's own answers, by tables solved by hand, and laws of the ledger.

use super::*;
use crate::lab::{self, LabDefinition, Points};
use crate::reference::Reference;
use crate::source::SourceText;
use crate::submission::{NoFiles, read};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::LazyLock;

struct Bench {
    lab: LabDefinition,
    reference: Reference,
    catalogue: Catalogue,
}

impl Bench {
    /// The embedded lab with `changes` made to its text.
    fn new(changes: &[(&str, &str)]) -> Self {
        let mut text = lab::embedded().iter().find(|(id, _)| *id == lab::DEFAULT).unwrap().1.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", &text)).unwrap();
        let reference = Reference::compute(&lab).unwrap();
        let catalogue = Catalogue::new(&lab, &reference);
        Self { lab, reference, catalogue }
    }

    fn card(&self, answers: &str, hand: Option<&HandMarks>) -> Scorecard {
        let text = format!("lab: ee361-lab3\nanswers:\n{answers}");
        let submission = read("x", "x.yaml", text.as_bytes(), &self.lab.sheet, &NoFiles);
        grade(&self.lab, &self.reference, &self.catalogue, &submission, hand)
    }

    /// Answers; then criterion, hundredths of points, code.
    #[track_caller]
    fn check(&self, answers: &str, rows: &[(&str, i64, &str)]) -> Scorecard {
        let card = self.card(answers, None);
        for (id, points, code) in rows {
            let item = item(&card, id);
            assert_eq!((item.earned, item.code), (Points(*points), *code), "{answers}{id}: {item:#?}");
        }
        ledger_adds_up(&card);
        card
    }
}

static LAB: LazyLock<Bench> = LazyLock::new(|| Bench::new(&[]));

fn item<'a>(card: &'a Scorecard, id: &str) -> &'a ItemScore {
    items(card).find(|item| item.id == id).unwrap()
}

fn items(card: &Scorecard) -> impl Iterator<Item = &ItemScore> {
    card.questions.iter().flat_map(|question| &question.items)
}

#[track_caller]
fn ledger_adds_up(card: &Scorecard) {
    let lost: Points = card.ledger.lost.iter().map(|loss| loss.points).sum();
    assert_eq!(lost.0, card.total.possible.0 - card.total.earned.0, "{:#?}", card.ledger);
    for item in items(card) {
        let lost: i64 =
            card.ledger.lost.iter().filter(|loss| loss.item == item.id).map(|loss| loss.points.0).sum();
        assert_eq!(lost, item.possible.0 - item.earned.0, "{}", item.id);
        let spared = card.ledger.spared.iter().filter(|spared| spared.item == item.id).count();
        let credited = item.follow_through.as_ref().is_some_and(|followed| followed.credited);
        assert_eq!(spared == 1, credited, "{}", item.id);
    }
    for spared in &card.ledger.spared {
        assert!(spared.points > Points::ZERO && spared.points <= item(card, &spared.item).earned);
    }
}

/// Answers to the question on the response about θ = 0, after the transfer function.
fn hanging(function: &str, response: &[(&str, &str)]) -> String {
    let mut text = format!("  hanging.transfer_function: {function}\n");
    for (field, value) in response {
        writeln!(text, "  hanging.response.{field}: {value}").unwrap();
    }
    text
}

const GRAVITY: &str = "-0.06s/(0.0132s^3 + 0.0024s^2 - 0.412s - 0.0589)";
const RIGHT: &str = "-0.06s/(0.0132s^3 + 0.0024s^2 + 0.412s + 0.0589)";
const POLES: &str = "hanging.response.poles";
const WORD: &str = "hanging.response.stability";
const FINAL: &str = "hanging.response.final_value";
const SHAPE: &str = "hanging.response.shape";
const DENOMINATOR: &str = "hanging.transfer_function.denominator";

/// Three poles 1e-200 apart: nobody waits for that response, and no points are lost for it without a word.
#[test]
fn what_cannot_be_followed_is_left_to_a_person() {
    let answers = hanging(
        "-0.06s/((s + 1)*(s + 1 + 1e-200)*(s + 1 + 2e-200))",
        &[("final_value", "7"), ("shape", "exponential decay"), ("stability", "unstable")],
    );
    let card = LAB.check(&answers, &[(FINAL, 0, "unmarked"), (SHAPE, 0, "unmarked")]);
    for id in [FINAL, SHAPE] {
        let item = item(&card, id);
        assert_eq!((item.verdict, item.provisional), (Verdict::Unmarked, true), "{id}");
        assert!(item.evidence.reason.contains("polemark cannot tell: "), "{id}: {:?}", item.evidence);
        assert!(item.evidence.reason.ends_with("A person will."), "{id}: {:?}", item.evidence);
    }
}

#[test]
fn what_follows_is_not_charged_again() {
    let answers = hanging(
        GRAVITY,
        &[
            ("poles", "[5.568, -5.607, -0.1428]"),
            ("final_value", "-∞"),
            ("shape", "exponential growth"),
            ("stability", "unstable"),
        ],
    );
    let card = LAB.check(
        &answers,
        &[
            (DENOMINATOR, 0, "denominator.sign"),
            (POLES, 50, "poles.follows"),
            (FINAL, 50, "value.follows"),
            (SHAPE, 100, "shape.follows"),
            (WORD, 100, "stability.follows"),
        ],
    );
    for id in [POLES, FINAL, SHAPE, WORD] {
        let item = item(&card, id);
        let followed = item.follow_through.as_ref().unwrap();
        assert_eq!((followed.root.as_str(), followed.guard), (DENOMINATOR, Guard::Passed), "{id}");
        assert_eq!((item.verdict, item.provisional), (Verdict::Right, false), "{id}");
        assert!(
            item.evidence.expected.contains(&format!("For {}:", followed.own)),
            "{id}: {:?}",
            item.evidence
        );
    }
    assert_eq!(card.ledger.spared.iter().map(|spared| spared.points).sum::<Points>(), Points(300));
}

#[test]
fn what_does_not_follow_is_charged_where_it_stands() {
    // A conjugate is missing of what would follow: as far as it goes.
    let friction = "-0.06s/(0.0132s^3 - 0.0024s^2 + 0.412s - 0.0589)";
    let card = LAB.check(
        &hanging(friction, &[("poles", "[0.1429, 0.01947 + 5.586j]")]),
        &[(POLES, 25, "poles.follows")],
    );
    let causes: Vec<_> = card
        .ledger
        .lost
        .iter()
        .filter(|loss| loss.item == POLES)
        .map(|loss| (&loss.cause, loss.points))
        .collect();
    assert_eq!(causes, [(&Cause::Here, Points(25))]);
    // Half by the reference is not less because it is nothing by the own function.
    LAB.check(
        &hanging(GRAVITY, &[("poles", "[-0.143, -0.0195 + 5.59j]")]),
        &[(POLES, 25, "poles.missing_conjugate")],
    );
    // Not given, unreadable.
    let answers = hanging(GRAVITY, &[("poles", "[many]")]);
    LAB.check(&answers, &[(POLES, 0, "unreadable"), (SHAPE, 0, "blank")]);
}

#[test]
fn a_right_function_is_as_good_as_the_reference() {
    // Each coefficient is within 0.5 %, the poles are exactly those of what was typed.
    let rounded = "-0.06s/(0.01314s^3 + 0.00239s^2 + 0.414s + 0.0591)";
    let card = LAB.check(&hanging(rounded, &[("stability", "unstable")]), &[(WORD, 0, "stability.opposite")]);
    assert_eq!(item(&card, WORD).follow_through, None);
}

#[test]
fn the_guard_refuses_what_is_easier_than_the_reference() {
    #[track_caller]
    fn check(what: &str, function: &str, poles: &str, word: &str, guard: Guard) {
        let answers = hanging(function, &[("poles", poles), ("stability", word)]);
        let card = LAB.card(&answers, None);
        for id in [POLES, WORD] {
            let item = item(&card, id);
            let followed = item.follow_through.as_ref().unwrap_or_else(|| panic!("{what}: {id}: {item:#?}"));
            assert_eq!((followed.credited, followed.guard), (false, guard), "{what}: {id}");
            assert_eq!(item.earned, Points::ZERO, "{what}: {id}");
            assert!(
                item.evidence.reason.contains("cannot be followed"),
                "{what}: {id}: {}",
                item.evidence.reason
            );
            assert!(
                card.ledger.lost.iter().any(|loss| loss.item == id
                    && matches!(&loss.cause, Cause::Refused { guard: refused, .. } if *refused == guard)),
                "{what}: {:?}",
                card.ledger
            );
        }
        ledger_adds_up(&card);
    }
    let unstable = "unstable";
    check("order 2", "0.06/(0.0132s^2 - 0.412)", "[5.587, -5.587]", unstable, Guard::Order);
    check("order 1", "1/(s - 1)", "[1]", unstable, Guard::Order);
    check("integrators", "1/s^3", "[0, 0, 0]", unstable, Guard::Order);
    check("s too many", "s^2/(s^3 - 2s^2 - 5s + 6)", "[1, -2, 3]", unstable, Guard::Order);
    check("all of one", "s/(s^3 + s^2 + s + 1)", "[-1, ±j]", "marginally stable", Guard::Trivial);
    check("one place", "s/(s - 2)^3", "[2, 2, 2]", unstable, Guard::Trivial);
    check("two terms", "s/(s^3 - 8)", "[2, -1 ± 1.7321j]", unstable, Guard::Trivial);
    check(
        "nothing moves next to it",
        "-0.06s/(0.0132s^3 + 5e9s^2 - 0.412s - 0.0589)",
        "[-3.788e11, 3.4322e-6, -3.4322e-6]",
        unstable,
        Guard::Trivial,
    );
    check(
        "belongs upright",
        "0.06s/(0.0132s^3 + 0.0024s^2 - 0.412s - 0.0589)",
        "[5.568, -5.607, -0.1428]",
        unstable,
        Guard::OtherPoint,
    );
    check(
        "belongs upright, with another g and scale",
        "4.54s/(s^3 + 0.182s^2 - 31.2s - 4.45)",
        "[5.565, -5.604, -0.1428]",
        unstable,
        Guard::OtherPoint,
    );
}

#[test]
fn a_word_rests_on_poles_first_and_on_the_function_as_well() {
    #[track_caller]
    fn check(
        what: &str,
        function: &str,
        poles: &str,
        word: &str,
        points: i64,
        code: &str,
        root: Option<&str>,
    ) {
        let mut response = vec![("stability", word)];
        if !poles.is_empty() {
            response.push(("poles", poles));
        }
        let card = LAB.card(&hanging(function, &response), None);
        let item = item(&card, WORD);
        assert_eq!((item.earned, item.code), (Points(points), code), "{what}: {item:#?}");
        assert_eq!(item.follow_through.as_ref().map(|f| f.root.as_str()), root, "{what}");
        ledger_adds_up(&card);
    }
    let mirrored = "[0.143, 0.0195 ± 5.59j]";
    let right = "[-0.143, -0.0195 ± 5.59j]";
    let (follows, contradicts) = ("stability.follows", "stability.contradicts_own");
    check("right, from right poles", RIGHT, right, "stable", 100, "right", None);
    check("right, from nothing", "''", "", "stable", 100, "right", None);
    check("right, against own poles", RIGHT, mirrored, "stable", 100, "stability.unsupported", None);
    check("right, against the own function", GRAVITY, "", "stable", 100, "stability.unsupported", None);
    check("right, too few poles say nothing", RIGHT, "[0.143]", "stable", 100, "right", None);
    check("wrong, from own poles", RIGHT, mirrored, "unstable", 100, follows, Some(POLES));
    check("wrong, from own poles alone", "''", mirrored, "unstable", 100, follows, Some(POLES));
    check("wrong, against right poles", RIGHT, right, "unstable", 0, contradicts, None);
    check("wrong, against wrong poles", RIGHT, mirrored, "marginally stable", 0, contradicts, Some(POLES));
    check("wrong, from the own function", GRAVITY, "", "unstable", 100, follows, Some(DENOMINATOR));
    check(
        "wrong, from the function though not from the poles",
        GRAVITY,
        right,
        "unstable",
        100,
        follows,
        Some(DENOMINATOR),
    );
    check(
        "wrong, from neither",
        GRAVITY,
        "",
        "marginally stable",
        0,
        "stability.marginal",
        Some(DENOMINATOR),
    );
    check("a conjugate left out", "''", "[0.143, 0.0195 + 5.59j]", "unstable", 100, follows, Some(POLES));
    check("too few poles", "''", "[2]", "unstable", 0, "stability.opposite", Some(POLES));
    check("poles too simple", "''", "[1, 1, 1]", "unstable", 0, "stability.opposite", Some(POLES));
    check(
        "the pole that cancels",
        RIGHT,
        "[0, -0.143, -0.0195 ± 5.59j]",
        "marginally stable",
        100,
        follows,
        Some(POLES),
    );
}

#[test]
fn the_lab_says_what_it_earns() {
    let answers = hanging(
        GRAVITY,
        &[("poles", "[5.568, -5.607, -0.1428]"), ("stability", "unstable"), ("shape", "exponential growth")],
    );
    let half = Bench::new(&[("follow_through: {credit: 1,", "follow_through: {credit: 0.5,")]);
    let card = half.check(
        &answers,
        &[(POLES, 25, "poles.follows"), (WORD, 50, "stability.follows"), (SHAPE, 50, "shape.follows")],
    );
    assert_eq!(item(&card, SHAPE).verdict, Verdict::Partly);
    assert!(item(&card, SHAPE).evidence.reason.contains("50 %"));
    let loss = card.ledger.lost.iter().find(|loss| loss.item == SHAPE).unwrap();
    assert_eq!(loss.cause, Cause::Part { root: DENOMINATOR.to_owned() });
    // Half of what is half right of it, and half of it is charged here.
    let friction = "-0.06s/(0.0132s^3 - 0.0024s^2 + 0.412s - 0.0589)";
    let card = half.check(
        &hanging(friction, &[("poles", "[0.1429, 0.01947 + 5.586j]")]),
        &[(POLES, 13, "poles.follows")],
    );
    let losses: Vec<_> = card.ledger.lost.iter().filter(|loss| loss.item == POLES).collect();
    assert_eq!(losses.iter().map(|loss| loss.points).collect::<Vec<_>>(), [Points(12), Points(25)]);

    let own = Bench::new(&[(
        "title: General shape\n        points: 1\n        check: shape",
        "title: General shape\n        points: 1\n        follow_through: 0.25\n        check: shape",
    )]);
    own.check(
        &answers,
        &[(POLES, 50, "poles.follows"), (WORD, 100, "stability.follows"), (SHAPE, 25, "shape.follows")],
    );

    let none = Bench::new(&[("follow_through: {credit: 1,", "follow_through: {credit: 0,")]);
    let card = none.check(
        &answers,
        &[(POLES, 0, "poles.value"), (WORD, 0, "stability.opposite"), (SHAPE, 0, "shape.other")],
    );
    assert!(items(&card).all(|item| item.follow_through.is_none()));
}

#[test]
fn the_same_mistake_is_charged_once() {
    let two = |hanging: &str, upright: &str| {
        format!("  hanging.transfer_function: {hanging}\n  upright.transfer_function: {upright}\n")
    };
    let up = "upright.transfer_function.denominator";
    let seed = two(
        "0.06s/(-0.0132s^3 - 0.0024s^2 + 0.4166s + 0.0588)",
        "0.06s/(0.0132s^3 + 0.0024s^2 - 0.4166s - 0.0588)",
    );
    let card =
        LAB.check(&seed, &[(DENOMINATOR, 0, "denominator.sign"), (up, 200, "denominator.same_mistake")]);
    assert_eq!(
        card.ledger.spared,
        [Spared { item: up.to_owned(), points: Points(100), root: DENOMINATOR.to_owned() }]
    );
    // The slip is new.
    let later = two(GRAVITY, "0.06s/(0.0132s^3 + 0.0024s^2 - 0.4166s - 0.0588)");
    LAB.check(&later, &[(up, 100, "denominator.one_slip")]);
    // Gravity's sign again, and two digits exchanged: only those are new, and one slip costs half of the denominator.
    let beside = two(GRAVITY, "0.06s/(0.0132s^3 + 0.0042s^2 + 0.41202s + 0.05886)");
    let card = LAB.check(
        &beside,
        &[
            (up, 100, "denominator.same_mistake"),
            ("upright.transfer_function.numerator", 200, "numerator.same_mistake"),
        ],
    );
    let lost: i64 = card.ledger.lost.iter().filter(|loss| loss.item == up).map(|loss| loss.points.0).sum();
    assert_eq!(lost, 100);
    // Another mistake alone is none of the earlier one's.
    LAB.check(
        &two(GRAVITY, "0.06s/(0.0132s^3 - 0.0024s^2 - 0.41202s + 0.05886)"),
        &[(up, 0, "denominator.sign")],
    );
    // The earlier function has no such mistake, or nothing of it.
    let friction = "0.06s/(0.0132s^3 - 0.0024s^2 - 0.41202s + 0.05886)";
    LAB.check(&two(RIGHT, friction), &[(up, 0, "denominator.sign")]);
    LAB.check(&two("''", friction), &[(up, 0, "denominator.sign")]);
    // Two operating points exchanged are two mistakes.
    let swapped = two(
        "0.06s/(0.0132s^3 + 0.0024s^2 - 0.41202s - 0.05886)",
        "-0.06s/(0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)",
    );
    LAB.check(&swapped, &[(DENOMINATOR, 0, "denominator.sign"), (up, 0, "denominator.sign")]);

    let half = Bench::new(&[("same_mistake: 1}", "same_mistake: 0.5}")]);
    half.check(&seed, &[(up, 150, "denominator.same_mistake")]);
    let none = Bench::new(&[("same_mistake: 1}", "same_mistake: 0}")]);
    none.check(&seed, &[(up, 100, "denominator.one_slip")]);

    // What follows from the spared function goes back to where it was charged.
    let mut answers = two("-0.06s/(0.0132s^3 - 0.0024s^2 + 0.41202s - 0.05886)", friction);
    answers.push_str("  upright.response.poles: [5.607, -5.568, 0.1428]\n");
    let card = LAB.check(&answers, &[("upright.response.poles", 50, "poles.follows")]);
    let followed = item(&card, "upright.response.poles").follow_through.clone().unwrap();
    assert_eq!(followed.root, DENOMINATOR);
    assert!(item(&card, "upright.response.poles").evidence.reason.contains("charged in Task 1, question 3"));
}

#[test]
fn a_person_has_the_last_word() {
    let answers = hanging(GRAVITY, &[("shape", "exponential growth"), ("stability", "marginally stable")]);
    let given = |id: &str, points| {
        let given = Override { points: Points(points), reason: "seen".to_owned(), answers: Vec::new() };
        HandMarks { items: [(id.to_owned(), vec![given])].into(), ..HandMarks::default() }
    };
    // What a person takes is theirs to explain.
    let card = LAB.card(&answers, Some(&given(SHAPE, 25)));
    ledger_adds_up(&card);
    let loss = card.ledger.lost.iter().find(|loss| loss.item == SHAPE).unwrap();
    assert_eq!((&loss.cause, loss.points), (&Cause::ByHand, Points(75)));
    assert_eq!(item(&card, SHAPE).follow_through, None);
    // A function that a person takes for right is as good as the reference.
    let card = LAB.card(&answers, Some(&given(DENOMINATOR, 200)));
    ledger_adds_up(&card);
    assert_eq!((item(&card, SHAPE).code, item(&card, SHAPE).earned), ("right", Points(100)));
}

/// None of these may make the later parts easy, or take long.
#[test]
fn hostile_functions_are_marked_like_any_other() {
    let ones = (0..=30).map(|power| format!("{}s^{power}", power + 1)).collect::<Vec<_>>().join(" + ");
    let digits = "123456789".repeat(20);
    let near: Vec<String> = (1..=29).map(|k| format!("(s + 1.{k:0>12})")).collect();
    let functions = [
        format!("1/({})", near.join("*")),
        format!("1/({})", near[..12].join("*")),
        format!("1/(({})*(s^2 + 3s + 7)^9)", near[..12].join("*")),
        "0".to_owned(),
        "s".to_owned(),
        "1/s".to_owned(),
        "s^30".to_owned(),
        "1/s^30".to_owned(),
        format!("1/({ones})"),
        format!("({ones})/s"),
        "s/(1e300s^3 + 1e-300s^2 + 1e300s + 1e-300)".to_owned(),
        "1e300s/(s^3 + 2s^2 + 3s + 4)".to_owned(),
        "1e-300s/(s^3 + 2s^2 + 3s + 4)".to_owned(),
        "-0.06s/(0.0132s^3 + 0.0024s^2 + 1e300s + 0.0589)".to_owned(),
        format!("{digits}s/({digits}s^3 + {digits}1s^2 + {digits}s + {digits}7)"),
        "-0.06s/(0.0132s^3 + 0.0024s^2 + 0.412s + 1e-14)".to_owned(),
        "s/((s + 1)^2*(s + 1.0000000000000000000001))".to_owned(),
        "s^4/(s^4*(s^3 + 2s^2 + 3s + 4))".to_owned(),
        "(s + 1e9)/(s^3 + 1e9s^2 + 1e9)".to_owned(),
    ];
    let response = [
        ("poles", "[1e300, -1e-300, 0, 0, ±1e200j]"),
        ("initial_value", "1e300"),
        ("final_value", "12345"),
        ("shape", "growth like a power of time"),
        ("stability", "marginally stable"),
        ("data", "[[0, 0], [1, 1e300], [2, -1e300], [3, 0], [4, 1], [5, 2], [6, 3], [7, 3], [8, 3], [9, 3]]"),
        ("description", "It is marginally stable and goes on for ever with constant amplitude."),
    ];
    for function in &functions {
        let card = LAB.card(&hanging(function, &response), None);
        ledger_adds_up(&card);
        for item in items(&card) {
            assert!(
                item.follow_through.as_ref().is_none_or(|followed| !followed.credited),
                "{function}: {item:#?}"
            );
        }
    }
}

/// The next of a sequence that looks random and is the same each time.
struct Dice(u64);

impl Dice {
    fn one_of<'a>(&mut self, pool: &[&'a str]) -> &'a str {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        pool[(self.0 >> 33) as usize % pool.len()]
    }
}

/// Right, wrong, made easy, left out, and not to be read, in every mixture.
fn anything(dice: &mut Dice) -> String {
    const FUNCTIONS: &[&str] = &[
        RIGHT,
        GRAVITY,
        "0.06s/(0.0132s^3 + 0.0024s^2 - 0.412s - 0.0589)",
        "-0.06s/(0.0132s^3 - 0.0024s^2 + 0.412s - 0.0589)",
        "0.06s/(0.0132s^3 - 0.0024s^2 - 0.412s + 0.0589)",
        "0.06s/(-0.0132s^3 - 0.0024s^2 + 0.4166s + 0.0588)",
        "0.06s/(0.0132s^3 + 0.0024s^2 - 0.4166s - 0.0588)",
        "-0.06s^2/(0.0132s^4 + 0.0024s^3 + 0.412s^2 + 0.0589s)",
        "0.06/(0.0132s^2 - 0.412)",
        "s/(s^3 + s^2 + s + 1)",
        "7s/(s^3 + 2s^2 + 3s + 4)",
        "nonsense",
        "''",
    ];
    const POOLS: &[(&str, &[&str])] = &[
        (
            "poles",
            &[
                "[-0.143, -0.0195 ± 5.59j]",
                "[5.568, -5.607, -0.1428]",
                "[0.1429, 0.01947 ± 5.586j]",
                "[0, -0.143, -0.0195 ± 5.59j]",
                "[-0.143]",
                "[0.143, 0.0195 + 5.59j]",
                "many",
                "''",
            ],
        ),
        ("initial_value", &["0", "1", "''"]),
        ("final_value", &["0", "unbounded", "-∞", "+∞", "3", "''"]),
        ("shape", &["decaying oscillation", "exponential growth", "growing oscillation", "constant", "''"]),
        ("stability", &["stable", "unstable", "marginally stable", "perhaps", "''"]),
        (
            "description",
            &[
                "It decays and is stable.",
                "It grows without bound and is unstable.",
                "It swings for ever.",
                "It depends.",
                "''",
            ],
        ),
    ];
    let mut answers = String::new();
    for point in ["hanging", "upright"] {
        writeln!(answers, "  {point}.transfer_function: {}", dice.one_of(FUNCTIONS)).unwrap();
        for (field, pool) in POOLS {
            writeln!(answers, "  {point}.response.{field}: {}", dice.one_of(pool)).unwrap();
        }
    }
    answers
}

#[test]
fn the_ledger_of_any_submission_adds_up_and_no_mark_is_lowered() {
    let strict = Bench::new(&[(
        "follow_through: {credit: 1, same_mistake: 1}",
        "follow_through: {credit: 0, same_mistake: 0}",
    )]);
    let half = Bench::new(&[(
        "follow_through: {credit: 1, same_mistake: 1}",
        "follow_through: {credit: 0.5, same_mistake: 0.5}",
    )]);
    let mut dice = Dice(1);
    for _ in 0..60 {
        let answers = anything(&mut dice);
        let cards = [&strict, &half, &*LAB].map(|bench| bench.card(&answers, None));
        let marks = cards.each_ref().map(|card| {
            ledger_adds_up(card);
            let marks: BTreeMap<&str, Points> =
                items(card).map(|item| (item.id.as_str(), item.earned)).collect();
            marks
        });
        for (id, least) in &marks[0] {
            assert!(*least <= marks[1][id] && marks[1][id] <= marks[2][id], "{answers}{id}");
        }
        for spared in &cards[2].ledger.spared {
            let charged = cards[2].ledger.lost.iter().any(|loss| loss.item == spared.root);
            assert!(charged, "{answers}{spared:?} was charged nowhere");
        }
    }
}

/// Whatever else stands there, no word earns more than the right one.
#[test]
fn the_right_word_is_never_worse_than_a_wrong_one() {
    let mut dice = Dice(2);
    for _ in 0..20 {
        let answers = anything(&mut dice);
        let others: String = answers
            .lines()
            .filter(|line| !line.trim_start().starts_with("hanging.response.stability"))
            .map(|line| format!("{line}\n"))
            .collect();
        let earned = |word: &str| {
            let card = LAB.card(&format!("{others}  hanging.response.stability: {word}\n"), None);
            (item(&card, WORD).earned, card.total.earned)
        };
        let right = earned("stable");
        assert_eq!(right.0, Points(100), "{others}");
        for wrong in ["unstable", "marginally stable"] {
            assert!(earned(wrong).1 <= right.1, "{others}{wrong}");
        }
    }
}

/// Twice the slope of each root at 16 cm is that at 4 cm: the missing 1/2 is told beside the other point, and nobody is refused.
#[test]
fn what_may_be_a_slip_is_no_other_point_for_certain() {
    let lab = lab::load("coupled-tanks").unwrap();
    let reference = Reference::compute(&lab).unwrap();
    let catalogue = Catalogue::new(&lab, &reference);
    let text = "lab: coupled-tanks\nanswers:\n  work.transfer_function: 6.66667/(19200s^2 + 2466.67s + 25)\n  work.poles: {poles: \
                [-0.011093, -0.11738]}\n";
    let submission = read("x", "x.yaml", text.as_bytes(), &lab.sheet, &NoFiles);
    let card = grade(&lab, &reference, &catalogue, &submission, None);
    let diagnosis = items(&card).find_map(|item| item.diagnosis.as_ref()).unwrap();
    let codes: Vec<&str> = diagnosis.explanations.iter().map(|one| one.code.as_str()).collect();
    assert_eq!(codes, ["point.other", "factor.slope"], "{diagnosis:#?}");
    let poles = items(&card).find(|item| item.id == "work.poles.poles" || item.id == "work.poles").unwrap();
    assert_eq!((poles.code, poles.provisional), ("poles.follows", true), "{:?}", poles.evidence);
}
