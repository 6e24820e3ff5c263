use super::super::{Equilibrium, Exact, Model, ParameterValues};
use super::determinant::{coefficients, determinant, products};
use super::form::{Signed, power_of_s, product};
use super::rest::{known_at_rest, letter_of};
use super::ring::{Atom, Fraction, Generator, Ring, S};
use super::signal::{Signal, capital};
use super::symbolic::{at_rest, evaluate};
use super::{AtRest, LetterDerivation, LetterEquation, LetterFunction, LetterTerm, Trouble, order};
use crate::algebra::{
    Budget, Expression, Function, Monomial, MultivariatePolynomial as Poly, NodeKind, Rational, exact_root,
    to_f64,
};
use std::collections::BTreeMap;

/// Products of coefficients for one operating point: about a tenth of a second.
const STEPS: usize = 300_000;

pub(super) fn derive(
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &Equilibrium,
    input: &str,
    output: &str,
) -> Result<LetterDerivation, Trouble> {
    let budget = &mut Budget::new(STEPS);
    let parameters = &model.derived.values(parameters).map_err(|_| Trouble::Undefined)?;
    let rest = Rest::new(model, parameters, at);
    let mut ring = rest.ring(model, parameters);
    let lookup = |name: &str, primes: u8, ring: &Ring| rest.fraction(name, primes, ring);

    let mut rest_equations = Vec::new();
    let mut relations = Vec::new();
    let motion = model.equations.len() - model.outputs.len().min(model.equations.len());
    for equation in &model.equations[..motion] {
        let left = evaluate(&mut ring, &equation.left, &lookup, budget);
        let right = evaluate(&mut ring, &equation.right, &lookup, budget);
        let (left, right) = (left?, right?);
        if left != right {
            relations.push(ring.sum(&left, &right.negated(), budget)?.num);
            let mut shown = |side| at_rest(&mut ring, side, &lookup, budget);
            rest_equations.push((shown(&equation.left)?, shown(&equation.right)?));
        }
    }

    let mut rows = Vec::new();
    let mut forcing = Vec::new();
    for i in 0..model.equations.len() {
        let residual = model.residual(i);
        let mut slopes = |name: &str| -> Result<Vec<Fraction>, Trouble> {
            (0..=model.order_of(name))
                .map(|k| evaluate(&mut ring, &residual.differentiate(name, k), &lookup, budget))
                .collect()
        };
        let row: Result<Vec<_>, _> = model.coordinates.iter().map(|c| slopes(&c.name)).collect();
        rows.push(row?);
        forcing.push(slopes(input)?.iter().map(Fraction::negated).collect::<Vec<_>>());
    }

    for (i, (row, forced)) in rows.iter_mut().zip(&mut forcing).enumerate() {
        turn(&ring, i, row, forced, budget)?;
    }

    for one in model.derived.iter() {
        let Some(name) = ring.named(&one.name) else { continue };
        let value = evaluate(&mut ring, &one.formula, &lookup, budget)?;
        relations.push(ring.sum(&name, &value.negated(), budget)?.num);
    }
    let mut roots = Vec::new();
    for (letter, generator) in ring.generators.iter().enumerate() {
        if let Atom::Root { of, order } = &generator.atom {
            let power = Poly::term(Rational::ONE, Monomial::letter(letter as u16, *order));
            roots.push(power.minus(of, budget)?);
        }
    }
    relations.retain(|relation| !relation.is_zero());

    let names = Names { model, rest: &rest, input };
    let writer = Writer { ring: &ring, names: &names };
    let linear = writer.equations(&rows, &forcing, false, budget)?;
    let transformed = writer.equations(&rows, &forcing, true, budget)?;
    let (rows, forcing, had_fractions) = without_fractions(&ring, rows, forcing, budget)?;
    let without_fractions =
        if had_fractions { Some(writer.equations(&rows, &forcing, true, budget)?) } else { None };

    let matrix: Vec<Vec<Poly>> = rows
        .iter()
        .map(|row| row.iter().map(|slopes| in_s(slopes, budget)).collect())
        .collect::<Result<_, _>>()?;
    let right: Vec<Poly> = forcing.iter().map(|slopes| in_s(slopes, budget)).collect::<Result<_, _>>()?;
    let place = model.coordinates.iter().position(|c| c.name == output).ok_or(Trouble::Undefined)?;
    let mut replaced = matrix.clone();
    for (row, entry) in replaced.iter_mut().zip(&right) {
        row[place] = entry.clone();
    }
    let (num, den) = (determinant(&ring, &replaced, budget)?, determinant(&ring, &matrix, budget)?);
    if den.is_zero() {
        return Err(Trouble::Undefined);
    }
    let plain = (Monomial::default(), Rational::ONE);
    let forms =
        |poly: &Poly, rows: &[Vec<Poly>], (shared, factor): (&Monomial, &Rational), budget: &mut Budget| {
            let parts = products(rows, budget)?;
            let parts = parts.as_ref().map(|parts| (parts.as_slice(), shared, factor));
            coefficients(&ring, poly, parts, budget)
        };
    let numerator = ring.by_powers_of_s(forms(&num, &replaced, (&plain.0, &plain.1), budget)?);
    let denominator = ring.by_powers_of_s(forms(&den, &matrix, (&plain.0, &plain.1), budget)?);

    let (short_num, short_den, shared) = ring.shortened(num, den, budget)?;
    let factor = scale(&ring, &short_num, &short_den);
    let (short_num, short_den) = (short_num.scaled(&factor), short_den.scaled(&factor));
    let monomial =
        shared.leading().filter(|_| shared.term_count() == 1).map(|(monomial, _)| monomial.clone());
    let short = |poly: &Poly, rows: &[Vec<Poly>], budget: &mut Budget| match &monomial {
        Some(monomial) => forms(poly, rows, (monomial, &factor), budget),
        None => coefficients(&ring, poly, None, budget),
    };
    let num_forms = short(&short_num, &replaced, budget)?;
    let den_forms = short(&short_den, &matrix, budget)?;
    let cancelled = match shared.as_constant() {
        Some(_) => None,
        None => Some(ring.collected(&shared, budget)?),
    };
    let written = |rows: &[Vec<Poly>], budget: &mut Budget| -> Result<Vec<Vec<Expression>>, Trouble> {
        rows.iter().map(|row| row.iter().map(|entry| ring.collected(entry, budget)).collect()).collect()
    };
    Ok(LetterDerivation {
        rest: rest.shown(model, &ring, budget)?,
        rest_equations,
        linear,
        transformed,
        without_fractions,
        unknowns: model.coordinates.iter().map(|c| names.transform(&c.name)).collect(),
        input: names.transform(input),
        output: place,
        numerator,
        denominator,
        cancelled,
        num: ring.by_powers_of_s(num_forms.clone()),
        den: ring.by_powers_of_s(den_forms.clone()),
        num_coefficients: unsigned(num_forms),
        den_coefficients: unsigned(den_forms),
        relations,
        roots,
        known: known_at_rest(model, at)
            .into_iter()
            .map(|one| {
                let turns = match one.value {
                    Exact::Known { pi, .. } => pi,
                    _ => Rational::ZERO,
                };
                (one.letter, super::ring::number(turns).times(super::ring::node(NodeKind::Pi)))
            })
            .collect(),
        forcing: right.iter().map(|entry| ring.collected(entry, budget)).collect::<Result<_, _>>()?,
        matrix: written(&matrix, budget)?,
        function: LetterFunction { ring: ring.clone(), num: short_num, den: short_den },
    })
}

fn unsigned(forms: Vec<(u32, Signed)>) -> Vec<(u32, Expression)> {
    forms.into_iter().map(|(power, form)| (power, form.into_expression())).collect()
}

/// Turns the signs of an equation so that its own coordinate, or the first term, has none.
fn turn(
    ring: &Ring,
    own: usize,
    row: &mut [Vec<Fraction>],
    forced: &mut [Fraction],
    budget: &mut Budget,
) -> Result<(), Trouble> {
    let highest = |slopes: &Vec<Fraction>| slopes.iter().rev().find(|slope| !slope.is_zero()).cloned();
    let Some(first) = row.get(own).and_then(highest).or_else(|| row.iter().find_map(highest)) else {
        return Ok(());
    };
    if ring.fraction_form(&first, budget)?.negative {
        for slope in row.iter_mut().flatten().chain(forced) {
            *slope = slope.negated();
        }
    }
    Ok(())
}

/// What numerator and denominator are multiplied by: no fraction of small numbers, no common whole number, and a leading
/// coefficient below that is positive by the lab's numbers.
fn scale(ring: &Ring, num: &Poly, den: &Poly) -> Rational {
    let contents = if num.is_zero() { vec![den.content()] } else { vec![num.content(), den.content()] };
    let small = |r: &Rational| to_f64(&Rational::from(r.denominator().clone())) <= 12.0;
    let decimal = |r: &Rational| (0..=6).any(|places| (r * Rational::from(10).pow(places)).is_int());
    let mut factor = Rational::ONE;
    if contents.iter().all(|c| small(c) || !decimal(c)) {
        let monomial = |c: &Rational, letter| Poly::term(c.clone(), Monomial::letter(letter, 1));
        let mut budget = Budget::new(100);
        let both = contents
            .iter()
            .enumerate()
            .try_fold(Poly::zero(), |sum, (i, c)| sum.plus(&monomial(c, i as u16), &mut budget));
        factor = Rational::ONE / both.map_or(Rational::ONE, |both| both.content());
    }
    let lead = den.coefficients_of(S).pop().unwrap_or_default();
    if ring.value(&lead) < 0.0 { -factor } else { factor }
}

/// Σ slopeₖ sᵏ, of slopes without fractions.
fn in_s(slopes: &[Fraction], budget: &mut Budget) -> Result<Poly, Trouble> {
    let mut sum = Poly::zero();
    for (power, slope) in slopes.iter().enumerate() {
        let s = Poly::term(Rational::ONE, Monomial::letter(S, power as u32));
        sum = sum.plus(&slope.num.times(&s, budget)?, budget)?;
    }
    Ok(sum)
}

type Rows = Vec<Vec<Vec<Fraction>>>;

/// Each equation multiplied by what its fractions have below.
fn without_fractions(
    ring: &Ring,
    rows: Rows,
    forcing: Vec<Vec<Fraction>>,
    budget: &mut Budget,
) -> Result<(Rows, Vec<Vec<Fraction>>, bool), Trouble> {
    let mut had = false;
    let (mut all, mut right) = (Vec::new(), Vec::new());
    for (row, forced) in rows.into_iter().zip(forcing) {
        let mut below = Poly::one();
        for fraction in row.iter().flatten().chain(&forced) {
            let shared = below.gcd(&fraction.den, budget)?;
            let rest = fraction.den.exact_quotient(&shared, budget)?.unwrap_or_default();
            below = below.times(&rest, budget)?;
        }
        let whole = Fraction::polynomial(below.clone());
        had |= below.as_constant().is_none();
        let mut clear = |fractions: Vec<Fraction>| -> Result<Vec<Fraction>, Trouble> {
            fractions.iter().map(|fraction| ring.product(fraction, &whole, budget)).collect()
        };
        all.push(row.into_iter().map(&mut clear).collect::<Result<_, _>>()?);
        right.push(clear(forced)?);
    }
    Ok((all, right, had))
}

/// What coordinates and inputs are at rest.
struct Rest {
    /// By name: (its letter, its value) where it is neither 0 nor a multiple of π.
    letters: BTreeMap<String, (String, Exact)>,
    /// k, where it is k·π and not 0.
    turns: BTreeMap<String, Rational>,
    parameters: Vec<String>,
}

impl Rest {
    fn new(model: &Model, parameters: &ParameterValues, at: &Equilibrium) -> Self {
        let names = model.coordinates.iter().map(|c| &c.name).chain(&model.inputs);
        let (mut letters, mut turns) = (BTreeMap::new(), BTreeMap::new());
        for name in names {
            match at.value(name, 0) {
                None => {}
                Some(Exact::Known { rational, pi }) if rational.is_zero() && pi.is_zero() => {}
                Some(Exact::Known { rational, pi }) if rational.is_zero() => {
                    turns.insert(name.clone(), pi);
                }
                Some(value) => {
                    letters.insert(name.clone(), (letter_of(model, name), value));
                }
            }
        }
        Self { letters, turns, parameters: parameters.keys().cloned().collect() }
    }

    fn ring(&self, model: &Model, parameters: &ParameterValues) -> Ring {
        let mut ring = Ring::default();
        ring.add(Generator { atom: Atom::S, value: 0.0, exact: None });
        ring.pi();
        let own = model.parameters.iter().filter(|name| parameters.contains_key(*name));
        let rest = model.coordinates.iter().map(|c| &c.name).chain(&model.inputs);
        let names: Vec<String> =
            own.chain(rest.filter(|name| self.letters.contains_key(*name))).cloned().collect();
        for name in order::as_written(model, names) {
            let (letter, value) = match self.letters.get(&name) {
                Some((letter, value)) => (letter.clone(), value.clone()),
                None => match parameters.get(&name) {
                    Some(value) => (name.clone(), value.clone()),
                    None => continue,
                },
            };
            let order = if value.to_f64() > 0.0 { root_order(model, &name) } else { 1 };
            let exact = value.as_rational().and_then(|v| match order {
                1 => Some(v.clone()),
                n => exact_root(v, u8::try_from(n).ok()?),
            });
            let value = value.to_f64().powf(1.0 / f64::from(order));
            ring.add(Generator { atom: Atom::Name { name: letter, order }, value, exact });
        }
        ring
    }

    fn fraction(&self, name: &str, primes: u8, ring: &Ring) -> Option<Fraction> {
        if self.parameters.iter().any(|p| p == name) {
            return ring.named(name);
        }
        if primes > 0 {
            return Some(Fraction::zero());
        }
        if let Some((letter, _)) = self.letters.get(name) {
            return ring.named(letter);
        }
        match self.turns.get(name) {
            Some(turns) => {
                let pi = ring.generators.iter().position(|g| matches!(g.atom, Atom::Pi))?;
                Some(Fraction::polynomial(Poly::term(turns.clone(), Monomial::letter(pi as u16, 1))))
            }
            None => Some(Fraction::zero()),
        }
    }

    fn shown(&self, model: &Model, ring: &Ring, budget: &mut Budget) -> Result<Vec<AtRest>, Trouble> {
        let mut all = Vec::new();
        let names = model.coordinates.iter().map(|c| &c.name).filter(|name| !model.is_output(name));
        for name in names.chain(&model.inputs) {
            let Some(fraction) = self.fraction(name, 0, ring).filter(|f| !f.is_zero()) else { continue };
            let is = ring.fraction_form(&fraction, budget)?.into_expression();
            all.push(AtRest { name: name.clone(), is, value: ring.value_of(&fraction) });
        }
        Ok(all)
    }
}

/// The least common denominator of the powers in which a name stands by itself: 2 for √h, 1 where there are none.
fn root_order(model: &Model, name: &str) -> u32 {
    fn visit(node: &Expression, name: &str, order: &mut u32) {
        let is_name =
            |a: &Expression| matches!(&a.kind, NodeKind::Symbol { name: n, primes: 0 } if n == name);
        let found = match &node.kind {
            NodeKind::Call(Function::Sqrt, a) if is_name(a) => 2,
            NodeKind::Power(a, b) if is_name(a) => match &b.kind {
                NodeKind::Number(power) => u32::try_from(power.denominator().clone()).unwrap_or(1),
                NodeKind::Divide(p, q) => match (&p.kind, &q.kind) {
                    (NodeKind::Number(p), NodeKind::Number(q)) if !q.is_zero() => {
                        u32::try_from((p / q).denominator().clone()).unwrap_or(1)
                    }
                    _ => 1,
                },
                _ => 1,
            },
            _ => 1,
        };
        let (mut a, mut b) = (*order, found);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        *order = (*order / a).saturating_mul(found).min(12);
        node.children().for_each(|child| visit(child, name, order));
    }
    let mut order = 1;
    for equation in &model.equations {
        visit(&equation.left, name, &mut order);
        visit(&equation.right, name, &mut order);
    }
    order
}

/// What signals are called.
struct Names<'a> {
    model: &'a Model,
    rest: &'a Rest,
    input: &'a str,
}

impl Names<'_> {
    fn signal(&self, name: &str, primes: u8) -> Signal {
        let deviates = self.rest.letters.contains_key(name) || self.rest.turns.contains_key(name);
        Signal { name: name.to_owned(), primes, deviates, transformed: false, keeps_name: false }
    }

    fn transform(&self, name: &str) -> Signal {
        let others = self.model.coordinates.iter().map(|c| c.name.as_str()).chain([self.input]);
        let keeps_name = others.filter(|other| *other != name).any(|other| capital(other) == capital(name));
        Signal { transformed: true, keeps_name, ..self.signal(name, 0) }
    }
}

/// Writes equations down.
struct Writer<'a> {
    ring: &'a Ring,
    names: &'a Names<'a>,
}

impl Writer<'_> {
    fn equations(
        &self,
        rows: &Rows,
        forcing: &[Vec<Fraction>],
        in_s: bool,
        budget: &mut Budget,
    ) -> Result<Vec<LetterEquation>, Trouble> {
        let mut equations = Vec::new();
        for (row, forced) in rows.iter().zip(forcing) {
            let mut left = Vec::new();
            for (coordinate, slopes) in self.names.model.coordinates.iter().zip(row) {
                left.extend(self.terms(&coordinate.name, slopes, in_s, budget)?);
            }
            let right = self.terms(self.names.input, forced, in_s, budget)?;
            equations.push(LetterEquation { left, right });
        }
        Ok(equations)
    }

    /// Highest derivative first.
    fn terms(
        &self,
        name: &str,
        slopes: &[Fraction],
        in_s: bool,
        budget: &mut Budget,
    ) -> Result<Vec<LetterTerm>, Trouble> {
        let filled: Vec<_> = slopes.iter().enumerate().rev().filter(|(_, slope)| !slope.is_zero()).collect();
        let mut parts = Vec::new();
        for (power, slope) in &filled {
            parts.push((*power as u8, self.ring.fraction_form(slope, budget)?));
        }
        if !in_s {
            let term = |(power, form): (u8, Signed)| LetterTerm {
                negative: form.negative,
                coefficient: form.size,
                signal: self.names.signal(name, power),
            };
            return Ok(parts.into_iter().map(term).collect());
        }
        let signal = self.names.transform(name);
        Ok(match parts.len() {
            0 => Vec::new(),
            1 => parts
                .into_iter()
                .map(|(power, form)| {
                    let one = matches!(&form.size.kind, NodeKind::Number(n) if *n == Rational::ONE);
                    let coefficient = match (power, one) {
                        (0, _) => form.size,
                        (_, true) => power_of_s(power.into()),
                        _ => product(vec![form.size, power_of_s(power.into())]),
                    };
                    LetterTerm { negative: form.negative, coefficient, signal: signal.clone() }
                })
                .collect(),
            _ => {
                let negative = parts.iter().all(|(_, form)| form.negative);
                let ascending = parts.into_iter().rev().map(|(power, form)| {
                    (u32::from(power), Signed { negative: form.negative && !negative, ..form })
                });
                let coefficient = self.ring.by_powers_of_s(ascending.collect());
                vec![LetterTerm { negative, coefficient, signal }]
            }
        })
    }
}
