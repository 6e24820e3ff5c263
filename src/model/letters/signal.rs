use crate::algebra::symbol_mathml;

/// A coordinate or an input, its derivatives, or its transform.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    pub name: String,
    pub primes: u8,
    /// It is not 0 at rest, so that its deviation has a name of its own: δh.
    pub deviates: bool,
    /// In s: X(s).
    pub transformed: bool,
    /// Its name as a transform is that of another: it stays as it is, h(s).
    pub(super) keeps_name: bool,
}

impl Signal {
    /// `x''`, `delta h'`, `X(s)`.
    pub fn to_text(&self) -> String {
        if self.transformed {
            return format!("{}(s)", self.transform_name());
        }
        let delta = if self.deviates { "delta " } else { "" };
        format!("{delta}{}{}", self.name, "'".repeat(self.primes.into()))
    }

    /// MathML without the `<math>` around it.
    pub fn to_mathml(&self) -> String {
        if self.transformed {
            let name = symbol_mathml(&self.transform_name(), 0);
            return format!(
                "<mrow>{name}<mo>\u{2061}</mo><mo stretchy=\"false\">(</mo><mi>s</mi><mo stretchy=\"false\">)</mo></mrow>"
            );
        }
        let delta = if self.deviates { "<mi mathvariant=\"normal\">δ</mi><mo>\u{2062}</mo>" } else { "" };
        let name = symbol_mathml(&self.name, self.primes);
        if delta.is_empty() { name } else { format!("<mrow>{delta}{name}</mrow>") }
    }

    fn transform_name(&self) -> String {
        if self.keeps_name { self.name.clone() } else { capital(&self.name) }
    }
}

/// x → X, theta → Theta, h1 → H1; a Greek letter whose capital is a Latin one stays small.
pub(super) fn capital(name: &str) -> String {
    const SAME_AS_LATIN: [&str; 13] = [
        "alpha", "beta", "epsilon", "zeta", "eta", "iota", "kappa", "mu", "nu", "rho", "tau", "upsilon",
        "chi",
    ];
    let base: &str = name.split('_').next().unwrap_or(name).trim_end_matches(|c: char| c.is_ascii_digit());
    if SAME_AS_LATIN.contains(&base) {
        return name.to_owned();
    }
    let mut letters = name.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
