//! Rigid surfaces in the model: each is a body of one element, all of whose nodes move alike.
//!
//! The element has no mechanical effect: its nodes share one displacement, along the applied force
//! or the prescribed displacement, and are held in the other directions, so that the element is
//! never strained. Its position has no meaning for the surface, whose distance from any point is
//! known ([`Form`]). As a body, it is treated like any other in contact rows, loads, supports and
//! the motions that contact alone holds.

mod form;
mod heights;

use super::freedoms::{Freedoms, Slot};
use crate::error::{Error, Result};
use crate::mesh::{Facet, Mesh, Shape, Surface};
use crate::scene::{Load, Scene};
use crate::shape::CORNERS_OF_CUBE;
use crate::space::{Vector, along, direction, dot, length, unit};
pub(super) use form::Form;
use std::ops::Range;

/// Cosine of the angle up to which directions count as equal.
const ALIKE: f64 = 1.0 - 1e-12;
/// Half the side of an element, as a fraction of the size of the mesh: small enough to be
/// distinguished from the bodies in a picture, large enough to be seen.
const SIDE: f64 = 0.02;

/// Rigid surfaces of a scene, in the order of their names.
#[derive(Debug, Default)]
pub(super) struct RigidBodies {
    bodies: Vec<RigidBody>,
}

/// A rigid surface with its form, its motion and its element.
#[derive(Debug)]
pub(super) struct RigidBody {
    pub name: String,
    pub form: Form,
    motion: Motion,
    /// Nodes of the element that represents the surface.
    nodes: Range<usize>,
}

/// Motion that a rigid surface can make.
#[derive(Debug, PartialEq)]
enum Motion {
    /// The surface does not move.
    Held,
    /// Moves by a prescribed displacement along these axes.
    Given([bool; 3]),
    /// Moves freely along a direction.
    Free(Vector),
}

impl RigidBodies {
    /// Resolves the rigid surfaces of a scene, and adds one element for each to its mesh.
    ///
    /// # Errors
    /// A name that the mesh already has; forces along several directions.
    pub fn add(scene: &Scene, mesh: &mut Mesh) -> Result<Self> {
        let mut bodies = Vec::new();
        let size = size(mesh);
        for (name, surface) in &scene.rigid {
            let refused = |error| scene.places.in_front(&format!("rigid.{name}"), error);
            if mesh.bodies.contains(name) || mesh.set_nodes(name).is_some() {
                return Err(refused(Error::input(format!(
                    "rigid.{name}: the mesh has a body or a set of this name: take another one"
                ))));
            }
            let within = |error: Error| refused(error.within(format!("rigid.{name}")));
            let form = Form::of(surface, scene).map_err(within)?;
            let motion = motion(scene, name)?;
            let nodes = add_element(mesh, name, &form, SIDE * size, scene);
            bodies.push(RigidBody {
                name: name.clone(),
                form,
                motion,
                nodes,
            });
        }
        Ok(RigidBodies { bodies })
    }

    /// Finds the rigid surface with a name.
    pub fn named(&self, name: &str) -> Option<&RigidBody> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// First node of rigid surfaces; all nodes from it on belong to rigid surfaces.
    pub fn first_node(&self) -> Option<usize> {
        self.bodies.first().map(|body| body.nodes.start)
    }

    /// Holds the nodes of each surface except along the directions in which it may move. Returns
    /// the nodes and local axes that share a displacement, with the number of the surface.
    pub fn hold(&self, freedoms: &mut Freedoms) -> Vec<((usize, usize), usize)> {
        let mut shared = Vec::new();
        for (k, body) in self.bodies.iter().enumerate() {
            for node in body.nodes.clone() {
                let free = match body.motion {
                    Motion::Held => [false; 3],
                    Motion::Given(axes) => axes,
                    Motion::Free(push) => {
                        freedoms.turn(node, push);
                        shared.push(((node, 0), k));
                        [true, false, false]
                    }
                };
                for (slot, free) in freedoms.slots[node].iter_mut().zip(free) {
                    if !free {
                        *slot = Slot::Fixed;
                    }
                }
            }
        }
        shared
    }
}

impl RigidBody {
    /// Masters of a slave that faces the surface: all nodes of the element, with equal weights.
    pub fn masters(&self) -> Vec<(usize, f64)> {
        let share = 1.0 / self.nodes.len() as f64;
        self.nodes.clone().map(|node| (node, share)).collect()
    }
}

/// Motion that the loads of a scene give a rigid surface.
fn motion(scene: &Scene, name: &str) -> Result<Motion> {
    let mut motion = Motion::Held;
    for (index, load) in scene.load.iter().enumerate().filter(|(_, l)| l.on == name) {
        if let Some(displacement) = &load.displacement {
            return Ok(Motion::Given(
                displacement.components().map(|of| of.is_some()),
            ));
        }
        let push = force(load);
        if length(push) == 0.0 {
            continue;
        }
        let push = direction(push);
        match motion {
            Motion::Free(other) if dot(push, other).abs() < ALIKE => {
                let error = Error::input(format!(
                    "load {} pushes the rigid surface `{name}` along another direction than an \
                     earlier load; it moves along one: give it forces along that one",
                    index + 1
                ));
                return Err(scene.places.in_front(&format!("load.{index}"), error));
            }
            Motion::Free(_) => {}
            _ => motion = Motion::Free(push),
        }
    }
    if let Motion::Free(push) = motion
        && scene.kind.is_axisymmetric()
        && push[0] != 0.0
    {
        return Err(Error::input(format!(
            "the rigid surface `{name}` is pushed along r: of an axisymmetric model it moves along \
             the axis"
        )));
    }
    Ok(motion)
}

/// Total force of a load on a rigid surface.
fn force(load: &Load) -> Vector {
    match (&load.force, &load.plane_force) {
        (Some(force), _) => force.vector(),
        (None, Some(plane)) => unit(plane.direction.axis()).map(|n| n * plane.total),
        _ => [0.0; 3],
    }
}

/// Longest side of the bounding box of the nodes.
fn size(mesh: &Mesh) -> f64 {
    let sides = (0..mesh.dimension).map(|d| {
        let along = mesh.coordinates.iter().skip(d).step_by(mesh.dimension);
        let ends = |[low, high]: [f64; 2], x: &f64| [low.min(*x), high.max(*x)];
        let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], ends);
        high - low
    });
    sides.fold(0.0, f64::max)
}

/// Point at a depth below the place on a rigid surface that is closest to what it may touch.
fn behind(scene: &Scene, mesh: &Mesh, name: &str, form: &Form, depth: f64) -> Vector {
    let touching = scene.contact.iter().filter_map(|contact| {
        [
            (&contact.first, &contact.second),
            (&contact.second, &contact.first),
        ]
        .into_iter()
        .find_map(|(own, other)| (own == name).then_some(other))
    });
    let nodes = touching.flat_map(|other| mesh.set_nodes(other).unwrap_or_default());
    let near = nodes.filter_map(|node| Some((mesh.point(node), form.near(mesh.point(node))?)));
    let closest = near.min_by(|a, b| a.1.0.total_cmp(&b.1.0));
    closest.map_or([0.0; 3], |(x, (distance, normal))| {
        along(x, -distance - depth, normal)
    })
}

/// Adds the element of a rigid surface as a body, and its boundary as a surface with the same name;
/// returns its nodes.
fn add_element(mesh: &mut Mesh, name: &str, form: &Form, half: f64, scene: &Scene) -> Range<usize> {
    let mut center = behind(scene, mesh, name, form, 2.0 * half);
    if scene.kind.is_axisymmetric() {
        center[0] = center[0].max(2.0 * half);
    }
    let (shape, signs): (Shape, &[[f64; 3]]) = match mesh.dimension {
        2 => (Shape::Quad4, &CORNERS_OF_CUBE[..4]),
        _ => (Shape::Hex8, &CORNERS_OF_CUBE),
    };
    let first = mesh.n_nodes();
    for sign in signs {
        let x = (0..mesh.dimension).map(|d| center[d] + half * sign[d]);
        mesh.coordinates.extend(x);
    }
    let nodes = first..first + signs.len();
    let next = |labels: &[u64]| labels.iter().max().map_or(1, |last| last + 1);
    if !mesh.node_labels.is_empty() {
        let start = next(&mesh.node_labels);
        mesh.node_labels.extend(start..start + signs.len() as u64);
    }
    if !mesh.element_labels.is_empty() {
        mesh.element_labels.push(next(&mesh.element_labels));
    }
    let element = mesh.n_elements();
    let numbers: Vec<u32> = nodes.clone().map(|node| node as u32).collect();
    mesh.push_element(shape, mesh.bodies.len(), &numbers);
    mesh.bodies.push(name.to_string());
    let facets = (0..shape.n_facets()).map(|local| Facet { element, local });
    mesh.surfaces.insert(
        name.to_string(),
        Surface {
            facets: facets.collect(),
            curve: None,
        },
    );
    nodes
}
