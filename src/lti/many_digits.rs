//! A response whose terms cancel, summed with as many digits as that takes.

use super::dyadic::{Dyadic, exact_taylor};
use super::pieces::{NODES, Piece, Pieces, nodes};
use super::poles::isolated_roots_to;
use super::wide::ldexp;
use super::{Mode, Pole, ResponseError, TransferFunction};
use crate::algebra::Polynomial;
use dashu_int::IBig;
use dashu_int::ops::BitTest;

/// A term is dropped when it has fallen to 2⁻⁷⁵ of the largest value seen.
const DEAD_BITS: u8 = 75;
/// Beyond this many digits nobody waits.
const MOST_BITS: f64 = 3_500.0;
/// Radians that the fastest term turns (or e-foldings it decays) within one piece.
const RADIANS: f64 = 12.0;
/// Products of many digits, before the sum is given up: about a second.
const MOST_PRODUCTS: usize = 4_000_000;
/// e-foldings after which a growing response is seen to grow.
const GROWTH: f64 = 60.0;

type Fixed = (IBig, IBig);

/// One pole with the coefficients of its powers of t.
struct Term {
    /// e^{p·w·x} for each node x of a piece of the present width w.
    over_piece: Vec<Fixed>,
    /// c · tᵏ/k! without the tᵏ, times e^{p·a} where the piece begins at a.
    coefficients: Vec<Fixed>,
    pole: Pole,
}

/// y(t) of `g`, strictly proper and in lowest terms, whose partial fractions in floating point are `modes`.
///
/// Accuracy: 1e-15 of the largest value in each piece, and 1e-20 of the largest of all.
/// Errors: [`ResponseError::TooClose`] when it takes more digits, or more pieces, than anybody would wait for.
/// Source: the same partial fractions with poles and coefficients to as many bits as cancel and 100 more; e^{pt} at
/// Chebyshev's points, by squaring where the steps double.
pub(super) fn many_digits(
    g: &TransferFunction,
    modes: &[Mode],
    poles: &[Pole],
) -> Result<Pieces, ResponseError> {
    let refused = || too_close(poles);
    let fastest = poles.iter().map(speed).fold(0.0, f64::max);
    let slowest = poles.iter().map(speed).filter(|s| *s > 0.0).fold(f64::INFINITY, f64::min);
    let sum = modes.iter().map(|mode| mode.amplitude().max(mode.early_bound(fastest))).sum::<f64>().log2();
    if !(fastest > 0.0 && sum.is_finite()) {
        return Err(refused());
    }
    let degree = g.den.degree() as f64;
    let separation = closest(poles).map_or(fastest, |(_, _, distance)| distance);
    let sensitive = ((degree * fastest / separation).log2() + 1.0).max(0.0);
    let repeated = poles.iter().map(|pole| pole.multiplicity).max().unwrap_or(1) as f64;
    // A power of two, so that times are exact.
    let width = ldexp(1.0, (0.5 / fastest).log2().floor() as i64);
    // How large the response is turns out at the end.
    let mut bits = sum.max(6.0) - sum.min(0.0) + f64::from(DEAD_BITS) + 30.0;
    // Steps double from the fastest to the slowest, and powers of t magnify what is cut off their coefficients.
    bits +=
        (fastest / slowest).log2() + poles.iter().map(|pole| magnified(pole, slowest)).fold(0.0, f64::max);
    loop {
        let precise = bits + sensitive * repeated + (fastest / slowest).log2() + 40.0;
        if precise.is_nan() || precise > MOST_BITS {
            return Err(refused());
        }
        let terms = terms(g, width, bits.ceil() as usize, precise.ceil() as usize)?;
        let pieces = sum_up(terms, width, bits.ceil() as usize).ok_or_else(refused)?;
        if pieces.highest().log2() >= sum.max(6.0) + f64::from(DEAD_BITS) - bits {
            return Ok(pieces);
        }
        bits += 0.5 * bits;
    }
}

fn speed(pole: &Pole) -> f64 {
    pole.re.hypot(pole.im)
}

/// Bits by which t^k outgrows 1 before the response has died, or is no longer looked at.
fn magnified(pole: &Pole, slowest: f64) -> f64 {
    let powers = (pole.multiplicity - 1) as f64;
    let rate = if pole.re == 0.0 { slowest / 5.0 } else { pole.re.abs() };
    powers * ((60.0 + 3.0 * powers) / rate).log2().max(0.0)
}

/// The two poles nearest to one another, as a part of their size.
fn closest(poles: &[Pole]) -> Option<(&Pole, &Pole, f64)> {
    let pairs = poles.iter().enumerate().flat_map(|(i, a)| poles[..i].iter().map(move |b| (a, b)));
    let apart = |a: &Pole, b: &Pole| {
        let distance = (a.re - b.re).hypot(a.im - b.im);
        // Two that are one in floating point.
        distance.max(f64::MIN_POSITIVE)
    };
    pairs
        .map(|(a, b)| (a, b, apart(a, b)))
        .min_by(|x, y| (x.2 / speed(x.0).max(speed(x.1))).total_cmp(&(y.2 / speed(y.0).max(speed(y.1)))))
}

fn too_close(poles: &[Pole]) -> ResponseError {
    let text = |pole: &Pole| match pole.im {
        0.0 => format!("{}", pole.re),
        im if im < 0.0 => format!("{} - {}j", pole.re, -im),
        im => format!("{} + {im}j", pole.re),
    };
    match closest(poles) {
        Some((a, b, _)) => ResponseError::TooClose { first: text(b), second: text(a) },
        None => ResponseError::OutOfRange,
    }
}

fn terms(g: &TransferFunction, width: f64, bits: usize, precise: usize) -> Result<Vec<Term>, ResponseError> {
    let both = [g.den.coefficients(), g.num.coefficients()].concat();
    let integers = Polynomial::new(both).primitive();
    let (den, num) = integers.split_at(g.den.degree() + 1);
    let mut terms = Vec::new();
    for root in isolated_roots_to(&g.den, precise as i64)? {
        let m = root.pole.multiplicity;
        let digits = |values: Vec<Dyadic>| -> Vec<Dyadic> {
            values.into_iter().map(|value| value.rounded(precise + 64)).collect()
        };
        let mut above = digits(exact_taylor(num, &root.center, m));
        above.resize(m, Dyadic::zero());
        let below = digits(exact_taylor(den, &root.center, 2 * m));
        let mut quotient: Vec<Dyadic> = Vec::with_capacity(m);
        for (k, value) in above.into_iter().enumerate() {
            let mut rest = value;
            for (j, earlier) in quotient.iter().enumerate() {
                if let Some(slope) = below.get(m + k - j) {
                    rest = rest.minus(&slope.times(earlier)).rounded(precise + 64);
                }
            }
            quotient.push(rest.over(&below[m], precise + 64));
        }
        // quotient[k] belongs to 1/(s − p)^(m − k), so to t^(m − 1 − k).
        let coefficients = quotient.into_iter().rev().enumerate().map(|(power, c)| {
            let (re, im) = c.in_fixed_point(bits);
            let factorial = (1..=power).fold(IBig::ONE, |product, k| product * IBig::from(k));
            (re / &factorial, im / &factorial)
        });
        let coefficients = coefficients.collect();
        let over_piece = nodes()
            .into_iter()
            .map(|x| exponential(&root.center.scaled(x * width).in_fixed_point(bits), bits))
            .collect();
        terms.push(Term { over_piece, coefficients, pole: root.pole });
    }
    Ok(terms)
}

/// e^z for |z| of about 1 or less, by its series.
fn exponential(z: &Fixed, bits: usize) -> Fixed {
    let one = IBig::ONE << bits;
    let mut sum = (one.clone(), IBig::ZERO);
    let mut term = (one, IBig::ZERO);
    for k in 1..4 * bits {
        let product = times(&term, z, bits);
        term = (product.0 / IBig::from(k), product.1 / IBig::from(k));
        if term.0.bit_len().max(term.1.bit_len()) <= 1 {
            break;
        }
        sum = (sum.0 + &term.0, sum.1 + &term.1);
    }
    sum
}

fn times(a: &Fixed, b: &Fixed, bits: usize) -> Fixed {
    ((&a.0 * &b.0 - &a.1 * &b.1) >> bits, (&a.0 * &b.1 + &a.1 * &b.0) >> bits)
}

/// Piece after piece until nothing moves any more, or what stays is seen to stay.
fn sum_up(mut terms: Vec<Term>, mut width: f64, bits: usize) -> Option<Pieces> {
    let moves = |term: &Term| speed(&term.pole) > 0.0 || term.coefficients.len() > 1;
    let rightmost = terms.iter().filter(|t| moves(t)).map(|t| t.pole.re).fold(f64::NEG_INFINITY, f64::max);
    let until = lasting_until(&terms, rightmost);
    let constant = terms.iter().find(|term| speed(&term.pole) == 0.0);
    let constant = constant.and_then(|term| term.coefficients.first()).map_or(0.0, |c| to_float(&c.0, bits));
    let positions = nodes();
    let mut pieces: Vec<Piece> = Vec::new();
    let mut from = 0.0;
    let mut products = 0;
    let mut highest = f64::MIN_POSITIVE;
    loop {
        // Where t^k stands at the coefficients, too.
        let alive_above = highest.log2() as i64 + bits as i64 - i64::from(DEAD_BITS);
        let late = (from + width).log2().max(0.0).ceil() as i64;
        let alive: Vec<usize> = (0..terms.len())
            .filter(|&i| {
                let sizes = terms[i].coefficients.iter().enumerate();
                let length = |c: &Fixed| c.0.bit_len().max(c.1.bit_len()) as i64;
                // Rounded down, what is nothing is −1.
                let there = sizes.filter(|(_, c)| length(c) > 1);
                there.map(|(k, c)| length(c) + k as i64 * late).max().unwrap_or(0) > alive_above
            })
            .collect();
        let done = from >= until && alive.iter().all(|&i| terms[i].pole.re >= 0.0);
        if done && !pieces.is_empty() {
            break;
        }
        products += NODES * alive.iter().map(|&i| 1 + terms[i].coefficients.len()).sum::<usize>().max(1);
        if products > MOST_PRODUCTS {
            return None;
        }
        let values = positions.iter().enumerate().map(|(node, x)| {
            let t = Dyadic::real(from + width * x).in_fixed_point(bits).0;
            let sum = alive.iter().fold(IBig::ZERO, |sum, &i| sum + value(&terms[i], node, &t, bits));
            to_float(&sum, bits)
        });
        let values: Vec<f64> = values.collect();
        highest = values.iter().fold(highest, |top, y| top.max(y.abs()));
        if !highest.is_finite() {
            return None;
        }
        pieces.push(Piece::through(from, width, &values));
        from += width;
        for term in &mut terms {
            let step = &term.over_piece[NODES - 1];
            for c in &mut term.coefficients {
                *c = times(c, step, bits);
            }
        }
        let fastest = alive.iter().map(|&i| speed(&terms[i].pole)).fold(0.0, f64::max);
        if 2.0 * width * fastest <= RADIANS && from >= width {
            width *= 2.0;
            for factor in terms.iter_mut().flat_map(|term| &mut term.over_piece) {
                *factor = times(factor, factor, bits);
            }
        }
    }
    Some(Pieces::new(pieces, constant, rightmost))
}

/// Re of a term's sum of coefficients times powers of t, times its exponential; twice for a pair.
fn value(term: &Term, node: usize, t: &IBig, bits: usize) -> IBig {
    let (mut re, mut im) = term.coefficients[term.coefficients.len() - 1].clone();
    for c in term.coefficients.iter().rev().skip(1) {
        re = ((re * t) >> bits) + &c.0;
        im = ((im * t) >> bits) + &c.1;
    }
    let factor = &term.over_piece[node];
    if term.pole.im == 0.0 {
        (re * &factor.0) >> bits
    } else {
        (re * &factor.0 - im * &factor.1) >> (bits - 1)
    }
}

fn to_float(value: &IBig, bits: usize) -> f64 {
    let excess = value.bit_len().saturating_sub(900);
    ldexp((value >> excess).to_f64().value(), excess as i64 - bits as i64)
}

/// Until when a response that does not decay is looked at.
fn lasting_until(terms: &[Term], rightmost: f64) -> f64 {
    if rightmost > 0.0 {
        return GROWTH / rightmost;
    }
    if rightmost < 0.0 {
        return 0.0;
    }
    let poles = || terms.iter().map(|term| &term.pole);
    let turn = poles().filter(|p| p.re == 0.0 && p.im > 0.0).map(|p| p.im).fold(f64::INFINITY, f64::min);
    let decay = poles().filter(|p| p.re < 0.0).map(|p| -p.re).fold(f64::INFINITY, f64::min);
    // Four times the time axis of such a response.
    4.5 * (8.0 * std::f64::consts::TAU / turn).max(5.0 / decay)
}
