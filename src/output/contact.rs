//! `contact.csv`: a row for each state and contact pair. States, pairs and contacts are counted
//! from 1. Units are those of the scene. A positive gap is open; a positive force or pressure is
//! compressive.

use super::table;
use crate::results::{PairState, State, Status, number};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// A row of the table. The columns are the fields.
#[derive(Serialize, Deserialize)]
pub(super) struct PairRow {
    /// Number of the state, from 1, as in the names of the field files.
    pub state: usize,
    #[serde(deserialize_with = "number")]
    alpha: f64,
    /// Number of the pair, from 1, as in the history's events and in messages.
    pub pair: usize,
    /// Number of the contact, from 1, in the order of the scene.
    pub contact: usize,
    /// First coordinate of the pair's undeformed position on the second surface: x, or r in an
    /// axisymmetric model.
    #[serde(deserialize_with = "number")]
    x: f64,
    /// Second coordinate of that position: y, or z in an axisymmetric model.
    #[serde(deserialize_with = "number")]
    y: f64,
    /// Undeformed z; only in a solid model.
    #[serde(skip_serializing_if = "Option::is_none")]
    z: Option<f64>,
    #[serde(deserialize_with = "number")]
    gap: f64,
    #[serde(deserialize_with = "number")]
    force: f64,
    #[serde(deserialize_with = "number")]
    area: f64,
    #[serde(deserialize_with = "number")]
    pressure: f64,
    status: Status,
    /// Name of the state.
    name: String,
}

impl PairRow {
    fn new(dimension: usize, state: usize, name: &str, alpha: f64, pair: &PairState) -> Self {
        PairRow {
            state,
            alpha,
            pair: pair.pair + 1,
            contact: pair.contact + 1,
            x: pair.position[0],
            y: pair.position[1],
            z: (dimension == 3).then_some(pair.position[2]),
            gap: pair.gap,
            force: pair.force,
            area: pair.area,
            pressure: pair.pressure,
            status: pair.status,
            name: name.to_string(),
        }
    }

    /// Returns the pair that the row records.
    pub(super) fn pair_state(&self) -> PairState {
        PairState {
            pair: self.pair - 1,
            contact: self.contact - 1,
            position: [self.x, self.y, self.z.unwrap_or(0.0)],
            gap: self.gap,
            force: self.force,
            area: self.area,
            pressure: self.pressure,
            status: self.status,
        }
    }
}

/// Writes the contact pairs of all states.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write(out: &mut impl Write, dimension: usize, states: &[State]) -> io::Result<()> {
    let nothing = PairState {
        pair: 0,
        contact: 0,
        position: [0.0; 3],
        gap: 0.0,
        force: 0.0,
        area: 0.0,
        pressure: 0.0,
        status: Status::Open,
    };
    let rows = states.iter().enumerate().flat_map(|(i, state)| {
        let pairs = state.pairs.iter();
        pairs.map(move |pair| PairRow::new(dimension, i + 1, &state.name, state.alpha, pair))
    });
    table::write(out, &PairRow::new(dimension, 0, "", 0.0, &nothing), rows)
}

#[cfg(test)]
mod tests {
    use super::PairRow;
    use crate::results::{PairState, Status};

    #[test]
    fn a_solid_has_a_third_coordinate() {
        let pair = PairState {
            pair: 0,
            contact: 0,
            position: [1.0, 2.0, 3.0],
            gap: 0.0,
            force: 0.0,
            area: 0.0,
            pressure: 0.0,
            status: Status::Closed,
        };
        let row = |dimension: usize| PairRow::new(dimension, 0, "end", 1.0, &pair);
        assert_eq!((row(3).x, row(3).y, row(3).z), (1.0, 2.0, Some(3.0)));
        assert_eq!(row(2).z, None);
    }
}
