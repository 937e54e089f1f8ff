//! Bodies that no contact force holds: rigid motion until they touch, and weak springs.

use super::load_point::LoadPoint;
use super::solver::Solver;
use crate::contact::loose::come_to_rest;
use crate::contact::springs::Springs;
use crate::error::Result;
use nalgebra::DVector;
use std::sync::Arc;

/// Springs that bear more than this fraction of the largest force are released along the load path.
const MOVES: f64 = 1e-9;
/// Springs that bear more than this fraction of the largest force are released in a state to be
/// read: round-off.
const NOTHING: f64 = 1e-14;
/// Fraction of the largest force that springs may bear in a state at rest.
const SETTLED: f64 = 1e-11;
/// A spring bears more than this fraction of the largest force only if the load drives its body on:
/// the body has then moved by a hundred times the deformation.
const DRIVEN: f64 = 1e-6;

/// Most times that springs are released: where contact holds a motion with a hundredth of its
/// stiffness, the force that springs bear falls by four orders of magnitude each time.
const MOST_TIMES: usize = 8;

impl Solver<'_> {
    /// Moves each body that no contact force holds rigidly until it touches, under the first bit of
    /// the load towards `end`; the load path goes on from there. Springs hold motions that the load
    /// does not drive.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub(in crate::analysis) fn move_loose_bodies(&mut self, end: &LoadPoint) -> Result<()> {
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
        let mut springs = self.springs.to_vec();
        let mut anew: Vec<usize> = Vec::new();
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
            for (&k, &gap) in pairs.iter().zip(gap.iter()).filter(|_| gap != from) {
                self.now.gap[k] = gap;
                self.now.force[k] = 0.0;
            }
            let own = (free.ncols() > 0)
                .then(|| Springs::new(matrix, pairs, &(&slips * free), &self.now.gap));
            let known = springs.iter().position(|other| other.pairs() == pairs);
            let as_stiff = match (known, &own) {
                (Some(at), Some(own)) => springs[at].as_stiff_as(own),
                (None, None) => true,
                _ => false,
            };
            if gap != from || !as_stiff {
                anew.extend_from_slice(pairs);
            }
            match (known, own) {
                (Some(at), Some(own)) => springs[at] = own,
                (Some(at), None) => drop(springs.remove(at)),
                (None, own) => springs.extend(own),
            }
        }
        self.set_springs(&Arc::from(springs));
        if !anew.is_empty() {
            let mut open = self.tableau.open().to_vec();
            anew.into_iter()
                .for_each(|k| open[k] = self.now.gap[k] > 0.0);
            self.tableau.reset(&open);
        }
        Ok(())
    }

    /// Finds the equilibrium without springs: a body that contact holds weakly, or that has not yet
    /// reached the pair that stops it, moves on until the springs bear nothing.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub(in crate::analysis) fn settle_springs(&mut self) -> Result<()> {
        for _ in 0..MOST_TIMES {
            self.let_springs_go(NOTHING);
            let bear = self.springs_bear(SETTLED);
            if !bear && !self.is_beyond_contact() {
                break;
            }
            if bear {
                self.refuse_motion_without_end()?;
            }
            self.solve_contact_at(&self.at.clone())?;
        }
        Ok(())
    }

    /// Whether a gap or a contact force is negative by more than round-off, with springs at work.
    fn is_beyond_contact(&self) -> bool {
        let [gap, force] = [self.scales.displacement, self.scales.force].map(|s| -1e-10 * s);
        let least = |of: &[f64]| of.iter().copied().fold(0.0, f64::min);
        !self.springs.is_empty() && (least(&self.now.gap) < gap || least(&self.now.force) < force)
    }

    /// Releases springs that bear more than a fraction of the largest force: makes them free of
    /// force at the current gaps, so that their bodies stay where they are. A body that contact
    /// holds weakly then moves on under the force that its spring has borne.
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
    pub(in crate::analysis) fn springs_hold_a_body(&self) -> bool {
        let open = self.tableau.open();
        let mut springs = self.springs.iter();
        springs.any(|own| own.pairs().iter().all(|&k| open[k]))
    }

    /// Whether a spring bears more than a fraction of the largest force.
    pub(in crate::analysis) fn springs_bear(&self, share: f64) -> bool {
        let gap = &self.now.gap;
        let forces = self.springs.iter().map(|own| own.largest_force(gap));
        forces.fold(0.0, f64::max) > share * self.scales.force
    }

    /// Refuses a state in which springs stop a driven body and no pair would stop it.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub(in crate::analysis) fn refuse_driven_bodies(&self) -> Result<()> {
        match self.springs_bear(DRIVEN) {
            true => self.refuse_motion_without_end(),
            false => Ok(()),
        }
    }

    fn refuse_motion_without_end(&self) -> Result<()> {
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
