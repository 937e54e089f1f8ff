//! Solves with the whole matrix by means of its condensed structure.

use super::{Condensed, Partition};
use crate::error::Result;
use nalgebra::{Cholesky, DVector, Dyn};

/// Solves `(K + D) u = x` in place. `D` is the stiffness of anything that acts on the contact
/// freedoms in addition to `K`. `held` is the Cholesky factor of `C + D`, where `C` is the contact
/// stiffness; `None` if there are no contact freedoms. `partition` holds the zone that is chosen at
/// present. Costs a full solve.
///
/// # Errors
/// Errors of [`Condensed::recover_all`].
pub fn solve_whole(
    condensed: &dyn Condensed,
    partition: &Partition,
    held: Option<&Cholesky<f64, Dyn>>,
    x: &mut [f64],
) -> Result<()> {
    let reduced = condensed.reduce_load(x)?;
    let mut zone = vec![0.0; partition.zone.len()];
    let mut contact = DVector::zeros(partition.contact.len());
    condensed.condense_load(&reduced, &mut zone, contact.as_mut_slice())?;
    condensed.eliminate_zone(&mut zone, contact.as_mut_slice());
    if let Some(held) = held {
        held.solve_mut(&mut contact);
    }
    condensed.recover_zone(&mut zone, contact.as_slice());
    let u = condensed.recover_all(&reduced, &zone, contact.as_slice())?;
    x.copy_from_slice(&u);
    Ok(())
}
