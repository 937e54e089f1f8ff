//! The position of the load program between two steps.

use super::cycles::CycleRecord;
use super::stopwatch::Stopwatch;
use crate::analysis::figures::deformation::Deformation;
use crate::analysis::figures::measure::{ContactFigures, total_load_size};
use crate::analysis::increments::drive::Drive;
use crate::analysis::stress::recovery::{RecoveredPeak, Watched};
use crate::analysis::structure::solver::Solver;
use crate::analysis::structure::state::State;
use crate::results::YieldPoint;
use serde::{Deserialize, Serialize};

/// Largest number of doublings of the load in the search for first yield or for a target.
pub(super) const DOUBLINGS: usize = 60;

/// The position of the load program between two steps. The rest of the program depends only on this
/// position, on the state of the structure, and on the state at the start of the way to the target.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Position {
    /// Current part of the program.
    pub(super) stage: Stage,
    /// Number of targets reached in the current cycle.
    pub(super) target: usize,
    /// Record of the cycles completed so far.
    pub(super) cycles: CycleRecord,
    /// Number of zones that were too small for the current target.
    pub(super) attempt: usize,
    /// The search for the current target, if the target is not a load factor.
    pub(super) search: Option<TargetSearch>,
    /// Load factors at the ends of the straight pieces ahead, beginning with the current piece.
    pub(super) stops: Vec<f64>,
    /// The drive along the current piece.
    pub(super) drive: Option<Drive>,
    /// Number of fixed increments taken on the current piece before the zone was changed.
    pub(super) taken: usize,
    /// Absolute load factor up to which the zone was chosen, if the zone follows the load.
    pub(super) zone_until: f64,
    /// Knowledge about first yield.
    pub(super) first_yield: FirstYield,
    /// Share of the program that was reported as done: it never falls.
    pub(super) fraction: f64,
    /// Time spent so far, by row of the time table.
    pub(super) seconds: Stopwatch,
    /// Largest deformation of the states, by which it is judged whether strains and rotations are
    /// small.
    pub(super) deformation: Deformation,
}

/// The purpose of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::analysis) enum Purpose {
    /// The whole program.
    Program,
    /// The load at first yield.
    YieldLoad,
    /// The stress from which a finer mesh chooses its zone; a run for this purpose also ends at
    /// first yield.
    Zone,
}

/// A part of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Stage {
    /// Constant loads and interference are applied.
    Preload {
        /// Whether the preload is applied for the second time, now watched for yield from its
        /// start.
        again: bool,
    },
    /// Target after target is reached.
    Targets,
    /// First yield was found, and nothing else is asked for.
    YieldOnly,
}

impl Default for Stage {
    fn default() -> Self {
        Stage::Preload { again: false }
    }
}

/// A search for the load factor at which a quantity has its target value.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct TargetSearch {
    /// Load factor to which the current way leads.
    pub(super) end: f64,
    /// Number of ways tried.
    pub(super) rounds: usize,
    /// Whether the load factor grows.
    pub(super) upward: bool,
    /// Size by which the quantity is divided.
    pub(super) scale: f64,
    /// Distance of the quantity from its target value at the start.
    pub(super) at_first: f64,
}

impl TargetSearch {
    /// A search that begins at a load factor: from here on, the load factor moves up (doubling) or
    /// down to zero until the monitored quantity, which is `off` now, vanishes.
    pub(super) fn new(alpha: f64, off: f64, upward: bool, scale: f64) -> Self {
        TargetSearch {
            end: alpha,
            rounds: 0,
            upward,
            scale,
            at_first: off.abs(),
        }
    }

    /// Goes on to the next load factor: twice the current one, and at least twice `begun`, if the
    /// load factor grows; otherwise zero. Returns false if there is no further load factor.
    pub(super) fn widen(&mut self, begun: f64) -> bool {
        let next = match (self.upward, self.end > 0.0) {
            _ if self.rounds == DOUBLINGS => return false,
            (true, _) => 2.0 * self.end.max(begun),
            (false, true) => 0.0,
            (false, false) => return false,
        };
        self.end = next;
        self.rounds += 1;
        true
    }

    /// Share of the way that has been covered, for a value of the monitored quantity.
    pub(super) fn share_behind(&self, monitored: f64) -> f64 {
        within_0_and_1(1.0 - monitored.abs() / self.at_first)
    }
}

/// Knowledge about first yield.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(super) struct FirstYield {
    /// Whether the material has yielded, so that increments are elastoplastic.
    pub(super) is_behind: bool,
    /// Load factor at first yield in the program's unit.
    pub(super) alpha: Option<f64>,
    /// Load factors between which the virgin structure is known to stay elastic.
    pub(super) elastic_range: [f64; 2],
    /// Place and load at which first yield was found.
    pub(super) point: Option<YieldPoint>,
    /// Points at which the stress is watched on the way to first yield.
    pub(super) watched: Watched,
}

impl FirstYield {
    /// Records that the material yields in the current state.
    pub(super) fn record(&mut self, solver: &Solver, peak: RecoveredPeak) {
        let figures = ContactFigures::of(solver);
        self.is_behind = true;
        self.point.get_or_insert(YieldPoint {
            alpha: solver.at.alpha,
            load: total_load_size(solver),
            max_pressure: figures.max_pressure,
            half_width: figures.half_width,
            half_width_reading: figures.half_width_reading,
            location: peak.location,
            body: peak.body,
        });
    }

    /// Whether the structure is known to stay elastic between two load factors.
    pub(super) fn excludes(&self, from: f64, to: f64) -> bool {
        let [low, high] = self.elastic_range;
        from.min(to) >= low && from.max(to) <= high
    }
}

/// The start of the way to a target. The way is repeated from there if the zone was too small for
/// it.
#[derive(Serialize, Deserialize)]
pub(super) struct Start {
    pub(super) state: State,
    pub(super) first_yield: FirstYield,
    /// Number of increments accepted before the start.
    pub(super) rows: usize,
}

/// Share of the way between two load factors that has been covered. Changes of contact are assumed
/// to be spread evenly over the factor to the power `power`.
pub(super) fn share_of_way(alpha: f64, from: f64, to: f64, power: f64) -> f64 {
    if from == to {
        return 1.0;
    }
    let [alpha, from, to] = [alpha, from, to].map(|f| f.abs().powf(power).copysign(f));
    within_0_and_1((alpha - from) / (to - from))
}

fn within_0_and_1(share: f64) -> f64 {
    if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_the_way_runs_from_0_to_1_and_is_a_number_whatever_comes() {
        let up = |alpha| share_of_way(alpha, 1.0, 3.0, 1.0);
        assert_eq!([1.0, 2.0, 3.0].map(up), [0.0, 0.5, 1.0]);
        assert_eq!(share_of_way(0.5, 2.0, 0.0, 1.0), 0.75);
        // Half of the pairs of a line contact are still to open at a quarter of the load.
        assert_eq!(share_of_way(0.25, 1.0, 0.0, 0.5), 0.5);
        assert_eq!(share_of_way(-0.25, 1.0, -1.0, 0.5), 0.75);
        let search = |at_first| TargetSearch {
            end: 1.0,
            rounds: 1,
            upward: true,
            scale: 1.0,
            at_first,
        };
        let monitored = [0.5, -0.25, 0.0, 9.0].map(|m| search(0.5).share_behind(m));
        assert_eq!(monitored, [0.0, 0.5, 1.0, 0.0]);
        for share in [
            up(f64::NAN),
            search(0.5).share_behind(f64::NAN),
            search(0.0).share_behind(0.0),
            search(f64::NAN).share_behind(1.0),
        ] {
            assert!((0.0..=1.0).contains(&share), "{share}");
        }
        assert_eq!(share_of_way(1.0, 1.0, 1.0, 0.5), 1.0);
    }
}
