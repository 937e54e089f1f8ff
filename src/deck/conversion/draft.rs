//! The scene under construction: supports, loads and equations with their places.

use super::super::Deck;
use super::super::constraints::{GLOBAL, LocalAxes};
use super::super::data::Account;
use super::super::facets::Key;
use super::super::history::KeyHistory;
use super::super::series::Series;
use super::super::source::LinePlace;
use super::Geometry;
use crate::scene::{Direction, Displacement, Equation, EquationTerm, Load, Relative, Support};
use crate::space::{Components, Vector};
use std::collections::BTreeMap;

/// Size of a sum of displacements, relative to its terms, up to which the sum counts as zero.
pub(super) const ROUND_OFF: f64 = 1e-9;

/// Parts of a scene, and the sets to which they refer.
pub(super) struct Draft<'d> {
    pub(super) deck: &'d Deck,
    /// Account of how the lines of the deck are treated.
    pub(super) account: Account,
    pub(super) geometry: Geometry,
    /// Thickness of a plane model: forces of the scene are per unit thickness.
    pub(super) thickness: f64,
    pub(super) supports: Vec<Support>,
    /// Loads at their largest value, each with its history.
    pub(super) loads: Vec<(Load, Series)>,
    pub(super) equations: Vec<Equation>,
    /// Names of the sets of a single node that equations use.
    sets_of_nodes: BTreeMap<u32, String>,
    /// Lines of the deck, by key of the scene.
    pub(super) places: BTreeMap<String, String>,
}

impl<'d> Draft<'d> {
    pub(super) fn new(
        deck: &'d Deck,
        account: Account,
        geometry: Geometry,
        thickness: f64,
    ) -> Self {
        Draft {
            deck,
            account,
            geometry,
            thickness,
            supports: Vec::new(),
            loads: Vec::new(),
            equations: Vec::new(),
            sets_of_nodes: BTreeMap::new(),
            places: BTreeMap::new(),
        }
    }

    /// Records a remark on how a line of the deck is interpreted.
    pub(super) fn remark(&mut self, place: LinePlace, keyword: &str, text: &str) {
        self.account.take(&self.deck.files, place, keyword, text);
    }

    /// A vector with as many components as the model has axes.
    pub(super) fn components(&self, vector: Vector) -> Components {
        match self.deck.mesh.dimension() {
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

    /// Moves a set along an axis.
    pub(super) fn displace(&mut self, on: String, axis: u8, entry: KeyHistory) {
        let value = |of: u8| (of == axis).then(|| entry.series.largest().into());
        let load = Load {
            on,
            displacement: Some(Displacement {
                x: value(0),
                y: value(1),
                z: value(2),
            }),
            since: entry.span.since,
            until: entry.span.until,
            ..Load::default()
        };
        self.add_load("displacement", load, entry.series, entry.place);
    }

    pub(super) fn add_equation(&mut self, terms: Vec<EquationTerm>, place: LinePlace) {
        let key = format!("equation.{}", self.equations.len());
        self.places.insert(key, self.deck.files.show(place));
        self.equations.push(Equation { terms });
    }

    /// Adds the equation that a sum of terms and a value over time is zero; if the value itself is
    /// not zero, the equation becomes a load.
    pub(super) fn relate(&mut self, terms: Vec<EquationTerm>, moved: Series, place: LinePlace) {
        if moved.is_zero() {
            return self.add_equation(terms, place);
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

    /// The terms along x, y and z of a displacement along an axis of its node; the largest comes
    /// first.
    pub(super) fn components_of(
        &mut self,
        (node, axis): Key,
        coefficient: f64,
        axes: &LocalAxes,
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

    /// The name of a set with this node only.
    pub(super) fn set_of_node(&mut self, node: u32) -> String {
        let known = self.sets_of_nodes.get(&node);
        if let Some(name) = known {
            return name.clone();
        }
        let name = format!("node-{}", self.deck.mesh.node_label(node as usize));
        let name = self.geometry.add_nodes(&name, vec![node]);
        self.sets_of_nodes.insert(node, name.clone());
        name
    }
}

/// The name of a set that is made for a line of the deck.
pub(super) fn made(keyword: &str, place: LinePlace) -> String {
    format!("{keyword}-line-{}", place.line())
}
