use super::exact::{Purpose, evaluate};
use super::{Equilibrium, Model, ModelError};
use crate::algebra::{Matrix, Polynomial, Rational, polynomial_determinant};
use crate::lti::{StateSpace, TransferFunction};
use std::collections::BTreeMap;

/// Small deviations about an equilibrium, from one input to one output coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Names of the states in order: `x`, `x'`, `theta`, `theta'`.
    pub states: Vec<String>,
    pub state_space: StateSpace,
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
    at.check(model, parameters)?;
    let slopes = Slopes::at(model, parameters, at)?;
    let uncancelled = slopes.eliminate(input, output)?;
    let cancelled = uncancelled.num.gcd(&uncancelled.den);
    let transfer_function = TransferFunction {
        num: uncancelled.num.exact_quotient(&cancelled),
        den: uncancelled.den.exact_quotient(&cancelled),
    };
    Ok(Linearization {
        states: model.states().iter().map(|(name, primes)| primed(name, *primes)).collect(),
        state_space: slopes.state_space(input, output)?,
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
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    input: &str,
    output: &str,
) -> Result<TransferFunction, ModelError> {
    let (input, output) = places(model, input, output)?;
    Slopes::at(model, parameters, at)?.eliminate(input, output)
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
    /// By equation and input.
    inputs: Vec<Vec<Rational>>,
    /// The order of each coordinate.
    orders: Vec<usize>,
    exact: bool,
}

impl Slopes {
    fn at(
        model: &Model,
        parameters: &BTreeMap<String, Rational>,
        at: &Equilibrium,
    ) -> Result<Self, ModelError> {
        let highest = model.highest_derivatives();
        let mut exact = true;
        let mut slope = |residual: &crate::algebra::Expression, name: &str, primes: u8| {
            let derivative = residual.differentiate(name, primes);
            let lookup = |name: &str, primes: u8| at.lookup(parameters, name, primes);
            let (value, known) = evaluate(&derivative, &lookup, Purpose::Slope)?.to_rational();
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
            let row: Result<Vec<_>, _> = model.inputs.iter().map(|name| slope(&residual, name, 0)).collect();
            inputs.push(row?);
        }
        let orders = highest.iter().map(|(_, order)| usize::from(*order)).collect();
        Ok(Self { coordinates, inputs, orders, exact })
    }

    /// P(s) q + r u = 0 solved for one coordinate by Cramer's rule.
    fn eliminate(&self, input: usize, output: usize) -> Result<TransferFunction, ModelError> {
        let system: Vec<Vec<Polynomial>> = self
            .coordinates
            .iter()
            .map(|row| {
                row.iter().map(|slopes| Polynomial::new(slopes.iter().rev().cloned().collect())).collect()
            })
            .collect();
        let mut replaced = system.clone();
        for (row, slopes) in replaced.iter_mut().zip(&self.inputs) {
            row[output] = Polynomial::constant(-&slopes[input]);
        }
        let (num, den) = (polynomial_determinant(replaced), polynomial_determinant(system));
        match den.leading() {
            None => Err(ModelError::Singular),
            Some(lead) if *lead < Rational::ZERO => Ok(TransferFunction { num: -&num, den: -&den }),
            Some(_) => Ok(TransferFunction { num, den }),
        }
    }

    /// E h + S x + U u = 0 solved for the highest derivatives h.
    fn state_space(&self, input: usize, output: usize) -> Result<StateSpace, ModelError> {
        let leading = Matrix {
            rows: self
                .coordinates
                .iter()
                .map(|row| row.iter().map(|slopes| last(slopes)).collect())
                .collect(),
        };
        // Below the highest, coordinate by coordinate: the same order as the states; then the input.
        let rest = self.coordinates.iter().zip(&self.inputs).map(|(row, inputs)| {
            let states = row.iter().flat_map(|slopes| &slopes[..slopes.len() - 1]);
            states.chain([&inputs[input]]).map(|slope| -slope).collect()
        });
        let solved = leading.solve(&Matrix { rows: rest.collect() }).ok_or(ModelError::Singular)?;
        let n: usize = self.orders.iter().sum();
        let mut state_space = StateSpace {
            a: Matrix::zeros(n, n),
            b: Matrix::zeros(n, 1),
            c: Matrix::zeros(1, n),
            d: Matrix::zeros(1, 1),
        };
        let mut first = 0;
        for (coordinate, &order) in self.orders.iter().enumerate() {
            let highest = &solved.rows[coordinate];
            for k in 0..order {
                let row = first + k;
                if k + 1 < order {
                    state_space.a.rows[row][row + 1] = Rational::ONE;
                } else {
                    state_space.a.rows[row] = highest[..n].to_vec();
                    state_space.b.rows[row][0] = highest[n].clone();
                }
            }
            if coordinate == output {
                if order > 0 {
                    state_space.c.rows[0][first] = Rational::ONE;
                } else {
                    state_space.c.rows[0] = highest[..n].to_vec();
                    state_space.d.rows[0][0] = highest[n].clone();
                }
            }
            first += order;
        }
        Ok(state_space)
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
            terms.extend(model.inputs.iter().cloned().zip(inputs.iter().cloned()));
            terms.retain(|(_, slope)| !slope.is_zero());
            equations.push(terms);
        }
        equations
    }
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
                assert_eq!(state_space_at(&linear.state_space, &s), g.num.eval(&s) / g.den.eval(&s));
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
            ("no highest derivative", plant(&["x^2*x'' + x = u"]), &[], ModelError::Singular),
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
