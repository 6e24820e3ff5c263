use super::Estimates;
use super::slopes::{Slopes, Variant};
use crate::model::mistakes::edit::Edit;
use crate::model::mistakes::real::{Entry, RealFunction, determinant};
use crate::model::{Equilibrium, Exact};
use std::collections::BTreeMap;

/// Parameters and operating point in numbers, and the slopes of every summand with them.
pub(super) struct Setting {
    values: Vec<f64>,
    /// By equation and summand: the slope by column.
    summands: Vec<Vec<Vec<f64>>>,
}

/// A summand's slopes in place of its own.
pub(super) struct Exchanged<'a> {
    equation: usize,
    summand: usize,
    slopes: &'a [f64],
}

/// The slopes of what a mistake changes.
pub(super) type Changed = Vec<(usize, usize, Vec<f64>)>;

#[derive(Clone, Copy)]
pub(super) struct Ports {
    input: usize,
    output: usize,
}

impl Estimates {
    pub(super) fn setting(&self, choice: usize, mistakes: &[usize]) -> Setting {
        let edits: Vec<&Edit> = mistakes.iter().map(|place| &self.mistakes[*place].edit).collect();
        // Where nothing rests, no slope is a number.
        let (parameters, at) = self
            .derivation
            .place(&self.choices[choice], &edits)
            .unwrap_or_else(|_| (BTreeMap::new(), Equilibrium { values: BTreeMap::new() }));
        let value = |name: &String| {
            let known = parameters.get(name).or_else(|| at.values.get(name));
            known.map_or(f64::NAN, Exact::to_f64)
        };
        let values: Vec<f64> = self.symbols().iter().map(value).collect();
        let mut stack = Vec::new();
        let summands = self
            .equations
            .iter()
            .map(|terms| terms.iter().map(|term| self.run(&term.slopes, &values, &mut stack)).collect())
            .collect();
        Setting { values, summands }
    }

    pub(super) fn run(&self, slopes: &Slopes, values: &[f64], stack: &mut Vec<f64>) -> Vec<f64> {
        let mut row = vec![0.0; self.width()];
        for (column, program) in slopes {
            row[*column] = program.run(values, stack);
        }
        row
    }

    pub(super) fn changed(&self, setting: &Setting, variants: &[Variant]) -> Changed {
        let mut stack = Vec::new();
        variants
            .iter()
            .map(|variant| {
                (variant.equation, variant.summand, self.run(&variant.slopes, &setting.values, &mut stack))
            })
            .collect()
    }

    /// Input and output with the mistakes made.
    pub(super) fn ports(&self, mistakes: &[usize]) -> Ports {
        let of = &self.derivation;
        let (mut input, mut output) = (&of.input, &of.output);
        for place in mistakes {
            match &self.mistakes[*place].edit {
                Edit::Output(name) => output = name,
                Edit::Input(name) => input = name,
                _ => {}
            }
        }
        let place = |found: Option<usize>| found.unwrap_or(usize::MAX);
        Ports {
            input: place(of.model.inputs.iter().position(|name| name == input)),
            output: place(of.model.coordinates.iter().position(|c| c.name == *output)),
        }
    }

    /// Cramer's rule on the polynomial matrix.
    pub(super) fn function(
        &self,
        setting: &Setting,
        exchanged: &[Exchanged<'_>],
        ports: Ports,
    ) -> Option<RealFunction> {
        let n = self.columns.len();
        if ports.output >= n || ports.input >= self.derivation.model.inputs.len() {
            return None;
        }
        let width = self.width();
        let mut rows = vec![(0.0, 0.0); n * width];
        for (equation, terms) in setting.summands.iter().enumerate() {
            for (summand, own) in terms.iter().enumerate() {
                // The last one: both changes of a pair, where each has one of its own.
                let other =
                    exchanged.iter().rev().find(|one| (one.equation, one.summand) == (equation, summand));
                let slopes = other.map_or(own.as_slice(), |other| other.slopes);
                for (sum, slope) in rows[equation * width..].iter_mut().zip(slopes) {
                    sum.0 += slope;
                    sum.1 += slope.abs();
                }
            }
        }
        if rows.iter().any(|(value, _)| !value.is_finite()) {
            return None;
        }
        let entry = |row: usize, column: usize| {
            let begin = self.columns[column];
            let end = self.columns.get(column + 1).copied().unwrap_or(self.inputs_begin);
            let (mut value, mut size) = (Entry::default(), Entry::default());
            for (power, place) in (begin..end).enumerate() {
                (value[power], size[power]) = rows[row * width + place];
            }
            (value, size)
        };
        let replaced = |row: usize, column: usize| {
            if column == ports.output {
                let begin = row * width + self.input_begins(ports.input);
                let (mut value, mut size) = (Entry::default(), Entry::default());
                for (power, (slope, sum)) in rows[begin..begin + value.len()].iter().enumerate() {
                    (value[power], size[power]) = (-slope, *sum);
                }
                (value, size)
            } else {
                entry(row, column)
            }
        };
        let den = determinant(n, &entry);
        (!den.is_zero()).then(|| RealFunction { num: determinant(n, &replaced), den })
    }
}

pub(super) fn exchanged<'a>(all: &[&'a Changed]) -> Vec<Exchanged<'a>> {
    let one = |(equation, summand, slopes): &'a (usize, usize, Vec<f64>)| Exchanged {
        equation: *equation,
        summand: *summand,
        slopes,
    };
    all.iter().flat_map(|changed| changed.iter().map(one)).collect()
}
