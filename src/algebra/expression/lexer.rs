use super::super::clip::clip;
use super::super::{NumberError, Rational, greek, parse_decimal};
use super::{ExpressionError, Function};
use unicode_normalization::UnicodeNormalization;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    pub kind: TokenKind,
    pub start: usize,
    pub end: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum TokenKind {
    Number(Rational),
    Pi,
    Symbol {
        name: String,
        primes: u8,
    },
    Function(Function),
    Plus,
    Minus,
    Times,
    Over,
    Power,
    /// A power written small: `²`, `⁻¹`.
    Superscript(Rational),
    Equals,
    /// Any opening bracket; they all mean `(`.
    Open,
    Close,
    /// LaTeX's `\frac`, before its two groups in braces.
    Fraction,
    /// `√`, before what it is the root of.
    Root,
    /// `°`, behind a number of degrees.
    Degrees,
}

/// Longer formulas are refused unread.
pub(super) const MOST_BYTES: usize = 4_000;
/// No name is differentiated more often than this.
const MOST_PRIMES: usize = 9;

/// Cuts a text into tokens.
///
/// Reads what people paste: `−`, `·`, `×`, `s²`, `𝑠` (a PDF's italics), `θ`, `ẍ`, `\frac`, `\cdot`.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, ExpressionError> {
    if text.len() > MOST_BYTES {
        return Err(ExpressionError {
            start: 0,
            end: 0,
            message: format!("a formula of {} bytes is longer than the {MOST_BYTES} we read", text.len()),
            help: None,
        });
    }
    let mut lexer = Lexer { text, at: 0, tokens: Vec::new() };
    while let Some(c) = lexer.peek() {
        lexer.token(c)?;
    }
    Ok(lexer.tokens)
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    tokens: Vec<Token>,
}

impl Lexer<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn skip(&mut self, c: char) {
        self.at += c.len_utf8();
    }

    fn push(&mut self, start: usize, kind: TokenKind) {
        self.tokens.push(Token { kind, start, end: self.at });
    }

    fn token(&mut self, c: char) -> Result<(), ExpressionError> {
        let start = self.at;
        if c.is_whitespace() || matches!(c, '\u{200b}' | '\u{2060}' | '\u{feff}') {
            self.skip(c);
            return Ok(());
        }
        if superscript(c).is_some() {
            return self.superscript(start);
        }
        let kind = match plain(c) {
            '+' => TokenKind::Plus,
            '-' => TokenKind::Minus,
            '*' if self.text[self.at..].starts_with("**") => {
                self.at += 1;
                TokenKind::Power
            }
            '*' => TokenKind::Times,
            '/' => TokenKind::Over,
            '^' => TokenKind::Power,
            '=' => TokenKind::Equals,
            '(' | '[' | '{' => TokenKind::Open,
            ')' | ']' | '}' => TokenKind::Close,
            '√' => TokenKind::Root,
            '°' => TokenKind::Degrees,
            '0'..='9' | '.' => return self.number(start),
            '\\' => return self.command(start),
            ',' => return Err(self.comma(start)),
            first if first.is_ascii_alphabetic() || first == '_' || greek::name(first).is_some() => {
                return self.name(start);
            }
            _ => {
                self.skip(c);
                return Err(error(start, self.at, format!("`{}` has no meaning in a formula", shown(c))));
            }
        };
        self.skip(c);
        self.push(start, kind);
        Ok(())
    }

    fn digits(&mut self, into: &mut String) {
        while let Some(c) = self.peek()
            && superscript(c).is_none()
            && plain(c).is_ascii_digit()
        {
            into.push(plain(c));
            self.skip(c);
        }
    }

    fn number(&mut self, start: usize) -> Result<(), ExpressionError> {
        let mut digits = String::new();
        self.digits(&mut digits);
        if let Some(c) = self.peek()
            && plain(c) == '.'
        {
            digits.push('.');
            self.skip(c);
            self.digits(&mut digits);
        }
        if self.peek() == Some(',') {
            return Err(self.comma(start));
        }
        self.exponent(&mut digits);
        let value = parse_decimal(&digits).map_err(|e| match e {
            NumberError::NotANumber { text } => error(start, self.at, format!("`{text}` is not a number")),
            other => error(start, self.at, other.to_string()),
        })?;
        if self.peek() == Some('.') {
            let end = self.at + 1;
            return Err(error(
                start,
                end,
                format!("`{}` has two decimal points", clip(&self.text[start..end])),
            ));
        }
        self.push(start, TokenKind::Number(value));
        Ok(())
    }

    /// `e-3` belongs to the number, `e` without digits after it is a name.
    fn exponent(&mut self, digits: &mut String) {
        let before = self.at;
        let Some(e @ ('e' | 'E')) = self.peek() else { return };
        self.skip(e);
        let mut exponent = String::from("e");
        if let Some(sign) = self.peek()
            && matches!(plain(sign), '+' | '-')
        {
            exponent.push(plain(sign));
            self.skip(sign);
        }
        let sign_end = exponent.len();
        self.digits(&mut exponent);
        if exponent.len() > sign_end {
            digits.push_str(&exponent);
        } else {
            self.at = before;
        }
    }

    fn superscript(&mut self, start: usize) -> Result<(), ExpressionError> {
        let mut digits = String::new();
        while let Some(c) = self.peek()
            && let Some(digit) = superscript(c)
        {
            digits.push(digit);
            self.skip(c);
        }
        let value = parse_decimal(&digits).map_err(|_| {
            let found = clip(&self.text[start..self.at]);
            let mut e = error(start, self.at, format!("`{found}` is not a power"));
            e.help = Some("write it as `^2`".to_owned());
            e
        })?;
        self.push(start, TokenKind::Superscript(value));
        Ok(())
    }

    /// A Greek letter is a name by itself; Latin letters and digits run on.
    fn name(&mut self, start: usize) -> Result<(), ExpressionError> {
        let mut name = String::new();
        let mut primes = 0;
        let mut greek_start = false;
        let mut in_index = false;
        while let Some(c) = self.peek()
            && superscript(c).is_none()
            && primes == 0
            // What is written small ends a name: J₁J₂ are two.
            && (is_subscript(c) || !in_index)
        {
            let base = plain(c);
            in_index = is_subscript(c) && !name.is_empty();
            if base == '_'
                && let Some(index) = braced(&self.text[self.at + c.len_utf8()..])
            {
                name.push('_');
                name.push_str(index);
                self.at += c.len_utf8() + index.len() + 2;
                greek_start = false;
                continue;
            }
            match greek::name(base) {
                Some(greek) if name.is_empty() => {
                    name.push_str(greek);
                    greek_start = true;
                }
                Some(_) => break,
                None if base.is_ascii_digit() || base == '_' => {
                    name.push(base);
                    greek_start = greek_start && base != '_';
                }
                None if base.is_ascii_alphabetic() && !greek_start => name.push(base),
                None => break,
            }
            primes += dots_in(c);
            self.skip(c);
        }
        while let Some(c) = self.peek() {
            match c {
                '\'' | '′' | '’' | '\u{307}' => primes += 1,
                '″' | '\u{308}' => primes += 2,
                _ => break,
            }
            self.skip(c);
        }
        if primes > MOST_PRIMES {
            let message = format!("`{}` has {primes} primes: {MOST_PRIMES} is the most we read", clip(&name));
            return Err(error(start, self.at, message));
        }
        self.push_name(start, name, primes as u8);
        Ok(())
    }

    fn push_name(&mut self, start: usize, name: String, primes: u8) {
        let kind = match Function::named(&name) {
            Some(function) if primes == 0 => TokenKind::Function(function),
            _ if name == "pi" && primes == 0 => TokenKind::Pi,
            _ => TokenKind::Symbol { name, primes },
        };
        self.push(start, kind);
    }

    /// What of LaTeX people paste into a formula.
    fn command(&mut self, start: usize) -> Result<(), ExpressionError> {
        // The backslash, or one of its wider look-alikes.
        self.at += self.text[self.at..].chars().next().map_or(0, char::len_utf8);
        let length = self.text[self.at..].bytes().take_while(u8::is_ascii_alphabetic).count();
        let command = self.text[self.at..self.at + length].to_owned();
        self.at += length;
        match command.as_str() {
            "" => match self.peek() {
                Some(c @ (',' | ';' | ':' | '!' | ' ')) => self.skip(c),
                Some(c @ ('{' | '}')) => {
                    self.skip(c);
                    self.push(start, if c == '{' { TokenKind::Open } else { TokenKind::Close });
                }
                _ => return Err(error(start, self.at, "`\\` has no meaning in a formula".to_owned())),
            },
            "left" | "right" | "big" | "Big" | "bigl" | "bigr" | "quad" | "mathrm" => {}
            "frac" | "dfrac" | "tfrac" => self.push(start, TokenKind::Fraction),
            // Behind `^`, with or without braces.
            "circ" => {
                let raised = |token: &Token| matches!(token.kind, TokenKind::Power | TokenKind::Open);
                let in_braces = matches!(self.tokens.last(), Some(Token { kind: TokenKind::Open, .. }));
                while self.tokens.last().is_some_and(raised) {
                    let power = self.tokens.pop().is_some_and(|token| token.kind == TokenKind::Power);
                    if power {
                        break;
                    }
                }
                if in_braces && self.peek() == Some('}') {
                    self.skip('}');
                }
                self.push(start, TokenKind::Degrees);
            }
            "cdot" | "times" => self.push(start, TokenKind::Times),
            name if Function::named(name).is_some() || greek::letter(name).is_some() => {
                // An index belongs to the letter: `\theta_0`.
                let mut name = command;
                if self.peek() == Some('_') {
                    let rest = &self.text[self.at + 1..];
                    let bare = || Some(&rest[..rest.bytes().take_while(u8::is_ascii_alphanumeric).count()]);
                    let (index, extra) = braced(rest).map_or((bare(), 0), |index| (Some(index), 2));
                    if let Some(index) = index.filter(|index| !index.is_empty()) {
                        name = format!("{name}_{index}");
                        self.at += 1 + index.len() + extra;
                    }
                }
                self.push_name(start, name, 0);
            }
            _ => {
                return Err(error(
                    start,
                    self.at,
                    format!("`\\{}` has no meaning in a formula", clip(&command)),
                ));
            }
        }
        Ok(())
    }

    /// What to say about the comma at `self.at`, in the number that begins at `start` or in none.
    fn comma(&self, start: usize) -> ExpressionError {
        let comma_end = self.at + self.peek().map_or(0, char::len_utf8);
        let after: String =
            self.text[comma_end..].chars().take_while(char::is_ascii_digit).take(40).collect();
        let before = clip(&self.text[start..self.at]);
        if before.is_empty() || after.is_empty() {
            return error(self.at, comma_end, "`,` has no meaning in a formula".to_owned());
        }
        let point = format!("{before}.{after}");
        let help = if after.len() == 3 && before.bytes().any(|b| matches!(b, b'1'..=b'9')) {
            format!("write `{point}` for a decimal fraction, or `{before}{after}` for thousands")
        } else {
            format!("write a decimal point: `{point}`")
        };
        ExpressionError {
            start,
            end: comma_end + after.len(),
            message: format!("`{before},{after}` has a comma where a decimal point is wanted"),
            help: Some(help),
        }
    }
}

/// The letters and digits of an index in braces: `m` of `{m}`.
fn braced(text: &str) -> Option<&str> {
    let (index, _) = text.strip_prefix('{')?.split_once('}')?;
    (!index.is_empty() && index.bytes().all(|b| b.is_ascii_alphanumeric())).then_some(index)
}

fn error(start: usize, end: usize, message: String) -> ExpressionError {
    ExpressionError { start, end, message, help: None }
}

/// A character made harmless for a message.
fn shown(c: char) -> String {
    if c.is_control() { c.escape_unicode().to_string() } else { c.to_string() }
}

/// The plain character behind a typographic one: `−` → `-`, `𝑠` → `s`, `ẍ` → `x`.
fn plain(c: char) -> char {
    if c.is_ascii() {
        return c;
    }
    match c {
        '−' | '–' | '‐' | '‑' | '—' => '-',
        '·' | '×' | '⋅' | '∙' | '∗' | '•' => '*',
        '÷' | '⁄' | '∕' => '/',
        _ if greek::name(c).is_some() => c,
        _ => std::iter::once(c).nfkd().next().unwrap_or(c),
    }
}

/// The time derivatives in a letter with dots: 2 in `ẍ`.
fn dots_in(c: char) -> usize {
    if c.is_ascii() {
        return 0;
    }
    let marks = std::iter::once(c).nfkd().skip(1);
    marks.map(|mark| if mark == '\u{307}' { 1 } else { 2 * usize::from(mark == '\u{308}') }).sum()
}

/// Digits and letters below the line.
fn is_subscript(c: char) -> bool {
    matches!(c, '₀'..='₉' | 'ₐ'..='ₜ' | 'ᵢ' | 'ᵣ' | 'ᵤ' | 'ᵥ' | 'ⱼ')
}

fn superscript(c: char) -> Option<char> {
    Some(match c {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁶' => '6',
        '⁷' => '7',
        '⁸' => '8',
        '⁹' => '9',
        '⁺' => '+',
        '⁻' => '-',
        _ => return None,
    })
}
