//! Criterion → Evidence → Verdict → Scorecard. Knows no HTML, no file and no clock; points come from the lab.
//!
//! One file a kind of criterion. How each of them decides, with examples, is in `docs/marking.md`.

mod accepted;
mod closeness;
mod concepts;
mod cover;
mod grade;
mod hand_marks;
mod mark;
mod nonlinearity;
mod phrase;
mod plot;
mod poles;
mod prose;
mod scale;
mod scorecard;
mod shape;
mod stability;
mod transfer_function;
mod value;

pub use grade::grade;
pub use hand_marks::{HandMarks, HandMarksFile, Override};
pub use scorecard::*;
