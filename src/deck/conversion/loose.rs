//! Nodes without elements, such as reference nodes. Their displacements and forces are sums of
//! those of other nodes, which are recorded here for the tables that list them.

use super::super::constraints::{HeldPlane, LocalAxes};
use super::super::facets::Key;
use super::super::history::{Map, sum_of};
use super::super::linear::{FreedomCoefficients, LinearRow, Reduced};
use super::super::mesh::DeckMesh;
use super::Geometry;
use crate::scene::{LooseAxis, LooseNode};
use std::collections::BTreeMap;

/// Nodes without elements, with the sums that their displacements and forces are.
pub(super) struct LooseNodes<'c> {
    pub(super) mesh: &'c DeckMesh,
    pub(super) geometry: &'c Geometry,
    /// Local axes of nodes whose displacements are taken along x, y and z here; tables are in the
    /// local axes nevertheless.
    pub(super) given_up: &'c LocalAxes,
    /// The sums by node number.
    pub(super) sums: BTreeMap<u64, LooseNode>,
}

impl LooseNodes<'_> {
    /// Records the forces of nodes without elements. With the row `sum c_k u_k = 0`, whose first
    /// term `i` is of a node with elements, the force on a node `l` without elements is
    /// `-c_l / c_i f_i`. In the rows of a rigid body these are the sums of the forces on its nodes
    /// and of their moments.
    pub(super) fn record_forces(&mut self, planes: &[HeldPlane], rows: &[LinearRow]) {
        for row in rows {
            let Some(first) = row.first.filter(|first| self.geometry.uses(first.0)) else {
                continue;
            };
            let c = row.terms.get(&first).copied().unwrap_or(0.0);
            if c != 0.0 {
                for (key, of) in &row.terms {
                    self.add_force(*key, first, -of / c);
                }
            }
        }
        for plane in planes {
            let followers = plane.nodes.iter().filter(|node| self.geometry.uses(**node));
            let followers: Vec<Key> = followers.map(|&node| (node, plane.leader.1)).collect();
            for follower in followers {
                self.add_force(plane.leader, follower, 1.0);
            }
        }
    }

    fn add_force(&mut self, key: Key, (node, axis): Key, share: f64) {
        let terms = self.along_own_axes((node, axis), share);
        if let Some(loose) = self.axis(key) {
            loose.force.extend(terms);
        }
    }

    /// The terms of a displacement or a force in the axes of its node: the node's number, the axis
    /// and the coefficient.
    fn along_own_axes(&self, (node, axis): Key, c: f64) -> Vec<(u64, u8, f64)> {
        let label = self.mesh.node_label(node as usize);
        match self.given_up.get(&node) {
            None => vec![(label, axis, c)],
            Some(own) => (0..3u8)
                .zip(own)
                .map(|(of, way)| (label, of, c * way[axis as usize]))
                .collect(),
        }
    }

    /// Records the displacements of nodes without elements, after the reduction of the equations
    /// in which they occur.
    pub(super) fn record_displacements(
        &mut self,
        planes: &[HeldPlane],
        reduced: &Reduced,
        boundary: &Map,
    ) {
        let alone = |key: Key| FreedomCoefficients::from([(key, 1.0)]);
        for plane in planes {
            let key = plane.leader;
            for &node in plane.nodes.iter().filter(|node| **node != key.0) {
                self.displace((node, key.1), &alone(key), boundary);
            }
            let follower = plane.nodes.iter().find(|node| self.geometry.uses(**node));
            let of = match follower.filter(|_| !boundary.contains_key(&key)) {
                Some(&follower) => (follower, key.1),
                None => key,
            };
            self.displace(key, &alone(of), boundary);
        }
        for key in boundary.keys() {
            self.displace(*key, &alone(*key), boundary);
        }
        for follows in &reduced.loose {
            self.displace(follows.key, &follows.of, boundary);
        }
    }

    fn displace(&mut self, key: Key, terms: &FreedomCoefficients, boundary: &Map) {
        let prescribed = sum_of(terms, boundary);
        let free = terms.iter().filter(|(key, _)| !boundary.contains_key(key));
        let free: Vec<(u64, u8, f64)> = free
            .filter(|(key, _)| self.geometry.uses(key.0))
            .flat_map(|(key, c)| self.along_own_axes(*key, *c))
            .collect();
        if let Some(loose) = self.axis(key) {
            loose.displacement = free;
            loose.prescribed = prescribed.rows().to_vec();
        }
    }

    /// The sums of a node along an axis; `None` if it belongs to an element, or if it is the
    /// rotation of a reference node, which has no number.
    fn axis(&mut self, (node, axis): Key) -> Option<&mut LooseAxis> {
        let is_node = (node as usize) < self.mesh.n_nodes();
        if !is_node || self.geometry.uses(node) {
            return None;
        }
        let label = self.mesh.node_label(node as usize);
        self.sums
            .entry(label)
            .or_default()
            .axes
            .get_mut(axis as usize)
    }
}
