//! How an increment is looked for: at once, then step by step.

/// Share of the best residual so far that counts as progress.
pub const PROGRESS: f64 = 0.7;

/// How equilibrium and the length of an increment that ends at a change of contact are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Whether equilibrium and length are searched together: each iterate is scaled to the change
    /// (4.17, 4.22). An iterate far out of balance shows the change too early, and scaled to it, it
    /// may do so again and again. Otherwise one follows the other: equilibrium at a length, then
    /// the next length, between those that were too short and too long.
    pub together: bool,
    /// Newton's iteration is given up when the residual has not fallen below the share [`PROGRESS`]
    /// of the best for so many iterations.
    pub patience: usize,
}

impl Search {
    /// The first that is tried.
    pub const FIRST: Search = Search {
        together: true,
        patience: 15,
    };
    /// Where that fails.
    pub const APART: Search = Search {
        together: false,
        ..Search::FIRST
    };

    /// Before an increment is given up: the energy falls with every step, so that the iteration
    /// ends at an equilibrium or, where there is none, goes on until no stiffness is left.
    pub fn to_the_end(self) -> Self {
        Search {
            patience: usize::MAX,
            ..self
        }
    }
}
