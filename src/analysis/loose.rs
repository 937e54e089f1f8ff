//! Bodies that no contact force holds.

use super::load_point::LoadPoint;
use super::solver::Solver;
use crate::contact::loose::come_to_rest;
use crate::error::Result;
use nalgebra::DVector;

impl Solver<'_> {
    /// A body that no contact force holds moves rigidly under the first bit of the load towards
    /// `end` until it touches: the way goes on from there.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub(super) fn move_loose_bodies(&mut self, end: &LoadPoint) -> Result<()> {
        let terms = self.structure.closed_forces_size(&self.at);
        let of_one = self.tableau.force_tolerance(&[terms], &self.now.gap);
        let nothing = self.round_off_of_contact().max(of_one);
        let force = &self.now.force;
        let is_loose = |pairs: &[usize]| pairs.iter().map(|&k| force[k]).sum::<f64>() <= nothing;
        let loose = self.structure.sub.rigid_slips(is_loose);
        if loose.is_empty() {
            return Ok(());
        }
        let [here, there] = [&self.at, end].map(|point| self.structure.closed_forces(point));
        let mut moved = false;
        for (pairs, slips) in loose {
            let rate = pairs.iter().map(|&k| there[k] - here[k]);
            let rate = DVector::from_iterator(pairs.len(), rate);
            let from = pairs.iter().map(|&k| self.now.gap[k]);
            let from = DVector::from_iterator(pairs.len(), from);
            let mut gap = from.clone();
            come_to_rest(&slips, &rate, &mut gap)
                .map_err(|u| self.structure.unbounded(pairs[u.pair], self.at.alpha))?;
            if gap == from {
                continue;
            }
            moved = true;
            for (&k, &gap) in pairs.iter().zip(gap.iter()) {
                self.now.gap[k] = gap;
                self.now.force[k] = 0.0;
            }
        }
        if moved {
            let open: Vec<bool> = self.now.gap.iter().map(|g| *g > 0.0).collect();
            self.tableau.reset(&open);
        }
        Ok(())
    }
}
