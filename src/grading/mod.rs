//! Criterion → Evidence → Verdict → Scorecard. Knows no HTML and no clock.

mod scorecard;

pub use scorecard::*;
