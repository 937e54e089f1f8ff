//! Supports and loads of a deck as those of the scene.
//!
//! A condition that a line gives for a whole set stays one entry on this set if all members of the
//! set have the same history. Other conditions are grouped by their history, on sets made for the
//! purpose.

use super::super::data::{Condition, ConditionKind, EntitySelection};
use super::super::facets::Face;
use super::super::history::{GivenDisplacements, Key, KeyHistory, Map};
use super::super::linear::FreedomCoefficients;
use super::super::series::Series;
use super::super::source::LinePlace;
use super::along_axes::AlongAxis;
use super::draft::{Draft, SumInSteps, made};
use crate::error::Result;
use crate::scene::{Displacement, Load, Support};
use crate::space::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// Largest component of a unit vector that counts as round-off, from sines and cosines in the
/// deck's coordinates and from the cross products that define axes.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// Members with the same history, by degree of freedom and history.
type MemberGroups = BTreeMap<(u8, Vec<u64>), (Vec<u32>, Series, LinePlace)>;

impl Draft<'_> {
    pub(super) fn conditions(&mut self) -> Result<()> {
        let GivenDisplacements {
            whole: mut boundary,
            mut in_steps,
        } = self.deck.displacements()?;
        let mut forces = self.deck.histories(ConditionKind::Force)?;
        let planes = self.constrain(&mut boundary, &mut in_steps, &mut forces)?;
        self.turn(&mut boundary, &mut forces)?;
        self.hold_planes(planes, &mut boundary, &mut forces)?;
        self.boundary(boundary)?;
        self.boundary_in_steps(in_steps)?;
        self.forces(forces)?;
        let pressures = self.deck.histories(ConditionKind::Pressure)?;
        self.pressures(pressures)
    }

    /// All conditions of a kind that are given for sets.
    fn lines_on_sets(&self, kind: ConditionKind) -> Vec<Condition> {
        let program = &self.deck.program;
        let steps = program.steps.iter().flat_map(|step| &step.conditions);
        let all = program.initial.iter().chain(steps);
        let of_kind = all.filter(|c| c.kind == kind && matches!(c.on, EntitySelection::Set(_)));
        of_kind.cloned().collect()
    }

    /// Removes the conditions that hold for whole node sets, and returns the set, axis, history and
    /// line of each.
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
            let Some(name) = self.deck.sets.nodes.written(name) else {
                continue;
            };
            let mut by_axis: BTreeMap<u8, Vec<u32>> = BTreeMap::new();
            for (node, axis) in self.deck.keys(&condition)? {
                if self.geometry.uses(node) {
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

    /// Turns nodes held at zero into supports, and others into prescribed displacements.
    fn boundary(&mut self, mut map: Map) -> Result<()> {
        map.retain(|key, _| self.geometry.uses(key.0));
        for (on, axis, series, place) in self.of_node_sets(ConditionKind::Boundary, &mut map)? {
            match series.is_zero() {
                true => self.hold(&on, &[axis as usize], place),
                false => self.displace(on, axis, KeyHistory::new(series, place)),
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
            let on = self.geometry.add_nodes(&made("boundary", place), nodes);
            self.hold(&on, &axes, place);
        }
        for ((axis, _), (nodes, series, place)) in Self::groups(map) {
            let on = self.geometry.add_nodes(&made("boundary", place), nodes);
            self.displace(on, axis, KeyHistory::new(series, place));
        }
        Ok(())
    }

    pub(super) fn displace(&mut self, on: String, axis: u8, entry: KeyHistory) {
        let KeyHistory {
            series,
            place,
            span,
            ..
        } = entry;
        let value = |of: u8| (of == axis).then(|| series.largest().into());
        let load = Load {
            on,
            displacement: Some(Displacement {
                x: value(0),
                y: value(1),
                z: value(2),
            }),
            since: span.since,
            until: span.until,
            ..Load::default()
        };
        self.add_load("displacement", load, series, place);
    }

    /// Adds forces. The deck gives the force on each node of a set, the scene the total on all
    /// nodes, shared equally.
    fn forces(&mut self, mut map: Map) -> Result<()> {
        map.retain(|_, entry| !entry.series.is_zero());
        let unused = map.iter().find(|(key, _)| !self.geometry.uses(key.0));
        if let Some((key, entry)) = unused {
            let node = self.deck.node_name(key.0 as usize);
            let message = format!("a force acts on node {node}, which belongs to no element");
            return Err(self.deck.error(entry.place, "CLOAD", message));
        }
        for (on, axis, series, place) in self.of_node_sets(ConditionKind::Force, &mut map)? {
            self.push(on, axis, series, place);
        }
        for ((axis, _), (nodes, series, place)) in Self::groups(map) {
            let on = self.geometry.add_nodes(&made("cload", place), nodes);
            self.push(on, axis, series, place);
        }
        Ok(())
    }

    fn push(&mut self, on: String, axis: u8, series: Series, place: LinePlace) {
        let n = self.geometry.node_sets.get(&on).map_or(0, Vec::len);
        let mut total: Vector = [0.0; 3];
        total[axis as usize] = n as f64 * series.largest() / self.thickness;
        let load = Load {
            on,
            force: Some(self.components(total)),
            ..Load::default()
        };
        self.add_load("force", load, series, place);
    }

    fn pressures(&mut self, mut map: Map) -> Result<()> {
        map.retain(|_, entry| !entry.series.is_zero());
        for condition in self.lines_on_sets(ConditionKind::Pressure) {
            let EntitySelection::Set(name) = &condition.on else {
                continue;
            };
            if condition.range[0] != 0 {
                continue;
            }
            let faces = self.deck.keys(&condition)?;
            let entries: Option<Vec<_>> = faces.iter().map(|face| map.get(face)).collect();
            let Some(entries) = entries else { continue };
            let Some(series) = entries.first().map(|first| first.series.clone()) else {
                continue;
            };
            if entries.iter().all(|entry| entry.series == series) {
                faces.iter().for_each(|face| drop(map.remove(face)));
                let on = self.geometry.surface_name(name);
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
            let on = self.geometry.add_surface(&made("dload", place), faces);
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
        self.add_load("pressure", load, series, place);
    }

    /// Converts conditions in local axes: zero displacements become supports along these axes, and
    /// forces are resolved into global components.
    fn turn(&mut self, boundary: &mut Map, forces: &mut Map) -> Result<()> {
        let axes = self.deck.local_axes()?;
        if axes.is_empty() {
            return Ok(());
        }
        let turned: Vec<Key> = boundary
            .keys()
            .filter(|k| axes.contains_key(&k.0))
            .copied()
            .collect();
        let mut by_direction: BTreeMap<[u64; 3], (Vector, BTreeSet<u32>, LinePlace)> =
            BTreeMap::new();
        let is_moved = |key: &Key| !boundary[key].series.is_zero() && self.geometry.uses(key.0);
        let moved = turned.iter().filter(|k| is_moved(k)).map(|k| k.0);
        let in_steps = self.in_steps.iter().flat_map(SumInSteps::nodes);
        let in_steps = in_steps.filter(|node| axes.contains_key(node));
        let moved: BTreeSet<u32> = moved.chain(in_steps).collect();
        for &node in &moved {
            let known: Vec<AlongAxis> = take_known(node, &axes[&node], boundary).collect();
            self.move_along(node, &known, &axes, boundary);
        }
        for key in turned.into_iter().filter(|key| !moved.contains(&key.0)) {
            let Some(entry) = boundary.remove(&key) else {
                continue;
            };
            if !self.geometry.uses(key.0) {
                continue;
            }
            let direction = axes[&key.0][key.1 as usize];
            let bits = direction.map(|x| (x + 0.0).to_bits());
            let new = (direction, BTreeSet::new(), entry.place);
            by_direction.entry(bits).or_insert(new).1.insert(key.0);
        }
        for (direction, nodes, place) in by_direction.into_values() {
            let name = made("boundary", place);
            let on = self.geometry.add_nodes(&name, nodes.into_iter().collect());
            let direction = Some(self.components(direction));
            let support = Support {
                on,
                direction,
                ..Support::default()
            };
            self.add_support(support, place);
        }
        let turned: Vec<Key> = forces
            .keys()
            .filter(|k| axes.contains_key(&k.0))
            .copied()
            .collect();
        let turned: Vec<_> = turned
            .into_iter()
            .filter_map(|k| Some((k, forces.remove(&k)?)))
            .collect();
        for ((node, axis), entry) in turned {
            let shares = axes[&node][axis as usize].iter().enumerate();
            for (global, &share) in shares.filter(|(_, share)| share.abs() > ROUND_OFF) {
                let mut of_axis = entry.clone();
                of_axis.series = Series::starting(0.0);
                let sum = forces.entry((node, global as u8)).or_insert(of_axis);
                sum.series.add(&entry.series, share);
            }
        }
        Ok(())
    }
}

/// What is prescribed along the axes of a node, which is taken from the map.
pub(super) fn take_known<'m>(
    node: u32,
    axes: &[Vector; 3],
    boundary: &'m mut Map,
) -> impl Iterator<Item = AlongAxis> + use<'m> {
    let axes = *axes;
    (0..3u8).filter_map(move |axis| {
        let entry = boundary.remove(&(node, axis))?;
        Some(AlongAxis {
            axis: axes[axis as usize],
            of: FreedomCoefficients::new(),
            moved: entry.series,
            place: entry.place,
        })
    })
}
