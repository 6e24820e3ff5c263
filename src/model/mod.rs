//! Equations of motion → equilibrium → linearization, exact where the numbers are.

mod compare;
mod doubt;
mod equations;
mod equilibrium;
mod exact;
mod letters;
mod linear_form;
mod linearization;
mod mistakes;
mod motion;
mod outputs;
mod parameters;
mod program;
mod rest;
mod small_signal;
mod static_function;
mod tangent;

pub use compare::{Comparison, ComparisonRun, ComparisonSample, compare, compare_as_usual};
pub use doubt::Doubts;
pub use equations::{Coordinate, Equation, Model, ModelError};
pub use equilibrium::Equilibrium;
use equilibrium::{AT_REST, at_rest};
pub use exact::Exact;
pub use letters::{
    AtRest, LetterAgreement, LetterAtRest, LetterDerivation, LetterEquation, LetterPlace, LetterTerm,
    LettersError, Signal, is_light, known_at_rest, letters_at_rest, letters_used,
};
pub use linear_form::{LinearForm, Root};
pub use linearization::{Linearization, linearize};
pub use mistakes::{Derivation, Estimates, Mistake, MistakeKind, Pair, Place, RealFunction, RealPolynomial};
pub use parameters::{DerivedParameter, DerivedParameters, ParameterValues};
pub use rest::{Rest, RestValue};
pub use small_signal::{Departure, SmallSignal};
pub use static_function::StaticFunction;
pub use tangent::{Tangent, TangentRule};
