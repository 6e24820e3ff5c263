mod pairs;
mod setting;
mod slopes;

use self::setting::{Setting, exchanged};
use self::slopes::{Summand, Variant, summands};
use super::edit::{Edit, WholeEdit};
use super::real::{Entry, MOST_COORDINATES, RealFunction, RealPolynomial};
use super::{Derivation, Mistake};
use crate::algebra::{Expression, Rational, to_f64};
use std::collections::BTreeMap;

/// The transfer functions that mistakes lead to, one or two at once, in `f64`: fast enough for all pairs of a lab.
///
/// Each equation is a sum of terms, and a term's slopes are differentiated once; a mistake in a term exchanges that term's
/// slopes. Accuracy: about 1e-12 of each coefficient; what vanishes is exactly 0. For an exact answer follow the mistakes with
/// [`Derivation::function`].
#[derive(Clone, Debug)]
pub struct Estimates {
    derivation: Derivation,
    mistakes: Vec<Mistake>,
    /// Sets of parameter values.
    choices: Vec<BTreeMap<String, Rational>>,
    /// By equation: the summands of left − right.
    equations: Vec<Vec<Summand>>,
    /// By mistake: the summands it changes.
    variants: Vec<Vec<Variant>>,
    /// By coordinate: where the columns of its derivatives begin.
    columns: Vec<usize>,
    /// The columns of the inputs begin here, as many for each as an [`Entry`] has powers.
    inputs_begin: usize,
    /// Few enough coordinates, of orders that an [`Entry`] has room for, and every slope at the point is a number.
    usable: bool,
}

/// Two mistakes made at once, by their places in the list, the first before the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    pub first: usize,
    pub second: usize,
    /// Which set of parameter values.
    pub choice: usize,
}

impl Estimates {
    /// `mistakes` are those of `derivation`; `choices` are sets of parameter values to follow them with.
    pub fn new(
        derivation: Derivation,
        mistakes: Vec<Mistake>,
        choices: Vec<BTreeMap<String, Rational>>,
    ) -> Self {
        let mut columns = Vec::new();
        let mut next = 0;
        for (_, order) in derivation.model.highest_derivatives() {
            columns.push(next);
            next += usize::from(order) + 1;
        }
        let mut own = Self {
            derivation,
            mistakes,
            choices,
            equations: Vec::new(),
            variants: Vec::new(),
            columns,
            inputs_begin: next,
            usable: true,
        };
        let mut orders = own.derivation.model.highest_derivatives().into_iter();
        let too_high = orders.any(|(_, order)| usize::from(order) >= Entry::default().len());
        if too_high || !(1..=MOST_COORDINATES).contains(&own.columns.len()) || own.choices.is_empty() {
            own.usable = false;
            return own;
        }
        let symbols = own.symbols();
        own.equations = own
            .derivation
            .model
            .equations
            .iter()
            .map(|equation| {
                let mut found = Vec::new();
                summands(&equation.left, false, &mut found);
                summands(&equation.right, true, &mut found);
                let ready = |(node, negative): (&Expression, bool)| Summand {
                    slopes: own.slopes(node, negative, &symbols),
                    node: node.clone(),
                    negative,
                };
                found.into_iter().map(ready).collect()
            })
            .collect();
        own.variants = (0..own.mistakes.len()).map(|place| own.variants_of(&[place], &symbols)).collect();
        own.usable = own.function(&own.setting(0, &[]), &[], own.ports(&[])).is_some();
        own
    }

    pub fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    pub fn derivation(&self) -> &Derivation {
        &self.derivation
    }

    pub fn choices(&self) -> &[BTreeMap<String, Rational>] {
        &self.choices
    }

    /// No function that two mistakes lead to has a numerator or denominator of a higher degree.
    pub fn highest_degree(&self) -> usize {
        let model = &self.derivation.model;
        let inputs = model.inputs.iter().map(|name| usize::from(model.order_of(name))).max().unwrap_or(0);
        // Of the determinant, and one more for a factor `s` too many.
        self.inputs_begin - self.columns.len() + inputs + 1
    }

    /// Where the columns of an input and its derivatives begin.
    fn input_begins(&self, place: usize) -> usize {
        self.inputs_begin + place * Entry::default().len()
    }

    /// Where the columns end.
    fn width(&self) -> usize {
        self.input_begins(self.derivation.model.inputs.len())
    }

    /// Visits what each mistake leads to with each choice of parameter values; what cannot be solved is left out.
    pub fn singles(&self, visit: &mut dyn FnMut(usize, usize, RealFunction)) {
        for choice in 0..self.choices.len() {
            let base = self.usable.then(|| self.setting(choice, &[]));
            for place in 0..self.mistakes.len() {
                let function = match &base {
                    Some(base) => self.single(base, choice, place),
                    None => None,
                };
                if let Some(function) = function.or_else(|| self.exactly(choice, place)) {
                    visit(place, choice, function);
                }
            }
        }
    }

    fn exactly(&self, choice: usize, place: usize) -> Option<RealFunction> {
        let mistake = &self.mistakes[place];
        if self.usable && !matches!(mistake.edit, Edit::Whole(WholeEdit::SharedLeft { .. })) {
            return None;
        }
        let derivation = Derivation { parameters: self.choices[choice].clone(), ..self.derivation.clone() };
        let function = derivation.function(&[mistake])?;
        Some(RealFunction {
            num: RealPolynomial::from_exact(&function.num)?,
            den: RealPolynomial::from_exact(&function.den)?,
        })
    }

    fn single(&self, base: &Setting, choice: usize, place: usize) -> Option<RealFunction> {
        let around;
        let setting = match &self.mistakes[place].edit {
            Edit::Parameter(_) | Edit::Point(_) | Edit::Rest(..) => {
                around = self.setting(choice, &[place]);
                &around
            }
            _ => base,
        };
        let changed = self.changed(setting, &self.variants[place]);
        let function = self.function(setting, &exchanged(&[&changed]), self.ports(&[place]))?;
        self.done(function, &[place]).filter(|function| !function.num.is_zero())
    }

    /// What is done to the function that is there.
    fn done(&self, function: RealFunction, mistakes: &[usize]) -> Option<RealFunction> {
        let mut result = function;
        for place in mistakes {
            let RealFunction { num, den } = result;
            result = match &self.mistakes[*place].edit {
                Edit::Whole(WholeEdit::Negated) => RealFunction { num: num.negated(), den },
                Edit::Whole(WholeEdit::Inverted) => RealFunction { num: den, den: num },
                Edit::Whole(WholeEdit::TimesS) => RealFunction { num: num.times_s()?, den },
                Edit::Whole(WholeEdit::OverS) => RealFunction { num, den: den.times_s()? },
                Edit::Whole(WholeEdit::Scaled(factor)) => {
                    RealFunction { num: num.scaled(to_f64(factor)), den }
                }
                Edit::Whole(WholeEdit::Truncated) => {
                    let short = result.cancelled().unwrap_or_else(|| result.without_shared_s());
                    if short.num.trailing_zeros() + short.den.trailing_zeros() == 0 {
                        return None;
                    }
                    RealFunction { num: short.num.shortened(1), den: short.den.shortened(1) }
                }
                Edit::Whole(WholeEdit::SharedLeft { .. }) => return None,
                _ => result,
            };
            if result.den.is_zero() {
                return None;
            }
        }
        Some(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Expression, parse_decimal};
    use crate::model::{Coordinate, Equation, Model, Rest};

    /// Coordinates and unit, parameters, equations, and the point.
    type Plant<'a> = (
        &'a [(&'a str, &'a str)],
        &'a [(&'a str, &'a str, &'a str)],
        &'a [&'a str],
        &'a [(&'a str, &'a str)],
    );

    const PLANTS: &[Plant<'_>] = &[
        (
            &[("x", "m"), ("theta", "rad")],
            &[("M", "0.5", "kg"), ("b", "0.1", ""), ("m", "0.2", "kg"), ("l", "0.3", "m"), ("g", "9.81", "")],
            &[
                "F = (M + m)*x'' + b*x' + m*l*theta''*cos(theta) - m*l*theta'^2*sin(theta)",
                "m*l^2*theta'' + m*g*l*sin(theta) + m*l*x''*cos(theta) = 0",
            ],
            &[("theta", "pi")],
        ),
        (
            &[("h", "m")],
            &[("A", "2", "m^2"), ("k", "0.5", "")],
            &["A*h' = F - k*sqrt(h)"],
            &[("h", "4"), ("F", "1")],
        ),
        // A shaft between two discs, and a motor: three coordinates, one of the first order.
        (
            &[("p", "rad"), ("q", "rad"), ("i", "A")],
            &[("J", "3", "kg m^2"), ("K", "7", "kg m^2"), ("c", "2", ""), ("k", "11", ""), ("R", "5", "")],
            &["J*p'' + c*p' + k*(p - q) = k*i", "K*q'' = k*(p - q)", "R*i + i' + c*p' = F + d"],
            &[],
        ),
        // A wheel on a tyre: the road acts through its rate as well, and its curvature here.
        (
            &[("x", "m"), ("y", "m")],
            &[("m", "3", "kg"), ("M", "5", "kg"), ("c", "2", ""), ("k", "11", "N/m"), ("K", "7", "N/m")],
            &["m*x'' = c*(F' - x') + k*(F - x) - K*(x - y) + d''", "M*y'' = K*(x - y) - c*d'"],
            &[],
        ),
    ];

    fn estimates((coordinates, parameters, equations, at): &Plant<'_>) -> Estimates {
        let coordinates = coordinates.iter().map(|(name, unit)| Coordinate {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            description: String::new(),
        });
        let names = parameters.iter().map(|(name, _, _)| (*name).to_owned()).collect();
        let model =
            Model::new(coordinates.collect(), vec!["F".into(), "d".into()], names, equations).unwrap();
        let values: BTreeMap<String, Rational> = parameters
            .iter()
            .map(|(name, value, _)| ((*name).to_owned(), parse_decimal(value).unwrap()))
            .collect();
        let pairs: Vec<_> = at.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
        let output = model.coordinates.last().unwrap();
        let derivation = Derivation {
            units: parameters
                .iter()
                .map(|(name, _, unit)| ((*name).to_owned(), (*unit).to_owned()))
                .collect(),
            mistaken: [("l".to_owned(), vec![("0.5".to_owned(), parse_decimal("0.5").unwrap())])].into(),
            rest: Rest::parse(&model, &pairs).unwrap(),
            others: vec![("Elsewhere".to_owned(), Rest::default())],
            input: "F".to_owned(),
            input_unit: String::new(),
            output: output.name.clone(),
            output_unit: output.unit.clone(),
            parameters: values.clone(),
            model,
        };
        let another = values.iter().map(|(name, value)| (name.clone(), value * Rational::from(3))).collect();
        let mistakes = derivation.mistakes();
        Estimates::new(derivation, mistakes, vec![values, another])
    }

    #[track_caller]
    fn check_alike(own: &Estimates, choice: usize, made: &[usize], found: &RealFunction) {
        let derivation = Derivation { parameters: own.choices[choice].clone(), ..own.derivation.clone() };
        let made: Vec<&Mistake> = made.iter().map(|place| &own.mistakes[*place]).collect();
        let exact = derivation.function(&made).unwrap_or_else(|| panic!("{made:?} leads nowhere"));
        let num = RealPolynomial::from_exact(&exact.num).unwrap();
        let den = RealPolynomial::from_exact(&exact.den).unwrap();
        let exact = RealFunction { num, den }.without_shared_s();
        let found = found.without_shared_s();
        let factor = exact.den.coefficients().last().unwrap() / found.den.coefficients().last().unwrap();
        for (exact, found) in [(exact.num, found.num), (exact.den, found.den)] {
            let (exact, found) = (exact.coefficients(), found.coefficients());
            assert_eq!(exact.len(), found.len(), "{made:?}: {exact:?}, {found:?}");
            for (exact, found) in exact.iter().zip(found) {
                assert!((exact - factor * found).abs() <= 1e-10 * exact.abs(), "{made:?}: {exact}, {found}");
            }
        }
    }

    #[test]
    fn a_transfer_function_of_high_order_is_followed_exactly() {
        let mut derivation = estimates(&PLANTS[1]).derivation;
        let (left, right) = Expression::parse_equation("h''' + A*h'' + h' + k*h = F").unwrap();
        derivation.model.equations[0] = Equation { text: String::new(), left, right };
        derivation.rest = Rest::default();
        let mistakes = derivation.mistakes();
        let own = Estimates::new(derivation.clone(), mistakes, vec![derivation.parameters]);
        let mut found = 0;
        own.singles(&mut |mistake, choice, function| {
            check_alike(&own, choice, &[mistake], &function);
            found += 1;
        });
        assert!(found > 3, "{found}");
        own.pairs(&mut |pair, _| panic!("{pair:?}"));
    }

    /// And what is left out does lead nowhere.
    #[test]
    fn estimates_agree_with_exact_derivations() {
        for plant in PLANTS {
            let own = estimates(plant);
            let (count, mut singles) = (own.mistakes.len(), Vec::new());
            own.singles(&mut |mistake, choice, function| {
                check_alike(&own, choice, &[mistake], &function);
                singles.push((mistake, choice));
            });
            let exactly = |made: &[&Mistake]| own.derivation.function(made).is_some();
            for mistake in 0..count {
                assert_eq!(
                    singles.contains(&(mistake, 0)),
                    exactly(&[&own.mistakes[mistake]]),
                    "{:?}",
                    own.mistakes[mistake]
                );
            }
            let (mut pairs, mut turn) = (Vec::new(), 0);
            own.pairs(&mut |pair, function| {
                assert!(
                    function.num.coefficients().len().max(function.den.coefficients().len())
                        <= own.highest_degree() + 1
                );
                pairs.push((pair.first, pair.second, pair.choice));
                // Every so many of them, exactly.
                turn += 1;
                if turn % 37 == 0 {
                    check_alike(&own, pair.choice, &[pair.first, pair.second], &function);
                }
            });
            pairs.sort_unstable();
            let known = pairs.len();
            pairs.dedup();
            assert_eq!(pairs.len(), known, "no pair comes twice");
            for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))).step_by(41) {
                let made = [&own.mistakes[a], &own.mistakes[b]];
                assert_eq!(pairs.binary_search(&(a, b, 0)).is_ok(), exactly(&made), "{made:?}");
            }
        }
    }
}
