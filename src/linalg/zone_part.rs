//! Parts of the zone.

/// Blocks that a backend must visit to recover some zone freedoms; by default all.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ZonePart {
    /// For each block of the backend, whether it is visited; empty for all.
    pub(super) blocks: Vec<bool>,
}

#[cfg(any(feature = "cholmod", feature = "faer"))]
impl ZonePart {
    /// Whether a block is visited.
    pub(super) fn has(&self, block: usize) -> bool {
        self.blocks.is_empty() || self.blocks[block]
    }
}
