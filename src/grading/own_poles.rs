use super::closeness::magnitude;
use crate::algebra::{Polynomial, Rational};
use crate::lti::Stability;
use crate::submission::TypedComplex;

/// A student's own poles as a set, exactly as typed, with the conjugates that were left out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OwnPoles {
    places: Vec<Place>,
    /// What they say of stability: as typed, and with the rounding of a program on the imaginary axis taken for 0.
    words: Vec<Stability>,
}

/// A real pole, or a complex one and its conjugate.
#[derive(Clone, Debug, PartialEq)]
struct Place {
    re: Rational,
    /// Not negative.
    im: Rational,
    times: usize,
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
        let places = places(&exact);
        let mut words = vec![stability(&places)];
        if rounded != exact {
            words.push(stability(&self::places(&rounded)));
        }
        Some(Self { places, words })
    }

    /// How many, by multiplicity.
    pub fn count(&self) -> usize {
        self.places.iter().map(|place| if place.im.is_zero() { place.times } else { 2 * place.times }).sum()
    }

    /// ∏ (s − p): exact, and so for few poles only.
    pub fn polynomial(&self) -> Polynomial {
        let factors = self.places.iter().flat_map(|place| {
            let Place { re, im, times } = place;
            let coefficients = if im.is_zero() {
                vec![Rational::ONE, -re.clone()]
            } else {
                vec![Rational::ONE, -(re + re), re * re + im * im]
            };
            std::iter::repeat_n(Polynomial::new(coefficients), *times)
        });
        factors.fold(Polynomial::one(), |product, factor| &product * &factor)
    }

    pub fn stability(&self) -> Stability {
        self.words.first().copied().unwrap_or(Stability::Unstable)
    }

    pub fn are(&self, word: Stability) -> bool {
        self.words.contains(&word)
    }
}

/// Each place once, in the order typed; a complex pole and its conjugate as often as either was given.
fn places(poles: &[(Rational, Rational)]) -> Vec<Place> {
    let mut found: Vec<Place> = Vec::new();
    for (re, im) in poles {
        let size = magnitude(im);
        if found.iter().any(|known| known.re == *re && known.im == size) {
            continue;
        }
        let given = |im: &Rational| poles.iter().filter(|(r, i)| r == re && i == im).count();
        let times = given(&size).max(given(&-size.clone()));
        found.push(Place { re: re.clone(), im: size, times });
    }
    found
}

fn stability(places: &[Place]) -> Stability {
    let on_axis = || places.iter().filter(|place| place.re.is_zero());
    if places.iter().any(|place| place.re > Rational::ZERO) || on_axis().any(|place| place.times > 1) {
        Stability::Unstable
    } else if on_axis().next().is_some() {
        Stability::MarginallyStable
    } else {
        Stability::AsymptoticallyStable
    }
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
            assert_eq!(own.polynomial(), Polynomial::from_integers(polynomial), "{poles:?}");
            assert_eq!(own.count(), polynomial.len() - 1, "{poles:?}");
            assert_eq!(own.words, words, "{poles:?}");
            assert_eq!(own.stability(), crate::lti::stability(&own.polynomial()), "{poles:?}");
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
