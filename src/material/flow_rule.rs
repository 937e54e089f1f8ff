//! Flow rule over an increment: whether a point yields, and the implicit rule of its kind of space.

use super::history::{Past, Update};
use super::radial_return::PlasticFlow;
use super::tensor::von_mises;
use super::{Hardening, Lame, Material, Softening, plane_stress, radial_return};
use crate::space::Space;

impl Material {
    /// Stress for a total strain minus the back stress, on which the yield condition is based.
    #[inline]
    pub(super) fn relative_stress<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> [f64; S] {
        let mut out = law.stress(strain, &old.state.strain);
        if !self.back_stresses.is_none() {
            let plastic = &old.state.strain;
            self.back_stresses.take_off(&mut out, plastic, old.back);
        }
        out
    }

    /// Trial stress of a total strain without further flow, minus the back stress, and the
    /// hardening; `None` if the trial stress lies within the yield surface. NaN counts as outside.
    #[inline]
    fn beyond_yield<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> Option<(&Hardening, [f64; S])> {
        let hardening = self.hardening.as_ref()?;
        let trial = self.relative_stress(law, strain, old);
        let within = von_mises(&trial) <= old.yield_stress(hardening, 0.0);
        (!within).then_some((hardening, trial))
    }

    /// Whether a total strain lies within the yield surface of a history, in which case
    /// [`Material::integrate`] changes nothing.
    #[inline]
    pub(crate) fn stays_elastic<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> bool {
        self.beyond_yield(law, strain, old).is_none()
    }

    /// Integrates the flow rule, given the total strain at the end of the increment and the history
    /// at its start. `law` is [`Material::lame`], passed in because the caller already has it.
    ///
    /// # Source
    /// J. C. Simo, T. J. R. Hughes, *Computational Inelasticity* (1998), boxes 3.1 to 3.3.
    pub(crate) fn integrate<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> Update<S> {
        let Some((hardening, trial)) = self.beyond_yield(law, strain, old) else {
            return Update {
                state: *old.state,
                softening: Softening::NONE,
                turn: [0.0; S],
                yields: false,
            };
        };
        match self.space {
            Space::PlaneStress => plane_stress::integrate(self, hardening, &trial, old),
            _ => radial_return::integrate(self, hardening, &trial, old),
        }
    }

    /// Integrates the flow rule like [`Material::integrate`], without the tangent; not in plane
    /// stress.
    pub(super) fn flow<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> PlasticFlow<S> {
        match self.beyond_yield(law, strain, old) {
            Some((hardening, trial)) => radial_return::flow(self, hardening, &trial, old),
            None => PlasticFlow::none(*old.state),
        }
    }
}
