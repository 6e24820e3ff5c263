use dashu_int::IBig;

/// Whether integer polynomials (highest power first) are seen to have no common factor, by looking at them modulo a prime.
///
/// `true` is a proof; `false` says nothing. Takes O(degree²) word operations however long the coefficients are.
/// Source: a common factor survives reduction modulo a prime that does not divide the leading coefficients;
/// Knuth, *TAOCP* 2, 4.6.1.
pub(super) fn surely_coprime(a: &[IBig], b: &[IBig]) -> bool {
    let (mut a, mut b) = (reduce(a), reduce(b));
    if a.first().is_none_or(|&lead| lead == 0) || b.first().is_none_or(|&lead| lead == 0) {
        return false;
    }
    while b.len() > 1 {
        let rest = remainder(a, &b);
        a = b;
        b = rest;
    }
    !b.is_empty()
}

/// 2⁶¹ − 1.
const PRIME: u64 = (1 << 61) - 1;

fn reduce(p: &[IBig]) -> Vec<u64> {
    let prime = IBig::from(PRIME);
    p.iter().map(|c| u64::try_from(((c % &prime) + &prime) % &prime).unwrap_or(0)).collect()
}

/// The remainder of `a` by `b`, whose leading coefficient is not 0; without leading zeros.
fn remainder(mut a: Vec<u64>, b: &[u64]) -> Vec<u64> {
    let inverse = power(b[0], PRIME - 2);
    let steps = (a.len() + 1).saturating_sub(b.len());
    for i in 0..steps {
        let factor = times(a[i], inverse);
        for (target, &value) in a[i..].iter_mut().zip(b) {
            *target = (*target + PRIME - times(factor, value)) % PRIME;
        }
    }
    a.into_iter().skip(steps).skip_while(|&c| c == 0).collect()
}

fn times(x: u64, y: u64) -> u64 {
    (u128::from(x) * u128::from(y) % u128::from(PRIME)) as u64
}

/// Source: Fermat; x^(p − 2) is 1/x.
fn power(mut x: u64, mut exponent: u64) -> u64 {
    let mut product = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            product = times(product, x);
        }
        x = times(x, x);
        exponent >>= 1;
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &[i64], &[i64], bool)]) {
        let p = |c: &[i64]| c.iter().map(|&c| IBig::from(c)).collect::<Vec<_>>();
        for (name, a, b, expected) in rows {
            assert_eq!(surely_coprime(&p(a), &p(b)), *expected, "{name}");
            assert_eq!(surely_coprime(&p(b), &p(a)), *expected, "{name}, turned round");
        }
    }

    #[test]
    fn only_a_proof_counts() {
        check(&[
            ("different roots", &[1, 2], &[1, 3], true),
            ("a shared root", &[1, 3, 2], &[1, 4, 3], false),
            ("a constant", &[1, 3, 2], &[-5], true),
            ("zero", &[1, 3, 2], &[], false),
            ("the prime hides the degree", &[PRIME as i64, 1], &[1, 3], false),
            ("they meet only modulo the prime", &[1, PRIME as i64 + 2], &[1, 2], false),
        ]);
    }
}
