//! Nodes of slave surfaces that are moved onto the master surface (`ADJUST` of `*CONTACT PAIR`).
//!
//! Slave nodes within a given distance of the master surface and those inside the other body, or
//! the nodes of a given set, move to the nearest point of the master surface. Faces are divided
//! into triangles; edges in the plane are straight.

use super::Deck;
use super::data::{Adjust, ContactPair, EntitySelection};
use super::facets::Face;
use super::mesh::DeckMesh;
use super::sets::{Lookup, What};
use crate::balls::Balls;
use crate::number::exact;
use crate::space::{Vector, along, cross, difference, dot, length};

/// Relative error of a coordinate of a deck, which a rotation may have rounded.
const ROUND_OFF: f64 = 256.0 * f64::EPSILON;

/// Whether a contact has an interference: a negative clearance, or slave nodes behind the master
/// surface.
pub(super) fn any_interference(deck: &Deck) -> bool {
    let (properties, mesh) = (&deck.properties, &deck.mesh);
    let is_behind = |pair: &ContactPair| {
        let Some((slaves, master)) = slaves_and_master(deck.lookup(), pair) else {
            return false;
        };
        slaves.iter().any(|&node| {
            let x = mesh.point(node as usize);
            let (target, outward) = master.nearest(x);
            // Nodes that touch are behind the surface by the round-off of their coordinates.
            let size = length(x).max(length(target)) * length(outward);
            dot(difference(x, target), outward) < -ROUND_OFF * size
        })
    };
    let clearances = &properties.clearances;
    let mut open = properties.contacts.iter().filter(|pair| !pair.is_closed);
    clearances.iter().any(|clearance| clearance.value < 0.0) || open.any(is_behind)
}

/// The slave nodes and the master surface of a contact pair; `None` if a name is undefined, which
/// is reported when the pair is used.
fn slaves_and_master(lookup: Lookup, pair: &ContactPair) -> Option<(Vec<u32>, SurfacePieces)> {
    let slaves = lookup.slave_nodes(pair).ok()?;
    let master = lookup.surface(&pair.master, (pair.place, "CONTACT PAIR"));
    Some((slaves, SurfacePieces::new(lookup.mesh, &master.ok()?)))
}

/// Moves the slave nodes of all contact pairs with `ADJUST`.
pub(super) fn adjust(deck: &mut Deck) {
    for number in 0..deck.properties.contacts.len() {
        let pair = deck.properties.contacts[number].clone();
        let Some(adjust) = &pair.adjust else { continue };
        let Some((nodes, master)) = slaves_and_master(deck.lookup(), &pair) else {
            continue;
        };
        let at = (pair.place, "CONTACT PAIR");
        let chosen = match adjust {
            Adjust::Within(_) => Ok(nodes.clone()),
            Adjust::Nodes(set) => deck.lookup().indices(What::Nodes, set, at),
        };
        let Ok(chosen) = chosen else { continue };
        let (mut n_moved, mut farthest) = (0, 0.0f64);
        for &node in nodes
            .iter()
            .filter(|node| chosen.binary_search(node).is_ok())
        {
            let x = deck.mesh.point(node as usize);
            let (target, outward) = master.nearest(x);
            let off = difference(x, target);
            let distance = length(off);
            // A node inside the other body moves, however deep it is.
            let is_apart = dot(off, outward) >= 0.0;
            if matches!(adjust, Adjust::Within(most) if is_apart && distance > *most) {
                continue;
            }
            n_moved += 1;
            farthest = farthest.max(distance);
            deck.mesh.nodes.coordinates[3 * node as usize..][..3].copy_from_slice(&target);
        }
        deck.properties.contacts[number].is_closed = n_moved == nodes.len();
        let text = format!(
            "ADJUST={}: {n_moved} of the {} nodes of {} are moved onto {}, by {} at most",
            adjust.written(),
            nodes.len(),
            pair.slave,
            pair.master,
            exact(farthest)
        );
        deck.account
            .take(&deck.files, pair.place, "CONTACT PAIR", &text);
    }
}

impl Adjust {
    fn written(&self) -> String {
        match self {
            Adjust::Within(distance) => exact(*distance).to_string(),
            Adjust::Nodes(EntitySelection::Set(name)) => name.clone(),
            Adjust::Nodes(EntitySelection::Label(label)) => label.to_string(),
            Adjust::Nodes(EntitySelection::All) => "all".to_string(),
        }
    }
}

/// A surface as triangles; in the plane as lines, given as triangles whose last two corners
/// coincide.
pub(super) struct SurfacePieces {
    corners: Vec<[Vector; 3]>,
    around: Balls,
}

impl SurfacePieces {
    pub(super) fn new(mesh: &DeckMesh, faces: &[Face]) -> Self {
        let mut corners = Vec::new();
        for &face in faces {
            let x = mesh.corner_points(face);
            match x[..] {
                [a, b] => corners.push([a, b, b]),
                [a, b, c] => corners.push([a, b, c]),
                [a, b, c, d] => corners.extend([[a, b, c], [a, c, d]]),
                _ => {}
            }
        }
        let ball = |[a, b, c]: &[Vector; 3]| {
            let third = 1.0 / 3.0;
            let center = [0, 1, 2].map(|d| third * (a[d] + b[d] + c[d]));
            let radius = [a, b, c].map(|x| length(difference(*x, center)));
            (center, radius.into_iter().fold(0.0, f64::max))
        };
        let around = Balls::new(corners.iter().map(ball).collect());
        SurfacePieces { corners, around }
    }

    /// The point of the surface nearest to `x`, and a vector out of the body there.
    pub(super) fn nearest(&self, x: Vector) -> (Vector, Vector) {
        let found = std::cell::Cell::new((f64::INFINITY, x, 0));
        self.around.nearest(x, |piece| {
            let point = nearest_on(&self.corners[piece], x);
            let distance = length(difference(point, x));
            if distance < found.get().0 {
                found.set((distance, point, piece));
            }
            distance
        });
        let (_, point, piece) = found.get();
        (point, self.corners.get(piece).map_or([0.0; 3], outward))
    }
}

/// A vector out of the body behind a piece of its surface. Seen from outside, corners run
/// counter-clockwise; a plane body lies on the left of its edges.
fn outward([a, b, c]: &[Vector; 3]) -> Vector {
    let (ab, ac) = (difference(*b, *a), difference(*c, *a));
    match b == c {
        true => [ab[1], -ab[0], 0.0],
        false => cross(ab, ac),
    }
}

/// The point of a triangle that is nearest to the point `x`.
///
/// # Source
/// C. Ericson, *Real-Time Collision Detection* (2005), section 5.1.5.
fn nearest_on([a, b, c]: &[Vector; 3], x: Vector) -> Vector {
    let (ab, ac, ax) = (difference(*b, *a), difference(*c, *a), difference(x, *a));
    let [aa, bb, cc] = [dot(ab, ab), dot(ab, ac), dot(ac, ac)];
    let (d, e) = (dot(ab, ax), dot(ac, ax));
    let determinant = aa * cc - bb * bb;
    let inside = [cc * d - bb * e, aa * e - bb * d];
    if determinant > f64::EPSILON * aa * cc
        && inside.iter().all(|v| *v >= 0.0)
        && inside[0] + inside[1] <= determinant
    {
        let [v, w] = inside.map(|v| v / determinant);
        return along(along(*a, v, ab), w, ac);
    }
    let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let side = difference(*to, *from);
        let square = dot(side, side);
        let t = match square > 0.0 {
            true => (dot(difference(x, *from), side) / square).clamp(0.0, 1.0),
            false => 0.0,
        };
        along(*from, t, side)
    });
    let size = |point: &Vector| length(difference(*point, x));
    let nearest = edges.into_iter().min_by(|p, q| size(p).total_cmp(&size(q)));
    nearest.unwrap_or(*a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_inside_on_an_edge_or_a_corner() {
        let triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        for (x, expected) in [
            ([0.2, 0.3, 0.7], [0.2, 0.3, 0.0]),
            ([0.5, -1.0, 0.1], [0.5, 0.0, 0.0]),
            ([1.0, 1.0, 0.0], [0.5, 0.5, 0.0]),
            ([-1.0, -1.0, 2.0], [0.0; 3]),
        ] {
            let off = length(difference(nearest_on(&triangle, x), expected));
            assert!(off < 1e-15, "{x:?}");
        }
        let line = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(nearest_on(&line, [1.0, 1.0, 0.0]), [1.0, 0.0, 0.0]);
    }
}
