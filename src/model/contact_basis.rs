//! Displacements of quadratic faces in contact, expressed by control points.
//!
//! A uniform pressure pulls at the corners of a face with eight nodes (their weight is -1/12 of the
//! area) and does not act on the corners of a face with six nodes, so no contact condition can be
//! stated at these corners. In the basis
//!
//! ```text
//! phi_c = N_c + alpha sum N_m (edges at c),   phi_m = (1 - 2 alpha) N_m,   alpha = 1/5
//! u_m = (1 - 2 alpha) q_m + alpha (q_c1 + q_c2),   u_c = q_c
//! ```
//!
//! all weights are positive: corners and middles have 1/20 and 1/5 of the area of a face with eight
//! nodes, and 2/15 and 1/5 of a face with six. Bodies touch where their control points `q` touch.
//! Freedoms and forces of such faces belong to the control points. The coefficients add up to 1, so
//! a rigid motion of the body moves its control points like any of its other points.
//!
//! # Source
//! A. Popp, B. Wohlmuth, M. Gee, W. Wall, *Dual quadratic mortar finite element methods for 3D
//! finite deformation contact*, SIAM J. Sci. Comput. 34 (2012) B421, doi:10.1137/110848190.

use super::pairs::resolved_tie::ResolvedTie;
use super::pairs::{ContactSurface, Pair};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::space::{Vector, along, dot};
use std::collections::BTreeMap;

/// Weight of each end of an edge in the displacement of the middle of the edge.
const ALPHA: f64 = ContactBasis::ALPHA;
/// Weight of the middle's own control point in the displacement of the middle.
const OWN: f64 = 1.0 - 2.0 * ALPHA;

/// The middle nodes of the edges of quadratic faces in contact, each with the ends of its edge.
#[derive(Debug, Clone, Default)]
pub struct ContactBasis {
    ends: BTreeMap<usize, [usize; 2]>,
}

impl ContactBasis {
    /// Weight of each end of an edge in the displacement of the middle of the edge.
    pub const ALPHA: f64 = 0.2;

    /// Finds the basis for the pairs and ties of a solid model. The basis covers the faces of the
    /// slaves, master faces that match them node by node, and the slave faces of ties.
    ///
    /// # Errors
    /// `Input` if the middle node of an edge faces a node that is not one, if matching faces have
    /// different edges, or if a slave of a contact of single nodes is the middle of an edge in the
    /// basis.
    pub(super) fn of(
        mesh: &Mesh,
        pairs: &[Pair],
        contacts: &[ContactSurface],
        ties: &[ResolvedTie],
    ) -> Result<Self> {
        let mut basis = ContactBasis::default();
        if !mesh.is_solid() {
            return Ok(basis);
        }
        for tie in ties {
            let surface = mesh.surfaces.get(&tie.slaves);
            basis
                .ends
                .extend(surface.map(|s| middles(mesh, s)).unwrap_or_default());
        }
        for contact in contacts {
            let [masters, slaves] = [1 - contact.slave, contact.slave].map(|side| {
                let surface = mesh.surfaces.get(&contact.names[side]);
                surface.map(|s| middles(mesh, s)).unwrap_or_default()
            });
            let pairs = &pairs[contact.range.clone()];
            if contact.is_partial {
                continue;
            }
            if pairs.iter().any(|pair| pair.faced().is_none()) {
                basis.ends.extend(slaves);
                continue;
            }
            let faced_by: BTreeMap<usize, usize> = (pairs.iter())
                .filter_map(|pair| Some((pair.slave, pair.faced()?)))
                .collect();
            for (&slave, &faced) in &faced_by {
                let (own, opposite) = match (slaves.get(&slave), masters.get(&faced)) {
                    (None, None) => continue,
                    (Some(own), Some(opposite)) => (*own, *opposite),
                    _ => return Err(differ(mesh, contact, [faced, slave])),
                };
                let across = own.map(|end| faced_by.get(&end).copied());
                let [a, b] = opposite.map(Some);
                if across != [a, b] && across != [b, a] {
                    return Err(differ(mesh, contact, [faced, slave]));
                }
                basis.ends.insert(slave, own);
                basis.ends.insert(faced, opposite);
            }
        }
        let single = contacts.iter().filter(|contact| contact.is_partial);
        let mut single = single.flat_map(|contact| &pairs[contact.range.clone()]);
        match single.find(|pair| basis.ends(pair.slave).is_some()) {
            None => Ok(basis),
            Some(pair) => Err(Error::input(format!(
                "node {} is the middle of an edge and a contact node of its own, but the edge \
                 is in another contact or tied, too: take it out of one of them",
                mesh.node_label(pair.slave)
            ))),
        }
    }

    /// Whether all control points coincide with nodes.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Ends of the edge of which a node is the middle; `None` for all other nodes.
    #[inline]
    pub fn ends(&self, node: usize) -> Option<[usize; 2]> {
        if self.ends.is_empty() {
            return None;
        }
        self.ends.get(&node).copied()
    }

    /// All middle nodes with the ends of their edges.
    pub fn edges(&self) -> impl Iterator<Item = (usize, [usize; 2])> + '_ {
        self.ends.iter().map(|(&node, &ends)| (node, ends))
    }

    /// Weight of a node's own control point in the displacement of the node.
    pub(super) fn own_weight(&self, node: usize) -> f64 {
        if self.ends(node).is_some() { OWN } else { 1.0 }
    }

    /// Calls `of` with each control point, and its weight, in the displacement of a node.
    #[inline]
    pub(super) fn each_control(&self, node: usize, mut of: impl FnMut(usize, f64)) {
        match self.ends(node) {
            None => of(node, 1.0),
            Some(ends) => {
                of(node, OWN);
                ends.into_iter().for_each(|end| of(end, ALPHA));
            }
        }
    }

    /// Vector at a node, from the vectors at control points.
    #[inline]
    pub(crate) fn at_node(&self, node: usize, control: impl Fn(usize) -> Vector) -> Vector {
        match self.ends(node) {
            None => control(node),
            Some([a, b]) => {
                let own = control(node).map(|v| OWN * v);
                along(along(own, ALPHA, control(a)), ALPHA, control(b))
            }
        }
    }

    /// Vector at a control point, from the vectors at nodes.
    pub(crate) fn at_control(&self, node: usize, value: impl Fn(usize) -> Vector) -> Vector {
        match self.ends(node) {
            None => value(node),
            Some([a, b]) => {
                let rest = along(along(value(node), -ALPHA, value(a)), -ALPHA, value(b));
                rest.map(|v| v / OWN)
            }
        }
    }

    /// Number at a control point, from the numbers at nodes.
    pub(super) fn number_at_control(&self, node: usize, value: impl Fn(usize) -> f64) -> f64 {
        self.at_control(node, |node| [value(node), 0.0, 0.0])[0]
    }

    /// Converts forces on nodes to forces on control points.
    pub fn share(&self, forces: &mut [Vector]) {
        for (node, ends) in self.edges() {
            let own = forces[node];
            forces[node] = own.map(|f| OWN * f);
            for end in ends {
                forces[end] = along(forces[end], ALPHA, own);
            }
        }
    }

    /// Converts forces on control points to forces on nodes: the inverse of
    /// [`ContactBasis::share`].
    pub(crate) fn gather(&self, forces: &mut [Vector]) {
        for (node, ends) in self.edges() {
            let own = forces[node].map(|f| f / OWN);
            forces[node] = own;
            for end in ends {
                forces[end] = along(forces[end], -ALPHA, own);
            }
        }
    }

    /// Converts forces on some nodes as [`ContactBasis::share`] does.
    pub(super) fn share_of(&self, forces: Vec<(usize, Vector)>) -> Vec<(usize, Vector)> {
        if self.ends.is_empty() {
            return forces;
        }
        let mut out: BTreeMap<usize, Vector> = BTreeMap::new();
        for (node, force) in forces {
            self.each_control(node, |control, weight| {
                let sum = out.entry(control).or_default();
                *sum = along(*sum, weight, force);
            });
        }
        out.into_iter().collect()
    }

    /// Converts terms whose sum is the displacement of a node along a direction to terms whose sum
    /// is the displacement of its control point. The middle of an edge moves by
    /// `u = w q + sum w_e q_e`, with a sum over the ends `e` of the edge, so its control point
    /// moves by `q = (u - sum w_e q_e) / w`.
    pub(super) fn at_control_point(
        &self,
        node: usize,
        direction: Vector,
        terms: Vec<(usize, Vector)>,
    ) -> Vec<(usize, Vector)> {
        let mut terms = self.share_of(terms);
        if let Some(ends) = self.ends(node) {
            terms.extend(ends.map(|end| (end, direction.map(|x| -ALPHA * x))));
            terms.iter_mut().for_each(|(_, v)| *v = v.map(|x| x / OWN));
        }
        terms
    }

    /// Converts gaps, interferences and areas of node-to-node pairs from nodes to control points.
    /// In other pairs the weights of the masters are converted.
    pub(super) fn restate(&self, pairs: &mut [Pair], contacts: &[ContactSurface]) {
        if self.ends.is_empty() {
            return;
        }
        for contact in contacts {
            let pairs = &mut pairs[contact.range.clone()];
            let are_nodes = || pairs.iter().all(|pair| pair.faced().is_some());
            if contact.is_rigid || !contact.is_partial && are_nodes() {
                self.restate_nodes(pairs);
                continue;
            }
            for pair in pairs {
                let weights = |&(node, weight): &(usize, f64)| (node, [weight, 0.0, 0.0]);
                let shared = self.share_of(pair.masters.iter().map(weights).collect());
                pair.masters = shared.into_iter().map(|(node, w)| (node, w[0])).collect();
            }
        }
    }

    fn restate_nodes(&self, pairs: &mut [Pair]) {
        let place: BTreeMap<usize, usize> = (pairs.iter().enumerate())
            .map(|(k, p)| (p.slave, k))
            .collect();
        let nodes = pairs.to_vec();
        for pair in pairs.iter_mut() {
            let along_normal = |size: fn(&Pair) -> f64| {
                let vector = |node: usize| {
                    let of = &nodes[place[&node]];
                    of.normal.map(|n| size(of) * n)
                };
                dot(self.at_control(pair.slave, vector), pair.normal)
            };
            (pair.gap, pair.interference, pair.unit_gap) = (
                along_normal(|p| p.gap),
                along_normal(|p| p.interference),
                along_normal(|p| p.unit_gap),
            );
        }
        for (k, node) in nodes.iter().enumerate() {
            if let Some(ends) = self.ends(node.slave) {
                pairs[k].area -= (1.0 - OWN) * node.area;
                for end in ends {
                    pairs[place[&end]].area += ALPHA * node.area;
                }
            }
        }
    }
}

/// Finds the middle nodes of the edges of a surface's faces, each with the ends of its edge.
fn middles(mesh: &Mesh, surface: &Surface) -> BTreeMap<usize, [usize; 2]> {
    let mut out = BTreeMap::new();
    for &facet in &surface.facets {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        let corners = mesh.facet_corners(facet);
        for (i, &middle) in nodes[corners..].iter().enumerate() {
            out.insert(middle, [nodes[i], nodes[(i + 1) % corners]]);
        }
    }
    out
}

fn differ(mesh: &Mesh, contact: &ContactSurface, nodes: [usize; 2]) -> Error {
    let [first, second] = &contact.names;
    let [a, b] = nodes.map(|node| mesh.node_label(node));
    Error::input(format!(
        "contact of `{first}` and `{second}`: nodes {a} and {b} face each other, but one is the \
         middle of an edge and the other is not that of the edge opposite; mesh both surfaces with \
         the same faces"
    ))
}
