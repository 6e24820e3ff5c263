//! Reads `hard_polynomials.txt`, for the tests and the benchmark.

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
    let mut entries: Vec<Entry> = Vec::new();
    let lines = include_str!("hard_polynomials.txt").lines();
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            entries.push(Entry { name: name.to_string(), ..Entry::default() });
            continue;
        }
        let entry = entries.last_mut().expect("a name comes first");
        match line.split_once(": ") {
            Some(("source", _)) => {}
            Some(("p", text)) => entry.p = multiplied_out(text),
            Some(("num", text)) => entry.num = Some(multiplied_out(text)),
            Some(("cancels", text)) => entry.cancels = text.parse().unwrap(),
            Some(("stability", text)) => entry.stability = text.to_string(),
            Some(("right", text)) => entry.right = text.parse().unwrap(),
            Some(("refused", text)) => entry.refused = Some(text.to_string()),
            Some((key, _)) => panic!("{}: {key}", entry.name),
            None => {
                let parts: Vec<&str> = line.split(' ').collect();
                let [multiplicity, re, im] = parts[..] else { panic!("{}: {line}", entry.name) };
                entry.roots.push((multiplicity.parse().unwrap(), decimal(re), decimal(im)));
            }
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
