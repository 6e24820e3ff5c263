//! The words of claims.

use super::claims::ClaimKind;
use super::phrase::Phrase;
use std::sync::LazyLock;

/// Phrases and what they claim; `None` claims nothing, and keeps a shorter phrase within it from being heard.
pub(super) type Phrases = Vec<(Option<ClaimKind>, Vec<Phrase>)>;

pub(super) static PHRASES: LazyLock<Phrases> = LazyLock::new(|| {
    let within =
        |between, texts: &[&str]| texts.iter().map(|text| Phrase::new(text).with_between(between)).collect();
    let all = |texts: &[&str]| within(1, texts);
    vec![
        (Some(ClaimKind::Stable), all(&["stable"])),
        (Some(ClaimKind::Stable), within(3, LEFT_HALF_PLANE)),
        (Some(ClaimKind::MarginallyStable), all(MARGINAL)),
        (Some(ClaimKind::Unstable), all(&["unstable", "instability"])),
        (Some(ClaimKind::Unstable), within(3, RIGHT_HALF_PLANE)),
        (Some(ClaimKind::Oscillates), all(OSCILLATES)),
        (Some(ClaimKind::DiesAway), all(DIES_AWAY)),
        (Some(ClaimKind::GrowsWithoutBound), all(GROWS)),
        (Some(ClaimKind::NeverEnds), endless()),
        (Some(ClaimKind::ConstantAmplitude), within(2, CONSTANT_AMPLITUDE)),
        (None, all(NOTHING)),
    ]
});

const MARGINAL: &[&str] =
    &["marginally stable", "marginal stable", "critically stable", "neutrally stable", "marginal stability"];
const LEFT_HALF_PLANE: &[&str] =
    &["all poles left half", "poles all left half", "all poles negative real", "all poles lhp"];
const RIGHT_HALF_PLANE: &[&str] = &[
    "pole right half",
    "poles right half",
    "pole rhp",
    "poles rhp",
    "pole positive real",
    "poles positive real",
    "eigenvalue positive real",
    "pole is positive",
];
const OSCILLATES: &[&str] = &[
    "oscillates",
    "oscillate",
    "oscillated",
    "oscillating",
    "oscillation",
    "oscillations",
    "oscillatory",
    "vibrates",
    "vibrate",
    "vibrations",
    "sinusoidal",
    "sinusoid",
    "swings back and forth",
    "swings about",
    "swings around",
    "swings to both sides",
    "back and forth",
    "to and fro",
];
const DIES_AWAY: &[&str] = &[
    "dies away",
    "die away",
    "dies out",
    "die out",
    "dies down",
    "die down",
    "dying away",
    "dying out",
    "decays",
    "decay",
    "decaying",
    "decayed",
    "damped",
    "damps out",
    "settles",
    "settle",
    "settled",
    "settling",
    "converges",
    "converge",
    "vanishes",
    "vanish",
    "fades away",
    "fades out",
    "fade away",
    "fade out",
    "comes to rest",
    "come to rest",
    "coming to rest",
    "comes to a stop",
    "come to a stop",
    "comes to a standstill",
    "come to a standstill",
    "returns to rest",
    "return to rest",
    "returns to equilibrium",
    "returns to the equilibrium",
    "returns to its equilibrium",
    "return to equilibrium",
    "return to its equilibrium",
    "decreasing amplitude",
    "decreasing amplitudes",
    "shrinking amplitude",
    "falling amplitude",
    "diminishing amplitude",
    "amplitude decreases",
    "amplitude shrinks",
    "smaller and smaller",
    "weaker and weaker",
    "smaller with time",
    "decreases with time",
    "smaller than the one before",
    "smaller than the previous one",
    "smaller than the last one",
];
const GROWS: &[&str] = &[
    "grows exponentially",
    "grow exponentially",
    "growing exponentially",
    "exponentially grows",
    "exponentially growing",
    "exponential growth",
    "increases exponentially",
    "increase exponentially",
    "increasing exponentially",
    "exponentially increasing",
    "rises exponentially",
    "rising exponentially",
    "grows without bound",
    "grows without bounds",
    "grows without limit",
    "grows without end",
    "grow without bound",
    "grow without limit",
    "growing without bound",
    "increases without bound",
    "increases without limit",
    "rises without bound",
    "without bound",
    "grows unboundedly",
    "grows indefinitely",
    "grows forever",
    "grows for ever",
    "increases indefinitely",
    "increases forever",
    "grows to infinity",
    "goes to infinity",
    "go to infinity",
    "going to infinity",
    "tends to infinity",
    "tend to infinity",
    "rises to infinity",
    "increases to infinity",
    "approaches infinity",
    "towards infinity",
    "diverges",
    "diverge",
    "diverging",
    "diverged",
    "unbounded",
    "blows up",
    "blow up",
    "explodes",
    "growing oscillation",
    "growing oscillations",
    "growing amplitude",
    "increasing amplitude",
    "larger and larger",
    "bigger and bigger",
    "larger with time",
    "bigger with time",
    "grows with time",
    "increases with time",
    "larger than the one before",
    "larger than the previous one",
    "larger than the last one",
];
const CONSTANT_AMPLITUDE: &[&str] = &[
    "constant amplitude",
    "same amplitude",
    "amplitude is constant",
    "amplitude remain* constant",
    "amplitude stay* constant",
    "amplitude stay* the same",
    "amplitude remain* the same",
    "sustained oscillation",
    "sustained oscillations",
    "undamped oscillation",
    "undamped oscillations",
    "undamped",
];
/// Words that look like a claim and are none.
const NOTHING: &[&str] = &[
    "conditionally stable",
    "relatively stable",
    "stable equilibrium",
    "stable equilibria",
    "stable position",
    "stable point",
    "stable state",
    "stable value",
    "stable oscillation",
    "stable oscillations",
    "stable limit",
    "stable level",
    "stable way",
    "settling time",
    "settles into",
    "settle into",
    "decay rate",
    "decay time",
    "decay constant",
    "decay ratio",
    "decaying term",
    "decaying exponential",
    "decaying part",
    "decaying mode",
    "decaying component",
    "damped frequency",
    "damped natural",
    "same amplitude as",
    "forced oscillation",
];

/// `swings for ever`, `continues to rotate indefinitely`.
fn endless() -> Vec<Phrase> {
    const VERBS: &[&str] =
        &["oscillat*", "swing*", "vibrat*", "rotat*", "mov*", "continu*", "go* on", "persist*", "last*"];
    const ENDLESS: &[&str] = &[
        "forever",
        "for ever",
        "indefinitely",
        "endlessly",
        "perpetually",
        "without end",
        "without stopping",
    ];
    let mut all: Vec<Phrase> = VERBS
        .iter()
        .flat_map(|verb| {
            ENDLESS.iter().map(move |endless| Phrase::new(&format!("{verb} {endless}")).with_between(3))
        })
        .collect();
    let whole = [
        "never stops",
        "never stop",
        "never ends",
        "does not stop",
        "not stop moving",
        "not come to an end",
        "never dies",
    ];
    all.extend(whole.iter().map(|text| Phrase::new(text).with_between(0)));
    all
}
