//! Reads `hard_polynomials.txt` and its like, for the tests and the benchmark.

use polemark::algebra::{Polynomial, Rational, parse_decimal};

/// One entry of the table; its head says what each line means.
#[derive(Default)]
pub struct Entry {
    pub name: String,
    pub p: Polynomial,
    pub num: Option<Polynomial>,
    pub cancels: usize,
    pub stability: String,
    pub right: usize,
    pub refused: Option<String>,
    /// Multiplicity, real and imaginary part; none below the real axis.
    pub roots: Vec<(usize, Rational, Rational)>,
}

pub fn table() -> Vec<Entry> {
    entries(
        include_str!("hard_polynomials.txt"),
        |name| Entry { name, ..Entry::default() },
        |entry, line| match line {
            Line::Key("source", _) => {}
            Line::Key("p", text) => entry.p = multiplied_out(text),
            Line::Key("num", text) => entry.num = Some(multiplied_out(text)),
            Line::Key("cancels", text) => entry.cancels = text.parse().unwrap(),
            Line::Key("stability", text) => entry.stability = text.to_string(),
            Line::Key("right", text) => entry.right = text.parse().unwrap(),
            Line::Key("refused", text) => entry.refused = Some(text.to_string()),
            Line::Key(key, _) => panic!("{}: {key}", entry.name),
            Line::Row(row) => {
                let [multiplicity, re, im] = row[..] else { panic!("{}: {row:?}", entry.name) };
                entry.roots.push((multiplicity.parse().unwrap(), decimal(re), decimal(im)));
            }
        },
    )
}

/// A line of an entry: `key: text`, or words.
pub enum Line<'a> {
    Key(&'a str, &'a str),
    Row(Vec<&'a str>),
}

/// The entries of a table, each under its `[name]`, blank lines and those that begin with `#` left out.
pub fn entries<E>(text: &str, new: impl Fn(String) -> E, read: impl Fn(&mut E, Line<'_>)) -> Vec<E> {
    let mut entries: Vec<E> = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            entries.push(new(name.to_string()));
            continue;
        }
        let entry = entries.last_mut().expect("a name comes first");
        match line.split_once(": ") {
            Some((key, text)) => read(entry, Line::Key(key, text)),
            None => read(entry, Line::Row(line.split(' ').collect())),
        }
    }
    entries
}

/// `1 2 3` or `(1 1)^10 (1 2)`.
pub fn multiplied_out(text: &str) -> Polynomial {
    let polynomial = |text: &str| Polynomial::new(text.split_whitespace().map(decimal).collect());
    if !text.starts_with('(') {
        return polynomial(text);
    }
    text.split('(').skip(1).fold(Polynomial::one(), |product, factor| {
        let (coefficients, power) = factor.split_once(')').unwrap();
        let power = power.trim().strip_prefix('^').map_or(1, |power| power.parse().unwrap());
        (0..power).fold(product, |product, _| &product * &polynomial(coefficients))
    })
}

fn decimal(text: &str) -> Rational {
    parse_decimal(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}
