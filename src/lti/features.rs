use super::Response;

/// Where a response goes as t → ∞.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    Value(f64),
    /// Grows without bound to one side.
    PlusInfinity,
    MinusInfinity,
    /// Oscillates for ever with bounded amplitude.
    Oscillates,
    /// Oscillates with growing amplitude.
    OscillatesUnbounded,
}

/// The general shape of a response, in the words of a textbook.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Swings about its final value with shrinking amplitude.
    DecayingOscillation,
    /// Swings with constant amplitude.
    SustainedOscillation,
    /// Swings with growing amplitude.
    GrowingOscillation,
    /// Approaches its final value without swinging about it.
    ExponentialDecay,
    /// Leaves to one side, ever faster.
    ExponentialGrowth,
    /// Grows like a power of t (a ramp, say).
    PolynomialGrowth,
    /// Stays where it is from the start.
    Constant,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremum {
    pub time_s: f64,
    pub value: f64,
}

/// What one reads off a response, from its closed form with bracketed extrema.
#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    /// y(0⁺).
    pub initial_value: f64,
    pub final_value: Limit,
    pub shape: Shape,
    /// The extremum of largest |y|, `None` when |y| has no maximum (unbounded responses).
    pub peak: Option<Extremum>,
    /// The first few extrema in time order (at most 8).
    pub extrema: Vec<Extremum>,
    /// 2π/|Im p| of the dominant (slowest-decaying) complex pair present in the response.
    pub period_s: Option<f64>,
    /// ζ and ω_n (rad/s) of that pair.
    pub damping_ratio: Option<f64>,
    pub natural_frequency_rad_s: Option<f64>,
    /// −1/Re of the slowest decaying term present, s.
    pub slowest_time_constant_s: Option<f64>,
    /// Time after which |y − final| stays within 2 % and 5 % of the peak deviation, for a decaying response, located on the curve.
    pub settling_time_2_percent_s: Option<f64>,
    pub settling_time_5_percent_s: Option<f64>,
}

impl Features {
    pub fn of(response: &Response) -> Self {
        let _ = response;
        todo!()
    }
}
