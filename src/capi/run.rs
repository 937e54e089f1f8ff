//! Running a scene.

use super::border::{BRINELL_OK, SizePrefixed, guarded, hand_out, note, shared};
use super::options::{backend, brinell_options};
use super::results::brinell_results;
use super::scene::brinell_scene;
use crate::accuracy::{self, Extent};
use crate::analysis::Analysis;
use crate::error::Result;
use crate::linalg::Backend;
use crate::model::Model;
use crate::output::{self, RunHeader};
use crate::panics::outside;
use crate::progress::{Flow, Observer};
use crate::reference;
use crate::results::{HistoryRow, Results};
use crate::scene::Scene;
use std::ffi::{CString, c_char, c_void};
use std::time::Instant;

/// An accepted increment.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_increment {
    /// sizeof(brinell_increment) of the library.
    pub size: usize,
    /// Number, from 1.
    pub number: u64,
    /// Load factor at the end of the increment, in the program's unit.
    pub alpha: f64,
    /// Total load at the end of the increment.
    pub load: f64,
    /// Largest contact pressure.
    pub max_pressure: f64,
    /// Contact half width.
    pub half_width: f64,
    /// Sum of the contact forces.
    pub contact_force: f64,
    /// Number of closed pairs.
    pub closed_pairs: u64,
    /// Number of Gauss points with plastic strain.
    pub plastic_points: u64,
    /// Largest equivalent plastic strain.
    pub max_equivalent_plastic_strain: f64,
    /// Share of the load program that has been run.
    pub fraction: f64,
    /// Event that ended the increment, such as "closes: pair 12". Valid during the call only.
    pub event: *const c_char,
}

// SAFETY: repr(C), begins with its size, numbers and a pointer.
unsafe impl SizePrefixed for brinell_increment {
    const NAME: &'static str = "brinell_increment";
}

/// Called in the calling thread after each accepted increment; anything but 0 stops the run there.
pub type brinell_callback =
    Option<unsafe extern "C" fn(increment: *const brinell_increment, user: *mut c_void) -> i32>;

/// Passes increments on to a callback.
struct Caller {
    callback: brinell_callback,
    user: *mut c_void,
}

// SAFETY: an analysis calls its observer in the thread that runs it, which is the one that gave the
// pointer.
unsafe impl Send for Caller {}

impl Observer for Caller {
    fn increment(&mut self, row: &HistoryRow, fraction: f64) -> Flow {
        let Some(callback) = self.callback else {
            return Flow::Continue;
        };
        let event = CString::new(row.event.replace('\0', " ")).unwrap_or_default();
        let increment = brinell_increment {
            size: size_of::<brinell_increment>(),
            number: row.increment as u64,
            alpha: row.alpha,
            load: row.load,
            max_pressure: row.max_pressure,
            half_width: row.half_width,
            contact_force: row.contact_force,
            closed_pairs: row.closed_pairs as u64,
            plastic_points: row.plastic_points as u64,
            max_equivalent_plastic_strain: row.max_equivalent_plastic_strain,
            fraction,
            event: event.as_ptr(),
        };
        // SAFETY: the callback and its pointer are the caller's; the structure lives during the
        // call.
        match outside(|| unsafe { callback(&raw const increment, self.user) }) {
            0 => Flow::Continue,
            _ => Flow::Stop,
        }
    }
}

/// Runs a scene's load program. `callback` (NULL for none) is called after each increment with
/// `user`.
///
/// A run that ends early after increments were accepted returns the status of the reason, such as
/// BRINELL_STOPPED, BRINELL_COLLAPSE, BRINELL_OUTGROWN or BRINELL_ANALYSIS, *and* the results
/// computed up to then. A complete run returns BRINELL_INACCURATE and results if the quality of a
/// state misses its tolerance, if the accuracy that the scene demands is not reached, or for
/// another reason that the message names. After any other failure `*out` is NULL.
///
/// A scene with the key `accuracy` is run on finer and finer meshes until the stated errors are
/// within the demand. The callback receives the increments of each run, counted anew from 1. The
/// results are those of the last mesh; `accuracy` in the summary lists the stated error of each
/// figure, and the reason if the demand was not reached.
///
/// # Safety
/// `scene` is a living scene, `options` is NULL or as long as its `size` says, `out` may be written
/// to; `callback` does not unwind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_run(
    scene: *const brinell_scene,
    options: *const brinell_options,
    callback: brinell_callback,
    user: *mut c_void,
    out: *mut *mut brinell_results,
) -> i32 {
    // SAFETY: as vouched for by the caller.
    unsafe {
        execute(
            || {
                let scene = shared(scene, "the scene")?.scene.clone();
                Ok(RunTask::Scene(Box::new(scene)))
            },
            options,
            callback,
            user,
            out,
        )
    }
}

/// A scene or a model that is to be run.
pub(super) enum RunTask {
    /// A scene, which is run to the accuracy that it demands, if any.
    Scene(Box<Scene>),
    /// A model, which is run on its mesh.
    Model(Box<Model>),
}

/// Runs a load program.
///
/// # Safety
/// The conditions of [`brinell_run`].
pub(super) unsafe fn execute(
    task: impl FnOnce() -> Result<RunTask>,
    options: *const brinell_options,
    callback: brinell_callback,
    user: *mut c_void,
    out: *mut *mut brinell_results,
) -> i32 {
    let mut ended = BRINELL_OK;
    let done = guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            *super::border::exclusive(out, "the place for the results")? = std::ptr::null_mut();
            let backend = backend(options)?;
            let start = Instant::now();
            let caller = &mut Caller { callback, user };
            let (analysis, results) = match task()? {
                RunTask::Scene(scene) if scene.accuracy.is_some() => {
                    let found = accuracy::reach(&scene, backend, Extent::Program, None, caller)?;
                    (found.analysis, found.results)
                }
                RunTask::Scene(scene) => as_it_stands(Model::new(&scene)?, backend, caller)?,
                RunTask::Model(model) => as_it_stands(*model, backend, caller)?,
            };
            let model = analysis.model();
            let header = RunHeader::new(model, backend, start.elapsed().as_secs_f64());
            if let Err(short) = output::ending(&results) {
                ended = note(&short);
            }
            hand_out(out, brinell_results::new(results, model.clone(), header))
        }
    });
    if done == BRINELL_OK { ended } else { done }
}

fn as_it_stands(
    model: Model,
    backend: Backend,
    observer: &mut dyn Observer,
) -> Result<(Analysis, Results)> {
    let mut analysis = Analysis::new(model, backend)?;
    let mut results = analysis.run(observer)?;
    reference::compare(analysis.model(), &mut results);
    Ok((analysis, results))
}
