use crate::algebra::Rational;
use crate::english::listed;
use crate::lab::{Check, LabDefinition, SystemRef};
use crate::reference::{LinearReference, OperatingPointReference, Reference};

/// One accepted set of parameter values, and what follows from it.
#[derive(Debug)]
pub(super) struct Accepted<'a, T: ?Sized> {
    /// Parameters that differ from the lab's own; empty for the lab's own.
    pub differs: &'a [(String, String, Rational)],
    pub what: &'a T,
}

impl<T: ?Sized> Clone for Accepted<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: ?Sized> Copy for Accepted<'_, T> {}

impl<'a, T: ?Sized> Accepted<'a, T> {
    /// A part of it, with the same parameter values.
    pub fn pick<U: ?Sized>(&self, part: impl Fn(&'a T) -> &'a U) -> Accepted<'a, U> {
        Accepted { differs: self.differs, what: part(self.what) }
    }

    /// ` with g = 9.8`, or nothing for the lab's own values.
    pub fn with(&self) -> String {
        if self.differs.is_empty() {
            return String::new();
        }
        let values: Vec<_> = self.differs.iter().map(|(name, text, _)| format!("{name} = {text}")).collect();
        format!(" with {}", values.join(", "))
    }
}

/// What is said after the expected answer when other parameter values are accepted too.
pub(super) fn also<T: ?Sized>(accepted: &[Accepted<'_, T>]) -> String {
    let others: Vec<_> = accepted
        .iter()
        .filter(|one| !one.differs.is_empty())
        .map(|one| one.with().trim_start_matches(" with ").to_owned())
        .collect();
    match others.as_slice() {
        [] => String::new(),
        others => format!(" What follows from {} is accepted too.", listed(others, "or")),
    }
}

pub(super) fn operating_point<'a>(
    reference: &'a Reference,
    of: &SystemRef,
) -> Option<&'a OperatingPointReference> {
    let model = reference.models.iter().find(|model| model.id == of.model)?;
    model.operating_points.iter().find(|point| point.id == of.operating_point)
}

/// `pick` of every accepted set of parameter values, the lab's own first; none when the reference does not know `of`.
pub(super) fn accepted<'a, T: ?Sized>(
    reference: &'a Reference,
    of: &SystemRef,
    pick: impl Fn(&'a LinearReference) -> &'a T,
) -> Vec<Accepted<'a, T>> {
    operating_point(reference, of)
        .map(|point| {
            point.accepted.iter().map(|one| Accepted { differs: &one.differs, what: pick(one) }).collect()
        })
        .unwrap_or_default()
}

/// The widest relative tolerance that the lab gives a coefficient of the system's transfer function.
pub(super) fn coefficient_tolerance(lab: &LabDefinition, of: &SystemRef) -> Rational {
    let checks =
        lab.questions.iter().flat_map(|question| &question.criteria).map(|criterion| &criterion.check);
    checks
        .filter(|check| check.transfer_function() == Some(of))
        .filter_map(|check| match check {
            Check::Numerator { tolerance, .. } | Check::Denominator { tolerance, .. } => {
                Some(tolerance.relative.clone())
            }
            _ => None,
        })
        .max()
        .unwrap_or(Rational::ZERO)
}
