//! What the first rank asks, and what each rank answers. Freedoms have the numbers of a rank's own
//! part of the matrix.

use serde::{Deserialize, Serialize};

#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Task {
    /// Assembles and keeps columns of a matrix, by its number; without bytes it has none.
    /// [`Result<MadeOnRank, String>`].
    Matrix(usize, Vec<u8>),
    /// Forgets them. Nothing.
    ForgetMatrix(usize),
    /// Multiplies a vector. [`Product`].
    Product(usize, Vec<f64>),
    /// Entries in rows or columns of the trailing freedoms marked, which are remembered. [`Near`].
    Near(usize, Vec<bool>),
    /// Entries of the graph of the interior and what it touches: the vertex of each freedom, -1 for
    /// none. Pairs of vertices.
    Graph(usize, Vec<i32>),
    /// Sets up a factor of the interior: its number, that of the matrix, the variable of each
    /// freedom, from 1. [`Analysed`].
    Analyse(usize, usize, Vec<i32>),
    /// Computes it. [`Factored`].
    Factor(usize),
    /// Solves with it. INFOG(1) and INFOG(2).
    Solve(usize),
    /// Forgets it. Nothing.
    ForgetFactor(usize),
    /// How much memory a rank has taken. Bytes.
    Memory,
    /// What the program asks. [`Result<Vec<u8>, String>`].
    Evaluate(Vec<u8>),
}

/// Columns that a rank has.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct MadeOnRank {
    /// Diagonal entries, 0 where another rank has the column.
    pub(super) diagonal: Vec<f64>,
    /// Whether each freedom couples to the same freedoms as the one before it, and to that one.
    pub(super) continued: Vec<bool>,
    pub(super) n_entries: usize,
    /// Whether an entry is not a number.
    pub(super) is_damaged: bool,
}

/// Sums over the entries that a rank has.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Product {
    /// Products `K u` of the rows.
    pub(super) values: Vec<f64>,
    /// Products `|K| |u|` of the rows.
    pub(super) terms: Vec<f64>,
    /// Sums of `|K|` over the rows.
    pub(super) sizes: Vec<f64>,
}

/// Entries with a trailing end, and the trailing freedoms that the interior touches.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Near {
    pub(super) touched: Vec<bool>,
    pub(super) rows: Vec<u32>,
    pub(super) columns: Vec<u32>,
    pub(super) values: Vec<f64>,
}

/// What MUMPS says after the analysis.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Analysed {
    /// INFOG(1) and INFOG(2).
    pub(super) state: [i32; 2],
    /// State of this rank, INFO(1).
    pub(super) own_state: i32,
    /// Ordering that was taken, INFOG(7).
    pub(super) order: i32,
    /// Bytes that the factorisation will take on this rank: its factor and what is held at the same
    /// time.
    pub(super) needed: f64,
    /// Bytes that the limits of this rank leave, before it had its entries.
    pub(super) left_by_limits: Option<f64>,
    /// Bytes that its machine leaves to all processes.
    pub(super) left_by_machine: Option<f64>,
    /// Name of the rank's machine.
    pub(super) machine: String,
    /// Operations, of all ranks together.
    pub(super) flops: f64,
    /// Entries of the factor, of all ranks together.
    pub(super) nonzeros: f64,
}

/// What MUMPS says after the factorisation.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Factored {
    /// INFOG(1) and INFOG(2).
    pub(super) state: [i32; 2],
    /// State of this rank, INFO(1).
    pub(super) own_state: i32,
    /// Number of negative pivots, INFOG(12).
    pub(super) negative_pivots: i32,
}
