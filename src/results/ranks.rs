//! What several ranks did together.

use serde::{Deserialize, Serialize};

/// The ranks of a run that `mpirun` started.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Ranks {
    /// Number of ranks.
    pub count: usize,
    /// Times that the first one asked something of the others: to assemble, to factor, to solve for
    /// each load and each state and to evaluate its stresses, nothing in between.
    pub requests: u64,
    /// Bytes that it sent and received for that, without those of MUMPS.
    pub bytes: u64,
    /// The most memory that each of them has held, in bytes; null if the system does not report
    /// it.
    pub peak_memory_bytes: Vec<Option<u64>>,
}
