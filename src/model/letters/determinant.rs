//! Determinants in letters, multiplied out, and as the sums of products one writes down first.

use super::Trouble;
use super::form::{Signed, product};
use super::ring::{Ring, S};
use crate::algebra::{Budget, Monomial, MultivariatePolynomial as Poly, Rational};

/// The determinant, by the row with the fewest entries; 1 for 0×0.
pub(super) fn determinant(ring: &Ring, rows: &[Vec<Poly>], budget: &mut Budget) -> Result<Poly, Trouble> {
    budget.spend(rows.len() + 1)?;
    let filled = |row: &Vec<Poly>| row.iter().filter(|entry| !entry.is_zero()).count();
    let Some((i, row)) = rows.iter().enumerate().min_by_key(|(_, row)| filled(row)) else {
        return Ok(Poly::one());
    };
    let mut sum = Poly::zero();
    for (j, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
        let minor = determinant(ring, &without(rows, i, j), budget)?;
        let part = entry.times(&minor, budget)?;
        sum = sum.plus(&if (i + j) % 2 == 1 { part.negated() } else { part }, budget)?;
    }
    ring.reduced(sum, budget)
}

fn without<T: Clone>(rows: &[Vec<T>], i: usize, j: usize) -> Vec<Vec<T>> {
    let rest = rows.iter().enumerate().filter(|(row, _)| *row != i);
    rest.map(|(_, row)| row.iter().enumerate().filter(|(c, _)| *c != j).map(|(_, e)| e.clone()).collect())
        .collect()
}

/// number · s^power · ∏ factors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Product {
    pub power: u32,
    pub number: Rational,
    /// Sorted, each once.
    pub factors: Vec<(Poly, u32)>,
}

impl Product {
    fn times(&self, other: &Self) -> Self {
        let mut factors = self.factors.clone();
        for (factor, power) in &other.factors {
            match factors.iter_mut().find(|(known, _)| known == factor) {
                Some((_, known)) => *known += power,
                None => factors.push((factor.clone(), *power)),
            }
        }
        factors.sort_by(|(a, _), (b, _)| a.terms().cmp(b.terms()));
        Self { power: self.power + other.power, number: &self.number * &other.number, factors }
    }

    /// Without s^a and letters; `None` when they are not in it.
    fn over(&self, shared: &Monomial) -> Option<Self> {
        let mut short = self.clone();
        for (letter, power) in shared.powers() {
            if *letter == S {
                short.power = short.power.checked_sub(*power)?;
                continue;
            }
            let factor = short.factors.iter_mut().find(|(known, _)| *known == Poly::letter(*letter))?;
            factor.1 = factor.1.checked_sub(*power)?;
        }
        short.factors.retain(|(_, power)| *power > 0);
        Some(short)
    }
}

/// More products than this are no longer read.
const MOST_PRODUCTS: usize = 60;

/// The determinant as a sum of products of what stands in the matrix, like products put together; `None` when there are many.
pub(super) fn products(rows: &[Vec<Poly>], budget: &mut Budget) -> Result<Option<Vec<Product>>, Trouble> {
    if rows.len() > 3 {
        return Ok(None);
    }
    let mut entries = Vec::new();
    for row in rows {
        let mut shown = Vec::new();
        for entry in row {
            let mut parts = Vec::new();
            for (power, part) in entry.coefficients_of(S).iter().enumerate().filter(|(_, p)| !p.is_zero()) {
                let (number, mut factors) = part.light_factors(budget)?;
                factors.sort_by(|(a, _), (b, _)| a.terms().cmp(b.terms()));
                parts.push(Product { power: power as u32, number, factors });
            }
            shown.push(parts);
        }
        entries.push(shown);
    }
    Ok(expanded(&entries))
}

fn expanded(rows: &[Vec<Vec<Product>>]) -> Option<Vec<Product>> {
    let Some(row) = rows.first() else {
        return Some(vec![Product { power: 0, number: Rational::ONE, factors: Vec::new() }]);
    };
    let mut sum: Vec<Product> = Vec::new();
    for (j, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_empty()) {
        let minor = expanded(&without(rows, 0, j))?;
        for a in entry {
            for b in &minor {
                let mut found = a.times(b);
                if j % 2 == 1 {
                    found.number = -found.number;
                }
                match sum.iter_mut().find(|p| p.power == found.power && p.factors == found.factors) {
                    Some(known) => known.number += found.number,
                    None => sum.push(found),
                }
            }
        }
        if sum.len() > MOST_PRODUCTS {
            return None;
        }
    }
    sum.retain(|product| !product.number.is_zero());
    Some(sum)
}

/// The coefficient of each power of s: multiplied out and factored, or as the products give it where that is hardly longer.
///
/// `shared` has been taken out of `poly`, and all of it was multiplied by `factor`; neither is yet true of `products`.
pub(super) fn coefficients(
    ring: &Ring,
    poly: &Poly,
    products: Option<(&[Product], &Monomial, &Rational)>,
    budget: &mut Budget,
) -> Result<Vec<(u32, Signed)>, Trouble> {
    let mut shown = Vec::new();
    for (power, part) in poly.coefficients_of(S).iter().enumerate().filter(|(_, part)| !part.is_zero()) {
        let power = power as u32;
        let multiplied = ring.form(part, budget)?;
        let as_products = match products {
            Some((all, shared, factor)) => {
                let short: Option<Vec<Product>> = all.iter().map(|p| p.over(shared)).collect();
                let own: Vec<Product> = short.into_iter().flatten().filter(|p| p.power == power).collect();
                written(ring, own, factor, budget)?
            }
            None => None,
        };
        shown.push((
            power,
            match as_products {
                Some(other) if other.cost() <= multiplied.cost() + 1 => other,
                _ => multiplied,
            },
        ));
    }
    Ok(shown)
}

fn written(
    ring: &Ring,
    products: Vec<Product>,
    factor: &Rational,
    budget: &mut Budget,
) -> Result<Option<Signed>, Trouble> {
    let has_sum = products.iter().any(|one| one.factors.iter().any(|(factor, _)| factor.term_count() > 1));
    if products.len() < 2 || !has_sum {
        return Ok(None);
    }
    let mut parts = Vec::new();
    for one in products {
        parts.push(ring.factored(&(one.number * factor), one.factors, budget)?);
    }
    let negative = parts.iter().all(|part| part.negative);
    if negative {
        parts.iter_mut().for_each(|part| part.negative = false);
    }
    // What is a sum in parentheses comes first, as it does on the diagonal.
    parts.sort_by_key(|part| (part.negative, usize::MAX - part.cost()));
    Ok(Some(Signed { negative, size: product(vec![super::form::sum(parts, true)]) }))
}
