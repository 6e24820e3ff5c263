use crate::algebra::{Polynomial, Rational};
use dashu_int::IBig;
use dashu_int::ops::Gcd;

/// Stability of a linear system, from the roots of its characteristic polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stability {
    /// All roots strictly in the left half-plane.
    AsymptoticallyStable,
    /// None in the right half-plane, simple ones on the axis.
    MarginallyStable,
    /// A root in the right half-plane, or a repeated one on the axis.
    Unstable,
}

impl Stability {
    /// The stable code: `asymptotically_stable`, `marginally_stable` or `unstable`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::AsymptoticallyStable => "asymptotically_stable",
            Self::MarginallyStable => "marginally_stable",
            Self::Unstable => "unstable",
        }
    }

    /// The same in plain English, to stand in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::AsymptoticallyStable => "asymptotically stable",
            Self::MarginallyStable => "marginally stable",
            Self::Unstable => "unstable",
        }
    }
}

/// Decided exactly in rationals (Routh–Hurwitz / Sturm), never from computed roots.
///
/// A constant has no roots and is asymptotically stable; the zero polynomial has every root and is unstable.
pub fn stability(characteristic: &Polynomial) -> Stability {
    let census = Census::of(characteristic);
    if characteristic.is_zero() || census.right > 0 || census.axis_multiplicity > 1 {
        Stability::Unstable
    } else if census.axis_multiplicity == 1 {
        Stability::MarginallyStable
    } else {
        Stability::AsymptoticallyStable
    }
}

/// The number of roots with positive real part, by multiplicity; exact, 0 for the zero polynomial.
pub fn right_half_plane_roots(p: &Polynomial) -> usize {
    Census::of(p).right
}

/// Where the roots of a polynomial lie.
struct Census {
    /// Roots in the open right half-plane, by multiplicity.
    right: usize,
    /// The highest multiplicity of a root on the imaginary axis; 0 when there is none.
    axis_multiplicity: usize,
}

impl Census {
    /// Roots that lie symmetric about the origin, those on the axis among them, are exactly what p(s) shares with
    /// p(−s). They are split off and counted on s²; what remains has a regular Routh array in all but its degrees,
    /// and Sturm's chain does not mind degrees that drop.
    fn of(p: &Polynomial) -> Self {
        let at_origin = p.trailing_zeros();
        let power = Polynomial::monomial(Rational::ONE, at_origin);
        let rest = p.exact_quotient(&power);
        let symmetric = rest.gcd(&rest.mirror());
        let on_axis = axis_pairs(&symmetric);
        let count_on_axis: usize = on_axis.iter().map(|(pairs, multiplicity)| 2 * pairs * multiplicity).sum();
        let mirrored = symmetric.degree().saturating_sub(count_on_axis) / 2;
        let highest = on_axis.iter().map(|&(_, multiplicity)| multiplicity).max().unwrap_or(0);
        Self {
            right: right_of_regular(&rest.exact_quotient(&symmetric)) + mirrored,
            axis_multiplicity: highest.max(at_origin),
        }
    }
}

/// The pairs ±jω of an even polynomial with p(0) ≠ 0: how many, and with what multiplicity.
///
/// With s² = −x they are the positive roots x = ω².
fn axis_pairs(even: &Polynomial) -> Vec<(usize, usize)> {
    let half = even.degree() / 2;
    let signed = |k: usize| if k % 2 == 1 { -even.coefficient(2 * k) } else { even.coefficient(2 * k) };
    let in_x = Polynomial::new((0..=half).rev().map(signed).collect());
    let factors = in_x.square_free();
    let counted = factors.into_iter().map(|(factor, multiplicity)| {
        let chain = sturm_chain(&factor, &factor.derivative());
        let positive = sign_changes(&chain, at_zero) - sign_changes(&chain, at_plus_infinity);
        (positive.max(0) as usize, multiplicity)
    });
    counted.filter(|&(pairs, _)| pairs > 0).collect()
}

/// Roots in the right half-plane of a polynomial that shares nothing with its mirror image.
///
/// On the axis p(jω) = U(ω) + jV(ω); as ω runs from −∞ to ∞ its angle grows by π for every root on the left and falls
/// by π for every root on the right, and the Cauchy index of V/U (n even) or U/V (n odd) counts these half turns.
/// Source: Gantmacher, *The Theory of Matrices* 2, ch. XV §3.
fn right_of_regular(p: &Polynomial) -> usize {
    let n = p.degree();
    if n == 0 {
        return 0;
    }
    // jᵏ is 1, j, −1, −j.
    let part = |parity: usize| {
        let coefficient = |k: usize| match (k % 2 == parity, k % 4 >= 2) {
            (false, _) => Rational::ZERO,
            (true, false) => p.coefficient(k),
            (true, true) => -p.coefficient(k),
        };
        Polynomial::new((0..=n).rev().map(coefficient).collect())
    };
    let (of_degree_n, other) = (part(n % 2), part(1 - n % 2));
    let chain = sturm_chain(&of_degree_n, &other);
    let index = sign_changes(&chain, at_minus_infinity) - sign_changes(&chain, at_plus_infinity);
    let left_less_right = if n.is_multiple_of(2) { -index } else { index };
    (n as isize - left_less_right).max(0) as usize / 2
}

/// a, b, and from there the negative remainder of the two before; all times positive factors that leave small integers,
/// highest power first.
fn sturm_chain(a: &Polynomial, b: &Polynomial) -> Vec<Vec<IBig>> {
    let mut chain = vec![a.primitive()];
    let mut next = b.primitive();
    while !next.is_empty() {
        let rest = chain.last().map(|last| negative_remainder(last, &next)).unwrap_or_default();
        chain.push(next);
        next = rest;
    }
    chain
}

/// −(a mod b) times a positive factor; empty for zero. `b` must not be zero.
fn negative_remainder(a: &[IBig], b: &[IBig]) -> Vec<IBig> {
    let mut rest = a.to_vec();
    let b_is_negative = b[0] < IBig::ZERO;
    for i in 0..(a.len() + 1).saturating_sub(b.len()) {
        if rest[i] == IBig::ZERO {
            continue;
        }
        let shared = IBig::from((&rest[i]).gcd(&b[0]));
        let shared = if b_is_negative { -shared } else { shared };
        let (keep, take) = (&b[0] / &shared, &rest[i] / &shared);
        for (k, value) in rest[i..].iter_mut().enumerate() {
            *value *= &keep;
            if let Some(other) = b.get(k) {
                *value -= &take * other;
            }
        }
    }
    let rest = rest.into_iter().rev().take(b.len() - 1).map(|c| Rational::from(-c));
    let mut rest: Vec<Rational> = rest.collect();
    rest.reverse();
    Polynomial::new(rest).primitive()
}

fn sign_changes(chain: &[Vec<IBig>], sign: fn(&[IBig]) -> i8) -> isize {
    let signs: Vec<i8> = chain.iter().map(|p| sign(p)).filter(|&s| s != 0).collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count() as isize
}

fn at_zero(p: &[IBig]) -> i8 {
    p.last().map_or(0, sign_of)
}

fn at_plus_infinity(p: &[IBig]) -> i8 {
    p.first().map_or(0, sign_of)
}

fn at_minus_infinity(p: &[IBig]) -> i8 {
    if p.len().is_multiple_of(2) { -at_plus_infinity(p) } else { at_plus_infinity(p) }
}

fn sign_of(value: &IBig) -> i8 {
    match value.cmp(&IBig::ZERO) {
        std::cmp::Ordering::Less => -1,
        std::cmp::Ordering::Equal => 0,
        std::cmp::Ordering::Greater => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::Stability::{AsymptoticallyStable, MarginallyStable, Unstable};
    use super::*;
    use crate::lti::tests::polynomial;

    #[track_caller]
    fn check(what: &str, coefficients: &str, verdict: Stability, right: usize) {
        let p = polynomial(coefficients);
        assert_eq!(stability(&p), verdict, "{what}");
        assert_eq!(right_half_plane_roots(&p), right, "{what}: roots on the right");
        let mirrored = right_half_plane_roots(&p.mirror());
        assert!(right + mirrored <= p.degree(), "{what}: more roots than its degree");
        assert_eq!(stability(&-&p), verdict, "{what}: the sign makes no difference");
    }

    #[test]
    fn textbook_table() {
        check("no dynamics", "5", AsymptoticallyStable, 0);
        check("first order", "1 3", AsymptoticallyStable, 0);
        check("first order, right", "1 -3", Unstable, 1);
        check("damped oscillator", "1 2 5", AsymptoticallyStable, 0);
        check("undamped oscillator", "1 0 4", MarginallyStable, 0);
        check("integrator", "1 0", MarginallyStable, 0);
        check("double integrator", "1 0 0", Unstable, 0);
        check("integrator and decay", "1 1 0", MarginallyStable, 0);
        check("integrator and oscillator", "1 0 4 0", MarginallyStable, 0);
        check("double integrator and oscillator", "1 0 1 0 0", Unstable, 0);
        check("triple integrator", "1 0 0 0", Unstable, 0);
        check("saddle", "1 0 -4", Unstable, 1);
        check("double imaginary pair", "1 0 2 0 1", Unstable, 0);
        check("two different imaginary pairs", "1 0 5 0 4", MarginallyStable, 0);
        check("double pair and decay", "1 1 2 2 1 1", Unstable, 0);
        check("s^4 + 1: symmetric about both axes", "1 0 0 0 1", Unstable, 2);
        check("s^8 - 1", "1 0 0 0 0 0 0 0 -1", Unstable, 3);
        check("(s + 1)^10", "1 10 45 120 210 252 210 120 45 10 1", AsymptoticallyStable, 0);
        check("hanging pendulum", "0.0132 0.0024 0.41202 0.05886", AsymptoticallyStable, 0);
        check("upright pendulum", "0.0132 0.0024 -0.41202 -0.05886", Unstable, 1);
        check("upright, whole state", "0.0132 0.0024 -0.41202 -0.05886 0", Unstable, 1);
    }

    #[test]
    fn special_rows_of_the_routh_array() {
        // Nise, *Control Systems Engineering*, examples 6.1, 6.2, 6.4, 6.5; Ogata, *Modern Control Engineering*, 5-6.
        check("Nise 6.1", "1 10 31 1030", Unstable, 2);
        check("Nise 6.2: zero in the first column", "1 2 3 6 5 3", Unstable, 2);
        check("Nise 6.4: a row of zeros", "1 7 6 42 8 56", MarginallyStable, 0);
        check("Nise 6.5: a row of zeros, degree 8", "1 1 12 22 39 59 48 38 20", Unstable, 2);
        check("Dorf: zero in the first column", "1 2 2 4 11 10", Unstable, 2);
        check("Ogata: zero in the first column", "1 2 1 2", MarginallyStable, 0);
        check("Ogata: a row of zeros", "1 2 24 48 -25 -50", Unstable, 1);
        check("third row starts with zero", "1 1 1 1 1", Unstable, 2);
        check("two degrees drop at once", "1 0 0 1", Unstable, 2);
        check("four degrees drop at once", "1 0 0 0 0 1", Unstable, 2);
    }

    #[test]
    fn close_calls_are_decided_exactly() {
        check("just left of the axis", "1 0.000000000000000000000000000001 1", AsymptoticallyStable, 0);
        check("just right of it", "1 -0.000000000000000000000000000001 1", Unstable, 2);
        check("on the edge of Routh", "1 2 3 6", MarginallyStable, 0);
        check("a hair inside", "1 2 3 5.99999999999999999999", AsymptoticallyStable, 0);
        check("a hair outside", "1 2 3 6.00000000000000000001", Unstable, 2);
        check("sizes far apart", "1e-300 1 1e300", AsymptoticallyStable, 0);
    }

    #[test]
    fn counts_of_products_add_up() {
        // (s − 1)^a (s + 2)^b (s² + 9)^c (s² − s + 4)^d has a + 2d roots on the right.
        let factors = [[1, -1, 0], [1, 2, 0], [1, 0, 9], [1, -1, 4]];
        for mask in 0..81_usize {
            let powers = [mask % 3, mask / 3 % 3, mask / 9 % 3, mask / 27];
            let mut p = Polynomial::one();
            for (k, &power) in powers.iter().enumerate() {
                let width = if k < 2 { 2 } else { 3 };
                for _ in 0..power {
                    p = &p * &Polynomial::from_integers(&factors[k][..width]);
                }
            }
            let right = powers[0] + 2 * powers[3];
            assert_eq!(right_half_plane_roots(&p), right, "powers {powers:?}");
            let expected = match (right, powers[2]) {
                (0, 0) => AsymptoticallyStable,
                (0, 1) => MarginallyStable,
                _ => Unstable,
            };
            assert_eq!(stability(&p), expected, "powers {powers:?}");
        }
    }
}
