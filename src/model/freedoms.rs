//! Freedoms: two per node, in local axes where a contact normal or a turned support asks for it.

use super::Pair;
use super::names::Entry;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Direction, Scene};

/// What stands in one of a node's two directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// A free freedom with its number. Nodes held plane share one.
    Free(u32),
    /// Held at zero.
    Fixed,
    /// Held at a prescribed displacement, see [`Freedoms::prescribed`].
    Prescribed(u32),
}

/// A prescribed displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prescribed {
    /// Index of the load whose factor scales it.
    pub load: usize,
    /// Value at factor 1.
    pub value: f64,
}

/// Numbering of the freedoms and the local axes they stand for: `u = u_0 a_0 + u_1 a_1` with `a_1` a quarter
/// turn counter-clockwise from `a_0`.
#[derive(Debug, Clone, Default)]
pub struct Freedoms {
    /// Number of free freedoms.
    pub n: usize,
    /// The two slots of each node.
    pub slots: Vec<[Slot; 2]>,
    /// First local axis of each node.
    pub axes: Vec<[f64; 2]>,
    /// Prescribed displacements.
    pub prescribed: Vec<Prescribed>,
    /// A node and local direction for each free freedom, for messages.
    pub owners: Vec<(u32, u8)>,
}

/// How far (sine of an angle) a support's direction may be off a contact's axes before it is an error.
const ALIGNED: f64 = 1e-6;
/// A support within 30 degrees of a contact's tangent is meant to lie in it: the normal of the discretised surface
/// is then turned into the symmetry plane.
const NEARLY_TANGENT: f64 = 0.5;

impl Freedoms {
    /// Numbers the freedoms of a scene. Contact normals on symmetry planes are turned into the plane
    /// (`pairs` is updated).
    ///
    /// # Errors
    /// Input errors: a support in the direction of a contact normal, turned supports that disagree,
    /// a prescribed displacement on a held freedom, a plane surface that is not free to move.
    pub fn new(scene: &Scene, mesh: &Mesh, pairs: &mut [Pair]) -> Result<Self> {
        let n_nodes = mesh.n_nodes();
        let mut contact_of = vec![None; n_nodes];
        for (k, pair) in pairs.iter().enumerate() {
            contact_of[pair.first] = Some(k);
            contact_of[pair.second] = Some(k);
        }
        let supports = Supports::resolve(scene, mesh)?;
        turn_normals_into_supports(pairs, &supports);
        let mut axes = vec![[1.0, 0.0]; n_nodes];
        for pair in pairs.iter() {
            axes[pair.first] = pair.normal;
            axes[pair.second] = pair.normal;
        }
        let mut slots = vec![[Slot::Free(0); 2]; n_nodes];
        for held in &supports.held {
            let node = held.node;
            if contact_of[node].is_none() && !is_aligned(axes[node], held.direction) {
                if slots[node].contains(&Slot::Fixed) {
                    return Err(held.refused(
                        scene,
                        format!(
                            "node {} is held in directions that are not at right angles; the last is {}",
                            mesh.node_label(node),
                            held.by(scene)
                        ),
                    ));
                }
                axes[node] = held.direction;
            }
            let along = dot(axes[node], held.direction).abs();
            if contact_of[node].is_some() && along > ALIGNED {
                return Err(held.refused(
                    scene,
                    format!(
                        "node {} belongs to a contact surface and {} acts along its contact normal ({}, {}): \
                         contact and support cannot hold the same freedom; {}",
                        mesh.node_label(node),
                        held.by(scene),
                        axes[node][0],
                        axes[node][1],
                        match held.support {
                            Some(_) => "take the node out of one of the two sets",
                            None => "give the contact a `normal` along the axis",
                        }
                    ),
                ));
            }
            slots[node][usize::from(along < 0.5)] = Slot::Fixed;
        }
        let mut freedoms = Freedoms {
            n: 0,
            slots,
            axes,
            prescribed: Vec::new(),
            owners: Vec::new(),
        };
        let ties = freedoms.apply_loads(scene, mesh, &contact_of)?;
        freedoms.number(&ties);
        Ok(freedoms)
    }

    /// Prescribed displacements become slots; surfaces held plane become ties (group of each node and direction).
    fn apply_loads(
        &mut self,
        scene: &Scene,
        mesh: &Mesh,
        contact_of: &[Option<usize>],
    ) -> Result<Ties> {
        let mut ties = Ties::new();
        for (index, load) in scene.load.iter().enumerate() {
            let directions: Vec<(usize, Option<f64>)> = if let Some(d) = load.displacement {
                [d.x, d.y]
                    .into_iter()
                    .enumerate()
                    .filter_map(|(i, v)| v.map(|v| (i, Some(v))))
                    .collect()
            } else if let Some(plane) = load.plane_force {
                vec![(axis(plane.direction), None)]
            } else {
                continue;
            };
            let entry = Entry::of_list(scene, "load", index);
            for node in entry.nodes(mesh, &load.on)? {
                let refused = |why: String| {
                    entry.refused(Error::input(format!(
                        "load {} on `{}`: node {} {why}",
                        index + 1,
                        load.on,
                        mesh.node_label(node)
                    )))
                };
                let touches = contact_of[node].is_some();
                for &(direction, value) in &directions {
                    let name = ["x", "y"][direction];
                    let local = self.local_axis(node, direction).ok_or_else(|| {
                        let has = match touches {
                            true => "a contact normal",
                            false => "a turned support",
                        };
                        refused(format!("has {has} and cannot be moved along {name}"))
                    })?;
                    let sign = dot(self.local(node)[local], unit(direction)).signum();
                    if self.slots[node][local] != Slot::Free(0) || ties.contains_key(&(node, local))
                    {
                        return Err(refused(format!(
                            "is already held or prescribed along {name}"
                        )));
                    }
                    match value {
                        Some(value) => {
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
                            ties.insert((node, local), index);
                        }
                    }
                }
            }
        }
        Ok(ties)
    }

    fn number(&mut self, ties: &Ties) {
        let mut group_freedom = std::collections::BTreeMap::new();
        for node in 0..self.slots.len() {
            for local in 0..2 {
                if !matches!(self.slots[node][local], Slot::Free(_)) {
                    continue;
                }
                let next = self.n as u32;
                let freedom = match ties.get(&(node, local)) {
                    Some(&group) => *group_freedom.entry(group).or_insert(next),
                    None => next,
                };
                if freedom == next {
                    self.owners.push((node as u32, local as u8));
                    self.n += 1;
                }
                self.slots[node][local] = Slot::Free(freedom);
            }
        }
    }

    /// Holds a freedom at zero and renumbers.
    pub(super) fn pin(&mut self, freedom: usize) {
        for slots in &mut self.slots {
            for slot in slots {
                if let Slot::Free(f) = *slot {
                    *slot = match (f as usize).cmp(&freedom) {
                        std::cmp::Ordering::Less => continue,
                        std::cmp::Ordering::Equal => Slot::Fixed,
                        std::cmp::Ordering::Greater => Slot::Free(f - 1),
                    };
                }
            }
        }
        self.owners.remove(freedom);
        self.n -= 1;
    }

    /// The two local axes of a node.
    pub fn local(&self, node: usize) -> [[f64; 2]; 2] {
        let a = self.axes[node];
        [a, [-a[1], a[0]]]
    }

    /// A vector at a node, given in global axes, in the local ones.
    pub fn to_local(&self, node: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        self.local(node).map(|axis| axis[0] * x + axis[1] * y)
    }

    /// Which local axis lies along a global direction (either sense), if one does.
    pub fn local_axis(&self, node: usize, direction: usize) -> Option<usize> {
        let axes = self.local(node);
        (0..2).find(|&i| dot(axes[i], unit(direction)).abs() > 1.0 - ALIGNED)
    }

    /// Displacement of a node in global axes, from free freedoms and load factors.
    pub fn displacement(&self, node: usize, u: &[f64], factors: &[f64]) -> [f64; 2] {
        let axes = self.local(node);
        let mut out = [0.0; 2];
        for local in 0..2 {
            let value = self.value(self.slots[node][local], u, factors);
            out[0] += value * axes[local][0];
            out[1] += value * axes[local][1];
        }
        out
    }

    /// Value of a slot.
    pub fn value(&self, slot: Slot, u: &[f64], factors: &[f64]) -> f64 {
        match slot {
            Slot::Free(f) => u[f as usize],
            Slot::Fixed => 0.0,
            Slot::Prescribed(p) => {
                let p = self.prescribed[p as usize];
                factors[p.load] * p.value
            }
        }
    }

    /// The free freedom of a node's contact normal (its first local axis).
    pub fn normal_freedom(&self, node: usize) -> Option<usize> {
        match self.slots[node][0] {
            Slot::Free(f) => Some(f as usize),
            _ => None,
        }
    }

    /// Names a freedom for messages: body, node and direction.
    pub fn describe(&self, mesh: &Mesh, freedom: usize) -> String {
        let Some(&(node, local)) = self.owners.get(freedom) else {
            return format!("freedom {freedom}");
        };
        let axis = self.local(node as usize)[local as usize];
        let body = (0..mesh.n_elements())
            .find(|&e| mesh.nodes(e).contains(&node))
            .map_or("?", |e| mesh.bodies[mesh.element_body[e] as usize].as_str());
        format!(
            "body `{body}`, node {}, direction ({:.3}, {:.3})",
            mesh.node_label(node as usize),
            axis[0],
            axis[1]
        )
    }
}

/// Group (load index) of each tied node and local direction.
type Ties = std::collections::BTreeMap<(usize, usize), usize>;

struct Held {
    node: usize,
    direction: [f64; 2],
    /// Index of the support; `None` on the axis of revolution, which holds by itself.
    support: Option<usize>,
}

impl Held {
    /// What holds the node.
    fn by(&self, scene: &Scene) -> String {
        match self.support {
            Some(index) => format!("support {} on `{}`", index + 1, scene.support[index].on),
            None => "the axis of revolution".to_string(),
        }
    }

    fn refused(&self, scene: &Scene, why: String) -> Error {
        match self.support {
            Some(index) => Entry::of_list(scene, "support", index).refused(Error::input(why)),
            None => Error::input(why),
        }
    }
}

struct Supports {
    held: Vec<Held>,
}

impl Supports {
    fn resolve(scene: &Scene, mesh: &Mesh) -> Result<Self> {
        let mut held = Vec::new();
        for (support, entry) in scene.support.iter().enumerate() {
            let (sin, cos) = entry.angle.unwrap_or(0.0).to_radians().sin_cos();
            for node in Entry::of_list(scene, "support", support).nodes(mesh, &entry.on)? {
                for &d in &entry.fix {
                    let direction = match (entry.angle, d) {
                        (None, d) => unit(axis(d)),
                        (Some(_), Direction::X) => [cos, sin],
                        (Some(_), Direction::Y) => [-sin, cos],
                    };
                    held.push(Held {
                        node,
                        direction,
                        support: Some(support),
                    });
                }
            }
        }
        if scene.kind.is_axisymmetric() {
            // On the axis of revolution the radial displacement vanishes whether or not the scene says so.
            let radius = (0..mesh.n_nodes())
                .map(|i| mesh.point(i)[0])
                .fold(0.0, f64::max);
            held.extend(
                (0..mesh.n_nodes())
                    .filter(|&i| mesh.point(i)[0] <= 1e-12 * radius)
                    .map(|node| Held {
                        node,
                        direction: [1.0, 0.0],
                        support: None,
                    }),
            );
        }
        Ok(Supports { held })
    }
}

fn turn_normals_into_supports(pairs: &mut [Pair], supports: &Supports) {
    let mut directions = std::collections::BTreeMap::new();
    for held in &supports.held {
        directions
            .entry(held.node)
            .or_insert_with(Vec::new)
            .push(held.direction);
    }
    for pair in pairs {
        for node in [pair.first, pair.second] {
            for &d in directions.get(&node).into_iter().flatten() {
                let off = dot(pair.normal, d);
                if off != 0.0 && off.abs() < NEARLY_TANGENT {
                    let n = [pair.normal[0] - off * d[0], pair.normal[1] - off * d[1]];
                    let length = n[0].hypot(n[1]);
                    pair.normal = [n[0] / length, n[1] / length];
                }
            }
        }
    }
}

fn is_aligned(axis: [f64; 2], direction: [f64; 2]) -> bool {
    let along = dot(axis, direction).abs();
    !(ALIGNED..=1.0 - ALIGNED).contains(&along)
}

fn axis(direction: Direction) -> usize {
    match direction {
        Direction::X => 0,
        Direction::Y => 1,
    }
}

fn unit(direction: usize) -> [f64; 2] {
    if direction == 0 {
        [1.0, 0.0]
    } else {
        [0.0, 1.0]
    }
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
