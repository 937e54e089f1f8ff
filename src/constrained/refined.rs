//! Displacements of a badly conditioned structure to the last digits.

use super::ConstrainedStructure;
use crate::error::Result;
use crate::linalg::{self, Refinement};
use nalgebra::DVector;

impl ConstrainedStructure {
    /// As [`ConstrainedStructure::displacements`] with the residual in twice the working precision ([`linalg::refine`]): for a stiffness whose
    /// entries are exact and whose condition is bad. Right to the last digits for the gaps and forces at hand, where the plain solution
    /// is off by round-off times the condition. Returns what the refinement did. Costs a full solve for each step.
    ///
    /// # Errors
    /// As [`ConstrainedStructure::displacements`].
    pub fn refined_displacements(&self, out: &mut [f64]) -> Result<Refinement> {
        self.displacements(out)?;
        let contact = &self.partition.contact;
        let force = DVector::from_column_slice(&self.state.force);
        let gap = DVector::from_column_slice(&self.state.gap);
        let slip = &self.gaps - gap;
        let pushed = self.rows.tr_mul(&force);
        let mut load = self.state.load.clone();
        for (&freedom, force) in contact.iter().zip(pushed.iter()) {
            load[freedom] -= force;
        }
        // (K + B' S B) u = f - B' r + B' S (delta - g): definite also where K alone is not.
        let residual = |u: &[f64]| {
            let mut r = linalg::twofold_residual(&self.stiffness, &load, u);
            let here = DVector::from_iterator(contact.len(), contact.iter().map(|&c| u[c]));
            let missing = self.shift.component_mul(&(&slip - &self.rows * here));
            for (&freedom, force) in contact.iter().zip(self.rows.tr_mul(&missing).iter()) {
                r[freedom] += force;
            }
            r
        };
        linalg::refine(out, residual, |x| {
            linalg::solve_whole(&*self.condensed, &self.partition, Some(&self.held), x)
        })
    }
}
