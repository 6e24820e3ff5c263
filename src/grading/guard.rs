use super::accepted::{accepted, operating_point};
use super::closeness::magnitude;
use super::own_poles::OwnPoles;
use super::scale::{Part, scalings};
use crate::algebra::{Polynomial, Rational};
use crate::lab::SystemRef;
use crate::lti::TransferFunction;
use crate::reference::Reference;

/// Whether an earlier answer may be followed: it must not make the later parts easier than the reference does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guard {
    Passed,
    /// Its numerator or denominator is not of the order asked for; of poles, there are too few.
    Order,
    /// Hardly a model: too few terms, every coefficient ±1, all poles at one place, or beyond all measure.
    Trivial,
    /// It is what belongs to another operating point.
    OtherPoint,
}

impl Guard {
    /// The word tools read: `passed`, `order`, `trivial`, `other_point`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Order => "order",
            Self::Trivial => "trivial",
            Self::OtherPoint => "other_point",
        }
    }
}

/// What an answer rests on is looked at when its degree is higher than asked for by at most this much, if only to say that it
/// cannot be followed.
pub(super) const HIGHER: usize = 4;

/// Whether `own` (common factors cancelled) may be followed where the system `of` was asked for.
///
/// `tolerance`: relative, of a coefficient, to tell that it is another operating point's.
pub(super) fn of_function(
    own: &TransferFunction,
    reference: &Reference,
    of: &SystemRef,
    tolerance: &Rational,
) -> Guard {
    let right = accepted(reference, of, |one| &one.linearization.transfer_function);
    let Some(right) = right.first().map(|one| one.what) else { return Guard::Order };
    let orders = |g: &TransferFunction| (g.num.is_zero(), g.num.degree(), g.den.degree());
    if orders(own) != orders(right) {
        Guard::Order
    } else if is_trivial(&own.den, &right.den) || is_beyond_measure(own, right) {
        Guard::Trivial
    } else if is_of_another_point(own, reference, of, tolerance) {
        Guard::OtherPoint
    } else {
        Guard::Passed
    }
}

/// The same for poles; `right` has those of the reference as its roots.
///
/// More than [`HIGHER`] too many are of another function.
pub(super) fn of_poles(own: &OwnPoles, right: &Polynomial) -> Guard {
    if !(right.degree()..=right.degree() + HIGHER).contains(&own.count()) {
        Guard::Order
    } else if is_trivial(&own.polynomial(), right) {
        Guard::Trivial
    } else {
        Guard::Passed
    }
}

/// Hardly a model, unless the reference is one of the kind itself.
fn is_trivial(own: &Polynomial, right: &Polynomial) -> bool {
    let terms = |p: &Polynomial| p.coefficients().iter().filter(|c| !c.is_zero()).count();
    let only_here = |is: fn(&Polynomial) -> bool| is(own) && !is(right);
    2 * terms(own) <= terms(right) || only_here(is_of_units) || only_here(has_one_place)
}

/// s³ + s² + s + 1, and its like: of degree 2 or more, each coefficient that is not zero ±1 of the leading one.
fn is_of_units(p: &Polynomial) -> bool {
    let unit = |c: &Rational| c.is_zero() || *c == Rational::ONE || *c == -Rational::ONE;
    p.degree() >= 2 && p.monic().coefficients().iter().all(unit)
}

/// (s + a)ⁿ with n ≥ 2.
fn has_one_place(p: &Polynomial) -> bool {
    p.degree() >= 2 && matches!(p.square_free().as_slice(), [(factor, _)] if factor.degree() == 1)
}

/// A coefficient a thousand million times too large or too small, the denominators made monic: no mistake of units or of a
/// power of ten goes that far, and next to it everything else is zero.
fn is_beyond_measure(own: &TransferFunction, right: &TransferFunction) -> bool {
    let (own, right) = (own.monic(), right.monic());
    let limit = Rational::from(10).pow(9);
    [(&own.num, &right.num), (&own.den, &right.den)].iter().any(|(own, right)| {
        (0..=right.degree()).any(|power| {
            let (have, want) = (own.coefficient(power), right.coefficient(power));
            if have.is_zero() || want.is_zero() {
                return false;
            }
            let ratio = magnitude(&(have / want));
            ratio > limit || ratio < Rational::ONE / &limit
        })
    })
}

fn is_of_another_point(
    own: &TransferFunction,
    reference: &Reference,
    of: &SystemRef,
    tolerance: &Rational,
) -> bool {
    let Some(this) = operating_point(reference, of) else { return false };
    let Some(model) = reference.models.iter().find(|model| model.id == of.model) else { return false };
    let equal = |right: &TransferFunction| {
        scalings((&right.num, &right.den), (&own.num, &own.den), (tolerance, tolerance))
            .iter()
            .any(|scaled| scaled.is_right(Part::Numerator) && scaled.is_right(Part::Denominator))
    };
    let others = model.operating_points.iter().filter(|point| point.id != this.id);
    others.flat_map(|point| &point.accepted).any(|one| equal(&one.linearization.transfer_function))
}
