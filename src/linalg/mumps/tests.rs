//! Tests of the MUMPS backend alone; the common tests are in `linalg::sparse::tests`.

use super::*;
use crate::linalg::sparse::tests::Way;
use crate::linalg::tests::{laplacian, one_at_a_time};

/// The MUMPS backend on one rank.
pub(in crate::linalg) fn ways() -> Vec<Way> {
    let way = Way {
        name: "mumps",
        is_chosen: true,
        condense,
    };
    Vec::from_iter(one_at_a_time().then_some(way))
}

/// Two unconnected bodies: one held and in contact, one with `ground` at its freedoms.
fn beside_another(n: usize, ground: f64, seed: u64) -> (SymmetricCsc, Partition) {
    let [held, other] = [laplacian(8, 2, 1.0, 7), laplacian(n, 3, ground, seed)];
    let mut both = sprs::TriMatI::<f64, i64>::new((8 + n, 8 + n));
    for (matrix, first) in [(&held, 0), (&other, 8)] {
        for (&value, (i, j)) in matrix.iter() {
            both.add_triplet(first + i as usize, first + j as usize, value);
        }
    }
    let partition = Partition {
        n: 8 + n,
        zone: Vec::new(),
        contact: vec![0, 3],
    };
    (both.to_csc(), partition)
}

/// MUMPS itself reports neither of the two interiors as an error.
#[test]
fn an_interior_that_nothing_holds_is_refused_and_a_negative_one_too() {
    if !one_at_a_time() {
        println!("skipped: MPI beside other tests");
        return;
    }
    for seed in 1..=60 {
        let n = 5 + seed as usize % 30;
        for ground in [0.0, -0.5] {
            let (matrix, partition) = beside_another(n, ground, seed);
            let error = condense(&matrix, &partition, &[]).err();
            let error = error.unwrap_or_else(|| panic!("{n} with {ground}, seed {seed}"));
            let cause = error.causes().find_map(|c| c.downcast_ref::<NotDefinite>());
            assert!(cause.is_some_and(|cause| cause.freedom >= 8), "{error}");
        }
        let (matrix, partition) = beside_another(n, 1e-3, seed);
        assert!(condense(&matrix, &partition, &[]).is_ok());
    }
}

/// A value that is NaN is reported as such.
#[test]
fn a_shared_matrix_with_a_damaged_entry_is_refused() {
    let mut matrix = laplacian(6, 2, 1.0, 3);
    matrix.data_mut()[4] = f64::NAN;
    let error = Shared::here(&matrix).unwrap_err();
    assert!(error.message().contains("not a finite number"), "{error}");
}
