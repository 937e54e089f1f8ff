//! The cooperation of several ranks in a run.

use serde::{Deserialize, Serialize};

/// The ranks of a run that `mpirun` started.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Ranks {
    /// Number of ranks.
    pub count: usize,
    /// Number of requests of the first rank to the others: to assemble, to factor, to solve for
    /// each load and each state and to evaluate its stresses. No other requests are made.
    pub requests: u64,
    /// Bytes that the first rank sent and received for these requests, without those of MUMPS.
    pub bytes: u64,
    /// The largest memory that each rank has held, in bytes; null if the system does not report it.
    pub peak_memory_bytes: Vec<Option<u64>>,
}
