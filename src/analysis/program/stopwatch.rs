//! The time table of a run: at each moment one row of it is running.
//!
//! The stopwatch is switched from row to row and never stopped in between, so that the rows add up
//! to the whole by construction. Work that is done on the way through other work has its own row
//! and not the other's.

use crate::results::FACTORISATION_ROW;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// A row of the time table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TimeRow {
    /// Factorisations, condensed loads, and changes of the zone.
    Condensation,
    /// The search for the load at first yield.
    YieldLoad,
    /// Choice of the zone by the stress at the largest loads.
    Zone,
    /// Increments before first yield.
    Contact,
    /// Increments beyond it.
    Plasticity,
    /// What is noted of each increment: contact patches, pressures, points of the path; and the
    /// way from target to target.
    History,
    /// Figures of states: displacements, contact patches, dents, quality.
    States,
    /// Stresses of all elements.
    Stresses,
    /// Writing of checkpoints.
    Checkpoints,
}

impl TimeRow {
    /// All rows with their names, in the order in which they are shown.
    pub(super) const ALL: [(TimeRow, &str); 9] = [
        (TimeRow::Condensation, FACTORISATION_ROW),
        (TimeRow::YieldLoad, "yield load"),
        (TimeRow::Zone, "choice of the zone"),
        (TimeRow::Contact, "elastic increments"),
        (TimeRow::Plasticity, "elastoplastic increments"),
        (TimeRow::History, "history"),
        (TimeRow::States, "states"),
        (TimeRow::Stresses, "stresses"),
        (TimeRow::Checkpoints, "checkpoints"),
    ];
}

/// A stopwatch that runs for one row at a time. What a checkpoint holds of it are the seconds so
/// far: it goes on from there.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Stopwatch {
    seconds: [f64; TimeRow::ALL.len()],
    #[serde(skip, default = "first_row")]
    row: TimeRow,
    #[serde(skip, default = "Instant::now")]
    since: Instant,
}

fn first_row() -> TimeRow {
    TimeRow::Condensation
}

impl Default for Stopwatch {
    fn default() -> Self {
        Stopwatch {
            seconds: [0.0; TimeRow::ALL.len()],
            row: first_row(),
            since: Instant::now(),
        }
    }
}

impl Stopwatch {
    /// This stopwatch, running for its row from `since` on.
    pub(super) fn running_since(self, since: Instant) -> Self {
        Stopwatch { since, ..self }
    }

    /// Runs for another row from now on; the row before.
    pub(super) fn switch(&mut self, to: TimeRow) -> TimeRow {
        let now = Instant::now();
        self.seconds[self.row as usize] += now.duration_since(self.since).as_secs_f64();
        self.since = now;
        std::mem::replace(&mut self.row, to)
    }

    /// Seconds that were spent for the row at hand and belong to another, which was measured on its
    /// own.
    pub(super) fn hand_over(&mut self, seconds: f64, to: TimeRow) {
        self.seconds[self.row as usize] -= seconds;
        self.seconds[to as usize] += seconds;
    }

    /// Seconds of a row up to the last switch.
    pub(super) fn seconds(&self, row: TimeRow) -> f64 {
        self.seconds[row as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Instants are read once for the row that ends and the one that begins: nothing is lost and
    /// nothing counts twice.
    #[test]
    fn rows_add_up_to_the_whole() {
        for (place, (row, _)) in TimeRow::ALL.into_iter().enumerate() {
            assert_eq!(row as usize, place);
        }
        let begun = Instant::now();
        let mut watch = Stopwatch::default().running_since(begun);
        let mut before = TimeRow::Condensation;
        for k in 0..1000 {
            let next = TimeRow::ALL[k * 7 % TimeRow::ALL.len()].0;
            assert_eq!(watch.switch(next), before);
            watch.hand_over(1e-7, TimeRow::Stresses);
            before = next;
        }
        watch.switch(before);
        let whole = watch.since.duration_since(begun).as_secs_f64();
        let sum: f64 = TimeRow::ALL
            .iter()
            .map(|(row, _)| watch.seconds(*row))
            .sum();
        // Durations are whole nanoseconds: what is left is the round-off of some thousand sums.
        assert!(
            (sum - whole).abs() <= 4e3 * f64::EPSILON * (whole + 1e-4),
            "{sum} {whole}"
        );
    }

    #[test]
    fn what_a_checkpoint_holds_goes_on() {
        let mut watch = Stopwatch::default();
        watch.switch(TimeRow::States);
        let bytes = postcard::to_stdvec(&watch).unwrap();
        let mut again: Stopwatch = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(again.seconds, watch.seconds);
        assert_eq!(again.switch(TimeRow::Contact), TimeRow::Condensation);
        assert!(again.seconds(TimeRow::Condensation) >= watch.seconds(TimeRow::Condensation));
    }
}
