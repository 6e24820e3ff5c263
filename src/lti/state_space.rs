use super::TransferFunction;
use crate::algebra::{Matrix, Polynomial, Rational};

/// ẋ = a x + b u, y = c x + d u; a n×n, b n×m, c p×n, d p×m, exact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateSpace {
    pub a: Matrix,
    pub b: Matrix,
    pub c: Matrix,
    pub d: Matrix,
}

impl StateSpace {
    /// det(sI − a): monic, degree n; its roots are the eigenvalues of the whole state.
    ///
    /// Exact. Source: Faddeev–LeVerrier; Gantmacher, *The Theory of Matrices* 1, ch. IV §5.
    pub fn characteristic_polynomial(&self) -> Polynomial {
        self.resolvent(|_| ())
    }

    /// From the first input to the first output, over the characteristic polynomial: nothing is cancelled.
    ///
    /// Exact. An input or output that is not there contributes zero.
    pub fn transfer_function(&self) -> TransferFunction {
        let mut markov = Vec::new();
        let den = self.resolvent(|adjugate| markov.push(self.seen_from_outside(adjugate)));
        let through = self.d.rows.first().and_then(|row| row.first()).cloned().unwrap_or_default();
        let num = &Polynomial::new(markov) + &den.scale(&through);
        TransferFunction { num, den }
    }

    /// The characteristic polynomial; `visit` is shown the matrix coefficients of adj(sI − a), highest power first.
    fn resolvent(&self, mut visit: impl FnMut(&Matrix)) -> Polynomial {
        let n = self.a.row_count();
        let mut coefficients = vec![Rational::ONE];
        let mut adjugate = Matrix::identity(n);
        for k in 1..=n {
            visit(&adjugate);
            let product = self.a.mul(&adjugate).unwrap_or_else(|| Matrix::zeros(n, n));
            let coefficient = -(product.trace() / Rational::from(k));
            adjugate = product;
            for (i, row) in adjugate.rows.iter_mut().enumerate() {
                row[i] += &coefficient;
            }
            coefficients.push(coefficient);
        }
        Polynomial::new(coefficients)
    }

    /// c · m · b for the first output and the first input.
    fn seen_from_outside(&self, m: &Matrix) -> Rational {
        let product = self.c.mul(m).and_then(|row| row.mul(&self.b));
        product.and_then(|p| p.rows.first()?.first().cloned()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::lti::tests::polynomial;

    /// Rows separated by `;`.
    fn matrix(text: &str) -> Matrix {
        let row = |line: &str| line.split_whitespace().map(|t| parse_decimal(t).unwrap()).collect();
        Matrix { rows: text.split(';').map(row).collect() }
    }

    #[track_caller]
    fn check(what: &str, [a, b, c, d]: [&str; 4], num: &str, den: &str) {
        let system = StateSpace { a: matrix(a), b: matrix(b), c: matrix(c), d: matrix(d) };
        let g = system.transfer_function();
        assert_eq!(g.num, polynomial(num), "{what}: numerator");
        assert_eq!(g.den, polynomial(den), "{what}: denominator");
        assert_eq!(system.characteristic_polynomial(), polynomial(den), "{what}: characteristic polynomial");
    }

    #[test]
    fn by_hand() {
        check("integrator", ["0", "1", "1", "0"], "1", "1 0");
        check("first order with feed-through", ["-2", "3", "5", "7"], "7 29", "1 2");
        check("mass and spring", ["0 1; -4 0", "0; 1", "1 0", "0"], "1", "1 0 4");
        check("hidden mode is not cancelled", ["-1 0; 0 -2", "1; 0", "1 1", "0"], "1 2", "1 3 2");
        check("triangular, decimals", ["-0.5 1; 0 -0.25", "0; 1", "1 0", "0"], "1", "1 0.75 0.125");
        // Controllable canonical form reads off its own transfer function.
        check("companion", ["0 1 0; 0 0 1; -6 -11 -6", "0; 0; 1", "5 4 3", "0"], "3 4 5", "1 6 11 6");
    }

    #[test]
    fn hanging_pendulum() {
        // From [M + m, ml; ml, I + ml²] times accelerations, solved by hand (determinant 0.0132):
        // x″ = (−0.0024 x′ + 0.035316 θ + 0.024 F)/0.0132, θ″ = (0.006 x′ − 0.41202 θ − 0.06 F)/0.0132.
        let rows = |scale: &str| scale.split(' ').map(|t| parse_decimal(t).unwrap()).collect::<Vec<_>>();
        let inertia = parse_decimal("0.0132").unwrap();
        let divided = |text: &str| rows(text).into_iter().map(|v| v / &inertia).collect::<Vec<_>>();
        let system = StateSpace {
            a: Matrix {
                rows: vec![
                    rows("0 0 1 0"),
                    rows("0 0 0 1"),
                    divided("0 0.035316 -0.0024 0"),
                    divided("0 -0.41202 0.006 0"),
                ],
            },
            b: Matrix { rows: [rows("0"), rows("0"), divided("0.024"), divided("-0.06")].to_vec() },
            c: matrix("0 1 0 0"),
            d: matrix("0"),
        };
        let expected =
            TransferFunction { num: polynomial("-0.06 0"), den: polynomial("0.0132 0.0024 0.41202 0.05886") };
        assert!(system.transfer_function().equals(&expected));
        assert_eq!(system.characteristic_polynomial().trailing_zeros(), 1);
    }
}
