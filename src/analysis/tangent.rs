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

    /// Solves `(S - keep K_p) du = residual` to `tolerance` (energy norm, relative) and returns `keep K_p du`, the change of
    /// initial loads beyond the residual that Newton's method asks for. `keep = 1` is the tangent, 0 the plain iteration;
    /// in between the condition is at most `1/(1 - keep)`, also where the material has no stiffness left.
    pub fn solve_tangent(&mut self, residual: &Trailing, tolerance: f64, keep: f64) -> Trailing {
        let n = self.now.gap.len();
        let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
        let mut softened = self.sub.zeros();
        let mut total = self.sub.zeros();
        let mut r = residual.clone();
        let mut z = r.clone();
        self.respond_homogeneous(&mut z, &mut gap, &mut force);
        let mut p = z.clone();
        let mut stiff_p = r.clone();
        let mut rz = r.dot(&z);
        let target = tolerance * tolerance * rz;
        for _ in 0..MOST {
            if rz <= target || rz <= 0.0 {
                break;
            }
            self.zone.softening_times(&p, &mut softened);
            for value in softened.iter_mut() {
                *value *= keep;
            }
            let curvature = stiff_p.dot(&p) - softened.dot(&p);
            if curvature <= 1e-14 * stiff_p.dot(&p) {
                break;
            }
            let step = rz / curvature;
            total.add(step, &softened);
            r.add(-step, &stiff_p);
            r.add(step, &softened);
            z.copy_from(&r);
            self.respond_homogeneous(&mut z, &mut gap, &mut force);
            let next = r.dot(&z);
            let beta = next / rz;
            rz = next;
            for (p, z) in p.iter_mut().zip(z.iter()) {
                *p = z + beta * *p;
            }
            for (s, r) in stiff_p.iter_mut().zip(r.iter()) {
                *s = r + beta * *s;
            }
        }
        total
    }
}
