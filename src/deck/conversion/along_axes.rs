//! Displacements that a deck prescribes along axes of a `*TRANSFORM`.

use super::super::history::{Entry, Map};
use super::super::series::Series;
use super::Draft;
use crate::scene::{Direction, EquationTerm};
use crate::space::{Vector, along};

/// Largest component of a unit vector that counts as round-off, after the sums of an elimination.
const ROUND_OFF: f64 = 1e-12;

/// The condition `v . u = sum_k b_k d_k` on a node's displacement `u`, with values `d_k` over time.
#[derive(Clone)]
struct KnownAlong {
    direction: Vector,
    shares: Vec<f64>,
}

impl Draft<'_> {
    /// Prescribes the displacement of a node along some of its own axes, by Gaussian elimination:
    /// a component along x, y or z is either known then, or follows the others.
    pub(super) fn move_along(
        &mut self,
        node: u32,
        known: Vec<(Vector, Entry)>,
        boundary: &mut Map,
    ) {
        let n = known.len();
        let mut rows: Vec<KnownAlong> = (known.iter().enumerate())
            .map(|(k, (direction, _))| KnownAlong {
                direction: *direction,
                shares: (0..n).map(|of| f64::from(u8::from(of == k))).collect(),
            })
            .collect();
        let mut pivots: Vec<usize> = Vec::new();
        for k in 0..n {
            let size = |axis: &usize| rows[k].direction[*axis].abs();
            let free = (0..3).filter(|axis| !pivots.contains(axis));
            let Some(pivot) = free.max_by(|a, b| size(a).total_cmp(&size(b)).then(b.cmp(a))) else {
                return;
            };
            let scale = 1.0 / rows[k].direction[pivot];
            rows[k].direction = rows[k].direction.map(|x| scale * x);
            rows[k].shares.iter_mut().for_each(|b| *b *= scale);
            let own = rows[k].clone();
            for (_, row) in rows.iter_mut().enumerate().filter(|(other, _)| *other != k) {
                let factor = row.direction[pivot];
                row.direction = along(row.direction, -factor, own.direction);
                row.direction[pivot] = 0.0;
                for (b, own) in row.shares.iter_mut().zip(&own.shares) {
                    *b -= factor * own;
                }
            }
            pivots.push(pivot);
        }
        for ((row, pivot), (_, entry)) in rows.into_iter().zip(pivots).zip(&known) {
            let mut moved = Series::starting(0.0);
            for ((_, entry), share) in known.iter().zip(&row.shares) {
                moved.add(&entry.series, *share);
            }
            let free =
                (0..3).filter(|&axis| axis != pivot && row.direction[axis].abs() > ROUND_OFF);
            let free: Vec<usize> = free.collect();
            if free.is_empty() {
                boundary.insert((node, pivot as u8), Entry::new(moved, entry.place));
                continue;
            }
            let on = self.set_of_node(node);
            let term = |axis: usize| EquationTerm {
                on: on.clone(),
                direction: Direction::ALL[axis],
                coefficient: -row.direction[axis],
            };
            let terms = std::iter::once(pivot).chain(free).map(term).collect();
            self.relate(terms, moved, entry.place);
        }
    }
}
