//! The part of the zone, other than its history, that a checkpoint keeps. The next increment is
//! predicted from it.

use super::packed::Ascending;
use super::points::ZoneOf;
use crate::material::{Softening, resized};
use serde::{Deserialize, Serialize};

/// Record of the points of a zone that yielded at the last evaluated state.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct Yielding {
    /// Elements with a point that yielded, as indices in the zone.
    active: Ascending,
    /// Points of these elements that yielded, as indices in the zone's arrays.
    yielding: Ascending,
    /// Softening at these points: the part of the elastic matrix that flow takes off.
    softening: Vec<Softening<6>>,
    /// Unsymmetric part of the softening at these points; empty if no back stress fades.
    turn: Vec<[f64; 6]>,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> ZoneOf<D, S, P, N> {
    /// Records which points yielded at the last evaluated state.
    pub(in crate::analysis) fn yielding(&self) -> Yielding {
        let active = self.active.iter().map(|&i| i as usize);
        let points = active.clone().flat_map(|i| self.points_of(i));
        let yielding: Vec<usize> = points.filter(|&point| self.yields[point]).collect();
        Yielding {
            active: Ascending::new(active),
            softening: (yielding.iter())
                .map(|&point| self.softening[point].resized())
                .collect(),
            turn: (yielding.iter())
                .filter_map(|&point| self.turn.get(point))
                .map(resized)
                .collect(),
            yielding: Ascending::new(yielding),
        }
    }

    /// Takes over the record of another zone of the same elements; false if the record does not fit
    /// this zone.
    pub(in crate::analysis) fn set_yielding(&mut self, record: &Yielding) -> bool {
        let fits = record.active.within(self.elements.list.len())
            && record.yielding.within(self.yields.len())
            && record.yielding.len() == record.softening.len()
            && record.turn.len()
                == if self.turn.is_empty() {
                    0
                } else {
                    record.softening.len()
                };
        if !fits {
            return false;
        }
        self.yields.fill(false);
        self.softening.fill(Softening::NONE);
        self.active = record.active.iter().map(|i| i as u32).collect();
        for (point, softening) in record.yielding.iter().zip(&record.softening) {
            self.yields[point] = true;
            self.softening[point] = softening.resized();
        }
        for (point, turn) in record.yielding.iter().zip(&record.turn) {
            self.turn[point] = resized(turn);
        }
        true
    }
}
