use super::{Pole, RootError, roots};
use crate::algebra::{Polynomial, polynomial_mathml, polynomial_text};

/// `num` over `den` in s, exact; nothing is cancelled unasked. `den` is never zero.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct TransferFunction {
    pub num: Polynomial,
    pub den: Polynomial,
}

impl TransferFunction {
    /// `None` when `den` is zero.
    pub fn new(num: Polynomial, den: Polynomial) -> Option<Self> {
        if den.is_zero() { None } else { Some(Self { num, den }) }
    }

    /// Without the common factor of numerator and denominator, and that factor (monic, 1 when there is none).
    ///
    /// The quotient keeps the size of the coefficients: (2s² + 2s)/(4s² + 8s) gives (2s + 2)/(4s + 8) and s.
    pub fn cancelled(&self) -> (Self, Polynomial) {
        let shared = self.num.gcd(&self.den);
        let num = self.num.exact_quotient(&shared);
        let den = self.den.exact_quotient(&shared);
        (Self { num, den }, shared)
    }

    /// Numerator and denominator divided by the denominator's leading coefficient.
    pub fn monic(&self) -> Self {
        match self.den.leading() {
            Some(lead) => {
                let factor = crate::algebra::Rational::ONE / lead;
                Self { num: self.num.scale(&factor), den: self.den.scale(&factor) }
            }
            None => self.clone(),
        }
    }

    /// Whether both are the same function of s, exactly: a common factor makes no difference.
    pub fn equals(&self, other: &Self) -> bool {
        &self.num * &other.den == &other.num * &self.den
    }

    /// The roots of the denominator as written, in rad/s; those of [`cancelled`](Self::cancelled) are the poles proper.
    ///
    /// Accuracy and errors: [`roots`].
    pub fn poles(&self) -> Result<Vec<Pole>, RootError> {
        roots(&self.den)
    }

    /// The roots of the numerator as written, in rad/s; none for the zero function.
    ///
    /// Accuracy and errors: [`roots`].
    pub fn zeros(&self) -> Result<Vec<Pole>, RootError> {
        if self.num.is_zero() { Ok(Vec::new()) } else { roots(&self.num) }
    }

    /// Degree of the denominator less that of the numerator; negative when improper.
    pub fn relative_degree(&self) -> isize {
        self.den.degree() as isize - self.num.degree() as isize
    }

    /// `-0.06s / (0.0132s^3 + 0.0024s^2 + 0.412s + 0.0589)`; the numerator alone over 1.
    pub fn to_text(&self, figures: usize) -> String {
        let num = polynomial_text(&self.num, "s", figures);
        if self.den == Polynomial::one() {
            return num;
        }
        let den = polynomial_text(&self.den, "s", figures);
        format!("{} / {}", in_parentheses(&num), in_parentheses(&den))
    }

    /// The same as a MathML fraction, without the `<math>` around it.
    pub fn to_mathml(&self, figures: usize) -> String {
        let num = polynomial_mathml(&self.num, "s", figures);
        if self.den == Polynomial::one() {
            return num;
        }
        format!("<mfrac>{num}{}</mfrac>", polynomial_mathml(&self.den, "s", figures))
    }
}

/// In parentheses when it is a sum: only sums have spaces.
fn in_parentheses(text: &str) -> String {
    if text.contains(' ') { format!("({text})") } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lti::tests::{polynomial, tf};

    #[test]
    fn common_factors_are_taken_out_exactly() {
        #[track_caller]
        fn check(what: &str, num: &str, den: &str, reduced: (&str, &str), shared: &str) {
            let (g, factor) = tf(num, den).cancelled();
            assert_eq!(g, tf(reduced.0, reduced.1), "{what}");
            assert_eq!(factor, polynomial(shared), "{what}");
            assert!(g.equals(&tf(num, den)), "{what}");
        }
        check("nothing in common", "1", "1 2", ("1", "1 2"), "1");
        check(
            "hanging pendulum",
            "-0.06 0 0",
            "0.0132 0.0024 0.41202 0.05886 0",
            ("-0.06 0", "0.0132 0.0024 0.41202 0.05886"),
            "1 0",
        );
        check("quadratic factor", "2 4 10", "3 6 15 0", ("2", "3 0"), "1 2 5");
        check("nearly equal roots stay", "1 1.0000000001", "1 1", ("1 1.0000000001", "1 1"), "1");
        check("zero function", "0", "2 4", ("0", "2"), "1 2");
    }

    #[test]
    fn equality_is_of_functions() {
        #[track_caller]
        fn check(what: &str, a: (&str, &str), b: (&str, &str), equal: bool) {
            assert_eq!(tf(a.0, a.1).equals(&tf(b.0, b.1)), equal, "{what}");
        }
        check("scaled, sign included", ("1", "1 2"), ("-3", "-3 -6"), true);
        check("not cancelled", ("1 0", "1 2 0"), ("1", "1 2"), true);
        check("last digit", ("1", "1 2.0001"), ("1", "1 2"), false);
        check("numerator's sign", ("-1", "1 2"), ("1", "1 2"), false);
        check("both zero", ("0", "1 2"), ("0", "5"), true);
    }

    #[test]
    fn it_is_written_as_one_types_it() {
        #[track_caller]
        fn check(num: &str, den: &str, text: &str) {
            assert_eq!(tf(num, den).to_text(3), text);
        }
        check(
            "-0.06 0",
            "0.0132 0.0024 0.41202 0.05886",
            "-0.06s / (0.0132s^3 + 0.0024s^2 + 0.412s + 0.0589)",
        );
        check("1 2", "1 0", "(s + 2) / s");
        check("3 0", "1", "3s");
        check("0", "1 1", "0 / (s + 1)");
        let mathml = tf("1", "1 2").to_mathml(3);
        assert!(mathml.starts_with("<mfrac>") && mathml.ends_with("</mfrac>"), "{mathml}");
    }

    #[test]
    fn monic_relative_degree_and_zero_denominator() {
        assert_eq!(tf("4", "2 6").monic(), tf("2", "1 3"));
        assert_eq!(tf("1 0", "1 0 0 1").relative_degree(), 2);
        assert_eq!(tf("1 0 0", "1 1").relative_degree(), -1);
        assert_eq!(TransferFunction::new(Polynomial::one(), Polynomial::zero()), None);
    }
}
