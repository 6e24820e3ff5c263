//! Whole runs: the program and the library over files as people hand them in.

mod again;
mod alike;
mod authoring;
mod bench;
mod by_hand;
mod careless;
mod claims;
mod class_marks;
mod cli;
mod conflicts;
mod ctms;
mod editions;
mod exports;
mod hard_polynomials;
mod hard_responses;
mod hard_table;
mod held_ball;
mod hostile_archives;
mod intake;
mod known;
mod laws;
mod ledger;
mod letters;
mod marking_examples;
mod numbers;
mod plots;
mod program;
mod readme;
mod schema;
mod student_edition;
mod switches;
mod teacher_marks;
mod variants;
mod verify;

/// Generated classes, as `cargo run --example generate_class` writes them.
#[path = "../../examples/generate_class/class.rs"]
mod class;
#[path = "../../examples/generate_class/forms.rs"]
mod forms;
