//! Forces on the volume of a body: weight, acceleration, rotation.
//!
//! ```text
//! f_i = sum_e int N_i rho b dV,   b = a,   b = omega^2 (x - x_0),  x_0 nearest to x on the axis
//! ```
//!
//! The angular velocity is `omega = 2 pi rpm/60` per second; the unit of time in the density must
//! also be the second.

use crate::element::volume_points;
use crate::mesh::Mesh;
use crate::scene::Rotation;
use crate::space::{Space, Vector, along, difference, direction, dot, unit};
use std::f64::consts::PI;

/// Nodal forces on a body, and the part of the body's volume that belongs to each of these nodes.
pub(super) struct BodyForces {
    pub(super) nodal: Vec<(usize, Vector)>,
    pub(super) volumes: Vec<f64>,
}

/// Consistent nodal forces of `density` times the field `b(x)` on a body, nodes ascending.
pub(super) fn on_body(
    space: Space,
    mesh: &Mesh,
    body: usize,
    density: f64,
    field: impl Fn(Vector) -> Vector,
) -> BodyForces {
    let mut at_node = std::collections::BTreeMap::new();
    for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body) {
        let nodes = mesh.nodes(element);
        let x: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n as usize)).collect();
        let kind = (mesh.shapes[element], mesh.integration_of(element));
        for point in volume_points(space, kind, &x) {
            let force = field(point.position).map(|b| density * b);
            for (&node, value) in nodes.iter().zip(point.values) {
                let share = point.weight * value;
                let (sum, volume): &mut (Vector, f64) = at_node.entry(node as usize).or_default();
                *sum = along(*sum, share, force);
                *volume += share;
            }
        }
    }
    BodyForces {
        nodal: at_node
            .iter()
            .map(|(&node, &(force, _))| (node, force))
            .collect(),
        volumes: at_node.values().map(|(_, volume)| *volume).collect(),
    }
}

/// Centrifugal field `omega^2 (x - x_0)`, which points away from the axis. In plane models the axis
/// is normal to the plane; in an axisymmetric model it is the axis of symmetry.
pub(super) fn spinning(space: Space, rotation: &Rotation) -> impl Fn(Vector) -> Vector {
    let center = rotation.center.map_or([0.0; 3], |c| c.vector());
    let axis: Vector = match space {
        Space::Axisymmetric => unit(1),
        Space::PlaneStrain | Space::PlaneStress => unit(2),
        Space::Solid => direction(rotation.axis.unwrap_or_default()),
    };
    let speed = 2.0 * PI * rotation.rpm / 60.0;
    move |x| {
        let way = difference(x, center);
        along(way, -dot(way, axis), axis).map(|d| speed * speed * d)
    }
}
