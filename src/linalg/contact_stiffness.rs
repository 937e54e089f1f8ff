//! Condensed stiffness on the contact freedoms, stored by bodies.
//!
//! Bodies that touch share contact forces, not stiffness: freedoms of different bodies are not
//! coupled in `C`. Two bodies with equal numbers of contact freedoms need half the memory of the
//! whole matrix, and a quarter of the work to form it.

use super::blocked;
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Contact stiffness `C = S_cc - S_cz S_zz^-1 S_zc` (force per displacement),
/// `n_contact x n_contact`, symmetric to the last bit, stored as its diagonal blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactStiffness {
    blocks: Vec<ContactBlock>,
    /// Number of the block, and place in the block, of each contact freedom.
    place: Vec<(usize, usize)>,
}

/// Diagonal block: stiffness among contact freedoms that are coupled with one another.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactBlock {
    /// Contact freedoms (places in [`super::Partition::contact`]), ascending.
    pub freedoms: Vec<usize>,
    /// Entries of the block, `freedoms.len() x freedoms.len()`.
    pub matrix: DMatrix<f64>,
}

impl ContactStiffness {
    /// Builds a matrix from blocks that together hold each of the freedoms `0..n_contact` once.
    pub(crate) fn new(blocks: Vec<ContactBlock>) -> Self {
        let n = blocks.iter().map(|block| block.freedoms.len()).sum();
        let mut place = vec![(0, 0); n];
        for (b, block) in blocks.iter().enumerate() {
            for (k, &freedom) in block.freedoms.iter().enumerate() {
                place[freedom] = (b, k);
            }
        }
        ContactStiffness { blocks, place }
    }

    /// Number of contact freedoms.
    pub fn n_contact(&self) -> usize {
        self.place.len()
    }

    /// Iterates over the diagonal blocks.
    pub fn blocks(&self) -> impl Iterator<Item = &ContactBlock> {
        self.blocks.iter()
    }

    /// Diagonal entry of a freedom.
    pub fn diagonal(&self, freedom: usize) -> f64 {
        let (block, k) = self.place[freedom];
        self.blocks[block].matrix[(k, k)]
    }

    /// Column of a freedom: the freedoms coupled with it, ascending, each with its entry.
    pub fn column(&self, freedom: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (block, k) = self.place[freedom];
        let block = &self.blocks[block];
        let entries = block.matrix.column(k);
        let entries = block.freedoms.iter().zip(entries.data.into_slice());
        entries.map(|(&freedom, &entry)| (freedom, entry))
    }

    /// Product `C x` for the columns of `x` (`n_contact x m`).
    pub fn times(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        let mut product = DMatrix::zeros(x.nrows(), x.ncols());
        for block in &self.blocks {
            let own = &block.matrix * x.select_rows(&block.freedoms);
            for (row, &freedom) in own.row_iter().zip(&block.freedoms) {
                product.set_row(freedom, &row);
            }
        }
        product
    }

    /// Submatrix of the given rows and columns.
    pub(crate) fn part(&self, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        let mut part = DMatrix::zeros(rows.len(), columns.len());
        self.add_part(rows, columns, &mut part);
        part
    }

    /// Adds the submatrix of the given rows and columns to `sum`, whose rows and columns are in the
    /// order of the two lists.
    pub(crate) fn add_part(&self, rows: &[usize], columns: &[usize], sum: &mut DMatrix<f64>) {
        let mut row_of = vec![None; self.n_contact()];
        for (i, &freedom) in rows.iter().enumerate() {
            row_of[freedom] = Some(i);
        }
        let n = rows.len().max(1);
        let sum = sum.as_mut_slice().par_chunks_mut(n).zip(columns);
        sum.with_min_len(blocked::at_once(n))
            .for_each(|(sum, &freedom)| {
                for (row, entry) in self.column(freedom) {
                    if let Some(i) = row_of[row] {
                        sum[i] += entry;
                    }
                }
            });
    }

    /// Splits the stiffness into groups of freedoms that no block couples with others. `place`
    /// gives the group of each freedom and its number within the group. These numbers ascend with
    /// the freedoms of a block.
    pub(crate) fn split(self, place: &[(usize, usize)], n_groups: usize) -> Vec<Self> {
        let mut blocks: Vec<Vec<ContactBlock>> = vec![Vec::new(); n_groups];
        for mut block in self.blocks {
            let Some(&first) = block.freedoms.first() else {
                continue;
            };
            let group = place[first].0;
            for freedom in &mut block.freedoms {
                *freedom = place[*freedom].1;
            }
            blocks[group].push(block);
        }
        blocks.into_iter().map(ContactStiffness::new).collect()
    }

    /// The whole matrix as a dense one, with zeros between the blocks.
    pub fn dense(&self) -> DMatrix<f64> {
        let n = self.n_contact();
        let mut whole = DMatrix::zeros(n, n);
        for j in 0..n {
            for (i, entry) in self.column(j) {
                whole[(i, j)] = entry;
            }
        }
        whole
    }
}
