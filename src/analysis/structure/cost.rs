//! What a run has cost so far.

use crate::results::Counts;
use serde::{Deserialize, Serialize};

/// Cost of a run so far.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Cost {
    /// Counts of what was done.
    pub counts: Counts,
    /// Whether half a trailing solve has been counted for a whole one.
    half: bool,
}

impl Cost {
    /// Two halves count as a trailing solve.
    pub fn count_half(&mut self) {
        self.half = !self.half;
        self.counts.trailing_solves += usize::from(self.half);
    }
}
