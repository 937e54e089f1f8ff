use super::*;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// A semidefinite matrix `A A'`, where `A` has fewer columns than rows if `rank < n`.
fn semidefinite(n: usize, rank: usize, entries: &[f64]) -> DMatrix<f64> {
    let a = DMatrix::from_fn(n, rank.max(1), |i, j| {
        entries[(i * rank.max(1) + j) % entries.len()]
    });
    &a * a.transpose()
}

fn check(t: &DMatrix<f64>, q: &[f64], g: &[f64], r: &[f64]) {
    let n = q.len();
    let full = t * DVector::from_column_slice(g) + DVector::from_column_slice(q);
    let scale = q.iter().fold(1e-300f64, |m, v| m.max(v.abs()))
        + t.amax() * g.iter().fold(0.0f64, |m, v| m.max(*v));
    for k in 0..n {
        assert!(g[k] >= 0.0 && r[k] >= 0.0);
        assert!(
            g[k] == 0.0 || r[k] == 0.0,
            "pair {k}: gap {} force {}",
            g[k],
            r[k]
        );
        assert!(
            (full[k] - r[k]).abs() <= 1e-11 * n as f64 * scale,
            "pair {k}: {} {}",
            full[k],
            r[k]
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    /// Every semidefinite problem is solved, or a direction that costs no energy proves that it has
    /// no solution.
    #[test]
    fn complementarity_terminates(n in 1usize..14, rank in 1usize..16,
            entries in proptest::collection::vec(-1.0f64..1.0, 224),
            q in proptest::collection::vec(-1.0f64..1.0, 14)) {
        let t = semidefinite(n, rank, &entries);
        let q = &q[..n];
        let mut tableau = Tableau::new(t.clone());
        let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
        match solve(&mut tableau, q, &mut g, &mut r) {
            Ok(_) => check(&t, q, &g, &r),
            Err(_) => prop_assert!(rank < n, "a definite problem always has a solution"),
        }
    }

}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The end of the path equals the direct solution there, whatever happened on the way.
    #[test]
    fn path_ends_where_the_direct_solve_does(
            n in 1usize..12,
            entries in proptest::collection::vec(-1.0f64..1.0, 168),
            q0 in proptest::collection::vec(0.0f64..1.0, 12),
            q1 in proptest::collection::vec(-3.0f64..1.0, 12)) {
        let t = semidefinite(n, n + 2, &entries) + DMatrix::identity(n, n) * 0.05;
        let mut tableau = Tableau::new(t.clone());
        let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
        prop_assert!(solve(&mut tableau, &q0[..n], &mut g, &mut r).is_ok());
        let ends = [&q0, &q1].map(|q| q[..n].to_vec());
        let [from, to] = ends;
        let mut path = Path::new(&mut tableau, from, to, g, r, 1.0, 0.0).unwrap();
        let mut events = 0;
        while let PathEnd::Event(changes) = path.advance(&mut tableau, 1.0) {
            prop_assert!(!changes.is_empty());
            path.turn(&mut tableau).unwrap();
            events += 1;
            prop_assert!(events < 1 << n);
        }
        let end: Vec<f64> = (0..n).map(|k| q0[k] + q1[k]).collect();
        let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
        let mut direct = Tableau::new(t);
        prop_assert!(solve(&mut direct, &end, &mut g, &mut r).is_ok());
        for k in 0..n {
            prop_assert!((g[k] - path.gap[k]).abs() < 1e-9 && (r[k] - path.force[k]).abs() < 1e-9);
        }
    }
}

#[test]
fn flips_carry_gaps_and_forces_along() {
    let n = 7;
    let entries: Vec<f64> = (0..n * n)
        .map(|i| ((i * i * 7919) % 1013) as f64 / 1013.0 - 0.5)
        .collect();
    let mut tableau = Tableau::new(semidefinite(n, n, &entries));
    let q: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).cos()).collect();
    let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
    tableau.solve(&q, &mut gap, &mut force);
    let (mut solved_gap, mut solved_force) = (gap.clone(), force.clone());
    for k in [2, 5, 0, 2, 6, 0, 3, 5] {
        assert!(tableau.flip_with(k, &mut gap, &mut force));
        tableau.solve(&q, &mut solved_gap, &mut solved_force);
        let largest = |v: &[f64]| v.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        for (a, b) in [(&gap, &solved_gap), (&force, &solved_force)] {
            for (x, y) in a.iter().zip(b) {
                // Only a few pivots of a matrix whose condition number is far below 1e5.
                assert!((x - y).abs() <= 1e-10 * largest(b), "{k}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn sweeping_there_and_back_is_the_identity() {
    let t = semidefinite(
        5,
        7,
        &[0.3, -0.8, 0.5, 0.9, -0.2, 0.7, 0.1, -0.6, 0.4, 0.8, -0.9],
    );
    let mut tableau = Tableau::new(t.clone());
    for k in [0, 3, 4, 3, 0, 4] {
        assert!(tableau.flip(k));
    }
    assert!((DMatrix::from_fn(5, 5, |i, j| tableau.swept(i, j)) - t).amax() < 1e-13);
}

/// The record of a tableau that has undergone many pivots is repeated in few pivots, and the result
/// has the same bits.
#[test]
fn the_way_of_a_tableau_stays_short_enough_to_be_repeated() {
    let t = semidefinite(
        6,
        8,
        &[0.3, -0.8, 0.5, 0.9, -0.2, 0.7, 0.1, -0.6, 0.4, 0.8, -0.9],
    );
    let mut tableau = Tableau::new(t.clone());
    for i in 0..5000 {
        assert!(tableau.flip((i * i + i / 7) % 6));
    }
    let mut again = Tableau::new(t);
    assert!(again.replay(tableau.record()));
    assert_eq!(again.open(), tableau.open());
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        assert_eq!(again.swept(i, j), tableau.swept(i, j));
    }
}

#[test]
fn a_body_held_by_contact_alone_does_not_open_its_last_pair() {
    // Two springs in a row without a support: T is singular, only one pair may open.
    let t = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
    let mut tableau = Tableau::new(t.clone());
    let (mut g, mut r) = (vec![0.0; 2], vec![0.0; 2]);
    assert!(solve(&mut tableau, &[-1.0, 3.0], &mut g, &mut r).is_ok());
    check(&t, &[-1.0, 3.0], &g, &r);
    assert!(solve(&mut tableau, &[-1.0, 0.5], &mut g, &mut r).is_err());
}

/// Two springs in a row, supported by a third. If the third is a billionth as stiff, it is far
/// above round-off and holds the body; if it is a ten-trillionth as stiff, it does not.
#[test]
fn a_body_on_a_weak_spring_is_held() {
    for (weak, is_held) in [(1e-9, true), (1e-13, false)] {
        let t = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0 + weak]);
        let mut tableau = Tableau::new(t);
        assert!(tableau.flip(0));
        assert_eq!(tableau.flip(1), is_held, "{weak}");
    }
}

#[test]
fn ties_open_together() {
    let n = 40;
    let t = DMatrix::from_fn(n, n, |i, j| if i == j { 2.0 } else { 0.01 });
    let mut tableau = Tableau::new(t);
    let q0 = vec![1.0; n];
    let q1 = vec![-2.0; n];
    let mut path = Path::new(&mut tableau, q0.clone(), q1, vec![0.0; n], q0, 1.0, 0.0).unwrap();
    match path.advance(&mut tableau, 1.0) {
        PathEnd::Event(changes) => assert_eq!(changes.len(), n),
        PathEnd::Target => panic!("all pairs open halfway"),
    }
    path.turn(&mut tableau).unwrap();
    assert!(tableau.open().iter().all(|o| *o));
    assert_eq!(path.advance(&mut tableau, 1.0), PathEnd::Target);
    assert!(path.gap.windows(2).all(|w| (w[0] - w[1]).abs() < 1e-15));
}

/// Pair 1 stays at the border of both its conditions along the whole path, up to round-off of
/// either sign.
#[test]
fn a_pair_that_stays_at_the_border_does_not_hold_up_the_path() {
    let t = DMatrix::from_column_slice(3, 3, &[1.0, 0.0, 0.0, 0.0, 6.0, 1.0, 0.0, 1.0, 3.0]);
    for sign in [1.0, -1.0] {
        let start = [0.0, sign, 3.0 * sign];
        let rate: Vec<f64> = start.iter().map(|q| -2.0 * q).collect();
        let mut tableau = Tableau::new(t.clone());
        let (mut g, mut r) = (vec![0.0; 3], vec![0.0; 3]);
        assert!(solve(&mut tableau, &start, &mut g, &mut r).is_ok());
        let mut path = Path::new(&mut tableau, start.to_vec(), rate, g, r, 1.0, 0.0).unwrap();
        let mut events = 0;
        while path.advance(&mut tableau, 1.0) != PathEnd::Target {
            path.turn(&mut tableau).unwrap();
            events += 1;
            assert!(events <= 3);
        }
        check(&t, &start.map(|q| -q), &path.gap, &path.force);
    }
}

/// Opening seven pairs of a matrix of rank six: the seventh pivot is round-off, and closing the
/// pair again does not bring the digits back.
#[test]
fn digits_lost_in_a_pivot_of_round_off_come_back() {
    let (n, rank) = (9, 6);
    let entries = [
        -0.08297167943167987,
        -0.021156378019337965,
        -0.3500050637952132,
        -0.8999676126905674,
        0.820464551258182,
        -0.028817743074163155,
        0.20893207126316396,
        -0.9938943074393589,
        0.8124765721268841,
        0.03577892844817117,
        -0.6833037198269916,
        -0.19650324713861989,
        -0.6149074658169557,
        -0.32446572920264016,
        -0.6072399615922185,
        0.6340458224695367,
        -0.12457851268163009,
        0.6860930199261772,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.44116385049030826,
        -0.2310960232335664,
        -0.5709049537061461,
        -0.49046340190695525,
        -0.8166888557152281,
        -0.7081289415897551,
        0.13753401089641934,
        0.1244389186927036,
        0.43112429892405874,
        0.30870368225282147,
        -0.2791557852026966,
        -0.9127478146427469,
        0.6702848993513862,
        0.9343009793445947,
        -0.779553457924783,
        -0.06378147611175068,
        -0.7906401164343065,
        0.29932516438131357,
        -0.5454258772211972,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    ];
    let q = [
        -0.7210909273778294,
        -0.027296640523110708,
        -0.10755925481756491,
        0.0,
        0.0,
        -0.20305220220415326,
        -0.4153571928947017,
        -0.11106581222636731,
        -0.6300150059468915,
    ];
    let t = semidefinite(n, rank, &entries);
    let mut tableau = Tableau::new(t.clone());
    let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
    assert!(solve(&mut tableau, &q, &mut g, &mut r).is_ok());
    check(&t, &q, &g, &r);
}

/// Pair 0 stands at the border (no gap, no force), and its rate of -1e-13 is only the round-off of
/// the terms 1 and -1. When pair 2 opens half way, pair 0 stays as it is: a rate without a
/// meaningful sign is no change of contact.
#[test]
fn a_rate_of_round_off_is_no_event() {
    let t = DMatrix::from_row_slice(3, 3, &[2.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let mut tableau = Tableau::new(t);
    tableau.reset(&[false, true, false]);
    let start = vec![-1.0, -1.0, 1.0];
    let rate = vec![-1.0 - 1e-13, -1.0, -2.0];
    let (gap, force) = (vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0]);
    let mut path = Path::new(&mut tableau, start, rate, gap, force, 1.0, 1.0).unwrap();
    let end = path.advance(&mut tableau, 1.0);
    assert_eq!(end, PathEnd::Event(vec![Change::Opens(2)]));
    assert!((path.t - 0.5).abs() <= 1e-12, "{}", path.t);
}

/// Two blocks, and the whole matrix with zeros between them, give the same path, with events in
/// both blocks.
#[test]
fn groups_of_pairs_are_one_problem() {
    let own = |n: usize| {
        DMatrix::from_fn(n, n, |i, j| {
            if i == j {
                3.0
            } else {
                1.0 / (1 + i + j) as f64
            }
        })
    };
    let pairs = [vec![0, 2, 5], vec![1, 3, 4, 6]];
    let blocks = pairs.iter().map(|pairs| PairBlock {
        pairs: pairs.clone(),
        matrix: std::sync::Arc::new(own(pairs.len())),
    });
    let blocks = PairMatrix::new(blocks.collect());
    let whole = PairMatrix::from(blocks.dense());
    assert_eq!((blocks.n_entries(), whole.n_entries()), (9 + 16, 49));
    let q: Vec<f64> = (0..7).map(|k| (k as f64 * 2.3).sin()).collect();
    let rate: Vec<f64> = (0..7).map(|k| (k as f64 * 1.1).cos() * 2.0).collect();
    let run = |matrix: &PairMatrix| {
        let mut tableau = Tableau::new(matrix.clone());
        let (mut g, mut r) = (vec![0.0; 7], vec![0.0; 7]);
        solve(&mut tableau, &q, &mut g, &mut r).unwrap();
        check(&matrix.dense(), &q, &g, &r);
        let mut path = Path::new(&mut tableau, q.clone(), rate.clone(), g, r, 1.0, 1.0).unwrap();
        let mut events = Vec::new();
        while let PathEnd::Event(changes) = path.advance(&mut tableau, 2.0) {
            events.push(changes);
            path.turn(&mut tableau).unwrap();
        }
        (events, path.gap, path.force)
    };
    let (a, b) = (run(&blocks), run(&whole));
    assert!(a.0.len() >= 3, "{:?}", a.0);
    assert_eq!(a.0, b.0);
    for (a, b) in a.1.iter().chain(&a.2).zip(b.1.iter().chain(&b.2)) {
        // A few operations on numbers of order 1 to 10.
        assert!((a - b).abs() <= 1e-13, "{a} {b}");
    }
}
