//! The program `brinell`, and what programs print.

use super::limit;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// The program, without arguments. There is none where examples use this module.
pub fn program() -> Command {
    let path = option_env!("CARGO_BIN_EXE_brinell");
    Command::new(path.expect("a test or a benchmark"))
}

/// Runs a program, which must succeed.
#[track_caller]
pub fn succeeds(command: &mut Command) -> Output {
    let output = limit::output(command);
    succeeded(command, &output);
    output
}

/// Panics with all that a program printed unless it succeeded.
#[track_caller]
pub fn succeeded(command: &Command, output: &Output) {
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    assert!(output.status.success(), "{command:?}\n{out}{err}");
}

/// `summary.json` in a folder of results.
pub fn summary(dir: &Path) -> Value {
    let text = std::fs::read_to_string(dir.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Standard output, which is UTF-8.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Standard error.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
