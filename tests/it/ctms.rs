//! What the Control Tutorials for MATLAB & Simulink print, held to every digit of it: `ctms.txt`.

use polemark::lab::{self, ExpectedValue, LabDefinition};
use polemark::reference::{Reference, values_at};
use polemark::source::SourceText;
use std::collections::BTreeMap;

/// One entry of the table; its head says what each line means.
struct Entry<'a> {
    lab: &'a str,
    place: &'a str,
    page: &'a str,
    times: f64,
    figures: Option<i32>,
    /// (key, values as printed, whether they hold).
    printed: Vec<(&'a str, Vec<&'a str>, bool)>,
}

#[test]
fn every_printed_digit_is_met() {
    let entries = table(include_str!("ctms.txt"));
    let mut references: BTreeMap<&str, Reference> = BTreeMap::new();
    let mut wrong = Vec::new();
    for entry in &entries {
        assert!(!entry.page.is_empty(), "{} {}: no page", entry.lab, entry.place);
        let reference = references.entry(entry.lab).or_insert_with(|| reference(entry.lab));
        for (key, printed, holds) in &entry.printed {
            let path = format!("{}.{key}", entry.place);
            let computed =
                values_at(reference, &path).unwrap_or_else(|| panic!("no {path} in {}", entry.lab));
            let computed = sorted(computed.iter().map(|value| number(value, entry.times)).collect(), key);
            let stated = sorted(printed.iter().map(|text| complex(text)).collect(), key);
            let met = computed.len() == stated.len()
                && computed
                    .iter()
                    .zip(&stated)
                    .all(|(x, p)| rounds_to(x.0, p.0, entry.figures) && rounds_to(x.1, p.1, entry.figures));
            if met != *holds {
                let texts = printed.join(" ");
                wrong.push(format!("{}: {path}: printed {texts}, computed {computed:?}", entry.page));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_printed_number_is_met_up_to_half_its_last_digit() {
    let check = |x: f64, text: &str, figures: Option<i32>, met: bool| {
        assert_eq!(rounds_to(x, real(text), figures), met, "{x} against {text} with {figures:?} figures");
    };
    check(5.56510758, "5.5651", None, true);
    check(5.56516, "5.5651", None, false);
    check(-59.22603848, "-59.2260", None, true);
    check(-59.22606, "-59.2260", None, false);
    check(-1454487.3, "-1.4545e6", None, true);
    check(-1454551.0, "-1.4545e6", None, false);
    check(2.299968e-6, "2.3e-06", Some(4), true);
    check(2.3006e-6, "2.3e-06", Some(4), false);
    check(2122.4, "2122", Some(4), true);
    check(1e-9, "0", None, false);
    check(0.0, "0", Some(4), true);
}

fn reference(id: &str) -> Reference {
    let (_, text) =
        lab::embedded().iter().find(|(known, _)| *known == id).unwrap_or_else(|| panic!("no lab {id}"));
    let lab =
        LabDefinition::parse(SourceText::new(id, *text)).unwrap_or_else(|e| panic!("{}", e.render(false)));
    Reference::compute(&lab).unwrap_or_else(|error| panic!("{id}: {error}"))
}

/// A number, and the place of its last digit: the power of ten.
type Printed = (f64, i32);

/// Whether `x` rounds to what is printed.
fn rounds_to(x: f64, (printed, last): Printed, figures: Option<i32>) -> bool {
    if printed == 0.0 {
        return x.abs() < 1e-12;
    }
    let last = figures.map_or(last, |figures| printed.abs().log10().floor() as i32 + 1 - figures);
    // The allowance is for the rounding of the half itself in binary.
    (x - printed).abs() <= 0.5 * 10f64.powi(last) * (1.0 + 1e-9)
}

fn real(text: &str) -> Printed {
    let value: f64 = text.parse().unwrap_or_else(|_| panic!("not a number: {text}"));
    let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    (value, exponent.parse::<i32>().unwrap() - decimals)
}

/// `-29.6+35.3j`, or a real number.
fn complex(text: &str) -> (Printed, Printed) {
    let Some(body) = text.strip_suffix('j') else { return (real(text), (0.0, 0)) };
    let mut signs = body.char_indices().filter(|(_, c)| matches!(c, '+' | '-'));
    let sign = signs.rfind(|(at, _)| *at > 0 && !body[..*at].ends_with(['e', 'E']));
    let (at, _) = sign.unwrap_or_else(|| panic!("not a complex number: {text}"));
    (real(&body[..at]), real(&body[at..]))
}

fn number(value: &ExpectedValue, times: f64) -> (f64, f64) {
    match value {
        ExpectedValue::Number(x) => (x * times, 0.0),
        ExpectedValue::Complex(re, im) => (re * times, im * times),
        ExpectedValue::Word(word) => panic!("a word: {word}"),
    }
}

/// A page lists poles and zeros in any order.
fn sorted<T: Copy + Place>(mut values: Vec<T>, key: &str) -> Vec<T> {
    if key.ends_with("poles") || key.ends_with("zeros") {
        values.sort_by(|a, b| {
            let ((a, b), (c, d)) = (a.place(), b.place());
            c.total_cmp(&a).then(d.total_cmp(&b))
        });
    }
    values
}

trait Place {
    fn place(&self) -> (f64, f64);
}

impl Place for (f64, f64) {
    fn place(&self) -> (f64, f64) {
        *self
    }
}

impl Place for (Printed, Printed) {
    fn place(&self) -> (f64, f64) {
        (self.0.0, self.1.0)
    }
}

fn table(text: &str) -> Vec<Entry<'_>> {
    let mut entries: Vec<Entry> = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(head) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            let (lab, place) = head.split_once(' ').unwrap_or_else(|| panic!("no place: {line}"));
            entries.push(Entry { lab, place, page: "", times: 1.0, figures: None, printed: Vec::new() });
            continue;
        }
        let entry = entries.last_mut().expect("a place comes first");
        match line.split_once(": ") {
            Some(("page", title)) => entry.page = title,
            Some(("times", factor)) => entry.times = factor.parse().unwrap(),
            Some(("figures", figures)) => entry.figures = Some(figures.parse().unwrap()),
            Some((key, values)) => {
                let (key, holds) = key.strip_prefix("not ").map_or((key, true), |key| (key, false));
                entry.printed.push((key, values.split(' ').collect(), holds));
            }
            None => panic!("{} {}: {line}", entry.lab, entry.place),
        }
    }
    entries
}
