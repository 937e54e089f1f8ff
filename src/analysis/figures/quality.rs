//! The quality of a state.
//!
//! No figure relies on the solver's own values. Gaps follow from the displacements, contact forces
//! from the stresses as the forces left over on contact nodes; neither is clipped. A wrong status
//! shows as tension or penetration, a wrong condensed matrix or factor as forces out of balance.
//!
//! Figures are relative to the largest load and displacement of the run so far, so that they keep
//! their meaning when everything is unloaded. Rigid body motions of floating bodies, which cause no
//! stress, do not count in the displacements to which stresses and their round-off are compared.

#[cfg(test)]
mod tests;

use super::reading::Reading;
use crate::analysis::structure::round_off::{LOOSEST, ROUND_OFF_OF_FORCES};
use crate::linalg::largest;
use crate::model::Model;
use crate::results::{Quality, Tolerances};

/// Fraction of the largest force or displacement by which an elastic state may be off: round-off
/// times any condition number at which a state is still of use.
const ROUND_OFF: f64 = 1e-8;

/// The bounds on the quality of a state of this model: the tolerances of the settings, with
/// room for the difference between measured and iterated quantities, and for round-off.
pub(in crate::analysis) fn tolerances(model: &Model) -> Tolerances {
    let settings = &model.settings;
    // Between changes of contact, a gap or a contact force may be negative by gamma.
    let forces = ROUND_OFF
        .max(100.0 * settings.tolerance)
        .max(10.0 * model.program.gamma)
        .min(LOOSEST);
    Tolerances {
        backward_error: (16.0 * f64::EPSILON * model.freedoms.n as f64).max(1e-12),
        equilibrium: forces,
        contact: forces,
        loosest: LOOSEST,
    }
}

/// Displacements of all freedoms, with the residuals of their equations.
pub(in crate::analysis) struct Displacements {
    /// The whole displacements, including rigid body motions.
    pub total: Vec<f64>,
    /// Displacements without the rigid body motions of floating bodies; `None` if there are no such
    /// motions.
    deformation: Option<Vec<f64>>,
    /// Largest `|f - K u|` of a row, for the deformation.
    residual: f64,
    /// Largest `|K| |u|` of a row, for the deformation.
    terms: f64,
    /// Largest `|f|` of a row.
    load: f64,
    /// Largest quotient of a row's `|f - K u|` and its `|K| |u| + |f|`.
    componentwise_error: f64,
}

impl Displacements {
    /// The displacements from which strains are computed.
    pub(in crate::analysis) fn deformation(&self) -> &[f64] {
        self.deformation.as_ref().unwrap_or(&self.total)
    }
}

impl Reading<'_, '_> {
    /// Finds the displacements of the current state. Costs half a full solve and a product with K.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(in crate::analysis) fn displacements(&mut self) -> crate::Result<Displacements> {
        self.solver.refresh();
        let model = self.solver.structure.model;
        let reduced = self.solver.structure.reduced_external(&self.solver.at);
        let mut load = self.solver.total_load();
        // A rigid surface has no stiffness: the forces on it are left out of this balance, and the
        // forces out of balance show whether they are in equilibrium.
        let rigid = model.freedoms.of_rigid();
        rigid.for_each(|freedom| load[freedom] = 0.0);
        let mut condensed = self.solver.structure.external(&self.solver.at);
        condensed.add(1.0, &self.solver.now.initial.load);
        let slip = self.solver.structure.sub.split_slip(
            &self.solver.structure.delta(&self.solver.at),
            &self.solver.now.gap,
        );
        let (found, amplitudes) = self.solver.structure.sub.recover_deformation(
            self.solver.structure.system,
            &load,
            &reduced,
            condensed,
            slip,
            [self.solver.scales.deformation, self.solver.scales.force],
        )?;
        self.solver.cost.counts.full_solves += 1;
        self.solver.cost.counts.trailing_solves += 1;
        let mut out = Displacements {
            total: found.u,
            deformation: None,
            residual: found.residual,
            terms: found.terms,
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

    /// The quality of the current state, if no other figure of it is wanted. Costs half a full
    /// solve and the stresses of all elements.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(in crate::analysis) fn quality_here(&mut self) -> crate::Result<Quality> {
        let u = self.displacements()?;
        self.quality_of(&u)
    }

    /// The quality of the current state with the given displacements.
    fn quality_of(&mut self, u: &Displacements) -> crate::Result<Quality> {
        let stresses = self.stresses(u.deformation(), false)?;
        Ok(self.quality(u, stresses.internal, &stresses.reactions))
    }

    /// The quality of the current state, given its `internal` forces and the `reactions` on
    /// prescribed displacements.
    pub(in crate::analysis) fn quality(
        &mut self,
        u: &Displacements,
        internal: Vec<f64>,
        reactions: &[f64],
    ) -> Quality {
        let external = self.external_forces();
        let applied = external.iter().fold(0.0f64, |m, (_, f)| m.max(f.abs()));
        self.solver.update_scales();
        // If displacements are prescribed, reactions measure the load.
        let scales = &mut self.solver.scales;
        scales.force = scales.force.max(applied).max(largest(reactions));
        scales.displacement = scales.displacement.max(largest(&u.total));
        scales.deformation = scales.deformation.max(largest(u.deformation()));
        // Without loads, displacements within the round-off of the mesh count as zero.
        let round_off_of_mesh = f64::EPSILON * self.solver.structure.model.mesh.diagonal();
        if applied == 0.0 && self.solver.scales.displacement <= round_off_of_mesh {
            return Quality {
                componentwise_error: Some(0.0),
                round_off: Some(0.0),
                ..Quality::default()
            };
        }
        let mut out_of_balance = internal;
        for spring in &self.solver.structure.model.freedoms.springs {
            out_of_balance[spring.freedom] += spring.stiffness * u.total[spring.freedom];
        }
        for (freedom, force) in external {
            out_of_balance[freedom] -= force;
        }
        let contact = &self.solver.structure.sub.partition.contact;
        let left_over: Vec<f64> = contact.iter().map(|&f| out_of_balance[f]).collect();
        let rows = &self.solver.structure.model.rows;
        let force = &self.solver.now.force;
        rows.add_forces(force, |i, force| out_of_balance[contact[i]] -= force);

        // A body that moves as a rigid one under prescribed displacements alone has no forces with
        // which round-off could be compared.
        let round_off = ROUND_OFF_OF_FORCES * self.terms_of_run(u);
        let is_unstressed = self.solver.scales.force <= round_off && applied == 0.0;
        let out_of_balance = largest(&out_of_balance);
        let mut quality = Quality {
            backward_error: self.backward_error(u),
            componentwise_error: Some(u.componentwise_error),
            round_off: Some(self.share_of_forces(round_off)),
            equilibrium: match is_unstressed {
                true => ratio(out_of_balance, u.terms),
                false => self.share_of_forces(out_of_balance),
            },
            ..Quality::default()
        };
        let delta = self.solver.structure.delta(&self.solver.at);
        let gap_scale = delta
            .iter()
            .fold(self.solver.scales.displacement, |m, d| m.max(d.abs()));
        for (k, delta) in delta.iter().enumerate() {
            let gap = delta - rows.slip(k, |i| u.total[contact[i]]);
            quality.penetration = quality
                .penetration
                .max(ratio(-gap, self.solver.scales.displacement));
            for force in rows.own(k).map(|(i, b)| -left_over[i] / b) {
                let (tension, size) = (-force, force.abs());
                quality.adhesion = quality.adhesion.max(self.share_of_forces(tension));
                let product = ratio(gap.abs(), gap_scale) * self.share_of_forces(size);
                quality.complementarity = quality.complementarity.max(product);
            }
        }
        quality
    }

    /// Largest `|K| |u|` of the current state. If plastic strains remain, the value is scaled to
    /// the largest deformation of the run: the plastic strains were balanced to the round-off of
    /// displacements that may have vanished since.
    fn terms_of_run(&self, u: &Displacements) -> f64 {
        let here = largest(u.deformation());
        if here > 0.0 && self.solver.now.initial.load.largest() > 0.0 {
            u.terms * (self.solver.scales.deformation / here).max(1.0)
        } else {
            u.terms
        }
    }

    /// A force divided by the largest force of the run.
    fn share_of_forces(&self, force: f64) -> f64 {
        ratio(force, self.solver.scales.force)
    }

    /// The applied forces, with the freedoms on which they act.
    fn external_forces(&self) -> Vec<(usize, f64)> {
        let loads = self.solver.structure.model.loads.iter();
        let loads = loads.zip(&self.solver.at.factors);
        let mut forces: Vec<(usize, f64)> = loads
            .flat_map(|(load, &factor)| load.forces.iter().map(move |&(f, v)| (f, factor * v)))
            .collect();
        forces.sort_by_key(|&(freedom, _)| freedom);
        forces.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        forces
    }

    /// Returns `|f - K u| / (|K| |u| + |f|)` in infinity norms, with `u` and `f` the largest
    /// deformation and force of the run.
    fn backward_error(&self, u: &Displacements) -> f64 {
        let scale = self.solver.structure.system.norm * self.solver.scales.deformation
            + u.load.max(self.solver.scales.force);
        ratio(u.residual, scale)
    }
}

fn ratio(value: f64, scale: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / scale }
}
