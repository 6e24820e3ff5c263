use super::interval::{Interval, evaluate};
use super::nonlinear::Unknown;
use crate::algebra::Expression;
use crate::model::Exact;

/// Proves that exactly one solution of `residuals` = 0 is near `values`; where each unknown then lies.
///
/// Krawczyk's test: with Y about the inverse of the slopes, a box X around x into whose inside x − Y·f(x) + (1 − Y·f'(X))·(X − x)
/// falls holds one solution and no other, and that is in what it falls to. Of more equations than unknowns, as many are proved
/// as there are unknowns, those that Y takes together; the others are held against the values by whoever asks.
/// `None` when it cannot be proved: the slopes are singular there, or an equation is not smooth.
/// Source: Krawczyk 1969; Neumaier, *Interval Methods for Systems of Equations*, 1990, ch. 5.
pub(super) fn proved(
    residuals: &[&Expression],
    unknowns: &[&Unknown],
    known: &dyn Fn(&str, u8) -> Option<Exact>,
    values: &[f64],
) -> Option<Vec<Interval>> {
    let slopes: Vec<Vec<Expression>> = residuals
        .iter()
        .map(|residual| unknowns.iter().map(|unknown| residual.differentiate(&unknown.name, 0)).collect())
        .collect();
    let with = |held: &[Interval], expression: &Expression| {
        evaluate(expression, &|name, primes| {
            let own = unknowns.iter().position(|unknown| unknown.name == name && primes == 0);
            own.map_or_else(
                || known(name, primes).map(|value| Interval::of(&value)),
                |place| held.get(place).copied(),
            )
        })
    };
    let mut best: Option<Vec<Interval>> = None;
    let mut x = values.to_vec();
    // A wide box proves more but for curves too much; after the first proof, its middle is a better place to start from.
    for relative in [1e-6, 1e-9, 1e-12, 1e-13] {
        let scale = |x: f64| x.abs().max(1e-6);
        let points: Vec<Interval> = x.iter().map(|x| Interval::point(*x)).collect();
        let held: Vec<Interval> = x.iter().map(|x| Interval::around(*x, relative * scale(*x))).collect();
        let at: Option<Vec<Interval>> = residuals.iter().map(|residual| with(&points, residual)).collect();
        let rows = |held: &[Interval]| -> Option<Vec<Vec<Interval>>> {
            slopes.iter().map(|row| row.iter().map(|slope| with(held, slope)).collect()).collect()
        };
        let (at, here, over) = (at?, rows(&points)?, rows(&held)?);
        let Some(narrowed) = krawczyk(&x, &held, &at, &here, &over) else { continue };
        x = narrowed.iter().map(|interval| interval.middle()).collect();
        best = Some(narrowed);
    }
    // What has not ten figures is no value; an expected 0 may have a width from the terms that cancel.
    best.filter(|all| all.iter().all(|one| one.width() <= 1e-10 * one.middle().abs().max(1e-3)))
}

fn krawczyk(
    x: &[f64],
    held: &[Interval],
    at: &[Interval],
    here: &[Vec<Interval>],
    over: &[Vec<Interval>],
) -> Option<Vec<Interval>> {
    let (rows, columns) = (here.len(), x.len());
    let middle = nalgebra::DMatrix::from_fn(rows, columns, |i, j| here[i][j].middle());
    if middle.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let inverse = if rows == columns { middle.try_inverse()? } else { middle.pseudo_inverse(1e-12).ok()? };
    if inverse.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let mut result = Vec::with_capacity(columns);
    for i in 0..columns {
        let y = |j: usize| Interval::point(inverse[(i, j)]);
        let mut sum = Interval::point(x[i]);
        for (j, value) in at.iter().enumerate() {
            sum = sum.minus(y(j).times(*value));
        }
        for k in 0..columns {
            let mut entry = Interval::point(if i == k { 1.0 } else { 0.0 });
            for (j, row) in over.iter().enumerate() {
                entry = entry.minus(y(j).times(row[k]));
            }
            sum = sum.plus(entry.times(held[k].minus(Interval::point(x[k]))));
        }
        if !sum.inside(held[i]) {
            return None;
        }
        result.push(sum);
    }
    Some(result)
}
