//! Contacts of single nodes: each chosen slave node against the point of the other surface that is
//! nearest to it.
//!
//! With the point `X = sum_k N_k(xi) x_k` of a master facet at which `|x - X|` is least, the
//! masters of a slave are the facet's nodes with the weights `N_k(xi)`, and the gap is the distance
//! along the master's normal there.

use super::Pair;
use super::contact_input::ContactInput;
use super::found::Found;
use super::only::Only;
use crate::balls::Balls;
use crate::element::facet_points;
use crate::error::{Error, Result};
use crate::mesh::surface::{PAIRING, longest_facet};
use crate::mesh::{Facet, Mesh};
use crate::scene::SlaveSide;
use crate::shape::Place;
use crate::space::{Vector, along, cross, difference, dot, length, unit};
use std::cell::Cell;
use std::collections::BTreeMap;

/// Number of Newton steps to the nearest point of a facet; flat facets need one.
const STEPS: usize = 20;
/// Sine of the largest angle (30 degrees) between the normal at the nearest point and the line from
/// this point to the node at which the node still faces the surface. The angle is not zero if the
/// node stands over an edge between two facets.
const FACING: f64 = 0.5;
/// Weight below which a master is dropped as round-off.
const NOTHING: f64 = 1e-13;

/// The point of a facet that is nearest to a node.
#[derive(Debug, Clone, Copy)]
struct NearestPoint {
    place: Place,
    point: Vector,
    /// Outward unit normal of the facet at the nearest point.
    normal: Vector,
    distance: f64,
}

/// Finds the pairs of the chosen nodes.
///
/// # Errors
/// `Input` if no node faces the other surface, or if a node lies behind the other surface or
/// belongs to both surfaces.
pub(super) fn pairs(input: &ContactInput, only: &Only) -> Result<Found> {
    let mesh = input.mesh;
    let slave = match only.side {
        SlaveSide::First => 0,
        _ => 1,
    };
    let [master, own] = [input.surfaces[1 - slave], input.surfaces[slave]];
    let facet_length = longest_facet(mesh, master).max(longest_facet(mesh, own));
    let places: Vec<Vec<Vector>> = master.facets.iter().map(|&f| points(mesh, f)).collect();
    let near = Balls::new(places.iter().map(|x| ball(x)).collect());
    let areas = lumped_areas(input, &own.facets);
    let mut pairs = Vec::new();
    for &node in &only.nodes {
        let x = mesh.point(node);
        let best: Cell<Option<(NearestPoint, usize)>> = Cell::new(None);
        near.nearest(x, |k| {
            let found = nearest(mesh, master.facets[k], &places[k], x);
            if best
                .get()
                .is_none_or(|(best, _)| found.distance < best.distance)
            {
                best.set(Some((found, k)));
            }
            found.distance
        });
        let Some((found, k)) = best.get() else {
            continue;
        };
        let off = difference(x, found.point);
        let gap = dot(off, found.normal);
        let beside = length(along(off, -gap, found.normal));
        let faces = beside <= (PAIRING * facet_length).max(FACING * found.distance);
        if !faces {
            continue;
        }
        let facet = master.facets[k];
        let values = (mesh.facet_reference(facet).functions)(found.place).values;
        let masters = mesh.facet_nodes(facet).zip(values);
        let masters: Vec<(usize, f64)> = masters.filter(|(_, w)| w.abs() > NOTHING).collect();
        if masters.iter().any(|(master, _)| *master == node) {
            return Err(Error::input(format!(
                "node {} is on both surfaces; the bodies must not share nodes where they touch",
                mesh.node_label(node)
            )));
        }
        pairs.push(Pair {
            contact: input.index,
            slave: node,
            masters,
            normal: found.normal.map(|n| -n),
            gap: input.stated.gap(node)?.unwrap_or(gap),
            interference: input.stated.interference(node)?,
            unit_gap: 1.0,
            area: areas.get(&node).copied().unwrap_or(0.0),
            arc: 0.0,
        });
    }
    check(input, only, &pairs, facet_length)?;
    if !mesh.is_solid() {
        order(mesh, &mut pairs);
    }
    Ok(Found::new(pairs, slave, facet_length))
}

fn check(input: &ContactInput, only: &Only, pairs: &[Pair], facet_length: f64) -> Result<()> {
    let mesh = input.mesh;
    if let (true, Some(&node)) = (pairs.is_empty(), only.nodes.first()) {
        return Err(Error::input(format!(
            "no node of `{}` faces the other surface, neither does node {} at {}",
            only.name,
            mesh.node_label(node),
            mesh.place(node)
        )));
    }
    let may_overlap = input.contact.overlap || input.contact.gap.is_some();
    let deepest = pairs.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
    let overlaps = |pair: &&Pair| pair.overlaps(facet_length, input.rounding) && !may_overlap;
    match deepest.filter(overlaps) {
        None => Ok(()),
        Some(pair) => Err(Error::input(format!(
            "node {} lies {:.3e} behind the other surface in the mesh; move the bodies apart, or \
             say `overlap = true` where that is an interference",
            mesh.node_label(pair.slave),
            -pair.gap
        ))),
    }
}

fn points(mesh: &Mesh, facet: Facet) -> Vec<Vector> {
    mesh.facet_nodes(facet)
        .map(|node| mesh.point(node))
        .collect()
}

/// A ball around the nodes of a facet, twice as large as needed because the facet may bulge.
fn ball(x: &[Vector]) -> (Vector, f64) {
    let share = 1.0 / x.len() as f64;
    let center = x.iter().fold([0.0; 3], |sum, x| along(sum, share, *x));
    let radius = x.iter().map(|x| length(difference(*x, center)));
    (center, 2.0 * radius.fold(0.0, f64::max))
}

/// Finds the nearest point of a facet by the Gauss-Newton method (Newton's method without the
/// curvature), with each step restricted to the facet.
fn nearest(mesh: &Mesh, facet: Facet, nodes: &[Vector], x: Vector) -> NearestPoint {
    let reference = mesh.facet_reference(facet);
    let is_triangle = reference.n_corners == 3;
    let mut place: Place = match is_triangle {
        true => [1.0 / 3.0, 1.0 / 3.0, 0.0],
        false => [0.0; 3],
    };
    let at = |place: Place| {
        let functions = (reference.functions)(place);
        let (mut point, mut tangents) = ([0.0; 3], [[0.0; 3]; 2]);
        for (k, node) in nodes.iter().enumerate() {
            point = along(point, functions.values[k], *node);
            for (tangent, slope) in tangents.iter_mut().zip(functions.gradients[k]) {
                *tangent = along(*tangent, slope, *node);
            }
        }
        (point, tangents)
    };
    for _ in 0..STEPS {
        let (point, [a, b]) = at(place);
        let off = difference(x, point);
        let before = place;
        if mesh.is_solid() {
            let [aa, ab, bb] = [dot(a, a), dot(a, b), dot(b, b)];
            let determinant = aa * bb - ab * ab;
            let [p, q] = [dot(a, off), dot(b, off)];
            place[0] += (bb * p - ab * q) / determinant;
            place[1] += (aa * q - ab * p) / determinant;
        } else {
            place[0] += dot(a, off) / dot(a, a);
        }
        place = within(place, is_triangle);
        if length(difference(place, before)) <= f64::EPSILON {
            break;
        }
    }
    let (point, [a, b]) = at(place);
    let normal = match mesh.is_solid() {
        true => cross(a, b),
        false => cross(a, unit(2)),
    };
    let size = length(normal);
    NearestPoint {
        place,
        point,
        normal: normal.map(|n| n / size),
        distance: length(difference(x, point)),
    }
}

/// The place moved into the reference facet.
fn within(place: Place, is_triangle: bool) -> Place {
    if !is_triangle {
        return place.map(|x| x.clamp(-1.0, 1.0));
    }
    let [mut p, mut q, _] = place;
    let beyond = 0.5 * (p + q - 1.0).max(0.0);
    (p, q) = (p - beyond, q - beyond);
    (p, q) = (p.clamp(0.0, 1.0), q.clamp(0.0, 1.0));
    [p, q.min(1.0 - p), 0.0]
}

/// Area that belongs to each node: the area of each facet in the shares of `int N_i^2`, which are
/// positive where `int N_i` is not (E. Hinton, T. Rock, O. C. Zienkiewicz, *A note on mass
/// lumping*, Earthquake Engng. Struct. Dyn. 4 (1976) 245).
fn lumped_areas(input: &ContactInput, facets: &[Facet]) -> BTreeMap<usize, f64> {
    let mesh = input.mesh;
    let mut areas: BTreeMap<usize, f64> = BTreeMap::new();
    for &facet in facets {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        let mut squares = vec![0.0; nodes.len()];
        let mut area = 0.0;
        for point in facet_points(
            input.space,
            mesh.facet_reference(facet),
            &points(mesh, facet),
        ) {
            area += point.weight;
            for (square, value) in squares.iter_mut().zip(&point.values) {
                *square += point.weight * value * value;
            }
        }
        let all: f64 = squares.iter().sum();
        for (node, square) in nodes.into_iter().zip(squares) {
            *areas.entry(node).or_default() += area * square / all;
        }
    }
    areas
}

/// Orders the pairs of a plane model along a line and measures their arcs. The line runs from the
/// slave farthest from the first one to the slave farthest from that one.
fn order(mesh: &Mesh, pairs: &mut [Pair]) {
    let Some(first) = pairs.first().map(|pair| mesh.point(pair.slave)) else {
        return;
    };
    let far = |from: Vector| {
        let places = pairs.iter().map(|pair| mesh.point(pair.slave));
        let off = |x: &Vector| length(difference(*x, from));
        places
            .max_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap_or(from)
    };
    let start = far(first);
    let way = difference(far(start), start);
    let along_way = |pair: &Pair| dot(difference(mesh.point(pair.slave), start), way);
    pairs.sort_by(|a, b| along_way(a).total_cmp(&along_way(b)));
    let (mut arc, mut last) = (0.0, None);
    for pair in pairs {
        let x = mesh.point(pair.slave);
        arc += last.map_or(0.0, |last| length(difference(x, last)));
        (pair.arc, last) = (arc, Some(x));
    }
}
