//! Output to standard output and to standard error.

use crate::error::{Error, ErrorKind, Result};
use crate::text::{self, shown_json};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::time::Instant;

/// Writes a warning to standard error; a failure to write it is ignored.
pub(super) fn warn(text: &str) {
    let _ = writeln!(io::stderr(), "warning: {}", text::shown(text));
}

/// Writes text to standard output, control characters escaped. A reader that closes the pipe early
/// (`| head`) is not an error.
pub(super) fn print(text: &str) -> Result<()> {
    let text = text::shown(text);
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

/// Returns a value as the text of a JSON object.
pub(super) fn json(value: &impl serde::Serialize) -> Result<String> {
    serde_json::to_string_pretty(value)
        .map(|text| shown_json(&text).into_owned() + "\n")
        .map_err(|cause| Error::internal("the summary is not plain data").because(cause))
}

/// Writes an event to standard error as a line of JSON.
pub(super) fn json_line(started: Instant, event: &str, content: Value) {
    let seconds = started.elapsed().as_secs_f64();
    let mut line = json!({ "event": event, "seconds": seconds });
    if let (Value::Object(line), Value::Object(content)) = (&mut line, content) {
        line.extend(content);
    }
    let _ = writeln!(io::stderr(), "{}", shown_json(&line.to_string()));
}
