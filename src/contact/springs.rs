//! Weak springs on rigid motions that neither contact holds nor a load drives.
//!
//! Example: a round punch touches a block with one pair. The pair carries the load, but it does not
//! resist a sideways motion. If no load acts sideways, equilibrium does not determine where the
//! punch stands: `T` is singular, and round-off would decide which pairs open and close. A spring
//! of very small stiffness keeps the punch where it is. Before results are read the spring is
//! released and equilibrium found again, until it carries no force (the proximal point method: R.
//! T. Rockafellar (1976), doi:10.1137/0314056).

use super::{PairBlock, PairMatrix};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Stiffness of a spring as a fraction of the stiffness of the pairs that move with it. Round-off
/// of 1e-13 of the load then moves the body by only 1e-5 of the deformation. Even where contact
/// resists a motion with only 1e-5 of the stiffness, as round surfaces of few elements do, the
/// spring is negligible.
const WEAK: f64 = 1e-8;

/// Weak springs on the pairs of a group. They act on the motions that nothing holds and nothing
/// drives, keep the bodies where they are and so let every pair open. `T` becomes `T + F F'`, and
/// `-F F' g_0` is added to the forces `q`, where `g_0` are the gaps at which the springs carry no
/// force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Springs {
    pairs: Vec<usize>,
    /// Columns of `F`, one for each motion.
    directions: Vec<Vec<f64>>,
    /// Amplitudes `F' g_0` at which the springs carry no force.
    at_rest: Vec<f64>,
}

impl Springs {
    /// Builds springs on the motions whose displacements of the pairs are the columns of `motions`
    /// (orthonormal); the springs carry no force at the gaps `gap`.
    pub(crate) fn new(
        matrix: &PairMatrix,
        pairs: &[usize],
        motions: &DMatrix<f64>,
        gap: &[f64],
    ) -> Self {
        let directions = motions.column_iter().map(|motion| {
            let of_pairs = pairs.iter().zip(motion.iter());
            let stiffness: f64 = of_pairs.map(|(&k, s)| s * s * matrix.diagonal(k)).sum();
            let root = (WEAK * stiffness).sqrt();
            motion.iter().map(|s| root * s).collect()
        });
        let mut springs = Springs {
            pairs: pairs.to_vec(),
            directions: directions.collect(),
            at_rest: Vec::new(),
        };
        springs.at_rest = springs.amplitudes(gap);
        springs
    }

    /// Numbers of the pairs on which the springs act.
    pub(crate) fn pairs(&self) -> &[usize] {
        &self.pairs
    }

    /// Whether the springs match the matrix: their pairs exist and lie in one group, the sizes
    /// agree.
    pub(crate) fn fit(&self, matrix: &PairMatrix) -> bool {
        let of_pairs = |direction: &Vec<f64>| direction.len() == self.pairs.len();
        let group = |k: usize| (k < matrix.len()).then(|| matrix.place(k).0);
        let mut groups = self.pairs.iter().map(|&k| group(k));
        let first = groups.next().flatten();
        first.is_some()
            && groups.all(|group| group == first)
            && self.directions.iter().all(of_pairs)
            && self.at_rest.len() == self.directions.len()
    }

    /// Whether other springs have the same pairs and stiffness. The gaps at which the springs carry
    /// no force may differ.
    pub(crate) fn as_stiff_as(&self, other: &Springs) -> bool {
        self.pairs == other.pairs && self.directions == other.directions
    }

    /// Returns springs of the same stiffness that carry no force at the gaps `gap`.
    pub(crate) fn moved_to(&self, gap: &[f64]) -> Self {
        Springs {
            at_rest: self.amplitudes(gap),
            ..self.clone()
        }
    }

    /// Amplitudes `F' g` of the motions for the gaps `g`.
    fn amplitudes(&self, gap: &[f64]) -> Vec<f64> {
        let along = |direction: &Vec<f64>| {
            let of_pairs = self.pairs.iter().zip(direction);
            of_pairs.map(|(&k, f)| f * gap[k]).sum()
        };
        self.directions.iter().map(along).collect()
    }

    /// Adds `F a`, the spring forces of the amplitudes `a`, to the forces of all pairs.
    fn add_times(&self, amplitudes: &[f64], forces: &mut [f64]) {
        for (direction, a) in self.directions.iter().zip(amplitudes) {
            for (&k, f) in self.pairs.iter().zip(direction) {
                forces[k] += f * a;
            }
        }
    }

    /// Adds the constant part of the spring forces, `-F F' g_0`, to the forces of all pairs.
    pub(crate) fn add_at_rest(&self, forces: &mut [f64]) {
        let back: Vec<f64> = self.at_rest.iter().map(|a| -a).collect();
        self.add_times(&back, forces);
    }

    /// The largest force that the springs exert on a pair at the gaps `gap`: `F F' (g - g_0)`.
    pub(crate) fn largest_force(&self, gap: &[f64]) -> f64 {
        let moved = self.amplitudes(gap);
        let moved: Vec<f64> = moved
            .iter()
            .zip(&self.at_rest)
            .map(|(a, b)| a - b)
            .collect();
        let of_pair = |i: usize| -> f64 {
            let of_each = self.directions.iter().zip(&moved);
            of_each.map(|(direction, a)| direction[i] * a).sum()
        };
        (0..self.pairs.len()).fold(0.0f64, |m, i| m.max(of_pair(i).abs()))
    }
}

/// Returns the matrix of the pairs with the stiffness of the springs added.
pub(crate) fn with_springs(matrix: &PairMatrix, springs: &[Springs]) -> PairMatrix {
    if springs.is_empty() {
        return matrix.clone();
    }
    let mut blocks = matrix.blocks().to_vec();
    for own in springs {
        let block: &mut PairBlock = &mut blocks[matrix.place(own.pairs[0]).0];
        let stiffness = Arc::make_mut(&mut block.matrix);
        for direction in &own.directions {
            let place = |i: usize| matrix.place(own.pairs[i]).1;
            for (j, f) in direction.iter().enumerate() {
                for (i, g) in direction.iter().enumerate() {
                    stiffness[(place(i), place(j))] += f * g;
                }
            }
        }
    }
    PairMatrix::new(blocks)
}
