use super::interval::Interval;
use super::proof::proved;
use crate::algebra::{Expression, Rational, from_f64, significant};
use crate::model::ModelError;
use crate::model::exact::Exact;
use crate::model::program::{Meaning, Program};

/// A value that is looked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unknown {
    pub name: String,
    /// Where it is looked for first.
    pub near: Option<f64>,
}

/// What balances, and where each unknown is proved to lie.
struct Solution {
    values: Vec<f64>,
    enclosures: Vec<Interval>,
}

/// The values of `unknowns` at which every one of `residuals` is 0; `known` gives the other names, derivatives included.
///
/// One unknown: the first change of sign away from `near` on either side; without `near`, all changes of sign between powers of
/// ten are looked at. Several: Newton's method from `near`, or from many starts. Each solution is proved with intervals to be
/// there and to be the only one close by; without `near` there may be but one in all that was looked at.
/// Errors: [`ModelError::NotFound`], [`ModelError::Several`], [`ModelError::Indistinct`] (a double root, say).
pub(super) fn solve_nonlinear(
    residuals: &[&Expression],
    unknowns: &[&Unknown],
    known: &dyn Fn(&str, u8) -> Option<Exact>,
) -> Result<Vec<(String, Exact)>, ModelError> {
    let system = System::new(residuals, unknowns, known)?;
    let stated = unknowns.iter().all(|unknown| unknown.near.is_some());
    let candidates: Box<dyn Iterator<Item = Vec<f64>> + '_> = match unknowns {
        [only] => Box::new(system.changes_of_sign(only.near).chain(system.candidates_from_starts(unknowns))),
        _ => Box::new(system.candidates_from_starts(unknowns)),
    };
    let mut solutions: Vec<Solution> = Vec::new();
    let mut doubtful: Option<Vec<f64>> = None;
    for values in candidates {
        let seen = |solution: &Solution| {
            solution.values.iter().zip(&values).all(|(a, b)| (a - b).abs() <= 1e-9 * (a.abs() + b.abs()))
        };
        if solutions.iter().any(seen) {
            continue;
        }
        match proved(residuals, unknowns, known, &values) {
            Some(enclosures) => {
                let values = enclosures.iter().map(|enclosure| enclosure.middle()).collect();
                solutions.push(Solution { values, enclosures });
                if stated {
                    break;
                }
            }
            None if doubtful.is_none() && system.balances(&values) => doubtful = Some(values),
            None => {}
        }
    }
    let names = || unknowns.iter().map(|unknown| unknown.name.clone()).collect::<Vec<_>>();
    let shown = |values: &[f64]| {
        let each = unknowns.iter().zip(values);
        let each = each.map(|(unknown, value)| format!("{} = {}", unknown.name, significant(*value, 6)));
        each.collect::<Vec<_>>().join(", ")
    };
    match solutions.as_slice() {
        [only] => Ok(system.exactly(unknowns, only, residuals, known)),
        [] => Err(match doubtful {
            Some(values) => ModelError::Indistinct { names: names(), value: shown(&values) },
            None => ModelError::NotFound { names: names() },
        }),
        several => {
            // The smallest first, whatever their signs.
            let mut values: Vec<&[f64]> = several.iter().map(|solution| &solution.values[..]).collect();
            values.sort_by(|a, b| size(a).total_cmp(&size(b)).then(a[0].total_cmp(&b[0])));
            let mut listed: Vec<String> =
                values.iter().take(MOST_SHOWN).map(|values| shown(values)).collect();
            if values.len() > MOST_SHOWN {
                listed.push(format!("{} more", values.len() - MOST_SHOWN));
            }
            Err(ModelError::Several { names: names(), values: listed })
        }
    }
}

/// Places that are named where there are several.
const MOST_SHOWN: usize = 4;

/// The residuals and their slopes, ready to be evaluated in `f64`.
struct System {
    residuals: Vec<Program>,
    /// By residual and unknown.
    slopes: Vec<Vec<Program>>,
}

/// Newton's steps from one start.
const STEPS: usize = 60;
/// Starts of Newton's method where none is stated.
const STARTS: u32 = 96;

impl System {
    fn new(
        residuals: &[&Expression],
        unknowns: &[&Unknown],
        known: &dyn Fn(&str, u8) -> Option<Exact>,
    ) -> Result<Self, ModelError> {
        let meaning = |name: &str, primes: u8| match unknowns
            .iter()
            .position(|unknown| unknown.name == name && primes == 0)
        {
            Some(slot) => Some(Meaning::Slot(slot)),
            None => known(name, primes).map(|value| Meaning::Constant(value.to_f64())),
        };
        let slopes_of = |residual: &&Expression| {
            let slope =
                |unknown: &&Unknown| Program::new(&residual.differentiate(&unknown.name, 0), &meaning);
            unknowns.iter().map(slope).collect::<Result<Vec<_>, _>>()
        };
        Ok(Self {
            residuals: residuals.iter().map(|r| Program::new(r, &meaning)).collect::<Result<_, _>>()?,
            slopes: residuals.iter().map(slopes_of).collect::<Result<_, _>>()?,
        })
    }

    fn at(&self, values: &[f64]) -> Vec<f64> {
        let mut stack = Vec::new();
        self.residuals.iter().map(|residual| residual.run(values, &mut stack)).collect()
    }

    /// Whether Newton's method ended where the residuals are but rounding beside what they are nearby.
    fn balances(&self, values: &[f64]) -> bool {
        let here = size(&self.at(values));
        let beside: Vec<f64> = values.iter().map(|x| x + 1e-3 * x.abs().max(1e-3)).collect();
        here.is_finite() && here <= 1e-9 * size(&self.at(&beside)).max(f64::MIN_POSITIVE)
    }

    /// Where the first residual changes its sign, the nearest to `near` first; without it, in the order of the numbers.
    fn changes_of_sign(&self, near: Option<f64>) -> impl Iterator<Item = Vec<f64>> + '_ {
        let groups: Vec<Vec<(f64, f64)>> = match near {
            Some(near) => {
                let first = 1e-3 * if near == 0.0 { 1.0 } else { near.abs() };
                let reach = |k: i32| if k < 0 { 0.0 } else { first * 1.1f64.powi(k) };
                let both = (0..240).map(|k| (reach(k - 1), reach(k)));
                let both = both.map(|(from, to)| vec![(near + from, near + to), (near - to, near - from)]);
                both.collect()
            }
            None => {
                // From a billionth to a billion, ten places to a power of ten.
                let sizes = (-90..=90).map(|tenth| 10f64.powf(f64::from(tenth) / 10.0));
                let mut grid: Vec<f64> = sizes.flat_map(|size| [size, -size]).chain([0.0]).collect();
                grid.sort_by(f64::total_cmp);
                grid.windows(2).map(|ends| vec![(ends[0], ends[1])]).collect()
            }
        };
        groups.into_iter().flat_map(move |group| {
            let mut found: Vec<f64> =
                group.into_iter().filter_map(|(low, high)| self.bisected(low, high)).collect();
            let far = |value: &f64| near.map_or(0.0, |near| (value - near).abs());
            found.sort_by(|a, b| far(a).total_cmp(&far(b)));
            found.into_iter().map(|value| vec![value])
        })
    }

    /// A change of sign between two places, to the last digit; one of them where it is 0 there.
    fn bisected(&self, low: f64, high: f64) -> Option<f64> {
        let residual = self.residuals.first()?;
        let mut stack = Vec::new();
        let mut of = |x: f64| residual.run(&[x], &mut stack);
        let (mut low, mut high) = (low, high);
        let (at_low, at_high) = (of(low), of(high));
        for (place, value) in [(low, at_low), (high, at_high)] {
            if value == 0.0 {
                return Some(place);
            }
        }
        if !at_low.is_finite() || !at_high.is_finite() || at_low.signum() == at_high.signum() {
            return None;
        }
        for _ in 0..200 {
            let middle = low / 2.0 + high / 2.0;
            if middle <= low || middle >= high {
                break;
            }
            let value = of(middle);
            if value == 0.0 {
                return Some(middle);
            }
            if value.signum() == at_low.signum() {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// Where Newton's method ends, from `near` alone where it is stated of all.
    fn candidates_from_starts<'a>(
        &'a self,
        unknowns: &'a [&'a Unknown],
    ) -> impl Iterator<Item = Vec<f64>> + 'a {
        let stated = unknowns.iter().all(|unknown| unknown.near.is_some());
        let starts = 0..if stated { 1 } else { STARTS };
        starts.filter_map(|nth| {
            let start = unknowns.iter().enumerate().map(|(place, unknown)| {
                // Spread evenly over powers of ten, for each unknown in another order; both signs in turn.
                let base = [2, 3, 5, 7, 11, 13, 17, 19].get(place).copied().unwrap_or(23);
                let size = 10f64.powf(6.0 * halton(nth / 2 + 1, base) - 4.0);
                unknown.near.unwrap_or(if nth % 2 == 0 { size } else { -size })
            });
            self.newton(start.collect())
        })
    }

    /// Damped: a step that makes the residuals larger, or leaves where they are defined, is halved.
    fn newton(&self, start: Vec<f64>) -> Option<Vec<f64>> {
        let mut values = start;
        let mut stack = Vec::new();
        for _ in 0..STEPS {
            let residuals = self.at(&values);
            let here = size(&residuals);
            if !here.is_finite() {
                return None;
            }
            if here == 0.0 {
                return Some(values);
            }
            let slopes: Vec<Vec<f64>> = self
                .slopes
                .iter()
                .map(|row| row.iter().map(|slope| slope.run(&values, &mut stack)).collect())
                .collect();
            let Some(step) = least_squares(&slopes, &residuals) else { return Some(values) };
            let mut part = 1.0;
            let next = loop {
                let next: Vec<f64> = values.iter().zip(&step).map(|(x, dx)| x - part * dx).collect();
                if size(&self.at(&next)) < here {
                    break Some(next);
                }
                part /= 2.0;
                if part < 1e-9 {
                    break None;
                }
            };
            match next {
                Some(next) => values = next,
                None => return Some(values),
            }
        }
        Some(values)
    }

    /// Each value exactly, where a simple rational number or multiple of pi in its place balances the equations exactly.
    fn exactly(
        &self,
        unknowns: &[&Unknown],
        solution: &Solution,
        residuals: &[&Expression],
        known: &dyn Fn(&str, u8) -> Option<Exact>,
    ) -> Vec<(String, Exact)> {
        let candidates = [simple_rational, simple_multiple_of_pi]
            .map(|simple| solution.enclosures.iter().map(|one| simple(*one)).collect::<Option<Vec<_>>>());
        let balances = |values: &Vec<Exact>| {
            let lookup = |name: &str, primes: u8| {
                let own = unknowns.iter().position(|unknown| unknown.name == name && primes == 0);
                own.map_or_else(|| known(name, primes), |place| values.get(place).cloned())
            };
            residuals
                .iter()
                .all(|residual| Exact::evaluate(residual, &lookup).is_ok_and(|left| left.is_zero()))
        };
        let exact = candidates.into_iter().flatten().find(balances);
        let nearly = || solution.values.iter().map(|value| Exact::Approximate(*value)).collect();
        let values: Vec<Exact> = exact.unwrap_or_else(nearly);
        unknowns.iter().map(|unknown| unknown.name.clone()).zip(values).collect()
    }
}

/// Largest |residual|; not a number when one is not.
fn size(residuals: &[f64]) -> f64 {
    residuals.iter().fold(0.0, |most, r| if r.is_nan() { f64::NAN } else { r.abs().max(most) })
}

/// The step that brings the residuals nearest to 0; `None` where the slopes leave it open.
fn least_squares(slopes: &[Vec<f64>], residuals: &[f64]) -> Option<Vec<f64>> {
    let columns = slopes.first()?.len();
    let matrix = nalgebra::DMatrix::from_fn(slopes.len(), columns, |i, j| slopes[i][j]);
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let right = nalgebra::DVector::from_column_slice(residuals);
    let normal = matrix.transpose() * &matrix;
    let step = normal.lu().solve(&(matrix.transpose() * right))?;
    step.iter().all(|x| x.is_finite()).then(|| step.iter().copied().collect())
}

/// The `n`-th of a sequence that fills 0..1 evenly; van der Corput's in `base`.
fn halton(n: u32, base: u32) -> f64 {
    let (mut rest, mut place, mut value) = (n, 1.0, 0.0);
    while rest > 0 {
        place /= f64::from(base);
        value += place * f64::from(rest % base);
        rest /= base;
    }
    value
}

/// The simplest fraction in it, with a denominator below a million.
fn simple_rational(held: Interval) -> Option<Exact> {
    if held.contains(0.0) {
        return Some(Exact::zero());
    }
    let value = held.middle();
    let (mut rest, mut before, mut now) = (value, (0.0f64, 1.0f64), (1.0f64, 0.0f64));
    for _ in 0..40 {
        let whole = rest.floor();
        let next = (whole * now.0 + before.0, whole * now.1 + before.1);
        if next.1 > 1e6 || next.0.abs() > 1e15 {
            return None;
        }
        (before, now) = (now, next);
        if held.contains(now.0 / now.1) {
            return Some(Exact::rational(from_f64(now.0)? / from_f64(now.1)?));
        }
        rest = 1.0 / (rest - whole);
    }
    None
}

/// k·pi in it, where the denominator of k is below a thousand.
fn simple_multiple_of_pi(held: Interval) -> Option<Exact> {
    let factor = simple_rational(held.over(Interval::point(std::f64::consts::PI)))?;
    let k = factor.as_rational()?;
    (k.denominator() < &1000u32.into()).then(|| Exact::Known { rational: Rational::ZERO, pi: k.clone() })
}
