//! All roots of a square-free polynomial, each in a disc of its own.

use super::RootError;
use super::dyadic::{Dyadic, taylor};
use super::wide::Wide;
use dashu_int::IBig;
use num_complex::Complex64;
use std::cmp::Ordering;

/// A root and how far it can be from `center`.
#[derive(Clone, Debug)]
pub(super) struct Disc {
    /// Exactly on an axis when the root is.
    pub center: Dyadic,
    /// Real; an upper bound, rounding included.
    pub radius: Wide,
}

/// Rounding in the radii (about 200 units of 2⁻⁵²) is covered by this much more.
const ROUNDING: f64 = 1.0 + 1e-10;
/// Radii wanted, relative to each part of the root: 2⁻⁶⁰.
const PRECISION_BITS: i64 = 60;
const FIRST_BITS: usize = 128;
const MOST_BITS: usize = 1024;
const FLOAT_SWEEPS: usize = 80;
const EXACT_SWEEPS: usize = 400;

/// The roots of a square-free polynomial with p(0) ≠ 0: those on and above the real axis.
///
/// `p`: integer coefficients, highest power first. `even`: whether p(s) = p(−s); otherwise p must share no root with
/// p(−s), so that none lies on the imaginary axis.
///
/// Every disc holds one root and no other: Smith's discs of radius n·|p(zᵢ)| / |aₙ ∏(zᵢ − zⱼ)| around exact points,
/// from exact values of p. Where a disc meets its own mirror image and no other disc, its root is on the axis.
/// Source: Ehrlich–Aberth iteration from Newton-polygon starting points (Bini, *Numer. Algorithms* 13, 1996), first in
/// floating point, then on exact values; Smith, *J. ACM* 17, 1970.
pub(super) fn simple_roots(p: &[IBig], even: bool) -> Result<Vec<Disc>, RootError> {
    let mut points: Vec<Dyadic> = float_roots(p).into_iter().map(Dyadic::near).collect();
    let mut bits = FIRST_BITS;
    let mut sweeps = 0;
    while bits <= MOST_BITS && sweeps < EXACT_SWEEPS {
        sweeps += 1;
        let values: Vec<Vec<Wide>> = points.iter().map(|z| taylor(p, z, 2)).collect();
        let differences = differences(&points);
        let discs = discs(p, &points, &values, &differences);
        if let Some(certified) = certify(&discs, &differences, even) {
            return Ok(certified);
        }
        let mut largest_step = i64::MIN;
        let mut moved = Vec::with_capacity(points.len());
        for (i, z) in points.iter().enumerate() {
            let step = aberth_step(values[i][0], values[i][1], &differences[i], i, z.to_wide());
            if !step.is_zero() {
                largest_step = largest_step.max(step.exponent() - z.to_wide().exponent());
            }
            moved.push(z.moved(step, bits));
        }
        points = moved;
        if largest_step < 16 - bits as i64 / 2 {
            bits *= 2;
        }
    }
    Err(RootError::NotConverged { iterations: sweeps })
}

/// Where the Ehrlich–Aberth iteration in floating point comes to rest, or gives up.
fn float_roots(p: &[IBig]) -> Vec<Wide> {
    let coefficients = in_floating_point(p);
    let sizes: Vec<Wide> = coefficients.iter().map(|c| c.abs()).collect();
    let mut points = starting_points(&sizes);
    let n = points.len();
    let mut resting = vec![false; n];
    for _ in 0..FLOAT_SWEEPS {
        for i in 0..n {
            if resting[i] {
                continue;
            }
            let z = points[i];
            let (value, slope) = horner(&coefficients, z);
            let (size, _) = horner(&sizes, z.abs());
            let rounding = size * Wide::real(4.0 * (n + 1) as f64 * f64::EPSILON, 0);
            if value.cmp_abs(rounding) != Ordering::Greater {
                resting[i] = true;
                continue;
            }
            let differences: Vec<Wide> = points.iter().map(|&other| z - other).collect();
            let step = aberth_step(value, slope, &differences, i, z);
            points[i] = z - step;
            resting[i] = step.cmp_abs(z.shifted(-50)) == Ordering::Less;
        }
        if resting.iter().all(|&r| r) {
            break;
        }
    }
    points
}

/// Each coefficient, highest power first: the derivatives at 0 are the coefficients from the other end.
fn in_floating_point(p: &[IBig]) -> Vec<Wide> {
    let at_zero = Dyadic::near(Wide::ZERO);
    let mut powers = taylor(p, &at_zero, p.len());
    powers.reverse();
    powers
}

/// p(z) and p′(z).
fn horner(p: &[Wide], z: Wide) -> (Wide, Wide) {
    p.iter().fold((Wide::ZERO, Wide::ZERO), |(value, slope), &c| (value * z + c, slope * z + value))
}

/// Newton's step p/p′, corrected for the other roots.
fn aberth_step(value: Wide, slope: Wide, differences: &[Wide], own: usize, z: Wide) -> Wide {
    if value.is_zero() {
        return Wide::ZERO;
    }
    let others = differences.iter().enumerate().filter(|&(j, _)| j != own);
    // Two points at one place would stay together for ever.
    if others.clone().any(|(j, d)| d.is_zero() && j < own) {
        return z * Wide::new(Complex64::new(0.7, 0.4), -45);
    }
    let repulsion = others.fold(Wide::ZERO, |sum, (_, &d)| sum + Wide::ONE / d);
    // p/p′ ÷ (1 − p/p′ · Σ) without dividing by a slope of zero.
    let denominator = slope - value * repulsion;
    if denominator.is_zero() {
        return z * Wide::new(Complex64::new(0.6, -0.5), -10);
    }
    value / denominator
}

/// Circles as wide as the roots are large, from the upper convex hull of (k, log₂|cₖ|).
fn starting_points(sizes: &[Wide]) -> Vec<Wide> {
    let n = sizes.len() - 1;
    let log = |c: Wide| c.mantissa().re.log2() + c.exponent() as f64;
    let mut hull: Vec<(usize, f64)> = Vec::new();
    for (k, &c) in sizes.iter().rev().enumerate().filter(|(_, c)| !c.is_zero()) {
        let point = (k, log(c));
        let slope = |a: (usize, f64), b: (usize, f64)| (b.1 - a.1) / (b.0 - a.0) as f64;
        while let [.., before, last] = hull[..] {
            if slope(before, last) > slope(last, point) {
                break;
            }
            hull.pop();
        }
        hull.push(point);
    }
    let mut points = Vec::with_capacity(n);
    for edge in hull.windows(2) {
        let count = edge[1].0 - edge[0].0;
        let log_radius = (edge[0].1 - edge[1].1) / count as f64;
        let whole = log_radius.floor();
        for j in 0..count {
            let turn = j as f64 / count as f64 + edge[0].0 as f64 / n as f64;
            let angle = std::f64::consts::TAU * turn + 0.7;
            points.push(Wide::new(Complex64::from_polar((log_radius - whole).exp2(), angle), whole as i64));
        }
    }
    points
}

/// zᵢ − zⱼ.
fn differences(points: &[Dyadic]) -> Vec<Vec<Wide>> {
    let n = points.len();
    let mut table = vec![vec![Wide::ZERO; n]; n];
    for i in 0..n {
        for j in 0..i {
            table[i][j] = points[i].minus(&points[j]).to_wide();
            table[j][i] = -table[i][j];
        }
    }
    table
}

/// Smith's discs; `None` where two points coincide.
fn discs(
    p: &[IBig],
    points: &[Dyadic],
    values: &[Vec<Wide>],
    differences: &[Vec<Wide>],
) -> Vec<Option<Disc>> {
    let degree = Wide::real(points.len() as f64 * ROUNDING, 0);
    let lead =
        p.first().map_or(Wide::ONE, |c| taylor(std::slice::from_ref(c), &Dyadic::near(Wide::ZERO), 1)[0]);
    let disc = |(i, center): (usize, &Dyadic)| {
        let mut product = lead;
        for (_, &d) in differences[i].iter().enumerate().filter(|&(j, _)| j != i) {
            product = product * d;
        }
        let radius = || degree * values[i][0].abs() / product.abs();
        (!product.is_zero()).then(|| Disc { center: center.clone(), radius: radius() })
    };
    points.iter().enumerate().map(disc).collect()
}

/// The discs on and above the real axis, once all are small, apart from each other, and known to be on an axis or off it.
fn certify(discs: &[Option<Disc>], differences: &[Vec<Wide>], even: bool) -> Option<Vec<Disc>> {
    let discs: Vec<&Disc> = discs.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let reach = |i: usize, j: usize| (discs[i].radius + discs[j].radius) * Wide::real(ROUNDING, 0);
    for (i, row) in differences.iter().enumerate() {
        if row[..i].iter().enumerate().any(|(j, d)| d.cmp_abs(reach(i, j)) != Ordering::Greater) {
            return None;
        }
    }
    // Whether the mirror image of a disc meets no disc but itself.
    let alone = |i: usize, mirrored: &Dyadic| {
        (0..discs.len()).all(|j| {
            let distance = mirrored.minus(&discs[j].center).to_wide();
            j == i || distance.abs().cmp_abs(reach(i, j)) == Ordering::Greater
        })
    };
    let meets =
        |disc: &Disc, part: Wide| part.cmp_abs(disc.radius * Wide::real(ROUNDING, 0)) != Ordering::Greater;
    let mut certified = Vec::with_capacity(discs.len());
    for (i, &disc) in discs.iter().enumerate() {
        let small = |part: Wide| disc.radius.cmp_abs(part.shifted(-PRECISION_BITS)) == Ordering::Less;
        let (re, im) = (disc.center.re(), disc.center.im());
        let radius = disc.radius;
        if meets(disc, im) {
            if !alone(i, &disc.center.conjugate()) || !small(re) {
                return None;
            }
            certified.push(Disc { center: disc.center.onto_real_axis(), radius });
        } else if even && meets(disc, re) {
            if !alone(i, &disc.center.reflected()) || !small(im) {
                return None;
            }
            certified.push(Disc { center: disc.center.onto_imaginary_axis(), radius });
        } else {
            if !small(im) || !small(re) {
                return None;
            }
            certified.push(disc.clone());
        }
    }
    certified.retain(|disc| disc.center.im().mantissa().re >= 0.0);
    Some(certified)
}
