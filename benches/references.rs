//! What it costs to prove a reference: common factors, poles with their bounds, the verdict of stability.
//!
//! ```text
//! cargo bench --bench references
//! ```

use divan::{Bencher, black_box};
use hard_table::Entry;
use polemark::algebra::Polynomial;
use polemark::lti::{TransferFunction, roots, stability};
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
