use super::Evidence;
use super::accepted::{Accepted, also};
use super::closeness::{Closeness, Expected, percent};
use super::mark::{Mark, share};
use crate::algebra::{Rational, from_f64, significant, to_f64};
use crate::lab::{AskedFeature, AskedRest, FeatureKind, Points, Tolerance};
use crate::lti::{Features, Limit};
use crate::submission::{Decimal, FinalValue, Unit, UnitRatio};

/// What a feature computed in floating point may be off by, as a part of itself,
const COMPUTED_TO: f64 = 1e-9;
/// and as a part of the response's largest value (its slowest time constant, for a time): what is left of a zero.
const RESIDUE: f64 = 1e-11;

/// What a feature is.
#[derive(Clone, Debug, PartialEq)]
enum Truth {
    Number(Expected),
    PlusInfinity,
    MinusInfinity,
    /// Swings for ever, bounded or growing: there is no limit, and no side it goes to.
    NoLimit,
    /// The response has no such feature (no peak, no period).
    None,
}

/// In the unit the feature is computed in.
fn truth(features: &Features, kind: FeatureKind) -> Truth {
    let finite = |size: f64| if size.is_finite() { size.abs() } else { 0.0 };
    let mut known: Vec<f64> = features.extrema.iter().map(|extremum| extremum.value).collect();
    known.extend(features.peak.map(|peak| peak.value));
    known.push(features.initial_value);
    let swings = known.iter().copied().map(finite).fold(0.0, f64::max);
    // A response that grows has no largest value: what is left of its zeros is that of numbers about 1.
    let residue = if features.peak.is_some() { swings } else { swings.max(1.0) };
    let largest = match features.final_value {
        Limit::Value(value) => swings.max(finite(value)),
        _ => swings,
    };
    let slowest = features.slowest_time_constant_s.map_or(0.0, finite);
    // What is left of a zero, and what the value is large or small beside.
    let beside = |value: f64, residue: f64, scale: f64| {
        let bound = COMPUTED_TO * value.abs() + RESIDUE * residue;
        Expected::beside(value, bound, scale).map_or(Truth::None, Truth::Number)
    };
    let number = |value: f64| beside(value, residue, largest);
    let optional =
        |value: Option<f64>, scale: f64| value.map_or(Truth::None, |value| beside(value, scale, scale));
    match kind {
        FeatureKind::InitialValue => number(features.initial_value),
        FeatureKind::FinalValue => match features.final_value {
            Limit::Value(value) => number(value),
            Limit::PlusInfinity => Truth::PlusInfinity,
            Limit::MinusInfinity => Truth::MinusInfinity,
            Limit::Oscillates | Limit::OscillatesUnbounded => Truth::NoLimit,
        },
        FeatureKind::Peak => features.peak.map_or(Truth::None, |peak| number(peak.value)),
        FeatureKind::PeakTimeS => optional(features.peak.map(|peak| peak.time_s), slowest),
        FeatureKind::PeriodS => optional(features.period_s, slowest),
        FeatureKind::DampingRatio => optional(features.damping_ratio, 1.0),
        FeatureKind::NaturalFrequencyRadS => optional(features.natural_frequency_rad_s, 0.0),
        FeatureKind::DampedFrequencyRadS => optional(features.damped_frequency_rad_s(), 0.0),
        FeatureKind::SettlingTime2PercentS => optional(features.settling_time_2_percent_s, slowest),
        FeatureKind::SettlingTime5PercentS => optional(features.settling_time_5_percent_s, slowest),
        FeatureKind::OvershootPercent => optional(features.overshoot_percent, 100.0),
        FeatureKind::RiseTime1090S => optional(features.rise_time_10_90_s, slowest),
        FeatureKind::RiseTime0100S => optional(features.rise_time_0_100_s, slowest),
        FeatureKind::DcGain => optional(features.dc_gain, 0.0),
    }
}

/// What is read off as well where the response lies at a line that the definition draws, and why; in the unit of the feature.
fn at_the_line(features: &Features, kind: FeatureKind) -> (Vec<Expected>, &'static str) {
    let known = &features.borderline;
    let only = |value: f64| (value, value);
    let values: Vec<(f64, f64)> = match kind {
        FeatureKind::Peak => known.peaks.iter().map(|extremum| only(extremum.value)).collect(),
        FeatureKind::PeakTimeS => known.peaks.iter().map(|extremum| only(extremum.time_s)).collect(),
        FeatureKind::SettlingTime2PercentS => known.settling_times_2_percent_s.clone(),
        FeatureKind::SettlingTime5PercentS => known.settling_times_5_percent_s.clone(),
        FeatureKind::RiseTime1090S => known.rise_time_10_90_s.into_iter().map(only).collect(),
        _ => Vec::new(),
    };
    let why = match kind {
        FeatureKind::Peak | FeatureKind::PeakTimeS => "another swing is as high to within 0.1 %",
        FeatureKind::RiseTime1090S => "the response starts at 10 % of its final value to within 0.1 %",
        _ => "a swing touches the edge of the band to within 1 % of it",
    };
    let expected = |(from, to): (f64, f64)| {
        Expected::computed((from + to) / 2.0, (to - from) / 2.0 + COMPUTED_TO * to.abs())
    };
    (values.into_iter().filter_map(expected).collect(), why)
}

/// Whether it may also be said that there is none.
fn hardly_any(features: &Features, kind: FeatureKind) -> bool {
    use FeatureKind::*;
    match kind {
        Peak | PeakTimeS | RiseTime0100S => features.borderline.hardly_a_peak,
        RiseTime1090S => features.borderline.rise_time_10_90_s.is_some(),
        OvershootPercent => features.overshoot_percent.is_some_and(|percent| percent <= 0.1),
        _ => false,
    }
}

/// What textbooks also give under the same name, in words and in the unit of the feature.
fn other_conventions(features: &Features, kind: FeatureKind) -> Vec<(&'static str, Expected)> {
    use FeatureKind::*;
    let other = |kind: FeatureKind| match truth(features, kind) {
        Truth::Number(expected) => Some((kind.words(), expected)),
        _ => None,
    };
    let time_constants = |count: f64, words| {
        let time = features.slowest_time_constant_s? * count;
        Some((words, Expected::computed(time, COMPUTED_TO * time)?))
    };
    let all = match kind {
        SettlingTime2PercentS | SettlingTime5PercentS => {
            let read_off =
                if kind == SettlingTime2PercentS { SettlingTime5PercentS } else { SettlingTime2PercentS };
            let four =
                || time_constants(4.0, "four time constants, an estimate of the settling time to within 2 %");
            let three = || {
                time_constants(3.0, "three time constants, an estimate of the settling time to within 5 %")
            };
            vec![other(read_off), four(), three()]
        }
        RiseTime1090S => vec![other(RiseTime0100S)],
        RiseTime0100S => vec![other(RiseTime1090S)],
        NaturalFrequencyRadS => vec![other(DampedFrequencyRadS)],
        DampedFrequencyRadS => vec![other(NaturalFrequencyRadS)],
        _ => Vec::new(),
    };
    all.into_iter().flatten().collect()
}

/// What is right of a value by one accepted set of parameter values, in the unit it is computed in.
struct Wanted {
    truth: Truth,
    /// What textbooks also give under the same name.
    others: Vec<(&'static str, Expected)>,
    /// What is read off as well, and why.
    as_well: (Vec<Expected>, &'static str),
    /// Whether it may also be said that there is none.
    hardly_any: bool,
}

impl Wanted {
    fn feature(features: &Features, kind: FeatureKind) -> Self {
        Self {
            truth: truth(features, kind),
            others: other_conventions(features, kind),
            as_well: at_the_line(features, kind),
            hardly_any: hardly_any(features, kind),
        }
    }

    fn rest(value: &Rational) -> Self {
        let size = if *value < Rational::ZERO { -value.clone() } else { value.clone() };
        let error_bound = from_f64(COMPUTED_TO).unwrap_or(Rational::ZERO) * size;
        Self {
            truth: Truth::Number(Expected { value: value.clone(), error_bound, scale: Rational::ZERO }),
            others: Vec::new(),
            as_well: (Vec::new(), ""),
            hardly_any: false,
        }
    }
}

/// A value as it is asked for: what, in which unit, and how near.
struct Question<'a> {
    /// To stand in a sentence: `the overshoot`.
    what: &'a str,
    unit: Option<&'a Unit>,
    /// Units that may stand behind the same number.
    also: &'a [Unit],
    tolerance: &'a Tolerance,
    /// How much of the unit asked for is one of the unit it is computed in.
    ratio: UnitRatio,
}

impl<'a> Question<'a> {
    fn feature(feature: &'a AskedFeature, tolerance: &'a Tolerance) -> Self {
        let ratio = match (&feature.native, &feature.unit) {
            (Some(native), Some(asked)) => native.in_unit(asked),
            _ => None,
        };
        Self {
            what: feature.kind.words(),
            unit: feature.unit.as_ref(),
            also: &feature.also,
            tolerance,
            ratio: ratio.unwrap_or_else(UnitRatio::one),
        }
    }

    fn rest(asked: &'a AskedRest, tolerance: &'a Tolerance) -> Self {
        Self { what: &asked.signal, unit: asked.unit.as_ref(), also: &[], tolerance, ratio: asked.ratio() }
    }

    /// In the unit asked for.
    fn truth(&self, wanted: &Wanted) -> Truth {
        match &wanted.truth {
            Truth::Number(expected) => Truth::Number(expected.in_unit(&self.ratio)),
            other => other.clone(),
        }
    }

    /// ` Or 3.2 s, since …`, or nothing.
    fn other_readings(&self, wanted: &Wanted) -> String {
        let (values, why) = &wanted.as_well;
        let shown = values.iter().map(|value| self.shown(&value.in_unit(&self.ratio)));
        // Some of many swings stand for all.
        let shown: Vec<String> = shown.take(3).collect();
        match (shown.as_slice(), wanted.hardly_any) {
            ([], false) => String::new(),
            ([], true) => " Or none, for it is less than 0.1 % of the final value.".to_owned(),
            (values, _) => format!(" Or {}, since {why}.", values.join(" or ")),
        }
    }

    fn unit(&self) -> &str {
        self.unit.map_or("", Unit::symbol)
    }

    fn shown(&self, expected: &Expected) -> String {
        with_unit(&expected.shown(self.tolerance), self.unit())
    }

    /// How near a number is that was typed in a unit of which one is `ratio` of the unit asked for.
    fn closeness(&self, expected: &Expected, typed: &Decimal, ratio: &UnitRatio) -> Closeness {
        let back = ratio.inverse();
        let (factor, bound) = back.value();
        let here = expected.stated(self.tolerance);
        let absolute = &here.absolute * (factor + bound);
        expected.in_unit(&back).closeness(typed, &Tolerance { absolute, ..here })
    }
}

/// What is expected of a feature, in words.
pub(super) fn expected(
    accepted: &[Accepted<'_, Features>],
    feature: &AskedFeature,
    tolerance: &Tolerance,
) -> String {
    with_wanted(
        accepted,
        |features| Wanted::feature(features, feature.kind),
        |accepted| Question::feature(feature, tolerance).expected(accepted),
    )
}

/// The feature typed against each accepted one, the best of them.
pub(super) fn judge(
    points: Points,
    accepted: &[Accepted<'_, Features>],
    feature: &AskedFeature,
    tolerance: &Tolerance,
    typed: &FinalValue,
) -> Mark {
    with_wanted(
        accepted,
        |features| Wanted::feature(features, feature.kind),
        |accepted| {
            Question::feature(feature, tolerance).judge(points, accepted, typed, &feature.other_convention)
        },
    )
}

/// What is expected of a value at rest, in words.
pub(super) fn expected_at_rest(
    accepted: &[Accepted<'_, Rational>],
    asked: &AskedRest,
    tolerance: &Tolerance,
) -> String {
    with_wanted(accepted, Wanted::rest, |accepted| Question::rest(asked, tolerance).expected(accepted))
}

/// The value at rest typed against each accepted one, the best of them.
pub(super) fn judge_at_rest(
    points: Points,
    accepted: &[Accepted<'_, Rational>],
    asked: &AskedRest,
    tolerance: &Tolerance,
    typed: &FinalValue,
) -> Mark {
    with_wanted(accepted, Wanted::rest, |accepted| {
        Question::rest(asked, tolerance).judge(points, accepted, typed, &Rational::ZERO)
    })
}

/// What `of` makes of the accepted ones, handed to `then`.
fn with_wanted<T, R>(
    accepted: &[Accepted<'_, T>],
    of: impl Fn(&T) -> Wanted,
    then: impl FnOnce(&[Accepted<'_, Wanted>]) -> R,
) -> R {
    let wanted: Vec<Wanted> = accepted.iter().map(|one| of(one.what)).collect();
    let pairs = accepted.iter().zip(&wanted);
    let accepted: Vec<_> = pairs.map(|(one, what)| Accepted { differs: one.differs, what }).collect();
    then(&accepted)
}

impl Question<'_> {
    fn expected(&self, accepted: &[Accepted<'_, Wanted>]) -> String {
        let Some(main) = accepted.first() else { return String::new() };
        match self.truth(main.what) {
            Truth::Number(expected) => {
                let own = self.shown(&expected);
                let same = |one: &Accepted<'_, Wanted>| match self.truth(one.what) {
                    Truth::Number(expected) => self.shown(&expected) == own,
                    _ => false,
                };
                let others = if accepted.iter().all(same) { String::new() } else { also(accepted) };
                let either = self.other_readings(main.what);
                format!("{own}; {}.{either}{others}", expected.accepted_in_words(self.tolerance, self.unit()))
            }
            Truth::PlusInfinity => "It grows without bound, to +∞.".to_owned(),
            Truth::MinusInfinity => "It grows without bound, to -∞.".to_owned(),
            Truth::NoLimit => "There is none: the response swings for ever.".to_owned(),
            Truth::None => "There is none: the response has no such value.".to_owned(),
        }
    }

    /// `other_convention`: what part of the points is left by what is right under another convention.
    fn judge(
        &self,
        points: Points,
        accepted: &[Accepted<'_, Wanted>],
        typed: &FinalValue,
        other_convention: &Rational,
    ) -> Mark {
        let found = match typed {
            FinalValue::Unbounded => "unbounded, or no such value".to_owned(),
            other => other.read_as(),
        };
        let expected = self.expected(accepted);
        let mut best: Option<Outcome> = None;
        for one in accepted {
            let outcome = self.compare(one, typed);
            if best.as_ref().is_none_or(|known| outcome.rank() > known.rank()) {
                best = Some(outcome);
            }
        }
        let Some(Outcome { code, reason }) = best else {
            return Mark::unmarked(expected, found, "There is no reference to compare this with.");
        };
        let evidence = Evidence { expected, found, reason, ..Evidence::default() };
        let left = match code {
            "value.other_convention" => share(points, other_convention),
            _ => Points::ZERO,
        };
        match code {
            "right" => Mark::right(points, evidence),
            code if left == Points::ZERO => Mark::wrong(code, evidence),
            code if left == points => Mark { code, ..Mark::right(points, evidence) },
            code => Mark::partly(code, left, evidence),
        }
    }
}

struct Outcome {
    code: &'static str,
    reason: String,
}

impl Outcome {
    fn new(code: &'static str, reason: impl Into<String>) -> Self {
        Self { code, reason: reason.into() }
    }

    /// The most telling one of several is shown.
    fn rank(&self) -> u8 {
        match self.code {
            "right" => 4,
            "value.other_convention" => 3,
            "value.sign" => 2,
            "value.other_unit" => 1,
            _ => 0,
        }
    }
}

/// How a typed number is to be read in the unit asked for.
enum Scale {
    /// One of the typed unit is so many of the unit asked for. The likelier first.
    Known(Vec<UnitRatio>),
    /// It measures something else.
    OtherQuantity,
}

impl Question<'_> {
    fn compare(&self, one: &Accepted<'_, Wanted>, typed: &FinalValue) -> Outcome {
        match (self.truth(one.what), typed) {
            (Truth::Number(want), FinalValue::Number(have, unit)) => {
                self.compare_numbers(&want, one, have, unit.as_ref())
            }
            (Truth::Number(_), FinalValue::Unbounded) if one.what.hardly_any => {
                Outcome::new("right", "There is hardly any such value, and one may say that there is none.")
            }
            (Truth::Number(want), _) => {
                let reason =
                    format!("The value is a number, {}: it does not grow without bound.", self.shown(&want));
                Outcome::new("value.number_given_unbounded", reason)
            }
            (Truth::PlusInfinity | Truth::MinusInfinity, FinalValue::Unbounded)
            | (Truth::PlusInfinity, FinalValue::PlusInfinity)
            | (Truth::MinusInfinity, FinalValue::MinusInfinity) => {
                Outcome::new("right", "It grows without bound.")
            }
            (Truth::PlusInfinity | Truth::MinusInfinity, FinalValue::Number(..)) => Outcome::new(
                "value.unbounded_given_number",
                "It grows without bound, so no number is its value.",
            ),
            (Truth::PlusInfinity, _) => Outcome::new("value.sign", "It grows without bound, but to +∞."),
            (Truth::MinusInfinity, _) => Outcome::new("value.sign", "It grows without bound, but to -∞."),
            (Truth::NoLimit | Truth::None, FinalValue::Unbounded) => {
                Outcome::new("right", "There is no such value.")
            }
            (Truth::NoLimit, FinalValue::Number(..)) => Outcome::new(
                "value.unbounded_given_number",
                "The response swings for ever, so no number is its limit.",
            ),
            (Truth::NoLimit, _) => {
                Outcome::new("value.sign", "The response swings for ever and goes to neither side.")
            }
            (Truth::None, FinalValue::Number(have, unit)) => self
                .at_the_line(one, have, unit.as_ref())
                .unwrap_or_else(|| Outcome::new("value.none", "The response has no such value.")),
            (Truth::None, _) => Outcome::new("value.none", "The response has no such value."),
        }
    }

    /// How the unit typed, if any, stands to the one asked for.
    fn scale(&self, typed: Option<&Unit>) -> Scale {
        let Some(typed) = typed else { return Scale::Known(vec![UnitRatio::one()]) };
        let Some(asked) = self.unit else {
            // The lab does not say what the output is measured in: as it stands, or in SI.
            return Scale::Known([UnitRatio::one()].into_iter().chain(typed.in_si()).collect());
        };
        if !asked.is_known() || !typed.is_known() {
            return Scale::Known(vec![UnitRatio::one()]);
        }
        let found = [asked].into_iter().chain(self.also).find_map(|unit| typed.in_unit(unit));
        found.map_or(Scale::OtherQuantity, |ratio| Scale::Known(vec![ratio]))
    }

    /// Right where another reading is as good.
    fn at_the_line(
        &self,
        one: &Accepted<'_, Wanted>,
        have: &Decimal,
        unit: Option<&Unit>,
    ) -> Option<Outcome> {
        let (values, why) = &one.what.as_well;
        let Scale::Known(ratios) = self.scale(unit) else { return None };
        let value = values
            .iter()
            .map(|value| value.in_unit(&self.ratio))
            .find(|value| ratios.iter().any(|ratio| self.closeness(value, have, ratio).accepted()))?;
        let (shown, with) = (self.shown(&value), one.with());
        Some(Outcome::new("right", format!("It is {shown}{with}, which is as good a reading, since {why}.")))
    }

    fn compare_numbers(
        &self,
        want: &Expected,
        one: &Accepted<'_, Wanted>,
        have: &Decimal,
        unit: Option<&Unit>,
    ) -> Outcome {
        let with = one.with();
        let expected = self.shown(want);
        let symbol = unit.map_or("", Unit::symbol);
        let typed = with_unit(&have.text, symbol);
        let ratios = match self.scale(unit) {
            Scale::Known(ratios) => ratios,
            // Nothing is nothing, whatever it is measured in.
            Scale::OtherQuantity if have.is_zero() => vec![UnitRatio::one()],
            Scale::OtherQuantity => return self.other_quantity(want, have, unit),
        };
        for ratio in &ratios {
            let how = match self.closeness(want, have, ratio) {
                Closeness::Within => format!("within the tolerance of {expected}{with}"),
                Closeness::Rounded => format!("{expected}{with}, correctly rounded"),
                Closeness::Off => continue,
            };
            let reason = if *ratio == UnitRatio::one() {
                format!("It is {how}.")
            } else {
                format!("{typed} is {}: it is {how}.", self.converted(have, ratio))
            };
            return Outcome::new("right", reason);
        }
        if let Some(outcome) = self.at_the_line(one, have, unit) {
            return outcome;
        }
        let is_nothing = want.shown(self.tolerance) == "0";
        let negative = Expected { value: -want.value.clone(), ..want.clone() };
        for ratio in &ratios {
            if !is_nothing && self.closeness(&negative, have, ratio).accepted() {
                let reason = format!("The size is right, the sign is not: {expected} was expected.");
                return Outcome::new("value.sign", reason);
            }
            for (words, other) in &one.what.others {
                if self.closeness(&other.in_unit(&self.ratio), have, ratio).accepted() {
                    let asked = self.what;
                    let reason = format!("{typed} is {words}; {asked} was asked, and that is {expected}.");
                    return Outcome::new("value.other_convention", reason);
                }
            }
        }
        if let Some(reason) = self.other_unit(want, have, unit) {
            return Outcome::new("value.other_unit", reason);
        }
        let off = ratios.first().map(|ratio| {
            let (factor, _) = ratio.value();
            &have.value * factor - &want.value
        });
        let by = off.filter(|_| !is_nothing);
        let reason = match by {
            Some(off) => {
                let part = off / &want.value;
                let size = if part < Rational::ZERO { -part } else { part };
                format!("It is off by {}: {expected} was expected.", percent(&size))
            }
            None => format!("{expected} was expected."),
        };
        Outcome::new("value.differs", reason)
    }

    /// The number as it is in the unit asked for: `5.5857 rad/s`.
    fn converted(&self, typed: &Decimal, ratio: &UnitRatio) -> String {
        let (factor, _) = ratio.value();
        with_unit(&significant(to_f64(&(&typed.value * factor)), 5), self.unit())
    }

    /// Why the number is right in a unit that was neither asked for nor typed; `None` when it is in none.
    fn other_unit(&self, want: &Expected, have: &Decimal, typed: Option<&Unit>) -> Option<String> {
        let asked = self.unit?;
        let written = typed.unwrap_or(asked);
        // A width that belongs to zero would make much of small numbers.
        let tolerance = Tolerance { absolute: Rational::ZERO, ..self.tolerance.clone() };
        let strict = Question { tolerance: &tolerance, ratio: self.ratio.clone(), ..*self };
        let units = [asked.clone()].into_iter().chain(asked.others());
        let meant = units.filter(|unit| unit.in_unit(written) != Some(UnitRatio::one())).find(|unit| {
            unit.in_unit(asked).is_some_and(|ratio| strict.closeness(want, have, &ratio).accepted())
        })?;
        let number = &have.text;
        let shown = self.shown(want);
        let is = match meant.symbol() {
            "" => format!("{number} is the value as a ratio"),
            symbol => format!("{number} is the value in {symbol}"),
        };
        let asked = self.unit();
        Some(match (typed, asked) {
            (Some(typed), _) => {
                format!("{is}, but {} was written behind it; {shown} was expected.", typed.symbol())
            }
            (_, "") => format!("{is}; it was asked as a pure number, {shown}."),
            _ => format!("{is}; it was asked in {asked}, where it is {shown}."),
        })
    }

    fn other_quantity(&self, want: &Expected, have: &Decimal, unit: Option<&Unit>) -> Outcome {
        let Some((typed, asked)) = unit.zip(self.unit) else {
            return Outcome::new("value.unit", format!("{} was expected.", self.shown(want)));
        };
        let number = if self.closeness(want, have, &UnitRatio::one()).accepted() {
            "The number is right, but its unit is not: "
        } else {
            ""
        };
        let measures = format!("{} is a unit of {}", typed.symbol(), without_article(typed.quantity()));
        let reason = match asked.symbol() {
            "" => format!("{number}{measures}, and a pure number was asked, {}.", self.shown(want)),
            symbol => format!(
                "{number}{measures}, and {} in {symbol} was asked, {}.",
                asked.quantity(),
                self.shown(want)
            ),
        };
        Outcome::new("value.unit", reason)
    }
}

fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" => number.to_owned(),
        unit => format!("{number} {unit}"),
    }
}

fn without_article(quantity: &str) -> &str {
    quantity.strip_prefix("a ").or_else(|| quantity.strip_prefix("an ")).unwrap_or(quantity)
}

#[cfg(test)]
mod tests {
    use super::super::closeness::tests::{tolerance, typed, usual};
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal};
    use crate::grading::Verdict;
    use crate::lti::{Extremum, InputKind, Response, TransferFunction};

    /// A response with the features given, the others those of e^(-t).
    fn features(initial_value: f64, final_value: Limit) -> Features {
        let first_order =
            TransferFunction::new(Polynomial::one(), Polynomial::from_integers(&[1, 1])).unwrap();
        let decay = Features::of(&Response::new(&first_order, InputKind::Impulse).unwrap());
        let peak = Some(Extremum { time_s: 1.0, value: -0.73 });
        Features { initial_value, final_value, peak, period_s: Some(1.1246), ..decay }
    }

    /// As a lab asks for it whose output is in rad and whose input is in N.
    fn asked(kind: FeatureKind) -> AskedFeature {
        asked_in(kind, None)
    }

    fn asked_in(kind: FeatureKind, unit: Option<&str>) -> AskedFeature {
        let native = kind.unit(Unit::parse("rad").as_ref());
        let per_push = ["rad/N", "rad/(N s)"].map(|text| Unit::parse(text).unwrap());
        let unit = unit.map(|text| if text == "1" { Unit::one() } else { Unit::parse(text).unwrap() });
        let also = if kind.is_output() { per_push.into() } else { Vec::new() };
        AskedFeature {
            kind,
            unit: unit.or_else(|| native.clone()),
            native,
            also,
            other_convention: Rational::ZERO,
        }
    }

    #[track_caller]
    fn check(rows: &[(FeatureKind, f64, Limit, FinalValue, &str)]) {
        for (feature, initial, limit, answer, code) in rows {
            let features = features(*initial, *limit);
            let accepted = [Accepted { differs: &[], what: &features }];
            let tolerance = tolerance("0.001", "0.01", Some(2));
            let mark = judge(Points(50), &accepted, &asked(*feature), &tolerance, answer);
            assert_eq!(mark.code, *code, "{feature:?} {limit:?} {answer:?}: {}", mark.evidence.reason);
            assert_eq!(mark.earned, if *code == "right" { Points(50) } else { Points::ZERO });
        }
    }

    /// What is typed of the step response of `num` over `den`; `None`: that there is no such value.
    #[track_caller]
    fn check_step(num: &str, den: &str, kind: FeatureKind, rows: &[(Option<&str>, &str)]) {
        let polynomial =
            |text: &str| Polynomial::new(text.split(' ').map(|c| parse_decimal(c).unwrap()).collect());
        let g = TransferFunction::new(polynomial(num), polynomial(den)).unwrap();
        let features = Features::of(&Response::new(&g, InputKind::Step).unwrap());
        let accepted = [Accepted { differs: &[], what: &features }];
        for (text, code) in rows {
            let answer = text.map_or(FinalValue::Unbounded, |text| FinalValue::Number(typed(text), None));
            let mark =
                judge(Points(50), &accepted, &asked(kind), &tolerance("0.001", "0.01", Some(2)), &answer);
            assert_eq!(mark.code, *code, "{den}: {kind:?} {text:?}: {:?}", mark.evidence);
        }
    }

    /// A thousandth of a second or of a unit is nothing to go by where everything is small or fast.
    #[test]
    fn the_usual_tolerance_of_small_values() {
        use FeatureKind::*;
        for (num, den, kind, right, wrong) in [
            // 1/(1e-4 s + 1)
            ("1", "0.0001 1", SettlingTime2PercentS, "0.000391", &["0", "0.001", "-0.0004", "0.00043"][..]),
            ("1", "0.0001 1", RiseTime1090S, "0.00022", &["0", "0.0005"]),
            ("0.0001", "1 1", DcGain, "0.0001", &["0", "-0.0001", "0.0002", "0.001"]),
            ("0.0001", "1 1", FinalValue, "0.0001", &["0", "-0.0001", "0.00011"]),
            // zeros: beside a largest value of 0.0001, and of 1
            ("0.0001", "1 1", InitialValue, "0.0000001", &["0.000001", "0.0001"]),
            ("1", "1 1", InitialValue, "0.001", &["0.0011"]),
        ] {
            let polynomial =
                |text: &str| Polynomial::new(text.split(' ').map(|c| parse_decimal(c).unwrap()).collect());
            let g = TransferFunction::new(polynomial(num), polynomial(den)).unwrap();
            let known = Features::of(&Response::new(&g, InputKind::Step).unwrap());
            let features = Features { dc_gain: Some(1e-4), ..known };
            let accepted = [Accepted { differs: &[], what: &features }];
            for text in wrong.iter().chain([&right]) {
                let answer = super::FinalValue::Number(typed(text), None);
                let mark = judge(Points(50), &accepted, &asked(kind), &usual(), &answer);
                assert_eq!(
                    mark.code == "right",
                    *text == right,
                    "{den}: {kind:?} {text}: {:?}",
                    mark.evidence
                );
            }
        }
    }

    /// Where a definition draws a line, a right answer on the other side of it is right.
    #[test]
    fn at_a_line_both_readings_are_right() {
        use FeatureKind::*;
        // Overshoot 4.999 % and 5.001 %: settled to 5 % at the first passage (2.85 s) or after the swing (4.7 s).
        for zeta2 in ["1.3804", "1.38"] {
            let rows = [
                (Some("2.86"), "right"),
                (Some("4.34"), "right"),
                (Some("4.48"), "right"),
                (Some("3.7"), "value.differs"),
            ];
            check_step("1", &format!("1 {zeta2} 1"), SettlingTime5PercentS, &rows);
        }
        check_step("1", "1 1.2 1", SettlingTime5PercentS, &[(Some("2.37"), "value.differs")]);
        // ζ = 0.95: an overshoot of 0.007 %.
        check_step(
            "1",
            "1 1.9 1",
            Peak,
            &[(None, "right"), (Some("1"), "right"), (Some("1.1"), "value.differs")],
        );
        // No overshoot may be said as 0 % or as none.
        check_step(
            "1",
            "1 3 1",
            OvershootPercent,
            &[(None, "right"), (Some("0"), "right"), (Some("5"), "value.differs")],
        );
        check_step("1", "1 0.4 1", OvershootPercent, &[(None, "value.number_given_unbounded")]);
        check_step("1", "1 1.9 1", RiseTime0100S, &[(None, "right"), (Some("3"), "value.differs")]);
        check_step("1", "1 0.4 1", Peak, &[(None, "value.number_given_unbounded"), (Some("1.53"), "right")]);
        // It starts at 10 %: ln 9 s from there.
        for start in ["0.09999", "0.1", "0.10001"] {
            let rows = [(None, "right"), (Some("2.2"), "right")];
            check_step(&format!("{start} 1"), "1 1", RiseTime1090S, &rows);
        }
        check_step("0.2 1", "1 1", RiseTime1090S, &[(None, "right"), (Some("2.08"), "value.none")]);
    }

    #[test]
    fn numbers_and_limits() {
        use super::FinalValue as Answer;
        use super::FinalValue::{MinusInfinity as Minus, PlusInfinity as Plus, Unbounded};
        use FeatureKind::*;
        let number = |text| Answer::Number(typed(text), None);
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
            // What rounding left of a zero moves no end.
            (InitialValue, -1e-17, at_zero, number("0.001"), "right"),
            (InitialValue, 1e-17, at_zero, number("-0.001"), "right"),
            (InitialValue, 0.0, at_zero, number("0.0010001"), "value.differs"),
        ]);
    }

    fn judged(features: &[&Features], asked: &AskedFeature, text: &str, unit: Option<&str>) -> Mark {
        let g = parse_decimal("9.8").unwrap();
        let differs = [("g".to_owned(), "9.8".to_owned(), g)];
        let accepted: Vec<_> = features
            .iter()
            .enumerate()
            .map(|(i, what)| Accepted { differs: if i == 0 { &[] } else { &differs }, what: *what })
            .collect();
        let unit = unit.map(|unit| Unit::parse(unit).unwrap_or_else(|| Unit::named(unit)));
        let answer = FinalValue::Number(Decimal::parse(text).unwrap(), unit);
        judge(Points(50), &accepted, asked, &tolerance("0.001", "0.01", Some(2)), &answer)
    }

    /// Angles by π, exactly: 30° is 0.5235987…
    #[test]
    fn degrees_and_radians() {
        let angle = features(-std::f64::consts::PI / 6.0, Limit::Value(0.0));
        for (text, unit, code) in [
            ("-0.5236", None, "right"),
            ("-30", Some("deg"), "right"),
            ("-30.3", Some("deg"), "right"),
            ("-30.31", Some("deg"), "value.differs"),
            ("-29.7", Some("deg"), "right"),
            ("-29.69", Some("deg"), "value.differs"),
            ("30", Some("deg"), "value.sign"),
            ("-30", None, "value.other_unit"),
            ("-523.6", Some("mrad"), "right"),
            ("-0.08333", Some("rev"), "right"),
            ("-30", Some("rad"), "value.other_unit"),
            ("-0.5236", Some("deg"), "value.other_unit"),
            ("-0.5236", Some("rad/(N·s)"), "right"),
            ("-30", Some("deg/N"), "right"),
            ("-0.5236", Some("m"), "value.unit"),
            ("-0.5236", Some("%"), "value.unit"),
            ("0", Some("m"), "value.differs"),
        ] {
            let mark = judged(&[&angle], &asked(FeatureKind::InitialValue), text, unit);
            assert_eq!(mark.code, code, "{text} {unit:?}: {}", mark.evidence.reason);
        }
        let in_degrees = asked_in(FeatureKind::InitialValue, Some("deg"));
        for (text, unit, code) in
            [("-30", None, "right"), ("-0.5236", None, "value.other_unit"), ("-0.5236", Some("rad"), "right")]
        {
            let mark = judged(&[&angle], &in_degrees, text, unit);
            assert_eq!(mark.code, code, "{text} {unit:?}: {}", mark.evidence.reason);
        }
        let expected = judged(&[&angle], &in_degrees, "1", None).evidence.expected;
        assert_eq!(
            expected,
            "-30 deg; accepted from -30.3 to -29.7 deg (1 %), or the value correctly rounded to at least 2 figures."
        );
    }

    /// Where the lab does not say what its output is measured in, or in a unit of its own.
    #[test]
    fn units_nobody_knows() {
        let level = features(0.25, Limit::Value(0.0));
        let unsaid =
            AskedFeature { unit: None, native: None, also: Vec::new(), ..asked(FeatureKind::InitialValue) };
        let counts = Some(Unit::named("counts"));
        let own = AskedFeature { unit: counts.clone(), native: counts, ..unsaid.clone() };
        for (asked, text, unit, code) in [
            (&unsaid, "0.25", None, "right"),
            (&unsaid, "0.25", Some("V"), "right"),
            (&unsaid, "25", Some("cm"), "right"),
            (&unsaid, "0.25", Some("cm"), "right"),
            (&unsaid, "2.5", Some("cm"), "value.differs"),
            (&own, "0.25", None, "right"),
            (&own, "0.25", Some("counts"), "right"),
            (&own, "0.25", Some("V"), "right"),
            (&own, "25", None, "value.differs"),
        ] {
            let mark = judged(&[&level], asked, text, unit);
            assert_eq!(mark.code, code, "{text} {unit:?}: {}", mark.evidence.reason);
        }
    }

    /// The kindest of the accepted sets counts, and the most telling of the reasons is given.
    #[test]
    fn several_accepted_sets() {
        let (main, other) = (features(2.0, Limit::Value(0.0)), features(3.0, Limit::Value(0.0)));
        for (text, code, reason) in [
            ("2", "right", "It is within the tolerance of 2 rad."),
            ("3", "right", "It is within the tolerance of 3 rad with g = 9.8."),
            ("-3", "value.sign", "The size is right, the sign is not: 3 rad was expected."),
            (
                "171.9",
                "value.other_unit",
                "171.9 is the value in deg; it was asked in rad, where it is 3 rad.",
            ),
            ("2.5", "value.differs", "It is off by 25 %: 2 rad was expected."),
        ] {
            let mark = judged(&[&main, &other], &asked(FeatureKind::InitialValue), text, None);
            assert_eq!((mark.code, mark.evidence.reason.as_str()), (code, reason), "{text}");
            assert!(mark.evidence.expected.ends_with("Also right with g = 9.8."));
        }
    }

    /// The lab's part of the points, and whose verdict it is.
    #[test]
    fn what_the_other_convention_leaves() {
        let decay = features(0.0, Limit::Value(0.0));
        let five_percent = significant(decay.settling_time_5_percent_s.unwrap(), 6);
        for (part, points, verdict) in
            [("0", 0, Verdict::Wrong), ("0.5", 25, Verdict::Partly), ("1", 50, Verdict::Right)]
        {
            let part = parse_decimal(part).unwrap();
            let asked = AskedFeature { other_convention: part, ..asked(FeatureKind::SettlingTime2PercentS) };
            let mark = judged(&[&decay], &asked, &five_percent, None);
            assert_eq!(
                (mark.code, mark.earned, mark.verdict),
                ("value.other_convention", Points(points), verdict)
            );
        }
    }
}
