use crate::algebra::{Expression, Function, NodeKind, Rational};
use std::collections::BTreeMap;

/// A sum of products of letters, each to a whole power: what a coefficient of s is made of.
///
/// What is no letter (`sqrt(k)`, the `M + m` one divides by) is taken as one, under the text it has.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Coefficient {
    /// (letter, power) by letter, no power 0; the factor of that product, never 0.
    terms: BTreeMap<Product, Rational>,
}

type Product = Vec<(String, i32)>;

/// What stands for each letter of a [`Coefficient`], and how much has been done.
#[derive(Debug, Default)]
pub(super) struct Letters {
    meanings: BTreeMap<String, Expression>,
    products: usize,
}

/// Products of terms, in all.
const MOST_PRODUCTS: usize = 200_000;

/// The formula grows beyond what is worth writing out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooLarge;

impl Coefficient {
    pub fn number(value: Rational) -> Self {
        let mut terms = BTreeMap::new();
        if !value.is_zero() {
            terms.insert(Vec::new(), value);
        }
        Self { terms }
    }

    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    pub fn plus(mut self, other: &Self) -> Self {
        for (product, factor) in &other.terms {
            let sum = self.terms.remove(product).unwrap_or(Rational::ZERO) + factor;
            if !sum.is_zero() {
                self.terms.insert(product.clone(), sum);
            }
        }
        self
    }

    pub fn negated(mut self) -> Self {
        for factor in self.terms.values_mut() {
            *factor = -factor.clone();
        }
        self
    }

    /// As a formula: a sum of products, letters in alphabetical order.
    pub fn expression(&self, letters: &Letters) -> Expression {
        Expression::sum(self.terms.iter().map(|(product, factor)| term(product, factor, letters)).collect())
    }
}

impl Letters {
    /// A name, or anything else that is to be taken as one.
    pub fn letter(&mut self, meaning: &Expression) -> Coefficient {
        let name = meaning.to_string();
        self.meanings.insert(name.clone(), meaning.clone());
        Coefficient { terms: BTreeMap::from([(vec![(name, 1)], Rational::ONE)]) }
    }

    /// a · b; the square of a root is what stands under it.
    pub fn product(&mut self, a: &Coefficient, b: &Coefficient) -> Result<Coefficient, TooLarge> {
        self.products += a.terms.len() * b.terms.len();
        if self.products > MOST_PRODUCTS {
            return Err(TooLarge);
        }
        let mut result = Coefficient::default();
        for (left, factor) in &a.terms {
            for (right, other) in &b.terms {
                let both = self.without_squared_roots(joined(left, right))?;
                let both = Coefficient {
                    terms: both.terms.into_iter().map(|(p, f)| (p, f * factor * other)).collect(),
                };
                result = result.plus(&both);
            }
        }
        Ok(result)
    }

    /// 1 / a, `None` for 0: a sum is taken as one letter.
    pub fn inverse(&mut self, a: &Coefficient) -> Option<Coefficient> {
        match a.terms.iter().collect::<Vec<_>>().as_slice() {
            [] => None,
            [(product, factor)] => {
                let turned = product.iter().map(|(letter, power)| (letter.clone(), -power)).collect();
                Some(Coefficient { terms: BTreeMap::from([(turned, Rational::ONE / *factor)]) })
            }
            _ => {
                let whole = a.expression(self);
                let letter = self.letter(&whole);
                self.inverse(&letter)
            }
        }
    }

    fn without_squared_roots(&mut self, mut product: Product) -> Result<Coefficient, TooLarge> {
        let root = product.iter().position(|(letter, power)| {
            let root = self
                .meanings
                .get(letter)
                .is_some_and(|m| matches!(m.kind, NodeKind::Call(Function::Sqrt, _)));
            root && *power >= 2
        });
        let Some(at) = root else {
            return Ok(Coefficient { terms: BTreeMap::from([(product, Rational::ONE)]) });
        };
        let under = match self.meanings.get(&product[at].0).map(|m| &m.kind) {
            Some(NodeKind::Call(_, under)) => (**under).clone(),
            _ => return Err(TooLarge),
        };
        product[at].1 -= 2;
        product.retain(|(_, power)| *power != 0);
        let rest = self.without_squared_roots(product)?;
        let under = self.coefficient(&under)?;
        self.product(&rest, &under)
    }

    /// Sums, products, whole powers and quotients multiplied out; anything else is taken as a letter.
    pub fn coefficient(&mut self, node: &Expression) -> Result<Coefficient, TooLarge> {
        Ok(match &node.kind {
            NodeKind::Number(value) => Coefficient::number(value.clone()),
            NodeKind::Negate(a) => self.coefficient(a)?.negated(),
            NodeKind::Add(a, b) => self.coefficient(a)?.plus(&self.coefficient(b)?),
            NodeKind::Subtract(a, b) => self.coefficient(a)?.plus(&self.coefficient(b)?.negated()),
            NodeKind::Multiply(a, b) => {
                let (a, b) = (self.coefficient(a)?, self.coefficient(b)?);
                self.product(&a, &b)?
            }
            NodeKind::Divide(a, b) => {
                let (a, b) = (self.coefficient(a)?, self.coefficient(b)?);
                match self.inverse(&b) {
                    Some(inverse) => self.product(&a, &inverse)?,
                    None => self.letter(node),
                }
            }
            NodeKind::Power(a, b) => match whole(b) {
                Some(power) => {
                    let base = self.coefficient(a)?;
                    let base = if power < 0 { self.inverse(&base) } else { Some(base) };
                    match base {
                        Some(base) => {
                            let mut result = Coefficient::number(Rational::ONE);
                            for _ in 0..power.unsigned_abs() {
                                result = self.product(&result, &base)?;
                            }
                            result
                        }
                        None => self.letter(node),
                    }
                }
                None => self.letter(node),
            },
            NodeKind::Pi | NodeKind::Symbol { .. } | NodeKind::Call(..) => self.letter(node),
        })
    }
}

/// A whole number of −60..=60.
pub(super) fn whole(node: &Expression) -> Option<i32> {
    match &node.kind {
        NodeKind::Number(value) if value.is_int() => {
            i32::try_from(value.numerator()).ok().filter(|n| n.abs() <= 60)
        }
        NodeKind::Negate(a) => whole(a).map(|n| -n),
        _ => None,
    }
}

fn joined(a: &Product, b: &Product) -> Product {
    let mut powers: BTreeMap<&String, i32> = BTreeMap::new();
    for (letter, power) in a.iter().chain(b) {
        *powers.entry(letter).or_default() += power;
    }
    powers.into_iter().filter(|(_, power)| *power != 0).map(|(l, power)| (l.clone(), power)).collect()
}

fn term(product: &Product, factor: &Rational, letters: &Letters) -> Expression {
    let negative = *factor < Rational::ZERO;
    let size = if negative { -factor } else { factor.clone() };
    let mut above = Expression::of_number(size);
    let mut below = Expression::of_number(Rational::ONE);
    for (letter, power) in product {
        let Some(meaning) = letters.meanings.get(letter) else { continue };
        let powered = meaning.clone().to_power(power.unsigned_abs() as usize);
        if *power > 0 {
            above = above.times(powered);
        } else {
            below = below.times(powered);
        }
    }
    let term = above.over(below);
    if negative { term.negated() } else { term }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &str)]) {
        for (text, expected) in rows {
            let mut letters = Letters::default();
            let found = letters.coefficient(&Expression::parse(text).unwrap()).unwrap();
            assert_eq!(found.expression(&letters).to_string(), *expected, "{text}");
        }
    }

    #[test]
    fn sums_of_products() {
        check(&[
            ("(a + b)*(a - b)", "a^2 - b^2"),
            ("2*k/(k*4)", "0.5"),
            ("1/(M + m)*k", "k/(M + m)"),
            ("(-1)^3*a", "-a"),
            ("sqrt(3)^2 + sqrt(k)*sqrt(k)", "3 + k"),
            ("sqrt(2)*sqrt(2)*sqrt(2)", "2*sqrt(2)"),
            ("pi*pi", "pi^2"),
            ("a^0.5", "a^0.5"),
            ("a - a", "0"),
        ]);
    }

    #[test]
    fn what_grows_too_large_is_given_up() {
        let text = "(a + b + c + d + e + f + g + h)^30";
        let mut letters = Letters::default();
        assert_eq!(letters.coefficient(&Expression::parse(text).unwrap()), Err(TooLarge));
    }
}
