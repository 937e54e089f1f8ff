//! A tie of the scene as rows by which nodes follow others.

use super::Pair;

/// A tie of the scene resolved to its rows.
#[derive(Debug, Clone)]
pub(in crate::model) struct ResolvedTie {
    /// Description of the tie for messages.
    pub what: String,
    /// Name of the surface whose nodes follow.
    pub slaves: String,
    /// Rows by which each slave node follows others; the area of a row is the integral of the dual
    /// function.
    pub rows: Vec<Pair>,
    /// Rows of slave nodes that already follow others in an earlier tie, where the two ties meet at
    /// a corner. These rows are added to the rows of the neighbouring slaves.
    pub elsewhere: Vec<Pair>,
}
