//! An early end of a run.

use crate::error::{Error, ErrorKind};

/// The reason why a run ended before its program did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Incomplete {
    /// The kind that decides the exit code: stopped, collapse, analysis, ...
    pub kind: ErrorKind,
    /// The reason in words.
    pub why: String,
}

impl Incomplete {
    /// Returns this ending as an error.
    pub fn to_error(&self) -> Error {
        Error::new(self.kind, self.why.as_str())
    }
}
