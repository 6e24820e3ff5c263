use super::search;
use crate::algebra::{Polynomial, Rational};
use dashu_int::IBig;

/// A real number that rounding leaves open: anything within `rounding` of `value`, just `value` when that is zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rounded {
    pub value: Rational,
    pub rounding: Rational,
    /// What was expected in its place: the search begins there too.
    pub expected: f64,
}

/// One or two roots, with what rounding leaves open.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RoundedRoot {
    Real(Rounded),
    /// re ± im·j
    Pair(Rounded, Rounded),
}

/// One or two roots, exactly.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Root {
    Real(Rational),
    /// re ± im·j
    Pair(Rational, Rational),
}

/// The largest relative change of a coefficient of `denominator` that turns its roots into ones that round to `roots`;
/// `None` when more than `tolerance` would be needed. Both polynomials are known up to a factor only, which gives way.
///
/// A coefficient that is zero has to stay zero, but for a thousandth of `tolerance` of the products it is the sum of.
/// Accuracy: what is returned is proved: floating point only looks for the roots, their polynomial is compared exactly.
/// It is not the smallest change, but within about a hundredth of `tolerance` of it. An answer at the very edge of
/// `tolerance` may be missed, never made up.
/// Work: bounded for any input, O(n³) for each of at most 300 steps.
/// Source: J. H. Wilkinson, *Rounding Errors in Algebraic Processes*, ch. 2: roots as those of a neighbouring polynomial.
pub(super) fn backward_error(
    denominator: &Polynomial,
    roots: &[RoundedRoot],
    tolerance: &Rational,
) -> Option<Rational> {
    let count =
        roots.iter().map(|root| if matches!(root, RoundedRoot::Real(_)) { 1 } else { 2 }).sum::<usize>();
    if count == 0 || count != denominator.degree() || *tolerance <= Rational::ZERO {
        return None;
    }
    let residue = tolerance / Rational::from(RESIDUE);
    let proved =
        |candidate: &Vec<Root>| change(denominator, candidate, &residue).filter(|change| change <= tolerance);
    search::candidates(denominator, roots, tolerance).iter().find_map(proved)
}

/// A coefficient expected to be zero may be a residue: at most this part of the tolerance, of the sum of the sizes of the
/// products it consists of.
pub(super) const RESIDUE: u16 = 1_000;

/// The largest relative change of a coefficient from `denominator` to the polynomial with these roots, for the scale that
/// makes it smallest: (M − m)/(M + m) with M and m the largest and smallest ratio of two coefficients.
///
/// `None` when a sign differs, or a coefficient is zero in one and not in the other, apart from a `residue` of the products
/// it is the sum of.
fn change(denominator: &Polynomial, roots: &[Root], residue: &Rational) -> Option<Rational> {
    let mut wanted = denominator.primitive();
    if wanted.first()? < &IBig::ZERO {
        wanted = wanted.into_iter().map(|coefficient| -coefficient).collect();
    }
    let got = product(roots, factor);
    let sizes = product(roots, factor_of_sizes);
    if got.len() != wanted.len() {
        return None;
    }
    let mut smallest: Option<(&IBig, &IBig)> = None;
    let mut largest = smallest;
    for ((got, wanted), size) in got.iter().zip(&wanted).zip(&sizes) {
        if *wanted == IBig::ZERO {
            if magnitude(got) * IBig::from(residue.denominator().clone()) > size * residue.numerator() {
                return None;
            }
            continue;
        }
        if *got == IBig::ZERO || (*got < IBig::ZERO) != (*wanted < IBig::ZERO) {
            return None;
        }
        // got/wanted is positive, so a quotient is less than another when the cross product is.
        let less = |a: (&IBig, &IBig), b: (&IBig, &IBig)| {
            magnitude(a.0) * magnitude(b.1) < magnitude(b.0) * magnitude(a.1)
        };
        let this = (got, wanted);
        if smallest.is_none_or(|known| less(this, known)) {
            smallest = Some(this);
        }
        if largest.is_none_or(|known| less(known, this)) {
            largest = Some(this);
        }
    }
    let (low, high) = (smallest?, largest?);
    let high_over = magnitude(high.0) * magnitude(low.1);
    let low_over = magnitude(low.0) * magnitude(high.1);
    Some(Rational::from(&high_over - &low_over) / Rational::from(high_over + low_over))
}

/// Whole coefficients of the product, highest power first; the scale is whatever clears the fractions.
fn product(roots: &[Root], factor: impl Fn(&Root) -> Vec<IBig>) -> Vec<IBig> {
    roots.iter().fold(vec![IBig::ONE], |product, root| {
        let factor = factor(root);
        let mut next = vec![IBig::ZERO; product.len() + factor.len() - 1];
        for (i, a) in product.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                next[i + j] += a * b;
            }
        }
        next
    })
}

/// q·s − a for a/q; q²·s² − 2aq·s + a² + b² for a/q ± b/q·j.
fn factor(root: &Root) -> Vec<IBig> {
    match root {
        Root::Real(value) => vec![IBig::from(value.denominator().clone()), -value.numerator().clone()],
        Root::Pair(re, im) => {
            let (a, b, q) = over_one_denominator(re, im);
            vec![&q * &q, IBig::from(-2) * &a * &q, &a * &a + &b * &b]
        }
    }
}

/// As [`factor`], to the same scale, for a root of no larger size on the negative real axis: no sum in it cancels.
fn factor_of_sizes(root: &Root) -> Vec<IBig> {
    match root {
        Root::Real(value) => vec![IBig::from(value.denominator().clone()), magnitude(value.numerator())],
        Root::Pair(re, im) => {
            let (a, b, q) = over_one_denominator(re, im);
            let size = magnitude(&a).max(magnitude(&b));
            vec![&q * &q, IBig::from(2) * &size * &q, &size * &size]
        }
    }
}

fn over_one_denominator(re: &Rational, im: &Rational) -> (IBig, IBig, IBig) {
    let (p, q) = (IBig::from(re.denominator().clone()), IBig::from(im.denominator().clone()));
    (re.numerator() * &q, im.numerator() * &p, p * q)
}

fn magnitude(value: &IBig) -> IBig {
    if *value < IBig::ZERO { -value } else { value.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;

    fn number(text: &str) -> Rational {
        parse_decimal(text).unwrap()
    }

    fn polynomial(text: &str) -> Polynomial {
        Polynomial::new(text.split_whitespace().map(number).collect())
    }

    /// `-1 -2±3`: a real root and a pair.
    fn roots(text: &str) -> Vec<Root> {
        let one = |text: &str| match text.split_once('±') {
            Some((re, im)) => Root::Pair(number(re), number(im)),
            None => Root::Real(number(text)),
        };
        text.split_whitespace().map(one).collect()
    }

    #[test]
    fn the_change_is_exact() {
        let residue = number("0.000005");
        for (denominator, text, want) in [
            // coefficients, roots, (M − m)/(M + m) of the ratios of coefficients
            ("1 3 2", "-1 -2", Some((0, 1))),
            ("-2 -6 -4", "-2 -1", Some((0, 1))),
            ("1 2 5", "-1±2", Some((0, 1))),
            ("0.5 1 2.5", "-1±2", Some((0, 1))),
            // s² + 2s + 5 and s² + 2s + 4: ratios 1, 1, 5/4
            ("1 2 4", "-1±2", Some((1, 9))),
            ("1 2 6", "-1±2", Some((1, 11))),
            // s² + 5s + 6: ratios 1, 5/4, 2
            ("1 4 3", "-2 -3", Some((1, 3))),
            ("1 3 2", "-1 2", None),
            ("1 3 2", "-1", None),
            ("1 0 4", "0±2", Some((0, 1))),
            // s² + 2as + 4 + a², with 2a at most 5e-6 · 2 · 2: ratios 1 and 1 + a²/4
            ("1 0 4", "-0.00001±2", Some((1, 80_000_000_001))),
            ("1 0 4", "-0.000011±2", None),
            ("1 1 4", "0±2", None),
            ("1 3 0", "-3 0", Some((0, 1))),
            ("1 3 2", "-3 0", None),
        ] {
            let want = want.map(|(over, under): (i64, i64)| Rational::from(over) / Rational::from(under));
            let got = change(&polynomial(denominator), &roots(text), &residue);
            assert_eq!(got, want, "{denominator}: {text}");
        }
    }

    #[test]
    fn what_rounding_leaves_open_is_used_and_no_more() {
        // s² + 2s + c: roots −1 ± √(1 − c). Each is typed to hundredths, so that c may be from 1 − 0.105² to 1 − 0.095².
        let typed = |re: &str, rounding: &str| {
            RoundedRoot::Real(Rounded { value: number(re), rounding: number(rounding), expected: f64::NAN })
        };
        let far = [typed("-1.1", "0.005"), typed("-0.9", "0.005")];
        for (denominator, tolerance, found) in [
            ("1 2 0.99", "0.0001", true),
            ("1 2 0.9890", "0.0001", true),
            ("1 2 0.9909", "0.0001", true),
            ("1 2 0.98", "0.001", false),
            ("1 2 0.98", "0.005", true),
            ("1 2 1", "0.001", false),
            ("1 2 1", "0.005", true),
            ("1 2 0.99", "0", false),
        ] {
            let got = backward_error(&polynomial(denominator), &far, &number(tolerance));
            assert_eq!(got.is_some(), found, "{denominator}, {tolerance}: {got:?}");
            assert!(got.is_none_or(|change| change <= number(tolerance)));
        }
        let exact = [typed("-1.1", "0"), typed("-0.9", "0")];
        assert!(backward_error(&polynomial("1 2 0.99"), &exact, &number("0.0001")).is_some());
        assert!(backward_error(&polynomial("1 2 0.9902"), &exact, &number("0.0001")).is_none());
    }
}
