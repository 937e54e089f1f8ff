//! The scene under construction: supports, loads and contacts with their places.

use super::super::Deck;
use super::super::history::KeyHistory;
use super::super::linear::FreedomCoefficients;
use super::super::series::Series;
use super::super::source::LinePlace;
use super::Geometry;
use crate::scene::{Contact, Direction, Equation, Load, LooseNode, Support, Tie};
use crate::space::{Components, Vector};
use std::collections::BTreeMap;

/// The condition that a sum of displacements along x, y and z has a value over some steps.
pub(super) struct SumInSteps {
    pub(super) terms: FreedomCoefficients,
    pub(super) entry: KeyHistory,
}

impl SumInSteps {
    /// Nodes of the sum.
    pub(super) fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.terms.keys().map(|key| key.0)
    }
}

/// Parts of a scene, and the sets to which they refer.
pub(super) struct Draft<'d> {
    pub(super) deck: &'d Deck,
    pub(super) geometry: Geometry,
    /// Thickness of a plane model: forces of the scene are per unit thickness.
    pub(super) thickness: f64,
    pub(super) supports: Vec<Support>,
    /// Loads at their largest value, each with its history.
    pub(super) loads: Vec<(Load, Series)>,
    pub(super) contacts: Vec<Contact>,
    pub(super) ties: Vec<Tie>,
    pub(super) equations: Vec<Equation>,
    /// Sums of displacements that are given in some steps only.
    pub(super) in_steps: Vec<SumInSteps>,
    /// Names of the sets of a single node that equations use.
    pub(super) sets_of_nodes: BTreeMap<u32, String>,
    /// Nodes without elements, by node number.
    pub(super) loose: BTreeMap<u64, LooseNode>,
    /// Lines of the deck, by key of the scene.
    pub(super) places: BTreeMap<String, String>,
}

impl<'d> Draft<'d> {
    pub(super) fn new(deck: &'d Deck, geometry: Geometry, thickness: f64) -> Self {
        Draft {
            deck,
            geometry,
            thickness,
            supports: Vec::new(),
            loads: Vec::new(),
            contacts: Vec::new(),
            ties: Vec::new(),
            equations: Vec::new(),
            in_steps: Vec::new(),
            sets_of_nodes: BTreeMap::new(),
            loose: BTreeMap::new(),
            places: BTreeMap::new(),
        }
    }

    /// A vector with as many components as the model has axes.
    pub(super) fn components(&self, vector: Vector) -> Components {
        match self.deck.dimension() {
            2 => [vector[0], vector[1]].into(),
            _ => vector.into(),
        }
    }

    /// Holds a set along axes; a preceding support of the same set is extended.
    pub(super) fn hold(&mut self, on: &str, axes: &[usize], place: LinePlace) {
        let directions = axes.iter().map(|&axis| Direction::ALL[axis]);
        if let Some(last) = self.supports.last_mut()
            && last.on == on
            && last.direction.is_none()
        {
            let new: Vec<Direction> = directions.filter(|d| !last.fix.contains(d)).collect();
            last.fix.extend(new);
            return;
        }
        let support = Support {
            on: on.to_string(),
            fix: directions.collect(),
            ..Support::default()
        };
        self.add_support(support, place);
    }

    pub(super) fn add_support(&mut self, support: Support, place: LinePlace) {
        let key = format!("support.{}", self.supports.len());
        self.places.insert(key, self.deck.files.show(place));
        self.supports.push(support);
    }

    /// Adds a load under a name made from `kind`.
    pub(super) fn add_load(
        &mut self,
        kind: &str,
        mut load: Load,
        series: Series,
        place: LinePlace,
    ) {
        let number = self.loads.len();
        load.name = format!("{kind}-{}", number + 1);
        self.places
            .insert(format!("load.{number}"), self.deck.files.show(place));
        self.loads.push((load, series));
    }
}

/// The name of a set that is made for a line of the deck.
pub(super) fn made(keyword: &str, place: LinePlace) -> String {
    format!("{keyword}-line-{}", place.line())
}
