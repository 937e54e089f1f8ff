//! Equations between displacements, and surfaces that equations hold plane.

use super::super::constraints::HeldPlane;
use super::super::history::{KeyHistory, Map};
use super::super::series::Series;
use super::Draft;
use crate::error::Result;
use crate::scene::{self, Direction, EquationTerm, Load, PlaneForce};

impl Draft<'_> {
    /// Converts surfaces that are held plane. The forces on all nodes of the plane become one total
    /// force; a condition that moves or holds the leader applies to all nodes.
    pub(super) fn hold_planes(
        &mut self,
        planes: Vec<HeldPlane>,
        boundary: &mut Map,
        forces: &mut Map,
    ) -> Result<()> {
        let dimension = self.deck.dimension();
        for plane in planes {
            let (leader, axis) = plane.leader;
            if axis as usize >= dimension {
                continue;
            }
            let followers = plane.nodes.iter().filter(|node| **node != leader);
            if let Some(entry) = boundary.get(&plane.leader).cloned() {
                let held = followers.map(|node| ((*node, axis), entry.clone()));
                boundary.extend(held);
                continue;
            }
            let found = plane
                .nodes
                .iter()
                .filter_map(|node| forces.remove(&(*node, axis)));
            let found: Vec<KeyHistory> = found.collect();
            let mut sum = Series::starting(0.0);
            found.iter().for_each(|entry| sum.add(&entry.series, 1.0));
            let nodes = self.geometry.used(plane.nodes.clone());
            if nodes.is_empty() {
                continue;
            }
            if sum.is_zero() {
                self.follow_leader(&plane)?;
                continue;
            }
            let place = found.first().map_or(plane.place, |entry| entry.place);
            let on = self
                .geometry
                .add_nodes(&format!("plane-line-{}", plane.place.line()), nodes);
            let load = Load {
                on,
                plane_force: Some(PlaneForce {
                    direction: Direction::ALL[axis as usize],
                    total: sum.largest() / self.thickness,
                }),
                ..Load::default()
            };
            self.add_load("plane", load, sum, place);
        }
        Ok(())
    }

    /// Converts a surface that is held plane and on which no force acts into an equation.
    fn follow_leader(&mut self, plane: &HeldPlane) -> Result<()> {
        let (leader, axis) = plane.leader;
        let others = plane.nodes.iter().copied();
        let others: Vec<u32> = others.filter(|node| *node != leader).collect();
        let used = |nodes: Vec<u32>| self.geometry.used(nodes);
        let (followers, leaders) = (used(others), used(vec![leader]));
        // The first follower becomes the leader if the leader belongs to no element.
        let (followers, leader) = match (&leaders[..], &followers[..]) {
            ([leader], _) => (followers.clone(), *leader),
            ([], [first, rest @ ..]) => (rest.to_vec(), *first),
            _ => return Ok(()),
        };
        if followers.is_empty() {
            return Ok(());
        }
        let line = plane.place.line();
        let terms = [(followers, 1.0), (vec![leader], -1.0)];
        let terms = terms
            .into_iter()
            .enumerate()
            .map(|(k, (nodes, coefficient))| {
                let name = format!("equation-line-{line}-term-{}", k + 1);
                EquationTerm {
                    on: self.geometry.add_nodes(&name, nodes),
                    direction: Direction::ALL[axis as usize],
                    coefficient,
                }
            });
        let terms = terms.collect();
        let key = format!("equation.{}", self.equations.len());
        self.places.insert(key, self.deck.files.show(plane.place));
        self.equations.push(scene::Equation { terms });
        Ok(())
    }
}
