//! Linear time-invariant systems: transfer functions, state space, poles, responses.

mod dyadic;
mod features;
mod poles;
mod response;
mod simple_roots;
mod stability;
mod state_space;
mod transfer_function;
mod wide;

pub use features::{Extremum, Features, Limit, Shape};
pub use poles::{Pole, RootError, roots};
pub use response::{InputKind, Response, ResponseError};
pub use stability::{Stability, right_half_plane_roots, stability};
pub use state_space::StateSpace;
pub use transfer_function::TransferFunction;
