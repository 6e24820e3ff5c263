use super::Evidence;
use super::mark::Mark;
use crate::lab::Points;
use crate::submission::{NonlinearityKind, nonlinearity_name};

/// What tells the class from the others.
fn mark_of(kind: NonlinearityKind) -> &'static str {
    match kind {
        NonlinearityKind::Saturation => "the output stops growing though the input goes on",
        NonlinearityKind::DeadZone => "nothing happens until the input is large enough",
        NonlinearityKind::Backlash => {
            "after a start or a reversal the input travels some way before the output follows"
        }
        NonlinearityKind::Relay => "the output jumps between fixed values",
        NonlinearityKind::CoulombFriction => "a constant force opposes the motion",
        NonlinearityKind::Hysteresis => "the output depends on where the input came from",
        NonlinearityKind::Quantization => "the output moves in steps",
        NonlinearityKind::RateLimit => "the output cannot change faster than some rate",
    }
}

pub(super) fn expected(kind: NonlinearityKind) -> String {
    format!("{}: {}.", nonlinearity_name(kind), mark_of(kind))
}

pub(super) fn judge(points: Points, want: NonlinearityKind, typed: NonlinearityKind) -> Mark {
    let (expected, found) = (expected(want), nonlinearity_name(typed).to_owned());
    if want == typed {
        let reason = format!("Yes: {found}.");
        return Mark::right(points, Evidence { expected, found, reason, ..Evidence::default() });
    }
    let reason = format!(
        "The sign of {} is that {}; here {}.",
        nonlinearity_name(typed),
        mark_of(typed),
        mark_of(want)
    );
    Mark::wrong("nonlinearity.other", Evidence { expected, found, reason, ..Evidence::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use NonlinearityKind::*;

    #[test]
    fn the_class_is_right_or_another() {
        for (want, typed, points, code) in [
            (DeadZone, DeadZone, 100, "right"),
            (DeadZone, Backlash, 0, "nonlinearity.other"),
            // friction is why there is a dead zone, but it is not the class asked for
            (DeadZone, CoulombFriction, 0, "nonlinearity.other"),
            (Backlash, Hysteresis, 0, "nonlinearity.other"),
        ] {
            let mark = judge(Points(100), want, typed);
            assert_eq!((mark.earned, mark.code), (Points(points), code), "{typed:?} for {want:?}");
        }
    }
}
