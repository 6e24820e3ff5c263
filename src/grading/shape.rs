use super::Evidence;
use super::accepted::{Accepted, also};
use super::mark::Mark;
use crate::lab::Points;
use crate::lti::Shape;
use crate::submission::shape_name;

fn oscillates(shape: Shape) -> bool {
    matches!(shape, Shape::DecayingOscillation | Shape::SustainedOscillation | Shape::GrowingOscillation)
}

/// −1 when it dies away, 0 when it stays, 1 when it grows.
fn trend(shape: Shape) -> i8 {
    match shape {
        Shape::DecayingOscillation | Shape::ExponentialDecay => -1,
        Shape::SustainedOscillation | Shape::Constant => 0,
        Shape::GrowingOscillation | Shape::ExponentialGrowth | Shape::PolynomialGrowth => 1,
    }
}

/// What is expected of the word, as a sentence.
pub(super) fn expected(accepted: &[Accepted<'_, Shape>]) -> String {
    let Some(main) = accepted.first() else { return String::new() };
    let others =
        if accepted.iter().all(|one| one.what == main.what) { String::new() } else { also(accepted) };
    let either = other_word(accepted).map_or_else(String::new, |word| format!(" Or {}.", with_article(word)));
    let own = match main.what {
        Shape::ExponentialDecay => "exponential decay, or approach to the final value",
        other => shape_name(*other),
    };
    format!("{own}.{either}{others}")
}

/// Another word for the same response as the first.
fn other_word(accepted: &[Accepted<'_, Shape>]) -> Option<Shape> {
    let main = accepted.first()?;
    let same = |one: &&Accepted<'_, Shape>| one.differs == main.differs && one.what != main.what;
    accepted.iter().find(same).map(|one| *one.what)
}

/// The same shape is right, any other is wrong; the code tells a kin (same trend, or both oscillating) from the rest.
pub(super) fn judge(points: Points, accepted: &[Accepted<'_, Shape>], typed: Shape) -> Mark {
    let (expected, found) = (expected(accepted), shape_name(typed).to_owned());
    let Some(main) = accepted.first().map(|one| *one.what) else {
        return Mark::unmarked(expected, found, "There is no reference to compare this with.");
    };
    if let Some(one) = accepted.iter().find(|one| *one.what == typed) {
        let first =
            accepted.iter().find(|other| other.differs == one.differs).map_or(typed, |other| *other.what);
        let reason = if first == typed {
            format!("The response{} is {}.", one.with(), with_article(typed))
        } else {
            format!(
                "The response{} may be called {} as well as {}: it lies where the two meet.",
                one.with(),
                with_article(typed),
                with_article(first)
            )
        };
        return Mark::right(points, Evidence { expected, found, reason, ..Evidence::default() });
    }
    let (code, half) = if trend(main) == trend(typed) {
        let half = match (oscillates(main), oscillates(typed)) {
            (true, false) => "The trend is right, but the response oscillates.",
            (false, true) => "The trend is right, but the response does not oscillate.",
            _ => "The trend is right, but not how it grows.",
        };
        ("shape.kin", half)
    } else if oscillates(main) && oscillates(typed) {
        ("shape.kin", "It does oscillate, but its amplitude goes another way.")
    } else {
        ("shape.other", "")
    };
    let reason = format!("The response is {}, not {}. {half}", with_article(main), with_article(typed));
    let reason = reason.trim_end().to_owned();
    Mark::wrong(code, Evidence { expected, found, reason, ..Evidence::default() })
}

fn with_article(shape: Shape) -> String {
    match shape {
        Shape::Constant | Shape::PolynomialGrowth => shape_name(shape).to_owned(),
        Shape::ExponentialDecay => "an exponential approach to its final value".to_owned(),
        Shape::ExponentialGrowth => shape_name(shape).to_owned(),
        _ => format!("a {}", shape_name(shape)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Shape::*;

    #[track_caller]
    fn check(rows: &[(Shape, Shape, i64, &str)]) {
        for (truth, typed, points, code) in rows {
            let mark = judge(Points(100), &[Accepted { differs: &[], what: truth }], *typed);
            assert_eq!((mark.earned, mark.code), (Points(*points), *code), "{typed:?} for {truth:?}");
        }
    }

    #[test]
    fn only_the_same_shape_is_right() {
        check(&[
            // truth, typed, points, code
            (DecayingOscillation, DecayingOscillation, 100, "right"),
            (DecayingOscillation, ExponentialDecay, 0, "shape.kin"),
            (DecayingOscillation, SustainedOscillation, 0, "shape.kin"),
            (DecayingOscillation, GrowingOscillation, 0, "shape.kin"),
            (DecayingOscillation, ExponentialGrowth, 0, "shape.other"),
            (DecayingOscillation, Constant, 0, "shape.other"),
            (ExponentialGrowth, PolynomialGrowth, 0, "shape.kin"),
            (ExponentialGrowth, GrowingOscillation, 0, "shape.kin"),
            (ExponentialGrowth, ExponentialDecay, 0, "shape.other"),
        ]);
    }

    #[test]
    fn where_two_shapes_meet_either_is_right() {
        let accepted = [&ExponentialDecay, &DecayingOscillation].map(|what| Accepted { differs: &[], what });
        for (typed, points) in [(ExponentialDecay, 100), (DecayingOscillation, 100), (Constant, 0)] {
            let mark = judge(Points(100), &accepted, typed);
            assert_eq!(mark.earned, Points(points), "{typed:?}");
            assert!(mark.evidence.expected.ends_with(" Or a decaying oscillation."), "{mark:?}");
        }
        let mark = judge(Points(100), &accepted, DecayingOscillation);
        assert!(mark.evidence.reason.contains("where the two meet"), "{mark:?}");
    }
}
