//! Whether a formula is the derived function, by multiplying crosswise.

use super::places::solved;
use super::ring::{Atom, Fraction, Generator, Ring, S};
use super::symbolic::evaluate;
use super::{LetterDerivation, Trouble};
use crate::algebra::{Budget, Expression, MultivariatePolynomial as Poly};

/// Products of coefficients for one formula: a few hundredths of a second.
const STEPS: usize = 60_000;

/// Whether `formula` can be multiplied out, with work left to compare it; every name in it is a letter.
pub fn is_light(formula: &Expression) -> bool {
    let mut ring = Ring::default();
    for symbol in formula.symbols() {
        if ring.named(&symbol.name).is_none() {
            let atom = Atom::Name { name: symbol.name, order: 1 };
            ring.add(Generator { atom, value: 1.0, exact: None });
        }
    }
    let lookup = |name: &str, _: u8, ring: &Ring| ring.named(name);
    let evaluated = evaluate(&mut ring, formula, &lookup, &mut Budget::new(STEPS / 2));
    !matches!(evaluated, Err(Trouble::OverBudget))
}

impl LetterDerivation {
    /// Whether `formula` in `variable` is the derived function for all values of the letters that can be at rest: what stands
    /// above times what stands below crosswise, multiplied out and with what holds at rest put in, differ by nothing.
    ///
    /// `None` when that takes more than a budget, when there are other names in it, or when a root or a function that only
    /// the formula has may be something known in disguise.
    pub fn same_as(&self, formula: &Expression, variable: &str) -> Option<bool> {
        let budget = &mut Budget::new(STEPS);
        let mut ring = self.function.ring.clone();
        let lookup = |name: &str, primes: u8, ring: &Ring| match (primes, name == variable) {
            (0, true) => Some(Fraction::polynomial(Poly::letter(S))),
            (0, false) => ring.named(name),
            _ => None,
        };
        let typed = evaluate(&mut ring, formula, &lookup, budget).ok()?;
        if self.at_rest(&ring, typed.den.clone(), budget).ok()?.is_zero() {
            return None;
        }
        if self.difference(&ring, &typed, budget).ok()?.is_zero() {
            return Some(true);
        }
        let known = self.function.ring.generators.len();
        let is_call = |letter: usize| matches!(ring.generators[letter].atom, Atom::Call { .. });
        let disguised = ring.generators.len() > known || (0..known).any(is_call);
        (!disguised).then_some(false)
    }

    fn difference(&self, ring: &Ring, typed: &Fraction, budget: &mut Budget) -> Result<Poly, Trouble> {
        let left = typed.num.times(&self.function.den, budget)?;
        let right = typed.den.times(&self.function.num, budget)?;
        self.at_rest(ring, left.minus(&right, budget)?, budget)
    }

    /// A multiple of `poly` by what is not 0, in letters that may have any value.
    fn at_rest(&self, ring: &Ring, poly: Poly, budget: &mut Budget) -> Result<Poly, Trouble> {
        let mut poly = ring.reduced(poly, budget)?;
        // The root of a number has no letter in it to solve for, and is reduced as it stands.
        let roots = self.roots.iter().filter(|root| root.letters().len() > 1);
        let all = self.relations.iter().chain(roots);
        for (letter, relation) in solved(&self.function.ring, all).ok_or(Trouble::Undefined)? {
            let parts = relation.coefficients_of(letter);
            let [rest, slope] = parts.as_slice() else { return Err(Trouble::Undefined) };
            let rest = rest.negated();
            // letter = rest/slope, all of it multiplied by the highest power of the slope.
            let powers = poly.coefficients_of(letter);
            let highest = powers.len().saturating_sub(1);
            let mut sum = Poly::zero();
            for (power, part) in powers.iter().enumerate() {
                let above = rest.raised_to(power as u32, budget)?;
                let below = slope.raised_to((highest - power) as u32, budget)?;
                sum = sum.plus(&part.times(&above, budget)?.times(&below, budget)?, budget)?;
            }
            poly = sum;
        }
        ring.reduced(poly, budget)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::model::{Coordinate, DerivedParameter, DerivedParameters, Equilibrium, Model};

    /// Names separated by spaces, equations and values by semicolons.
    struct System {
        coordinates: &'static str,
        input: &'static str,
        parameters: &'static str,
        /// Parameters that follow from others.
        derived: &'static str,
        equations: &'static str,
        at: &'static str,
        output: &'static str,
    }

    fn pairs(text: &str) -> Vec<(String, String)> {
        let of = |pair: &str| {
            let (name, value) = pair.split_once('=').unwrap();
            (name.trim().to_owned(), value.trim().to_owned())
        };
        text.split(';').filter(|pair| !pair.trim().is_empty()).map(of).collect()
    }

    impl System {
        fn derivation(&self) -> LetterDerivation {
            let coordinate =
                |n: &str| Coordinate { name: n.into(), unit: String::new(), description: String::new() };
            let coordinates = self.coordinates.split(' ').map(coordinate).collect();
            let derived: Vec<DerivedParameter> = pairs(self.derived)
                .into_iter()
                .map(|(name, text)| DerivedParameter { name, formula: Expression::parse(&text).unwrap() })
                .collect();
            let given: Vec<_> =
                pairs(self.parameters).into_iter().map(|(n, v)| (n, parse_decimal(&v).unwrap())).collect();
            let names = given.iter().map(|(n, _)| n.clone()).chain(derived.iter().map(|d| d.name.clone()));
            let equations: Vec<&str> = self.equations.split(';').map(str::trim).collect();
            let mut model =
                Model::new(coordinates, vec![self.input.into()], names.collect(), &equations).unwrap();
            model.derived = DerivedParameters::new(derived).unwrap();
            let given = given.into_iter().collect();
            let at = Equilibrium::parse(&model, &given, &pairs(self.at)).unwrap();
            LetterDerivation::derive(&model, &given, &at, self.input, self.output).unwrap()
        }

        #[track_caller]
        fn check(&self, same: &[&str], others: &[&str], undecided: &[&str]) {
            let derivation = self.derivation();
            let known = [(Some(true), same), (Some(false), others), (None, undecided)];
            for (expected, texts) in known {
                for text in texts {
                    let formula = Expression::parse_typed(text).unwrap();
                    let found = derivation.same_as(&formula, "s");
                    assert_eq!(found, expected, "{text} for {}", derivation.transfer_function());
                }
            }
        }
    }

    const MOTOR: System = System {
        coordinates: "w i",
        input: "V",
        parameters: "J = 0.01; b = 0.1; K = 0.01; R = 1; L = 0.5",
        derived: "",
        equations: "J*w' + b*w = K*i; L*i' + R*i = V - K*w",
        at: "",
        output: "w",
    };

    const TANK: System = System {
        coordinates: "h",
        input: "q",
        parameters: "A = 2; k = 0.5",
        derived: "",
        equations: "A*h' = q - k*sqrt(h)",
        at: "h = 4; q = 1",
        output: "h",
    };

    #[test]
    fn forms_of_textbook_functions_are_the_same() {
        MOTOR.check(
            &[
                "K/((J*s + b)*(L*s + R) + K^2)",
                "K/(J*L*s^2 + (J*R + b*L)*s + b*R + K^2)",
                "1/(J*L/K*s^2 + (J*R + b*L)/K*s + b*R/K + K)",
                "(K/(J*L))/(s^2 + (R/L + b/J)*s + (b*R + K^2)/(J*L))",
                "(K/((J*s + b)*(L*s + R)))/(1 + K^2/((J*s + b)*(L*s + R)))",
                "K*s*(s + J)/((J*s + b)*(L*s + R)*s + K^2*s)/(s + J)",
            ],
            &[
                "K/((J*s + b)*(L*s + R) - K^2)",
                "K/((J*s + b)*(L*s + R) + K)",
                "K/((J*s + K)*(L*s + R) + K^2)",
                "0.01/((J*s + b)*(L*s + R) + K^2)",
                "K/((J*s + b)*(L*s + 1) + K^2)",
                "0*K",
            ],
            &["K/((J*s + b)*(L*s + R) + K^2 + Z)", "K/(J*w)"],
        );
        System {
            derived: "tau = J*R/(b*R + K^2); G = K/(b*R + K^2)",
            equations: "J*w' + b*w = K*i; R*i = V - K*w",
            ..MOTOR
        }
        .check(
            &[
                "G/(tau*s + 1)",
                "K/(J*R*s + b*R + K^2)",
                "(K/(J*R))/(s + 1/tau)",
                "G/tau/(s + (b*R + K^2)/(J*R))",
            ],
            &["G/(tau*s - 1)", "tau/(G*s + 1)", "G/(tau*s + b)", "K/(J*R*s + tau*R + K^2)"],
            &[],
        );
        TANK.check(
            &[
                "1/(A*s + k/(2*sqrt(h_0)))",
                "1/(A*s + k*h_0^(-1/2)/2)",
                "1/(A*s + 0.5*k*h_0^(-0.5))",
                "2*h_0/(2*A*h_0*s + q_0)",
                "2*q_0/(2*A*q_0*s + k^2)",
                "(2*h_0/q_0)/(2*A*h_0/q_0*s + 1)",
                "2*sqrt(h_0)/(2*A*sqrt(h_0)*s + k)",
                "1/(A*s + k/(2*sqrt(h_0)))*(sin(k)^2 + cos(k)^2)",
            ],
            &["1/(A*s + k/sqrt(h_0))", "1/(A*s + 0.125)", "1/(A*s + k/4)", "1/(A*s - k/(2*sqrt(h_0)))"],
            &["1/(A*s + k/(2*sqrt(h_0)))*exp(k)", "1/(A*s + k/(2*sqrt(2*h_0)))"],
        );
        System {
            coordinates: "h1 h2",
            input: "q",
            parameters: "A1 = 2; A2 = 1; k1 = 0.5; k2 = 0.5",
            derived: "",
            equations: "A1*h1' = q - k1*sqrt(h1 - h2); A2*h2' = k1*sqrt(h1 - h2) - k2*sqrt(h2)",
            at: "h1 = 8; h2 = 4; q = 1",
            output: "h2",
        }
        .check(
            &[
                "k1/(2*sqrt(h1_0 - h2_0))/((A1*s + k1/(2*sqrt(h1_0 - h2_0)))*(A2*s + k1/(2*sqrt(h1_0 - h2_0)) + \
                 k2/(2*sqrt(h2_0))) - k1^2/(4*(h1_0 - h2_0)))",
                "q_0/(2*(h1_0 - h2_0))/((A1*s + q_0/(2*(h1_0 - h2_0)))*(A2*s + q_0/(2*(h1_0 - h2_0)) + q_0/(2*h2_0)) \
                 - q_0^2/(2*(h1_0 - h2_0))^2)",
            ],
            &[
                "k1/(2*sqrt(h1_0 - h2_0))/((A1*s + k1/(2*sqrt(h1_0 - h2_0)))*(A2*s + k1/(2*sqrt(h1_0 - h2_0)) - \
                 k2/(2*sqrt(h2_0))) - k1^2/(4*(h1_0 - h2_0)))",
                "q_0/(2*h2_0)/((A1*s + q_0/(2*h2_0))*(A2*s + q_0/h2_0) - q_0^2/(2*h2_0)^2)",
            ],
            // 0/0 for two reasons, which share nothing.
            &["(q_0 - k1*sqrt(h1_0 - h2_0))/(q_0 - k2*sqrt(h2_0))"],
        );
        System {
            coordinates: "x theta",
            input: "F",
            parameters: "M = 0.5; b = 0.1; m = 0.2; l = 0.3; I = 0.006; g = 9.81",
            derived: "",
            equations: "F = (M + m)*x'' + b*x' + m*l*theta''*cos(theta) - m*l*theta'^2*sin(theta); \
                        (I + m*l^2)*theta'' + m*g*l*sin(theta) + m*l*x''*cos(theta) = 0",
            at: "theta = pi",
            output: "theta",
        }
        .check(
            &[
                "m*l*s/(((M + m)*(I + m*l^2) - (m*l)^2)*s^3 + b*(I + m*l^2)*s^2 - (M + m)*m*g*l*s - b*m*g*l)",
                "m*l*s^2/(((M + m)*s^2 + b*s)*((I + m*l^2)*s^2 - m*g*l) - (m*l)^2*s^4)",
                "s/(((M + m)*(I/(m*l) + l) - m*l)*s^3 + b*(I/(m*l) + l)*s^2 - (M + m)*g*s - b*g)",
                "m*l*s/((M*I + m*I + M*m*l^2)*s^3 + b*(I + m*l^2)*s^2 - (M + m)*m*g*l*s - b*m*g*l)",
            ],
            &[
                "m*l*s/(((M + m)*(I + m*l^2) - (m*l)^2)*s^3 + b*(I + m*l^2)*s^2 + (M + m)*m*g*l*s + b*m*g*l)",
                "-m*l*s/(((M + m)*(I + m*l^2) - (m*l)^2)*s^3 + b*(I + m*l^2)*s^2 - (M + m)*m*g*l*s - b*m*g*l)",
                "m*l*s/(((M + m)*(I + m*l^2) - (m*l)^2)*s^3 + b*(I + m*l^2)*s^2 - 0.7*m*g*l*s - b*m*g*l)",
            ],
            &[],
        );
        System {
            coordinates: "x i",
            input: "V",
            parameters: "m = 0.05; g = 9.81; K = 0.0001; L = 0.01; R = 1",
            derived: "",
            equations: "m*x'' = m*g - K*(i/x)^2; V = R*i + L*i'",
            at: "x = 0.01; i = 0.01*sqrt(0.05*9.81/0.0001); V = 0.01*sqrt(0.05*9.81/0.0001)",
            output: "x",
        }
        .check(
            &[
                "(-2*K*i_0/(m*x_0^2*L))/((s + R/L)*(s^2 - 2*K*i_0^2/(m*x_0^3)))",
                "(-2*g/i_0)/((L*s + R)*(s^2 - 2*g/x_0))",
                "-2*g*R/V_0/((L*s + R)*(s^2 - 2*g/x_0))",
            ],
            &["(2*g/i_0)/((L*s + R)*(s^2 - 2*g/x_0))", "(-2*g/i_0)/((L*s + R)*(s^2 + 2*g/x_0))"],
            // By the lab's numbers i₀ is positive, and i₀ = x₀ √(m g/K); polemark knows only its square.
            &["(-2*g/(x_0*sqrt(m*g/K)))/((L*s + R)*(s^2 - 2*g/x_0))"],
        );
        System {
            coordinates: "x1 x2",
            input: "F",
            parameters: "m1 = 2500; m2 = 320; k1 = 80000; k2 = 500000; c1 = 350; c2 = 15020",
            derived: "",
            equations: "m1*x1'' = -k1*(x1 - x2) - c1*(x1' - x2') + F; \
                        m2*x2'' = k1*(x1 - x2) + c1*(x1' - x2') - k2*x2 - c2*x2' - F",
            at: "",
            output: "x1",
        }
        .check(
            &[
                "(m2*s^2 + c2*s + k2)/((m1*s^2 + c1*s + k1)*(m2*s^2 + (c1 + c2)*s + k1 + k2) - (c1*s + k1)^2)",
                "1/(m1*s^2 + c1*s + k1 - (c1*s + k1)^2/(m2*s^2 + (c1 + c2)*s + k1 + k2))*\
                 (m2*s^2 + c2*s + k2)/(m2*s^2 + (c1 + c2)*s + k1 + k2)",
            ],
            &[
                "(m2*s^2 + c2*s + k2)/((m1*s^2 + c1*s + k1)*(m2*s^2 + (c1 + c2)*s + k1 + k2) + (c1*s + k1)^2)",
                "(m2*s^2 + c1*s + k2)/((m1*s^2 + c1*s + k1)*(m2*s^2 + (c1 + c2)*s + k1 + k2) - (c1*s + k1)^2)",
            ],
            &[],
        );
        System {
            coordinates: "theta",
            input: "T",
            parameters: "m = 1; g = 9.81; l = 0.5; c = 0.1",
            derived: "",
            equations: "m*l^2*theta'' + c*theta' + m*g*l*sin(theta) = T",
            at: "theta = 0.5; T = 1*9.81*0.5*sin(0.5)",
            output: "theta",
        }
        .check(
            &[
                "1/(m*l^2*s^2 + c*s + m*g*l*cos(theta_0))",
                "1/(m*l^2*s^2 + c*s + T_0*cos(theta_0)/sin(theta_0))",
                "1/(m*l^2*s^2 + c*s + T_0/tan(theta_0))",
                "cos(theta_0)/(m*l^2*cos(theta_0)*s^2 + c*cos(theta_0)*s + m*g*l - T_0*sin(theta_0))",
            ],
            &[],
            &["1/(m*l^2*s^2 + c*s + m*g*l*cos(0.5))", "1/(m*l^2*s^2 + c*s + m*g*l)"],
        );
    }

    /// Multiplied out, some of these have more terms than fit into memory.
    #[test]
    fn hostile_formulas_end() {
        let nested = |open: &str, inside: &str, close: &str, n: usize| {
            format!("{}{inside}{}", open.repeat(n), close.repeat(n))
        };
        let tank = TANK.derivation();
        for text in [
            "1/(A*s + k/(2*sqrt(h_0))) + (A+k+h_0+q_0)^60".to_owned(),
            "((A+k+h_0)^60 + s)^60".to_owned(),
            "((((987654321.123^60)^60)^60)^60)^60*A*s".to_owned(),
            "(((A^60)^60)^60)^60".to_owned(),
            "1/(A*s + k^60^60)".to_owned(),
            "(A+k*s)^30*(h_0+q_0*s)^30/(A*s+k)^60".to_owned(),
            "(s+A/7)^20/((s+k/11)^20*(s+h_0/13)^20)".to_owned(),
            "1/(A*s + sqrt(k^7 + 3*A*k + 1/97)^(1/11))".to_owned(),
            "1/(A*s + sqrt(123456789012345678901234567890123456789012345678901234567891*k))".to_owned(),
            nested("(A+k*s*", "1", ")^2", 30),
            format!("1/(A*s + {})", nested("(k+", "k", "*h_0)", 30)),
            format!("1/(A*s + {})", nested("sqrt(", "k", ")", 60)),
            format!("1/(A*s + {})", nested("sqrt(A + ", "k", ")", 30)),
            format!("1/(A*s + {})", nested("exp(", "k", ")", 60)),
            format!("1/(A*s + {})", nested("1/(1 + ", "k", ")", 30)),
            nested("1/(s + A*", "1", ")", 30),
            format!("A{}", "+k/(s+h_0)".repeat(60)),
            (1..60).map(|n| format!("1/(s + {n}*A + k)")).collect::<Vec<_>>().join(" + "),
            (1..60).map(|n| format!("sqrt(A + {n}*k)")).collect::<Vec<_>>().join(" + "),
        ] {
            let formula = Expression::parse_typed(&text).unwrap();
            let _ = tank.same_as(&formula, "s");
        }
    }
}
