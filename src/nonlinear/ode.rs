/// Solution points (t, state) of an initial value problem, with dense output between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    pub points: Vec<(f64, Vec<f64>)>,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OdeError {
    #[error("more than {limit} steps before t = {time_s} s")]
    StepLimit { limit: usize, time_s: f64 },
    #[error("the solution left the range of numbers at t = {time_s} s")]
    NotFinite { time_s: f64 },
    #[error("the step size fell below what numbers resolve at t = {time_s} s")]
    StepTooSmall { time_s: f64 },
}

/// ẋ = `f(t, x, &mut dx)` from `x0` over 0..=`end_s` by Dormand–Prince 5(4), reported at the given `times` (ascending).
pub fn integrate(
    f: impl Fn(f64, &[f64], &mut [f64]),
    x0: &[f64],
    times: &[f64],
    relative_tolerance: f64,
) -> Result<Trajectory, OdeError> {
    let _ = (f, x0, times, relative_tolerance);
    todo!()
}
