use super::decimal::{is_minus, scan};
use super::problem::{Problem, quote};
use super::{Decimal, FinalValue, Unit};
use crate::algebra::{NumberError, significant, to_f64};
use std::f64::consts::PI;

/// Figures kept of what is no decimal.
const FIGURES: usize = 14;

const HELP: &str = "Write a number such as `0`, `-0.143` or `1e-3`, with its unit if you like (`1.5 s`), or `unbounded`, `+∞` or `-∞`.";

/// A value or a limit as typed: `0`, `≈ -0.143 rad`, `0.889 Hz`, `unbounded`, `-∞`, `does not exist` …
///
/// `asked`: the unit the lab asks for.
pub(super) fn parse_value(text: &str, asked: Option<&Unit>) -> Result<FinalValue, Problem> {
    if let Some(value) = limit_word(without_name(text)) {
        return Ok(value);
    }
    let unreadable = |start: usize, end: usize| {
        Problem::new("value.unreadable", start, end, format!("{} is not a value we can read.", quote(text)))
            .help(HELP)
    };
    let start = text.len() - strip_hedge(without_name(text)).len();
    let body = &text[start..];
    let (sign, unsigned) = match body.chars().next() {
        Some(c) if is_minus(c) => (true, body[c.len_utf8()..].trim_start()),
        Some('+') => (false, body[1..].trim_start()),
        _ => (false, body),
    };
    if without_remark(unsigned).trim().trim_end_matches('.').eq_ignore_ascii_case("zero") {
        return parse_value("0", None);
    }
    let Some((number, length)) = scan_number(unsigned) else {
        return Err(unreadable(0, text.len()));
    };
    let digits_at = text.len() - unsigned.len();
    let rest = without_remark(&unsigned[length..]);
    let number = number.map_err(|error| {
        Problem::new("value.unreadable", start, digits_at + length, format!("{error}.")).help(HELP)
    })?;
    let number = if sign { number.negated() } else { number };
    if rest.trim().trim_end_matches('.').is_empty() {
        return Ok(FinalValue::Number(number, None));
    }
    // A unit of the lab's own, such as `counts`, is known by its name alone.
    let own = asked.filter(|asked| asked.in_unit(&Unit::named(rest)).is_some());
    match Unit::parse(rest).or_else(|| own.cloned()) {
        Some(unit) => Ok(FinalValue::Number(number, Some(unit))),
        None => Err(unreadable(text.len() - rest.trim_start().len(), text.len())),
    }
}

/// A decimal, a multiple of π or a fraction of them at the start of `text`: `1.5`, `3π/4`, `2*pi/5.59`, `1/3`; and its length.
fn scan_number(text: &str) -> Option<(Result<Decimal, NumberError>, usize)> {
    let skipped = |at: usize, marks: &[char]| {
        let rest = text[at..].trim_start();
        text.len() - rest.strip_prefix(marks).map_or(rest, str::trim_start).len()
    };
    let number = scan(text);
    let after = number.as_ref().map_or(0, |(_, length)| *length);
    let at_pi = if number.is_some() { skipped(after, &['*', '·', '×']) } else { 0 };
    let pi = ["\\pi", "pi", "Pi", "π"].iter().find(|pi| text[at_pi..].starts_with(**pi));
    let pi = pi.map(|pi| at_pi + pi.len()).filter(|end| !text[*end..].starts_with(char::is_alphanumeric));
    let upper = pi.unwrap_or(after);
    let lower = text[upper..].trim_start().starts_with('/').then(|| skipped(upper, &['/']));
    let lower = lower.and_then(|at| scan(&text[at..]).map(|(number, length)| (number, at + length)));
    if pi.is_none() && lower.is_none() {
        return number;
    }
    let number = match number {
        Some((Err(error), length)) => return Some((Err(error), length)),
        Some((Ok(number), _)) => to_f64(&number.value),
        None if pi.is_some() => 1.0,
        None => return None,
    };
    let (divisor, end) = match lower {
        Some((Err(error), end)) => return Some((Err(error), end)),
        Some((Ok(divisor), end)) => (to_f64(&divisor.value), end),
        None => (1.0, upper),
    };
    let value = number * if pi.is_some() { PI } else { 1.0 } / divisor;
    Some((Decimal::parse(&significant(value, FIGURES)), end))
}

/// What stands after `θ =`, `y(∞) =`, `final value:`; all of it when no name stands in front.
fn without_name(text: &str) -> &str {
    const NAMES: &[&str] = &["final value", "initial value", "steady state", "steady state value"];
    // `t = 0` and `t → ∞` say when.
    const NO_NAMES: &[&str] = &["t", "s", "not", "never", "no", "is", "if", "at", "time"];
    let Some((name, value)) = text.rsplit_once(['=', '→', ':', '≈']) else { return text };
    let name = name.trim().to_lowercase();
    let (head, argument) = name.split_once('(').unwrap_or((&name, ")"));
    let head = head.trim().trim_start_matches('\\');
    let letters = |c: char| c.is_alphanumeric() || matches!(c, '_' | '{' | '}' | '∞');
    let one = head.starts_with(char::is_alphabetic) && head.chars().all(letters);
    let argument = argument.ends_with(')') && argument.len() <= 16 && !argument.contains(['=', ',']);
    if (one && argument && !NO_NAMES.contains(&head)) || NAMES.contains(&head) { value } else { text }
}

/// Without `(steady state)` at the end.
fn without_remark(text: &str) -> &str {
    const REMARKS: &[&str] = &[
        "steady state",
        "steady-state",
        "at steady state",
        "in steady state",
        "final value",
        "at rest",
        "rest",
        "equilibrium",
        "the equilibrium",
        "zero",
        "stable",
        "it settles",
        "settles",
        "limit",
        "initial value",
    ];
    let body = text.trim_end().trim_end_matches('.');
    let remark = body.strip_suffix(')').and_then(|body| body.rsplit_once('('));
    match remark {
        Some((before, remark)) if REMARKS.contains(&remark.trim().to_lowercase().as_str()) => before,
        _ => text,
    }
}

/// Without `≈`, `~`, `=`, `about`, `approaches`, `tends to` in front.
fn strip_hedge(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        let before = rest;
        rest = rest.trim_start_matches(['≈', '~', '=', '≅', '≃', '→']).trim_start();
        for word in IN_FRONT {
            if rest.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word)) {
                rest = rest[word.len()..].trim_start();
            }
        }
        if rest == before {
            return rest;
        }
    }
}

/// What may stand in front of a number without changing it.
const IN_FRONT: &[&str] = &[
    "approximately ",
    "approx. ",
    "approx ",
    "about ",
    "ca. ",
    "nearly ",
    "it ",
    "the response ",
    "the output ",
    "the angle ",
    "the final value is ",
    "is ",
    "approaches ",
    "tends to ",
    "tends towards ",
    "tends toward ",
    "goes to ",
    "goes towards ",
    "goes back to ",
    "converges to ",
    "settles to ",
    "settles at ",
    "decays to ",
    "returns to ",
    "comes back to ",
    "stays at ",
    "remains at ",
];

/// `unbounded`, `∞`, `diverges`, `does not exist`, `goes to minus infinity` …
fn limit_word(text: &str) -> Option<FinalValue> {
    if text.len() > 200 {
        return None;
    }
    let mut flat = String::with_capacity(text.len() + 16);
    for c in text.to_lowercase().chars() {
        match c {
            '∞' => flat.push_str(" infinity "),
            '±' => flat.push_str(" plusminus "),
            c if is_minus(c) => flat.push_str(" minus "),
            '+' => flat.push_str(" plus "),
            '’' | '\'' => {}
            c if c.is_alphanumeric() => flat.push(c),
            _ => flat.push(' '),
        }
    }
    let words: Vec<&str> = flat.split_whitespace().filter(|word| !FILLERS.contains(word)).collect();
    let signed = |sign: Option<&str>| match sign {
        Some("plus" | "positive") => FinalValue::PlusInfinity,
        Some("minus" | "negative") => FinalValue::MinusInfinity,
        _ => FinalValue::Unbounded,
    };
    match words.as_slice() {
        [sign @ ("plus" | "positive" | "minus" | "negative" | "plusminus"), rest]
            if INFINITY.contains(rest) =>
        {
            Some(signed(Some(sign)))
        }
        [rest @ .., sign @ ("plus" | "positive" | "minus" | "negative" | "plusminus"), last]
            if INFINITY.contains(last) && GROWS.contains(&rest.join(" ").as_str()) =>
        {
            Some(signed(Some(sign)))
        }
        [rest @ .., last]
            if INFINITY.contains(last) && (rest.is_empty() || GROWS.contains(&rest.join(" ").as_str())) =>
        {
            Some(FinalValue::Unbounded)
        }
        ["no"] | ["there", "no"] => {
            (flat.contains("limit") || flat.contains("value")).then_some(FinalValue::Unbounded)
        }
        words => only_no_limit(&words.join(" ")).then_some(FinalValue::Unbounded),
    }
}

/// One or more of [`NO_LIMIT`] and nothing else: `does not exist (unbounded)`.
fn only_no_limit(words: &str) -> bool {
    let mut rest = words;
    while !rest.is_empty() {
        let after =
            |phrase: &&&str| rest.strip_prefix(**phrase).is_some_and(|r| r.is_empty() || r.starts_with(' '));
        let Some(phrase) = NO_LIMIT.iter().filter(after).max_by_key(|phrase| phrase.len()) else {
            return false;
        };
        rest = rest[phrase.len()..].trim_start();
    }
    !words.is_empty()
}

const FILLERS: &[&str] = &[
    "it", "its", "the", "a", "an", "is", "to", "towards", "toward", "response", "value", "final", "output",
    "angle", "and", "hence", "so", "s", "limit", "does", "steady", "state", "rad", "radian", "radians",
    "rads", "unstable",
];
const INFINITY: &[&str] = &["infinity", "inf", "infinite", "oo", "infty"];
const GROWS: &[&str] = &[
    "goes",
    "tends",
    "grows",
    "approaches",
    "diverges",
    "increases",
    "decreases",
    "rises",
    "falls",
    "blows up",
    "becomes",
    "unbounded",
];
const NO_LIMIT: &[&str] = &[
    "unbounded",
    "diverges",
    "diverge",
    "diverging",
    "divergent",
    "not exist",
    "doesnt exist",
    "dne",
    "none exists",
    "not bounded",
    "grows without bound",
    "grows without bounds",
    "increases without bound",
    "without bound",
    "not converge",
    "doesnt converge",
    "not settle",
    "doesnt settle",
    "not defined",
    "undefined",
    "blows up",
    "grows unbounded",
    "grows unboundedly",
];

#[cfg(test)]
mod tests {
    use super::super::Decimal;
    use super::*;

    fn number(text: &str) -> FinalValue {
        FinalValue::Number(Decimal::parse(text).unwrap(), None)
    }

    fn with(text: &str, unit: &str) -> FinalValue {
        let unit = Unit::parse(unit).unwrap_or_else(|| Unit::named(unit));
        FinalValue::Number(Decimal::parse(text).unwrap(), Some(unit))
    }

    #[test]
    fn values_and_limits() {
        use FinalValue::*;
        for (text, expected) in [
            ("0", number("0")),
            ("-0.143", number("-0.143")),
            ("− 0.143", number("-0.143")),
            ("1.50", number("1.50")),
            ("1e-3", number("1e-3")),
            ("pi", number("3.1415926535898")),
            ("-π/6", number("-0.5235987755983")),
            ("3π/4 rad", with("2.3561944901923", "rad")),
            ("2*pi/5.59", number("1.1240045272235")),
            ("\\pi/2", number("1.5707963267949")),
            ("1/3", number("0.33333333333333")),
            ("2/3 rad", with("0.66666666666667", "rad")),
            ("4 1/s", with("4", "1/s")),
            ("0 rad", with("0", "rad")),
            ("0.2 rad/s", with("0.2", "rad/s")),
            ("0°", with("0", "deg")),
            ("0 degrees", with("0", "deg")),
            ("5 degrees", with("5", "deg")),
            ("0.889 Hz", with("0.889", "Hz")),
            ("53.3 rpm", with("53.3", "rpm")),
            ("1124.7ms", with("1124.7", "ms")),
            ("16 %", with("16", "%")),
            ("16%", with("16", "%")),
            ("1.12 [s]", with("1.12", "s")),
            ("-4.5 rad (at rest)", with("-4.5", "rad")),
            ("≈ 5.59 radians per second", with("5.59", "rad/s")),
            ("-0.79 rad/(N·s)", with("-0.79", "rad/(N·s)")),
            ("5 Counts", with("5", "counts")),
            ("≈ 0", number("0")),
            ("~0", number("0")),
            ("approximately 0.5", number("0.5")),
            ("zero", number("0")),
            ("approaches 0", number("0")),
            ("tends to 0", number("0")),
            ("goes to zero", number("0")),
            ("It converges to 0.", number("0")),
            ("θ = 0", number("0")),
            ("theta = 0", number("0")),
            ("θ(∞) = 0.5 rad", with("0.5", "rad")),
            ("\\theta = 0", number("0")),
            ("y(t → ∞) = 0", number("0")),
            ("θ → -∞", MinusInfinity),
            ("0 (steady state)", number("0")),
            ("zero (steady state)", number("0")),
            ("0 rad (at rest)", with("0", "rad")),
            ("final value: 0", number("0")),
            ("∞ rad", Unbounded),
            ("-∞ rad", MinusInfinity),
            ("unbounded (unstable)", Unbounded),
            ("Zero.", number("0")),
            ("unbounded", Unbounded),
            ("Unbounded.", Unbounded),
            ("∞", Unbounded),
            ("±∞", Unbounded),
            ("infinity", Unbounded),
            ("Infinite", Unbounded),
            ("inf", Unbounded),
            (".inf", Unbounded),
            ("diverges", Unbounded),
            ("it diverges", Unbounded),
            ("does not exist", Unbounded),
            ("doesn't exist", Unbounded),
            ("the limit does not exist", Unbounded),
            ("DNE", Unbounded),
            ("no limit", Unbounded),
            ("no final value", Unbounded),
            ("grows without bound", Unbounded),
            ("goes to infinity", Unbounded),
            ("unbounded (diverges)", Unbounded),
            ("does not exist (unbounded)", Unbounded),
            ("+∞", PlusInfinity),
            ("+ infinity", PlusInfinity),
            ("positive infinity", PlusInfinity),
            ("diverges to +∞", PlusInfinity),
            ("-∞", MinusInfinity),
            ("−∞", MinusInfinity),
            ("-.inf", MinusInfinity),
            ("minus infinity", MinusInfinity),
            ("it goes to negative infinity", MinusInfinity),
        ] {
            let counts = Unit::named("counts");
            assert_eq!(parse_value(text, Some(&counts)).as_ref(), Ok(&expected), "{text:?}");
        }
    }

    #[test]
    fn what_is_not_a_value_says_how_to_write_it() {
        for (text, code, marked, help) in [
            ("1,000", "value.unreadable", ",000", "number"),
            ("5 apples", "value.unreadable", "apples", "number"),
            ("does not diverge", "value.unreadable", "does not diverge", "number"),
            ("t = 0", "value.unreadable", "t = 0", "number"),
            ("t → ∞", "value.unreadable", "t → ∞", "number"),
            ("y(t) → 0 as t → ∞", "value.unreadable", "y(t) → 0 as t → ∞", "number"),
            ("θ != 0", "value.unreadable", "θ != 0", "number"),
            ("not = 0", "value.unreadable", "not = 0", "number"),
            ("does not approach 0", "value.unreadable", "does not approach 0", "number"),
            ("0 (not really)", "value.unreadable", "(not really)", "number"),
            ("unstable", "value.unreadable", "unstable", "number"),
            ("goes from 1 to 0", "value.unreadable", "goes from 1 to 0", "number"),
            ("not infinite", "value.unreadable", "not infinite", "number"),
            ("no", "value.unreadable", "no", "number"),
            ("finite", "value.unreadable", "finite", "number"),
            ("1..2", "value.unreadable", ".2", "number"),
            ("1e999", "value.unreadable", "1e999", "number"),
            ("NaN", "value.unreadable", "NaN", "number"),
            ("", "value.unreadable", "", "number"),
        ] {
            let problem = parse_value(text, None).unwrap_err();
            assert_eq!(problem.code, code, "{text:?}: {problem:?}");
            assert_eq!(&text[problem.start..problem.end], marked, "{text:?}");
            assert!(problem.help.as_deref().is_some_and(|h| h.contains(help)), "{text:?}: {problem:?}");
            assert!(problem.message.ends_with('.'), "{text:?}: {problem:?}");
        }
    }
}
