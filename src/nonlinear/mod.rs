//! Hard nonlinearities, signals, and block chains simulated with their switching instants located.

mod chain;
mod fixed_step;
#[cfg(test)]
mod levels_tests;
mod motion;
mod nonlinearity;
mod ode;
mod realization;
mod run;
mod signal;
mod simulate;
mod thinning;

pub use chain::{Block, Chain, ChainError, without_nonlinearities};
pub use fixed_step::simulate_fixed_step;
pub use nonlinearity::Nonlinearity;
pub use ode::{OdeError, Trajectory, integrate};
pub use run::Run;
pub use signal::Signal;
pub use simulate::simulate;
pub(crate) use thinning::Thinning;
