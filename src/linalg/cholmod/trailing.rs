//! The trailing columns of `L`, those of zone and contact freedoms, in storage of their own.
//!
//! ```text
//!     L_tt = [ L_zz      ]     L_tt L_tt' = S + diag(shift)
//!            [ L_cz L_cc ]
//! ```
//!
//! These solves are the hot loop of a plastic analysis: thousands of calls, each bound by how fast the
//! memory delivers `L_tt`. Columns of the same structure are kept as dense panels of at most
//! [`PANEL_WIDTH`] columns: a lower triangle, then a rectangle whose rows are listed once, both stored as the kernels ([`panel`])
//! read them.
//!
//! Of the zone only a part may be needed. A set of columns that holds with a column all rows of its structure (its
//! ancestors in the elimination tree) may as well have been eliminated after all others: its block of `L` is the
//! factor of the structure condensed onto it. So a zone shrinks, and grows back, without another factorisation.

use super::factor::{Columns, Factor};
use super::ordering::Groups;
use super::panel;
use super::tree::Forest;
use crate::error::{Error, Result};
use crate::linalg::Partition;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Columns of a panel: enough that rows are gathered rarely. 16, 32 and 64 differ by a few per cent.
const PANEL_WIDTH: usize = 64;

/// Neighbouring columns of one group with the same structure.
#[derive(Debug)]
struct Panel {
    /// First column (trailing numbering: zone, then contact, in the order of the factor).
    first: usize,
    width: usize,
    /// Rows below the panel's own columns, in `Trailing::rows`.
    rows: Range<usize>,
    /// First value in `Trailing::values`: the triangle, then the rectangle.
    values: usize,
}

impl Panel {
    fn triangle(&self) -> Range<usize> {
        self.values..self.values + panel::triangle_len(self.width)
    }

    fn rectangle(&self) -> Range<usize> {
        let start = self.triangle().end;
        start..start + self.width * self.rows.len()
    }
}

/// Workspace of one solve.
#[derive(Debug)]
struct Work {
    /// All trailing freedoms in the order of the factor.
    vector: Vec<f64>,
    /// The rows of one panel.
    rows: Vec<f64>,
    subtrees: Vec<WorkOfSubtree>,
}

/// Panels that may be solved while those of other subtrees are. They see a vector of their own, `[ columns | outer ]`: what a subtree
/// does to rows outside it stands in the rows of its last panel, its root.
#[derive(Debug)]
struct Subtree {
    panels: Range<usize>,
    columns: Range<usize>,
    /// Rows of the root, in `Trailing::rows`.
    outer: Range<usize>,
    /// Where the rows of each panel begin in `own_rows`.
    starts: Vec<usize>,
    /// The rows of all panels in the subtree's own numbering.
    own_rows: Vec<u32>,
}

#[derive(Debug)]
struct WorkOfSubtree {
    vector: Vec<f64>,
    rows: Vec<f64>,
}

/// `L_tt` and its solves.
#[derive(Debug)]
pub(super) struct Trailing {
    n_zone: usize,
    /// Trailing columns of the factor (0 is the first of the factored zone) that are kept, ascending.
    kept: Vec<u32>,
    /// Place in the kept zone of each zone column.
    zone: Vec<u32>,
    /// Place in the partition's contact list of each contact column.
    contact: Vec<u32>,
    panels: Vec<Panel>,
    n_zone_panels: usize,
    /// Disjoint subtrees of the zone's panels, ascending.
    subtrees: Vec<Subtree>,
    rows: Vec<u32>,
    values: Vec<f64>,
    work: Mutex<Work>,
}

impl Trailing {
    /// Copies the trailing columns out of `factor`, whose groups are contiguous: those of the contact freedoms, and of the
    /// zone those that the freedoms `wanted` need. Returns the zone freedoms kept (ascending) with it.
    pub(super) fn extract(
        factor: &Factor,
        groups: &Groups,
        partition: &Partition,
        wanted: &[usize],
    ) -> Result<(Self, Vec<usize>)> {
        let [_, first_zone, first_contact, n] = groups.starts();
        let permutation = factor.permutation();
        let columns = factor.columns();
        let needed = needed(
            &columns,
            permutation,
            first_zone..first_contact,
            n,
            partition,
            wanted,
        );
        let kept: Vec<u32> = (0..needed.len() as u32)
            .filter(|&j| needed[j as usize])
            .collect();
        let mut number = vec![u32::MAX; needed.len()];
        for (new, &old) in kept.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let n_zone = kept.partition_point(|&j| (j as usize) < first_contact - first_zone);
        let freedom_of = |&j: &u32| permutation[first_zone + j as usize] as usize;
        let mut zone: Vec<usize> = kept[..n_zone].iter().map(freedom_of).collect();
        zone.sort_unstable();
        let mut place = vec![0u32; n];
        for list in [&zone, &partition.contact] {
            for (k, &freedom) in list.iter().enumerate() {
                place[freedom] = k as u32;
            }
        }
        let places = |columns: &[u32]| -> Vec<u32> {
            columns.iter().map(|j| place[freedom_of(j)]).collect()
        };
        let mut trailing = Trailing {
            n_zone,
            zone: places(&kept[..n_zone]),
            contact: places(&kept[n_zone..]),
            panels: Vec::new(),
            n_zone_panels: 0,
            subtrees: Vec::new(),
            rows: Vec::new(),
            values: Vec::new(),
            work: Mutex::new(Work {
                vector: vec![0.0; kept.len()],
                rows: Vec::new(),
                subtrees: Vec::new(),
            }),
            kept,
        };
        let nonzeros = trailing
            .kept
            .iter()
            .map(|&j| columns.get(first_zone + j as usize).rows.len())
            .sum();
        trailing
            .values
            .try_reserve_exact(nonzeros)
            .map_err(|cause| {
                Error::analysis(format!(
                    "out of memory for the {nonzeros} nonzeros of the zone's factor: choose a smaller zone"
                ))
                .because(cause)
            })?;
        trailing.copy_panels(&columns, &number, first_zone, first_zone..first_contact);
        trailing.n_zone_panels = trailing.panels.len();
        trailing.copy_panels(&columns, &number, first_zone, first_contact..n);
        trailing.find_subtrees();
        let tallest = |panels: &[Panel]| panels.iter().map(|p| p.rows.len()).max().unwrap_or(0);
        let rows = vec![0.0; tallest(&trailing.panels)];
        let subtrees = trailing.subtrees.iter().map(|t| WorkOfSubtree {
            vector: vec![0.0; t.columns.len() + t.outer.len()],
            rows: vec![0.0; tallest(&trailing.panels[t.panels.clone()])],
        });
        let subtrees = subtrees.collect();
        let work = trailing.work.get_mut();
        let work = work.unwrap_or_else(PoisonError::into_inner);
        (work.rows, work.subtrees) = (rows, subtrees);
        Ok((trailing, zone))
    }

    /// Appends the panels of those columns of the factor in `range` that have a `number` among the kept ones; `origin`
    /// is the factor's first trailing column.
    fn copy_panels(
        &mut self,
        columns: &Columns,
        number: &[u32],
        origin: usize,
        range: Range<usize>,
    ) {
        let mut j = range.start;
        // Rows (factor numbering, from a column's diagonal down) that end with `self.rows[listed]`.
        let mut previous: &[i64] = &[];
        let mut listed = 0..0;
        while j < range.end {
            if number[j - origin] == u32::MAX {
                j += 1;
                continue;
            }
            let head = columns.get(j);
            let mut width = 1;
            while width < PANEL_WIDTH
                && j + width < range.end
                && same_rows(
                    columns.get(j + width).rows,
                    &head.rows[width.min(head.rows.len())..],
                )
            {
                width += 1;
            }
            let below = &head.rows[width..];
            // The next panel of a wide supernode uses the tail of the list of the one before.
            let rows = if below.len() <= previous.len()
                && same_rows(&previous[previous.len() - below.len()..], below)
            {
                listed.end - below.len()..listed.end
            } else {
                let start = self.rows.len();
                self.rows
                    .extend(below.iter().map(|&row| number[row as usize - origin]));
                start..self.rows.len()
            };
            previous = below;
            listed = rows.clone();
            let values = self.values.len();
            panel::store_triangle(
                width,
                |k| &columns.get(j + k).values[..width - k],
                &mut self.values,
            );
            panel::store_rectangle(
                below.len(),
                width,
                |k| &columns.get(j + k).values[width - k..],
                &mut self.values,
            );
            self.panels.push(Panel {
                first: number[j - origin] as usize,
                width,
                rows,
                values,
            });
            j += width;
        }
    }

    /// Cuts the elimination tree of the zone's panels.
    fn find_subtrees(&mut self) {
        let zone = &self.panels[..self.n_zone_panels];
        let panel_of = |column: u32| zone.partition_point(|p| p.first + p.width <= column as usize);
        let parent: Vec<usize> = zone
            .iter()
            .map(|p| match self.rows[p.rows.clone()].first() {
                Some(&row) if (row as usize) < self.n_zone => panel_of(row),
                _ => usize::MAX,
            })
            .collect();
        let work: Vec<u64> = zone
            .iter()
            .map(|p| (p.rectangle().end - p.values) as u64)
            .collect();
        let forest = Forest {
            parent: &parent,
            work: &work,
        };
        for panels in forest.subtrees() {
            let (first, root) = (zone[panels.start].first, &zone[panels.end - 1]);
            let columns = first..root.first + root.width;
            let outer = &self.rows[root.rows.clone()];
            let (mut starts, mut own_rows) = (Vec::with_capacity(panels.len()), Vec::new());
            for p in &zone[panels.clone()] {
                starts.push(own_rows.len());
                own_rows.extend(self.rows[p.rows.clone()].iter().map(|&row| {
                    match columns.contains(&(row as usize)) {
                        true => row - first as u32,
                        // Rows of a descendant outside the subtree are rows of the root.
                        false => (columns.len() + outer.partition_point(|o| *o < row)) as u32,
                    }
                }));
            }
            self.subtrees.push(Subtree {
                panels,
                columns,
                outer: root.rows.clone(),
                starts,
                own_rows,
            });
        }
    }

    /// The zone's panels that are in no subtree, in their order.
    fn top(&self) -> impl DoubleEndedIterator<Item = &Panel> {
        let begins = [0]
            .into_iter()
            .chain(self.subtrees.iter().map(|t| t.panels.end));
        let ends = self.subtrees.iter().map(|t| t.panels.start);
        let gaps: Vec<_> = begins.zip(ends.chain([self.n_zone_panels])).collect();
        gaps.into_iter()
            .flat_map(|(begin, end)| &self.panels[begin..end])
    }

    /// The panels of a subtree with their rows.
    fn panels_of<'a>(
        &'a self,
        tree: &'a Subtree,
    ) -> impl DoubleEndedIterator<Item = (&'a Panel, &'a [u32])> {
        let panels = self.panels[tree.panels.clone()].iter().zip(&tree.starts);
        panels.map(|(p, &start)| (p, &tree.own_rows[start..start + p.rows.len()]))
    }

    /// Forward substitution with the columns of a panel: `own = L^-1 own`, and `below -= L own` for its rows, which `rows` number
    /// from `offset`.
    fn forward(
        &self,
        p: &Panel,
        rows: &[u32],
        (own, below): (&mut [f64], &mut [f64]),
        offset: usize,
        sums: &mut [f64],
    ) {
        // A load on a part of the zone (where the material flows) reaches only the panels above that part.
        if own.iter().all(|value| *value == 0.0) {
            return;
        }
        let sums = &mut sums[..rows.len()];
        panel::solve_lower(&self.values[p.triangle()], own);
        panel::multiply(&self.values[p.rectangle()], own, sums);
        for (&row, &sum) in rows.iter().zip(&*sums) {
            below[row as usize - offset] -= sum;
        }
    }

    /// Backward substitution: `own = L^-T (own - L' below)`.
    fn backward(
        &self,
        p: &Panel,
        rows: &[u32],
        (own, below): (&mut [f64], &mut [f64]),
        offset: usize,
        known: &mut [f64],
    ) {
        let known = &mut known[..rows.len()];
        for (value, &row) in known.iter_mut().zip(rows) {
            *value = below[row as usize - offset];
        }
        panel::subtract_transposed(&self.values[p.rectangle()], known, own);
        panel::solve_upper(&self.values[p.triangle()], own);
    }

    /// `f_t = L_tt y_t`, given for all trailing columns of the factor, returned for the kept ones in the partition's order.
    pub(super) fn condensed_load(&self, y: &[f64], zone: &mut [f64], contact: &mut [f64]) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let Work { vector, rows, .. } = &mut *work;
        for (value, &column) in vector.iter_mut().zip(&self.kept) {
            *value = y[column as usize];
        }
        // From the last panel to the first: what a panel reads has not been overwritten yet.
        for p in self.panels.iter().rev() {
            let list = &self.rows[p.rows.clone()];
            let sums = &mut rows[..list.len()];
            let (own, below) = vector[p.first..].split_at_mut(p.width);
            panel::multiply(&self.values[p.rectangle()], own, sums);
            panel::multiply_lower(&self.values[p.triangle()], own);
            let offset = p.first + p.width;
            for (&row, &sum) in list.iter().zip(&*sums) {
                below[row as usize - offset] += sum;
            }
        }
        let (y_zone, y_contact) = vector.split_at(self.n_zone);
        scatter(&self.zone, y_zone, zone);
        scatter(&self.contact, y_contact, contact);
    }

    /// `y_z = L_zz^-1 f_z` left in `zone` in the order of the factor, and `contact -= L_cz y_z`.
    pub(super) fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let Work {
            vector,
            rows,
            subtrees,
        } = &mut *work;
        let (v_zone, v_contact) = vector.split_at_mut(self.n_zone);
        gather(&self.zone, zone, v_zone);
        gather(&self.contact, contact, v_contact);
        let whole = &*vector;
        self.subtrees
            .par_iter()
            .zip(&mut *subtrees)
            .for_each(|(tree, work)| {
                let (own, outer) = work.vector.split_at_mut(tree.columns.len());
                own.copy_from_slice(&whole[tree.columns.clone()]);
                outer.fill(0.0);
                for (p, rows) in self.panels_of(tree) {
                    let end = p.first + p.width - tree.columns.start;
                    let (done, below) = work.vector.split_at_mut(end);
                    let own = &mut done[end - p.width..];
                    self.forward(p, rows, (own, below), end, &mut work.rows);
                }
            });
        for (tree, work) in self.subtrees.iter().zip(&*subtrees) {
            let (own, outer) = work.vector.split_at(tree.columns.len());
            vector[tree.columns.clone()].copy_from_slice(own);
            for (&row, value) in self.rows[tree.outer.clone()].iter().zip(outer) {
                vector[row as usize] += value;
            }
        }
        for p in self.top() {
            let end = p.first + p.width;
            let (done, below) = vector.split_at_mut(end);
            let own = (&mut done[p.first..], below);
            self.forward(p, &self.rows[p.rows.clone()], own, end, rows);
        }
        let (v_zone, v_contact) = vector.split_at(self.n_zone);
        zone.copy_from_slice(v_zone);
        scatter(&self.contact, v_contact, contact);
    }

    /// `u_z = L_zz^-T (y_z - L_cz' u_c)`, with `zone` as [`Trailing::eliminate_zone`] left it.
    pub(super) fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let Work {
            vector,
            rows,
            subtrees,
        } = &mut *work;
        let (v_zone, v_contact) = vector.split_at_mut(self.n_zone);
        v_zone.copy_from_slice(zone);
        gather(&self.contact, u_contact, v_contact);
        for p in self.top().rev() {
            let end = p.first + p.width;
            let (done, below) = vector.split_at_mut(end);
            let own = (&mut done[p.first..], below);
            self.backward(p, &self.rows[p.rows.clone()], own, end, rows);
        }
        let whole = &*vector;
        self.subtrees
            .par_iter()
            .zip(&mut *subtrees)
            .for_each(|(tree, work)| {
                let (own, outer) = work.vector.split_at_mut(tree.columns.len());
                own.copy_from_slice(&whole[tree.columns.clone()]);
                for (value, &row) in outer.iter_mut().zip(&self.rows[tree.outer.clone()]) {
                    *value = whole[row as usize];
                }
                for (p, rows) in self.panels_of(tree).rev() {
                    let end = p.first + p.width - tree.columns.start;
                    let (done, below) = work.vector.split_at_mut(end);
                    let own = &mut done[end - p.width..];
                    self.backward(p, rows, (own, below), end, &mut work.rows);
                }
            });
        for (tree, work) in self.subtrees.iter().zip(&*subtrees) {
            vector[tree.columns.clone()].copy_from_slice(&work.vector[..tree.columns.len()]);
        }
        scatter(&self.zone, &vector[..self.n_zone], zone);
    }

    /// Puts the displacements of zone and contact freedoms on the trailing columns of the factor that are kept; `known` says which
    /// these are.
    pub(super) fn place(&self, zone: &[f64], contact: &[f64], known: &mut [bool], x: &mut [f64]) {
        let values = (self.zone.iter().map(|&k| zone[k as usize]))
            .chain(self.contact.iter().map(|&k| contact[k as usize]));
        for (&column, value) in self.kept.iter().zip(values) {
            known[column as usize] = true;
            x[column as usize] = value;
        }
    }

    /// `L_cc L_cc' - diag(shift)`, symmetric to the last bit.
    pub(super) fn contact_stiffness(&self, shift: &[f64]) -> DMatrix<f64> {
        let n = self.contact.len();
        // U = L_cc': the columns of U are the rows of L, so products of rows run through memory.
        let mut upper = DMatrix::zeros(n, n);
        let mut unit = [0.0; PANEL_WIDTH];
        let mut below = vec![0.0; n];
        for p in &self.panels[self.n_zone_panels..] {
            let list = &self.rows[p.rows.clone()];
            let first = p.first - self.n_zone;
            for k in 0..p.width {
                // Column k is L times a unit vector: exact, and the storage stays the kernels' own affair.
                let column = &mut unit[..p.width];
                column.fill(0.0);
                column[k] = 1.0;
                panel::multiply(
                    &self.values[p.rectangle()],
                    column,
                    &mut below[..list.len()],
                );
                panel::multiply_lower(&self.values[p.triangle()], column);
                for i in k..p.width {
                    upper[(first + k, first + i)] = column[i];
                }
                for (&row, &value) in list.iter().zip(&below) {
                    upper[(first + k, row as usize - self.n_zone)] = value;
                }
            }
        }
        // (L L')_IJ for blocks J <= I: only the first rows of U, up to the end of J, contribute.
        const BLOCK: usize = 96;
        let mut product = DMatrix::zeros(n, n);
        for j in (0..n).step_by(BLOCK) {
            let width = BLOCK.min(n - j);
            let depth = j + width;
            let left = upper.view((0, j), (depth, n - j)).transpose();
            let right = upper.view((0, j), (depth, width));
            product
                .view_mut((j, j), (n - j, width))
                .gemm(1.0, &left, &right, 0.0);
        }
        let mut stiffness = DMatrix::zeros(n, n);
        for j in 0..n {
            for i in j..n {
                let (a, b) = (self.contact[i] as usize, self.contact[j] as usize);
                stiffness[(a, b)] = product[(i, j)];
                stiffness[(b, a)] = product[(i, j)];
            }
        }
        for (k, &d) in shift.iter().enumerate() {
            stiffness[(k, k)] -= d;
        }
        stiffness
    }
}

/// Which trailing columns (numbered from the first of the zone) are needed: the wanted ones, what their structure names, and
/// all contact columns.
fn needed(
    columns: &Columns,
    permutation: &[i64],
    zone: Range<usize>,
    n: usize,
    partition: &Partition,
    wanted: &[usize],
) -> Vec<bool> {
    let mut is_wanted = vec![false; partition.n];
    for &freedom in wanted {
        is_wanted[freedom] = true;
    }
    let mut needed = vec![false; n - zone.start];
    needed[zone.len()..].fill(true);
    for j in zone.clone() {
        if needed[j - zone.start] || is_wanted[permutation[j] as usize] {
            for &row in columns.get(j).rows {
                needed[row as usize - zone.start] = true;
            }
        }
    }
    needed
}

/// True where two row lists are equal; those of one supernode are the same memory.
fn same_rows(a: &[i64], b: &[i64]) -> bool {
    a.len() == b.len() && (std::ptr::eq(a, b) || a == b)
}

fn gather(places: &[u32], from: &[f64], to: &mut [f64]) {
    for (value, &place) in to.iter_mut().zip(places) {
        *value = from[place as usize];
    }
}

fn scatter(places: &[u32], from: &[f64], to: &mut [f64]) {
    for (&value, &place) in from.iter().zip(places) {
        to[place as usize] = value;
    }
}
