//! What the structure answers to loads and initial loads with the contact statuses at hand:
//! trailing solves, by halves.
//!
//! The first half of a solve, elimination, is the same for all statuses and linear in the load; the
//! second gives displacements.

use super::engine::Engine;
use super::equilibrium::{EliminatedLoad, Equilibrium};
use super::load_point::LoadPoint;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;

/// Share of the largest gap and force that is the round-off of their sums.
const ZERO: f64 = 1e-14;

impl Engine<'_> {
    /// The first half of the solve with a load.
    pub fn eliminate(&mut self, load: Trailing) -> EliminatedLoad {
        let mut out = EliminatedLoad {
            eliminated: load.clone(),
            load,
            forces: vec![0.0; self.gap.len()],
        };
        if out.load.largest() > 0.0 {
            self.sub.eliminate(&mut out.eliminated, &mut out.forces);
            self.count_half();
        }
        out
    }

    /// Equilibrium for a load point and initial loads with the current statuses (paper 4.2): the
    /// second half of a trailing solve.
    pub fn respond(&mut self, point: &LoadPoint, initial: EliminatedLoad) -> Equilibrium {
        let n = self.gap.len();
        let mut u = initial.eliminated.clone();
        let mut q = initial.forces.clone();
        for (load, &factor) in self.loads.iter().zip(&point.factors) {
            u.add(factor, &load.eliminated);
            for (q, t) in q.iter_mut().zip(&load.forces) {
                *q += factor * t;
            }
        }
        for k in 0..n {
            q[k] += point.interference * self.gap_forces[1][k] - self.gap_forces[0][k];
        }
        let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
        self.tableau.solve(&q, &mut gap, &mut force);
        // Displacements serve for strains: rigid motions, however large, are left out.
        let (slip, _) = self.sub.split_slip(&self.delta(point), &gap);
        self.sub.recover(&mut u, &slip);
        self.count_half();
        Equilibrium {
            initial,
            u,
            gap,
            force,
        }
    }

    /// Completes a change of state that follows from its initial loads alone, closed pairs staying
    /// closed; its displacements in a part of the zone where only these are asked for. One trailing
    /// solve.
    pub fn respond_homogeneous(&mut self, change: &mut Equilibrium, part: &ZonePart) {
        let initial = &mut change.initial;
        initial.eliminated.copy_from(&initial.load);
        self.sub
            .eliminate(&mut initial.eliminated, &mut initial.forces);
        self.count_half();
        self.tableau
            .solve(&initial.forces, &mut change.gap, &mut change.force);
        self.recover_change(change, part);
    }

    /// The displacements of a change of state from its other parts: the second half of a trailing
    /// solve.
    pub fn recover_change(&mut self, change: &mut Equilibrium, part: &ZonePart) {
        change.u.copy_from(&change.initial.eliminated);
        let slip: Vec<f64> = change.gap.iter().map(|g| -g).collect();
        self.sub.recover_part(part, &mut change.u, &slip);
        self.count_half();
    }

    /// Two halves count as a trailing solve.
    pub fn count_half(&mut self) {
        self.half = !self.half;
        self.counts.trailing_solves += usize::from(self.half);
    }

    /// Makes the displacements belong to the current gaps and forces.
    pub fn refresh(&mut self) {
        if !self.fresh {
            let point = self.at.clone();
            let initial = self.now.initial.clone();
            self.now = self.respond(&point, initial);
            self.fresh = true;
            // Zero within round-off is zero; what is more than that stays to be seen.
            let gap = self.gap.iter().fold(0.0f64, |m, g| m.max(g.abs()));
            let force = (self.now.force.iter()).fold(self.force_scale, |m, r| m.max(*r));
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
