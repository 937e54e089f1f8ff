//! Patches of contact of a solid model.

use super::border::{SizePrefixed, give, guarded, shared};
use super::results::brinell_results;
use crate::error::Error;

/// A contact patch of a solid. If the patch reaches planes of symmetry, the figures are those of
/// the whole patch, mirror images included.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_patch {
    /// sizeof(brinell_patch).
    pub size: usize,
    /// Number of the contact in the scene, from 0.
    pub contact: u64,
    /// Area, projected on the plane perpendicular to the mean normal; for a patch that closes round
    /// a body the area of its surface.
    pub area: f64,
    /// Centroid of the area.
    pub centroid: [f64; 3],
    /// Half axes, the larger first, of the ellipse with the same moments of area.
    pub semi_axes: [f64; 2],
    /// Direction of the larger half axis.
    pub direction: [f64; 3],
    /// Largest pressure.
    pub max_pressure: f64,
    /// Force over area.
    pub mean_pressure: f64,
    /// Force that the patch carries.
    pub force: f64,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl SizePrefixed for brinell_patch {
    const NAME: &'static str = "brinell_patch";
}

/// Number of contact patches of a solid in state `index`; 0 if there is no such state.
///
/// # Safety
/// `results` is NULL or a living handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_n_patches(
    results: *const brinell_results,
    index: usize,
) -> usize {
    // SAFETY: as vouched for by the caller.
    let state = unsafe { results.as_ref() }.and_then(|r| r.results.states.get(index));
    state.map_or(0, |state| state.patches.len())
}

/// A contact patch of state `index`; `index` and `patch` count from 0.
///
/// # Safety
/// `results` is a living handle; `out` is as long as its `size` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_patch(
    results: *const brinell_results,
    index: usize,
    patch: usize,
    out: *mut brinell_patch,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let state = shared(results, "the results")?.state(index)?;
            let found = state.patches.get(patch).ok_or_else(|| {
                Error::input(format!(
                    "there is no patch {patch}: state `{}` has {}",
                    state.name,
                    state.patches.len()
                ))
            })?;
            give(
                out,
                &brinell_patch {
                    size: 0,
                    contact: found.contact as u64,
                    area: found.area,
                    centroid: found.centroid,
                    semi_axes: found.semi_axes,
                    direction: found.direction,
                    max_pressure: found.max_pressure,
                    mean_pressure: found.mean_pressure,
                    force: found.force,
                },
            )
        }
    })
}
