//! The response of the structure to loads and initial loads with the current contact statuses, by
//! trailing solves in two halves. A trailing solve is a solve on the zone and contact freedoms,
//! which are eliminated last.
//!
//! The first half of a solve, elimination, is the same for all statuses and linear in the load. The
//! second half gives the displacements.

use super::equilibrium::{EliminatedLoad, Equilibrium};
use super::factored::combination;
use super::load_point::LoadPoint;
use super::loose::move_loose_bodies;
use super::solver::Solver;
use crate::analysis::zone::points::Evaluation;
use crate::contact;
use crate::error::Result;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;
use std::borrow::Cow;

/// Fraction of the largest gap and of the largest force that counts as round-off of their sums.
const ZERO: f64 = 1e-14;

impl Solver<'_> {
    /// Equilibrium for a load point and initial loads with the current statuses (paper, eq. 4.2):
    /// the second half of a trailing solve.
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
        // Only strains are computed from the displacements, so rigid motions, however large, are
        // left out.
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

    /// Force of each pair at a load point, with initial loads, if all pairs were tied without gap:
    /// [`super::factored::Structure::closed_forces`] with the forces of the initial loads and of
    /// the springs.
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
            *q += point.interference_share * change - constant;
        }
        self.add_springs(&mut q);
        q
    }

    /// Completes a change of state that follows from its initial loads alone, closed pairs staying
    /// closed. The displacements are found in `part` of the zone, by default the whole zone. Costs
    /// one trailing solve.
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

    /// The elastic response to initial loads `initial`, closed pairs staying closed.
    pub fn direction(&mut self, initial: Trailing) -> Equilibrium {
        let mut out = Equilibrium::none(&initial, self.now.gap.len());
        out.initial.load = initial;
        self.respond_homogeneous(&mut out, &ZonePart::default());
        out
    }

    /// Finds the displacements of a change of state from its initial loads and gaps: the second
    /// half of a trailing solve.
    pub fn recover_change(&mut self, change: &mut Equilibrium, part: &ZonePart) {
        change.u.copy_from(&change.initial.eliminated);
        let slip: Vec<f64> = change.gap.iter().map(|g| -g).collect();
        self.structure.sub.recover_part(part, &mut change.u, &slip);
        self.cost.count_half();
    }

    /// Updates the displacements so that they belong to the current gaps and forces.
    pub fn refresh(&mut self) {
        if !self.fresh {
            let point = self.at.clone();
            let initial = self.now.initial.clone();
            self.now = self.respond(&point, initial);
            self.fresh = true;
            // Negative values within round-off are set to zero. Larger negative values remain, so
            // that they are noticed.
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

    /// Returns the displacements of the whole model for the current state. Costs half a full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn all_displacements(&mut self) -> Result<Vec<f64>> {
        self.refresh();
        let reduced = self.structure.reduced_external(&self.at);
        self.cost.counts.full_solves += 1;
        self.structure.sub.recover_all(&reduced, &self.now.u)
    }

    /// The sum of applied loads, contact forces and initial loads on all freedoms.
    pub fn total_load(&self) -> Vec<f64> {
        let mut load = combination(
            self.structure.model,
            &self.structure.system.loads,
            &self.at.factors,
        );
        let partition = &self.structure.sub.partition;
        for (&f, j) in partition.zone.iter().zip(&self.now.initial.load.zone) {
            load[f] += j;
        }
        let mut contact = self.now.initial.load.contact.clone();
        let rows = &self.structure.model.rows;
        rows.add_forces(&self.now.force, |i, force| contact[i] += force);
        for (&f, force) in partition.contact.iter().zip(contact) {
            load[f] += force;
        }
        load
    }

    /// The force that moves the nodes of the leading load along its displacement, for the whole
    /// body with its mirror images. The force is negative if the nodes have to be held back, and
    /// zero if it is no more than round-off of its terms. `None` if the leading load prescribes no
    /// displacement.
    pub(in crate::analysis) fn driving_force(&self) -> Option<f64> {
        let structure = &self.structure;
        let driving = structure.loads.driving.as_ref()?;
        let product = |(a, b): (&f64, &f64)| a * b;
        let of_whole = |force: f64| {
            Some(force * self.at.factors[driving.load].signum() * structure.model.symmetry)
        };
        if let Some(shares) = &driving.of_rigid {
            let forces = self.contact_forces();
            return of_whole(shares.iter().zip(forces.iter()).map(product).sum());
        }
        let delta = structure.delta(&self.at);
        let slip = delta.iter().zip(&self.now.gap).map(|(d, gap)| gap - d);
        let factors = structure.model.factors_of_alike(&self.at.factors);
        let of_loads = factors.zip(&driving.of_loads).map(|(h, force)| h * force);
        let of_pairs = driving.of_pairs.iter().zip(slip).map(|(t, slip)| t * slip);
        let initial = self.now.initial.load.iter();
        let of_initial = driving.moved.iter().zip(initial).map(product);
        let held = driving.prescribed.iter().zip(self.zone.on_prescribed());
        let plastic = of_initial.chain(held.map(product)).map(|work| -work);
        let terms = of_loads.chain(of_pairs).chain(plastic);
        let [force, size] = terms.fold([0.0, 0.0], |[sum, size], term| {
            [sum + term, size + f64::abs(term)]
        });
        if f64::abs(force) <= 8.0 * f64::EPSILON * structure.condition * size {
            return Some(0.0);
        }
        of_whole(force)
    }

    /// Computes the force by which the stresses at `state` are out of balance: the initial loads of
    /// the plastic strains at the displacements of `state`, minus the initial loads with which
    /// `state` is in equilibrium.
    pub(in crate::analysis) fn out_of_balance_at(
        &mut self,
        state: &Equilibrium,
        balance: &mut Trailing,
    ) -> Evaluation {
        let evaluation = self.zone.evaluate(&state.u, balance);
        balance.add(-1.0, &state.initial.load);
        self.cost.counts.plastic_iterations += 1;
        evaluation
    }

    /// Solves the elastic contact problem at a load point from scratch and makes the solution the
    /// current state (paper, eqs. 3.7 to 3.10).
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub fn solve_contact_at(&mut self, point: &LoadPoint) -> Result<()> {
        move_loose_bodies(self, point)?;
        let mut q = self.structure.closed_forces(point);
        for (q, t) in q.iter_mut().zip(&self.now.initial.forces) {
            *q += t;
        }
        self.add_springs(&mut q);
        let n = q.len();
        let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
        let outcome = contact::solve(&mut self.tableau, &q, &mut gap, &mut force);
        let certificate = outcome.map_err(|u| self.structure.unbounded(u.pair, point.alpha))?;
        self.cost.counts.contact_changes += certificate.changes;
        self.at = point.clone();
        self.now.gap = gap;
        self.now.force = force;
        self.border.clear();
        self.fresh = false;
        self.refresh();
        Ok(())
    }

    /// The contact forces of the current state. Residual stresses balance only to the tolerance of
    /// the plastic iteration and to round-off. If all contact forces together are less than that,
    /// the bodies have parted, nothing but the imbalance is left, and the forces returned are zero.
    pub fn contact_forces(&self) -> Cow<'_, [f64]> {
        let force = &self.now.force;
        let tolerance = self.structure.model.settings.tolerance * self.scales.force;
        let imbalance = tolerance.max(self.round_off_of_contact());
        let all = force.iter().fold(0.0, |sum, force| sum + force);
        if self.now.initial.load.largest() > 0.0 && all <= imbalance {
            return Cow::Owned(vec![0.0; force.len()]);
        }
        Cow::Borrowed(force)
    }
}
