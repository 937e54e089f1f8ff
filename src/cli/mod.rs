//! The command line: runs and studies, and commands that help to write scenes and to look at
//! results.
//!
//! Only this module prints. Results go to standard output, progress and errors to standard error,
//! and the exit code says how the program ended ([`crate::ErrorKind::exit_code`]).

#[cfg(all(unix, feature = "cholmod"))]
mod again;
mod arguments;
mod below;
mod ccx;
mod commands;
mod common_arguments;
mod completions;
mod compute;
mod convert;
mod deck;
mod ending;
mod example;
mod forecast;
mod fresh;
mod hardness;
mod hertz;
mod interrupt;
mod itself;
mod materials;
mod new;
mod progress;
mod ranks;
mod remaining;
mod report;
mod restart;
mod run_arguments;
mod runs;
mod schema;
mod selftest;
mod streams;
mod study;
mod sweep;
mod table;
mod threads;
mod values;
mod view;

use crate::error::{Error, ErrorKind, Result};
use crate::text;
use arguments::Arguments;
use clap::Parser;
use ending::ending;
use serde_json::json;
use std::borrow::Cow;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Runs the program with the arguments of the process and returns its exit code.
pub fn main() -> ExitCode {
    ExitCode::from(program(std::env::args_os().collect()))
}

/// Runs the program within another one, such as an interpreter. The words `itself` are a command
/// that starts the other program so that it runs this one. The arguments begin with the name of
/// the program; returns the exit code.
pub fn program_within(itself: Vec<OsString>, arguments: Vec<OsString>) -> u8 {
    itself::set(itself);
    program(arguments)
}

fn program(mut words: Vec<OsString>) -> u8 {
    // Under the name of CalculiX's program this program behaves like it.
    if words.first().is_some_and(|name| ccx::is_its_name(name)) {
        words.insert(1, "ccx".into());
    }
    std::panic::set_hook(Box::new(|panic| {
        let _ = writeln!(
            io::stderr(),
            "error: internal error, please report it with the scene that caused it: {panic}"
        );
        std::process::exit(i32::from(ErrorKind::Internal.exit_code()));
    }));
    interrupt::ignore_file_size_signal();
    #[cfg(all(unix, feature = "cholmod"))]
    again::start_with_better_settings();
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(problem) => return usage(&problem, &words),
    };
    let started = Instant::now();
    if let arguments::Command::Ccx(arguments) = &arguments.command {
        return ccx::run(arguments, started);
    }
    let ended = ranks::join(arguments.command.common()).and_then(|part| match part {
        ranks::ProcessRole::First(_ranks) => commands::execute(&arguments, started),
        ranks::ProcessRole::Helped => Ok(()),
    });
    match ended {
        Ok(()) => 0,
        Err(error) => {
            let (exit_code, text) = ending(&error);
            if arguments.command.progress_is_json() {
                let message = text.trim_start_matches("error: ").trim_end();
                let content = json!({ "message": message, "exit_code": exit_code });
                streams::json_line(started, "error", content);
            } else {
                let _ = io::stderr().write_all(text.as_bytes());
            }
            exit_code
        }
    }
}

/// Prints the output of clap: help and version, or a usage error (exit code 2), which repeats the
/// words that were typed.
fn usage(problem: &clap::Error, words: &[OsString]) -> u8 {
    let is_plain =
        |word: &OsString| matches!(text::shown(&word.to_string_lossy()), Cow::Borrowed(_));
    // The text is printed in the colours of the terminal, unless the typed words contain control
    // characters.
    let written = if words.iter().all(is_plain) {
        problem.print()
    } else {
        io::stderr().write_all(text::shown(&problem.to_string()).as_bytes())
    };
    // A reader that closes the pipe early is not an error.
    let _ = written;
    u8::try_from(problem.exit_code()).unwrap_or(1)
}

/// Checks whether a command line (the program's name first) is understood. Does nothing else.
///
/// # Errors
/// The usage error, or the text that `--help` and `--version` print: the text with which the
/// program would end.
pub fn check_command_line(
    arguments: impl IntoIterator<Item = OsString>,
) -> std::result::Result<(), String> {
    Arguments::try_parse_from(arguments)
        .map(drop)
        .map_err(|problem| problem.to_string())
}

/// Returns the scene that `brinell new` makes from a problem and its flags, as text; the scene is
/// also written if `--out` is among them.
///
/// # Errors
/// `Input` if the flags are not understood or their values are wrong; `Io` if the file exists
/// already.
pub fn new_scene(words: impl IntoIterator<Item = OsString>) -> Result<String> {
    #[derive(Parser)]
    #[command(name = "new", no_binary_name = true, disable_help_flag = true)]
    struct CommandLine {
        #[command(subcommand)]
        problem: new::ContactProblem,
        #[arg(long, global = true)]
        out: Option<PathBuf>,
    }
    let line = CommandLine::try_parse_from(words).map_err(|problem| {
        let text = problem.to_string();
        Error::input(text.trim_start_matches("error: ").trim_end())
    })?;
    new::start(&line.problem, line.out.as_deref()).map(|started| started.text)
}
