use super::edit::{Edit, Replacement, WholeEdit};
use super::real::{Entry, MOST_COORDINATES, RealFunction, RealPolynomial, determinant};
use super::rewrite::rewrite;
use super::{Derivation, Mistake, Place};
use crate::algebra::{Expression, NodeKind, Rational, to_f64};
use crate::model::program::{Meaning, Program};
use std::collections::BTreeMap;

/// The transfer functions that mistakes lead to, one or two at once, in `f64`: fast enough for all pairs of a lab.
///
/// Each equation is a sum of terms, and a term's slopes are differentiated once; a mistake in a term exchanges that term's
/// slopes. Accuracy: about 1e-12 of each coefficient; what vanishes is exactly 0. For an exact answer follow the mistakes with
/// [`Derivation::function`].
#[derive(Clone, Debug)]
pub struct Estimates {
    derivation: Derivation,
    mistakes: Vec<Mistake>,
    /// Sets of parameter values.
    choices: Vec<BTreeMap<String, Rational>>,
    /// By equation: the summands of left − right.
    equations: Vec<Vec<Summand>>,
    /// By mistake: the summands it changes.
    variants: Vec<Vec<Variant>>,
    /// By coordinate: where the columns of its derivatives begin.
    columns: Vec<usize>,
    /// The columns of the inputs begin here.
    inputs_begin: usize,
    /// Few enough coordinates, and every slope at the point is a number.
    usable: bool,
}

/// Two mistakes made at once, by their places in the list, the first before the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    pub first: usize,
    pub second: usize,
    /// Which set of parameter values.
    pub choice: usize,
}

#[derive(Clone, Debug)]
struct Summand {
    node: Expression,
    negative: bool,
    slopes: Slopes,
}

/// Partial derivatives that are not always 0, each with its column.
type Slopes = Vec<(usize, Program)>;

/// A summand as a mistake makes it.
#[derive(Clone, Debug)]
struct Variant {
    equation: usize,
    summand: usize,
    slopes: Slopes,
}

/// Parameters and operating point in numbers, and the slopes of every summand with them.
struct Setting {
    values: Vec<f64>,
    /// By equation and summand: the slope by column.
    summands: Vec<Vec<Vec<f64>>>,
}

/// A summand's slopes in place of its own.
struct Exchanged<'a> {
    equation: usize,
    summand: usize,
    slopes: &'a [f64],
}

/// The slopes of what a mistake changes.
type Changed = Vec<(usize, usize, Vec<f64>)>;

#[derive(Clone, Copy)]
struct Ports {
    input: usize,
    output: usize,
}

impl Estimates {
    /// `mistakes` are those of `derivation`; `choices` are sets of parameter values to follow them with.
    pub fn new(
        derivation: Derivation,
        mistakes: Vec<Mistake>,
        choices: Vec<BTreeMap<String, Rational>>,
    ) -> Self {
        let mut columns = Vec::new();
        let mut next = 0;
        for (_, order) in derivation.model.highest_derivatives() {
            columns.push(next);
            next += usize::from(order) + 1;
        }
        let mut own = Self {
            derivation,
            mistakes,
            choices,
            equations: Vec::new(),
            variants: Vec::new(),
            columns,
            inputs_begin: next,
            usable: true,
        };
        if !(1..=MOST_COORDINATES).contains(&own.columns.len()) || own.choices.is_empty() {
            own.usable = false;
            return own;
        }
        let symbols = own.symbols();
        own.equations = own
            .derivation
            .model
            .equations
            .iter()
            .map(|equation| {
                let mut found = Vec::new();
                summands(&equation.left, false, &mut found);
                summands(&equation.right, true, &mut found);
                let ready = |(node, negative): (&Expression, bool)| Summand {
                    slopes: own.slopes(node, negative, &symbols),
                    node: node.clone(),
                    negative,
                };
                found.into_iter().map(ready).collect()
            })
            .collect();
        own.variants = (0..own.mistakes.len()).map(|place| own.variants_of(&[place], &symbols)).collect();
        own.usable = own.function(&own.setting(0, &[]), &[], own.ports(&[])).is_some();
        own
    }

    pub fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    pub fn derivation(&self) -> &Derivation {
        &self.derivation
    }

    pub fn choices(&self) -> &[BTreeMap<String, Rational>] {
        &self.choices
    }

    /// Visits what each mistake leads to with each choice of parameter values; what cannot be solved is left out.
    pub fn singles(&self, visit: &mut dyn FnMut(usize, usize, RealFunction)) {
        for choice in 0..self.choices.len() {
            let base = self.usable.then(|| self.setting(choice, &[]));
            for place in 0..self.mistakes.len() {
                let function = match &base {
                    Some(base) => self.single(base, choice, place),
                    None => None,
                };
                if let Some(function) = function.or_else(|| self.exactly(choice, place)) {
                    visit(place, choice, function);
                }
            }
        }
    }

    /// Visits what each two mistakes lead to that can be made at once, with each choice of parameter values.
    ///
    /// Nothing for a model of more than eight coordinates.
    pub fn pairs(&self, visit: &mut dyn FnMut(Pair, RealFunction)) {
        if !self.usable {
            return;
        }
        let symbols = self.symbols();
        let of = |wanted: fn(&Edit) -> bool| -> Vec<usize> {
            (0..self.mistakes.len()).filter(|place| wanted(&self.mistakes[*place].edit)).collect()
        };
        let nodes = of(|edit| matches!(edit, Edit::Nodes(..)));
        let settings = of(|edit| matches!(edit, Edit::Parameter(_) | Edit::Point(_) | Edit::Rest(..)));
        let ports = of(|edit| matches!(edit, Edit::Output(_) | Edit::Input(_)));
        let wholes = of(|edit| matches!(edit, Edit::Whole(_)));
        let fits = |a: usize, b: usize| self.mistakes[a].combines_with(&self.mistakes[b]);
        let pairs_of = |first: &[usize], second: &[usize]| -> Vec<(usize, usize)> {
            let all = first.iter().flat_map(|a| second.iter().map(move |b| (*a.min(b), *a.max(b))));
            let mut all: Vec<_> = all.filter(|(a, b)| a < b && fits(*a, *b)).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let node_pairs: Vec<(usize, usize, Vec<Variant>)> = pairs_of(&nodes, &nodes)
            .into_iter()
            .map(|(a, b)| (a, b, self.shared_variants(a, b, &symbols)))
            .collect();
        let setting_pairs = pairs_of(&settings, &settings);
        let own = self.ports(&[]);
        for choice in 0..self.choices.len() {
            let mut give = |first: usize, second: usize, function: Option<RealFunction>| {
                let (first, second) = (first.min(second), first.max(second));
                if let Some(function) = function.filter(|function| !function.num.is_zero()) {
                    visit(Pair { first, second, choice }, function);
                }
            };
            for around in std::iter::once(None).chain(settings.iter().copied().map(Some)) {
                let setting = self.setting(choice, around.as_slice());
                let changed: Vec<(usize, Changed)> =
                    nodes.iter().map(|node| (*node, self.changed(&setting, &self.variants[*node]))).collect();
                let with = |changed: &Changed, ports| self.function(&setting, &exchanged(&[changed]), ports);
                let nothing = Changed::new();
                match around {
                    Some(around) => {
                        for (node, changed) in changed.iter().filter(|(node, _)| fits(around, *node)) {
                            give(around, *node, with(changed, own));
                        }
                        for port in ports.iter().copied().filter(|port| fits(around, *port)) {
                            give(around, port, with(&nothing, self.ports(&[port])));
                        }
                        let base = with(&nothing, own);
                        for whole in wholes.iter().copied().filter(|whole| fits(around, *whole)) {
                            give(around, whole, base.and_then(|base| self.done(base, &[whole])));
                        }
                    }
                    None => {
                        let by_node: BTreeMap<usize, &Changed> =
                            changed.iter().map(|(node, changed)| (*node, changed)).collect();
                        for (a, b, shared) in &node_pairs {
                            let (Some(first), Some(second)) = (by_node.get(a), by_node.get(b)) else {
                                continue;
                            };
                            let both = self.changed(&setting, shared);
                            let function = self.function(&setting, &exchanged(&[first, second, &both]), own);
                            give(*a, *b, function);
                        }
                        for (node, changed) in &changed {
                            let base = with(changed, own);
                            for whole in wholes.iter().copied().filter(|whole| fits(*node, *whole)) {
                                give(*node, whole, base.and_then(|base| self.done(base, &[whole])));
                            }
                            for port in ports.iter().copied().filter(|port| fits(*node, *port)) {
                                give(*node, port, with(changed, self.ports(&[port])));
                            }
                        }
                        for (a, b) in pairs_of(&ports, &ports) {
                            give(a, b, with(&nothing, self.ports(&[a, b])));
                        }
                        for (port, whole) in pairs_of(&ports, &wholes) {
                            let (port, whole) =
                                if ports.contains(&port) { (port, whole) } else { (whole, port) };
                            let base = with(&nothing, self.ports(&[port]));
                            give(port, whole, base.and_then(|base| self.done(base, &[whole])));
                        }
                        let base = with(&nothing, own);
                        for (a, b) in pairs_of(&wholes, &wholes) {
                            give(a, b, base.and_then(|base| self.done(base, &[a, b])));
                        }
                    }
                }
            }
            for (a, b) in &setting_pairs {
                let setting = self.setting(choice, &[*a, *b]);
                give(*a, *b, self.function(&setting, &[], own));
            }
        }
    }

    fn exactly(&self, choice: usize, place: usize) -> Option<RealFunction> {
        let mistake = &self.mistakes[place];
        if self.usable && !matches!(mistake.edit, Edit::Whole(WholeEdit::SharedLeft { .. })) {
            return None;
        }
        let derivation = Derivation { parameters: self.choices[choice].clone(), ..self.derivation.clone() };
        let function = derivation.function(&[mistake])?;
        Some(RealFunction {
            num: RealPolynomial::from_exact(&function.num)?,
            den: RealPolynomial::from_exact(&function.den)?,
        })
    }

    fn single(&self, base: &Setting, choice: usize, place: usize) -> Option<RealFunction> {
        let around;
        let setting = match &self.mistakes[place].edit {
            Edit::Parameter(_) | Edit::Point(_) | Edit::Rest(..) => {
                around = self.setting(choice, &[place]);
                &around
            }
            _ => base,
        };
        let changed = self.changed(setting, &self.variants[place]);
        let function = self.function(setting, &exchanged(&[&changed]), self.ports(&[place]))?;
        self.done(function, &[place]).filter(|function| !function.num.is_zero())
    }

    // ------------------------------------------------------------------------------------------ what is made once

    /// Names that have a value, in the order of [`Setting::values`].
    fn symbols(&self) -> Vec<String> {
        let model = &self.derivation.model;
        let coordinates = model.coordinates.iter().map(|coordinate| &coordinate.name);
        model.parameters.iter().chain(coordinates).chain(&model.inputs).cloned().collect()
    }

    /// The slopes of a summand by every coordinate, its derivatives, and every input.
    fn slopes(&self, node: &Expression, negative: bool, symbols: &[String]) -> Slopes {
        let model = &self.derivation.model;
        let meaning = |name: &str, primes: u8| match primes {
            0 => symbols.iter().position(|known| known == name).map(Meaning::Slot),
            // At rest nothing moves.
            _ => Some(Meaning::Constant(0.0)),
        };
        let orders = model.highest_derivatives();
        let moving = orders.iter().zip(&self.columns).flat_map(|((name, order), begin)| {
            (0..=*order).map(move |primes| (name.as_str(), primes, begin + usize::from(primes)))
        });
        let inputs = model
            .inputs
            .iter()
            .enumerate()
            .map(|(place, name)| (name.as_str(), 0, self.inputs_begin + place));
        let mut found = Slopes::new();
        for (name, primes, column) in moving.chain(inputs) {
            let slope = node.differentiate(name, primes);
            if matches!(&slope.kind, NodeKind::Number(value) if value.is_zero()) {
                continue;
            }
            let slope =
                if negative { Expression { kind: super::rewrite::negated(&slope), ..slope } } else { slope };
            found.extend(Program::with_zeros(&slope, &meaning).ok().map(|program| (column, program)));
        }
        found
    }

    /// Every summand that the mistakes change, with all of their changes in it.
    fn variants_of(&self, mistakes: &[usize], symbols: &[String]) -> Vec<Variant> {
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
    fn shared_variants(&self, first: usize, second: usize, symbols: &[String]) -> Vec<Variant> {
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

    // ------------------------------------------------------------------------------------------ numbers

    fn setting(&self, choice: usize, mistakes: &[usize]) -> Setting {
        let mut parameters = self.choices[choice].clone();
        let mut at = self.derivation.at.clone();
        for place in mistakes {
            match &self.mistakes[*place].edit {
                Edit::Parameter(edit) => edit.apply(&mut parameters),
                Edit::Point(other) => {
                    if let Some((_, other)) = self.derivation.others.get(*other) {
                        at = other.clone();
                    }
                }
                Edit::Rest(name, value) => {
                    at.values.insert(name.clone(), value.clone());
                }
                _ => {}
            }
        }
        let value = |name: &String| {
            let rest = || at.values.get(name).map(crate::model::Exact::to_f64);
            parameters.get(name).map(to_f64).or_else(rest).unwrap_or(f64::NAN)
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

    fn run(&self, slopes: &Slopes, values: &[f64], stack: &mut Vec<f64>) -> Vec<f64> {
        let mut row = vec![0.0; self.inputs_begin + self.derivation.model.inputs.len()];
        for (column, program) in slopes {
            row[*column] = program.run(values, stack);
        }
        row
    }

    fn changed(&self, setting: &Setting, variants: &[Variant]) -> Changed {
        let mut stack = Vec::new();
        variants
            .iter()
            .map(|variant| {
                (variant.equation, variant.summand, self.run(&variant.slopes, &setting.values, &mut stack))
            })
            .collect()
    }

    /// Input and output with the mistakes made.
    fn ports(&self, mistakes: &[usize]) -> Ports {
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
    fn function(&self, setting: &Setting, exchanged: &[Exchanged<'_>], ports: Ports) -> Option<RealFunction> {
        let n = self.columns.len();
        if ports.output >= n || ports.input >= self.derivation.model.inputs.len() {
            return None;
        }
        let width = self.inputs_begin + self.derivation.model.inputs.len();
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
                let (value, size) = rows[row * width + self.inputs_begin + ports.input];
                ([-value, 0.0, 0.0], [size, 0.0, 0.0])
            } else {
                entry(row, column)
            }
        };
        let den = determinant(n, &entry);
        (!den.is_zero()).then(|| RealFunction { num: determinant(n, &replaced), den })
    }

    /// What is done to the function that is there.
    fn done(&self, function: RealFunction, mistakes: &[usize]) -> Option<RealFunction> {
        let mut result = function;
        for place in mistakes {
            let RealFunction { num, den } = result;
            result = match &self.mistakes[*place].edit {
                Edit::Whole(WholeEdit::Negated) => RealFunction { num: num.negated(), den },
                Edit::Whole(WholeEdit::Inverted) => RealFunction { num: den, den: num },
                Edit::Whole(WholeEdit::TimesS) => RealFunction { num: num.times_s()?, den },
                Edit::Whole(WholeEdit::OverS) => RealFunction { num, den: den.times_s()? },
                Edit::Whole(WholeEdit::Scaled(factor)) => {
                    RealFunction { num: num.scaled(to_f64(factor)), den }
                }
                Edit::Whole(WholeEdit::Truncated) => {
                    let short = result.cancelled().unwrap_or_else(|| result.without_shared_s());
                    if short.num.trailing_zeros() + short.den.trailing_zeros() == 0 {
                        return None;
                    }
                    RealFunction { num: short.num.shortened(1), den: short.den.shortened(1) }
                }
                Edit::Whole(WholeEdit::SharedLeft { .. }) => return None,
                _ => result,
            };
            if result.den.is_zero() {
                return None;
            }
        }
        Some(result)
    }
}

fn exchanged<'a>(all: &[&'a Changed]) -> Vec<Exchanged<'a>> {
    let one = |(equation, summand, slopes): &'a (usize, usize, Vec<f64>)| Exchanged {
        equation: *equation,
        summand: *summand,
        slopes,
    };
    all.iter().flat_map(|changed| changed.iter().map(one)).collect()
}

/// The summands of a side, each with whether it is subtracted.
fn summands<'a>(node: &'a Expression, negative: bool, found: &mut Vec<(&'a Expression, bool)>) {
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
