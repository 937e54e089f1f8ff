//! How good a state is.
//!
//! Nothing here takes the solver's word: gaps are those of the displacements, contact forces those that the stresses leave over on
//! the contact nodes, neither of them clipped. A wrong status shows as tension or penetration, a wrong condensed matrix or
//! factor as forces out of balance.
//!
//! Figures are relative to the largest load and displacement of the run up to here, so that they keep their meaning
//! where everything is unloaded.

#[cfg(test)]
mod tests;

use super::engine::Engine;
use super::stresses::Stresses;
use crate::linalg::largest;
use crate::model::Model;
use crate::results::{Quality, Tolerances};

/// Share of the largest force or displacement that an elastic state may be off: round-off times any condition that a state is worth
/// having at.
const ROUND_OFF: f64 = 1e-8;

/// What no setting of the scene makes acceptable: a thousandth of the largest force on the wrong side.
const LOOSEST: f64 = 1e-3;

/// What the quality of a state of this model must keep: the tolerances that the scene asks for, with room for what
/// is measured elsewhere than iterated, and round-off.
pub(super) fn tolerances(model: &Model) -> Tolerances {
    let settings = &model.scene.analysis;
    // Between events a pair may be beyond its condition by gamma.
    let forces = ROUND_OFF
        .max(100.0 * settings.tolerance)
        .max(10.0 * model.scene.program.gamma)
        .min(LOOSEST);
    Tolerances {
        backward_error: (16.0 * f64::EPSILON * model.freedoms.n as f64).max(1e-12),
        equilibrium: forces,
        contact: forces,
    }
}

/// Displacements of all freedoms.
pub(super) struct Displacements {
    /// The whole.
    pub total: Vec<f64>,
    /// Without the rigid motions of floating bodies; `None` where there are none.
    deformation: Option<Vec<f64>>,
    /// Largest `|f - K u|` of the deformation.
    residual: f64,
    /// Largest `|f|`.
    load: f64,
    /// Largest of a row's `|f - K u|` over its `|K| |u| + |f|`.
    componentwise_error: f64,
}

impl Displacements {
    /// What strains are taken from.
    pub(super) fn deformation(&self) -> &[f64] {
        self.deformation.as_ref().unwrap_or(&self.total)
    }
}

impl Engine<'_> {
    /// Displacements of the current state. Costs half a full solve and a product with K.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(super) fn displacements(&mut self) -> crate::Result<Displacements> {
        self.refresh();
        let model = self.model;
        let reduced = self.reduced_external(&self.at);
        let load = self.total_load();
        let mut condensed = self.external(&self.at);
        condensed.add(1.0, &self.now.initial.load);
        let (found, amplitudes) =
            self.sub
                .recover_deformation(self.system, &load, &reduced, condensed, &self.slip())?;
        self.counts.full_solves += 1;
        self.counts.trailing_solves += 1;
        let mut out = Displacements {
            total: found.u,
            deformation: None,
            residual: found.residual,
            load: largest(&load),
            componentwise_error: found.componentwise_error,
        };
        if amplitudes.iter().any(|a| *a != 0.0) {
            out.deformation = Some(out.total.clone());
            for (motion, amplitude) in model.floating.motions.iter().zip(&amplitudes) {
                for &(freedom, value) in &motion.values {
                    out.total[freedom as usize] += amplitude * value;
                }
            }
        }
        Ok(out)
    }

    /// Quality of the current state, where nothing else of it is wanted. Costs half a full solve and the stresses of all elements.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(super) fn quality_here(&mut self) -> crate::Result<Quality> {
        let u = self.displacements()?;
        let nodal = self.model.nodal(u.deformation(), &self.at.factors);
        let stresses = Stresses::new(self.model, &self.zone, &self.elements, &nodal, false);
        Ok(self.quality(&u, &stresses))
    }

    /// Quality of the current state.
    pub(super) fn quality(&mut self, u: &Displacements, stresses: &Stresses) -> Quality {
        let external = self.external_forces();
        let applied = largest(&external);
        self.update_scales();
        // Reactions measure the load where displacements are prescribed.
        let reaction = largest(&stresses.reactions);
        self.force_scale = self.force_scale.max(applied).max(reaction);
        self.displacement_scale = self.displacement_scale.max(largest(&u.total));
        let out_of_balance: Vec<f64> = stresses
            .internal
            .iter()
            .zip(&external)
            .map(|(i, e)| i - e)
            .collect();

        let mut quality = Quality {
            backward_error: self.backward_error(u),
            componentwise_error: Some(u.componentwise_error),
            ..Quality::default()
        };
        let n = self.now.force.len();
        let mut worst = 0.0f64;
        let mut touched = vec![0.0; out_of_balance.len()];
        for (i, &f) in self.sub.partition.contact.iter().enumerate() {
            let sign = if i < n { 1.0 } else { -1.0 };
            touched[f] = sign * self.now.force[i % n];
        }
        for (b, r) in out_of_balance.iter().zip(&touched) {
            worst = worst.max((b - r).abs());
        }
        quality.equilibrium = self.share_of_forces(worst);

        let delta = self.delta(&self.at);
        let gap_scale = delta
            .iter()
            .fold(self.displacement_scale, |m, d| m.max(d.abs()));
        let contact = &self.sub.partition.contact;
        for k in 0..n {
            let (first, second) = (contact[k], contact[n + k]);
            let gap = delta[k] - (u.total[second] - u.total[first]);
            let forces = [out_of_balance[first], -out_of_balance[second]];
            quality.penetration = quality
                .penetration
                .max(ratio(-gap, self.displacement_scale));
            for force in forces {
                let (tension, size) = (-force, force.abs());
                quality.adhesion = quality.adhesion.max(self.share_of_forces(tension));
                let product = ratio(gap.abs(), gap_scale) * self.share_of_forces(size);
                quality.complementarity = quality.complementarity.max(product);
            }
        }
        quality
    }

    /// A force over the largest of the run. Where nothing has acted yet (a body that an interference lifted) what the stresses leave over is the round-off of
    /// stiffness times displacement, and no force.
    fn share_of_forces(&self, force: f64) -> f64 {
        let round_off = 16.0 * f64::EPSILON * self.system.norm * self.displacement_scale;
        if self.force_scale <= round_off && force.abs() <= round_off {
            return 0.0;
        }
        ratio(force, self.force_scale)
    }

    fn external_forces(&self) -> Vec<f64> {
        let mut external = vec![0.0; self.model.freedoms.n];
        for (load, &factor) in self.model.loads.iter().zip(&self.at.factors) {
            for &(f, force) in &load.forces {
                external[f] += factor * force;
            }
        }
        external
    }

    /// `|f - K u| / (|K| |u| + |f|)` in infinity norms, `u` and `f` the run's largest.
    fn backward_error(&self, u: &Displacements) -> f64 {
        let size = largest(u.deformation()).max(self.displacement_scale);
        let scale = self.system.norm * size + u.load.max(self.force_scale);
        ratio(u.residual, scale)
    }
}

fn ratio(value: f64, scale: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / scale }
}
