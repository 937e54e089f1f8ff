//! State that one leg of the load program hands to the next, in which other supports hold the
//! model.
//!
//! In every leg, displacements are counted from the start of the program. If a leg begins at the
//! load factor `a` with the displacements `u_a`, then
//!
//! ```text
//! a support that begins         u(t) = u_a
//! a prescribed displacement     u(t) = u_a (b - t)/(b - a) + u_b (t - a)/(b - a),   a <= t <= b
//! that begins                   with the next row of its history, u_b at b
//! a support that ends           f(t) = f_a (c - t)/(c - a),   a <= t <= c
//! ```
//!
//! where `f_a` are the forces of the support when it ends, and `c` is the load factor at which they
//! have fallen to zero. The displacements `u_a` and the support forces are load cases of their own.

use crate::scene::{Load, Scene};
use crate::space::Vector;
use serde::{Deserialize, Serialize};

/// State that one leg of the load program hands to the next.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Carried {
    /// Load factor at which the next leg begins.
    pub(crate) at: f64,
    /// Displacements of all nodes.
    pub(super) displacements: Vec<Vector>,
    /// Forces of supports that have ended.
    pub(super) released: Vec<Released>,
}

/// Forces of supports that have ended.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Released {
    /// Load factors at which the supports ended and at which their forces have fallen to zero.
    pub(super) until: [f64; 2],
    /// Force on the control point of each node.
    pub(super) forces: Vec<(usize, Vector)>,
}

impl Carried {
    /// Whether all displacements and forces belong to a mesh with `n_nodes` nodes.
    pub(super) fn is_of(&self, n_nodes: usize) -> bool {
        let forces = self.released.iter().flat_map(|released| &released.forces);
        let mut nodes = forces.map(|(node, _)| *node);
        self.displacements.len() == n_nodes && nodes.all(|node| node < n_nodes)
    }

    /// Number of the load case of the displacements at which supports begin to hold nodes.
    pub(super) fn held_case(scene: &Scene) -> usize {
        scene.load.len()
    }

    /// Displacement of a node at the beginning of the leg.
    pub(super) fn of_node(&self, node: usize) -> Vector {
        self.displacements[node]
    }

    /// Loads of the scene whose nodes still move from where the leg found them to the value of the
    /// load's history. Each load comes with the number of the load case of the initial
    /// displacements and the load factor of arrival.
    pub(super) fn on_their_way(&self, scene: &Scene) -> Vec<(usize, usize, f64)> {
        let is_on_its_way = |load: &Load| {
            let arrives = load.arrives().filter(|arrives| self.at < *arrives);
            arrives.filter(|_| load.span().holds_from(self.at))
        };
        let loads = scene.load.iter().enumerate();
        let found = loads.filter_map(|(index, load)| Some((index, is_on_its_way(load)?)));
        let first = Self::held_case(scene) + 1;
        let numbered = found.enumerate();
        numbered
            .map(|(k, (index, arrives))| (index, first + k, arrives))
            .collect()
    }

    /// Displacement that a load of the scene prescribes at a node, as numbers of load cases with
    /// their values: `before` alone if the load holds the node where it is, or shares of `before`
    /// and of the load's `value` at factor 1 while the node is on its way. `None` if the load
    /// prescribes the value alone, or does not hold in this leg.
    pub(super) fn taken_over(
        &self,
        scene: &Scene,
        load: usize,
        [value, before]: [f64; 2],
    ) -> Option<Vec<(usize, f64)>> {
        let entry = &scene.load[load];
        if entry.stays() && entry.span().holds_from(self.at) {
            return Some(vec![(Self::held_case(scene), before)]);
        }
        let mut all = self.on_their_way(scene).into_iter();
        let (_, origin, _) = all.find(|(index, ..)| *index == load)?;
        Some(vec![(load, value), (origin, before)])
    }
}
