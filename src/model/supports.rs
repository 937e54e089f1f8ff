//! Supports of each node, and their effect on contact normals.

use super::names::SceneEntry;
use super::pairs::Pair;
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::space::{Vector, along, direction, dot, unit};
use std::collections::BTreeMap;

/// Sine of the angle between a support and a contact's tangent below which the support is meant to
/// lie in the tangent, 30 degrees: the normal of the discretised surface is then rotated into the
/// symmetry plane.
const NEARLY_TANGENT: f64 = 0.5;

/// A direction in which a node is held.
pub(super) struct HeldDirection {
    pub(super) direction: Vector,
    /// Index of the support; `None` for the axis of revolution.
    pub(super) support: Option<usize>,
}

impl HeldDirection {
    /// Name of the support for messages.
    pub(super) fn by(&self, scene: &Scene) -> String {
        match self.support {
            Some(index) => format!("support {} on `{}`", index + 1, scene.support[index].on),
            None => "the axis of revolution".to_string(),
        }
    }

    pub(super) fn refused(&self, scene: &Scene, why: String) -> Error {
        match self.support {
            Some(index) => SceneEntry::of_list(scene, "support", index).refused(Error::input(why)),
            None => Error::input(why),
        }
    }
}

/// Directions in which loads prescribe the displacement of each node, or equations let it follow
/// others.
pub(super) struct Moved(BTreeMap<usize, Vec<Vector>>);

impl Moved {
    /// Whether the displacement of a node is prescribed or follows others along a direction;
    /// directions nearly at right angles to it do not count.
    pub(super) fn towards(&self, node: usize, direction: Vector) -> bool {
        let mut moved = self.0.get(&node).into_iter().flatten();
        moved.any(|moved| dot(direction, *moved).abs() >= NEARLY_TANGENT)
    }
}

/// Held directions of each node, in the order of the scene, whether throughout the program or in
/// some of its legs.
pub(super) struct Supports {
    pub(super) of_node: BTreeMap<usize, Vec<HeldDirection>>,
}

impl Supports {
    pub(super) fn resolve(scene: &Scene, mesh: &Mesh) -> Result<Self> {
        let mut of_node: BTreeMap<usize, Vec<HeldDirection>> = BTreeMap::new();
        for (index, support) in scene.support.iter().enumerate() {
            let directions = support.directions();
            for node in SceneEntry::of_list(scene, "support", index).nodes(mesh, &support.on)? {
                let held = directions.iter().map(|&direction| HeldDirection {
                    direction,
                    support: Some(index),
                });
                of_node.entry(node).or_default().extend(held);
            }
        }
        if scene.kind.is_axisymmetric() {
            // On the axis of revolution the radial displacement vanishes whether or not the scene
            // says so.
            let radius = (0..mesh.n_nodes())
                .map(|i| mesh.point(i)[0])
                .fold(0.0, f64::max);
            for node in (0..mesh.n_nodes()).filter(|&i| mesh.point(i)[0] <= 1e-12 * radius) {
                of_node.entry(node).or_default().push(HeldDirection {
                    direction: unit(0),
                    support: None,
                });
            }
        }
        Ok(Supports { of_node })
    }

    /// Keeps the supports that hold in the leg that begins at a load factor.
    pub(super) fn in_leg(mut self, scene: &Scene, start: f64) -> Self {
        for held in self.of_node.values_mut() {
            held.retain(|held| {
                let support = held.support.map(|index| &scene.support[index]);
                support.is_none_or(|support| support.span().holds_from(start))
            });
        }
        self.of_node.retain(|_, held| !held.is_empty());
        self
    }

    /// Finds the prescribed displacements of all loads, and those that follow others in equations.
    pub(super) fn moved(scene: &Scene, mesh: &Mesh) -> Result<Moved> {
        let mut of_node: BTreeMap<usize, Vec<Vector>> = BTreeMap::new();
        for (index, load) in scene.load.iter().enumerate() {
            let displacement = load.displacement.iter();
            let given = displacement.flat_map(|d| d.components().into_iter().enumerate());
            let given = given.filter_map(|(axis, field)| field.map(|_| axis));
            let relative = load.relative.iter().map(|of| of.direction.axis());
            let axes: Vec<Vector> = given.chain(relative).map(unit).collect();
            if axes.is_empty() {
                continue;
            }
            for node in SceneEntry::of_list(scene, "load", index).nodes(mesh, &load.on)? {
                of_node.entry(node).or_default().extend(&axes);
            }
        }
        for (index, equation) in scene.equation.iter().enumerate() {
            let Some(first) = equation.terms.first() else {
                continue;
            };
            for node in SceneEntry::of_list(scene, "equation", index).nodes(mesh, &first.on)? {
                let axis = unit(first.direction.axis());
                of_node.entry(node).or_default().push(axis);
            }
        }
        Ok(Moved(of_node))
    }
}

impl Supports {
    /// Checks that supports hold the slave of a pair along its normal in all legs of the program.
    ///
    /// # Errors
    /// `Unsupported` naming the node and the support.
    pub(super) fn hold_throughout(&self, scene: &Scene, mesh: &Mesh, pair: &Pair) -> Result<()> {
        let held = self.of_node.get(&pair.slave).into_iter().flatten();
        for held in held.filter(|held| dot(pair.normal, held.direction).abs() >= NEARLY_TANGENT) {
            let support = held.support.map(|index| &scene.support[index]);
            if support.is_some_and(|support| !support.span().is_whole()) {
                let error = held.refused(
                    scene,
                    format!(
                        "{} begins or ends within the program, and holds node {} along its \
                         contact normal: contact and support would take turns; take the node out \
                         of one of the two sets",
                        held.by(scene),
                        mesh.node_label(pair.slave)
                    ),
                );
                return Err(Error::new(ErrorKind::Unsupported, error.to_string()));
            }
        }
        Ok(())
    }

    /// Whether a node is held along a direction; supports nearly at right angles to it do not
    /// count.
    pub(super) fn hold_along(&self, node: usize, direction: Vector) -> bool {
        let mut held = self.of_node.get(&node).into_iter().flatten();
        held.any(|held| dot(direction, held.direction).abs() >= NEARLY_TANGENT)
    }
}

/// Rotates normals that are nearly at right angles to a support to exact right angles.
pub(super) fn turn_normals_into_supports(pairs: &mut [Pair], supports: &Supports) {
    for pair in pairs {
        for node in pair.faced().into_iter().chain([pair.slave]) {
            for held in supports.of_node.get(&node).into_iter().flatten() {
                let off = dot(pair.normal, held.direction);
                if off != 0.0 && off.abs() < NEARLY_TANGENT {
                    pair.normal = direction(along(pair.normal, -off, held.direction));
                }
            }
        }
    }
}
