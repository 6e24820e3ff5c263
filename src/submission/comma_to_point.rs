use super::decimal::is_minus;
use super::problem::{Problem, quote};
use crate::source::{Finding, Node, Span};
use std::borrow::Cow;

/// Digits of one number.
pub(super) const MAX_DIGITS: usize = 60;

const CODE: &str = "number.decimal_comma";

/// A text with points where decimal commas stood; byte for byte as long as it was.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pointed<'a> {
    pub text: Cow<'a, str>,
    /// Bytes of the numbers that had a decimal comma, their sign included.
    commas: Vec<(usize, usize)>,
}

impl<'a> Pointed<'a> {
    /// The text as it was typed. Errors when a number in it is too long.
    pub fn as_typed(text: &'a str) -> Result<Self, Problem> {
        match too_long(text) {
            Some(problem) => Err(problem),
            None => Ok(Self { text: text.into(), commas: Vec::new() }),
        }
    }

    /// Every comma between two digits after byte `from` is a decimal comma.
    ///
    /// Errors at `1,000` unless it is [`settled`] what a comma means, at `1,000.5` and `1,000,000`, and when a number is
    /// too long.
    pub fn read(text: &'a str, from: usize, settled: bool) -> Result<Self, Problem> {
        let mut pointed = text.to_owned();
        let mut places = Vec::new();
        for number in numbers(text).into_iter().filter(|number| number.start >= from) {
            let typed = &text[number.start..number.end];
            let problem = |message: String| Problem::new(CODE, number.start, number.end, message);
            match number.kind {
                Kind::Plain | Kind::Point => continue,
                Kind::Mixed => {
                    return Err(problem(format!(
                        "It is not clear what the commas in {} mean.",
                        quote(typed)
                    ))
                    .help("Write numbers without commas, with a point before the decimals."));
                }
                Kind::Thousands if !settled => {
                    let (decimal, whole) = (typed.replace(',', "."), typed.replace(',', ""));
                    let message = format!("{} may be {decimal} or {whole}, and is not read.", quote(typed));
                    return Err(problem(message).help(format!("Write `{decimal}` or `{whole}`.")));
                }
                Kind::Decimal | Kind::Thousands => {
                    pointed.replace_range(number.start..number.end, &typed.replace(',', "."));
                    places.push((own_sign(text, number.start), number.end));
                }
            }
        }
        match too_long(&pointed) {
            Some(problem) => Err(problem),
            None if places.is_empty() => Ok(Self { text: text.into(), commas: places }),
            None => Ok(Self { text: pointed.into(), commas: places }),
        }
    }

    /// Where in the file numbers with a decimal comma stand, and how they were read.
    pub fn places(&self, node: &Node, source: &str) -> Vec<(Span, String)> {
        let place = |&(start, end): &(usize, usize)| {
            (node.locate(source, start, end), self.text[start..end].to_owned())
        };
        self.commas.iter().map(place).collect()
    }
}

/// What to say of the decimal commas of one answer.
pub(super) fn commas_read(places: &[(Span, String)], source: &str) -> Option<Finding> {
    let (span, read) = places.first()?;
    let typed = source.get(span.start..span.end).unwrap_or_default();
    let others = match places.len() {
        1 => String::new(),
        2 => " So is the other decimal comma in this answer.".to_owned(),
        n => format!(" So are the {} other decimal commas in this answer.", n - 1),
    };
    let message = format!("{} is read as {read}.{others}", quote(typed));
    Some(
        Finding::warning("number.comma_read", message)
            .with_help(format!("Write a point: `{read}`."))
            .at(*span),
    )
}

/// Whether the texts of one answer tell that a comma is a decimal comma: `0,05` does, `5,568` and `0.05` do not.
pub(super) fn settled<'t>(texts: impl IntoIterator<Item = &'t str>) -> bool {
    let mut decimal = false;
    for number in texts.into_iter().flat_map(numbers) {
        match number.kind {
            Kind::Point | Kind::Mixed => return false,
            Kind::Decimal => decimal = true,
            Kind::Plain | Kind::Thousands => {}
        }
    }
    decimal
}

/// Whether commas between digits can only be decimal commas in a text that lists poles.
///
/// True when something else separates the poles, in an entry of a list of its own, and when as separators they would
/// leave `-0` or `05`. Other commas may separate poles where each has a space after it and nothing else separates any.
pub(super) fn only_decimal_in_poles(text: &str, entry: bool) -> bool {
    let numbers = numbers(text);
    let commas = numbers.iter().filter(|number| matches!(number.kind, Kind::Decimal | Kind::Thousands));
    let inside = |at: usize| {
        numbers.iter().any(|number| (number.start..number.end).contains(&at) && number.kind != Kind::Mixed)
    };
    let separates = |at: usize| !inside(at) && !in_name(text, at);
    let separators = || text.match_indices(',').map(|(at, _)| at).filter(|&at| separates(at));
    let body = text.trim();
    let separated = body.contains([';', '&', '\n']) || body.to_lowercase().contains(" and ");
    let certain = |number: &Number| {
        let (whole, fraction) = text[number.start..number.end].split_once(',').unwrap_or_default();
        let negative = text[..number.start].trim_end().ends_with(is_minus);
        let in_sum = text[..number.start].trim_end().trim_end_matches(|c| is_minus(c) || "+±/ ".contains(c));
        let imaginary = text[number.end..].trim_start().starts_with(['i', 'j', 'I', 'J']);
        (whole == "0" && negative)
            || (fraction.len() > 1 && fraction.starts_with('0'))
            || (imaginary && in_sum.ends_with(|c: char| c.is_ascii_digit()))
    };
    if separators().next().is_none() {
        return entry || separated || commas.into_iter().any(certain);
    }
    let spaced = separators().all(|at| text[at + 1..].starts_with(char::is_whitespace));
    spaced
        && !separated
        && numbers.iter().all(|number| number.kind != Kind::Point)
        && commas.into_iter().any(certain)
}

/// A list of numbers as text, in which a decimal comma has likely cut a number in two.
pub(super) fn comma_in_list_text(text: &str) -> Option<Problem> {
    let body = text.trim();
    let bare = body.trim_start_matches('[').trim_end_matches(']').trim();
    let loose = bare.contains(|c: char| c.is_whitespace() || c == ';');
    numbers(text).into_iter().find_map(|number| {
        let typed = &text[number.start..number.end];
        let (whole, rest) = typed.split_once(',')?;
        let negative = text[..number.start].ends_with(is_minus);
        let leading_zero = rest.split(',').any(|part| part.len() > 1 && part.starts_with('0'));
        let alone = body.len() == bare.len() && number.kind != Kind::Mixed && typed.len() >= bare.len() - 1;
        let likely = loose || alone || (negative && whole == "0") || leading_zero;
        (likely && number.kind != Kind::Point).then(|| {
            Problem::new(
                CODE,
                number.start,
                number.end,
                format!(
                    "In a list of numbers, {} may be one number or several, and is not read.",
                    quote(typed)
                ),
            )
            .help("Write a point before decimals, and a space after a comma that separates two numbers.")
        })
    })
}

/// A number with more digits than are read.
fn too_long(text: &str) -> Option<Problem> {
    let bytes = text.as_bytes();
    let numeric = |b: &u8| b.is_ascii_digit() || *b == b'.';
    let mut at = 0;
    while at < bytes.len() {
        let end = at + bytes[at..].iter().take_while(|b| numeric(b)).count();
        let digits = bytes[at..end].iter().filter(|b| b.is_ascii_digit()).count();
        if digits > MAX_DIGITS {
            let message =
                format!("This number has {digits} digits, more than the {MAX_DIGITS} that are read.");
            return Some(
                Problem::new("number.too_long", at, end, message).help("Round it to the digits that matter."),
            );
        }
        at = end.max(at + 1);
    }
    None
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Digits only.
    Plain,
    Point,
    /// `0,05`, `1,5`.
    Decimal,
    /// `5,568`: also a way to write thousands.
    Thousands,
    /// `1,000,000`, `1,000.5`, `1.000,5`.
    Mixed,
}

/// Digits with points and commas between them.
#[derive(Clone, Copy, Debug)]
struct Number {
    start: usize,
    end: usize,
    kind: Kind,
}

/// The numbers of a text, without those in names such as `p1,2` and `p_{1,2}`.
fn numbers(text: &str) -> Vec<Number> {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        if !digit(at) {
            at += 1;
            continue;
        }
        let start = at;
        while digit(at) || (matches!(bytes.get(at), Some(b'.' | b',')) && digit(at + 1)) {
            at += 1;
        }
        if in_name(text, start) {
            continue;
        }
        let typed = &text[start..at];
        let points = typed.matches('.').count() + usize::from(text[..start].ends_with('.'));
        let kind = match (typed.split_once(','), points) {
            (None, 0) => Kind::Plain,
            (None, _) => Kind::Point,
            (Some((whole, fraction)), 0) if !fraction.contains(',') => {
                let thousands = whole.len() <= 3 && !whole.starts_with('0') && fraction.len() == 3;
                if thousands { Kind::Thousands } else { Kind::Decimal }
            }
            (Some(_), _) => Kind::Mixed,
        };
        found.push(Number { start, end: at, kind });
    }
    found
}

/// Whether what stands here is the index of a name: `p1,2`, `s_1,2`, `p_{1,2}`. The unit in `j5,59` is no name.
fn in_name(text: &str, at: usize) -> bool {
    let before = text[..at].trim_end_matches(|c: char| c.is_ascii_digit() || c == ',');
    let before = before.strip_suffix('{').filter(|b| b.ends_with('_')).unwrap_or(before);
    let mut letters = before.chars().rev();
    match letters.next() {
        Some('i' | 'j' | 'I' | 'J') => letters.next().is_some_and(|c| c.is_alphabetic() || c == '_'),
        Some(c) => c.is_alphabetic() || c == '_',
        None => false,
    }
}

/// The start of the number, or of the minus sign that is its own: not `s - 0,5`.
fn own_sign(text: &str, start: usize) -> usize {
    let before = &text[..start];
    match before.char_indices().next_back() {
        Some((at, c))
            if is_minus(c)
                && text[..at].trim_end().chars().next_back().is_none_or(|c| "([{;=≈~,".contains(c)) =>
        {
            at
        }
        _ => start,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_commas_become_points() {
        for (text, expected) in [
            ("0,0", "0.0"),
            ("−2,5 rad", "−2.5 rad"),
            ("12345,678", "12345.678"),
            ("0,143", "0.143"),
            ("1,2345", "1.2345"),
            ("-0,06s/(0,0132s^3 + 5,568s)", "-0.06s/(0.0132s^3 + 5.568s)"),
            ("p1,2 = -0,5 ± j5,59", "p1,2 = -0.5 ± j5.59"),
            ("p_{1,2} = 0,5", "p_{1,2} = 0.5"),
            ("1, 2", "1, 2"),
            ("0.5", "0.5"),
        ] {
            let found = Pointed::read(text, 0, settled([text])).map(|pointed| pointed.text.into_owned());
            assert_eq!(found.as_deref(), Ok(expected), "{text}");
        }
    }

    #[test]
    fn what_may_be_something_else_is_refused() {
        for (text, code, marked, help) in [
            ("1,000", CODE, "1,000", "`1.000` or `1000`"),
            ("12,345", CODE, "12,345", "`12.345` or `12345`"),
            ("0.5s + 1,234", CODE, "1,234", "`1.234`"),
            ("0.5s + 0,05 + 1,234", CODE, "1,234", "`1.234`"),
            ("1,234,567", CODE, "1,234,567", "without commas"),
            ("1,234.5", CODE, "1,234.5", "without commas"),
            ("1.234,5", CODE, "1.234,5", "without commas"),
        ] {
            let problem = Pointed::read(text, 0, settled([text])).unwrap_err();
            assert_eq!((problem.code, &text[problem.start..problem.end]), (code, marked), "{text}");
            assert!(problem.help.as_deref().unwrap().contains(help), "{problem:?}");
        }
        let long = format!("0,{}", "1".repeat(MAX_DIGITS));
        assert_eq!(Pointed::read(&long, 0, true).unwrap_err().code, "number.too_long");
        assert_eq!(Pointed::as_typed(&"7".repeat(MAX_DIGITS + 1)).unwrap_err().code, "number.too_long");
        assert!(Pointed::as_typed(&"7".repeat(MAX_DIGITS)).is_ok());
    }

    #[test]
    fn commas_among_poles() {
        for (text, alone, entry) in [
            ("-0,143", true, true),
            ("-1,5", false, true),
            ("0,143", false, true),
            ("5,05", true, true),
            ("-0,0195 ± 5,59j", true, true),
            ("-2 ± 5,59j", true, true),
            ("-1,5; -2,5", true, true),
            ("-1,5 and -2,5", true, true),
            ("p1,2 = -1,5; -3", true, true),
            ("-0,143, -2,5", true, true),
            ("5,568, -5,607, -0,1428", true, true),
            ("-1, 5,05", true, true),
            ("5,568, -5,607", false, false),
            ("1,2, 3,4", false, false),
            ("0,5, -1,3", false, false),
            ("-0,143,-2,5", false, false),
            ("-0,143, -2.5", false, false),
            ("1,2,3, -0,5", false, false),
            ("-0,143; -2, -3", false, false),
            ("1,2,3; 4", false, false),
            ("0.5,1; 2", false, false),
        ] {
            assert_eq!(only_decimal_in_poles(text, false), alone, "{text}");
            assert_eq!(only_decimal_in_poles(text, true), entry, "{text}");
        }
    }

    #[test]
    fn commas_in_coefficients_as_text() {
        for (text, suspected) in [
            ("[-0,06 0]", true),
            ("0,0132 0,0024 0,41202", true),
            ("[-0,06]", true),
            ("0,5", true),
            ("1,5", true),
            ("[1,05,2]", true),
            ("1,2,5", false),
            ("[0,1]", false),
            ("[1,2,5]", false),
            ("1, 2, 5", false),
            ("1 2 5", false),
        ] {
            assert_eq!(comma_in_list_text(text).is_some(), suspected, "{text}");
        }
    }
}
