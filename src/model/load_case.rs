//! A load as nodal forces and forces on the free freedoms, with its history.

use super::Pair;
use super::freedoms::{Freedoms, Slot};
use super::heat::FreeStrain;
use super::openings::Opening;
use crate::interpolation::interpolate;
use crate::scene::{self, History};
use crate::space::{Vector, dot, length};
use std::collections::BTreeMap;

/// Quantity that the reported magnitude of a load measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Magnitude {
    /// Total force on the whole (all copies of a symmetric model).
    Force,
    /// Pressure, traction or remote stress.
    Stress,
    /// Prescribed displacement.
    Displacement,
    /// Change of temperature.
    Temperature,
    /// Change of gaps in contact.
    Gap,
    /// Initial strain of a body.
    Strain,
    /// Displacements and support forces carried over from an earlier leg of the load program, a
    /// stretch in which the same displacements are held.
    Carried,
}

/// A load: nodal forces per unit of its factor, and how the factor depends on the load factor.
#[derive(Debug, Clone)]
pub struct LoadCase {
    /// Name of the load for messages.
    pub name: String,
    /// Nodal forces at factor 1, node by node in global axes (sparse).
    pub(super) nodal: Vec<(usize, Vector)>,
    /// Forces on the free freedoms at factor 1 (sparse, ascending).
    pub forces: Vec<(usize, f64)>,
    /// Dependence of the load on the load factor.
    pub history: History,
    /// Magnitude at factor 1, such as a force, stress or displacement.
    pub magnitude: f64,
    /// Quantity that the magnitude measures.
    pub measures: Magnitude,
    /// Nodes of the loaded set, for the approach.
    pub nodes: Vec<usize>,
    /// Share of each node in the mean over the loaded set: for a surface its part of the area (the
    /// integral of its shape function), for a node set equal parts. The shares add up to 1.
    pub shares: Vec<f64>,
    /// Body to which the loaded nodes belong, for the approach.
    pub body: u32,
    /// Unit direction of the load, for the approach.
    pub direction: Vector,
    /// Strains without stress at factor 1, from temperature or initial strain, in the elements of
    /// the load's body.
    pub free_strain: Vec<FreeStrain>,
    /// Contacts whose gaps this load changes, with the change at factor 1; empty for other loads.
    pub opens: Vec<(usize, Opening)>,
}

impl LoadCase {
    /// Factor of this load at load factor `alpha`, where `unit` is the value that `alpha = 1`
    /// represents.
    pub fn factor(&self, alpha: f64, unit: f64) -> f64 {
        match &self.history {
            History::Proportional => alpha * unit,
            History::Constant => 1.0,
            History::Table(rows) => interpolate(rows, alpha),
        }
    }

    /// Gap that the load adds to a pair at factor 1.
    pub fn gap(&self, pair: &Pair) -> f64 {
        let opened = self
            .opens
            .iter()
            .filter(|(contact, _)| *contact == pair.contact);
        opened
            .map(|(_, opening)| opening.at(pair.slave) * pair.unit_gap)
            .sum()
    }

    /// Whether the load changes anything at factor 1.
    pub(crate) fn acts(&self) -> bool {
        match self.measures {
            Magnitude::Displacement => self.magnitude != 0.0,
            Magnitude::Gap | Magnitude::Carried => self.magnitude != 0.0,
            _ => !self.free_strain.is_empty() || self.nodal.iter().any(|(_, f)| *f != [0.0; 3]),
        }
    }

    /// Sum of the absolute values of the nodal forces at factor 1.
    pub fn size(&self) -> f64 {
        self.nodal.iter().map(|(_, f)| length(*f)).sum()
    }

    /// Largest magnitude that the load reaches, for proportional loads at a load factor of 1: the
    /// sum of nodal forces, or the displacement; zero for a constant load.
    pub fn driven(&self, unit: f64) -> f64 {
        let factor = match &self.history {
            History::Proportional => unit.abs(),
            History::Constant => 0.0,
            History::Table(rows) => rows.iter().fold(0.0f64, |m, row| m.max(row[1].abs())),
        };
        let size = match self.measures {
            Magnitude::Displacement => self.magnitude.abs(),
            Magnitude::Carried => 0.0,
            _ => self.size(),
        };
        factor * size
    }

    /// Load factors at which the history has a kink.
    pub fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        let rows: &[[f64; 2]] = if let History::Table(rows) = &self.history {
            rows
        } else {
            &[]
        };
        rows.iter().map(|r| r[0])
    }

    /// Calls `act` with each slot on which a force acts, and the force at factor 1.
    pub(crate) fn each_on_slots(&self, freedoms: &Freedoms, act: impl FnMut(Slot, f64)) {
        each_on_slots(&self.nodal, freedoms, act);
    }

    /// Nodal forces as vectors in global axes, on control points.
    pub(super) fn nodal(&self) -> &[(usize, Vector)] {
        &self.nodal
    }

    /// A load without nodes and forces, for what an earlier leg of the program has left.
    pub(super) fn carried(name: &str, history: History) -> LoadCase {
        LoadCase {
            name: name.to_string(),
            nodal: Vec::new(),
            forces: Vec::new(),
            history,
            magnitude: 0.0,
            measures: Magnitude::Carried,
            nodes: Vec::new(),
            shares: Vec::new(),
            body: 0,
            direction: [0.0; 3],
            free_strain: Vec::new(),
            opens: Vec::new(),
        }
    }

    /// Sets magnitude and direction from a vector.
    pub(super) fn set_size(&mut self, vector: Vector, measures: Magnitude) {
        let size = length(vector);
        self.magnitude = size;
        self.measures = measures;
        if size > 0.0 {
            self.direction = vector.map(|v| v / size);
        }
    }
}

/// Name of a load of the scene for messages.
pub(super) fn name(index: usize, load: &scene::Load) -> String {
    match load.name.is_empty() {
        true => format!("load {}", index + 1),
        false => load.name.clone(),
    }
}

/// Forces on the free freedoms, ascending, from nodal forces.
pub(super) fn on_freedoms(nodal: &[(usize, Vector)], freedoms: &Freedoms) -> Vec<(usize, f64)> {
    let mut out = BTreeMap::new();
    each_on_slots(nodal, freedoms, |slot, force| {
        if let Slot::Free(f) = slot {
            *out.entry(f as usize).or_insert(0.0) += force;
        }
    });
    out.into_iter().collect()
}

fn each_on_slots(nodal: &[(usize, Vector)], freedoms: &Freedoms, mut act: impl FnMut(Slot, f64)) {
    for &(node, force) in nodal {
        for (slot, axis) in freedoms.slots[node].iter().zip(freedoms.local(node)) {
            freedoms.each(*slot, |slot, c| act(slot, c * dot(force, axis)));
        }
    }
}
