use super::accepted::{Accepted, accepted, coefficient_tolerance};
use super::likeness::{Form, Row};
use super::pairs::Pairs;
use crate::algebra::{Polynomial, Rational, to_f64};
use crate::lab::{LabDefinition, SystemRef};
use crate::lti::TransferFunction;
use crate::model::{Derivation, Estimates, Mistake, RealFunction};
use crate::reference::Reference;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// The likely mistakes in deriving each transfer function that a lab asks for, and what they lead to: made once a lab.
///
/// Single mistakes are followed at once, pairs of them when the first answer needs them.
/// The empty one (`Catalogue::default()`) explains nothing.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    pub(super) systems: Vec<System>,
}

/// One transfer function that is asked for.
#[derive(Clone, Debug)]
pub(super) struct System {
    pub of: SystemRef,
    /// The widest relative tolerance of a coefficient.
    pub tolerance: f64,
    /// Accepted sets of parameter values as `g = 9.8`, the lab's own (no words) first; what is right with each.
    pub choices: Vec<(Vec<String>, Row)>,
    pub wrong: Vec<WrongFunction>,
    /// How likely each mistake is.
    pub weights: Vec<u32>,
    /// How likely a slip of a digit, exchanged digits and coarse rounding are.
    pub afterwards: BTreeMap<&'static str, u32>,
    estimates: Estimates,
    pairs: OnceLock<Pairs>,
}

/// A transfer function that mistakes lead to; no two are equal, and none is right.
#[derive(Clone, Debug)]
pub(super) struct WrongFunction {
    /// With every common factor cancelled, or as the derivation gives it without a common power of s.
    pub rows: Vec<Row>,
    /// Equal explanations: each with the parameter values it was found with, as a place in `choices`.
    pub causes: Vec<(usize, usize)>,
}

impl Catalogue {
    /// Follows every single mistake, with each accepted set of parameter values, to its transfer function.
    pub fn new(lab: &LabDefinition, reference: &Reference) -> Self {
        let mut systems: Vec<System> = Vec::new();
        for criterion in lab.questions.iter().flat_map(|question| &question.criteria) {
            let Some(of) = criterion.check.transfer_function() else { continue };
            if !systems.iter().any(|known| known.of == *of) {
                systems.extend(System::new(lab, reference, of));
            }
        }
        Self { systems }
    }

    /// How many different wrong functions single mistakes lead to, by estimate.
    pub fn wrong_functions(&self) -> usize {
        self.systems.iter().map(|system| system.wrong.len()).sum()
    }

    /// (system, change) of mistakes that lead to a right function or to none, by estimate.
    pub fn without_effect(&self) -> BTreeSet<(String, String)> {
        let silent = self.systems.iter().flat_map(|system| {
            let causes = system.wrong.iter().flat_map(|wrong| &wrong.causes);
            let told: BTreeSet<usize> = causes.map(|(mistake, _)| *mistake).collect();
            let all = system.estimates.mistakes().iter().enumerate();
            let silent = all.filter(move |(place, _)| !told.contains(place));
            silent.map(|(_, mistake)| (system.of.to_string(), mistake.change.clone()))
        });
        silent.collect()
    }

    /// The transfer functions of `of` that the mistakes with these changes lead to.
    pub(super) fn led_to_by(&self, of: &SystemRef, changes: &[&str]) -> Vec<TransferFunction> {
        let system = self.systems.iter().find(|system| system.of == *of);
        system.map_or_else(Vec::new, |system| system.led_to_by(changes))
    }

    /// Follows the pairs of mistakes too, which otherwise the first answer does that no single mistake explains; how many
    /// different functions they lead to.
    pub fn follow_pairs(&self) -> usize {
        self.systems.iter().map(|system| system.pairs().functions).sum()
    }
}

impl System {
    /// `None` when the lab or the reference does not know `of`.
    fn new(lab: &LabDefinition, reference: &Reference, of: &SystemRef) -> Option<Self> {
        let definition = lab.models.iter().find(|model| model.id == of.model)?;
        let point = definition.operating_points.iter().find(|point| point.id == of.operating_point)?;
        let derivation = definition.derivation(point, &lab.parameters);
        let right = accepted(reference, of, |one| &one.linearization.transfer_function);
        let words = |one: &Accepted<'_, TransferFunction>| -> Vec<String> {
            one.differs.iter().map(|(name, text, _)| format!("{name} = {text}")).collect()
        };
        let choices: Option<Vec<_>> =
            right.iter().map(|one| Some((words(one), Row::of(one.what)?))).collect();
        let sets = right.iter().map(|one| parameters(&derivation, one)).collect();
        let mistakes: Vec<Mistake> = derivation
            .mistakes()
            .into_iter()
            .filter(|mistake| lab.mistakes.weight(mistake.kind.code()) > 0)
            .collect();
        let weights = mistakes.iter().map(|mistake| lab.mistakes.weight(mistake.kind.code())).collect();
        let estimates = Estimates::new(derivation, mistakes, sets);
        let mut own = Self {
            of: of.clone(),
            tolerance: to_f64(&coefficient_tolerance(lab, of)),
            choices: choices?,
            wrong: Vec::new(),
            weights,
            afterwards: ["slip.digit", "slip.exchanged", "rounding.coarse"]
                .map(|code| (code, lab.mistakes.weight(code)))
                .into(),
            estimates,
            pairs: OnceLock::new(),
        };
        own.wrong = own.singles();
        Some(own)
    }

    pub fn mistake(&self, place: usize) -> Option<&Mistake> {
        self.estimates.mistakes().get(place)
    }

    /// Whether two mistakes can lead to a function of such degrees.
    pub fn may_be_two(&self, typed: &TransferFunction) -> bool {
        typed.num.degree().max(typed.den.degree()) <= self.estimates.highest_degree()
    }

    pub fn pairs(&self) -> &Pairs {
        self.pairs.get_or_init(|| {
            let known = self.wrong.iter().flat_map(|wrong| &wrong.rows);
            let simpler: BTreeSet<_> =
                known.chain(self.choices.iter().map(|(_, row)| row)).map(Row::key).collect();
            let weight = |mistake: usize| self.weights.get(mistake).copied().map_or(0, u64::from);
            Pairs::new(&self.estimates, &simpler, &|pair| weight(pair.first) * weight(pair.second))
        })
    }

    /// What the mistakes with these changes lead to, with each accepted set of parameter values; of the changes, those that
    /// are mistakes in the derivation count. None when there are none.
    pub fn led_to_by(&self, changes: &[&str]) -> Vec<TransferFunction> {
        let known = self.estimates.mistakes().iter();
        let made: Vec<&Mistake> = known.filter(|one| changes.contains(&one.change.as_str())).collect();
        if made.is_empty() {
            return Vec::new();
        }
        let sets = self.estimates.choices().iter();
        let functions = sets.filter_map(|parameters| {
            let derivation =
                Derivation { parameters: parameters.clone(), ..self.estimates.derivation().clone() };
            derivation.function(&made)
        });
        functions.map(|function| function.cancelled().0).collect()
    }

    /// What these mistakes lead to with that choice of parameter values, exactly.
    pub fn exactly(&self, mistakes: &[usize], choice: usize) -> Vec<Row> {
        let all: Option<Vec<&Mistake>> = mistakes.iter().map(|place| self.mistake(*place)).collect();
        let (Some(all), Some(parameters)) = (all, self.estimates.choices().get(choice)) else {
            return Vec::new();
        };
        let derivation = Derivation { parameters: parameters.clone(), ..self.estimates.derivation().clone() };
        let Some(function) = derivation.function(&all) else { return Vec::new() };
        let both = [Row::of(&function.cancelled().0), Row::of(&without_powers_of_s(&function))];
        both.into_iter().flatten().collect()
    }

    fn singles(&self) -> Vec<WrongFunction> {
        let right: BTreeSet<_> = self.choices.iter().map(|(_, row)| row.key()).collect();
        let mut places: BTreeMap<(Form, Vec<u64>), usize> = BTreeMap::new();
        let mut wrong: Vec<WrongFunction> = Vec::new();
        self.estimates.singles(&mut |mistake, choice, function| {
            let rows = rows(&function);
            let Some(first) = rows.first() else { return };
            let key = first.key();
            if right.contains(&key) {
                return;
            }
            match places.get(&key) {
                Some(place) => {
                    let causes = &mut wrong[*place].causes;
                    if !causes.iter().any(|(known, _)| *known == mistake) {
                        causes.push((mistake, choice));
                    }
                }
                None => {
                    places.insert(key, wrong.len());
                    wrong.push(WrongFunction { rows, causes: vec![(mistake, choice)] });
                }
            }
        });
        wrong
    }
}

/// With every common factor cancelled first, then without a common power of s where that is something else.
fn rows(function: &RealFunction) -> Vec<Row> {
    let both = [function.cancelled(), Some(function.without_shared_s())];
    both.into_iter().flatten().filter_map(|one| Row::estimated(&one)).collect()
}

fn parameters(derivation: &Derivation, one: &Accepted<'_, TransferFunction>) -> BTreeMap<String, Rational> {
    let own = derivation.parameters.iter().map(|(name, value)| (name.clone(), value.clone()));
    own.chain(one.differs.iter().map(|(name, _, value)| (name.clone(), value.clone()))).collect()
}

/// Without the power of s that numerator and denominator share: one sees that it cancels, whatever else is left.
fn without_powers_of_s(function: &TransferFunction) -> TransferFunction {
    let shared = function.num.trailing_zeros().min(function.den.trailing_zeros());
    let short = |polynomial: &Polynomial| {
        let coefficients = polynomial.coefficients();
        Polynomial::new(coefficients[..coefficients.len() - shared].to_vec())
    };
    TransferFunction { num: short(&function.num), den: short(&function.den) }
}
