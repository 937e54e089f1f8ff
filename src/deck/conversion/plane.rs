//! Surfaces that equations hold plane.

use super::super::bodies::unsupported;
use super::super::history::{Entry, Map};
use super::super::series::Series;
use super::Draft;
use crate::error::Result;
use crate::scene::{Direction, Load, PlaneForce};

impl Draft<'_> {
    /// The forces on all nodes of a plane are one force on it; what moves or holds the leader moves
    /// or holds all.
    pub(super) fn hold_plane(&mut self, boundary: &mut Map, forces: &mut Map) -> Result<()> {
        let dimension = self.deck.dimension();
        for plane in self.deck.held_planes()? {
            let (leader, axis) = plane.leader;
            if axis as usize >= dimension {
                continue;
            }
            let followers = plane.nodes.iter().filter(|node| **node != leader);
            if let Some(node) = followers
                .clone()
                .find(|node| boundary.contains_key(&(**node, axis)))
            {
                let label = self.deck.nodes.labels[*node as usize];
                let message = format!(
                    "node {label} follows another one along {} and is held or moved there too: \
                     take it out of one",
                    axis + 1
                );
                return Err(self.deck.error(plane.place, "EQUATION", message));
            }
            if let Some(entry) = boundary.get(&plane.leader).cloned() {
                let held = followers.map(|node| ((*node, axis), entry.clone()));
                boundary.extend(held);
                continue;
            }
            let found = plane
                .nodes
                .iter()
                .filter_map(|node| forces.remove(&(*node, axis)));
            let found: Vec<Entry> = found.collect();
            let mut sum = Series::starting(0.0);
            found.iter().for_each(|entry| sum.add(&entry.series, 1.0));
            let nodes = self.geometry.used(plane.nodes.clone());
            if nodes.is_empty() {
                continue;
            }
            if sum.is_zero() {
                let message =
                    "a surface is held plane and no force presses it: give it one along the axis";
                return Err(unsupported(self.deck.error(
                    plane.place,
                    "EQUATION",
                    message,
                )));
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
}
