/// A hard nonlinearity, in plant units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nonlinearity {
    /// Output = input, held within ±`limit`.
    ///
    /// ```text
    ///          ┌──── +limit
    ///         ╱
    ///        ╱
    ///   ────┘  -limit
    /// ```
    Saturation { limit: f64 },
    /// 0 within ±`threshold`, beyond it the input less the threshold.
    DeadZone { threshold: f64 },
    /// The play of a gear: deadband of total width `width`, centred on the input at the start (Simulink's Backlash block).
    Backlash { width: f64 },
}

impl Nonlinearity {
    /// Whether the output depends on the past (backlash) or on the present input alone.
    pub fn has_memory(&self) -> bool {
        matches!(self, Self::Backlash { .. })
    }
}
