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
    let mut others = Vec::new();
    let mut before = None;
    for differs in accepted.iter().map(|one| one.differs).filter(|differs| !differs.is_empty()) {
        // Several values of one parameter are named once: `g = 9.8, 9.80665 or 10`.
        let only = match differs {
            [(name, ..)] => Some(name),
            _ => None,
        };
        let again = only.is_some() && only == before;
        let value = |(name, text, _): &(String, String, Rational)| match again {
            true => text.clone(),
            false => format!("{name} = {text}"),
        };
        others.push(differs.iter().map(value).collect::<Vec<_>>().join(" and "));
        before = only;
    }
    match others.as_slice() {
        [] => String::new(),
        others => format!(" Also right with {}.", listed(others, "or")),
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

/// Those of them that have what is picked: an improper transfer function has no responses.
pub(super) fn accepted_where<'a, T: ?Sized>(
    reference: &'a Reference,
    of: &SystemRef,
    pick: impl Fn(&'a LinearReference) -> Option<&'a T>,
) -> Vec<Accepted<'a, T>> {
    let all = operating_point(reference, of).map_or(&[][..], |point| &point.accepted);
    all.iter().filter_map(|one| Some(Accepted { differs: &one.differs, what: pick(one)? })).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_one_parameter_are_named_once() {
        for (sets, words) in [
            ("", ""),
            ("g = 9.8", " Also right with g = 9.8."),
            ("g = 9.8; g = 9.80665; g = 10", " Also right with g = 9.8, 9.80665 or 10."),
            ("g = 9.8; m = 1; m = 2", " Also right with g = 9.8, m = 1 or 2."),
            ("g = 9.8; g = 9.8, m = 1; g = 10", " Also right with g = 9.8, g = 9.8 and m = 1 or g = 10."),
        ] {
            let differs: Vec<Vec<_>> = sets
                .split("; ")
                .map(|set| {
                    let parts = set.split(", ").filter_map(|part| part.split_once(" = "));
                    parts.map(|(name, text)| (name.to_owned(), text.to_owned(), Rational::ONE)).collect()
                })
                .collect();
            let accepted: Vec<_> = differs.iter().map(|differs| Accepted { differs, what: &() }).collect();
            assert_eq!(also(&accepted), words, "{sets}");
        }
    }
}
