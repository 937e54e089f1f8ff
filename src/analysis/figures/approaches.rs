//! The approach of the two bodies of each contact, taken as wholes.
//!
//! A body as a whole moves as its far boundary does. The motion of the far boundary is the first of
//! these that exists: the displacement prescribed on the body; zero, if supports hold the body
//! along the contact's normal; the mean displacement of the surfaces through which the body is
//! loaded, weighted with the sizes of the loads; the mean over the volume of the body. In a stack
//! of bodies the approaches of the contacts add up to the approach of the ends of the stack.

use super::dent::body_of;
use crate::model::{ContactSurface, LoadCase, Magnitude, Model, Slot, volumes_of_nodes};
use crate::space::{Vector, along, dot, length};

/// Length of the mean normal below which a contact has no direction, like a pin in contact all
/// round its hole.
const NO_DIRECTION: f64 = 1e-6;
/// Cosine of the angle between a direction and a contact's normal above which the direction counts
/// as along the normal. Of two perpendicular axes, at least the nearer one does.
const ALONG: f64 = 0.7;

/// The approach of the bodies of a contact as a function of displacements.
pub(super) struct Approach {
    /// Unit vector from the slave's body to the master's body.
    direction: Vector,
    /// Nodes of the slave's body and of the master's body, with their weights.
    sides: [Vec<(usize, f64)>; 2],
}

impl Approach {
    /// Approaches of all contacts; `None` for a contact whose normals cancel.
    pub(super) fn of_contacts(model: &Model) -> Vec<Option<Approach>> {
        let contacts = model.contacts.iter();
        contacts.map(|contact| Self::of(model, contact)).collect()
    }

    fn of(model: &Model, contact: &ContactSurface) -> Option<Approach> {
        let direction = direction(model, contact)?;
        let other = 1 - contact.slave;
        let sides = [contact.slave, other].map(|side| {
            let body = body_of(&model.mesh, &contact.names[side])?;
            Some(far_boundary(model, body, direction))
        });
        let [Some(slave), Some(faced)] = sides else {
            return None;
        };
        Some(Approach {
            direction,
            sides: [slave, faced],
        })
    }

    /// The approach for given displacements of all nodes.
    pub(in crate::analysis) fn at(&self, moved: &[Vector]) -> f64 {
        let mean = |side: &[(usize, f64)]| -> f64 {
            let parts = side.iter();
            parts
                .map(|&(node, w)| w * dot(moved[node], self.direction))
                .sum()
        };
        mean(&self.sides[0]) - mean(&self.sides[1])
    }
}

/// The mean normal of a contact of the whole model with its mirror images: components across planes
/// of symmetry, or across the axis of revolution, cancel.
fn direction(model: &Model, contact: &ContactSurface) -> Option<Vector> {
    let pairs = &model.pairs[contact.range.clone()];
    let area: f64 = pairs.iter().map(|pair| pair.area).sum();
    let mut mean = pairs.iter().fold([0.0; 3], |sum, pair| {
        along(sum, pair.area / area, pair.normal)
    });
    if model.kind.is_axisymmetric() {
        mean[0] = 0.0;
    }
    for mirror in &contact.mirrors {
        let across = mirror.normal();
        mean = along(mean, -dot(mean, across), across);
    }
    let size = length(mean);
    (size > NO_DIRECTION).then(|| mean.map(|x| x / size))
}

/// The nodes whose weighted mean displacement is that of the body as a whole, with their weights.
fn far_boundary(model: &Model, body: usize, direction: Vector) -> Vec<(usize, f64)> {
    let loads = || model.loads.iter().filter(|load| load.body as usize == body);
    let is_along = |load: &&LoadCase| dot(load.direction, direction).abs() > ALONG;
    let moves = |load: &&LoadCase| load.measures == Magnitude::Displacement;
    let shares = |load: &LoadCase, size: f64| -> Vec<(usize, f64)> {
        let nodes = load.nodes.iter().copied().zip(&load.shares);
        nodes.map(|(node, share)| (node, size * share)).collect()
    };
    if let Some(load) = loads().filter(moves).find(is_along) {
        return shares(load, 1.0);
    }
    let of_body = nodes_of(model, body);
    if of_body.iter().any(|&node| is_held(model, node, direction)) {
        return Vec::new();
    }
    let acting = || loads().filter(|load| !moves(load) && load.size() > 0.0 && is_along(load));
    let total: f64 = acting().map(LoadCase::size).sum();
    if total > 0.0 {
        return acting()
            .flat_map(|load| shares(load, load.size() / total))
            .collect();
    }
    let volumes = volumes_of_nodes(model.kind, &model.mesh);
    let total: f64 = of_body.iter().map(|&node| volumes[node]).sum();
    let share = |node: usize| (node, volumes[node] / total);
    of_body.into_iter().map(share).collect()
}

fn nodes_of(model: &Model, body: usize) -> Vec<usize> {
    let mesh = &model.mesh;
    let elements = (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body);
    let mut nodes: Vec<usize> = elements
        .flat_map(|e| mesh.nodes(e).iter().map(|&node| node as usize))
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Whether a support holds a node along a direction.
fn is_held(model: &Model, node: usize, direction: Vector) -> bool {
    let axes = model.freedoms.local(node);
    let slots = model.freedoms.of_node(node).iter().enumerate();
    slots
        .filter(|(_, slot)| **slot == Slot::Fixed)
        .any(|(axis, _)| dot(axes[axis], direction).abs() > ALONG)
}
