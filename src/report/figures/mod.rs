//! Which figures there are, and what is in them. Data only: nothing is drawn here.

mod distribution;
mod frame;
mod nonlinear;
mod pole_zero;
mod response;
mod simulation;
mod tangent;

pub use distribution::{Middle, distribution};
pub use nonlinear::{comparison_figure, parting_words};
pub use pole_zero::{StudentRoots, pole_zero, root_words};
pub use response::{OwnCurves, PreparedResponse, StudentCurves, feature_words, limit_words};
pub use simulation::{PreparedSimulation, characteristic_figure};
pub use tangent::tangent_figure;
