//! Checks that the parameters of a closed form lie in its range of validity.

use crate::error::{Error, Result};

/// Returns `value` if it is finite and greater than zero.
pub(super) fn positive(what: &str, name: &str, value: f64) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(Error::input(format!(
        "{what}: {name} = {value} must be finite and greater than 0"
    )))
}

/// Returns `value` if it is finite.
pub(super) fn finite(what: &str, name: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Error::input(format!(
        "{what}: {name} = {value} must be finite"
    )))
}

/// Returns `value` if it is a Poisson's ratio of a stable isotropic material, -1 < nu <= 1/2.
pub(super) fn poisson(what: &str, value: f64) -> Result<f64> {
    if value > -1.0 && value <= 0.5 {
        return Ok(value);
    }
    Err(Error::input(format!(
        "{what}: Poisson's ratio {value} must lie in (-1, 0.5]"
    )))
}

/// Returns `value` if it lies in `[low, high]`.
pub(super) fn between(what: &str, name: &str, value: f64, low: f64, high: f64) -> Result<f64> {
    if value >= low && value <= high {
        return Ok(value);
    }
    Err(Error::input(format!(
        "{what}: {name} = {value} must lie in [{low}, {high}]"
    )))
}

/// Fails unless `inner < outer`, both positive and finite.
pub(super) fn nested_radii(what: &str, inner: f64, outer: f64) -> Result<()> {
    positive(what, "inner radius", inner)?;
    positive(what, "outer radius", outer)?;
    if inner < outer {
        return Ok(());
    }
    Err(Error::input(format!(
        "{what}: the inner radius {inner} must be less than the outer radius {outer}"
    )))
}
