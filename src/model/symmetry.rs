//! Planes of symmetry of a model, found from its supports and loads.
//!
//! Along a straight boundary whose nodes are held across it and free along it (the axis of
//! revolution is one), the body continues as if mirrored. A fit of the stress from one side alone
//! would ignore what is known about the other side, and would move a maximum on the plane away from
//! it.

use super::mirror::{Mirror, ON_PLANE, SAME};
use super::{ContactSurface, Model, Pair, Slot};
use crate::mesh::Facet;
use crate::scene::{Load, LoadAction, NodeAction};
use crate::space::{Vector, along, cross, difference, direction, dot, length as length_of};
use std::collections::BTreeSet;

/// Directions across the contact normal in which the node of a pair is held.
fn held(model: &Model, node: usize) -> impl Iterator<Item = Vector> + '_ {
    let slots = model.freedoms.of_node(node);
    let axes = model.freedoms.local(node);
    (1..slots.len())
        .filter(move |&i| Conditions::is_held(model, slots[i]))
        .map(move |i| axes[i])
}

impl Mirror {
    /// Finds the planes of symmetry on which each contact ends: an end of its surface lies on the
    /// plane, and the plane bounds all bodies of the contact. A single node that is held to keep a
    /// body in place does not define a plane of symmetry.
    pub(super) fn of_contacts(model: &Model) -> Vec<Vec<Mirror>> {
        let of_contact = |contact| Self::of_contact(model, contact);
        model.contacts.iter().map(of_contact).collect()
    }

    fn of_contact(model: &Model, contact: &ContactSurface) -> Vec<Mirror> {
        let (mut out, mut known) = (Vec::new(), Vec::<Mirror>::new());
        for pair in &model.pairs[contact.range.clone()] {
            let x = model.mesh.point(pair.slave);
            // The round-off of positions on one plane is far below the size of a facet.
            let near = ON_PLANE * contact.facet_length;
            for normal in held(model, pair.slave) {
                let mirror = Mirror {
                    normal,
                    offset: dot(normal, x),
                };
                let same = |other: &Mirror| {
                    length_of(cross(normal, other.normal)) < SAME && other.beyond(x).abs() <= near
                };
                if known.iter().any(same) {
                    continue;
                }
                known.push(mirror);
                let Some(mirror) = mirror.at_end(model, contact, near) else {
                    continue;
                };
                let mut bodies = bodies_at(model, contact).into_iter();
                if bodies.all(|body| mirror.bounds(model, body, near)) {
                    out.push(mirror);
                }
            }
        }
        out
    }

    /// Orients the plane's normal away from a contact that ends on it: all pairs lie on one side,
    /// and in a solid an edge of a face lies in the plane. `None` if the contact does not end
    /// there.
    fn at_end(self, model: &Model, contact: &ContactSurface, near: f64) -> Option<Mirror> {
        let beyond = |k: usize| self.beyond(model.mesh.point(model.pairs[k].slave));
        let mut off = contact
            .range
            .clone()
            .map(beyond)
            .filter(|off| off.abs() > near);
        let is_before = off.next()? < 0.0;
        if off.any(|off| (off < 0.0) != is_before) {
            return None;
        }
        let is_edge = |face: &Vec<usize>| face.iter().filter(|k| beyond(**k).abs() <= near).count();
        let sign = if is_before { 1.0 } else { -1.0 };
        let mirror = Mirror {
            normal: along([0.0; 3], sign, self.normal),
            offset: sign * self.offset,
        };
        (!model.kind.is_solid() || contact.faces.iter().any(|face| is_edge(face) >= 2))
            .then_some(mirror)
    }

    /// Whether a body ends on the plane, and all its nodes on the plane are held along the plane's
    /// normal. Other conditions on the plane act on the mirror image in the same way. A facet that
    /// does not move along the plane either means that the body is clamped there, unless the scene
    /// declares a symmetry.
    fn bounds(&self, model: &Model, body: u32, near: f64) -> bool {
        let mesh = &model.mesh;
        let ours = |element: &usize| mesh.element_body[*element] == body;
        let elements: Vec<usize> = (0..mesh.n_elements()).filter(ours).collect();
        let off = |node: usize| self.beyond(mesh.point(node));
        let is_held = |node: usize, along: Vector| Conditions::hold_node(model, node, along);
        let stays =
            |node: usize| off(node) < -near || (off(node) <= near && is_held(node, self.normal));
        let nodes = |&element: &usize| mesh.nodes(element).iter().map(|&node| node as usize);
        if !elements.iter().flat_map(nodes).all(stays) {
            return false;
        }
        let touching = elements
            .iter()
            .filter(|e| nodes(e).any(|node| off(node) >= -near));
        let facets = touching.flat_map(|&element| {
            (0..mesh.shapes[element].n_facets()).map(move |local| Facet { element, local })
        });
        let is_there = |facet: &Facet| mesh.facet_nodes(*facet).all(|node| off(node) >= -near);
        let mut there = facets.filter(is_there).peekable();
        let is_axis = model.kind.is_axisymmetric()
            && self.offset.abs() <= near
            && self.normal[1].abs() < SAME;
        let is_clamped = |facet: Facet| {
            let first = mesh.facet_nodes(facet).next().unwrap_or(0);
            let axes = model
                .freedoms
                .local(first)
                .into_iter()
                .take(model.freedoms.per_node);
            let mut along = axes.filter(|axis| length_of(cross(*axis, self.normal)) > SAME);
            along.any(|axis| mesh.facet_nodes(facet).all(|node| is_held(node, axis)))
        };
        there.peek().is_some() && (model.scene.symmetry > 1 || is_axis || !there.any(is_clamped))
    }
}

/// Conditions at the nodes that decide whether a facet can lie on a plane of symmetry.
pub struct Conditions {
    /// For each node, whether forces, pressures or tractions act on it.
    loaded: Vec<bool>,
    /// For each node, whether it occurs in an equation.
    in_equation: Vec<bool>,
    /// Number of nodes that have each free freedom: nodes of a surface held plane share one.
    n_owners: Vec<u32>,
}

impl Conditions {
    /// Collects the conditions of a model.
    pub fn of(model: &Model) -> Self {
        let n_nodes = model.mesh.n_nodes();
        let marked = |sets: &mut dyn Iterator<Item = &String>| {
            let mut out = vec![false; n_nodes];
            for node in sets.flat_map(|on| model.mesh.set_nodes(on)).flatten() {
                out[node] = true;
            }
            out
        };
        let is_force = |load: &&Load| match load.action() {
            Some(LoadAction::OnNodes(action)) => match action {
                NodeAction::Displacement(_) | NodeAction::Relative(_) => false,
                NodeAction::PlaneForce(_) => false,
                NodeAction::Force(_) | NodeAction::Pressure(_) => true,
                NodeAction::Traction(_) | NodeAction::Kirsch(_) | NodeAction::Gap(_) => true,
            },
            Some(LoadAction::OnVolume(_)) | None => false,
        };
        let scene = &model.scene;
        let mut n_owners = vec![0; model.freedoms.n];
        for slots in &model.freedoms.slots {
            for slot in slots {
                if let Slot::Free(freedom) = slot {
                    n_owners[*freedom as usize] += 1;
                }
            }
        }
        let relative = scene.load.iter().filter(|load| load.relative.is_some());
        let in_equations = scene.equation_terms().map(|term| &term.on);
        Conditions {
            loaded: marked(&mut scene.load.iter().filter(is_force).map(|load| &load.on)),
            in_equation: marked(&mut in_equations.chain(relative.map(|load| &load.on))),
            n_owners,
        }
    }

    /// Whether the displacement of a slot is zero.
    fn is_held(model: &Model, slot: Slot) -> bool {
        match slot {
            Slot::Fixed => true,
            Slot::Prescribed(p) => model.freedoms.prescribed[p as usize].value == 0.0,
            Slot::Free(_) | Slot::Sum(_) => false,
        }
    }

    /// Slot in the direction `along` of a node; `None` if the direction is not one of its axes.
    fn slot(model: &Model, node: usize, along: Vector) -> Option<Slot> {
        let axes = model.freedoms.local(node);
        let slots = model.freedoms.of_node(node);
        let at = (0..slots.len()).find(|&i| length_of(cross(axes[i], along)) < SAME)?;
        Some(slots[at])
    }

    /// Whether something keeps a slot from moving freely.
    fn is_bound(&self, slot: Slot) -> bool {
        match slot {
            Slot::Free(freedom) => self.n_owners[freedom as usize] > 1,
            Slot::Fixed | Slot::Prescribed(_) | Slot::Sum(_) => true,
        }
    }

    /// Whether something pushes a node or keeps it from moving freely.
    fn act_on(&self, model: &Model, node: usize) -> bool {
        let mut slots = model.freedoms.of_node(node).iter();
        self.loaded[node] || slots.any(|slot| self.is_bound(*slot))
    }

    /// Whether a node does not move in a direction, which must lie in the span of the node's held
    /// axes: several axes are held where planes meet at an angle.
    fn hold_node(model: &Model, node: usize, direction: Vector) -> bool {
        let slots = model.freedoms.of_node(node).iter();
        let axes = slots.zip(model.freedoms.local(node));
        let held = axes.filter(|(slot, _)| Self::is_held(model, **slot));
        let left = held.fold(direction, |left, (_, axis)| {
            along(left, -dot(left, axis), axis)
        });
        length_of(left) < SAME
    }

    /// Whether all nodes of a side are held along its normal.
    fn hold(model: &Model, side: &MirrorSide, normal: Vector) -> bool {
        let mut nodes = side.nodes.iter();
        nodes.all(|&node| Self::hold_node(model, node, normal))
    }

    /// Whether two sides that are held across their planes keep a node from moving along an axis.
    fn hold_between(model: &Model, normal: Vector, other: &MirrorSide, axis: Vector) -> bool {
        let plane = |mirror: &Mirror| cross(normal, mirror.normal);
        other.mirror.as_ref().is_some_and(|mirror| {
            length_of(plane(mirror)) > SAME
                && dot(plane(mirror), axis).abs() < SAME
                && Self::hold(model, other, mirror.normal)
        })
    }

    /// Whether the condition of a slot along an axis holds on the whole side: all nodes of the side
    /// are tied, or the axis is normal to the side and all nodes of the side are held along it or
    /// share one freedom.
    fn go_on(&self, model: &Model, side: &MirrorSide, slot: Slot, axis: Vector) -> bool {
        let is_tied = matches!(slot, Slot::Sum(_));
        let is_held = Self::is_held(model, slot);
        let alike = |other: Slot| {
            other == slot
                || (is_held && Self::is_held(model, other))
                || (is_tied && matches!(other, Slot::Sum(_)))
        };
        (is_tied || side.is_across(axis))
            && (side.nodes.iter()).all(|&n| Self::slot(model, n, axis).is_some_and(alike))
    }
}

/// Planes of symmetry on which elements have a facet. All facets of the elements on a plane must be
/// symmetric: the stress continues as its mirror image only if every condition there does.
pub fn mirrors(model: &Model, conditions: &Conditions, elements: &[usize]) -> Vec<Mirror> {
    held_planes(model, conditions, elements, |facets| {
        facets.iter().all(|is| *is)
    })
}

/// Planes at which a model may be cut because it is symmetric about them: all facets on the plane
/// are held along its normal, and one of them at least is symmetric. Others may be at supports and
/// loads that act elsewhere, too.
pub(super) fn cuts(model: &Model, conditions: &Conditions, elements: &[usize]) -> Vec<Mirror> {
    held_planes(model, conditions, elements, |facets| facets.contains(&true))
}

/// Planes on which all facets of the elements are held along the normal, and for which `is_kept`
/// accepts which of these facets are symmetric.
fn held_planes(
    model: &Model,
    conditions: &Conditions,
    elements: &[usize],
    is_kept: impl Fn(&[bool]) -> bool,
) -> Vec<Mirror> {
    let sides = ActingSides::of(model, conditions, elements);
    let planes = || {
        let sides = sides.0.iter();
        sides.filter_map(|side| side.mirror.map(|mirror| (side, mirror)))
    };
    let same = |a: &Mirror, b: &Mirror, length: f64| {
        (a.offset - b.offset).abs() <= SAME * length
            && dot(a.normal, b.normal) > 0.0
            && length_of(cross(a.normal, b.normal)) < SAME
    };
    // Few facets are held, since most facets of the elements are inside the body.
    let mut out: Vec<Mirror> = Vec::new();
    for (side, mirror) in planes() {
        if Conditions::hold(model, side, mirror.normal)
            && !out.iter().any(|other| same(other, &mirror, side.length))
        {
            out.push(mirror);
        }
    }
    out.retain(|mirror| {
        let on_it = || planes().filter(|(side, other)| same(mirror, other, side.length));
        let is_symmetric = |(side, own): (&MirrorSide, Mirror)| {
            sides.are_symmetric(side, own.normal, model, conditions)
        };
        on_it().all(|(side, own)| Conditions::hold(model, side, own.normal))
            && is_kept(&on_it().map(is_symmetric).collect::<Vec<bool>>())
    });
    out
}

/// Numbers of the bodies that take part in a contact.
fn bodies_at(model: &Model, contact: &ContactSurface) -> BTreeSet<u32> {
    let mut in_contact = vec![false; model.mesh.n_nodes()];
    let pairs = &model.pairs[contact.range.clone()];
    pairs
        .iter()
        .flat_map(Pair::nodes)
        .for_each(|node| in_contact[node] = true);
    let touches = |element: &usize| {
        let mut own = model.mesh.nodes(*element).iter();
        own.any(|node| in_contact[*node as usize])
    };
    let is_meshed = |element: &usize| {
        let mut own = model.mesh.nodes(*element).iter();
        !own.any(|node| model.freedoms.is_rigid(*node as usize))
    };
    let elements = (0..model.mesh.n_elements()).filter(touches);
    let bodies = elements
        .filter(is_meshed)
        .map(|element| model.mesh.element_body[element]);
    bodies.collect()
}

/// Facet of an element that may lie on a plane of symmetry.
struct MirrorSide {
    nodes: Vec<usize>,
    /// Plane in which the facet lies; `None` if the facet is curved.
    mirror: Option<Mirror>,
    length: f64,
}

impl MirrorSide {
    fn of(model: &Model, facet: Facet) -> Self {
        let mesh = &model.mesh;
        let reference = mesh.facet_reference(facet);
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        let points: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n)).collect();
        let length = length_of(difference(points[1], points[0]));
        let at_corner = (reference.functions)(reference.nodes[0]);
        let normal = direction(reference.area(&at_corner, &points));
        let mirror = Mirror {
            normal,
            offset: dot(normal, points[0]),
        };
        let mut off = points.iter().map(|&x| mirror.beyond(x).abs());
        MirrorSide {
            nodes,
            mirror: off.all(|off| off <= SAME * length).then_some(mirror),
            length,
        }
    }

    /// Whether the side lies in a plane with the given normal.
    fn is_across(&self, normal: Vector) -> bool {
        let across = |mirror: &Mirror| length_of(cross(mirror.normal, normal)) < SAME;
        self.mirror.as_ref().is_some_and(across)
    }
}

/// Facets of some elements on which a support or load acts.
struct ActingSides(Vec<MirrorSide>);

impl ActingSides {
    fn of(model: &Model, conditions: &Conditions, elements: &[usize]) -> Self {
        let of_element = |&element: &usize| {
            let facets = (0..model.mesh.shapes[element].n_facets())
                .map(move |local| Facet { element, local });
            let acted_on = |facet: &Facet| {
                let mut nodes = model.mesh.facet_nodes(*facet);
                nodes.any(|node| conditions.act_on(model, node))
            };
            facets
                .filter(acted_on)
                .map(|facet| MirrorSide::of(model, facet))
        };
        ActingSides(elements.iter().flat_map(of_element).collect())
    }

    /// Whether the conditions along a side are those of a plane of symmetry: its nodes move freely
    /// along it and nothing pushes them. At its rim another surface may be loaded, tied, or held or
    /// kept plane in the direction of its own normal, since such a condition continues beyond the
    /// plane of symmetry.
    fn are_symmetric(
        &self,
        side: &MirrorSide,
        normal: Vector,
        model: &Model,
        conditions: &Conditions,
    ) -> bool {
        side.nodes.iter().all(|&node| {
            let at_rim = |of: &dyn Fn(&MirrorSide) -> bool| {
                let others = self.0.iter().filter(|other| other.nodes.contains(&node));
                let mut others = others.filter(|other| !other.is_across(normal));
                others.any(of)
            };
            let is_loaded = |other: &MirrorSide| other.nodes.iter().all(|&n| conditions.loaded[n]);
            if conditions.in_equation[node] || (conditions.loaded[node] && !at_rim(&is_loaded)) {
                return false;
            }
            let slots = model.freedoms.of_node(node).iter();
            let mut axes = slots.zip(model.freedoms.local(node));
            axes.all(|(&slot, axis)| {
                let is_along = length_of(cross(axis, normal)) > SAME;
                !is_along
                    || !conditions.is_bound(slot)
                    || at_rim(&|other| {
                        conditions.go_on(model, other, slot, axis)
                            || Conditions::hold_between(model, normal, other, axis)
                    })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Number of planes of symmetry of a block held across its left and bottom sides, with a load.
    fn n_mirrors(load: &str) -> usize {
        let text = format!(
            r#"
            kind = "plane_strain"
            load = [{load}]
            support = [{{ on = "block.left", fix = ["x"] }}, {{ on = "block.bottom", fix = ["y"] }}]
            [[mesh.parts]]
            body = "block"
            block = {{ x = [0.0, 1.0], y = [0.0, 1.0], elements = [3, 3] }}
            [materials.m]
            youngs_modulus = 1000.0
            poissons_ratio = 0.3
            [bodies.block]
            material = "m"
            [program]
            targets = [{{ load_factor = 1.0 }}]
            "#
        );
        let model = Model::new(&Scene::parse(&text, "test").unwrap()).unwrap();
        let all: Vec<usize> = (0..model.mesh.n_elements()).collect();
        mirrors(&model, &Conditions::of(&model), &all).len()
    }

    /// A load on the whole top continues beyond the plane at its rim; a load on the corner does
    /// not.
    #[test]
    fn a_load_at_the_rim_goes_on_where_all_of_a_side_bears_it() {
        assert_eq!(n_mirrors(r#"{ on = "block.top", pressure = 1.0 }"#), 2);
        let corner = r#"{ on = "block.top_left", force = [0.0, -1.0] }"#;
        assert_eq!(n_mirrors(corner), 1);
    }
}
