use std::borrow::Cow;

/// Marks of mathematics and code around a formula or a value: `$…$`, `\(…\)`, backticks.
const PAIRS: &[(&str, &str)] =
    &[("$$", "$$"), ("\\[", "\\]"), ("\\(", "\\)"), ("```", "```"), ("$", "$"), ("`", "`")];

/// Units of factor 1 that may stand after a transfer function.
const UNITS: &[&str] = &[
    "rad/N",
    "rad/(N)",
    "rad/V",
    "rad/(V)",
    "rad/s/V",
    "(rad/s)/V",
    "rad/(V s)",
    "rad/(s V)",
    "rad/(V·s)",
    "rad/(s·V)",
    "rad/(V*s)",
    "rad/(s*V)",
    "rad/Nm",
    "rad/(Nm)",
    "rad/(N m)",
    "rad/(N·m)",
    "m/N",
    "m/(N)",
    "m/V",
    "m/(V)",
    "m/s/V",
    "V/V",
    "rad/A",
    "rad/m",
    "rad",
];

/// The text with spaces for marks around all of it and for a full stop at its end; byte for byte as long as it was.
pub(super) fn unwrapped(text: &str) -> Cow<'_, str> {
    let (mut start, mut end) = (0, text.len());
    loop {
        let inner = &text[start..end];
        let body = inner.trim();
        let from = start + (inner.len() - inner.trim_start().len());
        let to = from + body.len();
        if let Some(rest) = body.strip_suffix('.').filter(|rest| !rest.is_empty() && !rest.ends_with('.')) {
            (start, end) = (from, from + rest.len());
            continue;
        }
        let around = PAIRS.iter().find(|(open, close)| {
            let inner = body.strip_prefix(open).and_then(|rest| rest.strip_suffix(close));
            // `$a$ / $b$` is two formulas.
            inner.is_some_and(|inner| !inner.is_empty() && !inner.contains(open) && !inner.contains(close))
        });
        match around {
            Some((open, close)) => (start, end) = (from + open.len(), to - close.len()),
            None => return blank_outside(text, start, end),
        }
    }
}

/// The text without a unit such as `rad/N` or `(rad/N)` after its formula; `known`: a letter that is no unit here.
///
/// Byte for byte as long as it was.
pub(super) fn without_unit(text: &str, known: impl Fn(&str) -> bool) -> Cow<'_, str> {
    let body = text.trim_end();
    let length = |unit: &&str| {
        let brackets = [("", ""), ("(", ")"), ("[", "]")];
        brackets.iter().find_map(|(open, close)| {
            let head = body.strip_suffix(close)?.strip_suffix(*unit)?.strip_suffix(open)?;
            (head.ends_with(char::is_whitespace) && !head.trim().is_empty()).then_some(head.len())
        })
    };
    // `… / (s + 1) m/N` may divide by a mass.
    let plain = |unit: &&&str| !unit.split(|c: char| !c.is_alphabetic()).any(&known);
    match UNITS.iter().filter(plain).filter_map(length).min() {
        Some(end) if !text[..end].trim_end().ends_with(['/', '*', '+', '-', '(', '=', '^']) => {
            blank_outside(text, 0, end)
        }
        _ => Cow::Borrowed(text),
    }
}

/// The text with spaces for all marks of mathematics and code, and `±` for `\pm`; byte for byte as long as it was.
pub(super) fn without_marks(text: &str) -> Cow<'_, str> {
    if !text.contains(['$', '`', '\\']) {
        return Cow::Borrowed(text);
    }
    let mut plain = text.replace(['$', '`'], " ").replace("\\pm", "± ").replace("\\mp", "± ");
    for mark in ["\\(", "\\)", "\\[", "\\]", "\\,", "\\;", "\\ "] {
        plain = plain.replace(mark, "  ");
    }
    Cow::Owned(plain)
}

fn blank_outside(text: &str, start: usize, end: usize) -> Cow<'_, str> {
    if (start, end) == (0, text.len()) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(format!("{}{}{}", " ".repeat(start), &text[start..end], " ".repeat(text.len() - end)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_around_a_formula_become_spaces() {
        for (text, expected) in [
            ("$1/s$", " 1/s "),
            ("$$ 1/s $$", "   1/s   "),
            ("\\[1/s\\].", "  1/s   "),
            ("\\(1/s\\)", "  1/s  "),
            ("`$1/s$`", "  1/s  "),
            (" 1/s. ", " 1/s  "),
            ("1/s", "1/s"),
            ("$a$/$b$", "$a$/$b$"),
            ("...", "..."),
            (".", "."),
            ("$$", "$$"),
            ("", ""),
        ] {
            assert_eq!(unwrapped(text), expected, "{text:?}");
            assert_eq!(unwrapped(text).len(), text.len(), "{text:?}");
        }
    }

    #[test]
    fn a_unit_after_a_formula_becomes_spaces() {
        for (text, expected) in [
            ("1/(s+1) rad/N", "1/(s+1)"),
            ("1/(s+1) rad/(N)", "1/(s+1)"),
            ("1/(s+1) (rad/N)", "1/(s+1)"),
            ("1/(s+1) [rad/N] ", "1/(s+1)"),
            ("1/(s+1) (rad/s)/V", "1/(s+1)"),
            ("1/(s+1) m/N", "1/(s+1) m/N"),
            ("1/(s+1) deg/N", "1/(s+1) deg/N"),
            ("1/ rad", "1/ rad"),
            ("rad/N", "rad/N"),
        ] {
            let found = without_unit(text, |letter| letter == "m");
            assert_eq!(found.trim_end(), expected, "{text:?}");
            assert_eq!(found.len(), text.len(), "{text:?}");
        }
    }

    #[test]
    fn marks_between_numbers_become_spaces() {
        for (text, expected) in [
            ("$-0.1$, $2$", " -0.1 ,  2 "),
            ("$-1 \\pm 2j$", " -1 ±  2j "),
            ("\\(0\\)", "  0  "),
            ("-1", "-1"),
        ] {
            assert_eq!(without_marks(text), expected, "{text:?}");
            assert_eq!(without_marks(text).len(), text.len(), "{text:?}");
        }
    }
}
