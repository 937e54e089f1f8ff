//! Values at a place of a state: pressure, displacements and stresses at the nearest node.

use crate::mesh::NearestNode;
use crate::model::Model;
use crate::results::{Results, State};
use crate::scene::{PlaceQuantity, Reference};
use crate::space::{Vector, difference, length};

/// Returns the value of a quantity at a place, in the state that the entry names. `None` if the run
/// has no such state, or the state has no fields there.
pub(super) fn value(model: &Model, results: &Results, entry: &Reference) -> Option<f64> {
    let (state, what) = PlaceQuantity::of(entry.quantity.as_deref()?, model.kind)?;
    let state = results.states.iter().find(|s| s.name == state)?;
    let at = entry.place()?;
    if what == PlaceQuantity::Pressure {
        return pressure(state, at);
    }
    let node = NearestNode::of(&model.mesh, entry.body.as_deref(), at)?.node;
    let fields = state.fields.as_ref()?;
    let (values, component, n) = match what {
        PlaceQuantity::Displacement(axis) => (&fields.displacement, axis, model.mesh.dimension),
        PlaceQuantity::Stress(component) => {
            let n = model.kind.components().len();
            (&fields.nodal_stress, component, n)
        }
        PlaceQuantity::Pressure => return None,
    };
    values.get(n * node + component).copied()
}

fn pressure(state: &State, at: Vector) -> Option<f64> {
    let pairs = state.pairs.iter();
    let nearest = pairs.min_by(|a, b| {
        let [a, b] = [a, b].map(|pair| length(difference(pair.position, at)));
        a.total_cmp(&b)
    });
    nearest.map(|pair| pair.pressure)
}
