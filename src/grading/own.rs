use super::accepted::Accepted;
use super::poles::ExpectedPoles;
use super::transfer_function::without_residue;
use crate::lti::{InputKind, Pole, ResponseError, RootError, Stability, TransferFunction, roots, stability};
use crate::reference::ResponseReference;
use std::sync::OnceLock;

/// A student's own model, and what follows from it; worked out when it is first asked for, and once.
///
/// Only what a transfer function alone decides: it has no states, so nothing can be said of poles that cancel.
#[derive(Debug)]
pub(super) struct OwnModel {
    pub function: TransferFunction,
    pub stability: Stability,
    poles: OnceLock<Result<Vec<Pole>, RootError>>,
    impulse: OnceLock<Result<ResponseReference, ResponseError>>,
    step: OnceLock<Result<ResponseReference, ResponseError>>,
}

impl OwnModel {
    /// The ways to take `typed`: common factors cancelled, then as it stands where that is not the same.
    ///
    /// A factor s left in the denominator is a pole at 0 for whoever lists the roots of what they wrote. Ways of a higher
    /// degree than `most` are left out: nobody asked for them, and they could be made to take long.
    pub fn ways(typed: &TransferFunction, most: usize) -> Vec<Self> {
        let clean = without_residue(typed).unwrap_or_else(|| typed.clone());
        let mut ways: Vec<TransferFunction> = Vec::new();
        for way in [clean.cancelled().0, clean, typed.clone()] {
            if !ways.contains(&way) && way.num.degree().max(way.den.degree()) <= most {
                ways.push(way);
            }
        }
        ways.into_iter().map(Self::new).collect()
    }

    fn new(function: TransferFunction) -> Self {
        let stability = stability(&function.den);
        let (poles, impulse, step) = Default::default();
        Self { function, stability, poles, impulse, step }
    }

    /// `None` when they cannot be computed.
    pub fn poles(&self) -> Option<ExpectedPoles<'_>> {
        let poles = self.roots().as_ref().ok()?;
        let poles = Accepted { differs: &[], what: poles.as_slice() };
        Some(ExpectedPoles { poles, denominator: &self.function.den })
    }

    /// `None` when it cannot be computed: see [`Self::why_no_response`].
    pub fn response(&self, kind: InputKind) -> Option<&ResponseReference> {
        self.computed(kind).as_ref().ok()
    }

    /// Why its poles cannot be told, as a clause.
    pub fn why_no_poles(&self) -> Option<String> {
        self.roots().as_ref().err().map(RootError::to_string)
    }

    /// Why its response cannot be told, as a clause.
    pub fn why_no_response(&self, kind: InputKind) -> Option<String> {
        self.computed(kind).as_ref().err().map(ResponseError::to_string)
    }

    fn roots(&self) -> &Result<Vec<Pole>, RootError> {
        self.poles.get_or_init(|| roots(&self.function.den))
    }

    fn computed(&self, kind: InputKind) -> &Result<ResponseReference, ResponseError> {
        let cell = match kind {
            InputKind::Impulse => &self.impulse,
            InputKind::Step => &self.step,
        };
        cell.get_or_init(|| ResponseReference::of(&self.function, kind))
    }
}
