use super::exact::{NAMES, Nudge, Purpose, evaluate};
use super::{Equilibrium, Exact, Model, ModelError, ParameterValues};
use crate::algebra::{Matrix, Polynomial, Rational, polynomial_determinant};
use crate::lti::{StateSpace, TransferFunction};
use std::collections::BTreeMap;

/// Small deviations about an equilibrium, from one input to one output coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Names of the states in order: `x`, `x'`, `theta`, `theta'`.
    pub states: Vec<String>,
    /// `None` where the equations cannot be solved for the highest derivatives: of an improper transfer function there is none.
    pub state_space: Option<StateSpace>,
    /// Straight from the elimination (Cramer on the polynomial matrix), nothing cancelled; `den` leads with a positive number.
    pub uncancelled: TransferFunction,
    /// The factor (monic gcd) that numerator and denominator share; 1 when they share none.
    pub cancelled: Polynomial,
    /// After cancelling, in the scale the elimination gives (for the cart: 0.0132 s³ + …).
    pub transfer_function: TransferFunction,
    /// The linearized equations: coefficient of each symbol (`x''`, `theta`, `F`, …) in left − right, per equation; zeros left out.
    pub linear_equations: Vec<Vec<(String, Rational)>>,
    /// False when a coefficient had to be rounded to an `f64` (an irrational equilibrium, say).
    pub exact: bool,
}

/// Exact differentiation of every equation at `at`, then elimination of the other coordinates.
///
/// Checks that `at` is an equilibrium first.
pub fn linearize(
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    input: &str,
    output: &str,
) -> Result<Linearization, ModelError> {
    let (input, output) = places(model, input, output)?;
    let parameters = model.derived.values(parameters)?;
    at.balances(model, &parameters)?;
    let slopes = Slopes::at(model, &parameters, at, Purpose::Slope)?;
    let named = |error| match error {
        ModelError::Singular => slopes.dependent(model).unwrap_or(ModelError::Singular),
        error => error,
    };
    let uncancelled = slopes.eliminate(input, output).map_err(named)?;
    let state_space = match slopes.state_space(input, output).map_err(named) {
        Ok(state_space) => Some(state_space),
        // Of a model given as an improper transfer function.
        Err(_) if !model.is_printed() => None,
        Err(error) => return Err(error),
    };
    let cancelled = uncancelled.num.gcd(&uncancelled.den);
    let transfer_function = TransferFunction {
        num: uncancelled.num.exact_quotient(&cancelled),
        den: uncancelled.den.exact_quotient(&cancelled),
    };
    Ok(Linearization {
        states: model.states().iter().map(|(name, primes)| primed(name, *primes)).collect(),
        state_space,
        uncancelled,
        cancelled,
        transfer_function,
        linear_equations: slopes.linear_equations(model),
        exact: slopes.exact,
    })
}

/// The transfer function alone, nothing cancelled, of small deviations from `at`, whether or not the equations balance there.
pub(super) fn about(
    model: &Model,
    parameters: &ParameterValues,
    at: &Equilibrium,
    input: &str,
    output: &str,
) -> Result<TransferFunction, ModelError> {
    let (input, output) = places(model, input, output)?;
    Slopes::at(model, parameters, at, Purpose::Slope)?.eliminate(input, output)
}

/// As [`about`], with every rounded value moved a little, those at rest and derived parameters too.
pub(super) fn moved(
    model: &Model,
    parameters: &ParameterValues,
    at: &Equilibrium,
    (input, output): (&str, &str),
    nudge: Nudge,
) -> Result<TransferFunction, ModelError> {
    let (input, output) = places(model, input, output)?;
    let mut source = NAMES;
    let mut move_all = |values: &ParameterValues| -> ParameterValues {
        let moved = values.iter().map(|(name, value)| {
            let value = match value {
                Exact::Approximate(value) => {
                    source = source.wrapping_add(1);
                    Exact::Approximate(value * nudge.factor(source))
                }
                known => known.clone(),
            };
            (name.clone(), value)
        });
        moved.collect()
    };
    let parameters = move_all(parameters);
    let at = Equilibrium { values: move_all(&at.values) };
    Slopes::at(model, &parameters, &at, Purpose::Moved(nudge))?.eliminate(input, output)
}

/// Where the input and the output coordinate stand in the model.
fn places(model: &Model, input: &str, output: &str) -> Result<(usize, usize), ModelError> {
    let output = model.coordinates.iter().position(|c| c.name == output).ok_or_else(|| no_value(output))?;
    let input = model.inputs.iter().position(|name| name == input).ok_or_else(|| no_value(input))?;
    Ok((input, output))
}

/// Partial derivatives of every left − right.
struct Slopes {
    /// By equation, coordinate and primes 0..=order.
    coordinates: Vec<Vec<Vec<Rational>>>,
    /// By equation, input and primes 0..=the highest of that input.
    inputs: Vec<Vec<Vec<Rational>>>,
    /// The order of each coordinate.
    orders: Vec<usize>,
    exact: bool,
}

impl Slopes {
    fn at(
        model: &Model,
        parameters: &ParameterValues,
        at: &Equilibrium,
        purpose: Purpose,
    ) -> Result<Self, ModelError> {
        let highest = model.highest_derivatives();
        let mut exact = true;
        let mut slope = |residual: &crate::algebra::Expression, name: &str, primes: u8| {
            let derivative = residual.differentiate(name, primes);
            let lookup = |name: &str, primes: u8| at.lookup(parameters, name, primes);
            let (value, known) = evaluate(&derivative, &lookup, purpose)?.to_rational();
            exact &= known;
            Ok::<_, ModelError>(value)
        };
        let mut coordinates = Vec::new();
        let mut inputs = Vec::new();
        for i in 0..model.equations.len() {
            let residual = model.residual(i);
            let mut by_coordinate = Vec::new();
            for (name, order) in &highest {
                let row: Result<Vec<_>, _> = (0..=*order).map(|k| slope(&residual, name, k)).collect();
                by_coordinate.push(row?);
            }
            coordinates.push(by_coordinate);
            let mut by_input = Vec::new();
            for name in &model.inputs {
                let row: Result<Vec<_>, _> =
                    (0..=model.order_of(name)).map(|k| slope(&residual, name, k)).collect();
                by_input.push(row?);
            }
            inputs.push(by_input);
        }
        let orders = highest.iter().map(|(_, order)| usize::from(*order)).collect();
        Ok(Self { coordinates, inputs, orders, exact })
    }

    /// P(s) q + r(s) u = 0 solved for one coordinate by Cramer's rule.
    fn eliminate(&self, input: usize, output: usize) -> Result<TransferFunction, ModelError> {
        let polynomial =
            |slopes: &Vec<Rational>| Polynomial::new(slopes.iter().rev().cloned().collect::<Vec<_>>());
        let system: Vec<Vec<Polynomial>> =
            self.coordinates.iter().map(|row| row.iter().map(polynomial).collect()).collect();
        let mut replaced = system.clone();
        for (row, slopes) in replaced.iter_mut().zip(&self.inputs) {
            row[output] = -&polynomial(&slopes[input]);
        }
        let (num, den) = (polynomial_determinant(replaced), polynomial_determinant(system));
        match den.leading() {
            None => Err(ModelError::Singular),
            Some(lead) if *lead < Rational::ZERO => Ok(TransferFunction { num: -&num, den: -&den }),
            Some(_) => Ok(TransferFunction { num, den }),
        }
    }

    /// The first equation that says nothing new of the highest derivatives: a combination of those before it, or 0.
    fn dependent(&self, model: &Model) -> Option<ModelError> {
        let mut kept: Vec<Vec<Rational>> = Vec::new();
        for (place, row) in self.coordinates.iter().enumerate() {
            let mut row: Vec<Rational> = row.iter().map(|slopes| last(slopes)).collect();
            let is_silent = row.iter().all(Rational::is_zero);
            for known in &kept {
                let Some(pivot) = known.iter().position(|value| !value.is_zero()) else { continue };
                let factor = &row[pivot] / &known[pivot];
                row.iter_mut().zip(known).for_each(|(value, known)| *value -= &factor * known);
            }
            if row.iter().all(Rational::is_zero) {
                let highest = model.highest_derivatives();
                let symbols = highest.iter().map(|(name, primes)| primed(name, *primes)).collect();
                return Some(ModelError::Dependent { equation: place + 1, is_silent, symbols });
            }
            kept.push(row);
        }
        None
    }

    /// E h + S x + U0 u + U1 u' + … = 0 solved for the highest derivatives h.
    ///
    /// Where derivatives of the input enter, a state is not the coordinate itself but what is left of it, see [`without_derivatives`].
    fn state_space(&self, input: usize, output: usize) -> Result<StateSpace, ModelError> {
        let leading = Matrix {
            rows: self
                .coordinates
                .iter()
                .map(|row| row.iter().map(|slopes| last(slopes)).collect())
                .collect(),
        };
        // Below the highest, coordinate by coordinate: the same order as the states; then the input and its derivatives.
        let rest = self.coordinates.iter().zip(&self.inputs).map(|(row, inputs)| {
            let states = row.iter().flat_map(|slopes| &slopes[..slopes.len() - 1]);
            states.chain(&inputs[input]).map(|slope| -slope).collect()
        });
        let solved = leading.solve(&Matrix { rows: rest.collect() }).ok_or(ModelError::Singular)?;
        let n: usize = self.orders.iter().sum();
        let inputs = self.inputs.first().map_or(1, |row| row[input].len());
        let mut a = Matrix::zeros(n, n);
        let mut b = Matrix::zeros(n, inputs);
        let mut c = Matrix::zeros(1, n);
        let mut d = Matrix::zeros(1, inputs);
        let mut first = 0;
        for (coordinate, &order) in self.orders.iter().enumerate() {
            let highest = &solved.rows[coordinate];
            for k in 0..order {
                let row = first + k;
                if k + 1 < order {
                    a.rows[row][row + 1] = Rational::ONE;
                } else {
                    a.rows[row] = highest[..n].to_vec();
                    b.rows[row] = highest[n..].to_vec();
                }
            }
            if coordinate == output {
                if order > 0 {
                    c.rows[0][first] = Rational::ONE;
                } else {
                    c.rows[0] = highest[..n].to_vec();
                    d.rows[0] = highest[n..].to_vec();
                }
            }
            first += order;
        }
        without_derivatives(a, b, c, d).ok_or(ModelError::Improper)
    }

    fn linear_equations(&self, model: &Model) -> Vec<Vec<(String, Rational)>> {
        let mut equations = Vec::new();
        for (row, inputs) in self.coordinates.iter().zip(&self.inputs) {
            let mut terms = Vec::new();
            for (coordinate, slopes) in model.coordinates.iter().zip(row) {
                for (primes, slope) in slopes.iter().enumerate().rev() {
                    terms.push((primed(&coordinate.name, primes as u8), slope.clone()));
                }
            }
            for (input, slopes) in model.inputs.iter().zip(inputs) {
                for (primes, slope) in slopes.iter().enumerate().rev() {
                    terms.push((primed(input, primes as u8), slope.clone()));
                }
            }
            terms.retain(|(_, slope)| !slope.is_zero());
            equations.push(terms);
        }
        equations
    }
}

/// x' = A x + b₀ u + b₁ u' + …, y = c x + d₀ u + d₁ u' + … without the derivatives of u; `b` and `d` have a column for each.
///
/// With x = z + bₖ u⁽ᵏ⁻¹⁾ the highest, k, is gone and leaves A bₖ to bₖ₋₁ and c bₖ to dₖ₋₁. `None` when dₖ is not 0 then: y
/// follows a derivative of u, which no state space does.
fn without_derivatives(a: Matrix, mut b: Matrix, c: Matrix, mut d: Matrix) -> Option<StateSpace> {
    let column =
        |of: &Matrix, k: usize| Matrix { rows: of.rows.iter().map(|row| vec![row[k].clone()]).collect() };
    for k in (1..d.rows[0].len()).rev() {
        if !d.rows[0][k].is_zero() {
            return None;
        }
        let moved = column(&b, k);
        let (to_b, to_d) = (a.mul(&moved)?, c.mul(&moved)?);
        for (row, more) in b.rows.iter_mut().zip(&to_b.rows) {
            row[k - 1] = &row[k - 1] + &more[0];
        }
        d.rows[0][k - 1] = &d.rows[0][k - 1] + &to_d.rows[0][0];
    }
    let (b, d) = (column(&b, 0), column(&d, 0));
    Some(StateSpace { a, b, c, d })
}

fn last(slopes: &[Rational]) -> Rational {
    slopes.last().cloned().unwrap_or(Rational::ZERO)
}

fn primed(name: &str, primes: u8) -> String {
    format!("{name}{}", "'".repeat(primes.into()))
}

fn no_value(name: &str) -> ModelError {
    ModelError::NoValue { name: name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Expression, parse_decimal};
    use crate::model::Coordinate;

    struct Plant {
        coordinates: &'static [&'static str],
        inputs: &'static [&'static str],
        parameters: &'static [(&'static str, &'static str)],
        equations: &'static [&'static str],
    }

    const CART: Plant = Plant {
        coordinates: &["x", "theta"],
        inputs: &["F"],
        parameters: &[("M", "0.5"), ("b", "0.1"), ("m", "0.2"), ("l", "0.3"), ("I", "0.006"), ("g", "9.81")],
        equations: &[
            "F = (M + m)*x'' + b*x' + m*l*theta''*cos(theta) - m*l*theta'^2*sin(theta)",
            "(I + m*l^2)*theta'' + m*g*l*sin(theta) + m*l*x''*cos(theta) = 0",
        ],
    };

    const TANK: Plant = Plant {
        coordinates: &["h"],
        inputs: &["q"],
        parameters: &[("A", "2"), ("k", "0.5")],
        equations: &["A*h' = q - k*sqrt(h)"],
    };

    impl Plant {
        fn model(&self) -> Model {
            let coordinate =
                |n: &&str| Coordinate { name: (*n).into(), unit: String::new(), description: String::new() };
            Model::new(
                self.coordinates.iter().map(coordinate).collect(),
                self.inputs.iter().map(|n| (*n).to_owned()).collect(),
                self.parameters.iter().map(|(n, _)| (*n).to_owned()).collect(),
                self.equations,
            )
            .unwrap()
        }

        fn values(&self) -> BTreeMap<String, Rational> {
            self.parameters.iter().map(|(n, v)| ((*n).to_owned(), parse_decimal(v).unwrap())).collect()
        }

        fn linearize(
            &self,
            at: &[(&str, &str)],
            input: &str,
            output: &str,
        ) -> Result<Linearization, ModelError> {
            let (model, parameters) = (self.model(), self.values());
            let pairs: Vec<_> = at.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
            let at = Equilibrium::parse(&model, &parameters, &pairs)?;
            linearize(&model, &parameters, &at, input, output)
        }
    }

    fn p(coefficients: &[(i64, u64)]) -> Polynomial {
        Polynomial::new(
            coefficients.iter().map(|(n, d)| Rational::from_parts((*n).into(), (*d).into())).collect(),
        )
    }

    /// c (s − A)⁻¹ b + d at s, exactly.
    fn state_space_at(system: &StateSpace, s: &Rational) -> Rational {
        let shifted =
            Matrix::identity(system.a.row_count()).scale(s).add(&system.a.scale(&Rational::NEG_ONE));
        let x = shifted.unwrap().solve(&system.b).unwrap();
        let y = system.c.mul(&x).unwrap().add(&system.d).unwrap();
        y.rows[0][0].clone()
    }

    #[track_caller]
    fn check_two_routes(linear: &Linearization) {
        for s in [2, 5, 11] {
            let s = Rational::from(s);
            for g in [&linear.uncancelled, &linear.transfer_function] {
                assert_eq!(
                    state_space_at(linear.state_space.as_ref().unwrap(), &s),
                    g.num.eval(&s) / g.den.eval(&s)
                );
            }
        }
    }

    #[test]
    fn cart_and_pendulum_by_hand() {
        let s = p(&[(1, 1), (0, 1)]);
        for (name, at, num, den) in [
            (
                "hanging",
                &[][..],
                p(&[(-3, 50), (0, 1)]),
                p(&[(33, 2500), (3, 1250), (20601, 50000), (2943, 50000)]),
            ),
            (
                "upright",
                &[("theta", "pi")],
                p(&[(3, 50), (0, 1)]),
                p(&[(33, 2500), (3, 1250), (-20601, 50000), (-2943, 50000)]),
            ),
        ] {
            let linear = CART.linearize(at, "F", "theta").unwrap();
            assert_eq!(
                linear.transfer_function,
                TransferFunction { num: num.clone(), den: den.clone() },
                "{name}"
            );
            assert_eq!(linear.uncancelled, TransferFunction { num: &num * &s, den: &den * &s }, "{name}");
            assert_eq!(linear.cancelled, s, "{name}");
            assert_eq!(linear.states, ["x", "x'", "theta", "theta'"], "{name}");
            assert!(linear.exact, "{name}");
            check_two_routes(&linear);
        }
    }

    #[test]
    fn linear_equations_of_the_hanging_pendulum() {
        let linear = CART.linearize(&[], "F", "theta").unwrap();
        let row = |terms: &[(&str, &str)]| -> Vec<(String, Rational)> {
            terms.iter().map(|(n, v)| ((*n).to_owned(), parse_decimal(v).unwrap())).collect()
        };
        assert_eq!(
            linear.linear_equations,
            [
                row(&[("x''", "-0.7"), ("x'", "-0.1"), ("theta''", "-0.06"), ("F", "1")]),
                row(&[("x''", "0.06"), ("theta''", "0.024"), ("theta", "0.5886")]),
            ]
        );
    }

    #[test]
    fn a_tank_at_a_level_with_a_rational_root() {
        // A h' = q − k √h at h = 4, q = 1: 2 ḣ + 0.125 h = q.
        let linear = TANK.linearize(&[("h", "4"), ("q", "k*sqrt(4)")], "q", "h").unwrap();
        assert_eq!(
            linear.transfer_function,
            TransferFunction { num: p(&[(1, 1)]), den: p(&[(2, 1), (1, 8)]) }
        );
        assert_eq!((linear.states.len(), linear.exact), (1, true));
        assert_eq!(linear.cancelled, Polynomial::one());
        check_two_routes(&linear);
    }

    #[test]
    fn an_irrational_level_is_rounded_and_says_so() {
        let linear = TANK.linearize(&[("h", "2"), ("q", "k*sqrt(2)")], "q", "h").unwrap();
        assert!(!linear.exact);
        let slope = linear.transfer_function.den.to_f64()[1];
        assert!((slope - 0.25 / 2f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn inputs_that_enter_with_their_derivatives() {
        let plant =
            |equations| Plant { coordinates: &["x", "y"], inputs: &["u"], parameters: &[], equations };
        for (name, equations, num, den) in [
            // s² X + 3 s X + 2 X = (5 s + 7) U by hand.
            (
                "a lead",
                &["x'' + 3*x' + 2*x = 5*u' + 7*u", "y = x"],
                p(&[(5, 1), (7, 1)]),
                p(&[(1, 1), (3, 1), (2, 1)]),
            ),
            ("direct feedthrough", &["x' + 2*x = 3*u'", "y = x"], p(&[(3, 1), (0, 1)]), p(&[(1, 1), (2, 1)])),
            (
                "twice",
                &["x'' + x' = 4*u'' + u", "y = x"],
                p(&[(4, 1), (0, 1), (1, 1)]),
                p(&[(1, 1), (1, 1), (0, 1)]),
            ),
            // y = u' − x' with x' = u' − x is x.
            (
                "one that falls out",
                &["x' = u' - x", "y = u' - x'"],
                p(&[(1, 1), (0, 1)]),
                p(&[(1, 1), (1, 1)]),
            ),
        ] {
            let linear = plant(equations).linearize(&[], "u", "y").unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(linear.transfer_function, TransferFunction { num, den }, "{name}");
            check_two_routes(&linear);
        }
        let differentiator = plant(&["x' = -x + u", "y = u' + x"]).linearize(&[], "u", "y");
        assert_eq!(differentiator, Err(ModelError::Improper));
        let lead = plant(&["x'' + 3*x' = 5*u' + 7*u", "y = x"]).linearize(&[], "u", "y").unwrap();
        let shown: Vec<&str> = lead.linear_equations[0].iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(shown, ["x''", "x'", "u'", "u"]);
    }

    #[test]
    fn algebraic_coordinates_and_several_inputs() {
        let plant = Plant {
            coordinates: &["x", "y"],
            inputs: &["u", "d"],
            parameters: &[],
            equations: &["x' = -x + u", "y = 3*x + 2*d"],
        };
        let from_u = plant.linearize(&[], "u", "y").unwrap();
        assert_eq!(
            from_u.transfer_function,
            TransferFunction { num: p(&[(3, 1)]), den: p(&[(1, 1), (1, 1)]) }
        );
        check_two_routes(&from_u);
        let from_d = plant.linearize(&[], "d", "y").unwrap();
        assert_eq!(from_d.transfer_function, TransferFunction { num: p(&[(2, 1)]), den: p(&[(1, 1)]) });
        assert_eq!(from_d.cancelled, p(&[(1, 1), (1, 1)]));
        check_two_routes(&from_d);
    }

    /// Name, plant, equilibrium as typed, error.
    type Row<'a> = (&'a str, Plant, &'a [(&'a str, &'a str)], ModelError);

    #[track_caller]
    fn check_errors(rows: &[Row]) {
        for (name, plant, at, expected) in rows {
            let (input, output) = (plant.inputs[0], plant.coordinates[0]);
            assert_eq!(plant.linearize(at, input, output).as_ref(), Err(expected), "{name}");
        }
    }

    #[test]
    fn what_cannot_be_linearized() {
        let plant = |equations| Plant { coordinates: &["x"], inputs: &["u"], parameters: &[], equations };
        let undefined = |what: &str| ModelError::Undefined { function: what.to_owned() };
        check_errors(&[
            ("empty tank", TANK, &[], undefined("division by zero")),
            ("Coulomb friction at rest", plant(&["x'' + sign(x') = u"]), &[], undefined("division by zero")),
            ("a kink", plant(&["x' + abs(x) = u"]), &[], undefined("the slope of abs")),
            (
                "no highest derivative",
                plant(&["x^2*x'' + x = u"]),
                &[],
                ModelError::Dependent { equation: 1, is_silent: true, symbols: vec!["x''".into()] },
            ),
            (
                "not at rest",
                plant(&["x' = u"]),
                &[("u", "1")],
                ModelError::NotAnEquilibrium { equation: 1, left: "0".into(), right: "1".into() },
            ),
        ]);
        let drag = plant(&["x'' + abs(x')*x' = u"]).linearize(&[], "u", "x").unwrap();
        assert_eq!(drag.transfer_function.den, p(&[(1, 1), (0, 1), (0, 1)]));
        assert_eq!(TANK.linearize(&[], "q", "x"), Err(no_value("x")));
        assert_eq!(TANK.linearize(&[], "u", "h"), Err(no_value("u")));
    }

    /// An independent route: central differences of left − right about the equilibrium.
    #[test]
    fn slopes_agree_with_central_differences() {
        for (theta, at) in [(0.0, &[][..]), (std::f64::consts::PI, &[("theta", "pi")])] {
            let linear = CART.linearize(at, "F", "theta").unwrap();
            let (model, parameters) = (CART.model(), CART.values());
            for (i, terms) in linear.linear_equations.iter().enumerate() {
                let residual = model.residual(i);
                for symbol in ["x", "x'", "x''", "theta", "theta'", "theta''", "F"] {
                    let value = |push: f64| -> f64 {
                        let lookup = |name: &str, primes: u8| {
                            let rest = match (name, primes) {
                                ("theta", 0) => theta,
                                _ => parameters.get(name).map_or(0.0, crate::algebra::to_f64),
                            };
                            Some(if primed(name, primes) == symbol { rest + push } else { rest })
                        };
                        Expression::eval_f64(&residual, &lookup).unwrap()
                    };
                    let numeric = (value(1e-6) - value(-1e-6)) / 2e-6;
                    let exact = terms.iter().find(|(n, _)| n == symbol);
                    let exact = exact.map_or(0.0, |(_, v)| crate::algebra::to_f64(v));
                    assert!((exact - numeric).abs() < 1e-8, "equation {i} by {symbol}: {exact}, {numeric}");
                }
            }
        }
    }
}
