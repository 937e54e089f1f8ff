//! The program `brinell`.

use std::process::ExitCode;

fn main() -> ExitCode {
    brinell::cli::main()
}
