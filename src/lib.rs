//! polemark marks control-systems lab reports from the equations up.
//!
//! ```text
//!    names    english  memo  which known name a mistyped one is nearest to · lists and capitals in messages · what is kept
//!     │
//!   algebra                  exact rationals, polynomials, expressions
//!     │           source     text with places in it: spans, findings, a YAML tree
//!     │              ├ annotations   findings for other programs: JSON, JUnit, SARIF, GitHub
//!   lti   nonlinear  │       transfer functions, poles, responses · saturation, relay, backlash …
//!     └──┬──┘      prose     what English sentences say: phrases, denials, claims about a response
//!     model          │       equations → equilibrium → linearization
//!        │      submission   what was answered
//!       lab ─────────┘       what is asked
//!        │
//!    reference               what a right answer is, curves included
//!        │
//!     grading                Criterion → Evidence → Verdict → Scorecard
//!     report                 Scorecard → view → figure → svg → html
//!     proof                  a lab proves itself: stated values, second route, model answer, blank
//!     class                  many submissions: intake, in parallel, records, statistics, comparison
//!     gradebook              records → Canvas, Moodle, Gradescope, Excel; reports to hand back
//!     cli                    labs · new · handout · check · grade · marks · compare · export · verify · reference · schema
//! ```
//!
//! A module imports from modules above it, never from below.

mod english;
mod memo;
mod names;

pub mod algebra;
pub mod annotations;
pub mod lti;
pub mod model;
pub mod nonlinear;
pub mod prose;
pub mod source;
pub mod submission;

pub mod lab;
pub mod reference;

pub mod class;
pub mod cli;
pub mod gradebook;
pub mod grading;
pub mod proof;
pub mod report;
