use super::ResponseReference;
use crate::algebra::Rational;
use crate::lti::{InputKind, Pole, Stability};
use crate::model::{ComparisonRun, Doubts, LetterDerivation, LettersError, Linearization, Tangent};
use crate::nonlinear::Run;
use std::collections::BTreeMap;

/// Every right answer of a lab.
#[derive(Clone, Debug)]
pub struct Reference {
    pub lab: String,
    pub models: Vec<ModelReference>,
    pub simulations: Vec<SimulationReference>,
}

#[derive(Clone, Debug)]
pub struct ModelReference {
    pub id: String,
    pub title: String,
    pub operating_points: Vec<OperatingPointReference>,
}

#[derive(Clone, Debug)]
pub struct OperatingPointReference {
    pub id: String,
    pub title: String,
    /// (name, value), plant units.
    pub equilibrium: Vec<(String, f64)>,
    /// (name, as typed in the lab).
    pub equilibrium_text: Vec<(String, String)>,
    pub input: String,
    pub input_unit: String,
    pub output: String,
    pub output_unit: String,
    /// `[0]` follows the lab's own parameter values; the rest, accepted alternatives.
    pub accepted: Vec<LinearReference>,
    /// The transfer function in the lab's own letters, step by step; or why there is none.
    pub letters: Result<LetterDerivation, LettersError>,
    /// The linear model beside the nonlinear equations; `None` where they are not compared.
    pub comparison: Option<ComparisonRun>,
    /// A static function beside its tangent; `None` of what moves.
    pub tangent: Option<Tangent>,
}

impl OperatingPointReference {
    /// What follows from the lab's own parameter values.
    pub fn main(&self) -> &LinearReference {
        &self.accepted[0]
    }
}

/// Everything linear about an operating point, for one set of parameter values.
#[derive(Clone, Debug)]
pub struct LinearReference {
    /// Parameters that differ from the lab's own: `[("g", "9.8", 49/5)]`; empty for the lab's own.
    pub differs: Vec<(String, String, Rational)>,
    pub linearization: Linearization,
    pub poles: Vec<Pole>,
    pub zeros: Vec<Pole>,
    /// Of the transfer function.
    pub stability: Stability,
    /// Eigenvalues of the whole state.
    pub internal_poles: Vec<Pole>,
    pub internal_stability: Stability,
    /// What of this the rounding of coefficients leaves open.
    pub doubts: Doubts,
    /// `None` of an improper transfer function, which has no ordinary responses.
    pub impulse: Option<ResponseReference>,
    /// Parameters, and coordinates and inputs at rest, by name; an irrational one is its nearest `f64`.
    pub values: BTreeMap<String, Rational>,
    pub step: Option<ResponseReference>,
}

impl LinearReference {
    /// `None` of an improper transfer function.
    pub fn response(&self, kind: InputKind) -> Option<&ResponseReference> {
        match kind {
            InputKind::Impulse => self.impulse.as_ref(),
            InputKind::Step => self.step.as_ref(),
        }
    }
}

/// A chain with its nonlinearities and with them taken out.
#[derive(Clone, Debug)]
pub struct SimulationReference {
    pub id: String,
    pub title: String,
    pub with: Run,
    pub without: Run,
    /// (t, without, with) on common instants.
    pub samples: Vec<(f64, f64, f64)>,
}
