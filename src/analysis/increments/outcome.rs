//! The ways in which an increment may end, and the results of the search for one.

use crate::analysis::structure::equilibrium::Equilibrium;
use crate::error::Error;

/// Largest factor by which a change of state may be stretched before its loads are eliminated
/// again. Load and eliminated load are rounded separately, by `eps` of the whole. The difference
/// between them grows as the change is stretched, but stays below 1e-12, a hundredth of the
/// tightest tolerance.
pub(super) const STRETCH: f64 = 1e4;

/// The ways in which an increment may end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EndsAt {
    /// The increment ends at the next change of contact, within `gamma` (4.18, 4.23), or at the end
    /// of the piece.
    NextChange {
        /// Relative tolerance on the length of the increment.
        gamma: f64,
    },
    /// The increment ends at the end of the piece; statuses change with the iterates
    /// ([`super::settling::settle_contact`]).
    EndOfPiece,
    /// The increment ends at the end of the piece; statuses are frozen.
    EndOfPieceFrozen,
}

/// An increment that was found.
#[derive(Debug, Clone)]
pub struct Increment {
    /// Share of the piece at the end of the increment.
    pub t: f64,
    /// Equilibrium at the end of the increment.
    pub state: Equilibrium,
    /// Pairs that change at the end of the increment.
    pub changes: Vec<usize>,
    /// Number of material evaluations.
    pub iterations: usize,
    /// Out-of-balance force divided by the force scale.
    pub residual: f64,
    /// Number of guard elements that yield; the zone is too small if there are any.
    pub guard_yields: usize,
    /// Factor by which the prediction was stretched since its loads were eliminated.
    pub stretched: f64,
}

/// The reason why no increment was found.
#[derive(Debug)]
pub enum NoIncrement {
    /// No set of statuses at the end of a fixed increment is right to round-off: the same sets
    /// recur, or the changes do not end.
    Undecided,
    /// The given pairs violate their contact condition from the start of the increment on: their
    /// statuses are wrong.
    WrongStatus(Vec<usize>),
    /// The start is not in balance: points there are beyond yield, and as they yield a pair changes
    /// its status, however short the increment is.
    Jumps,
    /// The iteration did not converge.
    NotConverged(Box<Attempt>),
    /// The given pairs begin with a gap or force of zero and end with a negative one.
    Crossed(Vec<usize>),
    /// The caller asked to stop.
    Stopped,
    /// A rank that holds a part of the stiffness failed.
    Failed(Error),
}

impl From<Error> for NoIncrement {
    fn from(error: Error) -> Self {
        NoIncrement::Failed(error)
    }
}

/// An increment that was tried and did not converge.
#[derive(Debug)]
pub struct Attempt {
    /// The last iterate of the attempt.
    pub state: Equilibrium,
    /// Number of material evaluations.
    pub iterations: usize,
    /// Out-of-balance force of the last iterate, divided by the force scale.
    pub residual: f64,
    /// Out-of-balance force that round-off leaves at the start of the increment, divided by the
    /// force scale.
    pub round_off: f64,
    /// The fraction of the elastic stiffness that is left along a mechanism in which the structure
    /// flows away ([`super::collapse::flows_away`]); `None` if no mechanism was found.
    pub mechanism: Option<f64>,
}
