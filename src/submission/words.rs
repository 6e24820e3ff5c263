use super::beside::{BESIDE_NONLINEARITY, BESIDE_STABILITY, TURNS, after_cause, classes, is_harmless};
use crate::lti::{Shape, Stability};
use crate::memo::Memo;
use std::sync::LazyLock;

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
/// `None` when no class, or more than one, is named, or beside it a word that may turn its meaning (`hardly`, `is wrong`).
pub fn nonlinearity_word(text: &str) -> Option<NonlinearityKind> {
    static KNOWN: LazyLock<Memo<String, Option<NonlinearityKind>>> = LazyLock::new(|| Memo::of(MOST_KNOWN));
    remembered(&KNOWN, text, read_nonlinearity)
}

fn read_nonlinearity(text: &str) -> Option<NonlinearityKind> {
    let (text, remarks) = without_remarks(before_cause(text, OCCASIONS)?)?;
    let kind = one_class(&text, nonlinearity)?;
    let same =
        |remark: &String| is_harmless(remark, &BESIDE_NONLINEARITY) || nonlinearity(remark) == Some(kind);
    remarks.iter().all(same).then_some(kind)
}

/// Most of a class answers in the same few words.
fn remembered<T: Copy>(
    known: &Memo<String, Option<T>>,
    text: &str,
    read: fn(&str) -> Option<T>,
) -> Option<T> {
    const LONGEST: usize = 80;
    if text.len() > LONGEST { read(text) } else { *known.get(text.to_owned(), |text| read(text)) }
}

/// Texts that are kept.
const MOST_KNOWN: usize = 500;

fn nonlinearity(text: &str) -> Option<NonlinearityKind> {
    let words = Words::new(text)?;
    let words: Vec<&str> = words.iter().collect();
    one(classes(after_cause(&words), NONLINEARITIES, &BESIDE_NONLINEARITY)?.into_iter())
}

/// `stable`, `BIBO stable`, `asymptotically stable`, `not stable`, `the system is unstable` …
///
/// `None` when no class, more than one, or a denied `unstable` is named, or beside it a word that may turn its meaning
/// (`almost`, `lacks`, `is false`).
pub fn stability_word(text: &str) -> Option<Stability> {
    static KNOWN: LazyLock<Memo<String, Option<Stability>>> = LazyLock::new(|| Memo::of(MOST_KNOWN));
    remembered(&KNOWN, text, read_stability)
}

fn read_stability(text: &str) -> Option<Stability> {
    let text = before_cause(text, &[])?;
    // YAML's own words: `stability: no` can mean only one thing.
    if let Some(yes) = yes_or_no(text) {
        return Some(if yes { Stability::AsymptoticallyStable } else { Stability::Unstable });
    }
    if let Some((question, reply)) = text.split_once('?')
        && let Some(yes) = yes_or_no(reply)
    {
        return match (stability(question)?, yes) {
            (asked, true) => Some(asked),
            (Stability::AsymptoticallyStable, false) => Some(Stability::Unstable),
            (_, false) => None,
        };
    }
    if let Some((yes, rest)) = leading_yes_or_no(text) {
        let against = if yes { Stability::Unstable } else { Stability::AsymptoticallyStable };
        return one_class(rest, stability).filter(|stability| *stability != against);
    }
    one_class(text, stability)
}

fn stability(text: &str) -> Option<Stability> {
    let words = Words::new(text)?;
    let words: Vec<&str> = words.iter().collect();
    one(classes(&words, STABILITIES, &BESIDE_STABILITY)?.into_iter())
}

/// `yes`, `No!`, `false.`
fn yes_or_no(text: &str) -> Option<bool> {
    match text.trim_matches(|c: char| !c.is_alphanumeric()).to_lowercase().as_str() {
        "yes" | "true" => Some(true),
        "no" | "false" => Some(false),
        _ => None,
    }
}

/// `no, unstable`: the word, and what follows it.
fn leading_yes_or_no(text: &str) -> Option<(bool, &str)> {
    let end = text.find([',', '.', ';', ':', '!', '(']).into_iter();
    let end = end.chain([" - ", " – ", " — "].iter().filter_map(|dash| text.find(dash))).min()?;
    Some((yes_or_no(&text[..end])?, &text[end..]))
}

/// The one class that a text names: also twice (`dead zone or deadband`), and apart from another (`X, not Y`).
fn one_class<T: PartialEq + Copy>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<T> {
    if several(named(text, SEPARATORS, &read)) {
        return None;
    }
    if let Some(same) = same_in_all(text, &read) {
        return Some(same);
    }
    or_without_contrast(text, &read).or_else(|| conclusion(text, read))
}

/// `…, so this is a dead zone`: what is concluded from a premise in any words that names no class itself.
fn conclusion<T>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<T> {
    const SO: &[&str] =
        &[", so ", ", therefore ", ", hence ", ", thus ", "; so ", "; therefore ", "; hence ", ". So "];
    let (at, so) = SO.iter().filter_map(|so| Some((text.rfind(so)?, so))).max_by_key(|(at, _)| *at)?;
    let premise = Words::new(&text[..at])?;
    let words: Vec<&str> = premise.iter().collect();
    let named = (0..words.len()).flat_map(|from| (from..words.len().min(from + 4)).map(move |to| (from, to)));
    let named = named.into_iter().any(|(from, to)| read(&words[from..=to].join(" ")).is_some());
    (!named && !premise.has_any(DENIALS)).then(|| read(&text[at + so.len()..]))?
}

/// What makes a premise one against its conclusion.
const DENIALS: &[&str] = &["if", "wrong", "false", "said", "says", "say", "claim", "claims", "unless"];

/// What all parts between [`ALTERNATIVES`] name.
fn same_in_all<T: PartialEq>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<T> {
    let mut flat = text.to_lowercase();
    for separator in ALTERNATIVES {
        flat = flat.replace(separator, "\n");
    }
    let parts: Option<Vec<T>> = flat.split('\n').map(read).collect();
    one(parts.filter(|parts| parts.len() > 1)?.into_iter())
}

/// `decaying oscillation`, `damped sinusoid`, `underdamped`, `grows exponentially` …
///
/// `None` when no shape, or more than one, is named.
pub fn shape_word(text: &str) -> Option<Shape> {
    static KNOWN: LazyLock<Memo<String, Option<Shape>>> = LazyLock::new(|| Memo::of(MOST_KNOWN));
    remembered(&KNOWN, text, read_shape)
}

fn read_shape(text: &str) -> Option<Shape> {
    // `underdamped, decaying exponentially` is one shape in two words; two names, or `/` and `or`, make two shapes.
    let two =
        several(named(text, SEPARATORS, shape_by_name)) || several(named(text, ALTERNATIVES, shape_of_part));
    if two { None } else { same_in_all(text, shape).or_else(|| or_without_contrast(text, shape)) }
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
    if words.has_any(HEDGES) || words.has_any(TURNS) {
        return None;
    }
    // What does not overshoot has a value that it goes to.
    let no_overshoot = words.take(NO_OVERSHOOT);
    let no_swing = words.take(NO_SWING) || no_overshoot;
    let no_decay = words.take(NO_DECAY);
    let without_bound = words.take(WITHOUT_BOUND);
    if words.has_any(NEGATIONS) {
        return None;
    }
    let starts = |stems: &[&str]| words.iter().any(|w| stems.iter().any(|s| w.starts_with(s)));
    let swing =
        starts(&["oscillat", "sinusoid", "swing", "ringing", "vibrat", "sine", "sinus", "cosine", "wave"]);
    // What rises to a level does not grow for ever.
    let up = words.has_any(&["rises", "rising", "rise", "increases", "increasing", "grows", "climbs"]);
    let level = words.has_any(&["to", "towards", "toward", "until", "final"]) || no_overshoot;
    let approach = up && level && !without_bound;
    let decay = words.has_any(DECAYS)
        || approach
        || no_overshoot
        || starts(&[
            "decay", "damped", "damping", "shrink", "diminish", "converg", "settl", "decreas", "fading",
            "fade", "attenuat", "subsid", "approach",
        ]);
    let rises = words.has_any(&["rises", "rising"]);
    let growth = without_bound
        || (!approach && (rises || starts(&["grow", "increas"])))
        || words.has_any(GROWS)
        || starts(&["diverg", "explod", "expand", "escalat", "unbounded", "runaway", "unstable"]);
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
    let ramp = starts(&["ramp"]);
    if ramp && swing && (decay || words.has_any(&["underdamped"])) && !growth && !steady {
        return Some(Shape::PolynomialGrowth);
    }
    if words.has_any(&["underdamped", "under damped"]) {
        return (!growth && !steady && !no_swing).then_some(Shape::DecayingOscillation);
    }
    if words.has_any(&["overshoot", "overshoots", "overshooting"]) && !swing {
        return None;
    }
    if words.has_any(&["overdamped", "over damped", "critically damped", "s shaped", "s shape", "s curve"]) {
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
        (false, false, false)
            if !polynomial && (starts(&["aperiodic", "pt1"]) || words.has_any(FIRST_ORDER)) =>
        {
            Some(Shape::ExponentialDecay)
        }
        (false, false, false) if polynomial && !exponential => Some(Shape::PolynomialGrowth),
        (false, false, true) if words.has_any(&["undamped"]) => Some(Shape::SustainedOscillation),
        (false, false, true) if !no_decay && !exponential && !polynomial => Some(Shape::Constant),
        _ => None,
    }
}

/// The classes of a nonlinearity a text names beside each other: `backlash / dead zone`.
pub(super) fn nonlinearities_named(text: &str) -> Vec<&'static str> {
    let beside: Vec<&str> = [BESIDE_EACH_OTHER, SEPARATORS].concat();
    let text = before_cause(text, OCCASIONS).unwrap_or_default();
    named(text, &beside, nonlinearity).into_iter().map(nonlinearity_name).collect()
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

/// A shape of which one half is not said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HalfShape {
    /// `exponential`
    Exponential,
    /// `oscillation`
    Oscillation,
}

impl HalfShape {
    /// What to ask, and how to write it.
    pub fn help(self) -> &'static str {
        match self {
            Self::Exponential => "Does it grow or decay? Write `exponential growth` or `exponential decay`.",
            Self::Oscillation => {
                "Does it grow, decay or stay? Write `growing oscillation`, `decaying oscillation` or `sustained oscillation`."
            }
        }
    }
}

/// `exponential` and `oscillation`, alone or beside words that say no more.
pub(super) fn half_a_shape(text: &str) -> Option<HalfShape> {
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
        "rise",
        "rises",
        "rising",
        "increase",
        "up",
        "step",
        "goes",
    ];
    let words = Words::new(text)?;
    let mut words = words.iter().filter(|word| !FILLERS.contains(word));
    match (words.next()?, words.next()) {
        ("exponential" | "exponentially" | "exponentials", None) => Some(HalfShape::Exponential),
        (word, None) if word.starts_with("monoton") => Some(HalfShape::Exponential),
        (word, None)
            if ["oscillat", "sinusoid", "swing", "sine"].iter().any(|stem| word.starts_with(stem)) =>
        {
            Some(HalfShape::Oscillation)
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

/// One name in brackets after another.
const BESIDE_EACH_OTHER: &[&str] = &["(", ")"];

/// A cause, which may be told in any words.
const CAUSES: &[&str] = &[
    " due to ",
    " because ",
    "(because ",
    "(due to ",
    " caused by ",
    " owing to ",
    " since ",
    ", as ",
    " as the ",
    " as both ",
    " as all ",
    " as its ",
    " as no ",
    " as one ",
    " as it ",
    " as there ",
];
/// The occasion on which a nonlinearity shows.
const OCCASIONS: &[&str] = &[" when "];

/// `a dead zone due to friction` without the cause. `None` when the cause takes back what stands before it.
fn before_cause<'t>(text: &'t str, more: &[&str]) -> Option<&'t str> {
    // In ASCII, so that bytes stay where they are.
    let lower = text.to_ascii_lowercase();
    let found = |mark: &&str| lower.find(*mark).filter(|at| !lower[*at..].starts_with(", as well"));
    let Some(cut) = CAUSES.iter().chain(more).filter_map(found).min().filter(|cut| *cut > 0) else {
        return Some(text);
    };
    let cause = format!(" {} ", text[cut..].to_lowercase().replace(|c: char| !c.is_alphanumeric(), " "));
    let mut turns = TURNS.iter().chain(&["but", "or", "if", "unless"]);
    let turned = turns.any(|turn| cause.contains(&format!(" {turn} ")));
    (!turned).then_some(&text[..cut])
}

/// `deadzone (friction)` as `deadzone` and its remark `friction`. `None` when a bracket is left open.
fn without_remarks(text: &str) -> Option<(String, Vec<String>)> {
    let (mut bare, mut remarks, mut rest) = (String::new(), Vec::new(), text);
    while let Some((before, after)) = rest.split_once('(') {
        let (remark, after) = after.split_once(')')?;
        bare.push_str(before);
        if bare.trim().is_empty() {
            bare.push_str(remark);
        } else {
            remarks.push(remark.to_owned());
        }
        bare.push(' ');
        rest = after;
    }
    bare.push_str(rest);
    Some((bare, remarks))
}

/// What `read` makes of the text, or of the text without what it only sets itself apart from.
fn or_without_contrast<T: PartialEq>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<T> {
    read(text).or_else(|| {
        let (rest, other) = without_contrast(text)?;
        // `stable, not at all` sets itself apart from nothing.
        let other = read(&other)?;
        read(&rest).filter(|rest| *rest != other)
    })
}

/// `not saturation but dead zone` without `not saturation but`; `stable, not unstable` without `, not unstable`; and
/// what was denied.
fn without_contrast(text: &str) -> Option<(String, String)> {
    if text.len() > 400 {
        return None;
    }
    let lower = text.to_lowercase();
    let padded = format!(" {lower}");
    if let Some(not) = padded.find(" not ")
        && let Some(but) = padded[not..].find(" but ")
    {
        let rest = format!("{} {}", &padded[..not], &padded[not + but + " but ".len()..]);
        return Some((rest, padded[not + " not ".len()..].split(" but ").next()?.to_owned()));
    }
    let marks = [", not ", "; not ", " and not "];
    let (comma, mark) = marks.iter().filter_map(|mark| Some((lower.find(mark)?, mark))).min()?;
    let denied = &lower[comma + mark.len()..];
    let end = denied.find([',', ';', '.']).unwrap_or(denied.len());
    Some((format!("{}{}", &lower[..comma], &denied[end..]), denied[..end].to_owned()))
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

const STABILITIES: &[(Stability, &[&str])] = &[
    (Stability::AsymptoticallyStable, &["stable", "stability"]),
    (
        Stability::MarginallyStable,
        &[
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
            "border of stability",
            "boundary of stability",
            "edge of stability",
            "stability limit",
            "stability boundary",
            "stability border",
            "borderline stability",
            "limit stable",
            "limit stability",
            "indifferently stable",
            "marginal",
            "marginally",
        ],
    ),
    (
        Stability::Unstable,
        &[
            "unstable",
            "instable",
            "instability",
            "not stable",
            "not bibo stable",
            "non stable",
            "nonstable",
            "un stable",
            "never stable",
        ],
    ),
];
const NO_SWING: &[&str] = &[
    "without any oscillations",
    "without any oscillation",
    "without oscillations",
    "without oscillation",
    "without oscillating",
    "without swinging",
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
const NO_OVERSHOOT: &[&str] = &[
    "without any overshoot",
    "without overshoot",
    "without overshooting",
    "with no overshoot",
    "no overshoot",
    "does not overshoot",
    "not overshoot",
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
const FIRST_ORDER: &[&str] =
    &["first order like", "first order lag", "first order step response", "first order rise"];
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

const NONLINEARITIES: &[(NonlinearityKind, &[&str])] = &[
    (
        NonlinearityKind::Saturation,
        &[
            "saturation",
            "saturated",
            "saturating",
            "saturates",
            "saturate",
            "clipping",
            "clipped",
            "clips",
            "limiter",
            "limiting",
            "limitation",
            "hard limit",
            "hard limiter",
            "hard limiting",
            "amplitude limit",
            "amplitude limiter",
            "amplitude limiting",
            "amplitude limitation",
            "voltage limit",
            "voltage limitation",
            "output limit",
            "output limitation",
            "clamping",
            "clamped",
        ],
    ),
    (
        NonlinearityKind::DeadZone,
        &[
            "dead zone",
            "deadzone",
            "dead zones",
            "dead band",
            "deadband",
            "dead space",
            "deadspace",
            "dead region",
            "insensitive zone",
            "insensitivity zone",
            "neutral zone",
        ],
    ),
    (
        NonlinearityKind::Backlash,
        // `backlash deadband` is what Simulink calls the width of a backlash.
        &[
            "backlash",
            "back lash",
            "gear play",
            "play",
            "lost motion",
            "slack",
            "gear slop",
            "gear lash",
            "free play",
            "freeplay",
            "mechanical play",
            "clearance",
            "gear clearance",
            "backlash deadband",
            "backlash dead band",
            "backlash dead zone",
            "deadband backlash",
            "backlash hysteresis",
        ],
    ),
    (
        NonlinearityKind::Relay,
        &[
            "relay",
            "on off",
            "bang bang",
            "two position",
            "two point",
            "two step",
            "two level",
            "ideal relay",
            "ideal switch",
            "two level relay",
            "two position relay",
            "two point relay",
            "on off relay",
            "relay without hysteresis",
            "relay with no hysteresis",
            "ideal relay without hysteresis",
            "ideal relay with no hysteresis",
            "signum",
            "sign function",
            "signum function",
            "sgn",
            "sgn function",
        ],
    ),
    (
        NonlinearityKind::CoulombFriction,
        &[
            "coulomb friction",
            "coulomb",
            "coulombic",
            "coulombic friction",
            "coulomb dry friction",
            "dry friction",
            "stiction",
            "static friction",
            "sliding friction",
            "kinetic friction",
            "stick friction",
            "coulomb static friction",
            "friction",
        ],
    ),
    (NonlinearityKind::Hysteresis, &["hysteresis", "hysteretic"]),
    (
        NonlinearityKind::Quantization,
        &[
            "quantization",
            "quantisation",
            "quantizer",
            "quantiser",
            "quantized",
            "quantised",
            "quantizing",
            "quantization error",
            "quantisation error",
            "quantization noise",
            "rounding",
            "rounding off",
            "rounding error",
            "round off",
            "roundoff",
            "staircase",
            "digitization",
            "digitisation",
            "finite resolution",
            "limited resolution",
        ],
    ),
    (
        NonlinearityKind::RateLimit,
        &[
            "rate limiters",
            "rate limiter",
            "rate limiting",
            "rate limited",
            "slew rate limit",
            "slew rate limiter",
            "slew rate limiting",
            "slew rate limitation",
            "slew rate saturation",
            "slew limit",
            "limited slew rate",
            "limited rate",
            "limited speed",
            "rate limitation",
            "rate limits",
            "rate saturation",
            "rate of change limit",
            "rate of change limiter",
            "velocity limit",
            "velocity limiter",
            "velocity limitation",
            "velocity saturation",
            "speed limit",
            "speed limiter",
            "speed limitation",
            "speed saturation",
            "rate limit",
            "slew rate",
        ],
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
                ("stable, both poles in the LHP", Some(AsymptoticallyStable)),
                ("stable (both poles negative)", Some(AsymptoticallyStable)),
                ("stable (all poles in left half plane)", Some(AsymptoticallyStable)),
                ("stable - both real parts are negative", Some(AsymptoticallyStable)),
                ("stable as both poles are in the left half of the s-plane", Some(AsymptoticallyStable)),
                ("stable, no RHP poles", Some(AsymptoticallyStable)),
                ("stable, no poles in the right half-plane", Some(AsymptoticallyStable)),
                ("overdamped and stable", Some(AsymptoticallyStable)),
                ("unstable, double pole at the origin", Some(Unstable)),
                ("unstable (double integrator)", Some(Unstable)),
                ("it is not stable: double pole at 0", Some(Unstable)),
                ("not BIBO stable", Some(Unstable)),
                ("marginally stable (pole at the origin)", Some(MarginallyStable)),
                ("marginally stable, simple pole at the origin (integrator)", Some(MarginallyStable)),
                ("limit stable", Some(MarginallyStable)),
                ("on the stability limit", Some(MarginallyStable)),
                ("at the limit of stability", Some(MarginallyStable)),
                ("double integrator", None),
                ("both poles negative", None),
                ("stable? negative", None),
                ("not in the stability limit", None),
                ("no unstable poles", None),
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
                ("un-stable", Some(Unstable)),
                ("un stable", Some(Unstable)),
                ("no, unstable", Some(Unstable)),
                ("no, it is not stable", Some(Unstable)),
                ("stable? no", Some(Unstable)),
                ("Is it stable? No.", Some(Unstable)),
                ("unstable? Yes!", Some(Unstable)),
                ("No!", Some(Unstable)),
                ("yes, stable", Some(AsymptoticallyStable)),
                ("unstable because a pole is not in the left half plane", Some(Unstable)),
                ("unstable (one pole at 5.57 in the right half plane)", Some(Unstable)),
                ("stable, as all poles have negative real parts", Some(AsymptoticallyStable)),
                ("unstable or not stable", Some(Unstable)),
                ("unstable? no", None),
                ("no, stable", None),
                ("yes, unstable", None),
                ("One pole has a positive real part, so the system is unstable.", Some(Unstable)),
                ("if it were stable the poles would be left, so it is unstable", None),
                ("they said it is fine, so it is stable", None),
                ("lacks stability", None),
                ("the opposite of stable", None),
                ("the opposite is stable", None),
                ("stable is false", None),
                ("stable: false", None),
                ("stable = 0", None),
                ("far from stable", None),
                ("hardly stable", None),
                ("loses stability", None),
                ("less stable", None),
                ("almost stable", None),
                ("nearly stable", None),
                ("hardly unstable", None),
                ("far from unstable", None),
                ("unstable is false", None),
                ("nearly unstable", None),
                ("in-stable", None),
                ("meta-stable", None),
                ("isnt stable", None),
                ("anything but stable", None),
                ("stable, not at all", None),
                ("stable (not really)", None),
                ("stable because that is wrong", None),
                ("one pole is stable", None),
                ("stable with feedback", None),
                ("stable as well as unstable", None),
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
                ("deadzone (friction)", Some(DeadZone)),
                ("a deadzone, as the motor does not respond to small voltages", Some(DeadZone)),
                ("because of friction it has a dead zone", Some(DeadZone)),
                ("Because of the friction in the motor, a dead zone", Some(DeadZone)),
                ("dead zone or deadband", Some(DeadZone)),
                ("dead zone (deadband)", Some(DeadZone)),
                ("(dead zone)", Some(DeadZone)),
                ("[dead zone]", Some(DeadZone)),
                ("dead zone (because of friction)", Some(DeadZone)),
                ("saturation when the volume is too high", Some(Saturation)),
                ("the nonlinearity is called backlash", Some(Backlash)),
                ("the motor suffers from a dead zone", Some(DeadZone)),
                ("It stops although there is a small voltage left, so this is a dead zone.", Some(DeadZone)),
                ("I'd say backlash, since the gears are loose.", Some(Backlash)),
                ("dead zone in the motors of electric toys", Some(DeadZone)),
                ("dead zone\" onmouseover=\"alert(1)", Some(DeadZone)),
                ("dead zone of a relay", None),
                ("dead zone would be silly", None),
                ("dead zone is nonsense", None),
                ("it has backlash, so it is not a dead zone", None),
                ("dead zone is wrong", None),
                ("dead zone is false", None),
                ("wrong: dead zone", None),
                ("everything except dead zone", None),
                ("far from a dead zone", None),
                ("hardly a dead zone", None),
                ("the opposite of saturation", None),
                ("dead zone, not really", None),
                ("dead zone (wrong)", None),
                ("backlash (deadband)", None),
                ("dead zone (backlash)", None),
                ("saturation (dead zone)", None),
                ("dead zone because of friction, but really backlash", None),
                ("dead zone as well as backlash", None),
                ("because of backlash a dead zone", None),
                ("ideal relay", Some(Relay)),
                ("ideal relay without hysteresis", Some(Relay)),
                ("two-point controller", Some(Relay)),
                ("two-level relay", Some(Relay)),
                ("signum function", Some(Relay)),
                ("relay with hysteresis", None),
                ("free play", Some(Backlash)),
                ("Coulomb (dry) friction", Some(CoulombFriction)),
                ("sliding friction", Some(CoulombFriction)),
                ("Coulombic friction", Some(CoulombFriction)),
                ("rounding", Some(Quantization)),
                ("quantization (staircase)", Some(Quantization)),
                ("A/D quantization", Some(Quantization)),
                ("rounding of the A/D converter", Some(Quantization)),
                ("rate limitation", Some(RateLimit)),
                ("rate saturation", Some(RateLimit)),
                ("velocity saturation", Some(RateLimit)),
                ("speed limit of the actuator", Some(RateLimit)),
                ("dead band", Some(DeadZone)),
                ("insensitive zone", Some(DeadZone)),
                ("hard limiter", Some(Saturation)),
                ("rate limit and saturation", None),
                ("no free play", None),
                ("due to friction", None),
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
                ("rises exponentially", Some(ExponentialGrowth)),
                ("rises exponentially to a final value", Some(ExponentialDecay)),
                ("rises monotonically to 0.0999 rad/s", Some(ExponentialDecay)),
                ("rises monotonically towards the final value", Some(ExponentialDecay)),
                ("rises exponentially to infinity", Some(ExponentialGrowth)),
                ("increases exponentially to infinity", Some(ExponentialGrowth)),
                ("rises linearly to 5", None),
                ("rises to a value and overshoots", None),
                ("rises to its value with overshoot", None),
                ("aperiodic", Some(ExponentialDecay)),
                ("aperiodic rise without overshoot", Some(ExponentialDecay)),
                ("aperiodic growth", Some(ExponentialGrowth)),
                ("S-shaped", Some(ExponentialDecay)),
                ("settles without overshoot", Some(ExponentialDecay)),
                ("rises without overshoot", Some(ExponentialDecay)),
                ("overdamped, no oscillation", Some(ExponentialDecay)),
                ("first-order-like", Some(ExponentialDecay)),
                ("exponential approach", Some(ExponentialDecay)),
                ("monotonic rise", None),
                ("grows linearly to infinity", Some(PolynomialGrowth)),
                ("not aperiodic", None),
                ("the opposite of exponential decay", None),
                ("hardly a decaying oscillation", None),
                ("exponential growth is wrong", None),
                ("decaying oscillation or damped sinusoid", Some(DecayingOscillation)),
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
            ("exponential", Some(HalfShape::Exponential)),
            ("An exponential curve.", Some(HalfShape::Exponential)),
            ("oscillates", Some(HalfShape::Oscillation)),
            ("exponential rise", Some(HalfShape::Exponential)),
            ("rises exponentially", Some(HalfShape::Exponential)),
            ("monotonic rise", Some(HalfShape::Exponential)),
            ("monotone", Some(HalfShape::Exponential)),
            ("rises", None),
            ("decaying", None),
            ("exponential oscillation", None),
            ("", None),
        ] {
            assert_eq!(half_a_shape(text), half, "{text}");
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
