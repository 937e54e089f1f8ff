//! `r = q + T g`, `g, r >= 0`, `g . r = 0` for random and adversarial T and q.

use brinell::contact::{Certificate, Tableau, solve};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Solves and checks the conditions to round-off: `rank`-dependent cancellation is bounded by the
/// condition of what is open.
pub fn checked(t: &DMatrix<f64>, q: &[f64], slack: f64) -> (Vec<f64>, Vec<f64>, Certificate) {
    let n = q.len();
    let mut tableau = Tableau::new(t.clone());
    let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
    let certificate = solve(&mut tableau, q, &mut g, &mut r).unwrap();
    check(t, q, &g, &r, slack);
    // Block pivoting is given up after 8 rounds without fewer violations, of which there are at
    // most n; the energy falls strictly from one set of open pairs to the next in the fallback, so
    // none returns.
    assert!(certificate.rounds <= 9 * (n + 1) + 1, "{certificate:?}");
    assert!(
        certificate.fallback_pivots <= n << n.min(40),
        "{certificate:?}"
    );
    for k in 0..n {
        if tableau.open()[k] {
            assert_eq!(r[k], 0.0);
        } else {
            assert_eq!(g[k], 0.0);
        }
    }
    (g, r, certificate)
}

/// The three conditions, relative to the size of the terms of `r = q + T g`.
pub fn check(t: &DMatrix<f64>, q: &[f64], g: &[f64], r: &[f64], slack: f64) {
    check_beside(0.0, t, q, g, r, slack);
}

/// As [`check`], for a `q` that is a difference of numbers as large as `terms`.
pub fn check_beside(terms: f64, t: &DMatrix<f64>, q: &[f64], g: &[f64], r: &[f64], slack: f64) {
    let n = q.len();
    let product = t * DVector::from_column_slice(g);
    let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let scale = largest(q).max(terms) + t.amax() * largest(g);
    for k in 0..n {
        assert!(g[k] >= 0.0 && r[k] >= 0.0, "pair {k}: {} {}", g[k], r[k]);
        assert!(g[k] == 0.0 || r[k] == 0.0, "pair {k}: {} {}", g[k], r[k]);
        let off = (r[k] - q[k] - product[k]).abs();
        let allowed = slack * f64::EPSILON * n as f64 * scale;
        assert!(
            off <= allowed,
            "pair {k}: off {off:.3e}, allowed {allowed:.3e}"
        );
    }
}

/// T = A A' of the given rank, A of small integers, so that singular matrices are exactly singular
/// and ties are exact.
fn matrix(n: usize, rank: usize, entries: &[i8]) -> DMatrix<f64> {
    let a = DMatrix::from_fn(n, rank, |i, j| f64::from(entries[i * rank + j]));
    &a * a.transpose()
}

/// A problem with a known solution: complementary gaps and forces of small integers, some of them
/// both zero.
fn problem() -> impl Strategy<Value = (DMatrix<f64>, Vec<f64>, Vec<f64>)> {
    (1usize..10, 1usize..10).prop_flat_map(|(n, rank)| {
        let entries = prop::collection::vec(-3i8..=3, n * rank);
        let sides = prop::collection::vec(-3i8..=3, n);
        (entries, sides).prop_map(move |(entries, sides)| {
            let t = matrix(n, rank, &entries);
            let g = DVector::from_fn(n, |k, _| f64::from(sides[k].max(0)));
            let r: Vec<f64> = sides.iter().map(|s| f64::from((-s).max(0))).collect();
            let product = &t * &g;
            let q = (0..n).map(|k| r[k] - product[k]).collect();
            (t, q, r)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    /// Definite or singular, with ties: a solution is found, and its forces are the known ones.
    /// With T semidefinite the forces of all solutions are the same (Cottle, Pang, Stone, theorem
    /// 3.1.7).
    #[test]
    fn forces_of_a_semidefinite_problem_are_found((t, q, expected) in problem()) {
        // Integers up to 9 * 9 * 10: the condition of what is open stays below 1e6.
        let (_, r, _) = checked(&t, &q, 1e6);
        let scale = q.iter().chain(&expected).fold(1.0f64, |m, x| m.max(x.abs()));
        for (k, (a, b)) in r.iter().zip(&expected).enumerate() {
            prop_assert!((a - b).abs() <= 1e-8 * scale, "pair {k}: {a} {b}");
        }
    }

    /// Scaling T by a power of two and q by another scales the solution exactly: no tolerance is
    /// absolute.
    #[test]
    fn scales_do_not_matter((t, q, _) in problem(), stiff in -40i32..40, load in -40i32..40) {
        let (s, l) = (2f64.powi(stiff), 2f64.powi(load));
        let (g, r, _) = checked(&t, &q, 1e6);
        let scaled: Vec<f64> = q.iter().map(|v| l * v).collect();
        let (gs, rs, _) = checked(&(s * &t), &scaled, 1e6);
        for k in 0..q.len() {
            prop_assert_eq!(gs[k], g[k] * l / s);
            prop_assert_eq!(rs[k], r[k] * l);
        }
    }

    /// Any start leads to the same forces.
    #[test]
    fn the_start_does_not_matter(
        (t, q, expected) in problem(),
        start in prop::collection::vec(any::<bool>(), 10),
    ) {
        let n = q.len();
        let mut tableau = Tableau::new(t.clone());
        tableau.reset(&start[..n]);
        let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
        solve(&mut tableau, &q, &mut g, &mut r).unwrap();
        check(&t, &q, &g, &r, 1e6);
        let scale = q.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        for (a, b) in r.iter().zip(&expected) {
            prop_assert!((a - b).abs() <= 1e-8 * scale);
        }
    }
}

/// Fathi's matrices `L L'`, L with 1 on and 2 below the diagonal: principal pivoting by least index
/// takes 2^n steps on them.
#[test]
fn fathi_matrices_end() {
    for n in [2, 5, 10, 16] {
        let l = DMatrix::from_fn(n, n, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Equal => 1.0,
            std::cmp::Ordering::Greater => 2.0,
            std::cmp::Ordering::Less => 0.0,
        });
        let t = &l * l.transpose();
        // Condition about 16^n for the largest, but the solution is g = e_1: q + T e_1 = (0, 1, 1,
        // ...).
        let (g, _, certificate) = checked(&t, &vec![-1.0; n], 1e4);
        assert!((g[0] - 1.0).abs() < 1e-10, "{g:?}");
        assert!(g[1..].iter().all(|v| v.abs() < 1e-10), "{g:?}");
        assert!(certificate.fallback_pivots < 1 << n, "{certificate:?}");
    }
}

/// Laplace's matrix with a load of alternating sign: half of the pairs change at once and back, a
/// cycle for codes that flip them all.
#[test]
fn alternating_loads_settle() {
    for n in [3usize, 8, 33, 120] {
        let t = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let q: Vec<f64> = (0..n)
            .map(|k| if k % 2 == 0 { -1.0 } else { 0.999 })
            .collect();
        // Condition about n^2.
        checked(&t, &q, 10.0 * (n * n) as f64);
    }
}

/// A rigid body on n springs' worth of pairs, nothing else: singular when all are open. Pressed it
/// is held, pulled it leaves.
#[test]
fn a_free_motion_is_held_or_named() {
    let n = 6;
    // Two rigid motions, translation and rotation, are in the null space.
    let x: Vec<f64> = (0..n).map(|k| k as f64 - 2.5).collect();
    let squares: f64 = x.iter().map(|v| v * v).sum();
    let t = DMatrix::from_fn(n, n, |i, j| {
        f64::from(i32::from(i == j)) - 1.0 / n as f64 - x[i] * x[j] / squares
    });
    checked(&t, &vec![1.0; n], 1e3);
    let mut q = vec![1.0; n];
    q[0] = -0.5;
    checked(&t, &q, 1e3);
    for q in [vec![-1.0; n], x.clone()] {
        // Pulled, and turned by a moment without a force: no forces >= 0 balance it.
        let mut tableau = Tableau::new(t.clone());
        let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
        let outcome = solve(&mut tableau, &q, &mut g, &mut r);
        assert!(outcome.is_err_and(|u| u.pair < n), "{q:?}: {g:?} {r:?}");
    }
}

/// Nothing to decide: no pairs; all forces zero.
#[test]
fn empty_and_zero_problems() {
    checked(&DMatrix::zeros(0, 0), &[], 1.0);
    let (g, r, certificate) = checked(&DMatrix::identity(4, 4), &[0.0; 4], 1.0);
    assert_eq!((g, r), (vec![0.0; 4], vec![0.0; 4]));
    assert_eq!(certificate.changes, 0);
}
