use super::accepted::{Accepted, accepted, operating_point};
use super::own::OwnModel;
use super::poles::{ExpectedPoles, accepted_poles};
use crate::lab::{Curve, SystemRef};
use crate::lti::{InputKind, Pole, Stability};
use crate::reference::{LinearReference, Reference, ResponseReference};

/// What answers about a system are held against.
#[derive(Clone, Copy, Debug)]
pub(super) enum Truth<'a> {
    Reference(&'a Reference),
    /// The student's own model of the system that is asked about.
    Own(&'a OwnModel),
}

impl<'a> Truth<'a> {
    pub fn poles(self, of: &SystemRef) -> Vec<ExpectedPoles<'a>> {
        match self {
            Self::Reference(reference) => accepted_poles(reference, of),
            Self::Own(own) => own.poles().into_iter().collect(),
        }
    }

    /// Poles of the whole state, cancelled ones included; none are known of a student's own model.
    pub fn internal_poles(self, of: &SystemRef) -> &'a [Pole] {
        self.main(of).map_or(&[], |one| &one.internal_poles)
    }

    pub fn stability(self, of: &SystemRef) -> Vec<Accepted<'a, Stability>> {
        match self {
            Self::Reference(reference) => accepted(reference, of, |one| &one.stability),
            Self::Own(own) => vec![Accepted { differs: &[], what: &own.stability }],
        }
    }

    /// Of the whole state; not known of a student's own model.
    pub fn internal_stability(self, of: &SystemRef) -> Option<Stability> {
        self.main(of).map(|one| one.internal_stability)
    }

    pub fn responses(self, of: &SystemRef, kind: InputKind) -> Vec<Accepted<'a, ResponseReference>> {
        match self {
            Self::Reference(reference) => accepted(reference, of, |one| response_of(one, kind)),
            Self::Own(own) => {
                own.response(kind).map(|what| Accepted { differs: &[], what }).into_iter().collect()
            }
        }
    }

    /// How long a curve is asked for where `asked_s` is enough for the reference, s: no longer than an own model takes to show
    /// its own behaviour.
    pub fn span_s(self, curve: &Curve, asked_s: f64) -> f64 {
        match (self, curve) {
            (Self::Own(own), Curve::Response { response, .. }) => {
                own.response(*response).map_or(asked_s, |known| known.horizon_s.min(asked_s))
            }
            _ => asked_s,
        }
    }

    /// What follows from the lab's own parameter values.
    fn main(self, of: &SystemRef) -> Option<&'a LinearReference> {
        match self {
            Self::Reference(reference) => operating_point(reference, of)?.accepted.first(),
            Self::Own(_) => None,
        }
    }
}

fn response_of(linear: &LinearReference, kind: InputKind) -> &ResponseReference {
    match kind {
        InputKind::Impulse => &linear.impulse,
        InputKind::Step => &linear.step,
    }
}
