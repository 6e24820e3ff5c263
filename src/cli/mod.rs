//! The command line: labs · new · handout · check · grade · marks · compare · export · verify · reference · schema. Alone prints, reads the
//! environment, ends the process.

mod check;
mod compare;
mod export;
mod format;
mod grade;
mod handout;
mod labs;
mod marks;
mod new;
mod outcome;
mod reference;
mod scaffold;
mod schema;
mod verify;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Mark control-systems lab reports from the equations up.
#[derive(Parser)]
#[command(name = "polemark", version, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    Labs(labs::Arguments),
    New(new::Arguments),
    Check(check::Arguments),
    Handout(handout::Arguments),
    Grade(grade::Arguments),
    Export(export::Arguments),
    Marks(marks::Arguments),
    Compare(compare::Arguments),
    Verify(verify::Arguments),
    Reference(reference::Arguments),
    Schema(schema::Arguments),
}

/// Runs the program on the process's own arguments.
///
/// Exit code: 0 nobody's fault (a poor mark included), 1 the lab's or submission's, 2 ours or the caller's.
pub fn main() -> ExitCode {
    let done = match Arguments::parse().verb {
        Verb::Labs(arguments) => labs::run(&arguments),
        Verb::New(arguments) => new::run(&arguments),
        Verb::Check(arguments) => check::run(&arguments),
        Verb::Handout(arguments) => handout::run(&arguments),
        Verb::Grade(arguments) => grade::run(&arguments),
        Verb::Export(arguments) => export::run(&arguments),
        Verb::Marks(arguments) => marks::run(&arguments),
        Verb::Compare(arguments) => compare::run(&arguments),
        Verb::Verify(arguments) => verify::run(&arguments),
        Verb::Reference(arguments) => reference::run(&arguments),
        Verb::Schema(arguments) => schema::run(&arguments),
    };
    match done {
        Ok(code) => code,
        // Whoever reads our output has seen enough (`polemark reference | head`).
        Err(failure) if failure.is_broken_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}
