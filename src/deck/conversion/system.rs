//! All kinds of constraints as equations of the scene: chains of equations, terms in local axes,
//! rigid bodies, nodes without elements.

use super::super::bodies::unsupported;
use super::super::constraints::HeldPlane;
use super::super::data::LinearEquation;
use super::super::history::{Key, KeyHistory, Map};
use super::super::linear::{self, Follows, FreedomCoefficients, LinearRow, Reduced};
use super::super::series::Series;
use super::super::sets::What;
use super::super::source::LinePlace;
use super::Draft;
use super::along_axes::AlongAxis;
use super::conditions::take_known;
use crate::error::Result;
use crate::scene::{self, Direction, EquationTerm, Load, Relative};
use crate::space::Vector;
use std::collections::BTreeMap;

/// Fraction of its terms up to which a sum of displacements counts as zero.
const ROUND_OFF: f64 = 1e-9;

impl Draft<'_> {
    /// Converts all equations into equations of the scene, except those of planes that are held by
    /// nothing else; these planes are returned. Nodes without elements are eliminated: conditions
    /// and forces on such a node are passed on to the nodes that are coupled to it.
    pub(super) fn constrain(
        &mut self,
        boundary: &mut Map,
        in_steps: &mut Vec<(Key, KeyHistory)>,
        forces: &mut Map,
    ) -> Result<Vec<HeldPlane>> {
        let axes = self.deck.local_axes()?;
        let (planes, others) = self.deck.held_planes()?;
        let mut rows = Vec::new();
        for equation in others {
            self.rows_of(equation, &mut rows)?;
        }
        self.rows_of_bodies(&axes, &mut rows)?;
        self.forces_of_loose(&planes, &rows);
        let (simple, joined) = apart(planes, &rows, |plane| {
            let is_own = |node: &u32| {
                let changes = in_steps
                    .iter()
                    .any(|(key, _)| *key == (*node, plane.leader.1));
                changes || axes.contains_key(node)
            };
            let (leader, axis) = plane.leader;
            let mut followers = plane.nodes.iter().filter(|node| **node != leader);
            plane.nodes.iter().any(is_own)
                || followers.any(|node| boundary.contains_key(&(*node, axis)))
        });
        for plane in joined {
            let followers = plane.nodes.iter().filter(|node| **node != plane.leader.0);
            rows.extend(followers.map(|&node| LinearRow {
                terms: FreedomCoefficients::from([
                    ((node, plane.leader.1), 1.0),
                    (plane.leader, -1.0),
                ]),
                first: Some((node, plane.leader.1)),
                place: plane.place,
                keyword: "EQUATION",
            }));
        }
        let of_rows: Vec<Key> = rows
            .iter()
            .flat_map(|row| row.terms.keys().copied())
            .collect();
        let reduced = self.reduced(rows, boundary);
        self.displacements_of_loose(&simple, &reduced, boundary);
        self.sums_in_steps(&reduced, in_steps)?;
        self.move_forces(&reduced, &of_rows, boundary, forces)?;
        self.check_known(&reduced.known, boundary)?;
        let known = boundary.clone();
        // A displacement along an axis of its node is combined with all others of the node.
        let is_known = |follows: &Follows| follows.of.keys().all(|key| known.contains_key(key));
        let mut turned: BTreeMap<u32, Vec<&Follows>> = BTreeMap::new();
        for follows in &reduced.others {
            match axes.contains_key(&follows.key.0) && !is_known(follows) {
                true => turned.entry(follows.key.0).or_default().push(follows),
                false => self.follow(follows, &known, boundary, &axes)?,
            }
        }
        for (node, of_node) in turned {
            let mut along: Vec<AlongAxis> = take_known(node, &axes[&node], boundary).collect();
            for follows in of_node {
                let (of, moved) = self.apart_from_loose(follows, &known);
                along.push(AlongAxis {
                    axis: axes[&node][follows.key.1 as usize],
                    of,
                    moved,
                    place: follows.place,
                });
            }
            self.move_along(node, &along, &axes, boundary);
        }
        let is_loose = |key: &Key| !self.geometry.uses(key.0);
        boundary.retain(|key, _| !(is_loose(key) && of_rows.contains(key)));
        Ok(simple)
    }

    /// Adds the rows of rigid bodies, of displacements along the axes of their nodes.
    fn rows_of_bodies(
        &self,
        axes: &BTreeMap<u32, [Vector; 3]>,
        rows: &mut Vec<LinearRow>,
    ) -> Result<()> {
        for body in self.deck.rigid_bodies()? {
            for (node, axis, mut row) in body.rows(self.deck) {
                let own = axes.get(&node).copied().unwrap_or(GLOBAL);
                for (of, local) in own.iter().enumerate() {
                    *row.terms.entry((node, of as u8)).or_insert(0.0) += local[axis];
                }
                row.first = Some((node, axis as u8));
                rows.push(row);
            }
        }
        Ok(())
    }

    /// Reduces the rows to independent ones, after removing displacements that are held at zero.
    fn reduced(&self, mut rows: Vec<LinearRow>, boundary: &Map) -> Reduced {
        let dimension = self.deck.dimension();
        let is_zero = |key: &Key| {
            let out_of_plane = key.1 as usize >= dimension && self.geometry.uses(key.0);
            out_of_plane
                || boundary
                    .get(key)
                    .is_some_and(|entry| entry.series.is_zero())
        };
        for row in &mut rows {
            row.terms.retain(|key, _| !is_zero(key));
        }
        linear::reduce(
            rows,
            |key| !self.geometry.uses(key.0),
            |key| boundary.contains_key(key),
        )
    }

    /// The rows of an equation, one for each node of its first set.
    fn rows_of(&self, equation: &LinearEquation, rows: &mut Vec<LinearRow>) -> Result<()> {
        let (deck, at) = (self.deck, (equation.place, "EQUATION"));
        let refused = |message: String| deck.error(at.0, at.1, message);
        let mut terms = Vec::new();
        for (on, freedom, coefficient) in &equation.terms {
            let nodes = deck.indices(What::Nodes, on, at)?;
            let keys: Vec<Key> = match freedom {
                1..=3 => nodes
                    .iter()
                    .map(|&node| (node, *freedom as u8 - 1))
                    .collect(),
                _ => deck.rotations_among(&nodes, [*freedom; 2])?,
            };
            if keys.is_empty() {
                let message = format!(
                    "degree of freedom {freedom} is none of a node here: 1 to {}",
                    deck.dimension()
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

    /// Transfers the force on a node without elements to the nodes that it follows. A force on a
    /// node that is held goes into the support.
    fn move_forces(
        &self,
        reduced: &Reduced,
        of_rows: &[Key],
        boundary: &Map,
        forces: &mut Map,
    ) -> Result<()> {
        for follows in &reduced.loose {
            let Some(entry) = forces.remove(&follows.key) else {
                continue;
            };
            for (key, share) in &follows.of {
                if boundary.contains_key(key) {
                    continue;
                }
                if !self.geometry.uses(key.0) && !entry.series.is_zero() {
                    return Err(self.pressed_loose(follows.key, entry.place));
                }
                let new = || KeyHistory::new(Series::starting(0.0), entry.place);
                let sum = forces.entry(*key).or_insert_with(new);
                sum.series.add(&entry.series, *share);
            }
        }
        let is_left = |key: &Key| !self.geometry.uses(key.0) && of_rows.contains(key);
        let left: Vec<Key> = forces.keys().filter(|key| is_left(key)).copied().collect();
        for key in left {
            if let Some(entry) = forces.remove(&key)
                && !boundary.contains_key(&key)
                && !entry.series.is_zero()
            {
                return Err(self.pressed_loose(key, entry.place));
            }
        }
        Ok(())
    }

    fn pressed_loose(&self, key: Key, place: LinePlace) -> crate::Error {
        let node = self.deck.node_name(key.0 as usize);
        let message = format!(
            "a force acts on node {node} along {}, which no node of an element follows alone",
            key.1 + 1
        );
        self.deck.error(place, "CLOAD", message)
    }

    /// Checks that rows between displacements that are all prescribed hold.
    fn check_known(&self, rows: &[LinearRow], boundary: &Map) -> Result<()> {
        for row in rows {
            let sum = series_of(&row.terms, boundary);
            let sizes = row.terms.iter().map(|(key, c)| {
                let given = boundary
                    .get(key)
                    .map_or(0.0, |entry| entry.series.largest());
                (c * given).abs()
            });
            if sum.largest().abs() > ROUND_OFF * sizes.fold(0.0, f64::max) {
                let message = "what is held or moved does not agree with it: take one of them out";
                return Err(self.deck.error(row.place, row.keyword, message));
            }
        }
        Ok(())
    }

    /// Holds or moves a displacement that follows prescribed ones only; any other becomes an
    /// equation.
    fn follow(
        &mut self,
        follows: &Follows,
        known: &Map,
        boundary: &mut Map,
        axes: &BTreeMap<u32, [Vector; 3]>,
    ) -> Result<()> {
        if follows.of.keys().all(|key| known.contains_key(key)) {
            let series = series_of(&follows.of, known);
            boundary.insert(follows.key, KeyHistory::new(series, follows.place));
            return Ok(());
        }
        let (of, moved) = self.apart_from_loose(follows, known);
        let all = std::iter::once((follows.key, -1.0)).chain(of);
        let mut terms = Vec::new();
        for (key, coefficient) in all {
            terms.extend(self.components_of(key, coefficient, axes));
        }
        self.relate(terms, moved, follows.place);
        Ok(())
    }

    /// The displacements of nodes with elements that a displacement follows, and the part that
    /// nodes without elements prescribe.
    fn apart_from_loose(&self, follows: &Follows, known: &Map) -> (FreedomCoefficients, Series) {
        let (loose, of): (FreedomCoefficients, FreedomCoefficients) =
            (follows.of.iter()).partition(|(key, _)| !self.geometry.uses(key.0));
        (of, series_of(&loose, known))
    }

    /// The terms along x, y and z of a displacement along an axis of its node; the largest comes
    /// first.
    pub(super) fn components_of(
        &mut self,
        (node, axis): Key,
        coefficient: f64,
        axes: &BTreeMap<u32, [Vector; 3]>,
    ) -> Vec<EquationTerm> {
        let own = axes.get(&node).unwrap_or(&GLOBAL)[axis as usize];
        let parts = own.map(|x| coefficient * x).into_iter().enumerate();
        let mut parts: Vec<(usize, f64)> = parts.collect();
        parts.retain(|(_, c)| c.abs() > ROUND_OFF * coefficient.abs());
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let on = self.set_of_node(node);
        let term = |(axis, coefficient): (usize, f64)| EquationTerm {
            on: on.clone(),
            direction: Direction::ALL[axis],
            coefficient,
        };
        parts.into_iter().map(term).collect()
    }

    /// Adds the equation that a sum of terms and a value over time is zero. If the value is not, it
    /// is a load.
    pub(super) fn relate(&mut self, terms: Vec<EquationTerm>, moved: Series, place: LinePlace) {
        if moved.is_zero() {
            let key = format!("equation.{}", self.equations.len());
            self.places.insert(key, self.deck.files.show(place));
            self.equations.push(scene::Equation { terms });
            return;
        }
        let Some((first, rest)) = terms.split_first() else {
            return;
        };
        let over_first = |term: &EquationTerm| EquationTerm {
            coefficient: -term.coefficient / first.coefficient,
            ..term.clone()
        };
        let load = Load {
            on: first.on.clone(),
            relative: Some(Relative {
                direction: first.direction,
                value: -moved.largest() / first.coefficient,
                terms: rest.iter().map(over_first).collect(),
            }),
            ..Load::default()
        };
        self.add_load("relative", load, moved, place);
    }

    /// The name of a set with this node only.
    pub(super) fn set_of_node(&mut self, node: u32) -> String {
        let known = self.sets_of_nodes.get(&node);
        if let Some(name) = known {
            return name.clone();
        }
        let name = format!("node-{}", self.deck.node_label(node as usize));
        let name = self.geometry.add_nodes(&name, vec![node]);
        self.sets_of_nodes.insert(node, name.clone());
        name
    }
}

const GLOBAL: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The sum of known displacements multiplied by coefficients.
pub(super) fn series_of(terms: &FreedomCoefficients, known: &Map) -> Series {
    let mut sum = Series::starting(0.0);
    for (key, c) in terms {
        if let Some(entry) = known.get(key) {
            sum.add(&entry.series, *c);
        }
    }
    sum
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
