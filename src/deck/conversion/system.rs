//! All kinds of constraints as equations of the scene: chains of equations, terms in local axes,
//! rigid bodies, nodes without elements.

use super::super::Deck;
use super::super::bodies::unsupported;
use super::super::constraints::{HeldPlane, LocalAxes};
use super::super::data::LinearEquation;
use super::super::facets::Key;
use super::super::history::{KeyHistory, Map, sum_of};
use super::super::linear::{self, Follows, FreedomCoefficients, LinearRow, Reduced};
use super::super::rigid::{DeckRigidBody, rotations_among};
use super::super::series::Series;
use super::super::sets::What;
use super::super::source::LinePlace;
use super::along_axes::NodeAlongAxes;
use super::conditions::DeckConditions;
use super::draft::ROUND_OFF;
use super::in_steps::InSteps;
use super::loose::LooseNodes;
use crate::error::Result;
use std::collections::BTreeMap;

impl DeckConditions<'_, '_> {
    /// Converts all equations into equations of the scene, except those of held planes without
    /// other conditions. Returns these planes, and the displacements that are given in some steps.
    /// Nodes without elements are eliminated: conditions and forces on such a node are passed on to
    /// the nodes that are coupled to it.
    pub(super) fn constrain(
        &mut self,
        in_steps: Vec<(Key, KeyHistory)>,
    ) -> Result<(Vec<HeldPlane>, InSteps)> {
        let deck = self.draft.deck;
        let (planes, others) = HeldPlane::among(&deck.properties.equations, deck.lookup())?;
        let mut rows = Vec::new();
        for equation in others {
            rows_of(equation, deck, &mut rows)?;
        }
        let given_up = self.give_up_axes(&in_steps)?;
        rows.iter_mut().for_each(|row| row.resolve(&given_up));
        self.rows_of_bodies(&mut rows)?;
        let mut loose = LooseNodes {
            mesh: &deck.mesh,
            geometry: &self.draft.geometry,
            given_up: &given_up,
            sums: BTreeMap::new(),
        };
        loose.record_forces(&planes, &rows);
        let (simple, joined) = apart(planes, &rows, |plane| {
            let gives_up = |node: &u32| given_up.contains_key(node);
            self.is_joined(plane, &in_steps) || plane.nodes.iter().any(gives_up)
        });
        for plane in joined {
            let followers = plane.nodes.iter().filter(|node| **node != plane.leader.0);
            rows.extend(followers.map(|&node| {
                let mut row = LinearRow {
                    terms: FreedomCoefficients::from([
                        ((node, plane.leader.1), 1.0),
                        (plane.leader, -1.0),
                    ]),
                    first: Some((node, plane.leader.1)),
                    place: plane.place,
                    keyword: "EQUATION",
                };
                row.resolve(&given_up);
                row
            }));
        }
        let of_rows = rows.iter().flat_map(|row| row.terms.keys().copied());
        let of_rows: Vec<Key> = of_rows.collect();
        let reduced = self.reduced(rows);
        loose.record_displacements(&simple, &reduced, &self.boundary);
        self.loose = loose.sums;
        let in_steps = InSteps::of(in_steps, &reduced, &self.axes, self.draft)?;
        self.move_forces(&reduced, &of_rows)?;
        self.check_known(&reduced.known)?;
        self.follow_all(&reduced.others);
        let geometry = &self.draft.geometry;
        let is_loose = |key: &Key| !geometry.uses(key.0);
        (self.boundary).retain(|key, _| !(is_loose(key) && of_rows.contains(key)));
        Ok((simple, in_steps))
    }

    /// Whether a held plane is subject to other conditions, so that it is not converted alone.
    fn is_joined(&self, plane: &HeldPlane, in_steps: &[(Key, KeyHistory)]) -> bool {
        let (leader, axis) = plane.leader;
        let is_own = |node: &u32| {
            let changes = in_steps.iter().any(|(key, _)| *key == (*node, axis));
            changes || self.axes.contains_key(node)
        };
        let mut followers = plane.nodes.iter().filter(|node| **node != leader);
        plane.nodes.iter().any(is_own)
            || followers.any(|node| self.boundary.contains_key(&(*node, axis)))
    }

    /// Removes the local axes of nodes of rigid bodies along which nothing is prescribed, and
    /// returns them: rows between components along x, y and z can be reduced whatever these axes
    /// are.
    fn give_up_axes(&mut self, in_steps: &[(Key, KeyHistory)]) -> Result<LocalAxes> {
        let deck = self.draft.deck;
        let bodies = DeckRigidBody::all(&deck.properties.rigid, deck.lookup())?;
        let mut out = LocalAxes::new();
        for &node in bodies.iter().flat_map(DeckRigidBody::nodes) {
            let in_a_step = in_steps.iter().any(|(key, _)| key.0 == node);
            let is_given = (0..3).any(|axis| self.boundary.contains_key(&(node, axis)));
            if self.draft.geometry.uses(node) && !in_a_step && !is_given {
                out.extend(self.axes.remove(&node).map(|axes| (node, axes)));
            }
        }
        self.turn_forces(&out);
        Ok(out)
    }

    /// Adds the rows of rigid bodies, in displacements along each node's own axes.
    fn rows_of_bodies(&self, rows: &mut Vec<LinearRow>) -> Result<()> {
        let deck = self.draft.deck;
        for body in DeckRigidBody::all(&deck.properties.rigid, deck.lookup())? {
            rows.extend(body.rows(&deck.mesh, &self.axes));
        }
        Ok(())
    }

    /// Reduces the rows to independent ones, after removing displacements that are held at zero.
    fn reduced(&self, mut rows: Vec<LinearRow>) -> Reduced {
        let (geometry, boundary) = (&self.draft.geometry, &self.boundary);
        let dimension = self.draft.deck.mesh.dimension();
        let is_zero = |key: &Key| {
            let out_of_plane = key.1 as usize >= dimension && geometry.uses(key.0);
            let entry = || boundary.get(key);
            out_of_plane || entry().is_some_and(|entry| entry.series.is_zero())
        };
        for row in &mut rows {
            row.terms.retain(|key, _| !is_zero(key));
        }
        linear::reduce(
            rows,
            |key| !geometry.uses(key.0),
            |key| boundary.contains_key(key),
        )
    }

    /// Transfers the force on a node without elements to the nodes that it follows. A force on a
    /// node that is held goes into the support.
    fn move_forces(&mut self, reduced: &Reduced, of_rows: &[Key]) -> Result<()> {
        let (deck, geometry) = (self.draft.deck, &self.draft.geometry);
        let (boundary, forces) = (&self.boundary, &mut self.forces);
        for follows in &reduced.loose {
            let Some(entry) = forces.remove(&follows.key) else {
                continue;
            };
            for (key, share) in &follows.of {
                if boundary.contains_key(key) {
                    continue;
                }
                if !geometry.uses(key.0) && !entry.series.is_zero() {
                    return Err(pressed_loose(deck, follows.key, entry.place));
                }
                let new = || KeyHistory::new(Series::starting(0.0), entry.place);
                let sum = forces.entry(*key).or_insert_with(new);
                sum.series.add(&entry.series, *share);
            }
        }
        let is_left = |key: &Key| !geometry.uses(key.0) && of_rows.contains(key);
        let left: Vec<Key> = forces.keys().filter(|key| is_left(key)).copied().collect();
        for key in left {
            if let Some(entry) = forces.remove(&key)
                && !boundary.contains_key(&key)
                && !entry.series.is_zero()
            {
                return Err(pressed_loose(deck, key, entry.place));
            }
        }
        Ok(())
    }

    /// Checks rows in which all displacements are prescribed: the prescribed values must satisfy
    /// them.
    fn check_known(&self, rows: &[LinearRow]) -> Result<()> {
        let boundary = &self.boundary;
        for row in rows {
            let sum = sum_of(&row.terms, boundary);
            let sizes = row.terms.iter().map(|(key, c)| {
                let given = boundary
                    .get(key)
                    .map_or(0.0, |entry| entry.series.largest());
                (c * given).abs()
            });
            if sum.largest().abs() > ROUND_OFF * sizes.fold(0.0, f64::max) {
                let message =
                    "the prescribed displacements contradict this equation: take one of them out";
                return Err(self.draft.deck.error(row.place, row.keyword, message));
            }
        }
        Ok(())
    }

    /// Prescribes the displacements that follow others, or turns them into equations.
    fn follow_all(&mut self, others: &[Follows]) {
        let known = self.boundary.clone();
        // A displacement along an axis of its node is combined with all others of the node.
        let is_known = |follows: &Follows| follows.of.keys().all(|key| known.contains_key(key));
        let mut turned: BTreeMap<u32, Vec<&Follows>> = BTreeMap::new();
        for follows in others {
            match self.axes.contains_key(&follows.key.0) && !is_known(follows) {
                true => turned.entry(follows.key.0).or_default().push(follows),
                false => self.follow(follows, &known),
            }
        }
        for (node, of_node) in turned {
            let mut along = NodeAlongAxes::taken(node, &self.axes, &mut self.boundary);
            for follows in of_node {
                let (of, moved) = self.apart_from_loose(follows, &known);
                along.follow(follows.key.1, of, moved, &self.axes, follows.place);
            }
            along.prescribe(self.draft, &self.axes, &mut self.boundary);
        }
    }

    /// Holds or moves a displacement that follows prescribed ones only; any other becomes an
    /// equation.
    fn follow(&mut self, follows: &Follows, known: &Map) {
        if follows.of.keys().all(|key| known.contains_key(key)) {
            let entry = KeyHistory::new(sum_of(&follows.of, known), follows.place);
            self.boundary.insert(follows.key, entry);
            return;
        }
        let (of, moved) = self.apart_from_loose(follows, known);
        let all = std::iter::once((follows.key, -1.0)).chain(of);
        let mut terms = Vec::new();
        for (key, coefficient) in all {
            terms.extend(self.draft.components_of(key, coefficient, &self.axes));
        }
        self.draft.relate(terms, moved, follows.place);
    }

    /// The displacements of nodes with elements that a displacement follows, and the part that
    /// nodes without elements prescribe.
    fn apart_from_loose(&self, follows: &Follows, known: &Map) -> (FreedomCoefficients, Series) {
        let is_loose = |key: &Key| !self.draft.geometry.uses(key.0);
        let (loose, of): (FreedomCoefficients, FreedomCoefficients) =
            (follows.of.iter()).partition(|(key, _)| is_loose(key));
        (of, sum_of(&loose, known))
    }
}

/// The rows of an equation, one for each node of its first set.
fn rows_of(equation: &LinearEquation, deck: &Deck, rows: &mut Vec<LinearRow>) -> Result<()> {
    let (lookup, at) = (deck.lookup(), (equation.place, "EQUATION"));
    let refused = |message: String| lookup.error(at, message);
    let mut terms = Vec::new();
    for (on, freedom, coefficient) in &equation.terms {
        let nodes = lookup.indices(What::Nodes, on, at)?;
        let keys: Vec<Key> = match freedom {
            1..=3 => nodes
                .iter()
                .map(|&node| (node, *freedom as u8 - 1))
                .collect(),
            _ => rotations_among(&deck.properties.rigid, lookup, &nodes, [*freedom; 2])?,
        };
        if keys.is_empty() {
            let message = format!(
                "degree of freedom {freedom} is none of a node here: 1 to {}",
                deck.mesh.dimension()
            );
            return Err(unsupported(refused(message)));
        }
        terms.push((keys, *coefficient));
    }
    let n = terms.first().map_or(0, |(keys, _)| keys.len());
    if let Some((keys, _)) = terms.iter().find(|(keys, _)| ![1, n].contains(&keys.len())) {
        let message = format!(
            "a term is on {} nodes, the first on {n}: give it as many, or one",
            keys.len()
        );
        return Err(refused(message));
    }
    for k in 0..n {
        let mut sum = FreedomCoefficients::new();
        let key_of = |keys: &Vec<Key>| if keys.len() == 1 { keys[0] } else { keys[k] };
        for (keys, coefficient) in &terms {
            *sum.entry(key_of(keys)).or_insert(0.0) += coefficient;
        }
        rows.push(LinearRow {
            terms: sum,
            first: terms.first().map(|(keys, _)| key_of(keys)),
            place: equation.place,
            keyword: "EQUATION",
        });
    }
    Ok(())
}

fn pressed_loose(deck: &Deck, key: Key, place: LinePlace) -> crate::Error {
    let node = deck.mesh.node_name(key.0 as usize);
    let message = format!(
        "a force acts on node {node} along {}, which no node of an element follows alone",
        key.1 + 1
    );
    deck.error(place, "CLOAD", message)
}

/// Separates planes that share no displacement with other planes or rows from planes that do, or
/// that `is_joined` selects.
fn apart(
    planes: Vec<HeldPlane>,
    rows: &[LinearRow],
    is_joined: impl Fn(&HeldPlane) -> bool,
) -> (Vec<HeldPlane>, Vec<HeldPlane>) {
    let mut count: BTreeMap<Key, usize> = BTreeMap::new();
    let of_rows = rows.iter().flat_map(|row| row.terms.keys().copied());
    let keys = |plane: &HeldPlane| -> Vec<Key> {
        let nodes = plane.nodes.iter();
        nodes.map(|&node| (node, plane.leader.1)).collect()
    };
    let of_planes = planes.iter().flat_map(keys);
    of_rows
        .chain(of_planes)
        .for_each(|key| *count.entry(key).or_default() += 1);
    planes
        .into_iter()
        .partition(|plane| !is_joined(plane) && keys(plane).iter().all(|key| count[key] == 1))
}
