//! Figures as lean SVG: plotters lays them out, our own backend writes them.
//!
//! The picture carries no colours, fonts or widths: every element has a class (`ink`, `grid`, `reference`, `student` …) and the
//! page's style sheet decides, so that dark mode and paper work without drawing twice.

mod backend;
mod clip;
mod draw;
mod simplify;
mod text_width;

pub use draw::render;
