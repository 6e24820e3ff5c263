use crate::algebra::Polynomial;

/// Stability of a linear system, from the roots of its characteristic polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stability {
    /// All roots strictly in the left half-plane.
    AsymptoticallyStable,
    /// None in the right half-plane, simple ones on the axis.
    MarginallyStable,
    /// A root in the right half-plane, or a repeated one on the axis.
    Unstable,
}

/// Decided exactly in rationals (Routh–Hurwitz / Sturm), never from computed roots.
pub fn stability(characteristic: &Polynomial) -> Stability {
    let _ = characteristic;
    todo!()
}
