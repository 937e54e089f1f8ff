//! The elastoplastic tangent, solved by conjugate gradients on the factored elastic stiffness.
//!
//! With `K_p = sum_g w_g B' (D - D_ep) B` the tangent is `S - K_p`. Preconditioned with `S` itself (one
//! trailing solve), its condition is that of the material: `(3G + H)/H` at worst, and the product with `S` is
//! never needed because `S p` follows from the recurrence of the search directions.

use super::engine::Engine;
use crate::substructure::Trailing;

/// Most iterations of a solve: enough for perfect plasticity near collapse; a solve that needs more has no useful direction.
const MOST: usize = 400;

/// A change of displacements with what follows from it.
#[derive(Debug, Clone)]
pub struct Direction {
    /// Change of displacements.
    pub u: Trailing,
    /// Change of initial loads.
    pub initial: Trailing,
    /// Change of gaps.
    pub gap: Vec<f64>,
    /// Change of contact forces.
    pub force: Vec<f64>,
}

impl Engine<'_> {
    /// The direction of initial loads `initial`, closed pairs staying closed.
    pub fn direction(&mut self, initial: Trailing) -> Direction {
        let n = self.now.gap.len();
        let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
        let mut u = initial.clone();
        self.respond_homogeneous(&mut u, &mut gap, &mut force);
        Direction {
            u,
            initial,
            gap,
            force,
        }
    }

    /// Newton's direction: solves `(S - keep K_p) du = residual` to `tolerance` (energy norm, relative). The initial loads of
    /// the direction are `S du`, what the direction asks the plastic strains to become. `keep = 1` is the tangent, 0 the plain
    /// iteration; in between the condition is at most `1/(1 - keep)`, also where the material has no stiffness left.
    ///
    /// The search directions carry their gaps and forces along, and the last preconditioned residual `z = S^-1 r` is
    /// taken as a step of the plain iteration on top, so that no trailing solve but those of the iteration is needed.
    pub fn solve_tangent(&mut self, residual: &Trailing, tolerance: f64, keep: f64) -> Direction {
        let mut softened = self.sub.zeros();
        let mut r = residual.clone();
        let mut z = self.direction(r.clone());
        let mut total = Direction {
            u: self.sub.zeros(),
            initial: self.sub.zeros(),
            gap: vec![0.0; z.gap.len()],
            force: vec![0.0; z.force.len()],
        };
        let mut p = z.clone();
        let mut rz = r.dot(&z.u);
        let target = tolerance * tolerance * rz;
        for _ in 0..MOST {
            if rz <= target || rz <= 0.0 {
                break;
            }
            self.zone.softening_times(&p.u, &mut softened);
            for value in softened.iter_mut() {
                *value *= keep;
            }
            let stiffness = p.initial.dot(&p.u);
            let curvature = stiffness - softened.dot(&p.u);
            if curvature <= 1e-14 * stiffness {
                break;
            }
            let step = rz / curvature;
            total.add(step, &p);
            r.add(-step, &p.initial);
            r.add(step, &softened);
            z.u.copy_from(&r);
            z.initial.copy_from(&r);
            self.respond_homogeneous(&mut z.u, &mut z.gap, &mut z.force);
            let next = r.dot(&z.u);
            p.turn(next / rz, &z);
            rz = next;
        }
        total.add(1.0, &z);
        total
    }
}

impl Direction {
    /// `self += factor * other`.
    pub fn add(&mut self, factor: f64, other: &Direction) {
        self.u.add(factor, &other.u);
        self.initial.add(factor, &other.initial);
        for (a, b) in self.gap.iter_mut().zip(&other.gap) {
            *a += factor * b;
        }
        for (a, b) in self.force.iter_mut().zip(&other.force) {
            *a += factor * b;
        }
    }

    /// `self = other + factor * self`.
    fn turn(&mut self, factor: f64, other: &Direction) {
        let values = self.u.iter_mut().chain(self.initial.iter_mut());
        let others = other.u.iter().chain(other.initial.iter());
        let pairs = self.gap.iter_mut().chain(&mut self.force);
        let other_pairs = other.gap.iter().chain(&other.force);
        for (a, b) in values.chain(pairs).zip(others.chain(other_pairs)) {
            *a = b + factor * *a;
        }
    }
}
