//! Tests of every backend, and tools for them.

// The tests of the sparse backends use more of this module.
mod accuracy;
#[cfg_attr(not(any(feature = "cholmod", feature = "faer")), allow(dead_code))]
pub(super) mod matrices;
mod refusals;

use super::*;
use matrices::{Grid, Support};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Backends that report their pivots; MUMPS does not.
fn pivoting() -> impl Iterator<Item = Backend> {
    backends().into_iter().filter(|b| *b != Backend::Mumps)
}

/// Backends of this build that may be used in this test run.
pub(crate) fn backends() -> Vec<Backend> {
    let all = Backend::built_in().into_iter();
    all.filter(|backend| *backend != Backend::Mumps || one_at_a_time())
        .collect()
}

/// Whether tests run one at a time, as MPI requires (`make test-mpi`): MPI starts a process, and
/// OpenBLAS may never return from that while it works in another thread.
pub(in crate::linalg) fn one_at_a_time() -> bool {
    std::env::var("RUST_TEST_THREADS").is_ok_and(|threads| threads == "1")
}

/// Reproducible pseudo-random numbers in (-1, 1).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn integer(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub(crate) fn next(&mut self) -> f64 {
        (self.integer() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// A matrix with bounds on the eigenvalues of `K + diag(shift)`.
pub(super) struct Sample {
    pub(super) matrix: SymmetricCsc,
    pub(super) partition: Partition,
    pub(super) shift: Vec<f64>,
    pub(super) smallest: f64,
    pub(super) largest: f64,
}

impl Sample {
    /// Computes the bounds from the dense eigenvalues.
    pub(super) fn new(matrix: SymmetricCsc, partition: Partition, shift: Vec<f64>) -> Self {
        let mut k = full(&matrix);
        for (&freedom, d) in partition.contact.iter().zip(&shift) {
            k[(freedom, freedom)] += d;
        }
        let values = k.symmetric_eigenvalues();
        Sample {
            matrix,
            partition,
            shift,
            smallest: values.min(),
            largest: values.max(),
        }
    }

    pub(super) fn condition(&self) -> f64 {
        self.largest / self.smallest
    }

    /// Relative error of a backward stable computation with the matrix: `n eps` times its
    /// condition.
    ///
    /// Higham, *Accuracy and Stability*, 2nd ed., theorems 10.3 and 10.4 with a modest constant
    /// taken as 1: their worst case grows with n, the actual error with its root.
    pub(super) fn tolerance(&self) -> f64 {
        self.partition.n as f64 * f64::EPSILON * self.condition()
    }
}

pub(super) fn full(matrix: &SymmetricCsc) -> DMatrix<f64> {
    let n = matrix.rows();
    let mut k = DMatrix::zeros(n, n);
    for (&a, (i, j)) in matrix.iter() {
        k[(i as usize, j as usize)] = a;
        k[(j as usize, i as usize)] = a;
    }
    k
}

pub(super) fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// A graph Laplacian with random weights and `ground` added to the diagonal. For `ground = 0` it is
/// singular with a constant null vector.
pub(super) fn laplacian(n: usize, edges_per_node: usize, ground: f64, seed: u64) -> SymmetricCsc {
    let mut numbers = Numbers::new(seed);
    let mut k = sprs::TriMatI::<f64, i64>::new((n, n));
    let add = |k: &mut sprs::TriMatI<f64, i64>, a: usize, b: usize, weight: f64| {
        k.add_triplet(a, a, weight);
        k.add_triplet(b, b, weight);
        k.add_triplet(a.min(b), a.max(b), -weight);
    };
    for a in 1..n {
        // A chain keeps the graph connected.
        add(&mut k, a - 1, a, 1.5 + numbers.next());
        for _ in 1..edges_per_node {
            let b = (numbers.integer() % n as u64) as usize;
            if a != b {
                add(&mut k, a, b, 1.5 + numbers.next());
            }
        }
    }
    for a in 0..n {
        k.add_triplet(a, a, ground);
    }
    k.to_csc()
}

/// Makes each freedom interior, zone or contact by the given shares; contact is in random order.
pub(super) fn partition(n: usize, zone: f64, contact: f64, seed: u64) -> Partition {
    let mut numbers = Numbers::new(seed);
    let mut result = Partition {
        n,
        ..Partition::default()
    };
    for freedom in 0..n {
        let draw = 0.5 * (1.0 + numbers.next());
        if draw < zone {
            result.zone.push(freedom);
        } else if draw < zone + contact {
            result.contact.push(freedom);
        }
    }
    result
        .contact
        .sort_by_key(|&freedom| (freedom * 7919 + 13) % 10_007);
    result
}

/// Shares of zone and contact, including cases in which each group is empty.
pub(super) const SHARES: [(f64, f64); 8] = [
    (0.0, 0.0),
    (0.3, 0.0),
    (0.0, 0.2),
    (1.0, 0.0),
    (0.0, 1.0),
    (0.6, 0.4),
    (0.3, 0.1),
    (0.05, 0.02),
];

/// Solves `(K + diag(springs on contact)) u = load` by the condensed system, and compares with the
/// plain solve: elimination, contact, recovery of the zone and of all freedoms must form one
/// consistent solution.
pub(super) fn assert_condensation_is_the_plain_solve(sample: &Sample, condensed: &dyn Condensed) {
    let Sample {
        matrix, partition, ..
    } = sample;
    let load = Numbers::new(5).vector(partition.n);
    let springs: Vec<f64> = if sample.shift.is_empty() {
        vec![0.0; partition.contact.len()]
    } else {
        sample.shift.iter().map(|d| 0.5 * d).collect()
    };
    let mut k = full(matrix);
    for (&freedom, s) in partition.contact.iter().zip(&springs) {
        k[(freedom, freedom)] += s;
    }
    let expected = k.clone().lu().solve(&DVector::from_column_slice(&load));
    let expected = expected.expect("the matrix with its springs is regular");

    let mut zone = vec![0.0; partition.zone.len()];
    let mut contact = vec![0.0; partition.contact.len()];
    let reduced = condensed.reduce_load(&load).unwrap();
    condensed
        .condense_load(&reduced, &mut zone, &mut contact)
        .unwrap();
    condensed.eliminate_zone(&mut zone, &mut contact);
    let mut c = condensed.contact_stiffness().dense();
    for (j, s) in springs.iter().enumerate() {
        c[(j, j)] += s;
    }
    let u_c = if contact.is_empty() {
        DVector::zeros(0)
    } else {
        let u_c = c.lu().solve(&DVector::from_column_slice(&contact));
        u_c.expect("the condensed matrix with its springs is regular")
    };
    condensed.recover_zone(&mut zone, u_c.as_slice());
    let mut total = load.clone();
    for ((&freedom, s), u_c) in partition.contact.iter().zip(&springs).zip(u_c.iter()) {
        total[freedom] -= s * u_c;
    }
    let found = solved(condensed, matrix, partition, &total, u_c.as_slice());
    let u = &found.u;

    // K + springs has at least half the smallest eigenvalue of K + shift: twice the condition.
    let tolerance = 2.0 * sample.tolerance() * expected.norm();
    assert!(distance(u, expected.as_slice()) <= tolerance);
    let at = |list: &[usize]| list.iter().map(|&f| expected[f]).collect::<Vec<_>>();
    assert!(distance(&zone, &at(&partition.zone)) <= tolerance);
    assert!(distance(u_c.as_slice(), &at(&partition.contact)) <= tolerance);

    let mut ku = vec![0.0; partition.n];
    multiply(matrix, u, &mut ku);
    let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let rows = full(matrix);
    let size = rows
        .row_iter()
        .map(|row| row.iter().map(|a| a.abs()).sum())
        .fold(0.0, f64::max);
    let scale = size * largest(u) + largest(&total);
    let residual: Vec<f64> = total.iter().zip(&ku).map(|(f, ku)| f - ku).collect();
    let error = largest(&residual) / scale;
    // The residual itself has an error of about one rounding error for each entry of a row.
    let round_off = 40.0 * f64::EPSILON;
    assert!((found.backward_error - error).abs() <= round_off);
}

/// Solves `K u = load` in interior and zone for given contact displacements.
pub(super) fn solved(
    condensed: &dyn Condensed,
    matrix: &SymmetricCsc,
    partition: &Partition,
    load: &[f64],
    u_contact: &[f64],
) -> Recovered {
    let reduced = condensed.reduce_load(load).unwrap();
    let mut zone = vec![0.0; partition.zone.len()];
    let mut contact = vec![0.0; partition.contact.len()];
    condensed
        .condense_load(&reduced, &mut zone, &mut contact)
        .unwrap();
    condensed.eliminate_zone(&mut zone, &mut contact);
    condensed.recover_zone(&mut zone, u_contact);
    let parts = [&reduced[..], &zone, u_contact];
    recover_refined(
        condensed,
        &matrix.clone().into(),
        super::norm(matrix),
        load,
        parts,
        partition,
        [0.0; 2],
    )
    .unwrap()
}

#[test]
fn a_chain_of_springs_condenses_to_its_series_stiffness() {
    // n equal springs of stiffness k in series, held at one end: stiffness k / n at the other.
    let (n, k) = (50, 3.0);
    let mut chain = sprs::TriMatI::<f64, i64>::new((n, n));
    for j in 0..n {
        chain.add_triplet(j, j, if j + 1 < n { 2.0 * k } else { k });
        if j > 0 {
            chain.add_triplet(j - 1, j, -k);
        }
    }
    let chain: SymmetricCsc = chain.to_csc();
    for backend in backends() {
        for zone in [vec![], vec![10, 11, 12], (0..n - 1).collect()] {
            let partition = Partition {
                n,
                zone: zone.clone(),
                contact: vec![n - 1],
            };
            let condensed = condense(backend, &chain, &partition, &[]).unwrap();
            let stiffness = condensed.contact_stiffness().diagonal(0);
            // The condition of the chain is (2 n / pi)^2 < n^2.
            let tolerance = (n * n * n) as f64 * f64::EPSILON;
            assert!((stiffness * n as f64 / k - 1.0).abs() <= tolerance);
            // A unit force at the end moves freedom j by (j + 1) / k.
            let mut u = vec![0.0; n];
            u[n - 1] = 1.0;
            let end = [n as f64 / k];
            let partition = Partition {
                n,
                zone,
                contact: vec![n - 1],
            };
            let u = solved(condensed.as_ref(), &chain, &partition, &u, &end).u;
            for (j, u) in u.iter().enumerate() {
                assert!((u * k - (j + 1) as f64).abs() <= tolerance * n as f64);
            }
        }
    }
}

#[test]
fn every_partition_gives_the_plain_solution() {
    for (seed, &(zone, contact)) in SHARES.iter().enumerate() {
        let seed = seed as u64 + 1;
        for n in [1, 2, 20, 140] {
            let partition = partition(n, zone, contact, seed);
            let held = laplacian(n, 3, 0.5, seed);
            let sample = Sample::new(held, partition.clone(), vec![]);
            for backend in backends() {
                let condensed = condense(backend, &sample.matrix, &partition, &[]).unwrap();
                assert_condensation_is_the_plain_solve(&sample, &*condensed);
            }
            if partition.contact.is_empty() || n == 1 {
                continue;
            }
            let shift = vec![2.0; partition.contact.len()];
            let sample = Sample::new(laplacian(n, 3, 0.0, seed), partition.clone(), shift);
            for backend in backends() {
                let condensed =
                    condense(backend, &sample.matrix, &partition, &sample.shift).unwrap();
                assert_condensation_is_the_plain_solve(&sample, &*condensed);
            }
        }
    }
}

/// A zone that shrinks and grows back within the factored one condenses like a zone that was
/// factored directly.
#[test]
fn a_zone_is_chosen_among_the_factored_one() {
    let matrix = laplacian(120, 3, 0.1, 3);
    let whole = partition(120, 0.5, 0.1, 4);
    for backend in backends() {
        let mut condensed = condense(backend, &matrix, &whole, &[]).unwrap();
        for stride in [3, 1, 7, 2] {
            let wanted: Vec<usize> = whole.zone.iter().copied().step_by(stride).collect();
            let zone = condensed.choose_zone(&wanted).unwrap().unwrap();
            assert!(zone.is_sorted() && check::contains(&zone, &wanted));
            assert!(check::contains(&whole.zone, &zone));
            let chosen = Partition {
                zone,
                ..whole.clone()
            };
            let sample = Sample::new(matrix.clone(), chosen, vec![]);
            assert_condensation_is_the_plain_solve(&sample, condensed.as_ref());
        }
        let outside = (0..120).find(|f| whole.zone.binary_search(f).is_err());
        assert_eq!(condensed.choose_zone(&[outside.unwrap()]).unwrap(), None);
    }
}

#[test]
fn a_body_held_by_contact_alone_has_a_singular_contact_stiffness() {
    let grid = Grid::<2>::new([9, 6], Support::Guides);
    let top = grid.nodes[1] - 1;
    let contact = grid.freedoms(1..2, |[_, y]| y == top);
    let zone = grid.freedoms(0..2, |[x, y]| x < 5 && (3..=top).contains(&y));
    let zone: Vec<usize> = zone.into_iter().filter(|f| !contact.contains(f)).collect();
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    let shift = vec![1.0; partition.contact.len()];
    let sample = Sample::new(grid.stiffness(|_| 1.0), partition, shift);
    for backend in backends() {
        let condensed =
            condense(backend, &sample.matrix, &sample.partition, &sample.shift).unwrap();
        assert_condensation_is_the_plain_solve(&sample, &*condensed);
        // Moving the whole body up takes no force.
        let c = condensed.contact_stiffness().dense();
        let forces = &c * DVector::from_element(c.nrows(), 1.0);
        assert!(forces.norm() <= sample.tolerance() * c.norm());
        assert_eq!(c, c.transpose());
    }
}

#[test]
fn the_weakest_pivot_is_that_of_the_softest_support() {
    // Two freedoms coupled by a spring of stiffness 1, each held by a spring of 1e-6: eliminating
    // either leaves 1 + s - 1 / (1 + s) of the diagonal 1 + s, about 2 s / (1 + s).
    let s = 1e-6;
    let mut k = sprs::TriMatI::<f64, i64>::new((2, 2));
    k.add_triplet(0, 0, 1.0 + s);
    k.add_triplet(0, 1, -1.0);
    k.add_triplet(1, 1, 1.0 + s);
    let k: SymmetricCsc = k.to_csc();
    for backend in pivoting() {
        for (zone, contact, last) in [(vec![], vec![0], 0), (vec![1], vec![], 1)] {
            let partition = Partition {
                n: 2,
                zone,
                contact,
            };
            let pivot = condense(backend, &k, &partition, &[])
                .unwrap()
                .weakest_pivot();
            assert_eq!(pivot.freedom, last);
            let expected = 1.0 - 1.0 / ((1.0 + s) * (1.0 + s));
            assert!((pivot.ratio - expected).abs() <= 4.0 * f64::EPSILON);
        }
    }
}

#[test]
fn the_prediction_is_what_the_factorisation_reports() {
    let matrix = laplacian(300, 3, 1.0, 2);
    let partition = partition(300, 0.2, 0.1, 2);
    for backend in backends() {
        let predicted = predict(backend, &matrix, &partition).unwrap();
        let cost = condense(backend, &matrix, &partition, &[]).unwrap().cost();
        assert_eq!(predicted, cost);
        assert!(predicted.trailing_nonzeros <= predicted.factor_nonzeros);
        assert!(predicted.flops > 0.0 && predicted.memory_bytes > 0.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]
    #[test]
    fn random_bodies_give_the_plain_solution(
        n in 2usize..60,
        edges in 1usize..5,
        zone in 0.0..1.0f64,
        contact in 0.0..1.0f64,
        held in any::<bool>(),
        seed in 1u64..1_000_000,
    ) {
        let partition = partition(n, zone, contact, seed);
        prop_assume!(held || !partition.contact.is_empty());
        let (ground, shift) = if held {
            (0.1, vec![])
        } else {
            (0.0, vec![1.0; partition.contact.len()])
        };
        let sample = Sample::new(laplacian(n, edges, ground, seed), partition, shift);
        for backend in backends() {
            let condensed =
                condense(backend, &sample.matrix, &sample.partition, &sample.shift).unwrap();
            assert_condensation_is_the_plain_solve(&sample, &*condensed);
        }
    }
}
