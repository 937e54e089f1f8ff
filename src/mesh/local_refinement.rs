//! Refinement of a plane mesh around points.
//!
//! In pass `k` of `times`, all elements that touch the disc of radius `2^(times-k)` radii around
//! the point, and the neighbours of these elements, are divided into four ([`crate::shape::cuts`]).
//! The element size therefore doubles whenever the distance from the point doubles, and all passes
//! divide about the same number of elements. An element beside these is divided only at the sides
//! that it shares with divided elements ([`partial_cuts`]), or into four if no such division fits.
//! Because of the layer of neighbours no later pass divides such an element again, which would make
//! its angles sharper. Surfaces that face each other node by node continue to do so.

use super::subdivision::{Finer, MOST_ELEMENTS, check_node_sets, partners};
use super::{Mesh, Surface};
use crate::scene::{Contact, LocalRefinement};
use crate::shape::{can_be_cut_at, partial_cuts};
use crate::space::{Vector, along, difference, dot, in_space, length};
use crate::{Error, Result};
use std::collections::{BTreeMap, HashSet};

/// A side of an element by its corners, the smaller index first.
type ElementSide = [u32; 2];

/// The mesh refined around points. `contacts` lists the surfaces that face each other.
///
/// # Errors
/// `Input` for a mesh of solids, for a mesh that would become too large, and for a node set that
/// contains both ends of a divided side.
pub fn refined(mesh: Mesh, around: &[LocalRefinement], contacts: &[Contact]) -> Result<Mesh> {
    if around.is_empty() {
        return Ok(mesh);
    }
    if mesh.is_solid() {
        return Err(Error::input(
            "mesh.refine is for plane meshes; this one is a mesh of solids, whose elements must be \
             made smaller where it is made",
        ));
    }
    check_size(&mesh, around)?;
    let passes = around.iter().map(|r| r.times).max().unwrap_or(0);
    let mut out = mesh;
    for pass in 1..=passes {
        let sides = closed(&out, &near(&out, around, pass), contacts);
        if out.n_elements() + 4 * sides.len() > MOST_ELEMENTS {
            return Err(too_many(pass, passes));
        }
        check_node_sets(&out, |ends| sides.contains(&ordered(ends)))?;
        let cut = |element| &partial_cuts(out.shapes[element])[divided(&out, element, &sides)];
        out = Finer::new(&out, cut).laid(contacts).mesh();
    }
    Ok(out)
}

fn too_many(pass: usize, passes: usize) -> Error {
    Error::input(format!(
        "mesh.refine: in pass {pass} of {passes} the mesh would have more than {MOST_ELEMENTS} \
         elements; give a smaller `radius` or fewer `times`"
    ))
}

/// Refuses a refinement that would make too many elements in one disc, before any is divided.
fn check_size(mesh: &Mesh, around: &[LocalRefinement]) -> Result<()> {
    for refinement in around {
        let is_inside = |&element: &usize| {
            let n = mesh.shapes[element].n_corners();
            let mut corners = mesh.nodes(element)[..n].iter();
            corners.all(|&node| {
                let way = difference(mesh.point(node as usize), in_space(refinement.at));
                length(way) <= refinement.radius
            })
        };
        let inside = (0..mesh.n_elements()).filter(is_inside).count() as f64;
        let passes = 1..=refinement.times;
        let is_too_many = |pass: &usize| inside * 4f64.powi(*pass as i32) > MOST_ELEMENTS as f64;
        if let Some(pass) = passes.clone().find(is_too_many) {
            return Err(too_many(pass, refinement.times));
        }
    }
    Ok(())
}

/// The elements that a pass divides into four: those that touch its discs, and their neighbours.
fn near(mesh: &Mesh, around: &[LocalRefinement], pass: usize) -> Vec<usize> {
    let discs: Vec<([f64; 2], f64)> = (around.iter())
        .filter(|refinement| refinement.times >= pass)
        .map(|refinement| (refinement.at, refinement.radius_in(pass)))
        .collect();
    let touches = |&element: &usize| {
        let mut discs = discs.iter();
        discs.any(|&(at, radius)| distance(mesh, element, at) <= radius)
    };
    let mut is_near = vec![false; mesh.n_nodes()];
    for element in (0..mesh.n_elements()).filter(touches) {
        for &node in mesh.nodes(element) {
            is_near[node as usize] = true;
        }
    }
    let has_near = |&element: &usize| mesh.nodes(element).iter().any(|&n| is_near[n as usize]);
    (0..mesh.n_elements()).filter(has_near).collect()
}

fn ordered([a, b]: ElementSide) -> ElementSide {
    [a.min(b), a.max(b)]
}

/// The sides of an element in the order of its facets.
fn sides_of(mesh: &Mesh, element: usize) -> impl Iterator<Item = ElementSide> + '_ {
    let (shape, nodes) = (mesh.shapes[element], mesh.nodes(element));
    let edges = shape.reference().edges.iter();
    edges.map(|&edge| ordered(edge.map(|k| nodes[k])))
}

/// One bit for each side of an element that is divided.
fn divided(mesh: &Mesh, element: usize, sides: &HashSet<ElementSide>) -> usize {
    let all = sides_of(mesh, element).enumerate();
    all.filter(|(_, side)| sides.contains(side))
        .fold(0, |bits, (k, _)| bits | 1 << k)
}

/// All sides that are divided if the given elements are divided into four: the sides of these
/// elements, the sides opposite divided ones on facing surfaces, and all sides of further elements
/// that cannot be divided at their divided sides alone.
fn closed(mesh: &Mesh, elements: &[usize], contacts: &[Contact]) -> HashSet<ElementSide> {
    let facing = facing_nodes(mesh, contacts);
    let mut sides = HashSet::new();
    for &element in elements {
        sides.extend(sides_of(mesh, element));
    }
    loop {
        let before = sides.len();
        for partner in &facing {
            let opposite = |side: &ElementSide| {
                let [a, b] = side.map(|node| partner.get(&node).copied());
                Some(ordered([a?, b?]))
            };
            let more: Vec<ElementSide> = sides.iter().filter_map(opposite).collect();
            sides.extend(more);
        }
        for element in 0..mesh.n_elements() {
            let own = divided(mesh, element, &sides);
            if own != 0 && !can_be_cut_at(mesh.shapes[element], own) {
                sides.extend(sides_of(mesh, element));
            }
        }
        if sides.len() == before {
            return sides;
        }
    }
}

/// For each contact whose surfaces face each other node by node, the node opposite each node, in
/// both directions.
fn facing_nodes(mesh: &Mesh, contacts: &[Contact]) -> Vec<BTreeMap<u32, u32>> {
    let mut out = Vec::new();
    for contact in contacts {
        let of = |name: &str| -> Option<&Surface> { mesh.surfaces.get(name) };
        let (Some(first), Some(second)) = (of(&contact.first), of(&contact.second)) else {
            continue;
        };
        let opposite = partners(mesh, contact, first, second);
        let back = opposite.iter().map(|(a, b)| (*b, *a)).collect();
        out.extend([opposite, back]);
    }
    out
}

/// Distance of a point from an element, zero inside; curved sides count as straight.
fn distance(mesh: &Mesh, element: usize, at: [f64; 2]) -> f64 {
    let at = in_space(at);
    let n = mesh.shapes[element].n_corners();
    let corner = |k: usize| mesh.point(mesh.nodes(element)[k % n] as usize);
    let sides = (0..n).map(|k| [corner(k), corner(k + 1)]);
    let is_left = |[a, b]: [Vector; 2]| {
        let (along, to) = (difference(b, a), difference(at, a));
        along[0] * to[1] - along[1] * to[0] >= 0.0
    };
    if sides.clone().all(is_left) {
        return 0.0;
    }
    sides
        .map(|[a, b]| {
            let way = difference(b, a);
            let share = dot(difference(at, a), way) / dot(way, way);
            length(difference(at, along(a, share.clamp(0.0, 1.0), way)))
        })
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
