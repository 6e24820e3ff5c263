//! Transfer functions as MATLAB and Python call for them: `tf([1 2], [1 0 3])`, `zpk([], [-1 -2], 5)`.

use super::Decimal;
use super::comma_to_point::comma_in_list_text;
use super::poles::{ReadPole, parse_poles};
use super::problem::Problem;
use crate::algebra::{Polynomial, Rational};
use crate::lti::TransferFunction;

/// `tf`, `zpk` or `ss`, and what stands between its parentheses, split at the commas between the parts.
pub(super) struct Call<'t> {
    name: &'static str,
    parts: Vec<&'t str>,
}

/// A call of one of these, and nothing else, whatever package it is of: `control.tf(…)`, `signal.TransferFunction(…);`
pub(super) fn call(text: &str) -> Option<Call<'_>> {
    const NAMES: &[(&str, &str)] = &[
        ("tf", "tf"),
        ("zpk", "zpk"),
        ("ss", "ss"),
        ("TransferFunction", "tf"),
        ("ZerosPolesGain", "zpk"),
        ("StateSpace", "ss"),
    ];
    const PACKAGES: &[&str] = &["control.", "ct.", "co.", "ctrl.", "signal.", "scipy.signal.", "matlab."];
    let body = text.trim().trim_end_matches([';', '.']).trim_end();
    let bare = PACKAGES.iter().find_map(|package| body.strip_prefix(package)).unwrap_or(body);
    let (head, inner) = bare.split_once('(')?;
    let name = NAMES.iter().find(|(written, _)| head.trim() == *written)?.1;
    let inner = inner.strip_suffix(')')?;
    let (mut parts, mut depth, mut from) = (Vec::new(), 0i32, 0);
    for (at, c) in inner.char_indices() {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(inner[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
        if depth < 0 {
            return None;
        }
    }
    parts.push(inner[from..].trim());
    // `tf('s')` and `tf("1/(s + 1)")` are no lists.
    let quoted = parts.iter().any(|part| part.contains(['\'', '"']));
    (depth == 0 && !quoted).then_some(Call { name, parts })
}

const HELP: &str =
    "Write `tf([0.5 0], [1 2 5])`, highest power first, or a formula like `0.5s / (s^2 + 2s + 5)`.";

impl Call<'_> {
    /// The transfer function; `coefficients` reads a list of numbers.
    pub fn read(
        &self,
        code: &'static str,
        (start, end): (usize, usize),
        coefficients: impl Fn(&str) -> Option<Vec<Rational>>,
    ) -> Result<TransferFunction, Problem> {
        let problem = |message: &str| Problem::new(code, start, end, message).help(HELP);
        if let Some(comma) = self.parts.iter().find_map(|part| comma_in_list_text(part)) {
            return Err(Problem { start, end, ..comma });
        }
        let (num, den) = match (self.name, self.parts.as_slice()) {
            ("tf", [num, den]) => {
                let list = |list| coefficients(list).map(Polynomial::new);
                let read = || Some((list(num)?, list(den)?));
                read().ok_or_else(|| problem("This `tf(…)` cannot be read."))?
            }
            ("tf", _) => return Err(problem("A `tf(…)` has two lists, numerator and denominator.")),
            ("zpk", [zeros, poles, gain]) => {
                let gain = Decimal::parse(gain.trim_matches(['[', ']']))
                    .map_err(|_| problem("The gain of this `zpk(…)` is not a number."))?;
                let roots = |text: &str| {
                    roots(text).ok_or_else(|| {
                    problem("The zeros and poles of a `zpk(…)` are lists of numbers, complex ones with their conjugates.")
                })
                };
                (roots(zeros)?.scale(&gain.value), roots(poles)?)
            }
            ("zpk", _) => return Err(problem("A `zpk(…)` has three parts: zeros, poles and the gain.")),
            _ => {
                let message = "A state-space model is given here, and a transfer function is asked for.";
                let help = "Write what `tf(ss(A, B, C, D))` gives: numerator and denominator.";
                return Err(Problem::new(code, start, end, message).help(help));
            }
        };
        TransferFunction::new(num, den).ok_or_else(|| problem("The denominator is zero."))
    }
}

/// The polynomial with leading coefficient 1 that has these roots; `None` unless it is real.
fn roots(text: &str) -> Option<Polynomial> {
    let inner = text.trim_matches(['[', ']', ' ']);
    if inner.is_empty() {
        return Some(Polynomial::new(vec![Rational::ONE]));
    }
    let listed = format!("[{inner}]");
    let mut left: Vec<ReadPole> = parse_poles(&listed).ok()?;
    let mut product = Polynomial::new(vec![Rational::ONE]);
    while let Some(root) = left.pop() {
        let (re, im) = (root.re.value, root.im.value);
        let factor = if im == Rational::ZERO {
            vec![Rational::ONE, -re]
        } else {
            let conjugate =
                left.iter().position(|other| other.re.value == re && other.im.value == -im.clone())?;
            left.swap_remove(conjugate);
            vec![Rational::ONE, Rational::from(-2) * &re, &re * &re + &im * &im]
        };
        product = &product * &Polynomial::new(factor);
    }
    Some(product)
}
