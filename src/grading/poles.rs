use super::Evidence;
use super::accepted::{Accepted, accepted, also};
use super::closeness::{closeness, in_words};
use super::mark::{Mark, half, share};
use crate::algebra::{Polynomial, Rational, significant};
use crate::lab::{Points, SystemRef, Tolerance};
use crate::lti::Pole;
use crate::reference::Reference;
use crate::submission::{Decimal, TypedComplex};

/// More poles than this are not matched one by one.
const MOST: usize = 60;

/// One accepted set of poles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExpectedPoles<'a> {
    pub poles: Accepted<'a, [Pole]>,
    /// The polynomial whose roots they are, common factors cancelled; any scale.
    #[allow(dead_code, reason = "read by the backward error, which comes next")]
    pub denominator: &'a Polynomial,
}

/// How near a set of poles has to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness<'a> {
    /// Of each real and imaginary part.
    pub parts: &'a Tolerance,
    /// Relative, of each coefficient of the denominator.
    #[allow(dead_code, reason = "read by the backward error, which comes next")]
    pub coefficients: &'a Rational,
}

/// The poles of every accepted set of parameter values, the lab's own first; none when the reference does not know `of`.
pub(super) fn accepted_poles<'a>(reference: &'a Reference, of: &SystemRef) -> Vec<ExpectedPoles<'a>> {
    accepted(reference, of, |one| one)
        .into_iter()
        .map(|one| ExpectedPoles {
            poles: Accepted { differs: one.differs, what: one.what.poles.as_slice() },
            denominator: &one.what.linearization.transfer_function.den,
        })
        .collect()
}

/// What is expected of a set of poles, in words.
pub(super) fn expected(accepted: &[ExpectedPoles<'_>], nearness: &Nearness<'_>) -> String {
    let sets: Vec<_> = accepted.iter().map(|one| one.poles).collect();
    let Some(main) = sets.first() else { return String::new() };
    let list = if main.what.is_empty() { "No poles".to_owned() } else { list(main.what) };
    format!("{list}; real and imaginary part each {}.{}", in_words(nearness.parts), also(&sets))
}

/// The typed set against each accepted set, the best of them.
///
/// Both are multisets. A typed pole may stand for an expected one when both parts are close enough and the real parts have
/// the same sign; the largest matching decides. `cancelled` are values that the whole state has beyond the poles.
pub(super) fn judge(
    points: Points,
    accepted: &[ExpectedPoles<'_>],
    cancelled: &[Pole],
    nearness: &Nearness<'_>,
    typed: &[TypedComplex],
) -> Mark {
    let expected = expected(accepted, nearness);
    let found = if typed.is_empty() { "No poles".to_owned() } else { typed_list(typed) };
    if accepted.is_empty() || accepted.iter().any(|one| count(one.poles.what) > MOST) {
        return Mark::unmarked(expected, found, "polemark cannot compare these poles; a person will.");
    }
    let mut best: Option<Outcome> = None;
    for one in accepted {
        let outcome = compare(one.poles.what, cancelled, nearness.parts, typed, &one.poles.with());
        let rank = |o: &Outcome| (o.code == "right", o.code == "poles.missing_conjugate", o.matched);
        if best.as_ref().is_none_or(|known| rank(&outcome) > rank(known)) {
            best = Some(outcome);
        }
    }
    let Some(outcome) = best else {
        return Mark::unmarked(expected, found, "There is no reference to compare this with.");
    };
    let evidence = Evidence { expected, found, reason: outcome.reason, ..Evidence::default() };
    match outcome.code {
        "right" => Mark::right(points, evidence),
        "poles.missing_conjugate" => Mark::partly(outcome.code, share(points, &half()), evidence),
        code => Mark::wrong(code, evidence),
    }
}

struct Outcome {
    code: &'static str,
    matched: usize,
    reason: String,
}

fn compare(
    want: &[Pole],
    cancelled: &[Pole],
    tolerance: &Tolerance,
    typed: &[TypedComplex],
    with: &str,
) -> Outcome {
    let each: Vec<Pole> =
        want.iter().flat_map(|pole| std::iter::repeat_n(*pole, pole.multiplicity)).collect();
    if typed.len() > MOST {
        let reason = format!("{} poles were written; there are {}.", typed.len(), each.len());
        return Outcome { code: "poles.extra", matched: 0, reason };
    }
    let values: Vec<Value> = typed.iter().map(Value::of).collect();
    let fit = assign(&each, &values, tolerance);
    let matched = fit.matched();
    let outcome = |code, reason| Outcome { code, matched, reason };

    if matched == each.len() && matched == values.len() {
        return outcome(
            "right",
            format!("Every pole{with} is there, each as often as it should be, and no other."),
        );
    }
    if let Some(reason) = missing_conjugates(&each, &values, tolerance) {
        return outcome("poles.missing_conjugate", reason);
    }
    if same_places(want, &values, tolerance) {
        return outcome("poles.multiplicity", multiplicities(want, &values, tolerance));
    }
    let mirrored: Vec<Value> = values.iter().map(Value::mirrored).collect();
    if assign(&each, &mirrored, tolerance).matched() == each.len().max(values.len()) {
        let reason =
            "Each real part has the wrong sign: the set is mirrored at the imaginary axis.".to_owned();
        return outcome("poles.mirrored", reason);
    }
    if matched == values.len() {
        let reason = format!(
            "Those given are right, but {} missing.",
            is_are(&list_each(&fit.unmatched_wanted(&each)))
        );
        return outcome("poles.missing", reason);
    }
    if matched == each.len() {
        let extra = fit.unmatched_values(&values);
        let mut reason = format!(
            "All poles are there, but {} not among them.",
            is_are(&extra.iter().map(|v| v.text()).collect::<Vec<_>>())
        );
        let of_state = |value: &Value| cancelled.iter().any(|pole| value.accepted_for(pole, tolerance));
        if extra.iter().all(|value| of_state(value)) {
            reason.push_str(" It belongs to the whole state, but cancels in the transfer function.");
        }
        return outcome("poles.extra", reason);
    }
    let one_mirrored = fit.unmatched_values(&values).iter().any(|value| {
        fit.unmatched_wanted(&each).iter().any(|pole| value.mirrored().accepted_for(pole, tolerance))
    });
    let code = if one_mirrored { "poles.mirrored" } else { "poles.value" };
    let mut reason = format!(
        "{} of {} poles are right. Not matched: {} expected, {} written.",
        matched,
        each.len(),
        list_each(&fit.unmatched_wanted(&each)).join(", "),
        fit.unmatched_values(&values).iter().map(|v| v.text()).collect::<Vec<_>>().join(", "),
    );
    if one_mirrored {
        reason.push_str(" A real part has the wrong sign.");
    }
    outcome(code, reason)
}

/// A typed pole and its images.
#[derive(Clone, Debug)]
struct Value {
    re: Decimal,
    im: Decimal,
}

impl Value {
    fn of(typed: &TypedComplex) -> Self {
        Self { re: typed.re.clone(), im: typed.im.clone() }
    }

    fn mirrored(&self) -> Self {
        Self { re: negated(&self.re), im: self.im.clone() }
    }

    fn conjugate(&self) -> Self {
        Self { re: self.re.clone(), im: negated(&self.im) }
    }

    fn accepted_for(&self, pole: &Pole, tolerance: &Tolerance) -> bool {
        // A real part that is zero as far as anyone can tell has no sign.
        let same_side = if pole.re > pole.error_bound {
            self.re.value > Rational::ZERO
        } else if pole.re < -pole.error_bound {
            self.re.value < Rational::ZERO
        } else {
            true
        };
        same_side
            && closeness(pole.re, pole.error_bound, &self.re, tolerance).accepted()
            && closeness(pole.im, pole.error_bound, &self.im, tolerance).accepted()
    }

    fn text(&self) -> String {
        complex_text(&self.re.text, &self.im.text, self.im.value.is_zero())
    }
}

fn negated(decimal: &Decimal) -> Decimal {
    let text = match decimal.text.strip_prefix(['-', '−']) {
        Some(positive) => positive.to_owned(),
        None => format!("-{}", decimal.text.trim_start_matches('+')),
    };
    Decimal { text, value: -decimal.value.clone(), last_place: decimal.last_place }
}

/// Which expected pole each typed one stands for.
struct Assignment {
    wanted_of_value: Vec<Option<usize>>,
    value_of_wanted: Vec<Option<usize>>,
}

impl Assignment {
    fn matched(&self) -> usize {
        self.wanted_of_value.iter().flatten().count()
    }

    fn unmatched_wanted(&self, each: &[Pole]) -> Vec<Pole> {
        each.iter()
            .zip(&self.value_of_wanted)
            .filter(|(_, taken)| taken.is_none())
            .map(|(pole, _)| *pole)
            .collect()
    }

    fn unmatched_values<'a>(&self, values: &'a [Value]) -> Vec<&'a Value> {
        values
            .iter()
            .zip(&self.wanted_of_value)
            .filter(|(_, taken)| taken.is_none())
            .map(|(value, _)| value)
            .collect()
    }
}

/// The largest one-to-one assignment of typed to expected poles (augmenting paths; Kuhn 1955, Berge 1957).
fn assign(each: &[Pole], values: &[Value], tolerance: &Tolerance) -> Assignment {
    let fits: Vec<Vec<bool>> = values
        .iter()
        .map(|value| each.iter().map(|pole| value.accepted_for(pole, tolerance)).collect())
        .collect();
    let mut assignment =
        Assignment { wanted_of_value: vec![None; values.len()], value_of_wanted: vec![None; each.len()] };
    for value in 0..values.len() {
        let mut seen = vec![false; each.len()];
        augment(value, &fits, &mut seen, &mut assignment);
    }
    assignment
}

/// Depth at most the number of poles, which is at most [`MOST`].
fn augment(value: usize, fits: &[Vec<bool>], seen: &mut [bool], assignment: &mut Assignment) -> bool {
    for wanted in 0..seen.len() {
        if !fits[value][wanted] || seen[wanted] {
            continue;
        }
        seen[wanted] = true;
        let free = match assignment.value_of_wanted[wanted] {
            None => true,
            Some(other) => augment(other, fits, seen, assignment),
        };
        if free {
            assignment.value_of_wanted[wanted] = Some(value);
            assignment.wanted_of_value[value] = Some(wanted);
            return true;
        }
    }
    false
}

/// The set would be right if each complex pole that stands alone had its conjugate beside it.
fn missing_conjugates(each: &[Pole], values: &[Value], tolerance: &Tolerance) -> Option<String> {
    let alone: Vec<&Value> = values.iter().filter(|value| !value.im.value.is_zero()).collect();
    let completed: Vec<Value> = alone
        .iter()
        .filter(|value| {
            let same = |other: &&&Value| {
                other.re.value == value.re.value && other.im.value == -value.im.value.clone()
            };
            alone.iter().filter(same).count() == 0
        })
        .map(|value| value.conjugate())
        .collect();
    if completed.is_empty() {
        return None;
    }
    let mut all = values.to_vec();
    all.extend(completed.iter().cloned());
    if all.len() != each.len() || assign(each, &all, tolerance).matched() != each.len() {
        return None;
    }
    let list: Vec<_> = completed.iter().map(Value::text).collect();
    Some(format!(
        "Each pole given is right, but complex poles of a real system come in conjugate pairs: {} missing. Half the points.",
        is_are(&list)
    ))
}

/// The same places, though not the same number of poles at each.
fn same_places(want: &[Pole], values: &[Value], tolerance: &Tolerance) -> bool {
    !values.is_empty()
        && want.iter().all(|pole| values.iter().any(|value| value.accepted_for(pole, tolerance)))
        && values.iter().all(|value| want.iter().any(|pole| value.accepted_for(pole, tolerance)))
}

fn multiplicities(want: &[Pole], values: &[Value], tolerance: &Tolerance) -> String {
    let times = |n: usize| match n {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        n => format!("{n} times"),
    };
    let off: Vec<_> = want
        .iter()
        .filter_map(|pole| {
            let given = values.iter().filter(|value| value.accepted_for(pole, tolerance)).count();
            (given != pole.multiplicity).then(|| {
                format!(
                    "{} counts {}, it is given {}",
                    pole_text(pole),
                    times(pole.multiplicity),
                    times(given)
                )
            })
        })
        .collect();
    format!("The places are right, but not how often each counts: {}.", off.join("; "))
}

fn count(poles: &[Pole]) -> usize {
    poles.iter().map(|pole| pole.multiplicity).sum()
}

fn is_are(list: &[String]) -> String {
    format!("{} {}", list.join(", "), if list.len() == 1 { "is" } else { "are" })
}

fn list_each(poles: &[Pole]) -> Vec<String> {
    poles.iter().map(pole_text).collect()
}

fn list(poles: &[Pole]) -> String {
    let one = |pole: &Pole| match pole.multiplicity {
        1 => pole_text(pole),
        many => format!("{} ({many} times)", pole_text(pole)),
    };
    poles.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn typed_list(typed: &[TypedComplex]) -> String {
    let shown: Vec<_> = typed.iter().take(MOST).map(|pole| Value::of(pole).text()).collect();
    let more = if typed.len() > MOST { format!(" and {} more", typed.len() - MOST) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}

fn pole_text(pole: &Pole) -> String {
    // Below its error bound a part is zero as far as anyone can tell.
    let shown = |part: f64| if part.abs() <= pole.error_bound { 0.0 } else { part };
    let (re, im) = (shown(pole.re), shown(pole.im));
    complex_text(&significant(re, 5), &significant(im, 5), im == 0.0)
}

/// `-0.0195 + 5.59j`; a real number stands alone.
fn complex_text(re: &str, im: &str, real: bool) -> String {
    if real {
        return re.to_owned();
    }
    match im.strip_prefix(['-', '−']) {
        Some(positive) => format!("{re} - {positive}j"),
        None => format!("{re} + {}j", im.trim_start_matches('+')),
    }
}

#[cfg(test)]
mod tests {
    use super::super::closeness::tests::{tolerance, typed};
    use super::*;
    use crate::grading::Verdict;
    use crate::source::Span;
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
            assert_eq!(
                (mark.earned, mark.code),
                (Points(*points), *code),
                "{what}: {}",
                mark.evidence.reason
            );
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
    }
}
