//! Bodies that no contact force holds yet: where the first bit of load takes them.
//!
//! As the load goes to zero deformation vanishes before the gaps do. What is left of
//! `r = q + T g` is the work of the load on the rigid motions of the bodies that contact alone can
//! hold, whose displacements of the pairs are the columns of `S` (`T S = 0`):
//!
//! ```text
//!     minimise q' S x    with  g + S x >= 0
//! ```
//!
//! A linear program in as many unknowns as there are motions. No load is needed to find it, so
//! that none can be too small beside the round-off of `T g`.
//!
//! # Source
//! The gradient projection method: J. Nocedal, S. J. Wright, *Numerical Optimization*, 2nd ed.,
//! section 16.5; the least index of R. G. Bland (1977), doi:10.1287/moor.2.2.103.

use super::Unbounded;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// Share of the terms of a sum that is its round-off.
const ROUND_OFF: f64 = 1e-11;

/// Moves the pairs of a group by rigid motions, whose displacements are the columns of `slips`
/// (orthonormal), to where the load rate `q` takes them. As many pairs as there are motions then
/// have no gap: where the load does not drive a motion, the nearest pair ends it.
///
/// # Errors
/// [`Unbounded`] where no pair stops a motion that the load drives.
pub(crate) fn come_to_rest(
    slips: &DMatrix<f64>,
    q: &DVector<f64>,
    gap: &mut DVector<f64>,
) -> Result<(), Unbounded> {
    let pull = -slips.tr_mul(q);
    let small = ROUND_OFF * slips.abs().tr_mul(&q.abs()).norm();
    let mut touching: Vec<usize> = Vec::new();
    let mut seen = BTreeSet::new();
    loop {
        let qr = slips.select_rows(&touching).transpose().qr();
        let held = qr.q();
        let held_pull = held.tr_mul(&pull);
        let left = &pull - &held * &held_pull;
        let driven = left.norm() > small;
        let way = if driven {
            left
        } else {
            // Pairs that would have to pull are let go, unless that leads in a circle.
            let pulling = qr.r().solve_upper_triangular(&held_pull).and_then(|force| {
                let of_pairs = touching.iter().zip(force.iter()).enumerate();
                let pulling = of_pairs.filter(|(_, (k, f))| *f * slips.row(**k).norm() > small);
                pulling.min_by_key(|(_, (k, _))| **k).map(|(i, _)| i)
            });
            if let Some(i) = pulling.filter(|_| seen.insert(touching.clone())) {
                touching.remove(i);
                continue;
            }
            match free_motion(&held) {
                Some(way) => way,
                None => break,
            }
        };
        // Those that touch stay where they are, whatever round-off says.
        let mut moves = slips * &way;
        touching.iter().for_each(|&k| moves[k] = 0.0);
        let (step, k) = match (next(slips, &way, &moves, gap, 1.0), driven) {
            (Some(ahead), true) => ahead,
            (None, true) => return Err(Unbounded { pair: moves.imax() }),
            (ahead, false) => {
                let back = next(slips, &way, &moves, gap, -1.0);
                let both = [ahead, back.map(|(step, k)| (-step, k))]
                    .into_iter()
                    .flatten();
                match both.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())) {
                    Some(nearest) => nearest,
                    None => break,
                }
            }
        };
        gap.axpy(step, &moves, 1.0);
        touching.push(k);
        for &k in &touching {
            gap[k] = 0.0;
        }
        gap.apply(|g| *g = g.max(0.0));
    }
    Ok(())
}

/// The pair that closes first along `sign` times the way, and the share of the way until then; of
/// equals the least.
fn next(
    slips: &DMatrix<f64>,
    way: &DVector<f64>,
    moves: &DVector<f64>,
    gap: &DVector<f64>,
    sign: f64,
) -> Option<(f64, usize)> {
    let closing = |k: &usize| -sign * moves[*k] > ROUND_OFF * slips.row(*k).norm() * way.norm();
    let steps = (0..gap.len()).filter(closing);
    let steps = steps.map(|k| (gap[k] / moves[k].abs(), k));
    steps.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// A motion that the orthonormal `held` leave free: the unit vector of which they hold least.
fn free_motion(held: &DMatrix<f64>) -> Option<DVector<f64>> {
    let m = held.nrows();
    if held.ncols() >= m {
        return None;
    }
    let free = DMatrix::identity(m, m) - held * held.transpose();
    let most = free.diagonal().imax();
    Some(free.column(most).into_owned())
}

#[cfg(test)]
mod tests {
    use super::super::{Tableau, solve};
    use super::*;
    use proptest::prelude::*;

    /// A body in a notch of two walls, driven into it, onto one wall, not at all, and out of it.
    #[test]
    fn a_body_moves_until_the_load_is_held() {
        let slips = DMatrix::from_row_slice(3, 2, &[0.6, 0.8, 0.8, -0.6, 0.0, 0.0]);
        let from = DVector::from_vec(vec![0.3, 0.2, 1.0]);
        let rest = |q: [f64; 3]| {
            let mut gap = from.clone();
            come_to_rest(&slips, &DVector::from_row_slice(&q), &mut gap).map(|()| gap)
        };
        let into = rest([1.0, 2.0, 0.0]).expect("both walls hold it");
        assert_eq!(into.as_slice(), [0.0, 0.0, 1.0]);
        // Nothing drives it along the first wall: it goes to where the second holds it too.
        let onto_one = rest([1.0, 0.0, 0.0]).expect("the first wall holds it");
        assert_eq!(onto_one.as_slice(), [0.0, 0.0, 1.0]);
        assert_eq!(rest([0.0; 3]), Ok(into));
        assert_eq!(rest([1.0, -2.0, 0.0]), Err(Unbounded { pair: 1 }));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]

        /// The pairs that touch carry the load without pulling, which shows that no place has less
        /// work; where none holds it, the contact problem has no solution either.
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
            let found = come_to_rest(&slips, &q, &mut gap);
            let t = DMatrix::identity(n, n) - &slips * slips.transpose();
            prop_assume!(t.diagonal().min() > 1e-3);
            let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
            let solved = solve(&mut Tableau::new(t.clone()), q.as_slice(), &mut g, &mut r);
            if found.is_err() {
                // Gaps without end are none: T is singular to round-off.
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
