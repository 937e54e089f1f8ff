//! `brinell runs`: carries out the runs that a sweep requests on standard input.

use super::arguments::{Arguments, Command};
use super::compute;
use super::ending::ending;
use super::sweep::Ended;
use crate::error::{Error, Result};
use crate::output;
use crate::substructure::sharing_factors;
use clap::Parser;
use std::io::{BufRead, Write};
use std::time::Instant;

/// Carries out the requested runs until the input ends.
///
/// # Errors
/// `Analysis` if an answer cannot be written.
pub(super) fn serve() -> Result<()> {
    let failed = |cause| Error::analysis("cannot answer the sweep").because(cause);
    sharing_factors(|| {
        for line in std::io::stdin().lock().lines() {
            let Ok(line) = line else { break };
            let ended = serde_json::to_string(&answer(&line))
                .map_err(|cause| Error::internal("an answer is not plain data").because(cause))?;
            let mut out = std::io::stdout().lock();
            writeln!(out, "{ended}")
                .and_then(|()| out.flush())
                .map_err(failed)?;
        }
        Ok(())
    })
}

/// Runs a point, and returns how the run ended.
fn answer(line: &str) -> Ended {
    let of = |error: &Error| {
        let (exit_code, text) = ending(error);
        let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
        let message = lines.collect::<Vec<_>>().join(" ");
        Ended {
            exit_code: Some(i32::from(exit_code)),
            message: message.trim_start_matches("error: ").to_string(),
        }
    };
    let understood = || Error::internal("the sweep asks for what is no run");
    let words: Result<Vec<String>> =
        serde_json::from_str(line).map_err(|cause| understood().because(cause));
    let run = words.and_then(|words| {
        let arguments = Arguments::try_parse_from(words);
        match arguments.map(|arguments| arguments.command) {
            Ok(Command::Run(program)) => {
                let (_, results) = compute::run(&program, Instant::now())?;
                output::ending(&results)
            }
            Ok(_) => Err(understood()),
            Err(cause) => Err(understood().because(cause)),
        }
    });
    match run {
        Ok(()) => Ended {
            exit_code: Some(0),
            message: String::new(),
        },
        Err(error) => of(&error),
    }
}
