use super::accepted::{Accepted, accepted, accepted_where, operating_point};
use super::own::OwnModel;
use super::poles::{ExpectedPoles, accepted_poles};
use crate::lab::{Curve, SystemRef};
use crate::lti::{InputKind, Mode, Pole, Shape, Stability};
use crate::reference::{LinearReference, Reference, ResponseReference};
use std::f64::consts::TAU;

/// What answers about a system are held against.
#[derive(Clone, Copy, Debug)]
pub(super) enum Truth<'a> {
    Reference(&'a Reference),
    /// The student's own model of the system that is asked about.
    Own(&'a OwnModel),
}

impl<'a> Truth<'a> {
    pub fn poles(self, of: &SystemRef) -> Vec<ExpectedPoles<'a>> {
        match self {
            Self::Reference(reference) => accepted_poles(reference, of),
            Self::Own(own) => own.poles().into_iter().collect(),
        }
    }

    /// Poles of the whole state, cancelled ones included; none are known of a student's own model.
    pub fn internal_poles(self, of: &SystemRef) -> &'a [Pole] {
        self.main(of).map_or(&[], |one| &one.internal_poles)
    }

    pub fn stability(self, of: &SystemRef) -> Vec<Accepted<'a, Stability>> {
        match self {
            Self::Reference(reference) => accepted(reference, of, |one| &one.stability),
            Self::Own(own) => vec![Accepted { differs: &[], what: &own.stability }],
        }
    }

    /// Of the whole state; not known of a student's own model.
    pub fn internal_stability(self, of: &SystemRef) -> Option<Stability> {
        self.main(of).map(|one| one.internal_stability)
    }

    pub fn responses(self, of: &SystemRef, kind: InputKind) -> Vec<Accepted<'a, ResponseReference>> {
        match self {
            Self::Reference(reference) => accepted_where(reference, of, |one| one.response(kind)),
            Self::Own(own) => {
                own.response(kind).map(|what| Accepted { differs: &[], what }).into_iter().collect()
            }
        }
    }

    /// The shapes of the responses, then what one sees of them as well for a while or where they lie at the line between two.
    pub fn shapes(self, of: &SystemRef, kind: InputKind) -> Vec<Accepted<'a, Shape>> {
        let responses = self.responses(of, kind);
        let in_the_end = responses.iter().map(|one| one.pick(|known| &known.features.shape));
        let at_first = responses
            .iter()
            .filter(|one| swings_at_first(one.what))
            .map(|one| one.pick(|_| &Shape::GrowingOscillation));
        let at_the_line =
            responses.iter().filter(|one| one.what.features.borderline.shape.is_some()).map(|one| {
                one.pick(|known| known.features.borderline.shape.as_ref().unwrap_or(&known.features.shape))
            });
        in_the_end.chain(at_first).chain(at_the_line).collect()
    }

    /// How long a curve is asked for where `asked_s` is enough for the reference, s: no longer than an own model takes to show
    /// its own behaviour.
    pub fn span_s(self, curve: &Curve, asked_s: f64) -> f64 {
        match (self, curve) {
            (Self::Own(own), Curve::Response { response, .. }) => {
                own.response(*response).map_or(asked_s, |known| known.horizon_s.min(asked_s))
            }
            _ => asked_s,
        }
    }

    /// What follows from the lab's own parameter values.
    fn main(self, of: &SystemRef) -> Option<&'a LinearReference> {
        match self {
            Self::Reference(reference) => operating_point(reference, of)?.accepted.first(),
            Self::Own(_) => None,
        }
    }
}

/// So many periods of a growing oscillation are enough to see it.
const SEEN_PERIODS: f64 = 5.0;

/// Whether a response that runs away in the end is at first a growing oscillation: for five periods and more, a growing pair
/// is larger than everything that grows without swinging.
fn swings_at_first(known: &ResponseReference) -> bool {
    if known.features.shape != Shape::ExponentialGrowth {
        return false;
    }
    let growing = || known.response.modes().iter().filter(|mode| mode.re > 0.0);
    let size = |mode: &Mode, t: f64| {
        let amplitude = mode.coefficient_re.hypot(mode.coefficient_im);
        let powers: f64 = (1..=mode.power).map(|k| t / k as f64).product();
        amplitude * powers * (mode.re * t).min(600.0).exp()
    };
    growing().filter(|mode| mode.im > 0.0).any(|pair| {
        let t = SEEN_PERIODS * TAU / pair.im;
        let straight: f64 = growing().filter(|mode| mode.im == 0.0).map(|mode| size(mode, t)).sum();
        2.0 * size(pair, t) > straight
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal};
    use crate::lti::TransferFunction;

    #[test]
    fn a_small_runaway_term_leaves_an_oscillation_to_be_seen() {
        #[track_caller]
        fn check(what: &str, num: &str, den: &str, swings: bool) {
            let polynomial = |text: &str| {
                Polynomial::new(text.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
            };
            let g = TransferFunction::new(polynomial(num), polynomial(den)).unwrap();
            let known = ResponseReference::of(&g, InputKind::Impulse).unwrap();
            assert_eq!(swings_at_first(&known), swings, "{what}");
        }
        check("the pendulum, friction reversed", "-0.06 0", "0.0132 -0.0024 0.41202 -0.05886", true);
        check("the pendulum upright", "0.06 0", "0.0132 0.0024 -0.41202 -0.05886", false);
        check("it oscillates in the end as well", "1", "1 -0.2 4", false);
        // e^t and e^0.1t cos t, as large at first: after five periods nothing is left to see.
        check("it runs away at once", "2 -2.2 1.11", "1 -1.2 1.21 -1.01", false);
    }
}
