use super::motion::Motion;
use super::{Equilibrium, Linearization, Model, ModelError, linearize};
use crate::algebra::{Matrix, Rational, to_f64};
use crate::nonlinear::{OdeError, Thinning, Trajectory, integrate};
use nalgebra::{DMatrix, DVector, RowDVector};
use std::collections::BTreeMap;

/// How linear and nonlinear answers to a push are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Seconds looked at.
    pub horizon_s: f64,
    /// Relative departure (of the linear peak) at which they are said to part: 0.1 is 10 %.
    pub departure: f64,
    /// Impulses (input unit · s) to draw.
    pub pushes: Vec<f64>,
}

/// (t, linear, nonlinear).
pub type ComparisonSample = (f64, f64, f64);

/// Output deviation after an impulse at the input, linear beside nonlinear.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonRun {
    /// How they were compared: as the lab says, or as [`compare_as_usual`] chose.
    pub asked: Comparison,
    /// (push, samples of (t, linear, nonlinear)), output deviation from equilibrium in its unit; some 600 samples at most.
    pub runs: Vec<(f64, Vec<ComparisonSample>)>,
    /// The smallest impulse (input unit · s) whose departure reaches `Comparison::departure`, to three figures or better;
    /// `None` if none up to a million times the smallest push does (or every one down to a millionth of it).
    pub parting_push: Option<f64>,
    /// The largest |output| of the linear model at that push.
    pub parting_amplitude: Option<f64>,
}

/// Integrates the nonlinear equations beside the linear model after impulses at the input.
///
/// An impulse makes the rates (of coordinates that have but one derivative, the values) jump as the linear model does at
/// the equilibrium; from there both move without input. The departure is max |nonlinear − linear| / max |linear|.
///
/// Accuracy: the linear curve to rounding (matrix exponential), the nonlinear to 1e-7 of its peak while it does not
/// depend on how it started to the last digit; both are looked at in 2,000 instants.
/// Errors: those of [`linearize`]; [`ModelError::NotLinear`] when the highest derivatives do not enter linearly;
/// [`ModelError::Simulation`] when the equations cannot be followed after one of the pushes to draw.
pub fn compare(
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    input: &str,
    output: &str,
    comparison: &Comparison,
) -> Result<ComparisonRun, ModelError> {
    let linearization = linearize(model, parameters, at, input, output)?;
    let experiment = Experiment::new(model, parameters, at, output, &linearization, comparison.horizon_s)?;
    let sizes = comparison.pushes.iter().map(|push| push.abs()).filter(|push| *push > 0.0);
    let smallest = sizes.fold(f64::INFINITY, f64::min);
    let runs = experiment.runs(&comparison.pushes)?;
    let parting_push = experiment.parting_push(smallest, comparison.departure);
    Ok(experiment.told(comparison.clone(), runs, parting_push))
}

/// [`compare`] over the time an impulse response is shown, where a lab does not say how.
///
/// They are said to part at a tenth of the linear peak, and two impulses are drawn, each rounded down to one figure: the one
/// at which they part, and a fifth of it. It is looked for from the impulse after which the linear output reaches 1.
/// `None` where there is nothing to see or to follow: the equations are linear, have no states, or answer an impulse with one of
/// their own; no such impulse is within a million times of that; or they cannot be followed after it.
pub fn compare_as_usual(
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    output: &str,
    linearization: &Linearization,
    horizon_s: f64,
) -> Option<ComparisonRun> {
    let through = linearization.state_space.as_ref()?.d.rows.iter().flatten().any(|d| !d.is_zero());
    let nothing_seen = linearization.transfer_function.num.is_zero();
    if linearization.states.is_empty() || through || nothing_seen || is_linear(model, output) {
        return None;
    }
    let experiment = Experiment::new(model, parameters, at, output, linearization, horizon_s).ok()?;
    let peak = experiment.linear_peak();
    if !(peak > 0.0 && peak.is_finite()) {
        return None;
    }
    let parting_push = experiment.parting_push(1.0 / peak, USUAL_DEPARTURE)?;
    // Where the equations break off before they part, there is no such push.
    if (experiment.departure(parting_push) / USUAL_DEPARTURE - 1.0).abs() > 0.01 {
        return None;
    }
    let pushes: Vec<f64> = [parting_push / 5.0, parting_push].map(one_figure_down).into();
    let runs = experiment.runs(&pushes).ok()?;
    let asked = Comparison { horizon_s, departure: USUAL_DEPARTURE, pushes };
    Some(experiment.told(asked, runs, Some(parting_push)))
}

/// Whether no slope of an equation depends on where it is taken; the formulas of other outputs do not count.
fn is_linear(model: &Model, output: &str) -> bool {
    let moving = |name: &str| {
        model.coordinates.iter().any(|c| c.name == name) || model.inputs.iter().any(|i| i == name)
    };
    let counts = |index: &usize| model.output_of(*index).is_none_or(|own| own == output);
    (0..model.equations.len()).filter(counts).all(|index| {
        let residual = model.residual(index);
        let mut symbols: Vec<(String, u8)> =
            residual.symbols().into_iter().map(|symbol| (symbol.name, symbol.primes)).collect();
        symbols.sort();
        symbols.dedup();
        symbols.iter().filter(|(name, _)| moving(name)).all(|(name, primes)| {
            let slope = residual.differentiate(name, *primes);
            !slope.symbols().iter().any(|symbol| moving(&symbol.name))
        })
    })
}

/// 0.0375 → 0.03.
fn one_figure_down(value: f64) -> f64 {
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let first: String = digits.chars().take(1).collect();
    format!("{first}e{exponent}").parse().unwrap_or(value)
}

/// Of the linear peak, where a lab does not say.
const USUAL_DEPARTURE: f64 = 0.1;
/// Instants at which the curves are looked at, after the first.
const INSTANTS: usize = 2_000;
/// Of the integrator, for curves that are drawn.
const DRAWN_TOLERANCE: f64 = 1e-9;
/// Of the integrator, while the parting push is searched for: a departure of some percent needs no more.
const SEARCH_TOLERANCE: f64 = 1e-7;
/// A push is a parting one when its departure is this close (relative) to the one asked for.
const PARTING_TOLERANCE: f64 = 1e-5;
/// What lines between samples may miss, of the peak of the smaller curve; doubled until few enough are left.
const DRAWING_TOLERANCE: f64 = 1e-3;
const SAMPLES_LIMIT: usize = 600;

struct Experiment {
    motion: Motion,
    /// The state right after an impulse of 1, as a deviation.
    start: Vec<f64>,
    /// The linear output after an impulse of 1, at each instant.
    linear: Vec<f64>,
    horizon_s: f64,
}

impl Experiment {
    fn new(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        at: &Equilibrium,
        output: &str,
        linearization: &Linearization,
        horizon_s: f64,
    ) -> Result<Self, ModelError> {
        Ok(Self {
            motion: Motion::new(model, parameters, at, output)?,
            start: column(&linearization.state_space.as_ref().ok_or(ModelError::Singular)?.b),
            linear: impulse_response(linearization, horizon_s)?,
            horizon_s,
        })
    }

    /// What is drawn of each push.
    fn runs(&self, pushes: &[f64]) -> Result<Vec<(f64, Vec<ComparisonSample>)>, ModelError> {
        let run = |push: &f64| {
            let nonlinear = self
                .nonlinear(*push, DRAWN_TOLERANCE)
                .map_err(|source| ModelError::Simulation { push: *push, source })?;
            Ok((*push, self.samples(*push, &nonlinear)))
        };
        pushes.iter().map(run).collect()
    }

    fn told(
        &self,
        asked: Comparison,
        runs: Vec<(f64, Vec<ComparisonSample>)>,
        parting_push: Option<f64>,
    ) -> ComparisonRun {
        let parting_amplitude = parting_push.map(|push| push * self.linear_peak());
        ComparisonRun { asked, runs, parting_push, parting_amplitude }
    }

    /// The output's deviation after an impulse of `push`, at each instant.
    fn nonlinear(&self, push: f64, tolerance: f64) -> Result<Vec<f64>, OdeError> {
        let start: Vec<f64> = self.start.iter().map(|x| x * push).collect();
        let mut workspace = self.motion.workspace();
        let trajectory: Trajectory = integrate(
            |_, state, rates| self.motion.rates(state, rates, &mut workspace),
            &start,
            self.horizon_s,
            tolerance,
        )?;
        let outputs = instants(self.horizon_s).map(|t| match self.motion.output_state() {
            Some(state) => trajectory.component(state, t),
            None => self.motion.solved_output(&trajectory.at(t), &mut workspace),
        });
        Ok(outputs.collect())
    }

    fn linear_peak(&self) -> f64 {
        peak(&self.linear)
    }

    /// How far nonlinear departs from linear; infinite when it cannot be followed.
    fn departure(&self, push: f64) -> f64 {
        let Ok(nonlinear) = self.nonlinear(push, SEARCH_TOLERANCE) else { return f64::INFINITY };
        let gap = nonlinear.iter().zip(&self.linear).map(|(y, unit)| (y - push * unit).abs());
        gap.fold(0.0, f64::max) / (push * self.linear_peak())
    }

    /// Looked for from `smallest`.
    fn parting_push(&self, smallest: f64, wanted: f64) -> Option<f64> {
        let peak = self.linear_peak();
        if !smallest.is_finite() || peak.is_nan() || peak <= 0.0 || wanted.is_nan() {
            return None;
        }
        // ln(departure / wanted): nearly a straight line over ln(push), for the departure grows as a power of it.
        let excess = |log_push: f64| (self.departure(log_push.exp()) / wanted).ln();
        let (mut low, mut high) = bracket(excess, smallest.ln())?;
        // The secant of the bracket (Illinois: an end that stays twice is trusted half as much), or its middle where
        // an end is infinite.
        let mut last = 0.0;
        for _ in 0..60 {
            let secant = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            let middle = (low.0 + high.0) / 2.0;
            let next = if low.0 < secant && secant < high.0 { secant } else { middle };
            let value = excess(next);
            if value.abs() < PARTING_TOLERANCE || high.0 - low.0 < PARTING_TOLERANCE {
                return Some(next.exp());
            }
            let stayed = if value < 0.0 { &mut high.1 } else { &mut low.1 };
            if value * last > 0.0 {
                *stayed /= 2.0;
            }
            *(if value < 0.0 { &mut low } else { &mut high }) = (next, value);
            last = value;
        }
        Some(high.0.exp())
    }

    fn samples(&self, push: f64, nonlinear: &[f64]) -> Vec<ComparisonSample> {
        let linear = self.linear.iter().map(|unit| push * unit);
        let points: Vec<(f64, [f64; 2])> = instants(self.horizon_s)
            .zip(linear.zip(nonlinear))
            .map(|(t, (linear, &nonlinear))| (t, [linear, nonlinear]))
            .collect();
        let smaller_peak = (push.abs() * self.linear_peak()).min(peak(nonlinear));
        let mut tolerance = DRAWING_TOLERANCE * smaller_peak;
        loop {
            let mut thinning = Thinning::new([tolerance; 2]);
            points.iter().for_each(|point| thinning.add(*point));
            let samples = thinning.finish();
            if samples.len() <= SAMPLES_LIMIT || !(tolerance > 0.0 && tolerance.is_finite()) {
                return samples.into_iter().map(|(t, [linear, nonlinear])| (t, linear, nonlinear)).collect();
            }
            tolerance *= 2.0;
        }
    }
}

/// Two values of ln(push) a factor of four apart, each with its excess: the first below 0, the second not.
fn bracket(excess: impl Fn(f64) -> f64, start: f64) -> Option<((f64, f64), (f64, f64))> {
    let step = 4f64.ln();
    let mut here = (start, excess(start));
    let up = here.1 < 0.0;
    // 4^10 is a little more than a million.
    for _ in 0..10 {
        let next = here.0 + if up { step } else { -step };
        let next = (next, excess(next));
        match (up, next.1 < 0.0) {
            (true, false) => return Some((here, next)),
            (false, true) => return Some((next, here)),
            _ => here = next,
        }
    }
    None
}

/// The linear output after an impulse of 1, at each instant.
fn impulse_response(linearization: &Linearization, horizon_s: f64) -> Result<Vec<f64>, ModelError> {
    let space = linearization.state_space.as_ref().ok_or(ModelError::Singular)?;
    let mut state = DVector::from_vec(column(&space.b));
    let output = RowDVector::from_vec(column_of_row(&space.c));
    let n = state.len();
    if n == 0 {
        return Ok(vec![0.0; INSTANTS + 1]);
    }
    let a = DMatrix::from_fn(n, n, |i, j| to_f64(&space.a.rows[i][j]));
    let step = (a * (horizon_s / INSTANTS as f64)).exp();
    let mut outputs = Vec::with_capacity(INSTANTS + 1);
    for _ in 0..=INSTANTS {
        outputs.push((&output * &state)[(0, 0)]);
        state = &step * state;
    }
    if let Some(nth) = outputs.iter().position(|y| !y.is_finite()) {
        let time_s = horizon_s * nth as f64 / INSTANTS as f64;
        return Err(ModelError::Simulation { push: 1.0, source: OdeError::NotFinite { time_s } });
    }
    Ok(outputs)
}

fn instants(horizon_s: f64) -> impl Iterator<Item = f64> {
    (0..=INSTANTS).map(move |nth| horizon_s * nth as f64 / INSTANTS as f64)
}

fn peak(values: &[f64]) -> f64 {
    values.iter().map(|y| y.abs()).fold(0.0, f64::max)
}

fn column(matrix: &Matrix) -> Vec<f64> {
    matrix.rows.iter().filter_map(|row| row.first()).map(to_f64).collect()
}

fn column_of_row(matrix: &Matrix) -> Vec<f64> {
    matrix.rows.first().into_iter().flatten().map(to_f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::model::Coordinate;

    struct Plant {
        coordinates: &'static [&'static str],
        parameters: &'static [(&'static str, &'static str)],
        equations: &'static [&'static str],
        at: &'static [(&'static str, &'static str)],
        input: &'static str,
        output: &'static str,
    }

    const HANGING: Plant = Plant {
        coordinates: &["x", "theta"],
        parameters: &[("M", "0.5"), ("b", "0.1"), ("m", "0.2"), ("l", "0.3"), ("I", "0.006"), ("g", "9.81")],
        equations: &[
            "F = (M + m)*x'' + b*x' + m*l*theta''*cos(theta) - m*l*theta'^2*sin(theta)",
            "(I + m*l^2)*theta'' + m*g*l*sin(theta) + m*l*x''*cos(theta) = 0",
        ],
        at: &[],
        input: "F",
        output: "theta",
    };

    const UPRIGHT: Plant = Plant { at: &[("theta", "pi")], ..HANGING };

    /// A pendulum without friction: its swing after a push follows from its energy.
    const PENDULUM: Plant = Plant {
        coordinates: &["theta"],
        parameters: &[("g", "9.81")],
        equations: &["theta'' + g*sin(theta) = u"],
        at: &[],
        input: "u",
        output: "theta",
    };

    impl Plant {
        fn at(&self) -> Result<(Model, BTreeMap<String, Rational>, Equilibrium), ModelError> {
            let coordinate =
                |n: &&str| Coordinate { name: (*n).into(), unit: String::new(), description: String::new() };
            let model = Model::new(
                self.coordinates.iter().map(coordinate).collect(),
                vec![self.input.to_owned()],
                self.parameters.iter().map(|(n, _)| (*n).to_owned()).collect(),
                self.equations,
            )?;
            let parameters =
                self.parameters.iter().map(|(n, v)| ((*n).to_owned(), parse_decimal(v).unwrap())).collect();
            let pairs: Vec<_> = self.at.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
            let at = Equilibrium::parse(&model, &parameters, &pairs)?;
            Ok((model, parameters, at))
        }

        fn compare(&self, comparison: &Comparison) -> Result<ComparisonRun, ModelError> {
            let (model, parameters, at) = self.at()?;
            compare(&model, &parameters, &at, self.input, self.output, comparison)
        }

        #[track_caller]
        fn run(&self, horizon_s: f64, departure: f64, pushes: &[f64]) -> ComparisonRun {
            self.compare(&Comparison { horizon_s, departure, pushes: pushes.to_vec() }).unwrap()
        }
    }

    fn between(samples: &[ComparisonSample], t: f64) -> (f64, f64) {
        let after = samples.partition_point(|sample| sample.0 < t).clamp(1, samples.len() - 1);
        let (from, to) = (samples[after - 1], samples[after]);
        let x = (t - from.0) / (to.0 - from.0);
        (from.1 + x * (to.1 - from.1), from.2 + x * (to.2 - from.2))
    }

    #[test]
    fn cart_and_pendulum_against_another_program() {
        // scipy 1.x: DOP853 at rtol 1e-12 and expm; parting pushes by brentq over 2,001 instants.
        type Row = (f64, f64, f64, f64);
        let check = |name: &str, plant: &Plant, horizon_s: f64, rows: &[Row], parting: &[(f64, f64, f64)]| {
            let mut pushes: Vec<f64> = rows.iter().map(|row| row.0).collect();
            pushes.dedup();
            for &(departure, push, amplitude) in parting {
                let run = plant.run(horizon_s, departure, &pushes);
                for &(push, t, nonlinear, linear) in rows {
                    let (_, samples) = run.runs.iter().find(|(drawn, _)| *drawn == push).unwrap();
                    assert!(samples.len() <= SAMPLES_LIMIT, "{name}: {} samples", samples.len());
                    let found = between(samples, t);
                    // Lines between samples miss what they may of the smaller peak.
                    let peak = |pick: fn(&ComparisonSample) -> f64| {
                        samples.iter().map(|s| pick(s).abs()).fold(0.0, f64::max)
                    };
                    let allowed = 2e-3 * peak(|s| s.1).min(peak(|s| s.2));
                    assert!((found.0 - linear).abs() < allowed, "{name} at {t}: {found:?}, linear {linear}");
                    assert!(
                        (found.1 - nonlinear).abs() < allowed,
                        "{name} at {t}: {found:?}, nonlinear {nonlinear}"
                    );
                }
                let found = run.parting_push.unwrap();
                assert!((found / push - 1.0).abs() < 1e-4, "{name}: parts at {found}, not {push}");
                let found = run.parting_amplitude.unwrap();
                assert!((found / amplitude - 1.0).abs() < 1e-4, "{name}: parts at {found}, not {amplitude}");
            }
        };
        check(
            "hanging",
            &HANGING,
            6.0,
            &[
                (0.2, 1.0, 0.10545034397231581, 0.10284293868356938),
                (0.2, 3.3, 0.06897536477753569, 0.060448568943446856),
                (0.2, 6.0, -0.12861580016490048, -0.12110031791887776),
                (1.0, 1.0, 0.762998602845232, 0.5142146934178469),
                (1.0, 3.3, 0.7891273214459419, 0.3022428447172343),
                (1.0, 6.0, 0.2626140404195146, -0.6055015895943888),
            ],
            &[
                (0.1, 0.2146415376811889, 0.17573412164193164),
                (0.01, 0.06788544268543112, 0.055580055805961794),
            ],
        );
        check(
            "upright",
            &UPRIGHT,
            0.8,
            &[
                (0.01, 0.2, 0.010919182926956594, 0.010919261659087649),
                (0.01, 0.8, 0.33785101406919305, 0.34120536122537554),
                (0.2, 0.5, 1.1655266065967167, 1.282415758441512),
                (0.2, 0.8, 3.8591917797796933, 6.824107224507511),
            ],
            &[
                (0.1, 0.03888804610127641, 1.3268809817335074),
                (0.01, 0.01008915013084313, 0.3442472114851375),
            ],
        );
    }

    #[test]
    fn the_ends_of_the_curves_are_exact() {
        for (plant, horizon_s, push, nonlinear, linear) in [
            (HANGING, 6.0, 0.2, -0.12861580016490048, -0.12110031791887776),
            (HANGING, 6.0, 1.0, 0.2626140404195146, -0.6055015895943888),
            (UPRIGHT, 0.8, 0.01, 0.33785101406919305, 0.34120536122537554),
        ] {
            let run = plant.run(horizon_s, 0.1, &[push]);
            let &(t, drawn_linear, drawn_nonlinear) = run.runs[0].1.last().unwrap();
            assert_eq!(t, horizon_s);
            assert!((drawn_linear - linear).abs() < 1e-11, "{drawn_linear}, not {linear}");
            assert!((drawn_nonlinear - nonlinear).abs() < 1e-7, "{drawn_nonlinear}, not {nonlinear}");
        }
    }

    #[test]
    fn a_swing_is_as_high_as_its_energy() {
        // θ'(0) = J: the swing ends where cos θ = 1 - J²/2g; past J = 2√g it goes over the top.
        let run = PENDULUM.run(6.0, 0.1, &[1.0, 5.0, 6.2]);
        for (push, samples) in &run.runs {
            let peak = samples.iter().map(|sample| sample.2.abs()).fold(0.0, f64::max);
            let expected = (1.0 - push * push / (2.0 * 9.81)).acos();
            assert!((peak / expected - 1.0).abs() < 2e-3, "push {push}: {peak}, not {expected}");
        }
        let over = PENDULUM.run(6.0, 0.1, &[6.3]);
        assert!(over.runs[0].1.last().unwrap().2 > std::f64::consts::TAU);
    }

    #[test]
    fn an_equilibrium_stays_where_it_is() {
        // sin(π) is not 0 in floating point, and e^(5.6·6) would make it seen.
        let run = UPRIGHT.run(6.0, 0.1, &[0.0]);
        assert!(run.runs[0].1.iter().all(|sample| sample.1 == 0.0 && sample.2 == 0.0));
        assert_eq!(run.parting_push, None);
    }

    #[test]
    fn pushes_the_other_way_mirror() {
        let run = HANGING.run(6.0, 0.1, &[0.5, -0.5]);
        for (right, left) in run.runs[0].1.iter().zip(&run.runs[1].1) {
            assert!((right.0 - left.0).abs() < 1e-12 && (right.1 + left.1).abs() < 1e-12);
            assert!((right.2 + left.2).abs() < 1e-9);
        }
    }

    #[test]
    fn the_search_goes_down_as_well_as_up() {
        let (from_below, from_above) = (HANGING.run(6.0, 0.1, &[0.001]), HANGING.run(6.0, 0.1, &[3.0]));
        let (below, above) = (from_below.parting_push.unwrap(), from_above.parting_push.unwrap());
        assert!((below / above - 1.0).abs() < 1e-4, "{below}, {above}");
    }

    #[test]
    fn a_linear_plant_never_parts() {
        let spring = Plant { equations: &["theta'' + g*theta = u"], ..PENDULUM };
        let run = spring.run(6.0, 0.01, &[1.0, 10.0]);
        assert_eq!((run.parting_push, run.parting_amplitude), (None, None));
        for (_, samples) in &run.runs {
            assert!(samples.iter().all(|sample| (sample.1 - sample.2).abs() < 1e-7));
        }
        assert_eq!(spring.run(6.0, 0.01, &[]).parting_push, None);
        assert_eq!(spring.run(0.0, 0.01, &[1.0]).parting_push, None);
    }

    #[test]
    fn other_shapes_of_equations() {
        // First order: the level itself jumps, by J/A.
        let tank = Plant {
            coordinates: &["h"],
            parameters: &[("A", "2"), ("k", "0.5")],
            equations: &["A*h' = u - k*h^2"],
            at: &[("h", "2"), ("u", "2")],
            input: "u",
            output: "h",
        };
        // ḣ = (2 − 0.5 h²)/2: with h(0) = 3, h = 2·(1 + c)/(1 − c), c = (1/5)·e^(−t).
        let run = tank.run(3.0, 0.1, &[2.0]);
        let &(t, linear, nonlinear) = run.runs[0].1.last().unwrap();
        let c = (-t).exp() / 5.0;
        assert!((linear - (-3.0f64).exp()).abs() < 1e-12, "{linear}");
        assert!((nonlinear - (2.0 * (1.0 + c) / (1.0 - c) - 2.0)).abs() < 1e-8, "{nonlinear}");

        // An output that is not a state but follows from the others.
        let reading = Plant {
            coordinates: &["h", "reading"],
            equations: &["A*h' = u - k*h^2", "reading = 10*h"],
            at: &[("h", "2"), ("u", "2"), ("reading", "20")],
            output: "reading",
            ..tank
        };
        let read = reading.run(3.0, 0.1, &[2.0]);
        assert!((read.runs[0].1.last().unwrap().2 - 10.0 * nonlinear).abs() < 1e-7);
        assert!((read.parting_push.unwrap() / run.parting_push.unwrap() - 1.0).abs() < 1e-4);
    }

    #[test]
    fn what_cannot_be_followed() {
        let of = |equations: &'static [&'static str]| {
            Plant { equations, ..PENDULUM }.compare(&Comparison {
                horizon_s: 5.0,
                departure: 0.1,
                pushes: vec![3.0],
            })
        };
        let error = of(&["theta''^2 + theta'' + g*theta = u"]).unwrap_err();
        assert_eq!(error, ModelError::NotLinear { equation: 1, symbol: "theta''".into() });
        // θ'' = θ'² + u explodes a third of a second after a push of 3.
        let error = of(&["theta'' + 0*g = theta'^2 + u"]).unwrap_err();
        assert!(matches!(error, ModelError::Simulation { push: 3.0, .. }), "{error}");
    }

    /// What is chosen where a lab does not say.
    #[test]
    fn as_usual() {
        #[track_caller]
        fn check(plant: &Plant, horizon_s: f64, pushes: Option<[f64; 2]>) {
            let (model, parameters, at) = plant.at().unwrap();
            let linearization = linearize(&model, &parameters, &at, plant.input, plant.output).unwrap();
            let run = compare_as_usual(&model, &parameters, &at, plant.output, &linearization, horizon_s);
            let found = run.as_ref().map(|run| run.asked.pushes.clone());
            assert_eq!(found, pushes.map(Vec::from), "{:?}", plant.equations);
            if let Some(run) = run {
                // The same as when it is asked for.
                let again = plant.compare(&run.asked).unwrap();
                assert_eq!(run.runs, again.runs);
                let (one, other) = (run.parting_push.unwrap(), again.parting_push.unwrap());
                assert!((one / other - 1.0).abs() < 1e-4, "{one}, {other}");
            }
        }
        let linear = Plant { equations: &["theta'' + g*theta = u"], ..PENDULUM };
        check(&linear, 5.0, None);
        // After a push of √9.81 θ the swings lag by ωt θ²/16 radians: by a tenth in 5 s where θ is 0.32, the push 1.
        check(&PENDULUM, 5.0, Some([0.1, 0.9]));
        let through = Plant {
            coordinates: &["theta", "y"],
            output: "y",
            equations: &["theta'' + g*sin(theta) = u", "y = theta + u"],
            ..PENDULUM
        };
        check(&through, 5.0, None);
        let still = Plant { equations: &["g*theta^3 + theta = u"], ..PENDULUM };
        check(&still, 5.0, None);
    }

    #[test]
    fn pushes_are_round() {
        for (value, round) in [(0.0375, 0.03), (9.99, 9.0), (1.0, 1.0), (2e-7, 2e-7), (12345.0, 10000.0)] {
            assert_eq!(one_figure_down(value), round);
        }
    }
}
