//! Equations between displacements, and surfaces that they hold plane.

use super::super::bodies::unsupported;
use super::super::constraints::HeldPlane;
use super::super::data::Equation;
use super::super::history::{Entry, Map};
use super::super::series::Series;
use super::super::sets::What;
use super::super::source::Place;
use super::Draft;
use crate::error::Result;
use crate::scene::{self, Direction, EquationTerm, Load, PlaneForce};

impl Draft<'_> {
    /// The forces on all nodes of a plane are one force on it; what moves or holds the leader moves
    /// or holds all.
    pub(super) fn hold_plane(&mut self, boundary: &mut Map, forces: &mut Map) -> Result<()> {
        let dimension = self.deck.dimension();
        let (planes, others) = self.deck.held_planes()?;
        for equation in others {
            self.equation(equation)?;
        }
        for plane in planes {
            let (leader, axis) = plane.leader;
            if axis as usize >= dimension {
                continue;
            }
            let followers = plane.nodes.iter().filter(|node| **node != leader);
            if let Some(node) = followers
                .clone()
                .find(|node| boundary.contains_key(&(**node, axis)))
            {
                let label = self.deck.node_name(*node as usize);
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

    /// A surface that is held plane and pressed by no force of its own.
    fn follow_leader(&mut self, plane: &HeldPlane) -> Result<()> {
        let (leader, axis) = plane.leader;
        let others = plane.nodes.iter().copied().filter(|node| *node != leader);
        let terms = [(others.collect(), 1.0), (vec![leader], -1.0)];
        self.add_equation(
            terms.map(|(nodes, c)| (nodes, axis as usize, c)).into(),
            plane.place,
        )
    }

    fn equation(&mut self, equation: &Equation) -> Result<()> {
        let (deck, at) = (self.deck, (equation.place, "EQUATION"));
        let mut terms = Vec::new();
        for (on, freedom, coefficient) in &equation.terms {
            if !(1..=3).contains(freedom) {
                let message = format!(
                    "degree of freedom {freedom} is none of a node here: 1 to {}",
                    deck.dimension()
                );
                return Err(unsupported(deck.error(at.0, at.1, message)));
            }
            terms.push((
                deck.indices(What::Nodes, on, at)?,
                freedom - 1,
                *coefficient,
            ));
        }
        self.add_equation(terms, equation.place)
    }

    /// Adds an equation; in the plane nothing moves along the third axis.
    fn add_equation(&mut self, terms: Vec<(Vec<u32>, usize, f64)>, place: Place) -> Result<()> {
        let axes = self.deck.local_axes()?;
        let mut out = Vec::new();
        for (k, (nodes, axis, coefficient)) in terms.into_iter().enumerate() {
            let label = |node: u32| self.deck.node_name(node as usize);
            let refused = |message| self.deck.error(place, "EQUATION", message);
            if let Some(node) = nodes
                .iter()
                .find(|node| !self.geometry.is_used[**node as usize])
            {
                let message = format!("node {} belongs to no element", label(*node));
                return Err(unsupported(refused(message)));
            }
            if let Some(node) = nodes.iter().find(|node| axes.contains_key(node)) {
                let message = format!(
                    "node {} has axes of its own (*TRANSFORM): equations are in the global ones",
                    label(*node)
                );
                return Err(unsupported(refused(message)));
            }
            if axis >= self.deck.dimension() {
                if k == 0 {
                    let message = "the first degree of freedom is held in a plane model";
                    return Err(refused(message.to_string()));
                }
                continue;
            }
            let name = format!("equation-line-{}-term-{}", place.line(), k + 1);
            out.push(EquationTerm {
                on: self.geometry.add_nodes(&name, nodes),
                direction: Direction::ALL[axis],
                coefficient,
            });
        }
        let key = format!("equation.{}", self.equations.len());
        self.places.insert(key, self.deck.files.show(place));
        self.equations.push(scene::Equation { terms: out });
        Ok(())
    }
}
