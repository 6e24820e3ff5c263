use super::closeness::magnitude;
use crate::algebra::{Polynomial, Rational};
use crate::lti::{Stability, stability};
use crate::submission::TypedComplex;

/// A student's own poles as the roots of a polynomial, exactly as typed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OwnPoles {
    /// Monic, with the conjugates that were left out.
    pub polynomial: Polynomial,
    /// What they say of stability: as typed, and with the rounding of a program on the imaginary axis taken for 0.
    words: Vec<Stability>,
}

/// More poles than this are not followed.
const MOST: usize = 60;

/// A real part smaller than this, next to the largest pole, is a program's rounding of 0.
const NOISE_PLACES: isize = 9;

impl OwnPoles {
    /// `None` when there are none, or too many.
    pub fn new(typed: &[TypedComplex]) -> Option<Self> {
        if typed.is_empty() || typed.len() > MOST {
            return None;
        }
        let exact: Vec<(Rational, Rational)> =
            typed.iter().map(|pole| (pole.re.value.clone(), pole.im.value.clone())).collect();
        let size = |(re, im): &(Rational, Rational)| magnitude(re).max(magnitude(im));
        let largest = exact.iter().map(size).max().unwrap_or(Rational::ZERO);
        let limit = largest * Rational::from(10).pow(-NOISE_PLACES);
        let on_axis = |re: &Rational| if magnitude(re) <= limit { Rational::ZERO } else { re.clone() };
        let rounded: Vec<_> = exact.iter().map(|(re, im)| (on_axis(re), im.clone())).collect();
        let polynomial = polynomial(&exact);
        let mut words = vec![stability(&polynomial)];
        if rounded != exact {
            words.push(stability(&self::polynomial(&rounded)));
        }
        Some(Self { polynomial, words })
    }

    pub fn stability(&self) -> Stability {
        self.words.first().copied().unwrap_or(Stability::Unstable)
    }

    pub fn are(&self, word: Stability) -> bool {
        self.words.contains(&word)
    }
}

/// ∏ (s − p), a complex pole and its conjugate as often as either was given.
fn polynomial(poles: &[(Rational, Rational)]) -> Polynomial {
    let mut product = Polynomial::one();
    let mut seen: Vec<(&Rational, Rational)> = Vec::new();
    for (re, im) in poles {
        if im.is_zero() {
            product = &product * &Polynomial::new(vec![Rational::ONE, -re.clone()]);
            continue;
        }
        let key = (re, magnitude(im));
        if seen.contains(&key) {
            continue;
        }
        let upper = Rational::ZERO < *im;
        let given = |up: bool| {
            let same = |(r, i): &&(Rational, Rational)| {
                r == re && magnitude(i) == key.1 && (Rational::ZERO < *i) == up
            };
            poles.iter().filter(same).count()
        };
        let times = given(upper).max(given(!upper));
        let pair = vec![Rational::ONE, -(re + re), re * re + im * im];
        let pair = Polynomial::new(pair);
        product = (0..times).fold(product, |product, _| &product * &pair);
        seen.push(key);
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;
    use crate::submission::Decimal;
    use Stability::*;

    fn own(poles: &[(&str, &str)]) -> OwnPoles {
        let decimal = |text: &str| Decimal::parse(text).unwrap();
        let typed: Vec<_> = poles
            .iter()
            .map(|(re, im)| TypedComplex { re: decimal(re), im: decimal(im), span: Span::default() })
            .collect();
        OwnPoles::new(&typed).unwrap()
    }

    #[test]
    fn poles_say_what_is_stable() {
        #[track_caller]
        fn check(poles: &[(&str, &str)], polynomial: &[i64], words: &[Stability]) {
            let own = own(poles);
            assert_eq!(own.polynomial, Polynomial::from_integers(polynomial), "{poles:?}");
            assert_eq!(own.words, words, "{poles:?}");
        }
        check(&[("-1", "0"), ("-2", "0")], &[1, 3, 2], &[AsymptoticallyStable]);
        check(&[("-1", "0"), ("2", "0")], &[1, -1, -2], &[Unstable]);
        check(&[("-1", "2"), ("-1", "-2")], &[1, 2, 5], &[AsymptoticallyStable]);
        check(&[("-1", "2")], &[1, 2, 5], &[AsymptoticallyStable]);
        check(&[("0", "1"), ("0", "-1")], &[1, 0, 1], &[MarginallyStable]);
        check(&[("0", "1"), ("0", "1"), ("0", "-1"), ("0", "-1")], &[1, 0, 2, 0, 1], &[Unstable]);
        check(&[("0", "0"), ("0", "0")], &[1, 0, 0], &[Unstable]);
        let noisy = own(&[("3e-17", "2"), ("3e-17", "-2")]);
        assert_eq!(noisy.words, [Unstable, MarginallyStable]);
    }

    #[test]
    fn none_and_too_many_say_nothing() {
        assert_eq!(OwnPoles::new(&[]), None);
        let zero = TypedComplex { re: Decimal::absent(), im: Decimal::absent(), span: Span::default() };
        assert_eq!(OwnPoles::new(&vec![zero; MOST + 1]), None);
    }
}
