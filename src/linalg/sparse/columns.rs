//! Columns of a factor `L`, read where they are stored.

use std::ops::Range;

/// A column of `L`: its rows, ascending from the diagonal, and their values.
pub(crate) struct FactorColumn<'a> {
    pub(crate) rows: &'a [i64],
    pub(crate) values: &'a [f64],
}

/// Columns of `L` in one of two storage schemes.
pub(crate) enum FactorColumns<'a> {
    /// Dense trapezoids of neighbouring columns.
    Supernodal(Supernodes<'a>),
    /// Compressed sparse columns.
    #[cfg_attr(not(feature = "cholmod"), allow(dead_code))]
    Simplicial {
        starts: &'a [i64],
        counts: &'a [i64],
        rows: &'a [i64],
        values: &'a [f64],
    },
}

/// Neighbouring columns with the same rows, as dense trapezoids within rectangles: each column has
/// as many values as the supernode has rows; values above the diagonal have no meaning.
pub(crate) struct Supernodes<'a> {
    /// First column of each supernode, followed by the number of columns.
    pub(crate) starts: &'a [i64],
    /// Start of the rows of each supernode, followed by the number of rows.
    pub(crate) row_starts: &'a [i64],
    /// Start of the values of each supernode, followed by the number of values.
    pub(crate) value_starts: &'a [i64],
    /// Rows of all supernodes; the rows of a supernode ascend and start with its own columns.
    pub(crate) rows: &'a [i64],
    /// Values of all supernodes.
    pub(crate) values: &'a [f64],
}

impl<'a> Supernodes<'a> {
    /// Number of supernodes.
    pub(crate) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Number of columns of `L`.
    pub(crate) fn n_columns(&self) -> usize {
        self.starts.last().map_or(0, |&n| n as usize)
    }

    /// Range of the columns of a supernode.
    pub(crate) fn columns(&self, s: usize) -> Range<usize> {
        self.starts[s] as usize..self.starts[s + 1] as usize
    }

    /// Rows of the first column of a supernode.
    pub(crate) fn rows(&self, s: usize) -> &'a [i64] {
        &self.rows[self.row_starts[s] as usize..self.row_starts[s + 1] as usize]
    }

    /// Values of a supernode, column by column.
    pub(crate) fn values(&self, s: usize) -> &'a [f64] {
        let start = self.value_starts[s] as usize;
        &self.values[start..start + self.rows(s).len() * self.columns(s).len()]
    }
}

impl<'a> FactorColumns<'a> {
    /// Diagonal entries of `L`.
    pub(crate) fn pivots(&self) -> Vec<f64> {
        match self {
            FactorColumns::Supernodal(supernodes) => (0..supernodes.len())
                .flat_map(|s| {
                    let (values, height) = (supernodes.values(s), supernodes.rows(s).len());
                    (0..supernodes.columns(s).len()).map(move |k| values[k * height + k])
                })
                .collect(),
            FactorColumns::Simplicial { starts, values, .. } => {
                starts.iter().map(|&start| values[start as usize]).collect()
            }
        }
    }

    /// Finds column `j` within its supernode.
    pub(crate) fn get(&self, j: usize) -> FactorColumn<'a> {
        match self {
            FactorColumns::Supernodal(supernodes) => {
                let s = supernodes
                    .starts
                    .partition_point(|&start| start as usize <= j)
                    - 1;
                let within = j - supernodes.columns(s).start;
                let rows = supernodes.rows(s);
                FactorColumn {
                    rows: &rows[within..],
                    values: &supernodes.values(s)[within * rows.len() + within..]
                        [..rows.len() - within],
                }
            }
            FactorColumns::Simplicial {
                starts,
                counts,
                rows,
                values,
            } => {
                let range = starts[j] as usize..(starts[j] + counts[j]) as usize;
                FactorColumn {
                    rows: &rows[range.clone()],
                    values: &values[range],
                }
            }
        }
    }
}
