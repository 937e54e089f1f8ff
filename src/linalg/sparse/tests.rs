//! Tests of every sparse backend, in any ordering and storage; the dense backend is the reference.

mod bodies;
mod changed;

use super::*;
use crate::linalg::dense::DenseCondensed;
use crate::linalg::solve_whole;
use crate::linalg::tests::matrices::{Grid, Support};
use crate::linalg::tests::{
    Numbers, SHARES, Sample, assert_condensation_is_the_plain_solve, distance, laplacian, norm,
    partition, solved,
};

/// Ways in which ordering and storage are chosen by cost, as in a run.
fn chosen() -> impl Iterator<Item = Way> {
    ways().into_iter().filter(|way| way.is_chosen)
}

type Condense = fn(&SymmetricCsc, &Partition, &[f64]) -> Result<Box<dyn Condensed>>;

/// A backend with an ordering and a storage.
pub(in crate::linalg) struct Way {
    pub(in crate::linalg) name: &'static str,
    /// Whether a run uses this way.
    pub(in crate::linalg) is_chosen: bool,
    pub(in crate::linalg) condense: Condense,
}

/// All ways that this build contains.
fn ways() -> Vec<Way> {
    let mut all = Vec::new();
    #[cfg(feature = "cholmod")]
    all.extend(crate::linalg::cholmod::tests::ways());
    #[cfg(feature = "faer")]
    all.extend(crate::linalg::faer::tests::ways());
    #[cfg(feature = "mumps")]
    all.extend(crate::linalg::mumps::tests::ways());
    all
}

/// Compares every method of the trait with the dense backend, to round-off.
pub(in crate::linalg) fn assert_agrees(sample: &Sample, condensed: &dyn Condensed) {
    let Sample {
        matrix,
        partition,
        shift,
        ..
    } = sample;
    let dense = DenseCondensed::new(matrix, partition, shift).unwrap();
    let tolerance = sample.tolerance();
    let c = condensed.contact_stiffness().dense();
    // C + D is as large as K + D, so its errors stay in C when D is subtracted.
    let difference = (&c - dense.contact_stiffness().dense()).norm();
    assert!(difference <= tolerance * sample.largest);
    assert_eq!(c, c.transpose());

    let (n_zone, n_contact) = (partition.zone.len(), partition.contact.len());
    let mut numbers = Numbers::new(77);
    let load = numbers.vector(partition.n);
    let f_z = numbers.vector(n_zone);
    let f_c = numbers.vector(n_contact);
    let u_c = numbers.vector(n_contact);
    // |S_zz^-1| and |K_ii^-1| are at most 1 / smallest; S and K at most `largest`.
    let force = norm(&load) + norm(&f_z) + norm(&f_c);
    let force_tolerance = tolerance * sample.condition() * force;
    let displacement_tolerance =
        tolerance * (force / sample.smallest + sample.condition() * norm(&u_c));
    let both: [&dyn Condensed; 2] = [condensed, &dense];

    let [a, b] = both.map(|backend| {
        let (mut zone, mut contact) = (vec![0.0; n_zone], vec![0.0; n_contact]);
        let reduced = backend.reduce_load(&load).unwrap();
        backend
            .condense_load(&reduced, &mut zone, &mut contact)
            .unwrap();
        [zone, contact].concat()
    });
    assert!(distance(&a, &b) <= force_tolerance);

    let [a, b] = both.map(|backend| {
        let (mut zone, mut contact) = (f_z.clone(), f_c.clone());
        backend.eliminate_zone(&mut zone, &mut contact);
        backend.recover_zone(&mut zone, &u_c);
        (zone, contact)
    });
    assert!(distance(&a.0, &b.0) <= displacement_tolerance);
    assert!(distance(&a.1, &b.1) <= force_tolerance);
}

#[test]
fn all_of_it_agrees_with_the_dense_backend() {
    for (seed, &(zone, contact)) in SHARES.iter().enumerate() {
        let seed = seed as u64 + 11;
        for (n, held) in [(20, true), (100, true), (100, false)] {
            let partition = partition(n, zone, contact, seed);
            if !held && partition.contact.is_empty() {
                continue;
            }
            let ground = if held { 0.5 } else { 0.0 };
            let shift = if held {
                vec![]
            } else {
                (0..partition.contact.len())
                    .map(|k| 1.0 + k as f64 / 8.0)
                    .collect()
            };
            let sample = Sample::new(laplacian(n, 4, ground, seed), partition, shift);
            for Way { name, condense, .. } in ways() {
                let Sample {
                    matrix,
                    partition,
                    shift,
                    ..
                } = &sample;
                let condensed = condense(matrix, partition, shift).expect(name);
                assert_agrees(&sample, &*condensed);
                assert_condensation_is_the_plain_solve(&sample, &*condensed);
            }
        }
    }
}

#[test]
fn an_elastic_body_agrees_with_the_dense_backend() {
    let grid = Grid::<2>::new([10, 12], Support::Bottom);
    let contact = grid.freedoms(1..2, |[x, y]| y == 12 && (3..=7).contains(&x));
    let mut zone = grid.freedoms(0..2, |[x, y]| y > 7 && (2..=8).contains(&x));
    zone.retain(|freedom| !contact.contains(freedom));
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    let stiffness = grid.stiffness(|[_, y]| if y < 5 { 3.0 } else { 1.0 });
    let sample = Sample::new(stiffness, partition, vec![]);
    for Way { name, condense, .. } in ways() {
        let condensed = condense(&sample.matrix, &sample.partition, &[]).expect(name);
        assert_agrees(&sample, &*condensed);
    }
}

#[test]
fn the_trailing_solve_is_the_full_solve_on_a_large_grid() {
    let grid = Grid::<2>::new([100, 100], Support::Bottom);
    let contact = grid.freedoms(1..2, |[x, y]| y == 100 && (35..=65).contains(&x));
    let mut zone = grid.freedoms(0..2, |[x, y]| y > 75 && (30..=70).contains(&x));
    zone.retain(|freedom| !contact.contains(freedom));
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    let matrix = grid.stiffness(|_| 1.0);
    for Way { name, condense, .. } in chosen() {
        let condensed = condense(&matrix, &partition, &[]).expect(name);
        assert_trailing_is_full(&grid, &matrix, &partition, &*condensed);
    }
}

fn assert_trailing_is_full(
    grid: &Grid<2>,
    matrix: &SymmetricCsc,
    partition: &Partition,
    condensed: &dyn Condensed,
) {
    // Load on the zone and on the contact freedoms, which then move freely.
    let mut load = vec![0.0; grid.n];
    let mut numbers = Numbers::new(3);
    for &freedom in partition.zone.iter().chain(&partition.contact) {
        load[freedom] = numbers.next();
    }
    let at = |u: &[f64], list: &[usize]| list.iter().map(|&f| u[f]).collect::<Vec<_>>();
    let (mut zone, mut contact) = (at(&load, &partition.zone), at(&load, &partition.contact));
    // A load on trailing freedoms alone is its own condensed load.
    let (mut f_z, mut f_c) = (vec![0.0; zone.len()], vec![0.0; contact.len()]);
    let reduced = condensed.reduce_load(&load).unwrap();
    condensed
        .condense_load(&reduced, &mut f_z, &mut f_c)
        .unwrap();
    let condition = condition(condensed, matrix, partition);
    let tolerance = (grid.n as f64).sqrt() * f64::EPSILON * condition;
    assert!(distance(&f_z, &zone) <= tolerance * norm(&load));
    assert!(distance(&f_c, &contact) <= tolerance * norm(&load));

    condensed.eliminate_zone(&mut zone, &mut contact);
    let right = nalgebra::DVector::from_column_slice(&contact);
    let u_c = condensed
        .contact_stiffness()
        .dense()
        .cholesky()
        .unwrap()
        .solve(&right);
    condensed.recover_zone(&mut zone, u_c.as_slice());
    let found = solved(condensed, matrix, partition, &load, u_c.as_slice());
    let u = found.u;
    assert!(distance(&zone, &at(&u, &partition.zone)) <= tolerance * norm(&zone));
    let moved = at(&u, &partition.contact);
    assert!(distance(u_c.as_slice(), &moved) <= tolerance * norm(&moved));
    assert!(found.backward_error <= 10.0 * f64::EPSILON);
}

/// Estimates the 2-norm condition by a few steps of the power method on `K` and on its inverse. The
/// estimate is a lower bound; twenty steps suffice for the well separated ends of such a spectrum.
fn condition(condensed: &dyn Condensed, matrix: &SymmetricCsc, partition: &Partition) -> f64 {
    let n = matrix.rows();
    let (mut x, mut y) = (Numbers::new(9).vector(n), vec![0.0; n]);
    let mut largest = 0.0;
    let mut inverse = 0.0;
    for _ in 0..20 {
        crate::linalg::multiply(matrix, &x, &mut y);
        largest = norm(&y) / norm(&x);
        let scale = 1.0 / norm(&y);
        x.iter_mut().zip(&y).for_each(|(x, y)| *x = y * scale);
    }
    x = Numbers::new(9).vector(n);
    let held = condensed.contact_stiffness().dense().cholesky();
    for _ in 0..20 {
        y.copy_from_slice(&x);
        solve_whole(condensed, partition, held.as_ref(), &mut y).unwrap();
        inverse = norm(&y) / norm(&x);
        let scale = 1.0 / norm(&y);
        x.iter_mut().zip(&y).for_each(|(x, y)| *x = y * scale);
    }
    largest * inverse
}

#[test]
fn refinement_keeps_the_backward_error_at_round_off() {
    // Stiff and soft layers: the stiffness of elements differs by a factor of 1e8.
    let grid = Grid::<2>::new([30, 30], Support::Bottom);
    let partition = Partition {
        n: grid.n,
        zone: grid.freedoms(0..2, |[_, y]| y > 24),
        contact: vec![],
    };
    let matrix = grid.stiffness(|[x, y]| if (x + y) % 3 == 0 { 1e8 } else { 1.0 });
    for Way { name, condense, .. } in ways() {
        let condensed = condense(&matrix, &partition, &[]).expect(name);
        let load = Numbers::new(4).vector(grid.n);
        let found = solved(&*condensed, &matrix, &partition, &load, &[]);
        assert!(found.backward_error <= 4.0 * f64::EPSILON);
        // Without a load nothing moves.
        let found = solved(&*condensed, &matrix, &partition, &vec![0.0; grid.n], &[]);
        assert_eq!(norm(&found.u), 0.0);
        assert_eq!(found.backward_error, 0.0);
    }
}

#[test]
fn displacements_that_do_not_belong_to_the_load_show_in_the_backward_error() {
    let n = 40;
    let matrix = laplacian(n, 2, 0.5, 8);
    let partition = partition(n, 0.2, 0.2, 8);
    let shift = vec![1.0; partition.contact.len()];
    for Way { name, condense, .. } in ways() {
        let condensed = condense(&matrix, &partition, &shift).expect(name);
        let u_c = vec![-50.0; shift.len()];
        let found = solved(&*condensed, &matrix, &partition, &vec![1.0; n], &u_c);
        assert!(found.backward_error > 1e-3);
    }
}

/// The backward substitution by subtrees gives the result of the whole, with the same bits for any
/// number of threads, whichever part of the zone is chosen.
pub(in crate::linalg) fn assert_subtrees_are_solved_like_the_whole<F: LowerFactor>(
    condense: impl Fn(&SymmetricCsc, &Partition) -> SparseCondensed<F>,
) {
    let grid = Grid::<2>::new([160, 160], Support::Bottom);
    let contact = grid.freedoms(1..2, |[_, y]| y == 160);
    let mut zone = grid.freedoms(0..2, |[_, y]| y > 100);
    zone.retain(|freedom| !contact.contains(freedom));
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    let matrix = grid.stiffness(|_| 1.0);
    let mut condensed = condense(&matrix, &partition);
    assert!(condensed.solver().triangular.n_subtrees() > 4);
    // Given displacements and the load that causes them.
    let whole = Numbers::new(8).vector(grid.n);
    let mut load = vec![0.0; grid.n];
    crate::linalg::multiply(&matrix, &whole, &mut load);
    let tolerance =
        (grid.n as f64).sqrt() * f64::EPSILON * condition(&condensed, &matrix, &partition);
    for stride in [1, 5] {
        let wanted: Vec<usize> = partition.zone.iter().copied().step_by(stride).collect();
        let zone = condensed.choose_zone(&wanted).unwrap().unwrap();
        let at = |list: &[usize]| list.iter().map(|&f| whole[f]).collect::<Vec<_>>();
        let (u_z, u_c) = (at(&zone), at(&partition.contact));
        let reduced = condensed.reduce_load(&load).unwrap();
        let solve = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap()
                .install(|| condensed.recover_all(&reduced, &u_z, &u_c).unwrap())
        };
        let u = solve(1);
        assert!(distance(&u, &whole) <= tolerance * norm(&whole));
        assert_eq!(u, solve(3));

        // The zone is solved separately: the load is condensed, eliminated, recovered.
        assert!(condensed.trailing.n_subtrees() > 2);
        let trailing = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                let (mut f_z, mut f_c) = (vec![0.0; zone.len()], vec![0.0; u_c.len()]);
                condensed
                    .condense_load(&reduced, &mut f_z, &mut f_c)
                    .unwrap();
                condensed.eliminate_zone(&mut f_z, &mut f_c);
                condensed.recover_zone(&mut f_z, &u_c);
                (f_z, f_c)
            })
        };
        let (z, c) = trailing(1);
        assert!(distance(&z, &u_z) <= tolerance * norm(&whole));
        // The remaining force on the contact freedoms is C u_c.
        let force =
            condensed.contact_stiffness().dense() * nalgebra::DVector::from_column_slice(&u_c);
        assert!(distance(force.as_slice(), &c) <= tolerance * norm(&load));
        assert_eq!((z, c), trailing(3));
    }
}

#[test]
fn calls_from_several_threads_give_the_same_bits() {
    let grid = Grid::<2>::new([40, 40], Support::Bottom);
    let contact = grid.freedoms(1..2, |[_, y]| y == 40);
    let mut zone = grid.freedoms(0..2, |[_, y]| y > 20);
    zone.retain(|freedom| !contact.contains(freedom));
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    for Way { name, condense, .. } in ways() {
        let condensed = condense(&grid.stiffness(|_| 1.0), &partition, &[]).expect(name);
        let load = Numbers::new(6).vector(partition.zone.len());
        let solve = || {
            let mut zone = load.clone();
            let mut contact = vec![0.0; partition.contact.len()];
            condensed.eliminate_zone(&mut zone, &mut contact);
            condensed.recover_zone(&mut zone, &contact);
            zone
        };
        let expected = solve();
        assert!(norm(&expected) > 0.0);
        std::thread::scope(|scope| {
            let runs: Vec<_> = (0..4).map(|_| scope.spawn(solve)).collect();
            for run in runs {
                assert_eq!(run.join().unwrap(), expected);
            }
        });
    }
}

#[test]
fn an_indefinite_pivot_is_named_by_every_way() {
    let grid = Grid::<2>::new([12, 12], Support::Bottom);
    let contact = grid.freedoms(1..2, |[_, y]| y == 12);
    let stiffness = grid.stiffness(|_| 1.0);
    for freedom in [0, 77, contact[3], grid.n - 2] {
        // A negative diagonal entry makes the pivot negative wherever it is eliminated.
        let mut matrix = stiffness.clone();
        let diagonal = matrix.proper_indptr()[freedom + 1] as usize - 1;
        matrix.data_mut()[diagonal] = -1.0;
        let partition = Partition {
            n: grid.n,
            zone: (60..90).collect(),
            contact: contact.clone(),
        };
        // MUMPS does not report its pivots.
        for Way { name, condense, .. } in ways().into_iter().filter(|w| w.name != "mumps") {
            let error = condense(&matrix, &partition, &[]).err().expect(name);
            let expected = format!("freedom {freedom}");
            assert!(error.message().ends_with(&expected), "{name}: {error}");
        }
    }
}

#[test]
fn kernels_of_every_width_do_what_they_say() {
    let mut numbers = Numbers::new(21);
    for width in 1..=PANEL {
        for m in [0, 1, 3, 4, 7, 16, 33] {
            let rectangle = numbers.vector(width * m);
            let mut tiles = Vec::new();
            panel::store_rectangle(m, width, |j| &rectangle[j * m..(j + 1) * m], &mut tiles);
            assert_eq!(tiles.len(), width * m);
            let x = numbers.vector(width);
            let y = numbers.vector(m);
            // Two orders of summation: twice the number of terms in rounding errors.
            let tolerance = |terms: usize| 2.0 * terms as f64 * f64::EPSILON;

            let mut product = vec![1.0; m];
            panel::multiply(&tiles, &x, &mut product);
            for i in 0..m {
                let sum: f64 = (0..width).map(|j| rectangle[j * m + i] * x[j]).sum();
                assert!((product[i] - sum).abs() <= tolerance(width) * width as f64);
            }
            let mut difference = x.clone();
            panel::subtract_transposed(&tiles, &y, &mut difference);
            for j in 0..width {
                let sum: f64 = (0..m).map(|i| rectangle[j * m + i] * y[i]).sum();
                assert!((difference[j] - (x[j] - sum)).abs() <= tolerance(m + 1) * (m + 1) as f64);
            }
        }
        // Diagonally dominant, so that the inverse is small: x -> L x -> L^-1 L x.
        let columns: Vec<Vec<f64>> = (0..width)
            .map(|j| {
                let below = numbers.vector(width - j - 1);
                let small = below.iter().map(|l| l / width as f64);
                std::iter::once(2.0).chain(small).collect()
            })
            .collect();
        let at = |i: usize, j: usize| columns[j][i - j];
        let mut triangle = Vec::new();
        panel::store_triangle(width, |j| &columns[j], &mut triangle);
        assert_eq!(triangle.len(), panel::triangle_len(width));
        let x = numbers.vector(width);
        let mut y = x.clone();
        panel::multiply_lower(&triangle, &mut y);
        for (i, y) in y.iter().enumerate() {
            let sum: f64 = (0..=i).map(|j| at(i, j) * x[j]).sum();
            assert!((y - sum).abs() <= 4.0 * width as f64 * f64::EPSILON);
        }
        panel::solve_lower(&triangle, &mut y);
        assert!(distance(&y, &x) <= 8.0 * width as f64 * f64::EPSILON * norm(&x));
        let mut y: Vec<f64> = (0..width)
            .map(|j| (j..width).map(|i| at(i, j) * x[i]).sum())
            .collect();
        panel::solve_upper(&triangle, &mut y);
        assert!(distance(&y, &x) <= 8.0 * width as f64 * f64::EPSILON * norm(&x));
    }
}

/// Largest panel width in the test of the kernels: all remainders modulo four occur, with several
/// strips.
const PANEL: usize = 19;

/// For any graph an ordering lists each freedom once and the groups one after the other.
pub(in crate::linalg) fn assert_groups_stay_together(
    order: impl Fn(&SymmetricCsc, &Groups) -> Vec<i64>,
) {
    for seed in 1..12 {
        for &(zone, contact) in &SHARES {
            // Few edges give many small trees, whose roots are spread over the groups.
            let matrix = laplacian(200, 1, 0.5, seed);
            let partition = partition(200, zone, contact, seed);
            let groups = Groups::new(&partition);
            let order = order(&matrix, &groups);
            assert!(groups.are_contiguous(&order));
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(k, &f)| f == k as i64));
            if groups.starts()[1] > 0 && groups.starts()[1] < 200 {
                let mut mixed = order;
                mixed.swap(0, 199);
                assert!(!groups.are_contiguous(&mixed));
            }
        }
    }
}

/// Of the orderings of a solid body (automatic, minimum degree, dissection) the cheapest is chosen.
pub(in crate::linalg) fn assert_the_cheaper_order_is_chosen(
    predict: impl Fn(&SymmetricCsc, &Partition) -> [Prediction; 3],
) {
    let grid = Grid::<3>::new([14, 14, 14], Support::Bottom);
    let contact = grid.freedoms(2..3, |[x, y, z]| z == 14 && x < 4 && y < 4);
    let mut zone = grid.freedoms(0..3, |[x, y, z]| z > 11 && x < 5 && y < 5);
    zone.retain(|freedom| !contact.contains(freedom));
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    let [chosen, degree, dissection] = predict(&grid.stiffness(|_| 1.0), &partition);
    assert_ne!(degree.flops, dissection.flops);
    assert!(chosen.flops <= degree.flops);
    assert!([degree, dissection].contains(&chosen));
}
