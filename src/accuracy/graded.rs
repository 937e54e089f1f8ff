//! Meshes of a plane scene refined around a contact that the scene's own mesh does not resolve.
//!
//! At first yield a contact may be smaller than one element by any factor: under a ball the load at
//! first yield goes with the cube of the yield stress. If all elements are made smaller, the cost
//! of resolving the contact grows with the square of this factor; if only the elements around it
//! are ([`LocalRefinement`]), the cost grows with its logarithm.

use super::companions::READABLE;
use super::meter::work;
use super::runs::{Extent, Quiet, analyse};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{EdgeReading, Results, State};
use crate::scene::{LocalRefinement, Scene};

/// Distance from the middle of a contact, in half widths, within which elements are smallest, as in
/// the meshes that are generated around a contact.
const REACH: f64 = 2.0;
/// Factor by which a refinement that adds no pairs to a contact must narrow the contact. A
/// refinement that misses the contact does neither.
const NARROWER: f64 = 0.9;

/// A contact at first yield or in a state, with the number of closed pairs on a side of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ContactSpot {
    /// Name of the state; `None` for first yield.
    state: Option<String>,
    at: [f64; 2],
    half_width: f64,
    pairs: usize,
}

impl ContactSpot {
    /// Finds the contact in the state of this name, or at first yield. `None` if the contact does
    /// not end in an edge of pressures.
    fn of(results: &Results, state: Option<&str>) -> Option<Self> {
        let (at, half_width, reading) = match state {
            None => {
                let first = results.first_yield.as_ref()?;
                (first.location, first.half_width, first.half_width_reading)
            }
            Some(name) => {
                let state = results.states.iter().find(|state| state.name == name)?;
                (
                    most_pressed(state)?,
                    state.half_width,
                    state.half_width_reading,
                )
            }
        };
        let is_read = reading.is_of_pressures(half_width);
        is_read.then(|| ContactSpot {
            state: state.map(str::to_string),
            at: [at[0], at[1]],
            half_width,
            pairs: reading.pairs,
        })
    }

    /// The first contact that is carried only by pairs at its edge.
    fn unresolved(results: &Results) -> Option<Self> {
        let states = results.states.iter().map(|state| Some(state.name.as_str()));
        let mut all = std::iter::once(None).chain(states);
        all.find_map(|state| {
            Self::of(results, state).filter(|spot| spot.pairs <= EdgeReading::AT_EDGE)
        })
    }

    fn refined(&self, times: usize) -> LocalRefinement {
        LocalRefinement {
            at: self.at,
            radius: REACH * self.half_width,
            times,
        }
    }
}

/// Position of the pair with the largest pressure.
fn most_pressed(state: &State) -> Option<[f64; 3]> {
    let pairs = state.pairs.iter();
    let most = pairs.max_by(|a, b| a.pressure.total_cmp(&b.pressure))?;
    (most.pressure > 0.0).then_some(most.position)
}

/// The refinement of a plane mesh with which the first unresolved contact of a run would have
/// [`READABLE`] pairs on a side if it were as wide as in the run. The true contact is narrower and
/// may need a finer mesh.
pub(super) fn suggested(scene: &Scene, results: &Results) -> Option<LocalRefinement> {
    let spot = ContactSpot::unresolved(results).filter(|_| !scene.kind.is_solid())?;
    let halvings = (READABLE as f64 / spot.pairs.max(1) as f64).log2().ceil();
    Some(spot.refined(halvings as usize))
}

/// Finds the refinement of a plane scene's mesh that gives [`READABLE`] pairs on a side to the
/// first contact that a run of the scene leaves unresolved. The elements there are halved and the
/// scene is run again until this is reached; `spent` grows by the floating point operations of
/// these runs. `None` if all contacts are resolved, if the mesh is one of solids, if smaller
/// elements do not help, or if `may_go_on` ends the search.
pub(super) fn resolving(
    (scene, results): (&Scene, &Results),
    (backend, extent): (Backend, Extent),
    (may_go_on, spent): (impl Fn() -> bool, &mut f64),
    observer: &mut dyn Observer,
) -> Option<LocalRefinement> {
    let mut spot = ContactSpot::unresolved(results).filter(|_| !scene.kind.is_solid())?;
    let extent = if spot.state.is_none() {
        Extent::Yield
    } else {
        extent
    };
    for times in 1..=LocalRefinement::MOST_TIMES {
        if !may_go_on() || observer.stop_requested() {
            return None;
        }
        let refinement = spot.refined(times);
        let refined = with(scene, refinement.clone());
        let model = Model::new(&refined).ok()?;
        let (_, results) = analyse(model, backend, extent, &mut Quiet(observer)).ok()?;
        *spent += work(&results);
        let now = ContactSpot::of(&results, spot.state.as_deref())?;
        if now.pairs >= READABLE {
            return Some(refinement);
        }
        if now.pairs <= spot.pairs && now.half_width > NARROWER * spot.half_width {
            return None;
        }
        spot = now;
    }
    None
}

/// The scene with one more refinement of its mesh.
pub(super) fn with(scene: &Scene, refinement: LocalRefinement) -> Scene {
    let mut out = scene.clone();
    out.mesh.refine.push(refinement);
    out
}
