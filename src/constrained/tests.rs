use super::*;
use crate::ErrorKind;
use crate::contact::Change;
use crate::linalg::tests::backends;

/// Upper triangle of a chain of unit springs between `n` freedoms; a further unit spring ties each
/// freedom in `held` to the ground.
fn chain(n: usize, held: &[usize]) -> SymmetricCsc {
    let mut triplets = sprs::TriMatI::<f64, i64>::new((n, n));
    for i in 0..n {
        let mut own = f64::from(u8::from(held.contains(&i)));
        own += f64::from(u8::from(i > 0)) + f64::from(u8::from(i + 1 < n));
        triplets.add_triplet(i, i, own);
        if i > 0 {
            triplets.add_triplet(i - 1, i, -1.0);
        }
    }
    triplets.to_csc()
}

const CLOSE: f64 = 1e-12;

fn close(a: f64, b: f64) {
    assert!(
        (a - b).abs() <= CLOSE * a.abs().max(b.abs()).max(1.0),
        "{a} {b}"
    );
}

/// A bar of three unit springs, held at one end, with a wall at distance 1 from the other end. The
/// end moves by 3 f under an end load f, so it touches the wall at the load 1/3.
#[test]
fn a_bar_touches_a_wall_at_the_load_that_closes_its_gap() {
    for backend in backends() {
        let k = chain(3, &[0]);
        let mut bar = ConstrainedStructure::new(backend, &k, &[vec![(2, 1.0)]], &[1.0]).unwrap();
        close(bar.gaps()[0], 1.0);
        // The condensed stiffness of the end is that of three springs in a row.
        close(bar.condensed_stiffness()[(0, 0)], 1.0 / 3.0);
        close(bar.contact_matrix[(0, 0)], 1.0 / 3.0);
        bar.start(&[0.0, 0.0, 1.0]).unwrap();
        let event = bar.step(2.0).unwrap();
        close(event.t, 1.0 / 3.0);
        assert_eq!(event.changes, [Change::Closes(0)]);
        let event = bar.step(2.0).unwrap();
        assert!(event.changes.is_empty());
        // The wall carries the load beyond the one that closes the gap.
        close(bar.forces()[0], 2.0 - 1.0 / 3.0);
        let mut u = [0.0; 3];
        let backward_error = bar.displacements(&mut u).unwrap();
        for (u, expected) in u.iter().zip([1.0 / 3.0, 2.0 / 3.0, 1.0]) {
            close(*u, expected);
        }
        assert!(backward_error < 1e-14);
        // A direct solution gives the same force.
        bar.solve(&[0.0, 0.0, 2.0]).unwrap();
        close(bar.forces()[0], 2.0 - 1.0 / 3.0);
        assert_eq!(bar.open(), [false]);
    }
}

/// Two bars, the second of which is held by contact alone: K is singular.
#[test]
fn a_body_held_by_contact_alone_is_pushed_but_not_pulled() {
    for backend in backends() {
        // Freedoms 0..2 are held at 0, freedoms 3..5 float.
        let mut k = sprs::TriMatI::<f64, i64>::new((6, 6));
        for (value, (row, column)) in chain(3, &[0]).iter() {
            k.add_triplet(row as usize, column as usize, *value);
        }
        for (value, (row, column)) in chain(3, &[]).iter() {
            k.add_triplet(3 + row as usize, 3 + column as usize, *value);
        }
        let k: SymmetricCsc = k.to_csc();
        // g = u_3 - u_2 + 0.5 >= 0.
        let rows = [vec![(2, 1.0), (3, -1.0)]];
        let mut bars = ConstrainedStructure::new(backend, &k, &rows, &[0.5]).unwrap();
        bars.solve(&[0.0, 0.0, 0.0, 0.0, 0.0, -2.0]).unwrap();
        close(bars.forces()[0], 2.0);
        let mut u = [0.0; 6];
        bars.displacements(&mut u).unwrap();
        for (u, expected) in u.iter().zip([-2.0, -4.0, -6.0, -6.5, -8.5, -10.5]) {
            close(*u, expected);
        }
        let error = bars.solve(&[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unheld, "{error}");
        assert!(error.message().contains("row 0"));
    }
}

/// Rows with weights (a node between two others) fulfil the optimality conditions, whatever the
/// load.
#[test]
fn random_structures_fulfil_all_conditions() {
    let mut seed = 7u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for round in 0..20 {
        let n = 12;
        let k = chain(n, &[0, n - 1]);
        let rows: Vec<Vec<(usize, f64)>> = (0..4)
            .map(|i| {
                let share = random() + 0.5;
                vec![(3 * i, 1.0), (3 * i + 1, -share), (3 * i + 2, share - 1.0)]
            })
            .collect();
        let gaps: Vec<f64> = (0..4).map(|_| 0.2 * random()).collect();
        for backend in backends() {
            let mut structure = ConstrainedStructure::new(backend, &k, &rows, &gaps).unwrap();
            let load: Vec<f64> = (0..n).map(|_| random()).collect();
            structure.start(&load).unwrap();
            let mut events = 0;
            while !structure.step(1.0).unwrap().changes.is_empty() {
                events += 1;
                assert!(events < 50, "round {round}");
            }
            let along = structure.forces().to_vec();
            let mut u = vec![0.0; n];
            structure.displacements(&mut u).unwrap();
            let (g, r) = (structure.gaps().to_vec(), structure.forces().to_vec());
            let mut residual = vec![0.0; n];
            linalg::multiply(&k, &u, &mut residual);
            for i in 0..n {
                residual[i] -= load[i];
            }
            for (i, row) in rows.iter().enumerate() {
                assert!(
                    g[i] >= 0.0 && r[i] >= 0.0 && g[i] * r[i] == 0.0,
                    "round {round}"
                );
                let moved: f64 = row.iter().map(|(f, c)| c * u[*f]).sum();
                close(gaps[i] - moved, g[i]);
                for (f, c) in row {
                    residual[*f] += c * r[i];
                }
            }
            assert!(residual.iter().all(|v| v.abs() < 1e-12), "{residual:?}");
            // The end of the path equals the direct solution for the load at the end.
            structure.solve(&load).unwrap();
            for (a, b) in along.iter().zip(structure.forces()) {
                close(*a, *b);
            }
        }
    }
}

/// Two chains of springs end to end, the second stiffer by `ratio`: `1/T = 3/k_1 + 3/k_2`.
/// Whichever is listed first, `T` is no stiffer than the softer chain, to the last digits.
#[test]
fn the_softer_side_follows_whatever_the_ratio() {
    for backend in backends() {
        for ratio in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
            let mut k = sprs::TriMatI::<f64, i64>::new((6, 6));
            for (body, stiffness) in [(0, 1.0), (3, ratio)] {
                for (value, (row, column)) in chain(3, &[0]).iter() {
                    k.add_triplet(
                        body + row as usize,
                        body + column as usize,
                        stiffness * value,
                    );
                }
            }
            let k: SymmetricCsc = k.to_csc();
            let rows = [vec![(2, 1.0), (5, -1.0)]];
            let chains = ConstrainedStructure::new(backend, &k, &rows, &[0.0]).unwrap();
            let exact = 1.0 / (3.0 + 3.0 / ratio);
            let found = chains.contact_matrix[(0, 0)];
            assert!(
                (found / exact - 1.0).abs() < 1e-14,
                "{ratio:e}: {found:e} {exact:e}"
            );
        }
    }
}

/// Rows that share freedoms, so that no follower is in one row only. With all rows closed the chain
/// hangs on them, and their forces are those of equilibrium.
#[test]
fn rows_may_share_freedoms() {
    for backend in backends() {
        let k = chain(4, &[0]);
        // Rows that combine freedoms 0, 2 and 3 with different weights.
        let rows = [
            vec![(0, 1.0), (2, -0.5), (3, 0.25)],
            vec![(0, -1.0), (2, 2.0), (3, 1.0)],
            vec![(3, 1.0), (2, 1.0), (0, 0.5)],
        ];
        let mut tied = ConstrainedStructure::new(backend, &k, &rows, &[0.0; 3]).unwrap();
        let load = [0.3, 0.2, 0.5, 1.0];
        tied.solve(&load).unwrap();
        let (mut u, mut residual) = ([0.0; 4], [0.0; 4]);
        tied.displacements(&mut u).unwrap();
        linalg::multiply(&k, &u, &mut residual);
        for (i, row) in rows.iter().enumerate() {
            let moved: f64 = row.iter().map(|(f, b)| b * u[*f]).sum();
            close(-moved, tied.gaps()[i]);
            for (f, b) in row {
                residual[*f] += b * tied.forces()[i];
            }
        }
        for (r, f) in residual.iter().zip(load) {
            close(*r, f);
        }
        // T is the stiffness against displacements of the rows: (B K^-1 B')^-1.
        let mut inverse = DMatrix::zeros(4, 4);
        for j in 0..4 {
            let mut column = ConstrainedStructure::new(backend, &k, &[], &[]).unwrap();
            let mut unit = [0.0; 4];
            unit[j] = 1.0;
            column.solve(&unit).unwrap();
            let mut u = [0.0; 4];
            column.displacements(&mut u).unwrap();
            inverse.column_mut(j).copy_from_slice(&u);
        }
        let b = DMatrix::from_fn(3, 4, |i, f| {
            let entry = rows[i].iter().find(|(freedom, _)| *freedom == f);
            entry.map_or(0.0, |(_, b)| *b)
        });
        let unit = &b * inverse * b.transpose() * &*tied.contact_matrix;
        for i in 0..3 {
            for j in 0..3 {
                close(unit[(i, j)], if i == j { 1.0 } else { 0.0 });
            }
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let k = chain(3, &[0]);
    let new = |rows: &[Vec<(usize, f64)>], gaps: &[f64]| {
        ConstrainedStructure::new(Backend::Dense, &k, rows, gaps)
            .err()
            .unwrap()
    };
    for (error, word) in [
        (new(&[vec![(3, 1.0)]], &[0.0]), "freedom 3"),
        (new(&[vec![(2, 1.0)]], &[]), "0 gaps"),
        (new(&[vec![(2, 0.0)]], &[0.0]), "row 0 is zero"),
        (new(&[vec![(2, 1.0)]], &[f64::NAN]), "not finite"),
        (
            new(&[vec![(2, 1.0)], vec![(2, 2.0)]], &[0.0, 0.0]),
            "depend",
        ),
    ] {
        assert_eq!(error.kind(), ErrorKind::Input);
        assert!(error.message().contains(word), "{error}");
    }
    let free = chain(3, &[]);
    let error = ConstrainedStructure::new(Backend::Dense, &free, &[], &[])
        .err()
        .unwrap();
    assert_eq!(error.kind(), ErrorKind::Unheld);
    let mut bar = ConstrainedStructure::new(Backend::Dense, &k, &[vec![(2, 1.0)]], &[1.0]).unwrap();
    assert!(bar.solve(&[0.0]).is_err() && bar.solve(&[f64::NAN; 3]).is_err());
    assert!(bar.step(1.0).is_err());
    bar.start(&[0.0; 3]).unwrap();
    assert!(bar.step(-1.0).is_err() && bar.step(f64::NAN).is_err());
    assert!(bar.displacements(&mut [0.0]).is_err());
}

/// A clamped beam by finite differences, `1 -4 6 -4 1`: whole numbers, a condition of 1e10. The
/// load is exact for whole-number displacements, and the refined solution reproduces them exactly.
/// The plain solution loses half the digits.
#[test]
fn refined_displacements_are_right_to_the_last_digit() {
    let n = 500;
    let mut triplets = sprs::TriMatI::<f64, i64>::new((n, n));
    for j in 0..n {
        for (below, value) in [(2, 1.0), (1, -4.0), (0, 6.0)] {
            if j >= below {
                triplets.add_triplet(j - below, j, value);
            }
        }
    }
    let k: SymmetricCsc = triplets.to_csc();
    let exact: Vec<f64> = (0..n).map(|i| ((i * 7919) % 1000) as f64 - 500.0).collect();
    let mut load = vec![0.0; n];
    linalg::multiply(&k, &exact, &mut load);
    for backend in backends() {
        // A wall far away: no contact force.
        let rows = [vec![(n / 2, 1.0)]];
        let mut beam = ConstrainedStructure::new(backend, &k, &rows, &[1e6]).unwrap();
        beam.solve(&load).unwrap();
        assert_eq!(beam.forces(), [0.0]);
        let off = |u: &[f64]| {
            let each = u.iter().zip(&exact).map(|(a, b)| (a - b).abs() / 500.0);
            each.fold(0.0f64, f64::max)
        };
        let mut u = vec![0.0; n];
        beam.displacements(&mut u).unwrap();
        let plain = off(&u);
        assert!(plain > 1e-10, "{backend:?}: not hard enough, {plain:e}");
        let refined = beam.refined_displacements(&mut u).unwrap();
        assert_eq!(off(&u), 0.0, "{backend:?}: {refined:?}");
        assert!(refined.steps >= 1 && refined.first > 1e-11, "{refined:?}");
    }
}

/// Displacements fulfil the condition of a closed row, with or without refinement.
#[test]
fn refined_displacements_meet_a_closed_row() {
    for backend in backends() {
        let k = chain(4, &[0]);
        let rows = [vec![(3, 1.0)]];
        let mut bar = ConstrainedStructure::new(backend, &k, &rows, &[0.5]).unwrap();
        bar.solve(&[0.0, 0.0, 0.0, 1.0]).unwrap();
        let (mut plain, mut refined) = ([0.0; 4], [0.0; 4]);
        bar.displacements(&mut plain).unwrap();
        bar.refined_displacements(&mut refined).unwrap();
        for (k, (a, b)) in plain.iter().zip(&refined).enumerate() {
            close(*a, 0.125 * (k + 1) as f64);
            close(*b, 0.125 * (k + 1) as f64);
        }
    }
}

#[test]
fn a_matrix_is_the_same_in_every_layout() {
    let expected = SymmetricCsc::new_csc(
        (3, 3),
        vec![0, 1, 3, 5],
        vec![0, 0, 1, 1, 2],
        vec![2.0, -1.0, 2.0, -1.0, 1.0],
    );
    let upper = stiffness_from_csc(
        3,
        &[0usize, 1, 3, 5],
        &[0u8, 0, 1, 1, 2],
        &[2.0, -1.0, 2.0, -1.0, 1.0],
        Triangle::Upper,
    );
    // Rows in descending order, the last entry split into two halves.
    let lower = stiffness_from_csc(
        3,
        &[0i32, 2, 4, 6],
        &[1i64, 0, 2, 1, 2, 2],
        &[-1.0, 2.0, -1.0, 2.0, 0.5, 0.5],
        Triangle::Lower,
    );
    let both = stiffness_from_csc(
        3,
        &[0i64, 2, 5, 8],
        &[1i32, 0, 2, 1, 0, 2, 1, 2],
        &[-1.0, 2.0, -1.0, 2.0, -1.0, 0.5, -1.0, 0.5],
        Triangle::Both,
    );
    for found in [upper, lower, both] {
        assert_eq!(found.unwrap(), expected);
    }
    for (starts, rows) in [
        (&[0i64, 1, 2, 3] as &[i64], &[0i64, 1, 3] as &[i64]),
        (&[0, 1, 2, 3], &[0, -1, 2]),
        (&[0, 2, 1, 3], &[0, 1, 2]),
        (&[0, -1, 2, 3], &[0, 1, 2]),
        (&[0, 1, 3], &[0, 1, 2]),
        (&[], &[0, 1, 2]),
        (&[0, 1, 2, 3], &[0, 1, 1]),
    ] {
        let found = stiffness_from_csc(3, starts, rows, &[1.0; 3], Triangle::Lower);
        assert_eq!(
            found.unwrap_err().kind(),
            ErrorKind::Input,
            "{starts:?} {rows:?}"
        );
    }
}

#[test]
fn gaps_that_are_kept_stay_those_of_their_state() {
    let k = stiffness_from_csc(1, &[0, 1], &[0], &[1.0], Triangle::Both).unwrap();
    let mut spring =
        ConstrainedStructure::with_owned(Backend::Dense, k, &[vec![(0, 1.0)]], &[1.0]).unwrap();
    let without_load = spring.shared_gaps();
    spring.solve(&[3.0]).unwrap();
    let pressed = (spring.shared_gaps(), spring.shared_forces());
    assert!(std::ptr::eq(pressed.0.as_slice(), spring.gaps()));
    spring.start(&[-3.0]).unwrap();
    while !spring.step(1.0).unwrap().changes.is_empty() {}
    let close = |values: &[f64], expected: f64| (values[0] - expected).abs() < 1e-14;
    assert!(close(spring.gaps(), 1.0) && close(&without_load, 1.0));
    assert!(close(&pressed.0, 0.0) && close(&pressed.1, 2.0));
}
