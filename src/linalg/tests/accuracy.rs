//! Tests of condition, backward error and refinement.

use super::*;
use crate::linalg::{
    componentwise_backward_error, condition, refine, smallest_pivot_ratio, solve_whole,
    twofold_residual,
};

/// Bending of a clamped beam by finite differences, `1 -4 6 -4 1`: entries are whole numbers, the
/// condition grows with `n^4`.
fn beam(n: usize) -> SymmetricCsc {
    let mut k = sprs::TriMatI::<f64, i64>::new((n, n));
    for j in 0..n {
        for (i, value) in [
            (j.wrapping_sub(2), 1.0),
            (j.wrapping_sub(1), -4.0),
            (j, 6.0),
        ] {
            if i <= j {
                k.add_triplet(i, j, value);
            }
        }
    }
    k.to_csc()
}

fn whole(n: usize) -> Partition {
    Partition {
        n,
        zone: vec![3, 4, 7],
        contact: vec![5, n - 1],
    }
}

/// Whole numbers as the exact solution, with their exact load.
fn exact(k: &SymmetricCsc) -> (Vec<f64>, Vec<f64>) {
    let mut numbers = Numbers::new(7);
    let x: Vec<f64> = (0..k.rows())
        .map(|_| (1000.0 * numbers.next()).round())
        .collect();
    let mut load = vec![0.0; x.len()];
    multiply(k, &x, &mut load);
    (x, load)
}

fn error(x: &[f64], exact: &[f64]) -> f64 {
    let largest = exact.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let off = x.iter().zip(exact).map(|(a, b)| (a - b).abs());
    off.fold(0.0f64, f64::max) / largest
}

/// Plain refinement stops at round-off times the condition, however often it is repeated, although
/// its backward error is as small as possible. A residual in twice the precision goes on to the
/// last bit.
#[test]
fn refinement_goes_on_where_the_plain_one_stalls() {
    let k = beam(600);
    let (x, load) = exact(&k);
    for backend in backends() {
        let partition = whole(600);
        let condensed = condense(backend, &k, &partition, &[]).unwrap();
        let held = condensed.contact_stiffness().dense().cholesky();
        let solve = |x: &mut [f64]| solve_whole(&*condensed, &partition, held.as_ref(), x);
        let mut u = load.clone();
        solve(&mut u).unwrap();
        let mut plain = u.clone();
        let mut best = f64::INFINITY;
        for _ in 0..10 {
            best = best.min(error(&plain, &x));
            let mut step = vec![0.0; load.len()];
            multiply(&k, &plain, &mut step);
            step.iter_mut().zip(&load).for_each(|(r, f)| *r = f - *r);
            solve(&mut step).unwrap();
            plain.iter_mut().zip(&step).for_each(|(u, du)| *u += du);
        }
        assert!(best > 1e-10, "{backend:?}: not hard enough, {best:e}");
        let backward = componentwise_backward_error(&k, &load, &plain);
        assert!(backward < 1e-14, "{backend:?}: {backward:e}");

        let before = error(&u, &x);
        let refined = refine(&mut u, |u| twofold_residual(&k, &load, u), solve).unwrap();
        assert_eq!(error(&u, &x), 0.0, "{backend:?}: {refined:?}");
        assert!((1..=8).contains(&refined.steps), "{refined:?}");
        // The first correction is the error of the unrefined solution.
        assert!(
            (refined.first / before - 1.0).abs() < 0.01,
            "{refined:?} {before:e}"
        );
        assert_eq!(componentwise_backward_error(&k, &load, &u), 0.0);
    }
}

/// Compares with `|B|_1 |B^-1|_1` from the inverse, in cases in which the estimate could go wrong:
/// graded, shifted, random.
#[test]
fn the_condition_is_estimated_within_a_factor_of_three() {
    let mut cases: Vec<(SymmetricCsc, Partition, Vec<f64>)> = vec![
        (beam(60), whole(60), vec![]),
        (beam(200), whole(200), vec![]),
    ];
    for seed in 0..8 {
        let n = 40 + 5 * seed as usize;
        let singular = laplacian(n, 3, 0.0, seed);
        cases.push((
            singular,
            whole(n),
            vec![1e-3 * 10f64.powi(seed as i32 % 4), 2.0],
        ));
        cases.push((
            laplacian(n, 3, 10f64.powi(-(seed as i32)), seed),
            whole(n),
            vec![],
        ));
    }
    for (k, partition, shift) in &cases {
        let mut b = full(k);
        for (&freedom, d) in partition.contact.iter().zip(shift) {
            b[(freedom, freedom)] += d;
        }
        let root = b.diagonal().map(f64::sqrt);
        let n = b.nrows();
        let scaled = DMatrix::from_fn(n, n, |i, j| b[(i, j)] / (root[i] * root[j]));
        let norm = |m: &DMatrix<f64>| m.column_iter().map(|c| c.lp_norm(1)).fold(0.0, f64::max);
        let inverse = scaled.clone().cholesky().unwrap().inverse();
        let exact = norm(&scaled) * norm(&inverse);
        for backend in backends() {
            let condensed = condense(backend, k, partition, shift).unwrap();
            let here = k.clone().into();
            let estimate = condition(&*condensed, &here, partition, shift).unwrap();
            assert!(
                estimate <= exact * (1.0 + 1e-5) && estimate >= exact / 3.0,
                "{backend:?} n = {n}: {estimate:e}, exact {exact:e}"
            );
        }
    }
}

/// The loss of a pivot to cancellation is a lower bound of the condition, but may show nothing: a
/// beam's pivots look harmless.
#[test]
fn pivots_alone_do_not_show_a_bad_condition() {
    let k = beam(200);
    let partition = whole(200);
    let condensed = condense(Backend::Dense, &k, &partition, &[]).unwrap();
    let pivot = condensed.weakest_pivot().ratio;
    let estimate = condition(&*condensed, &k.into(), &partition, &[]).unwrap();
    assert!(pivot > smallest_pivot_ratio(200));
    assert!(
        1.0 / pivot <= estimate * (1.0 + 1e-6),
        "{pivot:e} {estimate:e}"
    );
    assert!(
        estimate > 1e6 && 1.0 / pivot < 1e-2 * estimate,
        "{pivot:e} {estimate:e}"
    );
}

/// A wrong row shows in full, however small it is compared with the others.
#[test]
fn the_componentwise_error_sees_a_small_row() {
    let mut k = sprs::TriMatI::<f64, i64>::new((2, 2));
    k.add_triplet(0, 0, 1e12);
    k.add_triplet(1, 1, 1.0);
    let k = k.to_csc();
    let load = [1e12, 1.0];
    let omega = componentwise_backward_error(&k, &load, &[1.0, 1.5]);
    assert!((omega - 0.5 / 2.5).abs() < 1e-15, "{omega}");
    assert_eq!(componentwise_backward_error(&k, &load, &[1.0, 1.0]), 0.0);
    assert!(componentwise_backward_error(&k, &load, &[f64::NAN, 1.0]).is_nan());
    // Almost no load and almost no displacement: round-off there is no error.
    assert!(componentwise_backward_error(&k, &[1e12, 0.0], &[1.0, 1e-17]) < 1e-16);
}

/// The pass over the matrix in parts gives each row the sum of its own entries, however far from
/// the diagonal they lie, up to the round-off of the row. If a row hardly moves, the error is
/// measured by its own stiffness.
#[test]
fn the_pass_in_parts_gives_every_row_its_own() {
    use crate::linalg::row_sums::RowSums;
    let mut numbers = Numbers::new(3);
    for n in [1, 2, 3, 7, 400] {
        let mut k = sprs::TriMatI::<f64, i64>::new((n, n));
        for j in 0..n {
            k.add_triplet(j, j, 4.0 + numbers.next());
            for _ in 0..6 {
                let i = numbers.integer() as usize % n;
                // Every third row is coupled only with rows of its kind.
                if i < j && i.is_multiple_of(3) == j.is_multiple_of(3) {
                    k.add_triplet(i, j, numbers.next());
                }
            }
        }
        let k: SymmetricCsc = k.to_csc();
        let whole = full(&k);
        for still in [false, true] {
            let mut u: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
            if still {
                (0..n).step_by(3).for_each(|i| u[i] *= 1e-17);
            }
            let mut f = vec![0.0; n];
            multiply(&k, &u, &mut f);
            f.iter_mut().for_each(|f| *f *= 1.0 + 1e-6 * numbers.next());
            if still {
                // No load acts in a third of the rows: their displacements are round-off.
                (0..n).step_by(3).for_each(|i| f[i] = 0.0);
            }
            let rows = RowSums::new(&k, &f, &u);
            let moved = u.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            let tiny = 1000.0 * n as f64 * f64::EPSILON;
            let mut worst = 0.0f64;
            for i in 0..n {
                let row = whole.row(i);
                let products = || row.iter().zip(&u).map(|(a, u)| a * u);
                let terms: f64 = products().map(f64::abs).sum();
                let residual = f[i] - products().sum::<f64>();
                let round_off = 2.0 * n as f64 * f64::EPSILON * (terms + f[i].abs());
                assert!((rows.terms[i] - terms).abs() <= round_off, "{n} {i}");
                assert!((rows.residual[i] - residual).abs() <= round_off, "{n} {i}");
                let stiffness: f64 = row.iter().map(|a| a.abs()).sum();
                let own = rows.terms[i] + f[i].abs();
                let scale = if own > tiny * (stiffness * moved + f[i].abs()) {
                    own
                } else {
                    rows.terms[i] + stiffness * moved
                };
                if rows.residual[i] != 0.0 {
                    worst = worst.max(rows.residual[i].abs() / scale);
                }
            }
            let found = rows.componentwise_error(&f, &u);
            // Row sums are added in another order.
            let slack = 8.0 * n as f64 * f64::EPSILON;
            assert!(
                (found / worst - 1.0).abs() <= slack,
                "{n} {still}: {found} {worst}"
            );
            u[n / 2] = f64::NAN;
            let lost = RowSums::new(&k, &f, &u);
            assert!(lost.componentwise_error(&f, &u).is_nan());
        }
    }
}
