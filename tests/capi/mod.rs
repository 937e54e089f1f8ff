//! The C interface from the outside: header, installation, programs in C, C++, Rust and Python.

mod demand;
mod header;
mod install;
mod python;

use crate::support::program::succeeded;
use std::process::{Command, Output};

/// Runs a program, which must succeed; it may build something, and take its time.
fn done(command: &mut Command) -> Output {
    let output = command.output();
    let output = output.unwrap_or_else(|e| panic!("{command:?}: {e}"));
    succeeded(command, &output);
    output
}
