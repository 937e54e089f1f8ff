//! Floating bodies: whether supports, contact alone or nothing holds each body.
//!
//! Rigid motions of all bodies together are tested against the supports and, bilaterally, the
//! contact pairs. A motion that both leave free causes an error that names the body and the motion,
//! unless no load does work on it: then one freedom is pinned, which affects only the free motion.
//! A round body is pinned too if a load turns it no more than its flat facets explain; the pin then
//! bears this small load. So is a body that slides along a plane or turns about the centre of a
//! round surface, if nothing but small deviations of nodes and facets from these shapes holds this
//! motion.

use super::far_boundary::{FarBoundary, StoppedMotion};
use super::motions::{self, FREE, Forces, Mode, Motions};
use super::rigid_motion::RigidMotion;
use super::smooth_surfaces::SmoothSurfaces;
use super::{ContactRows, ContactSurface, Freedoms, LoadCase, Pair, far_boundary, springs};
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::Mesh;
use crate::number::significant;
use crate::space::Space;
use std::collections::{BTreeMap, BTreeSet};

/// Bodies that are not held by supports alone, and their rigid motions.
#[derive(Debug, Clone, Default)]
pub struct FloatingBodies {
    /// Whether each contact freedom belongs to a floating body.
    pub of_contact: Vec<bool>,
    /// Names of the floating bodies.
    pub bodies: Vec<String>,
    /// Motions that were pinned.
    pub pins: Vec<Pin>,
    /// Basis of the rigid motions that supports and pins leave free.
    pub motions: Vec<RigidMotion>,
    /// Part of the model to which each contact freedom belongs; a part is a set of bodies that
    /// share nodes or free motions, or that ties or equations join.
    pub part_of_contact: Vec<usize>,
}

impl FloatingBodies {
    /// Free freedoms of parts of the model that have no other freedoms than their rigid motions.
    pub(super) fn rigid_freedoms(&self) -> BTreeSet<usize> {
        let mut of_part: BTreeMap<usize, (usize, BTreeSet<usize>)> = BTreeMap::new();
        for motion in &self.motions {
            let (n_motions, freedoms) = of_part.entry(motion.part).or_default();
            *n_motions += 1;
            freedoms.extend(motion.values.iter().map(|&(freedom, _)| freedom as usize));
        }
        let only = of_part
            .into_values()
            .filter(|(n, freedoms)| *n == freedoms.len());
        only.flat_map(|(_, freedoms)| freedoms).collect()
    }
}

/// A freedom that was pinned because nothing else held it and no load does work on its motion,
/// apart from what the facets of a round surface explain.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// Description of the motion in words.
    pub motion: String,
    /// Name of the load that does the most work on the motion, and the ratio of this work to the
    /// size of the load. The flat facets of a round surface explain this work. `None` if no load
    /// does work on the motion.
    pub driven: Option<(String, f64)>,
    /// Whether contact holds the motion a little, because a surface is not exactly flat or round.
    pub is_held_by_deviations: bool,
    /// Node of the pinned freedom.
    pub node: usize,
}

/// Work that counts as zero, relative to the sum of the sizes of its terms. A free motion moves
/// pairs by up to [`FREE`] of its own displacement, so the centre of a round surface is known no
/// more accurately, and a load through the centre does about that much work.
const NO_WORK_FOUND: f64 = 10.0 * FREE;

/// Fraction of the largest singular value below which contact holds a motion weakly: the fourth
/// root of the round-off. The matrix of contact has a condition of the square of its inverse, with
/// which half of all digits are lost.
const WEAK: f64 = 1.2e-4;

impl Pin {
    fn in_words(&self, mesh: &Mesh) -> String {
        let Pin {
            motion,
            driven,
            is_held_by_deviations,
            node,
        } = self;
        let node = mesh.node_label(*node);
        let (held, deviations) = match is_held_by_deviations {
            true => (
                "only deviations of a surface from its plane or round shape hold this motion",
                "these deviations",
            ),
            false => (
                "nothing holds this motion",
                "flat facets of a round surface",
            ),
        };
        match driven {
            None => format!("{motion}: {held} and no load drives it; it is held at node {node}"),
            Some((load, share)) => format!(
                "{motion}: {held}, and load `{load}` drives it by {} of its size, no more than \
                 {deviations} explain; it is held at node {node}, which carries this small load",
                significant(*share, 2)
            ),
        }
    }
}

/// A motion that was pinned, with the node and the number of the axis that are held.
type Pinned = (Mode, usize, usize);

/// Finds the floating bodies, and the contact rows on the freedoms that pins leave free.
pub(super) fn resolve(
    space: Space,
    mesh: &Mesh,
    freedoms: &mut Freedoms,
    (pairs, contacts): (&[Pair], &[ContactSurface]),
    loads: &[LoadCase],
    warnings: &mut Vec<String>,
) -> Result<(FloatingBodies, ContactRows)> {
    let motions = Motions::new(space, mesh, freedoms.basis.clone());
    let mut floating = FloatingBodies::default();
    let mut is_floating = vec![false; motions.names.len()];
    for mode in &motions.free(freedoms, &[]) {
        for group in motions.moved(mode) {
            is_floating[group] = true;
        }
    }
    let pinned = pin(&motions, freedoms, pairs, loads, &mut floating.pins)?;
    warnings.extend(floating.pins.iter().map(|pin| pin.in_words(mesh)));
    springs::add(freedoms, pairs, contacts);
    let rows = ContactRows::of(mesh, freedoms, pairs)?;
    let owner = |&freedom: &usize| motions.group_of_node[freedoms.owners[freedom].0 as usize];
    let group_of_contact: Vec<usize> = rows.freedoms.iter().map(owner).collect();
    let floats = |&group: &usize| is_floating[group];
    floating.of_contact = group_of_contact.iter().map(floats).collect();
    let bodies = motions.names.iter().zip(&is_floating);
    let bodies = bodies.filter(|(_, floats)| **floats);
    floating.bodies = bodies
        .flat_map(|(names, _)| names.iter().cloned())
        .collect();
    let modes = motions.free(freedoms, &[]);
    let part = motions.parts(&modes, freedoms);
    floating.part_of_contact = group_of_contact.iter().map(|&group| part[group]).collect();
    let owned = motions::owned(freedoms, mesh.n_nodes());
    let motion_of = |mode: &Mode| {
        let group = *motions.moved(mode).first()?;
        Some(RigidMotion {
            part: part[group],
            values: motions.on_freedoms(mode, freedoms, &owned),
            in_far_boundary: Vec::new(),
        })
    };
    floating.motions = modes.iter().filter_map(motion_of).collect();
    let part_of_node: Vec<usize> = motions.group_of_node.iter().map(|&g| part[g]).collect();
    let pins: Vec<(usize, usize)> = pinned.iter().map(|&(_, node, at)| (node, at)).collect();
    let stopped = pinned.iter().filter_map(|(mode, ..)| {
        let groups = motions.moved(mode);
        let mut values = motions.on_freedoms(mode, freedoms, &owned);
        for (k, &(node, local)) in pins.iter().enumerate() {
            if groups.contains(&motions.group_of_node[node]) {
                let value = motions.along(mode, node, freedoms.local(node)[local], 0.0);
                values.push(((freedoms.n + k) as u32, value));
            }
        }
        let part = part[*groups.first()?];
        Some(StoppedMotion { part, values })
    });
    let far = FarBoundary {
        part_of_node: &part_of_node,
        volumes: far_boundary::volumes_of_nodes(space, mesh),
        freedoms,
        stopped: stopped.collect(),
        pins: &pins,
    };
    let forces = motions.forces(loads);
    let work = |j: usize| motions.work(&modes[j], &forces);
    far.measure(&mut floating.motions, loads, work);
    Ok((floating, rows))
}

/// Pins a freedom of each rigid motion that neither supports nor contact hold.
///
/// # Errors
/// `Unheld`, naming the body, the motion, and the load that does work on it.
fn pin(
    motions: &Motions,
    freedoms: &mut Freedoms,
    pairs: &[Pair],
    loads: &[LoadCase],
    pins: &mut Vec<Pin>,
) -> Result<Vec<Pinned>> {
    let forces = motions.forces(loads);
    let contact: BTreeSet<usize> = pairs.iter().flat_map(Pair::nodes).collect();
    let mut smooth: Option<SmoothSurfaces> = None;
    let mut pinned = Vec::new();
    for _ in 0..motions.per_group() * motions.names.len() {
        let mut free = motions.free(freedoms, pairs);
        let are_weak = free.is_empty();
        if are_weak {
            free = motions.held_by_less(freedoms, pairs, WEAK);
            free.retain(|mode| {
                let surfaces = smooth.get_or_insert_with(|| SmoothSurfaces::of(motions.mesh));
                let driven = most_driving(motions, mode, &forces, loads).map_or(0.0, |of| of.1);
                let deviation = surfaces.holding(motions, mode, pairs);
                deviation.is_some_and(|deviation| driven <= deviation)
            });
        }
        if free.is_empty() {
            break;
        }
        // Motions that have no body in common stay free when one of them is pinned, so all of them
        // are pinned at once.
        let mut moved = vec![false; motions.names.len()];
        for mode in &free {
            let groups = motions.moved(mode);
            if groups.iter().any(|&group| moved[group]) {
                continue;
            }
            groups.iter().for_each(|&group| moved[group] = true);
            let motion = motions.describe(mode);
            let unheld = |why: String| Error::new(ErrorKind::Unheld, format!("{motion}: {why}"));
            let driven = most_driving(motions, mode, &forces, loads);
            let mut is_explained = |share: f64| {
                let surfaces = smooth.get_or_insert_with(|| SmoothSurfaces::of(motions.mesh));
                are_weak || share <= surfaces.work_of_facets(motions, mode)
            };
            if let Some((load, share)) = driven.filter(|(_, share)| !is_explained(*share)) {
                let how_much = match share < 0.01 {
                    true => format!(" by {} of its size", significant(share, 2)),
                    false => String::new(),
                };
                return Err(unheld(format!(
                    "neither supports nor contact hold this motion, and load `{}` drives \
                     it{how_much}; add a support or a contact",
                    loads[load].name,
                )));
            }
            let driven = driven.map(|(load, share)| (loads[load].name.clone(), share));
            let freedom = motions.largest(mode, freedoms, &contact);
            let freedom = freedom.ok_or_else(|| unheld("nothing holds this motion".to_string()))?;
            let (node, local) = freedoms.owners[freedom];
            pinned.push((mode.clone(), node as usize, local as usize));
            let node = node as usize;
            pins.push(Pin {
                motion,
                driven,
                is_held_by_deviations: are_weak,
                node,
            });
            freedoms.pin(freedom);
        }
    }
    Ok(pinned)
}

/// Finds the load that does most work on a mode relative to the load's size, and returns this ratio
/// too; `None` if all ratios are round-off. Loads of one history always act together, so that their
/// work is added; of these, the one with most work is returned.
fn most_driving(
    motions: &Motions,
    mode: &Mode,
    forces: &Forces,
    loads: &[LoadCase],
) -> Option<(usize, f64)> {
    // For each history: the load with most work, that work, the sum of works, and that of sizes.
    let mut together: Vec<(usize, f64, f64, f64)> = Vec::new();
    for (load, work) in motions.work(mode, forces) {
        let size = motions.size(mode, forces, load) * mode.largest();
        let acts_with = |other: &usize| loads[*other].history == loads[load].history;
        match together.iter_mut().find(|sums| acts_with(&sums.0)) {
            Some(sums) => {
                if work.abs() > sums.1 {
                    (sums.0, sums.1) = (load, work.abs());
                }
                sums.2 += work;
                sums.3 += size;
            }
            None => together.push((load, work.abs(), work, size)),
        }
    }
    let shares = together.into_iter();
    let shares = shares.map(|(load, _, work, size)| (load, work.abs() / size));
    let driving = shares.filter(|(_, share)| *share > NO_WORK_FOUND);
    driving.max_by(|a, b| a.1.total_cmp(&b.1))
}
