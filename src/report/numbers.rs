//! Numbers as people read them; templates never see a bare number.

use crate::algebra::significant;

/// `value` to `figures` significant figures with typographic minus and power of ten: `−0.0132`, `1.2×10⁻⁷`.
pub fn number(value: f64, figures: usize) -> String {
    typographic(&significant(value, figures))
}

/// `number` and its unit, parted by a no-break space; the unit may be empty.
pub fn quantity(value: f64, figures: usize, unit: &str) -> String {
    let value = number(value, figures);
    if unit.is_empty() { value } else { format!("{value}\u{a0}{unit}") }
}

/// `-5.59e-7` → `−5.59×10⁻⁷`.
pub fn typographic(ascii: &str) -> String {
    let text = match ascii.split_once('e') {
        Some((mantissa, exponent)) if exponent.trim_start_matches(['-', '+']).parse::<u32>().is_ok() => {
            let raised: String = exponent.chars().map(superscript).collect();
            format!("{mantissa}×10{raised}")
        }
        _ => ascii.to_owned(),
    };
    text.replace('-', "−")
}

/// ASCII mathematics in running text as print has it: `-0.0132s^3` → `−0.0132s³`, `kg m^2` → `kg m²`. A hyphen between letters
/// stays one.
pub fn typeset(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let mut i = 0;
    while i < letters.len() {
        let next = letters.get(i + 1).copied();
        match letters[i] {
            '^' if next.is_some_and(|c| c.is_ascii_digit() || c == '-') => {
                let digits = |from: usize| letters[from..].iter().take_while(|c| c.is_ascii_digit()).count();
                let mut end = i + 2 + digits(i + 2);
                // `m^2.5`, but not the full stop after `m^2.`
                if letters.get(end) == Some(&'.') && digits(end + 1) > 0 {
                    end += 1 + digits(end + 1);
                }
                out.extend(letters[i + 1..end].iter().map(|c| if *c == '.' { '·' } else { superscript(*c) }));
                i = end;
                continue;
            }
            '-' => {
                let opens = i == 0 || matches!(letters[i - 1], ' ' | '(' | '[' | ',' | '/' | '±' | '“');
                let counts = next.is_some_and(|c| c.is_ascii_digit() || matches!(c, '.' | ' ' | '(' | '∞'));
                out.push(if opens && counts { '−' } else { '-' });
            }
            c => out.push(c),
        }
        i += 1;
    }
    out
}

/// `−0.02 ± 5.59j`, `−0.143`, `3j`: a number or a conjugate pair.
pub fn complex(re: f64, im: f64, pair: bool, figures: usize) -> String {
    if im == 0.0 {
        return number(re, figures);
    }
    let size = number(im.abs(), figures);
    let sign = match (pair, im < 0.0) {
        (true, _) => "±",
        (false, true) => "−",
        (false, false) => "+",
    };
    match (re == 0.0, sign) {
        (true, "+") => format!("{size}j"),
        (true, sign) => format!("{sign}{size}j"),
        (false, sign) => format!("{} {sign} {size}j", number(re, figures)),
    }
}

/// `1 point`, `0.5 points`, `3 curves`.
pub fn counted(amount: impl std::fmt::Display, noun: &str) -> String {
    let amount = amount.to_string();
    let plural = if amount == "1" { "" } else { "s" };
    format!("{amount} {noun}{plural}")
}

/// A name as it is written in print: `theta` → θ, `omega_n` → ω_n.
pub fn letter(name: &str) -> String {
    let (stem, rest) = name.find(['_', '\'']).map_or((name, ""), |i| name.split_at(i));
    let greek = match stem {
        "alpha" => "α",
        "beta" => "β",
        "gamma" => "γ",
        "delta" => "δ",
        "epsilon" => "ε",
        "zeta" => "ζ",
        "eta" => "η",
        "theta" => "θ",
        "kappa" => "κ",
        "lambda" => "λ",
        "mu" => "μ",
        "nu" => "ν",
        "xi" => "ξ",
        "pi" => "π",
        "rho" => "ρ",
        "sigma" => "σ",
        "tau" => "τ",
        "phi" => "φ",
        "chi" => "χ",
        "psi" => "ψ",
        "omega" => "ω",
        "Delta" => "Δ",
        "Theta" => "Θ",
        "Phi" => "Φ",
        "Omega" => "Ω",
        other => other,
    };
    format!("{greek}{rest}")
}

fn superscript(c: char) -> char {
    match c {
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        '-' => '⁻',
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(String, &str)]) {
        for (got, expected) in rows {
            assert_eq!(got, expected);
        }
    }

    #[test]
    fn numbers_are_set_like_print() {
        check(&[
            (typographic("-0.0132"), "−0.0132"),
            (typographic("1.2e-7"), "1.2×10⁻⁷"),
            (typographic("not a number"), "not a number"),
            (complex(-0.02, 5.59, true, 3), "−0.02 ± 5.59j"),
            (complex(-0.02, -5.59, false, 3), "−0.02 − 5.59j"),
            (complex(0.0, 3.0, true, 3), "±3j"),
            (complex(0.0, 3.0, false, 3), "3j"),
            (complex(-0.143, 0.0, false, 3), "−0.143"),
            (counted(1, "point"), "1 point"),
            (counted("0.5", "point"), "0.5 points"),
            (typeset("-0.0132s^3 - 0.41s (g = -9.8)"), "−0.0132s³ − 0.41s (g = −9.8)"),
            (typeset("kg m^2, s^-1, 2021-04, dead-zone"), "kg m², s⁻¹, 2021-04, dead-zone"),
            (typeset("cm^2.5/s, m^2."), "cm²·⁵/s, m²."),
            (typeset("a^, ^"), "a^, ^"),
            (letter("theta"), "θ"),
            (letter("x"), "x"),
            (letter("omega_n"), "ω_n"),
        ]);
    }
}
