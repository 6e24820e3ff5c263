use super::dyadic::taylor;
use super::extrema::ExtremumScan;
use super::many_digits::many_digits;
use super::pieces::Pieces;
use super::poles::isolated_roots_to;
use super::simple_roots::PRECISION_BITS;
use super::wide::Wide;
use super::{Pole, RootError, TransferFunction, horizon, sampling};
use crate::algebra::{Polynomial, to_f64};
use dashu_int::IBig;
use num_complex::Complex64;
use std::sync::Arc;

/// What the system is driven with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InputKind {
    /// δ(t), area 1.
    Impulse,
    /// 1 for t ≥ 0.
    Step,
}

impl InputKind {
    /// As lab files spell it: `impulse`, `step`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Impulse => "impulse",
            Self::Step => "step",
        }
    }
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResponseError {
    #[error(
        "the transfer function is improper: its numerator (degree {num}) outranks its denominator (degree {den})"
    )]
    Improper { num: usize, den: usize },
    #[error("the response is too large or too small for floating-point numbers")]
    OutOfRange,
    #[error(
        "the poles {first} and {second} lie so close together that the response takes more digits than can be waited for"
    )]
    TooClose { first: String, second: String },
    #[error(transparent)]
    Roots(#[from] RootError),
}

/// lim s·Y(s) as s → ∞ of a strictly proper Y(s).
fn initial_value(driven: &TransferFunction) -> f64 {
    match (driven.den.degree().checked_sub(1), driven.den.leading()) {
        (Some(power), Some(leading)) => to_f64(&(driven.num.coefficient(power) / leading)),
        _ => 0.0,
    }
}

/// One term of a partial-fraction expansion in the time domain.
///
/// A real pole (`im` = 0) contributes c · tᵏ/k! · e^{pt}; with `im` > 0 the term stands for the pair and contributes
/// 2 Re(c · e^{pt}) · tᵏ/k!.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// The pole p, rad/s; `im` ≥ 0.
    pub re: f64,
    pub im: f64,
    /// k: 0 up to the pole's multiplicity less one.
    pub power: usize,
    /// c, the coefficient of 1/(s − p)^(k + 1).
    pub coefficient_re: f64,
    pub coefficient_im: f64,
}

impl Mode {
    /// The final value is such a mode: it stays what it is.
    pub(super) fn is_constant(&self) -> bool {
        self.re == 0.0 && self.im == 0.0 && self.power == 0
    }

    pub(super) fn is_real(&self) -> bool {
        self.im == 0.0
    }

    /// |p|, rad/s.
    pub(super) fn speed(&self) -> f64 {
        self.re.hypot(self.im)
    }

    /// The largest the contribution can be at t.
    pub(super) fn envelope(&self, t: f64) -> f64 {
        self.amplitude() * self.growth(t, self.power)
    }

    /// The largest the contribution can be from t on.
    pub(super) fn bound_from(&self, t: f64) -> f64 {
        match (self.re < 0.0, self.power) {
            (false, 0) if self.re == 0.0 => self.amplitude(),
            (false, _) => f64::INFINITY,
            (true, k) => self.envelope(t.max(k as f64 / -self.re)),
        }
    }

    /// How large the contribution is while the fastest term, of `speed` rad/s, turns once.
    pub(super) fn early_bound(&self, speed: f64) -> f64 {
        self.envelope(1.0 / speed)
    }

    /// |c|, twice for a pair.
    pub(super) fn amplitude(&self) -> f64 {
        let size = self.coefficient_re.hypot(self.coefficient_im);
        if self.is_real() { size } else { 2.0 * size }
    }

    /// e^{re·t} tᵏ/k!; it stops growing just short of infinity.
    fn growth(&self, t: f64, k: usize) -> f64 {
        (1..=k).fold((self.re * t).min(600.0).exp(), |product, i| product * t / i as f64)
    }

    /// The contribution at t, to the last bit what [`jet`](Self::jet) begins with.
    fn value(&self, t: f64) -> f64 {
        let full = self.growth(t, self.power);
        if self.is_real() {
            return self.coefficient_re * full;
        }
        let (sin, cos) = (self.im * t).sin_cos();
        (2.0 * self.coefficient_re * cos - 2.0 * self.coefficient_im * sin) * full
    }

    /// Value and first two derivatives of the contribution at t.
    fn jet(&self, t: f64) -> [f64; 3] {
        let p = Complex64::new(self.re, self.im);
        let c = Complex64::new(self.coefficient_re, self.coefficient_im);
        let turning = if self.is_real() { c } else { 2.0 * c * Complex64::cis(self.im * t) };
        let [full, less, least] =
            [0, 1, 2].map(|order| self.power.checked_sub(order).map_or(0.0, |k| self.growth(t, k)));
        // Leibniz: (e^{pt} tᵏ/k!)″ = e^{pt}(p² tᵏ/k! + 2p tᵏ⁻¹/(k−1)! + tᵏ⁻²/(k−2)!).
        let rate = p * full + less;
        let curvature = p * p * full + 2.0 * p * less + least;
        [turning.re * full, (turning * rate).re, (turning * curvature).re]
    }
}

/// A response in closed form: a sum of tᵏ e^{pt} terms from the partial fractions of G(s) or G(s)/s.
///
/// Accuracy: about 1e-15 of the sum of the terms' envelopes at that time; multiple poles cost nothing. Poles that nearly
/// coincide, and many in a row, have terms far larger than the response, which cancel. Where that would cost more than
/// four digits the terms are summed with as many digits as it takes, once, and the curve is kept as polynomials: 1e-13
/// of the largest value near that time.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    pub kind: InputKind,
    /// The area of the δ(t) in an impulse response: the direct feed-through, G(∞). It is no part of y(t) at t ≥ 0⁺.
    pub delta: f64,
    /// y(0⁺) by the initial value theorem, from exact coefficients: a sum of modes would leave a rounding error for 0.
    initial: f64,
    modes: Vec<Mode>,
    /// The curve itself, where the modes cancel.
    pieces: Option<Arc<Pieces>>,
}

/// Modes larger than the response by this have lost too many digits.
const MOST_CANCELLED: f64 = 1e4;
/// Poles this close, of their size, are taken to coincide.
const MEETING: f64 = 1e-7;
/// Instants at which that is looked at.
const LOOKS: u32 = 60;

impl Response {
    /// Common factors of numerator and denominator are cancelled exactly first, so that a pole-zero pair leaves no trace.
    ///
    /// Errors: [`ResponseError`]; an impulse or step response needs a proper transfer function.
    /// Source: Laurent expansion at each pole, from exact derivatives of numerator and denominator.
    pub fn new(g: &TransferFunction, kind: InputKind) -> Result<Self, ResponseError> {
        let (g, _) = g.cancelled();
        if g.relative_degree() < 0 {
            return Err(ResponseError::Improper { num: g.num.degree(), den: g.den.degree() });
        }
        let (driven, delta) = match kind {
            InputKind::Impulse => {
                let (through, num) = g.num.div_rem(&g.den).unwrap_or_default();
                (TransferFunction { num, den: g.den }, to_f64(&through.coefficient(0)))
            }
            InputKind::Step => {
                let integrated =
                    TransferFunction { num: g.num, den: &g.den * &Polynomial::from_integers(&[1, 0]) };
                (integrated.cancelled().0, 0.0)
            }
        };
        let initial = initial_value(&driven);
        let (modes, poles) =
            if driven.num.is_zero() { Default::default() } else { partial_fractions(&driven)? };
        let finite = |m: &Mode| m.coefficient_re.is_finite() && m.coefficient_im.is_finite();
        if !delta.is_finite() || !initial.is_finite() || !modes.iter().all(finite) {
            return Err(ResponseError::OutOfRange);
        }
        let plain = Self { kind, delta, initial, modes, pieces: None };
        if !meet(&poles) && plain.cancelled() <= MOST_CANCELLED {
            return Ok(plain);
        }
        let pieces = Some(Arc::new(many_digits(&driven, &plain.modes, &poles)?));
        Ok(Self { pieces, ..plain })
    }

    /// How much larger the sum of the terms' envelopes is than the response, at worst.
    fn cancelled(&self) -> f64 {
        let speeds = || self.modes.iter().map(Mode::speed).filter(|speed| *speed > 0.0);
        let (fastest, slowest) = (speeds().fold(0.0, f64::max), speeds().fold(f64::INFINITY, f64::min));
        if fastest == 0.0 {
            return 1.0;
        }
        let (first, last) = (0.1 / fastest, 10.0 / slowest);
        let times = (0..=LOOKS).map(|k| first * (last / first).powf(f64::from(k) / f64::from(LOOKS)));
        let seen: Vec<(f64, f64, f64)> = times
            .map(|t| (t, self.at(t).abs(), self.modes.iter().map(|mode| mode.envelope(t)).sum()))
            .collect();
        // What decays is measured by its peak, what grows by what it has become.
        let rightmost = self.moving().map(|mode| mode.re).fold(f64::NEG_INFINITY, f64::max);
        let early = if rightmost > 0.0 { 1.0 / rightmost } else { f64::INFINITY };
        let (mut worst, mut highest): (f64, f64) = (1.0, f64::MIN_POSITIVE);
        highest = seen.iter().filter(|look| look.0 <= early).map(|look| look.1).fold(highest, f64::max);
        for (_, size, envelope) in seen {
            highest = highest.max(size);
            worst = worst.max(envelope / highest);
        }
        worst
    }

    pub(super) fn pieces(&self) -> Option<&Pieces> {
        self.pieces.as_deref()
    }

    /// The terms, those of the rightmost poles first, the highest power of a pole first; none for the zero response.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// y(t) for t ≥ 0 s (t = 0 means 0⁺).
    ///
    /// Growth stops near 1e260: a value is always finite.
    pub fn at(&self, t: f64) -> f64 {
        if t == 0.0 {
            return self.initial;
        }
        match self.pieces().and_then(|pieces| pieces.jet(t)) {
            Some(jet) => jet[0],
            None => self.modes.iter().fold(0.0, |sum, mode| sum + mode.value(t)),
        }
    }

    /// dy/dt at t ≥ 0.
    pub fn rate(&self, t: f64) -> f64 {
        self.jet(t)[1]
    }

    /// A time axis on which the behaviour is seen, in seconds: 1, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten.
    ///
    /// - Decaying: until what is left is within 5 % of the peak deviation.
    /// - Growing: until the growing terms are a hundred times what the response began with.
    /// - Oscillating for ever, or a ramp: about 8 periods, and until the transient is over; 10 s when nothing sets a scale.
    ///
    /// Never more than 400 periods of the fastest oscillation present.
    pub fn horizon_s(&self) -> f64 {
        horizon::horizon_s(self)
    }

    /// Points (t, y) on 0..=`end_s`, dense enough that straight lines between them stay within `tolerance`·peak of the curve.
    ///
    /// The peak is the largest |y| on the axis. All extrema are among the points. At most 4,000 points: beyond that the
    /// tolerance is loosened, and with more than 1,000 swings only the highest and lowest point of each of 1,000 equal
    /// stretches are given, so that a line through them fills the band the curve moves in.
    pub fn samples(&self, end_s: f64, tolerance: f64) -> Vec<(f64, f64)> {
        sampling::samples(self, end_s, tolerance)
    }

    /// (t, y) of start, extrema and end of 0..=`end_s`: between two of them y rises or falls. With more than 1,000 swings only
    /// the highest and lowest point of each of 1,000 equal stretches.
    pub fn turning_points(&self, end_s: f64) -> Vec<(f64, f64)> {
        sampling::turning_points(self, end_s)
    }

    /// Value, rate and curvature at t.
    pub(super) fn jet(&self, t: f64) -> [f64; 3] {
        if let Some(jet) = self.pieces().and_then(|pieces| pieces.jet(t)) {
            return jet;
        }
        self.modes.iter().fold([0.0; 3], |sum, mode| {
            let jet = mode.jet(t);
            [sum[0] + jet[0], sum[1] + jet[1], sum[2] + jet[2]]
        })
    }

    /// The extrema after `from`, in time order.
    pub(super) fn extrema_from(&self, from: f64) -> ExtremumScan<'_> {
        ExtremumScan::new(self, from)
    }

    /// The constant term: the final value, when everything else decays.
    pub(super) fn constant(&self) -> f64 {
        self.modes.iter().find(|mode| mode.is_constant()).map_or(0.0, |mode| mode.coefficient_re)
    }

    /// Everything but the constant.
    pub(super) fn moving(&self) -> impl Iterator<Item = &Mode> + Clone {
        self.modes.iter().filter(|mode| !mode.is_constant())
    }

    /// The largest |y − constant| can be at t.
    pub(super) fn moving_envelope(&self, t: f64) -> f64 {
        if let Some(pieces) = self.pieces() {
            return pieces.bound_from(t);
        }
        self.moving().map(|mode| mode.envelope(t)).sum()
    }

    /// The largest |y − constant| can be from t on.
    pub(super) fn moving_bound_from(&self, t: f64) -> f64 {
        if let Some(pieces) = self.pieces() {
            return pieces.bound_from(t);
        }
        self.moving().map(|mode| mode.bound_from(t)).sum()
    }

    /// The terms one can tell from zero: all that do not decay, and those decaying ones that ever reach 1e-9 of the
    /// largest of them.
    pub(super) fn present(&self) -> impl Iterator<Item = &Mode> + Clone {
        let height = |mode: &Mode| mode.bound_from(0.0);
        let lasting = |mode: &Mode| mode.re >= 0.0;
        let largest = self.modes.iter().filter(|mode| !lasting(mode)).map(height).fold(0.0, f64::max);
        let highest = self.pieces().map_or(largest, Pieces::highest);
        self.modes.iter().filter(move |mode| lasting(mode) || height(mode) >= 1e-9 * highest)
    }
}

/// Whether two poles nearly coincide, so that not even the coefficients have all their digits.
fn meet(poles: &[Pole]) -> bool {
    let near = |a: &Pole, b: &Pole| {
        (a.re - b.re).hypot(a.im - b.im) <= MEETING * a.re.hypot(a.im).max(b.re.hypot(b.im))
    };
    poles.iter().enumerate().any(|(i, a)| poles[..i].iter().any(|b| near(a, b)))
}

/// A numerator must keep this many of a pole's bits where that lies beside a zero.
const KEPT_BITS: i64 = 44;
/// A zero this close to a pole is not told from it.
const MOST_BITS: i64 = 4_000;

/// The terms of `g`, strictly proper and in lowest terms.
///
/// Where a zero nearly cancels a pole, the pole is found to as many bits as tell them apart: how small a residue is, and
/// on which side of 0, is never left to rounding.
fn partial_fractions(g: &TransferFunction) -> Result<ModesAndPoles, ResponseError> {
    // Both over one common denominator, so that their quotient stays what it is.
    let both = [g.den.coefficients(), g.num.coefficients()].concat();
    let integers = Polynomial::new(both).primitive();
    let (den, num) = integers.split_at(g.den.degree() + 1);
    let mut bits = PRECISION_BITS;
    loop {
        if let Some(found) = terms_to(&g.den, den, num, bits)? {
            return Ok(found);
        }
        bits *= 2;
        if bits > MOST_BITS {
            return Err(ResponseError::OutOfRange);
        }
    }
}

/// The modes of a response, and the poles they belong to.
type ModesAndPoles = (Vec<Mode>, Vec<Pole>);

/// With poles to within 2^−`bits` of each part; `None` where a zero is too close to one of them for that.
fn terms_to(
    p: &Polynomial,
    den: &[IBig],
    num: &[IBig],
    bits: i64,
) -> Result<Option<ModesAndPoles>, ResponseError> {
    let mut modes = Vec::with_capacity(p.degree());
    let mut poles = Vec::with_capacity(p.degree());
    for root in isolated_roots_to(p, bits)? {
        poles.push(root.pole);
        if root.pole.im != 0.0 {
            poles.push(Pole { im: -root.pole.im, ..root.pole });
        }
        let m = root.pole.multiplicity;
        let above = taylor(num, &root.center, m + 1);
        // What the numerator changes by from the center to the pole itself.
        let lost = (above[1] * root.center.to_wide()).abs().shifted(KEPT_BITS - bits);
        if root.pole.error_bound > 0.0 && above[0].cmp_abs(lost).is_lt() {
            return Ok(None);
        }
        let below = taylor(den, &root.center, 2 * m);
        for (k, value) in quotient_series(&above[..m], &below[m..]).into_iter().enumerate() {
            if !value.is_zero() {
                let c = value.to_complex();
                let coefficient_im = if root.pole.im == 0.0 { 0.0 } else { c.im };
                let (re, im, power) = (root.pole.re, root.pole.im, m - 1 - k);
                modes.push(Mode { re, im, power, coefficient_re: c.re, coefficient_im });
            }
        }
    }
    Ok(Some((modes, poles)))
}

/// The power series `above` / `below`; what is only rounding is zero.
fn quotient_series(above: &[Wide], below: &[Wide]) -> Vec<Wide> {
    let mut quotient: Vec<Wide> = Vec::with_capacity(above.len());
    for (k, &value) in above.iter().enumerate() {
        let (mut rest, mut size) = (value, value.abs());
        for (j, &earlier) in quotient.iter().enumerate() {
            let product = below[k - j] * earlier;
            rest = rest - product;
            size = size + product.abs();
        }
        let is_rounding = k > 0 && rest.cmp_abs(size * Wide::real(16.0 * f64::EPSILON, 0)).is_le();
        quotient.push(if is_rounding { Wide::ZERO } else { rest / below[0] });
    }
    quotient
}

#[cfg(test)]
#[allow(clippy::excessive_precision, reason = "as many digits as the source gives")]
mod tests {
    use super::InputKind::{Impulse, Step};
    use super::*;
    use crate::lti::matrix_exponential_response;
    use crate::lti::tests::{HANGING, UPRIGHT, tf};

    #[test]
    fn a_value_is_the_beginning_of_its_jet_to_the_last_bit() {
        for (num, den) in [HANGING, UPRIGHT, ("1", "1 5 59 157 152 50"), ("1 2", "1 3 0 0")] {
            let response = Response::new(&tf(num, den), Step).unwrap();
            for i in 1..500 {
                let t = f64::from(i) / 37.0;
                assert_eq!(response.at(t).to_bits(), response.jet(t)[0].to_bits(), "{num} / {den} at {t}");
            }
        }
    }

    /// `times`: (t, y).
    #[track_caller]
    fn check(what: &str, g: (&str, &str), kind: InputKind, accuracy: f64, times: &[(f64, f64)]) {
        let g = tf(g.0, g.1);
        let response = Response::new(&g, kind).unwrap();
        let instants: Vec<f64> = times.iter().map(|&(t, _)| t).collect();
        let other = matrix_exponential_response(&g, kind, &instants).unwrap();
        let peak = times.iter().map(|&(_, y)| y.abs()).fold(0.0, f64::max);
        for (&(t, y), second) in times.iter().zip(other) {
            let found = response.at(t);
            assert!((found - y).abs() <= accuracy * peak, "{what} at {t} s: {found}, not {y}");
            assert!(
                (second - y).abs() <= 1e-9 * peak,
                "{what} at {t} s by matrix exponential: {second}, not {y}"
            );
            let h = 1e-3 / response.modes().iter().map(Mode::speed).fold(1.0, f64::max);
            let slope = (response.at(t + h) - response.at(t - h)) / (2.0 * h);
            let rate = response.rate(t);
            assert!(
                (rate - slope).abs() <= 1e-3 * (peak + rate.abs()),
                "{what} at {t} s: rate {rate}, not {slope}"
            );
        }
    }

    /// mpmath 1.3 with 60 digits (exponential of the companion matrix); python-control 0.10.2 agrees to 1e-6.
    #[test]
    #[rustfmt::skip]
    fn values_against_many_digits() {
        check("hanging impulse", HANGING, Impulse, 1e-13, &[(0.0, 0.0), (0.25, -0.78052777279247548), (1.0, 0.51421469341784927), (10.0, 0.41510976660677454), (100.0, 0.059641108142773782)]);
        check("hanging step", HANGING, Step, 1e-13, &[(0.0, 0.0), (0.25, -0.11851474236737255), (1.0, -0.014679956476844723), (10.0, 0.059605022812768094), (100.0, 0.017795330493408964)]);
        check("upright impulse", UPRIGHT, Impulse, 1e-14, &[(0.0, 0.0), (0.1, 0.47432508864981728), (0.5, 6.4120787922073625), (1.0, 103.88071795567482), (2.0, 27201.859001762398)]);
        check("upright step", UPRIGHT, Step, 1e-14, &[(0.0, 0.0), (0.1, 0.023184884153268147), (0.5, 1.0215513439928093), (1.0, 18.5279172516404), (2.0, 4885.31801583971)]);
        check("double pole", ("1 3", "1 4 4"), Impulse, 1e-15, &[(0.0, 1.0), (0.3, 0.71345512692223437), (1.0, 0.27067056647322538), (3.0, 0.0099150087066654337), (8.0, 1.012816572473332e-6)]);
        check("double pole", ("1 3", "1 4 4"), Step, 1e-15, &[(0.0, 0.0), (0.3, 0.2560695275153762), (1.0, 0.58083089595423414), (3.0, 0.74442280760250069), (8.0, 0.74999946545792008)]);
        check("triple pole with zeros", ("1 -2 5", "1 3 3 1"), Impulse, 2e-15, &[(0.0, 1.0), (0.5, 0.0), (1.0, 0.36787944117144232), (2.0, 1.2180175491295142), (6.0, 0.29992901337662937)]);
        check("triple pole with zeros", ("1 -2 5", "1 3 3 1"), Step, 2e-15, &[(0.0, 0.0), (0.5, 0.14775472229893261), (1.0, 0.21756726477124982), (2.0, 1.0752767861382319), (6.0, 4.57117587343672)]);
        check("resonant pair", ("100", "1 0.2 100"), Step, 1e-14, &[(0.0, 0.0), (0.1, 0.45670100544490315), (1.0, 1.7643883081818187), (10.0, 0.68558475520307394), (60.0, 1.002470094612743)]);
        check("double imaginary pair", ("1", "1 0 2 0 1"), Impulse, 1e-15, &[(0.0, 0.0), (1.0, 0.15058433946987839), (5.0, -1.1886176009896349), (20.0, -3.624347992770106)]);
        check("feed-through", ("2 3 4", "1 2 5"), Step, 1e-15, &[(0.0, 2.0), (0.5, 1.2442896919814091), (1.0, 0.64974094411485468), (3.0, 0.85597374859631688)]);
        check("slow pole beside a fast pair", ("5e19", "1 1e6 1e18 5e19"), Step, 1e-14, &[(0.0, 0.0), (1e-9, 7.9245030338239359e-9), (1e-6, 4.9973642212853665e-5), (0.01, 0.39346934027220559), (0.1, 0.99326205300226207)]);
        check("motor to position", ("0.2083", "1 1.71 0"), Step, 1e-15, &[(0.0, 0.0), (0.5, 0.019966139565144044), (1.0, 0.063461353784804395), (5.0, 0.53784252092754624)]);
        check("gain", ("3", "2"), Step, 1e-15, &[(0.0, 1.5), (7.0, 1.5)]);
        check("gain", ("3", "2"), Impulse, 1e-15, &[(0.0, 0.0), (7.0, 0.0)]);
        check("triple integrator", ("2", "1 0 0 0"), Impulse, 1e-15, &[(0.0, 0.0), (3.0, 9.0)]);
    }

    #[test]
    fn a_cancelled_pair_leaves_no_trace() {
        // (s − 7)(s + 0.001)(s² + 4) above and below.
        let shared = tf("1 -6.999 3.993 -27.996 -0.028", "1");
        let plain = tf("1", "1 1");
        let padded = TransferFunction { num: &plain.num * &shared.num, den: &plain.den * &shared.num };
        for kind in [Impulse, Step] {
            let response = Response::new(&padded, kind).unwrap();
            assert_eq!(response, Response::new(&plain, kind).unwrap());
            assert!(response.modes().iter().all(|mode| mode.re <= 0.0));
        }
        // A step cancels against a zero at the origin.
        assert_eq!(Response::new(&tf("1 0", "1 1"), Step).unwrap().modes().len(), 1);
    }

    /// √2 is 1.41421356237309504880168872420969807856967187537694807317667973799…
    #[test]
    fn a_zero_beside_a_pole_leaves_a_residue_of_the_right_sign() {
        const ROOT: &str = "1.41421356237309504880168872420969807856967187537694807317667973799";
        for places in [8, 15, 18, 20, 25, 30, 40, 60] {
            let below = &ROOT[..places + 2];
            let above = format!("{}9", &below[..below.len() - 1]);
            let above = if below.ends_with('9') { "1.5" } else { &above };
            for (zero, sign) in [(below, 1.0), (above, -1.0)] {
                // (s − zero) / (s² − 2): e^(√2 t) with (√2 − zero) / (2 √2).
                let response = Response::new(&tf(&format!("1 -{zero}"), "1 0 -2"), Impulse).unwrap();
                let growing = response.modes().iter().find(|mode| mode.re > 0.0).unwrap();
                assert_eq!(growing.coefficient_re.signum(), sign, "{zero}");
                let gap = &tf(&format!("1 -{zero}"), "1").num;
                let apart = (gap * &tf(&format!("1 {zero}"), "1").num).coefficient(0)
                    + crate::algebra::Rational::from(2);
                // 2 − zero² = (√2 − zero)(√2 + zero), and that is nearly 2√2.
                let residue = to_f64(&apart) / 8.0;
                let is = growing.coefficient_re / residue;
                assert!((is - 1.0).abs() < if zero == "1.5" { 0.1 } else { 1e-7 }, "{zero}: {is}");
            }
        }
    }

    #[test]
    fn the_impulse_of_a_feed_through_is_kept_apart() {
        let response = Response::new(&tf("2 3 4", "1 2 5"), Impulse).unwrap();
        assert_eq!(response.delta, 2.0);
        assert_eq!(response.at(0.0), -1.0);
        assert_eq!(Response::new(&tf("2 3 4", "1 2 5"), Step).unwrap().delta, 0.0);
    }

    #[test]
    fn improper_transfer_functions_are_refused() {
        let error = ResponseError::Improper { num: 2, den: 1 };
        assert_eq!(Response::new(&tf("1 0 0", "1 1"), Step), Err(error.clone()));
        assert_eq!(matrix_exponential_response(&tf("1 0 0", "1 1"), Impulse, &[1.0]), Err(error));
        // Proper once the common factor is out.
        assert!(Response::new(&tf("1 0 0", "1 0"), Step).is_err());
        assert!(Response::new(&tf("1 0 0", "1 0 0"), Step).is_ok());
    }

    #[test]
    fn extremes_stay_finite() {
        let response = Response::new(&tf("1", "1 -1e6"), Step).unwrap();
        assert!(response.at(1e9).is_finite() && response.rate(1e9).is_finite());
        assert_eq!(Response::new(&tf("0", "1 1"), Impulse).unwrap().at(3.0), 0.0);
        assert_eq!(Response::new(&tf("1e400", "1 1"), Impulse), Err(ResponseError::OutOfRange));
        assert_eq!(
            matrix_exponential_response(&tf("1", "1 1e400"), Impulse, &[1.0]),
            Err(ResponseError::OutOfRange)
        );
    }

    #[test]
    fn the_time_axis_shows_the_behaviour() {
        #[track_caller]
        fn check(what: &str, g: (&str, &str), kind: InputKind, horizon: f64) {
            assert_eq!(Response::new(&tf(g.0, g.1), kind).unwrap().horizon_s(), horizon, "{what}");
        }
        check("hanging: 5 % after 153 s", HANGING, Impulse, 200.0);
        check("upright: e^(5.57 t)", UPRIGHT, Impulse, 1.0);
        check("time constant 2 s: 3τ", ("1", "2 1"), Step, 8.0);
        check("time constant 2 ms", ("1", "0.002 1"), Step, 0.008);
        check("undamped, 1 rad/s: eight periods", ("1", "1 0 1"), Impulse, 60.0);
        check("motor to position: five time constants of the transient", ("0.2083", "1 1.71 0"), Step, 3.0);
        check("integrator: no scale", ("1", "1 0"), Step, 10.0);
        check("gain: no scale", ("1", "1"), Step, 10.0);
        check("zero", ("0", "1 1"), Step, 10.0);
        check("hardly damped: at most 400 periods", ("1", "1 1e-9 1"), Impulse, 3000.0);
    }
}
