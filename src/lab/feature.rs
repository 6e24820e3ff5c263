use crate::algebra::Rational;
use crate::submission::{Unit, UnitRatio};

/// What one may read off a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    InitialValue,
    FinalValue,
    /// Signed value of the extremum of largest magnitude.
    Peak,
    /// When that extremum is reached.
    PeakTimeS,
    PeriodS,
    DampingRatio,
    /// ω_n of the dominant pair.
    NaturalFrequencyRadS,
    /// ω_d = 2π / period.
    DampedFrequencyRadS,
    SettlingTime2PercentS,
    SettlingTime5PercentS,
    /// In percent of the final value.
    OvershootPercent,
    RiseTime1090S,
    RiseTime0100S,
    /// G(0).
    DcGain,
}

/// A feature of a response as a criterion asks for it.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedFeature {
    pub kind: FeatureKind,
    /// What it is asked in; `None` where the lab does not say what the output is measured in.
    pub unit: Option<Unit>,
    /// What it is computed in, where the lab says so.
    pub native: Option<Unit>,
    /// Units that may stand behind the same number: an impulse response may be given per unit of its impulse.
    pub also: Vec<Unit>,
    /// What part of the points is left by what is right under the other convention (0..=1).
    pub other_convention: Rational,
}

impl AskedFeature {
    /// How much of the unit asked for is one of the unit it is computed in.
    pub fn ratio(&self) -> UnitRatio {
        ratio(self.native.as_ref(), self.unit.as_ref())
    }
}

/// A value at rest as a criterion asks for it.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedRest {
    /// A coordinate, an output or an input.
    pub signal: String,
    /// What it is asked in; `None` where the lab does not say.
    pub unit: Option<Unit>,
    /// What the equations have it in, where the lab says so.
    pub native: Option<Unit>,
}

impl AskedRest {
    /// How much of the unit asked for is one of the unit that the equations have it in.
    pub fn ratio(&self) -> UnitRatio {
        ratio(self.native.as_ref(), self.unit.as_ref())
    }
}

fn ratio(native: Option<&Unit>, asked: Option<&Unit>) -> UnitRatio {
    native.zip(asked).and_then(|(native, asked)| native.in_unit(asked)).unwrap_or_else(UnitRatio::one)
}

/// Every feature, as the lab file spells it and in words.
const FEATURES: &[(FeatureKind, &str, &str)] = &[
    (FeatureKind::InitialValue, "initial_value", "the initial value"),
    (FeatureKind::FinalValue, "final_value", "the final value"),
    (FeatureKind::Peak, "peak", "the peak"),
    (FeatureKind::PeakTimeS, "peak_time_s", "the peak time"),
    (FeatureKind::PeriodS, "period_s", "the period"),
    (FeatureKind::DampingRatio, "damping_ratio", "the damping ratio"),
    (FeatureKind::NaturalFrequencyRadS, "natural_frequency_rad_s", "the natural frequency"),
    (FeatureKind::DampedFrequencyRadS, "damped_frequency_rad_s", "the frequency of the damped oscillation"),
    (FeatureKind::SettlingTime2PercentS, "settling_time_2_percent_s", "the settling time to within 2 %"),
    (FeatureKind::SettlingTime5PercentS, "settling_time_5_percent_s", "the settling time to within 5 %"),
    (FeatureKind::OvershootPercent, "overshoot_percent", "the overshoot"),
    (FeatureKind::RiseTime1090S, "rise_time_10_90_s", "the rise time from 10 % to 90 %"),
    (FeatureKind::RiseTime0100S, "rise_time_0_100_s", "the rise time from 0 to 100 %"),
    (FeatureKind::DcGain, "dc_gain", "the gain at rest, G(0)"),
];

impl FeatureKind {
    /// Every feature, in the order of the manual.
    pub fn all() -> impl Iterator<Item = Self> {
        FEATURES.iter().map(|(kind, _, _)| *kind)
    }

    fn row(self) -> Option<&'static (Self, &'static str, &'static str)> {
        FEATURES.iter().find(|(kind, _, _)| *kind == self)
    }

    /// As the lab file spells it: `settling_time_2_percent_s`.
    pub fn as_str(self) -> &'static str {
        self.row().map_or("", |(_, name, _)| name)
    }

    /// As the path of a computed value ends, which tells the value of a peak from its time: `peak_value`.
    pub fn path_name(self) -> &'static str {
        match self {
            Self::Peak => "peak_value",
            other => other.as_str(),
        }
    }

    /// To stand in a sentence: `the settling time to within 2 %`.
    pub fn words(self) -> &'static str {
        self.row().map_or("", |(_, _, words)| words)
    }

    /// The unit it is computed in; `output` is that of the response.
    pub fn unit(self, output: Option<&Unit>) -> Option<Unit> {
        match self {
            Self::InitialValue | Self::FinalValue | Self::Peak | Self::DcGain => output.cloned(),
            Self::DampingRatio => Some(Unit::one()),
            Self::NaturalFrequencyRadS | Self::DampedFrequencyRadS => Unit::parse("rad/s"),
            Self::OvershootPercent => Unit::parse("%"),
            Self::PeakTimeS
            | Self::PeriodS
            | Self::SettlingTime2PercentS
            | Self::SettlingTime5PercentS
            | Self::RiseTime1090S
            | Self::RiseTime0100S => Unit::parse("s"),
        }
    }

    /// Whether it is a value of the output, and not a time or a ratio.
    pub fn is_output(self) -> bool {
        matches!(self, Self::InitialValue | Self::FinalValue | Self::Peak)
    }

    /// Whether textbooks read it off in more than one way.
    pub fn has_conventions(self) -> bool {
        matches!(
            self,
            Self::NaturalFrequencyRadS
                | Self::DampedFrequencyRadS
                | Self::SettlingTime2PercentS
                | Self::SettlingTime5PercentS
                | Self::RiseTime1090S
                | Self::RiseTime0100S
        )
    }

    /// Whether only step responses have it.
    pub fn is_of_steps(self) -> bool {
        matches!(self, Self::OvershootPercent | Self::RiseTime1090S | Self::RiseTime0100S)
    }
}
