//! What one leg of the program leaves to the next, in which other supports hold the model.
//!
//! Displacements are total ones in every leg. At the load factor `a` at which a leg begins, with
//! displacements `u_a`:
//!
//! ```text
//! a support that begins         u(t) = u_a
//! a prescribed displacement     u(t) = u_a (b - t)/(b - a) + u_b (t - a)/(b - a),   a <= t <= b
//! that begins                   with the next row of its history, u_b at b
//! a support that ends           f(t) = f_a (c - t)/(c - a),   a <= t <= c
//! ```
//!
//! with the support forces `f_a` at its end, and the load factor `c` at which they have been taken
//! away. The displacements `u_a`, and the support forces, are load cases of their own.

use crate::scene::{Load, Scene};
use crate::space::Vector;
use serde::{Deserialize, Serialize};

/// What one leg of the program leaves to the next.
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
    /// Load factors at which the supports ended, and at which nothing is left of the forces.
    pub(super) until: [f64; 2],
    /// Force on the control point of each node.
    pub(super) forces: Vec<(usize, Vector)>,
}

impl Carried {
    /// Whether all data are those of a mesh with so many nodes.
    pub(super) fn is_of(&self, n_nodes: usize) -> bool {
        let forces = self.released.iter().flat_map(|released| &released.forces);
        let mut nodes = forces.map(|(node, _)| *node);
        self.displacements.len() == n_nodes && nodes.all(|node| node < n_nodes)
    }

    /// Number of the load case of supports that hold nodes where they were.
    pub(super) fn held_case(scene: &Scene) -> usize {
        scene.load.len()
    }

    /// Displacement of a node at the beginning of the leg.
    pub(super) fn of_node(&self, node: usize) -> Vector {
        self.displacements[node]
    }

    /// Loads of the scene whose nodes are on their way to the values of their histories, with the
    /// number of the load case for the displacements from which they come.
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

    /// What a load of the scene prescribes, by the numbers of load cases: where its nodes came to
    /// be, `before`, or a sum of shares of this and of the `value` at its factor 1. `None` if it is
    /// the value alone, or if the load does not hold in this leg.
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
