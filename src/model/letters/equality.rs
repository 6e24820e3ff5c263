//! Whether a formula is the derived function, by multiplying crosswise.

use super::places::solved;
use super::ring::{Atom, Fraction, Generator, Ring, S};
use super::symbolic::evaluate;
use super::{LetterDerivation, Trouble};
use crate::algebra::{Budget, Expression, Letter, Monomial, MultivariatePolynomial as Poly, Rational};
use std::collections::BTreeMap;

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
        let formula = &self.with_rest(formula);
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
        if !disguised {
            return Some(false);
        }
        // A root may be whole by what holds at rest: √(m g/K) is i₀/x₀.
        let resolved = self.same_at_rest(formula, variable, &mut Budget::new(STEPS));
        resolved.ok().filter(|same| *same)
    }

    /// The same with what holds at rest put into the formula before its roots are taken, and all letters that are positive as
    /// squares, so that √a √b is √(a b).
    fn same_at_rest(
        &self,
        formula: &Expression,
        variable: &str,
        budget: &mut Budget,
    ) -> Result<bool, Trouble> {
        let old = &self.function.ring;
        let (mut ring, values) = self.in_squares(budget)?;
        let mut names = BTreeMap::new();
        for generator in &old.generators {
            if let Atom::Name { name, .. } = &generator.atom
                && let Some(letter) = old.named(name)
            {
                names.insert(name.clone(), mapped(&ring, &letter.num, &values, budget)?);
            }
        }
        let lookup = |name: &str, primes: u8, _: &Ring| match (primes, name == variable) {
            (0, true) => Some(Fraction::polynomial(Poly::letter(S))),
            (0, false) => names.get(name).cloned(),
            _ => None,
        };
        let typed = evaluate(&mut ring, formula, &lookup, budget)?;
        let num = mapped(&ring, &self.function.num, &values, budget)?;
        let den = mapped(&ring, &self.function.den, &values, budget)?;
        let own = ring.quotient(&num, &den, budget)?;
        let left = typed.num.times(&own.den, budget)?;
        let right = typed.den.times(&own.num, budget)?;
        Ok(ring.reduced(left.minus(&right, budget)?, budget)?.is_zero())
    }

    /// A ring of the letters that follow from no others at rest, and what each letter of the old ring is in it.
    fn in_squares(&self, budget: &mut Budget) -> Result<(Ring, Vec<Option<Fraction>>), Trouble> {
        let old = &self.function.ring;
        // The root of a sum is a letter like others, for which the sum can be solved.
        let is_sum =
            |generator: &Generator| matches!(&generator.atom, Atom::Root { of, .. } if of.term_count() > 1);
        let sums = self.roots.iter().filter(|root| root.term_count() > 2);
        let solved = solved(old, self.relations.iter().chain(sums)).ok_or(Trouble::Undefined)?;
        let mut ring = Ring::default();
        let mut values: Vec<Option<Fraction>> = Vec::new();
        for (index, generator) in old.generators.iter().enumerate() {
            let follows = solved.iter().any(|(letter, _)| usize::from(*letter) == index);
            let letter = |atom: Atom, value: f64, power: u32, ring: &mut Ring| {
                let letter = ring.add(Generator { atom, value, exact: None });
                Some(Fraction::polynomial(Poly::term(Rational::ONE, Monomial::letter(letter, power))))
            };
            values.push(match &generator.atom {
                Atom::S | Atom::Pi => letter(generator.atom.clone(), generator.value, 1, &mut ring),
                Atom::Name { name, order } if !follows && generator.value > 0.0 => {
                    let atom = Atom::Name { name: name.clone(), order: 2 * order };
                    letter(atom, generator.value.sqrt(), 2, &mut ring)
                }
                Atom::Name { .. } if !follows => {
                    letter(generator.atom.clone(), generator.value, 1, &mut ring)
                }
                Atom::Root { .. } if is_sum(generator) => {
                    let atom = Atom::Name { name: format!(" {index}"), order: 1 };
                    letter(atom, generator.value, 1, &mut ring)
                }
                _ => None,
            });
        }
        let is_known = |poly: &Poly, values: &[Option<Fraction>]| {
            poly.letters().iter().all(|l| values[usize::from(*l)].is_some())
        };
        // What follows from letters that are known, until there is no more.
        while let Some(index) = (0..values.len()).find(|index| {
            values[*index].is_none()
                && match &old.generators[*index].atom {
                    Atom::Root { of, .. } => is_known(of, &values),
                    Atom::Call { argument, .. } => {
                        is_known(&argument.num, &values) && is_known(&argument.den, &values)
                    }
                    _ => solved.iter().any(|(letter, relation)| {
                        let others = relation.letters().into_iter().filter(|other| other != letter);
                        let mut others = others.map(|other| values[usize::from(other)].is_some());
                        usize::from(*letter) == *index && others.all(|known| known)
                    }),
                }
        }) {
            let value = match &old.generators[index].atom {
                Atom::Root { of, order } => {
                    let of = mapped(&ring, of, &values, budget)?;
                    ring.root(&of, *order, budget)?
                }
                Atom::Call { function, argument } => {
                    let num = mapped(&ring, &argument.num, &values, budget)?;
                    let den = mapped(&ring, &argument.den, &values, budget)?;
                    let argument = ring.quotient(&num, &den, budget)?;
                    Fraction::polynomial(Poly::letter(ring.call(*function, &argument)))
                }
                _ => {
                    let of = solved.iter().find(|(letter, _)| usize::from(*letter) == index);
                    let (letter, relation) = of.ok_or(Trouble::Undefined)?;
                    let parts = relation.coefficients_of(*letter);
                    let [rest, slope] = parts.as_slice() else { return Err(Trouble::Undefined) };
                    let rest = mapped(&ring, &rest.negated(), &values, budget)?;
                    let slope = mapped(&ring, slope, &values, budget)?;
                    ring.quotient(&rest, &slope, budget)?
                }
            };
            values[index] = Some(value);
        }
        Ok((ring, values))
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

/// A polynomial with fractions in place of letters.
fn mapped(
    ring: &Ring,
    poly: &Poly,
    values: &[Option<Fraction>],
    budget: &mut Budget,
) -> Result<Fraction, Trouble> {
    let mut used: Vec<(Letter, &Fraction, u32)> = Vec::new();
    for letter in poly.letters() {
        let value = values.get(usize::from(letter)).and_then(Option::as_ref).ok_or(Trouble::Undefined)?;
        used.push((letter, value, poly.degree_in(letter)));
    }
    let (mut num, mut den) = (Poly::zero(), Poly::one());
    for (monomial, coefficient) in poly.terms() {
        let mut term = Poly::constant(coefficient.clone());
        for (letter, value, highest) in &used {
            let power = monomial.power_of(*letter);
            term = term.times(&value.num.raised_to(power, budget)?, budget)?;
            term = term.times(&value.den.raised_to(highest - power, budget)?, budget)?;
        }
        num = num.plus(&term, budget)?;
    }
    for (_, value, highest) in &used {
        den = den.times(&value.den.raised_to(*highest, budget)?, budget)?;
    }
    ring.fraction(num, den, budget)
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

    const TILTED: System = System {
        coordinates: "theta",
        input: "T",
        parameters: "m = 1; g = 9.81; l = 0.5; c = 0.1",
        derived: "",
        equations: "m*l^2*theta'' + c*theta' + m*g*l*sin(theta) = T",
        at: "theta = pi/6; T = 9.81*0.25",
        output: "theta",
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
                "(-2*g/(x_0*sqrt(m*g/K)))/((L*s + R)*(s^2 - 2*g/x_0))",
                "(-2*sqrt(K*g/m)/x_0)/((L*s + R)*(s^2 - 2*g/x_0))",
                "-2*g*R/V_0/((L*s + R)*(s^2 - 2*g/x_0))",
            ],
            &["(2*g/i_0)/((L*s + R)*(s^2 - 2*g/x_0))", "(-2*g/i_0)/((L*s + R)*(s^2 + 2*g/x_0))"],
            // By the lab's numbers i₀ is positive, and i₀ = x₀ √(m g/K); which other root it is nobody can see.
            &[
                "(2*g/(x_0*sqrt(m*g/K)))/((L*s + R)*(s^2 - 2*g/x_0))",
                "-2*sqrt(m*g/K + 1)/((L*s + R)*(s^2 - 2*g/x_0))",
            ],
        );
        TILTED.check(
            &[
                "1/(m*l^2*s^2 + c*s + m*g*l*sqrt(3)/2)",
                "1/(m*l^2*s^2 + c*s + m*g*l*√3/2)",
                "1/(m*l^2*s^2 + c*s + m*g*l*cos(theta_0))",
                "1/(m*l^2*s^2 + c*s + m*g*l*cos(pi/6))",
                "1/(m*l^2*s^2 + c*s + m*g*l*cos(30°))",
                r"\frac{1}{m l^2 s^2 + c s + m g l\cos\frac{\pi}{6}}",
                "1/(m*l^2*s^2 + c*s + T_0*sqrt(3))",
                "1/(m*l^2*s^2 + c*s + T_0/tan(theta_0))",
                "1/(m*l^2*s^2 + c*s + m*g*l*sqrt(1 - sin(theta_0)^2))",
                "1/(m*l^2*s^2 + c*s + sqrt(m^2*g^2*l^2 - T_0^2))",
            ],
            &[
                "1/(m*l^2*s^2 + c*s + m*g*l/2)",
                "1/(m*l^2*s^2 + c*s + m*g*l*sin(theta_0))",
                "1/(m*l^2*s^2 + c*s - m*g*l*√3/2)",
                "1/(m*l^2*s^2 + c*s + m*g*l*0.866)",
            ],
            &["1/(m*l^2*s^2 + c*s + m*g*l*sqrt(2)/2)"],
        );
        System {
            coordinates: "h",
            input: "q",
            parameters: "A = 1; a = 0.01; g = 9.81",
            derived: "",
            equations: "A*h' = q - a*sqrt(2*g*h)",
            at: "h = 2; q = 0.01*sqrt(2*9.81*2)",
            output: "h",
        }
        .check(
            &[
                "1/(A*s + a*g/sqrt(2*g*h_0))",
                "1/(A*s + a*sqrt(2*g*h_0)/(2*h_0))",
                "1/(A*s + a*sqrt(2*g)*sqrt(h_0)/(2*h_0))",
                "1/(A*s + a*sqrt(2*g)/(2*sqrt(h_0)))",
                "1/(A*s + a*sqrt(4*g^2*h_0)/(2*h_0)/sqrt(2*g))",
                "1/(A*s + a^2*g/q_0)",
                "1/(A*s + a*sqrt(g/(2*h_0)))",
                "1/(A*s + q_0/(2*h_0))",
            ],
            &["1/(A*s + a*g/(2*sqrt(2*g*h_0)))"],
            &[],
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
