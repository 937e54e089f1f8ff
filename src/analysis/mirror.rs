//! Planes of symmetry that bound a body: there the stress goes on as its own mirror image.
//!
//! Along a straight boundary whose nodes are held across it and free along it (the axis of
//! revolution is one), the body goes on as if mirrored. A fit of the stress from one side alone
//! would leave out what is known of the other side, and would put a maximum that lies on the plane
//! beside it.

use crate::mesh::Facet;
use crate::model::{Model, Slot};

/// Sine of the angle up to which directions, and share of a facet's length up to which places, are
/// the same.
const SAME: f64 = 1e-9;

/// A plane `normal . x = offset`; the body lies where `normal . x` is smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mirror {
    normal: [f64; 2],
    offset: f64,
}

/// The reflection `1 - 2 n n'`, by its entries xx, xy, yy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection([f64; 3]);

impl Mirror {
    /// The mirror image of a point.
    pub fn image(&self, x: [f64; 2]) -> [f64; 2] {
        let twice = -2.0 * self.beyond(x);
        [x[0] + twice * self.normal[0], x[1] + twice * self.normal[1]]
    }

    /// How stresses are reflected.
    pub fn reflection(&self) -> Reflection {
        let [x, y] = self.normal;
        Reflection([1.0 - 2.0 * x * x, -2.0 * x * y, 1.0 - 2.0 * y * y])
    }

    /// Whether two planes are at right angles: images in both then have the stress of the original.
    pub fn is_normal_to(&self, other: &Mirror) -> bool {
        let along = self.normal[0] * other.normal[0] + self.normal[1] * other.normal[1];
        along.abs() < SAME
    }

    /// Distance of a point beyond the plane.
    pub fn beyond(&self, x: [f64; 2]) -> f64 {
        self.normal[0] * x[0] + self.normal[1] * x[1] - self.offset
    }
}

impl Reflection {
    /// The reflected stress `[xx, yy, zz, xy]`: `R sigma R`.
    pub fn of(&self, [xx, yy, zz, xy]: [f64; 4]) -> [f64; 4] {
        let [c, s, d] = self.0;
        [
            c * c * xx + 2.0 * c * s * xy + s * s * yy,
            s * s * xx + 2.0 * s * d * xy + d * d * yy,
            zz,
            c * s * xx + (c * d + s * s) * xy + s * d * yy,
        ]
    }
}

/// Nodes on which forces, pressures or tractions act: a tangential one is no mirror's.
pub fn loaded_nodes(model: &Model) -> Vec<bool> {
    let mut out = vec![false; model.mesh.n_nodes()];
    let held = |l: &crate::scene::Load| l.displacement.is_some() || l.plane_force.is_some();
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
                let [x, y] = mirror.normal;
                (x * other.normal[1] - y * other.normal[0]).abs() < SAME
                    && x * other.normal[0] + y * other.normal[1] > 0.0
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
    let nodes: Vec<usize> = model.mesh.facet_nodes(facet).collect();
    let [a, b] = [nodes[0], nodes[1]].map(|n| model.mesh.in_plane(n));
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]);
    // The body lies on the left of the facet.
    let normal = [along[1] / length, -along[0] / length];
    let mut free = false;
    for &node in &nodes {
        let [x, y, _] = model.freedoms.local(node)[0];
        let across = |axis: [f64; 2]| (axis[0] * normal[1] - axis[1] * normal[0]).abs() < SAME;
        let held = if across([x, y]) {
            0
        } else if across([-y, x]) {
            1
        } else {
            return None;
        };
        let slots = model.freedoms.slots[node];
        if slots[held] != Slot::Fixed {
            return None;
        }
        free |= matches!(slots[1 - held], Slot::Free(_));
    }
    if !free || nodes.iter().all(|&n| loaded[n]) {
        return None;
    }
    let mirror = Mirror {
        normal,
        offset: normal[0] * a[0] + normal[1] * a[1],
    };
    let curved = nodes
        .iter()
        .any(|&n| mirror.beyond(model.mesh.in_plane(n)).abs() > SAME * length);
    (!curved).then_some((mirror, length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_turns_points_and_shear_round() {
        let mirror = Mirror {
            normal: [-1.0, 0.0],
            offset: 0.0,
        };
        assert_eq!(mirror.image([2.0, 3.0]), [-2.0, 3.0]);
        let stress = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(mirror.reflection().of(stress), [1.0, 2.0, 3.0, -4.0]);
        // Across the diagonal x and y change places, and shear keeps its sign.
        let half = 0.5f64.sqrt();
        let diagonal = Mirror {
            normal: [half, -half],
            offset: 0.0,
        };
        let [x, y] = diagonal.image([2.0, 3.0]);
        assert!((x - 3.0).abs() + (y - 2.0).abs() < 1e-15);
        let turned = diagonal.reflection().of(stress);
        for (found, expected) in turned.iter().zip([2.0, 1.0, 3.0, 4.0]) {
            assert!((found - expected).abs() < 1e-14, "{turned:?}");
        }
    }
}
