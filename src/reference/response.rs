use crate::algebra::to_f64;
use crate::lti::{Features, InputKind, Response, ResponseError, TransferFunction};
use std::sync::OnceLock;

/// How far, as a part of the peak, a drawn polyline may stray from the true curve.
const DRAWING_TOLERANCE: f64 = 1e-3;

/// G(0); `None` where the origin is a pole.
pub fn dc_gain(g: &TransferFunction) -> Option<f64> {
    let (g, _) = g.cancelled();
    let den = g.den.coefficient(0);
    (!den.is_zero()).then(|| to_f64(&(g.num.coefficient(0) / den)))
}

/// A response, what is said of it, and how it is drawn.
#[derive(Clone, Debug)]
pub struct ResponseReference {
    pub response: Response,
    pub features: Features,
    /// Seconds shown.
    pub horizon_s: f64,
    drawn: OnceLock<Vec<(f64, f64)>>,
    turns: OnceLock<Vec<(f64, f64)>>,
}

impl ResponseReference {
    /// What follows from the transfer function alone, so that it can be had for a student's as well as for the lab's.
    ///
    /// Errors: [`Response::new`].
    pub fn of(g: &TransferFunction, kind: InputKind) -> Result<Self, ResponseError> {
        let response = Response::new(g, kind)?;
        let horizon_s = response.horizon_s();
        Ok(Self {
            features: Features { dc_gain: dc_gain(g), ..Features::of(&response) },
            horizon_s,
            response,
            drawn: OnceLock::new(),
            turns: OnceLock::new(),
        })
    }

    /// (t, y) of start, extrema and end, to the horizon; worked out when they are first asked for.
    pub fn turning_points(&self) -> &[(f64, f64)] {
        self.turns.get_or_init(|| self.response.turning_points(self.horizon_s))
    }

    /// (t, y) for drawing, to the horizon. Worked out when they are first asked for: of a student's function they seldom are.
    pub fn samples(&self) -> &[(f64, f64)] {
        self.drawn.get_or_init(|| self.response.samples(self.horizon_s, DRAWING_TOLERANCE))
    }
}
