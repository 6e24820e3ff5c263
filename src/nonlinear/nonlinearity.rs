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
}

impl Nonlinearity {
    /// Whether the output depends on the past (backlash) or on the present input alone.
    pub fn has_memory(&self) -> bool {
        matches!(self, Self::Backlash { .. })
    }

    /// The name used in the field: `saturation`, `dead zone`, `backlash`.
    pub fn kind_name(&self) -> &'static str {
        match self {
            Self::Saturation { .. } => "saturation",
            Self::DeadZone { .. } => "dead zone",
            Self::Backlash { .. } => "backlash",
        }
    }

    /// The output at `input`, when it was `previous` before (0 at the start).
    ///
    /// `previous` matters only to backlash, and there the input must not have turned in between.
    /// A width, limit or threshold below 0 counts as 0.
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
        }
    }

    /// The input–output picture for inputs within ±`reach`, as corners (input, output) to be joined by straight lines.
    ///
    /// Backlash starts at the origin and goes once round the loop an input swinging between ±`reach` makes.
    pub fn characteristic(&self, reach: f64) -> Vec<(f64, f64)> {
        let reach = reach.abs();
        let turns: Vec<f64> = match *self {
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
            (Backlash { width: 2.0 }, 0.5, &[(0.0, 0.0), (0.5, 0.0), (-0.5, 0.0), (0.5, 0.0)]),
        ] {
            assert_eq!(nonlinearity.characteristic(reach), corners, "{}", nonlinearity.kind_name());
        }
    }
}
