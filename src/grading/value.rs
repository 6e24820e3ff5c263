use super::Evidence;
use super::accepted::{Accepted, also};
use super::closeness::{Closeness, accepted_in_words, closeness, percent, shown};
use super::mark::Mark;
use crate::algebra::{Rational, from_f64};
use crate::lab::{FeatureKind, Points, Tolerance};
use crate::lti::{Features, Limit};
use crate::submission::{Decimal, FinalValue};

/// What a feature computed in floating point may be off by, as a part of itself,
const COMPUTED_TO: f64 = 1e-9;
/// and as a part of the response's largest value (its slowest time constant, for a time): what is left of a zero.
const RESIDUE: f64 = 1e-11;

/// What a feature is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Truth {
    /// A number, and what it may itself be off by.
    Number(f64, f64),
    PlusInfinity,
    MinusInfinity,
    /// Swings for ever, bounded or growing: there is no limit, and no side it goes to.
    NoLimit,
    /// The response has no such feature (no peak, no period).
    None,
}

fn truth(features: &Features, feature: FeatureKind) -> Truth {
    let finite = |size: f64| if size.is_finite() { size.abs() } else { 0.0 };
    let extrema = features.extrema.iter().map(|extremum| finite(extremum.value));
    let largest = extrema.fold(finite(features.initial_value), f64::max);
    let slowest = features.slowest_time_constant_s.map_or(0.0, finite);
    let number = |value: f64, scale: f64| Truth::Number(value, COMPUTED_TO * value.abs() + RESIDUE * scale);
    let optional = |value: Option<f64>, scale: f64| value.map_or(Truth::None, |value| number(value, scale));
    match feature {
        FeatureKind::InitialValue => number(features.initial_value, largest),
        FeatureKind::FinalValue => match features.final_value {
            Limit::Value(value) => number(value, largest),
            Limit::PlusInfinity => Truth::PlusInfinity,
            Limit::MinusInfinity => Truth::MinusInfinity,
            Limit::Oscillates | Limit::OscillatesUnbounded => Truth::NoLimit,
        },
        FeatureKind::Peak => optional(features.peak.map(|peak| peak.value), largest),
        FeatureKind::PeriodS => optional(features.period_s, slowest),
        FeatureKind::DampingRatio => optional(features.damping_ratio, 1.0),
        FeatureKind::SettlingTime2PercentS => optional(features.settling_time_2_percent_s, slowest),
        FeatureKind::SettlingTime5PercentS => optional(features.settling_time_5_percent_s, slowest),
    }
}

/// What is expected of the value, in words.
pub(super) fn expected(
    accepted: &[Accepted<'_, Features>],
    feature: FeatureKind,
    tolerance: &Tolerance,
) -> String {
    let Some(main) = accepted.first() else { return String::new() };
    match truth(main.what, feature) {
        Truth::Number(value, bound) => {
            let own = shown(value, tolerance);
            let same = |one: &Accepted<'_, Features>| match truth(one.what, feature) {
                Truth::Number(value, _) => shown(value, tolerance) == own,
                _ => false,
            };
            let others = if accepted.iter().all(same) { String::new() } else { also(accepted) };
            format!("{own}; {}.{others}", accepted_in_words(value, bound, tolerance, ""))
        }
        Truth::PlusInfinity => "It grows without bound, to +∞.".to_owned(),
        Truth::MinusInfinity => "It grows without bound, to -∞.".to_owned(),
        Truth::NoLimit => "There is none: the response swings for ever.".to_owned(),
        Truth::None => "There is none: the response has no such value.".to_owned(),
    }
}

/// The value typed against each accepted one, the best of them.
pub(super) fn judge(
    points: Points,
    accepted: &[Accepted<'_, Features>],
    feature: FeatureKind,
    tolerance: &Tolerance,
    typed: &FinalValue,
) -> Mark {
    let found = match typed {
        FinalValue::Number(decimal) => decimal.text.clone(),
        FinalValue::Unbounded => "unbounded, or no such value".to_owned(),
        FinalValue::PlusInfinity => "+∞".to_owned(),
        FinalValue::MinusInfinity => "-∞".to_owned(),
    };
    let expected = expected(accepted, feature, tolerance);
    let mut first_wrong = None;
    for one in accepted {
        let (code, reason) = compare(truth(one.what, feature), tolerance, typed, &one.with());
        let evidence =
            Evidence { expected: expected.clone(), found: found.clone(), reason, ..Evidence::default() };
        if code == "right" {
            return Mark::right(points, evidence);
        }
        first_wrong.get_or_insert_with(|| Mark::wrong(code, evidence));
    }
    first_wrong
        .unwrap_or_else(|| Mark::unmarked(expected, found, "There is no reference to compare this with."))
}

fn compare(truth: Truth, tolerance: &Tolerance, typed: &FinalValue, with: &str) -> (&'static str, String) {
    match (truth, typed) {
        (Truth::Number(want, bound), FinalValue::Number(have)) => {
            compare_numbers(want, bound, tolerance, have, with)
        }
        (Truth::Number(want, _), _) => {
            let reason =
                format!("The value is a number, {}: it does not grow without bound.", shown(want, tolerance));
            ("value.number_given_unbounded", reason)
        }
        (Truth::PlusInfinity | Truth::MinusInfinity, FinalValue::Unbounded)
        | (Truth::PlusInfinity, FinalValue::PlusInfinity)
        | (Truth::MinusInfinity, FinalValue::MinusInfinity) => {
            ("right", "It grows without bound.".to_owned())
        }
        (Truth::PlusInfinity | Truth::MinusInfinity, FinalValue::Number(_)) => {
            ("value.unbounded_given_number", "It grows without bound, so no number is its value.".to_owned())
        }
        (Truth::PlusInfinity, _) => ("value.sign", "It grows without bound, but to +∞.".to_owned()),
        (Truth::MinusInfinity, _) => ("value.sign", "It grows without bound, but to -∞.".to_owned()),
        (Truth::NoLimit | Truth::None, FinalValue::Unbounded) => {
            ("right", "There is no such value.".to_owned())
        }
        (Truth::NoLimit, FinalValue::Number(_)) => (
            "value.unbounded_given_number",
            "The response swings for ever, so no number is its limit.".to_owned(),
        ),
        (Truth::NoLimit, _) => {
            ("value.sign", "The response swings for ever and goes to neither side.".to_owned())
        }
        (Truth::None, _) => ("value.none", "The response has no such value.".to_owned()),
    }
}

fn compare_numbers(
    want: f64,
    bound: f64,
    tolerance: &Tolerance,
    have: &Decimal,
    with: &str,
) -> (&'static str, String) {
    let near = |value: f64| closeness(value, bound, have, tolerance);
    let shown = shown(want, tolerance);
    match near(want) {
        Closeness::Within => ("right", format!("It is within the tolerance of {shown}{with}.")),
        Closeness::Rounded => ("right", format!("It is {shown}{with}, correctly rounded.")),
        Closeness::Off if near(-want).accepted() => {
            ("value.sign", format!("The size is right, the sign is not: {shown} was expected."))
        }
        Closeness::Off => {
            let by = from_f64(want).filter(|want| !want.is_zero()).map(|want| (&have.value - &want) / want);
            let by = match by {
                Some(by) if shown != "0" => {
                    let size = if by < Rational::ZERO { -by } else { by };
                    format!("It is off by {}: {shown} was expected.", percent(&size))
                }
                _ => format!("{shown} was expected."),
            };
            ("value.differs", by)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::closeness::tests::{tolerance, typed};
    use super::*;
    use crate::algebra::Polynomial;
    use crate::lti::{Extremum, InputKind, Response, TransferFunction};

    /// A response with the features given, the others those of e^(-t).
    fn features(initial_value: f64, final_value: Limit) -> Features {
        let first_order =
            TransferFunction::new(Polynomial::one(), Polynomial::from_integers(&[1, 1])).unwrap();
        let decay = Features::of(&Response::new(&first_order, InputKind::Impulse).unwrap());
        let peak = Some(Extremum { time_s: 1.0, value: -0.73 });
        Features { initial_value, final_value, peak, period_s: Some(1.1246), ..decay }
    }

    #[track_caller]
    fn check(rows: &[(FeatureKind, f64, Limit, FinalValue, &str)]) {
        for (feature, initial, limit, answer, code) in rows {
            let features = features(*initial, *limit);
            let accepted = [Accepted { differs: &[], what: &features }];
            let tolerance = tolerance("0.001", "0.01", Some(2));
            let mark = judge(Points(50), &accepted, *feature, &tolerance, answer);
            assert_eq!(mark.code, *code, "{feature:?} {limit:?} {answer:?}: {}", mark.evidence.reason);
            assert_eq!(mark.earned, if *code == "right" { Points(50) } else { Points::ZERO });
        }
    }

    #[test]
    fn numbers_and_limits() {
        use super::FinalValue as Answer;
        use super::FinalValue::{MinusInfinity as Minus, PlusInfinity as Plus, Unbounded};
        use FeatureKind::*;
        let number = |text| Answer::Number(typed(text));
        let at_zero = Limit::Value(1e-19);
        check(&[
            // feature, initial value, limit, answer, code
            (InitialValue, 0.0, at_zero, number("0"), "right"),
            (InitialValue, 0.0, at_zero, number("0.001"), "right"),
            (InitialValue, 0.0, at_zero, number("0.0011"), "value.differs"),
            (InitialValue, -4.545, at_zero, number("-4.59"), "right"),
            (InitialValue, -4.545, at_zero, number("-4.6"), "value.differs"),
            (InitialValue, -4.545, at_zero, number("4.55"), "value.sign"),
            (FinalValue, 0.0, at_zero, number("0"), "right"),
            (FinalValue, 0.0, at_zero, Unbounded, "value.number_given_unbounded"),
            (FinalValue, 0.0, Limit::PlusInfinity, Unbounded, "right"),
            (FinalValue, 0.0, Limit::PlusInfinity, Plus, "right"),
            (FinalValue, 0.0, Limit::PlusInfinity, Minus, "value.sign"),
            (FinalValue, 0.0, Limit::PlusInfinity, number("1000000"), "value.unbounded_given_number"),
            (FinalValue, 0.0, Limit::MinusInfinity, Unbounded, "right"),
            (FinalValue, 0.0, Limit::MinusInfinity, Plus, "value.sign"),
            (FinalValue, 0.0, Limit::Oscillates, Unbounded, "right"),
            (FinalValue, 0.0, Limit::Oscillates, number("0"), "value.unbounded_given_number"),
            (FinalValue, 0.0, Limit::OscillatesUnbounded, Plus, "value.sign"),
            (Peak, 0.0, at_zero, number("-0.73"), "right"),
            (Peak, 0.0, at_zero, number("0.73"), "value.sign"),
            (PeriodS, 0.0, at_zero, number("1.1"), "right"),
            (PeriodS, 0.0, at_zero, number("1"), "value.differs"),
            (DampingRatio, 0.0, at_zero, number("1"), "value.none"),
            (DampingRatio, 0.0, at_zero, Unbounded, "right"),
        ]);
    }
}
