use super::beside::TURNS;
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
/// `asked`: the unit the lab asks for. `limit`: a value the response begins at or goes to, of which `no oscillation` says
/// nothing.
pub(super) fn parse_value(text: &str, asked: Option<&Unit>, limit: bool) -> Result<FinalValue, Problem> {
    let from = after_name(text, asked)?;
    let named = &text[from..];
    let bare = [Some(named), without_harmless_remark(named)].into_iter().flatten();
    if let Some(value) = bare.clone().find_map(|text| limit_word(text, limit)) {
        return Ok(value);
    }
    let unreadable = |start: usize, end: usize| {
        Problem::new("value.unreadable", start, end, format!("{} is not a value we can read.", quote(text)))
            .help(HELP)
    };
    let start = text.len() - strip_hedge(named).len();
    let body = &text[start..];
    let (sign, unsigned) = match body.chars().next() {
        Some(c) if is_minus(c) => (true, body[c.len_utf8()..].trim_start()),
        Some('+') => (false, body[1..].trim_start()),
        _ => (false, body),
    };
    if without_remark(unsigned).trim().trim_end_matches('.').eq_ignore_ascii_case("zero") {
        return parse_value("0", None, limit);
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
    let end = |rest: &str| rest.trim().trim_end_matches(['.', ',', ';']).trim_end().is_empty();
    let unit = |rest: &str| {
        // A unit of the lab's own, such as `counts`, is known by its name alone.
        let own = asked.filter(|asked| asked.in_unit(&Unit::named(rest)).is_some());
        Unit::parse(rest).or_else(|| own.cloned())
    };
    let typed = |rest: &str| match end(rest) {
        true => Some(FinalValue::Number(number.clone(), None)),
        false => unit(rest).map(|unit| FinalValue::Number(number.clone(), Some(unit))),
    };
    if let Some(value) = typed(rest) {
        return Ok(value);
    }
    if let Some((before, remark)) = remark_behind(rest)
        && let Some(value) = typed(before.trim_end_matches([',', ';', ':']))
        && does_not_differ(remark, &value, asked)
    {
        return Ok(value);
    }
    let at = text.len() - rest.trim_start().len();
    Err(unknown_unit(rest, at, text.len()).unwrap_or_else(|| unreadable(at, text.len())))
}

/// What to say of `apples` behind a number.
fn unknown_unit(rest: &str, start: usize, end: usize) -> Option<Problem> {
    let name = rest.trim().trim_end_matches('.');
    if name.eq_ignore_ascii_case("db") {
        let message = "A value in dB is not read.";
        let help = "Write the ratio itself: 20 dB is a factor of 10.";
        return Some(Problem::new("value.unreadable", start, end, message).help(help));
    }
    let mark = |c: char| {
        c.is_alphabetic() || matches!(c, '/' | '·' | '*' | '^' | '°' | '²' | '³' | '-') || c.is_ascii_digit()
    };
    let one = name.starts_with(char::is_alphabetic) && name.len() <= 20 && name.chars().all(mark);
    one.then(|| {
        let message = format!("{} is not a unit we know.", quote(name));
        let help =
            "Write the number in the unit that is asked for, or in another like `rad/s`, `Hz`, `ms`, `cm`.";
        Problem::new("value.unreadable", start, end, message).help(help)
    })
}

/// The text before a remark at its end and the remark: in brackets, or in words after a comma.
fn remark_behind(text: &str) -> Option<(&str, &str)> {
    let body = text.trim_end().trim_end_matches('.');
    let in_brackets = || {
        let inner = body.strip_suffix(')')?;
        let mut depth = 0usize;
        let open = inner.char_indices().rev().find(|(_, c)| match c {
            ')' => {
                depth += 1;
                false
            }
            '(' if depth == 0 => true,
            '(' => {
                depth -= 1;
                false
            }
            _ => false,
        });
        open.map(|(at, _)| (&inner[..at], &inner[at + 1..]))
    };
    let after_comma = || {
        let (before, remark) = body.split_once([',', ';'])?;
        (!remark.contains(|c: char| c.is_ascii_digit())).then_some((before, remark))
    };
    in_brackets().or_else(after_comma)
}

fn without_harmless_remark(text: &str) -> Option<&str> {
    remark_behind(text)
        .filter(|(before, remark)| is_harmless(remark) && !before.trim().is_empty())
        .map(|(before, _)| before)
}

/// Whether a remark takes nothing back, and is no other value than the one before it.
fn does_not_differ(remark: &str, value: &FinalValue, asked: Option<&Unit>) -> bool {
    if !is_harmless(remark) {
        return false;
    }
    let FinalValue::Number(number, unit) = value else { return true };
    let Some((sign, size, rest)) = number_in(remark) else { return true };
    let other = if sign { -size } else { size };
    let own = unit.as_ref().or(asked);
    let ratio = match (rest.trim().is_empty(), Unit::parse(rest), own) {
        (true, _, _) => 1.0,
        // `35.83 rad (about 5.7 turns)`
        (false, Some(unit), Some(own)) => match unit.in_unit(own) {
            Some(ratio) => to_f64(&ratio.value().0),
            // `4 s (2 %)`
            None => return true,
        },
        _ => return true,
    };
    let number = to_f64(&number.value);
    (other * ratio - number).abs() <= 0.02 * number.abs()
}

/// The sign, the size and what follows, where a text is a number and little else.
fn number_in(text: &str) -> Option<(bool, f64, &str)> {
    let body = strip_hedge(text);
    let (sign, body) = match body.chars().next() {
        Some(c) if is_minus(c) => (true, body[c.len_utf8()..].trim_start()),
        _ => (false, body),
    };
    let (number, length) = scan_number(body)?;
    Some((sign, to_f64(&number.ok()?.value), &body[length..]))
}

/// Whether a remark beside a value leaves it as it is.
fn is_harmless(remark: &str) -> bool {
    const DOUBTS: &[&str] = &[
        "not", "no", "never", "or", "if", "but", "unless", "maybe", "perhaps", "either", "depends", "and",
        "then", "isnt", "without", "guess", "sure", "unsure", "should", "would",
    ];
    const SAFE: &[&str] = &[
        "no overshoot",
        "no oscillation",
        "without overshoot",
        "without oscillation",
        "does not oscillate",
        "not oscillating",
    ];
    if remark.len() > 100 || remark.contains(['?', '!', '(', '≠', '±']) {
        return remark.len() <= 100 && remark.contains('(') && is_harmless(&remark.replace(['(', ')'], " "));
    }
    let lower = remark.to_lowercase().replace(['\'', '’'], "");
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let mut plain = format!(" {} ", words.join(" "));
    for safe in SAFE {
        plain = plain.replace(&format!(" {safe} "), " ");
    }
    !plain.split(' ').any(|word| DOUBTS.contains(&word) || TURNS.contains(&word))
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

/// Where the value begins behind `θ =`, `y(∞) =`, `final value:`, `2π/5.59 =`; 0 when no name stands in front.
///
/// Errors where a value stands in front that is not the one behind.
fn after_name(text: &str, asked: Option<&Unit>) -> Result<usize, Problem> {
    const NAMES: &[&str] = &[
        "final value",
        "initial value",
        "steady state",
        "steady-state",
        "steady state value",
        "steady-state value",
        "overshoot",
        "percent overshoot",
        "percentage overshoot",
        "maximum overshoot",
        "rise time",
        "settling time",
        "peak time",
        "period",
        "peak",
        "peak value",
        "damping ratio",
        "damping",
        "natural frequency",
        "damped frequency",
        "damped natural frequency",
        "dc gain",
        "steady-state gain",
        "static gain",
        "time constant",
    ];
    // `t = 0` and `t → ∞` say when.
    const NO_NAMES: &[&str] = &["t", "s", "not", "never", "no", "is", "if", "at", "time"];
    let mut depth = 0i32;
    let last = text.char_indices().rev().find(|(_, c)| {
        depth += i32::from(*c == ')') - i32::from(*c == '(');
        depth == 0 && matches!(c, '=' | '→' | ':' | '≈')
    });
    let Some((at, mark)) = last else { return Ok(0) };
    let (before, behind) = (&text[..at], at + mark.len_utf8());
    let typed = before.trim();
    let name = typed.to_lowercase();
    let (head, argument) = name.split_once('(').unwrap_or((&name, ")"));
    let head = head.trim().trim_start_matches('\\').trim_start_matches('%');
    let letters = |c: char| c.is_alphanumeric() || matches!(c, '_' | '{' | '}' | '∞');
    let one = head.starts_with(char::is_alphabetic) && head.chars().all(letters);
    let argument = argument.ends_with(')') && argument.len() <= 16 && !argument.contains(['=', ',']);
    // A time that is asked for may be called `T`, and `t` too.
    let is_time = asked.is_some_and(|asked| asked.quantity() == "a time");
    let no_name = NO_NAMES.contains(&head) && typed != "T" && !(typed == "t" && is_time && mark != '→');
    if (one && argument && !no_name) || NAMES.contains(&head) {
        return Ok(behind);
    }
    if !matches!(mark, '=' | '≈') || !is_calculation(typed) {
        return Ok(0);
    }
    // `0.0716 = 7.16 %` says the same twice; `1 = 2` does not.
    let last = typed.rsplit(['=', '≈']).next().unwrap_or(typed);
    let number = number_in(last).filter(|(_, _, rest)| rest.trim().is_empty() || Unit::parse(rest).is_some());
    let Some((sign, size, rest)) = number else { return Ok(behind) };
    let value = if sign { -size } else { size };
    let other = number_in(&text[behind..]);
    let unit = |rest: &str| Unit::parse(rest).unwrap_or_else(Unit::one);
    let same = other.is_none_or(|(sign, size, behind)| {
        let other = if sign { -size } else { size };
        let ratio = unit(behind.trim()).in_unit(&unit(rest.trim()));
        let ratio = ratio.map(|ratio| to_f64(&ratio.value().0));
        [Some(1.0), ratio]
            .into_iter()
            .flatten()
            .any(|ratio| (other * ratio - value).abs() <= 0.02 * value.abs())
    });
    match same {
        true => Ok(behind),
        false => {
            Err(Problem::new("value.unreadable", 0, text.len(), format!("{} gives two values.", quote(text)))
                .help("Write the one that is your answer."))
        }
    }
}

/// `2π/5.59`, `4/(zeta*wn)`, `F/K1`, `%OS = 100*exp(-0.5)`: names, numbers and signs, and no sentence.
fn is_calculation(text: &str) -> bool {
    let sign = |c: char| "+-*/^·×−.()[]{}_%²³√'\\ =≈".contains(c) || c.is_alphanumeric();
    if text.is_empty() || text.len() > 120 || !text.chars().all(sign) {
        return false;
    }
    let word = |word: &str| word.len() > 1 && word.chars().all(char::is_alphabetic);
    let words: Vec<&str> = text.split_whitespace().collect();
    let prose =
        words.windows(2).any(|pair| word(pair[0]) && (word(pair[1]) || pair[1].len() == 1 && pair[1] != "="));
    let about = ["t", "at", "not", "no", "if", "when", "for", "is", "or"];
    let lower = text.to_lowercase();
    let first = lower.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    let turned = words.iter().any(|word| about[1..].contains(&word.to_lowercase().as_str()));
    let says_when = about.contains(&first) && words.len() == 1;
    if prose || turned || says_when || text.contains("==") || text.ends_with(['<', '>', '!']) {
        return false;
    }
    text.contains(|c: char| "+-*/^·×−=√".contains(c)) || text.starts_with(|c: char| c.is_ascii_digit())
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
///
/// `limit`: of which `no oscillation` says nothing.
fn limit_word(text: &str, limit: bool) -> Option<FinalValue> {
    if text.len() > 200 {
        return None;
    }
    if !limit && ["n/a", "n.a.", "n. a."].contains(&text.trim().to_lowercase().as_str()) {
        return Some(FinalValue::Unbounded);
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
        words => {
            let words = words.join(" ");
            let none = only_of(&words, NO_LIMIT) || (!limit && only_of(&words, NO_FEATURE));
            none.then_some(FinalValue::Unbounded)
        }
    }
}

/// One or more of these phrases and nothing else: `does not exist (unbounded)`.
fn only_of(words: &str, phrases: &[&str]) -> bool {
    let mut rest = words;
    while !rest.is_empty() {
        let after =
            |phrase: &&&str| rest.strip_prefix(**phrase).is_some_and(|r| r.is_empty() || r.starts_with(' '));
        let Some(phrase) = phrases.iter().filter(after).max_by_key(|phrase| phrase.len()) else {
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
    "none",
    "there none",
    "grows without",
    "increases without",
    "not applicable",
];
/// Of a period, an overshoot, a peak: that there is none. Also beside [`NO_LIMIT`].
const NO_FEATURE: &[&str] = &[
    "none",
    "there none",
    "not applicable",
    "not exist",
    "no overshoot",
    "no oscillation",
    "no oscillations",
    "no period",
    "no peak",
    "there no overshoot",
    "there no oscillation",
    "without overshoot",
    "without oscillation",
    "not oscillate",
    "doesnt oscillate",
    "not oscillating",
    "non oscillating",
    "not overshoot",
    "doesnt overshoot",
    "aperiodic",
    "not periodic",
    "overdamped",
    "no swing",
    "not swing",
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
            assert_eq!(parse_value(text, Some(&counts), true).as_ref(), Ok(&expected), "{text:?}");
        }
    }

    #[test]
    fn values_as_calculated_or_printed() {
        let seconds = Unit::parse("s");
        for (text, expected) in [
            ("T = 1.1253 s", with("1.1253", "s")),
            ("T ≈ 1.125 s", with("1.125", "s")),
            ("t = 1.125 s", with("1.125", "s")),
            ("t_s ≈ 4 s", with("4", "s")),
            ("%OS = 7.16", number("7.16")),
            ("OS: 7.16 %", with("7.16", "%")),
            ("Overshoot: 7.16 %", with("7.16", "%")),
            ("rise time = 4 s", with("4", "s")),
            ("2π/5.5835 = 1.1253 s", with("1.1253", "s")),
            ("2.197*20 s = 43.94 s", with("43.94", "s")),
            ("3.912*tau = 78.24 s", with("78.24", "s")),
            ("4/(zeta*wn) = 205 s", with("205", "s")),
            ("F/K1 = 12.5 µm", with("12.5", "µm")),
            ("T = 2π/ωd = 1.1253 s", with("1.1253", "s")),
            ("1.0716 - 1 = 7.16 %", with("7.16", "%")),
            ("0.0716 = 7.16 %", with("7.16", "%")),
            ("1125 ms = 1.125 s", with("1.125", "s")),
            ("1.1253 s (2*pi/5.5835)", with("1.1253", "s")),
            ("1.1253 (= 2π/ωd)", number("1.1253")),
            ("35.83 rad (about 5.7 turns)", with("35.83", "rad")),
            ("0.0035 (very weakly damped)", number("0.0035")),
            ("200.6 s (2 % band)", with("200.6", "s")),
            ("0 %, no overshoot", with("0", "%")),
            ("0 (no overshoot)", number("0")),
            ("1.5 (s)", with("1.5", "s")),
            ("2 V/°C", with("2", "V/°C")),
            ("0.4 °C/kW", with("0.4", "°C/kW")),
            ("1.2 degC", with("1.2", "°C")),
            ("none", FinalValue::Unbounded),
            ("None.", FinalValue::Unbounded),
            ("n/a", FinalValue::Unbounded),
            ("no overshoot", FinalValue::Unbounded),
            ("There is no overshoot.", FinalValue::Unbounded),
            ("does not oscillate", FinalValue::Unbounded),
            ("it doesn't oscillate", FinalValue::Unbounded),
            ("none (overdamped)", FinalValue::Unbounded),
            ("none, it does not oscillate", FinalValue::Unbounded),
            ("does not exist", FinalValue::Unbounded),
            ("negative infinity (the ball hits the magnet)", FinalValue::MinusInfinity),
            ("grows without limit", FinalValue::Unbounded),
        ] {
            assert_eq!(parse_value(text, seconds.as_ref(), false).as_ref(), Ok(&expected), "{text:?}");
        }
        for (text, words) in [
            ("1 = 2", "two values"),
            ("1125 ms = 2 s", "two values"),
            ("5 at t = 0", "not a value"),
            ("x = 5 at t = 0", "not a value"),
            ("not 2*3 = 6", "not a value"),
            ("4 (or 5)", "not a value"),
            ("4 (5)", "not a value"),
            ("35.83 rad (20 rad)", "not a value"),
            ("4, not 5", "not a value"),
            ("4 (no, rather less)", "not a value"),
            ("3 (wrong)", "not a value"),
            ("20 dB", "in dB"),
            ("3 fathoms", "`fathoms` is not a unit"),
            ("2 rad/fortnight", "`rad/fortnight` is not a unit"),
            ("does oscillate", "not a value"),
            ("not none", "not a value"),
        ] {
            let problem = parse_value(text, seconds.as_ref(), false).expect_err(text);
            assert!(problem.message.contains(words), "{text:?}: {problem:?}");
        }
        for text in ["no overshoot", "does not oscillate", "overdamped", "t = 2 s"] {
            assert!(parse_value(text, None, true).is_err(), "{text:?}");
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
            let problem = parse_value(text, None, true).unwrap_err();
            assert_eq!(problem.code, code, "{text:?}: {problem:?}");
            assert_eq!(&text[problem.start..problem.end], marked, "{text:?}");
            assert!(problem.help.as_deref().is_some_and(|h| h.contains(help)), "{text:?}: {problem:?}");
            assert!(problem.message.ends_with('.'), "{text:?}: {problem:?}");
        }
    }
}
