//! Planes of symmetry that bound a body: there the stress goes on as its own mirror image.
//!
//! Along a straight boundary whose nodes are held across it and free along it (the axis of
//! revolution is one), the body goes on as if mirrored. A fit of the stress from one side alone
//! would leave out what is known of the other side, and would put a maximum that lies on the plane
//! beside it.

use crate::mesh::Facet;
use crate::model::{Model, Slot};
use crate::space::{Vector, along, cross, difference, direction, dot, length as length_of};

/// Sine of the angle up to which directions, and share of a facet's length up to which places, are
/// the same.
const SAME: f64 = 1e-9;
/// Share of a pair's size up to which it lies on a plane.
const ON_PLANE: f64 = 1e-6;

/// A plane `normal . x = offset`; the body lies where `normal . x` is smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mirror {
    normal: Vector,
    offset: f64,
}

/// One reflection or several after one another: the orthogonal matrix, row by row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection([Vector; 3]);

impl Mirror {
    /// The planes that pairs of solids lie on: both nodes of some pair are held across them. First
    /// those at right angles to one another, then those opposite to one of these: between the two
    /// the contact goes on without end.
    pub fn of_pairs(
        model: &Model,
        pairs: impl Iterator<Item = usize>,
    ) -> (Vec<Mirror>, Vec<Mirror>) {
        let (mut out, mut opposite): (Vec<Mirror>, Vec<Mirror>) = (Vec::new(), Vec::new());
        for k in pairs {
            let pair = &model.pairs[k];
            let held = |node: usize| {
                let slots = model.freedoms.slots[node];
                let axes = model.freedoms.local(node);
                (1..3)
                    .filter(move |&i| slots[i] == Slot::Fixed)
                    .map(move |i| axes[i])
            };
            for normal in held(pair.faced().unwrap_or(pair.slave)) {
                let x = model.mesh.point(pair.slave);
                let mirror = Mirror {
                    normal,
                    offset: dot(normal, x),
                };
                let is_parallel = |other: Vector| length_of(cross(normal, other)) < SAME;
                if !held(pair.slave).any(is_parallel) {
                    continue;
                }
                // Mirror images of mirror images agree for planes at right angles.
                if out.iter().all(|other| mirror.is_normal_to(other)) {
                    out.push(mirror);
                }
                // Round-off of places on one plane is far below the size of a pair's share.
                let size = pair.area.sqrt();
                let apart = |other: &Mirror| other.beyond(x).abs() > ON_PLANE * size;
                let mut parallel = out.iter().filter(|other| is_parallel(other.normal));
                if parallel.any(apart) && opposite.iter().all(|other| mirror.is_normal_to(other)) {
                    opposite.push(mirror);
                }
            }
        }
        (out, opposite)
    }

    /// The unit vector across it.
    pub fn normal(&self) -> Vector {
        self.normal
    }

    /// The mirror image of a point.
    pub fn image(&self, x: Vector) -> Vector {
        along(x, -2.0 * self.beyond(x), self.normal)
    }

    /// How stresses are reflected: `1 - 2 n n'`.
    pub fn reflection(&self) -> Reflection {
        let n = self.normal;
        let entry = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * n[i] * n[j];
        Reflection([0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))))
    }

    /// Whether two planes are at right angles.
    pub fn is_normal_to(&self, other: &Mirror) -> bool {
        dot(self.normal, other.normal).abs() < SAME
    }

    /// Distance of a point beyond the plane.
    pub fn beyond(&self, x: Vector) -> f64 {
        dot(self.normal, x) - self.offset
    }
}

impl Reflection {
    /// This one after another.
    pub fn after(&self, other: &Reflection) -> Reflection {
        Reflection(self.0.map(|row| {
            let terms = row.iter().zip(&other.0);
            terms.fold([0.0; 3], |sum, (share, row)| along(sum, *share, *row))
        }))
    }

    /// The reflected stress `[xx, yy, zz, xy | yz, zx]`: `R sigma R'`.
    pub fn of<const S: usize>(&self, stress: [f64; S]) -> [f64; S] {
        let shear = |k: usize| stress.get(k).copied().unwrap_or(0.0);
        let tensor = [
            [stress[0], stress[3], shear(5)],
            [stress[3], stress[1], shear(4)],
            [shear(5), shear(4), stress[2]],
        ];
        let reflected =
            |i: usize, j: usize| -> f64 { dot(self.0[i], tensor.map(|row| dot(row, self.0[j]))) };
        const AXES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];
        std::array::from_fn(|k| reflected(AXES[k][0], AXES[k][1]))
    }
}

/// Nodes on which forces, pressures or tractions act: a tangential one is no mirror's.
pub fn loaded_nodes(model: &Model) -> Vec<bool> {
    let mut out = vec![false; model.mesh.n_nodes()];
    let held = |l: &crate::scene::Load| {
        l.acts_on_volume() || l.displacement.is_some() || l.plane_force.is_some()
    };
    for load in model.scene.load.iter().filter(|l| !held(l)) {
        for node in model.mesh.set_nodes(&load.on).into_iter().flatten() {
            out[node] = true;
        }
    }
    out
}

/// The planes of symmetry on which elements have a facet. `loaded` are [`loaded_nodes`].
pub fn mirrors(model: &Model, loaded: &[bool], elements: &[usize]) -> Vec<Mirror> {
    let mut out: Vec<Mirror> = Vec::new();
    for &element in elements {
        for local in 0..model.mesh.shapes[element].n_facets() {
            let Some((mirror, length)) = mirror_on(model, loaded, Facet { element, local }) else {
                continue;
            };
            let same = |other: &Mirror| {
                length_of(cross(mirror.normal, other.normal)) < SAME
                    && dot(mirror.normal, other.normal) > 0.0
                    && (mirror.offset - other.offset).abs() <= SAME * length
            };
            if !out.iter().any(same) {
                out.push(mirror);
            }
        }
    }
    out
}

/// The plane of a facet that is held across and free along it, and the facet's length.
fn mirror_on(model: &Model, loaded: &[bool], facet: Facet) -> Option<(Mirror, f64)> {
    let mesh = &model.mesh;
    let reference = mesh.facet_reference(facet);
    let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
    let points: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n)).collect();
    let length = length_of(difference(points[1], points[0]));
    let at_corner = (reference.functions)(reference.nodes[0]);
    let normal = direction(reference.area(&at_corner, &points));
    let mut free = false;
    for &node in &nodes {
        let axes = model.freedoms.local(node);
        let slots = model.freedoms.of_node(node);
        let across = |i: &usize| length_of(cross(axes[*i], normal)) < SAME;
        let held = (0..slots.len()).find(across)?;
        if slots[held] != Slot::Fixed {
            return None;
        }
        free |= slots.iter().any(|slot| matches!(slot, Slot::Free(_)));
    }
    if !free || nodes.iter().all(|&n| loaded[n]) {
        return None;
    }
    let mirror = Mirror {
        normal,
        offset: dot(normal, points[0]),
    };
    let curved = points
        .iter()
        .any(|&x| mirror.beyond(x).abs() > SAME * length);
    (!curved).then_some((mirror, length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_turns_points_and_shear_round() {
        let mirror = Mirror {
            normal: [-1.0, 0.0, 0.0],
            offset: 0.0,
        };
        assert_eq!(mirror.image([2.0, 3.0, 0.0]), [-2.0, 3.0, 0.0]);
        let stress = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(mirror.reflection().of(stress), [1.0, 2.0, 3.0, -4.0]);
        // Across the diagonal x and y change places, and shear keeps its sign.
        let half = 0.5f64.sqrt();
        let diagonal = Mirror {
            normal: [half, -half, 0.0],
            offset: 0.0,
        };
        let [x, y, _] = diagonal.image([2.0, 3.0, 0.0]);
        assert!((x - 3.0).abs() + (y - 2.0).abs() < 1e-15);
        let turned = diagonal.reflection().of(stress);
        for (found, expected) in turned.iter().zip([2.0, 1.0, 3.0, 4.0]) {
            assert!((found - expected).abs() < 1e-14, "{turned:?}");
        }
        // In space, twice: across x and z together zx keeps its sign, the other shears do not.
        let across_z = Mirror {
            normal: [0.0, 0.0, 1.0],
            offset: 0.5,
        };
        assert_eq!(across_z.image([1.0, 2.0, 3.0]), [1.0, 2.0, -2.0]);
        let both = across_z.reflection().after(&mirror.reflection());
        let stress = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(both.of(stress), [1.0, 2.0, 3.0, -4.0, -5.0, 6.0]);
    }
}
