use crate::lti::{Shape, Stability};

/// The class of a hard nonlinearity, as a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NonlinearityKind {
    Saturation,
    DeadZone,
    Backlash,
    Relay,
    CoulombFriction,
    Hysteresis,
    Quantization,
    RateLimit,
}

/// `deadzone`, `dead-zone`, `deadband` … are the same word.
pub fn nonlinearity_word(text: &str) -> Option<NonlinearityKind> {
    let _ = text;
    todo!()
}

/// `stable`, `BIBO stable`, `asymptotically stable` …
pub fn stability_word(text: &str) -> Option<Stability> {
    let _ = text;
    todo!()
}

/// `decaying oscillation`, `damped sinusoid`, `underdamped` …
pub fn shape_word(text: &str) -> Option<Shape> {
    let _ = text;
    todo!()
}
