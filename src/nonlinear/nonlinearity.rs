/// A hard nonlinearity, in plant units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nonlinearity {
    /// Output = input, held within ±`limit`.
    ///
    /// ```text
    ///             output
    ///               │   ┌──────  +limit
    ///               │ ╱
    ///     ──────────┼──────────  input
    ///             ╱ │
    ///    ───────┘   │            -limit
    /// ```
    Saturation { limit: f64 },
    /// 0 within ±`threshold`, beyond it the input less the threshold.
    ///
    /// ```text
    ///             output
    ///               │      ╱
    ///               │    ╱
    ///     ──────┌───┼───┘──────  input
    ///         ╱ │       │
    ///       ╱  -threshold +threshold
    /// ```
    DeadZone { threshold: f64 },
    /// The play of a gear: a gap of total width `width`, centred on output 0 at the start (Simulink's Backlash block).
    ///
    /// The output stands still while the input moves inside the gap, and follows it, at the same rate, while the input
    /// pushes against one end: half the width behind it.
    ///
    /// ```text
    ///             output
    ///           ┌───┼────╱
    ///         ╱     │  ╱ ↑       up on the right, down on the left,
    ///     ──╱───────┼╱─────────  across the gap when the input turns
    ///     ↓       ╱ │
    ///    └──────┘   │
    ///       width
    /// ```
    Backlash { width: f64 },
    /// ±`amplitude` after the sign of the input; 0 where the input is exactly 0, and at the start.
    ///
    /// `hysteresis` and `dead_zone` are half-widths in the input's unit. The relay switches on where |input| exceeds
    /// `dead_zone` + `hysteresis`, and off where it falls below `dead_zone` − `hysteresis`; without dead zone it goes over
    /// to the other side instead, where the input exceeds `hysteresis` there. Exactly at such a point it stays as it is, but
    /// without hysteresis it is then off.
    ///
    /// ```text
    ///             output
    ///               │   ┌─┬────  +amplitude
    ///               │   ↓ ↑
    ///     ────┬─┬───┼───┴─┴────  input
    ///         ↓ ↑   │    dead_zone ± hysteresis
    ///    ─────┴─┘   │            -amplitude
    /// ```
    /// Source: Gelb & Vander Velde, *Multiple-Input Describing Functions*, 1968, app. B; Simulink's Relay block.
    Relay { amplitude: f64, hysteresis: f64, dead_zone: f64 },
    /// `interval` · round(input/`interval`), halves away from zero (Simulink's Quantizer block).
    Quantizer { interval: f64 },
    /// Follows its input, but rises by no more than `rising` (> 0) and falls by no more than `falling` (< 0) in a second
    /// (Simulink's Rate Limiter block); from 0 at the start.
    RateLimit { rising: f64, falling: f64 },
    /// sign(input) · (`viscous` · |input| + `coulomb`), 0 at 0 (Simulink's Coulomb & Viscous Friction block, with its
    /// gain and its offset).
    CoulombFriction { coulomb: f64, viscous: f64 },
}

/// An input this near a half of the interval, as a share of it (or of the number of intervals), is at the half.
const HALF: f64 = 1e-12;

impl Nonlinearity {
    /// Whether the output depends on the past, and not on the present input alone.
    pub fn has_memory(&self) -> bool {
        match *self {
            Self::Backlash { .. } | Self::RateLimit { .. } => true,
            Self::Relay { hysteresis, .. } => hysteresis > 0.0,
            _ => false,
        }
    }

    /// Whether the output jumps where the input passes a level.
    pub fn jumps(&self) -> bool {
        match *self {
            Self::Relay { .. } | Self::Quantizer { .. } => true,
            Self::CoulombFriction { coulomb, .. } => coulomb != 0.0,
            _ => false,
        }
    }

    /// The name used in the field: `saturation`, `dead zone`, `backlash`, `relay`, …
    pub fn kind_name(&self) -> &'static str {
        match self {
            Self::Saturation { .. } => "saturation",
            Self::DeadZone { .. } => "dead zone",
            Self::Backlash { .. } => "backlash",
            Self::Relay { .. } => "relay",
            Self::Quantizer { .. } => "quantizer",
            Self::RateLimit { .. } => "rate limit",
            Self::CoulombFriction { .. } => "Coulomb friction",
        }
    }

    /// The numbers it is made of.
    pub(super) fn parameters(&self) -> [f64; 3] {
        match *self {
            Self::Saturation { limit: size }
            | Self::DeadZone { threshold: size }
            | Self::Backlash { width: size }
            | Self::Quantizer { interval: size } => [size, 0.0, 0.0],
            Self::Relay { amplitude, hysteresis, dead_zone } => [amplitude, hysteresis, dead_zone],
            Self::RateLimit { rising, falling } => [rising, falling, 0.0],
            Self::CoulombFriction { coulomb, viscous } => [coulomb, viscous, 0.0],
        }
    }

    /// The output at `input`, when it was `previous` before (0 at the start).
    ///
    /// `previous` matters only to backlash and to a relay with hysteresis, and there the input must not have turned in
    /// between. A rate limit passes its input: it is a matter of time. A width, limit or threshold below 0 counts as 0.
    pub fn output(&self, input: f64, previous: f64) -> f64 {
        match *self {
            Self::Saturation { limit } => input.min(limit.max(0.0)).max(-limit.max(0.0)),
            Self::DeadZone { threshold } => {
                let threshold = threshold.max(0.0);
                (input - threshold).max(0.0) + (input + threshold).min(0.0)
            }
            Self::Backlash { width } => {
                let half = width.max(0.0) / 2.0;
                previous.max(input - half).min(input + half)
            }
            Self::RateLimit { .. } => input,
            Self::Relay { .. } | Self::Quantizer { .. } | Self::CoulombFriction { .. } => {
                let before = if previous > 0.0 {
                    1.0
                } else if previous < 0.0 {
                    -1.0
                } else {
                    0.0
                };
                let (gain, offset) = self.on_level(self.level(input, before));
                gain * input + offset
            }
        }
    }

    /// Which of the levels of a relay, Coulomb friction (-1, 0, 1) or a quantizer (its multiple) `input` is on, when it
    /// was on `previous` before; whole numbers, 0 for what has no levels.
    pub(super) fn level(&self, input: f64, previous: f64) -> f64 {
        match *self {
            Self::Quantizer { interval } if interval > 0.0 => {
                let multiple = input / interval;
                let tolerance = HALF * multiple.abs().max(1.0);
                ((multiple.abs() + 0.5 + tolerance).floor()).copysign(multiple) + 0.0
            }
            Self::Relay { hysteresis, dead_zone, .. } => {
                let (hysteresis, dead_zone) = (hysteresis.max(0.0), dead_zone.max(0.0));
                let (on, off) = (dead_zone + hysteresis, dead_zone - hysteresis);
                let turned = dead_zone > 0.0 && previous * input < 0.0;
                if input > on {
                    1.0
                } else if input < -on {
                    -1.0
                } else if input.abs() < off || hysteresis == 0.0 || turned {
                    0.0
                } else {
                    previous
                }
            }
            Self::CoulombFriction { .. } if input > 0.0 => 1.0,
            Self::CoulombFriction { .. } if input < 0.0 => -1.0,
            _ => 0.0,
        }
    }

    /// (gain, offset) of the straight line on `level`.
    pub(super) fn on_level(&self, level: f64) -> (f64, f64) {
        match *self {
            Self::Quantizer { interval } if interval > 0.0 => (0.0, interval * level),
            // Steps of nothing.
            Self::Quantizer { .. } => (1.0, 0.0),
            Self::Relay { amplitude, .. } => (0.0, amplitude * level),
            Self::CoulombFriction { coulomb, viscous } => (viscous * level.abs(), coulomb * level),
            _ => (1.0, 0.0),
        }
    }

    /// The inputs (least, greatest) between which it stays on `level`.
    pub(super) fn level_range(&self, level: f64) -> (f64, f64) {
        const ENDLESS: f64 = f64::INFINITY;
        match *self {
            Self::Quantizer { interval } if interval > 0.0 => {
                ((level - 0.5) * interval, (level + 0.5) * interval)
            }
            Self::Relay { hysteresis, dead_zone, .. } => {
                let (hysteresis, dead_zone) = (hysteresis.max(0.0), dead_zone.max(0.0));
                let (on, off) = (dead_zone + hysteresis, dead_zone - hysteresis);
                match level {
                    1.0 => (off, ENDLESS),
                    -1.0 => (-ENDLESS, -off),
                    _ => (-on, on),
                }
            }
            Self::CoulombFriction { .. } => match level {
                1.0 => (0.0, ENDLESS),
                -1.0 => (-ENDLESS, 0.0),
                _ => (0.0, 0.0),
            },
            _ => (-ENDLESS, ENDLESS),
        }
    }

    /// An input at which the level may change and that is no farther than `noise` from `input`.
    pub(super) fn edge_near(&self, input: f64, noise: f64) -> Option<f64> {
        let edges = match *self {
            Self::Quantizer { interval } if interval > 0.0 => {
                [((input / interval).floor() + 0.5) * interval; 4]
            }
            Self::Relay { hysteresis, dead_zone, .. } => {
                let (hysteresis, dead_zone) = (hysteresis.max(0.0), dead_zone.max(0.0));
                let (on, off) = (dead_zone + hysteresis, dead_zone - hysteresis);
                [on, off, -off, -on]
            }
            Self::CoulombFriction { .. } => [0.0; 4],
            _ => return None,
        };
        edges.into_iter().find(|edge| (edge - input).abs() <= noise)
    }

    /// The level just above or below `edge`.
    pub(super) fn level_beside(&self, edge: f64, above: bool, previous: f64) -> f64 {
        match *self {
            Self::Quantizer { interval } if interval > 0.0 => {
                let below = (edge / interval - 0.5).round();
                if above { below + 1.0 } else { below }
            }
            _ => self.level(if above { edge.next_up() } else { edge.next_down() }, previous),
        }
    }

    /// At which part (0 to 1) of a straight way of its input `from`..`to` the output, `previous` before, jumps: the mean of
    /// the places if there are several.
    pub(super) fn edge_between(&self, from: f64, to: f64, previous: f64) -> Option<f64> {
        let before = if previous == 0.0 { 0.0 } else { previous.signum() };
        let passes = match *self {
            Self::Relay { .. } => self.level(to, before) != before,
            _ => self.level(from, 0.0) != self.level(to, 0.0),
        };
        if !self.jumps() || !passes || from == to {
            return None;
        }
        let edge = match *self {
            // Evenly spaced, so their mean is halfway between the first and the last.
            Self::Quantizer { interval } => (self.level(from, 0.0) + self.level(to, 0.0)) / 2.0 * interval,
            Self::Relay { .. } => {
                let (low, high) = self.level_range(before);
                let edge = if to > from { high } else { low };
                let next = self.level_beside(edge, to > from, before);
                let (low, high) = self.level_range(next);
                let second = if to > from { high } else { low };
                // From one side through the dead zone to the other.
                if next != self.level(to, before) { (edge + second) / 2.0 } else { edge }
            }
            _ => 0.0,
        };
        Some(((edge - from) / (to - from)).clamp(0.0, 1.0))
    }

    /// The input–output picture for inputs within ±`reach`, as corners (input, output) to be joined by straight lines.
    ///
    /// Backlash, and a relay with hysteresis, starts at the origin and goes once round the loop an input swinging between
    /// ±`reach` makes. Of a quantizer no more than a hundred steps to either side are drawn. Of a rate limit it is the rate
    /// of the output over the rate of the input it can follow.
    pub fn characteristic(&self, reach: f64) -> Vec<(f64, f64)> {
        let reach = reach.abs();
        let turns: Vec<f64> = match *self {
            Self::RateLimit { rising, falling } => {
                let (rising, falling) = (rising.clamp(0.0, reach), falling.clamp(-reach, 0.0));
                return vec![(-reach, falling), (falling, falling), (rising, rising), (reach, rising)];
            }
            Self::Relay { .. } | Self::Quantizer { .. } | Self::CoulombFriction { .. } => {
                return self.steps(reach);
            }
            Self::Saturation { limit: corner } | Self::DeadZone { threshold: corner } => {
                let corner = corner.max(0.0).min(reach);
                vec![-reach, -corner, corner, reach]
            }
            Self::Backlash { width } => {
                let width = width.max(0.0);
                if reach <= width / 2.0 {
                    vec![0.0, reach, -reach, reach]
                } else {
                    vec![0.0, width / 2.0, reach, reach - width, -reach, width - reach, reach]
                }
            }
        };
        let mut output = 0.0;
        let mut corners: Vec<(f64, f64)> = Vec::with_capacity(turns.len());
        for input in turns {
            output = self.output(input, output);
            if corners.last() != Some(&(input, output)) {
                corners.push((input, output));
            }
        }
        corners
    }

    /// The picture of what has levels.
    fn steps(&self, reach: f64) -> Vec<(f64, f64)> {
        const STEPS_DRAWN: f64 = 100.0;
        let reach = match *self {
            Self::Quantizer { interval } if interval > 0.0 => reach.min(STEPS_DRAWN * interval),
            Self::Quantizer { .. } => return vec![(-reach, -reach), (reach, reach)],
            _ => reach,
        };
        let path = if self.has_memory() { vec![0.0, reach, -reach, reach] } else { vec![-reach, reach] };
        let mut level = self.level(path[0], 0.0);
        let output = |level: f64, input: f64| {
            let (gain, offset) = self.on_level(level);
            (input, gain * input + offset)
        };
        let mut corners = vec![output(level, path[0])];
        for legs in path.windows(2) {
            let above = legs[1] > legs[0];
            // One more than there can be.
            for _ in 0..2 * STEPS_DRAWN as usize + 4 {
                let (low, high) = self.level_range(level);
                let edge = if above { high } else { low };
                if (above && edge >= legs[1]) || (!above && edge <= legs[1]) {
                    break;
                }
                let next = self.level_beside(edge, above, level);
                corners.extend([output(level, edge), output(next, edge)]);
                level = next;
            }
            corners.push(output(level, legs[1]));
        }
        corners.dedup();
        corners
    }
}

#[cfg(test)]
mod tests {
    use super::Nonlinearity::{self, *};

    /// What it is, and the outputs met on the way along some inputs.
    type Row<'a> = (&'a str, Nonlinearity, &'a [(f64, f64)]);

    #[track_caller]
    fn check(rows: &[Row]) {
        for (name, nonlinearity, path) in rows {
            let mut output = 0.0;
            for &(input, expected) in *path {
                output = nonlinearity.output(input, output);
                assert!((output - expected).abs() < 1e-15, "{name} at {input}: {output}, not {expected}");
            }
        }
    }

    #[test]
    fn outputs() {
        check(&[
            (
                "saturation",
                Saturation { limit: 5.0 },
                &[(0.0, 0.0), (4.0, 4.0), (8.0, 5.0), (-5.0, -5.0), (-9.0, -5.0)],
            ),
            ("saturation of nothing", Saturation { limit: 0.0 }, &[(3.0, 0.0), (-3.0, 0.0)]),
            ("dead zone", DeadZone { threshold: 1.0 }, &[(0.5, 0.0), (1.0, 0.0), (3.0, 2.0), (-1.5, -0.5)]),
            ("no dead zone", DeadZone { threshold: 0.0 }, &[(0.5, 0.5), (-1.5, -1.5)]),
            (
                "backlash there and back",
                Backlash { width: 2.0 },
                &[
                    (0.5, 0.0),
                    (1.0, 0.0),
                    (3.0, 2.0),
                    (2.0, 2.0),
                    (1.0, 2.0),
                    (0.0, 1.0),
                    (1.0, 1.0),
                    (2.5, 1.5),
                ],
            ),
            ("backlash pushed at once", Backlash { width: 2.0 }, &[(-4.0, -3.0), (-3.0, -3.0)]),
            ("no play", Backlash { width: 0.0 }, &[(0.5, 0.5), (-0.25, -0.25)]),
            (
                "ideal relay",
                Relay { amplitude: 3.0, hysteresis: 0.0, dead_zone: 0.0 },
                &[(0.0, 0.0), (1e-9, 3.0), (0.0, 0.0), (-2.0, -3.0), (-0.0, 0.0)],
            ),
            (
                "relay with hysteresis",
                Relay { amplitude: 3.0, hysteresis: 1.0, dead_zone: 0.0 },
                &[(0.5, 0.0), (1.0, 0.0), (1.1, 3.0), (-1.0, 3.0), (-1.1, -3.0), (1.0, -3.0), (1.1, 3.0)],
            ),
            (
                "relay with dead zone",
                Relay { amplitude: 3.0, hysteresis: 0.0, dead_zone: 1.0 },
                &[(1.0, 0.0), (1.1, 3.0), (1.0, 0.0), (-1.0, 0.0), (-1.1, -3.0)],
            ),
            (
                "relay with both",
                Relay { amplitude: 3.0, hysteresis: 0.5, dead_zone: 1.0 },
                &[
                    (1.4, 0.0),
                    (1.6, 3.0),
                    (0.6, 3.0),
                    (0.4, 0.0),
                    (1.4, 0.0),
                    (1.6, 3.0),
                    (-1.0, 0.0),
                    (-1.6, -3.0),
                    (1.0, 0.0),
                ],
            ),
            (
                "quantizer",
                Quantizer { interval: 0.5 },
                &[
                    (0.24, 0.0),
                    (0.25, 0.5),
                    (0.74, 0.5),
                    (0.75, 1.0),
                    (-0.24, 0.0),
                    (-0.25, -0.5),
                    (-0.76, -1.0),
                    (0.0, 0.0),
                ],
            ),
            (
                "Coulomb and viscous friction",
                CoulombFriction { coulomb: 2.0, viscous: 0.5 },
                &[(0.0, 0.0), (1.0, 2.5), (4.0, 4.0), (-0.0, 0.0), (-1.0, -2.5)],
            ),
            ("dry friction", CoulombFriction { coulomb: 2.0, viscous: 0.0 }, &[(1e-300, 2.0), (-7.0, -2.0)]),
        ]);
    }

    #[test]
    fn pictures() {
        for (nonlinearity, reach, corners) in [
            (Saturation { limit: 5.0 }, 8.0, &[(-8.0, -5.0), (-5.0, -5.0), (5.0, 5.0), (8.0, 5.0)][..]),
            (Saturation { limit: 5.0 }, 4.0, &[(-4.0, -4.0), (4.0, 4.0)]),
            (DeadZone { threshold: 1.0 }, 3.0, &[(-3.0, -2.0), (-1.0, 0.0), (1.0, 0.0), (3.0, 2.0)]),
            (
                Backlash { width: 2.0 },
                4.0,
                &[(0.0, 0.0), (1.0, 0.0), (4.0, 3.0), (2.0, 3.0), (-4.0, -3.0), (-2.0, -3.0), (4.0, 3.0)],
            ),
            (
                Relay { amplitude: 3.0, hysteresis: 0.0, dead_zone: 0.0 },
                2.0,
                &[(-2.0, -3.0), (0.0, -3.0), (0.0, 3.0), (2.0, 3.0)],
            ),
            (
                Relay { amplitude: 3.0, hysteresis: 0.0, dead_zone: 1.0 },
                2.0,
                &[(-2.0, -3.0), (-1.0, -3.0), (-1.0, 0.0), (1.0, 0.0), (1.0, 3.0), (2.0, 3.0)],
            ),
            (
                Relay { amplitude: 3.0, hysteresis: 1.0, dead_zone: 0.0 },
                2.0,
                &[
                    (0.0, 0.0),
                    (1.0, 0.0),
                    (1.0, 3.0),
                    (2.0, 3.0),
                    (-1.0, 3.0),
                    (-1.0, -3.0),
                    (-2.0, -3.0),
                    (1.0, -3.0),
                    (1.0, 3.0),
                    (2.0, 3.0),
                ],
            ),
            (
                Quantizer { interval: 1.0 },
                1.2,
                &[(-1.2, -1.0), (-0.5, -1.0), (-0.5, 0.0), (0.5, 0.0), (0.5, 1.0), (1.2, 1.0)],
            ),
            (
                CoulombFriction { coulomb: 2.0, viscous: 0.5 },
                2.0,
                &[(-2.0, -3.0), (0.0, -2.0), (0.0, 2.0), (2.0, 3.0)],
            ),
            (
                RateLimit { rising: 2.0, falling: -1.0 },
                4.0,
                &[(-4.0, -1.0), (-1.0, -1.0), (2.0, 2.0), (4.0, 2.0)],
            ),
            (Backlash { width: 2.0 }, 0.5, &[(0.0, 0.0), (0.5, 0.0), (-0.5, 0.0), (0.5, 0.0)]),
        ] {
            assert_eq!(nonlinearity.characteristic(reach), corners, "{}", nonlinearity.kind_name());
        }
    }
}
