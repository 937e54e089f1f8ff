//! Displacements of a badly conditioned structure to the last digits.

use super::ConstrainedStructure;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::{self, Refinement};
use nalgebra::{Cholesky, DVector};

impl ConstrainedStructure {
    /// As [`ConstrainedStructure::displacements`] with the residual in twice the working precision ([`linalg::refine`]): for a stiffness whose
    /// entries are exact and whose condition is bad. Right to the last digits for the gaps and forces at hand, where the plain solution
    /// is off by round-off times the condition. Returns what the refinement did. Costs a full solve for each step and a factor of the
    /// condensed stiffness.
    ///
    /// # Errors
    /// As [`ConstrainedStructure::displacements`]; [`ErrorKind::Unheld`] where the closed rows do not hold the structure.
    pub fn refined_displacements(&self, out: &mut [f64]) -> Result<Refinement> {
        self.displacements(out)?;
        let contact = &self.partition.contact;
        let force = DVector::from_column_slice(self.forces());
        let pushed = self.rows.tr_mul(&force);
        let mut load = self.state.load.clone();
        for (&freedom, force) in contact.iter().zip(pushed.iter()) {
            load[freedom] -= force;
        }
        // (K + B' S B) u = f - B' r + B' S delta with the closed rows, whose gap is zero without round-off: definite also where K alone is not.
        let open = self.tableau.open();
        let spring = DVector::from_fn(open.len(), |i, _| if open[i] { 0.0 } else { self.shift[i] });
        let mut stiffness = self.condensed.contact_stiffness().clone();
        for i in (0..open.len()).filter(|&i| !open[i]) {
            let row = self.rows.row(i);
            stiffness += row.transpose() * row * spring[i];
        }
        let held = Cholesky::new(stiffness).ok_or_else(|| {
            Error::new(
                ErrorKind::Unheld,
                "the closed contact rows do not hold the structure: its displacements are not unique",
            )
        })?;
        let residual = |u: &[f64]| {
            let mut r = linalg::twofold_residual(&self.stiffness, &load, u);
            let here = DVector::from_iterator(contact.len(), contact.iter().map(|&c| u[c]));
            let missing = spring.component_mul(&(&self.gaps - &self.rows * here));
            for (&freedom, force) in contact.iter().zip(self.rows.tr_mul(&missing).iter()) {
                r[freedom] += force;
            }
            r
        };
        let held = (!contact.is_empty()).then_some(&held);
        linalg::refine(out, residual, |x| {
            linalg::solve_whole(&*self.condensed, &self.partition, held, x)
        })
    }
}
