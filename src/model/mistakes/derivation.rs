use super::edit::Edit;
use super::rewrite::rewrite;
use super::{Mistake, calls, degrees, factors, parameters, terms, whole};
use crate::algebra::Rational;
use crate::lti::TransferFunction;
use crate::model::linearization::about;
use crate::model::{Equilibrium, Model};
use std::collections::BTreeMap;

/// What a transfer function is derived from.
#[derive(Clone, Debug)]
pub struct Derivation {
    pub model: Model,
    pub parameters: BTreeMap<String, Rational>,
    /// Units by parameter: two of the same unit are taken for one another.
    pub units: BTreeMap<String, String>,
    /// Values of parameters that are often used wrongly, each as typed.
    pub mistaken: BTreeMap<String, Vec<(String, Rational)>>,
    pub at: Equilibrium,
    /// The other operating points that are asked about, each with its title.
    pub others: Vec<(String, Equilibrium)>,
    pub input: String,
    pub input_unit: String,
    pub output: String,
    pub output_unit: String,
}

impl Derivation {
    /// Every single mistake, in the order of the equations; the same mistakes for any values of the parameters.
    pub fn mistakes(&self) -> Vec<Mistake> {
        let mut all = terms::mistakes(self);
        all.extend(calls::mistakes(self));
        all.extend(factors::mistakes(self));
        all.extend(parameters::mistakes(self));
        all.extend(degrees::mistakes(self));
        all.extend(whole::mistakes(self));
        all
    }

    /// What comes out with `mistakes` made at once, nothing cancelled.
    ///
    /// `None` when it cannot be solved or never moves, or when the mistakes exclude one another. The equations need not
    /// balance at the point: with a mistake in them they may not.
    pub fn function(&self, mistakes: &[&Mistake]) -> Option<TransferFunction> {
        for (place, first) in mistakes.iter().enumerate() {
            if mistakes[place + 1..].iter().any(|second| !first.combines_with(second)) {
                return None;
            }
        }
        let mut changed = self.clone();
        let mut nodes = Vec::new();
        for mistake in mistakes {
            match &mistake.edit {
                Edit::Nodes(places, to) => nodes.extend(places.iter().map(|place| (*place, to))),
                Edit::Parameter(edit) => edit.apply(&mut changed.parameters),
                Edit::Point(other) => changed.at = self.others.get(*other)?.1.clone(),
                Edit::Rest(name, value) => {
                    changed.at.values.insert(name.clone(), value.clone());
                }
                Edit::Output(name) => changed.output.clone_from(name),
                Edit::Input(name) => changed.input.clone_from(name),
                Edit::Whole(_) => {}
            }
        }
        // What is inside is changed before what is around it.
        nodes.sort_by_key(|(place, _)| place.end - place.start);
        for (place, to) in nodes {
            let equation = changed.model.equations.get_mut(place.equation)?;
            let bytes = (place.start, place.end);
            equation.left = rewrite(&equation.left, bytes, &|node| to.of(node));
            equation.right = rewrite(&equation.right, bytes, &|node| to.of(node));
        }
        let mut function =
            about(&changed.model, &changed.parameters, &changed.at, &changed.input, &changed.output).ok()?;
        for mistake in mistakes {
            if let Edit::Whole(edit) = &mistake.edit {
                function = edit.apply(function)?;
            }
        }
        (!function.num.is_zero()).then_some(function)
    }
}
