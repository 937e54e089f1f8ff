//! A wall under internal pressure that is plastic up to a front: the part common to cylinder and
//! sphere.

use crate::error::{Error, ErrorKind, Result};
use crate::root;

/// Radius of the plastic front of `body` under `pressure`, in the wall `[a, b]` (radii); the inner
/// radius as long as the wall is elastic. `of_front(c)` is the pressure that holds the front at
/// `c`, rising from first yield at `a` to collapse at `b`.
///
/// # Errors
/// [`ErrorKind::Input`] if the pressure is negative or not a number, [`ErrorKind::Collapse`] if it
/// exceeds the collapse pressure.
pub(super) fn plastic_front(
    body: &str,
    pressure: f64,
    [a, b]: [f64; 2],
    of_front: impl Fn(f64) -> f64,
) -> Result<f64> {
    let collapse = of_front(b);
    if pressure > collapse {
        return Err(Error::new(
            ErrorKind::Collapse,
            format!("{body}: pressure {pressure} exceeds the collapse pressure {collapse}"),
        ));
    }
    if pressure.is_nan() || pressure < 0.0 {
        return Err(Error::input(format!(
            "{body}: pressure {pressure} must not be negative"
        )));
    }
    if pressure <= of_front(a) {
        return Ok(a);
    }
    Ok(root::of(|front| of_front(front) - pressure, a, b))
}

/// Refuses a pressure above twice the pressure at first yield, because the bore then yields again
/// in unloading.
///
/// # Errors
/// [`ErrorKind::Input`] for such a pressure.
pub(super) fn refuse_reverse_yield(body: &str, pressure: f64, first_yield: f64) -> Result<()> {
    let limit = 2.0 * first_yield;
    if pressure > limit {
        return Err(Error::input(format!(
            "{body}: after the pressure {pressure} unloading yields again; the closed form ends at \
             {limit}"
        )));
    }
    Ok(())
}
