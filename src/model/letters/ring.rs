//! The letters a derivation computes with, and fractions of polynomials in them.

use super::Trouble;
use crate::algebra::{
    Budget, Expression, Function, Letter, Monomial, MultivariatePolynomial as Poly, NodeKind, Rational,
    exact_root,
};

/// The Laplace variable is always letter 0.
pub(super) const S: Letter = 0;

/// What a letter stands for.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    S,
    Pi,
    /// A parameter or a value at rest; the letter is its root of that order, so that √h and h are powers of one letter.
    Name {
        name: String,
        order: u32,
    },
    /// The root of that order of a polynomial that is no single letter: its powers are reduced.
    Root {
        of: Poly,
        order: u32,
    },
    /// A function that is not algebraic, of this argument.
    Call {
        function: Function,
        argument: Fraction,
    },
}

/// A letter, what it stands for, and its value by the lab's numbers.
#[derive(Clone, Debug)]
pub(super) struct Generator {
    pub atom: Atom,
    pub value: f64,
    /// The same when it is rational and known exactly.
    pub exact: Option<Rational>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    pub generators: Vec<Generator>,
}

/// `num` over `den` without common factor; `den` is not zero, primitive, and leads with a positive number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fraction {
    pub num: Poly,
    pub den: Poly,
}

impl Fraction {
    pub fn polynomial(num: Poly) -> Self {
        Self { num, den: Poly::one() }
    }

    pub fn constant(value: Rational) -> Self {
        Self::polynomial(Poly::constant(value))
    }

    pub fn zero() -> Self {
        Self::polynomial(Poly::zero())
    }

    pub fn is_zero(&self) -> bool {
        self.num.is_zero()
    }

    pub fn negated(&self) -> Self {
        Self { num: self.num.negated(), den: self.den.clone() }
    }

    pub fn as_constant(&self) -> Option<Rational> {
        self.den.as_constant().and_then(|den| Some(self.num.as_constant()? / den))
    }
}

impl Ring {
    pub fn add(&mut self, generator: Generator) -> Letter {
        let number = self.generators.len() as Letter;
        self.generators.push(generator);
        number
    }

    pub fn atom(&self, letter: Letter) -> Option<&Atom> {
        self.generators.get(usize::from(letter)).map(|generator| &generator.atom)
    }

    /// The value of a polynomial by the lab's numbers; s counts as 0.
    pub fn value(&self, poly: &Poly) -> f64 {
        let of = |letter: Letter| self.generators.get(usize::from(letter)).map_or(f64::NAN, |g| g.value);
        poly.eval(&of, &crate::algebra::to_f64)
    }

    /// The same when it is rational and known exactly.
    fn exact(&self, poly: &Poly) -> Option<Rational> {
        let of = |letter: Letter| self.generators.get(usize::from(letter)).and_then(|g| g.exact.clone());
        let known = poly.letters().into_iter().all(|letter| of(letter).is_some());
        known.then(|| poly.eval(&|letter| of(letter).unwrap_or(Rational::ZERO), &Rational::clone))
    }

    pub fn value_of(&self, fraction: &Fraction) -> f64 {
        self.value(&fraction.num) / self.value(&fraction.den)
    }

    /// Powers of roots, and squares of sines, replaced by what they are.
    pub fn reduced(&self, poly: Poly, budget: &mut Budget) -> Result<Poly, Trouble> {
        let mut poly = poly;
        for letter in poly.letters() {
            let (order, square) = match self.atom(letter) {
                Some(Atom::Root { of, order }) => (*order, of.clone()),
                Some(Atom::Call { function: Function::Sin, argument }) => {
                    let Some(cosine) = self.call_letter(Function::Cos, argument) else { continue };
                    let one = Poly::one();
                    (2, one.minus(&Poly::letter(cosine).raised_to(2, budget)?, budget)?)
                }
                _ => continue,
            };
            if poly.degree_in(letter) < order {
                continue;
            }
            let mut result = Poly::zero();
            for (power, part) in poly.coefficients_of(letter).iter().enumerate() {
                let power = power as u32;
                let rest = Poly::term(Rational::ONE, Monomial::letter(letter, power % order));
                let whole = square.raised_to(power / order, budget)?;
                result = result.plus(&part.times(&rest, budget)?.times(&whole, budget)?, budget)?;
            }
            poly = result;
        }
        Ok(poly)
    }

    pub fn fraction(&self, num: Poly, den: Poly, budget: &mut Budget) -> Result<Fraction, Trouble> {
        let (num, den) = (self.reduced(num, budget)?, self.reduced(den, budget)?);
        if den.is_zero() {
            return Err(Trouble::Undefined);
        }
        if num.is_zero() {
            return Ok(Fraction::zero());
        }
        let (num, den, _) = self.shortened(num, den, budget)?;
        let whole = den.primitive();
        let factor = match (den.leading(), whole.leading()) {
            (Some((_, a)), Some((_, b))) => b / a,
            _ => Rational::ONE,
        };
        Ok(Fraction { num: num.scaled(&factor), den: whole })
    }

    /// Without what both hold, and that.
    pub fn shortened(
        &self,
        num: Poly,
        den: Poly,
        budget: &mut Budget,
    ) -> Result<(Poly, Poly, Poly), Trouble> {
        let mut shared = num.gcd(&den, budget)?;
        let (mut num, mut den) = match shared.as_constant() {
            Some(_) => (num, den),
            None => (
                num.exact_quotient(&shared, budget)?.unwrap_or(num),
                den.exact_quotient(&shared, budget)?.unwrap_or(den),
            ),
        };
        // A square root may be in both without being seen in one: a − b is (√(a − b))².
        let mut letters = [num.letters(), den.letters()].concat();
        letters.dedup();
        for letter in letters {
            while let (Some(a), Some(b)) =
                (self.over_root(&num, letter, budget)?, self.over_root(&den, letter, budget)?)
            {
                (num, den) = (a, b);
                shared = shared.times(&Poly::letter(letter), budget)?;
            }
        }
        Ok((num, den, self.reduced(shared, budget)?))
    }

    /// p₀ + p₁ w over w = √q as p₁ + (p₀/q) w; `None` when that is no polynomial, or the letter is no square root.
    fn over_root(&self, poly: &Poly, letter: Letter, budget: &mut Budget) -> Result<Option<Poly>, Trouble> {
        let Some(Atom::Root { of, order: 2 }) = self.atom(letter) else { return Ok(None) };
        let mut parts = poly.coefficients_of(letter);
        if parts.len() > 2 || of.as_constant().is_some() {
            return Ok(None);
        }
        parts.resize(2, Poly::zero());
        match parts[0].exact_quotient(of, budget)? {
            Some(rest) => {
                let with = rest.times(&Poly::letter(letter), budget)?;
                Ok(Some(parts[1].plus(&with, budget)?))
            }
            None => Ok(None),
        }
    }

    pub fn sum(&self, a: &Fraction, b: &Fraction, budget: &mut Budget) -> Result<Fraction, Trouble> {
        if a.den == b.den {
            return self.fraction(a.num.plus(&b.num, budget)?, a.den.clone(), budget);
        }
        let shared = a.den.gcd(&b.den, budget)?;
        let own = a.den.exact_quotient(&shared, budget)?.unwrap_or_default();
        let other = b.den.exact_quotient(&shared, budget)?.unwrap_or_default();
        let sum = a.num.times(&other, budget)?.plus(&b.num.times(&own, budget)?, budget)?;
        self.fraction(sum, own.times(&b.den, budget)?, budget)
    }

    pub fn product(&self, a: &Fraction, b: &Fraction, budget: &mut Budget) -> Result<Fraction, Trouble> {
        if a.is_zero() || b.is_zero() {
            return Ok(Fraction::zero());
        }
        self.fraction(a.num.times(&b.num, budget)?, a.den.times(&b.den, budget)?, budget)
    }

    pub fn quotient(&self, a: &Fraction, b: &Fraction, budget: &mut Budget) -> Result<Fraction, Trouble> {
        if b.is_zero() {
            return Err(Trouble::Undefined);
        }
        self.fraction(a.num.times(&b.den, budget)?, a.den.times(&b.num, budget)?, budget)
    }

    pub fn whole_power(&self, a: &Fraction, power: i32, budget: &mut Budget) -> Result<Fraction, Trouble> {
        let times = power.unsigned_abs();
        let (num, den) = (a.num.raised_to(times, budget)?, a.den.raised_to(times, budget)?);
        if power < 0 { self.fraction(den, num, budget) } else { self.fraction(num, den, budget) }
    }

    /// The root of that order, at least 2.
    pub fn root(&mut self, a: &Fraction, order: u32, budget: &mut Budget) -> Result<Fraction, Trouble> {
        if a.is_zero() {
            return Ok(Fraction::zero());
        }
        // ⁿ√(p/q) is ⁿ√(p qⁿ⁻¹)/q, and whole powers come out.
        let inside = a.num.times(&a.den.raised_to(order - 1, budget)?, budget)?;
        let (number, factors) = inside.light_factors(budget)?;
        let mut outside = Poly::one();
        let mut left = Poly::one();
        for (factor, power) in factors {
            let (out, rest) = self.taken_out(&factor, power, order);
            outside = outside.times(&out.raised_to(1, budget)?, budget)?;
            left = left.times(&rest.0.raised_to(rest.1, budget)?, budget)?;
        }
        let negative = number < Rational::ZERO;
        if negative && (order % 2 == 1 || left.as_constant().is_some()) {
            return Err(Trouble::Undefined);
        }
        let size = if negative { -&number } else { number.clone() };
        let degree = u8::try_from(order).map_err(|_| Trouble::Undefined)?;
        let (outside, inside) = match exact_root(&size, degree) {
            Some(root) => (outside.scaled(&root), if negative { left.negated() } else { left }),
            None => {
                let (out, inside) = if order == 2 { squares_out(&size) } else { (Rational::ONE, size) };
                (outside.scaled(&out), left.scaled(&if negative { -inside } else { inside }))
            }
        };
        let outside = self.fraction(outside, a.den.clone(), budget)?;
        // √(v²) is −v where v is negative by the lab's numbers.
        let outside = if order.is_multiple_of(2) && self.value_of(&outside) < 0.0 {
            outside.negated()
        } else {
            outside
        };
        if inside == Poly::one() {
            return Ok(outside);
        }
        let letter = self.root_letter(inside, order);
        self.product(&outside, &Fraction::polynomial(Poly::letter(letter)), budget)
    }

    /// factor^(power/order) as what comes out of the root, and the (base, power) that stays inside.
    fn taken_out(&self, factor: &Poly, power: u32, order: u32) -> (Poly, (Poly, u32)) {
        let only =
            factor.leading().filter(|_| factor.term_count() == 1).map(|(monomial, _)| monomial.powers());
        if let Some([(letter, 1)]) = only
            && let Some(Atom::Name { order: known, .. }) = self.atom(*letter)
            && known % order == 0
            && power.is_multiple_of(order)
        {
            return (Poly::term(Rational::ONE, Monomial::letter(*letter, power / order)), (Poly::one(), 0));
        }
        let out = if power >= order && factor.term_count() == 1 { power / order } else { 0 };
        let outside = match only {
            Some([(letter, 1)]) => Poly::term(Rational::ONE, Monomial::letter(*letter, out)),
            _ => Poly::one(),
        };
        (outside, (factor.clone(), power - out * order))
    }

    fn root_letter(&mut self, of: Poly, order: u32) -> Letter {
        let known = self.generators.iter().position(
            |g| matches!(&g.atom, Atom::Root { of: known, order: o } if *known == of && *o == order),
        );
        match known {
            Some(letter) => letter as Letter,
            None => {
                let value = self.value(&of).powf(1.0 / f64::from(order));
                let exact = self.exact(&of).and_then(|v| exact_root(&v, u8::try_from(order).ok()?));
                self.add(Generator { atom: Atom::Root { of, order }, value, exact })
            }
        }
    }

    pub fn call_letter(&self, function: Function, argument: &Fraction) -> Option<Letter> {
        let found = self.generators.iter().position(
            |g| matches!(&g.atom, Atom::Call { function: f, argument: a } if *f == function && a == argument),
        );
        found.map(|letter| letter as Letter)
    }

    /// The function of an argument as a letter of its own.
    pub fn call(&mut self, function: Function, argument: &Fraction) -> Letter {
        match self.call_letter(function, argument) {
            Some(letter) => letter,
            None => {
                let value = function.apply(self.value_of(argument));
                let atom = Atom::Call { function, argument: argument.clone() };
                self.add(Generator { atom, value, exact: None })
            }
        }
    }

    pub fn pi(&mut self) -> Letter {
        match self.generators.iter().position(|g| matches!(g.atom, Atom::Pi)) {
            Some(letter) => letter as Letter,
            None => self.add(Generator { atom: Atom::Pi, value: std::f64::consts::PI, exact: None }),
        }
    }

    /// The letter of a name, when there is one.
    pub fn named(&self, name: &str) -> Option<Fraction> {
        let place = self
            .generators
            .iter()
            .position(|g| matches!(&g.atom, Atom::Name { name: n, .. } if n == name))?;
        let Atom::Name { order, .. } = &self.generators[place].atom else { return None };
        Some(Fraction::polynomial(Poly::term(Rational::ONE, Monomial::letter(place as Letter, *order))))
    }

    /// k when the fraction is k·π.
    pub fn multiple_of_pi(&self, fraction: &Fraction) -> Option<Rational> {
        if fraction.is_zero() {
            return Some(Rational::ZERO);
        }
        let den = fraction.den.as_constant()?;
        let (monomial, factor) = fraction.num.leading().filter(|_| fraction.num.term_count() == 1)?;
        match monomial.powers() {
            [(letter, 1)] if matches!(self.atom(*letter), Some(Atom::Pi)) => Some(factor / den),
            _ => None,
        }
    }

    /// The letter to that power, as one writes it.
    pub fn shown(
        &self,
        letter: Letter,
        power: u32,
        form: &dyn Fn(&Fraction) -> Expression,
    ) -> Vec<Expression> {
        let raised = |base: Expression, power: u32| match power {
            0 => None,
            1 => Some(base),
            n => Some(node(NodeKind::Power(Box::new(base), Box::new(number(Rational::from(n)))))),
        };
        let name = |name: &str| node(NodeKind::Symbol { name: name.to_owned(), primes: 0 });
        let Some(atom) = self.atom(letter) else { return Vec::new() };
        match atom {
            Atom::S => raised(name("s"), power).into_iter().collect(),
            Atom::Pi => raised(node(NodeKind::Pi), power).into_iter().collect(),
            Atom::Name { name: n, order } => {
                let whole = raised(name(n), power / order);
                let root = (!power.is_multiple_of(*order)).then(|| rooted(name(n), power % order, *order));
                whole.into_iter().chain(root).collect()
            }
            Atom::Root { of, order } => {
                let inside = form(&Fraction::polynomial(of.clone()));
                vec![rooted(inside, power, *order)]
            }
            Atom::Call { function, argument } => {
                let call = node(NodeKind::Call(*function, Box::new(form(argument))));
                raised(call, power).into_iter().collect()
            }
        }
    }
}

/// √value as rational · √whole, squares of small numbers taken out: 3/4 is (1/2, 3).
fn squares_out(value: &Rational) -> (Rational, Rational) {
    let bottom = Rational::from(value.denominator().clone());
    let (mut out, mut inside) = (Rational::ONE / &bottom, value * &bottom * &bottom);
    for n in 2..=100u32 {
        let square = Rational::from(n * n);
        while (&inside / &square).is_int() {
            inside /= &square;
            out *= Rational::from(n);
        }
    }
    (out, inside)
}

/// base^(power/order), as a square root where it is one.
fn rooted(base: Expression, power: u32, order: u32) -> Expression {
    let exponent = Rational::from(power) / Rational::from(order);
    if exponent == Rational::ONE / Rational::from(2) {
        return node(NodeKind::Call(Function::Sqrt, Box::new(base)));
    }
    node(NodeKind::Power(Box::new(base), Box::new(number(exponent))))
}

pub(super) fn node(kind: NodeKind) -> Expression {
    Expression { kind, start: 0, end: 0 }
}

pub(super) fn number(value: Rational) -> Expression {
    node(NodeKind::Number(value))
}
