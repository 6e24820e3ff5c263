use super::chance::Places;
use super::likeness::{Form, Row, Typed};
use crate::model::{Estimates, Pair};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// What two mistakes at once lead to: every function that no single one leads to, by form.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    shelves: BTreeMap<Form, Shelf>,
    /// How many different functions.
    pub functions: usize,
}

/// Functions of one form, sorted by their last coefficient, then the one before it, and so on.
#[derive(Clone, Debug, Default)]
struct Shelf {
    /// Coefficients of a function.
    length: usize,
    /// One function after the other.
    values: Vec<f64>,
    /// By function: where its pairs begin; and the end of the last.
    begins: Vec<usize>,
    pairs: Vec<Pair>,
    /// By function: how likely its likeliest pair is.
    weights: Vec<u64>,
}

/// A function that agrees with what was typed.
#[derive(Debug)]
pub(super) struct Hit<'a> {
    pub misfit: f64,
    pub pairs: &'a [Pair],
    /// How likely the likeliest of them is.
    pub weight: u64,
}

impl Pairs {
    /// `simpler` are the keys of the functions that are right or that a single mistake leads to.
    /// `weigh` tells how likely a pair is.
    pub fn new(
        estimates: &Estimates,
        simpler: &BTreeSet<(Form, Vec<u64>)>,
        weigh: &dyn Fn(&Pair) -> u64,
    ) -> Self {
        let mut found: BTreeMap<Form, (Vec<f64>, Vec<Pair>)> = BTreeMap::new();
        estimates.pairs(&mut |pair, function| {
            let cancelled = function.cancelled();
            for one in [Some(function.without_shared_s()), cancelled].into_iter().flatten() {
                let Some(row) = Row::estimated(&one) else { continue };
                let (values, pairs) = found.entry(row.form).or_default();
                values.extend(&row.values);
                pairs.push(pair);
            }
        });
        let mut functions = 0;
        let shelves = found.into_iter().map(|(form, (values, pairs))| {
            let shelf = Shelf::new(form, &values, &pairs, simpler, weigh);
            functions += shelf.count();
            (form, shelf)
        });
        Self { shelves: shelves.collect(), functions }
    }

    /// Every function that agrees with `typed`.
    pub fn like(&self, typed: &Typed) -> Vec<Hit<'_>> {
        let Some(shelf) = self.shelves.get(&typed.form) else { return Vec::new() };
        let mut hits = Vec::new();
        let (low, high) = last_of(typed);
        for function in shelf.first_from(low)..shelf.count() {
            let values = shelf.values_of(function);
            if values.last().is_none_or(|last| *last > high) {
                break;
            }
            let row = Row { form: typed.form, values: values.to_vec() };
            if let Some(misfit) = typed.misfit(&row) {
                hits.push(Hit { misfit, pairs: shelf.pairs_of(function), weight: shelf.weights[function] });
            }
        }
        hits
    }

    /// How many functions that are at least so likely agree with `typed` wherever it is not left open.
    pub fn agreeing(&self, typed: &Typed, open: Places, weight: u64) -> usize {
        self.shelves.get(&typed.form).map_or(0, |shelf| {
            let agrees = |function: &usize| {
                let rest = typed.values.len() as u32 - open.count_ones();
                rest < 2 || typed.factors(shelf.values_of(*function), open).is_some()
            };
            (0..shelf.count()).filter(|function| shelf.weights[*function] >= weight).filter(agrees).count()
        })
    }
}

impl Shelf {
    fn new(
        form: Form,
        values: &[f64],
        pairs: &[Pair],
        simpler: &BTreeSet<(Form, Vec<u64>)>,
        weigh: &dyn Fn(&Pair) -> u64,
    ) -> Self {
        let length = values.len() / pairs.len().max(1);
        let row = |place: usize| &values[place * length..(place + 1) * length];
        let order = |a: &[f64], b: &[f64]| -> Ordering {
            let places = a.iter().rev().zip(b.iter().rev());
            places.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        };
        let mut places: Vec<usize> = (0..pairs.len()).collect();
        places.sort_by(|a, b| order(row(*a), row(*b)).then(pairs[*a].cmp(&pairs[*b])));
        let mut own = Self { length, ..Self::default() };
        let mut at = 0;
        while let Some(first) = places.get(at).copied() {
            let same = places[at..].iter().take_while(|place| row(**place) == row(first)).count();
            let key = (form, row(first).iter().map(|value| value.to_bits()).collect());
            if !simpler.contains(&key) {
                own.values.extend_from_slice(row(first));
                own.begins.push(own.pairs.len());
                let pairs = places[at..at + same].iter().map(|place| pairs[*place]);
                own.weights.push(pairs.clone().map(|pair| weigh(&pair)).max().unwrap_or(0));
                own.pairs.extend(pairs);
            }
            at += same;
        }
        own.begins.push(own.pairs.len());
        own
    }

    fn count(&self) -> usize {
        self.begins.len().saturating_sub(1)
    }

    fn values_of(&self, function: usize) -> &[f64] {
        &self.values[function * self.length..(function + 1) * self.length]
    }

    fn pairs_of(&self, function: usize) -> &[Pair] {
        &self.pairs[self.begins[function]..self.begins[function + 1]]
    }

    /// The first function whose last coefficient is not below `low`.
    fn first_from(&self, low: f64) -> usize {
        let (mut from, mut to) = (0, self.count());
        while from < to {
            let middle = (from + to) / 2;
            if self.values_of(middle).last().is_some_and(|last| *last < low) {
                from = middle + 1;
            } else {
                to = middle;
            }
        }
        from
    }
}

/// Between what the last coefficient may be, the first being 1.
fn last_of(typed: &Typed) -> (f64, f64) {
    // Wider than what is compared afterwards.
    const EDGE: f64 = 1e-8;
    let ends = |place: usize| {
        let (value, width) = (typed.values[place], typed.widths[place]);
        let width = width + EDGE * value.abs();
        [value - width, value + width]
    };
    if typed.values.len() < 2 {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let (first, last) = (ends(0), ends(typed.values.len() - 1));
    if first[0] <= 0.0 && first[1] >= 0.0 {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let ratios = last.iter().flat_map(|last| first.iter().map(move |first| last / first));
    ratios.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), ratio| (low.min(ratio), high.max(ratio)))
}
