//! Surfaces whose nodes do not face each other: dual mortar coupling with small sliding.
//!
//! With the trace basis `phi_j` of the slave, functions `psi_j` dual to this basis on each facet,
//! and the shape functions `N_k` of the master,
//!
//! ```text
//!     int psi_j phi_l = delta_jl int phi_j,    D_j = int psi_j,    M_jk = int psi_j N_k
//!     g_j = delta_j - n_j . (d_j - sum_k w_jk d_k),    w_jk = M_jk / D_j,    p_j = r_j / D_j
//! ```
//!
//! over the part of the slave that faces the master. Quadratic facets of solids have the basis of
//! [`crate::model::ContactBasis`], whose weights are positive.
//!
//! # Source
//! B. Wohlmuth, *A mortar finite element method using dual spaces for the Lagrange multiplier*,
//! SIAM J. Numer. Anal. 38 (2000) 989; A. Popp, B. Wohlmuth, M. Gee, W. Wall, SIAM J. Sci. Comput.
//! 34 (2012) B421; partly covered facets: A. Popp, A. Seitz, M. Gee, W. Wall, Comput. Methods Appl.
//! Mech. Engrg. 264 (2013) 67.

mod dual;
mod face;
mod overlap;
pub(in crate::model) mod roundness;
mod sides;
mod spheres;

use super::super::tractions::area;
use super::contact_input::ContactInput;
use super::covered::Covered;
use super::found::Found;
use super::{ContactSurface, NO_AREA, Pair};
use crate::balls::Balls;
use crate::error::{Error, Result};
use crate::mesh::surface::{longest_facet, nodes, normals};
use crate::mesh::{Mesh, Surface};
use crate::scene::SlaveSide;
use crate::space::{Vector, difference, direction, dot, length};
use dual::{Integrals, OfFacet, integrate};
use face::MortarFace;
use rayon::prelude::*;
use sides::Sides;
use std::collections::{BTreeMap, BTreeSet};

/// Fraction of a row's weight that must be covered for the row to be kept: rows below it would
/// contain the inverse of round-off.
const COVERED: f64 = 1e-8;
/// Largest distance of tied surfaces, as a fraction of a facet's length: more than the tolerances
/// of a mesher, less than an element.
const NEAR: f64 = 0.05;
/// Fraction of a facet's length by which facets of a flat surface may deviate from it.
const FLAT: f64 = 1e-6;

/// Both sides of a contact, with the pairs found.
struct Coupled<'a> {
    sides: Sides<'a>,
    pairs: Vec<Pair>,
    /// Slave nodes that the other surface hardly covers.
    left_out: Vec<usize>,
    /// Slave nodes that lie opposite nothing.
    alone: Vec<usize>,
    /// Number of the surface with the slaves.
    slave: usize,
    facet_length: f64,
    covered: Covered,
}

impl Coupled<'_> {
    /// Refuses pairs that share nodes or overlap.
    fn check(&self) -> Result<()> {
        self.sides.check(&self.pairs, self.facet_length, self.slave)
    }
}

/// Finds the pairs of a contact.
///
/// # Errors
/// Surfaces that are not one curve, do not face each other, share nodes or overlap.
pub(super) fn pairs(entries: &ContactInput, notes: &mut Vec<String>) -> Result<Found> {
    let found = coupled(entries, entries.contact.slave)?;
    found.check()?;
    // Facets of a curved surface overlap the other surface on one side and leave gaps on the other.
    // If all slaves lay at gaps, an interference fit would show no pressure and no error. So both
    // choices of the slave are checked.
    if found.sides.depth_of_facets() > FLAT * found.facet_length {
        let other = [SlaveSide::Second, SlaveSide::First][found.slave];
        if let Ok(other) = coupled(entries, other) {
            other.check()?;
        }
    }
    if !found.left_out.is_empty() {
        let contact = &entries.contact;
        notes.push(format!(
            "contact {}: less than a part in 1e8 of the share of {} of `{}` faces the other \
             surface: free of contact",
            entries.index + 1,
            super::list(entries.mesh, &found.left_out),
            [&contact.first, &contact.second][found.slave],
        ));
    }
    Ok(Found {
        covered: found.covered,
        ..Found::new(found.pairs, found.slave, found.facet_length)
    })
}

/// Finds the rows of two tied surfaces, and the slaves that stay free.
///
/// # Errors
/// Errors of [`pairs`], except that surfaces may overlap; nodes whose gap or overlap is larger than
/// `distance`, or than a fraction of a facet by default.
pub(super) fn tied(entries: &ContactInput, distance: Option<f64>) -> Result<(Found, Vec<usize>)> {
    let found = coupled(entries, entries.contact.slave)?;
    found.sides.check_apart(&found.pairs)?;
    let most = distance.unwrap_or(NEAR * found.facet_length + found.sides.depth_of_facets());
    let far: Vec<&Pair> = (found.pairs.iter())
        .filter(|pair| pair.gap.abs() > most)
        .collect();
    if !far.is_empty() {
        let mesh = entries.mesh;
        let contact = &entries.contact;
        let names = [&contact.first, &contact.second];
        let each = far.iter().take(4).map(|pair| {
            let (label, place) = (mesh.node_label(pair.slave), mesh.place(pair.slave));
            format!("node {label} at {place} by {:.3e}", pair.gap)
        });
        let each: Vec<String> = each.collect();
        return Err(Error::input(format!(
            "{} of {} nodes of `{}` are farther from `{}` than {most:.3e}: {}{}; bring the bodies \
             together, name the facets that touch, or give `distance`",
            far.len(),
            found.pairs.len(),
            names[found.slave],
            names[1 - found.slave],
            each.join(", "),
            if far.len() > 4 { ", ..." } else { "" }
        )));
    }
    let mut free = found.left_out;
    free.extend(found.alone);
    let found = Found {
        covered: found.covered,
        ..Found::new(found.pairs, found.slave, found.facet_length)
    };
    Ok((found, free))
}

/// Finds the rows of two surfaces without checking for overlap.
///
/// # Errors
/// Surfaces that are not one curve or do not face each other.
fn coupled<'a>(entries: &'a ContactInput<'a>, slave: SlaveSide) -> Result<Coupled<'a>> {
    let (mesh, contact) = (entries.mesh, &entries.contact);
    let curves = entries.surfaces.map(|s| roundness::true_shape(mesh, s));
    let slave = match slave {
        SlaveSide::First => 0,
        SlaveSide::Second => 1,
        SlaveSide::Auto => finer(entries, [0, 1].map(|k| curves[k].is_some())),
    };
    let curves = [curves[slave], curves[1 - slave]];
    let [slave_surface, master_surface] = [entries.surfaces[slave], entries.surfaces[1 - slave]];
    let slave_nodes = nodes(mesh, slave_surface)?;
    nodes(mesh, master_surface)?;
    let faces = |surface: &Surface| -> Vec<MortarFace> {
        surface
            .facets
            .iter()
            .map(|&facet| MortarFace::new(mesh, facet))
            .collect()
    };
    let shaped = Surface {
        facets: slave_surface.facets.clone(),
        curve: curves[0],
    };
    let normals = match contact.normal {
        Some(n) => vec![entries.towards_master(direction(n.vector()), slave); slave_nodes.len()],
        None => normals(mesh, &shaped, &slave_nodes),
    };
    let masters = faces(master_surface);
    let sides = Sides {
        entries,
        slaves: faces(slave_surface),
        near: Balls::new(masters.iter().map(MortarFace::ball).collect()),
        masters,
        curves,
        normals: slave_nodes.iter().copied().zip(normals).collect(),
    };
    let of_facets: Result<Vec<OfFacet>> = sides
        .slaves
        .par_iter()
        .map(|face| integrate(&sides, face))
        .collect();
    let (integrals, covered) = sum(of_facets?);
    let facet_length = longest_facet(mesh, slave_surface).max(longest_facet(mesh, master_surface));
    let (mut left_out, mut alone) = (Vec::new(), Vec::new());
    let mut pairs = Vec::new();
    let mut arc = 0.0;
    for (j, &node) in slave_nodes.iter().enumerate() {
        if j > 0 && !mesh.is_solid() {
            arc += length(difference(mesh.point(node), mesh.point(slave_nodes[j - 1])));
        }
        let Some(of_node) = integrals.get(&node) else {
            alone.push(node);
            continue;
        };
        match sides.pair(node, of_node, arc)? {
            Some(pair) => pairs.push(pair),
            None => left_out.push(node),
        }
    }
    if pairs.is_empty() {
        return Err(Error::input(format!(
            "no part of `{}` lies opposite `{}`, seen along its normal: check the names of the \
             surfaces and where the bodies are, or give `normal`",
            [&contact.first, &contact.second][slave],
            [&contact.first, &contact.second][1 - slave],
        )));
    }
    Ok(Coupled {
        sides,
        pairs,
        left_out,
        alone,
        slave,
        facet_length,
        covered,
    })
}

/// Sums the integrals of all facets by node, and collects the covered part of partly covered
/// facets.
fn sum(facets: Vec<OfFacet>) -> (BTreeMap<usize, Integrals>, Covered) {
    let mut sums: BTreeMap<usize, Integrals> = BTreeMap::new();
    let mut covered = BTreeMap::new();
    for (number, facet) in facets.into_iter().enumerate() {
        for (node, of_facet) in facet.nodes {
            sums.entry(node).or_default().add(&of_facet);
        }
        covered.extend(facet.covered.map(|parts| (number, parts)));
    }
    (sums, covered)
}

/// Factor by which linear facets of a master may be longer than facets of the slave. Beyond this
/// factor the kinks between straight facets, not the contact, would shape the pressure.
const LONGER: f64 = 2.0;
/// Factor in place of [`LONGER`] if gaps have kinks too, as on curved surfaces of unknown true
/// shape: the weights of a slave average the kinks out if its facets are no shorter than the
/// master's.
const LONGER_KINKED: f64 = 1.0;

/// Chooses the slave: the surface with the smaller facets in the part where the two surfaces may
/// face each other, or the second surface if the facets are equal. There are two exceptions. A flat
/// surface that lies wholly opposite the other, while the other extends beyond it, is the slave
/// unless its facets are longer by a factor of more than [`LONGER`]: slaves of the other surface
/// would touch with a small part of their areas at its edges. The surface with the larger facets is
/// the slave if its facets are linear and longer by a factor of more than [`LONGER`] or
/// [`LONGER_KINKED`].
fn finer(entries: &ContactInput, is_known: [bool; 2]) -> usize {
    let (mesh, surfaces) = (entries.mesh, entries.surfaces);
    let faces = surfaces.map(|surface| -> Vec<MortarFace> {
        surface
            .facets
            .iter()
            .map(|&facet| MortarFace::new(mesh, facet))
            .collect()
    });
    let faced_radii = |own: &[MortarFace], other: &[MortarFace]| {
        let near = Balls::new(other.iter().map(MortarFace::ball).collect());
        let faced = |face: &&MortarFace| {
            let near = near.near(face.center, face.normal, face.radius);
            near.into_iter().any(|k| face.may_face(&other[k]))
        };
        let mut sizes: Vec<f64> = own.iter().filter(faced).map(|face| face.radius).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let radii = [0, 1].map(|k| faced_radii(&faces[k], &faces[1 - k]));
    let median = |sizes: &[f64]| sizes.get(sizes.len() / 2).copied().unwrap_or(f64::INFINITY);
    let [first, second] = [median(&radii[0]), median(&radii[1])];
    let is_within = [0, 1].map(|k| radii[k].len() == faces[k].len());
    let longest = |faces: &[MortarFace]| faces.iter().map(|face| face.radius).fold(0.0, f64::max);
    let areas = surfaces.map(|surface| area(entries.space, mesh, surface));
    let inner = (0..2).find(|&k| is_within[k] && areas[k] < areas[1 - k] * (1.0 - 1e-6));
    if let Some(inner) = inner.filter(|&k| depth(&faces[k]) <= FLAT * longest(&faces[k]))
        && median(&radii[inner]) <= LONGER * (1.0 + 1e-6) * median(&radii[1 - inner])
        && median(&radii[1 - inner]) <= LONGER * (1.0 + 1e-6) * median(&radii[inner])
    {
        return inner;
    }
    let finer = usize::from(first >= second * (1.0 - 1e-6));
    let is_linear = |face: &MortarFace| face.nodes.len() == face.reference.n_corners;
    let ratio = if finer == 0 {
        second / first
    } else {
        first / second
    };
    let coarser = &faces[1 - finer];
    let longer = match is_known[1 - finer] || depth(coarser) <= FLAT * longest(coarser) {
        true => LONGER,
        false => LONGER_KINKED,
    };
    match ratio > longer * (1.0 + 1e-6) && coarser.iter().all(is_linear) {
        true => 1 - finer,
        false => finer,
    }
}

impl Sides<'_> {
    /// Makes the pair of a slave node; `None` if too little of its area is covered.
    fn pair(&self, node: usize, of_node: &Integrals, arc: f64) -> Result<Option<Pair>> {
        let (mesh, stated) = (self.entries.mesh, self.entries.stated);
        let Some(&normal) = self.normals.get(&node) else {
            return Ok(None);
        };
        let (weight, masters) = match of_node.covered > COVERED * of_node.whole {
            true => (of_node.covered, of_node.weights()),
            false => (0.0, Vec::new()),
        };
        let met = self.meet(node, normal, &of_node.faced);
        // A quadratic element's node on the axis has zero weight: see `AxisPoint`.
        let largest = of_node.largest;
        let on_axis = self.entries.space.is_axisymmetric()
            && mesh.point(node)[0].abs() <= COVERED * largest
            && weight <= NO_AREA * of_node.of_facet;
        let masters = match &met {
            Some(met) if on_axis => met.masters.clone(),
            _ if weight > 0.0 => masters,
            _ => return Ok(None),
        };
        // The dual functions are negative in places and extend beyond the covered part, so the mean
        // gap may be negative although the surfaces overlap nowhere. The mean gap is therefore
        // limited from below by the least gap, or by zero.
        let weighted = || {
            let mean = dot(of_node.gap.map(|g| g / weight), normal);
            mean.max(of_node.least.min(0.0))
        };
        let (gap, unit_gap) = match met {
            Some(met) if !of_node.is_transformed => (met.gap, 1.0),
            _ if of_node.is_transformed => {
                (weighted(), dot(of_node.normal.map(|n| n / weight), normal))
            }
            _ => (weighted(), 1.0),
        };
        Ok(Some(Pair {
            contact: self.entries.index,
            slave: node,
            masters,
            normal,
            gap: stated.gap(node)?.map_or(gap, |stated| unit_gap * stated),
            interference: unit_gap * stated.interference(node)?,
            unit_gap,
            area: weight,
            arc,
        }))
    }

    /// Refuses pairs that share nodes.
    fn check_apart(&self, pairs: &[Pair]) -> Result<()> {
        let mesh = self.entries.mesh;
        for pair in pairs {
            if pair.masters.iter().any(|&(node, _)| node == pair.slave) {
                return Err(Error::input(format!(
                    "node {} is on both surfaces; the bodies must not share nodes where they touch",
                    mesh.node_label(pair.slave)
                )));
            }
        }
        Ok(())
    }

    /// Refuses pairs that share nodes or overlap.
    fn check(&self, pairs: &[Pair], facet_length: f64, slave: usize) -> Result<()> {
        let (mesh, contact) = (self.entries.mesh, &self.entries.contact);
        self.check_apart(pairs)?;
        let deepest = pairs.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
        let rounding = self.entries.rounding;
        let overlaps = |pair: &&Pair| pair.overlaps(facet_length, rounding) && !contact.overlap;
        let Some(deepest) = deepest.filter(overlaps) else {
            return Ok(());
        };
        let place = format!(
            "node {} of `{}` at {} overlaps the other surface by {:.3e} in the mesh",
            mesh.node_label(deepest.slave),
            [&contact.first, &contact.second][slave],
            mesh.place(deepest.slave),
            -deepest.gap
        );
        let facets = self.depth_of_facets();
        let is_linear = |face: &MortarFace| face.nodes.len() == face.reference.n_corners;
        let finer = match self.slaves.iter().chain(&self.masters).all(is_linear) {
            true => "use quadratic elements",
            false => "use smaller elements",
        };
        Err(Error::input(match -deepest.gap <= facets {
            true => format!(
                "{place}: no more than facets deviate from a curved surface ({facets:.1e}), which \
                 is not what the bodies do; say what the surface is (`mesh.circles`, `spheres`, \
                 `cylinders`, `tori`), give `gap`, {finer}, or say `overlap = true` where that is \
                 an interference"
            ),
            false => format!(
                "{place}; move the bodies apart, or say `overlap = true` where that is an \
                 interference"
            ),
        }))
    }

    /// Estimates how far facets of both surfaces may deviate from a surface through their nodes: a
    /// chord `h` whose ends turn by an angle `t` deviates from its arc by `h t / 8`.
    fn depth_of_facets(&self) -> f64 {
        [
            (&self.slaves, self.curves[0]),
            (&self.masters, self.curves[1]),
        ]
        .into_iter()
        .filter(|(_, curve)| curve.is_none())
        .map(|(faces, _)| depth(faces))
        .sum()
    }
}

/// Estimates how far facets may deviate from a surface through their nodes.
fn depth(faces: &[MortarFace]) -> f64 {
    let mut at: BTreeMap<usize, &MortarFace> = BTreeMap::new();
    let mut largest = 0.0f64;
    for face in faces {
        for &node in &face.nodes {
            if let Some(other) = at.insert(node, face) {
                let turn = dot(face.normal, other.normal).clamp(-1.0, 1.0).acos();
                largest = largest.max(2.0 * face.radius.max(other.radius) * turn / 8.0);
            }
        }
    }
    largest
}

/// Normals of masters that face no single node; each normal may become an axis of its master.
pub(in crate::model) fn master_normals(
    mesh: &Mesh,
    pairs: &[Pair],
    contacts: &[ContactSurface],
) -> Vec<(usize, Vector)> {
    let mut out = Vec::new();
    for contact in contacts.iter().filter(|contact| !contact.is_rigid) {
        let pairs = pairs[contact.range.clone()].iter();
        let masters: BTreeSet<usize> = pairs
            .filter(|pair| pair.faced().is_none())
            .flat_map(|pair| pair.masters.iter().map(|&(node, _)| node))
            .collect();
        let masters: Vec<usize> = masters.into_iter().collect();
        if let Some(surface) = mesh.surfaces.get(&contact.names[1 - contact.slave]) {
            let normals = normals(mesh, surface, &masters);
            out.extend(masters.into_iter().zip(normals));
        }
    }
    out
}
