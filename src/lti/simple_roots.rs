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
/// Radii wanted as a rule, relative to each part of the root: 2⁻⁶⁰.
pub(super) const PRECISION_BITS: i64 = 60;
const FIRST_BITS: usize = 128;
const MOST_BITS: usize = 4096;
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
/// floating point, then on exact values; clusters, where it gains a bit a sweep, by their own Taylor series; Smith,
/// *J. ACM* 17, 1970.
/// `precision_bits`: the radius is less than 2^−`precision_bits` of each part of the root.
pub(super) fn simple_roots(p: &[IBig], even: bool, precision_bits: i64) -> Result<Vec<Disc>, RootError> {
    let mut points: Vec<Dyadic> = float_roots(&in_floating_point(p)).into_iter().map(Dyadic::near).collect();
    let mut values: Vec<Vec<Wide>> = points.iter().map(|z| taylor(p, z, 2)).collect();
    let mut bits = FIRST_BITS;
    let mut sweeps = 0;
    while bits <= MOST_BITS && sweeps < EXACT_SWEEPS {
        sweeps += 1;
        let differences = differences(&points);
        let discs: Vec<Option<Disc>> =
            (0..points.len()).map(|i| disc(p, i, &points[i], values[i][0], &differences[i])).collect();
        let settled: Vec<Option<Disc>> =
            (0..points.len()).map(|i| settled(i, &discs, &differences, even, precision_bits)).collect();
        if let Some(all) = settled.iter().cloned().collect::<Option<Vec<Disc>>>() {
            return Ok(all.into_iter().filter(|disc| disc.center.im().mantissa().re >= 0.0).collect());
        }
        // By turns, so that neither stands in the other's way.
        let mut moved = if sweeps % 2 == 0 {
            apart(p, &points, &discs, &differences, bits)
        } else {
            vec![None; points.len()]
        };
        let mut largest_step = i64::MIN;
        for (i, z) in points.iter_mut().enumerate().filter(|&(i, _)| settled[i].is_none()) {
            let next = moved[i].take().unwrap_or_else(|| {
                z.moved(aberth_step(values[i][0], values[i][1], &differences[i], i, z.to_wide()), bits)
            });
            let step = next.minus(z).to_wide();
            if !step.is_zero() {
                largest_step = largest_step.max(step.exponent() - z.to_wide().exponent());
                values[i] = taylor(p, &next, 2);
                *z = next;
            }
        }
        if largest_step < 16 - bits as i64 / 2 {
            bits *= 2;
        }
    }
    Err(RootError::NotConverged { iterations: sweeps })
}

/// New places for the points of clusters, where their discs become smaller by it.
fn apart(
    p: &[IBig],
    points: &[Dyadic],
    discs: &[Option<Disc>],
    differences: &[Vec<Wide>],
    bits: usize,
) -> Vec<Option<Dyadic>> {
    let mut moved = vec![None; points.len()];
    let widest = |cluster: &[usize], discs: &[Option<Disc>]| {
        let radii: Option<Vec<Wide>> =
            cluster.iter().map(|&i| discs[i].as_ref().map(|disc| disc.radius)).collect();
        radii.and_then(|radii| radii.into_iter().max_by(|a, b| a.cmp_abs(*b)))
    };
    for cluster in clusters(points, discs, differences) {
        let places = taken_apart(p, &points[cluster[0]], cluster.len(), bits);
        let mut there = points.to_vec();
        for (&i, z) in cluster.iter().zip(&places) {
            there[i] = z.clone();
        }
        let at =
            |&i: &usize| disc(p, i, &there[i], taylor(p, &there[i], 1)[0], &row_of_differences(&there, i));
        let new: Vec<Option<Disc>> = cluster.iter().map(at).collect();
        let everyone: Vec<usize> = (0..new.len()).collect();
        let better = match (widest(&everyone, &new), widest(&cluster, discs)) {
            (Some(new), Some(old)) => new.cmp_abs(old) == Ordering::Less,
            (new, _) => new.is_some(),
        };
        if better {
            for i in cluster {
                moved[i] = Some(there[i].clone());
            }
        }
    }
    moved
}

/// Groups of points that stand for roots not yet told apart, far from all others and from 0.
fn clusters(points: &[Dyadic], discs: &[Option<Disc>], differences: &[Vec<Wide>]) -> Vec<Vec<usize>> {
    let radius = |i: usize| discs[i].as_ref().map_or(Wide::ZERO, |disc| disc.radius);
    let meet = |i: usize, j: usize| differences[i][j].cmp_abs(radius(i) + radius(j)) != Ordering::Greater;
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut found = Vec::new();
    while let Some(first) = left.pop() {
        let mut cluster = vec![first];
        let mut at = 0;
        while let Some(&i) = cluster.get(at) {
            cluster.extend(left.extract_if(.., |j| meet(i, *j)));
            at += 1;
        }
        let mut across = Wide::ZERO;
        let mut away = points[first].to_wide();
        for (&i, j) in cluster.iter().flat_map(|i| (0..points.len()).map(move |j| (i, j))) {
            let distance = differences[i][j];
            let inside = cluster.contains(&j);
            if inside && distance.cmp_abs(across) == Ordering::Greater {
                across = distance;
            } else if !inside && distance.cmp_abs(away) == Ordering::Less {
                away = distance;
            }
        }
        if cluster.len() > 1 && across.shifted(3).cmp_abs(away) == Ordering::Less {
            found.push(cluster);
        }
    }
    found
}

/// Where `count` roots near `z` and far from all others are, to the precision of the series about their mean that ends with
/// h^`count`; none when it has no such term.
fn taken_apart(p: &[IBig], z: &Dyadic, count: usize, bits: usize) -> Vec<Dyadic> {
    let series = taylor(p, z, count + 1);
    let mean = series[count - 1] / (series[count] * Wide::real(count as f64, 0));
    let mean = z.moved(mean, bits);
    let mut series = taylor(p, &mean, count + 1);
    if series[count].is_zero() {
        return Vec::new();
    }
    series.reverse();
    let at_mean = series.iter().rev().take_while(|c| c.is_zero()).count();
    series.truncate(count + 1 - at_mean);
    let mut offsets = float_roots(&series);
    offsets.resize(count, Wide::ZERO);
    offsets.into_iter().map(|h| mean.moved(-h, bits)).collect()
}

/// Where the Ehrlich–Aberth iteration in floating point comes to rest, or gives up.
fn float_roots(coefficients: &[Wide]) -> Vec<Wide> {
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
            let (value, slope) = horner(coefficients, z);
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
    (0..points.len()).map(|i| row_of_differences(points, i)).collect()
}

fn row_of_differences(points: &[Dyadic], i: usize) -> Vec<Wide> {
    points.iter().map(|z| points[i].minus(z).to_wide()).collect()
}

/// Smith's disc around a point, from p(z) and its distances to all; `None` where another coincides with it.
fn disc(p: &[IBig], own: usize, z: &Dyadic, value: Wide, differences: &[Wide]) -> Option<Disc> {
    let degree = Wide::real(differences.len() as f64 * ROUNDING, 0);
    let mut product =
        p.first().map_or(Wide::ONE, |c| taylor(std::slice::from_ref(c), &Dyadic::near(Wide::ZERO), 1)[0]);
    for (_, &d) in differences.iter().enumerate().filter(|&(j, _)| j != own) {
        product = product * d;
    }
    (!product.is_zero()).then(|| Disc { center: z.clone(), radius: degree * value.abs() / product.abs() })
}

/// A disc that is small, apart from all others, and known to be on an axis (then so is its center) or off it.
fn settled(
    i: usize,
    discs: &[Option<Disc>],
    differences: &[Vec<Wide>],
    even: bool,
    precision_bits: i64,
) -> Option<Disc> {
    let disc = discs[i].as_ref()?;
    // Whether a distance keeps this disc apart from another; never from one not known yet.
    let clear = |distance: Wide, j: usize| {
        let reach = |other: &Disc| (disc.radius + other.radius) * Wide::real(ROUNDING, 0);
        discs[j].as_ref().is_some_and(|other| distance.cmp_abs(reach(other)) == Ordering::Greater)
    };
    let others = || (0..discs.len()).filter(|&j| j != i);
    if !others().all(|j| clear(differences[i][j], j)) {
        return None;
    }
    // Whether the mirror image of the disc meets no disc but itself.
    let alone = |mirrored: &Dyadic| {
        others()
            .all(|j| discs[j].as_ref().is_some_and(|other| clear(mirrored.minus(&other.center).to_wide(), j)))
    };
    let meets = |part: Wide| part.cmp_abs(disc.radius * Wide::real(ROUNDING, 0)) != Ordering::Greater;
    let small = |part: Wide| disc.radius.cmp_abs(part.shifted(-precision_bits)) == Ordering::Less;
    let (re, im) = (disc.center.re(), disc.center.im());
    let onto = |center: Dyadic| Some(Disc { center, radius: disc.radius });
    if meets(im) {
        let on_axis = alone(&disc.center.conjugate()) && small(re);
        if on_axis { onto(disc.center.onto_real_axis()) } else { None }
    } else if even && meets(re) {
        let on_axis = alone(&disc.center.reflected()) && small(im);
        if on_axis { onto(disc.center.onto_imaginary_axis()) } else { None }
    } else {
        (small(im) && small(re)).then(|| disc.clone())
    }
}
