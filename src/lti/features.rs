use super::{InputKind, Mode, Response, settling};
use crate::algebra::significant;
use std::f64::consts::TAU;

/// Where a response goes as t → ∞.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    Value(f64),
    /// Grows without bound to one side.
    PlusInfinity,
    MinusInfinity,
    /// Oscillates for ever with bounded amplitude.
    Oscillates,
    /// Oscillates with growing amplitude.
    OscillatesUnbounded,
}

impl Limit {
    /// The stable code: `value`, `plus_infinity`, `minus_infinity`, `oscillates` or `oscillates_unbounded`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Value(_) => "value",
            Self::PlusInfinity => "plus_infinity",
            Self::MinusInfinity => "minus_infinity",
            Self::Oscillates => "oscillates",
            Self::OscillatesUnbounded => "oscillates_unbounded",
        }
    }

    /// The value to four figures, or what it does instead: `0.25`, `grows without bound`.
    pub fn words(self) -> String {
        match self {
            Self::Value(value) => significant(value, 4),
            Self::PlusInfinity => "grows without bound".to_owned(),
            Self::MinusInfinity => "falls without bound".to_owned(),
            Self::Oscillates => "oscillates for ever".to_owned(),
            Self::OscillatesUnbounded => "oscillates with growing amplitude".to_owned(),
        }
    }

    /// The final value, where there is one.
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Value(value) => Some(value),
            _ => None,
        }
    }
}

/// The general shape of a response, in the words of a textbook.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Swings about its final value with shrinking amplitude.
    DecayingOscillation,
    /// Swings with constant amplitude.
    SustainedOscillation,
    /// Swings with growing amplitude.
    GrowingOscillation,
    /// Approaches its final value without swinging about it.
    ExponentialDecay,
    /// Leaves to one side, ever faster.
    ExponentialGrowth,
    /// Grows like a power of t (a ramp, say).
    PolynomialGrowth,
    /// Stays where it is from the start.
    Constant,
}

impl Shape {
    /// The stable code, such as `decaying_oscillation`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::DecayingOscillation => "decaying_oscillation",
            Self::SustainedOscillation => "sustained_oscillation",
            Self::GrowingOscillation => "growing_oscillation",
            Self::ExponentialDecay => "exponential_decay",
            Self::ExponentialGrowth => "exponential_growth",
            Self::PolynomialGrowth => "polynomial_growth",
            Self::Constant => "constant",
        }
    }

    /// The same in plain English, to stand in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::DecayingOscillation => "a decaying oscillation",
            Self::SustainedOscillation => "a sustained oscillation",
            Self::GrowingOscillation => "a growing oscillation",
            Self::ExponentialDecay => "an exponential approach to the final value",
            Self::ExponentialGrowth => "exponential growth",
            Self::PolynomialGrowth => "growth like a power of time",
            Self::Constant => "constant",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremum {
    pub time_s: f64,
    pub value: f64,
}

/// What one reads off a response, from its closed form with bracketed extrema.
///
/// Accuracy: times and values to about 1e-12 of the time constants and of the peak. A response with more than some ten
/// thousand swings before it settles is read off its envelope instead, never too early.
#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    /// y(0⁺).
    pub initial_value: f64,
    pub final_value: Limit,
    pub shape: Shape,
    /// The extremum of largest |y|, `None` when |y| has no maximum (unbounded responses, and those that only approach it).
    pub peak: Option<Extremum>,
    /// The first few extrema in time order (at most 8); t = 0 is not one of them.
    pub extrema: Vec<Extremum>,
    /// 2π/|Im p| of the dominant (slowest-decaying) complex pair present in the response.
    pub period_s: Option<f64>,
    /// ζ and ω_n (rad/s) of that pair, or of two real poles when there are no others; ζ is negative when it grows.
    pub damping_ratio: Option<f64>,
    pub natural_frequency_rad_s: Option<f64>,
    /// −1/Re of the slowest decaying term present, s.
    pub slowest_time_constant_s: Option<f64>,
    /// Time after which |y − final| stays within 2 % and 5 % of the peak deviation, for a decaying response, located on the curve.
    pub settling_time_2_percent_s: Option<f64>,
    pub settling_time_5_percent_s: Option<f64>,
    /// How far a step response goes beyond its final value, in percent of it; 0 when it does not.
    pub overshoot_percent: Option<f64>,
    /// From 10 % to 90 % of the final value of a step response that starts below 10 %, at the first passage.
    pub rise_time_10_90_s: Option<f64>,
    /// From 0 to the first passage of the final value, for a step response that reaches it.
    pub rise_time_0_100_s: Option<f64>,
    /// What is read off as well, where the response lies at one of the lines these definitions draw.
    pub borderline: Borderline,
    /// G(0) of the transfer function behind the response, where whoever computed it has put it; `None` at a pole at the origin.
    pub dc_gain: Option<f64>,
}

/// What else is a right reading of a response at the line between two.
///
/// A swing of 1.001 % is visible by definition and one of 0.999 % is not: nobody is to be wrong for seeing it the other way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Borderline {
    /// The other shape, where what decides is within a tenth of its limit, or two terms outlast the others that hardly differ.
    pub shape: Option<Shape>,
    /// Extrema (the start among them) as high as the peak to within a thousandth, in time order.
    pub peaks: Vec<Extremum>,
    /// The peak, or the overshoot, is less than a thousandth of the final value: one may say that there is none.
    pub hardly_a_peak: bool,
    /// Where a swing touches the band to within a hundredth of it: the time of settling to 2 % and to 5 % without that swing,
    /// and with it, (from, to).
    pub settling_times_2_percent_s: Vec<(f64, f64)>,
    pub settling_times_5_percent_s: Vec<(f64, f64)>,
    /// From the start, for a step response that starts at 10 % of its final value to within a thousandth.
    pub rise_time_10_90_s: Option<f64>,
}

/// At most so many extrema are listed.
const EXTREMA_LISTED: usize = 8;
/// What a line is given so that nothing hangs on the last bits.
const LAST_BITS: f64 = 1e-9;
/// Of the peak, or of the final value: nearer than this nothing is told apart.
const NEARLY: f64 = 1e-3;
/// Of the band within which a response has settled.
const NEAR_THE_BAND: f64 = 0.01;
/// Of the limit from which a swing is visible.
const NEARLY_VISIBLE: f64 = 0.1;
/// A pair changes its amplitude by less than six millionths in a swing: no eye tells that from none.
const SUSTAINED: f64 = 1e-6;

impl Features {
    pub fn of(response: &Response) -> Self {
        let extrema = first_extrema(response);
        let outlook = Outlook::of(response);
        let (shape, final_value) = outlook.judged(response, &extrema, 1.0);
        let bounded = matches!(final_value, Limit::Value(_) | Limit::Oscillates);
        let enough_s =
            if final_value == Limit::Oscillates { 4.0 * response.horizon_s() } else { f64::INFINITY };
        let pair = dominant_pair(response);
        let (damping_ratio, natural_frequency_rad_s) = pair
            .map(|mode| (-mode.re / mode.speed(), mode.speed()))
            .or_else(|| of_two_real(response))
            .unzip();
        let decaying = response.present().filter(|mode| mode.re < 0.0).map(|mode| -1.0 / mode.re);
        let deviation = final_value.value().and_then(|value| {
            let peak = settling::largest_excursion(response, value, f64::INFINITY)?;
            Some((peak.value - value).abs()).filter(|&size| size > 0.0)
        });
        let settled = |share: f64| deviation.map(|size| settling::last_crossing(response, share * size));
        let step_to = final_value.value().filter(|&v| response.kind == InputKind::Step && v != 0.0);
        let reached =
            |share: f64| step_to.and_then(|value| settling::first_crossing(response, share * value));
        let starts_at = step_to.map_or(1.0, |value| response.at(0.0) / value);
        let starts_low = starts_at < 0.1 * (1.0 - LAST_BITS);
        let peak = if bounded { settling::largest_excursion(response, 0.0, enough_s) } else { None };
        let overshoot = step_to.map(|value| overshoot_percent(response, value));
        let other_times = |share: f64| {
            let [early, late] = [1.0 + NEAR_THE_BAND, 1.0 - NEAR_THE_BAND].map(|part| settled(share * part));
            let touches = |(early, late): &(f64, f64)| late - early > 2.0 * NEAR_THE_BAND * late;
            let Some((early, late)) = early.zip(late).filter(touches) else { return Vec::new() };
            let turns = extrema.iter().map(|extremum| extremum.time_s);
            let turn = turns.filter(|turn| (early..=late).contains(turn)).fold(early, f64::max);
            vec![(early, early), (if turn > early { turn } else { late }, late)]
        };
        let final_size = final_value.value().map_or(0.0, f64::abs);
        let borderline = Borderline {
            shape: outlook.other_shape(response, &extrema, shape),
            peaks: peak.map_or_else(Vec::new, |peak| as_high(response, &extrema, peak)),
            hardly_a_peak: peak.is_some_and(|peak| (peak.value.abs() / final_size - 1.0).abs() <= NEARLY)
                || overshoot.is_some_and(|percent| percent > 0.0 && percent <= 100.0 * NEARLY),
            settling_times_2_percent_s: other_times(0.02),
            settling_times_5_percent_s: other_times(0.05),
            rise_time_10_90_s: reached(0.9).filter(|_| (starts_at / 0.1 - 1.0).abs() <= NEARLY),
        };
        Self {
            initial_value: response.at(0.0),
            final_value,
            shape,
            peak,
            borderline,
            extrema,
            period_s: pair.map(|mode| TAU / mode.im),
            damping_ratio,
            natural_frequency_rad_s,
            slowest_time_constant_s: decaying.reduce(f64::max),
            settling_time_2_percent_s: settled(0.02),
            settling_time_5_percent_s: settled(0.05),
            overshoot_percent: overshoot,
            rise_time_10_90_s: reached(0.9)
                .zip(reached(0.1))
                .filter(|_| starts_low)
                .map(|(late, early)| late - early),
            rise_time_0_100_s: reached(1.0).filter(|_| starts_low),
            dc_gain: None,
        }
    }
}

impl Features {
    /// ω_d = 2π / period of the dominant pair, rad/s.
    pub fn damped_frequency_rad_s(&self) -> Option<f64> {
        self.period_s.map(|period_s| TAU / period_s)
    }
}

fn first_extrema(response: &Response) -> Vec<Extremum> {
    let mut extrema = Vec::new();
    let mut scan = response.extrema_from(0.0);
    while !scan.finished() && extrema.len() < EXTREMA_LISTED {
        extrema.extend(scan.advance());
        // What is left of a decaying response is below rounding.
        let highest = response.moving_bound_from(0.0);
        if highest.is_finite() && response.moving_bound_from(scan.time()) <= 1e-13 * highest {
            break;
        }
    }
    extrema
}

/// The slowest-decaying (or fastest-growing) pair one can see.
fn dominant_pair(response: &Response) -> Option<&Mode> {
    let pairs = response.present().filter(|mode| !mode.is_real());
    pairs.fold(None, |best: Option<&Mode>, mode| match best {
        Some(b) if (b.re, b.amplitude()) >= (mode.re, mode.amplitude()) => best,
        _ => Some(mode),
    })
}

/// ζ and ω_n of s² + 2ζω_n·s + ω_n² with real roots (ζ² ≥ 1), when these two are all the response shows.
fn of_two_real(response: &Response) -> Option<(f64, f64)> {
    let constant_of_a_step = |mode: &Mode| response.kind == InputKind::Step && mode.is_constant();
    let mut poles: Vec<f64> = Vec::new();
    for mode in response.present().filter(|mode| !constant_of_a_step(mode)) {
        let known = poles.iter().filter(|pole| **pole == mode.re).count();
        poles.extend(std::iter::repeat_n(mode.re, (mode.power + 1).saturating_sub(known)));
    }
    let [first, second] = poles[..] else { return None };
    let speed = (first * second).sqrt();
    (first * second > 0.0 && speed.is_finite()).then(|| (-(first + second) / 2.0 / speed, speed))
}

/// How far y goes beyond `value`, in percent of it.
fn overshoot_percent(response: &Response, value: f64) -> f64 {
    let beyond = |y: f64| y / value - 1.0;
    let mut most = beyond(response.at(0.0)).max(0.0);
    let mut scan = response.extrema_from(0.0);
    while !scan.finished() {
        let rest = response.moving_bound_from(scan.time()) / value.abs();
        if rest <= most || rest <= 1e-12 {
            break;
        }
        if let Some(extremum) = scan.advance() {
            most = most.max(beyond(extremum.value));
        }
    }
    100.0 * most
}

/// The terms that outlast the others.
///
/// The rightmost terms decide, among them those with the highest power of t; the constant term (the final value) does
/// not count. Where a real and a complex term tie, the larger amplitude decides.
struct Outlook<'a> {
    /// The largest real one of them.
    real: Option<&'a Mode>,
    /// The largest pair.
    pair: Option<&'a Mode>,
}

impl<'a> Outlook<'a> {
    fn of(response: &'a Response) -> Self {
        let moving = || response.present().filter(|mode| !mode.is_constant());
        let rightmost = moving().map(|mode| mode.re).fold(f64::NEG_INFINITY, f64::max);
        let right = || moving().filter(move |mode| mode.re == rightmost);
        let power = right().map(|mode| mode.power).max().unwrap_or(0);
        let largest = |real: bool| {
            let candidates = right().filter(move |mode| mode.power == power && mode.is_real() == real);
            candidates.max_by(|a, b| a.amplitude().total_cmp(&b.amplitude()))
        };
        Self { real: largest(true), pair: largest(false) }
    }

    fn leader(&self) -> Option<&'a Mode> {
        let size = |mode: Option<&Mode>| mode.map_or(0.0, Mode::amplitude);
        if size(self.pair) > size(self.real) { self.pair } else { self.real }
    }

    /// `demand`: so many times larger than usual a swing must be to be visible.
    fn judged(&self, response: &Response, extrema: &[Extremum], demand: f64) -> (Shape, Limit) {
        let Some(leader) = self.leader() else {
            return (Shape::Constant, Limit::Value(response.constant()));
        };
        if leader.re < 0.0 {
            let swings = leads_visibly(leader, response, demand) || swings_visibly(response, extrema, demand);
            let shape = if swings { Shape::DecayingOscillation } else { Shape::ExponentialDecay };
            return (shape, Limit::Value(response.constant()));
        }
        let bounded = leader.re == 0.0 && leader.power == 0;
        match (leader.is_real(), bounded) {
            (false, true) => (Shape::SustainedOscillation, Limit::Oscillates),
            (false, false) => (Shape::GrowingOscillation, Limit::OscillatesUnbounded),
            (true, _) => {
                let shape = if leader.re > 0.0 { Shape::ExponentialGrowth } else { Shape::PolynomialGrowth };
                let up = leader.coefficient_re > 0.0;
                (shape, if up { Limit::PlusInfinity } else { Limit::MinusInfinity })
            }
        }
    }
}

impl Outlook<'_> {
    /// Another word for the shape that is as right as `shape`.
    fn other_shape(&self, response: &Response, extrema: &[Extremum], shape: Shape) -> Option<Shape> {
        let leader = self.leader()?;
        if !leader.is_real() && leader.re != 0.0 && leader.re.abs() <= SUSTAINED * leader.im {
            return Some(Shape::SustainedOscillation);
        }
        if leader.re < 0.0 {
            let demands = [1.0 - NEARLY_VISIBLE, 1.0 + NEARLY_VISIBLE];
            let words = demands.map(|demand| self.judged(response, extrema, demand).0);
            return words.into_iter().find(|word| *word != shape);
        }
        // A term of the other kind that grows as fast, or nearly.
        let rival = |mode: &&Mode| {
            let gap = leader.re - mode.re;
            let ratio = mode.amplitude() / leader.amplitude();
            let alike = if gap == 0.0 { (ratio - 1.0).abs() <= NEARLY_VISIBLE } else { ratio > 0.0 };
            mode.is_real() != leader.is_real()
                && mode.power == leader.power
                && gap >= 0.0
                && gap <= LAST_BITS * leader.speed().max(mode.speed())
                && alike
        };
        let rival = response.moving().find(rival)?;
        let other =
            Outlook { real: Some(rival).filter(|r| r.is_real()), pair: Some(rival).filter(|r| !r.is_real()) };
        Some(other.judged(response, extrema, 1.0).0).filter(|word| *word != shape)
    }
}

/// The start and the first extrema where they are as high as the peak.
fn as_high(response: &Response, extrema: &[Extremum], peak: Extremum) -> Vec<Extremum> {
    let start = Extremum { time_s: 0.0, value: response.at(0.0) };
    let near = |other: &&Extremum| **other != peak && other.value.abs() >= (1.0 - NEARLY) * peak.value.abs();
    std::iter::once(&start).chain(extrema).filter(near).copied().collect()
}

/// A pair that decays by this in every radian has died before it swings back: e^(−10π) is 2e-14.
const DEAD_BEFORE_IT_SWINGS: f64 = 10.0;

/// Whether a decaying response ends in the oscillation of a pair that has at least 1 % of the largest amplitude.
fn leads_visibly(leader: &Mode, response: &Response, demand: f64) -> bool {
    if leader.is_real() || -leader.re * demand > DEAD_BEFORE_IT_SWINGS * leader.im {
        return false;
    }
    let largest =
        response.present().filter(|mode| !mode.is_constant()).map(Mode::amplitude).fold(0.0, f64::max);
    let largest = response.pieces().map_or(largest, |pieces| pieces.highest().min(largest));
    leader.amplitude() >= 0.01 * demand * largest
}

/// Whether a pair makes the curve go up and down by at least 5 % of its range, twice in a row.
///
/// A slow real term may outlast an oscillation that everyone sees.
fn swings_visibly(response: &Response, extrema: &[Extremum], demand: f64) -> bool {
    let values = || std::iter::once(response.at(0.0)).chain(extrema.iter().map(|e| e.value));
    let (low, high) =
        values().fold((response.constant(), response.constant()), |(low, high), y| (low.min(y), high.max(y)));
    let least = 0.05 * demand * (high - low);
    let swings = extrema.windows(2).filter(|pair| (pair[1].value - pair[0].value).abs() >= least);
    response.present().any(|mode| !mode.is_real()) && swings.count() >= 2
}

#[cfg(test)]
#[allow(clippy::excessive_precision, reason = "as many digits as the source gives")]
mod tests {
    use super::Limit::{MinusInfinity, Oscillates, OscillatesUnbounded, PlusInfinity, Value};
    use super::*;
    use crate::algebra::Polynomial;
    use crate::lti::InputKind::{Impulse, Step};
    use crate::lti::tests::{HANGING, UPRIGHT, tf};
    use crate::lti::{TransferFunction, matrix_exponential_response};

    fn features(g: (&str, &str), kind: InputKind) -> Features {
        Features::of(&Response::new(&tf(g.0, g.1), kind).unwrap())
    }

    #[track_caller]
    fn close(what: &str, found: f64, expected: f64) {
        assert!(
            (found - expected).abs() <= 1e-12 * expected.abs().max(1e-3),
            "{what}: {found}, not {expected}"
        );
    }

    #[track_caller]
    fn close_option(what: &str, found: Option<f64>, expected: Option<f64>) {
        assert_eq!(found.is_some(), expected.is_some(), "{what}: {found:?}, not {expected:?}");
        if let (Some(found), Some(expected)) = (found, expected) {
            close(what, found, expected);
        }
    }

    #[test]
    fn shapes_and_limits() {
        use super::Shape::*;
        #[track_caller]
        fn check(what: &str, g: (&str, &str), kind: InputKind, shape: Shape, limit: Limit) {
            let found = features(g, kind);
            assert_eq!(found.shape, shape, "{what}");
            assert_eq!(found.final_value.as_str(), limit.as_str(), "{what}");
            close_option(what, found.final_value.value(), limit.value());
            let bounded = matches!(limit, Value(_) | Oscillates);
            assert!(bounded || found.peak.is_none(), "{what}: {:?}", found.peak);
        }
        check("hanging impulse", HANGING, Impulse, DecayingOscillation, Value(0.0));
        check("hanging step", HANGING, Step, DecayingOscillation, Value(0.0));
        check("upright impulse", UPRIGHT, Impulse, ExponentialGrowth, PlusInfinity);
        check("upright, sign turned", ("-0.06 0", UPRIGHT.1), Impulse, ExponentialGrowth, MinusInfinity);
        check("first order", ("3", "2 1"), Impulse, ExponentialDecay, Value(0.0));
        check("double pole", ("1", "1 2 1"), Impulse, ExponentialDecay, Value(0.0));
        check("undamped", ("1", "1 0 4"), Impulse, SustainedOscillation, Oscillates);
        check("undamped step", ("1", "1 0 4"), Step, SustainedOscillation, Oscillates);
        check("resonance", ("1", "1 0 2 0 1"), Impulse, GrowingOscillation, OscillatesUnbounded);
        check("negative damping", ("1", "1 -0.2 4"), Impulse, GrowingOscillation, OscillatesUnbounded);
        check("ramp", ("1", "1 0"), Step, PolynomialGrowth, PlusInfinity);
        check("motor to position", ("-0.2083", "1 1.71 0"), Step, PolynomialGrowth, MinusInfinity);
        check("motor to position", ("2", "1 4 0"), Impulse, ExponentialDecay, Value(0.5));
        check("ramp and oscillation", ("1", "1 0 1 0 0"), Impulse, PolynomialGrowth, PlusInfinity);
        check("zero", ("0", "1 1"), Step, Constant, Value(0.0));
        check("gain", ("3", "2"), Step, Constant, Value(1.5));
        check("integrator's impulse", ("5", "1 0"), Impulse, Constant, Value(5.0));
        check("zeta 0.9", ("1", "1 1.8 1"), Impulse, DecayingOscillation, Value(0.0));
        // 1/(s + 0.1) outlasts a pair at −1 ± 10j that everyone sees.
        check(
            "slow pole under ripple",
            ("2 4.2 103", "1 2.1 101.2 10.1"),
            Impulse,
            DecayingOscillation,
            Value(0.0),
        );
        // The same pair, a thousand times smaller.
        check(
            "slow pole, ripple too small",
            ("1.001 2.0021 101.0101", "1 2.1 101.2 10.1"),
            Impulse,
            ExponentialDecay,
            Value(0.0),
        );
        // A residue of 1e-7 on the right decides all the same.
        check(
            "nearly cancelled on the right",
            ("1 -1.0000001", "1 0 -1"),
            Impulse,
            ExponentialGrowth,
            MinusInfinity,
        );
        check("cancelled exactly on the right", ("1 -1", "1 0 -1"), Impulse, ExponentialDecay, Value(0.0));
    }

    /// mpmath 1.3 with 40 digits: roots of y′ and of |y − final| − band.
    #[test]
    fn hanging_pendulum_peaks_at_its_second_extremum() {
        let found = features(HANGING, Impulse);
        let expected = [
            (0.27609452806719964, -0.78911275186133619),
            (0.83824178016767964, 0.81875231047215797),
            (1.4008118019297955, -0.77455760479132068),
            (1.9629874009381699, 0.79867990982972309),
            (2.5255309763801616, -0.75994128593497057),
            (3.0877312483890664, 0.77938960225648422),
            (3.6502518051021734, -0.74532099926628901),
            (4.2124735523614097, 0.76081287979969032),
        ];
        assert_eq!(found.extrema.len(), expected.len());
        for (extremum, (time_s, value)) in found.extrema.iter().zip(expected) {
            close("time", extremum.time_s, time_s);
            close("value", extremum.value, value);
        }
        assert_eq!(found.peak, Some(found.extrema[1]));
        close("initial value", found.initial_value, 0.0);
        close_option("2 %", found.settling_time_2_percent_s, Some(200.49136711390514));
        close_option("5 %", found.settling_time_5_percent_s, Some(153.25915446746511));
        close_option("period", found.period_s, Some(TAU / 5.5863847121985271));
        close_option(
            "damping",
            found.damping_ratio,
            Some(0.019467786474327556 / 0.019467786474327556f64.hypot(5.5863847121985271)),
        );
        close_option("slowest", found.slowest_time_constant_s, Some(1.0 / 0.019467786474327556));

        let step = features(HANGING, Step);
        assert_eq!(step.peak, Some(step.extrema[0]));
        close("step's peak", step.extrema[0].value, -0.27851216494503879);
        close_option("step, 2 %", step.settling_time_2_percent_s, Some(167.58890859717658));
        close_option("step, 5 %", step.settling_time_5_percent_s, Some(120.35861855854914));
    }

    /// mpmath 1.3 with 40 digits; second and first order also by hand.
    #[test]
    fn step_responses() {
        struct Row {
            settling: [f64; 2],
            overshoot: f64,
            rise_10_90: f64,
            rise_0_100: Option<f64>,
            peak: Option<(f64, f64)>,
        }
        #[track_caller]
        fn check(what: &str, g: (&str, &str), row: Row) {
            let found = features(g, Step);
            close_option(what, found.settling_time_2_percent_s, Some(row.settling[0]));
            close_option(what, found.settling_time_5_percent_s, Some(row.settling[1]));
            close_option(what, found.overshoot_percent, Some(row.overshoot));
            close_option(what, found.rise_time_10_90_s, Some(row.rise_10_90));
            close_option(what, found.rise_time_0_100_s, row.rise_0_100);
            close_option(what, found.peak.map(|peak| peak.time_s), row.peak.map(|peak| peak.0));
            close_option(what, found.peak.map(|peak| peak.value), row.peak.map(|peak| peak.1));
        }
        check(
            "zeta 0.2, 2 rad/s",
            ("4", "1 0.8 4"),
            Row {
                settling: [9.8009518652186914, 6.8722182091356257],
                overshoot: 52.6620599330303,
                rise_10_90: 0.83432091081968154 - 0.23260596035701871,
                rise_0_100: Some(0.90434867751867817),
                peak: Some((1.6031872877023301, 1.526620599330303)),
            },
        );
        check(
            "first order, 2 s",
            ("3", "2 1"),
            Row {
                settling: [2.0 * 50f64.ln(), 2.0 * 20f64.ln()],
                overshoot: 0.0,
                rise_10_90: 2.0 * 9f64.ln(),
                rise_0_100: None,
                peak: None,
            },
        );
        check(
            "overdamped",
            ("10", "1 7 10"),
            Row {
                settling: [2.2111611308555594, 1.7522353712281122],
                overshoot: 0.0,
                rise_10_90: 1.4037307925764999 - 0.17141185122898871,
                rise_0_100: None,
                peak: None,
            },
        );
        check(
            "starts the wrong way",
            ("-1 1", "1 3 2"),
            Row {
                settling: [5.0055973718808665, 4.081603455186036],
                overshoot: 0.0,
                rise_10_90: 3.6695789942831861 - 1.2496391818834047,
                rise_0_100: None,
                peak: None,
            },
        );
    }

    /// Step responses of ω_n² / (s² + 2ζω_n s + ω_n²) by the formulas of textbooks.
    ///
    /// Source: Ogata, *Modern Control Engineering*, 5th ed., eqs. 5-19 to 5-21 (rise time 0 to 100 %, peak time, overshoot);
    /// Nise, *Control Systems Engineering*, 6th ed., fig. 4.16 (ω_n times rise time 10 to 90 %) and eq. 4.41 (the envelope's
    /// settling time, which the curve's never exceeds).
    #[test]
    fn second_order_systems_of_the_textbooks() {
        for (zeta, tenths, nise) in [
            (0.1, 1, 1.104),
            (0.2, 2, 1.203),
            (0.3, 3, 1.321),
            (0.4, 4, 1.463),
            (0.5, 5, 1.638),
            (0.6, 6, 1.854),
            (0.7, 7, 2.126),
            (0.8, 8, 2.467),
            (0.9, 9, 2.883),
        ] {
            let zeta: f64 = zeta;
            let what = format!("zeta {zeta}");
            // ω_n = 5 rad/s: 2ζω_n is a whole number.
            let den = Polynomial::from_integers(&[1, tenths, 25]);
            let g = TransferFunction::new(Polynomial::from_integers(&[25]), den).unwrap();
            let found = Features::of(&Response::new(&g, Step).unwrap());
            let root = (1.0 - zeta * zeta).sqrt();
            let damped = 5.0 * root;
            let pi = std::f64::consts::PI;
            close_option(&what, found.damping_ratio, Some(zeta));
            close_option(&what, found.natural_frequency_rad_s, Some(5.0));
            close_option(&what, found.damped_frequency_rad_s(), Some(damped));
            close_option(&what, found.rise_time_0_100_s, Some((pi - zeta.acos()) / damped));
            close_option(&what, found.peak.map(|peak| peak.time_s), Some(pi / damped));
            close_option(&what, found.overshoot_percent, Some(100.0 * (-zeta * pi / root).exp()));
            let rise = found.rise_time_10_90_s.unwrap() * 5.0;
            assert!((rise - nise).abs() <= 0.0005, "{what}: {rise}, not {nise}");
            for (share, settled) in
                [(0.02, found.settling_time_2_percent_s), (0.05, found.settling_time_5_percent_s)]
            {
                let envelope = -(share * root).ln() / (zeta * 5.0);
                // It enters the band at most half a swing before its envelope does.
                let settled = settled.unwrap();
                assert!(
                    settled <= envelope && settled >= envelope - pi / damped,
                    "{what}: {settled}, not {envelope}"
                );
            }
        }
    }

    #[test]
    fn two_real_poles_have_a_damping_ratio_and_no_period() {
        for (what, g, expected) in [
            ("critically damped", ("25", "1 10 25"), Some((1.0, 5.0))),
            ("overdamped", ("25", "1 15 25"), Some((1.5, 5.0))),
            ("with a zero", ("1 7", "1 15 25"), Some((1.5, 5.0))),
            ("growing", ("25", "1 -15 25"), Some((-1.5, 5.0))),
            ("to both sides", ("25", "1 15 -25"), None),
            ("an integrator", ("25", "1 15 0"), None),
            ("one pole", ("25", "1 15"), None),
            ("three poles", ("6", "1 6 11 6"), None),
            ("two of them and an integrator", ("6", "1 3 2 0"), None),
        ] {
            for kind in [Impulse, Step] {
                let found = features(g, kind);
                close_option(what, found.damping_ratio, expected.map(|(zeta, _)| zeta));
                close_option(what, found.natural_frequency_rad_s, expected.map(|(_, speed)| speed));
                assert_eq!(found.period_s, None, "{what}");
            }
        }
    }

    #[test]
    fn peaks_at_the_start_and_without_extrema() {
        let decay = features(("3", "2 1"), Impulse);
        assert_eq!(decay.peak, Some(Extremum { time_s: 0.0, value: 1.5 }));
        assert_eq!(decay.extrema, []);
        close_option("5 %", decay.settling_time_5_percent_s, Some(2.0 * 20f64.ln()));
        assert_eq!(decay.period_s, None);

        // (1 − 2t)² e^(−t): touches zero at 0.5 s, turns at 2.5 s.
        let touching = features(("1 -2 5", "1 3 3 1"), Impulse);
        assert_eq!(touching.extrema.len(), 2);
        close("first", touching.extrema[0].time_s, 0.5);
        close("second", touching.extrema[1].time_s, 2.5);
        close("highest", touching.peak.unwrap().value, 16.0 * (-2.5f64).exp());

        // t²/2 − 1000 t: one turn, far beyond any time constant.
        let parabola = features(("-1000 1", "1 0 0 0"), Impulse);
        assert_eq!(parabola.extrema.len(), 1);
        close("parabola", parabola.extrema[0].time_s, 1000.0);

        // y and its first five derivatives vanish at 0: rounding there is no extremum.
        let flat = features(("1", "1 7 21 35 35 21 7 1"), Step);
        assert_eq!(flat.extrema, []);

        let undamped = features(("3", "1 0 9"), Impulse);
        close("amplitude", undamped.peak.unwrap().value, 1.0);
        assert_eq!(undamped.settling_time_2_percent_s, None);
        close_option("no damping", undamped.damping_ratio, Some(0.0));
    }

    #[test]
    fn widely_different_times() {
        // 1 s and 1 µs: y = (e^(−t) − e^(−1e6 t)) · 1e6/(1e6 − 1).
        let stiff = features(("1e6", "1 1000001 1e6"), Impulse);
        assert_eq!(stiff.extrema.len(), 1);
        close("peak", stiff.extrema[0].time_s, 1e6f64.ln() / 999999.0);
        close_option(
            "5 %",
            stiff.settling_time_5_percent_s,
            Some(20f64.ln() - (stiff.extrema[0].value * 0.999999).ln()),
        );
        // A pair that takes 10⁹ swings to settle is read off its envelope, at once.
        let ringing = features(("4e14", "1 2e-2 4e14"), Step);
        assert!((ringing.settling_time_5_percent_s.unwrap() / (100.0 * 20f64.ln()) - 1.0).abs() < 1e-6);
        assert!((ringing.overshoot_percent.unwrap() - 100.0).abs() < 1e-6);
    }

    #[test]
    fn at_the_line_between_two_shapes_either_is_right() {
        use Shape::*;
        #[track_caller]
        fn check(what: &str, g: (&str, &str), kind: InputKind, shape: Shape, other: Option<Shape>) {
            let found = features(g, kind);
            assert_eq!((found.shape, found.borderline.shape), (shape, other), "{what}");
        }
        check("plainly swings", ("4", "1 0.8 4"), Step, DecayingOscillation, None);
        check("plainly does not", ("10", "1 7 10"), Step, ExponentialDecay, None);
        // e^(−10t) + a e^(−t) cos 10t for a about 0.01.
        for (share, shape, other) in [
            ("0.00999", ExponentialDecay, Some(DecayingOscillation)),
            ("0.01001", DecayingOscillation, Some(ExponentialDecay)),
            ("0.005", ExponentialDecay, None),
            ("0.02", DecayingOscillation, None),
        ] {
            let a = crate::lti::tests::polynomial(share);
            let pair = crate::lti::tests::polynomial("1 2 101");
            let num = &pair
                + &(&a * &(&crate::lti::tests::polynomial("1 1") * &crate::lti::tests::polynomial("1 10")));
            let den = &pair * &crate::lti::tests::polynomial("1 10");
            let g = TransferFunction::new(num, den).unwrap();
            let found = Features::of(&Response::new(&g, Impulse).unwrap());
            assert_eq!((found.shape, found.borderline.shape), (shape, other), "{share}");
        }
        // e^t + a e^t cos t for a about 1: (s² − 2s + 2 + a (s − 1)²) / (s − 1)(s² − 2s + 2).
        let den = "1 -3 4 -2";
        check("as large", ("2 -4 3", den), Impulse, ExponentialGrowth, Some(GrowingOscillation));
        check(
            "a little less",
            ("1.999 -3.998 2.999", den),
            Impulse,
            ExponentialGrowth,
            Some(GrowingOscillation),
        );
        check(
            "a little more",
            ("2.001 -4.002 3.001", den),
            Impulse,
            GrowingOscillation,
            Some(ExponentialGrowth),
        );
        check("half", ("1.5 -3 2.5", den), Impulse, ExponentialGrowth, None);
        check("twice", ("3 -6 4", den), Impulse, GrowingOscillation, None);
        // A pair on the axis, and 1e-15 to its sides: decided exactly, but nobody sees the difference.
        check("on the axis", ("1", "1 0 1"), Impulse, SustainedOscillation, None);
        check("left", ("1", "1 2e-15 1"), Impulse, DecayingOscillation, Some(SustainedOscillation));
        check("right", ("1", "1 -2e-15 1"), Impulse, GrowingOscillation, Some(SustainedOscillation));
        check("seen", ("1", "1 1e-3 1"), Impulse, DecayingOscillation, None);
    }

    #[test]
    fn swings_as_high_as_the_peak_are_told() {
        // sin t + sin 3t: as high at every extremum but the small ones between.
        let found = features(("4 0 12", "1 0 10 0 9"), Impulse);
        let peak = found.peak.unwrap();
        assert!(peak.time_s < 1.0, "the first counts: {peak:?}");
        assert!(found.borderline.peaks.iter().any(|e| (e.value + peak.value).abs() < 1e-12), "{found:?}");
        assert_eq!(features(HANGING, Impulse).borderline.peaks, []);
    }

    #[test]
    fn a_swing_that_touches_the_band_gives_two_times() {
        // ζ with an overshoot of 5 %: ln 20 / √(π² + ln² 20) = 0.690106730559822…
        for (zeta2, either) in
            [("1.3802134611", true), ("1.38", true), ("1.382", true), ("1.2", false), ("1.5", false)]
        {
            let found = features(("1", &format!("1 {zeta2} 1")), Step);
            assert_eq!(!found.borderline.settling_times_5_percent_s.is_empty(), either, "{zeta2}");
        }
    }

    #[test]
    fn a_step_that_hardly_overshoots() {
        for (zeta2, hardly) in [("1.4", false), ("1.9", true), ("1.95", true), ("2", false), ("2.1", false)] {
            let found = features(("1", &format!("1 {zeta2} 1")), Step);
            assert_eq!(found.borderline.hardly_a_peak, hardly, "{zeta2}");
        }
    }

    #[test]
    fn a_step_that_starts_at_a_tenth() {
        for (start, low, either) in [
            ("0.09995", true, true),
            ("0.1", false, true),
            ("0.10005", false, true),
            ("0.05", true, false),
            ("0.2", false, false),
        ] {
            let found = features((&format!("{start} 1"), "1 1"), Step);
            let known = (found.rise_time_10_90_s.is_some(), found.borderline.rise_time_10_90_s.is_some());
            assert_eq!(known, (low, either), "{start}");
        }
    }

    #[test]
    fn codes_are_stable() {
        assert_eq!(Shape::DecayingOscillation.as_str(), "decaying_oscillation");
        assert_eq!(Shape::ExponentialDecay.words(), "an exponential approach to the final value");
        assert_eq!(Value(0.25).words(), "0.25");
        assert_eq!(OscillatesUnbounded.as_str(), "oscillates_unbounded");
    }

    /// What the closed form says, held against a second route and against brute force, for a hundred systems.
    #[test]
    fn laws() {
        let mut seed = 1_u64;
        let mut draw = |n: i64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as i64 % n
        };
        for round in 0..100 {
            // Products of (s + a) and (s² + bs + c), all on the left, some repeated; a numerator of lower degree.
            let mut den = Polynomial::one();
            while den.degree() < 1 + draw(5) as usize {
                let (a, b, c) = (1 + draw(9), 1 + draw(4), 5 + draw(40));
                let factor = if draw(2) == 0 { vec![1, a] } else { vec![1, b, c] };
                den = &den * &Polynomial::from_integers(&factor);
            }
            let num: Vec<i64> = (0..den.degree()).map(|_| draw(11) - 5).collect();
            let g = TransferFunction::new(Polynomial::from_integers(&num), den).unwrap();
            let kind = if round % 2 == 0 { Impulse } else { Step };
            let response = Response::new(&g, kind).unwrap();
            let found = Features::of(&response);
            let what = format!("{} to {kind:?}", g.to_text(6));

            let end = response.horizon_s();
            let times: Vec<f64> = (0..=2000).map(|k| end * f64::from(k) / 2000.0).collect();
            let values: Vec<f64> = times.iter().map(|&t| response.at(t)).collect();
            let highest = values.iter().fold(0.0, |top: f64, y| top.max(y.abs()));
            let few: Vec<f64> = times.iter().copied().step_by(200).collect();
            let other = matrix_exponential_response(&g, kind, &few).unwrap();
            for (y, second) in values.iter().step_by(200).zip(other) {
                assert!((y - second).abs() <= 1e-11 * highest, "{what}: {y} or {second}");
            }

            if let Some(peak) = found.peak {
                assert!(peak.value.abs() >= highest, "{what}: {peak:?} is not the highest");
            }
            let turns = values.windows(3).filter(|y| (y[1] - y[0]) * (y[2] - y[1]) < 0.0);
            let size = |y: &&[f64]| (y[1] - y[0]).abs().max((y[2] - y[1]).abs()) > 1e-9 * highest;
            let before_end = found.extrema.iter().filter(|e| e.time_s < end).count();
            assert!(
                before_end >= turns.filter(size).count().min(EXTREMA_LISTED),
                "{what}: {:?}",
                found.extrema
            );

            let Some(settled) = found.settling_time_5_percent_s else {
                assert_eq!(found.shape, Shape::Constant, "{what}");
                continue;
            };
            let level = found.final_value.value().unwrap();
            let deviation = |t: f64| (response.at(t) - level).abs();
            let most = times.iter().map(|&t| deviation(t)).fold(0.0, f64::max);
            for &t in times.iter().filter(|&&t| t > settled) {
                assert!(deviation(t) <= 0.0501 * most, "{what}: outside at {t} s, settled at {settled} s");
            }
            assert!(deviation(settled) >= 0.05 * most * (1.0 - 1e-9), "{what}: settled before {settled} s");
        }
    }
}
