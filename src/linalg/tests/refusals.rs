//! Arguments that every backend must refuse, and the messages.

use super::*;
use crate::ErrorKind;
use std::error::Error as _;

#[test]
fn a_pivot_that_is_not_positive_names_its_freedom() {
    let n = 60;
    // Freedom 41 is coupled to nothing, so every ordering meets its pivot as it is stored.
    let build = |pivot: f64| -> SymmetricCsc {
        let mut k = sprs::TriMatI::<f64, i64>::new((n, n));
        for j in 0..n {
            k.add_triplet(j, j, if j == 41 { pivot } else { 4.0 });
            if j >= 1 && j != 41 && j != 42 {
                k.add_triplet(j - 1, j, -1.0);
            }
        }
        k.to_csc()
    };
    let partitions = [
        (vec![3, 4], vec![50]),
        (vec![40, 41, 42], vec![50]),
        (vec![3, 4], vec![41, 50]),
    ];
    for backend in pivoting() {
        for (zone, contact) in partitions.clone() {
            let partition = Partition { n, zone, contact };
            for pivot in [-1.0, 0.0] {
                let error = condense(backend, &build(pivot), &partition, &[])
                    .err()
                    .unwrap();
                let cause = error.source().and_then(|c| c.downcast_ref::<NotDefinite>());
                assert_eq!(cause, Some(&NotDefinite { freedom: 41 }));
                assert!(error.message().contains("freedom 41"));
            }
            assert!(condense(backend, &build(1.0), &partition, &[]).is_ok());
        }
    }
}

#[test]
fn a_free_body_is_not_definite_whatever_the_sign_of_its_round_off() {
    for seed in 1..20 {
        let matrix = laplacian(80, 2, 0.0, seed);
        let partition = partition(80, 0.2, 0.1, seed);
        for backend in backends() {
            let error = condense(backend, &matrix, &partition, &[]).err().unwrap();
            assert_eq!(error.kind(), ErrorKind::Internal);
            let cause = error.source().and_then(|c| c.downcast_ref::<NotDefinite>());
            assert!(cause.is_some_and(|c| c.freedom < 80));
        }
    }
}

#[test]
fn arguments_that_do_not_fit_are_refused() {
    let k = laplacian(6, 2, 1.0, 1);
    let good = Partition {
        n: 6,
        zone: vec![1],
        contact: vec![4, 2],
    };
    let with = |zone: Vec<usize>, contact: Vec<usize>| Partition {
        n: 6,
        zone,
        contact,
    };
    let mut infinite = k.clone();
    infinite.data_mut()[3] = f64::INFINITY;
    let no_diagonal: SymmetricCsc = {
        let mut t = sprs::TriMatI::<f64, i64>::new((6, 6));
        for j in 1..6 {
            t.add_triplet(j, j, 1.0);
        }
        t.to_csc()
    };
    let lower = full(&k);
    let lower: SymmetricCsc = {
        let mut t = sprs::TriMatI::<f64, i64>::new((6, 6));
        for j in 0..6 {
            for i in j..6 {
                t.add_triplet(i, j, lower[(i, j)]);
            }
        }
        t.to_csc()
    };
    for backend in backends() {
        let cases = [
            (&k, with(vec![1], vec![1]), vec![], "freedom 1 is listed"),
            (
                &k,
                with(vec![6], vec![]),
                vec![],
                "freedom 6 does not exist",
            ),
            (&k, good.clone(), vec![1.0], "1 values of shift for 2"),
            (&k, good.clone(), vec![1.0, f64::NAN], "freedom 2 is NaN"),
            (&k, Partition::default(), vec![], "without freedoms"),
            (
                &k,
                Partition {
                    n: 7,
                    ..good.clone()
                },
                vec![],
                "6 x 6",
            ),
            (&infinite, good.clone(), vec![], "is inf"),
            (&no_diagonal, good.clone(), vec![], "column 0"),
            (&lower, good.clone(), vec![], "column 0"),
        ];
        for (matrix, partition, shift, expected) in cases {
            let error = condense(backend, matrix, &partition, &shift).err().unwrap();
            assert!(error.message().contains(expected), "{}", error.message());
        }
        let condensed = condense(backend, &k, &good, &[]).unwrap();
        let error = condensed
            .recover_all(&[0.0; 5], &[0.0; 2], &[0.0; 2])
            .unwrap_err();
        assert!(error.message().contains("5 values of reduced load"));
        let error = condensed.reduce_load(&[0.0; 5]).unwrap_err();
        assert!(error.message().contains("5 values of load"));
        let reduced = condensed.reduce_load(&[0.0; 6]).unwrap();
        let error = condensed
            .condense_load(&reduced, &mut [0.0; 2], &mut [0.0; 2])
            .unwrap_err();
        assert!(error.message().contains("2 values of zone load"));
    }
}

#[test]
fn the_dense_backend_refuses_what_is_too_large_and_says_what_to_do() {
    let n = dense::LARGEST + 1;
    let mut k = sprs::TriMatI::<f64, i64>::new((n, n));
    for j in 0..n {
        k.add_triplet(j, j, 1.0);
    }
    let k: SymmetricCsc = k.to_csc();
    let partition = Partition {
        n,
        ..Partition::default()
    };
    for error in [
        condense(Backend::Dense, &k, &partition, &[]).err().unwrap(),
        predict(Backend::Dense, &k, &partition).unwrap_err(),
    ] {
        assert_eq!(error.kind(), ErrorKind::Input);
        assert!(error.message().contains("6001") && error.message().contains("cholmod"));
    }
}
