/// A driving signal as a function of time, from t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Signal {
    /// amplitude · sin(frequency · t + phase) + bias.
    Sine { amplitude: f64, frequency_rad_s: f64, phase_rad: f64, bias: f64 },
    /// `high` for the first `duty` (0..1) of each period, `low` for the rest, starting at `delay_s` (`low` before).
    Pulse { low: f64, high: f64, period_s: f64, duty: f64, delay_s: f64 },
    /// 0 before `time_s`, `amplitude` from then on.
    Step { amplitude: f64, time_s: f64 },
}
