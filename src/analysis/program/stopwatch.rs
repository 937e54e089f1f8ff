//! The time table of a run: at each moment exactly one row of it is running.
//!
//! The stopwatch is switched from row to row and never stopped in between, so that the rows add up
//! to the whole by construction. Work done within other work counts in its own row and not in the
//! row of the other work.

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
    /// Choice of the zone from the stress at the largest loads.
    Zone,
    /// Increments before first yield.
    Contact,
    /// Increments beyond first yield.
    Plasticity,
    /// Records of each increment (contact patches, pressures, points of the path), and the
    /// transition from target to target.
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

/// A stopwatch that runs for one row at a time. A checkpoint holds its seconds so far, from which
/// it continues.
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
    /// Returns this stopwatch, with its current row running since `since`.
    pub(super) fn running_since(self, since: Instant) -> Self {
        Stopwatch { since, ..self }
    }

    /// Switches to another row and returns the row that was running previously.
    pub(super) fn switch(&mut self, to: TimeRow) -> TimeRow {
        let now = Instant::now();
        self.seconds[self.row as usize] += now.duration_since(self.since).as_secs_f64();
        self.since = now;
        std::mem::replace(&mut self.row, to)
    }

    /// Moves seconds from the current row to another row, to which they belong and for which they
    /// were measured separately.
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

    /// The clock is read once for the row that ends and the row that begins, so that no time is
    /// lost or counted twice.
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
        // Durations are whole nanoseconds: the difference is the round-off of some thousand sums.
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
