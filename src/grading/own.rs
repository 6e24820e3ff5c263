use super::accepted::Accepted;
use super::poles::ExpectedPoles;
use super::transfer_function::without_residue;
use crate::lti::{InputKind, Pole, Stability, TransferFunction, roots, stability};
use crate::reference::ResponseReference;
use std::cell::OnceCell;

/// A student's own model, and what follows from it; worked out when it is first asked for, and once.
///
/// Only what a transfer function alone decides: it has no states, so nothing can be said of poles that cancel.
#[derive(Debug)]
pub(super) struct OwnModel {
    pub function: TransferFunction,
    pub stability: Stability,
    poles: OnceCell<Vec<Pole>>,
    impulse: OnceCell<Option<ResponseReference>>,
    step: OnceCell<Option<ResponseReference>>,
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
        let poles = self.poles.get_or_init(|| roots(&self.function.den).unwrap_or_default());
        let computed = !poles.is_empty() || self.function.den.degree() == 0;
        let poles = Accepted { differs: &[], what: poles.as_slice() };
        computed.then_some(ExpectedPoles { poles, denominator: &self.function.den })
    }

    /// `None` when it is improper, or beyond the range of numbers.
    pub fn response(&self, kind: InputKind) -> Option<&ResponseReference> {
        let cell = match kind {
            InputKind::Impulse => &self.impulse,
            InputKind::Step => &self.step,
        };
        cell.get_or_init(|| ResponseReference::of(&self.function, kind).ok()).as_ref()
    }
}
