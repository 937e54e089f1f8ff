//! The factored tangent of the zone, used when conjugate gradients on the elastic factor take many
//! steps.
//!
//! ```text
//!     M = S - (1 - LEFT) K_p      of the iterate at which it was factored
//! ```
//!
//! is factored in the pattern of the zone's own factor ([`FactoredTangent`]); the rest of the model
//! stays condensed as it is. If the tangent is damped, its factor `keep` also multiplies `K_p` in
//! `M`. The factor is the preconditioner for the tangents of later iterates, which differ from `M`
//! in the points that yield and in the normals of the yield surface. In perfectly plastic material
//! near its limit load `S - K_p` is singular; `M >= LEFT S` is not.
//!
//! Operations, not times, decide when a factor pays. Conjugate gradient steps are taken one by one
//! until they have cost as much as a factor; the total is at most twice the cost of the better
//! choice, whatever follows. The factor is forgotten at the end of its increment, so a run resumed
//! from a checkpoint finds the next increment as the original run would have.
//!
//! # Source
//! A. R. Karlin, M. S. Manasse, L. Rudolph, D. D. Sleator (1988), *Competitive snoopy caching*,
//! doi:10.1007/BF01762111 (the rule).

use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::factored_tangent::FactoredTangent;
use crate::analysis::structure::solver::Solver;
use crate::contact::Tableau;
use crate::contact::springs::with_springs;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;

/// Largest number of iterations of a solve: enough for perfect plasticity near collapse. A solve
/// that needs more has no useful direction.
pub(super) const MOST: usize = 400;
/// Fraction of a direction's elastic stiffness that is round-off.
pub(super) const SINGULAR: f64 = 1e-14;
/// Number of conjugate gradient steps that cost as much as a direction found with a factor of the
/// tangent: such a direction takes two or three steps, each with two products, and the elastic
/// response to their result.
pub(super) const DIRECT: usize = 6;
/// Fraction of the elastic stiffness that stays in the factored tangent where flow takes off all of
/// it. It must exceed the share that counts as lost in a collapse ([`super::collapse`]), so that a
/// mechanism is far softer than all else, and be less than the root of that share, so that stiff
/// motions do not hide the mechanism: it is the geometric mean of the two.
const LEFT: f64 = 3.162_277_660_168_379_5e-5;

/// A search direction and its load, with work space for products.
struct SearchDirection {
    u: Trailing,
    load: Trailing,
    lost: Trailing,
    other: Trailing,
}

/// The system `(S - keep K_p) du = residual` of a structure, to be solved to a `tolerance` (energy
/// norm, relative).
pub(super) struct TangentSystem<'s, 'm> {
    pub(super) solver: &'s mut Solver<'m>,
    pub(super) tolerance: f64,
    /// Share of the softening that the tangent keeps.
    pub(super) keep: f64,
    /// The part of the zone whose displacements count.
    pub(super) part: ZonePart,
}

impl TangentSystem<'_, '_> {
    /// Counts a step of conjugate gradients beyond the number that a direction with a factor takes.
    /// Returns whether further steps are still cheaper than a factor.
    pub(super) fn may_go_on_without_factor(&mut self) -> bool {
        if self.solver.tangent.is_none() {
            self.solver.tangent = FactoredTangent::new(&self.solver.structure).map(Box::new);
        }
        let Some(tangent) = &mut self.solver.tangent else {
            return true;
        };
        tangent.spent += 1.0;
        tangent.is_refused || !tangent.is_paid()
    }

    /// Factors the tangent of the last evaluated state. Returns false if it has no factor.
    pub(super) fn factor(&mut self) -> bool {
        let Some(mut tangent) = self.solver.tangent.take() else {
            return false;
        };
        tangent.tableau = self.factored_tableau(&mut tangent);
        let is_factored = tangent.tableau.is_some();
        tangent.is_refused = !is_factored;
        self.solver.tangent = Some(tangent);
        is_factored
    }

    /// Factors the tangent again and returns its tableau; `None` if it has no factor.
    fn factored_tableau(&mut self, tangent: &mut FactoredTangent) -> Option<Tableau> {
        let share = (1.0 - LEFT) * self.keep;
        let softened = &mut tangent.softened;
        softened.begin();
        self.solver
            .zone
            .each_softening(share, |places, matrix| softened.take_off(places, matrix));
        self.solver.zone.keep_softening();
        self.solver.cost.counts.zone_factorizations += 1;
        (tangent.share, tangent.spent, tangent.is_fresh) = (share, 0.0, true);
        let structure = &self.solver.structure;
        let matrix = softened.factor(structure.model, &structure.sub.partition)?;
        let mut tableau = Tableau::new(with_springs(&matrix, &self.solver.springs));
        tableau.reset(self.solver.tableau.open());
        (tableau.open() == self.solver.tableau.open()).then_some(tableau)
    }

    /// Solves the tangent by conjugate gradients preconditioned with the factored tangent, starting
    /// from a remaining load and the displacements so far. Returns the displacements. The factor is
    /// renewed if that pays; `None` if there is no factor.
    pub(super) fn solve_by_factor(&mut self, so_far: (Trailing, Trailing)) -> Option<Trailing> {
        let mut tangent = self
            .solver
            .tangent
            .take_if(|tangent| tangent.tableau.is_some())?;
        let (mut load, mut u) = so_far;
        let mut done = false;
        let mut can = tangent.set_statuses(self.solver.tableau.open());
        while can && !done {
            done = self.steps_by_factor(&mut tangent, (&mut load, &mut u));
            if !done {
                tangent.tableau = self.factored_tableau(&mut tangent);
                can = tangent.tableau.is_some();
            }
        }
        if !can {
            (tangent.tableau, tangent.is_refused) = (None, true);
        }
        tangent.is_fresh = false;
        self.solver.tangent = Some(tangent);
        done.then_some(u)
    }

    /// Takes steps until one lowers the energy by no more than the share `tolerance` squared of the
    /// total decrease. Conjugate gradients measure this whatever their preconditioner (M. R.
    /// Hestenes, E. Stiefel 1952, doi:10.6028/jres.049.044). Returns false if another factor would
    /// have cost less.
    fn steps_by_factor(
        &mut self,
        tangent: &mut FactoredTangent,
        (load, u): (&mut Trailing, &mut Trailing),
    ) -> bool {
        let mut carried = vec![0.0; self.solver.now.gap.len()];
        let mut z = self.solver.structure.sub.zeros();
        let mut p = SearchDirection {
            u: z.clone(),
            load: z.clone(),
            lost: z.clone(),
            other: z.clone(),
        };
        let (mut before, mut gained) = (f64::INFINITY, 0.0);
        for step in 0..MOST {
            self.take_carried(load, &mut carried);
            tangent.solve(load, &self.part, &mut z);
            self.solver.cost.count_half();
            self.solver.cost.count_half();
            let rz = load.dot(&z);
            if rz <= 0.0 {
                break;
            }
            p.u.scale_and_add(rz / before, &z);
            p.load.scale_and_add(rz / before, load);
            before = rz;
            let stiffness = p.load.dot(&p.u);
            let curvature = stiffness - self.softer(tangent, &mut p);
            if curvature <= SINGULAR * stiffness {
                if step == 0 {
                    u.add(1.0, &p.u);
                }
                break;
            }
            let length = rz / curvature;
            u.add(length, &p.u);
            let gain = length * rz;
            gained += gain;
            if step > 0 && gain <= self.tolerance * self.tolerance * gained {
                break;
            }
            load.add(-length, &p.load);
            load.add(length, &p.lost);
            if step >= DIRECT / 2 && !tangent.is_fresh {
                tangent.spent += 1.0;
                if tangent.is_paid() {
                    return false;
                }
            }
        }
        true
    }

    /// Difference of the factored tangent and the current tangent along a direction: writes the
    /// forces to `lost` and returns their work.
    fn softer(&mut self, tangent: &FactoredTangent, p: &mut SearchDirection) -> f64 {
        self.solver.zone.softening_times(&p.u, &mut p.lost);
        self.solver.zone.kept_softening_times(&p.u, &mut p.other);
        for (lost, other) in p.lost.iter_mut().zip(p.other.iter()) {
            *lost = self.keep * *lost - tangent.share * other;
        }
        p.lost.dot(&p.u)
    }

    /// The direction whose displacements, in the part that counts, are `u`: the elastic response to
    /// the residual plus the forces that flow along `u` adds.
    pub(super) fn direction_along(&mut self, u: &Trailing, residual: &Trailing) -> Equilibrium {
        let mut load = self.solver.structure.sub.zeros();
        self.solver.zone.softening_times(u, &mut load);
        load.scale_and_add(self.keep, residual);
        self.solver.direction(load)
    }

    /// Subtracts the forces `-B' c` that closed pairs alone carry from a load, and adds them to
    /// `carried`.
    pub(super) fn take_carried(&self, load: &mut Trailing, carried: &mut [f64]) {
        let rows = &self.solver.structure.model.rows;
        rows.take_carried(&mut load.contact, carried, self.solver.tableau.open());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::increments::collapse::LOST;

    #[test]
    fn what_is_left_lies_between_what_is_lost_and_its_root() {
        assert!((LEFT.powi(4) / LOST.powi(3) - 1.0).abs() < 1e-14);
    }
}
