use super::Decimal;
use super::decimal::{is_minus, scan};
use super::printed_poles::printed;
use super::problem::{Problem, quote};
use crate::algebra::{parse_decimal, significant, to_f64};

/// Poles in one list, repeated ones counted.
pub(super) const MAX_POLES: usize = 60;
/// More than so many poles take, with room to spare.
pub(super) const MOST_POLE_BYTES: usize = 6_000;

const CODE: &str = "poles.unreadable";
const HELP: &str = "Write a pole like `-0.143`, `-2+3.1j` or `-2 ± 3.1j`; a double one like `-1 (x2)`.";

/// A pole and the bytes of the text it was read from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ReadPole {
    pub re: Decimal,
    pub im: Decimal,
    pub start: usize,
    pub end: usize,
}

/// One or more poles as text: `-0.143, -0.0195 ± 5.59j`, `[-1; -2+3i]`, `-1 (x2)`, `s = -0.143` …
///
/// `a ± bj` gives two; a multiplicity repeats the pole.
pub(super) fn parse_poles(text: &str) -> Result<Vec<ReadPole>, Problem> {
    let (plain, power) = printed(text);
    let read = listed(&plain).or_else(|problem| row(&plain).or_else(|| rows(&plain)).ok_or(problem));
    let scaled = |pole: ReadPole| ReadPole { re: scaled(pole.re, power), im: scaled(pole.im, power), ..pole };
    read.map(|poles| poles.into_iter().map(scaled).collect())
}

/// Times 10^`power`.
fn scaled(number: Decimal, power: i32) -> Decimal {
    if power == 0 || number.is_zero() {
        return number;
    }
    Decimal {
        text: format!("{}e{power}", number.text),
        value: number.value * crate::algebra::Rational::from(10).pow(power as isize),
        last_place: number.last_place.saturating_add(power),
    }
}

/// Several lines of which each is a list or a [`row`], as Python breaks a long array.
fn rows(text: &str) -> Option<Vec<ReadPole>> {
    let body = text.trim();
    let inner = body.strip_prefix('[')?.strip_suffix(']')?;
    let mut at = text.find('[')? + 1;
    let mut poles = Vec::new();
    for line in inner.split_inclusive('\n') {
        if !line.trim().is_empty() {
            let read = listed(line).ok().or_else(|| pieces(line, line.trim(), true))?;
            poles.extend(read.into_iter().map(|pole| ReadPole {
                start: at + pole.start,
                end: at + pole.end,
                ..pole
            }));
        }
        at += line.len();
    }
    (poles.len() <= MAX_POLES).then_some(poles)
}

/// MATLAB's row without commas: `-0.143 -0.0195+5.59i -0.0195-5.59i`.
///
/// `None` unless each piece is a whole pole, and none could be a part of the one before it.
fn row(text: &str) -> Option<Vec<ReadPole>> {
    let body = text.trim().trim_end_matches(';');
    let inner = body.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    pieces(text, inner.unwrap_or(body), inner.is_some())
}

/// Poles with white space between them; `bracketed`: in a list.
fn pieces(text: &str, bare: &str, bracketed: bool) -> Option<Vec<ReadPole>> {
    if bare.contains([',', ';', '&', '\n', '(']) {
        return None;
    }
    let (mut poles, mut from): (Vec<ReadPole>, usize) = (Vec::new(), 0);
    let (mut pieces, mut complex, mut negative) = (0, bracketed, true);
    for piece in bare.split_whitespace() {
        let at = from + text[from..].find(piece)?;
        from = at + piece.len();
        let read = listed(piece).ok()?;
        let without_real_part = read.iter().any(|pole| pole.re == Decimal::absent());
        // `-1 +2i` is one pole.
        if pieces > 0 && without_real_part {
            return None;
        }
        pieces += 1;
        complex |= !without_real_part && read.iter().any(|pole| !pole.im.is_zero());
        negative &= piece.starts_with(is_minus);
        poles.extend(read.into_iter().map(|pole| ReadPole {
            start: at + pole.start,
            end: at + pole.end,
            ..pole
        }));
    }
    let clear = complex || (negative && pieces > 2);
    (pieces > 1 && clear && poles.len() <= MAX_POLES).then_some(poles)
}

/// Poles with separators between them.
fn listed(text: &str) -> Result<Vec<ReadPole>, Problem> {
    let mut cursor = Cursor { text, at: 0 };
    let mut poles: Vec<ReadPole> = Vec::new();
    // `two poles at`: how many, where it stands, and how many poles were read before it.
    let mut told: Option<(usize, usize, usize)> = None;
    cursor.skip_space();
    let bracketed = cursor.eat_any(&['[', '{']).is_some();
    loop {
        cursor.skip_separators();
        if bracketed {
            cursor.eat_any(&[']', '}']);
            cursor.skip_separators();
        }
        let end = cursor.at == text.len() || (!poles.is_empty() && is_remark(cursor.rest()));
        let here = cursor.at;
        let words = if end { None } else { cursor.words()? };
        if (end || words.is_some())
            && let Some((count, at, before)) = told.take()
        {
            match poles.len() - before {
                found if found == count => {}
                1 => {
                    let pole = poles[before].clone();
                    poles.extend(std::iter::repeat_n(pole, count - 1));
                }
                found => {
                    let message = format!("{count} poles are told here, and {found} are given.");
                    return Err(Problem::new(CODE, at, cursor.at, message).help(HELP));
                }
            }
        }
        if end {
            return Ok(poles);
        }
        let times = match words {
            Some(Told::Each(times)) => times,
            Some(Told::Together(count)) => {
                told = Some((count, here, poles.len()));
                1
            }
            None => 1,
        };
        let found = cursor.item()?;
        let found: Vec<ReadPole> =
            found.iter().flat_map(|pole| std::iter::repeat_n(pole.clone(), times)).collect();
        if poles.len() + found.len() > MAX_POLES {
            return Err(Problem::new(
                "poles.too_many",
                0,
                text.len(),
                format!("The list has more than the {MAX_POLES} poles we read."),
            ));
        }
        poles.extend(found);
        let here = cursor.at;
        cursor.skip_space();
        let closed = bracketed && cursor.rest().starts_with([']', '}']);
        if cursor.at < text.len() && !closed && !cursor.at_separator() {
            return Err(cursor.unreadable(here, text.len()));
        }
    }
}

/// `all in the left half plane`: words about the poles before it, and none about how many there are.
fn is_remark(text: &str) -> bool {
    const ABOUT: &[&str] = &[
        "plane",
        "poles",
        "lhp",
        "rhp",
        "stable",
        "unstable",
        "conjugate",
        "conjugates",
        "real",
        "complex",
        "parts",
    ];
    const BESIDE: &[&str] = &[
        "all",
        "both",
        "in",
        "the",
        "left",
        "right",
        "half",
        "open",
        "hand",
        "s",
        "are",
        "is",
        "lie",
        "they",
        "so",
        "hence",
        "therefore",
        "thus",
        "system",
        "it",
        "with",
        "negative",
        "positive",
        "part",
        "have",
        "of",
        "and",
    ];
    let lower = text.to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| c.is_whitespace() || "-.,;()".contains(c)).collect();
    let mut words = words.into_iter().filter(|word| !word.is_empty()).peekable();
    let mut about = false;
    words.peek().is_some()
        && words.all(|word| {
            about |= ABOUT.contains(&word);
            ABOUT.contains(&word) || BESIDE.contains(&word)
        })
        && about
}

/// What words in front of a pole say about how many there are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Told {
    /// `a double pole at`
    Each(usize),
    /// `two poles at`
    Together(usize),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Plus,
    Minus,
    Both,
}

struct Term {
    sign: Sign,
    size: Decimal,
    imaginary: bool,
}

impl Term {
    /// The signed sizes: two for `±`.
    fn values(&self) -> Vec<Decimal> {
        match self.sign {
            Sign::Plus => vec![self.size.clone()],
            Sign::Minus => vec![self.size.negated()],
            Sign::Both => vec![self.size.clone(), self.size.negated()],
        }
    }
}

struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl Cursor<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn skip_space(&mut self) {
        self.at =
            self.text.len() - self.rest().trim_start_matches(|c: char| c.is_whitespace() && c != '\n').len();
    }

    fn eat_any(&mut self, chars: &[char]) -> Option<char> {
        let c = self.peek().filter(|c| chars.contains(c))?;
        self.at += c.len_utf8();
        Some(c)
    }

    /// Eats `word` (lower case) when it stands here as a word of its own.
    fn eat_word(&mut self, word: &str) -> bool {
        let rest = self.rest();
        let fits = rest.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word))
            && !rest[word.len()..].starts_with(char::is_alphanumeric);
        if fits {
            self.at += word.len();
        }
        fits
    }

    fn at_separator(&self) -> bool {
        let rest = self.rest();
        rest.starts_with([',', ';', '\n', '&']) || Cursor { text: self.text, at: self.at }.eat_word("and")
    }

    fn skip_separators(&mut self) {
        loop {
            let before = self.at;
            self.skip_space();
            self.eat_any(&[',', ';', '\n', '\r', '&']);
            self.eat_word("and");
            if self.at == before {
                return;
            }
        }
    }

    fn unreadable(&self, start: usize, end: usize) -> Problem {
        let shown = if self.text[start..end].trim().is_empty() { self.text } else { &self.text[start..end] };
        Problem::new(CODE, start, end, format!("{} is not a number we can read.", quote(shown))).help(HELP)
    }

    /// Passes over `a double pole at`, `two poles at`, `the poles are` in front of a pole.
    fn words(&mut self) -> Result<Option<Told>, Problem> {
        const NOUNS: &[&str] = &["pole", "poles", "root", "roots", "eigenvalue", "eigenvalues", "pair"];
        const BESIDE: &[&str] = &[
            "a",
            "an",
            "the",
            "real",
            "complex",
            "conjugate",
            "stable",
            "unstable",
            "simple",
            "single",
            "one",
            "another",
            "of",
            "is",
            "are",
            "lies",
            "lie",
            "there",
            "located",
            "its",
            "and",
            "with",
            "in",
        ];
        let start = self.at;
        let (mut end, mut noun, mut at_place, mut each, mut together) = (start, false, false, 1, 0);
        loop {
            let rest = self.text[end..].trim_start_matches([' ', '\t']);
            let from = self.text.len() - rest.len();
            let length = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
            let word = rest[..length].to_lowercase();
            match word.as_str() {
                "double" => each = 2,
                "triple" => each = 3,
                "two" | "both" => together = 2,
                "three" => together = 3,
                "four" => together = 4,
                "at" => at_place = true,
                // Only as the place of a pole: `the origin` is 0.
                word if NOUNS.contains(&word) => noun = true,
                word if BESIDE.contains(&word) => {}
                _ => break,
            }
            end = from + length;
        }
        let told = noun || (at_place && end > start);
        if !told {
            return Ok(None);
        }
        if self.text[end..].starts_with(':') {
            end += 1;
        }
        if self.text[end..].trim().is_empty() {
            return Err(self.unreadable(start, end));
        }
        self.at = end;
        match (each, together) {
            (each, 0) => Ok(Some(Told::Each(each))),
            (1, together) => Ok(Some(Told::Together(together))),
            _ => Err(self.unreadable(start, end)),
        }
    }

    /// A pole, its conjugate after `±`, and repetitions.
    fn item(&mut self) -> Result<Vec<ReadPole>, Problem> {
        let named = self.skip_name();
        let start = self.at;
        if self.eat_word("origin") || self.eat_word("the origin") {
            let zero = Decimal { text: "0".to_owned(), value: crate::algebra::Rational::ZERO, last_place: 0 };
            let pole = ReadPole { re: zero, im: Decimal::absent(), start, end: self.at };
            return Ok(vec![pole; self.multiplicity()?]);
        }
        let opened = self.eat_any(&['(']).is_some();
        let first = self.term(start, true)?;
        self.skip_space();
        let second = match self.peek() {
            Some(c) if is_minus(c) || matches!(c, '+' | '±' | '∓') => Some(self.term(start, false)?),
            _ => None,
        };
        if opened {
            self.skip_space();
            if self.eat_any(&[')']).is_none() {
                return Err(Problem::new(
                    CODE,
                    start,
                    self.at,
                    "A parenthesis is opened here and not closed.",
                )
                .help(HELP));
            }
        }
        let end = self.at;
        let (re, im) = match (&first, &second) {
            (a, None) if a.imaginary => (vec![Decimal::absent()], a.values()),
            (a, None) => (a.values(), vec![Decimal::absent()]),
            (a, Some(b)) if a.imaginary != b.imaginary => {
                let (re, im) = if a.imaginary { (b, a) } else { (a, b) };
                if re.sign == Sign::Both {
                    return Err(self.unreadable(start, end));
                }
                (re.values(), im.values())
            }
            _ => return Err(self.two_of_a_kind(&first, start, end)),
        };
        self.skip_unit();
        let once: Vec<ReadPole> = re
            .iter()
            .flat_map(|re| im.iter().map(|im| ReadPole { re: re.clone(), im: im.clone(), start, end }))
            .collect();
        // `s_1,2 = 0` is a pole that is there twice.
        let times = self.multiplicity()?.max(if once.len() == 1 { named } else { 1 });
        Ok(once.iter().flat_map(|pole| std::iter::repeat_n(pole.clone(), times)).collect())
    }

    fn two_of_a_kind(&self, first: &Term, start: usize, end: usize) -> Problem {
        let kind = if first.imaginary { "imaginary" } else { "real" };
        let typed = quote(&self.text[start..end]);
        Problem::new(CODE, start, end, format!("{typed} has two {kind} parts.")).help(if first.imaginary {
            HELP.to_owned()
        } else {
            format!("An imaginary part ends in `j` or `i`. {HELP}")
        })
    }

    /// Passes over `s =`, `p1 =`, `p_{1,2}:`, `≈` in front of a pole; how many poles the indices name, at least 1.
    fn skip_name(&mut self) -> usize {
        let mut named = 1;
        let mut before: Option<String> = None;
        loop {
            self.skip_space();
            let rest = self.rest();
            let name = rest.char_indices().find(|(i, c)| {
                !(*i == 0
                    || c.is_ascii_digit()
                    || matches!(c, '_' | '{' | '}' | ',' | ' ' | '₀'..='₉' | '-' | '/'))
            });
            let Some((i, c)) = name.filter(|(_, c)| matches!(c, '=' | ':' | '≈')) else { break };
            if !rest.starts_with(char::is_alphabetic) {
                break;
            }
            let own = rest[..i].trim().to_owned();
            // `s1 = s2 = 0` is a pole that is there twice, `s = p = 0` is not.
            named = match &before {
                Some(other) if *other != own && other.chars().next() == own.chars().next() => {
                    named + indices(&own)
                }
                _ => named.max(indices(&own)),
            };
            before = Some(own);
            self.at += i + c.len_utf8();
        }
        loop {
            self.skip_space();
            if self.eat_any(&['≈', '~', '=']).is_none() {
                return named;
            }
        }
    }

    /// `+`, `-`, `±`, `+-`, `+/-`; `None` when no sign stands here.
    fn sign(&mut self) -> Option<Sign> {
        let c = self.peek()?;
        let kind = |c: char| match c {
            '+' => Some(Sign::Plus),
            '±' | '∓' => Some(Sign::Both),
            c if is_minus(c) => Some(Sign::Minus),
            _ => None,
        };
        let first = kind(c)?;
        self.at += c.len_utf8();
        if first == Sign::Both {
            return Some(first);
        }
        let rest = self.rest();
        let other = rest.strip_prefix('/').unwrap_or(rest);
        match other.chars().next().map(|c| (c, kind(c))) {
            Some((c, Some(second))) if second != first && second != Sign::Both => {
                self.at = self.text.len() - other.len() + c.len_utf8();
                Some(Sign::Both)
            }
            _ => Some(first),
        }
    }

    fn imaginary_unit(&mut self) -> bool {
        let mut after = self.rest().chars();
        let unit = after.next().is_some_and(|c| matches!(c, 'i' | 'j' | 'I' | 'J'));
        let alone = !after.next().is_some_and(|c| c.is_alphabetic());
        if unit && alone {
            self.at += 1;
        }
        unit && alone
    }

    fn term(&mut self, item: usize, first: bool) -> Result<Term, Problem> {
        self.skip_space();
        let sign = match self.sign() {
            Some(sign) => sign,
            None if first => Sign::Plus,
            None => return Err(self.unreadable(item, self.text.len())),
        };
        self.skip_space();
        if self.imaginary_unit() {
            self.skip_space();
            if self.eat_any(&['*', '·', '×']).is_some() {
                self.skip_space();
            }
            let size = match self.number()? {
                Some(size) => size,
                None => Decimal { text: "1".to_owned(), ..unit_size() },
            };
            return Ok(Term { sign, size, imaginary: true });
        }
        let Some(size) = self.number()? else {
            return Err(self.unreadable(item, self.end_of_item()));
        };
        let after_number = self.at;
        self.skip_space();
        let times = self.eat_any(&['*', '·', '×']).is_some();
        self.skip_space();
        let imaginary = self.imaginary_unit();
        if !imaginary {
            self.at = after_number;
            // `-1 × 2` may be a multiplicity, `-1 * x` is not a number.
            if times && self.rest().trim_start().starts_with(['*', '·']) {
                return Err(self.unreadable(item, self.end_of_item()));
            }
        }
        Ok(Term { sign, size, imaginary })
    }

    fn number(&mut self) -> Result<Option<Decimal>, Problem> {
        let start = self.at;
        if let Some((value, end)) = root(self.rest()) {
            self.at += end;
            return Ok(Some(value));
        }
        let Some(number) = self.plain_number()? else { return Ok(None) };
        // `-1/98.77`; but `1/2j` can be read in two ways.
        let after = self.at;
        self.skip_space();
        if self.eat_any(&['/']).is_some() {
            self.skip_space();
            if let Some(below) = self.plain_number()?
                && !below.is_zero()
                && !self
                    .rest()
                    .trim_start_matches([' ', '*', '·'])
                    .starts_with(['i', 'j', 'I', 'J', '/', '^'])
                && let Ok(value) = parse_decimal(&significant(to_f64(&(&number.value / &below.value)), 14))
            {
                let text = self.text[start..self.at].to_owned();
                return Ok(Some(Decimal { text, value, last_place: number.last_place.min(-12) }));
            }
        }
        self.at = after;
        Ok(Some(number))
    }

    fn plain_number(&mut self) -> Result<Option<Decimal>, Problem> {
        let Some((number, length)) = scan(self.rest()) else { return Ok(None) };
        if let Some(problem) = decimal_comma(self.text, self.at, length) {
            return Err(problem);
        }
        let start = self.at;
        self.at += length;
        // `3..1` and `1.2.3`: the rest of the digits belong to the complaint.
        if self.rest().starts_with('.') {
            return Err(self.unreadable(start, self.end_of_item()));
        }
        number.map(Some).map_err(|error| Problem::new(CODE, start, self.at, format!("{error}.")).help(HELP))
    }

    fn end_of_item(&self) -> usize {
        let rest = self.rest();
        self.at + rest.find([',', ';', '\n', ']']).unwrap_or(rest.len())
    }

    fn skip_unit(&mut self) {
        let here = self.at;
        self.skip_space();
        let rest = self.rest();
        for unit in ["rad/sec", "rad/s", "1/s", "s^-1", "s⁻¹"] {
            if rest.starts_with(unit) && !rest[unit.len()..].starts_with(char::is_alphanumeric) {
                self.at += unit.len();
                return;
            }
        }
        self.at = here;
    }

    /// `(x2)`, `×2`, `(double)`, `twice`, `(multiplicity 2)`, `(2 times)` after a pole; 1 when nothing is said.
    fn multiplicity(&mut self) -> Result<usize, Problem> {
        let here = self.at;
        self.skip_space();
        if self.at_separator() {
            self.at = here;
            return Ok(1);
        }
        let start = self.at;
        let parenthesised = self.rest().starts_with(['(', '[']);
        let words = if parenthesised {
            let close = self.rest().find([')', ']']).map(|i| self.at + i);
            let Some(close) = close else {
                return Err(Problem::new(
                    CODE,
                    start,
                    self.text.len(),
                    "A parenthesis is opened here and not closed.",
                )
                .help(HELP));
            };
            self.at = close + 1;
            self.text[start + 1..close].to_owned()
        } else {
            let end = self.end_of_item();
            let words = self.text[start..end].to_owned();
            // `-1 double and -2`: the separator is not part of it.
            let words = words.split(" and ").next().unwrap_or_default().trim_end().to_owned();
            self.at = start + words.len();
            words
        };
        if words.is_empty() && !parenthesised {
            self.at = here;
            return Ok(1);
        }
        match times(&words) {
            Some(n) if (1..=MAX_POLES).contains(&n) => Ok(n),
            _ => Err(Problem::new(
                "poles.multiplicity",
                start,
                self.at,
                format!(
                    "{} after a pole is not read as its multiplicity.",
                    quote(&self.text[start..self.at])
                ),
            )
            .help("Write a double pole like `-1 (x2)`, or list it twice.")),
        }
    }
}

/// How many poles a name with indices stands for: 2 for `s_1,2` and `p_{3/4}`, 1 for `p1` and for `p1-3`, which says less.
fn indices(name: &str) -> usize {
    let digits =
        |part: &str| !part.is_empty() && part.chars().all(|c| c.is_ascii_digit() || ('₀'..='₉').contains(&c));
    let listed = name.trim_start_matches(char::is_alphabetic).trim_start_matches(['_', '{', ' ']);
    let parts: Vec<&str> = listed.trim_end_matches(['}', ' ']).split([',', '/']).map(str::trim).collect();
    if parts.len() <= MAX_POLES && parts.iter().all(|part| digits(part)) { parts.len() } else { 1 }
}

/// A number whose whole part is followed by `,` and a digit, where the comma may also separate two poles.
fn decimal_comma(text: &str, start: usize, length: usize) -> Option<Problem> {
    let fraction = text[start + length..].strip_prefix(',')?;
    let digits = fraction.bytes().take_while(u8::is_ascii_digit).count();
    if digits == 0 || text[start..start + length].contains(['.', 'e', 'E']) {
        return None;
    }
    let end = start + length + 1 + digits;
    let minus = text[..start].trim_end().chars().next_back().is_some_and(is_minus);
    let written = format!(
        "{}{}.{}",
        if minus { "-" } else { "" },
        &text[start..start + length],
        &text[start + length + 1..end]
    );
    Some(
        Problem::new(
            "number.decimal_comma",
            start,
            end,
            format!("{} may be one number or two, and is not read.", quote(&text[start..end])),
        )
        .help(format!("Write {}; if two numbers are meant, put a space after the comma.", quote(&written))),
    )
}

/// `sqrt(1962)`, `√1962`, `\\sqrt{1962}` at the beginning, as the nearest decimal of 14 figures; and its length.
fn root(text: &str) -> Option<(Decimal, usize)> {
    let after = ["\\sqrt", "sqrt", "√"].iter().find_map(|sign| text.strip_prefix(sign))?;
    let inner = after.trim_start();
    let close = match inner.chars().next()? {
        '(' => Some(')'),
        '{' => Some('}'),
        _ => None,
    };
    let inner = inner.strip_prefix(['(', '{']).unwrap_or(inner).trim_start();
    let (number, length) = scan(inner)?;
    let mut rest = &inner[length..];
    if let Some(close) = close {
        rest = rest.trim_start().strip_prefix(close)?;
    }
    let end = text.len() - rest.len();
    let decimal = Decimal::parse(&significant(to_f64(&number.ok()?.value).sqrt(), 14)).ok()?;
    Some((Decimal { text: text[..end].to_owned(), ..decimal }, end))
}

fn unit_size() -> Decimal {
    Decimal { text: "1".to_owned(), value: crate::algebra::Rational::ONE, last_place: 0 }
}

fn times(words: &str) -> Option<usize> {
    let lower = words.to_lowercase();
    if is_remark(&lower) {
        return Some(1);
    }
    if lower
        .contains(|c: char| !c.is_alphanumeric() && !c.is_whitespace() && !matches!(c, '×' | '=' | ':' | '-'))
    {
        return None;
    }
    // `x2`, `2x` and `×2` become `x 2`.
    let lower = lower.replace('×', " x ");
    let (mut number, mut bare, mut marked) = (None, false, false);
    for word in lower.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()) {
        let n = match word {
            "double" | "twice" | "two" => 2,
            "triple" | "thrice" | "three" => 3,
            "quadruple" | "four" => 4,
            "simple" | "once" | "single" => 1,
            "multiplicity" | "mult" | "order" | "times" | "time" | "x" | "m" | "n" | "repeated" => {
                marked = true;
                continue;
            }
            "of" | "pole" | "poles" | "root" | "roots" | "real" | "a" | "conjugate" | "pair" | "complex" => {
                continue;
            }
            word => {
                let digits = word.strip_prefix('x').or_else(|| word.strip_suffix('x')).unwrap_or(word);
                marked |= digits.len() < word.len();
                bare = true;
                digits.parse().ok()?
            }
        };
        if number.is_some_and(|before| before != n) {
            return None;
        }
        number = Some(n);
    }
    match number {
        Some(_) if bare && !marked => None,
        Some(n) => Some(n),
        None => harmless_remark(&lower).then_some(1),
    }
}

/// `(pole)`, `(complex conjugate pair)`: says nothing about how often.
fn harmless_remark(lower: &str) -> bool {
    !lower.contains("repeated")
        && !lower.contains("mult")
        && !lower.contains("order")
        && lower.contains("pole")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<(String, String)>, Problem> {
        parse_poles(text).map(|poles| poles.into_iter().map(|p| (p.re.text, p.im.text)).collect())
    }

    #[track_caller]
    fn check(text: &str, expected: &[(&str, &str)]) {
        let found = read(text).unwrap_or_else(|p| panic!("{text:?}: {p:?}"));
        let found: Vec<_> = found.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
        assert_eq!(found, expected, "{text:?}");
    }

    #[test]
    fn every_spelling_of_a_pair() {
        for text in [
            "-0.0195 ± 5.59j",
            "-0.0195±5.59j",
            "-0.0195 +- 5.59j",
            "-0.0195 +/- 5.59j",
            "-0.0195 -+ 5.59j",
            "-0.0195 +/- 5.59i",
            "-0.0195 ± 5.59J",
            "-0.0195 ± j5.59",
            "-0.0195 ± j 5.59",
            "-0.0195 ± i5.59",
            "-0.0195 ± j*5.59",
            "-0.0195 ± 5.59*j",
            "-0.0195 ± 5.59 * j",
            "-0.0195 ± 5.59·j",
            "\u{2212}0.0195 ± 5.59j",
            "\u{2212}\u{a0}0.0195\u{a0}±\u{a0}5.59j",
            "- 0.0195 ± 5.59 j",
            "(-0.0195 ± 5.59j)",
            "±5.59j - 0.0195",
            "s = -0.0195 ± 5.59j",
            "p_{1,2} = -0.0195 ± 5.59j",
            "p1,2 = -0.0195 ± 5.59j",
            "-0.0195 ± 5.59j rad/s",
            "-0.0195 ± 5.59j (complex conjugate poles)",
            "-0.0195 + 5.59j, -0.0195 - 5.59j",
            "[-0.0195 + 5.59i; -0.0195 - 5.59i]",
            "-0.0195+5.59i\n-0.0195-5.59i\n",
            "-0.0195 + j5.59 and -0.0195 - j5.59",
        ] {
            check(text, &[("-0.0195", "5.59"), ("-0.0195", "-5.59")]);
        }
    }

    #[test]
    fn real_and_imaginary_poles() {
        check("-0.143", &[("-0.143", "0")]);
        check("-1e-3", &[("-1e-3", "0")]);
        check("-1.4×10^-1", &[("-1.4e-1", "0")]);
        check("0", &[("0", "0")]);
        check("≈ -0.14", &[("-0.14", "0")]);
        check("j", &[("0", "1")]);
        check("-j2", &[("0", "-2")]);
        check("±3", &[("3", "0"), ("-3", "0")]);
        check("± 5.5j", &[("0", "5.5"), ("0", "-5.5")]);
        check("0 ± 5.5j", &[("0", "5.5"), ("0", "-5.5")]);
        check("-1, -2, -3", &[("-1", "0"), ("-2", "0"), ("-3", "0")]);
        check("-1,-2,-3", &[("-1", "0"), ("-2", "0"), ("-3", "0")]);
        check("-1; -2", &[("-1", "0"), ("-2", "0")]);
        check("-1 and -2", &[("-1", "0"), ("-2", "0")]);
        check("", &[]);
        check("[]", &[]);
        check("-1, -2, all in the left half plane", &[("-1", "0"), ("-2", "0")]);
        check("-1, -2 (both in the LHP)", &[("-1", "0"), ("-2", "0")]);
        check("-1 and -2, so the system is stable.", &[("-1", "0"), ("-2", "0")]);
        check("-1 -2+3i -2-3i", &[("-1", "0"), ("-2", "3"), ("-2", "-3")]);
        check("-1 -2±3j", &[("-1", "0"), ("-2", "3"), ("-2", "-3")]);
        check("-1 -2 -3", &[("-1", "0"), ("-2", "0"), ("-3", "0")]);
        check("[-1 2]", &[("-1", "0"), ("2", "0")]);
        check("-1 +2i", &[("-1", "2")]);
        check("−3 −1+2i", &[("-3", "0"), ("-1", "2")]);
        check("pole at s = -0.05", &[("-0.05", "0")]);
        check("pole: -0.05", &[("-0.05", "0")]);
        check("complex pair at -1 ± 2j", &[("-1", "2"), ("-1", "-2")]);
        check("-1/98.77", &[("-1/98.77", "0")]);
        check("±sqrt(1962)", &[("sqrt(1962)", "0"), ("-sqrt(1962)", "0")]);
        check("-1 ± √2 j", &[("-1", "√2"), ("-1", "-√2")]);
        check(
            "ans =\n\n  -1.0000 + 2.0000i\n  -1.0000 - 2.0000i\n",
            &[("-1.0000", "2.0000"), ("-1.0000", "-2.0000")],
        );
        check(
            "p =\n\n   1.0e+02 *\n\n  -0.2398 + 0.3519i\n  -0.2398 - 0.3519i\n  -0.0500\n",
            &[("-0.2398e2", "0.3519e2"), ("-0.2398e2", "-0.3519e2"), ("-0.0500e2", "0")],
        );
        check("array([-1.+2.j, -1.-2.j,\n       -3.+0.j])", &[("-1", "2"), ("-1", "-2"), ("-3", "0")]);
        check("[-1.+2.j -1.-2.j\n -3.+0.j -4.+0.j]", &[("-1", "2"), ("-1", "-2"), ("-3", "0"), ("-4", "0")]);
    }

    #[test]
    fn a_scale_in_front_counts() {
        let poles = parse_poles("ans =\n  1.0e+03 *\n  -0.2398\n  -0.0500").unwrap();
        let values: Vec<_> = poles.iter().map(|pole| (to_f64(&pole.re.value), pole.re.last_place)).collect();
        assert_eq!(values, [(-239.8, -1), (-50.0, -1)]);
        let text = "ans =\n  1.0e+03 *\n  -0.2398";
        assert_eq!(&text[poles[0].start..poles[0].end], "-0.2398");
        assert!((to_f64(&parse_poles("-1/98.77").unwrap()[0].re.value) + 1.0 / 98.77).abs() < 1e-14);
        assert!((to_f64(&parse_poles("sqrt(2)").unwrap()[0].re.value) - 2f64.sqrt()).abs() < 1e-13);
    }

    #[test]
    fn multiplicities() {
        for text in [
            "-1 (x2)",
            "-1 x2",
            "-1 (×2)",
            "-1 ×2",
            "-1 × 2",
            "-1 (2x)",
            "-1 (double)",
            "-1 double",
            "-1 (double pole)",
            "-1 (twice)",
            "-1 (multiplicity 2)",
            "-1 (multiplicity: 2)",
            "-1 (m = 2)",
            "-1 (2 times)",
            "-1 (order 2)",
            "-1 (repeated twice)",
            "(-1) (x2)",
        ] {
            check(text, &[("-1", "0"), ("-1", "0")]);
        }
        for text in [
            "s1 = s2 = 0",
            "s_1 = s_2 = 0",
            "double pole at 0",
            "a double pole at s = 0",
            "two poles at s = 0",
            "both poles at 0",
            "double pole at the origin",
            "Double pole in the origin",
            "two poles in the origin",
            "0 (two times)",
            "0 (double)",
            "two poles: 0, 0",
            "the poles are 0 and 0",
        ] {
            check(text, &[("0", "0"), ("0", "0")]);
        }
        check("two poles at 0 and one at -5", &[("0", "0"), ("0", "0"), ("-5", "0")]);
        check("two poles at -1 and -2", &[("-1", "0"), ("-2", "0")]);
        check("a pole at -1 and a double pole at -2", &[("-1", "0"), ("-2", "0"), ("-2", "0")]);
        check("s = p = 0", &[("0", "0")]);
        check("-1 (triple), -2", &[("-1", "0"), ("-1", "0"), ("-1", "0"), ("-2", "0")]);
        check("-1 double and -2", &[("-1", "0"), ("-1", "0"), ("-2", "0")]);
        check("-1 ± 2j (x2)", &[("-1", "2"), ("-1", "2"), ("-1", "-2"), ("-1", "-2")]);
    }

    #[test]
    fn what_is_not_a_pole_says_where_and_how() {
        for (text, code, marked) in [
            ("-2+j3..1", CODE, "3..1"),
            ("-0,143", "number.decimal_comma", "0,143"),
            ("-0.0195 ± 5,59j", "number.decimal_comma", "5,59"),
            ("-1 + 2", CODE, "-1 + 2"),
            ("2j + 3j", CODE, "2j + 3j"),
            ("-1 -2", CODE, "-1 -2"),
            ("sqrt(x)", CODE, "sqrt(x)"),
            ("-1/2j", "poles.multiplicity", "/2j"),
            ("two poles at 0, -5 and -7", CODE, "two poles at 0, -5 and -7"),
            ("double two poles at 0", CODE, "double two poles at"),
            ("pole at", CODE, "pole at"),
            ("-1 (repeated)", "poles.multiplicity", "(repeated)"),
            ("-1 2", "poles.multiplicity", "2"),
            ("-3 -1 +2i", CODE, "-3 -1"),
            ("-3 -1 +2i -1 -2i", CODE, "-3 -1"),
            ("-3 -2 +1e-3i", CODE, "-3 -2"),
            ("-1, -2, zero", CODE, "zero"),
            ("-1, -2, all double", CODE, "all double"),
            ("-1 (2)", "poles.multiplicity", "(2)"),
            ("-1 (x0)", "poles.multiplicity", "(x0)"),
            ("-1 (x1000000)", "poles.multiplicity", "(x1000000)"),
            ("-1 (x2", CODE, "(x2"),
            ("(-1", CODE, "(-1"),
            ("±1 ± 2j", CODE, "±1 ± 2j"),
            ("5∠90°", "poles.multiplicity", "∠90°"),
            ("-1, abc, -2", CODE, "abc"),
            ("1e999", CODE, "1e999"),
            ("nan", CODE, "nan"),
        ] {
            let problem = read(text).unwrap_err();
            assert_eq!(
                (problem.code, &text[problem.start..problem.end]),
                (code, marked),
                "{text:?}: {problem:?}"
            );
            assert!(problem.help.is_some() && problem.message.ends_with('.'), "{problem:?}");
        }
        assert_eq!(read(&"-1,".repeat(200)).unwrap_err().code, "poles.too_many");
        assert!(read(&"(".repeat(100_000)).is_err());
    }

    #[test]
    fn the_help_of_a_decimal_comma_keeps_the_sign() {
        let problem = read("-0,143").unwrap_err();
        assert!(problem.help.unwrap().starts_with("Write `-0.143`;"));
    }

    #[test]
    fn each_pole_knows_its_place() {
        let text = "-1, -2 ± 3j (x2)";
        let places: Vec<_> = parse_poles(text).unwrap().iter().map(|p| &text[p.start..p.end]).collect();
        assert_eq!(places, ["-1", "-2 ± 3j", "-2 ± 3j", "-2 ± 3j", "-2 ± 3j"]);
    }
}
