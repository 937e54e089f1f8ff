//! Trailing columns of `L`, which belong to zone and contact freedoms, in storage of their own.
//!
//! ```text
//!     L_tt = [ L_zz      ]     L_tt L_tt' = S + diag(shift)
//!            [ L_cz L_cc ]
//! ```
//!
//! Solves with these columns are the hot loop of a plastic analysis: thousands of calls, each
//! limited by the rate at which memory delivers `L_tt`. Columns of the same structure are kept as
//! dense panels of at most [`PANEL_WIDTH`] columns: a lower triangle, then a rectangle whose rows
//! are listed once, both stored in the sequence in which the kernels ([`panel`]) read them.
//!
//! Only a part of the zone may be needed. Suppose that, for each column of a set, the set contains
//! all rows of its structure (its ancestors in the elimination tree). The set may then as well be
//! eliminated last: its block of `L` is the factor of the structure condensed onto the set. Thus a
//! zone can shrink, and grow back, without another factorisation.

mod changed;
mod substitution;
mod subtree;

use super::tree::Forest;
use super::{FactorColumns, Groups, LowerFactor, panel};
use crate::error::{Error, Result};
use crate::linalg::{ContactBlock, ContactStiffness, Partition, blocked};
pub(crate) use changed::Changed;
use nalgebra::DMatrix;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use subtree::{Subtree, WorkOfSubtree};

/// Largest number of columns of a panel: enough that rows are gathered rarely. 16, 32 and 64 differ
/// by a few per cent.
const PANEL_WIDTH: usize = 64;

/// Neighbouring columns of one group with the same structure.
#[derive(Debug, Clone)]
struct Panel {
    /// First column (trailing numbering: zone, then contact, in the order of the factor).
    first: usize,
    width: usize,
    /// Range in `TrailingFactor::rows` of the rows below the panel's own columns.
    rows: Range<usize>,
    /// Start in `TrailingFactor::values` of the panel's triangle, which its rectangle follows.
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
#[derive(Debug, Default)]
struct SolveWorkspace {
    /// Values of all trailing freedoms in the order of the factor.
    vector: Vec<f64>,
    /// Values in the rows of one panel.
    rows: Vec<f64>,
    subtrees: Vec<WorkOfSubtree>,
}

/// Part `L_tt` of the factor on zone and contact freedoms, with its solves.
#[derive(Debug)]
pub(crate) struct TrailingFactor {
    n_zone: usize,
    /// Trailing columns of the factor that are kept, ascending; column 0 is the first of the
    /// factored zone.
    kept: Vec<u32>,
    /// Place in the kept zone of each zone column.
    zone: Vec<u32>,
    /// Place in the partition's contact list of each contact column.
    contact: Vec<u32>,
    panels: Vec<Panel>,
    n_zone_panels: usize,
    /// Parent of each zone panel: the panel that contains its first row below; `usize::MAX` if that
    /// row is a contact freedom or does not exist.
    parents: Vec<usize>,
    /// Disjoint subtrees of the zone's panels, ascending.
    subtrees: Vec<Subtree>,
    rows: Vec<u32>,
    values: Vec<f64>,
    work: Mutex<SolveWorkspace>,
}

impl TrailingFactor {
    /// Copies trailing columns out of `factor`, whose groups are contiguous: all columns of contact
    /// freedoms, and the zone columns that the freedoms `wanted` need. Also returns the zone
    /// freedoms that are kept (ascending).
    pub(crate) fn extract(
        factor: &dyn LowerFactor,
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
        let mut trailing = TrailingFactor {
            n_zone,
            zone: places(&kept[..n_zone]),
            contact: places(&kept[n_zone..]),
            panels: Vec::new(),
            n_zone_panels: 0,
            parents: Vec::new(),
            subtrees: Vec::new(),
            rows: Vec::new(),
            values: Vec::new(),
            work: Mutex::default(),
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
                    "out of memory for the {nonzeros} nonzeros of the zone's factor: choose a \
                     smaller zone"
                ))
                .because(cause)
            })?;
        trailing.copy_panels(&columns, &number, first_zone, first_zone..first_contact);
        trailing.n_zone_panels = trailing.panels.len();
        trailing.copy_panels(&columns, &number, first_zone, first_contact..n);
        trailing.find_subtrees();
        trailing.make_room();
        Ok((trailing, zone))
    }

    /// Cuts the elimination tree of the zone's panels into subtrees.
    fn find_subtrees(&mut self) {
        let zone = &self.panels[..self.n_zone_panels];
        let panel_of = |column: u32| zone.partition_point(|p| p.first + p.width <= column as usize);
        self.parents = zone
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
            parent: &self.parents,
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
                        // A row outside the subtree that a panel of the subtree has is also a row
                        // of the root.
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

    /// Allocates the workspace of the solves.
    fn make_room(&mut self) {
        let tallest = |panels: &[Panel]| panels.iter().map(|p| p.rows.len()).max().unwrap_or(0);
        let subtrees = self.subtrees.iter().map(|t| WorkOfSubtree {
            vector: vec![0.0; t.columns.len() + t.outer.len()],
            rows: vec![0.0; tallest(&self.panels[t.panels.clone()])],
        });
        let work = SolveWorkspace {
            vector: vec![0.0; self.kept.len()],
            rows: vec![0.0; tallest(&self.panels)],
            subtrees: subtrees.collect(),
        };
        *self.work.get_mut().unwrap_or_else(PoisonError::into_inner) = work;
    }

    /// Appends the panels of those factor columns in `range` that have a `number` among the kept
    /// ones; `origin` is the factor's first trailing column.
    fn copy_panels(
        &mut self,
        columns: &FactorColumns,
        number: &[u32],
        origin: usize,
        range: Range<usize>,
    ) {
        let mut j = range.start;
        // Rows below the previous panel, in factor numbering; `self.rows[listed]` lists them in the
        // numbering of the kept columns.
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
            // The next panel of a wide supernode shares the end of the row list of the panel
            // before.
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
            let mut own: [&[f64]; PANEL_WIDTH] = [&[]; PANEL_WIDTH];
            for (k, column) in own[..width].iter_mut().enumerate() {
                *column = columns.get(j + k).values;
            }
            panel::store_triangle(width, |k| &own[k][..width - k], &mut self.values);
            panel::store_rectangle(
                below.len(),
                width,
                |k| &own[k][width - k..],
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

    /// Number of values that the factor holds.
    pub(crate) fn n_values(&self) -> usize {
        self.values.len()
    }

    /// Writes the displacements of zone and contact freedoms to the kept trailing columns of the
    /// factor, and marks these columns in `known`.
    pub(crate) fn place(&self, zone: &[f64], contact: &[f64], known: &mut [bool], x: &mut [f64]) {
        let values = (self.zone.iter().map(|&k| zone[k as usize]))
            .chain(self.contact.iter().map(|&k| contact[k as usize]));
        for (&column, value) in self.kept.iter().zip(values) {
            known[column as usize] = true;
            x[column as usize] = value;
        }
    }

    /// Contact stiffness `L_cc L_cc' - diag(shift)`, symmetric to the last bit.
    pub(crate) fn contact_stiffness(&self, shift: &[f64]) -> ContactStiffness {
        let bodies = self.uncoupled_contact().into_iter();
        let mut number = vec![usize::MAX; self.contact.len()];
        let blocks = bodies.map(|panels| self.contact_block(&panels, shift, &mut number));
        ContactStiffness::new(blocks.collect())
    }

    /// Panels of contact columns (ascending) of each tree of the elimination forest: columns of
    /// different trees are not coupled.
    fn uncoupled_contact(&self) -> Vec<Vec<&Panel>> {
        let panels = &self.panels[self.n_zone_panels..];
        let mut tree_of_column = vec![0; self.contact.len()];
        let mut trees: Vec<Vec<&Panel>> = Vec::new();
        for p in panels.iter().rev() {
            let tree = match self.rows[p.rows.clone()].first() {
                Some(&parent) => tree_of_column[parent as usize - self.n_zone],
                None => {
                    trees.push(Vec::new());
                    trees.len() - 1
                }
            };
            trees[tree].push(p);
            let first = p.first - self.n_zone;
            tree_of_column[first..first + p.width].fill(tree);
        }
        trees.iter_mut().for_each(|tree| tree.reverse());
        trees.reverse();
        trees
    }

    /// Block of `L_cc L_cc' - diag(shift)` for the columns in `panels`; `number` is workspace with
    /// one number for each contact column.
    fn contact_block(
        &self,
        panels: &[&Panel],
        shift: &[f64],
        number: &mut [usize],
    ) -> ContactBlock {
        let columns = panels.iter().flat_map(|p| p.first..p.first + p.width);
        let columns: Vec<usize> = columns.map(|column| column - self.n_zone).collect();
        let n = columns.len();
        for (k, &column) in columns.iter().enumerate() {
            number[column] = k;
        }
        let mut lower = DMatrix::zeros(n, n);
        let mut unit = [0.0; PANEL_WIDTH];
        let mut below = vec![0.0; n];
        for p in panels {
            let list = &self.rows[p.rows.clone()];
            let first = number[p.first - self.n_zone];
            for k in 0..p.width {
                // Column k is L times a unit vector: this is exact, and keeps the storage private
                // to the kernels.
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
                    lower[(first + i, first + k)] = column[i];
                }
                for (&row, &value) in list.iter().zip(&below) {
                    lower[(number[row as usize - self.n_zone], first + k)] = value;
                }
            }
        }
        // (L L')_ij for j <= i: only the first columns of L, up to j, contribute.
        let product = blocked::outer(&lower, |j| j);
        drop(lower);
        let freedom_of = |&column: &usize| self.contact[column] as usize;
        let mut freedoms: Vec<usize> = columns.iter().map(freedom_of).collect();
        freedoms.sort_unstable();
        let place = number;
        for (k, &freedom) in freedoms.iter().enumerate() {
            place[freedom] = k;
        }
        let place: Vec<usize> = columns.iter().map(|c| place[freedom_of(c)]).collect();
        let mut matrix = DMatrix::zeros(n, n);
        for j in 0..n {
            for i in j..n {
                matrix[(place[i], place[j])] = product[(i, j)];
                matrix[(place[j], place[i])] = product[(i, j)];
            }
        }
        for (k, &freedom) in freedoms.iter().enumerate() {
            if let Some(d) = shift.get(freedom) {
                matrix[(k, k)] -= d;
            }
        }
        ContactBlock { freedoms, matrix }
    }
}

/// Marks the trailing columns (numbered from the first of the zone) that are needed: the wanted
/// ones, the rows of their structure, and all contact columns.
fn needed(
    columns: &FactorColumns,
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

/// Whether two row lists are equal; lists of one supernode are in the same memory.
fn same_rows(a: &[i64], b: &[i64]) -> bool {
    a.len() == b.len() && (std::ptr::eq(a, b) || a == b)
}
