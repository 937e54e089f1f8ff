//! Flow rule along the straight strain path of an increment.
//!
//! The implicit rule lets the whole increment flow in the direction that flow has at its end. This
//! is exact while the direction does not turn; otherwise the error is half the angle, of first
//! order in the increments. Here the path is cut into [`parts::PARTS`] in which the direction of
//! flow turns by the same angle, a few tenths at most, and each part is integrated twice by the
//! implicit rule, in one step and in two halves. Twice the second result minus the first is of
//! second order (Richardson), and where the material loses most of its stiffness it stays as stable
//! as the implicit rule itself. The result changes smoothly with the end of the path, so that
//! iterations converge.
//!
//! In plane stress the strain across the plane turns a path that is straight in the plane as soon
//! as flow begins, even in a bar under tension. There the implicit rule, which is exact for
//! proportional stresses, is kept.
//!
//! # Source
//! L. F. Richardson (1911), doi:10.1098/rsta.1911.0009; substeps along strain paths: S. W.
//! Sloan (1987), doi:10.1002/nme.1620240505.

mod deviators;
mod parts;

use super::{Lame, Material, Past, Update};
use crate::space::Space;
use deviators::Deviators;
pub use parts::Memory;
use parts::{LEAST_TURN, StrainPath};

impl Material {
    /// Integrates the flow rule along the straight path from the total strain `begin`, which
    /// belongs to the history `old`, to `end`; by the implicit rule in one step if `begin` is not
    /// known. If the point yields, `memory` holds the strains at the end afterwards.
    ///
    /// The tangent is that of the implicit rule over the whole path with two changes. Its normal is
    /// the direction of flow at the end. Its reduction of the stiffness across the flow is that
    /// along a path on which flow does not turn ([`parts::Across`]): without hardening and with
    /// `x = 3 G d/sigma_y` this is `1 - (1 - exp(-x))/x`, whereas one step gives
    /// `3 G d/q = x/(1 + x)`. The difference would slow down iterations. If back stresses fade, the
    /// tangent is that of one step.
    pub(crate) fn integrate_along<const S: usize>(
        &self,
        law: &Lame,
        (begin, end): (Option<&[f64; S]>, &[f64; S]),
        old: &Past<S>,
        memory: &mut Memory<S>,
    ) -> Update<S> {
        let whole = self.integrate(law, end, old);
        if !whole.yields {
            return whole;
        }
        memory.strains.copy_from_slice(old.back);
        memory.lost_work = 0.0;
        let path = StrainPath {
            material: self,
            law,
            begin: begin.unwrap_or(end),
            end,
            harder: old.harder,
        };
        if begin.is_none() || self.space == Space::PlaneStress {
            path.carry(old.state, &whole.state, memory);
            return whole;
        }
        let integrated = match (&self.hardening, self.back_stresses.n_stored()) {
            (Some(hardening), 0) => {
                let share = path.begin_of_flow(old);
                let begin = path.relative(path.begin, old);
                Deviators::new(&path, hardening).integrate(&begin, share, old.state, LEAST_TURN)
            }
            _ => path.integrate(old, &whole.state, memory),
        };
        let Some((state, lost, normal)) = integrated else {
            return whole;
        };
        let mut update = Update { state, ..whole };
        if self.back_stresses.n_stored() == 0 {
            let softening = &mut update.softening;
            let isotropic = Lame::of_deviator(2.0 * self.shear_modulus() * lost);
            softening.along += 2.0 * (softening.isotropic.mu - isotropic.mu);
            softening.isotropic = isotropic;
            softening.normal = normal.unwrap_or(softening.normal);
        }
        update
    }
}
