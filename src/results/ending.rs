//! The ending of a run.

use super::{Demand, Incomplete, Results};
use crate::error::ErrorKind;

/// The ending of a run, with the requirements that it did not meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending<'r> {
    /// The program is complete, there is no reason not to trust its states
    /// ([`Results::inaccurate`]), and the demanded accuracy is reached.
    Complete,
    /// The program is complete, but there are reasons not to trust it ([`Results::inaccurate`]), or
    /// the demanded accuracy is not reached.
    Inaccurate {
        /// Reasons not to trust the results: see [`Results::inaccurate`].
        states: &'r [String],
        /// A demanded accuracy that was not reached.
        demand: Option<&'r Demand>,
    },
    /// The run ended before its program did.
    Incomplete(&'r Incomplete),
}

impl Results {
    /// Returns how the run ended.
    pub fn ending(&self) -> Ending<'_> {
        if let Some(incomplete) = &self.incomplete {
            return Ending::Incomplete(incomplete);
        }
        let demand = self.accuracy.as_ref().and_then(|a| a.demand.as_ref());
        let demand = demand.filter(|demand| !demand.reached);
        if self.inaccurate.is_empty() && demand.is_none() {
            Ending::Complete
        } else {
            Ending::Inaccurate {
                states: &self.inaccurate,
                demand,
            }
        }
    }
}

impl Ending<'_> {
    /// Returns the kind that decides the exit code; `None` if all requirements are met.
    pub fn kind(&self) -> Option<ErrorKind> {
        match self {
            Ending::Complete => None,
            Ending::Inaccurate { .. } => Some(ErrorKind::Inaccurate),
            Ending::Incomplete(incomplete) => Some(incomplete.kind),
        }
    }
}
