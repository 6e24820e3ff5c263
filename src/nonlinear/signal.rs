/// A driving signal as a function of time, from t = 0.
///
/// At a jump the value is the one after it (right-continuous): `at(edge)` is the new level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Signal {
    /// amplitude · sin(frequency · t + phase) + bias.
    Sine { amplitude: f64, frequency_rad_s: f64, phase_rad: f64, bias: f64 },
    /// `high` for the first `duty` (0..1) of each period, `low` for the rest, starting at `delay_s` (`low` before).
    Pulse { low: f64, high: f64, period_s: f64, duty: f64, delay_s: f64 },
    /// 0 before `time_s`, `amplitude` from then on.
    Step { amplitude: f64, time_s: f64 },
}

/// [`Signal::breaks`] stops after this many: a figure cannot show more.
const BREAKS_LISTED: usize = 10_000;

impl Signal {
    /// The value at time `t` s.
    pub fn at(&self, t: f64) -> f64 {
        match *self {
            Self::Sine { amplitude, frequency_rad_s, phase_rad, bias } => {
                amplitude * (frequency_rad_s * t + phase_rad).sin() + bias
            }
            Self::Pulse { low, high, .. } => {
                if self.is_high(t) {
                    high
                } else {
                    low
                }
            }
            Self::Step { amplitude, time_s } => {
                if t >= time_s {
                    amplitude
                } else {
                    0.0
                }
            }
        }
    }

    /// The slope at time `t` s, in units per second; 0 on the levels of pulses and steps, at their edges too.
    pub fn rate(&self, t: f64) -> f64 {
        match *self {
            Self::Sine { amplitude, frequency_rad_s, phase_rad, .. } => {
                amplitude * frequency_rad_s * (frequency_rad_s * t + phase_rad).cos()
            }
            Self::Pulse { .. } | Self::Step { .. } => 0.0,
        }
    }

    /// The instants 0 < t < `duration_s` at which the signal jumps, ascending; the first 10,000 of them.
    ///
    /// What happens at t = 0 is where the signal starts, not a jump.
    pub fn breaks(&self, duration_s: f64) -> Vec<f64> {
        std::iter::successors(self.next_break(0.0), |&t| self.next_break(t))
            .take_while(|&t| t < duration_s)
            .take(BREAKS_LISTED)
            .collect()
    }

    /// The first instant after `after_s` (which is not negative) at which the signal jumps.
    pub fn next_break(&self, after_s: f64) -> Option<f64> {
        match *self {
            Self::Sine { .. } => None,
            Self::Step { amplitude, time_s } => (amplitude != 0.0 && time_s > after_s).then_some(time_s),
            Self::Pulse { low, high, period_s, duty, delay_s } => {
                let one_level = low == high || duty.is_nan() || duty <= 0.0;
                if one_level || delay_s.is_nan() || after_s.is_nan() {
                    return None;
                }
                if after_s < delay_s {
                    return Some(delay_s);
                }
                if duty >= 1.0 || period_s.is_nan() || period_s <= 0.0 {
                    return None;
                }
                let period = self.period_number(after_s);
                [period + duty, period + 1.0, period + 1.0 + duty]
                    .into_iter()
                    .map(|periods| delay_s + periods * period_s)
                    .find(|&t| t > after_s)
            }
        }
    }

    fn is_high(&self, t: f64) -> bool {
        let Self::Pulse { period_s, duty, delay_s, .. } = *self else { return false };
        if t < delay_s || duty.is_nan() || duty <= 0.0 {
            return false;
        }
        if duty >= 1.0 || period_s.is_nan() || period_s <= 0.0 {
            return true;
        }
        t < delay_s + (self.period_number(t) + duty) * period_s
    }

    /// Which period of a pulse `t` ≥ delay lies in, from 0.
    fn period_number(&self, t: f64) -> f64 {
        let Self::Pulse { period_s, delay_s, .. } = *self else { return 0.0 };
        // The quotient may round to the wrong side of an edge; the edges themselves decide.
        let guess = ((t - delay_s) / period_s).floor();
        if delay_s + (guess + 1.0) * period_s <= t {
            guess + 1.0
        } else if delay_s + guess * period_s > t {
            guess - 1.0
        } else {
            guess
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Signal::{self, *};

    const PULSES: Signal = Pulse { low: -5.0, high: 5.0, period_s: 3.0, duty: 0.5, delay_s: 0.0 };
    const DELAYED: Signal = Pulse { low: 0.0, high: 5.0, period_s: 0.1, duty: 0.3, delay_s: 0.7 };

    /// What it is, and its values at some times.
    type Row<'a> = (&'a str, Signal, &'a [(f64, f64)]);

    #[track_caller]
    fn check(rows: &[Row]) {
        for (name, signal, values) in rows {
            for &(t, expected) in *values {
                assert!((signal.at(t) - expected).abs() < 1e-15, "{name} at {t}: {}", signal.at(t));
            }
        }
    }

    #[test]
    fn values_are_those_after_a_jump() {
        let sine =
            Sine { amplitude: 8.0, frequency_rad_s: 2.0, phase_rad: std::f64::consts::FRAC_PI_2, bias: 1.0 };
        check(&[
            ("sine", sine, &[(0.0, 9.0), (std::f64::consts::FRAC_PI_2, -7.0)]),
            ("pulses", PULSES, &[(0.0, 5.0), (1.4999, 5.0), (1.5, -5.0), (2.9999, -5.0), (3.0, 5.0)]),
            ("delayed pulses", DELAYED, &[(0.0, 0.0), (0.69, 0.0), (0.7, 5.0), (0.729, 5.0), (0.75, 0.0)]),
            (
                "always high",
                Pulse { low: 1.0, high: 2.0, period_s: 1.0, duty: 1.0, delay_s: 0.5 },
                &[(0.4, 1.0), (7.0, 2.0)],
            ),
            (
                "never high",
                Pulse { low: 1.0, high: 2.0, period_s: 1.0, duty: 0.0, delay_s: 0.0 },
                &[(0.0, 1.0), (7.0, 1.0)],
            ),
            ("step", Step { amplitude: 2.0, time_s: 1.0 }, &[(0.0, 0.0), (0.9999, 0.0), (1.0, 2.0)]),
        ]);
        assert!(sine.rate(0.0).abs() < 1e-14);
        assert!((sine.rate(1.0) + 16.0 * 2f64.sin()).abs() < 1e-14);
    }

    #[test]
    fn breaks_are_inside_and_ascending() {
        assert_eq!(PULSES.breaks(6.0), [1.5, 3.0, 4.5]);
        assert_eq!(PULSES.breaks(0.0), [0.0; 0]);
        assert_eq!(Step { amplitude: 1.0, time_s: 0.0 }.breaks(5.0), [0.0; 0]);
        assert_eq!(Step { amplitude: 1.0, time_s: 2.0 }.breaks(5.0), [2.0]);
        assert_eq!(Pulse { low: 1.0, high: 2.0, period_s: 1.0, duty: 1.0, delay_s: 0.5 }.breaks(9.0), [0.5]);
        assert_eq!(
            Pulse { low: 0.0, high: 5.0, period_s: 1e-9, duty: 0.5, delay_s: 0.0 }.breaks(10.0).len(),
            10_000
        );
    }

    #[test]
    fn every_break_parts_two_levels() {
        let breaks = DELAYED.breaks(30.0);
        assert_eq!(breaks.len(), 586);
        for pair in breaks.windows(2) {
            assert!(pair[0] < pair[1]);
            let (before, after) = (DELAYED.at(pair[0] - 1e-9), DELAYED.at(pair[0]));
            assert!(before != after, "nothing happens at {}", pair[0]);
            assert_eq!(DELAYED.at(pair[1].next_down()), after, "another level before {}", pair[1]);
        }
    }
}
