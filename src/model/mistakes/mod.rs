//! The mistakes one is likely to make between the equations and a transfer function, found from any model's equations.

mod calls;
mod degrees;
mod derivation;
mod edit;
mod estimates;
mod factors;
mod parameters;
mod real;
mod rewrite;
mod slopes;
mod terms;
mod whole;

use self::edit::Edit;
pub use derivation::Derivation;
pub use estimates::{Estimates, Pair};
pub use real::{RealFunction, RealPolynomial};

/// One thing done wrong on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    pub kind: MistakeKind,
    /// A clause: ``the term `b*x'` of equation 1 is missing``; formulas stand in backticks.
    pub words: String,
    /// What to change in the derivation to get it: `equation 1: b*x' -> 0`.
    pub change: String,
    /// Where in the equations; none when it is made elsewhere.
    pub places: Vec<Place>,
    edit: Edit,
}

/// A part of an equation: which one, counted from 0, and bytes `start..end` of it as printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    pub equation: usize,
    pub start: usize,
    pub end: usize,
}

impl Place {
    /// Whether `inner` is it or a part of it.
    pub fn holds(&self, inner: &Self) -> bool {
        self.equation == inner.equation && self.start <= inner.start && inner.end <= self.end
    }
}

/// The likeliest first: among equally likely explanations the order in which they are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MistakeKind {
    OtherPoint,
    WholeSign,
    TermSign,
    PointSign,
    TermDropped,
    PowerDropped,
    Slope,
    FactorDropped,
    ParameterMistaken,
    ParametersSwapped,
    ParameterDoubled,
    ParameterHalved,
    Degrees,
    Origin,
    OtherOutput,
    OtherInput,
    Inverted,
    Cancelled,
    ParameterScaled,
}

impl MistakeKind {
    pub const ALL: [Self; 19] = [
        Self::OtherPoint,
        Self::WholeSign,
        Self::TermSign,
        Self::PointSign,
        Self::TermDropped,
        Self::PowerDropped,
        Self::Slope,
        Self::FactorDropped,
        Self::ParameterMistaken,
        Self::ParametersSwapped,
        Self::ParameterDoubled,
        Self::ParameterHalved,
        Self::Degrees,
        Self::Origin,
        Self::OtherOutput,
        Self::OtherInput,
        Self::Inverted,
        Self::Cancelled,
        Self::ParameterScaled,
    ];

    /// Stable, dotted: `term.sign`.
    pub fn code(self) -> &'static str {
        match self {
            Self::OtherPoint => "point.other",
            Self::WholeSign => "function.sign",
            Self::TermSign => "term.sign",
            Self::PointSign => "point.sign",
            Self::TermDropped => "term.dropped",
            Self::PowerDropped => "factor.power",
            Self::Slope => "factor.slope",
            Self::FactorDropped => "factor.dropped",
            Self::ParameterMistaken => "parameter.mistaken",
            Self::ParametersSwapped => "parameter.swapped",
            Self::ParameterDoubled => "parameter.doubled",
            Self::ParameterHalved => "parameter.halved",
            Self::Degrees => "units.degrees",
            Self::Origin => "function.origin",
            Self::OtherOutput => "output.other",
            Self::OtherInput => "input.other",
            Self::Inverted => "function.inverted",
            Self::Cancelled => "function.cancelled",
            Self::ParameterScaled => "parameter.scaled",
        }
    }

    /// How likely it is beside the others, unless a lab says otherwise: a choice, from marking by hand.
    pub fn weight(self) -> u32 {
        match self {
            Self::OtherPoint => 40,
            Self::WholeSign => 36,
            Self::TermSign => 32,
            Self::PointSign => 28,
            Self::TermDropped => 24,
            Self::PowerDropped => 18,
            Self::Slope => 16,
            Self::FactorDropped => 14,
            Self::ParameterMistaken => 12,
            Self::ParametersSwapped => 10,
            Self::ParameterDoubled => 8,
            Self::ParameterHalved | Self::Degrees | Self::Origin => 6,
            Self::OtherOutput | Self::OtherInput | Self::Inverted => 4,
            Self::Cancelled => 3,
            Self::ParameterScaled => 2,
        }
    }
}

impl Mistake {
    /// Whether both can be made in one derivation, and are then two.
    pub fn combines_with(&self, other: &Self) -> bool {
        use MistakeKind::{Degrees, OtherInput, OtherOutput, OtherPoint, PointSign};
        let either = |a: &Self, b: &Self| {
            // What is said of a point or of an output holds of no other.
            matches!(
                (a.kind, b.kind),
                (PointSign, OtherPoint) | (Degrees, OtherOutput | OtherInput | OtherPoint)
            ) || (a.kind == PointSign && b.kind == Degrees && matches!(b.edit, Edit::Rest(..)))
        };
        self.edit.combines_with(&other.edit)
            && !self.edit.makes_up_for(&other.edit)
            && !either(self, other)
            && !either(other, self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{parse_decimal, polynomial_text};
    use crate::model::{Coordinate, Model, Rest};
    use std::collections::BTreeMap;

    /// With a = 2, b = 3, l = 5, k = 7; the rows are expected among the mistakes.
    #[track_caller]
    fn check(equation: &str, at: &str, rows: &[(&str, &str, &str, &str)]) {
        check_in("m", equation, at, rows);
    }

    /// With x in that unit.
    fn derivation(unit: &str, equation: &str, at: &str) -> Derivation {
        let x = Coordinate { name: "x".into(), unit: unit.to_owned(), description: String::new() };
        let names = ["a", "b", "l", "k"].map(str::to_owned).to_vec();
        let model = Model::new(vec![x], vec!["F".into()], names, &[equation]).unwrap();
        let parameters: BTreeMap<_, _> = [("a", "2"), ("b", "3"), ("l", "5"), ("k", "7")]
            .map(|(name, value)| (name.to_owned(), parse_decimal(value).unwrap()))
            .into();
        let units: BTreeMap<_, _> = [("a", "kg"), ("b", "N s/m"), ("l", "m"), ("k", "kg")]
            .map(|(name, unit)| (name.to_owned(), unit.to_owned()))
            .into();
        let point = |text: &str| Rest::parse(&model, &[("x".to_owned(), text.to_owned())]).unwrap();
        let (here, top) = (point(at), point("pi"));
        Derivation {
            units,
            mistaken: [("k".to_owned(), vec![("8".to_owned(), parse_decimal("8").unwrap())])].into(),
            rest: here,
            others: vec![("At the top".to_owned(), top)],
            input: "F".to_owned(),
            input_unit: "N".to_owned(),
            output: "x".to_owned(),
            output_unit: unit.to_owned(),
            model,
            parameters,
        }
    }

    #[track_caller]
    fn check_in(unit: &str, equation: &str, at: &str, rows: &[(&str, &str, &str, &str)]) {
        let of = derivation(unit, equation, at);
        let listed = of.mistakes();
        let all: Vec<_> = listed.into_iter().filter_map(|m| Some((of.function(&[&m])?, m))).collect();
        for (code, change, num, den) in rows {
            let wanted = |m: &Mistake| m.kind.code() == *code && m.change == *change;
            let found = all.iter().find(|(_, mistake)| wanted(mistake));
            let list: Vec<_> = all.iter().map(|(_, m)| (m.kind.code(), &m.change)).collect();
            let (function, _) = found.unwrap_or_else(|| panic!("{code}, {change}: {list:#?}"));
            let (top, bottom) =
                (polynomial_text(&function.num, "s", 5), polynomial_text(&function.den, "s", 5));
            assert_eq!((top.as_str(), bottom.as_str()), (*num, *den), "{code}, {change}");
        }
        assert!(all.iter().all(|(_, mistake)| !mistake.words.is_empty()));
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
        check(
            "F*cos(x) = a*x''*cos(x) + b*x' + k*sin(x)",
            "pi",
            &[
                // instead of 1/(2s² - 3s + 7)
                ("point.sign", "equation 1: cos(x) -> -cos(x) no. 2", "-1", "2s^2 + 3s - 7"),
                ("point.sign", "every cos(x) -> -cos(x)", "1", "2s^2 + 3s - 7"),
                ("point.sign", "every cos(x) -> -cos(x), every sin(x) -> -sin(x)", "1", "2s^2 + 3s + 7"),
            ],
        );
    }

    #[test]
    fn a_point_at_the_same_place_is_no_other() {
        let others = |at: &str, others: &[&str]| {
            let mut of = derivation("m", "F = a*x'' + b*x' + k*sin(x)", at);
            let top = of.others.remove(0).1;
            let bottom = derivation("m", "F = a*x'' + b*x' + k*sin(x)", "0").rest;
            let place = |title: &&str| if title.starts_with("top") { top.clone() } else { bottom.clone() };
            of.others = others.iter().map(|title| ((*title).to_owned(), place(title))).collect();
            let listed = of.mistakes().into_iter().filter(|m| m.kind == MistakeKind::OtherPoint);
            listed.map(|m| m.change).collect::<Vec<_>>()
        };
        assert_eq!(others("pi", &["top, other output", "bottom"]), ["at: bottom"]);
        assert_eq!(others("0", &["top", "top, other output"]), ["at: top"]);
    }

    #[test]
    fn degrees_for_radians() {
        check_in(
            "rad",
            "F = a*x'' + b*x' + k*sin(x)",
            "pi",
            &[
                // instead of 1/(2s² + 3s - 7); cos(180 rad) is -0.5985
                ("units.degrees", "x in degrees", "57.296", "2s^2 + 3s - 7"),
                ("units.degrees", "at: x = 180", "1", "2s^2 + 3s - 4.1892"),
            ],
        );
    }

    #[test]
    fn slopes_without_their_exponent() {
        check(
            "F*x^2 = a*x' + k*x^2 + b*sqrt(l*x)",
            "5",
            &[
                // instead of 25/(2s + 70 + 3/2)
                ("factor.slope", "equation 1: slope of x^2 no. 2 without 2", "25", "2s + 36.5"),
                ("factor.slope", "equation 1: slope of sqrt(l*x) without 1/2", "25", "2s + 73"),
            ],
        );
        let none = |equation: &str| {
            let listed = derivation("m", equation, "0").mistakes();
            assert!(!listed.iter().any(|m| m.kind == MistakeKind::Slope), "{equation}");
        };
        // Of a rate, of a parameter, and where it is level at rest.
        none("F = a*x'^2 + l^2*x");
        none("F = a*x' + b*x^2");
    }

    #[test]
    fn nothing_is_cancelled_wrongly_where_nothing_stands_at_the_origin() {
        let cancels = |m: &Mistake| matches!(m.kind, MistakeKind::Cancelled | MistakeKind::Origin);
        let listed = |equation: &str| derivation("m", equation, "0").mistakes();
        assert!(!listed("F = a*x'' + b*x' + k*x").iter().any(cancels));
        assert!(listed("F = a*x'' + b*x'").iter().any(cancels));
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
                ("parameter.mistaken", "k -> 8", "1", "2s^2 + 3s + 40"),
                ("parameter.scaled", "b -> 10*b", "1", "2s^2 + 30s + 35"),
                ("parameter.scaled", "a -> a/1000", "1", "0.002s^2 + 3s + 35"),
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
                // 1/(s (2s + 3)): the numerator has no s, and nothing of it would be left.
            ],
        );
        check("F = a*x'' + b*x'", "0", &[]);
    }
}
