//! The elastoplastic tangent, solved by conjugate gradients on the factored elastic stiffness.
//!
//! With `K_p = sum_g w_g B' (D - D_ep) B` the tangent is `S - K_p`. Preconditioned with `S` itself
//! (one trailing solve), its condition number is that of the material: `(3G + H)/H` at worst. The
//! product with `S` is never needed, because `S p` follows from the recurrence of the search
//! directions.
//!
//! Closed pairs constrain the search to `B u = 0`. Forces `B' c`, which act on a pair of nodes as
//! `(-c, c)`, do no work and move nothing. No step removes them from the residual, and each step
//! would multiply their round-off by its length, by orders of magnitude in a few steps if little
//! stiffness is left. They are therefore subtracted and kept apart.
//!
//! # Source
//! N. I. M. Gould, M. E. Hribar, J. Nocedal, *On the solution of equality constrained quadratic
//! programming problems arising in optimization* (2001), section 6 (the growth of the part of the
//! residual that the constraints carry, and its removal), doi:10.1137/S1064827598345667.
//!
//! Fading back stresses make the tangent unsymmetric if flow turns. It is then solved by conjugate
//! residuals that keep the last few directions (Orthomin), with the same preconditioner and the
//! same work per direction: S. C. Eisenstat, H. C. Elman, M. H. Schultz (1983),
//! doi:10.1137/0720023.

use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::solver::Solver;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;
use std::collections::VecDeque;

/// Most iterations of a solve: enough for perfect plasticity near collapse. A solve that needs more
/// has no useful direction.
pub(super) const MOST: usize = 400;
/// Fraction of a direction's elastic stiffness that is round-off.
pub(super) const SINGULAR: f64 = 1e-14;
/// Number of conjugate gradient steps that cost as much as a direction found with a factor of the
/// tangent: such a direction takes two or three steps, each with two products, and the elastic
/// response to their result.
pub(super) const DIRECT: usize = 6;
/// Number of directions that conjugate residuals keep: an elastoplastic solve takes about ten.
const KEPT: usize = 20;

/// A residual, or the product of the tangent with a direction: a load `r` with its elastic response
/// `S^-1 r`, and the forces in it that closed pairs alone carry.
struct Answered {
    change: Equilibrium,
    carried: Vec<f64>,
}

impl Answered {
    fn add(&mut self, factor: f64, other: &Answered) {
        self.change.add(factor, &other.change);
        for (own, other) in self.carried.iter_mut().zip(&other.carried) {
            *own += factor * other;
        }
    }

    /// The product `r_1' S^-1 r_2` of two loads.
    fn dot(&self, other: &Answered) -> f64 {
        self.change.initial.load.dot(&other.change.u)
    }
}

impl Solver<'_> {
    /// The elastic response to initial loads `initial`, closed pairs staying closed.
    pub fn direction(&mut self, initial: Trailing) -> Equilibrium {
        let mut out = Equilibrium::none(&initial, self.now.gap.len());
        out.initial.load = initial;
        self.respond_homogeneous(&mut out, &ZonePart::default());
        out
    }

    /// Newton's direction: solves `(S - keep K_p) du = residual` to `tolerance` (energy norm,
    /// relative). The initial loads of the direction are `S du`: the change of initial loads that
    /// the direction asks for. `keep = 1` is the tangent, 0 the plain iteration. In between, the
    /// condition number is at most `1/(1 - keep)`, even if the material has no stiffness left.
    ///
    /// The search directions carry their gaps, forces and eliminated loads along, and the last
    /// preconditioned residual `z = S^-1 r` is added as a step of the plain iteration. In addition
    /// to the iteration's trailing solves, the direction therefore costs half a solve. In the
    /// iteration, the second halves pass only through the part of the zone that counts.
    pub fn solve_tangent(&mut self, residual: &Trailing, tolerance: f64, keep: f64) -> Equilibrium {
        let part = self.part_that_counts(residual);
        let at_rest = (residual.clone(), self.structure.sub.zeros());
        if let Some(u) = self.solve_by_factor(at_rest, (tolerance, keep), &part) {
            return self.direction_along(&u, residual, keep);
        }
        let mut left = self.answer(residual.clone(), &part);
        let size = tolerance * left.dot(&left).max(0.0).sqrt();
        if !self.zone.is_symmetric() {
            return self.conjugate_residuals(left, size, keep, &part);
        }
        let mut total = Equilibrium::none(residual, left.carried.len());
        while !self.conjugate_gradients((&mut total, &mut left), size, keep, &part) {
            if self.factor_tangent(keep) {
                let so_far = (left.change.initial.load.clone(), total.u.clone());
                if let Some(u) = self.solve_by_factor(so_far, (tolerance, keep), &part) {
                    return self.direction_along(&u, residual, keep);
                }
            }
        }
        self.complete_direction(total, &left)
    }

    /// Conjugate gradients on the elastic factor, starting from the direction so far and the
    /// remaining residual, until the residual is below `size`. Returns false if a factor of the
    /// tangent would have cost less.
    fn conjugate_gradients(
        &mut self,
        (total, z): (&mut Equilibrium, &mut Answered),
        size: f64,
        keep: f64,
        part: &ZonePart,
    ) -> bool {
        let mut softened = self.structure.sub.zeros();
        let mut p = z.change.clone();
        let mut rz = z.dot(z);
        for step in 0..MOST {
            if rz <= size * size || rz <= 0.0 {
                break;
            }
            if step >= DIRECT && !self.may_go_on_without_factor() {
                return false;
            }
            self.zone.softening_times(&p.u, &mut softened);
            let stiffness = p.initial.load.dot(&p.u);
            let curvature = stiffness - keep * softened.dot(&p.u);
            if curvature <= SINGULAR * stiffness {
                break;
            }
            let step = rz / curvature;
            total.add(step, &p);
            let load = &mut z.change.initial.load;
            load.add(-step, &p.initial.load);
            load.add(step * keep, &softened);
            self.take_what_closed_pairs_carry(load, &mut z.carried);
            self.respond_homogeneous(&mut z.change, part);
            let next = z.dot(z);
            p.scale_and_add(next / rz, &z.change);
            rz = next;
        }
        true
    }

    /// Conjugate residuals on the elastic factor, for an unsymmetric tangent, starting from the
    /// residual, until the rest of it is below `size`.
    fn conjugate_residuals(
        &mut self,
        mut z: Answered,
        size: f64,
        keep: f64,
        part: &ZonePart,
    ) -> Equilibrium {
        let mut softened = self.structure.sub.zeros();
        let mut total = Equilibrium::none(&softened, z.carried.len());
        // The directions, each with its product with the tangent, and the squared size of that
        // product.
        let mut kept: VecDeque<(Equilibrium, Answered, f64)> = VecDeque::new();
        for _ in 0..MOST {
            let rz = z.dot(&z);
            if rz <= size * size || rz <= 0.0 {
                break;
            }
            let mut p = z.change.clone();
            self.zone.softening_times(&p.u, &mut softened);
            let mut load = p.initial.load.clone();
            load.add(-keep, &softened);
            let mut image = self.answer(load, part);
            for (direction, other, square) in &kept {
                let share = image.dot(other) / square;
                p.add(-share, direction);
                image.add(-share, other);
            }
            let square = image.dot(&image);
            if square <= 1e-28 * rz {
                break;
            }
            let step = z.dot(&image) / square;
            total.add(step, &p);
            z.add(-step, &image);
            if kept.len() == KEPT {
                kept.pop_front();
            }
            kept.push_back((p, image, square));
        }
        self.complete_direction(total, &z)
    }

    /// The elastic response to a load.
    fn answer(&mut self, load: Trailing, part: &ZonePart) -> Answered {
        let mut change = Equilibrium::none(&load, self.now.gap.len());
        change.initial.load = load;
        let mut carried = vec![0.0; change.gap.len()];
        self.take_what_closed_pairs_carry(&mut change.initial.load, &mut carried);
        self.respond_homogeneous(&mut change, part);
        Answered { change, carried }
    }

    /// Completes a sum of search directions, with the remaining residual taken as a further step.
    fn complete_direction(&mut self, mut total: Equilibrium, left: &Answered) -> Equilibrium {
        total.add(1.0, &left.change);
        let contact = &mut total.initial.load.contact;
        let rows = &self.structure.model.rows;
        rows.add_forces(&left.carried, |i, force| contact[i] += force);
        for (k, c) in left.carried.iter().enumerate() {
            // Compressive forces push the two nodes of a pair apart.
            total.initial.forces[k] -= c;
            total.force[k] -= c;
        }
        let sub = &self.structure.sub;
        sub.balance_in_bodies(&mut total.initial.forces);
        self.recover_change(&mut total, &ZonePart::default());
        total
    }

    /// Subtracts the forces `-B' c` that closed pairs alone carry from a load, and adds them to
    /// `carried`.
    pub(super) fn take_what_closed_pairs_carry(&self, load: &mut Trailing, carried: &mut [f64]) {
        let rows = &self.structure.model.rows;
        rows.take_carried(&mut load.contact, carried, self.tableau.open());
    }

    /// The part of the zone whose displacements count in a tangent solve: where the material
    /// yields, and where the residual acts.
    fn part_that_counts(&self, residual: &Trailing) -> ZonePart {
        let mut marks: Vec<bool> = residual.zone.iter().map(|r| *r != 0.0).collect();
        self.zone.mark_active(&mut marks);
        self.zone.mark_kept(&mut marks);
        self.structure.sub.part_of_zone(&marks)
    }
}
