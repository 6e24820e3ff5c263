use crate::algebra::Expression;
use crate::nonlinear::OdeError;

/// A generalized coordinate: `x` in m, say.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    pub name: String,
    pub unit: String,
    pub description: String,
}

/// One equation of motion, `left = right`, as printed.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    pub text: String,
    pub left: Expression,
    pub right: Expression,
}

/// Equations of motion in coordinates, inputs and parameters; as many equations as coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub coordinates: Vec<Coordinate>,
    pub inputs: Vec<String>,
    pub parameters: Vec<String>,
    pub equations: Vec<Equation>,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    #[error(
        "{equations} equations for {coordinates} coordinates: there must be as many of one as of the other"
    )]
    Count { equations: usize, coordinates: usize },
    #[error("equation {equation}: {message}")]
    Syntax { equation: usize, start: usize, end: usize, message: String, help: Option<String> },
    #[error("equation {equation} does not balance at this point: {left} on the left, {right} on the right")]
    NotAnEquilibrium { equation: usize, left: String, right: String },
    #[error("the highest derivatives cannot be solved for: their matrix is singular at this point")]
    Singular,
    #[error("coordinate `{coordinate}` is differentiated {primes} times: two is the most we take")]
    OrderTooHigh { coordinate: String, primes: u8 },
    #[error("`{name}` has no value")]
    NoValue { name: String },
    #[error("`{function}` is not defined at this point")]
    Undefined { function: String },
    #[error("equation {equation} is not linear in `{symbol}`, so it cannot be solved for the accelerations")]
    NotLinear { equation: usize, symbol: String },
    #[error("the equations cannot be followed after an impulse of {push}: {source}")]
    Simulation { push: f64, source: OdeError },
}
