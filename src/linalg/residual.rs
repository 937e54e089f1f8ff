//! Residual and backward error of a solution, and a step of iterative refinement.

use super::row_sums::largest;
use super::{Condensed, Partition, Symmetric};
use crate::error::Result;

/// Backward error above which a refinement step is tried: as many rounding errors as a row has
/// entries on average. A smaller residual may consist only of its own round-off, and a step
/// computed from it gains nothing.
pub(super) fn refine_above(matrix: &Symmetric) -> f64 {
    let (n, upper) = (matrix.n().max(1) as f64, matrix.n_entries() as f64);
    (2.0 * upper / n - 1.0).max(1.0) * f64::EPSILON
}

/// Solution of a full solve with its errors.
#[derive(Debug, Clone)]
pub struct Recovered {
    /// Displacements of all freedoms.
    pub u: Vec<f64>,
    /// Residual `|f - K u|` in the infinity norm.
    pub residual: f64,
    /// Backward error `|f - K u| / (|K| |u| + |f|)` in infinity norms; zero if the residual is
    /// zero, NaN if a value is NaN.
    pub backward_error: f64,
    /// Componentwise backward error ([`super::componentwise_backward_error`]), with the residual in
    /// working precision: the residual's own round-off, one rounding error for each entry of a row,
    /// counts as an error of the solution.
    pub componentwise_error: f64,
    /// Largest `|K| |u|` of a row, which scales the round-off of forces computed from `u`.
    pub terms: f64,
}

impl Recovered {
    fn new(matrix: &Symmetric, norm: f64, f: &[f64], u: Vec<f64>) -> Result<(Self, Vec<f64>)> {
        let rows = matrix.rows(f, &u)?;
        let residual = largest(&rows.residual);
        let backward_error = if residual == 0.0 {
            0.0
        } else {
            residual / (norm * largest(&u) + largest(f))
        };
        let found = Recovered {
            residual,
            backward_error,
            componentwise_error: rows.componentwise_error(f, &u),
            terms: largest(&rows.terms),
            u,
        };
        Ok((found, rows.residual))
    }
}

/// Recovers all freedoms ([`Condensed::recover_all`]) with the residual for the load `f` on all
/// freedoms (contact forces included). A step of iterative refinement of interior and zone follows
/// if it lowers the residual. `norm` is the infinity norm of `matrix` ([`super::norm`]). `beside`
/// gives the size of a displacement and of a load, for instance the largest values of related
/// solutions, or zeros. If these are larger than the values of this solution, the residual need
/// only be small compared with them.
///
/// # Errors
/// Errors of [`Condensed::recover_all`].
pub fn recover_refined(
    condensed: &dyn Condensed,
    matrix: &Symmetric,
    norm: f64,
    f: &[f64],
    [reduced, zone, contact]: [&[f64]; 3],
    partition: &Partition,
    beside: [f64; 2],
) -> Result<Recovered> {
    let u = condensed.recover_all(reduced, zone, contact)?;
    let (found, mut r) = Recovered::new(matrix, norm, f, u)?;
    let scale = norm * largest(&found.u).max(beside[0]) + largest(f).max(beside[1]);
    // A NaN is not refined.
    if found.backward_error.is_nan() || found.residual <= refine_above(matrix) * scale {
        return Ok(found);
    }
    // The contact displacements are given, so the step does not change them.
    for &freedom in &partition.contact {
        r[freedom] = 0.0;
    }
    let reduced = condensed.reduce_load(&r)?;
    let (mut step_zone, mut step_contact) = (vec![0.0; zone.len()], vec![0.0; contact.len()]);
    condensed.condense_load(&reduced, &mut step_zone, &mut step_contact)?;
    condensed.eliminate_zone(&mut step_zone, &mut step_contact);
    step_contact.fill(0.0);
    condensed.recover_zone(&mut step_zone, &step_contact);
    let mut refined = condensed.recover_all(&reduced, &step_zone, &step_contact)?;
    for (u, old) in refined.iter_mut().zip(&found.u) {
        *u += old;
    }
    let (refined, _) = Recovered::new(matrix, norm, f, refined)?;
    Ok(if refined.backward_error < found.backward_error {
        refined
    } else {
        found
    })
}
