use super::typed_pole::Side;
use super::*;
use crate::algebra::{parse_decimal, polynomial_text};
use crate::grading::Verdict;
use crate::grading::closeness::tests::{tolerance, typed, usual};
use crate::lti::roots;
use crate::source::Span;
use crate::submission::Decimal;
use proptest::prelude::*;

fn pole(re: f64, im: f64, multiplicity: usize) -> Pole {
    Pole { re, im, multiplicity, error_bound: 1e-14 }
}

fn pair(re: f64, im: f64) -> [Pole; 2] {
    [pole(re, im, 1), pole(re, -im, 1)]
}

/// `-0.0195,5.59 -0.143,0`: real and imaginary parts.
fn answer(text: &str) -> Vec<TypedComplex> {
    let one = |one: &str| {
        let (re, im) = one.split_once(',').unwrap();
        TypedComplex { re: typed(re), im: typed(im), span: Span::default() }
    };
    text.split_whitespace().map(one).collect()
}

fn mark(want: &[Pole], cancelled: &[Pole], text: &str) -> Mark {
    marked(want, cancelled, &tolerance("0.001", "0.01", Some(2)), &answer(text))
}

fn marked(want: &[Pole], cancelled: &[Pole], parts: &Tolerance, typed: &[TypedComplex]) -> Mark {
    let denominator = Polynomial::one();
    let poles = Accepted { differs: &[], what: want };
    let accepted = [ExpectedPoles { poles, denominator: &denominator }];
    let nearness = Nearness { parts, coefficients: &Rational::ZERO };
    judge(Points(50), &accepted, cancelled, &nearness, typed)
}

#[track_caller]
fn check(want: &[Pole], rows: &[(&str, &str, i64, &str)]) {
    for (what, text, points, code) in rows {
        let mark = mark(want, &[], text);
        assert_eq!((mark.earned, mark.code), (Points(*points), *code), "{what}: {}", mark.evidence.reason);
    }
}

#[test]
fn the_pendulum_hanging() {
    let mut want = pair(-0.019468, 5.58638).to_vec();
    want.push(pole(-0.14288, 0.0, 1));
    check(
        &want,
        &[
            // what it is, answer, points, code
            ("exact", "-0.019468,5.58638 -0.019468,-5.58638 -0.14288,0", 50, "right"),
            ("in another order", "-0.14288,0 -0.019468,-5.58638 -0.019468,5.58638", 50, "right"),
            ("three figures", "-0.0195,5.59 -0.0195,-5.59 -0.143,0", 50, "right"),
            ("two figures", "-0.019,5.6 -0.019,-5.6 -0.14,0", 50, "right"),
            ("real part off, but within 0.001", "-0.0204,5.59 -0.0204,-5.59 -0.143,0", 50, "right"),
            ("real part beyond", "-0.0206,5.59 -0.0206,-5.59 -0.143,0", 0, "poles.value"),
            ("no damping seen", "0,5.59 0,-5.59 -0.143,0", 0, "poles.value"),
            ("damping of the wrong sign", "0.0005,5.59 0.0005,-5.59 -0.143,0", 0, "poles.value"),
            ("imaginary part 1 % off", "-0.0195,5.642 -0.0195,-5.642 -0.143,0", 50, "right"),
            ("imaginary part beyond", "-0.0195,5.643 -0.0195,-5.643 -0.143,0", 0, "poles.value"),
            ("conjugate missing", "-0.0195,5.59 -0.143,0", 25, "poles.missing_conjugate"),
            ("the other conjugate missing", "-0.0195,-5.59 -0.143,0", 25, "poles.missing_conjugate"),
            ("conjugate missing and another wrong", "-0.0195,5.59 -0.2,0", 0, "poles.value"),
            ("the real one missing", "-0.0195,5.59 -0.0195,-5.59", 0, "poles.missing"),
            ("the pair missing", "-0.143,0", 0, "poles.missing"),
            ("none", "", 0, "poles.missing"),
            ("the cancelled one too", "-0.0195,5.59 -0.0195,-5.59 -0.143,0 0,0", 0, "poles.extra"),
            ("mirrored", "0.0195,5.59 0.0195,-5.59 0.143,0", 0, "poles.mirrored"),
            ("one mirrored", "-0.0195,5.59 -0.0195,-5.59 0.143,0", 0, "poles.mirrored"),
            ("one twice", "-0.0195,5.59 -0.0195,-5.59 -0.143,0 -0.143,0", 0, "poles.multiplicity"),
            ("the same conjugate twice", "-0.0195,5.59 -0.0195,5.59 -0.143,0", 0, "poles.value"),
            ("swapped parts", "5.59,-0.0195 5.59,0.0195 0,-0.143", 0, "poles.value"),
        ],
    );
}

#[test]
fn multiplicity_counts() {
    check(
        &[pole(-1.0, 0.0, 2), pole(-3.0, 0.0, 1)],
        &[
            ("exact", "-1,0 -1,0 -3,0", 50, "right"),
            ("double pole given once", "-1,0 -3,0", 0, "poles.multiplicity"),
            ("the other one doubled", "-1,0 -3,0 -3,0", 0, "poles.multiplicity"),
        ],
    );
    check(
        &[pole(-1.0, 2.0, 2), pole(-1.0, -2.0, 2)],
        &[
            ("double pair without conjugates", "-1,2 -1,2", 25, "poles.missing_conjugate"),
            ("a pair given once", "-1,2 -1,-2", 0, "poles.multiplicity"),
        ],
    );
    check(&[], &[("none there, none given", "", 50, "right"), ("none there", "-1,0", 0, "poles.extra")]);
}

#[test]
fn a_pole_on_the_axis_has_no_side() {
    check(
        &pair(0.0, 2.0),
        &[
            ("exact", "0,2 0,-2", 50, "right"),
            ("to the left", "-0.001,2 -0.001,-2", 50, "right"),
            ("to the right", "0.001,2 0.001,-2", 50, "right"),
            ("too far", "0.0011,2 0.0011,-2", 0, "poles.value"),
        ],
    );
}

#[test]
fn close_poles_are_assigned_as_well_as_can_be() {
    // 1.005 fits both, 0.995 only the first: taking the nearest in turn would leave one over.
    check(
        &[pole(1.0, 0.0, 1), pole(1.014, 0.0, 1)],
        &[
            ("the ambiguous one first", "1.005,0 0.995,0", 50, "right"),
            ("the ambiguous one last", "0.995,0 1.005,0", 50, "right"),
        ],
    );
}

#[test]
fn an_eigenvalue_that_cancels_is_named() {
    let reason = mark(&[pole(-1.0, 0.0, 1)], &[pole(0.0, 0.0, 1)], "-1,0 0,0").evidence.reason;
    assert!(reason.contains("whole state"), "{reason}");
}

#[test]
fn hostile_sizes() {
    let many = "1,0 ".repeat(5_000);
    assert_eq!(mark(&[pole(1.0, 0.0, 1)], &[], &many).code, "poles.extra");
    assert_eq!(mark(&[pole(1.0, 0.0, 61)], &[], "1,0").verdict, Verdict::Unmarked);
    let sixty = "1,0 ".repeat(60);
    assert_eq!(mark(&[pole(1.0, 0.0, 60)], &[], &sixty).code, "right");
}

#[test]
fn hostile_numbers() {
    let sixty = |text: &str| answer(&format!("{text} ").repeat(60));
    let one = (0..60).fold(Polynomial::one(), |p, _| &p * &polynomial("1 1"));
    for typed in [
        sixty("-1.1,0"),
        sixty("-0.99,0"),
        answer(&("-1.0,0 ".repeat(59) + "-1.3,0")),
        answer(&("-1.0,0 ".repeat(59) + "-0.95,0")),
        answer(&("-0.95,0.20 -0.95,-0.20 ".repeat(29) + "-0.90,0 -1.0,0")),
        answer(&(("-1.".to_owned() + &"0".repeat(398) + "1,0 ").repeat(58) + "-1.01,0 -0.98,0")),
        sixty("-1e300,0"),
        sixty("-1e-300,0"),
        answer(&"-1e300,1e300 -1e-300,0 -1e-300,1e-300 ".repeat(20)),
    ] {
        judged(&one, &typed);
    }
    let wide = polynomial("1 1e300 1e-300 1");
    for text in ["-1e300,0 -1,0 -1,0", "-1e400,0 -1e-400,0 -1,0", "-1,0 -1,0 -1,0"] {
        assert_ne!(judged(&wide, &answer(text)).code, "right", "{text}");
    }
}

/// With the denominator that the poles are roots of, as the lab grades: parts within 1 % or 0.001 or rounded to 2 figures,
/// coefficients within 0.5 %.
fn judged(denominator: &Polynomial, typed: &[TypedComplex]) -> Mark {
    let poles = roots(denominator).unwrap();
    let accepted = [ExpectedPoles { poles: Accepted { differs: &[], what: &poles }, denominator }];
    let parts = tolerance("0.001", "0.01", Some(2));
    let coefficients = parse_decimal("0.005").unwrap();
    judge(Points(50), &accepted, &[], &Nearness { parts: &parts, coefficients: &coefficients }, typed)
}

/// Coefficients, highest power first.
fn polynomial(text: &str) -> Polynomial {
    Polynomial::new(text.split_whitespace().map(|number| parse_decimal(number).unwrap()).collect())
}

#[track_caller]
fn check_denominator(coefficients: &str, rows: &[(&str, &str, bool)]) {
    let denominator = polynomial(coefficients);
    for (what, text, right) in rows {
        let mark = judged(&denominator, &answer(text));
        assert_eq!(mark.code == "right", *right, "{what}: {}: {}", mark.code, mark.evidence.reason);
    }
}

// The roots in the tables below are those of the coefficients named, by mpmath 1.3 with 80 digits, then rounded.

#[test]
fn a_triple_pole_both_sides() {
    check_denominator(
        "1 3 3 1",
        &[
            // what it is, answer, right
            ("exact", "-1,0 -1,0 -1,0", true),
            ("1 3 3 1.005, two figures", "-1.2,0 -0.91,-0.15 -0.91,0.15", true),
            ("1 3 3 1.005, three figures", "-1.17,0 -0.915,-0.148 -0.915,0.148", true),
            ("1 3 3 1.005, four figures", "-1.171,0 -0.9145,-0.1481 -0.9145,0.1481", true),
            ("1 3 3 0.995, two figures", "-0.83,0 -1.1,0.15 -1.1,-0.15", true),
            ("1 3 3 0.995, three figures", "-0.829,0 -1.09,0.148 -1.09,-0.148", true),
            ("1 3 3 1.0100: the scale gives way", "-1.21544,0 -0.892278,0.186580 -0.892278,-0.186580", true),
            ("1 3 3 1.0102: beyond 1.005/0.995", "-1.21687,0 -0.891565,0.187815 -0.891565,-0.187815", false),
            ("1.005 2.985 3.015 0.995: each at its end", "-0.70795,0 -1.1311,0.34510 -1.1311,-0.34510", true),
            ("1.0052 2.985 3.015 0.995", "-0.70771,0 -1.1309,0.34595 -1.1309,-0.34595", false),
            ("1 3 3 1.02", "-1.271,0 -0.8643,-0.2351 -0.8643,0.2351", false),
            ("one beyond any of them", "-1.17,0 -0.915,-0.3 -0.915,0.3", false),
            ("mirrored", "1.17,0 0.915,-0.148 0.915,0.148", false),
            ("one sign off", "1.17,0 -0.915,-0.148 -0.915,0.148", false),
            ("a pair mirrored", "-1.17,0 0.915,-0.148 0.915,0.148", false),
            ("a conjugate missing", "-1.17,0 -0.915,-0.148", false),
            ("given twice", "-1,0 -1,0", false),
            ("given once more", "-1,0 -1,0 -1,0 -1,0", false),
        ],
    );
    // (s + 1.33)³, its coefficients rounded to three figures: 1 3.99 5.31 2.35
    check_denominator("1 3.99 5.3067 2.352637", &[("rounded", "-1.14,0 -1.42,0.171 -1.42,-0.171", true)]);
}

#[test]
fn multiple_poles_both_sides() {
    check_denominator(
        "1 2 1",
        &[
            ("1 2 1.005", "-1.00,0.0707 -1.00,-0.0707", true),
            ("1 2 0.995", "-1.07,0 -0.929,0", true),
            ("1 2 1.0100", "-1.0000,-0.10000 -1.0000,0.10000", true),
            ("1 2 1.0102", "-1.0000,-0.10100 -1.0000,0.10100", false),
            ("1 2 1.02", "-1.00,-0.141 -1.00,0.141", false),
        ],
    );
    check_denominator(
        "1 4 6 4 1",
        &[
            ("1 4 6 4 1.005", "-1.19,-0.188 -0.812,-0.188 -0.812,0.188 -1.19,0.188", true),
            ("two figures of it", "-1.2,-0.19 -0.81,-0.19 -0.81,0.19 -1.2,0.19", true),
            ("1 4 6 4 0.995", "-1.27,0 -0.734,0 -1.00,0.266 -1.00,-0.266", true),
            ("1 4 6 4 1.02", "-1.27,0.266 -0.734,0.266 -0.734,-0.266 -1.27,-0.266", false),
        ],
    );
    // (s² + 2s + 5)²
    check_denominator(
        "1 4 14 20 25",
        &[
            ("1 4 14 20 25.1", "-1.08,-2.00 -0.921,-2.00 -1.08,2.00 -0.921,2.00", true),
            ("1 4 14.05 20.05 25", "-0.9729,1.888 -0.9729,-1.888 -1.027,-2.118 -1.027,2.118", true),
            ("1 4 14 20 25.5", "-1.18,-2.01 -0.824,2.01 -1.18,2.01 -0.824,-2.01", false),
        ],
    );
}

#[test]
fn poles_near_and_on_the_axis() {
    check_denominator(
        "1 0.02 4",
        &[
            ("1 0.0201 4.02", "-0.0100,-2.00 -0.0100,2.00", true),
            ("within 0.001, whatever the denominator", "-0.0110,-2.00 -0.0110,2.00", true),
            ("beyond", "-0.0111,-2.00 -0.0111,2.00", false),
            ("the sign off by very little", "0.0001,-2.00 0.0001,2.00", false),
        ],
    );
    // Twice that: 0.3 % of the constant moves a pair across the axis, and the sign is held to.
    check_denominator(
        "1 0.04 8.0004 0.16 16",
        &[("1 0.04 8.0004 0.16 16.05", "0.0459,-2.00 0.0459,2.00 -0.0659,2.00 -0.0659,-2.00", false)],
    );
    // (s² + 4)²: nothing has a side.
    check_denominator(
        "1 0 8 0 16",
        &[
            ("1 0 8 0 16.05", "-0.0559,2.00 -0.0559,-2.00 0.0559,2.00 0.0559,-2.00", true),
            ("1 0 7.97 0 16.05", "-0.103,-2.00 -0.103,2.00 0.103,-2.00 0.103,2.00", true),
            ("all to the left", "-0.0559,2.00 -0.0559,-2.00 -0.0559,2.00 -0.0559,-2.00", false),
        ],
    );
    check_denominator("1 0 0 1", &[("1 0 0 1.004", "-1.00,0 0.501,-0.867 0.501,0.867", true)]);
}

#[test]
fn poles_at_the_origin_stand_for_themselves() {
    check_denominator(
        "1 3 3 1 0 0",
        &[
            ("1 3 3 1.005", "-1.17,0 -0.915,-0.148 -0.915,0.148 0,0 0,0", true),
            ("a program's noise for 0", "-1.17,0 -0.915,-0.148 -0.915,0.148 1e-9,0 -1e-9,0", true),
            ("0 given once", "-1.17,0 -0.915,-0.148 -0.915,0.148 0,0", false),
            ("0 for another pole", "0,0 -0.915,-0.148 -0.915,0.148 0,0 0,0", false),
            ("0 too far off", "-1.17,0 -0.915,-0.148 -0.915,0.148 0.002,0 0,0", false),
        ],
    );
}

#[test]
fn poles_of_very_different_sizes() {
    // (s + 0.001)(s + 1000)(s + 1)², four of its coefficients changed by 0.5 % and less
    check_denominator(
        "1 1002.001 2002.002 1002.001 1",
        &[
            ("1 +0.4 % -0.3 % 1 +0.5 %", "-1000,0 -0.00101,0 -0.993,-0.0997 -0.993,0.0997", true),
            ("the fast one half as fast", "-500,0 -0.00101,0 -0.993,-0.0997 -0.993,0.0997", false),
            ("the slow one unstable", "-1000,0 0.00101,0 -0.993,-0.0997 -0.993,0.0997", false),
        ],
    );
}

#[test]
fn the_pendulum_rounded() {
    check_denominator(
        "0.0132 0.0024 0.41202 0.05886",
        &[
            ("two figures", "-0.14,0 -0.019,5.6 -0.019,-5.6", true),
            ("three figures", "-0.143,0 -0.0195,5.59 -0.0195,-5.59", true),
            ("four figures", "-0.1429,0 -0.01947,5.586 -0.01947,-5.586", true),
            ("of 0.0132 0.0024 0.412 0.0589", "-0.143,0 -0.0194,5.59 -0.0194,-5.59", true),
            ("of 1 0.182 31.2 4.46", "-0.143,0 -0.0195,5.59 -0.0195,-5.59", true),
            ("of 1 0.18 31 4.5, two figures only", "-0.145,0 -0.0174,-5.57 -0.0174,5.57", false),
            ("mirrored", "0.143,0 0.0195,5.59 0.0195,-5.59", false),
            ("the pair mirrored", "-0.143,0 0.0195,5.59 0.0195,-5.59", false),
            ("upright", "-5.61,0 -0.143,0 5.57,0", false),
        ],
    );
    check_denominator(
        "0.0132 0.0024 -0.41202 -0.05886",
        &[
            ("two figures", "-5.6,0 -0.14,0 5.6,0", true),
            ("three figures", "-5.61,0 -0.143,0 5.57,0", true),
            ("four figures", "-5.607,0 -0.1428,0 5.568,0", true),
            ("mirrored", "5.61,0 0.143,0 -5.57,0", false),
            ("two signs exchanged, but each within 1 %", "5.61,0 -0.143,0 -5.57,0", true),
            ("two signs exchanged, beyond 1 %", "5.63,0 -0.143,0 -5.54,0", false),
            ("the slow one mirrored", "-5.61,0 0.143,0 5.57,0", false),
        ],
    );
}

/// (s + 1)(s + 2)…(s + 10): a small change of one coefficient moves its roots far (Wilkinson 1959).
#[test]
fn ten_poles_that_move_far() {
    check_denominator(
        "1 55 1320 18150 157773 902055 3416930 8409500 12753576 10628640 3628800",
        &[
            (
                "six figures",
                "-9.99,0 -9.05,0 -7.75,0 -7.36,0 -3.89,0 -3.04,0 -2.00,0 -1.00,0 -5.46,-0.128 -5.46,0.128",
                true,
            ),
            (
                "four figures",
                "-4.14,0 -0.987,0 -2.10,0.497 -2.10,-0.497 -3.94,-2.16 -3.94,2.16 -11.6,2.21 -11.6,-2.21 -7.29,3.81 -7.29,-3.81",
                true,
            ),
            (
                "the second 0.49 % more",
                "-17.24,0 -2.778,0 -2.003,0 -1.0000,0 -3.358,1.026 -3.358,-1.026 -4.502,2.942 -4.502,-2.942 -8.263,6.145 -8.263,-6.145",
                true,
            ),
            (
                "the second 1.2 % more",
                "-20.03,0 -2.653,0 -2.009,0 -1.0000,0 -3.152,1.135 -3.152,-1.135 -4.119,3.168 -4.119,-3.168 -7.713,7.259 -7.713,-7.259",
                false,
            ),
        ],
    );
}

#[test]
fn a_mark_says_in_which_way_it_is_right() {
    let mark = judged(&polynomial("1 3 3 1"), &answer("-1.17,0 -0.915,-0.148 -0.915,0.148"));
    assert_eq!(
        mark.evidence.reason,
        "These are, rounded, the poles of a denominator whose coefficients differ from the expected ones by at most 0.175 %, within the \
         0.5 % allowed; near a multiple pole small changes of the coefficients move the poles far."
    );
    assert_eq!(
        mark.evidence.expected,
        "-1 (3 times, from -1.01 to -0.99), or each part correctly rounded to at least 2 figures. Also right, on the same side \
         of the imaginary axis: the poles, as rounded, of a denominator whose coefficients are each within 0.5 % of the \
         expected ones."
    );
    let mark = judged(&polynomial("1 0.0002 4"), &answer("-0.0001,2.1 -0.0001,-2.1"));
    assert_eq!(
        mark.evidence.expected,
        "-0.0001 ± 2j (real part from -0.0011 to below 0, imaginary part from ±1.98 to ±2.0199), or each part correctly rounded to \
         at least 2 figures. Also right, on the same side of the imaginary axis: the poles, as rounded, of a denominator \
         whose coefficients are each within 0.5 % of the expected ones."
    );
    assert_eq!(
        mark.evidence.reason,
        "0 of 2 poles are right: -0.0001 + 2.1j is written where -0.0001 + 2j is expected; -0.0001 - 2.1j is written where \
         -0.0001 - 2j is expected."
    );
}

/// Half the points, and what is said, also where the poles move far.
#[test]
fn slips_beside_a_multiple_pole() {
    for (text, code) in [
        ("-1.17,0 -0.915,-0.148", "poles.missing_conjugate"),
        ("1.17,0 0.915,-0.148 0.915,0.148", "poles.mirrored"),
        ("-1.17,0 0.915,-0.148 0.915,0.148", "poles.mirrored"),
        ("-1.17,0 -0.915,-0.3 -0.915,0.3", "poles.value"),
        ("-1.17,0 -0.915,-0.148 -0.915,0.148 -1,0", "poles.value"),
    ] {
        assert_eq!(judged(&polynomial("1 3 3 1"), &answer(text)).code, code, "{text}");
    }
}

/// Correctly rounded to so many significant figures.
fn rounded(value: f64, figures: usize) -> Decimal {
    if value == 0.0 {
        Decimal::absent()
    } else {
        Decimal::parse(&format!("{value:.*e}", figures - 1)).unwrap()
    }
}

fn rounded_poles(poles: &[Pole], figures: usize) -> Vec<TypedComplex> {
    poles
        .iter()
        .flat_map(|pole| std::iter::repeat_n(pole, pole.multiplicity))
        .map(|pole| TypedComplex {
            re: rounded(pole.re, figures),
            im: rounded(pole.im, figures),
            span: Span::default(),
        })
        .collect()
}

/// How many in the left and in the right half-plane.
fn sides(poles: &[Pole]) -> (usize, usize) {
    let count = |side| poles.iter().filter(|pole| Side::of(pole) == side).map(|pole| pole.multiplicity).sum();
    (count(Side::Left), count(Side::Right))
}

/// Products of s + a and s² + 2as + a² + b² with a, b in hundredths, near one another as often as not.
fn denominator() -> impl Strategy<Value = Polynomial> {
    let hundredth = |n: i64| Rational::from(n) / Rational::from(100);
    let factor = (-300i64..300, 0i64..300, 0..4u8).prop_map(move |(a, b, kind)| {
        let (a, b) = if kind < 2 { (a / 100 * 100, b / 100 * 100) } else { (a, b) };
        let (a, b) = (hundredth(a), hundredth(b));
        if kind % 2 == 0 {
            Polynomial::new(vec![Rational::ONE, a])
        } else {
            Polynomial::new(vec![Rational::ONE, Rational::from(2) * &a, &a * &a + &b * &b])
        }
    });
    prop::collection::vec((factor, 1..4usize), 1..4).prop_map(|factors| {
        let each = factors.into_iter().flat_map(|(factor, n)| std::iter::repeat_n(factor, n)).take(7);
        each.fold(Polynomial::one(), |product, factor| &product * &factor)
    })
}

/// Each coefficient changed by so many hundredths of the 0.5 % allowed, -100 to 100.
fn perturbed(denominator: &Polynomial, by: &[i64]) -> Polynomial {
    let change =
        |(c, by): (&Rational, &i64)| c * (Rational::ONE + Rational::from(*by) / Rational::from(20_000));
    Polynomial::new(denominator.coefficients().iter().zip(by).map(change).collect())
}

proptest! {
    #[test]
    fn order_makes_no_difference(seed in prop::collection::vec((-9i32..9, -9i32..9), 1..7), turn in 0usize..7) {
        let want: Vec<Pole> = seed.iter().map(|(re, im)| pole(f64::from(*re), f64::from(*im), 1)).collect();
        let mut given = answer(&seed.iter().map(|(re, im)| format!("{re},{im} ")).collect::<String>());
        let turn = turn % given.len();
        given.rotate_left(turn);
        let mark = marked(&want, &[], &tolerance("0.001", "0.01", None), &given);
        prop_assert_eq!(mark.code, "right");
    }

    #[test]
    fn who_rounds_correctly_is_never_failed(
        denominator in denominator(),
        by in prop::collection::vec(prop_oneof![-100i64..=100, Just(100), Just(-100)], 16),
        figures in 3usize..7,
    ) {
        let own = roots(&perturbed(&denominator, &by)).unwrap();
        prop_assume!(sides(&own) == sides(&roots(&denominator).unwrap()));
        let typed = rounded_poles(&own, figures);
        let mark = judged(&denominator, &typed);
        let as_typed: Vec<_> = typed.iter().map(|pole| (&pole.re.text, &pole.im.text)).collect();
        let polynomial = polynomial_text(&denominator, "s", 8);
        prop_assert_eq!(mark.code, "right", "{}: {:?}: {}", polynomial, as_typed, mark.evidence.reason);
    }

    #[test]
    fn a_sign_away_is_never_passed(
        denominator in denominator(),
        by in prop::collection::vec(-100i64..=100, 16),
        figures in 2usize..7,
        which in 0usize..16,
    ) {
        let own = roots(&perturbed(&denominator, &by)).unwrap();
        let expected = roots(&denominator).unwrap();
        prop_assume!(sides(&own) == sides(&expected));
        let mut typed = rounded_poles(&own, figures);
        let wrong = typed[which % typed.len()].clone();
        prop_assume!(!wrong.re.is_zero());
        for pole in &mut typed {
            let conjugate = pole.im.value == -wrong.im.value.clone();
            if pole.re == wrong.re && (pole.im == wrong.im || conjugate) {
                pole.re = Decimal { value: -pole.re.value.clone(), ..pole.re.clone() };
            }
        }
        let mark = judged(&denominator, &typed);
        prop_assert_ne!(mark.code, "right", "{}", mark.evidence.reason);
    }

    #[test]
    fn neither_order_nor_which_conjugate_comes_first_matters(
        denominator in denominator(),
        by in prop::collection::vec(-300i64..=300, 16),
        turn in 0usize..16,
    ) {
        let own = roots(&perturbed(&denominator, &by)).unwrap();
        let typed = rounded_poles(&own, 3);
        let mut other = typed.clone();
        other.reverse();
        other.rotate_left(turn % typed.len());
        let (mark, turned) = (judged(&denominator, &typed), judged(&denominator, &other));
        prop_assert_eq!((mark.code, mark.earned), (turned.code, turned.earned));
    }
}

/// What the lab does not state is no wider than a thousandth of the pole.
#[test]
fn the_usual_tolerance_of_slow_poles() {
    let slow = [pole(-0.0003, 0.0, 1), pole(0.0, 0.0, 1)];
    let lightly_damped = pair(-0.0195, 5.586);
    let undamped = pair(0.0, 0.002);
    for (want, text, code) in [
        (&slow[..], "-0.0003,0 0,0", "right"),
        (&slow, "-0.0003,0 0.0000001,0", "right"),
        (&slow, "0.0003,0 0,0", "poles.mirrored"),
        (&slow, "-0.0004,0 0,0", "poles.value"),
        (&slow, "-0.0003,0 -0.0009,0", "poles.value"),
        (&lightly_damped, "-0.0204,5.59 -0.0204,-5.59", "right"),
        (&lightly_damped, "-0.0217,5.59 -0.0217,-5.59", "poles.value"),
        (&undamped, "0,0.002 0,-0.002", "right"),
        (&undamped, "-0.000002,0.002 -0.000002,-0.002", "right"),
        (&undamped, "-0.0005,0.002 -0.0005,-0.002", "poles.value"),
        (&undamped, "0,0.0026 0,-0.0026", "poles.value"),
    ] {
        let mark = marked(want, &[], &usual(), &answer(text));
        assert_eq!(mark.code, code, "{text}: {:?}", mark.evidence);
    }
}
