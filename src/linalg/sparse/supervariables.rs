//! Supervariables: runs of freedoms that couple to the same freedoms, as those of a node do. An
//! ordering puts them next to each other anyway. If they are found first, a plane mesh has only
//! half the vertices and a quarter of the entries to be ordered.
//!
//! # Source
//! I. S. Duff, J. K. Reid, *The multifrontal solution of indefinite sparse symmetric linear
//! equations*, ACM TOMS 9 (3), 1983, doi:10.1145/356044.356047; C. Ashcraft, *Compressed graphs and
//! the minimum degree algorithm*, SIAM J. Sci. Comput. 16 (6), 1995, doi:10.1137/0916081.

use super::{Groups, Pattern};

/// Pattern of a matrix with one row and column for each supervariable.
pub(crate) struct Supervariables {
    /// First freedom of each supervariable, followed by the number of freedoms.
    first: Vec<usize>,
    columns: Vec<i64>,
    rows: Vec<i64>,
    groups: Groups,
}

impl Supervariables {
    /// Finds the longest runs of consecutive freedoms of one group that are coupled with each other
    /// and have the same neighbours.
    pub(crate) fn find(matrix: &Pattern, groups: &Groups) -> Self {
        let n = matrix.n();
        let goes_on = continued(matrix, groups);
        let mut first = Vec::with_capacity(n / 2 + 1);
        // Number of the supervariable that a freedom starts.
        let mut number = vec![-1i64; n];
        for freedom in 0..n {
            if !goes_on[freedom] {
                number[freedom] = first.len() as i64;
                first.push(freedom);
            }
        }
        let mut columns = Vec::with_capacity(first.len() + 1);
        let mut rows = Vec::new();
        columns.push(0);
        for &freedom in &first {
            let numbers = matrix.column(freedom).iter();
            rows.extend(numbers.map(|&row| number[row as usize]).filter(|&s| s >= 0));
            columns.push(rows.len() as i64);
        }
        let member = first.iter().map(|&f| groups.of(f)).collect();
        first.push(n);
        Supervariables {
            first,
            columns,
            rows,
            groups: Groups::from_members(member),
        }
    }

    /// Makes supervariables that are known already. `first` holds the first freedom of each,
    /// followed by the number of freedoms; `member` holds their groups; `coupled` holds the coupled
    /// pairs, in any order.
    #[cfg(feature = "mumps")]
    pub(crate) fn known(first: Vec<usize>, member: Vec<u8>, coupled: &[[i32; 2]]) -> Self {
        let n = member.len();
        let upper = |&[a, b]: &[i32; 2]| (a.max(b) as usize, i64::from(a.min(b)));
        let mut columns = vec![0i64; n + 1];
        // Each supervariable is also coupled with itself.
        let itself = (0..n).map(|j| (j, j as i64));
        let all = || coupled.iter().map(upper).chain(itself.clone());
        all().for_each(|(column, _)| columns[column + 1] += 1);
        for j in 0..n {
            columns[j + 1] += columns[j];
        }
        let mut next = columns.clone();
        let mut rows = vec![0i64; columns[n] as usize];
        for (column, row) in all() {
            rows[next[column] as usize] = row;
            next[column] += 1;
        }
        let mut sorted = Vec::with_capacity(rows.len());
        let mut ends = vec![0i64];
        for j in 0..n {
            let column = &mut rows[columns[j] as usize..columns[j + 1] as usize];
            column.sort_unstable();
            sorted.extend_from_slice(column);
            let start = ends[j] as usize;
            let mut kept = start;
            for k in start..sorted.len() {
                if k == start || sorted[k] != sorted[kept - 1] {
                    sorted[kept] = sorted[k];
                    kept += 1;
                }
            }
            sorted.truncate(kept);
            ends.push(sorted.len() as i64);
        }
        Supervariables {
            first,
            columns: ends,
            rows: sorted,
            groups: Groups::from_members(member),
        }
    }

    /// Mean number of freedoms of a supervariable.
    #[cfg(any(test, feature = "cholmod"))]
    pub(crate) fn size(&self) -> f64 {
        let n = self.first.last().copied().unwrap_or(0);
        n as f64 / (self.first.len() - 1).max(1) as f64
    }

    /// Number of freedoms of each supervariable.
    #[cfg(feature = "faer")]
    pub(crate) fn sizes(&self) -> Vec<i64> {
        let sizes = self.first.windows(2);
        sizes.map(|pair| (pair[1] - pair[0]) as i64).collect()
    }

    /// The pattern of the supervariables.
    pub(crate) fn pattern(&self) -> Pattern<'_> {
        Pattern::from_parts(&self.columns, &self.rows)
    }

    /// Groups of the supervariables.
    pub(crate) fn groups(&self) -> &Groups {
        &self.groups
    }

    /// Ordering of the freedoms for an ordering of the supervariables.
    pub(crate) fn expand(&self, permutation: &[i64]) -> Vec<i64> {
        let freedoms = permutation.iter().flat_map(|&s| {
            let s = s as usize;
            self.first[s] as i64..self.first[s + 1] as i64
        });
        freedoms.collect()
    }
}

/// For each freedom, whether it has the group and the neighbours of the previous freedom and is
/// coupled with it.
fn continued(matrix: &Pattern, groups: &Groups) -> Vec<bool> {
    let n = matrix.n();
    // Above the diagonal: the column holds the rows of the previous column, and the diagonal.
    let mut same: Vec<bool> = (0..n)
        .map(|j| {
            j > 0
                && groups.of(j) == groups.of(j - 1)
                && matrix.column(j).split_last().map(|(_, above)| above)
                    == Some(matrix.column(j - 1))
        })
        .collect();
    // To the right of the diagonal: each column holds both freedoms or neither.
    for k in 0..n {
        let rows = matrix.column(k);
        let above = &rows[..rows.len().saturating_sub(1)];
        for (place, &row) in above.iter().enumerate() {
            let row = row as usize;
            if same[row] && (place == 0 || above[place - 1] as usize + 1 != row) {
                same[row] = false;
            }
            if same[row + 1] && rows[place + 1] as usize != row + 1 {
                same[row + 1] = false;
            }
        }
    }
    same
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Partition;

    /// Upper triangle of the graph with the given edges.
    fn upper(n: usize, edges: &[(usize, usize)]) -> (Vec<i64>, Vec<i64>) {
        let (mut columns, mut rows) = (vec![0], Vec::new());
        for j in 0..n {
            let mut above: Vec<i64> = edges
                .iter()
                .filter(|e| e.0.max(e.1) == j)
                .map(|e| e.0.min(e.1) as i64)
                .collect();
            above.sort_unstable();
            rows.extend(above);
            rows.push(j as i64);
            columns.push(rows.len() as i64);
        }
        (columns, rows)
    }

    fn partition(n: usize, contact: &[usize]) -> Partition {
        Partition {
            n,
            contact: contact.to_vec(),
            ..Partition::default()
        }
    }

    /// A chain of three nodes with two freedoms each: three supervariables, the last of which
    /// splits if one of its freedoms is in contact.
    #[test]
    fn the_freedoms_of_a_node_are_one_unless_their_groups_differ() {
        let mut edges = Vec::new();
        for (a, b) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2)] {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let edge = (2 * a + i, 2 * b + j);
                if edge.0 < edge.1 {
                    edges.push(edge);
                }
            }
        }
        let (columns, rows) = upper(6, &edges);
        let matrix = Pattern::from_parts(&columns, &rows);
        let all = Supervariables::find(&matrix, &Groups::new(&partition(6, &[])));
        assert_eq!(all.first, [0, 2, 4, 6]);
        assert_eq!(all.size(), 2.0);
        assert_eq!(all.columns, [0, 1, 3, 5]);
        assert_eq!(all.rows, [0, 0, 1, 1, 2]);
        assert_eq!(all.expand(&[2, 0, 1]), [4, 5, 0, 1, 2, 3]);
        let split = Supervariables::find(&matrix, &Groups::new(&partition(6, &[5])));
        assert_eq!(split.first, [0, 2, 4, 5, 6]);
        assert_eq!(split.rows, [0, 0, 1, 1, 2, 1, 2, 3]);
    }

    /// Freedoms whose neighbours differ above or to the right of the diagonal, or that are not
    /// coupled, stay separate.
    #[test]
    fn freedoms_with_other_neighbours_stay_apart() {
        type Case<'a> = (&'a [(usize, usize)], &'a [usize]);
        let cases: [Case; 5] = [
            (&[(1, 2), (0, 1), (0, 2)], &[0, 3, 4]),
            (&[(0, 1), (1, 2)], &[0, 1, 2, 3, 4]),
            (&[(0, 2), (0, 1), (1, 3)], &[0, 1, 2, 3, 4]),
            (&[(0, 2), (1, 2)], &[0, 1, 2, 3, 4]),
            (&[(0, 3), (1, 3), (0, 1)], &[0, 2, 3, 4]),
        ];
        for (edges, first) in cases {
            let (columns, rows) = upper(4, edges);
            let matrix = Pattern::from_parts(&columns, &rows);
            let found = Supervariables::find(&matrix, &Groups::new(&partition(4, &[])));
            assert_eq!(found.first, first, "{edges:?}");
        }
    }
}
