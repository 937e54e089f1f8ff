//! Trailing matrix with changed values, factored anew in the pattern of the existing factor.
//!
//! ```text
//!     M = L_tt L_tt' - sum_e P_e' A_e P_e
//! ```
//!
//! Small matrices `A_e` on freedoms that the condensed matrix couples stay within the pattern of
//! `L_tt`: the panels of `L_tt` can hold the factor of `M`, too.
//!
//! # Source
//! E. G. Ng, B. W. Peyton, *Block sparse Cholesky algorithms on advanced uniprocessor computers*,
//! SIAM J. Sci. Comput. 14 (1993) 1034, doi:10.1137/0914063 (supernodes, relative indices).

use super::{Panel, TrailingFactor, panel};
use crate::linalg::{ChangedFactor, ContactStiffness, ZonePart, blocked};
use nalgebra::{DMatrix, DMatrixViewMut};

/// Matrix `M` with its factor.
pub(crate) struct Changed {
    factor: TrailingFactor,
    shift: Vec<f64>,
    /// Matrix `L_tt L_tt'`, panel by panel, each with all its rows, column by column; empty until
    /// it is needed.
    unchanged: Vec<f64>,
    /// Matrix `M`, overwritten by its factor panel by panel.
    work: Vec<f64>,
    /// Number of values in `unchanged` and in `work`.
    size: usize,
    /// Start of each panel in `unchanged` and `work`.
    starts: Vec<usize>,
    /// Panel of each column.
    panel_of: Vec<u32>,
    /// Column of each freedom, zone freedoms first, then contact freedoms.
    columns: Vec<u32>,
    /// Places of the rows of an update in the panel that it changes.
    places: Vec<u32>,
    flops: f64,
}

impl Changed {
    /// Makes a changed factor for the trailing factor of a matrix with this shift.
    pub(crate) fn new(trailing: &TrailingFactor, shift: &[f64]) -> Self {
        let factor = trailing.like();
        let mut panel_of = vec![0; factor.kept.len()];
        let mut starts = Vec::with_capacity(factor.panels.len());
        let (mut size, mut flops, mut tallest) = (0, 0.0, 0);
        for (k, p) in factor.panels.iter().enumerate() {
            panel_of[p.first..p.first + p.width].fill(k as u32);
            starts.push(size);
            size += p.width * p.height();
            tallest = tallest.max(p.height());
            let heights = (0..p.width).map(|column| (p.height() - column) as f64);
            flops += heights.map(|height| height * height).sum::<f64>();
        }
        let n_zone = factor.n_zone;
        let mut columns = vec![0; factor.kept.len()];
        for (column, &place) in factor.zone.iter().enumerate() {
            columns[place as usize] = column as u32;
        }
        for (column, &place) in factor.contact.iter().enumerate() {
            columns[n_zone + place as usize] = (n_zone + column) as u32;
        }
        Changed {
            factor,
            shift: shift.to_vec(),
            size,
            unchanged: Vec::new(),
            work: Vec::new(),
            starts,
            panel_of,
            columns,
            places: vec![0; tallest],
            flops,
        }
    }

    /// Computes `unchanged = L L'`.
    fn multiply(&mut self) {
        let mut values = vec![0.0; self.size];
        for k in 0..self.factor.panels.len() {
            let block = self.factor.block(k);
            let product = blocked::outer(&block, |_| block.ncols());
            self.add_product(k, 0, 1.0, &product, &mut values);
        }
        self.unchanged = values;
    }

    /// Adds `factor` times a symmetric matrix (its lower triangle) on the rows of a panel from
    /// `first` on.
    fn add_product(
        &mut self,
        panel: usize,
        first: usize,
        factor: f64,
        product: &DMatrix<f64>,
        values: &mut [f64],
    ) {
        let panels = &self.factor.panels;
        let p = &panels[panel];
        let list = &self.factor.rows[p.rows.clone()];
        let row = |i: usize| match i.checked_sub(p.width) {
            Some(below) => list[below] as usize,
            None => p.first + i,
        };
        let height = p.height();
        let mut begin = first;
        while begin < height {
            let target = self.panel_of[row(begin)] as usize;
            let q = &panels[target];
            let rows = (begin..height).map(row);
            place_rows(q, &self.factor.rows[q.rows.clone()], rows, &mut self.places);
            let mut column = begin;
            while column < height && row(column) < q.first + q.width {
                let start = self.starts[target] + (row(column) - q.first) * q.height();
                let own = &mut values[start..start + q.height()];
                let product = product.column(column - first);
                let entries = &product.as_slice()[column - first..];
                for (&place, entry) in self.places[column - begin..].iter().zip(entries) {
                    own[place as usize] += factor * entry;
                }
                column += 1;
            }
            begin = column;
        }
    }

    /// Factors the matrix in `work`; returns false if a pivot is not positive.
    fn factor_work(&mut self, work: &mut [f64]) -> bool {
        for k in 0..self.factor.panels.len() {
            let p = &self.factor.panels[k];
            let (width, height, start) = (p.width, p.height(), self.starts[k]);
            let values = &mut work[start..start + width * height];
            let mut values = DMatrixViewMut::from_slice(values, height, width);
            let Some(below) = factor_panel(&mut values) else {
                return false;
            };
            if height > width {
                let product = blocked::outer(&below, |_| width);
                self.add_product(k, width, -1.0, &product, work);
            }
        }
        true
    }
}

/// Factors a panel to which all earlier updates have been applied. Returns the rows below the
/// triangle; `None` if a pivot is not positive.
fn factor_panel(values: &mut DMatrixViewMut<f64>) -> Option<DMatrix<f64>> {
    let (height, width) = values.shape();
    let own = values.rows(0, width).into_owned().cholesky()?.unpack();
    values.rows_mut(0, width).copy_from(&own);
    // L_21 = A_21 L_11^-T, computed by its transpose.
    let mut right = values.rows(width, height - width).transpose();
    own.solve_lower_triangular_unchecked_mut(&mut right);
    let below = right.transpose();
    values.rows_mut(width, height - width).copy_from(&below);
    Some(below)
}

/// Writes to `places` where the ascending `rows` lie in panel `q`, which contains all of them;
/// `list` holds the rows of `q` below its triangle.
fn place_rows(q: &Panel, list: &[u32], rows: impl Iterator<Item = usize>, places: &mut [u32]) {
    let mut next = 0;
    for (row, place) in rows.zip(places) {
        *place = match row < q.first + q.width {
            true => (row - q.first) as u32,
            false => {
                while (list[next] as usize) < row {
                    next += 1;
                }
                (q.width + next) as u32
            }
        };
    }
}

impl ChangedFactor for Changed {
    fn flops(&self) -> [f64; 2] {
        [self.flops, 4.0 * self.factor.values.len() as f64]
    }

    fn begin(&mut self) {
        if self.unchanged.is_empty() {
            self.multiply();
        }
        self.work.clone_from(&self.unchanged);
    }

    fn take_off(&mut self, places: &[u32], matrix: &[f64]) {
        let n = places.len();
        for (j, &b) in places.iter().enumerate() {
            let column = self.columns[b as usize] as usize;
            let k = self.panel_of[column] as usize;
            let p = &self.factor.panels[k];
            let start = self.starts[k] + (column - p.first) * p.height();
            let list = &self.factor.rows[p.rows.clone()];
            for (i, &a) in places.iter().enumerate() {
                let row = self.columns[a as usize] as usize;
                if row < column {
                    continue;
                }
                let place = match (row - p.first).checked_sub(p.width) {
                    Some(_) => p.width + list.partition_point(|&other| (other as usize) < row),
                    None => row - p.first,
                };
                self.work[start + place] -= matrix[j * n + i];
            }
        }
    }

    fn factor(&mut self) -> bool {
        let mut work = std::mem::take(&mut self.work);
        let done = self.factor_work(&mut work);
        if done {
            self.factor.store(&work, &self.starts);
        }
        self.work = work;
        done
    }

    fn contact_stiffness(&self) -> ContactStiffness {
        self.factor.contact_stiffness(&self.shift)
    }

    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]) {
        self.factor.eliminate_zone(zone, contact);
    }

    fn recover_part(&self, part: &ZonePart, zone: &mut [f64], u_contact: &[f64]) {
        self.factor.recover_zone(part, zone, u_contact);
    }
}

impl Panel {
    /// Number of rows of the panel's columns, including those above the diagonal.
    fn height(&self) -> usize {
        self.width + self.rows.len()
    }
}

impl TrailingFactor {
    /// Makes another factor with the same columns.
    fn like(&self) -> Self {
        let mut like = TrailingFactor {
            n_zone: self.n_zone,
            kept: self.kept.clone(),
            zone: self.zone.clone(),
            contact: self.contact.clone(),
            panels: self.panels.clone(),
            n_zone_panels: self.n_zone_panels,
            parents: Vec::new(),
            subtrees: Vec::new(),
            rows: self.rows.clone(),
            values: self.values.clone(),
            work: Default::default(),
        };
        like.find_subtrees();
        like.make_room();
        like
    }

    /// A panel as a matrix of all its rows, zero above the diagonal.
    fn block(&self, k: usize) -> DMatrix<f64> {
        let p = &self.panels[k];
        let (width, below) = (p.width, p.rows.len());
        let mut block = DMatrix::zeros(p.height(), width);
        let triangle = &self.values[p.triangle()];
        panel::read_triangle(width, triangle, |i, j, value| block[(i, j)] = value);
        let rectangle = &self.values[p.rectangle()];
        panel::read_rectangle(below, width, rectangle, |i, j, value| {
            block[(width + i, j)] = value;
        });
        block
    }

    /// Stores the values of a factor with the same panels, given by columns.
    fn store(&mut self, columns: &[f64], starts: &[usize]) {
        self.values.clear();
        for (p, &start) in self.panels.iter().zip(starts) {
            let (width, height) = (p.width, p.height());
            let column = |k: usize| &columns[start + k * height..][..height];
            panel::store_triangle(width, |k| &column(k)[k..width], &mut self.values);
            let below = height - width;
            panel::store_rectangle(below, width, |k| &column(k)[width..], &mut self.values);
        }
    }
}
