//! Checks whether a structure is held by its own stiffness or with its contact rows closed.

use crate::contact::Unbounded;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::{self, Backend, Condensed, NotDefinite, Partition, SymmetricCsc};

/// Condenses the stiffness. If the matrix alone is not definite, its own diagonal is added on the
/// contact freedoms first and subtracted again after condensation.
pub(super) fn condense(
    backend: Backend,
    stiffness: &SymmetricCsc,
    partition: &Partition,
) -> Result<Box<dyn Condensed>> {
    let freedom = |error: &Error| {
        let cause = std::error::Error::source(error)?;
        Some(cause.downcast_ref::<NotDefinite>()?.freedom)
    };
    match linalg::condense(backend, stiffness, partition, &[]) {
        Err(error) if freedom(&error).is_some() && !partition.contact.is_empty() => {}
        Err(error) => return Err(named(error, freedom)),
        done => return done,
    }
    let largest = stiffness.data().iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let diagonal = |&f: &usize| stiffness.get(f, f).copied().unwrap_or(0.0);
    let shift: Vec<f64> = partition
        .contact
        .iter()
        .map(diagonal)
        .map(|d| if d > 0.0 { d } else { largest })
        .collect();
    linalg::condense(backend, stiffness, partition, &shift).map_err(|e| named(e, freedom))
}

fn named(error: Error, freedom: impl Fn(&Error) -> Option<usize>) -> Error {
    match freedom(&error) {
        Some(freedom) => Error::new(
            ErrorKind::Unheld,
            format!(
                "the stiffness is not positive definite at freedom {freedom}: a part of the \
                 structure is not held"
            ),
        )
        .because(error),
        None => error,
    }
}

/// Error of a contact problem in which the load pushes a part away from every contact.
pub(super) fn pushed_away(cause: Unbounded) -> Error {
    Error::new(
        ErrorKind::Unheld,
        format!(
            "the load pushes a part of the structure away from every contact: nothing stops row {} \
             from opening",
            cause.pair
        ),
    )
}
