use super::{RootError, TransferFunction};

/// What the system is driven with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InputKind {
    /// δ(t), area 1.
    Impulse,
    /// 1 for t ≥ 0.
    Step,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResponseError {
    #[error(
        "the transfer function is improper: its numerator (degree {num}) outranks its denominator (degree {den})"
    )]
    Improper { num: usize, den: usize },
    #[error(transparent)]
    Roots(#[from] RootError),
}

/// A response in closed form: a sum of t^k e^{pt} terms from the partial fractions of G(s) or G(s)/s.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    pub kind: InputKind,
    /// (pole re, pole im, power of t, residue re, residue im): Σ residue · t^power / power! · e^{pole t}; conjugates listed.
    pub(crate) terms: Vec<(f64, f64, usize, f64, f64)>,
}

impl Response {
    pub fn new(g: &TransferFunction, kind: InputKind) -> Result<Self, ResponseError> {
        let _ = (g, kind);
        todo!()
    }

    /// y(t) for t ≥ 0 s (t = 0 means 0⁺).
    pub fn at(&self, t: f64) -> f64 {
        let _ = t;
        todo!()
    }

    /// dy/dt at t ≥ 0.
    pub fn rate(&self, t: f64) -> f64 {
        let _ = t;
        todo!()
    }

    /// A time axis on which the behaviour is seen: for a decaying response until it has settled, for a growing one until
    /// it has grown some hundredfold; in seconds.
    pub fn horizon_s(&self) -> f64 {
        todo!()
    }

    /// Points (t, y) on 0..=`end_s`, dense enough that straight lines between them stay within `tolerance`·peak of the curve.
    pub fn samples(&self, end_s: f64, tolerance: f64) -> Vec<(f64, f64)> {
        let _ = (end_s, tolerance);
        todo!()
    }
}
