//! What a reference costs: of each lab on the shelf, and of polynomials and responses that are hard, one of each family.
//!
//! ```text
//! cargo bench --bench references
//! ```

use divan::{Bencher, black_box};
use hard_table::Entry;
use polemark::algebra::Polynomial;
use polemark::lab;
use polemark::lti::{Features, InputKind, Response, TransferFunction, roots, stability};
use polemark::reference::Reference;
use std::sync::LazyLock;

#[path = "../tests/it/hard_table.rs"]
#[allow(dead_code, reason = "the truth in the table is for the tests")]
mod hard_table;

fn main() {
    divan::main();
}

static TABLE: LazyLock<Vec<Entry>> = LazyLock::new(hard_table::table);

/// One of each class, the costliest.
const CLASSES: [&str; 16] = [
    "hanging pendulum on a cart",
    "(s + 1)^10",
    "(s + 1)^50",
    "Wilkinson 20",
    "Wilkinson 50",
    "Chebyshev T50",
    "Bessel filter of order 50",
    "random of degree 20, coefficients within 1000000",
    "random of degree 50, coefficients within 1000000000",
    "roots -1e-12 to -1e12, every power",
    "degree 50, coefficients 1e-12 to 1e12 at random",
    "a double pair at sqrt 2 and a decay",
    "pairs 1e-15 left, on the axis and right",
    "ten roots 1e-12 apart",
    "Mignotte 50, a = 1e12",
    "nothing is, one unit beside it",
];

/// One of each family in `hard_responses.txt`.
const RESPONSES: [&str; 14] = [
    "a pair 1e-30 apart",
    "two real poles 2e-9 apart",
    "ten poles 1e-12 apart",
    "(s + 1)^10 exactly",
    "(s + 1)^50",
    "Wilkinson 20",
    "Wilkinson 50",
    "thirty tanks in a row",
    "poles -1e-6 to -1e6, every power",
    "stiff, with a cluster at the fast end",
    "a double pair on the axis and a decay",
    "a zero 1e-10 beside a pole on the right",
    "a cluster on the right",
    "two hardly damped pairs 1e-10 apart",
];

/// What drives it, and its function.
fn driven(name: &str) -> (InputKind, TransferFunction) {
    let head = format!("[{name}]");
    let table = include_str!("../tests/it/hard_responses.txt").lines();
    let entry: Vec<&str> = table.skip_while(|line| *line != head).skip(1).take(8).collect();
    let key =
        |key: &str| entry.iter().find_map(|line| line.strip_prefix(key)).expect("it stands in the table");
    let [num, den] = ["num: ", "den: "].map(|part| hard_table::multiplied_out(key(part)));
    let kind = if key("kind: ") == "step" { InputKind::Step } else { InputKind::Impulse };
    (kind, TransferFunction::new(num, den).expect("no denominator is zero"))
}

fn shelf() -> impl Iterator<Item = &'static str> {
    lab::embedded().iter().map(|(id, _)| *id)
}

/// Every operating point, with letters, responses, comparison with the nonlinear equations, and simulations.
#[divan::bench(args = shelf(), sample_count = 10)]
fn whole_lab(bencher: Bencher<'_, '_>, id: &str) {
    let lab = lab::load(id).expect("a lab on the shelf parses");
    bencher.bench(|| Reference::compute(black_box(&lab)));
}

/// Without letters, comparison and simulations: what each student's own values cost.
#[divan::bench(args = shelf(), sample_count = 10)]
fn numbers_of_a_lab(bencher: Bencher<'_, '_>, id: &str) {
    let lab = lab::load(id).expect("a lab on the shelf parses");
    bencher.bench(|| Reference::numbers(black_box(&lab)));
}

/// A response and what is read off it.
#[divan::bench(args = RESPONSES, sample_count = 5)]
fn respond(bencher: Bencher<'_, '_>, name: &str) {
    let (kind, g) = driven(name);
    bencher.bench(|| Response::new(black_box(&g), kind).map(|response| Features::of(&response)));
}

fn function(name: &str) -> TransferFunction {
    let entry = TABLE.iter().find(|entry| entry.name == name).expect("it stands in the table");
    let num = entry.num.clone().unwrap_or_else(Polynomial::one);
    TransferFunction::new(num, entry.p.clone()).expect("no denominator is zero")
}

#[divan::bench(args = CLASSES, sample_count = 10)]
fn prove(bencher: Bencher<'_, '_>, name: &str) {
    let g = function(name);
    bencher.bench(|| {
        let (g, shared) = black_box(&g).cancelled();
        (g.poles(), stability(&g.den), shared)
    });
}

#[divan::bench(args = CLASSES, sample_count = 10)]
fn find_roots(bencher: Bencher<'_, '_>, name: &str) {
    let g = function(name);
    bencher.bench(|| roots(black_box(&g.den)));
}

#[divan::bench(args = CLASSES, sample_count = 10)]
fn decide_stability(bencher: Bencher<'_, '_>, name: &str) {
    let g = function(name);
    bencher.bench(|| stability(black_box(&g.den)));
}

/// All of the table, one after another.
#[divan::bench(sample_count = 3)]
fn the_whole_table(bencher: Bencher<'_, '_>) {
    LazyLock::force(&TABLE);
    bencher.bench(|| {
        for entry in TABLE.iter() {
            let _ = black_box((roots(&entry.p), stability(&entry.p)));
        }
    });
}
