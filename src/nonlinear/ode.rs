use crate::algebra::significant;
/// The solution of an initial value problem on 0..=end, as one polynomial a step: values at any time between.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    dimension: usize,
    start: Vec<f64>,
    steps: Vec<Step>,
}

/// One step of the integrator: `dense` holds five coefficients a component, in Hairer's nested form.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    from: f64,
    length: f64,
    dense: Vec<[f64; 5]>,
}

impl Trajectory {
    /// The state at time `t` s; before the start and beyond the end, the state there.
    pub fn at(&self, t: f64) -> Vec<f64> {
        (0..self.dimension).map(|component| self.component(component, t)).collect()
    }

    /// One component of [`Trajectory::at`].
    pub fn component(&self, component: usize, t: f64) -> f64 {
        let after = self.steps.partition_point(|step| step.from <= t);
        let Some(step) = self.steps.get(after.saturating_sub(1)) else { return self.start[component] };
        let theta = ((t - step.from) / step.length).clamp(0.0, 1.0);
        let [c0, c1, c2, c3, c4] = step.dense[component];
        let rest = 1.0 - theta;
        c0 + theta * (c1 + rest * (c2 + theta * (c3 + rest * c4)))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OdeError {
    #[error("more than {limit} steps before t = {} s", significant(*time_s, 6))]
    StepLimit { limit: usize, time_s: f64 },
    #[error("the solution left the range of numbers at t = {} s", significant(*time_s, 6))]
    NotFinite { time_s: f64 },
    #[error("the step size fell below what numbers resolve at t = {} s", significant(*time_s, 6))]
    StepTooSmall { time_s: f64 },
}

/// Steps, rejected ones included, before [`integrate`] gives up: some tenths of a second of work.
const STEP_LIMIT: usize = 200_000;

/// Solves ẋ = `f(t, x, &mut dx)` from `x0` at t = 0 until `end_s`.
///
/// Accuracy: each step's error is held below `relative_tolerance` times the largest size each component has had so
/// far; the error at the end, and between steps, is some ten times that on well-behaved problems. Tolerances below
/// 1e-13 count as 1e-13.
/// Errors: a stiff problem ends in [`OdeError::StepLimit`], an explosion in [`OdeError::NotFinite`], a singularity in
/// [`OdeError::StepTooSmall`] or either of the others; the call always returns.
/// Source: Dormand–Prince 5(4) with PI step control and its continuous extension of order 4; Hairer, Nørsett & Wanner,
/// *Solving Ordinary Differential Equations I*, II.4–II.6 and the program DOPRI5.
pub fn integrate(
    mut f: impl FnMut(f64, &[f64], &mut [f64]),
    x0: &[f64],
    end_s: f64,
    relative_tolerance: f64,
) -> Result<Trajectory, OdeError> {
    let n = x0.len();
    let tolerance = relative_tolerance.max(1e-13);
    let mut trajectory = Trajectory { dimension: n, start: x0.to_vec(), steps: Vec::new() };
    if x0.iter().any(|x| !x.is_finite()) || !end_s.is_finite() {
        return Err(OdeError::NotFinite { time_s: 0.0 });
    }
    if end_s <= 0.0 || n == 0 {
        return Ok(trajectory);
    }

    let mut t = 0.0;
    let mut x = x0.to_vec();
    let mut largest: Vec<f64> = x.iter().map(|x| x.abs()).collect();
    let mut k = [const { Vec::new() }; 7];
    k.fill(vec![0.0; n]);
    let mut next = vec![0.0; n];
    f(t, &x, &mut k[0]);
    let mut h = first_step(&x, &k[0], end_s);
    let mut previous_error: f64 = 1e-4;
    let mut rejected = false;

    for _ in 0..STEP_LIMIT {
        if end_s - t <= 1e-14 * end_s {
            return Ok(trajectory);
        }
        let last = t + 1.01 * h >= end_s;
        if last {
            h = end_s - t;
        }
        if h <= 4.0 * f64::EPSILON * t {
            let finite = k[0].iter().all(|dx| dx.is_finite());
            return Err(if finite {
                OdeError::StepTooSmall { time_s: t }
            } else {
                OdeError::NotFinite { time_s: t }
            });
        }
        for (stage, row) in STAGES.iter().enumerate() {
            for i in 0..n {
                let slope: f64 = row.iter().zip(&k).map(|(a, k)| a * k[i]).sum();
                next[i] = x[i] + h * slope;
            }
            f(t + NODES[stage] * h, &next, &mut k[stage + 1]);
        }
        // `next` is now the solution of order 5, `k[6]` the slope there, which opens the next step.
        let mut square = 0.0;
        for i in 0..n {
            let error: f64 = h * ERROR.iter().zip(&k).map(|(e, k)| e * k[i]).sum::<f64>();
            let scale = tolerance * largest[i].max(next[i].abs());
            if error != 0.0 {
                square += (error / scale.max(f64::MIN_POSITIVE)).powi(2);
            }
        }
        let error = (square / n as f64).sqrt();
        if !error.is_finite() || next.iter().chain(&k[6]).any(|value| !value.is_finite()) {
            if h <= 1e-12 * end_s {
                return Err(OdeError::NotFinite { time_s: t });
            }
            h *= 0.1;
            rejected = true;
            continue;
        }
        if error > 1.0 {
            h *= (0.9 * error.powf(-0.2)).max(0.2);
            rejected = true;
            continue;
        }
        trajectory.steps.push(Step { from: t, length: h, dense: dense(&x, &next, &k, h) });
        t = if last { end_s } else { t + h };
        std::mem::swap(&mut x, &mut next);
        for (largest, x) in largest.iter_mut().zip(&x) {
            *largest = largest.max(x.abs());
        }
        k.swap(0, 6);
        let factor = 0.9 * error.max(1e-10).powf(-0.17) * previous_error.powf(0.04);
        h *= factor.clamp(0.2, if rejected { 1.0 } else { 10.0 });
        previous_error = error.max(1e-4);
        rejected = false;
    }
    Err(OdeError::StepLimit { limit: STEP_LIMIT, time_s: t })
}

/// A cautious first step: a hundredth of the time in which the state changes by its own size.
fn first_step(x: &[f64], slope: &[f64], end_s: f64) -> f64 {
    let time = x
        .iter()
        .zip(slope)
        .filter(|(x, dx)| **x != 0.0 && **dx != 0.0)
        .map(|(x, dx)| (x / dx).abs())
        .fold(f64::INFINITY, f64::min);
    (0.01 * time).clamp(1e-9 * end_s, 1e-3 * end_s)
}

fn dense(x: &[f64], next: &[f64], k: &[Vec<f64>; 7], h: f64) -> Vec<[f64; 5]> {
    (0..x.len())
        .map(|i| {
            let difference = next[i] - x[i];
            let bulge = h * k[0][i] - difference;
            let quartic: f64 = DENSE.iter().zip(k).map(|(d, k)| d * k[i]).sum();
            [x[i], difference, bulge, difference - h * k[6][i] - bulge, h * quartic]
        })
        .collect()
}

const NODES: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];

const STAGES: [&[f64]; 6] = [
    &[0.2],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

const DENSE: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

#[cfg(test)]
mod tests {
    use super::*;

    fn pendulum(_: f64, x: &[f64], dx: &mut [f64]) {
        dx[0] = x[1];
        dx[1] = -9.81 * x[0].sin();
    }

    #[test]
    fn closed_forms_are_met_everywhere() {
        type Case = (&'static str, fn(f64, &[f64], &mut [f64]), &'static [f64], f64, fn(f64) -> f64);
        let cases: [Case; 5] = [
            ("decay", |_, x, dx| dx[0] = -x[0], &[1.0], 10.0, |t| (-t).exp()),
            ("growth", |_, x, dx| dx[0] = x[0], &[1.0], 10.0, |t| t.exp()),
            ("oscillation", |_, x, dx| (dx[0], dx[1]) = (x[1], -x[0]), &[0.0, 1.0], 20.0, |t| t.sin()),
            ("time alone", |t, _, dx| dx[0] = 3.0 * t * t, &[0.0], 2.0, |t| t.powi(3)),
            ("from a state of zeros", |t, x, dx| dx[0] = t - x[0], &[0.0], 5.0, |t| t - 1.0 + (-t).exp()),
        ];
        for (name, f, x0, end, solution) in cases {
            let peak = (0..=100).map(|i| solution(end * f64::from(i) / 100.0).abs()).fold(0.0, f64::max);
            for tolerance in [1e-6, 1e-9, 1e-12] {
                let trajectory = integrate(f, x0, end, tolerance).unwrap();
                for i in 0..=1000 {
                    let t = end * f64::from(i) / 1000.0;
                    let error = (trajectory.component(0, t) - solution(t)).abs() / peak;
                    assert!(error < 60.0 * tolerance, "{name}, tolerance {tolerance}, t = {t}: {error}");
                }
            }
        }
    }

    #[test]
    fn a_hundred_thousandth_of_the_tolerance_costs_ten_times_the_calls() {
        // Order 5: calls grow as tolerance^(-1/5).
        let calls = |tolerance| {
            let mut calls = 0;
            let f = |t: f64, x: &[f64], dx: &mut [f64]| {
                calls += 1;
                pendulum(t, x, dx);
            };
            integrate(f, &[1.0, 0.0], 20.0, tolerance).unwrap();
            f64::from(calls)
        };
        let ratio = calls(1e-11) / calls(1e-6);
        assert!((7.0..14.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn a_pendulum_without_friction_keeps_its_energy() {
        let energy = |x: &[f64]| x[1] * x[1] / 2.0 - 9.81 * x[0].cos();
        let trajectory = integrate(pendulum, &[3.0, 0.0], 60.0, 1e-11).unwrap();
        for i in 0..=600 {
            let lost = energy(&trajectory.at(f64::from(i) / 10.0)) - energy(&[3.0, 0.0]);
            assert!(lost.abs() < 1e-7, "{lost} at {} s", f64::from(i) / 10.0);
        }
    }

    #[test]
    fn the_stiff_the_exploding_and_the_singular_come_back() {
        let stiff = integrate(|t, x, dx| dx[0] = -1e7 * (x[0] - t.cos()), &[0.0], 10.0, 1e-6);
        assert!(matches!(stiff, Err(OdeError::StepLimit { .. })), "{stiff:?}");
        let explosion = integrate(|_, x, dx| dx[0] = x[0] * x[0], &[1.0], 2.0, 1e-9).unwrap_err();
        let (OdeError::StepLimit { time_s, .. }
        | OdeError::NotFinite { time_s }
        | OdeError::StepTooSmall { time_s }) = explosion;
        assert!((time_s - 1.0).abs() < 1e-6, "{explosion:?}");
        let root = integrate(|_, x, dx| dx[0] = -1.0 / x[0], &[1.0], 2.0, 1e-9).unwrap_err();
        let (OdeError::StepLimit { time_s, .. }
        | OdeError::NotFinite { time_s }
        | OdeError::StepTooSmall { time_s }) = root;
        assert!((time_s - 0.5).abs() < 1e-6, "{root:?}");
        let undefined = integrate(|_, _, dx| dx[0] = f64::NAN, &[1.0], 2.0, 1e-9);
        assert_eq!(undefined.unwrap_err(), OdeError::NotFinite { time_s: 0.0 });
        assert!(integrate(|_, x, dx| dx[0] = x[0], &[f64::INFINITY], 1.0, 1e-9).is_err());
        assert!(integrate(|_, x, dx| dx[0] = x[0], &[1.0], f64::NAN, 1e-9).is_err());
    }

    #[test]
    fn no_time_at_all_is_the_start() {
        let trajectory = integrate(|_, x, dx| dx[0] = x[0], &[2.0], 0.0, 1e-9).unwrap();
        assert_eq!(trajectory.at(0.0), [2.0]);
        assert_eq!(trajectory.at(1.0), [2.0]);
    }
}
