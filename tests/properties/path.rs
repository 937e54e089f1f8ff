//! Along a load path, from event to event: the end is the solution there, whatever the way.

use super::complementarity::{check_beside, checked};
use brinell::contact::{Path, PathEnd, Tableau};
use nalgebra::DMatrix;
use proptest::prelude::*;

/// More events than this on a piece mean that the path does not end.
const MOST_EVENTS: usize = 2000;

/// Follows `q(t)` from the solution at 0 to 1. Returns gaps, forces and the number of events.
fn follow(t: &DMatrix<f64>, start: &[f64], end: &[f64]) -> (Vec<f64>, Vec<f64>, usize) {
    let n = start.len();
    let mut tableau = Tableau::new(t.clone());
    let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
    brinell::contact::solve(&mut tableau, start, &mut g, &mut r).unwrap();
    let rate = end.iter().zip(start).map(|(b, a)| b - a).collect();
    let mut path = Path::new(&mut tableau, start.to_vec(), rate, g, r, 1.0, 0.0).unwrap();
    let mut events = 0;
    let mut last = 0.0;
    while let PathEnd::Event(changes) = path.advance(&mut tableau, 1.0) {
        assert!(
            !changes.is_empty(),
            "an event without a change at t = {}",
            path.t
        );
        assert!(
            path.t >= last,
            "the path went back from {last} to {}",
            path.t
        );
        last = path.t;
        events += 1;
        assert!(
            events < MOST_EVENTS,
            "the path does not end: t = {}",
            path.t
        );
        path.turn(&mut tableau).unwrap();
    }
    assert_eq!(path.t, 1.0);
    (path.gap, path.force, events)
}

/// Definite matrices with integer entries, so that ties are common and exact.
fn definite() -> impl Strategy<Value = (DMatrix<f64>, Vec<f64>, Vec<f64>)> {
    (1usize..9).prop_flat_map(|n| {
        (
            prop::collection::vec(-2i8..=2, n * n),
            prop::collection::vec(-4i8..=4, n),
            prop::collection::vec(-4i8..=4, n),
        )
            .prop_map(move |(entries, start, end)| {
                let a = DMatrix::from_fn(n, n, |i, j| f64::from(entries[i * n + j]));
                let t = &a * a.transpose() + DMatrix::identity(n, n);
                let float = |v: Vec<i8>| v.into_iter().map(f64::from).collect::<Vec<_>>();
                (t, float(start), float(end))
            })
    })
}

fn size(q: &[f64]) -> f64 {
    q.iter().fold(0.0, |m, v| m.max(v.abs()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn the_end_of_a_path_is_the_solution_there((t, start, end) in definite()) {
        let (g, r, _) = follow(&t, &start, &end);
        // Condition of T at most 1 + 8 * 8 * 4 * 4.
        check_beside(size(&start), &t, &end, &g, &r, 1e4);
        let (direct, forces, _) = checked(&t, &end, 1e4);
        for k in 0..end.len() {
            prop_assert!((g[k] - direct[k]).abs() <= 1e-10, "gap {k}: {} {}", g[k], direct[k]);
            let off = (r[k] - forces[k]).abs();
            prop_assert!(off <= 1e-10 * 40.0, "force {k}: {} {}", r[k], forces[k]);
        }
    }

    /// There and back again: no memory.
    #[test]
    fn a_path_is_reversible((t, start, end) in definite()) {
        let (_, _, there) = follow(&t, &start, &end);
        let (g, r, back) = follow(&t, &end, &start);
        check_beside(size(&end), &t, &start, &g, &r, 1e4);
        prop_assert!(there.max(back) < MOST_EVENTS);
    }
}

/// Identical uncoupled pairs all change at the same point: one event.
#[test]
fn ties_are_one_event() {
    let n = 300;
    let t = DMatrix::identity(n, n);
    let (g, r, events) = follow(&t, &vec![1.0; n], &vec![-2.0; n]);
    assert_eq!(events, 1);
    assert!(g.iter().all(|v| *v == 2.0) && r.iter().all(|v| *v == 0.0));
    let (_, r, events) = follow(&t, &vec![-2.0; n], &vec![1.0; n]);
    assert_eq!(events, 1);
    assert!(r.iter().all(|v| *v == 1.0));
}
