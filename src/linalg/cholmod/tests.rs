//! Tests of the CHOLMOD backend alone; the common tests are in `linalg::sparse::tests`.

use super::*;
use crate::linalg::sparse::tests::{
    Way, assert_groups_stay_together, assert_subtrees_are_solved_like_the_whole,
    assert_the_cheaper_order_is_chosen,
};
use crate::linalg::tests::matrices::{Grid, Support};
use suitesparse_sys as sys;

const METHODS: [Method; 3] = [Method::Automatic, Method::MinimumDegree, Method::Dissection];

/// Starts CHOLMOD with the given storage of the factor.
fn common(storage: u32) -> Common {
    let mut common = Common::start().unwrap();
    common.as_mut().supernodal = storage as i32;
    common
}

/// CHOLMOD with each kind of storage and each ordering.
pub(in crate::linalg) fn ways() -> Vec<Way> {
    macro_rules! way {
        ($name:literal, $storage:expr, $method:expr) => {
            Way {
                name: $name,
                is_chosen: false,
                condense: |matrix, partition, shift| {
                    let common = common($storage);
                    let condensed = with_common(common, matrix, partition, shift, $method)?;
                    let is_supernodal = $storage == sys::CHOLMOD_SUPERNODAL;
                    assert_eq!(condensed.solver().factor.is_supernodal(), is_supernodal);
                    Ok(Box::new(condensed))
                },
            }
        };
    }
    use Method::*;
    vec![
        Way {
            name: "cholmod",
            is_chosen: true,
            condense,
        },
        way!(
            "cholmod, simplicial, CAMD",
            sys::CHOLMOD_SIMPLICIAL,
            MinimumDegree
        ),
        way!(
            "cholmod, simplicial, dissection",
            sys::CHOLMOD_SIMPLICIAL,
            Dissection
        ),
        way!(
            "cholmod, supernodal, CAMD",
            sys::CHOLMOD_SUPERNODAL,
            MinimumDegree
        ),
        way!(
            "cholmod, supernodal, dissection",
            sys::CHOLMOD_SUPERNODAL,
            Dissection
        ),
    ]
}

#[test]
fn the_storage_does_not_change_the_fill_and_large_factors_are_supernodal() {
    let grid = Grid::<2>::new([60, 60], Support::Bottom);
    let partition = Partition {
        n: grid.n,
        zone: grid.freedoms(0..2, |[_, y]| y > 50),
        contact: vec![],
    };
    let matrix = grid.stiffness(|_| 1.0);
    let storages = [
        sys::CHOLMOD_SIMPLICIAL,
        sys::CHOLMOD_SUPERNODAL,
        sys::CHOLMOD_AUTO,
    ];
    let factors = storages.map(|storage| {
        let method = Method::Automatic;
        with_common(common(storage), &matrix, &partition, &[], method).unwrap()
    });
    let fill = factors.each_ref().map(|f| f.cost().factor_nonzeros);
    assert!(fill[0] == fill[1] && fill[0] == fill[2]);
    let supernodal = factors
        .each_ref()
        .map(|f| f.solver().factor.is_supernodal());
    assert_eq!(supernodal, [false, true, true]);
}

#[test]
fn the_groups_stay_together_in_any_order() {
    for method in METHODS {
        assert_groups_stay_together(|matrix, groups| {
            let common = Common::start().unwrap();
            let (factor, _) = analyze(common, &Pattern::new(matrix), groups, method).unwrap();
            factor.permutation().to_vec()
        });
    }
}

#[test]
fn the_cheaper_order_is_chosen() {
    assert_the_cheaper_order_is_chosen(|matrix, partition| {
        METHODS.map(|method| predict_with_method(matrix, partition, method).unwrap())
    });
}

#[test]
fn subtrees_are_solved_like_the_whole() {
    assert_subtrees_are_solved_like_the_whole(|matrix, partition| {
        let common = Common::start().unwrap();
        with_common(common, matrix, partition, &[], Method::Automatic).unwrap()
    });
}

#[test]
fn the_libraries_name_themselves() {
    let version = cholmod_version();
    let numbers: Vec<u32> = version
        .split('.')
        .map(|part| part.parse().unwrap())
        .collect();
    assert!(numbers.len() == 3 && numbers[0] >= 3);
    assert!(blas_name().contains("BLAS"));
    if let Some(threads) = blas_threads() {
        assert!(threads >= 1);
        assert!(blas_name().contains(&format!("{threads} thread")));
    }
}
