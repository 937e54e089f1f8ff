//! Contact pairs: nodes of two surfaces that face each other (paper 2.1).
//!
//! The gap of a pair is `g = delta - (u_second - u_first) . n >= 0` with
//! `delta = (x_first - x_second) . n` and `n` the unit vector from the second body to the first.

use super::given::{Given, NodePair, Partner, partners};
use super::names::Entry;
use crate::element::facet_points;
use crate::error::{Error, Result};
use crate::mesh::surface::{PAIRING, facing, longest_facet, nodes, normals};
use crate::mesh::{Curve, Facet, Mesh, Surface};
use crate::scene::{Contact, Scene};
use crate::space::{Vector, difference, direction, dot, length};
use std::collections::{BTreeMap, BTreeSet};

/// A pair of nodes that may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Index of the scene's contact entry.
    pub contact: usize,
    /// Node of the first surface.
    pub first: usize,
    /// Node of the second surface.
    pub second: usize,
    /// Unit vector from the second body to the first (the paper's i_1).
    pub normal: Vector,
    /// Initial gap delta, interference not yet taken off.
    pub gap: f64,
    /// Interference.
    pub interference: f64,
    /// Area that belongs to the pair: integral of the node's shape function over the second surface.
    pub area: f64,
    /// Distance along the second surface from its begin; 0 in a solid model.
    pub arc: f64,
}

/// A contact of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurface {
    /// Names of the first and second surface.
    pub names: [String; 2],
    /// Its pairs: `pairs[range]`.
    pub range: std::ops::Range<usize>,
    /// Centre and radius of the surface, where it is known to be a circle.
    pub circle: Option<([f64; 2], f64)>,
    /// Length of the longest facet, the resolution of positions.
    pub facet_length: f64,
    /// The nodes on the axis of revolution that carry no force.
    pub axis: Option<AxisPoint>,
    /// Pairs at which the candidates end although both bodies go on there: material beyond could touch too.
    pub goes_on: Vec<usize>,
    /// In a solid model the pairs at the corners of each piece of a face of the second surface, in
    /// order.
    pub faces: Vec<Vec<usize>>,
}

/// Two nodes on the axis of revolution that belong to quadratic elements. Their consistent force is zero whatever the
/// pressure, so the condition that they keep apart has no weight: they are no pair, and the pressure there is the even
/// continuation of that beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisPoint {
    /// Node of the second surface.
    pub node: usize,
    /// Node of the first surface.
    pub first: usize,
    /// Unit normal from the second surface to the first.
    pub normal: Vector,
    /// Initial gap.
    pub gap: f64,
    /// Interference.
    pub interference: f64,
    /// Distance along the second surface from its begin.
    pub arc: f64,
    /// Whether the surface begins on the axis (else it ends there).
    pub begins: bool,
}

/// Share of its neighbour's area below which a node on the axis carries no force: 0 for quadratic elements but for curvature, 1/6 for
/// linear ones.
const NO_AREA: f64 = 0.02;

pub(super) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    given: &Given,
) -> Result<(Vec<Pair>, Vec<ContactSurface>)> {
    let mut pairs: Vec<Pair> = Vec::new();
    let mut contacts = Vec::new();
    let mut used: BTreeMap<usize, usize> = BTreeMap::new();
    for (index, contact) in scene.contact.iter().enumerate() {
        let start = pairs.len();
        let given = given.pairs.get(&index).map(Vec::as_slice);
        let entry = Entry::of_list(scene, "contact", index);
        let surfaces = [
            entry.surface(mesh, "first", &contact.first)?,
            entry.surface(mesh, "second", &contact.second)?,
        ];
        let surface = resolve_contact(index, contact, surfaces, given, mesh, scene, &mut pairs)
            .map_err(|error| entry.refused(error))?;
        for pair in &pairs[start..] {
            for node in [pair.first, pair.second] {
                if let Some(other) = used.insert(node, index) {
                    return Err(entry.refused(Error::input(format!(
                        "node {} is in two contact pairs: of contact {} and contact {} (`{}` on `{}`); a node may belong to one",
                        mesh.node_label(node),
                        other + 1,
                        index + 1,
                        contact.first,
                        contact.second
                    ))));
                }
            }
        }
        contacts.push(surface);
    }
    Ok((pairs, contacts))
}

fn resolve_contact(
    index: usize,
    contact: &Contact,
    [first, second]: [&Surface; 2],
    given: Option<&[NodePair]>,
    mesh: &Mesh,
    scene: &Scene,
    pairs: &mut Vec<Pair>,
) -> Result<ContactSurface> {
    let what = format!(
        "contact {} (`{}` on `{}`)",
        index + 1,
        contact.first,
        contact.second
    );
    let context = |e: Error| e.within(&what);
    let first_nodes = nodes(mesh, first).map_err(context)?;
    let second_nodes = nodes(mesh, second).map_err(context)?;
    let normal = match contact.normal {
        Some(n) => vec![direction(n.vector()); second_nodes.len()],
        None => normals(mesh, second, &second_nodes),
    };
    let facet_length = longest_facet(mesh, first).max(longest_facet(mesh, second));
    let tolerance = PAIRING * facet_length;
    let partners = match given {
        Some(given) => {
            let names = [contact.first.as_str(), contact.second.as_str()];
            partners(
                given,
                mesh,
                names,
                &first_nodes,
                &second_nodes,
                &normal,
                contact.gap,
            )
            .map_err(context)?
        }
        None => second_nodes
            .iter()
            .zip(&normal)
            .map(|(&node, &normal)| {
                facing(mesh, mesh.point(node), normal, &first_nodes, tolerance).map(|first| {
                    Partner {
                        first,
                        normal,
                        gap: contact.gap,
                    }
                })
            })
            .collect(),
    };

    // Beyond the end of the shorter surface there is nothing to press on; who gives the pairs decides himself.
    let faces: BTreeSet<usize> = second_nodes
        .iter()
        .zip(&partners)
        .filter(|(_, partner)| given.is_some() || partner.is_some())
        .map(|(&node, _)| node)
        .collect();
    let areas = nodal_areas(scene, mesh, second, &faces);

    let mut taken = vec![false; first_nodes.len()];
    let mut unpaired = Vec::new();
    let mut arc = 0.0;
    let start = pairs.len();
    for (j, &node) in second_nodes.iter().enumerate() {
        let x = mesh.point(node);
        if j > 0 && !mesh.is_solid() {
            arc += length(difference(x, mesh.point(second_nodes[j - 1])));
        }
        match partners[j] {
            Some(partner) if !taken[partner.first] => {
                taken[partner.first] = true;
                let area = areas.get(&node).copied().unwrap_or(0.0);
                let y = mesh.point(first_nodes[partner.first]);
                let geometric = dot(difference(y, x), partner.normal);
                pairs.push(Pair {
                    contact: index,
                    first: first_nodes[partner.first],
                    second: node,
                    normal: partner.normal,
                    gap: partner.gap.unwrap_or(geometric),
                    interference: contact.interference,
                    area,
                    arc,
                });
            }
            _ => unpaired.push(node),
        }
    }
    let unpaired_first: Vec<usize> = first_nodes
        .iter()
        .zip(&taken)
        .filter(|(_, taken)| !**taken)
        .map(|(&n, _)| n)
        .collect();
    // One surface may reach beyond the other, but the shorter one must pair completely; who gives the pairs decides himself.
    let incomplete = given.is_none() && !unpaired.is_empty() && !unpaired_first.is_empty();
    if pairs.len() == start || incomplete {
        return Err(Error::input(format!(
            "{what}: the surfaces' nodes do not pair: node{} of `{}` face{} no node of `{}` along the normal (within {:.1e}); \
             mesh the two surfaces with facing nodes, or give `normal`",
            list(mesh, &unpaired),
            contact.second,
            if unpaired.len() == 1 { "s" } else { "" },
            contact.first,
            tolerance,
        )));
    }
    for pair in &pairs[start..] {
        if pair.first == pair.second {
            return Err(Error::input(format!(
                "{what}: node {} is on both surfaces; the bodies must not share nodes where they touch",
                mesh.node_label(pair.first)
            )));
        }
        if pair.gap < -1e-9 * facet_length && contact.gap.is_none() {
            return Err(Error::input(format!(
                "{what}: nodes {} and {} overlap by {:.3e} in the mesh; move the bodies apart, or state the overlap as `interference` \
                 with `gap = 0`",
                mesh.node_label(pair.first),
                mesh.node_label(pair.second),
                -pair.gap
            )));
        }
    }
    let axis = take_axis_pair(mesh, scene, pairs, start);
    let circle = [second.curve, first.curve]
        .into_iter()
        .flatten()
        .find_map(|c| match c {
            Curve::Circle { center, radius, .. } if second.curve == Some(c) => {
                Some((center, radius))
            }
            _ => None,
        });
    Ok(ContactSurface {
        names: [contact.first.clone(), contact.second.clone()],
        range: start..pairs.len(),
        circle,
        facet_length,
        axis,
        goes_on: Vec::new(),
        faces: faces_of(mesh, second, &pairs[start..], start),
    })
}

/// The pairs at the corners of each piece of a face of a surface of a solid; `start` is the first
/// one's number. A linear face is one piece; of a quadratic one the nodes are the corners of several.
fn faces_of(mesh: &Mesh, surface: &Surface, pairs: &[Pair], start: usize) -> Vec<Vec<usize>> {
    if !mesh.is_solid() {
        return Vec::new();
    }
    let numbers = start..start + pairs.len();
    let of_node: BTreeMap<usize, usize> = pairs.iter().map(|p| p.second).zip(numbers).collect();
    let pairs_of = |&facet: &Facet| -> Option<Vec<usize>> {
        let nodes = mesh.facet_nodes(facet);
        nodes.map(|node| of_node.get(&node).copied()).collect()
    };
    let faces = surface.facets.iter().filter_map(pairs_of);
    faces
        .flat_map(|face| {
            let pieces: &[&[usize]] = match face.len() {
                3 => &[&[0, 1, 2]],
                4 => &[&[0, 1, 2, 3]],
                6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
                _ => &[
                    &[0, 4, 7],
                    &[4, 1, 5],
                    &[5, 2, 6],
                    &[6, 3, 7],
                    &[4, 5, 6, 7],
                ],
            };
            let of_piece = |piece: &&[usize]| piece.iter().map(|&k| face[k]).collect();
            pieces.iter().map(of_piece).collect::<Vec<Vec<usize>>>()
        })
        .collect()
}

/// Takes the pair on the axis that can carry no force out of the pairs from `start` on.
fn take_axis_pair(
    mesh: &Mesh,
    scene: &Scene,
    pairs: &mut Vec<Pair>,
    start: usize,
) -> Option<AxisPoint> {
    let last = pairs.len().checked_sub(1).filter(|last| *last > start)?;
    if !scene.kind.is_axisymmetric() {
        return None;
    }
    let radius = |k: usize| mesh.point(pairs[k].second)[0];
    for (end, beside) in [(start, start + 1), (last, last - 1)] {
        let on_axis = radius(end).abs() <= PAIRING * radius(beside).abs();
        if on_axis && pairs[end].area <= NO_AREA * pairs[beside].area {
            let pair = pairs.remove(end);
            return Some(AxisPoint {
                node: pair.second,
                first: pair.first,
                normal: pair.normal,
                gap: pair.gap,
                interference: pair.interference,
                arc: pair.arc,
                begins: end == start,
            });
        }
    }
    None
}

/// Integrals of each node's shape function over the facets of a surface all of whose nodes are among `faces`.
fn nodal_areas(
    scene: &Scene,
    mesh: &Mesh,
    surface: &Surface,
    faces: &BTreeSet<usize>,
) -> BTreeMap<usize, f64> {
    let mut areas: BTreeMap<usize, f64> = BTreeMap::new();
    for &facet in &surface.facets {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        if !nodes.iter().all(|node| faces.contains(node)) {
            continue;
        }
        let x: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n)).collect();
        let reference = mesh.shapes[facet.element].reference().facet;
        for point in facet_points(scene.kind, reference, &x) {
            for (&node, value) in nodes.iter().zip(&point.values) {
                *areas.entry(node).or_default() += point.weight * value;
            }
        }
    }
    areas
}

fn list(mesh: &Mesh, nodes: &[usize]) -> String {
    let mut out: Vec<String> = nodes
        .iter()
        .take(6)
        .map(|&n| mesh.node_label(n).to_string())
        .collect();
    if nodes.len() > 6 {
        out.push(format!("and {} more", nodes.len() - 6));
    }
    format!(
        "{} {}",
        if nodes.len() == 1 { "" } else { "s" },
        out.join(", ")
    )
}
