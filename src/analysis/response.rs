//! What the structure answers to loads and initial loads with the contact statuses at hand:
//! trailing solves, by halves.
//!
//! The first half of a solve, elimination, is the same for all statuses and linear in the load; the
//! second gives displacements.

use super::equilibrium::{EliminatedLoad, Equilibrium};
use super::load_point::LoadPoint;
use super::solver::Solver;
use crate::linalg::ZonePart;

/// Share of the largest gap and force that is the round-off of their sums.
const ZERO: f64 = 1e-14;

impl Solver<'_> {
    /// Equilibrium for a load point and initial loads with the current statuses (paper 4.2): the
    /// second half of a trailing solve.
    pub fn respond(&mut self, point: &LoadPoint, initial: EliminatedLoad) -> Equilibrium {
        let n = self.structure.gaps.initial.len();
        let mut u = initial.eliminated.clone();
        let factors = self.structure.model.factors_of_alike(&point.factors);
        for (load, factor) in self.structure.loads.condensed.iter().zip(factors) {
            u.add(factor, &load.eliminated);
        }
        let q = self.forces_if_tied(point, &initial);
        let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
        self.tableau.solve(&q, &mut gap, &mut force);
        // Displacements serve for strains: rigid motions, however large, are left out.
        let delta = self.structure.delta(point);
        let (slip, _) = self.structure.sub.split_slip(&delta, &gap);
        self.structure.sub.recover(&mut u, &slip);
        self.cost.count_half();
        Equilibrium {
            initial,
            u,
            gap,
            force,
        }
    }

    /// Force of each pair at a load point, with initial loads, if all were tied without gap.
    pub fn forces_if_tied(&self, point: &LoadPoint, initial: &EliminatedLoad) -> Vec<f64> {
        let mut q = initial.forces.clone();
        let factors = self.structure.model.factors_of_alike(&point.factors);
        for (load, factor) in self.structure.loads.condensed.iter().zip(factors) {
            for (q, t) in q.iter_mut().zip(&load.forces) {
                *q += factor * t;
            }
        }
        let [initial, by_interference] = &self.structure.gaps.forces;
        for (q, (constant, change)) in q.iter_mut().zip(initial.iter().zip(by_interference)) {
            *q += point.interference * change - constant;
        }
        self.add_springs(&mut q);
        q
    }

    /// Completes a change of state that follows from its initial loads alone, closed pairs staying
    /// closed; its displacements in a part of the zone where only these are asked for. One trailing
    /// solve.
    pub fn respond_homogeneous(&mut self, change: &mut Equilibrium, part: &ZonePart) {
        let initial = &mut change.initial;
        initial.eliminated.copy_from(&initial.load);
        self.structure
            .sub
            .eliminate(&mut initial.eliminated, &mut initial.forces);
        self.cost.count_half();
        self.tableau
            .solve(&initial.forces, &mut change.gap, &mut change.force);
        self.recover_change(change, part);
    }

    /// The displacements of a change of state from its other parts: the second half of a trailing
    /// solve.
    pub fn recover_change(&mut self, change: &mut Equilibrium, part: &ZonePart) {
        change.u.copy_from(&change.initial.eliminated);
        let slip: Vec<f64> = change.gap.iter().map(|g| -g).collect();
        self.structure.sub.recover_part(part, &mut change.u, &slip);
        self.cost.count_half();
    }

    /// Makes the displacements belong to the current gaps and forces.
    pub fn refresh(&mut self) {
        if !self.fresh {
            let point = self.at.clone();
            let initial = self.now.initial.clone();
            self.now = self.respond(&point, initial);
            self.fresh = true;
            // Zero within round-off is zero; what is more than that stays to be seen.
            let gaps = self.structure.gaps.initial.iter();
            let gap = gaps.fold(0.0f64, |m, g| m.max(g.abs()));
            let force = (self.now.force.iter()).fold(self.scales.force, |m, r| m.max(*r));
            for (values, scale) in [(&mut self.now.gap, gap), (&mut self.now.force, force)] {
                for value in values.iter_mut() {
                    if (-ZERO * scale..0.0).contains(value) {
                        *value = 0.0;
                    }
                }
            }
        }
    }
}
