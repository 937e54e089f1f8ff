//! Forward and backward substitution with the trailing columns, subtree by subtree.
//!
//! The cut into subtrees, and the sequence in which their contributions to the columns above are
//! summed, are the same for every number of threads; so are the bits of the result.

use super::super::panel;
use super::subtree::Subtree;
use super::{Panel, SolveWorkspace, TrailingFactor};
use crate::linalg::ZonePart;
use rayon::prelude::*;
use std::sync::PoisonError;

impl TrailingFactor {
    /// Number of subtrees.
    #[cfg(test)]
    pub(crate) fn n_subtrees(&self) -> usize {
        self.subtrees.len()
    }

    /// Finds the panels of the marked zone freedoms and all panels on which these depend: their
    /// ancestors in the elimination tree.
    pub(crate) fn part_of_zone(&self, marked: &[bool]) -> ZonePart {
        let mut blocks = vec![false; self.n_zone_panels];
        for k in 0..self.n_zone_panels {
            let p = &self.panels[k];
            let mut places = self.zone[p.first..p.first + p.width].iter();
            blocks[k] |= places.any(|&place| marked[place as usize]);
            if blocks[k] && self.parents[k] != usize::MAX {
                blocks[self.parents[k]] = true;
            }
        }
        ZonePart { blocks }
    }

    /// Panels of the zone that are in no subtree, in ascending order.
    fn top(&self) -> impl DoubleEndedIterator<Item = usize> {
        let begins = [0]
            .into_iter()
            .chain(self.subtrees.iter().map(|t| t.panels.end));
        let ends = self.subtrees.iter().map(|t| t.panels.start);
        let gaps: Vec<_> = begins.zip(ends.chain([self.n_zone_panels])).collect();
        gaps.into_iter().flat_map(|(begin, end)| begin..end)
    }

    /// Panels of a subtree, each with its rows.
    fn panels_of<'a>(
        &'a self,
        tree: &'a Subtree,
    ) -> impl DoubleEndedIterator<Item = (usize, &'a [u32])> {
        let panels = tree.panels.clone().zip(&tree.starts);
        panels.map(|(k, &start)| (k, &tree.own_rows[start..start + self.panels[k].rows.len()]))
    }

    /// Performs the forward substitution with the columns of a panel: `own = L^-1 own`, and `below
    /// -= L own` in the panel's `rows`; `below` begins at row `offset`.
    fn forward(
        &self,
        p: &Panel,
        rows: &[u32],
        (own, below): (&mut [f64], &mut [f64]),
        offset: usize,
        sums: &mut [f64],
    ) {
        // A load on a part of the zone (where the material flows) reaches only the panels above
        // that part.
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

    /// Performs the backward substitution with a panel: `own = L^-T (own - L' below)`.
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

    /// Computes `f_t = L_tt y_t`; `y` is given for all trailing columns of the factor, the result
    /// is for the kept ones in the partition's order.
    pub(crate) fn condensed_load(&self, y: &[f64], zone: &mut [f64], contact: &mut [f64]) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let SolveWorkspace { vector, rows, .. } = &mut *work;
        for (value, &column) in vector.iter_mut().zip(&self.kept) {
            *value = y[column as usize];
        }
        // From the last panel to the first, so that nothing is overwritten before a panel reads it.
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

    /// Leaves `y_z = L_zz^-1 f_z` in `zone`, in the order of the factor, and subtracts `L_cz y_z`
    /// from `contact`.
    pub(crate) fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let SolveWorkspace {
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
                for (k, rows) in self.panels_of(tree) {
                    let p = &self.panels[k];
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
        for k in self.top() {
            let p = &self.panels[k];
            let end = p.first + p.width;
            let (done, below) = vector.split_at_mut(end);
            let own = (&mut done[p.first..], below);
            self.forward(p, &self.rows[p.rows.clone()], own, end, rows);
        }
        let (v_zone, v_contact) = vector.split_at(self.n_zone);
        zone.copy_from_slice(v_zone);
        scatter(&self.contact, v_contact, contact);
    }

    /// Computes `u_z = L_zz^-T (y_z - L_cz' u_c)` in a part of the zone, zero elsewhere, from
    /// `zone` as [`TrailingFactor::eliminate_zone`] left it.
    pub(crate) fn recover_zone(&self, part: &ZonePart, zone: &mut [f64], u_contact: &[f64]) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let SolveWorkspace {
            vector,
            rows,
            subtrees,
        } = &mut *work;
        let (v_zone, v_contact) = vector.split_at_mut(self.n_zone);
        v_zone.copy_from_slice(zone);
        gather(&self.contact, u_contact, v_contact);
        for k in self.top().rev() {
            let p = &self.panels[k];
            let end = p.first + p.width;
            let (done, below) = vector.split_at_mut(end);
            if !part.has(k) {
                done[p.first..].fill(0.0);
                continue;
            }
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
                for (k, rows) in self.panels_of(tree).rev() {
                    let p = &self.panels[k];
                    let end = p.first + p.width - tree.columns.start;
                    let (done, below) = work.vector.split_at_mut(end);
                    let own = &mut done[end - p.width..];
                    if !part.has(k) {
                        own.fill(0.0);
                        continue;
                    }
                    self.backward(p, rows, (own, below), end, &mut work.rows);
                }
            });
        for (tree, work) in self.subtrees.iter().zip(&*subtrees) {
            vector[tree.columns.clone()].copy_from_slice(&work.vector[..tree.columns.len()]);
        }
        scatter(&self.zone, &vector[..self.n_zone], zone);
    }
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
