//! Contact pairs of nodes that face each other.

use super::Pair;
use super::contact_input::ContactInput;
use super::found::Found;
use crate::balls::Balls;
use crate::element::facet_points;
use crate::error::{Error, Result};
use crate::mesh::surface::{PAIRING, facing, longest_facet, nodes, normals};
use crate::mesh::{Mesh, Surface};
use crate::model::given::{NodePair, Partner, partners};
use crate::scene::SlaveSide;
use crate::space::{Vector, difference, direction, dot, length};
use std::collections::{BTreeMap, BTreeSet};

/// Finds the master node that each slave node faces along its normal.
fn faced(
    mesh: &Mesh,
    [masters, slaves]: [&[usize]; 2],
    normals: &[Vector],
    tolerance: f64,
) -> Vec<Option<Partner>> {
    let near = Balls::new(masters.iter().map(|&n| (mesh.point(n), 0.0)).collect());
    let partner = |(&node, &normal): (&usize, &Vector)| {
        let x = mesh.point(node);
        let places = near.near(x, normal, tolerance);
        let nodes: Vec<usize> = places.iter().map(|&k| masters[k]).collect();
        let at = facing(mesh, x, normal, &nodes, tolerance)?;
        Some(Partner {
            first: places[at],
            normal,
            gap: None,
        })
    };
    slaves.iter().zip(normals).map(partner).collect()
}

/// Refuses pairs of a node with itself, and pairs that overlap although the contact does not allow
/// for an overlap.
fn check(entries: &ContactInput, pairs: &[Pair], facet_length: f64) -> Result<()> {
    let (mesh, contact) = (entries.mesh, &entries.contact);
    let may_overlap = contact.overlap || contact.gap.is_some();
    for pair in pairs {
        let faced = pair.masters[0].0;
        if faced == pair.slave {
            return Err(Error::input(format!(
                "node {} is on both surfaces; the bodies must not share nodes where they touch",
                mesh.node_label(faced)
            )));
        }
        if pair.overlaps(facet_length, entries.rounding) && !may_overlap {
            return Err(Error::input(format!(
                "nodes {} and {} overlap by {:.3e} in the mesh; move the bodies apart, or say \
                 `overlap = true` where that is an interference",
                mesh.node_label(faced),
                mesh.node_label(pair.slave),
                -pair.gap
            )));
        }
    }
    Ok(())
}

/// Finds pairs of nodes that face each other, or takes given pairs; `None` if nodes do not match.
///
/// # Errors
/// Surfaces that are not one curve; pairs that share a node, overlap or are invalid.
pub(super) fn pairs(entries: &ContactInput, given: Option<&[NodePair]>) -> Result<Option<Found>> {
    let (mesh, contact) = (entries.mesh, &entries.contact);
    // As in the paper, the normal is that of the second body.
    let slave = match contact.slave {
        SlaveSide::First if given.is_none() => 0,
        _ => 1,
    };
    let [master_surface, slave_surface] = [entries.surfaces[1 - slave], entries.surfaces[slave]];
    let master_nodes = nodes(mesh, master_surface)?;
    let slave_nodes = nodes(mesh, slave_surface)?;
    let normal = match contact.normal {
        Some(n) => vec![entries.towards_master(direction(n.vector()), slave); slave_nodes.len()],
        None => normals(mesh, slave_surface, &slave_nodes),
    };
    let facet_length = longest_facet(mesh, master_surface).max(longest_facet(mesh, slave_surface));
    let tolerance = PAIRING * facet_length;
    let partner_of: Vec<Option<Partner>> = match given {
        Some(given) => {
            let names = [contact.first.as_str(), contact.second.as_str()];
            let nodes = [&*master_nodes, &*slave_nodes];
            partners(given, mesh, names, nodes, &normal)?
        }
        None => faced(mesh, [&master_nodes, &slave_nodes], &normal, tolerance),
    };

    // Beyond the end of the shorter surface there is nothing to press on, but given pairs are kept
    // in any case.
    let touching: BTreeSet<usize> = slave_nodes
        .iter()
        .zip(&partner_of)
        .filter(|(_, partner)| given.is_some() || partner.is_some())
        .map(|(&node, _)| node)
        .collect();
    let areas = nodal_areas(entries, slave_surface, &touching);

    let mut taken = vec![false; master_nodes.len()];
    let mut is_complete = true;
    let mut arc = 0.0;
    let mut pairs = Vec::new();
    for (j, &node) in slave_nodes.iter().enumerate() {
        let x = mesh.point(node);
        if j > 0 && !mesh.is_solid() {
            arc += length(difference(x, mesh.point(slave_nodes[j - 1])));
        }
        match partner_of[j] {
            Some(partner) if !taken[partner.first] => {
                taken[partner.first] = true;
                let area = areas.get(&node).copied().unwrap_or(0.0);
                let faced = master_nodes[partner.first];
                pairs.push(pair_of(entries, [node, faced], &partner, [area, arc])?);
            }
            _ => is_complete = false,
        }
    }
    // One surface may reach beyond the other, but the shorter one must pair completely, facet by
    // facet, unless pairs are given.
    is_complete |= taken.iter().all(|taken| *taken);
    let match_up = || facets_match(mesh, [master_surface, slave_surface], &pairs);
    if given.is_none() && (pairs.is_empty() || !is_complete || !match_up()) {
        return Ok(None);
    }
    if pairs.is_empty() {
        return Err(Error::input(
            "no pair of nodes is given; name some, or leave them out to have the surfaces paired",
        ));
    }
    check(entries, &pairs, facet_length)?;
    Ok(Some(Found::new(pairs, slave, facet_length)))
}

/// The pair of a slave node and the master node that it faces, with the area of the slave and its
/// arc length along the surface.
fn pair_of(
    entries: &ContactInput,
    [slave, faced]: [usize; 2],
    partner: &Partner,
    [area, arc]: [f64; 2],
) -> Result<Pair> {
    let mesh = entries.mesh;
    let apart = difference(mesh.point(faced), mesh.point(slave));
    let geometric = dot(apart, partner.normal);
    Ok(Pair {
        contact: entries.index,
        slave,
        masters: vec![(faced, 1.0)],
        normal: partner.normal,
        gap: match partner.gap {
            Some(gap) => gap,
            None => entries.stated.gap(slave)?.unwrap_or(geometric),
        },
        interference: entries.stated.interference(slave)?,
        unit_gap: 1.0,
        area,
        arc,
    })
}

/// Whether fully paired facets match: each facet of either surface whose nodes all have a partner
/// faces a facet of the other.
fn facets_match(mesh: &Mesh, [master, slave]: [&Surface; 2], pairs: &[Pair]) -> bool {
    let partner: BTreeMap<usize, usize> = (pairs.iter())
        .map(|pair| (pair.slave, pair.masters[0].0))
        .collect();
    let is_faced: BTreeSet<usize> = partner.values().copied().collect();
    let sorted = |nodes: Option<Vec<usize>>| {
        let mut nodes = nodes?;
        nodes.sort_unstable();
        Some(nodes)
    };
    let own = |facet| {
        mesh.facet_nodes(facet)
            .map(|n| Some(n).filter(|n| is_faced.contains(n)))
    };
    let across = |facet| mesh.facet_nodes(facet).map(|n| partner.get(&n).copied());
    let masters = master
        .facets
        .iter()
        .filter_map(|&f| sorted(own(f).collect()));
    let slaves = slave
        .facets
        .iter()
        .filter_map(|&f| sorted(across(f).collect()));
    masters.collect::<BTreeSet<_>>() == slaves.collect::<BTreeSet<_>>()
}

/// Integrals of each node's shape function over the facets of a surface whose nodes are all among
/// `faces`.
pub(super) fn nodal_areas(
    entries: &ContactInput,
    surface: &Surface,
    faces: &BTreeSet<usize>,
) -> BTreeMap<usize, f64> {
    let mesh = entries.mesh;
    let mut areas: BTreeMap<usize, f64> = BTreeMap::new();
    for &facet in &surface.facets {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        if !nodes.iter().all(|node| faces.contains(node)) {
            continue;
        }
        let x: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n)).collect();
        let reference = mesh.facet_reference(facet);
        for point in facet_points(entries.space, reference, &x) {
            for (&node, value) in nodes.iter().zip(&point.values) {
                *areas.entry(node).or_default() += point.weight * value;
            }
        }
    }
    areas
}
