//! Error type of the crate: a kind, a message with entities and numbers, and the cause.

use crate::text::short;
use std::error::Error as StdError;
use std::fmt;

/// Result type of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Kind of an error, which decides the exit code of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The scene, the mesh or the command line is wrong. Exit code 2.
    Input,
    /// A file could not be read or written. Exit code 3.
    Io,
    /// The input is well-formed but asks for an effect that brinell does not have. Exit code 2.
    Unsupported,
    /// The model is not held: a body can move freely. Exit code 4.
    Unheld,
    /// The analysis failed: a solve did not converge, a target was not reached, or the memory did
    /// not suffice. Exit code 5.
    Analysis,
    /// The load passed the limit load; the message names the load held previously. Exit code 6.
    Collapse,
    /// The run ended, but a state's quality misses its tolerance, a contact presses although a load
    /// has opened it far, displacements are not small although the deck asks for large ones, or a
    /// demanded accuracy was not reached; or a family of the selftest failed. Exit code 7.
    Inaccurate,
    /// Contact reached the end of its surfaces although the bodies continue beyond it; earlier
    /// results are right. Exit code 8.
    Outgrown,
    /// The caller or the user stopped the run. Exit code 130; the program itself returns 128 plus
    /// the number of the signal.
    Stopped,
    /// A fault of brinell itself. Exit code 70.
    Internal,
}

impl ErrorKind {
    /// Exit code of the command-line program for this kind of error.
    pub fn exit_code(self) -> u8 {
        match self {
            ErrorKind::Input | ErrorKind::Unsupported => 2,
            ErrorKind::Io => 3,
            ErrorKind::Unheld => 4,
            ErrorKind::Analysis => 5,
            ErrorKind::Collapse => 6,
            ErrorKind::Inaccurate => 7,
            ErrorKind::Outgrown => 8,
            ErrorKind::Internal => 70,
            ErrorKind::Stopped => 130,
        }
    }
}

/// Error with its kind, a message that names the entities concerned, and its cause.
#[derive(Debug)]
pub struct Error {
    kind: ErrorKind,
    message: String,
    cause: Option<Box<dyn StdError + Send + Sync>>,
}

impl Error {
    /// Makes an error of `kind`; `message` names the entity, the value and what to do.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Error {
            kind,
            message: short(&message.into()).into_owned(),
            cause: None,
        }
    }

    /// Makes an error of bad input ([`ErrorKind::Input`]).
    pub fn input(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Input, message)
    }

    /// Makes an error of a failed analysis ([`ErrorKind::Analysis`]).
    pub fn analysis(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Analysis, message)
    }

    /// Makes an error of a fault in brinell itself ([`ErrorKind::Internal`]).
    pub fn internal(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Internal, message)
    }

    /// Makes an error of a file operation ([`ErrorKind::Io`]) on `path`, with the system's error as
    /// cause.
    pub fn io(what: &str, path: &std::path::Path, cause: std::io::Error) -> Self {
        Self::new(ErrorKind::Io, format!("cannot {what} {}", path.display())).because(cause)
    }

    /// Adds the cause of this error.
    pub fn because(mut self, cause: impl StdError + Send + Sync + 'static) -> Self {
        self.cause = Some(Box::new(cause));
        self
    }

    /// Puts `context` (a file, a scene key, a phase) in front of the message.
    pub fn within(mut self, context: impl fmt::Display) -> Self {
        self.message = format!("{context}: {}", self.message);
        self
    }

    /// Rewords the message of the error.
    pub(crate) fn reworded(mut self, words: impl Fn(&str) -> String) -> Self {
        self.message = words(&self.message);
        self
    }

    /// Kind of the error.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// Message of the error without its causes.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Causes of the error: its own cause, the cause of that, and so on.
    pub fn causes(&self) -> impl Iterator<Item = &(dyn StdError + 'static)> {
        std::iter::successors(self.source(), |&cause| cause.source())
    }

    /// Message followed by all causes, in one line.
    pub(crate) fn in_full(&self) -> String {
        self.causes().fold(self.message.clone(), |text, cause| {
            format!("{text}: {cause}")
        })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl StdError for Error {
    fn source(&self) -> Option<&(dyn StdError + 'static)> {
        self.cause.as_deref().map(|c| c as _)
    }
}

#[cfg(test)]
mod tests {
    use super::ErrorKind::{self, *};

    /// Scripts and callers of the C library rely on the exit codes, so they never change.
    #[test]
    fn every_kind_has_the_code_of_the_contract() {
        let codes: [(ErrorKind, u8); 10] = [
            (Input, 2),
            (Unsupported, 2),
            (Io, 3),
            (Unheld, 4),
            (Analysis, 5),
            (Collapse, 6),
            (Inaccurate, 7),
            (Outgrown, 8),
            (Stopped, 130),
            (Internal, 70),
        ];
        for (kind, code) in codes {
            assert_eq!(kind.exit_code(), code, "{kind:?}");
        }
    }
}
