//! The command line: runs and studies, and what helps to write scenes and to look at results.
//!
//! Only this module prints. What was computed goes to standard output, progress and errors to standard error, and
//! the exit code says what kind of end it was ([`crate::ErrorKind::exit_code`]).

mod arguments;
mod commands;
mod completions;
mod example;
mod forecast;
mod interrupt;
mod new;
mod progress;
mod remaining;
mod report;
mod restart;
mod schema;
mod selftest;
mod study;
mod table;
mod view;

use crate::error::{Error, ErrorKind, Result};
use crate::output::number;
use arguments::Arguments;
use clap::Parser;
use serde_json::json;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Instant;

/// Runs the program with the arguments of the process and returns its exit code.
pub fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|panic| {
        let _ = writeln!(
            io::stderr(),
            "error: internal error, please report it with the scene that caused it: {panic}"
        );
        std::process::exit(i32::from(ErrorKind::Internal.exit_code()));
    }));
    // clap prints help, version and usage errors (exit code 2) itself.
    let arguments = Arguments::parse();
    let started = Instant::now();
    match commands::execute(&arguments, started) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let exit_code = error.kind().exit_code();
            let text = explain(&error);
            if arguments.command.progress_is_json() {
                let message = text.trim_start_matches("error: ").trim_end();
                let content = json!({ "message": message, "exit_code": exit_code });
                progress::json_line(started, "error", content);
            } else {
                let _ = io::stderr().write_all(text.as_bytes());
            }
            ExitCode::from(exit_code)
        }
    }
}

/// Whether a command line (the program's name first) is understood; the usage error, or what `--help` and `--version` print, if not.
/// Does nothing else.
///
/// # Errors
/// The text that the program would end with.
pub fn check_command_line(
    arguments: impl IntoIterator<Item = std::ffi::OsString>,
) -> std::result::Result<(), String> {
    Arguments::try_parse_from(arguments)
        .map(drop)
        .map_err(|problem| problem.to_string())
}

/// An error with its causes, as lines for a reader.
fn explain(error: &Error) -> String {
    let mut text = format!("error: {}\n", error.to_string().replace('\n', "\n       "));
    for cause in error.causes() {
        text.push_str(&format!("  caused by: {cause}\n"));
    }
    text
}

/// Writes to standard output. A reader that has seen enough (`| head`) is no error.
fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    let written = stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush());
    match written {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::new(ErrorKind::Io, "cannot write to standard output").because(cause))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_printed_with_its_causes_and_aligned_lines() {
        let cause = io::Error::other("disk full");
        let error = Error::new(ErrorKind::Io, "first\nsecond").because(cause);
        assert_eq!(
            explain(&error),
            "error: first\n       second\n  caused by: disk full\n"
        );
    }
}
