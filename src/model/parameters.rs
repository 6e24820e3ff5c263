use super::{Exact, ModelError};
use crate::algebra::{Expression, Rational};
use std::collections::BTreeMap;

/// The value of every parameter, exact as far as it goes.
pub type ParameterValues = BTreeMap<String, Exact>;

/// A parameter whose value follows from those of others.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivedParameter {
    pub name: String,
    pub formula: Expression,
}

/// Parameters that follow from others, each after those it needs.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct DerivedParameters {
    in_order: Vec<DerivedParameter>,
}

impl DerivedParameters {
    /// In any order.
    ///
    /// Errors: [`ModelError::Circle`] with the names that need one another.
    pub fn new(mut waiting: Vec<DerivedParameter>) -> Result<Self, ModelError> {
        let mut in_order = Vec::with_capacity(waiting.len());
        while !waiting.is_empty() {
            let names: Vec<String> = waiting.iter().map(|one| one.name.clone()).collect();
            let (ready, rest): (Vec<_>, Vec<_>) = waiting
                .into_iter()
                .partition(|one| one.formula.symbols().iter().all(|symbol| !names.contains(&symbol.name)));
            if ready.is_empty() {
                return Err(ModelError::Circle { names: circle(&rest) });
            }
            in_order.extend(ready);
            waiting = rest;
        }
        Ok(Self { in_order })
    }

    /// Each after those it needs.
    pub fn iter(&self) -> impl Iterator<Item = &DerivedParameter> {
        self.in_order.iter()
    }

    pub fn contains(&self, name: &str) -> bool {
        self.in_order.iter().any(|one| one.name == name)
    }

    /// The values of all parameters: what `given` says of a derived one is replaced by what follows.
    ///
    /// Accuracy: exact where rationals and multiples of pi go, else about 1 ulp of `f64` a step.
    /// Errors: [`ModelError::Parameter`] where a formula has no value.
    pub fn values(&self, given: &BTreeMap<String, Rational>) -> Result<ParameterValues, ModelError> {
        let mut values: ParameterValues =
            given.iter().map(|(name, value)| (name.clone(), Exact::rational(value.clone()))).collect();
        for DerivedParameter { name, formula } in &self.in_order {
            let lookup = |name: &str, primes: u8| values.get(name).filter(|_| primes == 0).cloned();
            let value = Exact::evaluate(formula, &lookup)
                .map_err(|error| ModelError::Parameter { name: name.clone(), error: Box::new(error) })?;
            values.insert(name.clone(), value);
        }
        Ok(values)
    }

    /// The same without those of `names`, which keep the values they are given.
    pub(super) fn without(&self, names: &[&String]) -> Self {
        let kept = self.in_order.iter().filter(|one| !names.contains(&&one.name));
        Self { in_order: kept.cloned().collect() }
    }

    /// Whether the value of `name` depends on that of `other`.
    pub(super) fn depends(&self, name: &str, other: &str) -> bool {
        let mut reached = vec![name];
        for one in self.in_order.iter().rev() {
            if reached.contains(&one.name.as_str()) {
                let needed = one.formula.symbols();
                if needed.iter().any(|symbol| symbol.name == other) {
                    return true;
                }
                let known = self.in_order.iter().filter(|own| needed.iter().any(|s| s.name == own.name));
                reached.extend(known.map(|own| own.name.as_str()));
            }
        }
        false
    }
}

/// Names of a circle among formulas of which each needs another: `a`, `b`, `a`.
fn circle(waiting: &[DerivedParameter]) -> Vec<String> {
    let next = |name: &String| {
        let own = waiting.iter().find(|one| one.name == *name)?;
        let needed = own.formula.symbols().into_iter().map(|symbol| symbol.name);
        needed.into_iter().find(|name| waiting.iter().any(|one| one.name == *name))
    };
    let mut path: Vec<String> = waiting.first().map(|one| one.name.clone()).into_iter().collect();
    while let Some(name) = path.last().and_then(next) {
        let before = path.iter().position(|known| *known == name);
        path.push(name);
        if let Some(start) = before {
            return path.split_off(start);
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;

    fn derived(formulas: &[(&str, &str)]) -> Result<DerivedParameters, ModelError> {
        let one = |(name, text): &(&str, &str)| DerivedParameter {
            name: (*name).to_owned(),
            formula: Expression::parse(text).unwrap(),
        };
        DerivedParameters::new(formulas.iter().map(one).collect())
    }

    fn given() -> BTreeMap<String, Rational> {
        [("R", "2"), ("k", "0.5"), ("b", "0.1")]
            .map(|(name, value)| (name.to_owned(), parse_decimal(value).unwrap()))
            .into()
    }

    #[test]
    fn they_follow_in_any_order() {
        #[track_caller]
        fn check(formulas: &[(&str, &str)], name: &str, expected: &str) {
            let values = derived(formulas).unwrap().values(&given()).unwrap();
            let expected = parse_decimal(expected).unwrap();
            assert_eq!(values[name], Exact::rational(expected), "{formulas:?}");
        }
        check(&[("K", "k^2/(R*b)")], "K", "1.25");
        check(&[("K", "J*2"), ("J", "3*k")], "K", "3");
        check(&[("J", "3*k"), ("K", "J*2")], "K", "3");
        // A value that is given for a derived one does not count.
        check(&[("b", "R/4")], "b", "0.5");
        check(&[("a", "sin(pi/6)*R")], "a", "1");
        check(&[("slope", "pi/4"), ("a", "tan(slope)")], "a", "1");
    }

    #[test]
    fn irrational_values_are_rounded() {
        let values = derived(&[("c", "sqrt(R)")]).unwrap().values(&given()).unwrap();
        assert_eq!(values["c"], Exact::Approximate(2f64.sqrt()));
    }

    #[test]
    fn what_has_no_value_is_an_error() {
        #[track_caller]
        fn check(formulas: &[(&str, &str)], message: &str) {
            let error = derived(formulas).and_then(|all| all.values(&given())).unwrap_err();
            assert_eq!(error.to_string(), message, "{formulas:?}");
        }
        check(&[("K", "K")], "the formulas go in a circle: `K` needs `K`");
        check(
            &[("a", "2*e"), ("e", "f"), ("f", "e + R")],
            "the formulas go in a circle: `e` needs `f` needs `e`",
        );
        check(&[("K", "1/(R - 2)")], "the parameter `K`: `division by zero` is not defined at this point");
        check(&[("K", "sqrt(-R)")], "the parameter `K`: `sqrt` is not defined at this point");
    }

    #[test]
    fn what_depends_on_what() {
        let all = derived(&[("K", "J*2"), ("J", "3*k"), ("L", "b")]).unwrap();
        for (name, other, expected) in
            [("K", "J", true), ("K", "k", true), ("K", "b", false), ("L", "b", true), ("J", "K", false)]
        {
            assert_eq!(all.depends(name, other), expected, "{name} on {other}");
        }
        let fixed = all
            .without(&[&"J".to_owned()])
            .values(&BTreeMap::from([("J".to_owned(), Rational::from(7)), ("b".to_owned(), Rational::ONE)]));
        assert_eq!(fixed.unwrap()["K"], Exact::rational(Rational::from(14)));
    }
}
