//! What a checkpoint keeps of the zone: the history, and what the next increment is predicted from.

use super::Zone;
use crate::analysis::packed::{Ascending, SparseHistory};
use crate::material::{PlasticState, Softening};
use serde::{Deserialize, Serialize};

/// The zone between two increments, without its elements.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct ZoneRecord {
    history: SparseHistory,
    /// Elements (places in the zone) with a point that flowed last.
    active: Ascending,
    /// Their points (places in the zone's arrays) that did.
    flowing: Ascending,
    /// What flow takes off the elastic matrix there.
    softening: Vec<Softening>,
}

impl Zone {
    /// The record of this zone.
    pub(in crate::analysis) fn record(&self) -> ZoneRecord {
        let active = self.active.iter().map(|&i| i as usize);
        let points = active.clone().flat_map(|i| self.points_of(i));
        let flowing: Vec<usize> = points.filter(|&point| self.flows[point]).collect();
        ZoneRecord {
            history: SparseHistory::new(&self.committed),
            active: Ascending::new(active),
            softening: flowing.iter().map(|&point| self.softening[point]).collect(),
            flowing: Ascending::new(flowing),
        }
    }

    /// Takes over what a zone of the same elements recorded; false where it is of others.
    pub(in crate::analysis) fn recall(&mut self, record: &ZoneRecord) -> bool {
        let mut history = vec![PlasticState::default(); self.committed.len()];
        let fits = record.history.unpack(&mut history)
            && record.active.within(self.elements.list.len())
            && record.flowing.within(self.flows.len())
            && record.flowing.len() == record.softening.len();
        if !fits {
            return false;
        }
        self.restore(&history);
        self.flows.fill(false);
        self.softening.fill(Softening::NONE);
        self.active = record.active.iter().map(|i| i as u32).collect();
        for (point, softening) in record.flowing.iter().zip(&record.softening) {
            self.flows[point] = true;
            self.softening[point] = *softening;
        }
        true
    }
}
