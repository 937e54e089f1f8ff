//! The elastoplastic tangent, solved by conjugate gradients on the factored elastic stiffness.
//!
//! With `K_p = sum_g w_g B' (D - D_ep) B` the tangent is `S - K_p`. Preconditioned with `S` itself
//! (one trailing solve), its condition is that of the material: `(3G + H)/H` at worst, and the
//! product with `S` is never needed because `S p` follows from the recurrence of the search
//! directions.
//!
//! Closed pairs constrain the search to `B u = 0`: forces `B' c`, of a pair of nodes `(-c, c)`, do
//! no work and move nothing. No step takes them from the residual, and each would multiply their
//! round-off by its length, by orders in a few steps where little stiffness is left: they are taken
//! off and kept apart.
//!
//! # Source
//! N. I. M. Gould, M. E. Hribar, J. Nocedal, *On the solution of equality constrained quadratic
//! programming problems arising in optimization* (2001), section 6 (the growth of the part of the
//! residual that the constraints carry, and its removal), doi:10.1137/S1064827598345667.

use super::equilibrium::Equilibrium;
use super::solver::Solver;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;

/// Most iterations of a solve: enough for perfect plasticity near collapse; a solve that needs more
/// has no useful direction.
const MOST: usize = 400;

impl Solver<'_> {
    /// The direction of initial loads `initial`, closed pairs staying closed.
    pub fn direction(&mut self, initial: Trailing) -> Equilibrium {
        let mut out = Equilibrium::none(&initial, self.now.gap.len());
        out.initial.load = initial;
        self.respond_homogeneous(&mut out, &ZonePart::default());
        out
    }

    /// Newton's direction: solves `(S - keep K_p) du = residual` to `tolerance` (energy norm,
    /// relative). The initial loads of the direction are `S du`, what the direction asks the
    /// plastic strains to become. `keep = 1` is the tangent, 0 the plain iteration; in between the
    /// condition is at most `1/(1 - keep)`, also where the material has no stiffness left.
    ///
    /// The search directions carry their gaps, forces and eliminated loads along, and the last
    /// preconditioned residual `z = S^-1 r` is taken as a step of the plain iteration on top:
    /// besides the iteration's trailing solves the direction costs half a solve. In the iteration
    /// the second halves go through the part of the zone that counts.
    pub fn solve_tangent(&mut self, residual: &Trailing, tolerance: f64, keep: f64) -> Equilibrium {
        let mut softened = self.structure.sub.zeros();
        let part = self.part_that_counts(residual);
        // The residual that is left is the load of z.
        let mut z = Equilibrium::none(residual, self.now.gap.len());
        z.initial.load.copy_from(residual);
        let mut carried = vec![0.0; z.gap.len()];
        self.take_what_closed_pairs_carry(&mut z.initial.load, &mut carried);
        self.respond_homogeneous(&mut z, &part);
        let mut total = Equilibrium::none(residual, z.gap.len());
        let mut p = z.clone();
        let mut rz = z.initial.load.dot(&z.u);
        let target = tolerance * tolerance * rz;
        for _ in 0..MOST {
            if rz <= target || rz <= 0.0 {
                break;
            }
            self.zone.softening_times(&p.u, &mut softened);
            let stiffness = p.initial.load.dot(&p.u);
            let curvature = stiffness - keep * softened.dot(&p.u);
            if curvature <= 1e-14 * stiffness {
                break;
            }
            let step = rz / curvature;
            total.add(step, &p);
            z.initial.load.add(-step, &p.initial.load);
            z.initial.load.add(step * keep, &softened);
            self.take_what_closed_pairs_carry(&mut z.initial.load, &mut carried);
            self.respond_homogeneous(&mut z, &part);
            let next = z.initial.load.dot(&z.u);
            p.scale_and_add(next / rz, &z);
            rz = next;
        }
        total.add(1.0, &z);
        let contact = &mut total.initial.load.contact;
        let rows = &self.structure.model.rows;
        rows.add_forces(&carried, |i, force| contact[i] += force);
        for (k, c) in carried.iter().enumerate() {
            // Compressive forces hold the nodes of a pair apart.
            total.initial.forces[k] -= c;
            total.force[k] -= c;
        }
        self.recover_change(&mut total, &ZonePart::default());
        total
    }

    /// Takes the forces `-B' c` that closed pairs carry alone off a load and adds them to
    /// `carried`.
    fn take_what_closed_pairs_carry(&self, load: &mut Trailing, carried: &mut [f64]) {
        let rows = &self.structure.model.rows;
        rows.take_carried(&mut load.contact, carried, self.tableau.open());
    }

    /// Where the displacements of search directions enter a tangent solve: where the material
    /// yields and where the residual acts.
    fn part_that_counts(&self, residual: &Trailing) -> ZonePart {
        let mut marks: Vec<bool> = residual.zone.iter().map(|r| *r != 0.0).collect();
        self.zone.mark_active(&mut marks);
        self.structure.sub.part_of_zone(&marks)
    }
}
