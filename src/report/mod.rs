//! Scorecard → view → figure → svg → html. Solves and awards nothing.

pub mod figure;
mod numbers;
pub mod svg;
