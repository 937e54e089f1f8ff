//! Bodies that no contact force holds.

use super::load_point::LoadPoint;
use super::solver::Solver;
use crate::contact::loose::come_to_rest;
use crate::contact::springs::Springs;
use crate::error::Result;
use nalgebra::DVector;
use std::sync::Arc;

/// Share of the largest force above which springs are let go on the way.
const MOVES: f64 = 1e-9;
/// The same in a state that is read: round-off.
pub(super) const NOTHING: f64 = 1e-14;
/// Share of the largest force that no spring bears but where the load drives a body on: it has
/// moved by a hundred times the deformation.
const DRIVEN: f64 = 1e-6;

/// Times that springs are let go: where contact holds a motion with a hundredth of its stiffness
/// what they bear falls by four orders each time.
const MOST_TIMES: usize = 8;

impl Solver<'_> {
    /// A body that no contact force holds moves rigidly under the first bit of the load towards
    /// `end` until it touches: the way goes on from there. Motions that the load does not drive are
    /// kept by springs.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub(super) fn move_loose_bodies(&mut self, end: &LoadPoint) -> Result<()> {
        self.let_springs_go(MOVES);
        let terms = self.structure.closed_forces_size(&self.at);
        let of_one = self.tableau.force_tolerance(&[terms], &self.now.gap);
        let nothing = self.round_off_of_contact().max(of_one);
        let force = &self.now.force;
        let is_loose = |pairs: &[usize]| pairs.iter().map(|&k| force[k]).sum::<f64>() <= nothing;
        let loose = self.structure.sub.rigid_slips(is_loose);
        if loose.is_empty() {
            return Ok(());
        }
        let matrix = self.structure.sub.pair_matrix();
        let [here, there] = [&self.at, end].map(|point| self.structure.closed_forces(point));
        let mut changed = false;
        let mut springs = self.springs.to_vec();
        for (pairs, slips) in loose {
            let of = |value: &dyn Fn(usize) -> f64| {
                DVector::from_iterator(pairs.len(), pairs.iter().map(|&k| value(k)))
            };
            let rate = of(&|k| there[k] - here[k]);
            let terms = of(&|k| there[k].abs() + here[k].abs());
            let from = of(&|k| self.now.gap[k]);
            let mut gap = from.clone();
            let free = come_to_rest(&slips, [&rate, &terms], &mut gap)
                .map_err(|u| self.structure.unbounded(pairs[u.pair], self.at.alpha))?;
            if gap != from {
                changed = true;
                for (&k, &gap) in pairs.iter().zip(gap.iter()) {
                    self.now.gap[k] = gap;
                    self.now.force[k] = 0.0;
                }
            }
            springs.retain(|own| own.pairs() != pairs);
            if free.ncols() > 0 {
                changed = true;
                let motions = &slips * free;
                springs.push(Springs::new(matrix, pairs, &motions, &self.now.gap));
            }
        }
        self.set_springs(&Arc::from(springs));
        if changed {
            let open: Vec<bool> = self.now.gap.iter().map(|g| *g > 0.0).collect();
            self.tableau.reset(&open);
        }
        Ok(())
    }

    /// Leaves bodies where they are by now that springs pull back with more than a share of the
    /// largest force. What contact holds weakly moves on by what the spring has borne.
    pub(super) fn let_springs_go(&mut self, share: f64) {
        for _ in 0..MOST_TIMES {
            if !self.springs_bear(share) {
                return;
            }
            let springs = self.springs.iter();
            self.springs = springs.map(|own| own.moved_to(&self.now.gap)).collect();
            self.fresh = false;
            self.refresh();
        }
    }

    /// Whether nothing but springs holds a body.
    pub(super) fn springs_hold_a_body(&self) -> bool {
        let open = self.tableau.open();
        let mut springs = self.springs.iter();
        springs.any(|own| own.pairs().iter().all(|&k| open[k]))
    }

    /// Whether a spring bears more than this share of the largest force.
    pub(super) fn springs_bear(&self, share: f64) -> bool {
        let gap = &self.now.gap;
        let forces = self.springs.iter().map(|own| own.largest_force(gap));
        forces.fold(0.0, f64::max) > share * self.scales.force
    }

    /// No pair stops a body that nothing but springs keeps from moving on.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub(super) fn refuse_driven_bodies(&self) -> Result<()> {
        if !self.springs_bear(DRIVEN) {
            return Ok(());
        }
        let of_all = self.structure.closed_forces(&self.at);
        for (pairs, slips) in self.structure.sub.rigid_slips(|_| true) {
            let [load, mut gap] = [&of_all, &self.now.gap]
                .map(|of| DVector::from_iterator(pairs.len(), pairs.iter().map(|&k| of[k])));
            come_to_rest(&slips, [&load, &load], &mut gap)
                .map_err(|u| self.structure.unbounded(pairs[u.pair], self.at.alpha))?;
        }
        Ok(())
    }
}
