use super::response::dc_gain;
use super::*;
use crate::algebra::{Rational, from_f64};
use crate::lab::{LabDefinition, ModelDefinition, OperatingPointDefinition, SimulationDefinition, SystemRef};
use crate::lti::{InputKind, ResponseError, RootError, roots, stability};
use crate::model::{
    Doubts, Exact, LetterDerivation, LettersError, ModelError, StaticFunction, Tangent, compare,
    compare_as_usual, linearize,
};
use crate::nonlinear::{ChainError, Run, simulate, without_nonlinearities};
use crate::source::Finding;
use std::collections::BTreeMap;

/// Why no reference could be computed: always the lab's fault, and always at a named place of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    #[error("`{point}`: {error}")]
    Model { point: String, error: Box<ModelError> },
    #[error("the response of `{point}`: {error}")]
    Response { point: String, error: ResponseError },
    #[error("poles or zeros of `{point}`: {error}")]
    Roots { point: String, error: RootError },
    #[error("simulation `{simulation}`: {error}")]
    Simulation { simulation: String, error: ChainError },
}

impl ReferenceError {
    /// The error at its place in the lab file, with what to do about it.
    pub fn finding(&self, lab: &LabDefinition) -> Finding {
        let points = || lab.models.iter().flat_map(|m| m.operating_points.iter().map(move |p| (m, p)));
        let place = match self {
            Self::Model { point, .. } | Self::Response { point, .. } | Self::Roots { point, .. } => {
                points().find(|(model, known)| name(model, known) == *point).map(|(_, known)| known.span)
            }
            Self::Simulation { .. } => None,
        };
        let help = match self {
            Self::Response { error: ResponseError::TooClose { .. }, .. } => {
                "choose values that put these poles farther apart, or exactly on top of one another"
            }
            Self::Response { error: ResponseError::OutOfRange, .. }
            | Self::Roots { error: RootError::OutOfRange, .. } => {
                "look for a power of ten too many in the values, or measure in other units"
            }
            Self::Response { error: ResponseError::Roots(_), .. } | Self::Roots { .. } => {
                "choose values with fewer digits, or a model of lower order"
            }
            Self::Response { .. } | Self::Model { .. } | Self::Simulation { .. } => "",
        };
        let finding = Finding::error("lab.reference", self.to_string());
        let finding = if help.is_empty() { finding } else { finding.with_help(help) };
        place.map_or_else(|| finding.clone(), |span| finding.clone().at(span))
    }
}

/// How much of a reference is worked out besides the numbers.
#[derive(Clone, Copy)]
enum Extent<'a> {
    /// Letters and comparisons.
    Whole,
    Numbers,
    /// What [`Reference::for_marking`] needs of this variant, beside the lab's own reference.
    Marking(&'a LabDefinition, &'a Reference),
}

impl<'a> Extent<'a> {
    fn letters(self, of: &SystemRef) -> bool {
        match self {
            Self::Whole => true,
            Self::Numbers => false,
            Self::Marking(lab, _) => lab.is_asked_in_letters(of),
        }
    }

    /// What is known of a point that no varied parameter enters.
    fn known(self, of: &SystemRef) -> Option<&'a OperatingPointReference> {
        match self {
            Self::Marking(lab, own) if !lab.is_varied(of) => own.operating_point(of),
            _ => None,
        }
    }
}

/// One choice of a value for every parameter.
struct ParameterChoice {
    values: BTreeMap<String, Rational>,
    /// (name, text as typed, value) of those that are not the lab's own.
    differs: Vec<(String, String, Rational)>,
}

impl Reference {
    /// Computes every right answer of `lab`.
    ///
    /// Errors: an operating point that is not an equilibrium, a response or a simulation that leaves the range of numbers.
    pub fn compute(lab: &LabDefinition) -> Result<Self, ReferenceError> {
        let models = model_references(lab, Extent::Whole)?;
        let simulations = lab.simulations.iter().map(simulation_reference).collect::<Result<_, _>>()?;
        Ok(Self { lab: lab.id.clone(), models, simulations })
    }

    /// The numbers alone: without letters, comparisons with the nonlinear equations, and simulations, which take most of the time.
    ///
    /// Errors: as [`Reference::compute`].
    pub fn numbers(lab: &LabDefinition) -> Result<Self, ReferenceError> {
        Ok(Self {
            lab: lab.id.clone(),
            models: model_references(lab, Extent::Numbers)?,
            simulations: Vec::new(),
        })
    }

    /// What marking and its reports need of a variant: comparisons and simulations that no varied parameter enters are those of
    /// `own`, which is the whole reference of the lab's own values, and letters are derived only where they are asked for.
    ///
    /// Errors: as [`Reference::compute`].
    pub fn for_marking(lab: &LabDefinition, own: &Self) -> Result<Self, ReferenceError> {
        let models = model_references(lab, Extent::Marking(lab, own))?;
        let simulations = lab.simulations.iter().map(|definition| {
            let known = own.simulation(&definition.id).filter(|_| !lab.is_simulation_varied(&definition.id));
            known.map_or_else(|| simulation_reference(definition), |known| Ok(known.clone()))
        });
        Ok(Self { lab: lab.id.clone(), models, simulations: simulations.collect::<Result<_, _>>()? })
    }

    /// The operating point `of` names, if there is one.
    pub fn operating_point(&self, of: &crate::lab::SystemRef) -> Option<&OperatingPointReference> {
        let model = self.models.iter().find(|m| m.id == of.model)?;
        model.operating_points.iter().find(|p| p.id == of.operating_point)
    }

    pub fn simulation(&self, id: &str) -> Option<&SimulationReference> {
        self.simulations.iter().find(|s| s.id == id)
    }
}

/// The lab's own parameter values first, then every combination with accepted alternatives.
fn parameter_choices(lab: &LabDefinition) -> Vec<ParameterChoice> {
    let own = lab.parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
    let mut choices = vec![ParameterChoice { values: own, differs: Vec::new() }];
    for parameter in &lab.parameters {
        let so_far = choices.len();
        for (text, value) in &parameter.accepted {
            for index in 0..so_far {
                let mut values = choices[index].values.clone();
                values.insert(parameter.name.clone(), value.clone());
                let mut differs = choices[index].differs.clone();
                differs.push((parameter.name.clone(), text.clone(), value.clone()));
                choices.push(ParameterChoice { values, differs });
            }
        }
    }
    choices
}

fn model_references(lab: &LabDefinition, extent: Extent<'_>) -> Result<Vec<ModelReference>, ReferenceError> {
    let choices = parameter_choices(lab);
    lab.models.iter().map(|model| model_reference(model, &choices, extent)).collect()
}

fn model_reference(
    definition: &ModelDefinition,
    choices: &[ParameterChoice],
    extent: Extent<'_>,
) -> Result<ModelReference, ReferenceError> {
    let operating_points = definition
        .operating_points
        .iter()
        .map(|point| operating_point_reference(definition, point, choices, extent))
        .collect::<Result<_, _>>()?;
    Ok(ModelReference { id: definition.id.clone(), title: definition.title.clone(), operating_points })
}

fn operating_point_reference(
    definition: &ModelDefinition,
    point: &OperatingPointDefinition,
    choices: &[ParameterChoice],
    extent: Extent<'_>,
) -> Result<OperatingPointReference, ReferenceError> {
    let accepted = choices
        .iter()
        .map(|choice| linear_reference(definition, point, choice))
        .collect::<Result<Vec<_>, _>>()?;
    let compared = |comparison| {
        compare(&definition.model, &choices[0].values, &point.at, &point.input, &point.output, comparison)
            .map_err(|error| model_error(definition, point, error))
    };
    let as_usual = || {
        let main = accepted.first()?;
        let (linearization, horizon_s) = (&main.linearization, main.impulse.as_ref()?.horizon_s);
        compare_as_usual(
            &definition.model,
            &choices[0].values,
            &point.at,
            &point.output,
            linearization,
            horizon_s,
        )
    };
    let of = SystemRef { model: definition.id.clone(), operating_point: point.id.clone() };
    let comparison = match (extent.known(&of), &point.comparison) {
        (Some(known), _) => known.comparison.clone(),
        _ if matches!(extent, Extent::Numbers) => None,
        (None, Some(comparison)) => Some(compared(comparison)?),
        (None, None) => as_usual(),
    };
    let derive = || {
        let (model, values) = (&definition.model, &choices[0].values);
        LetterDerivation::derive(model, values, &point.at, &point.input, &point.output)
    };
    Ok(OperatingPointReference {
        id: point.id.clone(),
        title: point.title.clone(),
        equilibrium: point.at.values.iter().map(|(name, value)| (name.clone(), value.to_f64())).collect(),
        equilibrium_text: point.at_text.clone(),
        input: point.input.clone(),
        input_unit: point.input_unit.clone(),
        output: point.output.clone(),
        output_unit: point.output_unit.clone(),
        tangent: tangent_reference(definition, point, &choices[0], &accepted[0])?,
        accepted,
        // Without letters nobody looks at why there are none.
        letters: if extent.letters(&of) { derive() } else { Err(LettersError::OverBudget) },
        comparison,
    })
}

fn linear_reference(
    definition: &ModelDefinition,
    point: &OperatingPointDefinition,
    choice: &ParameterChoice,
) -> Result<LinearReference, ReferenceError> {
    let in_model = |error| model_error(definition, point, error);
    let at = point.rest.at(&definition.model, &choice.values).map_err(in_model)?;
    let linearization =
        linearize(&definition.model, &choice.values, &at, &point.input, &point.output).map_err(in_model)?;
    let parameters = definition.model.derived.values(&choice.values).map_err(in_model)?;
    let nearest = |value: &Exact| match value.as_rational() {
        Some(value) => value.clone(),
        None => from_f64(value.to_f64()).unwrap_or(Rational::ZERO),
    };
    let root_error = |error| ReferenceError::Roots { point: name(definition, point), error };
    let response_error = |error| ReferenceError::Response { point: name(definition, point), error };
    let g = &linearization.transfer_function;
    // The determinant of the elimination: the characteristic polynomial of the whole state, up to a factor.
    let characteristic = linearization.uncancelled.den.monic();
    let response = |kind| match ResponseReference::of(g, kind) {
        Err(ResponseError::Improper { .. }) => Ok(None),
        other => other.map(Some).map_err(response_error),
    };
    Ok(LinearReference {
        differs: choice.differs.clone(),
        poles: roots(&g.den).map_err(root_error)?,
        zeros: if g.num.is_zero() { Vec::new() } else { roots(&g.num).map_err(root_error)? },
        stability: stability(&g.den),
        internal_poles: roots(&characteristic).map_err(root_error)?,
        internal_stability: stability(&characteristic),
        doubts: Doubts::of(
            &linearization,
            &definition.model,
            &parameters,
            &at,
            (&point.input, &point.output),
        ),
        impulse: response(InputKind::Impulse)?,
        step: response(InputKind::Step)?,
        values: parameters
            .iter()
            .chain(&at.values)
            .map(|(name, value)| (name.clone(), nearest(value)))
            .collect(),
        linearization,
    })
}

fn tangent_reference(
    definition: &ModelDefinition,
    point: &OperatingPointDefinition,
    choice: &ParameterChoice,
    linear: &LinearReference,
) -> Result<Option<Tangent>, ReferenceError> {
    let Some(rule) = &point.tangent else { return Ok(None) };
    let function =
        StaticFunction::new(&definition.model, &choice.values, &point.at, &point.input, &point.output)
            .map_err(|error| model_error(definition, point, error))?;
    let slope = dc_gain(&linear.linearization.transfer_function);
    Ok(function.zip(slope).map(|(function, slope)| Tangent::new(&function, slope, rule)))
}

fn simulation_reference(definition: &SimulationDefinition) -> Result<SimulationReference, ReferenceError> {
    let run = |chain: &crate::nonlinear::Chain| {
        simulate(chain, definition.duration_s)
            .map_err(|error| ReferenceError::Simulation { simulation: definition.id.clone(), error })
    };
    let with = run(&definition.chain)?;
    let without = run(&without_nonlinearities(&definition.chain))?;
    Ok(SimulationReference {
        id: definition.id.clone(),
        title: definition.title.clone(),
        samples: common_samples(&without, &with),
        with,
        without,
    })
}

/// Both outputs at the instants of either: twice where one of them jumps.
fn common_samples(without: &Run, with: &Run) -> Vec<(f64, f64, f64)> {
    let mut times: Vec<f64> = without.samples.iter().chain(&with.samples).map(|(t, _)| *t).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut jumps = [without.jumps(), with.jumps()].concat();
    jumps.sort_by(f64::total_cmp);
    let mut samples = Vec::with_capacity(times.len() + jumps.len());
    for t in times {
        if jumps.binary_search_by(|jump| jump.total_cmp(&t)).is_ok() {
            samples.push((t, without.just_before(t), with.just_before(t)));
        }
        samples.push((t, without.at(t), with.at(t)));
    }
    samples
}

fn model_error(
    definition: &ModelDefinition,
    point: &OperatingPointDefinition,
    error: ModelError,
) -> ReferenceError {
    ReferenceError::Model { point: name(definition, point), error: Box::new(error) }
}

/// `cart.hanging`
fn name(definition: &ModelDefinition, point: &OperatingPointDefinition) -> String {
    format!("{}.{}", definition.id, point.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab;

    #[test]
    fn a_refusal_stands_at_its_operating_point_and_says_what_to_do() {
        let lab = lab::load(lab::DEFAULT).unwrap();
        let error = ReferenceError::Response {
            point: "cart.upright".to_owned(),
            error: ResponseError::TooClose { first: "-1".to_owned(), second: "-1".to_owned() },
        };
        let told = error.finding(&lab).render(&lab.text, false);
        let line = lab
            .text
            .text
            .lines()
            .position(|line| line.trim() == "- id: upright")
            .or_else(|| lab.text.text.lines().position(|line| line.trim_start().starts_with("upright:")));
        let line = line.unwrap() + 1;
        for part in [
            "`cart.upright`",
            "lie so close together",
            "farther apart",
            &format!(":{line}:"),
            "lab.reference",
        ] {
            assert!(told.contains(part), "{part}: {told}");
        }
    }
}
