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
    /// Rows of nodes that follow in an earlier tie, around a corner: their part of this tie is
    /// handed on to their neighbours.
    pub elsewhere: Vec<Pair>,
}
