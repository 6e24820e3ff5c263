//! What becomes of a claim, given what is known of the response.

use super::claims::{Claim, ClaimKind, Quantity};
use super::number::ClaimedNumber;
use crate::algebra::significant;
use crate::lti::{Features, Limit, Shape, Stability};

impl Claim {
    /// Whether the claim is true of a response with these features, of a system with this stability; `None` where the words
    /// leave room (`stable` of what is marginally stable).
    pub fn holds(&self, features: &Features, stability: Stability) -> Option<bool> {
        match self.kind {
            ClaimKind::Stable | ClaimKind::MarginallyStable | ClaimKind::Unstable => {
                self.holds_for_stability(stability)
            }
            ClaimKind::Value(of, number) => self.stance(value(features, of, number)),
            // A swing may hide under what decays or grows faster.
            ClaimKind::Oscillates if features.period_s.is_some() && !swings(features.shape) => None,
            _ => self.holds_for_shape(features.shape).or_else(|| self.holds_for_limit(features.final_value)),
        }
    }

    /// What is so instead, as a clause that stands after `by your transfer function`: `it is a decaying oscillation`.
    pub fn fact(&self, features: &Features, stability: Stability) -> String {
        match self.kind {
            ClaimKind::Stable | ClaimKind::MarginallyStable | ClaimKind::Unstable => {
                format!("it is {}", stability.words())
            }
            ClaimKind::Value(Quantity::Initial, _) => {
                format!("the initial value is {}", significant(features.initial_value, 4))
            }
            ClaimKind::Value(Quantity::Final, _) => match features.final_value {
                Limit::Value(value) => format!("the final value is {}", significant(value, 4)),
                other => format!("it {}", other.words()),
            },
            ClaimKind::Value(Quantity::Peak, _) => match features.peak {
                Some(peak) => format!("the peak is {}", significant(peak.value, 4)),
                None => "it has no peak".to_owned(),
            },
            ClaimKind::Value(Quantity::PeriodS, _) => match features.period_s {
                Some(period) => format!("the period is {} s", significant(period, 4)),
                None => "it does not oscillate".to_owned(),
            },
            _ => format!("the response is {}", features.shape.words()),
        }
    }

    /// The same, where the stability is all that is known.
    pub fn holds_for_stability(&self, stability: Stability) -> Option<bool> {
        use Stability::*;
        let affirmed = match (self.kind, stability) {
            (ClaimKind::Stable, AsymptoticallyStable) => Some(true),
            (ClaimKind::Stable, Unstable) => Some(false),
            // Some call it stable.
            (ClaimKind::Stable, MarginallyStable) => self.denied.then_some(false),
            (ClaimKind::Unstable, Unstable) => Some(true),
            (ClaimKind::Unstable, AsymptoticallyStable) => Some(false),
            (ClaimKind::Unstable, MarginallyStable) => self.denied.then_some(false),
            (ClaimKind::MarginallyStable, stability) => Some(stability == MarginallyStable),
            (ClaimKind::DiesAway, AsymptoticallyStable) => Some(true),
            (ClaimKind::DiesAway | ClaimKind::Value(Quantity::Final, _), Unstable) => Some(false),
            (
                ClaimKind::GrowsWithoutBound | ClaimKind::NeverEnds | ClaimKind::ConstantAmplitude,
                AsymptoticallyStable,
            ) => Some(false),
            (ClaimKind::GrowsWithoutBound, Unstable) => Some(true),
            _ => None,
        };
        self.stance(affirmed)
    }

    /// The same, where the general shape is all that is known.
    pub fn holds_for_shape(&self, shape: Shape) -> Option<bool> {
        use Shape::*;
        let affirmed = match (self.kind, shape) {
            (ClaimKind::Oscillates, shape) => Some(swings(shape)),
            (ClaimKind::DiesAway, DecayingOscillation | ExponentialDecay) => Some(true),
            (ClaimKind::DiesAway, SustainedOscillation | GrowingOscillation | ExponentialGrowth) => {
                Some(false)
            }
            (ClaimKind::GrowsWithoutBound, GrowingOscillation | ExponentialGrowth | PolynomialGrowth) => {
                Some(true)
            }
            (ClaimKind::GrowsWithoutBound, _) => Some(false),
            (ClaimKind::NeverEnds, DecayingOscillation | ExponentialDecay) => Some(false),
            (ClaimKind::NeverEnds, Constant) => None,
            (ClaimKind::NeverEnds, _) => Some(true),
            (ClaimKind::ConstantAmplitude, Constant) => None,
            (ClaimKind::ConstantAmplitude, shape) => Some(shape == SustainedOscillation),
            (ClaimKind::Stable, GrowingOscillation | ExponentialGrowth | SustainedOscillation) => Some(false),
            (ClaimKind::Unstable, DecayingOscillation | ExponentialDecay) => Some(false),
            (
                ClaimKind::Value(Quantity::Final, _),
                SustainedOscillation | GrowingOscillation | ExponentialGrowth | PolynomialGrowth,
            ) => Some(false),
            _ => None,
        };
        self.stance(affirmed)
    }

    /// The same, where only is known where it goes.
    pub fn holds_for_limit(&self, limit: Limit) -> Option<bool> {
        let affirmed = match (self.kind, limit) {
            (ClaimKind::Value(Quantity::Final, number), Limit::Value(value)) => Some(number.near(value, 0.0)),
            (ClaimKind::Value(Quantity::Final, _) | ClaimKind::DiesAway, limit) => {
                Some(limit.value().is_some())
            }
            (ClaimKind::GrowsWithoutBound, limit) => {
                Some(!matches!(limit, Limit::Value(_) | Limit::Oscillates))
            }
            (ClaimKind::NeverEnds, limit) => Some(limit.value().is_none()),
            (ClaimKind::ConstantAmplitude, Limit::Oscillates) => None,
            (ClaimKind::ConstantAmplitude, _) => Some(false),
            (ClaimKind::Unstable, Limit::Value(_)) => Some(false),
            (ClaimKind::Stable, limit) if limit.value().is_none() => Some(false),
            _ => None,
        };
        self.stance(affirmed)
    }

    /// The same, where only the value it starts from is known.
    pub fn holds_for_initial_value(&self, start: f64) -> Option<bool> {
        match self.kind {
            ClaimKind::Value(Quantity::Initial, number) => self.stance(Some(number.near(start, 0.0))),
            _ => None,
        }
    }

    fn stance(&self, affirmed: Option<bool>) -> Option<bool> {
        affirmed.map(|holds| holds != self.denied)
    }
}

fn swings(shape: Shape) -> bool {
    matches!(shape, Shape::DecayingOscillation | Shape::SustainedOscillation | Shape::GrowingOscillation)
}

fn value(features: &Features, of: Quantity, number: ClaimedNumber) -> Option<bool> {
    let scale = features.peak.map_or(0.0, |peak| peak.value.abs());
    match of {
        Quantity::Initial => Some(number.near(features.initial_value, scale)),
        Quantity::Final => Some(features.final_value.value().is_some_and(|value| number.near(value, scale))),
        Quantity::Peak => peak(features, number),
        Quantity::PeriodS => match features.period_s {
            Some(period) => Some(number.near(period, 0.0)),
            None => (!swings(features.shape)).then_some(false),
        },
    }
}

/// Any extremum may be called a peak, and its sign may be left out; only the first few are known.
fn peak(features: &Features, number: ClaimedNumber) -> Option<bool> {
    let Some(largest) = features.peak else { return (!swings(features.shape)).then_some(false) };
    let same = |value: f64| {
        let bare = ClaimedNumber { value: number.value.abs(), ..number };
        if number.value < 0.0 { number.near(value, 0.0) } else { bare.near(value.abs(), 0.0) }
    };
    if same(largest.value) || features.extrema.iter().any(|extremum| same(extremum.value)) {
        return Some(true);
    }
    let negative = |value: f64| value < 0.0;
    let smaller = number.value.abs() < largest.value.abs();
    // One of the later swings, or one that goes the other way.
    let later = smaller && (swings(features.shape) || negative(number.value) == negative(largest.value));
    if later { None } else { Some(false) }
}

#[cfg(test)]
mod tests {
    use super::super::claims;
    use crate::algebra::Polynomial;
    use crate::lti::{Features, InputKind, Response, TransferFunction, stability};

    /// What the only claim of each sentence is of the impulse response of `num` over `den`.
    #[track_caller]
    fn check(num: &[i64], den: &[i64], rows: &[(&str, Option<bool>)]) {
        let g =
            TransferFunction::new(Polynomial::from_integers(num), Polynomial::from_integers(den)).unwrap();
        let features = Features::of(&Response::new(&g, InputKind::Impulse).unwrap());
        for (sentence, want) in rows {
            let found = claims(sentence, &[]);
            let [claim] = found.as_slice() else { panic!("{sentence}: {found:?}") };
            assert_eq!(claim.holds(&features, stability(&g.den)), *want, "{sentence}");
        }
    }

    #[test]
    fn of_a_decaying_oscillation() {
        // e⁻ᵗ sin 2t
        check(
            &[2],
            &[1, 2, 5],
            &[
                ("It is stable.", Some(true)),
                ("It is not stable.", Some(false)),
                ("It is unstable.", Some(false)),
                ("It is marginally stable.", Some(false)),
                ("It oscillates.", Some(true)),
                ("It does not oscillate.", Some(false)),
                ("It settles.", Some(true)),
                ("It grows without bound.", Some(false)),
                ("It goes on for ever.", Some(false)),
                ("It does not go on for ever.", Some(true)),
                ("It has constant amplitude.", Some(false)),
                ("It starts at 0.", Some(true)),
                ("It starts at 1.", Some(false)),
                ("It returns to zero.", Some(true)),
                ("The final value is 2.5.", Some(false)),
                ("The period is 3.1 s.", Some(true)),
                ("The period is 2 s.", Some(false)),
                ("The period is about 3 s.", Some(true)),
                // e^(−0.5536) sin 1.1071 = 0.514
                ("The peak is 0.51.", Some(true)),
                ("The peak is 1.4.", Some(false)),
            ],
        );
    }

    #[test]
    fn of_a_swing_that_stays() {
        // ½ sin 2t
        check(
            &[1],
            &[1, 0, 4],
            &[
                ("It is stable.", None),
                ("It is not stable.", Some(true)),
                ("It is unstable.", None),
                ("It is not unstable.", Some(true)),
                ("It is marginally stable.", Some(true)),
                ("It settles.", Some(false)),
                ("It goes on for ever.", Some(true)),
                ("It has constant amplitude.", Some(true)),
                ("It grows without bound.", Some(false)),
                ("It returns to zero.", Some(false)),
            ],
        );
    }

    #[test]
    fn of_growth() {
        // eᵗ
        check(
            &[1],
            &[1, -1],
            &[
                ("It is stable.", Some(false)),
                ("It is unstable.", Some(true)),
                ("It oscillates.", Some(false)),
                ("It settles.", Some(false)),
                ("It does not settle.", Some(true)),
                ("It grows without bound.", Some(true)),
                ("It goes on for ever.", Some(true)),
                ("It starts at 1.", Some(true)),
                ("It returns to zero.", Some(false)),
                ("The final value is not 0.", Some(true)),
                ("The period is 2 s.", Some(false)),
            ],
        );
        // A swing may hide: eᵗ and e⁻ᵗ sin 2t.
        check(&[1], &[1, 1, 3, -5], &[("It oscillates.", None), ("It grows without bound.", Some(true))]);
    }
}
