//! The tangent of the zone, factored: where conjugate gradients on the elastic factor take many
//! steps.
//!
//! ```text
//!     M = S - (1 - LEFT) K_p      of the iterate at which it was factored
//! ```
//!
//! is factored in the pattern of the zone's own factor ([`FactoredTangent`]); all else of the model
//! stays condensed as it is. It solves the tangents of the iterates that follow as preconditioner:
//! their difference from `M` is that of the points that yield and of their normals. Perfectly
//! plastic material near its limit load leaves `S - K_p` singular; `M >= LEFT S` is not.
//!
//! When it pays is decided from operations, not from time: steps of conjugate gradients are bought
//! one by one until they have cost what a factor would have, which comes at most twice as dear as
//! the better choice, whatever follows. It is forgotten with its increment: a run that goes on from
//! a checkpoint finds the next one as the run before it would have.
//!
//! # Source
//! A. R. Karlin, M. S. Manasse, L. Rudolph, D. D. Sleator (1988), *Competitive snoopy caching*,
//! doi:10.1007/BF01762111 (the rule).

use super::tangent::{DIRECT, MOST, SINGULAR};
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::factored_tangent::FactoredTangent;
use crate::analysis::structure::solver::Solver;
use crate::contact::Tableau;
use crate::contact::springs::with_springs;
use crate::linalg::ZonePart;
use crate::substructure::Trailing;

/// Share of the elastic stiffness that stays in the factored tangent where flow takes all. Between
/// what counts as lost in a collapse ([`super::collapse`]), so that a mechanism is far
/// softer than all else, and the root of that, so that what is stiff does not hide it: the
/// geometric mean of the two.
const LEFT: f64 = 3.162_277_660_168_379_5e-5;

/// A search direction and its load, and room for what products with it are made of.
struct SearchDirection {
    u: Trailing,
    load: Trailing,
    lost: Trailing,
    other: Trailing,
}

impl Solver<'_> {
    /// Takes note of a step of conjugate gradients beyond what one with a factor takes: whether it
    /// is still cheaper than a factor.
    pub(super) fn may_go_on_without_factor(&mut self) -> bool {
        if self.tangent.is_none() {
            self.tangent = FactoredTangent::new(&self.structure).map(Box::new);
        }
        let Some(tangent) = &mut self.tangent else {
            return true;
        };
        tangent.spent += 1.0;
        tangent.is_refused || !tangent.is_paid()
    }

    /// Factors the tangent of the last evaluated state, of whose softening a share `keep` counts;
    /// false where it has no factor.
    pub(super) fn factor_tangent(&mut self, keep: f64) -> bool {
        let Some(mut tangent) = self.tangent.take() else {
            return false;
        };
        tangent.tableau = self.factored_tableau(&mut tangent, keep);
        let is_factored = tangent.tableau.is_some();
        tangent.is_refused = !is_factored;
        self.tangent = Some(tangent);
        is_factored
    }

    /// The tableau of a tangent that is factored anew.
    fn factored_tableau(&mut self, tangent: &mut FactoredTangent, keep: f64) -> Option<Tableau> {
        let share = (1.0 - LEFT) * keep;
        let softened = &mut tangent.softened;
        softened.begin();
        self.zone
            .each_softening(share, |places, matrix| softened.take_off(places, matrix));
        self.zone.keep_softening();
        self.cost.counts.zone_factorizations += 1;
        (tangent.share, tangent.spent, tangent.is_fresh) = (share, 0.0, true);
        let structure = &self.structure;
        let matrix = softened.factor(structure.model, &structure.sub)?;
        let mut tableau = Tableau::new(with_springs(&matrix, &self.springs));
        tableau.reset(self.tableau.open());
        (tableau.open() == self.tableau.open()).then_some(tableau)
    }

    /// Forgets the factored tangent.
    pub(in crate::analysis) fn forget_tangent(&mut self) {
        self.zone.forget_softening();
        if let Some(tangent) = &mut self.tangent {
            (tangent.tableau, tangent.is_refused, tangent.spent) = (None, false, 0.0);
        }
    }

    /// Displacements that solve the tangent, by conjugate gradients on the factored one, from some
    /// at which a load is left; the factor is renewed where that pays. `None` where there is none.
    pub(super) fn solve_by_factor(
        &mut self,
        so_far: (Trailing, Trailing),
        (tolerance, keep): (f64, f64),
        part: &ZonePart,
    ) -> Option<Trailing> {
        let mut tangent = self.tangent.take_if(|tangent| tangent.tableau.is_some())?;
        let (mut load, mut u) = so_far;
        let mut done = false;
        let mut can = tangent.set_statuses(self.tableau.open());
        while can && !done {
            done = self.steps_by_factor(&mut tangent, (&mut load, &mut u), tolerance, keep, part);
            if !done {
                tangent.tableau = self.factored_tableau(&mut tangent, keep);
                can = tangent.tableau.is_some();
            }
        }
        if !can {
            (tangent.tableau, tangent.is_refused) = (None, true);
        }
        tangent.is_fresh = false;
        self.tangent = Some(tangent);
        done.then_some(u)
    }

    /// Steps until one lowers the energy by no more than the share `tolerance` squared of what all
    /// do: conjugate gradients measure that whatever they are preconditioned with (M. R. Hestenes,
    /// E. Stiefel 1952, doi:10.6028/jres.049.044). False where another factor would have cost less.
    fn steps_by_factor(
        &mut self,
        tangent: &mut FactoredTangent,
        (load, u): (&mut Trailing, &mut Trailing),
        tolerance: f64,
        keep: f64,
        part: &ZonePart,
    ) -> bool {
        let mut carried = vec![0.0; self.now.gap.len()];
        let mut z = self.structure.sub.zeros();
        let mut p = SearchDirection {
            u: z.clone(),
            load: z.clone(),
            lost: z.clone(),
            other: z.clone(),
        };
        let (mut before, mut gained) = (f64::INFINITY, 0.0);
        for step in 0..MOST {
            self.take_what_closed_pairs_carry(load, &mut carried);
            tangent.solve(load, part, &mut z);
            self.cost.count_half();
            self.cost.count_half();
            let rz = load.dot(&z);
            if rz <= 0.0 {
                break;
            }
            p.u.scale_and_add(rz / before, &z);
            p.load.scale_and_add(rz / before, load);
            before = rz;
            let stiffness = p.load.dot(&p.u);
            let curvature = stiffness - self.softer(tangent, &mut p, keep);
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
            if step > 0 && gain <= tolerance * tolerance * gained {
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

    /// What the tangent has less than the factored one along a direction: forces in `lost`, and the
    /// work of these.
    fn softer(&mut self, tangent: &FactoredTangent, p: &mut SearchDirection, keep: f64) -> f64 {
        self.zone.softening_times(&p.u, &mut p.lost);
        self.zone.kept_softening_times(&p.u, &mut p.other);
        for (lost, other) in p.lost.iter_mut().zip(p.other.iter()) {
            *lost = keep * *lost - tangent.share * other;
        }
        p.lost.dot(&p.u)
    }

    /// The direction in which displacements, where they count, are `u`: what the structure answers
    /// to the residual and to what the flow along `u` adds to it.
    pub(super) fn direction_along(
        &mut self,
        u: &Trailing,
        residual: &Trailing,
        keep: f64,
    ) -> Equilibrium {
        let mut load = self.structure.sub.zeros();
        self.zone.softening_times(u, &mut load);
        load.scale_and_add(keep, residual);
        self.direction(load)
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
