use super::accepted::{Accepted, accepted, transfer_function_of};
use super::likeness::Row;
use crate::algebra::{Rational, to_f64};
use crate::lab::{Check, LabDefinition, SystemRef};
use crate::lti::TransferFunction;
use crate::model::{Derivation, Equilibrium, Mistake, mistakes};
use crate::reference::Reference;
use std::collections::BTreeMap;

/// The likely mistakes in deriving each transfer function that a lab asks for, and what they lead to: made once a lab.
///
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
}

/// A transfer function that mistakes lead to; no two are equal, and none is right.
#[derive(Clone, Debug)]
pub(super) struct WrongFunction {
    /// With every common factor cancelled, or as the derivation gives it without a common power of s.
    pub rows: Vec<Row>,
    /// Equal explanations: each with the parameter values it was found with, as a place in `choices`.
    pub causes: Vec<(Mistake, usize)>,
}

impl Catalogue {
    /// Follows every single mistake, with each accepted set of parameter values, to its transfer function.
    pub fn new(lab: &LabDefinition, reference: &Reference) -> Self {
        let mut systems: Vec<System> = Vec::new();
        for criterion in lab.questions.iter().flat_map(|question| &question.criteria) {
            let Some(of) = transfer_function_of(criterion) else { continue };
            let tolerance = match &criterion.check {
                Check::Numerator { tolerance, .. } | Check::Denominator { tolerance, .. } => {
                    to_f64(&tolerance.relative)
                }
                _ => 0.0,
            };
            match systems.iter_mut().find(|system| system.of == *of) {
                Some(known) => known.tolerance = known.tolerance.max(tolerance),
                None => systems.extend(System::new(lab, reference, of, tolerance)),
            }
        }
        Self { systems }
    }
}

impl System {
    /// `None` when the lab or the reference does not know `of`.
    fn new(lab: &LabDefinition, reference: &Reference, of: &SystemRef, tolerance: f64) -> Option<Self> {
        let definition = lab.models.iter().find(|model| model.id == of.model)?;
        let point = definition.operating_points.iter().find(|point| point.id == of.operating_point)?;
        let right = accepted(reference, of, |one| &one.linearization.transfer_function);
        let units: BTreeMap<String, String> =
            lab.parameters.iter().map(|parameter| (parameter.name.clone(), parameter.unit.clone())).collect();
        let others: Vec<(String, &Equilibrium)> = definition
            .operating_points
            .iter()
            .filter(|other| other.id != point.id)
            .map(|other| (other.title.clone(), &other.at))
            .collect();
        // Found functions, comparable: cancelled, and the denominator monic.
        let mut known: Vec<TransferFunction> = Vec::new();
        let mut wrong: Vec<WrongFunction> = Vec::new();
        for (choice, one) in right.iter().enumerate() {
            let parameters = parameters(lab, one);
            let derivation = Derivation {
                model: &definition.model,
                parameters: &parameters,
                units: &units,
                at: &point.at,
                others: &others,
                input: &point.input,
                output: &point.output,
            };
            for (mistake, function) in mistakes(&derivation) {
                let cancelled = function.cancelled().0;
                if right.iter().any(|one| one.what.equals(&cancelled)) {
                    continue;
                }
                let comparable = cancelled.monic();
                match known.iter().position(|one| *one == comparable) {
                    Some(place) => {
                        let causes = &mut wrong[place].causes;
                        if !causes.iter().any(|(known, _)| *known == mistake) {
                            causes.push((mistake, choice));
                        }
                    }
                    None => {
                        known.push(comparable);
                        let mut rows = vec![Row::of(&cancelled), Row::of(&without_powers_of_s(&function))];
                        rows.dedup();
                        wrong.push(WrongFunction { rows, causes: vec![(mistake, choice)] });
                    }
                }
            }
        }
        let words = |one: &Accepted<'_, TransferFunction>| {
            one.differs.iter().map(|(name, text, _)| format!("{name} = {text}")).collect()
        };
        let choices = right.iter().map(|one| (words(one), Row::of(one.what))).collect();
        Some(Self { of: of.clone(), tolerance, choices, wrong })
    }
}

fn parameters(lab: &LabDefinition, one: &Accepted<'_, TransferFunction>) -> BTreeMap<String, Rational> {
    let own = lab.parameters.iter().map(|parameter| (parameter.name.clone(), parameter.value.clone()));
    own.chain(one.differs.iter().map(|(name, _, value)| (name.clone(), value.clone()))).collect()
}

/// Without the power of s that numerator and denominator share: one sees that it cancels, whatever else is left.
fn without_powers_of_s(function: &TransferFunction) -> TransferFunction {
    let shared = function.num.trailing_zeros().min(function.den.trailing_zeros());
    let short = |polynomial: &crate::algebra::Polynomial| {
        let coefficients = polynomial.coefficients();
        crate::algebra::Polynomial::new(coefficients[..coefficients.len() - shared].to_vec())
    };
    TransferFunction { num: short(&function.num), den: short(&function.den) }
}
