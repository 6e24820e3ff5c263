//! Extrema of a response, bracketed and refined, one after the other.

use super::{Extremum, Mode, Response};

/// Walks along a response and stops at every extremum.
///
/// The step is an eighth of a radian of the fastest term still alive, and no more than an eighth of the time passed. A
/// bracket is a change of sign of the rate, or a rate that nearly touches zero and is found to cross it.
pub(super) struct ExtremumScan<'a> {
    response: &'a Response,
    shortest_step: f64,
    tail: Option<Tail>,
    at: Point,
    /// Sign of the last rate that was more than rounding, and where.
    side: Option<(f64, f64)>,
    pending: Option<(f64, f64)>,
    steps_left: usize,
}

/// The walk ends after this many steps, about 10 ms of work.
const MOST_STEPS: usize = 100_000;
const STEPS_A_RADIAN: f64 = 8.0;
/// A term is dead when its rate has fallen to this share of the whole.
const DEAD: f64 = 1e-12;

#[derive(Clone, Copy)]
struct Point {
    t: f64,
    curvature: f64,
    /// 0 when the rate is nothing but rounding.
    sign: f64,
    step: f64,
}

impl<'a> ExtremumScan<'a> {
    pub fn new(response: &'a Response, from: f64) -> Self {
        let shortest_step = shortest_step(response);
        let at = Point::new(response, from, shortest_step);
        let side = (at.sign != 0.0).then_some((at.sign, from));
        let tail = Tail::of(response);
        Self { response, shortest_step, tail, at, side, pending: None, steps_left: MOST_STEPS }
    }

    /// How far the walk has come.
    pub fn time(&self) -> f64 {
        self.at.t
    }

    /// One step ahead; the extremum in it, if any.
    pub fn advance(&mut self) -> Option<Extremum> {
        if let Some((a, b)) = self.pending.take() {
            return Some(self.refined(a, b));
        }
        self.steps_left = self.steps_left.saturating_sub(1);
        let before = self.at;
        self.at = Point::new(self.response, before.t + before.step, self.shortest_step);
        let after = self.at;
        if after.sign == 0.0 {
            return None;
        }
        let (side, since) = self.side.replace((after.sign, after.t))?;
        if side != after.sign {
            return Some(self.refined(since, after.t));
        }
        // The rate comes nearer to zero and leaves again: does it cross in between?
        if before.sign == side && before.curvature * side < 0.0 && after.curvature * side > 0.0 {
            let curvature = |t: f64| self.response.jet(t)[2];
            let nearest = crossing(before.t, after.t, curvature);
            if self.response.rate(nearest) * side < 0.0 {
                self.pending = Some((nearest, after.t));
                return Some(self.refined(before.t, nearest));
            }
        }
        None
    }

    /// Whether no extremum is left, or none that can be found within the steps allowed.
    pub fn finished(&self) -> bool {
        let nothing_left = || match self.response.pieces() {
            Some(pieces) => self.at.t >= pieces.end(),
            None => self.tail.is_some_and(|tail| tail.is_monotone(self.response, self.at.t)),
        };
        self.pending.is_none() && (self.gave_up() || nothing_left())
    }

    /// Whether the steps allowed are used up.
    pub fn gave_up(&self) -> bool {
        self.steps_left == 0
    }

    fn refined(&self, a: f64, b: f64) -> Extremum {
        let time_s = crossing(a, b, |t| self.response.rate(t));
        Extremum { time_s, value: self.response.at(time_s) }
    }
}

/// A response in the end rises or falls with its rightmost term, if that is a real one.
#[derive(Clone, Copy)]
struct Tail {
    /// `None` when nothing moves at all.
    leader: Option<Mode>,
    /// From here on the other terms shrink against the leader.
    since: f64,
}

impl Tail {
    /// `None` when a pair is among the rightmost terms: it turns for ever.
    fn of(response: &Response) -> Option<Self> {
        let place = |mode: &Mode| (mode.re, mode.power);
        let mut leader: Option<Mode> = None;
        for &mode in response.moving() {
            if leader
                .is_none_or(|l| place(&mode) > place(&l) || (place(&mode) == place(&l) && !mode.is_real()))
            {
                leader = Some(mode);
            }
        }
        let Some(first) = leader else {
            return Some(Self { leader: None, since: 0.0 });
        };
        if !first.is_real() {
            return None;
        }
        let mut since = if first.re == 0.0 { 0.0 } else { 2.0 * first.power as f64 / first.re.abs() };
        for mode in response.moving().filter(|mode| mode.re < first.re && mode.power > first.power) {
            since = since.max((mode.power - first.power) as f64 / (first.re - mode.re));
        }
        Some(Self { leader, since })
    }

    /// Whether from t on the leader's rate outweighs all others.
    fn is_monotone(self, response: &Response, t: f64) -> bool {
        let Some(leader) = self.leader else {
            return true;
        };
        if t < self.since || t == 0.0 {
            return false;
        }
        let bound = |mode: &Mode| mode.envelope(t) * (mode.speed() + mode.power as f64 / t);
        let others = response.moving().filter(|&&mode| mode != leader).map(bound).sum::<f64>();
        let turn = if leader.re < 0.0 { -1.0 } else { 1.0 };
        leader.envelope(t) * (leader.speed() + turn * leader.power as f64 / t) > 1.01 * others
    }
}

impl Point {
    fn new(response: &Response, t: f64, shortest_step: f64) -> Self {
        let [_, rate, curvature] = response.jet(t);
        if let Some(pieces) = response.pieces() {
            let (step, rounding) = pieces.step_and_rounding(t);
            let sign = if rate.abs() <= rounding { 0.0 } else { rate.signum() };
            return Self { t, curvature, sign, step };
        }
        let steepness = |mode: &Mode| {
            let within = t.max(shortest_step);
            mode.envelope(within) * (mode.speed() + mode.power as f64 / within)
        };
        let whole: f64 = response.modes().iter().map(steepness).sum();
        let alive = response.modes().iter().filter(|mode| steepness(mode) > DEAD * whole);
        let speed = alive.map(|mode| mode.speed()).fold(0.0, f64::max);
        let by_time = (t / STEPS_A_RADIAN).max(shortest_step);
        let step = by_time.min(1.0 / (STEPS_A_RADIAN * speed));
        let sign = if rate.abs() <= 64.0 * f64::EPSILON * whole { 0.0 } else { rate.signum() };
        Self { t, curvature, sign, step }
    }
}

/// The first step: small against every time constant, and against the times at which a polynomial in t can turn.
fn shortest_step(response: &Response) -> f64 {
    let fastest = response.modes().iter().map(Mode::speed).fold(0.0, f64::max);
    let polynomial = || response.modes().iter().filter(|mode| mode.speed() == 0.0);
    let mut turning: f64 = 0.0;
    for high in polynomial() {
        for low in polynomial().filter(|low| low.power < high.power) {
            let ratio = high.amplitude() / low.amplitude();
            turning = turning.max(ratio.powf(1.0 / (high.power - low.power) as f64));
        }
    }
    let speed = fastest.max(turning);
    if speed > 0.0 { 1.0 / (32.0 * speed) } else { 1.0 }
}

/// Where f changes sign between a and b, to the last bit or two; f(a) and f(b) differ in sign.
///
/// Source: regula falsi (Illinois), every fourth step a bisection.
pub(super) fn crossing(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    let (mut weight_a, mut weight_b) = (fa, fb);
    let mut moved_a = None;
    for round in 0..200 {
        let width = b - a;
        if fa == 0.0 || width <= 2.0 * f64::EPSILON * b.abs() {
            return a;
        }
        if fb == 0.0 {
            return b;
        }
        let secant = b - weight_b * width / (weight_b - weight_a);
        let inside = secant > a && secant < b && round % 4 != 3;
        let t = if inside { secant } else { a + 0.5 * width };
        if t <= a || t >= b {
            return t;
        }
        let value = f(t);
        // Illinois: an end that stays twice in a row counts half.
        let moves_a = (value < 0.0) == (fa < 0.0);
        if moves_a {
            (a, fa, weight_a) = (t, value, value);
            if moved_a == Some(true) {
                weight_b *= 0.5;
            }
        } else {
            (b, fb, weight_b) = (t, value, value);
            if moved_a == Some(false) {
                weight_a *= 0.5;
            }
        }
        moved_a = Some(moves_a);
    }
    a + 0.5 * (b - a)
}

/// How far one may step at t without passing over anything.
pub(super) fn step_at(response: &Response, t: f64) -> f64 {
    Point::new(response, t, shortest_step(response)).step
}
