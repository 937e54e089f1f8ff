//! Surfaces that equations hold plane.

use super::super::constraints::HeldPlane;
use super::super::history::{KeyHistory, Map};
use super::super::series::Series;
use super::draft::Draft;
use crate::scene::{Direction, EquationTerm, Load, PlaneForce};

impl HeldPlane {
    /// Converts a surface that is held plane. The forces on all its nodes become one total force; a
    /// condition that moves or holds the leader applies to all nodes.
    pub(super) fn hold(&self, draft: &mut Draft, boundary: &mut Map, forces: &mut Map) {
        let (leader, axis) = self.leader;
        if axis as usize >= draft.deck.mesh.dimension() {
            return;
        }
        let followers = self.nodes.iter().filter(|node| **node != leader);
        if let Some(entry) = boundary.get(&self.leader).cloned() {
            boundary.extend(followers.map(|node| ((*node, axis), entry.clone())));
            return;
        }
        let found = self.nodes.iter();
        let found = found.filter_map(|node| forces.remove(&(*node, axis)));
        let found: Vec<KeyHistory> = found.collect();
        let mut sum = Series::starting(0.0);
        found.iter().for_each(|entry| sum.add(&entry.series, 1.0));
        let nodes = draft.geometry.used(self.nodes.clone());
        if nodes.is_empty() {
            return;
        }
        if sum.is_zero() {
            self.follow_leader(draft);
            return;
        }
        let place = found.first().map_or(self.place, |entry| entry.place);
        let name = format!("plane-line-{}", self.place.line());
        let load = Load {
            on: draft.geometry.add_nodes(&name, nodes),
            plane_force: Some(PlaneForce {
                direction: Direction::ALL[axis as usize],
                total: sum.largest() / draft.thickness,
            }),
            ..Load::default()
        };
        draft.add_load("plane", load, sum, place);
    }

    /// Converts a surface that is held plane and on which no force acts into an equation.
    fn follow_leader(&self, draft: &mut Draft) {
        let (leader, axis) = self.leader;
        let others = self.nodes.iter().copied();
        let others: Vec<u32> = others.filter(|node| *node != leader).collect();
        let used = |nodes: Vec<u32>| draft.geometry.used(nodes);
        let (followers, leaders) = (used(others), used(vec![leader]));
        // The first follower becomes the leader if the leader belongs to no element.
        let (followers, leader) = match (&leaders[..], &followers[..]) {
            ([leader], _) => (followers.clone(), *leader),
            ([], [first, rest @ ..]) => (rest.to_vec(), *first),
            _ => return,
        };
        if followers.is_empty() {
            return;
        }
        let line = self.place.line();
        let terms = [(followers, 1.0), (vec![leader], -1.0)];
        let terms = terms
            .into_iter()
            .enumerate()
            .map(|(k, (nodes, coefficient))| {
                let name = format!("equation-line-{line}-term-{}", k + 1);
                EquationTerm {
                    on: draft.geometry.add_nodes(&name, nodes),
                    direction: Direction::ALL[axis as usize],
                    coefficient,
                }
            });
        let terms = terms.collect();
        draft.add_equation(terms, self.place);
    }
}
