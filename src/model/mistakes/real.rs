/// A polynomial in `f64`, lowest power first; what is nothing but rounding is exactly 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealPolynomial {
    coefficients: [f64; ROOM],
    /// Degree + 1; 0 for zero.
    length: usize,
}

/// Numerator and denominator in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealFunction {
    pub num: RealPolynomial,
    pub den: RealPolynomial,
}

/// Coefficients of the longest polynomial: two for each of the most coordinates, one more, and what is done afterwards.
const ROOM: usize = 2 * MOST_COORDINATES + 4;

/// Beyond these the determinant is not worked out here.
pub(super) const MOST_COORDINATES: usize = 8;

/// Of the sum of the sizes of what was added up: below it, a sum is 0.
const ROUNDING: f64 = 1e-11;

/// An entry of the matrix, lowest power first.
pub(super) type Entry = [f64; 3];

impl RealPolynomial {
    const ZERO: Self = Self { coefficients: [0.0; ROOM], length: 0 };

    /// Lowest power first.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..self.length]
    }

    pub fn is_zero(&self) -> bool {
        self.length == 0
    }

    pub fn from_exact(polynomial: &crate::algebra::Polynomial) -> Option<Self> {
        let values = polynomial.to_f64();
        let mut own = Self::ZERO;
        for (target, value) in own.coefficients.get_mut(..values.len())?.iter_mut().zip(values.iter().rev()) {
            *target = *value;
        }
        own.length = values.len();
        Some(own)
    }

    pub fn trailing_zeros(&self) -> usize {
        self.coefficients().iter().take_while(|c| **c == 0.0).count()
    }

    pub(super) fn negated(mut self) -> Self {
        self.coefficients.iter_mut().for_each(|c| *c = -*c);
        self
    }

    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.coefficients.iter_mut().for_each(|c| *c *= factor);
        self
    }

    /// Times s; `None` when there is no room.
    pub(super) fn times_s(mut self) -> Option<Self> {
        if self.length == ROOM {
            return None;
        }
        self.coefficients.rotate_right(1);
        self.length += usize::from(self.length > 0);
        Some(self)
    }

    /// Without its lowest coefficients.
    pub(super) fn shortened(mut self, by: usize) -> Self {
        let by = by.min(self.length);
        self.coefficients[..by].fill(0.0);
        self.coefficients.rotate_left(by);
        self.length -= by;
        self
    }

    fn trimmed(mut self) -> Self {
        self.length = self.coefficients.iter().rposition(|c| *c != 0.0).map_or(0, |last| last + 1);
        self
    }

    /// Quotient and remainder, each coefficient of the remainder 0 when only rounding is left of it.
    fn divided(&self, divisor: &Self) -> Option<(Self, Self)> {
        let lead = *divisor.coefficients().last()?;
        let (mut rest, mut quotient) = (*self, Self::ZERO);
        let mut sizes = self.coefficients.map(f64::abs);
        for shift in (0..(self.length + 1).saturating_sub(divisor.length)).rev() {
            let top = shift + divisor.length - 1;
            let factor = rest.coefficients[top] / lead;
            quotient.coefficients[shift] = factor;
            for (place, c) in divisor.coefficients().iter().enumerate() {
                rest.coefficients[shift + place] -= factor * c;
                sizes[shift + place] += (factor * c).abs();
            }
            rest.coefficients[top] = 0.0;
        }
        for (c, size) in rest.coefficients.iter_mut().zip(sizes) {
            // Less strict than elsewhere: the divisor may be a remainder itself.
            if c.abs() <= 100.0 * ROUNDING * size {
                *c = 0.0;
            }
        }
        Some((quotient.trimmed(), rest.trimmed()))
    }
}

impl RealFunction {
    /// Without the power of s that numerator and denominator share.
    pub fn without_shared_s(self) -> Self {
        let shared = self.num.trailing_zeros().min(self.den.trailing_zeros());
        Self { num: self.num.shortened(shared), den: self.den.shortened(shared) }
    }

    /// Without any common factor; `None` when there is none but powers of s.
    pub fn cancelled(&self) -> Option<Self> {
        let short = self.without_shared_s();
        // A power of s that only one of them has is no matter for the other.
        let bare = |p: RealPolynomial| p.shortened(p.trailing_zeros());
        let (mut a, mut b) = (bare(short.num), bare(short.den));
        if a.length < 2 || b.length < 2 {
            return None;
        }
        while !b.is_zero() {
            let rest = a.divided(&b)?.1;
            a = b;
            b = rest;
        }
        if a.length < 2 {
            return None;
        }
        let a = a.scaled(1.0 / a.coefficients().last()?);
        Some(Self { num: short.num.divided(&a)?.0, den: short.den.divided(&a)?.0 })
    }
}

/// Coefficients as sums, with the sizes of what was added up: only beside them can 0 be told from rounding.
#[derive(Clone, Copy)]
struct Sums {
    values: [f64; ROOM],
    sizes: [f64; ROOM],
    length: usize,
}

impl Sums {
    const ZERO: Self = Self { values: [0.0; ROOM], sizes: [0.0; ROOM], length: 0 };

    fn of(entry: &Entry, size: &Entry) -> Self {
        let mut own = Self { length: 3, ..Self::ZERO };
        own.values[..3].copy_from_slice(entry);
        own.sizes[..3].copy_from_slice(size);
        own
    }

    /// Plus or minus an entry times a polynomial.
    fn add_product(&mut self, entry: &Entry, size: &Entry, other: &Self, sign: f64) {
        for (i, (a, a_size)) in entry.iter().zip(size).enumerate().filter(|(_, (_, size))| **size != 0.0) {
            for k in 0..other.length.min(ROOM - i) {
                self.values[i + k] += sign * a * other.values[k];
                self.sizes[i + k] += a_size * other.sizes[k];
            }
        }
        self.length = self.length.max((other.length + 2).min(ROOM));
    }

    fn polynomial(&self) -> RealPolynomial {
        let mut own = RealPolynomial::ZERO;
        for (target, (value, size)) in own.coefficients.iter_mut().zip(self.values.iter().zip(&self.sizes)) {
            if value.abs() > ROUNDING * size {
                *target = *value;
            }
        }
        own.trimmed()
    }
}

/// The determinant of an n×n matrix of polynomials, n at most [`MOST_COORDINATES`]; entries with the sizes of their summands.
pub(super) fn determinant(n: usize, entry: &dyn Fn(usize, usize) -> (Entry, Entry)) -> RealPolynomial {
    if n == 2 {
        let ((a, a_size), (d, d_size)) = (entry(0, 0), entry(1, 1));
        let ((b, b_size), (c, c_size)) = (entry(0, 1), entry(1, 0));
        let mut sum = Sums::ZERO;
        sum.add_product(&a, &a_size, &Sums::of(&d, &d_size), 1.0);
        sum.add_product(&b, &b_size, &Sums::of(&c, &c_size), -1.0);
        return sum.polynomial();
    }
    // By the first rows: the determinant of as many of them as there are columns in each set.
    let mut minors = vec![Sums::ZERO; 1 << n];
    minors[0].values[0] = 1.0;
    minors[0].sizes[0] = 1.0;
    minors[0].length = 1;
    for set in 1usize..1 << n {
        let row = set.count_ones() as usize - 1;
        let mut sum = Sums::ZERO;
        for column in (0..n).filter(|column| set & (1 << column) != 0) {
            let after = (set >> (column + 1)).count_ones();
            let (value, size) = entry(row, column);
            let sign = if after % 2 == 0 { 1.0 } else { -1.0 };
            let minor = minors[set & !(1 << column)];
            sum.add_product(&value, &size, &minor, sign);
        }
        minors[set] = sum;
    }
    minors[(1 << n) - 1].polynomial()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lowest power first.
    fn polynomial(coefficients: &[f64]) -> RealPolynomial {
        let mut own = RealPolynomial::ZERO;
        own.coefficients[..coefficients.len()].copy_from_slice(coefficients);
        own.trimmed()
    }

    #[test]
    fn determinants() {
        #[track_caller]
        fn check(rows: &[&[&[f64]]], expected: &[f64]) {
            let entry = |row: usize, column: usize| {
                let mut entry = Entry::default();
                entry[..rows[row][column].len()].copy_from_slice(rows[row][column]);
                (entry, entry.map(f64::abs))
            };
            assert_eq!(determinant(rows.len(), &entry).coefficients(), expected, "{rows:?}");
        }
        check(&[&[&[2.0, 1.0]]], &[2.0, 1.0]);
        check(&[&[&[0.0, 1.0], &[1.0]], &[&[2.0], &[1.0, 1.0]]], &[-2.0, 1.0, 1.0]);
        check(&[&[&[0.1, 0.3], &[0.2]], &[&[0.15, 0.45], &[0.3]]], &[]);
        // The characteristic polynomial of a companion matrix: s³ + 6 s² + 11 s + 6.
        let s = &[0.0, 1.0][..];
        check(
            &[&[s, &[-1.0], &[]], &[&[], s, &[-1.0]], &[&[6.0], &[11.0], &[6.0, 1.0]]],
            &[6.0, 11.0, 6.0, 1.0],
        );
    }

    #[test]
    fn shared_factors() {
        #[track_caller]
        fn check(num: &[f64], den: &[f64], cancelled: Option<(&[f64], &[f64])>) {
            let found = RealFunction { num: polynomial(num), den: polynomial(den) }.cancelled();
            let found = found.map(|f| (f.num.coefficients().to_vec(), f.den.coefficients().to_vec()));
            let near = |a: &[f64], b: &[f64]| {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
            };
            let alike = match (&found, cancelled) {
                (Some((a, b)), Some((c, d))) => near(a, c) && near(b, d),
                (None, None) => true,
                _ => false,
            };
            assert!(alike, "{num:?} / {den:?}: {found:?}");
        }
        // (s + 0.3)(s + 2) / s (s + 0.3)(s + 5)
        check(&[0.6, 2.3, 1.0], &[0.0, 1.5, 5.3, 1.0], Some((&[2.0, 1.0], &[0.0, 5.0, 1.0])));
        check(&[0.0, 0.0, 1.0], &[0.0, 1.5, 5.3, 1.0], None);
        check(&[0.6, 2.3, 1.0], &[0.0, 1.6, 5.3, 1.0], None);
        check(&[3.0], &[1.0, 2.0], None);
    }
}
