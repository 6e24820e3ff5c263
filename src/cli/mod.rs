//! The command line: new · check · grade · verify · reference. Alone prints, reads the environment, ends the process.

use std::process::ExitCode;

/// Runs the program on the process's own arguments.
pub fn main() -> ExitCode {
    ExitCode::from(2)
}
