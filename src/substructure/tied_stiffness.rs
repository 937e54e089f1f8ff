//! The condensed stiffness on the leaders of contact rows whose followers move along.
//!
//! With leaders `l`, followers `f` and `P = [1; G]` ([`Rows`])
//!
//! ```text
//!     P'S   = S_lf + (S_ff G)'              on the followers: the coupling C_lf
//!     P'S P = S_ll + V G + (V G)'           V = (S_lf + C_lf) / 2
//! ```
//!
//! These are two products with `G`. Summed entry by entry, each entry of `S` would be needed once
//! for each pair of leaders that carry its row and its column: the square of the number of entries
//! of `G`.

use super::rows::{RowEntries, Rows};
use crate::linalg::{ContactStiffness, blocked};
use nalgebra::DMatrix;

/// Condensed stiffness of the leaders with the contact rows closed.
pub(super) struct TiedStiffness {
    /// Matrix `P'S P`, leaders by leaders; its lower triangle.
    pub(super) matrix: DMatrix<f64>,
    /// Matrix `P'S` on the followers, leaders by followers.
    pub(super) coupling: DMatrix<f64>,
    /// Number of multiplications of the products with `G`.
    pub(super) multiplications: usize,
}

impl TiedStiffness {
    /// Builds the stiffness on some of the leaders, given by their numbers.
    pub(super) fn new(stiffness: &ContactStiffness, rows: &Rows, leaders: &[usize]) -> Self {
        let lead: Vec<usize> = leaders.iter().map(|&leader| rows.lead[leader]).collect();
        let carried = carried_by(rows, leaders);
        let (felt, first) = blocked::times(&stiffness.part(&rows.follow, &rows.follow), &carried);
        let mut mean = stiffness.part(&lead, &rows.follow);
        let coupling = &mean + felt.transpose();
        drop(felt);
        mean += &coupling;
        mean *= 0.5;
        let (mut matrix, second) = blocked::times(&mean, &carried);
        blocked::add_transpose(&mut matrix);
        stiffness.add_part(&lead, &lead, &mut matrix);
        TiedStiffness {
            matrix,
            coupling,
            multiplications: first + second,
        }
    }
}

/// Matrix `G` by columns: the followers that each leader carries, with their weights.
fn carried_by(rows: &Rows, leaders: &[usize]) -> Vec<RowEntries> {
    let mut column_of = vec![None; rows.lead.len()];
    for (column, &leader) in leaders.iter().enumerate() {
        column_of[leader] = Some(column);
    }
    let mut columns = vec![RowEntries::new(); leaders.len()];
    for (follower, carried) in rows.carried.iter().enumerate() {
        for &(leader, weight) in carried {
            if let Some(column) = column_of[leader] {
                columns[column].push((follower, weight));
            }
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::ContactBlock;
    use crate::linalg::tests::Numbers;

    /// Two bodies with random stiffnesses of condition below 4 (diagonally dominant) on `first` and
    /// `second` contact freedoms; the second body is `stiffer` times as stiff.
    fn two_bodies([first, second]: [usize; 2], stiffer: f64, seed: u64) -> ContactStiffness {
        let mut numbers = Numbers::new(seed);
        let mut block = |freedoms: std::ops::Range<usize>, scale: f64| {
            let n = freedoms.len();
            let random = DMatrix::from_vec(n, n, numbers.vector(n * n));
            let sum = &random * random.transpose() + DMatrix::identity(n, n) * n as f64;
            ContactBlock {
                freedoms: freedoms.collect(),
                matrix: sum * scale,
            }
        };
        let blocks = vec![block(0..first, 1.0), block(first..first + second, stiffer)];
        ContactStiffness::new(blocks)
    }

    /// Rows that tie each freedom of the second body to some freedoms of the first.
    fn rows(stiffness: &ContactStiffness, [first, second]: [usize; 2], masters: usize) -> Rows {
        let mut numbers = Numbers::new(11);
        let row = |k: usize| {
            let own =
                (0..masters).map(|i| ((k * first / second + i) % first, -numbers.next().abs()));
            own.chain([(first + k, 1.0)]).collect()
        };
        let entries = (0..second).map(row).collect();
        Rows::of_contact(entries, first + second, |i| stiffness.diagonal(i)).unwrap()
    }

    /// Matrix `P` of all leaders, as a dense one.
    fn moved(rows: &Rows, n: usize) -> DMatrix<f64> {
        let mut moved = DMatrix::zeros(n, rows.lead.len());
        for (leader, entries) in rows.moved.iter().enumerate() {
            entries
                .iter()
                .for_each(|&(freedom, weight)| moved[(freedom, leader)] += weight);
        }
        moved
    }

    /// Slaves follow their masters, or stiff slaves lead and the softer masters follow all of them.
    /// Both results equal the products of full matrices, whatever the number of threads, with no
    /// more multiplications than two products of full matrices take.
    #[test]
    fn what_leaders_feel_is_the_sum_over_all_that_moves() {
        let sizes = [120, 50];
        for (stiffer, masters) in [(1.0, 1), (1.0, 4), (1e5, 9), (1e5, 25)] {
            let stiffness = two_bodies(sizes, stiffer, 3);
            let rows = rows(&stiffness, sizes, masters);
            // Where slaves lead, each follower depends on all leaders.
            let entries: usize = rows.carried.iter().map(Vec::len).sum();
            assert_eq!(entries > 50 * 25, stiffer > 1.0, "{entries}");
            let leaders: Vec<usize> = (0..rows.lead.len()).filter(|k| k % 7 != 2).collect();
            let whole = moved(&rows, 170).select_columns(&leaders);
            let forces = stiffness.dense() * &whole;
            let (matrix, coupling) = (whole.tr_mul(&forces), forces.select_rows(&rows.follow));
            let of = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let work = || TiedStiffness::new(&stiffness, &rows, &leaders);
                pool.build().unwrap().install(work)
            };
            let (one, three) = (of(1), of(3));
            assert_eq!(
                (&one.matrix, &one.coupling),
                (&three.matrix, &three.coupling)
            );
            // Sums of 170 terms, twice, of the size of the absolute values.
            let sizes_of = |m: &DMatrix<f64>| m.map(f64::abs);
            let size = sizes_of(&whole).tr_mul(&(sizes_of(&stiffness.dense()) * sizes_of(&whole)));
            let tolerance = 2.0 * 170.0 * f64::EPSILON * size.amax();
            assert!((one.coupling.transpose() - coupling).amax() <= tolerance);
            let difference = (one.matrix - matrix).lower_triangle();
            assert!(difference.amax() <= tolerance, "{}", difference.amax());
            let (p, m) = (rows.len(), leaders.len());
            assert!(one.multiplications <= p * p * m + m * m * p);
            if stiffer == 1.0 {
                assert!(one.multiplications <= (p + m) * entries);
            }
        }
    }
}
