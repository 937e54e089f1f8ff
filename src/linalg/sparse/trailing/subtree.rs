//! Subtrees of the elimination tree that are solved at the same time.

use std::ops::Range;

/// Panels that may be solved at the same time as panels of other subtrees. A subtree works on a
/// vector of its own, `[ columns | outer ]`: its contributions to rows outside the subtree belong
/// to the rows of its last panel, the root.
#[derive(Debug)]
pub(super) struct Subtree {
    pub(super) panels: Range<usize>,
    pub(super) columns: Range<usize>,
    /// Rows of the root panel, as a range in `TrailingFactor::rows`.
    pub(super) outer: Range<usize>,
    /// Start of the rows of each panel in `own_rows`.
    pub(super) starts: Vec<usize>,
    /// Rows of all panels in the subtree's own numbering.
    pub(super) own_rows: Vec<u32>,
}

/// Workspace of a subtree in one solve.
#[derive(Debug)]
pub(super) struct WorkOfSubtree {
    pub(super) vector: Vec<f64>,
    pub(super) rows: Vec<f64>,
}
