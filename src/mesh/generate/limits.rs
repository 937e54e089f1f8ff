//! Limits of a generator's input: finite sizes of the right sign, and a mesh that fits in memory.

use crate::memory;
use crate::mesh::Shape;
use crate::number::{bytes, exact};
use crate::{Error, Result};

/// Largest number of elements that a generator makes.
pub(super) const MOST_ELEMENTS: f64 = 50e6;

/// Bound of sizes and coordinates: larger values overflow when multiplied together.
const LARGEST: f64 = 1e100;

/// Requires a size to be finite, positive, and neither so large that products of sizes overflow nor
/// so small that they underflow.
pub(super) fn positive(key: &str, value: f64) -> Result<()> {
    if value > 0.0 && (1.0 / LARGEST..=LARGEST).contains(&value) {
        return Ok(());
    }
    Err(Error::input(format!(
        "{key} = {}: give a positive number between {:e} and {LARGEST:e}",
        exact(value),
        1.0 / LARGEST
    )))
}

/// Requires a coordinate or an angle to be finite and within bounds.
pub(super) fn finite(key: &str, value: f64) -> Result<()> {
    if value.abs() <= LARGEST {
        return Ok(());
    }
    Err(Error::input(format!(
        "{key} = {}: give a number of at most {LARGEST:e}",
        exact(value)
    )))
}

/// Requires a range `[from, to]` to satisfy `from < to`.
pub(super) fn range(key: &str, [from, to]: [f64; 2]) -> Result<()> {
    finite(key, from)?;
    finite(key, to)?;
    if from < to {
        return Ok(());
    }
    Err(Error::input(format!(
        "{key} = [{}, {}]: the second number must be greater than the first",
        exact(from),
        exact(to)
    )))
}

/// Requires a number of elements to be at least `least`.
pub(super) fn at_least(key: &str, value: usize, least: usize) -> Result<()> {
    if value >= least {
        return Ok(());
    }
    Err(Error::input(format!(
        "{key} = {value}: give at least {least}"
    )))
}

/// Requires a growth ratio to lie between 1 and 100.
pub(super) fn growth(key: &str, value: f64) -> Result<()> {
    if (1.0..=100.0).contains(&value) {
        return Ok(());
    }
    Err(Error::input(format!(
        "{key} = {value}: give a ratio from 1 (even) to 100; 1.05 to 1.3 is usual"
    )))
}

/// Checks a growth ratio and the one at the far end. The far ratio must not be smaller; it may be
/// larger only if the near ratio is above 1.
pub(super) fn growths(key: &str, near: f64, far_key: &str, far: Option<f64>) -> Result<()> {
    growth(key, near)?;
    let Some(far) = far else { return Ok(()) };
    growth(far_key, far)?;
    if far == near || far > near && near > 1.0 {
        return Ok(());
    }
    Err(Error::input(format!(
        "{far_key} = {far}: the growth rises from {key} = {near} with the distance; give at least \
         that, and a growth above 1"
    )))
}

/// Number of elements into which `cells` quadrilateral cells are divided.
pub(super) fn elements(cells: f64, shape: Shape) -> f64 {
    if shape.n_corners() == 3 {
        2.0 * cells
    } else {
        cells
    }
}

/// Least memory in bytes per node of a solid mesh: the mesh and its matrix.
const BYTES_PER_NODE: f64 = 2000.0;

/// Least memory in bytes of the factor per node and per node along the shortest side of a body.
/// Nested dissection leaves `O(n m)` entries for a grid of n nodes with m along its shortest side;
/// for boxes with 1e5 to 1e6 freedoms these take 670 to 780 bytes (`hex8`), 950 (`hex20`).
const BYTES_OF_FACTOR: f64 = 500.0;

/// Refuses bodies of hexahedral cells that memory cannot hold, before anything is allocated;
/// `bodies` holds the numbers of cells along each axis.
pub(in crate::mesh) fn solids(key: &str, bodies: &[[f64; 3]], shape: Shape) -> Result<()> {
    let elements = bodies
        .iter()
        .map(|cells| cells.iter().product::<f64>())
        .sum();
    total(key, elements)?;
    let per_cell: f64 = if shape.is_quadratic() { 4.0 } else { 1.0 };
    let least = |cells: &[f64; 3]| {
        let nodes = per_cell * cells.iter().product::<f64>();
        let shortest = per_cell.cbrt() * cells.iter().copied().fold(f64::INFINITY, f64::min);
        let of_factor = BYTES_OF_FACTOR * shortest / memory::shared_by() as f64;
        nodes * BYTES_PER_NODE.max(of_factor)
    };
    let needed: f64 = bodies.iter().map(least).sum();
    match memory::available() {
        Some(there) if needed > there => Err(Error::input(format!(
            "{key}: the mesh would have {elements:.3e} elements and take more than {} of \
             memory; {} are free: ask for fewer or larger elements",
            bytes(needed),
            bytes(there)
        ))),
        _ => Ok(()),
    }
}

/// Refuses a mesh with too many elements, before anything is allocated.
pub(super) fn total(key: &str, elements: f64) -> Result<()> {
    if elements <= MOST_ELEMENTS {
        return Ok(());
    }
    Err(Error::input(format!(
        "{key}: the mesh would have {elements:.3e} elements, more than {MOST_ELEMENTS:.0e}; \
         ask for fewer or larger elements"
    )))
}
