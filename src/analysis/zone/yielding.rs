//! What a checkpoint keeps of the zone besides the history: what the next increment is predicted
//! from.

use super::packed::Ascending;
use super::points::ZoneOf;
use crate::material::{Softening, resized};
use serde::{Deserialize, Serialize};

/// Which points of a zone yielded at the last evaluated state.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct Yielding {
    /// Elements (places in the zone) with a point that yielded.
    active: Ascending,
    /// Points of these elements (places in the zone's arrays) that yielded.
    yielding: Ascending,
    /// Softening: what flow takes off the elastic matrix at these points.
    softening: Vec<Softening<6>>,
    /// Part of the softening that is not symmetric, where there may be any.
    turn: Vec<[f64; 6]>,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> ZoneOf<D, S, P, N> {
    /// Which points yielded at the last evaluated state.
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

    /// Takes over what another zone of the same elements says; false where it is of others.
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
