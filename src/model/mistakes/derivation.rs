use super::edit::Edit;
use super::rewrite::rewrite;
use super::{Mistake, calls, degrees, factors, parameters, slopes, terms, whole};
use crate::algebra::Rational;
use crate::lti::TransferFunction;
use crate::model::linearization::about;
use crate::model::{Equation, Equilibrium, Model, ModelError, ParameterValues, Rest};
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
    pub rest: Rest,
    /// The other operating points that are asked about, each with its title.
    pub others: Vec<(String, Rest)>,
    pub input: String,
    pub input_unit: String,
    pub output: String,
    pub output_unit: String,
}

impl Derivation {
    /// Every single mistake, in the order of the equations; the same mistakes for any values of the parameters.
    pub fn mistakes(&self) -> Vec<Mistake> {
        let mut all = Vec::new();
        // In equations that nobody has printed nobody can have gone wrong.
        if self.model.is_printed() {
            all.extend(terms::mistakes(self));
            all.extend(calls::mistakes(self));
            all.extend(factors::mistakes(self));
            all.extend(slopes::mistakes(self));
        }
        all.extend(parameters::mistakes(self));
        all.extend(degrees::mistakes(self));
        all.extend(whole::mistakes(self));
        all
    }

    /// The equations that the transfer function is derived from, each with its place: all but those of other outputs.
    pub(super) fn equations(&self) -> impl Iterator<Item = (usize, &Equation)> {
        let all = self.model.equations.iter().enumerate();
        all.filter(|(index, _)| self.model.output_of(*index).is_none_or(|output| output == self.output))
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
        let edits: Vec<&Edit> = mistakes.iter().map(|mistake| &mistake.edit).collect();
        let (parameters, at) = self.place(&self.parameters, &edits).ok()?;
        let mut changed = self.clone();
        let mut nodes = Vec::new();
        for mistake in mistakes {
            match &mistake.edit {
                Edit::Nodes(places, to) => nodes.extend(places.iter().map(|place| (*place, to))),
                Edit::Parameter(_) | Edit::Point(_) | Edit::Rest(..) => {}
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
        let mut function = about(&changed.model, &parameters, &at, &changed.input, &changed.output).ok()?;
        for mistake in mistakes {
            if let Edit::Whole(edit) = &mistake.edit {
                function = edit.apply(function)?;
            }
        }
        (!function.num.is_zero()).then_some(function)
    }

    /// Where it is linearized with the lab's own values; `None` where nothing rests there.
    pub fn at(&self) -> Option<Equilibrium> {
        self.rest.at(&self.model, &self.parameters).ok()
    }

    /// The values of all parameters and the operating point, with what `edits` change of them, from the `given` values.
    ///
    /// What follows from a value follows from the mistaken one: derived parameters, and the place of rest by the right
    /// equations. A derived parameter that is mistaken itself follows from nothing.
    pub(super) fn place(
        &self,
        given: &BTreeMap<String, Rational>,
        edits: &[&Edit],
    ) -> Result<(ParameterValues, Equilibrium), ModelError> {
        let derived = &self.model.derived;
        let names: Vec<&String> = edits
            .iter()
            .filter_map(|edit| match edit {
                Edit::Parameter(edit) => Some(edit.names()),
                _ => None,
            })
            .flatten()
            .collect();
        let mut parameters = if names.iter().any(|name| derived.contains(name)) {
            // Their values before the mistake, which is then made.
            let before = derived.values(given)?;
            let own = |name: &&String| Some(((*name).clone(), before.get(*name)?.to_rational().0));
            given.clone().into_iter().chain(names.iter().filter_map(own)).collect()
        } else {
            given.clone()
        };
        let mut rest = &self.rest;
        for edit in edits {
            match edit {
                Edit::Parameter(edit) => edit.apply(&mut parameters),
                Edit::Point(other) => rest = self.others.get(*other).map_or(rest, |(_, other)| other),
                _ => {}
            }
        }
        let parameters = derived.without(&names).values(&parameters)?;
        let mut at = rest.with(&self.model, &parameters)?;
        for edit in edits {
            if let Edit::Rest(name, value) = edit {
                at.values.insert(name.clone(), value.clone());
            }
        }
        Ok((parameters, at))
    }
}
