use super::exact::Nudge;
use super::linearization::moved;
use super::{Equilibrium, Linearization, Model, ParameterValues};
use crate::algebra::Rational;
use crate::lti::{Pole, Stability, TransferFunction, roots, stability};
use std::cmp::Ordering;

/// What rounded coefficients leave open: verdicts that other coefficients, as near to the true ones, would turn.
///
/// Nothing is in doubt where every coefficient is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Doubts {
    /// Whether a coefficient is zero, and of which sign it is; whether a factor cancels.
    pub form: bool,
    /// Of the transfer function.
    pub stability: bool,
    /// Of the whole state.
    pub whole_state: bool,
}

impl Doubts {
    pub fn any(self) -> bool {
        self.form || self.stability || self.whole_state
    }

    /// `which terms it has, or which factors cancel`; empty when nothing is.
    pub fn words(self) -> String {
        let all = [
            (self.form, "which terms it has, or which factors cancel"),
            (self.stability, "the stability of the transfer function"),
            (self.whole_state, "the stability of the whole state"),
        ];
        let words: Vec<String> =
            all.iter().filter(|(open, _)| *open).map(|(_, words)| (*words).to_owned()).collect();
        crate::english::listed(&words, "and")
    }
}

/// A zero and a pole are at one place when they are no farther apart than this many times what rounding may move them.
const APART: f64 = 4.0;

impl Doubts {
    /// What [`Linearization`] decides exactly, decided again with every rounded value moved by a part in 1e9.
    ///
    /// Values that follow from one source (a parameter, a value at rest, a function) move together, so that what cancels
    /// whatever the values are still does. Nothing is worked out where the coefficients are exact.
    pub fn of(
        own: &Linearization,
        model: &Model,
        parameters: &ParameterValues,
        at: &Equilibrium,
        ports: (&str, &str),
    ) -> Self {
        if own.exact {
            return Self::default();
        }
        let here = Verdicts::of(&own.uncancelled);
        let mut doubts = Self::default();
        let mut functions = Vec::new();
        for nudge in Nudge::all() {
            let there = match moved(model, parameters, at, ports, nudge) {
                Ok(function) => {
                    let verdicts = Verdicts::of(&function);
                    functions.push(function.cancelled().0);
                    verdicts
                }
                // It can no longer be solved.
                Err(_) => return Self { form: true, stability: true, whole_state: true },
            };
            doubts.form |= here.form != there.form;
            doubts.stability |= here.stability != there.stability;
            doubts.whole_state |= here.whole_state != there.whole_state;
        }
        doubts.form |= nearly_cancels(&own.transfer_function, &functions);
        doubts
    }
}

/// What is decided exactly.
#[derive(PartialEq)]
struct Verdicts {
    /// The signs of the coefficients of numerator and denominator after cancelling.
    form: [Vec<Ordering>; 2],
    stability: Stability,
    whole_state: Stability,
}

impl Verdicts {
    fn of(uncancelled: &TransferFunction) -> Self {
        let TransferFunction { num, den } = uncancelled.cancelled().0;
        Self {
            form: [&num, &den].map(|p| p.coefficients().iter().map(|c| c.cmp(&Rational::ZERO)).collect()),
            stability: stability(&den),
            whole_state: stability(&uncancelled.den),
        }
    }
}

/// Whether a zero is so near a pole that rounding alone may have set them apart.
fn nearly_cancels(own: &TransferFunction, moved: &[TransferFunction]) -> bool {
    if own.num.degree() == 0 || own.den.degree() == 0 {
        return false;
    }
    let known = |p| roots(p).unwrap_or_default();
    let (zeros, poles) = (known(&own.num), known(&own.den));
    let near = |pole: &Pole, others: &[Pole]| {
        others.iter().map(|other| distance(pole, other)).fold(f64::INFINITY, f64::min)
    };
    // Near enough to be looked at: the roots of a moved function take long.
    const LOOKED_AT: f64 = 1e-3;
    let pairs: Vec<(&Pole, &Pole)> = zeros
        .iter()
        .flat_map(|zero| poles.iter().map(move |pole| (zero, pole)))
        .filter(|(zero, pole)| distance(zero, pole) <= LOOKED_AT * pole.re.hypot(pole.im))
        .collect();
    if pairs.is_empty() {
        return false;
    }
    let moved: Vec<(Vec<Pole>, Vec<Pole>)> =
        moved.iter().map(|one| (known(&one.num), known(&one.den))).collect();
    let farthest = |distances: &mut dyn Iterator<Item = f64>| {
        distances.filter(|distance| distance.is_finite()).fold(0.0, f64::max)
    };
    pairs.iter().any(|(zero, pole)| {
        let by_zero = farthest(&mut moved.iter().map(|(zeros, _)| near(zero, zeros)));
        let by_pole = farthest(&mut moved.iter().map(|(_, poles)| near(pole, poles)));
        distance(zero, pole) <= APART * (by_zero + by_pole)
    })
}

fn distance(a: &Pole, b: &Pole) -> f64 {
    (a.re - b.re).hypot(a.im - b.im)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::model::{Coordinate, Rest, linearize};
    use std::collections::BTreeMap;

    /// Equations in x and y with the input F, k = 2; where they rest; what is open of x by F.
    #[track_caller]
    fn check(what: &str, equations: &[&str], at: &[(&str, &str)], open: &str) {
        let names = ["x", "y"].into_iter().take(equations.len());
        let coordinates = names.map(|name| Coordinate {
            name: name.to_owned(),
            unit: String::new(),
            description: String::new(),
        });
        let model = Model::new(coordinates.collect(), vec!["F".into()], vec!["k".into()], equations).unwrap();
        let given = BTreeMap::from([("k".to_owned(), parse_decimal("2").unwrap())]);
        let pairs: Vec<_> = at.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
        let at = Rest::parse(&model, &pairs).unwrap().at(&model, &given).unwrap();
        let own = linearize(&model, &given, &at, "F", "x").unwrap();
        let parameters = model.derived.values(&given).unwrap();
        assert_eq!(Doubts::of(&own, &model, &parameters, &at, ("F", "x")).words(), open, "{what}");
    }

    #[test]
    fn what_rounding_leaves_open_is_told() {
        const FORM: &str = "which terms it has, or which factors cancel";
        const ALL: &str = "which terms it has, or which factors cancel, the stability of the transfer function and the stability of the whole state";
        check("exact", &["x'' + (k - 2)*x' + k*x = F"], &[], "");
        check("no damping, an irrational spring", &["x'' + sqrt(k)*x = F"], &[], "");
        check("damped", &["x'' + sqrt(k)*x' + x = F"], &[], "");
        check("damped by what is 0 but for rounding", &["x'' + (sqrt(k)^2 - 2)*x' + x = F"], &[], ALL);
        check("two sources", &["x'' + (sqrt(k) - exp(ln(k)/2))*x' + x = F"], &[], ALL);
        check("a damping of 1e-8 is one", &["x'' + (sqrt(k) - 1.41421355)*x' + x = F"], &[], "");
        check(
            "at the level where the slope is 0",
            &["x' = F - x^3 + 3*k*x"],
            &[("x", "sqrt(k)"), ("F", "solve")],
            ALL,
        );
        check(
            "two masses and a spring between them",
            &["x'' + sqrt(k)*(x - y) = F", "y'' + sqrt(k)*(y - x) = 0"],
            &[],
            "",
        );
        check(
            "a zero that an irrational pole cancels",
            &["x' + 2*x = F' + y", "y' + sqrt(k)^2*y = 0"],
            &[],
            "",
        );
        check("nearly so", &["x' + sqrt(k)^2*x = F' + 2*F"], &[], FORM);
        check("not so nearly", &["x' + sqrt(k)*x = F' + 1.4142*F"], &[], "");
    }
}
