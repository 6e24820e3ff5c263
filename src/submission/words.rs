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

/// `deadzone`, `dead-zone`, `deadband` … are the same word. Short sentences are read too (`the motor shows a dead zone`).
///
/// `None` when no class, or more than one, is named.
pub fn nonlinearity_word(text: &str) -> Option<NonlinearityKind> {
    let text = before_cause(text);
    if several(named(text, SEPARATORS, nonlinearity)) {
        None
    } else {
        or_without_contrast(text, nonlinearity)
    }
}

fn nonlinearity(text: &str) -> Option<NonlinearityKind> {
    let mut words = Words::new(text)?;
    if words.has_any(NEGATIONS) || words.has_any(HEDGES) {
        return None;
    }
    // `backlash deadband` is what Simulink calls the width of a backlash.
    let backlash = words.take(&[
        "backlash deadband",
        "backlash dead band",
        "backlash dead zone",
        "deadband backlash",
        "backlash hysteresis",
    ]);
    let rate = words.take(RATE_LIMIT);
    let named = NONLINEARITIES.iter().filter(|(_, phrases)| words.has_any(phrases)).map(|(kind, _)| *kind);
    let named = named.chain(backlash.then_some(NonlinearityKind::Backlash));
    one(named.chain(rate.then_some(NonlinearityKind::RateLimit)))
}

/// `stable`, `BIBO stable`, `asymptotically stable`, `not stable`, `the system is unstable` …
///
/// `None` when no class, more than one, or a denied `unstable` is named.
pub fn stability_word(text: &str) -> Option<Stability> {
    match text.trim().trim_end_matches('.').to_lowercase().as_str() {
        // YAML's own words: `stability: no` can mean only one thing.
        "yes" | "true" => Some(Stability::AsymptoticallyStable),
        "no" | "false" => Some(Stability::Unstable),
        _ if several(named(text, SEPARATORS, stability)) => None,
        _ => or_without_contrast(text, stability),
    }
}

fn stability(text: &str) -> Option<Stability> {
    let mut words = Words::new(text)?;
    if words.has_any(HEDGES) || words.has_any(&["conditionally", "marginally unstable"]) {
        return None;
    }
    let denied = words.take(NOT_STABLE).then_some(Stability::Unstable);
    if words.has_any(NEGATIONS) {
        return None;
    }
    let marginal = words.take(MARGINAL).then_some(Stability::MarginallyStable);
    let unstable = words.has_any(&["unstable", "instable", "instability"]).then_some(Stability::Unstable);
    let stable = words.has_any(&["stable", "stability"]).then_some(Stability::AsymptoticallyStable);
    one([denied, marginal, unstable, stable].into_iter().flatten())
}

/// `decaying oscillation`, `damped sinusoid`, `underdamped`, `grows exponentially` …
///
/// `None` when no shape, or more than one, is named.
pub fn shape_word(text: &str) -> Option<Shape> {
    // `underdamped, decaying exponentially` is one shape in two words; two names, or `/` and `or`, make two shapes.
    let two =
        several(named(text, SEPARATORS, shape_by_name)) || several(named(text, ALTERNATIVES, shape_of_part));
    if two { None } else { or_without_contrast(text, shape) }
}

fn shape_by_name(text: &str) -> Option<Shape> {
    let words: Vec<String> = Words::new(text)?.iter().map(str::to_owned).collect();
    shape(text).filter(|shape| words.join(" ") == shape_name(*shape))
}

/// As [`shape`]; but `sustained` alone, beside `constant oscillation`, is no constant.
fn shape_of_part(text: &str) -> Option<Shape> {
    let constant = text.to_lowercase();
    let constant = constant.contains("constant") || constant.contains("flat");
    shape(text).filter(|shape| *shape != Shape::Constant || constant)
}

fn shape(text: &str) -> Option<Shape> {
    let mut words = Words::new(text)?;
    if words.has_any(HEDGES) {
        return None;
    }
    let no_swing = words.take(NO_SWING);
    let no_decay = words.take(NO_DECAY);
    let without_bound = words.take(WITHOUT_BOUND);
    if words.has_any(NEGATIONS) {
        return None;
    }
    let starts = |stems: &[&str]| words.iter().any(|w| stems.iter().any(|s| w.starts_with(s)));
    let swing =
        starts(&["oscillat", "sinusoid", "swing", "ringing", "vibrat", "sine", "sinus", "cosine", "wave"]);
    let decay = words.has_any(DECAYS)
        || starts(&[
            "decay", "damped", "damping", "shrink", "diminish", "converg", "settl", "decreas", "fading",
            "fade", "attenuat", "subsid",
        ]);
    let growth = without_bound
        || words.has_any(GROWS)
        || starts(&[
            "grow",
            "increas",
            "diverg",
            "explod",
            "expand",
            "escalat",
            "unbounded",
            "runaway",
            "unstable",
        ]);
    let steady = no_decay
        || starts(&[
            "sustain",
            "constant",
            "undamped",
            "continuous",
            "persist",
            "perpetual",
            "endless",
            "harmonic",
            "periodic",
            "pure",
            "steady",
            "forever",
            "flat",
        ]);
    if words.has_any(&["underdamped", "under damped"]) {
        return (!growth && !steady && !no_swing).then_some(Shape::DecayingOscillation);
    }
    if words.has_any(&["overdamped", "over damped", "critically damped"]) {
        return (!growth && !steady && !swing).then_some(Shape::ExponentialDecay);
    }
    if swing {
        return match (decay, growth, steady) {
            _ if no_swing => None,
            (true, false, false) => Some(Shape::DecayingOscillation),
            (false, true, false) => Some(Shape::GrowingOscillation),
            (false, false, true) => Some(Shape::SustainedOscillation),
            _ => None,
        };
    }
    let exponential = starts(&["exponential", "monoton", "aperiodic"]);
    let polynomial = starts(&["linear", "ramp", "parabol", "quadratic", "polynomial", "cubic"])
        || words.has_any(&["straight line"]);
    match (decay, growth, steady) {
        (true, false, false) if polynomial => None,
        (true, false, false) => (exponential || no_swing).then_some(Shape::ExponentialDecay),
        (false, true, false) if polynomial => (!exponential).then_some(Shape::PolynomialGrowth),
        (false, true, false) => (exponential || without_bound || starts(&["diverg", "runaway", "unbounded"]))
            .then_some(Shape::ExponentialGrowth),
        (false, false, false) if polynomial && !exponential => Some(Shape::PolynomialGrowth),
        (false, false, true) if words.has_any(&["undamped"]) => Some(Shape::SustainedOscillation),
        (false, false, true) if !no_decay && !exponential && !polynomial => Some(Shape::Constant),
        _ => None,
    }
}

/// The classes of a nonlinearity a text names beside each other: `backlash / dead zone`.
pub(super) fn nonlinearities_named(text: &str) -> Vec<&'static str> {
    named(before_cause(text), SEPARATORS, nonlinearity).into_iter().map(nonlinearity_name).collect()
}

/// As [`nonlinearities_named`], in the words that are taught.
pub(super) fn stabilities_named(text: &str) -> Vec<&'static str> {
    let word = |stability| match stability {
        Stability::AsymptoticallyStable => STABILITY_WORDS[0],
        Stability::MarginallyStable => STABILITY_WORDS[1],
        Stability::Unstable => STABILITY_WORDS[2],
    };
    named(text, SEPARATORS, stability).into_iter().map(word).collect()
}

/// As [`nonlinearities_named`].
pub(super) fn shapes_named(text: &str) -> Vec<&'static str> {
    named(text, SEPARATORS, shape_of_part).into_iter().map(shape_name).collect()
}

/// Half a shape: what is missing in `exponential` and in `oscillation`.
pub(super) fn half_a_shape(text: &str) -> Option<&'static str> {
    const FILLERS: &[&str] = &[
        "a",
        "an",
        "the",
        "it",
        "is",
        "response",
        "curve",
        "function",
        "shape",
        "behaviour",
        "behavior",
        "like",
    ];
    let words = Words::new(text)?;
    let mut words = words.iter().filter(|word| !FILLERS.contains(word));
    match (words.next()?, words.next()) {
        ("exponential" | "exponentially" | "exponentials", None) => {
            Some("Does it grow or decay? Write `exponential growth` or `exponential decay`.")
        }
        (word, None)
            if ["oscillat", "sinusoid", "swing", "sine"].iter().any(|stem| word.starts_with(stem)) =>
        {
            Some(
                "Does it grow, decay or stay? Write `growing oscillation`, `decaying oscillation` or `sustained oscillation`.",
            )
        }
        _ => None,
    }
}

/// What the parts of a text between the separators are read as, each once, in the order of the text.
fn named<T: PartialEq>(text: &str, separators: &[&str], read: impl Fn(&str) -> Option<T>) -> Vec<T> {
    let mut found = Vec::new();
    // Longer than any answer in a word.
    if text.len() > 400 {
        return found;
    }
    let mut flat = format!(" {} ", text.to_lowercase());
    for separator in separators {
        flat = flat.replace(separator, " \n ");
    }
    for part in flat.split('\n').filter_map(read) {
        if !found.contains(&part) {
            found.push(part);
        }
    }
    found
}

fn several<T>(named: Vec<T>) -> bool {
    named.len() > 1
}

/// Between two answers of which one is meant.
const ALTERNATIVES: &[&str] = &["/", "|", " or "];
/// Between two answers.
const SEPARATORS: &[&str] = &["/", "|", " or ", ",", ";", "&", "+", " and ", " as well as "];

/// `a dead zone due to friction` without the cause.
fn before_cause(text: &str) -> &str {
    // In ASCII, so that bytes stay where they are.
    let lower = text.to_ascii_lowercase();
    let causes = [" due to ", " because ", " caused by ", " owing to ", " since "];
    &text[..causes.iter().filter_map(|cause| lower.find(cause)).min().unwrap_or(text.len())]
}

/// What `read` makes of the text, or of the text without what it only sets itself apart from.
fn or_without_contrast<T>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<T> {
    read(text).or_else(|| read(&without_contrast(text)?))
}

/// `not saturation but dead zone` without `not saturation but`; `stable, not unstable` without `, not unstable`.
fn without_contrast(text: &str) -> Option<String> {
    if text.len() > 400 {
        return None;
    }
    let lower = text.to_lowercase();
    let padded = format!(" {lower}");
    if let Some(not) = padded.find(" not ")
        && let Some(but) = padded[not..].find(" but ")
    {
        return Some(format!("{} {}", &padded[..not], &padded[not + but + " but ".len()..]));
    }
    let comma = [", not ", "; not ", " and not "].iter().filter_map(|mark| lower.find(mark)).min()?;
    let rest = &lower[comma + 2..];
    let end = rest.find([',', ';', '.']).map_or("", |i| &rest[i..]);
    Some(format!("{}{end}", &lower[..comma]))
}

/// `asymptotically stable`, `marginally stable`, `unstable`.
pub fn stability_name(stability: Stability) -> &'static str {
    stability.words()
}

/// `decaying oscillation` …
pub fn shape_name(shape: Shape) -> &'static str {
    match shape {
        Shape::DecayingOscillation => "decaying oscillation",
        Shape::SustainedOscillation => "sustained oscillation",
        Shape::GrowingOscillation => "growing oscillation",
        Shape::ExponentialDecay => "exponential decay",
        Shape::ExponentialGrowth => "exponential growth",
        Shape::PolynomialGrowth => "polynomial growth",
        Shape::Constant => "constant",
    }
}

/// `dead zone` …
pub fn nonlinearity_name(kind: NonlinearityKind) -> &'static str {
    match kind {
        NonlinearityKind::Saturation => "saturation",
        NonlinearityKind::DeadZone => "dead zone",
        NonlinearityKind::Backlash => "backlash",
        NonlinearityKind::Relay => "relay",
        NonlinearityKind::CoulombFriction => "Coulomb friction",
        NonlinearityKind::Hysteresis => "hysteresis",
        NonlinearityKind::Quantization => "quantization",
        NonlinearityKind::RateLimit => "rate limit",
    }
}

/// The words a message offers, in the order they are taught.
pub(super) const STABILITY_WORDS: &[&str] = &["stable", "marginally stable", "unstable"];
pub(super) const SHAPE_WORDS: &[&str] = &[
    "decaying oscillation",
    "sustained oscillation",
    "growing oscillation",
    "exponential decay",
    "exponential growth",
    "polynomial growth",
    "constant",
];
pub(super) const NONLINEARITY_WORDS: &[&str] = &[
    "saturation",
    "dead zone",
    "backlash",
    "relay",
    "Coulomb friction",
    "hysteresis",
    "quantization",
    "rate limit",
];

const NEGATIONS: &[&str] = &["not", "never", "no", "non", "neither", "nor", "without"];
const HEDGES: &[&str] = &["or", "if", "unless", "maybe", "perhaps", "but", "either", "depends", "until"];
const NOT_STABLE: &[&str] = &["not stable", "not bibo stable", "non stable", "nonstable", "never stable"];
const MARGINAL: &[&str] = &[
    "marginally stable",
    "marginal stable",
    "marginal stability",
    "marginally stability",
    "critically stable",
    "critical stability",
    "neutrally stable",
    "neutral stability",
    "borderline stable",
    "lyapunov stable",
    "stable in the sense of lyapunov",
    "limit of stability",
    "verge of stability",
    "marginal",
    "marginally",
];
const NO_SWING: &[&str] = &[
    "without any oscillations",
    "without any oscillation",
    "without oscillations",
    "without oscillation",
    "without oscillating",
    "without swinging",
    "without overshoot",
    "no oscillations",
    "no oscillation",
    "does not oscillate",
    "not oscillate",
    "not oscillating",
    "not oscillatory",
    "non oscillating",
    "non oscillatory",
    "nonoscillatory",
];
const NO_DECAY: &[&str] = &[
    "without any damping",
    "without damping",
    "without decay",
    "without decaying",
    "no damping",
    "no decay",
    "non decaying",
    "not decaying",
    "not decay",
    "not damped",
    "never decays",
    "never dies out",
    "not die out",
    "constant amplitude",
    "fixed amplitude",
];
const DECAYS: &[&str] = &[
    "dies out",
    "die out",
    "dies down",
    "dying",
    "becomes smaller",
    "becoming smaller",
    "gets smaller",
    "getting smaller",
    "calms down",
];
const GROWS: &[&str] = &[
    "becomes larger",
    "becoming larger",
    "becomes bigger",
    "gets larger",
    "getting larger",
    "gets bigger",
    "getting bigger",
    "blows up",
];
const WITHOUT_BOUND: &[&str] = &[
    "without bound",
    "without bounds",
    "without limit",
    "not bounded",
    "never stops growing",
    "to infinity",
];

/// Taken out first: a rate limiter is no limiter.
const RATE_LIMIT: &[&str] = &[
    "rate limiters",
    "rate limiter",
    "rate limiting",
    "rate limited",
    "slew rate limit",
    "rate limit",
    "slew rate",
];

const NONLINEARITIES: &[(NonlinearityKind, &[&str])] = &[
    (
        NonlinearityKind::Saturation,
        &["saturation", "saturated", "saturating", "saturates", "saturate", "clipping", "clipped", "limiter"],
    ),
    (
        NonlinearityKind::DeadZone,
        &["dead zone", "deadzone", "dead zones", "dead band", "deadband", "dead space", "deadspace"],
    ),
    (
        NonlinearityKind::Backlash,
        &["backlash", "back lash", "gear play", "play", "lost motion", "slack", "gear slop"],
    ),
    (NonlinearityKind::Relay, &["relay", "on off", "bang bang", "two position"]),
    (
        NonlinearityKind::CoulombFriction,
        &["coulomb friction", "coulomb", "dry friction", "stiction", "static friction", "friction"],
    ),
    (NonlinearityKind::Hysteresis, &["hysteresis", "hysteretic"]),
    (
        NonlinearityKind::Quantization,
        &["quantization", "quantisation", "quantizer", "quantiser", "quantized", "quantised", "quantizing"],
    ),
];

/// Lower-case words with single spaces between and around them.
struct Words(String);

/// A sentence longer than this is prose, not a word.
const MAX_WORDS: usize = 20;

impl Words {
    fn new(text: &str) -> Option<Self> {
        if text.len() > 400 {
            return None;
        }
        let lower =
            text.to_lowercase().replace("n't", " not").replace("n’t", " not").replace("cannot", "can not");
        let words: Vec<&str> =
            lower.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
        (!words.is_empty() && words.len() <= MAX_WORDS).then(|| Self(format!(" {} ", words.join(" "))))
    }

    fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.split(' ').filter(|w| !w.is_empty())
    }

    fn find(&self, phrase: &str) -> Option<usize> {
        self.0.find(&format!(" {phrase} "))
    }

    fn has_any(&self, phrases: &[&str]) -> bool {
        phrases.iter().any(|phrase| self.find(phrase).is_some())
    }

    /// Takes the phrases out; true if one was there.
    fn take(&mut self, phrases: &[&str]) -> bool {
        let mut found = false;
        for phrase in phrases {
            while let Some(at) = self.find(phrase) {
                self.0.replace_range(at..at + phrase.len() + 1, "");
                found = true;
            }
        }
        found
    }
}

/// The only kind named, if there is exactly one.
fn one<T: PartialEq>(mut named: impl Iterator<Item = T>) -> Option<T> {
    let first = named.next()?;
    named.all(|next| next == first).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check<T: PartialEq + std::fmt::Debug>(read: impl Fn(&str) -> T, rows: &[(&str, T)]) {
        for (text, expected) in rows {
            assert_eq!(&read(text), expected, "{text:?}");
        }
    }

    #[test]
    fn stability_words() {
        use Stability::*;
        check(
            stability_word,
            &[
                ("stable", Some(AsymptoticallyStable)),
                ("Stable.", Some(AsymptoticallyStable)),
                ("BIBO stable", Some(AsymptoticallyStable)),
                ("BIBO-stable", Some(AsymptoticallyStable)),
                ("asymptotically stable", Some(AsymptoticallyStable)),
                ("exponentially stable", Some(AsymptoticallyStable)),
                ("The system is stable", Some(AsymptoticallyStable)),
                ("it's a stable system", Some(AsymptoticallyStable)),
                ("marginally stable", Some(MarginallyStable)),
                ("Marginally-stable", Some(MarginallyStable)),
                ("critically stable", Some(MarginallyStable)),
                ("neutrally stable", Some(MarginallyStable)),
                ("marginal", Some(MarginallyStable)),
                ("unstable", Some(Unstable)),
                ("UNSTABLE!", Some(Unstable)),
                ("not stable", Some(Unstable)),
                ("the system isn't stable", Some(Unstable)),
                ("the system isn’t stable", Some(Unstable)),
                ("non-stable", Some(Unstable)),
                ("the pendulum-cart system is unstable", Some(Unstable)),
                ("BIBO unstable", Some(Unstable)),
                ("not unstable", None),
                ("not marginally stable", None),
                ("not asymptotically stable", None),
                ("conditionally stable", None),
                ("marginally unstable", None),
                ("stable or unstable", None),
                ("stable / unstable", None),
                ("stable, unstable", None),
                ("marginal / stable", None),
                ("marginally/critically stable", Some(MarginallyStable)),
                ("not stable, unstable", Some(Unstable)),
                ("unstable, not stable", Some(Unstable)),
                ("stable | marginally stable | unstable", None),
                ("stable if the gain is small", None),
                ("first stable, then unstable", None),
                ("stabel", None),
                ("yes", Some(AsymptoticallyStable)),
                ("No", Some(Unstable)),
                ("not sure", None),
                ("stable, not unstable", Some(AsymptoticallyStable)),
                ("not stable but unstable", Some(Unstable)),
                ("stable but not asymptotically stable", None),
                ("", None),
                ("±∞ …", None),
            ],
        );
    }

    #[test]
    fn nonlinearity_words() {
        use NonlinearityKind::*;
        check(
            nonlinearity_word,
            &[
                ("saturation", Some(Saturation)),
                ("Amplifier saturation", Some(Saturation)),
                ("the speaker is saturated", Some(Saturation)),
                ("clipping", Some(Saturation)),
                ("dead zone", Some(DeadZone)),
                ("dead-zone", Some(DeadZone)),
                ("Deadzone", Some(DeadZone)),
                ("deadband", Some(DeadZone)),
                ("dead band", Some(DeadZone)),
                ("dead-zone nonlinearity", Some(DeadZone)),
                ("the motor exhibits a dead zone", Some(DeadZone)),
                ("dead zone due to friction", Some(DeadZone)),
                ("backlash", Some(Backlash)),
                ("Back-lash", Some(Backlash)),
                ("backlash deadband", Some(Backlash)),
                ("gear play", Some(Backlash)),
                ("backlash in the gears", Some(Backlash)),
                ("relay", Some(Relay)),
                ("on/off", Some(Relay)),
                ("bang-bang", Some(Relay)),
                ("Coulomb friction", Some(CoulombFriction)),
                ("stiction", Some(CoulombFriction)),
                ("hysteresis", Some(Hysteresis)),
                ("quantisation", Some(Quantization)),
                ("quantization", Some(Quantization)),
                ("rate limiter", Some(RateLimit)),
                ("slew-rate limit", Some(RateLimit)),
                ("limiter", Some(Saturation)),
                ("not saturation but dead zone", Some(DeadZone)),
                ("dead zone, not saturation", Some(DeadZone)),
                ("saturation or dead zone", None),
                ("backlash / dead zone", None),
                ("dead zone / backlash", None),
                ("backlash/deadband", None),
                ("backlash, saturation", None),
                ("saturation; backlash", None),
                ("backlash & dead zone", None),
                ("backlash, i.e. gear play", Some(Backlash)),
                ("backlash / play", Some(Backlash)),
                ("dead-zone/deadband", Some(DeadZone)),
                ("dead zone due to friction, and to the brushes", Some(DeadZone)),
                ("dead zone, because of static friction", Some(DeadZone)),
                ("dead zone and saturation", None),
                ("not a dead zone", None),
                ("no backlash", None),
                ("displayed", None),
                ("linear", None),
                ("", None),
            ],
        );
    }

    #[test]
    fn shape_words() {
        use Shape::*;
        check(
            shape_word,
            &[
                ("decaying oscillation", Some(DecayingOscillation)),
                ("Decaying oscillations", Some(DecayingOscillation)),
                ("a damped sinusoid", Some(DecayingOscillation)),
                ("damped sine wave", Some(DecayingOscillation)),
                ("underdamped", Some(DecayingOscillation)),
                ("under-damped response", Some(DecayingOscillation)),
                ("oscillates and dies out", Some(DecayingOscillation)),
                ("exponentially decaying sinusoid", Some(DecayingOscillation)),
                ("it oscillates with decreasing amplitude", Some(DecayingOscillation)),
                ("sustained oscillation", Some(SustainedOscillation)),
                ("undamped", Some(SustainedOscillation)),
                ("undamped oscillation", Some(SustainedOscillation)),
                ("oscillation of constant amplitude", Some(SustainedOscillation)),
                ("non-decaying oscillation", Some(SustainedOscillation)),
                ("growing oscillation", Some(GrowingOscillation)),
                ("oscillates with increasing amplitude", Some(GrowingOscillation)),
                ("diverging oscillations", Some(GrowingOscillation)),
                ("exponential decay", Some(ExponentialDecay)),
                ("decays exponentially", Some(ExponentialDecay)),
                ("overdamped", Some(ExponentialDecay)),
                ("critically damped", Some(ExponentialDecay)),
                ("decays without oscillation", Some(ExponentialDecay)),
                ("monotonic decay", Some(ExponentialDecay)),
                ("exponential growth", Some(ExponentialGrowth)),
                ("growing exponential", Some(ExponentialGrowth)),
                ("increases exponentially", Some(ExponentialGrowth)),
                ("grows without bound", Some(ExponentialGrowth)),
                ("diverges", Some(ExponentialGrowth)),
                ("ramp", Some(PolynomialGrowth)),
                ("linear growth", Some(PolynomialGrowth)),
                ("grows linearly", Some(PolynomialGrowth)),
                ("constant", Some(Constant)),
                ("flat", Some(Constant)),
                ("not a sustained but a decaying oscillation", Some(DecayingOscillation)),
                ("wave that becomes smaller", Some(DecayingOscillation)),
                ("decaying oscillation / exponential decay", None),
                ("decaying oscillation or exponential decay", None),
                ("decaying oscillation, exponential decay", None),
                ("Exponential growth, growing oscillation", None),
                ("underdamped, decaying exponentially", Some(DecayingOscillation)),
                ("sustained/undamped oscillation", Some(SustainedOscillation)),
                ("diverging, growing oscillation", Some(GrowingOscillation)),
                ("exponential", None),
                ("oscillation", None),
                ("decaying", None),
                ("decaying or growing oscillation", None),
                ("growing and decaying oscillation", None),
                ("not a decaying oscillation", None),
                ("underdamped, growing", None),
                ("round", None),
                ("", None),
            ],
        );
    }

    #[test]
    fn two_answers_are_named() {
        assert_eq!(nonlinearities_named("Backlash / dead zone"), ["backlash", "dead zone"]);
        assert_eq!(nonlinearities_named("saturation, backlash or saturation"), ["saturation", "backlash"]);
        assert_eq!(stabilities_named("marginal / stable"), ["marginally stable", "stable"]);
        assert_eq!(shapes_named("ramp or constant"), ["polynomial growth", "constant"]);
        assert_eq!(shapes_named("decaying oscillation"), ["decaying oscillation"]);
    }

    #[test]
    fn half_a_shape_is_asked_about() {
        for (text, half) in [
            ("exponential", true),
            ("An exponential curve.", true),
            ("oscillates", true),
            ("decaying", false),
            ("exponential oscillation", false),
            ("", false),
        ] {
            assert_eq!(half_a_shape(text).is_some(), half, "{text}");
        }
    }

    #[test]
    fn every_name_is_read_as_itself() {
        for word in STABILITY_WORDS {
            assert!(stability_word(word).is_some(), "{word}");
        }
        for word in SHAPE_WORDS {
            assert_eq!(shape_word(word).map(shape_name), Some(*word));
        }
        for word in NONLINEARITY_WORDS {
            assert_eq!(nonlinearity_word(word).map(nonlinearity_name), Some(*word));
        }
        assert_eq!(
            stability_word("asymptotically stable").map(stability_name),
            Some("asymptotically stable")
        );
    }
}
