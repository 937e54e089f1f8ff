//! Displacements that loads prescribe, and places at which supports that begin within the program
//! hold their nodes.

use super::carried::Carried;
use super::frame::ALIGNED;
use super::freedoms::{Freedoms, Planes, Prescribed, Slot};
use super::names::Entry;
use super::on_mesh::OnMesh;
use super::supports::Held;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Direction, Load, Scene};
use crate::space::{Vector, dot, in_words, unit};

impl Freedoms {
    /// Refuses an edge whose middle is held through its control point while its ends are not held
    /// in the same way: all at rest, or all moved by the same load. `n_loads` is the number of
    /// loads of the scene.
    pub(super) fn check_edges(&self, mesh: &Mesh, n_loads: usize) -> Result<()> {
        // Displacements that a leg of the program has left are held like zero.
        let of = |slot: Slot| match slot {
            Slot::Free(_) | Slot::Sum(_) => None,
            Slot::Fixed => Some(n_loads),
            Slot::Prescribed(p) => Some(self.prescribed[p as usize].load),
        };
        let held = |node: usize, direction: Vector| {
            let axes = self.local(node);
            // Planes at any angle hold all directions in the span of their normals.
            let at_rest = (0..3).filter(|&i| of(self.slots[node][i]) == Some(n_loads));
            if at_rest
                .map(|i| dot(axes[i], direction).powi(2))
                .sum::<f64>()
                > 1.0 - ALIGNED
            {
                return Some(n_loads);
            }
            let at = (0..3).find(|&i| dot(axes[i], direction).abs() > 1.0 - ALIGNED)?;
            of(self.slots[node][at])
        };
        for (node, ends) in self.basis.edges() {
            for (slot, axis) in self.slots[node].iter().zip(self.local(node)) {
                let alike = |end: &usize| held(*end, axis) == held(node, axis);
                if !matches!(slot, Slot::Free(_)) && !ends.iter().all(alike) {
                    return Err(Error::input(format!(
                        "node {} in the middle of an edge in contact is held along {}, but an end \
                         of the edge (nodes {} and {}) is not held alike: hold or release the \
                         whole edge",
                        mesh.node_label(node),
                        in_words(axis, mesh.dimension),
                        mesh.node_label(ends[0]),
                        mesh.node_label(ends[1])
                    )));
                }
            }
        }
        Ok(())
    }

    /// Holds a node where it is along the directions of supports that began within the program.
    pub(super) fn hold_where_it_is(
        &mut self,
        scene: &Scene,
        node: usize,
        of_node: &[Held],
        carried: &Carried,
    ) {
        let began = |held: &&Held| {
            let support = held.support.map(|index| &scene.support[index]);
            support.is_some_and(|support| support.since.is_some())
        };
        let axes = self.local(node);
        for Held { direction, .. } in of_node.iter().filter(began) {
            for (slot, axis) in self.slots[node].iter_mut().zip(axes) {
                if *slot == Slot::Fixed && dot(axis, *direction).abs() > ALIGNED {
                    *slot = Slot::Prescribed(self.prescribed.len() as u32);
                    self.prescribed.push(Prescribed {
                        load: Carried::held_case(scene),
                        value: dot(carried.of_control(node, &self.basis), axis),
                    });
                }
            }
        }
    }

    /// Turns prescribed displacements into slots, and surfaces held plane into groups.
    pub(super) fn apply_loads(
        &mut self,
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
            // Displacements on their way are equations.
            let comes = carried.is_some_and(|carried| carried.origin_case(scene, index).is_some());
            if comes || !load.span().holds_from(start) {
                continue;
            }
            let entry = Entry::of_list(scene, "load", index);
            let directions: Vec<(usize, Option<OnMesh>)> = if let Some(d) = &load.displacement {
                let given = d.components().into_iter().enumerate();
                let given = given.filter_map(|(axis, field)| Some((axis, field?)));
                let fields = given.map(|(axis, field)| {
                    let field = OnMesh::new(field, "displacement", scene, mesh);
                    Ok((axis, Some(field?)))
                });
                let within = |error: Error| entry.refused(error.within(entry.on(&load.on)));
                fields.collect::<Result<_>>().map_err(within)?
            } else if let Some(plane) = load.plane_force
                && !scene.rigid.contains_key(&load.on)
            {
                vec![(plane.direction.axis(), None)]
            } else {
                continue;
            };
            let nodes = entry.nodes(mesh, &load.on)?;
            if load.plane_force.is_some() && changes && self.all_are_held(&nodes, &directions) {
                continue;
            }
            for node in nodes {
                let refused = |why: String| {
                    entry.refused(Error::input(format!(
                        "load {} on `{}`: node {} {why}",
                        index + 1,
                        load.on,
                        mesh.node_label(node)
                    )))
                };
                let touches = touches[node];
                for (direction, value) in &directions {
                    let direction = *direction;
                    let name = Direction::ALL[direction].name();
                    let local = self.local_axis(node, direction).ok_or_else(|| {
                        let has = match touches {
                            true => "a contact normal",
                            false => "a turned support",
                        };
                        refused(format!("has {has} and cannot be moved along {name}"))
                    })?;
                    let sign = dot(self.local(node)[local], unit(direction)).signum();
                    if self.slots[node][local] != Slot::Free(0)
                        || planes.contains_key(&(node, local))
                    {
                        return Err(refused(format!(
                            "is already held or prescribed along {name}"
                        )));
                    }
                    match value {
                        Some(field) => {
                            let value = field
                                .at_control(node, &self.basis)
                                .map_err(|error| entry.refused(error.within(entry.on(&load.on))))?;
                            self.slots[node][local] =
                                Slot::Prescribed(self.prescribed.len() as u32);
                            self.prescribed.push(Prescribed {
                                load: index,
                                value: sign * value,
                            });
                        }
                        None if sign < 0.0 || touches => {
                            let why = "belongs to a contact surface, which cannot be held plane";
                            return Err(refused(why.to_string()));
                        }
                        None => {
                            planes.insert((node, local), index);
                        }
                    }
                }
            }
        }
        Ok(planes)
    }

    /// Whether nodes are all held along some directions, so that a force there goes into what holds
    /// them.
    fn all_are_held<T>(&self, nodes: &[usize], directions: &[(usize, T)]) -> bool {
        let is_held = |node: usize, direction: usize| {
            let axis = self.local_axis(node, direction);
            axis.is_some_and(|axis| self.slots[node][axis] != Slot::Free(0))
        };
        let mut all = directions
            .iter()
            .flat_map(|(d, _)| nodes.iter().map(|&node| (node, *d)));
        all.all(|(node, direction)| is_held(node, direction))
    }
}
