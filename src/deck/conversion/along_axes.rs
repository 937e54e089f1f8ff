//! Displacements along axes of a `*TRANSFORM` that a deck prescribes or makes follow others.

use super::super::constraints::LocalAxes;
use super::super::history::{KeyHistory, Map};
use super::super::linear::FreedomCoefficients;
use super::super::series::Series;
use super::super::source::LinePlace;
use super::draft::Draft;
use crate::scene::{Direction, EquationTerm};
use crate::space::{Vector, along};

/// Largest component of a unit vector that counts as round-off, after the sums of an elimination.
const ROUND_OFF: f64 = 1e-12;

/// Displacement of a node along a direction, as a sum of displacements of other nodes plus a value
/// over time.
struct AlongAxis {
    axis: Vector,
    of: FreedomCoefficients,
    moved: Series,
    place: LinePlace,
}

/// The condition `v . u = sum_k b_k d_k` on a node's displacement `u`, with the known displacements
/// `d_k` along axes of the node.
#[derive(Clone)]
struct KnownAlong {
    direction: Vector,
    shares: Vec<f64>,
}

/// Known displacements of a node along some of its own axes.
pub(super) struct NodeAlongAxes {
    node: u32,
    known: Vec<AlongAxis>,
}

impl NodeAlongAxes {
    /// Takes the displacements prescribed along the axes of a node from the map.
    pub(super) fn taken(node: u32, axes: &LocalAxes, boundary: &mut Map) -> Self {
        let known = (0..3u8).filter_map(|axis| {
            let entry = boundary.remove(&(node, axis))?;
            Some(AlongAxis {
                axis: axes[&node][axis as usize],
                of: FreedomCoefficients::new(),
                moved: entry.series,
                place: entry.place,
            })
        });
        let known = known.collect();
        NodeAlongAxes { node, known }
    }

    /// Adds that the displacement along an axis is a sum of others plus a value. Displacements of
    /// the same node among the others, `c_j a_j . u`, are subtracted from the direction `a` in
    /// `a . u`.
    pub(super) fn follow(
        &mut self,
        axis: u8,
        mut of: FreedomCoefficients,
        moved: Series,
        axes: &LocalAxes,
        place: LinePlace,
    ) {
        let own = &axes[&self.node];
        let mut direction = own[axis as usize];
        for (j, other) in (0..3u8).zip(own) {
            if let Some(c) = of.remove(&(self.node, j)) {
                direction = along(direction, -c, *other);
            }
        }
        self.known.push(AlongAxis {
            axis: direction,
            of,
            moved,
            place,
        });
    }

    /// Prescribes the displacement by Gaussian elimination, after which each component along x, y
    /// or z is either known or follows others.
    pub(super) fn prescribe(&self, draft: &mut Draft, axes: &LocalAxes, boundary: &mut Map) {
        let (node, known) = (self.node, &self.known);
        for (row, pivot, place) in eliminated(known) {
            let mut moved = Series::starting(0.0);
            let mut of = FreedomCoefficients::new();
            for (known, share) in known.iter().zip(&row.shares) {
                moved.add(&known.moved, *share);
                for (key, c) in &known.of {
                    *of.entry(*key).or_default() += share * c;
                }
            }
            let free =
                (0..3).filter(|&axis| axis != pivot && row.direction[axis].abs() > ROUND_OFF);
            let own: Vec<usize> = std::iter::once(pivot).chain(free).collect();
            of.retain(|_, c| *c != 0.0);
            if own.len() == 1 && of.is_empty() {
                boundary.insert((node, pivot as u8), KeyHistory::new(moved, place));
                continue;
            }
            let on = draft.set_of_node(node);
            let term = |axis: usize| EquationTerm {
                on: on.clone(),
                direction: Direction::ALL[axis],
                coefficient: -row.direction[axis],
            };
            let mut terms: Vec<EquationTerm> = own.into_iter().map(term).collect();
            for (key, c) in of {
                terms.extend(draft.components_of(key, c, axes));
            }
            draft.relate(terms, moved, place);
        }
    }
}

/// The conditions on the components of a displacement, each with its pivot and its place.
fn eliminated(known: &[AlongAxis]) -> Vec<(KnownAlong, usize, LinePlace)> {
    let n = known.len();
    let mut rows: Vec<KnownAlong> = (known.iter().enumerate())
        .map(|(k, known)| KnownAlong {
            direction: known.axis,
            shares: (0..n).map(|of| f64::from(u8::from(of == k))).collect(),
        })
        .collect();
    let mut pivots: Vec<usize> = Vec::new();
    for k in 0..n {
        let size = |axis: &usize| rows[k].direction[*axis].abs();
        let free = (0..3).filter(|axis| !pivots.contains(axis));
        let Some(pivot) = free.max_by(|a, b| size(a).total_cmp(&size(b)).then(b.cmp(a))) else {
            break;
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
    let rows = rows.into_iter().zip(pivots).zip(known);
    rows.map(|((row, pivot), known)| (row, pivot, known.place))
        .collect()
}
