//! Laws of marking, tried on answers nobody wrote down: parts of the sample class put together anew, and transfer functions
//! made up.
//!
//! **A better answer never scores less** means, since a later answer may be right for an earlier one that was wrong:
//!
//! - an answer replaced by the right one earns all points of its own criteria, whatever stands beside it;
//! - no other criterion loses points by that, except what it was *spared*, that is, what it earned only because it followed from
//!   a wrong answer (the ledger says so), and it loses no more than that;
//! - all answers about one system replaced together never lower the total;
//! - one wrong coefficient put right never lowers the points of its transfer function.

use crate::bench::{Bench, items};
use polemark::algebra::{Polynomial, Rational, to_f64};
use polemark::grading::{ItemScore, Scorecard, Verdict};
use polemark::lab::{LabDefinition, Points};
use polemark::lti::TransferFunction;
use polemark::model::Mistake;
use polemark::source::Span;
use polemark::submission::{Answer, Submission};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

static BENCH: LazyLock<&Bench> = LazyLock::new(Bench::embedded);

/// The answers of the sample class, those of malformed files left out.
static CLASS: LazyLock<Vec<Submission>> =
    LazyLock::new(|| BENCH.class().into_iter().filter(|submission| submission.readable).collect());

/// Answer files made of answers of the class: most fields from one student, the others from anyone.
fn mixed() -> impl Strategy<Value = Submission> {
    let fields = BENCH.lab.sheet.fields.len();
    let student = 0..CLASS.len();
    let others = prop::collection::vec(prop::option::weighted(0.3, student.clone()), fields);
    (student, others).prop_map(|(most, others)| {
        let mut mixed = Submission { id: "mixed".to_owned(), ..CLASS[most].clone() };
        mixed.answers.clear();
        for (field, other) in BENCH.lab.sheet.fields.iter().zip(others) {
            let from = other.unwrap_or(most);
            if let Some(answer) = CLASS[from].answers.get(&field.path) {
                put(&mut mixed, answer);
            }
        }
        mixed
    })
}

fn put(submission: &mut Submission, answer: &Answer) {
    let answer = Answer { span: Span { start: 0, end: 0 }, ..answer.clone() };
    submission.answers.insert(answer.path.clone(), answer);
}

/// The right answers to the fields for which `wanted` holds, in place of what stands there.
fn corrected(submission: &Submission, wanted: impl Fn(&str) -> bool) -> Submission {
    let mut better = submission.clone();
    BENCH
        .lab
        .model_answer
        .answers
        .values()
        .filter(|answer| wanted(&answer.path))
        .for_each(|answer| put(&mut better, answer));
    better
}

fn by_id(scorecard: &Scorecard) -> BTreeMap<String, ItemScore> {
    items(scorecard.clone()).into_iter().map(|item| (item.id.clone(), item)).collect()
}

fn spared(scorecard: &Scorecard, id: &str) -> Points {
    scorecard.ledger.spared.iter().filter(|spared| spared.item == id).map(|spared| spared.points).sum()
}

/// Fields that one criterion judges together have one name.
fn answered_together(path: &str) -> &str {
    // Data decides before a figure.
    path.strip_suffix(".data").or(path.strip_suffix(".figure")).unwrap_or(path)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_ledger_adds_up(submission in mixed()) {
        let card = BENCH.grade(&submission);
        let lost: Points = card.ledger.lost.iter().map(|loss| loss.points).sum();
        prop_assert_eq!(lost.0, card.total.possible.0 - card.total.earned.0);
        let items = by_id(&card);
        let losing: BTreeSet<&str> = card.ledger.lost.iter().map(|loss| loss.item.as_str()).collect();
        prop_assert_eq!(losing.len(), card.ledger.lost.len(), "a criterion is charged twice");
        for loss in &card.ledger.lost {
            let item = &items[&loss.item];
            prop_assert_eq!(loss.points.0, item.possible.0 - item.earned.0, "{}", &loss.item);
        }
        for spared in &card.ledger.spared {
            let item = &items[&spared.item];
            prop_assert!(spared.points > Points::ZERO && spared.points <= item.earned, "{spared:?}");
            prop_assert!(item.follow_through.as_ref().is_some_and(|follow| follow.credited), "{spared:?}");
            prop_assert!(losing.contains(spared.root.as_str()), "{spared:?} was charged nowhere");
        }
    }

    #[test]
    fn points_go_with_verdicts(submission in mixed()) {
        for item in items(BENCH.grade(&submission)) {
            let earned = match item.verdict {
                Verdict::Right => item.earned == item.possible,
                Verdict::Partly => Points::ZERO < item.earned && item.earned < item.possible,
                _ => item.earned == Points::ZERO,
            };
            prop_assert!(earned, "{}: {:?} earns {}", item.id, item.verdict, item.earned);
            prop_assert!(item.verdict == Verdict::Right || !item.evidence.reason.is_empty(), "{}", item.id);
        }
    }

    /// A right answer in one field, all else equal.
    #[test]
    fn a_right_answer_earns_its_points_and_takes_only_what_was_spared(
        submission in mixed(),
        field in prop::sample::select(BENCH.lab.sheet.fields.iter().map(|field| field.path.clone()).collect::<Vec<_>>()),
    ) {
        let replaced = answered_together(&field);
        let own = |path: &str| answered_together(path) == replaced;
        let (before, after) = (BENCH.grade(&submission), BENCH.grade(&corrected(&submission, own)));
        let (earlier, later) = (by_id(&before), by_id(&after));
        for criterion in BENCH.all_criteria() {
            let (was, is) = (earlier[&criterion.id].earned, later[&criterion.id].earned);
            if own(&criterion.field) {
                prop_assert_eq!(is, criterion.points, "{} is right: {}", &criterion.id, &later[&criterion.id].evidence.reason);
            } else {
                let least = was.0 - spared(&before, &criterion.id).0;
                prop_assert!(is.0 >= least, "{} right: {} falls from {was} to {is}", &field, &criterion.id);
            }
        }
    }

    /// All answers about one operating point or one simulation.
    #[test]
    fn right_answers_about_one_system_never_lower_the_total(
        submission in mixed(),
        about in prop::sample::select(systems()),
    ) {
        let own = |path: &str| BENCH.lab.sheet.fields.iter().any(|field| field.path == path && field.about.as_deref() == Some(&about));
        let (before, after) = (BENCH.grade(&submission), BENCH.grade(&corrected(&submission, own)));
        prop_assert!(after.total.earned >= before.total.earned, "{about}: {} to {}", before.total.earned, after.total.earned);
    }

    #[test]
    fn follow_through_never_lowers_a_mark_and_more_credit_never_does(submission in mixed()) {
        let half = Rational::ONE / Rational::from(2);
        let credits = [Rational::ZERO, half, Rational::ONE];
        let marks = credits.map(|credit| {
            let lab = with_credit(&BENCH.lab, &credit);
            polemark::grading::grade(&lab, &BENCH.reference, &BENCH.catalogue, &submission, None)
        });
        for pair in marks.windows(2) {
            for (less, more) in items(pair[0].clone()).iter().zip(items(pair[1].clone())) {
                prop_assert!(more.earned >= less.earned, "{}: {} to {}", less.id, less.earned, more.earned);
            }
        }
        prop_assert_eq!(&marks[0].ledger.spared, &[]);
        for (without, with) in items(marks[0].clone()).iter().zip(items(marks[2].clone())) {
            prop_assert_eq!(with.earned.0 - without.earned.0, spared(&marks[2], &with.id).0, "{}", &with.id);
        }
    }

    #[test]
    fn the_same_answers_are_marked_the_same(submission in mixed()) {
        prop_assert_eq!(BENCH.grade(&submission), BENCH.grade(&submission.clone()));
    }
}

fn systems() -> Vec<String> {
    let all: BTreeSet<String> =
        BENCH.lab.sheet.fields.iter().filter_map(|field| field.about.clone()).collect();
    all.into_iter().collect()
}

fn with_credit(lab: &LabDefinition, credit: &Rational) -> LabDefinition {
    let mut lab = lab.clone();
    lab.follow_through.credit = credit.clone();
    lab.follow_through.same_mistake = credit.clone();
    for criterion in lab.questions.iter_mut().flat_map(|question| &mut question.criteria) {
        criterion.follow_through = credit.clone();
    }
    lab
}

#[test]
fn right_answers_are_worth_everything_and_none_nothing() {
    for bench in [Bench::embedded(), Bench::small(), Bench::oscillator()] {
        let right = bench.grade(&bench.lab.model_answer);
        assert_eq!(right.total.earned, right.total.possible, "{}", bench.lab.id);
        assert_eq!((&right.ledger.lost[..], &right.ledger.spared[..]), (&[][..], &[][..]));
        let blank = bench.grade(&bench.read(""));
        assert_eq!(blank.total.earned, Points::ZERO, "{}", bench.lab.id);
        assert!(items(blank).iter().all(|item| item.verdict == Verdict::Blank));
    }
}

/// The right answer alone, with nothing else in the file, earns the points of its criteria.
#[test]
fn every_criterion_is_reached_by_its_own_answer() {
    for bench in [Bench::embedded(), Bench::small(), Bench::oscillator()] {
        let nothing = bench.read("");
        for criterion in bench.all_criteria() {
            let mut alone = nothing.clone();
            let own = |path: &str| answered_together(path) == answered_together(&criterion.field);
            bench
                .lab
                .model_answer
                .answers
                .values()
                .filter(|answer| own(&answer.path))
                .for_each(|answer| put(&mut alone, answer));
            let marks = by_id(&bench.grade(&alone));
            assert_eq!(marks[&criterion.id].earned, criterion.points, "{}", criterion.id);
        }
    }
}

/// Each wrong turn of the derivation taken at both operating points, and then put right at the first.
#[test]
fn a_mistake_made_twice_and_put_right_once_never_lowers_the_total() {
    let model = &BENCH.lab.models[0];
    let wrong = |at: usize| -> BTreeMap<String, String> {
        let derivation = model.derivation(&model.operating_points[at], &BENCH.lab.parameters);
        let led = |mistake: Mistake| Some((derivation.function(&[&mistake])?, mistake.change));
        let all = derivation.mistakes().into_iter().filter_map(led);
        all.map(|(function, change)| (change, rounded(&function))).collect()
    };
    let (hanging, upright) = (wrong(0), wrong(1));
    let mut spared_somewhere = 0;
    for (change, first) in &hanging {
        let Some(second) = upright.get(change) else { continue };
        let both = BENCH
            .read(&format!("  hanging.transfer_function: {first}\n  upright.transfer_function: {second}\n"));
        let (before, after) =
            (BENCH.grade(&both), BENCH.grade(&corrected(&both, |path| path.starts_with("hanging."))));
        spared_somewhere += usize::from(!before.ledger.spared.is_empty());
        let fields = |card: &Scorecard| -> i64 {
            items(card.clone())
                .iter()
                .filter(|item| item.id.contains("transfer_function"))
                .map(|item| item.earned.0)
                .sum()
        };
        assert!(fields(&after) >= fields(&before), "{change}: {} to {}", fields(&before), fields(&after));
    }
    assert!(spared_somewhere > 20, "{spared_somewhere} of {}", hanging.len());
}

/// With common factors cancelled, each coefficient to five figures.
fn rounded(function: &TransferFunction) -> String {
    let function = function.cancelled().0;
    let list = |polynomial: &Polynomial| -> String {
        let coefficients = polynomial.coefficients().iter().map(|c| format!("{:.4e}", to_f64(c)));
        coefficients.collect::<Vec<_>>().join(", ")
    };
    format!("{{num: [{}], den: [{}]}}", list(&function.num), list(&function.den))
}

/// A decimal of five places.
fn decimal(hundred_thousandths: i64) -> String {
    let sign = if hundred_thousandths < 0 { "-" } else { "" };
    let size = hundred_thousandths.unsigned_abs();
    format!("{sign}{}.{:05}", size / 100_000, size % 100_000)
}

/// −0.06 s over 0.0132 s³ + 0.0024 s² + 0.41202 s + 0.05886, in hundred-thousandths: numerator first.
const RIGHT: [i64; 5] = [-6000, 1320, 240, 41202, 5886];

/// How often each coefficient is taken, in percent: far enough apart that no two agree on a wrong common factor.
const WRONG: [i64; 8] = [-100, 300, -50, 170, 20, -230, 700, -400];

fn function([n, a, b, c, d]: [i64; 5]) -> String {
    let [n, a, b, c, d] = [n, a, b, c, d].map(decimal);
    format!("{{num: [{n}, 0], den: [{a}, {b}, {c}, {d}]}}")
}

/// The same function as students may write it.
fn spellings(typed: [i64; 5], factor: i64) -> Vec<String> {
    let quoted = |text: String| format!("\"{text}\"");
    let [n, a, b, c, d] = typed.map(decimal);
    let signed = |text: &str| match text.strip_prefix('-') {
        Some(size) => format!("- {size}"),
        None => format!("+ {text}"),
    };
    let (sb, sc, sd) = (signed(&b), signed(&c), signed(&d));
    vec![
        function(typed),
        function(typed.map(|c| c * factor)),
        function(typed.map(|c| -c)),
        quoted(format!("{n}s/({a}s^3 {sb}s^2 {sc}s {sd})")),
        quoted(format!("{n}*s / ({d} {sc}*s {sb}*s**2 {}*s**3)", signed(&a))),
        quoted(format!("G(s) = {n}·s/((({a}s {sb})s {sc})s {sd})")),
        quoted(format!("({n}s)/(s²({a}s {sb}) + ({c}s {sd}))")),
        quoted(format!("-({n}s)/(-({a}s³ {sb}s²) - ({c}s {sd}))")),
        quoted(format!("(0.5*{n}s + 0.5*{n}s)/({a}s^3 {sb}s^2 {sc}s {sd})").replace("0.5*-", "-0.5*")),
        quoted(format!("{n}/({a}s^2 {sb}s {sc} + ({d})/s)")),
    ]
}

/// What the marks of a submission are, without the words.
fn outcome(items: &[ItemScore]) -> Vec<(String, Points, Verdict, &'static str, bool)> {
    items
        .iter()
        .map(|item| (item.id.clone(), item.earned, item.verdict, item.code, item.provisional))
        .collect()
}

/// Poles, values and words that are right for gravity's sign turned, or for the right function.
const LATER: &[&str] = &[
    "poles: [5.568, -5.607, -0.1428], final_value: unbounded, shape: exponential growth, stability: unstable",
    "poles: [-0.1429, -0.0195 ± 5.586j], final_value: 0, shape: decaying oscillation, stability: stable",
];

/// Right but for the coefficients in which `wrong` names another factor.
fn corrupted(wrong: [Option<usize>; 5]) -> [i64; 5] {
    std::array::from_fn(|i| wrong[i].map_or(RIGHT[i], |w| RIGHT[i] * WRONG[w] / 100))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_transfer_function_is_worth_the_same_in_every_spelling(
        wrong in prop::array::uniform5(prop::option::weighted(0.3, 0..WRONG.len())),
        factor in prop_oneof![Just(1000), Just(7), Just(-3), Just(123)],
        later in prop::sample::select(LATER),
    ) {
        let of = |spelling: &str| {
            outcome(&BENCH.mark(&format!("  hanging.transfer_function: {spelling}\n  hanging.response: {{{later}}}\n")))
        };
        let spellings = spellings(corrupted(wrong), factor);
        let first = of(&spellings[0]);
        for spelling in &spellings[1..] {
            prop_assert_eq!(&of(spelling), &first, "{} and {}", spelling, &spellings[0]);
        }
    }

    /// Two of five coefficients may be off, so that the others set the common factor.
    #[test]
    fn a_coefficient_put_right_never_costs_points(
        one in 0..5usize, other in 0..5usize, w in prop::array::uniform2(0..WRONG.len()), scale in 1..2000i64,
    ) {
        let points = |wrong: [Option<usize>; 5]| -> i64 {
            let typed = function(corrupted(wrong).map(|c| c * scale));
            let marks = BENCH.mark(&format!("  hanging.transfer_function: {typed}\n"));
            marks.iter().filter(|item| item.id.starts_with("hanging.transfer_function")).map(|item| item.earned.0).sum()
        };
        let both: [Option<usize>; 5] = std::array::from_fn(|i| if i == one { Some(w[0]) } else { (i == other).then_some(w[1]) });
        let better = std::array::from_fn(|i| both[i].filter(|_| i != one));
        prop_assert!(points(better) >= points(both), "{both:?}: {} to {}", points(both), points(better));
    }

    #[test]
    fn poles_are_worth_the_same_in_every_order_and_spelling(
        real in prop::sample::select(vec!["-0.1429", "0.1429", "-0.2", "-0.14", "-1"]),
        part in prop::sample::select(vec!["-0.0195", "0.0195", "-0.019", "-0.1", "0"]),
        swing in prop::sample::select(vec!["5.586", "5.6", "5", "0.2"]),
        word in prop::sample::select(vec!["stable", "unstable", "marginally stable"]),
    ) {
        let plus = format!("{part} + {swing}j");
        let minus = format!("{part} - {swing}j");
        let lists = [
            format!("[{real}, {plus}, {minus}]"),
            format!("[{minus}, {real}, {plus}]"),
            format!("[{part} ± {swing}j, {real}]"),
            format!("[{real}, {part} +- {swing}i]"),
            format!("\"{plus}; {minus}; {real}\""),
            format!("\"s = {real}, s = {part}+j{swing}, s = {part}-j{swing}\""),
            format!("[{real}, {{re: {part}, im: {swing}}}, {{re: {part}, im: -{swing}}}]"),
            format!("\"[{real}; {part}+{swing}*i; {part}-{swing}*i]\""),
        ];
        let of = |list: &str| {
            outcome(&BENCH.mark(&format!("  hanging.response: {{poles: {list}, stability: {word}}}\n")))
        };
        let first = of(&lists[0]);
        for list in &lists[1..] {
            prop_assert_eq!(&of(list), &first, "{} and {}", list, &lists[0]);
        }
    }
}

#[test]
fn letters_are_worth_what_their_numbers_are() {
    for (letters, numbers) in [
        (
            "-m*l*s/(((M+m)*(I+m*l^2) - (m*l)^2)*s^3 + b*(I+m*l^2)*s^2 + (M+m)*m*g*l*s + b*m*g*l)",
            "-0.06s/(0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)",
        ),
        (
            "m*l*s/(((M+m)*(I+m*l^2) + (m*l)^2)*s^3 + b*(I+m*l^2)*s^2 - (M+m)*m*g*l*s - b*m*g*l)",
            "0.06s/(0.0204s^3 + 0.0024s^2 - 0.41202s - 0.05886)",
        ),
    ] {
        let of = |text: &str| outcome(&BENCH.mark(&format!("  hanging.transfer_function: \"{text}\"\n")));
        assert_eq!(of(letters), of(numbers), "{letters}");
    }
}

#[test]
fn a_word_is_worth_the_same_in_every_spelling() {
    for (field, words) in [
        (
            "hanging.response.stability",
            &["stable", "Stable.", "asymptotically stable", "BIBO stable", "yes"][..],
        ),
        (
            "hanging.response.stability",
            &["unstable", "UNSTABLE", "not stable", "non-stable", "the system is unstable"],
        ),
        ("hanging.response.stability", &["marginally stable", "Marginally-stable", "neutrally stable"]),
        (
            "hanging.response.shape",
            &["decaying oscillation", "damped sinusoid", "underdamped", "Decaying Oscillations"],
        ),
        ("hanging.response.shape", &["exponential growth", "grows without bound", "rises exponentially"]),
        ("upright.response.final_value", &["unbounded", "∞", "inf", "does not exist", "diverges"]),
        ("hanging.response.final_value", &["0", "0.0", "0,0", "zero", "0 rad", "0e3"]),
        (
            "battery.nonlinearity",
            &["dead zone", "Dead-zone.", "deadband", "the motor shows a dead zone", "[dead zone]"],
        ),
        ("battery.nonlinearity", &["saturation", "clipping", "limiter"]),
    ] {
        let yaml = |word: &str| if word.starts_with('[') { word.to_owned() } else { format!("\"{word}\"") };
        let of = |word: &str| outcome(&BENCH.mark(&format!("  {field}: {}\n", yaml(word))));
        for word in words {
            assert_eq!(of(word), of(words[0]), "{field}: {word} and {}", words[0]);
        }
    }
}
