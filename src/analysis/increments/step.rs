//! Settings and results of a drive along a straight piece of the load path.

use crate::analysis::stress::recovery::RecoveredPeak;
use crate::analysis::structure::solver::Solver;
use crate::contact::Change;
use crate::error::{Error, ErrorKind, Result};
use crate::model::LoadProgram;
use crate::scene::Settings;

/// Report on an accepted increment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IncrementReport {
    /// Description of the event that ended the increment.
    pub event: String,
    /// Number of material evaluations.
    pub iterations: usize,
    /// Number of trailing solves.
    pub trailing_solves: usize,
    /// Relative out-of-balance force.
    pub residual: f64,
}

/// A measured quantity that ends a drive when it changes its sign.
pub type Monitor<'a> = dyn Fn(&mut Solver) -> Result<f64> + 'a;

/// The way in which a drive ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arrival {
    /// The drive ended at the end of the piece.
    End,
    /// The drive ended where the monitored quantity is zero.
    Monitor,
    /// The drive ended at first yield.
    Yield(RecoveredPeak),
    /// The drive ended because a guard element yields: the zone must grow, and the last increment
    /// was not taken.
    ZoneTooSmall,
    /// The drive ended because the load factor has left the range for which the zone was chosen.
    ZoneOutgrown,
}

/// Result of one step of a drive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Step {
    /// The increment that was accepted, if one was.
    pub increment: Option<IncrementReport>,
    /// How the drive ended, if it did.
    pub arrival: Option<Arrival>,
}

impl Step {
    /// The end of a drive without a further increment.
    pub fn arrived(arrival: Arrival) -> Self {
        Step {
            increment: None,
            arrival: Some(arrival),
        }
    }
}

/// Settings by which increments are taken.
#[derive(Clone, Copy)]
pub struct Rules<'a> {
    /// Solver settings.
    pub settings: &'a Settings,
    /// The program, with the way in which increments are chosen.
    pub program: &'a LoadProgram,
    /// Absolute load factor up to which the zone was chosen.
    pub zone_until: f64,
    /// Called between iterations; true stops the run at the last accepted increment.
    pub stop: &'a dyn Fn() -> bool,
}

/// Accuracy to which a monitored quantity (of order 1) is brought to its zero, and relative
/// accuracy of the place of the zero.
pub(in crate::analysis) const MONITOR_ACCURACY: f64 = 1e-10;
/// Fraction of a piece of the load path below which increments are not cut. If not even such a
/// short increment is found because the load has passed the limit load, the limit load is known to
/// this share of the piece.
pub(super) const SMALLEST_CUT: f64 = 1e-6;

/// Whether the monitored quantity is zero at the start of a drive. Along the drive it would then
/// not change its sign.
pub(super) fn is_hit(monitored: Option<f64>) -> bool {
    monitored.is_some_and(|value| value.abs() <= MONITOR_ACCURACY)
}

/// Whether a monitored quantity is zero or has changed its sign.
pub(in crate::analysis) fn crosses(was: f64, is: f64) -> bool {
    is == 0.0 || (is > 0.0) != (was > 0.0)
}

/// The error of a run that its caller stopped.
pub fn stopped() -> Error {
    Error::new(ErrorKind::Stopped, "stopped on request")
}

/// Describes the changes of contact that ended an increment.
pub fn describe(changes: &[Change]) -> String {
    let words: Vec<String> = changes
        .iter()
        .take(4)
        .map(|c| match c {
            Change::Closes(k) => format!("closes: pair {}", k + 1),
            Change::Opens(k) => format!("opens: pair {}", k + 1),
        })
        .collect();
    let more = if changes.len() > 4 {
        format!(" and {} more", changes.len() - 4)
    } else {
        String::new()
    };
    words.join(", ") + &more
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Descriptions count pairs from 1, whether the pairs close or open.
    #[test]
    fn events_name_their_pairs() {
        let one = [Change::Closes(0), Change::Opens(3)];
        assert_eq!(describe(&one), "closes: pair 1, opens: pair 4");
        let many: Vec<Change> = (0..6).map(Change::Opens).collect();
        assert_eq!(
            describe(&many),
            "opens: pair 1, opens: pair 2, opens: pair 3, opens: pair 4 and 2 more"
        );
    }
}
