use super::Place;
use crate::algebra::{NodeKind, Polynomial, Rational};
use crate::lti::TransferFunction;
use crate::model::Exact;
use std::collections::BTreeMap;

/// What a mistake changes in a derivation.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Edit {
    /// Parts of the equations made another one.
    Nodes(Vec<Place>, Replacement),
    Parameter(ParameterEdit),
    /// Another operating point, as a place among the others.
    Point(usize),
    /// A coordinate or input at rest.
    Rest(String, Exact),
    Output(String),
    Input(String),
    Whole(WholeEdit),
}

/// What a part of an equation becomes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Replacement {
    Negated,
    /// 0 for a term left out, 1 for a factor.
    Number(u8),
    Name(String),
    /// Its value at rest stays, its slope is so many times as steep.
    Slope(Rational),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum ParameterEdit {
    Swapped(String, String),
    Scaled(String, Rational),
    Set(String, Rational),
}

/// What is done to a transfer function that is there.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum WholeEdit {
    Negated,
    Inverted,
    TimesS,
    OverS,
    Scaled(Rational),
    /// s cancelled where one of the two has a constant, which is lost.
    Truncated,
    /// A shared factor cancelled in the numerator only, or in the denominator only.
    SharedLeft {
        in_denominator: bool,
    },
}

impl Replacement {
    pub fn of(&self, node: &crate::algebra::Expression) -> NodeKind {
        match self {
            Self::Negated => super::rewrite::negated(node),
            Self::Number(value) => NodeKind::Number(Rational::from(*value)),
            Self::Name(name) => NodeKind::Symbol { name: name.clone(), primes: 0 },
            Self::Slope(factor) => super::rewrite::with_slope(node, factor),
        }
    }
}

impl ParameterEdit {
    pub fn apply(&self, parameters: &mut BTreeMap<String, Rational>) {
        match self {
            Self::Swapped(first, second) => {
                if let (Some(a), Some(b)) = (parameters.get(first).cloned(), parameters.get(second).cloned())
                {
                    parameters.insert(first.clone(), b);
                    parameters.insert(second.clone(), a);
                }
            }
            Self::Scaled(name, factor) => {
                if let Some(value) = parameters.get_mut(name) {
                    *value = &*value * factor;
                }
            }
            Self::Set(name, value) => {
                parameters.insert(name.clone(), value.clone());
            }
        }
    }

    pub fn names(&self) -> Vec<&String> {
        match self {
            Self::Swapped(first, second) => vec![first, second],
            Self::Scaled(name, _) | Self::Set(name, _) => vec![name],
        }
    }
}

impl WholeEdit {
    /// `None` where there is nothing to do it to.
    pub fn apply(&self, function: TransferFunction) -> Option<TransferFunction> {
        let s = || Polynomial::monomial(Rational::ONE, 1);
        let TransferFunction { num, den } = function;
        match self {
            Self::Negated => TransferFunction::new(-&num, den),
            Self::Inverted => TransferFunction::new(den, num),
            Self::TimesS => TransferFunction::new(&num * &s(), den),
            Self::OverS => TransferFunction::new(num, &den * &s()),
            Self::Scaled(factor) => TransferFunction::new(num.scale(factor), den),
            Self::Truncated => {
                let (TransferFunction { num, den }, _) = TransferFunction { num, den }.cancelled();
                if num.trailing_zeros() + den.trailing_zeros() == 0 {
                    return None;
                }
                let shortened = |polynomial: &Polynomial| {
                    let coefficients = polynomial.coefficients();
                    Polynomial::new(coefficients[..coefficients.len().saturating_sub(1)].to_vec())
                };
                TransferFunction::new(shortened(&num), shortened(&den))
            }
            Self::SharedLeft { in_denominator } => {
                let (short, shared) = TransferFunction { num, den }.cancelled();
                if shared.degree() == shared.trailing_zeros() {
                    return None;
                }
                Some(if *in_denominator {
                    TransferFunction { den: &short.den * &shared, num: short.num }
                } else {
                    TransferFunction { num: &short.num * &shared, den: short.den }
                })
            }
        }
    }
}

impl Edit {
    /// One parameter too large and another too small: that makes up for part of the other, and nobody does it twice by chance.
    pub fn makes_up_for(&self, other: &Self) -> bool {
        let grows = |edit: &Self| match edit {
            Self::Parameter(ParameterEdit::Scaled(_, factor)) => Some(*factor > Rational::ONE),
            _ => None,
        };
        matches!((grows(self), grows(other)), (Some(a), Some(b)) if a != b)
    }

    /// Whether both can be done at once, and are then more than one of them.
    pub fn combines_with(&self, other: &Self) -> bool {
        use Edit::{Input, Nodes, Output, Parameter, Point, Rest, Whole};
        match (self, other) {
            (Nodes(first, to), Nodes(second, becomes)) => {
                let hides = |outer: &[Place], to: &Replacement, inner: &[Place]| {
                    *to != Replacement::Negated
                        && inner.iter().any(|inner| outer.iter().any(|outer| outer.holds(inner)))
                };
                !first.iter().any(|place| second.contains(place))
                    && !hides(first, to, second)
                    && !hides(second, becomes, first)
            }
            (Parameter(first), Parameter(second)) => {
                let names = second.names();
                !first.names().iter().any(|name| names.contains(name))
            }
            (Point(_) | Rest(..), Point(_) | Rest(..)) | (Output(_), Output(_)) | (Input(_), Input(_)) => {
                false
            }
            (Whole(first), Whole(second)) => {
                std::mem::discriminant(first) != std::mem::discriminant(second)
                    && !matches!(
                        (first, second),
                        (WholeEdit::TimesS, WholeEdit::OverS) | (WholeEdit::OverS, WholeEdit::TimesS)
                    )
            }
            _ => true,
        }
    }
}
