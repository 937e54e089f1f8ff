//! Matrix of the contact problem, stored by groups of pairs.
//!
//! Pairs of bodies that nothing joins do not influence one another: for a thousand separate joints
//! the matrix has a thousand small blocks, and principal pivots keep this structure. Memory and
//! work are therefore those of the blocks, not of the whole matrix.

use nalgebra::DMatrix;
use rayon::prelude::*;
use std::sync::Arc;

/// Number of rows that a thread takes at a time.
const ROWS: usize = 512;

/// A symmetric matrix with a row and a column for each pair, stored as its diagonal blocks. Cloning
/// is cheap.
#[derive(Debug, Clone)]
pub struct PairMatrix {
    blocks: Arc<[PairBlock]>,
    /// For each pair the number of its block and its place in the block.
    place: Arc<[(usize, usize)]>,
}

/// Block of the contact matrix: stiffness that couples the pairs of one group.
#[derive(Debug, Clone)]
pub struct PairBlock {
    /// Numbers of the pairs of this block, ascending.
    pub pairs: Vec<usize>,
    /// Entries of the block, `pairs.len() x pairs.len()`, symmetric.
    pub matrix: Arc<DMatrix<f64>>,
}

impl PairMatrix {
    /// Builds a matrix from blocks that together hold each of the pairs `0..n` once.
    pub fn new(blocks: Vec<PairBlock>) -> Self {
        let n = blocks.iter().map(|block| block.pairs.len()).sum();
        let mut place = vec![(0, 0); n];
        for (b, block) in blocks.iter().enumerate() {
            for (k, &pair) in block.pairs.iter().enumerate() {
                place[pair] = (b, k);
            }
        }
        PairMatrix {
            blocks: blocks.into(),
            place: place.into(),
        }
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.place.len()
    }

    /// True if there is no pair.
    pub fn is_empty(&self) -> bool {
        self.place.is_empty()
    }

    /// The blocks, one for each group of pairs.
    pub fn blocks(&self) -> &[PairBlock] {
        &self.blocks
    }

    /// Returns the number of the block of a pair and the place of the pair in it.
    pub fn place(&self, pair: usize) -> (usize, usize) {
        self.place[pair]
    }

    /// Diagonal entry of a pair.
    pub fn diagonal(&self, pair: usize) -> f64 {
        let (block, k) = self.place[pair];
        self.blocks[block].matrix[(k, k)]
    }

    /// Column of a pair: the pairs of its group, ascending, each with its entry.
    pub fn column(&self, pair: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (block, k) = self.place[pair];
        let block = &self.blocks[block];
        let entries = block.matrix.column(k).data.into_slice();
        block.pairs.iter().copied().zip(entries.iter().copied())
    }

    /// Adds the product with a vector: `y += A x`, fast if most entries of `x` are zero.
    pub(crate) fn add_product(&self, x: &[f64], y: &mut [f64]) {
        let blocks = self.blocks.iter();
        add_products(
            blocks.map(|block| (block.pairs.as_slice(), &*block.matrix)),
            x,
            y,
        );
    }

    /// The whole matrix as a dense one, with zeros between the blocks.
    pub fn dense(&self) -> DMatrix<f64> {
        let n = self.len();
        let mut whole = DMatrix::zeros(n, n);
        for j in 0..n {
            for (i, entry) in self.column(j) {
                whole[(i, j)] = entry;
            }
        }
        whole
    }

    /// Number of entries that are stored in the blocks.
    pub fn n_entries(&self) -> usize {
        self.blocks.iter().map(|block| block.matrix.len()).sum()
    }
}

impl From<DMatrix<f64>> for PairMatrix {
    fn from(matrix: DMatrix<f64>) -> Self {
        Arc::new(matrix).into()
    }
}

impl From<Arc<DMatrix<f64>>> for PairMatrix {
    fn from(matrix: Arc<DMatrix<f64>>) -> Self {
        let pairs = (0..matrix.nrows()).collect();
        PairMatrix::new(vec![PairBlock { pairs, matrix }])
    }
}

/// Adds `y += A x` for a matrix `A` that is given by its blocks, each with its pairs.
pub(super) fn add_products<'a>(
    blocks: impl Iterator<Item = (&'a [usize], &'a DMatrix<f64>)>,
    x: &[f64],
    y: &mut [f64],
) {
    let (mut own_x, mut own_y) = (Vec::new(), Vec::new());
    for (pairs, a) in blocks {
        if pairs.len() == y.len() {
            add_product(a, x, y);
            continue;
        }
        own_x.clear();
        own_x.extend(pairs.iter().map(|&k| x[k]));
        if own_x.iter().all(|x| *x == 0.0) {
            continue;
        }
        own_y.clear();
        own_y.extend(pairs.iter().map(|&k| y[k]));
        add_product(a, &own_x, &mut own_y);
        for (&k, &value) in pairs.iter().zip(&own_y) {
            y[k] = value;
        }
    }
}

/// Adds `y += A x` for one dense block, fast if most entries of `x` are zero.
fn add_product(a: &DMatrix<f64>, x: &[f64], y: &mut [f64]) {
    let add = |(block, y): (usize, &mut [f64])| {
        for (j, &x) in x.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            let rows = &a.as_slice()[j * a.nrows() + block * ROWS..][..y.len()];
            for (y, a) in y.iter_mut().zip(rows) {
                *y += a * x;
            }
        }
    };
    if y.len() <= ROWS {
        add((0, y));
    } else {
        y.par_chunks_mut(ROWS).enumerate().for_each(add);
    }
}
