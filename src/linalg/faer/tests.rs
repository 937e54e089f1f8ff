//! Tests of the faer backend alone; the common tests are in `linalg::sparse::tests`.

use super::*;
use crate::linalg::sparse::LowerFactor;
use crate::linalg::sparse::tests::{
    Way, assert_groups_stay_together, assert_subtrees_are_solved_like_the_whole,
    assert_the_cheaper_order_is_chosen,
};
use crate::linalg::tests::laplacian;
use crate::linalg::tests::matrices::{Grid, Support};

const METHODS: [FillReduction; 3] = [
    FillReduction::Automatic,
    FillReduction::MinimumDegree,
    FillReduction::Dissection,
];

/// The faer backend with each ordering.
pub(in crate::linalg) fn ways() -> Vec<Way> {
    macro_rules! way {
        ($name:literal, $method:expr) => {
            Way {
                name: $name,
                is_chosen: false,
                condense: |matrix, partition, shift| {
                    Ok(Box::new(with_method(matrix, partition, shift, $method)?))
                },
            }
        };
    }
    vec![
        Way {
            name: "faer",
            is_chosen: true,
            condense,
        },
        way!("faer, AMD", FillReduction::MinimumDegree),
        way!("faer, dissection", FillReduction::Dissection),
    ]
}

#[test]
fn the_groups_stay_together_in_any_order() {
    for method in METHODS {
        assert_groups_stay_together(|matrix, groups| {
            let (factor, _, _) = analyze(&Pattern::new(matrix), groups, method).unwrap();
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
        with_method(matrix, partition, &[], FillReduction::Automatic).unwrap()
    });
}

/// Column counts from the pattern of supervariables equal those of a symbolic factorisation of the
/// whole pattern.
#[test]
fn counts_are_those_of_the_structure() {
    let grid = Grid::<2>::new([9, 7], Support::Bottom);
    let matrices = [grid.stiffness(|_| 1.0), laplacian(120, 3, 0.5, 5)];
    for matrix in &matrices {
        let n = matrix.rows();
        let partition = Partition {
            n,
            zone: (n / 2..n - n / 5).collect(),
            contact: (n - n / 5..n).collect(),
        };
        for method in METHODS {
            let groups = Groups::new(&partition);
            let (factor, _, _) = analyze(&Pattern::new(matrix), &groups, method).unwrap();
            let mut place = vec![0; n];
            for (column, &freedom) in factor.permutation().iter().enumerate() {
                place[freedom as usize] = column;
            }
            let mut filled = vec![vec![false; n]; n];
            for (_, (i, j)) in matrix.iter() {
                let (a, b) = (place[i as usize], place[j as usize]);
                filled[a.min(b)][a.max(b)] = true;
            }
            for k in 0..n {
                let rows: Vec<usize> = (k + 1..n).filter(|&i| filled[k][i]).collect();
                if let Some(&parent) = rows.first() {
                    rows.iter().for_each(|&row| filled[parent][row] = true);
                }
            }
            let counts = filled
                .iter()
                .map(|c| c.iter().filter(|f| **f).count() as i64);
            let counts: Vec<i64> = counts.collect();
            assert_eq!(factor.column_counts(), counts);
            let flops: i64 = counts.iter().map(|count| count * count).sum();
            assert_eq!(factor.flops(), flops as f64);
            assert_eq!(factor.nonzeros(), counts.iter().sum::<i64>() as f64);
        }
    }
}

/// Values that overflow a double are refused, like an indefinite matrix.
#[test]
fn overflow_is_not_definite() {
    let mut matrix = sprs::TriMatI::<f64, i64>::new((2, 2));
    for (i, j, value) in [(0, 0, 1e-300), (0, 1, 1e200), (1, 1, 1.0)] {
        matrix.add_triplet(i, j, value);
    }
    let partition = Partition {
        n: 2,
        ..Partition::default()
    };
    let error = condense(&matrix.to_csc(), &partition, &[]).err().unwrap();
    assert!(error.message().contains("not positive definite"), "{error}");
}
