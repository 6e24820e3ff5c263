//! What may stand beside the word that answers a question: only words known to leave its meaning as it is.

/// Words and phrases that may stand beside a class.
pub(super) struct Beside {
    /// Anywhere.
    anywhere: &'static [&'static [&'static str]],
    /// Only after a class.
    after: &'static [&'static str],
    /// Whether other words may follow a class too, as long as none of them says something about it.
    free_tail: bool,
}

/// The classes a text names, in its order; `None` when a word stands beside them that is not known to be harmless.
///
/// The longest phrase counts: `not stable` names what `not stable` stands for, and not also `stable`.
pub(super) fn classes<T: Copy>(words: &[&str], phrases: &[(T, &[&str])], beside: &Beside) -> Option<Vec<T>> {
    let class = |rest: &[&str]| {
        let begin = phrases.iter().filter_map(|(class, phrases)| Some((longest(rest, phrases)?, *class)));
        begin.max_by_key(|(length, _)| *length)
    };
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let rest = &words[at..];
        if let Some((length, class)) = class(rest) {
            found.push(class);
            at += length;
        } else if found.is_empty()
            && let Some(length) = subject(rest)
        {
            // `the unstable system is stable` names two.
            if (1..length).any(|i| class(&rest[i..]).is_some()) {
                return None;
            }
            at += length;
        } else {
            let known = beside.length(rest, words[..at].last().copied(), !found.is_empty());
            at += known.or_else(|| (!found.is_empty() && beside.is_free_tail(rest)).then_some(1))?;
        }
    }
    Some(found)
}

/// Whether a remark (`friction`, `a pole in the right half plane`) leaves the answer before it as it is.
pub(super) fn is_harmless(remark: &str, beside: &Beside) -> bool {
    let lower = remark.to_lowercase();
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let mut at = 0;
    while at < words.len() {
        let rest = &words[at..];
        let number = rest[0] != "0" && rest[0].bytes().all(|b| b.is_ascii_digit());
        let cause = longest(rest, &["friction"]).or(number.then_some(1));
        let Some(length) = cause.or_else(|| beside.length(rest, words[..at].last().copied(), true)) else {
            return false;
        };
        at += length;
    }
    true
}

/// The words after `because of friction`, `due to the friction in the motor` at the beginning; else all.
pub(super) fn after_cause<'w, 't>(words: &'w [&'t str]) -> &'w [&'t str] {
    let Some(intro) = longest(words, &["because of", "due to", "owing to"]) else { return words };
    let cause = &words[intro..];
    let told = |word: &&&str| {
        ["a", "the", "its", "in", "of", "static", "dry", "coulomb", "friction", "stiction"].contains(*word)
            || NOUNS.contains(*word)
    };
    let length = cause.iter().take_while(told).count();
    if cause[..length].iter().any(|word| ["friction", "stiction"].contains(word)) {
        &cause[length..]
    } else {
        words
    }
}

impl Beside {
    fn is_free_tail(&self, rest: &[&str]) -> bool {
        self.free_tail && !rest.iter().any(|word| TURNS.contains(word) || PREDICATES.contains(word))
    }

    /// How many words at the start of `rest` are harmless together.
    fn length(&self, rest: &[&str], before: Option<&str>, after_class: bool) -> Option<usize> {
        let anywhere = self.anywhere.iter().filter_map(|phrases| longest(rest, phrases)).max();
        if !after_class {
            return anywhere;
        }
        let number = rest[0].bytes().all(|b| b.is_ascii_digit())
            && before.is_some_and(|word| {
                word.bytes().all(|b| b.is_ascii_digit()) || BEFORE_NUMBERS.contains(&word)
            });
        anywhere.max(longest(rest, self.after)).or(number.then_some(1))
    }
}

/// `the pendulum-cart system is`: a subject of words we need not know, up to its verb.
fn subject(words: &[&str]) -> Option<usize> {
    const MOST_WORDS: usize = 5;
    if !["the", "this", "our"].contains(words.first()?) {
        return None;
    }
    let verb = words.iter().take(MOST_WORDS + 1).position(|word| VERBS.contains(word))?;
    let named = &words[1..verb];
    let clear = !named.iter().any(|word| TURNS.contains(word) || OTHERS.contains(word));
    (clear && named.last().is_some_and(|word| NOUNS.contains(word))).then_some(verb + 1)
}

/// How many words of the longest of these phrases begin `words`.
fn longest(words: &[&str], phrases: &[&str]) -> Option<usize> {
    let begins = |phrase: &&str| {
        let length = phrase.split(' ').count();
        (length <= words.len() && phrase.split(' ').eq(words[..length].iter().copied())).then_some(length)
    };
    phrases.iter().filter_map(begins).max()
}

/// Words that turn what stands beside them, or leave it in doubt.
pub(super) const TURNS: &[&str] = &[
    "opposite",
    "contrary",
    "inverse",
    "reverse",
    "hardly",
    "barely",
    "scarcely",
    "rarely",
    "seldom",
    "almost",
    "nearly",
    "lack",
    "lacks",
    "lacking",
    "lose",
    "loses",
    "losing",
    "except",
    "excluding",
    "far",
    "wrong",
    "false",
    "untrue",
    "incorrect",
    "mistaken",
    "impossible",
    "unlike",
    "less",
    "anything",
    "nothing",
    "instead",
    "rather",
    "fails",
    "fail",
    "failing",
    "however",
    "although",
    "though",
    "actually",
    "nevertheless",
    "un",
    "cannot",
    "avoid",
    "avoids",
    "absent",
    "doubt",
    "doubtful",
    "vanishes",
    "disappears",
    "removed",
    "excluded",
    "missing",
    "compensated",
    "avoided",
    "nonsense",
];

/// Words that say something about what stands before them, or leave it open.
const PREDICATES: &[&str] = &[
    "is", "are", "was", "were", "be", "been", "isn", "would", "could", "should", "might", "may", "can",
    "does", "do", "did", "has", "had", "have", "seems", "appears", "not", "no", "non", "never", "neither",
    "nor", "none", "without", "or", "if", "unless", "maybe", "perhaps", "but", "either", "depends", "until",
    "than",
];

/// Words that make a subject another one than is asked about.
const OTHERS: &[&str] = &[
    "other",
    "another",
    "not",
    "no",
    "non",
    "never",
    "neither",
    "only",
    "if",
    "or",
    "ideal",
    "same",
    "different",
    "next",
    "previous",
    "former",
    "second",
    "any",
    "some",
    "few",
    "wants",
    "was",
    "of",
    "that",
    "than",
    "without",
    "from",
    "to",
];

const VERBS: &[&str] = &["is", "are", "has", "shows", "exhibits", "behaves", "remains"];

const ARTICLES: &[&str] = &[
    "a",
    "an",
    "the",
    "this",
    "that",
    "our",
    "its",
    "it",
    "s",
    "is",
    "are",
    "was",
    "be",
    "will",
    "has",
    "have",
    "having",
    "shows",
    "showing",
    "exhibits",
    "remains",
    "and",
    "of",
    "so",
    "thus",
    "hence",
    "therefore",
    "we",
    "there",
    "answer",
    "i e",
    "ie",
    "i think",
    "i say",
    "i d say",
    "i would say",
    "i believe",
    "we think",
    "we see",
    "clearly",
    "definitely",
    "certainly",
    "obviously",
    "very",
    "seems",
    "looks",
    "appears",
    "to be",
    "in a",
    "in an",
    "in the",
    "on the",
    "at the",
    "for the",
    "case",
    "here",
    "also",
    "yes",
];

const NOUNS: &[&str] = &[
    "system",
    "systems",
    "plant",
    "process",
    "model",
    "loop",
    "response",
    "output",
    "input",
    "signal",
    "function",
    "equilibrium",
    "position",
    "point",
    "state",
    "behaviour",
    "behavior",
    "pendulum",
    "motor",
    "motors",
    "engine",
    "actuator",
    "amplifier",
    "speaker",
    "loudspeaker",
    "sensor",
    "valve",
    "gear",
    "gears",
    "gearbox",
    "gearing",
    "gear train",
    "teeth",
    "wheel",
    "wheels",
    "steering",
    "servo",
    "controller",
    "device",
    "toy",
    "car",
    "transmission",
    "mechanism",
    "joint",
    "drive",
    "battery",
    "voltage",
    "current",
    "power",
    "circuit",
    "tank",
    "shaft",
    "brake",
    "machine",
    "robot",
];

const BEFORE_NUMBERS: &[&str] =
    &["at", "s", "pole", "poles", "root", "roots", "eigenvalue", "eigenvalues", "width", "of", "about"];

pub(super) const BESIDE_STABILITY: Beside = Beside {
    anywhere: &[
        ARTICLES,
        NOUNS,
        &[
            "bibo",
            "asymptotically",
            "exponentially",
            "globally",
            "locally",
            "internally",
            "externally",
            "open",
            "closed",
            "linear",
            "linearized",
            "linearised",
            "completely",
            "totally",
            "fully",
            "highly",
            "inherently",
            "intrinsically",
            "naturally",
            "strictly",
            "always",
            "transfer",
            "all poles",
            "all the poles",
            "inverted",
            "overdamped",
            "underdamped",
            "critically damped",
            "damped",
        ],
    ],
    after: &[
        "both",
        "all",
        "both poles",
        "double pole",
        "double",
        "simple pole",
        "simple",
        "single",
        "integrator",
        "double integrator",
        "origin",
        "left",
        "left half",
        "half",
        "half plane",
        "s plane",
        "plane",
        "complex plane",
        "poles negative",
        "both poles negative",
        "all poles negative",
        "all poles are negative",
        "both poles are negative",
        "both negative",
        "all negative",
        "negative poles",
        "poles are negative",
        "are negative",
        "is negative",
        "parts are negative",
        "real parts",
        "no rhp pole",
        "no rhp poles",
        "no pole in the rhp",
        "no poles in the rhp",
        "no pole in the right half plane",
        "no poles in the right half plane",
        "no pole in the right half",
        "no poles in the right half",
        "no unstable pole",
        "no unstable poles",
        "no positive pole",
        "no positive poles",
        "in",
        "on",
        "at",
        "near",
        "around",
        "with",
        "with a",
        "pole",
        "poles",
        "root",
        "roots",
        "eigenvalue",
        "eigenvalues",
        "lie",
        "lies",
        "located",
        "one pole",
        "two poles",
        "three poles",
        "all its poles",
        "one positive pole",
        "a positive pole",
        "one real positive pole",
        "negative real part",
        "negative real parts",
        "positive real part",
        "positive real parts",
        "right half plane",
        "left half plane",
        "right half s plane",
        "left half s plane",
        "right hand plane",
        "left hand plane",
        "rhp",
        "lhp",
        "orhp",
        "olhp",
        "imaginary axis",
    ],
    free_tail: false,
};

pub(super) const BESIDE_NONLINEARITY: Beside = Beside {
    anywhere: &[
        ARTICLES,
        NOUNS,
        &[
            "nonlinearity",
            "non linearity",
            "nonlinearities",
            "nonlinear",
            "type",
            "kind",
            "effect",
            "effects",
            "phenomenon",
            "characteristic",
            "class",
            "element",
            "block",
            "called",
            "named",
            "known as",
            "such as",
            "suffers from",
            "suffering from",
            "comes from",
            "results from",
            "acts like",
            "acts as",
            "behaves like",
            "looks like",
            "in",
            "of",
            "at",
            "on",
            "at its",
            "between",
            "mechanical",
            "hard",
            "static",
            "electrical",
            "magnetic",
            "audio",
            "remote",
            "control",
            "controlled",
            "small",
            "large",
            "high",
            "low",
            "typical",
            "example",
            "e g",
            "eg",
            "caused",
            "simple",
            "dry",
            "ideal",
            "a d",
            "ad",
            "adc",
            "converter",
            "analog",
            "digital",
            "function",
            "error",
        ],
    ],
    after: &[
        "is present",
        "is seen",
        "is visible",
        "is shown",
        "is the answer",
        "is the nonlinearity",
        "occurs",
        "happens",
        "exists",
        "width",
        "v",
        "volt",
        "volts",
        "limit",
        "limits",
        "volume",
        "voltages",
        "inputs",
        "signals",
        "values",
        "around",
        "about",
        "zero",
        "origin",
        "range",
        "region",
    ],
    free_tail: true,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subject_may_have_any_words_that_do_not_turn_it() {
        for (text, length) in [
            ("the pendulum cart system is stable", Some(5)),
            ("this system is stable", Some(3)),
            ("the opposite system is stable", None),
            ("the other system is stable", None),
            ("the far too long list of words before the system is stable", None),
            ("the pendulum stable", None),
            ("some system is stable", None),
            ("the", None),
            ("", None),
        ] {
            let words: Vec<&str> = text.split_whitespace().collect();
            assert_eq!(subject(&words), length, "{text}");
        }
    }
}
