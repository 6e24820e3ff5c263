//! Values at rest that are found: what balances the equations when nothing moves.

use super::form::{Form, Value};
use super::nonlinear::{Unknown, solve_nonlinear};
use crate::algebra::{Expression, Rational};
use crate::model::{Exact, Model, ModelError};

/// Finds the values of `unknowns` that balance the equations of `model` (not those of outputs) where every derivative is 0.
///
/// `known` gives the values of all other names. An equation that is left with one unknown is solved for it, and linear ones
/// together; so are those that remain.
/// Accuracy: exact where the unknown enters linearly with rational slopes, and where a nonlinear one turns out to be a simple
/// rational number or multiple of pi; else proved to lie within a few units in the last place of the `f64`.
/// Errors: [`ModelError::Free`], [`ModelError::Undetermined`], and those of [`solve_nonlinear`].
pub(super) fn solve(
    model: &Model,
    known: &dyn Fn(&str) -> Option<Exact>,
    unknowns: Vec<Unknown>,
) -> Result<Vec<(String, Exact)>, ModelError> {
    let equations = model.equations.len() - model.outputs.len().min(model.equations.len());
    let residuals: Vec<Expression> = (0..equations).map(|index| model.residual(index)).collect();
    let mut found: Vec<(String, Exact)> = Vec::new();
    let mut open = unknowns;
    while !open.is_empty() {
        let value = |name: &str, primes: u8| {
            if primes > 0 {
                return Some(Value::Known(Exact::zero()));
            }
            if let Some(place) = open.iter().position(|unknown| unknown.name == name) {
                return Some(Value::Unknown(place));
            }
            let solved = found.iter().find(|(solved, _)| solved == name).map(|(_, value)| value.clone());
            solved.or_else(|| known(name)).map(Value::Known)
        };
        let forms: Vec<Form> = residuals
            .iter()
            .map(|residual| Form::of(residual, open.len(), &value))
            .collect::<Result<_, _>>()?;
        let depends: Vec<Vec<bool>> = forms.iter().map(Form::depends).collect();
        if let Some((_, free)) =
            open.iter().enumerate().find(|(place, _)| !depends.iter().any(|of| of[*place]))
        {
            return Err(ModelError::Free { name: free.name.clone() });
        }
        let solved = linear(&forms, &open)?;
        let solved = if solved.is_empty() {
            let lone = |of: &&Vec<bool>| of.iter().filter(|depends| **depends).count() == 1;
            let places: Vec<usize> = match depends.iter().find(lone) {
                Some(of) => (0..open.len()).filter(|place| of[*place]).collect(),
                None => (0..open.len()).collect(),
            };
            // Of one unknown, the equations that hold it alone; of several, all that are left.
            let involved: Vec<&Expression> = residuals
                .iter()
                .zip(&depends)
                .filter(|(_, of)| {
                    let held = |place: &usize| of[*place];
                    places.iter().any(held)
                        && (0..open.len()).all(|place| !of[place] || places.contains(&place))
                })
                .map(|(residual, _)| residual)
                .collect();
            let wanted: Vec<&Unknown> = places.iter().map(|place| &open[*place]).collect();
            if involved.len() < wanted.len() {
                let names = wanted.iter().map(|unknown| unknown.name.clone()).collect();
                return Err(ModelError::Undetermined { names });
            }
            let lookup = |name: &str, primes: u8| match value(name, primes) {
                Some(Value::Known(value)) => Some(value),
                // Where it stands in these equations it is multiplied by 0.
                Some(Value::Unknown(_)) => Some(Exact::rational(Rational::ONE)),
                None => None,
            };
            solve_nonlinear(&involved, &wanted, &lookup)?
        } else {
            solved
        };
        open.retain(|unknown| !solved.iter().any(|(name, _)| *name == unknown.name));
        found.extend(solved);
    }
    Ok(found)
}

/// The unknowns that the linear equations alone determine, by exact elimination.
///
/// Errors: equations that contradict one another, or, when nothing but linear equations is there, leave some undetermined.
fn linear(forms: &[Form], open: &[Unknown]) -> Result<Vec<(String, Exact)>, ModelError> {
    let mut rows: Vec<(Vec<Rational>, Exact)> = forms
        .iter()
        .filter_map(|form| match form {
            Form::Linear { constant, slopes } if slopes.iter().any(|slope| !slope.is_zero()) => {
                Some((slopes.clone(), constant.clone()))
            }
            _ => None,
        })
        .collect();
    let mut next = 0;
    for column in 0..open.len() {
        let Some(pivot) = (next..rows.len()).find(|row| !rows[*row].0[column].is_zero()) else { continue };
        rows.swap(next, pivot);
        let (slopes, constant) = rows[next].clone();
        for (row, (other, its_constant)) in rows.iter_mut().enumerate() {
            if row == next || other[column].is_zero() {
                continue;
            }
            let factor = &other[column] / &slopes[column];
            for (own, pivot) in other.iter_mut().zip(&slopes) {
                *own = &*own - &factor * pivot;
            }
            *its_constant = its_constant.clone().minus(constant.scaled(&factor));
        }
        next += 1;
    }
    if rows[next..].iter().any(|(_, constant)| matches!(constant, Exact::Known { .. }) && !constant.is_zero())
    {
        return Err(ModelError::NotFound {
            names: open.iter().map(|unknown| unknown.name.clone()).collect(),
        });
    }
    let mut solved = Vec::new();
    for (slopes, constant) in &rows[..next] {
        let mut places = (0..slopes.len()).filter(|place| !slopes[*place].is_zero());
        if let (Some(place), None) = (places.next(), places.next()) {
            let factor = Rational::NEG_ONE / &slopes[place];
            solved.push((open[place].name.clone(), constant.scaled(&factor)));
        }
    }
    let nothing_else = forms.iter().all(|form| matches!(form, Form::Linear { .. }));
    if solved.is_empty() && nothing_else {
        return Err(ModelError::Undetermined {
            names: open.iter().map(|unknown| unknown.name.clone()).collect(),
        });
    }
    Ok(solved)
}
