//! The ways to search for an increment: equilibrium and length at once, or one after the other.

/// Progress means that the residual falls below this fraction of the best one so far.
pub const PROGRESS: f64 = 0.7;

/// The way in which equilibrium and the length of an increment that ends at a change of contact are
/// found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Whether equilibrium and length are searched together: each iterate is scaled to the change
    /// of contact (4.17, 4.22). An iterate far out of balance shows the change too early and,
    /// scaled to it, may do so again and again. If false, equilibrium is found at a fixed length,
    /// and then the next length is chosen between lengths that were too short and lengths that were
    /// too long.
    pub together: bool,
    /// Newton's iteration is given up after this many iterations in which the residual has not
    /// fallen below the share [`PROGRESS`] of the best one.
    pub patience: usize,
}

impl Search {
    /// The search that is tried first.
    pub const FIRST: Search = Search {
        together: true,
        patience: 15,
    };
    /// The search that is tried if the first one fails.
    pub const APART: Search = Search {
        together: false,
        ..Search::FIRST
    };

    /// The search made before an increment is given up. The energy falls with every step, so the
    /// iteration either ends at an equilibrium or goes on until no stiffness is left.
    pub fn to_the_end(self) -> Self {
        Search {
            patience: usize::MAX,
            ..self
        }
    }
}
