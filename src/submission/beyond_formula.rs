//! What stands in a formula's field besides one formula on one line: a fraction printed over a rule, and values set
//! before or after it.

use super::problem::{Problem, quote};
use crate::algebra::{Rational, parse_decimal};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The rule of a fraction as programs print it, three strokes or more: its bytes. `Err`: there are several.
///
/// ```text
///       2 s + 1
///   ---------------
///   s^2 + 2 s + 5
/// ```
pub(super) fn fraction_rule(text: &str) -> Result<Option<(usize, usize)>, (usize, usize)> {
    let mut rules: Vec<(usize, usize)> = Vec::new();
    let mut run: Option<(usize, usize, usize)> = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        let stroke = matches!(c, '-' | '−' | '–' | '—' | '─' | '_' | '‐');
        run = match (run, stroke) {
            (None, true) => Some((at, at + c.len_utf8(), 1)),
            (Some((start, _, count)), true) => Some((start, at + c.len_utf8(), count + 1)),
            (Some((start, end, count)), false) => {
                if count >= 3 {
                    rules.push((start, end));
                }
                None
            }
            (None, false) => None,
        };
    }
    match rules.as_slice() {
        [] => Ok(None),
        [rule] => Ok(Some(*rule)),
        [_, second, ..] => Err(*second),
    }
}

/// The text with spaces for what sets a value beside the formula: `s = tf('s');` before it, `, g = 9.81` after it.
///
/// Byte for byte as long as it was; `true` when something behind the formula was left out, which is harmless only if
/// the formula has no letters. Anything else that is set (`where q = …`) cannot be left out: a [`Problem`].
pub(super) fn without_assignments<'t>(
    text: &'t str,
    symbols: &BTreeMap<String, Rational>,
    code: &'static str,
) -> Result<(Cow<'t, str>, bool), Problem> {
    let mut rest = match tf_of_s(text) {
        Some(end) => Cow::Owned(" ".repeat(end) + &text[end..]),
        None => Cow::Borrowed(text),
    };
    let mut left_out = false;
    while let Some((from, name, value)) = assignment(&rest) {
        if !(symbols.contains_key(name) && parse_decimal(value).is_ok()) {
            let message = format!("Something else is set beside the formula here: {}.", quote(&rest[from..]));
            let help =
                "Write one formula, with numbers or the lab's letters put in; or `{num: […], den: […]}`.";
            return Err(Problem::new(code, from, rest.len(), message).help(help));
        }
        rest = Cow::Owned(format!("{}{}", &rest[..from], " ".repeat(rest.len() - from)));
        left_out = true;
    }
    Ok((rest, left_out))
}

/// The text with spaces for the lines with which programs head a fraction: `Transfer function:`, `Inputs (1): ['u[0]']`.
///
/// Byte for byte as long as it was.
pub(super) fn without_headings(text: &str) -> Cow<'_, str> {
    const HEADS: &[&str] = &[
        "<TransferFunction",
        "<LinearICSystem",
        "Inputs (",
        "Outputs (",
        "Transfer function:",
        "Zero/pole/gain:",
        "From input",
        ">>",
    ];
    let heads = |line: &str| HEADS.iter().any(|head| line.trim_start().starts_with(head));
    let Some(last) = text.trim_end().rfind('\n') else { return Cow::Borrowed(text) };
    if !text[..last].lines().any(heads) {
        return Cow::Borrowed(text);
    }
    let blanked = text.split_inclusive('\n').map(|line| match heads(line) {
        true => {
            line.chars().map(|c| if c == '\n' { "\n".to_owned() } else { " ".repeat(c.len_utf8()) }).collect()
        }
        false => line.to_owned(),
    });
    Cow::Owned(blanked.collect())
}

/// Where MATLAB's `s = tf('s');` at the beginning ends.
fn tf_of_s(text: &str) -> Option<usize> {
    let mut rest = text.trim_start();
    for part in ["s", "=", "tf", "("] {
        rest = rest.strip_prefix(part)?.trim_start();
    }
    let rest = rest.strip_prefix(['\'', '"'])?.strip_prefix('s')?.strip_prefix(['\'', '"'])?;
    let rest = rest.trim_start().strip_prefix(')')?.trim_start();
    let rest = rest.strip_prefix([';', ',']).unwrap_or(rest);
    Some(text.len() - rest.len())
}

/// The last `name = value` behind a formula: where its separator stands, the name, the value.
fn assignment(text: &str) -> Option<(usize, &str, &str)> {
    text.rmatch_indices(['=', '≈']).find_map(|(equals, sign)| {
        let head = &text[..equals];
        let &(from, name) = separators(head).last()?;
        let has_formula = head[..from].contains(|c: char| c.is_ascii_digit() || "=/*".contains(c));
        let name = name.trim();
        (has_formula && !name.is_empty()).then_some((from, name, text[equals + sign.len()..].trim()))
    })
}

/// Places that part a formula from what follows, with what follows: `,` and `;` outside brackets, line ends, `where`.
fn separators(head: &str) -> Vec<(usize, &str)> {
    const WORDS: [&str; 6] = [" where ", " with ", " for ", " using ", " when ", " at "];
    let mut found = Vec::new();
    let mut depth = 0usize;
    let bytes = head.as_bytes();
    let digit = |at: Option<usize>| at.and_then(|at| bytes.get(at)).is_some_and(u8::is_ascii_digit);
    for (at, c) in head.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            // A comma between digits is a decimal one.
            ',' if depth == 0 && !(digit(at.checked_sub(1)) && digit(Some(at + 1))) => {
                found.push((at, &head[at + 1..]));
            }
            ';' | '\n' if depth == 0 => found.push((at, &head[at + 1..])),
            ' ' => {
                let word = WORDS.iter().find(|word| head[at..].starts_with(**word));
                found.extend(word.map(|word| (at, &head[at + word.len()..])));
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_of_fractions() {
        for (text, rule) in [
            ("1\n---\ns", Ok(Some((2, 5)))),
            ("1 ───── s", Ok(Some((2, 17)))),
            ("-1 - -2", Ok(None)),
            ("1--2", Ok(None)),
            ("a\n---\nb\n-----\nc", Err((8, 13))),
        ] {
            assert_eq!(fraction_rule(text), rule, "{text:?}");
        }
    }

    #[test]
    fn what_is_set_beside_a_formula() {
        let symbols = BTreeMap::from([("g".to_owned(), Rational::from(10))]);
        let check = |text: &str, expected: Result<(&str, bool), &str>| {
            let found = without_assignments(text, &symbols, "code");
            let found = found.as_ref().map(|(text, out)| (text.trim(), *out));
            let problem = |problem: &Problem| text[problem.start..problem.end].to_owned();
            assert_eq!(found.map_err(problem), expected.map_err(str::to_owned), "{text:?}");
        };
        check("2/(s + 1)", Ok(("2/(s + 1)", false)));
        check("G(s) = 2/(s + 1)", Ok(("G(s) = 2/(s + 1)", false)));
        check("G(s) = a/b\n  = 2/(s + 1)", Ok(("G(s) = a/b\n  = 2/(s + 1)", false)));
        check("G(s), hanging = 2/(s + 1)", Ok(("G(s), hanging = 2/(s + 1)", false)));
        check("2/(s + 1), g = 9.81", Ok(("2/(s + 1)", true)));
        check("2/(s + 1) where g = 9.81", Ok(("2/(s + 1)", true)));
        check("s = tf('s'); G = 2/(s + 1)", Ok(("G = 2/(s + 1)", false)));
        check("0,5/(s + 1,5)", Ok(("0,5/(s + 1,5)", false)));
        check("K/(s + 1), K = 2", Err(", K = 2"));
        check("1/q*s, q = (1 + 2)*3 - 4", Err(", q = (1 + 2)*3 - 4"));
        check("1/(q s)\nq = 2*3\n  = 6", Err("\nq = 2*3\n  = 6"));
        check("num = 2; den = s + 1", Err("; den = s + 1"));
    }
}
