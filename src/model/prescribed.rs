//! Displacements prescribed by loads.

use super::carried::Carried;
use super::frame::ALIGNED;
use super::freedoms::{Freedoms, Planes, Prescribed, Slot};
use super::names::SceneEntry;
use super::on_mesh::OnMesh;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Direction, Load, Scene};
use crate::space::{Vector, dot, unit};

/// Middle of an edge whose displacement is given while the ends of the edge move otherwise: its
/// control point follows the control points of the ends.
pub(super) struct FollowingMiddle {
    pub(super) node: usize,
    /// Number of the local axis.
    pub(super) axis: usize,
    /// The prescribed value, with the number of the load; `None` for zero.
    pub(super) moved: Option<(usize, f64)>,
}

/// Directions along which a load moves nodes, with the values of a displacement.
type MovedDirections<'a> = Vec<(usize, Option<OnMesh<'a>>)>;

/// A load that prescribes displacements or holds a surface plane.
struct Moving<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    index: usize,
    load: &'a Load,
    entry: SceneEntry<'a>,
}

impl<'a> Moving<'a> {
    /// Directions along which the load moves its nodes, with the values of a displacement; a
    /// surface that is held plane has none. `None` if the load moves nothing.
    fn directions(&self) -> Result<Option<MovedDirections<'a>>> {
        if let Some(d) = &self.load.displacement {
            let given = d.components().into_iter().enumerate();
            let given = given.filter_map(|(axis, field)| Some((axis, field?)));
            let fields = given.map(|(axis, field)| {
                let field = OnMesh::new(field, "displacement", self.scene, self.mesh);
                Ok((axis, Some(field?)))
            });
            let fields: Result<_> = fields.collect();
            return fields.map(Some).map_err(|error| self.within(error));
        }
        let is_rigid = self.scene.rigid.contains_key(&self.load.on);
        let plane = self.load.plane_force.as_ref().filter(|_| !is_rigid);
        Ok(plane.map(|plane| vec![(plane.direction.axis(), None)]))
    }

    /// An error of one of the load's fields, with its place in the scene.
    fn within(&self, error: Error) -> Error {
        let entry = &self.entry;
        entry.refused(error.within(entry.on(&self.load.on)))
    }

    /// Says why a node cannot be moved.
    fn refused(&self, node: usize, why: &str) -> Error {
        self.entry.refused(Error::input(format!(
            "load {} on `{}`: node {} {why}",
            self.index + 1,
            self.load.on,
            self.mesh.node_label(node)
        )))
    }

    /// Prescribes the displacement of a node along a direction, or puts the node into the group of
    /// its plane if there is no value.
    fn prescribe(
        &self,
        freedoms: &mut Freedoms,
        (node, direction): (usize, usize),
        value: &Option<OnMesh>,
        touches: bool,
        planes: &mut Planes,
    ) -> Result<()> {
        let name = Direction::ALL[direction].name();
        let local = freedoms.local_axis(node, direction).ok_or_else(|| {
            let has = match touches {
                true => "a contact normal",
                false => "a turned support",
            };
            self.refused(node, &format!("has {has} and cannot be moved along {name}"))
        })?;
        let sign = dot(freedoms.local(node)[local], unit(direction)).signum();
        if freedoms.slots[node][local] != Slot::Free(0) || planes.contains_key(&(node, local)) {
            let why = format!("is already held or prescribed along {name}");
            return Err(self.refused(node, &why));
        }
        match value {
            Some(field) => {
                let value = field.at_node(node).map_err(|error| self.within(error))?;
                let number = freedoms.add_prescribed(self.index, sign * value);
                freedoms.slots[node][local] = Slot::Prescribed(number);
            }
            None if sign < 0.0 || touches => {
                let why = "belongs to a contact surface, which cannot be held plane";
                return Err(self.refused(node, why));
            }
            None => {
                planes.insert((node, local), self.index);
            }
        }
        Ok(())
    }
}

/// Turns displacements prescribed at the middles of edges into those of their control points.
/// Returns the middles whose control points depend on ends that are free or moved by another load.
/// `n_loads` is the number of loads of the scene.
pub(super) fn give_to_control_points(
    freedoms: &mut Freedoms,
    n_loads: usize,
) -> Vec<FollowingMiddle> {
    let mut following = Vec::new();
    let mut values = Vec::new();
    for (node, ends) in freedoms.basis.edges() {
        for (axis, slot) in freedoms.of_node(node).iter().enumerate() {
            let (load, value) = match *slot {
                Slot::Free(_) | Slot::Sum(_) => continue,
                Slot::Fixed => (n_loads, 0.0),
                Slot::Prescribed(p) => {
                    let Prescribed { load, value } = freedoms.prescribed[p as usize];
                    (load, value)
                }
            };
            let direction = freedoms.local(node)[axis];
            let at_end = |end: usize| given_along(freedoms, end, direction, load);
            let control = match ends.map(at_end) {
                [Some(a), Some(b)] => Some(freedoms.basis.number_at_control(node, |of| match of {
                    of if of == ends[0] => a,
                    of if of == ends[1] => b,
                    _ => value,
                })),
                _ => None,
            };
            match (control, *slot) {
                (Some(control), Slot::Prescribed(p)) => values.push((p, control)),
                (Some(0.0), _) => {}
                _ => following.push(FollowingMiddle {
                    node,
                    axis,
                    moved: (load != n_loads || value != 0.0).then_some((load, value)),
                }),
            }
        }
    }
    for (p, control) in values {
        freedoms.prescribed[p as usize].value = control;
    }
    following
}

/// Displacement of a node along a direction at factor 1 of a load, if the node is held there or
/// this load alone prescribes the displacement; `None` if something else moves the node.
fn given_along(freedoms: &Freedoms, node: usize, direction: Vector, load: usize) -> Option<f64> {
    let axes = freedoms.local(node);
    // Planes at any angle hold all directions in the span of their normals.
    let shares = (0..freedoms.per_node).map(|i| (i, dot(axes[i], direction)));
    let mut sum = 0.0;
    for (axis, share) in shares.filter(|(_, share)| share.powi(2) > ALIGNED) {
        sum += share
            * match freedoms.slots[node][axis] {
                Slot::Fixed => 0.0,
                Slot::Prescribed(p) => {
                    let Prescribed { load: own, value } = freedoms.prescribed[p as usize];
                    (own == load).then_some(value)?
                }
                Slot::Free(_) | Slot::Sum(_) => return None,
            };
    }
    Some(sum)
}

/// Turns prescribed displacements into slots, and surfaces held plane into groups.
pub(super) fn apply_loads(
    freedoms: &mut Freedoms,
    scene: &Scene,
    mesh: &Mesh,
    touches: &[bool],
    carried: Option<&Carried>,
) -> Result<Planes> {
    let mut planes = Planes::new();
    let start = carried.map_or(0.0, |carried| carried.at);
    let changes = !scene.changes_of_support().is_empty();
    let loads = || scene.load.iter().enumerate();
    let is_plane = |load: &Load| load.plane_force.is_some();
    let displaced = loads().filter(|(_, load)| !is_plane(load));
    for (index, load) in displaced.chain(loads().filter(|(_, load)| is_plane(load))) {
        // A prescribed displacement that starts from where an earlier leg left the nodes is imposed
        // by equations instead.
        let is_taken_over = |carried: &Carried| carried.taken_over(scene, index, [0.0; 2]);
        let comes = carried.and_then(is_taken_over).is_some();
        if comes || !load.span().holds_from(start) {
            continue;
        }
        let moving = Moving {
            scene,
            mesh,
            index,
            load,
            entry: SceneEntry::of_list(scene, "load", index),
        };
        let Some(directions) = moving.directions()? else {
            continue;
        };
        let nodes = moving.entry.nodes(mesh, &load.on)?;
        if load.plane_force.is_some() && changes && all_are_held(freedoms, &nodes, &directions) {
            continue;
        }
        for node in nodes {
            for (direction, value) in &directions {
                moving.prescribe(
                    freedoms,
                    (node, *direction),
                    value,
                    touches[node],
                    &mut planes,
                )?;
            }
        }
    }
    Ok(planes)
}

/// Whether all nodes are held along the given directions, so that a force along these directions
/// moves nothing.
fn all_are_held<T>(freedoms: &Freedoms, nodes: &[usize], directions: &[(usize, T)]) -> bool {
    let is_held = |node: usize, direction: usize| {
        let axis = freedoms.local_axis(node, direction);
        axis.is_some_and(|axis| freedoms.slots[node][axis] != Slot::Free(0))
    };
    let mut all = directions
        .iter()
        .flat_map(|(d, _)| nodes.iter().map(|&node| (node, *d)));
    all.all(|(node, direction)| is_held(node, direction))
}
