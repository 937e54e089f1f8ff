//! Results as arrays.

use super::border::{SizePrefixed, exclusive, free, give, guarded, shared, text};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::output::{self, RunHeader};
use crate::results::{HistoryRow, PairState, Results, State, Status};
use std::ffi::{CString, c_char};
use std::path::Path;

/// What a run computed.
pub struct brinell_results {
    pub(super) results: Results,
    model: Model,
    header: RunHeader,
    /// Name of each state.
    names: Vec<CString>,
    /// For each state the values of the pairs, one array for each of BRINELL_PAIR_...
    pairs: Vec<[Vec<f64>; 8]>,
    /// Columns of the history, one array for each of BRINELL_HISTORY_...
    history: [Vec<f64>; 7],
}

/// Undeformed x (r) of the pair, on the second surface.
pub const BRINELL_PAIR_X: i32 = 0;
/// Undeformed y (z).
pub const BRINELL_PAIR_Y: i32 = 1;
/// Gap of the pair, >= 0.
pub const BRINELL_PAIR_GAP: i32 = 2;
/// Force, compressive positive.
pub const BRINELL_PAIR_FORCE: i32 = 3;
/// Area that belongs to the pair.
pub const BRINELL_PAIR_AREA: i32 = 4;
/// Pressure, compressive positive.
pub const BRINELL_PAIR_PRESSURE: i32 = 5;
/// 1 if the pair is closed, 0 if it is open.
pub const BRINELL_PAIR_CLOSED: i32 = 6;
/// Undeformed z of the pair in a solid.
pub const BRINELL_PAIR_Z: i32 = 7;

/// Displacements, n_nodes x 2 components (n_nodes x 3 in a solid), node by node.
pub const BRINELL_FIELD_DISPLACEMENT: i32 = 0;
/// Mean stresses of the elements, n_elements x 4 components: xx, yy, zz, xy (axisymmetric rr, zz,
/// tt, rz). In a solid n_elements x 6: xx, yy, zz, xy, yz, zx.
pub const BRINELL_FIELD_STRESS: i32 = 1;
/// n_elements von Mises stresses.
pub const BRINELL_FIELD_VON_MISES: i32 = 2;
/// n_elements equivalent plastic strains.
pub const BRINELL_FIELD_PLASTIC_STRAIN: i32 = 3;

/// Load factor at the end of each increment.
pub const BRINELL_HISTORY_ALPHA: i32 = 0;
/// Total load at the end of each increment.
pub const BRINELL_HISTORY_LOAD: i32 = 1;
/// Largest contact pressure.
pub const BRINELL_HISTORY_MAX_PRESSURE: i32 = 2;
/// Contact half width.
pub const BRINELL_HISTORY_HALF_WIDTH: i32 = 3;
/// Sum of the contact forces.
pub const BRINELL_HISTORY_CONTACT_FORCE: i32 = 4;
/// Largest equivalent plastic strain.
pub const BRINELL_HISTORY_PLASTIC_STRAIN: i32 = 5;
/// Relative out-of-balance force.
pub const BRINELL_HISTORY_RESIDUAL: i32 = 6;

/// First yield. Numbers that are not known are NaN.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_yield {
    /// sizeof(brinell_yield).
    pub size: usize,
    /// Factor on the scene's proportional loads.
    pub alpha: f64,
    /// Total load at first yield.
    pub load: f64,
    /// Largest contact pressure.
    pub max_pressure: f64,
    /// Contact half width.
    pub half_width: f64,
    /// Coordinate x (r) of the point that yields first.
    pub x: f64,
    /// Coordinate y (z) of the point that yields first.
    pub y: f64,
    /// Number of the body that yields, from 0.
    pub body: u64,
    /// Coordinate z of the point that yields first, in a solid.
    pub z: f64,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl SizePrefixed for brinell_yield {
    const NAME: &'static str = "brinell_yield";
}

/// The state at a target.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_state {
    /// sizeof(brinell_state).
    pub size: usize,
    /// Load factor in the program's unit.
    pub alpha: f64,
    /// Total load in this state.
    pub load: f64,
    /// Sum of the contact forces.
    pub contact_force: f64,
    /// Largest contact pressure.
    pub max_pressure: f64,
    /// Contact half width.
    pub half_width: f64,
    /// Depth of the residual dent.
    pub residual_depth: f64,
    /// Relative approach of the bodies; for a single load the mean displacement of the loaded
    /// surface along the load.
    pub approach: f64,
    /// Largest equivalent plastic strain.
    pub max_equivalent_plastic_strain: f64,
    /// Number of Gauss points with plastic strain.
    pub plastic_points: u64,
    /// Number of contact pairs.
    pub n_pairs: u64,
    /// 1 if the state has fields, otherwise 0.
    pub has_fields: i32,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl SizePrefixed for brinell_state {
    const NAME: &'static str = "brinell_state";
}

/// The mesh, not copied: the arrays are valid as long as the results.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_mesh {
    /// sizeof(brinell_mesh).
    pub size: usize,
    /// Number of nodes.
    pub n_nodes: usize,
    /// Number of elements.
    pub n_elements: usize,
    /// Coordinates, n_nodes x 2 (n_nodes x 3 in a solid), node by node.
    pub coordinates: *const f64,
    /// Nodes of all elements, one element after the other.
    pub connectivity: *const u32,
    /// n_elements + 1 starts of the elements' nodes in the connectivity.
    pub offsets: *const usize,
    /// Number of the body of each element, from 0; n_elements values.
    pub element_body: *const u32,
}

// SAFETY: repr(C), begins with its size, numbers and pointers.
unsafe impl SizePrefixed for brinell_mesh {
    const NAME: &'static str = "brinell_mesh";
}

impl brinell_results {
    pub(super) fn new(results: Results, model: Model, header: RunHeader) -> Self {
        let of_pair = |pair: &PairState, which: i32| match which {
            BRINELL_PAIR_X => pair.position[0],
            BRINELL_PAIR_Y => pair.position[1],
            BRINELL_PAIR_GAP => pair.gap,
            BRINELL_PAIR_FORCE => pair.force,
            BRINELL_PAIR_AREA => pair.area,
            BRINELL_PAIR_PRESSURE => pair.pressure,
            BRINELL_PAIR_Z => pair.position[2],
            _ => f64::from(u8::from(pair.status == Status::Closed)),
        };
        let of_row = |row: &HistoryRow, which: i32| match which {
            BRINELL_HISTORY_ALPHA => row.alpha,
            BRINELL_HISTORY_LOAD => row.load,
            BRINELL_HISTORY_MAX_PRESSURE => row.max_pressure,
            BRINELL_HISTORY_HALF_WIDTH => row.half_width,
            BRINELL_HISTORY_CONTACT_FORCE => row.contact_force,
            BRINELL_HISTORY_PLASTIC_STRAIN => row.max_equivalent_plastic_strain,
            _ => row.residual,
        };
        let pairs = |state: &State| {
            std::array::from_fn(|k| state.pairs.iter().map(|p| of_pair(p, k as i32)).collect())
        };
        let name = |state: &State| CString::new(state.name.replace('\0', " ")).unwrap_or_default();
        brinell_results {
            names: results.states.iter().map(name).collect(),
            pairs: results.states.iter().map(pairs).collect(),
            history: std::array::from_fn(|k| {
                results
                    .history
                    .iter()
                    .map(|r| of_row(r, k as i32))
                    .collect()
            }),
            results,
            model,
            header,
        }
    }

    pub(super) fn state(&self, index: usize) -> Result<&State> {
        self.results.states.get(index).ok_or_else(|| {
            Error::input(format!(
                "there is no state {index}: the run left {}",
                self.results.states.len()
            ))
        })
    }
}

/// Returns one of several arrays by its number.
fn chosen<'a>(arrays: &'a [Vec<f64>], which: i32, what: &str) -> Result<&'a [f64]> {
    usize::try_from(which)
        .ok()
        .and_then(|which| arrays.get(which))
        .map(Vec::as_slice)
        .ok_or_else(|| Error::input(format!("there is no {what} {which}")))
}

/// Gives the caller the address and length of an array.
///
/// # Safety
/// `data` and `n` may be written to.
pub(super) unsafe fn lend<T>(values: &[T], data: *mut *const T, n: *mut usize) -> Result<()> {
    // SAFETY: as vouched for by the caller.
    unsafe {
        *exclusive(data, "the place for the array")? = values.as_ptr();
        *exclusive(n, "the place for its length")? = values.len();
    }
    Ok(())
}

/// Frees results; arrays taken from them are no longer valid.
///
/// # Safety
/// `results` is NULL or was handed out by this library and not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_free(results: *mut brinell_results) {
    // SAFETY: as vouched for by the caller.
    unsafe { free(results) }
}

/// Number of states; 0 for NULL.
///
/// # Safety
/// `results` is NULL or a living handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_n_states(results: *const brinell_results) -> usize {
    // SAFETY: as vouched for by the caller.
    unsafe { results.as_ref() }.map_or(0, |r| r.results.states.len())
}

/// First yield. The status is BRINELL_INPUT if the run has no first yield.
///
/// # Safety
/// `results` is a living handle; `out` is as long as its `size` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_yield(
    results: *const brinell_results,
    out: *mut brinell_yield,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let point = shared(results, "the results")?.results.first_yield;
            let point = point.ok_or_else(|| Error::input("nothing yields in this run"))?;
            give(
                out,
                &brinell_yield {
                    size: 0,
                    alpha: point.alpha,
                    load: point.load,
                    max_pressure: point.max_pressure,
                    half_width: point.half_width,
                    x: point.location[0],
                    y: point.location[1],
                    z: point.location[2],
                    body: point.body as u64,
                },
            )
        }
    })
}

/// The main figures of state `index`, from 0; brinell_results_value gives every figure.
///
/// # Safety
/// `results` is a living handle; `out` is as long as its `size` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_state(
    results: *const brinell_results,
    index: usize,
    out: *mut brinell_state,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let state = shared(results, "the results")?.state(index)?;
            give(
                out,
                &brinell_state {
                    size: 0,
                    alpha: state.alpha,
                    load: state.load,
                    contact_force: state.contact_force,
                    max_pressure: state.max_pressure,
                    half_width: state.half_width,
                    residual_depth: state.residual_depth,
                    approach: state.approach,
                    max_equivalent_plastic_strain: state.max_equivalent_plastic_strain,
                    plastic_points: state.plastic_points as u64,
                    n_pairs: state.pairs.len() as u64,
                    has_fields: i32::from(state.fields.is_some()),
                },
            )
        }
    })
}

/// The name of state `index`; NULL if there is no such state. Valid as long as the results.
///
/// # Safety
/// `results` is NULL or a living handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_state_name(
    results: *const brinell_results,
    index: usize,
) -> *const c_char {
    // SAFETY: as vouched for by the caller.
    let name = unsafe { results.as_ref() }.and_then(|r| r.names.get(index));
    name.map_or(std::ptr::null(), |name| name.as_ptr())
}

/// An array of the contact pairs of state `index`: one of BRINELL_PAIR_... Valid as long as the
/// results.
///
/// # Safety
/// `results` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_pairs(
    results: *const brinell_results,
    index: usize,
    which: i32,
    data: *mut *const f64,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let results = shared(results, "the results")?;
            results.state(index)?;
            lend(
                chosen(&results.pairs[index], which, "array of pairs")?,
                data,
                n,
            )
        }
    })
}

/// A field of state `index`: one of BRINELL_FIELD_... Not copied: valid as long as the results.
///
/// # Safety
/// `results` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_field(
    results: *const brinell_results,
    index: usize,
    which: i32,
    data: *mut *const f64,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let state = shared(results, "the results")?.state(index)?;
            let fields = state.fields.as_ref().ok_or_else(|| {
                Error::input(format!(
                    "state `{}` has no fields (fields = false)",
                    state.name
                ))
            })?;
            let values = match which {
                BRINELL_FIELD_DISPLACEMENT => &fields.displacement,
                BRINELL_FIELD_STRESS => &fields.stress,
                BRINELL_FIELD_VON_MISES => &fields.von_mises,
                BRINELL_FIELD_PLASTIC_STRAIN => &fields.plastic_strain,
                other => return Err(Error::input(format!("there is no field {other}"))),
            };
            lend(values, data, n)
        }
    })
}

/// A column of the history, a value for each accepted increment: one of BRINELL_HISTORY_... Valid
/// as long as the results.
///
/// # Safety
/// `results` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_history(
    results: *const brinell_results,
    which: i32,
    data: *mut *const f64,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let results = shared(results, "the results")?;
            lend(
                chosen(&results.history, which, "column of the history")?,
                data,
                n,
            )
        }
    })
}

/// The mesh of the run.
///
/// # Safety
/// `results` is a living handle; `out` is as long as its `size` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_mesh(
    results: *const brinell_results,
    out: *mut brinell_mesh,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let mesh = &shared(results, "the results")?.model.mesh;
            give(
                out,
                &brinell_mesh {
                    size: 0,
                    n_nodes: mesh.n_nodes(),
                    n_elements: mesh.n_elements(),
                    coordinates: mesh.coordinates.as_ptr(),
                    connectivity: mesh.connectivity.as_ptr(),
                    offsets: mesh.offsets.as_ptr(),
                    element_body: mesh.element_body.as_ptr(),
                },
            )
        }
    })
}

/// Writes the result directory that the program writes: tables, fields, report.
///
/// # Safety
/// `results` is a living handle; `dir` is a text that ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_write(
    results: *const brinell_results,
    dir: *const c_char,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        let (r, dir) = unsafe { (shared(results, "the results")?, text(dir, "the directory")?) };
        output::write_with_report(Path::new(dir), &r.header, &r.model, &r.results)
    })
}
