use super::StaticFunction;

/// Where a tangent is looked at, and how far from the function it is good.
#[derive(Clone, Debug, PartialEq)]
pub struct TangentRule {
    /// The input shown, `from` < `to`; the operating point lies between.
    pub from: f64,
    pub to: f64,
    /// What the tangent may be off by, as a part of the change it foretells: 0.1 is 10 %.
    pub departure: f64,
}

/// A function beside its tangent at an operating point.
#[derive(Clone, Debug, PartialEq)]
pub struct Tangent {
    pub rule: TangentRule,
    /// Input and output at the operating point.
    pub at: (f64, f64),
    /// 0 where the function has no linear part there.
    pub slope: f64,
    /// The nearest input below and above at which |f − tangent| = departure · |slope · (x − x0)|; `None` when it is nowhere so
    /// in what is shown. Where the function ends before, that is where it ends.
    pub good_from: Option<f64>,
    pub good_to: Option<f64>,
    /// (x, f(x)) from `from` to `to`, where the function has a value.
    pub samples: Vec<(f64, f64)>,
}

/// Points drawn of the function.
const DRAWN: usize = 401;
/// Points on each side at which the departure is looked for, equally spaced and ever closer to the operating point.
const LOOKED_AT: usize = 2_000;
/// The nearest of them, as a part of that side.
const NEAREST: f64 = 1e-6;

impl Tangent {
    /// Accuracy of where it stops being good: 1e-9 of the distance from the operating point, for a smooth function.
    pub fn new(function: &StaticFunction, slope: f64, rule: &TangentRule) -> Self {
        let (x0, y0) = function.rest();
        let good = |x: f64| {
            let foretold = slope * (x - x0);
            (function.at(x) - y0 - foretold).abs() <= rule.departure * foretold.abs()
        };
        let end_of = |end: f64| {
            if slope == 0.0 {
                return None;
            }
            let mut parts: Vec<f64> = (1..=LOOKED_AT)
                .flat_map(|k| {
                    let part = k as f64 / LOOKED_AT as f64;
                    [part, NEAREST.powf(1.0 - part)]
                })
                .collect();
            parts.sort_by(f64::total_cmp);
            let mut before = 0.0;
            for part in parts {
                if !good(x0 + part * (end - x0)) {
                    let (mut inside, mut outside) = (before, part);
                    for _ in 0..100 {
                        let middle = 0.5 * (inside + outside);
                        if good(x0 + middle * (end - x0)) {
                            inside = middle;
                        } else {
                            outside = middle;
                        }
                    }
                    return Some(x0 + 0.5 * (inside + outside) * (end - x0));
                }
                before = part;
            }
            None
        };
        let x = |k: usize| rule.from + (rule.to - rule.from) * k as f64 / (DRAWN - 1) as f64;
        Self {
            rule: rule.clone(),
            at: (x0, y0),
            slope,
            good_from: end_of(rule.from),
            good_to: end_of(rule.to),
            samples: (0..DRAWN).map(|k| (x(k), function.at(x(k)))).filter(|(_, y)| y.is_finite()).collect(),
        }
    }

    /// The tangent's output at `x`.
    pub fn line(&self, x: f64) -> f64 {
        self.at.1 + self.slope * (x - self.at.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{parse_decimal, to_f64};
    use crate::model::{Coordinate, Equilibrium, Model, linearize};
    use std::collections::BTreeMap;

    /// Equation, point, shown, then the slope and where the tangent stops being good to 10 %.
    #[track_caller]
    fn check(equation: &str, at: [&str; 2], shown: (f64, f64), slope: f64, good: (Option<f64>, Option<f64>)) {
        let y = Coordinate { name: "y".into(), unit: String::new(), description: String::new() };
        let model = Model::new(vec![y], vec!["x".into()], vec!["k".into()], &[equation]).unwrap();
        let parameters = BTreeMap::from([("k".to_owned(), parse_decimal("2").unwrap())]);
        let pairs = [("x".to_owned(), at[0].to_owned()), ("y".to_owned(), at[1].to_owned())];
        let at = Equilibrium::parse(&model, &parameters, &pairs).unwrap();
        let g = linearize(&model, &parameters, &at, "x", "y").unwrap().transfer_function;
        let found = to_f64(&(g.num.coefficient(0) / g.den.coefficient(0)));
        assert!((found - slope).abs() < 1e-12 * slope.abs().max(1.0), "{equation}: {found}");
        let function = StaticFunction::new(&model, &parameters, &at, "x", "y").unwrap().unwrap();
        let rule = TangentRule { from: shown.0, to: shown.1, departure: 0.1 };
        let tangent = Tangent::new(&function, found, &rule);
        for (found, wanted) in [(tangent.good_from, good.0), (tangent.good_to, good.1)] {
            match (found, wanted) {
                (None, None) => {}
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-9, "{equation}: {a}, not {b}"),
                _ => panic!("{equation}: {found:?}, not {wanted:?}"),
            }
        }
    }

    #[test]
    fn where_tangents_stop_being_good() {
        // (δx)² = 0.1 · 6 · |δx|
        check("y = x^2", ["3", "9"], (0.0, 6.0), 6.0, (Some(2.4), Some(3.6)));
        // out of sight on one side
        check("y = x^2", ["3", "9"], (2.5, 6.0), 6.0, (None, Some(3.6)));
        // no linear part
        check("y = x^2", ["0", "0"], (-1.0, 1.0), 0.0, (None, None));
        // a straight line is good everywhere
        check("y = k*x + 1", ["1", "3"], (-5.0, 5.0), 2.0, (None, None));
        // 3 δx² + δx³ at 1: slope 3; 3|δx| = 0.3 − δx·|δx| …: δx = 0.1·3/(3 ± …)
        check("y = 1/x", ["1", "1"], (0.1, 2.0), -1.0, (Some(1.0 - 1.0 / 11.0), Some(1.0 + 1.0 / 9.0)));
        // given implicitly: y³ = x, δ from 1; y = x^(1/3)
        check(
            "y^2 = x",
            ["4", "2"],
            (1.0, 9.0),
            0.25,
            (Some(4.0 - 1.322314049586777), Some(4.0 + 1.9753086419753085)),
        );
        // in force to the edge of what the root is defined for
        check(
            "y = k*sqrt(x)",
            ["4", "4"],
            (-1.0, 9.0),
            0.5,
            (Some(4.0 - 1.322314049586777), Some(4.0 + 1.9753086419753085)),
        );
    }
}
