//! Sums over the rows of a symmetric matrix that is stored as its upper triangle.

use super::SymmetricCsc;
use rayon::prelude::*;
use std::ops::Range;

/// Number of parts of the matrix that are processed in parallel. It is fixed, so that the order of
/// summation does not depend on the number of threads.
const PARTS: usize = 4;
/// Number of entries from which a matrix is processed in parallel: with fewer entries, waking a
/// thread costs more than it saves.
const MANY: usize = 1 << 15;
/// Number of rows that a thread takes at a time.
const GRAIN: usize = 1 << 14;

/// Product `y = K x` for the stored upper triangle.
pub fn multiply(matrix: &SymmetricCsc, x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for (j, column) in matrix.outer_iterator().enumerate() {
        let mut sum = 0.0;
        for (i, &a) in column.iter() {
            sum += a * x[i];
            if i != j {
                y[i] += a * x[j];
            }
        }
        y[j] += sum;
    }
}

/// Infinity norm `|K|`: the largest sum of absolute values of a row.
pub fn norm(matrix: &SymmetricCsc) -> f64 {
    let mut rows = vec![0.0f64; matrix.rows()];
    for (j, column) in matrix.outer_iterator().enumerate() {
        for (i, &a) in column.iter() {
            rows[i] += a.abs();
            if i != j {
                rows[j] += a.abs();
            }
        }
    }
    largest(&rows)
}

/// Largest absolute value; NaN if any value is NaN.
pub(crate) fn largest(values: &[f64]) -> f64 {
    largest_of(values.len(), |i| values[i].abs())
}

/// Largest of `n` nonnegative values; NaN if any value is NaN.
fn largest_of(n: usize, value: impl Fn(usize) -> f64 + Sync) -> f64 {
    let of = |rows: Range<usize>| {
        let (mut largest, mut lost) = (0.0, false);
        for i in rows {
            let value = value(i);
            lost |= value.is_nan();
            largest = if value > largest { value } else { largest };
        }
        if lost { f64::NAN } else { largest }
    };
    if n <= GRAIN {
        return of(0..n);
    }
    let parts = (0..n.div_ceil(GRAIN)).into_par_iter();
    let parts = parts.map(|part| of(part * GRAIN..((part + 1) * GRAIN).min(n)));
    parts.reduce(|| 0.0, |a, b| if a > b || a.is_nan() { a } else { b })
}

/// Row sums from one pass over `K`, for a solution `u` of `K u = f`.
pub(super) struct RowSums {
    /// Residual `f - K u` of each row.
    pub residual: Vec<f64>,
    /// Sum `|K| |u|` of each row.
    pub terms: Vec<f64>,
    /// Sum of `|K|` over each row.
    pub stiffness: Vec<f64>,
}

/// Block of rows with the same numbers as the columns of a part of the matrix.
struct RowBlock<'a> {
    columns: Range<usize>,
    residual: &'a mut [f64],
    terms: &'a mut [f64],
    stiffness: &'a mut [f64],
    /// Contributions of the columns to rows above this block: `K u`, `|K| |u|` and `|K|`. The entry
    /// at place `i` belongs to row `columns.start - 1 - i`.
    before: Vec<[f64; 3]>,
}

impl RowSums {
    pub(super) fn new(matrix: &SymmetricCsc, f: &[f64], u: &[f64]) -> Self {
        let (n, pointers) = (u.len(), matrix.proper_indptr());
        let mut rows = RowSums {
            residual: f.to_vec(),
            terms: vec![0.0; n],
            stiffness: vec![0.0; n],
        };
        // Each part gets the same number of entries.
        let bound = |part: usize| {
            let entry = (matrix.nnz() * part / PARTS) as i64;
            pointers[..n].partition_point(|p| *p < entry)
        };
        let mut parts = Vec::with_capacity(PARTS);
        let (mut residual, mut terms) = (rows.residual.as_mut_slice(), rows.terms.as_mut_slice());
        let mut stiffness = rows.stiffness.as_mut_slice();
        for part in 0..PARTS {
            let columns = bound(part)..if part + 1 == PARTS {
                n
            } else {
                bound(part + 1)
            };
            let own = columns.len();
            parts.push(RowBlock {
                columns,
                residual: residual.split_off_mut(..own).unwrap_or_default(),
                terms: terms.split_off_mut(..own).unwrap_or_default(),
                stiffness: stiffness.split_off_mut(..own).unwrap_or_default(),
                before: Vec::new(),
            });
        }
        let at_once = if matrix.nnz() < MANY { PARTS } else { 1 };
        parts
            .par_iter_mut()
            .with_min_len(at_once)
            .for_each(|part| part.subtract_products(matrix, &pointers, u));
        let before: Vec<_> = parts
            .into_iter()
            .map(|part| (part.columns.start, part.before))
            .collect();
        for (first, sums) in before {
            for (i, [product, terms, stiffness]) in sums.into_iter().enumerate() {
                let row = first - 1 - i;
                rows.residual[row] -= product;
                rows.terms[row] += terms;
                rows.stiffness[row] += stiffness;
            }
        }
        rows
    }

    /// Componentwise backward error: the largest ratio of a row's `|f - K u|` to its
    /// `|K| |u| + |f|`. Rows without load and almost without displacement are measured against
    /// their own stiffness times the largest displacement (Arioli, Demmel, Duff 1989).
    pub(super) fn componentwise_error(&self, f: &[f64], u: &[f64]) -> f64 {
        let moved = largest(u);
        let tiny = 1000.0 * u.len() as f64 * f64::EPSILON;
        largest_of(u.len(), |i| {
            let own = self.terms[i] + f[i].abs();
            let scale = if own > tiny * (self.stiffness[i] * moved + f[i].abs()) {
                own
            } else {
                self.terms[i] + self.stiffness[i] * moved
            };
            match self.residual[i].abs() {
                0.0 => 0.0,
                r => r / scale,
            }
        })
    }
}

impl RowBlock<'_> {
    /// Subtracts the products of the part's columns of the upper triangle, and of their mirrored
    /// rows, from the residual and adds up their sizes.
    fn subtract_products(&mut self, matrix: &SymmetricCsc, pointers: &[i64], u: &[f64]) {
        let (rows, values) = (matrix.indices(), matrix.data());
        let first = self.columns.start;
        for j in self.columns.clone() {
            let [begin, end] = [pointers[j], pointers[j + 1]].map(|p| p as usize);
            let u_j = u[j];
            let (mut sum, mut terms, mut stiffness) = (0.0, 0.0, 0.0);
            for (&i, &a) in rows[begin..end].iter().zip(&values[begin..end]) {
                let i = i as usize;
                let (product, size) = (a * u[i], a.abs());
                sum += product;
                terms += product.abs();
                stiffness += size;
                if i == j {
                    continue;
                }
                let mirrored = a * u_j;
                if i >= first {
                    self.residual[i - first] -= mirrored;
                    self.terms[i - first] += mirrored.abs();
                    self.stiffness[i - first] += size;
                } else {
                    let place = first - 1 - i;
                    if place >= self.before.len() {
                        self.before.resize(place + 1, [0.0; 3]);
                    }
                    let before = &mut self.before[place];
                    *before = [
                        before[0] + mirrored,
                        before[1] + mirrored.abs(),
                        before[2] + size,
                    ];
                }
            }
            self.residual[j - first] -= sum;
            self.terms[j - first] += terms;
            self.stiffness[j - first] += stiffness;
        }
    }
}
