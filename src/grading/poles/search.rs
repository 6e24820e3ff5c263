use super::backward_error::{RESIDUE, Root, Rounded, RoundedRoot};
use crate::algebra::{Polynomial, Rational, from_f64, to_f64};
use dashu_int::ops::BitTest;
use nalgebra::{DMatrix, DVector};

/// Roots within the roundings whose polynomial is as near to `denominator` as could be found; the nearest first.
///
/// Every root lies within its rounding, exactly; nothing else is promised. Sizes beyond `f64` give nothing.
/// Method: the change of each coefficient, in parts of `tolerance`, is held between −t and t by a barrier, as each root is
/// within its rounding, while t is made small. Newton's method without the second derivatives of the coefficients,
/// from the typed poles and, if that leads nowhere, from the expected ones.
/// Source: S. Boyd, L. Vandenberghe, *Convex Optimization*, 11.3 (barrier method) and 11.4 (feasibility).
pub(super) fn candidates(
    denominator: &Polynomial,
    roots: &[RoundedRoot],
    tolerance: &Rational,
) -> Vec<Vec<Root>> {
    let Some(problem) = Problem::new(denominator, roots, to_f64(tolerance)) else { return Vec::new() };
    let typed = vec![0.0; problem.variables + 1];
    if problem.out_of_reach(&typed) {
        return Vec::new();
    }
    let mut found = problem.descend(problem.apart());
    if found.is_empty() {
        found = problem.descend(problem.expected());
    }
    found.push(typed);
    found.iter().map(|point| problem.roots(point)).collect()
}

/// In units of s that make the product of the expected poles about 1.
struct Problem<'a> {
    roots: &'a [RoundedRoot],
    factors: Vec<Factor>,
    /// How many parts are free; the scale of the polynomial is one variable more, the last.
    variables: usize,
    /// The unit is 2 to this power.
    unit: isize,
    /// Monic, highest power first.
    wanted: Vec<f64>,
    /// What each change is divided by: the tolerance times the coefficient.
    widths: Vec<f64>,
    tolerance: f64,
}

enum Factor {
    Real(Part),
    Pair(Part, Part),
}

/// A number between `center` − `reach` and `center` + `reach`; the variable runs from −1 to 1.
struct Part {
    center: f64,
    reach: f64,
    variable: Option<usize>,
}

impl Part {
    fn at(&self, point: &[f64]) -> f64 {
        self.center + self.variable.map_or(0.0, |index| self.reach * point[index])
    }
}

/// Newton steps of one descent.
const STEPS: usize = 120;

impl<'a> Problem<'a> {
    fn new(denominator: &Polynomial, roots: &'a [RoundedRoot], tolerance: f64) -> Option<Self> {
        let monic = denominator.monic();
        let product = monic.coefficients().last()?;
        let bits = |size: usize| isize::try_from(size).ok();
        let magnitude = bits(product.numerator().bit_len())? - bits(product.denominator().bit_len())?;
        let unit = magnitude / isize::try_from(monic.degree()).ok()?.max(1);
        let in_units = |value: &Rational, power: isize| to_f64(&(value * power_of_two(-unit * power)));
        let mut wanted = Vec::new();
        for (power, coefficient) in (0..).zip(monic.coefficients()) {
            wanted.push(in_units(coefficient, power));
        }
        let mut variables = 0;
        let mut part = |rounded: &Rounded| {
            let (center, reach) = (in_units(&rounded.value, 1), in_units(&rounded.rounding, 1));
            let free = reach > 1e-12 * center.abs();
            let variable = free.then_some(variables);
            variables += usize::from(free);
            Part { center, reach, variable }
        };
        let factors: Vec<Factor> = roots
            .iter()
            .map(|root| match root {
                RoundedRoot::Real(value) => Factor::Real(part(value)),
                RoundedRoot::Pair(re, im) => Factor::Pair(part(re), part(im)),
            })
            .collect();
        let sizes = sizes(&factors, |re, im| re.center.abs().max(im.center.abs()));
        let widths = wanted
            .iter()
            .zip(sizes)
            .map(|(wanted, size)| {
                tolerance * if *wanted == 0.0 { 0.9 * size / f64::from(RESIDUE) } else { wanted.abs() }
            })
            .collect();
        Some(Self { roots, factors, variables, unit, wanted, widths, tolerance })
    }

    /// Whether no roots within the roundings can do, by the largest change that the roundings can make to each coefficient.
    /// Also when something is not finite.
    fn out_of_reach(&self, typed: &[f64]) -> bool {
        let here = product(self.factors.iter().map(|factor| factor.polynomial(typed)));
        let sizes_here = sizes(&self.factors, |re, im| re.center.hypot(im.center));
        let farthest = sizes(&self.factors, |re, im| re.center.hypot(im.center) + re.reach + im.reach);
        let scale =
            if self.tolerance < 1.0 { 2.0 * self.tolerance / (1.0 - self.tolerance) } else { f64::MAX };
        let allowed = |index: usize| {
            let size = sizes_here[index];
            1.001
                * (scale * self.wanted[index].abs() + farthest[index] - size
                    + self.tolerance * size / f64::from(RESIDUE))
        };
        (0..here.len()).any(|index| {
            let off = (here[index] - self.wanted[index]).abs();
            !off.is_finite() || !self.widths[index].is_normal() || off > allowed(index)
        })
    }

    /// The typed poles, those at the same place set apart: at one place they could only move together.
    fn apart(&self) -> Vec<f64> {
        let place = |factor: &Factor| match factor {
            Factor::Real(re) => (re.center, 0.0),
            Factor::Pair(re, im) => (re.center, im.center),
        };
        let mut point = vec![0.0; self.variables + 1];
        for (index, factor) in self.factors.iter().enumerate() {
            let same =
                |others: &[Factor]| others.iter().filter(|other| place(other) == place(factor)).count();
            let (before, all) = (same(&self.factors[..index]), same(&self.factors));
            if all > 1 {
                let offset = before as f64 / (all - 1) as f64 - 0.5;
                factor.each_part(|part| {
                    if let Some(variable) = part.variable {
                        point[variable] = offset;
                    }
                });
            }
        }
        point
    }

    /// The expected poles, as far as the roundings let them.
    fn expected(&self) -> Vec<f64> {
        let mut point = vec![0.0; self.variables + 1];
        let mut set = |part: &Part, rounded: &Rounded| {
            let Some(variable) = part.variable else { return };
            let expected =
                from_f64(rounded.expected).map(|value| to_f64(&(value * power_of_two(-self.unit))));
            let offset = (expected.unwrap_or(part.center) - part.center) / part.reach;
            point[variable] = if offset.is_finite() { offset.clamp(-0.9, 0.9) } else { 0.0 };
        };
        for (factor, root) in self.factors.iter().zip(self.roots) {
            match (factor, root) {
                (Factor::Real(part), RoundedRoot::Real(rounded)) => set(part, rounded),
                (Factor::Pair(re, im), RoundedRoot::Pair(rounded_re, rounded_im)) => {
                    set(re, rounded_re);
                    set(im, rounded_im);
                }
                _ => {}
            }
        }
        point
    }

    /// Exactly within the roundings, whatever floating point made of it.
    fn roots(&self, point: &[f64]) -> Vec<Root> {
        let exact = |part: &Part, rounded: &Rounded| {
            let Some(_) = part.variable else { return rounded.value.clone() };
            let found = from_f64(part.at(point)).map(|value| value * power_of_two(self.unit));
            found
                .filter(|found| {
                    let off = found - &rounded.value;
                    off <= rounded.rounding && -off <= rounded.rounding
                })
                .unwrap_or_else(|| rounded.value.clone())
        };
        self.factors
            .iter()
            .zip(self.roots)
            .filter_map(|pair| match pair {
                (Factor::Real(part), RoundedRoot::Real(rounded)) => Some(Root::Real(exact(part, rounded))),
                (Factor::Pair(re, im), RoundedRoot::Pair(rounded_re, rounded_im)) => {
                    Some(Root::Pair(exact(re, rounded_re), exact(im, rounded_im)))
                }
                _ => None,
            })
            .collect()
    }

    /// The leading coefficient is the scale, and must itself be within the tolerance.
    fn scale(&self, point: &[f64]) -> f64 {
        1.0 + self.scale_reach() * point[self.variables]
    }

    fn scale_reach(&self) -> f64 {
        self.tolerance.min(0.9)
    }

    /// The change of each coefficient in parts of the tolerance.
    fn changes(&self, point: &[f64]) -> Vec<f64> {
        let scale = self.scale(point);
        let whole = product(self.factors.iter().map(|factor| factor.polynomial(point)));
        (0..whole.len()).map(|k| (scale * whole[k] - self.wanted[k]) / self.widths[k]).collect()
    }

    /// Derivatives of the changes: a row for each coefficient, a column for each variable.
    fn slopes(&self, point: &[f64]) -> DMatrix<f64> {
        let polynomials: Vec<Vec<f64>> = self.factors.iter().map(|factor| factor.polynomial(point)).collect();
        let mut before = vec![vec![1.0]];
        for polynomial in &polynomials {
            before.push(times(&before[before.len() - 1], polynomial));
        }
        let whole = &before[polynomials.len()];
        let scale = self.scale(point);
        let mut slopes = DMatrix::zeros(whole.len(), self.variables + 1);
        for (k, value) in whole.iter().enumerate() {
            slopes[(k, self.variables)] = self.scale_reach() * value / self.widths[k];
        }
        let mut after = vec![1.0];
        for (index, factor) in self.factors.iter().enumerate().rev() {
            let others = times(&before[index], &after);
            for (variable, derivative) in factor.derivatives(point) {
                let column = times(&others, &derivative);
                let lower = whole.len() - column.len();
                for (k, value) in (lower..).zip(column) {
                    slopes[(k, variable)] = scale * value / self.widths[k];
                }
            }
            after = times(&after, &polynomials[index]);
        }
        slopes
    }

    /// Points with every change below 1: the best, then the first found; none when there is none nearby.
    fn descend(&self, start: Vec<f64>) -> Vec<Vec<f64>> {
        let mut at = Place { point: start, bound: 0.0 };
        let mut here = self.changes(&at.point);
        if !here.iter().all(|change| change.is_finite()) {
            return Vec::new();
        }
        at.bound = 1.5 * largest_size(&here) + 0.1;
        let barriers = 2.0 * (here.len() + at.point.len()) as f64;
        let mut pull = barriers / at.bound;
        let mut first: Option<Vec<f64>> = None;
        let mut best: Option<(f64, Vec<f64>)> = None;
        for _ in 0..STEPS {
            let largest = largest_size(&here);
            if largest < 1.0 {
                first.get_or_insert_with(|| at.point.clone());
                if best.as_ref().is_none_or(|(known, _)| largest < *known) {
                    best = Some((largest, at.point.clone()));
                }
            }
            let Some(step) = self.newton(&at, &here, pull) else { break };
            let moved = if step.decrement > 0.1 { self.line_search(&at, &here, pull, &step) } else { None };
            if let Some((there, changes)) = moved {
                at = there;
                here = changes;
                continue;
            }
            // In the middle: with this pull the bound is within `gap` of the smallest.
            let gap = barriers / pull;
            let enough = if best.is_some() { gap < 0.01 } else { at.bound - 2.0 * gap > 1.0 || gap < 1e-6 };
            if enough {
                break;
            }
            pull *= 6.0;
        }
        best.map(|(_, point)| point).into_iter().chain(first).collect()
    }

    fn newton(&self, at: &Place, here: &[f64], pull: f64) -> Option<Step> {
        let (variables, rows) = (at.point.len(), here.len());
        let slopes = self.slopes(&at.point);
        // A barrier is −ln of a room, bound − change and bound + change; with the room's slope over the room for a row, the
        // slope of all is minus the sum of the rows, and the curvature the sum of their squares.
        let mut relative = DMatrix::zeros(2 * rows, variables + 1);
        for (k, change) in here.iter().enumerate() {
            for (row, sign) in [(k, -1.0), (rows + k, 1.0)] {
                let room = at.bound + sign * change;
                for i in 0..variables {
                    relative[(row, i)] = sign * slopes[(k, i)] / room;
                }
                relative[(row, variables)] = 1.0 / room;
            }
        }
        let mut gradient: DVector<f64> = -relative.row_sum_tr();
        let mut curvature = relative.tr_mul(&relative);
        gradient[variables] += pull;
        for (i, y) in at.point.iter().enumerate() {
            let room = 1.0 - y * y;
            gradient[i] += 2.0 * y / room;
            curvature[(i, i)] += (2.0 + 2.0 * y * y) / (room * room);
        }
        let direction = -curvature.cholesky()?.solve(&gradient);
        let decrement = -gradient.dot(&direction);
        decrement.is_finite().then_some(Step { direction, decrement })
    }

    fn line_search(&self, at: &Place, here: &[f64], pull: f64, step: &Step) -> Option<(Place, Vec<f64>)> {
        let before = at.barrier(here, pull);
        let mut length = 1.0;
        for _ in 0..40 {
            let there = at.moved(step, length);
            if there.point.iter().all(|y| y.abs() < 1.0) {
                let changes = self.changes(&there.point);
                let after = there.barrier(&changes, pull);
                if after <= before - 0.1 * length * step.decrement {
                    return Some((there, changes));
                }
            }
            length *= 0.5;
        }
        None
    }
}

#[derive(Clone)]
struct Place {
    /// Each between −1 and 1.
    point: Vec<f64>,
    /// Above the size of every change.
    bound: f64,
}

struct Step {
    direction: DVector<f64>,
    /// What the step would gain, twice, were all of it as it is here.
    decrement: f64,
}

impl Place {
    fn moved(&self, step: &Step, length: f64) -> Self {
        let n = self.point.len();
        let point = self.point.iter().enumerate().map(|(i, y)| y + length * step.direction[i]).collect();
        Self { point, bound: self.bound + length * step.direction[n] }
    }

    /// NaN outside.
    fn barrier(&self, here: &[f64], pull: f64) -> f64 {
        let changes: f64 =
            here.iter().map(|change| (self.bound - change).ln() + (self.bound + change).ln()).sum();
        let roundings: f64 = self.point.iter().map(|y| (1.0 - y * y).ln()).sum();
        pull * self.bound - changes - roundings
    }
}

impl Factor {
    fn polynomial(&self, point: &[f64]) -> Vec<f64> {
        match self {
            Self::Real(part) => vec![1.0, -part.at(point)],
            Self::Pair(re, im) => {
                let (a, b) = (re.at(point), im.at(point));
                vec![1.0, -2.0 * a, a * a + b * b]
            }
        }
    }

    /// (variable, derivative of [`polynomial`](Self::polynomial) without its leading zero).
    fn derivatives(&self, point: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let by = |part: &Part, slope: Vec<f64>| {
            part.variable.map(|variable| (variable, slope.iter().map(|s| s * part.reach).collect()))
        };
        match self {
            Self::Real(part) => by(part, vec![-1.0]).into_iter().collect(),
            Self::Pair(re, im) => {
                let (a, b) = (re.at(point), im.at(point));
                by(re, vec![-2.0, 2.0 * a]).into_iter().chain(by(im, vec![2.0 * b])).collect()
            }
        }
    }

    fn each_part(&self, mut see: impl FnMut(&Part)) {
        match self {
            Self::Real(part) => see(part),
            Self::Pair(re, im) => {
                see(re);
                see(im);
            }
        }
    }
}

/// The coefficients, were each root on the negative real axis, as far from zero as `size` says.
fn sizes(factors: &[Factor], size: impl Fn(&Part, &Part) -> f64) -> Vec<f64> {
    const NOTHING: Part = Part { center: 0.0, reach: 0.0, variable: None };
    product(factors.iter().map(|factor| match factor {
        Factor::Real(part) => vec![1.0, size(part, &NOTHING)],
        Factor::Pair(re, im) => {
            let size = size(re, im);
            vec![1.0, 2.0 * size, size * size]
        }
    }))
}

fn largest_size(changes: &[f64]) -> f64 {
    changes.iter().fold(0.0, |largest, change| change.abs().max(largest))
}

fn product(factors: impl Iterator<Item = Vec<f64>>) -> Vec<f64> {
    factors.fold(vec![1.0], |product, factor| times(&product, &factor))
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    product
}

fn power_of_two(exponent: isize) -> Rational {
    Rational::from(2).pow(exponent)
}
