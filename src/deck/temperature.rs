//! Temperatures of a deck: what bodies begin with, go through, and what materials are at it.

use super::Deck;
use super::bodies::{Bodies, unsupported};
use super::data::{Hardening, Kind, MaterialData};
use super::series::Series;
use super::source::Place;
use crate::error::Result;
use crate::interpolation::interpolate;
use std::collections::BTreeMap;

/// What a body begins with and how that changes.
pub(super) struct OfBody {
    pub(super) initial: f64,
    pub(super) change: Series,
    /// The line that gave it last; none of a body without temperatures.
    pub(super) place: Option<Place>,
}

/// A material at one temperature.
pub(super) struct AtTemperature {
    /// Young's modulus and Poisson's ratio.
    pub(super) elastic: [f64; 2],
    /// Plastic strain and yield stress.
    pub(super) plastic: Hardening,
}

impl Deck {
    /// The temperatures of each body, which all its nodes have.
    ///
    /// # Errors
    /// Nodes of a body with different temperatures.
    pub(super) fn temperatures_of_bodies(&self, bodies: &Bodies) -> Result<Vec<OfBody>> {
        let none = || OfBody {
            initial: 0.0,
            change: Series::starting(0.0),
            place: None,
        };
        let histories = self.histories(Kind::Temperature)?;
        if histories.is_empty() {
            return Ok(bodies.names.iter().map(|_| none()).collect());
        }
        let mut initial: BTreeMap<u32, f64> = BTreeMap::new();
        let given = self.program.initial.iter();
        for condition in given.filter(|condition| condition.kind == Kind::Temperature) {
            for (node, _) in self.keys(condition)? {
                initial.insert(node, condition.value);
            }
        }
        let at = |node: u32| {
            let initial = initial.get(&node).copied().unwrap_or(0.0);
            let Some(entry) = histories.get(&(node, 0)) else {
                return OfBody {
                    initial,
                    change: Series::starting(0.0),
                    place: None,
                };
            };
            let mut change = entry.series.clone();
            change.add(&Series::starting(initial), -1.0);
            OfBody {
                initial,
                change,
                place: Some(entry.place),
            }
        };
        let mut out: Vec<Option<OfBody>> = bodies.names.iter().map(|_| None).collect();
        for (element, &body) in bodies.of_element.iter().enumerate() {
            for &node in self.element_nodes(element) {
                let here = at(node);
                let Some(first) = &out[body as usize] else {
                    out[body as usize] = Some(here);
                    continue;
                };
                let is_same =
                    first.initial == here.initial && first.change.bits() == here.change.bits();
                if !is_same {
                    let place = here.place.or(first.place).unwrap_or(self.end);
                    let message = format!(
                        "node {} has another temperature than others of body {}: a body has one",
                        self.nodes.labels[node as usize], bodies.names[body as usize]
                    );
                    return Err(unsupported(self.error(place, "TEMPERATURE", message)));
                }
            }
        }
        Ok(out
            .into_iter()
            .map(|of_body| of_body.unwrap_or_else(none))
            .collect())
    }
}

impl MaterialData {
    /// Whether its law depends on the temperature.
    pub(super) fn varies(&self) -> bool {
        self.elastic.len() > 1 || self.plastic.len() > 1
    }

    /// The law at a temperature, between the tables' linear and beyond them that of the last; none
    /// without an elastic one.
    pub(super) fn at(&self, temperature: f64) -> Option<AtTemperature> {
        if self.elastic.is_empty() {
            return None;
        }
        let column = |k: usize| -> Vec<[f64; 2]> {
            self.elastic.iter().map(|(t, law)| [*t, law[k]]).collect()
        };
        let elastic = [0, 1].map(|k| interpolate(&column(k), temperature));
        Some(AtTemperature {
            elastic,
            plastic: self.hardening_at(temperature),
        })
    }

    fn hardening_at(&self, temperature: f64) -> Hardening {
        let next = self.plastic.partition_point(|(t, _)| *t <= temperature);
        let below = next.checked_sub(1).and_then(|k| self.plastic.get(k));
        match (below, self.plastic.get(next)) {
            (None, None) => Hardening::new(),
            (Some((_, rows)), None) | (None, Some((_, rows))) => rows.clone(),
            (Some((low, cold)), Some((high, warm))) => {
                let share = (temperature - low) / (high - low);
                let mut strains: Vec<f64> = cold.iter().chain(warm).map(|row| row[0]).collect();
                strains.sort_by(f64::total_cmp);
                strains.dedup();
                let stress = |strain: f64| {
                    let [cold, warm] = [cold, warm].map(|rows| interpolate(rows, strain));
                    cold + share * (warm - cold)
                };
                strains
                    .into_iter()
                    .map(|strain| [strain, stress(strain)])
                    .collect()
            }
        }
    }
}

impl AtTemperature {
    /// The slope of hardening from the first row to the last.
    pub(super) fn slope(&self) -> Option<f64> {
        let ([from, low], [to, high]) = (*self.plastic.first()?, *self.plastic.last()?);
        (to > from).then(|| (high - low) / (to - from))
    }
}
