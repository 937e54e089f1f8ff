//! Exit code and message of the program if it ends with an error.

use super::interrupt;
use crate::error::{Error, ErrorKind};
use crate::text;

/// Returns the exit code of an error, and its message.
pub(super) fn ending(error: &Error) -> (u8, String) {
    let exit_code = match error.kind() {
        ErrorKind::Stopped => interrupt::exit_code(),
        kind => kind.exit_code(),
    };
    (exit_code, explain(error))
}

/// Formats an error with its causes, as lines for a reader.
fn explain(error: &Error) -> String {
    let mut text = format!("error: {}", error.to_string().replace('\n', "\n       "));
    let signal = interrupt::name().filter(|_| error.kind() == ErrorKind::Stopped);
    text.push_str(&signal.map_or("\n".to_string(), |signal| format!(" ({signal})\n")));
    for cause in error.causes() {
        text.push_str(&format!("  caused by: {cause}\n"));
    }
    text::shown(&text).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;

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
