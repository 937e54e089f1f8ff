//! Displacements of a badly conditioned structure to the last digits.

use super::ConstrainedStructure;
use crate::error::{Error, Result};
use crate::linalg::{self, SymmetricCsc};
use nalgebra::DVector;

impl ConstrainedStructure {
    /// As [`ConstrainedStructure::displacements`] with the residual in twice the working precision ([`linalg::refine`]), for a stiffness that is exact and badly
    /// conditioned: right to the last digits for the contact forces at hand, where the plain solution is off by round-off times the
    /// condition. `stiffness` is the matrix that the structure was made of. Returns what the refinement did.
    ///
    /// # Errors
    /// As [`ConstrainedStructure::displacements`]; [`crate::ErrorKind::Input`] where the matrix has another size.
    pub fn refined_displacements(
        &self,
        stiffness: &SymmetricCsc,
        out: &mut [f64],
    ) -> Result<linalg::Refinement> {
        if stiffness.cols() != self.n {
            return Err(Error::input(format!(
                "a stiffness with {} freedoms was given for a structure with {}",
                stiffness.cols(),
                self.n
            )));
        }
        self.displacements(out)?;
        let force = DVector::from_column_slice(&self.state.force);
        let pushed = self.rows.tr_mul(&force);
        let mut load = self.state.load.clone();
        for (&freedom, force) in self.contact.iter().zip(pushed.iter()) {
            load[freedom] -= force;
        }
        let contact: Vec<f64> = self.contact.iter().map(|&freedom| out[freedom]).collect();
        linalg::refine(
            &*self.condensed,
            stiffness,
            &self.contact,
            &load,
            &contact,
            out,
        )
    }
}
