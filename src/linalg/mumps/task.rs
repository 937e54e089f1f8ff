//! Requests of the first rank and answers of each rank. Freedoms have the numbers of the rank's own
//! part of the matrix.

use serde::{Deserialize, Serialize};

#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Task {
    /// Assembles the columns of a matrix and keeps them under the given number; empty bytes mean no
    /// columns. Answer: [`Result<MadeOnRank, String>`].
    Matrix(usize, Vec<u8>),
    /// Drops the columns of a matrix. No answer.
    ForgetMatrix(usize),
    /// Multiplies a matrix by a vector. Answer: [`Product`].
    Product(usize, Vec<f64>),
    /// Finds entries in rows or columns of the marked trailing freedoms, and keeps the marks.
    /// Answer: [`Near`].
    Near(usize, Vec<bool>),
    /// Finds the graph of the interior and the freedoms that it touches, given the vertex of each
    /// freedom, or -1. Answer: pairs of vertices.
    Graph(usize, Vec<i32>),
    /// Sets up a factor of the interior, given its number, the number of the matrix, and the
    /// variable of each freedom, from 1. Answer: [`Analysed`].
    Analyse(usize, usize, Vec<i32>),
    /// Computes the factor with the given number. Answer: [`Factored`].
    Factor(usize),
    /// Solves with the factor that has the given number. Answer: INFOG(1) and INFOG(2).
    Solve(usize),
    /// Drops the factor with the given number. No answer.
    ForgetFactor(usize),
    /// Measures the memory that a rank has taken. Answer: bytes.
    Memory,
    /// Answers a message of the program. Answer: [`Result<Vec<u8>, String>`].
    Evaluate(Vec<u8>),
}

/// Properties of the columns of a matrix that a rank holds.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct MadeOnRank {
    /// Diagonal entries; 0 if another rank holds the column.
    pub(super) diagonal: Vec<f64>,
    /// Whether each freedom is coupled with the previous freedom and with the same freedoms as the
    /// previous one.
    pub(super) continued: Vec<bool>,
    pub(super) n_entries: usize,
    /// Whether any entry is NaN or infinite.
    pub(super) is_damaged: bool,
}

/// Sums over the entries that a rank holds.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Product {
    /// Products `K u` of the rows.
    pub(super) values: Vec<f64>,
    /// Products `|K| |u|` of the rows.
    pub(super) terms: Vec<f64>,
    /// Sums of `|K|` over the rows.
    pub(super) sizes: Vec<f64>,
}

/// Entries whose row or column is a trailing freedom, and for each freedom whether the interior
/// touches it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Near {
    pub(super) touched: Vec<bool>,
    pub(super) rows: Vec<u32>,
    pub(super) columns: Vec<u32>,
    pub(super) values: Vec<f64>,
}

/// Results of MUMPS's analysis on a rank.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Analysed {
    /// INFOG(1) and INFOG(2).
    pub(super) state: [i32; 2],
    /// State of this rank, INFO(1).
    pub(super) own_state: i32,
    /// Ordering that MUMPS used, INFOG(7).
    pub(super) order: i32,
    /// Bytes that the factorisation will take on this rank: the factor and the data held at the
    /// same time.
    pub(super) needed: f64,
    /// Bytes that the limits of this rank leave, measured before the rank had its entries.
    pub(super) left_by_limits: Option<f64>,
    /// Bytes that the rank's machine leaves to all processes.
    pub(super) left_by_machine: Option<f64>,
    /// Name of the rank's machine.
    pub(super) machine: String,
    /// Floating point operations of all ranks together.
    pub(super) flops: f64,
    /// Number of entries of the factor on all ranks together.
    pub(super) nonzeros: f64,
}

/// Results of MUMPS's factorisation on a rank.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Factored {
    /// INFOG(1) and INFOG(2).
    pub(super) state: [i32; 2],
    /// State of this rank, INFO(1).
    pub(super) own_state: i32,
    /// Number of negative pivots, INFOG(12).
    pub(super) negative_pivots: i32,
}
