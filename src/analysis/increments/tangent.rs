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
//! Fading back stresses make the tangent unsymmetric if the direction of flow turns. The system is
//! then solved by conjugate residuals that keep the last few directions (Orthomin), with the same
//! preconditioner and the same work per direction: S. C. Eisenstat, H. C. Elman, M. H. Schultz
//! (1983), doi:10.1137/0720023.

use super::tangent_by_factor::{DIRECT, MOST, SINGULAR, TangentSystem};
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::solver::Solver;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;
use std::collections::VecDeque;

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

/// Newton's direction: solves `(S - keep K_p) du = residual` to `tolerance` (energy norm,
/// relative). The initial loads of the direction are `S du`: the change of initial loads for which
/// `du` is the elastic response. `keep = 1` is the tangent, 0 the plain iteration. In between, the
/// condition number is at most `1/(1 - keep)`, even if the material has no stiffness left.
///
/// The search directions carry their gaps, forces and eliminated loads along, and the last
/// preconditioned residual `z = S^-1 r` is added as a step of the plain iteration. In addition
/// to the iteration's trailing solves, the direction therefore costs half a solve. In the
/// iteration, the second halves pass only through the part of the zone that counts.
pub(in crate::analysis) fn solve_tangent(
    solver: &mut Solver,
    residual: &Trailing,
    tolerance: f64,
    keep: f64,
) -> Equilibrium {
    let part = part_that_counts(solver, residual);
    let mut system = TangentSystem {
        solver,
        tolerance,
        keep,
        part,
    };
    system.solve(residual)
}

/// The part of the zone whose displacements count in a tangent solve: where the material yields,
/// where it yielded when the tangent was factored, and where the residual acts.
fn part_that_counts(solver: &Solver, residual: &Trailing) -> ZonePart {
    let mut marks: Vec<bool> = residual.zone.iter().map(|r| *r != 0.0).collect();
    solver.zone.mark_active(&mut marks);
    solver.zone.mark_kept(&mut marks);
    solver.structure.sub.part_of_zone(&marks)
}

impl TangentSystem<'_, '_> {
    /// Solves the system with the factored tangent, if there is one. Otherwise takes conjugate
    /// gradient steps on the elastic factor, and factors the tangent once that pays.
    fn solve(&mut self, residual: &Trailing) -> Equilibrium {
        let at_rest = (residual.clone(), self.solver.structure.sub.zeros());
        if let Some(u) = self.solve_by_factor(at_rest) {
            return self.direction_along(&u, residual);
        }
        let mut left = self.answer(residual.clone());
        let size = self.tolerance * left.dot(&left).max(0.0).sqrt();
        if !self.solver.zone.is_symmetric() {
            return self.conjugate_residuals(left, size);
        }
        let mut total = Equilibrium::none(residual, left.carried.len());
        while !self.conjugate_gradients((&mut total, &mut left), size) {
            if self.factor() {
                let so_far = (left.change.initial.load.clone(), total.u.clone());
                if let Some(u) = self.solve_by_factor(so_far) {
                    return self.direction_along(&u, residual);
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
    ) -> bool {
        let keep = self.keep;
        let mut softened = self.solver.structure.sub.zeros();
        let mut p = z.change.clone();
        let mut rz = z.dot(z);
        for step in 0..MOST {
            if rz <= size * size || rz <= 0.0 {
                break;
            }
            if step >= DIRECT && !self.may_go_on_without_factor() {
                return false;
            }
            self.solver.zone.softening_times(&p.u, &mut softened);
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
            self.take_carried(load, &mut z.carried);
            self.solver.respond_homogeneous(&mut z.change, &self.part);
            let next = z.dot(z);
            p.scale_and_add(next / rz, &z.change);
            rz = next;
        }
        true
    }

    /// Conjugate residuals on the elastic factor, for an unsymmetric tangent, starting from the
    /// residual `z`, until what is left of it is below `size`.
    fn conjugate_residuals(&mut self, mut z: Answered, size: f64) -> Equilibrium {
        let mut softened = self.solver.structure.sub.zeros();
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
            self.solver.zone.softening_times(&p.u, &mut softened);
            let mut load = p.initial.load.clone();
            load.add(-self.keep, &softened);
            let mut image = self.answer(load);
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
    fn answer(&mut self, load: Trailing) -> Answered {
        let mut change = Equilibrium::none(&load, self.solver.now.gap.len());
        change.initial.load = load;
        let mut carried = vec![0.0; change.gap.len()];
        self.take_carried(&mut change.initial.load, &mut carried);
        self.solver.respond_homogeneous(&mut change, &self.part);
        Answered { change, carried }
    }

    /// Completes a sum of search directions, with the remaining residual taken as a further step.
    fn complete_direction(&mut self, mut total: Equilibrium, left: &Answered) -> Equilibrium {
        total.add(1.0, &left.change);
        let contact = &mut total.initial.load.contact;
        let rows = &self.solver.structure.model.rows;
        rows.add_forces(&left.carried, |i, force| contact[i] += force);
        for (k, c) in left.carried.iter().enumerate() {
            // Compressive forces push the two nodes of a pair apart.
            total.initial.forces[k] -= c;
            total.force[k] -= c;
        }
        let sub = &self.solver.structure.sub;
        sub.balance_in_bodies(&mut total.initial.forces);
        self.solver.recover_change(&mut total, &ZonePart::default());
        total
    }
}
