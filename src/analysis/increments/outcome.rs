//! How an increment may end, and what a search for one comes to.

use crate::analysis::structure::equilibrium::Equilibrium;
use crate::error::Error;

/// Most that a change of state may be stretched before its loads are eliminated anew: load and
/// eliminated load are rounded apart, by `eps` of the whole, and that grows with the change. It
/// stays below 1e-12, a hundredth of the tightest tolerance.
pub(super) const STRETCH: f64 = 1e4;

/// How an increment may end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EndsAt {
    /// The increment ends at the next change of contact, within `gamma` (4.18, 4.23), or at the end
    /// of the piece.
    NextChange {
        /// Relative tolerance.
        gamma: f64,
    },
    /// The increment ends at the end of the piece, statuses changing with the iterates
    /// ([`super::settling::settle_contact`]).
    EndOfPiece,
    /// The increment ends at the end of the piece, statuses frozen.
    EndOfPieceFrozen,
}

/// An increment that was found.
#[derive(Debug, Clone)]
pub struct Increment {
    /// Share of the piece at its end.
    pub t: f64,
    /// Equilibrium at its end.
    pub state: Equilibrium,
    /// Pairs that change at the end of the increment.
    pub changes: Vec<usize>,
    /// Material evaluations.
    pub iterations: usize,
    /// Out-of-balance force over the force scale.
    pub residual: f64,
    /// Guard elements that yield: the zone is too small.
    pub guard_yields: usize,
    /// Factor by which the prediction was stretched since its loads were eliminated.
    pub stretched: f64,
}

/// Why no increment was found.
#[derive(Debug)]
pub enum NoIncrement {
    /// The statuses at the end of a fixed increment come back to what they were: no set of them is
    /// right to round-off.
    Undecided,
    /// These pairs violate their condition at once: their statuses are wrong.
    WrongStatus(Vec<usize>),
    /// The start is not in balance: points there are beyond their yield stress, and as they yield a
    /// pair changes, however little the load does.
    Jumps,
    /// The iteration did not converge.
    NotConverged(Box<Attempt>),
    /// These pairs, at the border of their condition at the start, end beyond it.
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
    /// The last iterate.
    pub state: Equilibrium,
    /// Material evaluations.
    pub iterations: usize,
    /// Out-of-balance force of the last iterate over the force scale.
    pub residual: f64,
    /// What round-off leaves out of balance at the start of the increment, over the force scale.
    pub round_off: f64,
    /// Share of the elastic stiffness along a mechanism in which it flows away
    /// ([`super::collapse::flows_away`]), where it was seen to.
    pub mechanism: Option<f64>,
}
