use super::Estimates;
use crate::algebra::{Expression, NodeKind};
use crate::model::AT_REST;
use crate::model::mistakes::Place;
use crate::model::mistakes::edit::{Edit, Replacement};
use crate::model::mistakes::rewrite::{negated, rewrite};
use crate::model::program::{Meaning, Program};

#[derive(Clone, Debug)]
pub(super) struct Summand {
    pub node: Expression,
    pub negative: bool,
    pub slopes: Slopes,
}

/// Partial derivatives that are not always 0, each with its column.
pub(super) type Slopes = Vec<(usize, Program)>;

/// A summand as a mistake makes it.
#[derive(Clone, Debug)]
pub(super) struct Variant {
    pub equation: usize,
    pub summand: usize,
    pub slopes: Slopes,
}

impl Estimates {
    /// Names that have a value, in the order of [`Setting::values`].
    pub(super) fn symbols(&self) -> Vec<String> {
        let model = &self.derivation.model;
        let coordinates = model.coordinates.iter().map(|coordinate| &coordinate.name);
        model.parameters.iter().chain(coordinates).chain(&model.inputs).cloned().collect()
    }

    /// The slopes of a summand by every coordinate, its derivatives, and every input.
    pub(super) fn slopes(&self, node: &Expression, negative: bool, symbols: &[String]) -> Slopes {
        let model = &self.derivation.model;
        let meaning = |name: &str, primes: u8| match primes {
            0 => {
                let name = name.strip_suffix(AT_REST).unwrap_or(name);
                symbols.iter().position(|known| known == name).map(Meaning::Slot)
            }
            // At rest nothing moves.
            _ => Some(Meaning::Constant(0.0)),
        };
        let orders = model.highest_derivatives();
        let moving = orders.iter().zip(&self.columns).flat_map(|((name, order), begin)| {
            (0..=*order).map(move |primes| (name.as_str(), primes, begin + usize::from(primes)))
        });
        let inputs = model.inputs.iter().enumerate().flat_map(|(place, name)| {
            let begin = self.input_begins(place);
            (0..=model.order_of(name)).map(move |primes| (name.as_str(), primes, begin + usize::from(primes)))
        });
        let mut found = Slopes::new();
        for (name, primes, column) in moving.chain(inputs) {
            let slope = node.differentiate(name, primes);
            if matches!(&slope.kind, NodeKind::Number(value) if value.is_zero()) {
                continue;
            }
            let slope = if negative { Expression { kind: negated(&slope), ..slope } } else { slope };
            found.extend(Program::with_zeros(&slope, &meaning).ok().map(|program| (column, program)));
        }
        found
    }

    /// Every summand that the mistakes change, with all of their changes in it.
    pub(super) fn variants_of(&self, mistakes: &[usize], symbols: &[String]) -> Vec<Variant> {
        let mut places: Vec<(Place, &Replacement)> = Vec::new();
        for place in mistakes {
            if let Edit::Nodes(nodes, to) = &self.mistakes[*place].edit {
                places.extend(nodes.iter().map(|node| (*node, to)));
            }
        }
        places.sort_by_key(|(place, _)| place.end - place.start);
        let mut found = Vec::new();
        for (equation, terms) in self.equations.iter().enumerate() {
            for (summand, term) in terms.iter().enumerate() {
                let whole = Place { equation, start: term.node.start, end: term.node.end };
                let inside: Vec<_> = places.iter().filter(|(place, _)| whole.holds(place)).collect();
                if inside.is_empty() {
                    continue;
                }
                let changed = inside.iter().fold(term.node.clone(), |node, (place, to)| {
                    rewrite(&node, (place.start, place.end), &|node| to.of(node))
                });
                let slopes = self.slopes(&changed, term.negative, symbols);
                found.push(Variant { equation, summand, slopes });
            }
        }
        found
    }

    /// The summands that both mistakes change.
    pub(super) fn shared_variants(&self, first: usize, second: usize, symbols: &[String]) -> Vec<Variant> {
        let touches = |mistake: usize, variant: &Variant| {
            self.variants[mistake]
                .iter()
                .any(|own| (own.equation, own.summand) == (variant.equation, variant.summand))
        };
        if !self.variants[first].iter().any(|variant| touches(second, variant)) {
            return Vec::new();
        }
        let mut both = self.variants_of(&[first, second], symbols);
        both.retain(|variant| touches(first, variant) && touches(second, variant));
        both
    }
}

/// The summands of a side, each with whether it is subtracted.
pub(super) fn summands<'a>(node: &'a Expression, negative: bool, found: &mut Vec<(&'a Expression, bool)>) {
    match &node.kind {
        NodeKind::Add(a, b) => {
            summands(a, negative, found);
            summands(b, negative, found);
        }
        NodeKind::Subtract(a, b) => {
            summands(a, negative, found);
            summands(b, !negative, found);
        }
        NodeKind::Negate(a) => summands(a, !negative, found),
        _ => found.push((node, negative)),
    }
}
