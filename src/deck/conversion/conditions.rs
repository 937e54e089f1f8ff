//! Supports and loads of a deck as those of the scene.
//!
//! A condition that a line gives for a whole set stays one entry on this set if all members of the
//! set have the same history. Other conditions are grouped by their history, on sets made for the
//! purpose.

use super::super::constraints::{LocalAxes, local_axes};
use super::super::data::{Condition, ConditionKind, EntitySelection};
use super::super::facets::{Face, Key};
use super::super::history::{GivenDisplacements, KeyHistory, Map, histories};
use super::super::series::Series;
use super::super::source::LinePlace;
use super::along_axes::NodeAlongAxes;
use super::draft::{Draft, made};
use super::in_steps::InSteps;
use crate::error::Result;
use crate::scene::{Load, LooseNode, Support};
use crate::space::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// Largest component of a unit vector that counts as round-off, from sines and cosines in the
/// deck's coordinates and from the cross products that define axes.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// Members with the same history, by degree of freedom and history.
type MemberGroups = BTreeMap<(u8, Vec<u64>), (Vec<u32>, Series, LinePlace)>;

/// Conditions of a deck on their way into a scene.
pub(super) struct DeckConditions<'c, 'd> {
    pub(super) draft: &'c mut Draft<'d>,
    pub(super) axes: LocalAxes,
    /// Displacements that are given in all steps.
    pub(super) boundary: Map,
    pub(super) forces: Map,
    /// Displacements and forces of nodes without elements, as sums over other nodes, by node
    /// number.
    pub(super) loose: BTreeMap<u64, LooseNode>,
}

impl<'c, 'd> DeckConditions<'c, 'd> {
    /// Adds the supports, forces, pressures and equations of a deck to a draft. Returns the
    /// displacements and forces of nodes without elements as sums, by node number.
    pub(super) fn convert(draft: &'c mut Draft<'d>) -> Result<BTreeMap<u64, LooseNode>> {
        let deck = draft.deck;
        let GivenDisplacements { whole, in_steps } = GivenDisplacements::of(deck)?;
        let mut conditions = DeckConditions {
            draft,
            boundary: whole,
            forces: histories(deck, ConditionKind::Force)?,
            axes: local_axes(&deck.properties.transforms, deck.lookup())?,
            loose: BTreeMap::new(),
        };
        let (planes, in_steps) = conditions.constrain(in_steps)?;
        conditions.turn_boundary(&in_steps);
        let axes = conditions.axes.clone();
        conditions.turn_forces(&axes);
        let DeckConditions {
            draft,
            boundary,
            forces,
            ..
        } = &mut conditions;
        for plane in planes {
            plane.hold(draft, boundary, forces);
        }
        conditions.add_boundary()?;
        in_steps.prescribe(conditions.draft, &conditions.axes);
        conditions.add_forces()?;
        conditions.add_pressures(histories(deck, ConditionKind::Pressure)?)?;
        Ok(conditions.loose)
    }

    /// All conditions of a kind that are given for sets.
    fn lines_on_sets(&self, kind: ConditionKind) -> Vec<Condition> {
        let program = &self.draft.deck.program;
        let steps = program.steps.iter().flat_map(|step| &step.conditions);
        let all = program.initial.iter().chain(steps);
        let of_kind = all.filter(|c| c.kind == kind && matches!(c.on, EntitySelection::Set(_)));
        of_kind.cloned().collect()
    }

    /// Removes from the map the conditions that apply to whole node sets. Returns the set, axis,
    /// history and line of each.
    fn of_node_sets(
        &self,
        kind: ConditionKind,
        map: &mut Map,
    ) -> Result<Vec<(String, u8, Series, LinePlace)>> {
        let mut out = Vec::new();
        for condition in self.lines_on_sets(kind) {
            let EntitySelection::Set(name) = &condition.on else {
                continue;
            };
            let Some(name) = self.draft.deck.sets.nodes.written(name) else {
                continue;
            };
            let mut by_axis: BTreeMap<u8, Vec<u32>> = BTreeMap::new();
            for (node, axis) in condition.keys(self.draft.deck)? {
                if self.draft.geometry.uses(node) {
                    by_axis.entry(axis).or_default().push(node);
                }
            }
            for (axis, nodes) in by_axis {
                let entries: Option<Vec<_>> = nodes.iter().map(|&n| map.get(&(n, axis))).collect();
                let Some(entries) = entries else { continue };
                let Some(first) = entries.first() else {
                    continue;
                };
                let series = first.series.clone();
                if entries.iter().any(|entry| entry.series != series) {
                    continue;
                }
                nodes
                    .iter()
                    .for_each(|&node| drop(map.remove(&(node, axis))));
                out.push((name.to_string(), axis, series, condition.place));
            }
        }
        Ok(out)
    }

    /// Turns nodes held at zero into supports, and others into prescribed displacements.
    fn add_boundary(&mut self) -> Result<()> {
        let mut map = std::mem::take(&mut self.boundary);
        map.retain(|key, _| self.draft.geometry.uses(key.0));
        let of_sets = self.of_node_sets(ConditionKind::Boundary, &mut map)?;
        let draft = &mut *self.draft;
        for (on, axis, series, place) in of_sets {
            match series.is_zero() {
                true => draft.hold(&on, &[axis as usize], place),
                false => draft.displace(on, axis, KeyHistory::new(series, place)),
            }
        }
        // For each node, the axes along which it is held, as a mask.
        let mut held: BTreeMap<u32, (u8, LinePlace)> = BTreeMap::new();
        map.retain(|&(node, axis), entry| {
            if entry.series.is_zero() {
                held.entry(node).or_insert((0, entry.place)).0 |= 1 << axis;
            }
            !entry.series.is_zero()
        });
        let mut by_mask: BTreeMap<u8, (Vec<u32>, LinePlace)> = BTreeMap::new();
        for (node, (mask, place)) in held {
            by_mask
                .entry(mask)
                .or_insert((Vec::new(), place))
                .0
                .push(node);
        }
        for (mask, (nodes, place)) in by_mask {
            let axes: Vec<usize> = (0..3).filter(|axis| mask & (1 << axis) != 0).collect();
            let on = draft.geometry.add_nodes(&made("boundary", place), nodes);
            draft.hold(&on, &axes, place);
        }
        for ((axis, _), (nodes, series, place)) in groups(map) {
            let on = draft.geometry.add_nodes(&made("boundary", place), nodes);
            draft.displace(on, axis, KeyHistory::new(series, place));
        }
        Ok(())
    }

    /// Adds forces. The deck gives the force on each node of a set, the scene the total on all
    /// nodes, shared equally.
    fn add_forces(&mut self) -> Result<()> {
        let mut map = std::mem::take(&mut self.forces);
        map.retain(|_, entry| !entry.series.is_zero());
        let unused = map.iter().find(|(key, _)| !self.draft.geometry.uses(key.0));
        if let Some((key, entry)) = unused {
            let node = self.draft.deck.mesh.node_name(key.0 as usize);
            let message = format!("a force acts on node {node}, which belongs to no element");
            return Err(self.draft.deck.error(entry.place, "CLOAD", message));
        }
        for (on, axis, series, place) in self.of_node_sets(ConditionKind::Force, &mut map)? {
            self.push(on, axis, series, place);
        }
        for ((axis, _), (nodes, series, place)) in groups(map) {
            let on = self.draft.geometry.add_nodes(&made("cload", place), nodes);
            self.push(on, axis, series, place);
        }
        Ok(())
    }

    fn push(&mut self, on: String, axis: u8, series: Series, place: LinePlace) {
        let n = self.draft.geometry.node_sets.get(&on).map_or(0, Vec::len);
        let mut total: Vector = [0.0; 3];
        total[axis as usize] = n as f64 * series.largest() / self.draft.thickness;
        let load = Load {
            on,
            force: Some(self.draft.components(total)),
            ..Load::default()
        };
        self.draft.add_load("force", load, series, place);
    }

    fn add_pressures(&mut self, mut map: Map) -> Result<()> {
        map.retain(|_, entry| !entry.series.is_zero());
        for condition in self.lines_on_sets(ConditionKind::Pressure) {
            let EntitySelection::Set(name) = &condition.on else {
                continue;
            };
            if condition.range[0] != 0 {
                continue;
            }
            let faces = condition.keys(self.draft.deck)?;
            let entries: Option<Vec<_>> = faces.iter().map(|face| map.get(face)).collect();
            let Some(entries) = entries else { continue };
            let Some(series) = entries.first().map(|first| first.series.clone()) else {
                continue;
            };
            if entries.iter().all(|entry| entry.series == series) {
                faces.iter().for_each(|face| drop(map.remove(face)));
                let on = self.draft.geometry.surface_name(name);
                self.press(on, series, condition.place);
            }
        }
        let mut groups: BTreeMap<Vec<u64>, (Vec<Face>, Series, LinePlace)> = BTreeMap::new();
        for (face, entry) in map {
            let new = || (Vec::new(), entry.series.clone(), entry.place);
            let key = entry.series.bits();
            groups.entry(key).or_insert_with(new).0.push(face);
        }
        for (faces, series, place) in groups.into_values() {
            let on = self
                .draft
                .geometry
                .add_surface(&made("dload", place), faces);
            self.press(on, series, place);
        }
        Ok(())
    }

    fn press(&mut self, on: String, series: Series, place: LinePlace) {
        let load = Load {
            on,
            pressure: Some(series.largest().into()),
            ..Load::default()
        };
        self.draft.add_load("pressure", load, series, place);
    }

    /// Converts displacements in local axes: zero displacements become supports along these axes.
    fn turn_boundary(&mut self, in_steps: &InSteps) {
        let (axes, boundary, draft) = (&self.axes, &mut self.boundary, &mut *self.draft);
        let turned = boundary.keys().filter(|k| axes.contains_key(&k.0));
        let turned: Vec<Key> = turned.copied().collect();
        let mut by_direction: BTreeMap<[u64; 3], (Vector, BTreeSet<u32>, LinePlace)> =
            BTreeMap::new();
        let is_moved = |key: &Key| !boundary[key].series.is_zero() && draft.geometry.uses(key.0);
        let moved = turned.iter().filter(|k| is_moved(k)).map(|k| k.0);
        let of_sums = in_steps.nodes_of_sums();
        let of_sums = of_sums.filter(|node| axes.contains_key(node));
        let moved: BTreeSet<u32> = moved.chain(of_sums).collect();
        for &node in &moved {
            NodeAlongAxes::taken(node, axes, boundary).prescribe(draft, axes, boundary);
        }
        for key in turned.into_iter().filter(|key| !moved.contains(&key.0)) {
            let Some(entry) = boundary.remove(&key) else {
                continue;
            };
            if !draft.geometry.uses(key.0) {
                continue;
            }
            let direction = axes[&key.0][key.1 as usize];
            let bits = direction.map(|x| (x + 0.0).to_bits());
            let new = (direction, BTreeSet::new(), entry.place);
            by_direction.entry(bits).or_insert(new).1.insert(key.0);
        }
        for (direction, nodes, place) in by_direction.into_values() {
            let name = made("boundary", place);
            let on = draft.geometry.add_nodes(&name, nodes.into_iter().collect());
            let support = Support {
                on,
                direction: Some(draft.components(direction)),
                ..Support::default()
            };
            draft.add_support(support, place);
        }
    }

    /// Resolves forces on nodes with these local axes into global components.
    pub(super) fn turn_forces(&mut self, axes: &LocalAxes) {
        let forces = &mut self.forces;
        let all = std::mem::take(forces).into_iter();
        let (turned, others): (Map, Map) = all.partition(|(key, _)| axes.contains_key(&key.0));
        *forces = others;
        for ((node, axis), entry) in turned {
            let shares = axes[&node][axis as usize].iter().enumerate();
            for (global, &share) in shares.filter(|(_, share)| share.abs() > ROUND_OFF) {
                let mut of_axis = entry.clone();
                of_axis.series = Series::starting(0.0);
                let sum = forces.entry((node, global as u8)).or_insert(of_axis);
                sum.series.add(&entry.series, share);
            }
        }
    }
}

/// Groups members by their history.
fn groups(map: Map) -> MemberGroups {
    let mut out = MemberGroups::new();
    for ((member, axis), entry) in map {
        let key = (axis, entry.series.bits());
        let new = || (Vec::new(), entry.series.clone(), entry.place);
        out.entry(key).or_insert_with(new).0.push(member);
    }
    out
}
