//! Positions to which the first bit of load moves bodies that no contact force holds yet.
//!
//! As the load goes to zero, the deformation vanishes before the gaps do. What remains of
//! `r = q + T g` is the work of the load on the rigid motions of the bodies that are held by
//! contact alone. The displacements of the pairs in these motions are the columns of `S`
//! (`T S = 0`):
//!
//! ```text
//!     minimise q' S x    with  g + S x >= 0
//! ```
//!
//! This is a linear program in as many unknowns as there are motions. It does not contain the size
//! of the load, so no load can be too small compared with the round-off of `T g`. A motion that the
//! load does not drive (a roller between two plates, sideways) has no place of least work: the body
//! stays where it is.
//!
//! # Source
//! The gradient projection method: J. Nocedal, S. J. Wright, *Numerical Optimization*, 2nd ed.,
//! section 16.5; the least index of R. G. Bland (1977), doi:10.1287/moor.2.2.103.

use super::Unbounded;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// Fraction of the terms of a sum below which the sum counts as round-off.
const ROUND_OFF: f64 = 1e-11;
/// Moves the pairs of a group by rigid motions, whose displacements are the columns of `slips`
/// (orthonormal), to where the load rate `q`, a sum of `terms`, takes them. A motion that the load
/// does not drive leaves the pairs where they are. Returns the motions that no pair stops on this
/// way, as the orthonormal columns of a matrix (`motions x free motions`).
///
/// # Errors
/// [`Unbounded`] if no pair stops a motion that the load drives.
pub(crate) fn come_to_rest(
    slips: &DMatrix<f64>,
    [q, terms]: [&DVector<f64>; 2],
    gap: &mut DVector<f64>,
) -> Result<DMatrix<f64>, Unbounded> {
    let pull = -slips.tr_mul(q);
    let size = |q: &DVector<f64>| slips.abs().tr_mul(&q.abs()).norm();
    let of_terms = 8.0 * f64::EPSILON * (q.len() as f64).sqrt();
    let small = (ROUND_OFF * size(q)).max(of_terms * size(terms));
    let mut touching: Vec<usize> = Vec::new();
    let mut seen = BTreeSet::new();
    loop {
        let qr = slips.select_rows(&touching).transpose().qr();
        let held = qr.q();
        let held_pull = held.tr_mul(&pull);
        let way = &pull - &held * &held_pull;
        if way.norm() <= small {
            // Pairs that would have to pull are released, unless this leads in a circle.
            let pulling = qr.r().solve_upper_triangular(&held_pull).and_then(|force| {
                let of_pairs = touching.iter().zip(force.iter()).enumerate();
                let pulling = of_pairs.filter(|(_, (k, f))| *f * slips.row(**k).norm() > small);
                pulling.min_by_key(|(_, (k, _))| **k).map(|(i, _)| i)
            });
            match pulling.filter(|_| seen.insert(touching.clone())) {
                Some(i) => {
                    touching.remove(i);
                    continue;
                }
                None => return Ok(complement(&held)),
            }
        }
        // Touching pairs stay in touch, whatever round-off says.
        let mut moves = slips * &way;
        touching.iter().for_each(|&k| moves[k] = 0.0);
        let (step, k) =
            next(slips, &way, &moves, gap).ok_or_else(|| Unbounded { pair: moves.imax() })?;
        gap.axpy(step, &moves, 1.0);
        touching.push(k);
        for &k in &touching {
            gap[k] = 0.0;
        }
        gap.apply(|g| *g = g.max(0.0));
    }
}

/// Returns the share of the way until the first pair closes, and that pair; of several pairs that
/// close at once, the first.
fn next(
    slips: &DMatrix<f64>,
    way: &DVector<f64>,
    moves: &DVector<f64>,
    gap: &DVector<f64>,
) -> Option<(f64, usize)> {
    let closing = |k: &usize| -moves[*k] > ROUND_OFF * slips.row(*k).norm() * way.norm();
    let steps = (0..gap.len()).filter(closing);
    let steps = steps.map(|k| (gap[k] / moves[k].abs(), k));
    steps.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns an orthonormal basis of the orthogonal complement of the orthonormal columns of `held`.
fn complement(held: &DMatrix<f64>) -> DMatrix<f64> {
    let m = held.nrows();
    let mut left = DMatrix::identity(m, m) - held * held.transpose();
    let mut basis = DMatrix::zeros(m, m - held.ncols());
    for mut column in basis.column_iter_mut() {
        // `left` is a projection: its longest column belongs to its largest diagonal entry.
        let most = left.diagonal().imax();
        let longest = left.column(most).normalize();
        left -= &longest * longest.transpose();
        column.copy_from(&longest);
    }
    basis
}

#[cfg(test)]
mod tests {
    use super::super::{Tableau, solve};
    use super::*;
    use proptest::prelude::*;

    /// A body in a notch between two walls. The load drives it into the notch, onto one wall,
    /// nowhere, and out of the notch.
    #[test]
    fn a_body_moves_until_the_load_is_held() {
        let slips = DMatrix::from_row_slice(3, 2, &[0.6, 0.8, 0.8, -0.6, 0.0, 0.0]);
        let from = DVector::from_vec(vec![0.3, 0.2, 1.0]);
        let rest = |q: [f64; 3]| {
            let mut gap = from.clone();
            let q = DVector::from_row_slice(&q);
            let found = come_to_rest(&slips, [&q, &q], &mut gap);
            found.map(|free| (gap, free.ncols()))
        };
        let at = |gap: [f64; 3]| DVector::from_row_slice(&gap);
        let into = rest([1.0, 2.0, 0.0]);
        assert_eq!(into, Ok((at([0.0, 0.0, 1.0]), 0)));
        // Nothing drives the body along the first wall.
        let onto_one = rest([1.0, 0.0, 0.0]);
        assert_eq!(onto_one, Ok((at([0.0, 0.2, 1.0]), 1)));
        assert_eq!(rest([0.0; 3]), Ok((from.clone(), 2)));
        assert_eq!(rest([1.0, -2.0, 0.0]), Err(Unbounded { pair: 1 }));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]

        /// The touching pairs carry the load without pulling, which shows that no other place has
        /// less work. If no pairs hold the load, the contact problem has no solution either.
        #[test]
        fn the_load_is_held_where_it_can_be(n in 2usize..12, m in 1usize..5,
                entries in proptest::collection::vec(-1.0f64..1.0, 48),
                gaps in proptest::collection::vec(1e-3f64..1.0, 12),
                q in proptest::collection::vec(-1.0f64..1.0, 12)) {
            let m = m.min(n - 1);
            let qr = DMatrix::from_row_slice(n, m, &entries[..n * m]).qr();
            prop_assume!(qr.r().diagonal().amin() > 1e-2);
            let slips = qr.q();
            let from = DVector::from_row_slice(&gaps[..n]);
            let q = DVector::from_row_slice(&q[..n]);
            let mut gap = from.clone();
            let found = come_to_rest(&slips, [&q, &q], &mut gap);
            let t = DMatrix::identity(n, n) - &slips * slips.transpose();
            prop_assume!(t.diagonal().min() > 1e-3);
            let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
            let solved = solve(&mut Tableau::new(t.clone()), q.as_slice(), &mut g, &mut r);
            if found.is_err() {
                // Enormous gaps are no solution: T is singular up to round-off.
                prop_assert!(solved.is_err() || g.iter().any(|g| *g > 1e6), "{:?}", g);
            } else {
                prop_assert!(gap.min() >= 0.0);
                let moved = &gap - &from;
                let strained = (&t * &moved).amax() / moved.amax().max(1.0);
                prop_assert!(strained < 1e-10, "not a rigid motion");
                let touching: Vec<usize> = (0..n).filter(|&k| gap[k] == 0.0).collect();
                prop_assert_eq!(touching.len(), m);
                let held = slips.select_rows(&touching).transpose();
                let force = held.lu().solve(&slips.tr_mul(&q)).expect("independent pairs");
                prop_assert!(force.min() >= -1e-9 * force.amax(), "pulls: {}", force);
            }
        }
    }
}
