//! Depth below a surface: the distance from its facets, whose curved edges and faces are taken as
//! straight between neighbouring nodes.

use super::pairs::ContactSurface;
use crate::balls::Balls;
use crate::error::{Error, Result};
use crate::mesh::{Facet, Mesh, Surface};
use crate::scene::{Scene, closest};
use crate::space::{Vector, along, cross, difference, dot, length};
use serde::{Deserialize, Serialize};

/// A surface as triangles, or as lines, which are triangles with two equal last corners.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Simplices {
    corners: Vec<[Vector; 3]>,
    balls: Balls,
}

impl Simplices {
    pub(super) fn new(corners: Vec<[Vector; 3]>) -> Self {
        let balls = corners.iter().map(|corners| {
            let center = std::array::from_fn(|d| corners.iter().map(|x| x[d]).sum::<f64>() / 3.0);
            let reach = corners.iter().map(|x| length(difference(*x, center)));
            (center, reach.fold(0.0, f64::max))
        });
        Simplices {
            balls: Balls::new(balls.collect()),
            corners,
        }
    }

    /// Distance of a point from the surface.
    pub(super) fn distance(&self, place: Vector) -> f64 {
        self.balls
            .nearest(place, |k| from_triangle(place, self.corners[k]))
    }
}

/// Distance of a point from a triangle: from its plane if the foot lies inside, otherwise from the
/// nearest side.
fn from_triangle(x: Vector, [a, b, c]: [Vector; 3]) -> f64 {
    let normal = cross(difference(b, a), difference(c, a));
    let size = length(normal);
    let inside = |from: Vector, to: Vector| {
        dot(cross(difference(to, from), difference(x, from)), normal) >= 0.0
    };
    if size > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return dot(difference(x, a), normal).abs() / size;
    }
    let sides = [[a, b], [b, c], [c, a]].map(|side| from_line(x, side));
    sides.into_iter().fold(f64::INFINITY, f64::min)
}

/// Distance of a point from the segment between two others.
fn from_line(x: Vector, [a, b]: [Vector; 2]) -> f64 {
    let (way, off) = (difference(b, a), difference(x, a));
    let square = dot(way, way);
    let share = if square > 0.0 {
        (dot(off, way) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    length(difference(x, along(a, share, way)))
}

/// Splits a facet into triangles or lines between neighbouring nodes.
fn simplices(mesh: &Mesh, facet: Facet) -> Vec<[Vector; 3]> {
    let x: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
    let n = mesh.facet_corners(facet);
    let (corners, middles) = x.split_at(n);
    if n == 2 {
        let ends = [&corners[..1], middles, &corners[1..]].concat();
        return ends.windows(2).map(|w| [w[0], w[1], w[1]]).collect();
    }
    if middles.is_empty() {
        return fan(corners);
    }
    let tip = |k: usize| [corners[k], middles[k], middles[(k + n - 1) % n]];
    (0..n).map(tip).chain(fan(middles)).collect()
}

fn fan(polygon: &[Vector]) -> Vec<[Vector; 3]> {
    let pairs = polygon[1..].windows(2);
    pairs.map(|pair| [polygon[0], pair[0], pair[1]]).collect()
}

/// Finds the surface from which the depths of a body are measured: the one that its `depth_from`
/// names, or all its surfaces in contact. `key` is the entry that asks for depths.
///
/// # Errors
/// A surface that the mesh does not have or that belongs to another body; no `depth_from` in a body
/// without a contact surface.
pub(super) fn surface_of(
    scene: &Scene,
    mesh: &Mesh,
    body: (usize, &str),
    key: &str,
    contacts: &[ContactSurface],
) -> Result<Simplices> {
    let surfaces = surfaces(scene, mesh, body, key, contacts)?;
    let facets = surfaces.iter().flat_map(|surface| &surface.facets);
    let corners = facets.flat_map(|&facet| simplices(mesh, facet)).collect();
    Ok(Simplices::new(corners))
}

/// Finds the mesh surfaces from which the depths of a body are measured.
fn surfaces<'m>(
    scene: &Scene,
    mesh: &'m Mesh,
    (index, body): (usize, &str),
    wanted_by: &str,
    contacts: &[ContactSurface],
) -> Result<Vec<&'m Surface>> {
    let belongs = |surface: &Surface| {
        let mut facets = surface.facets.iter();
        facets.all(|facet| mesh.element_body[facet.element] as usize == index)
    };
    let refused = |key: &str, why: String| {
        let key = format!("bodies.{body}.{key}");
        let error = Error::input(format!("{key}: {why}"));
        scene.places.in_front(&key, error)
    };
    let named = scene
        .bodies
        .get(body)
        .and_then(|body| body.depth_from.as_deref());
    if let Some(name) = named {
        let surface = mesh.surfaces.get(name).ok_or_else(|| {
            let known: Vec<&str> = mesh.surfaces.keys().map(String::as_str).collect();
            let meant =
                closest(name, &known).map_or(String::new(), |k| format!(", did you mean `{k}`?"));
            refused(
                "depth_from",
                format!(
                    "the mesh has no surface `{name}`{meant} It has: {}",
                    known.join(", ")
                ),
            )
        })?;
        if !belongs(surface) {
            return Err(refused(
                "depth_from",
                format!("the surface `{name}` is not one of body `{body}`"),
            ));
        }
        return Ok(vec![surface]);
    }
    let names = contacts.iter().flat_map(|contact| &contact.names);
    let found: Vec<&Surface> = names
        .filter_map(|name| mesh.surfaces.get(name))
        .filter(|surface| belongs(surface))
        .collect();
    if found.is_empty() {
        return Err(refused(
            wanted_by,
            "no surface of the body may touch another: name the one from which depths count, \
             depth_from = \"...\""
                .to_string(),
        ));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a wavy surface of triangles and a polyline, the tree finds the same distance as a full
    /// scan, and a fine sampling of the triangles finds no smaller one.
    #[test]
    fn depths_are_distances_from_the_facets() {
        let node = |i: usize, j: usize| {
            let (x, y) = (i as f64, j as f64);
            [x, y, 0.4 * (0.8 * x).sin() * (1.1 * y).cos()]
        };
        let mut corners = Vec::new();
        for i in 0..9 {
            for j in 0..7 {
                let around = [
                    node(i, j),
                    node(i + 1, j),
                    node(i + 1, j + 1),
                    node(i, j + 1),
                ];
                corners.extend(fan(&around));
            }
        }
        corners.extend((0..5).map(|k| {
            let [a, b] = [k, k + 1].map(|k| [12.0, f64::from(k), 0.5]);
            [a, b, b]
        }));
        let surface = Simplices::new(corners.clone());
        let n = 40;
        for k in 0..60 {
            let t = f64::from(k);
            let x = [
                0.25 * t - 1.0,
                3.5 + 4.0 * (0.7 * t).sin(),
                2.0 * (1.3 * t).cos(),
            ];
            let scan = corners.iter().map(|c| from_triangle(x, *c));
            let found = surface.distance(x);
            assert_eq!(found, scan.fold(f64::INFINITY, f64::min));
            let mut sampled = f64::INFINITY;
            for [a, b, c] in &corners {
                for i in 0..=n {
                    for j in 0..=n - i {
                        let [s, t] = [i, j].map(|i| f64::from(i) / f64::from(n));
                        let place = along(along(*a, s, difference(*b, *a)), t, difference(*c, *a));
                        sampled = sampled.min(length(difference(x, place)));
                    }
                }
            }
            // Every point of a triangle has a sample within 1.5/40.
            assert!(
                found <= sampled + 1e-12 && sampled * sampled <= found * found + 0.04f64.powi(2),
                "{k}: {found} {sampled}"
            );
        }
    }
}
