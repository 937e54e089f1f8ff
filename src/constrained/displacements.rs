//! Displacements of the current state, accurate to the last digits even for a badly conditioned
//! structure.

use super::{ConstrainedStructure, sizes};
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::{self, Refinement, Symmetric};
use nalgebra::{Cholesky, DMatrix, DVector};
use std::sync::Arc;

impl ConstrainedStructure {
    /// Computes the displacements of all freedoms (`n`) in the current state. Returns
    /// `|K u - f + B' r| / (|K| |u| + |f|)`. Costs one full solve.
    ///
    /// # Errors
    /// [`ErrorKind::Input`] if `out` has the wrong length; failure of the backend's solve.
    pub fn displacements(&self, out: &mut [f64]) -> Result<f64> {
        if out.len() != self.partition.n {
            return Err(Error::input(format!(
                "{} values were given for the displacements of {} freedoms",
                out.len(),
                self.partition.n
            )));
        }
        let load = self.load_with_contact();
        let mut contact = self.state.condensed.clone_owned();
        let mut forces = vec![0.0; self.n_rows()];
        self.tied.eliminate(contact.as_mut_slice(), &mut forces);
        let gap = DVector::from_column_slice(self.gaps());
        let slip = &self.gaps - gap;
        self.tied.recover(contact.as_mut_slice(), slip.as_slice());
        let reduced = self.condensed.reduce_load(&self.state.load)?;
        let found = linalg::recover_refined(
            self.condensed.as_ref(),
            &Symmetric::Whole(Arc::clone(&self.stiffness)),
            self.norm,
            &load,
            [&reduced, &[], contact.as_slice()],
            &self.partition,
            [0.0; 2],
        )?;
        out.copy_from_slice(&found.u);
        Ok(found.backward_error)
    }

    /// Load on all freedoms with the contact forces, `f - B' r`.
    fn load_with_contact(&self) -> Vec<f64> {
        let pushed = self.rows.tr_mul(&DVector::from_column_slice(self.forces()));
        let mut load = self.state.load.clone();
        for (&freedom, force) in self.partition.contact.iter().zip(pushed.iter()) {
            load[freedom] -= force;
        }
        load
    }

    /// Computes displacements like [`ConstrainedStructure::displacements`], with the residual in
    /// twice the working precision ([`linalg::refine`]): for a badly conditioned stiffness whose
    /// entries are exact. The result is right to the last digits for the current gaps and forces,
    /// whereas the plain solution is off by round-off times the condition. Returns the record of
    /// the refinement. Costs a full solve for each step and a factor of the condensed stiffness.
    ///
    /// # Errors
    /// Errors of [`ConstrainedStructure::displacements`]; [`ErrorKind::Unheld`] if the closed rows
    /// do not hold the structure.
    pub fn refined_displacements(&self, out: &mut [f64]) -> Result<Refinement> {
        self.displacements(out)?;
        let contact = &self.partition.contact;
        let load = self.load_with_contact();
        // (K + B' S B) u = f - B' r + B' S delta with the closed rows, whose gap is exactly zero:
        // the matrix is definite even if K alone is not.
        let open = self.tableau.open();
        let sizes = sizes(&self.condensed_stiffness, &self.rows);
        let spring = DVector::from_fn(open.len(), |i, _| if open[i] { 0.0 } else { sizes[i] });
        let mut stiffness = DMatrix::clone(&self.condensed_stiffness);
        for i in (0..open.len()).filter(|&i| !open[i]) {
            let row = self.rows.row(i);
            stiffness += row.transpose() * row * spring[i];
        }
        let held = Cholesky::new(stiffness).ok_or_else(|| {
            Error::new(
                ErrorKind::Unheld,
                "the closed contact rows do not hold the structure: its displacements are not \
                 unique",
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
