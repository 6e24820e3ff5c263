//! The mistakes one is likely to make between the equations and a transfer function, found from any model's equations.

mod calls;
mod factors;
mod parameters;
mod rewrite;
mod terms;
mod whole;

use self::rewrite::rewrite;
use super::linearization::about;
use super::{Equilibrium, Model};
use crate::algebra::{Expression, NodeKind, Rational};
use crate::lti::TransferFunction;
use std::collections::BTreeMap;

/// What a transfer function is derived from.
#[derive(Clone, Copy, Debug)]
pub struct Derivation<'a> {
    pub model: &'a Model,
    pub parameters: &'a BTreeMap<String, Rational>,
    /// Units by parameter: two of the same unit are taken for one another.
    pub units: &'a BTreeMap<String, String>,
    pub at: &'a Equilibrium,
    /// The other operating points that are asked about, each with its title.
    pub others: &'a [(String, &'a Equilibrium)],
    pub input: &'a str,
    pub output: &'a str,
}

/// One thing done wrong on the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    pub kind: MistakeKind,
    /// A clause: ``the term `b*x'` of equation 1 is missing``; formulas stand in backticks.
    pub words: String,
    /// What to change in the derivation to get it: `equation 1: b*x' -> 0`.
    pub change: String,
    /// Where in the equations; none when it is made elsewhere.
    pub places: Vec<Place>,
}

/// A part of an equation: which one, counted from 0, and bytes `start..end` of it as printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    pub equation: usize,
    pub start: usize,
    pub end: usize,
}

/// The likeliest first: the order in which explanations are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MistakeKind {
    OtherPoint,
    WholeSign,
    TermSign,
    PointSign,
    TermDropped,
    PowerDropped,
    FactorDropped,
    ParametersSwapped,
    ParameterDoubled,
    ParameterHalved,
    Origin,
    OtherOutput,
    OtherInput,
    Inverted,
}

impl MistakeKind {
    /// Stable, dotted: `term.sign`.
    pub fn code(self) -> &'static str {
        match self {
            Self::OtherPoint => "point.other",
            Self::WholeSign => "function.sign",
            Self::TermSign => "term.sign",
            Self::PointSign => "point.sign",
            Self::TermDropped => "term.dropped",
            Self::PowerDropped => "factor.power",
            Self::FactorDropped => "factor.dropped",
            Self::ParametersSwapped => "parameter.swapped",
            Self::ParameterDoubled => "parameter.doubled",
            Self::ParameterHalved => "parameter.halved",
            Self::Origin => "function.origin",
            Self::OtherOutput => "output.other",
            Self::OtherInput => "input.other",
            Self::Inverted => "function.inverted",
        }
    }
}

/// Every single mistake and the transfer function it leads to, nothing cancelled; in the order of the equations.
///
/// What cannot be solved, or never moves, is left out. Several may lead to the same function, and some to the right one.
pub fn mistakes(of: &Derivation<'_>) -> Vec<(Mistake, TransferFunction)> {
    let mut all = terms::mistakes(of);
    all.extend(calls::mistakes(of));
    all.extend(factors::mistakes(of));
    all.extend(parameters::mistakes(of));
    all.extend(whole::mistakes(of));
    all.retain(|(_, function)| !function.num.is_zero());
    all
}

impl Derivation<'_> {
    /// What comes out, whether or not the equations balance at the point: a derivation with a mistake in it need not.
    fn result(&self) -> Option<TransferFunction> {
        about(self.model, self.parameters, self.at, self.input, self.output).ok()
    }

    /// With the node at bytes `place` of equation `index` (from 0) made another one.
    fn with_node(
        &self,
        index: usize,
        place: (usize, usize),
        other: &dyn Fn(&Expression) -> NodeKind,
    ) -> Option<TransferFunction> {
        let mut model = self.model.clone();
        let equation = model.equations.get_mut(index)?;
        equation.left = rewrite(&equation.left, place, other);
        equation.right = rewrite(&equation.right, place, other);
        Derivation { model: &model, ..*self }.result()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{parse_decimal, polynomial_text};
    use crate::model::Coordinate;

    /// With a = 2, b = 3, l = 5, k = 7; the rows are expected among the mistakes.
    #[track_caller]
    fn check(equation: &str, at: &str, rows: &[(&str, &str, &str, &str)]) {
        let x = Coordinate { name: "x".into(), unit: "m".into(), description: String::new() };
        let names = ["a", "b", "l", "k"].map(str::to_owned).to_vec();
        let model = Model::new(vec![x], vec!["F".into()], names, &[equation]).unwrap();
        let parameters: BTreeMap<_, _> = [("a", "2"), ("b", "3"), ("l", "5"), ("k", "7")]
            .map(|(name, value)| (name.to_owned(), parse_decimal(value).unwrap()))
            .into();
        let units: BTreeMap<_, _> = [("a", "kg"), ("b", "N s/m"), ("l", "m"), ("k", "kg")]
            .map(|(name, unit)| (name.to_owned(), unit.to_owned()))
            .into();
        let point = |text: &str| {
            Equilibrium::parse(&model, &parameters, &[("x".to_owned(), text.to_owned())]).unwrap()
        };
        let (here, top) = (point(at), point("pi"));
        let others = [("At the top".to_owned(), &top)];
        let of = Derivation {
            model: &model,
            parameters: &parameters,
            units: &units,
            at: &here,
            others: &others,
            input: "F",
            output: "x",
        };
        let all = mistakes(&of);
        for (code, change, num, den) in rows {
            let wanted = |m: &Mistake| m.kind.code() == *code && m.change == *change;
            let found = all.iter().find(|(mistake, _)| wanted(mistake));
            let list: Vec<_> = all.iter().map(|(m, _)| (m.kind.code(), &m.change)).collect();
            let (_, function) = found.unwrap_or_else(|| panic!("{code}, {change}: {list:#?}"));
            let (top, bottom) =
                (polynomial_text(&function.num, "s", 5), polynomial_text(&function.den, "s", 5));
            assert_eq!((top.as_str(), bottom.as_str()), (*num, *den), "{code}, {change}");
        }
        assert!(all.iter().all(|(mistake, _)| !mistake.words.is_empty()));
    }

    #[test]
    fn terms_and_sub_terms() {
        check(
            "F = a*x'' + b*x' + k*sin(x)",
            "0",
            &[
                // code, change, what comes out instead of 1/(2s² + 3s + 7)
                ("term.sign", "equation 1: F -> -F", "-1", "2s^2 + 3s + 7"),
                ("term.sign", "equation 1: b*x' -> -b*x'", "1", "2s^2 - 3s + 7"),
                ("term.dropped", "equation 1: b*x' -> 0", "1", "2s^2 + 7"),
                ("term.dropped", "equation 1: k*sin(x) -> 0", "1", "2s^2 + 3s"),
            ],
        );
        check(
            "F - (a + b*l)*x'' - (-(b - l^2))*x' + (-k*x) = 0",
            "0",
            &[
                // instead of 1/(17s² + 22s + 7)
                ("term.sign", "equation 1: a -> -a", "1", "13s^2 + 22s + 7"),
                ("term.dropped", "equation 1: b*l -> 0", "1", "2s^2 + 22s + 7"),
                ("term.sign", "equation 1: l^2 -> -l^2", "1", "17s^2 - 28s + 7"),
                ("term.dropped", "equation 1: b -> 0", "1", "17s^2 + 25s + 7"),
                ("term.sign", "equation 1: (-k*x) -> -(-k*x)", "1", "17s^2 + 22s - 7"),
            ],
        );
    }

    #[test]
    fn the_point_and_the_calls_at_it() {
        check(
            "F*cos(x) = a*x'' + b*x' + k*sin(x)",
            "pi",
            &[
                // instead of -1/(2s² + 3s - 7)
                ("point.sign", "equation 1: cos(x) -> -cos(x)", "1", "2s^2 + 3s - 7"),
                ("point.sign", "equation 1: sin(x) -> -sin(x)", "-1", "2s^2 + 3s + 7"),
            ],
        );
        check(
            "F*cos(x) = a*x'' + b*x' + k*sin(x)",
            "0",
            &[("point.other", "at: At the top", "-1", "2s^2 + 3s - 7")],
        );
    }

    #[test]
    fn factors_of_products() {
        check(
            "F = (a + b*l^2)*x'' + k*l*sin(x)/b",
            "0",
            &[
                // instead of 1/(77s² + 35/3)
                ("factor.power", "equation 1: l^2 -> l in b*l^2", "1", "17s^2 + 11.667"),
                ("factor.dropped", "equation 1: l^2 -> 1 in b*l^2", "1", "5s^2 + 11.667"),
                ("factor.dropped", "equation 1: b -> 1 in b*l^2", "1", "27s^2 + 11.667"),
                ("factor.dropped", "equation 1: k -> 1 in k*l*sin(x)", "1", "77s^2 + 1.6667"),
            ],
        );
    }

    #[test]
    fn parameters_and_the_whole() {
        check(
            "F = a*x'' + b*x' + k*l*x",
            "0",
            &[
                // instead of 1/(2s² + 3s + 35)
                ("parameter.swapped", "a <-> k", "1", "7s^2 + 3s + 10"),
                ("parameter.doubled", "l -> 2*l", "1", "2s^2 + 3s + 70"),
                ("parameter.halved", "l -> l/2", "1", "2s^2 + 3s + 17.5"),
                ("function.sign", "G -> -G", "-1", "2s^2 + 3s + 35"),
                ("function.inverted", "G -> 1/G", "2s^2 + 3s + 35", "1"),
            ],
        );
        check(
            "F = a*x'' + b*x'",
            "0",
            &[
                // instead of 1/(2s² + 3s)
                ("function.origin", "G -> s*G", "s", "2s^2 + 3s"),
                ("function.origin", "G -> G/s", "1", "2s^3 + 3s^2"),
            ],
        );
    }
}
