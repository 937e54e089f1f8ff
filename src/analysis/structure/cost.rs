//! Counts of the work that a run has done so far.

use crate::results::Counts;
use serde::{Deserialize, Serialize};

/// Cost of a run so far.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Cost {
    /// Counts of factorisations, solves and iterations.
    pub counts: Counts,
    /// Whether an odd number of halves was counted, so that the next half belongs to the same
    /// solve.
    half: bool,
}

impl Cost {
    /// Counts half a trailing solve: two halves count as one.
    pub fn count_half(&mut self) {
        self.half = !self.half;
        self.counts.trailing_solves += usize::from(self.half);
    }
}
