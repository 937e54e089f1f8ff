//! Values at a place of a state: pressure, displacements and stresses at the nearest node.

use crate::model::Model;
use crate::results::{Results, State};
use crate::scene::{PlaceQuantity, Reference};
use crate::space::Vector;

/// The value of a quantity of a place in the state that it names. `None` where the run has no such
/// state, or no fields there.
pub(super) fn value(model: &Model, results: &Results, entry: &Reference) -> Option<f64> {
    let (state, what) = PlaceQuantity::of(entry.quantity.as_deref()?, model.kind)?;
    let state = results.states.iter().find(|s| s.name == state)?;
    let mut at: Vector = [0.0; 3];
    at.iter_mut()
        .zip(entry.at.as_ref()?)
        .for_each(|(a, x)| *a = *x);
    if what == PlaceQuantity::Pressure {
        return pressure(state, at);
    }
    let node = nearest_node(model, entry.body.as_deref(), at)?;
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

fn distance(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum()
}

fn pressure(state: &State, at: Vector) -> Option<f64> {
    let pairs = state.pairs.iter();
    let nearest = pairs.min_by(|a, b| {
        let [a, b] = [a, b].map(|pair| distance(pair.position, at));
        a.total_cmp(&b)
    });
    nearest.map(|pair| pair.pressure)
}

/// The nearest node of the mesh, or of one of its bodies.
fn nearest_node(model: &Model, body: Option<&str>, at: Vector) -> Option<usize> {
    let mesh = &model.mesh;
    let is_of =
        |e: &usize| body.is_none_or(|body| mesh.bodies[mesh.element_body[*e] as usize] == body);
    let elements = (0..mesh.n_elements()).filter(is_of);
    let nodes = elements.flat_map(|e| mesh.nodes(e).iter().map(|&node| node as usize));
    nodes.min_by(|&a, &b| {
        let [a, b] = [a, b].map(|node| distance(mesh.point(node), at));
        a.total_cmp(&b)
    })
}
