//! The command that runs this program again.

use std::ffi::OsString;
use std::io;
use std::process::Command;
use std::sync::OnceLock;

/// Words of the command that runs this program, if it is not an executable file of its own.
static WITHIN: OnceLock<Vec<OsString>> = OnceLock::new();

/// Sets the words of the command that runs this program; they are set once.
pub(super) fn set(words: Vec<OsString>) {
    let _ = WITHIN.set(words);
}

/// Returns a command that runs this program.
pub(super) fn itself() -> io::Result<Command> {
    if let Some([program, arguments @ ..]) = WITHIN.get().map(Vec::as_slice) {
        let mut command = Command::new(program);
        command.args(arguments);
        return Ok(command);
    }
    Ok(Command::new(std::env::current_exe()?))
}
