//! Hard nonlinearities, signals, and block chains simulated with their switching instants located.

mod chain;
mod nonlinearity;
mod ode;
mod signal;

pub use chain::{Block, Chain, ChainError, Run, simulate};
pub use nonlinearity::Nonlinearity;
pub use ode::{OdeError, Trajectory, integrate};
pub use signal::Signal;
