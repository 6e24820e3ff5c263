use super::{Exact, Model, ModelError, ParameterValues, Rest};
use crate::algebra::{Expression, NodeKind, Rational, significant};
use std::collections::BTreeMap;

/// Where nothing moves: coordinates and inputs, in plant units; rates are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    pub values: BTreeMap<String, Exact>,
}

impl Equilibrium {
    /// Reads values such as `pi` or `k*sqrt(4)`, in which the parameters may stand; what is not listed is 0.
    pub fn parse(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        pairs: &[(String, String)],
    ) -> Result<Self, ModelError> {
        Rest::parse(model, pairs)?.at(model, parameters)
    }

    /// The value of a coordinate, its derivatives (all 0) or an input.
    pub fn value(&self, name: &str, primes: u8) -> Option<Exact> {
        let value = self.values.get(name)?;
        Some(if primes == 0 { value.clone() } else { Exact::zero() })
    }

    /// Errors unless every equation balances: exactly where the numbers are exact, else within 1e-9 of its terms.
    pub fn check(&self, model: &Model, parameters: &BTreeMap<String, Rational>) -> Result<(), ModelError> {
        self.balances(model, &model.derived.values(parameters)?)
    }

    pub(super) fn balances(&self, model: &Model, parameters: &ParameterValues) -> Result<(), ModelError> {
        let lookup = |name: &str, primes: u8| self.lookup(parameters, name, primes);
        for (i, equation) in model.equations.iter().enumerate() {
            let left = Exact::evaluate(&equation.left, &lookup)?;
            let right = Exact::evaluate(&equation.right, &lookup)?;
            let balanced = match left.clone().minus(right.clone()) {
                difference @ Exact::Known { .. } => difference.is_zero(),
                Exact::Approximate(difference) => {
                    let size =
                        size_of_terms(&equation.left, &lookup)? + size_of_terms(&equation.right, &lookup)?;
                    difference.abs() <= TOLERANCE * size
                }
            };
            if !balanced {
                let shown = |value: Exact| significant(value.to_f64(), 6);
                let (left, right) = (shown(left), shown(right));
                return Err(ModelError::NotAnEquilibrium { equation: i + 1, left, right });
            }
        }
        Ok(())
    }

    /// The value at rest of any name in the equations.
    pub(super) fn lookup(&self, parameters: &ParameterValues, name: &str, primes: u8) -> Option<Exact> {
        let name = name.strip_suffix(AT_REST).unwrap_or(name);
        let parameter = || parameters.get(name).filter(|_| primes == 0).cloned();
        self.value(name, primes).or_else(parameter)
    }
}

/// Behind a name: what it is worth at rest, which nothing moves. No name in a lab ends so.
pub(super) const AT_REST: char = '\0';

/// The same with every name standing for its value at rest.
pub(super) fn at_rest(node: &Expression) -> Expression {
    node.replaced(&|node| match &node.kind {
        NodeKind::Symbol { name, primes } => {
            let kind = NodeKind::Symbol { name: format!("{name}{AT_REST}"), primes: *primes };
            Some(Expression { kind, start: node.start, end: node.end })
        }
        _ => None,
    })
}

/// Of the sum of the sizes of an equation's terms.
const TOLERANCE: f64 = 1e-9;

/// Σ |term| of a sum.
fn size_of_terms(node: &Expression, lookup: &dyn Fn(&str, u8) -> Option<Exact>) -> Result<f64, ModelError> {
    match &node.kind {
        NodeKind::Add(a, b) | NodeKind::Subtract(a, b) => {
            Ok(size_of_terms(a, lookup)? + size_of_terms(b, lookup)?)
        }
        NodeKind::Negate(a) => size_of_terms(a, lookup),
        _ => Ok(Exact::evaluate(node, lookup)?.to_f64().abs()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::model::Coordinate;

    fn pendulum() -> (Model, BTreeMap<String, Rational>) {
        let theta = Coordinate { name: "theta".into(), unit: "rad".into(), description: String::new() };
        let model =
            Model::new(vec![theta], vec!["u".into()], vec!["k".into()], &["theta'' + k*sin(theta) = u"])
                .unwrap();
        (model, BTreeMap::from([("k".to_owned(), parse_decimal("9.81").unwrap())]))
    }

    fn at(pairs: &[(&str, &str)]) -> Result<Equilibrium, ModelError> {
        let (model, parameters) = pendulum();
        let pairs: Vec<_> = pairs.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
        let at = Equilibrium::parse(&model, &parameters, &pairs)?;
        at.check(&model, &parameters)?;
        Ok(at)
    }

    #[test]
    fn where_the_equations_balance() {
        for (pairs, balances) in [
            (&[][..], true),
            (&[("theta", "pi")], true),
            (&[("theta", "-3*pi")], true),
            (&[("theta", "pi/2"), ("u", "9.81")], true),
            (&[("theta", "pi/2"), ("u", "9.8100000001")], false),
            (&[("theta", "pi/6"), ("u", "k/2")], true),
            (&[("theta", "0.5"), ("u", "k*sin(0.5)")], true),
            (&[("theta", "0.5"), ("u", "4.703164526")], true),
            (&[("theta", "0.5"), ("u", "4.7031646")], false),
        ] {
            assert_eq!(at(pairs).is_ok(), balances, "{pairs:?}: {:?}", at(pairs));
        }
    }

    #[test]
    fn elsewhere_is_an_error() {
        for (pairs, message) in [
            (
                &[("theta", "pi/2")][..],
                "equation 1 does not balance at this point: 9.81 on the left, 0 on the right",
            ),
            (&[("theta", "3.14159")], "equation 1 does not balance"),
            (
                &[("phi", "0")],
                "`phi` is neither a coordinate nor an input of the model; these are `theta`, `u`",
            ),
            (&[("theta", "po")], "the value of `theta`: `po` is not a name we know"),
            (&[("theta", "1/0")], "`theta` at rest: `division by zero` is not defined"),
        ] {
            let error = at(pairs).unwrap_err().to_string();
            assert!(error.starts_with(message), "{pairs:?}: {error}");
        }
    }
}
