//! Programs of cycles: the plastic flow of each cycle, and whether the next cycle would be like the
//! last.
//!
//! The change of the plastic strains over a cycle is compared, point by point, with the change over
//! the previous cycle. If the differences `r_k` fall like a geometric series, the cycles to come
//! alter the change by `r_k q/(1 - q)`, `q = r_k/r_(k-1)`. A cycle is steady once both values are a
//! small fraction of the flow of the first cycle. The flow that remains in the end is that of the
//! last cycle minus the alteration by the cycles to come. If none remains, plastic flow dies out,
//! however slowly; otherwise it goes on in every cycle, however small it is. Growth, the net change
//! of the plastic strains over a cycle, is judged in the same way. A cycle in which nothing flows
//! is steady at once. The states reported for a program come from one more cycle.

use crate::analysis::zone::history::PointHistory;
use crate::analysis::zone::packed;
use crate::material::PlasticState;
use crate::model::Model;
use crate::results::{CycleOutcome, CycleRow, Cycles, EndState};
use serde::{Deserialize, Serialize};

/// Bound on the flow of a cycle, divided by the flow that the cycles to come will take off it. This
/// ratio is 1 if flow dies out in a geometric series, and infinite if it is the same in each cycle.
/// Up to this bound flow counts as dying out: the rates differ between the points of the structure.
const DIES_OUT: f64 = 1.5;
/// Ratio above which flow counts as lasting; between [`DIES_OUT`] and this ratio another cycle is
/// run.
const LASTS: f64 = 2.0;

/// Record of the cycles so far.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct CycleRecord {
    rows: Vec<CycleRow>,
    /// Outcome of the cycles, once the next cycle would be like the last one.
    outcome: Option<CycleOutcome>,
    /// Whether the states of the last cycle were taken.
    is_over: bool,
    /// Elements of the zone at the end of the last cycle. `points` are the histories of their
    /// points, `change` is the change over this cycle, `difference` the largest difference from the
    /// cycle before.
    elements: Vec<usize>,
    #[serde(with = "packed::history")]
    points: Vec<PlasticState<6>>,
    #[serde(with = "packed::history")]
    change: Vec<PlasticState<6>>,
    difference: Option<f64>,
    /// The element with the largest change.
    place: usize,
}

impl CycleRecord {
    /// Whether the states of the current cycle are reported, in a program of at most `most` cycles.
    pub(super) fn is_last(&self, most: usize) -> bool {
        self.is_over || self.outcome.is_some() || self.rows.len() + 1 >= most
    }

    /// Number of cycles completed so far.
    pub(super) fn n_done(&self) -> usize {
        self.rows.len()
    }

    /// Records the end of a cycle, with the histories of the zone's elements. `steady` is the share
    /// of the largest flow of the first cycle that counts as none.
    fn end(&mut self, elements: &[usize], points: Vec<PlasticState<6>>, steady: f64) {
        let stride = points.len() / elements.len().max(1);
        let of_now = |known: &[PlasticState<6>]| aligned(known, &self.elements, elements, stride);
        let minus = |a: &[PlasticState<6>], b: &[PlasticState<6>]| -> Vec<PlasticState<6>> {
            let pairs = a.iter().zip(b);
            pairs.map(|(a, b)| difference(a, b)).collect()
        };
        let change = minus(&points, &of_now(&self.points));
        let unlike = minus(&change, &of_now(&self.change));
        let growth = largest(&change, |point| size(&point.strain));
        let row = CycleRow {
            cycle: self.rows.len() + 1,
            flow: largest(&change, |point| point.equivalent).1,
            growth: growth.1,
        };
        let before = self.difference.take();
        if !self.rows.is_empty() {
            let both = |point: &PlasticState<6>| size(&point.strain).max(point.equivalent.abs());
            self.difference = Some(largest(&unlike, both).1);
        }
        self.rows.push(row);
        self.place = elements.get(growth.0 / stride.max(1)).copied().unwrap_or(0);
        (self.elements, self.points, self.change) = (elements.to_vec(), points, change);
        // Once a cycle was steady, another cycle provides the states; round-off does not revoke
        // this.
        self.outcome = self.judge(row, before, steady).or(self.outcome);
    }

    /// Judges the last cycle: the outcome if the next cycle would be like it, `None` otherwise.
    /// `before` is the difference between the two cycles before it.
    fn judge(&self, row: CycleRow, before: Option<f64>, steady: f64) -> Option<CycleOutcome> {
        let first = self.rows[0].flow;
        if row.flow == 0.0 {
            return Some(match first == 0.0 {
                true => CycleOutcome::Elastic,
                false => CycleOutcome::ElasticShakedown,
            });
        }
        let small = steady * first;
        let (now, before) = (self.difference?, before?);
        let ahead = match now < before {
            true => now * now / (before - now),
            // The difference is no larger than the error of an iteration.
            false if now <= steady * small => now,
            false => f64::INFINITY,
        };
        if now.max(ahead) > small {
            return None;
        }
        // A flow below this is no larger than the error of an iteration.
        let none = steady * small;
        let dies_out = |size: f64| size <= DIES_OUT * ahead + none;
        let lasts = |size: f64| size > LASTS * ahead + none;
        if dies_out(row.flow) {
            Some(CycleOutcome::ElasticShakedown)
        } else if lasts(row.flow) && dies_out(row.growth) {
            Some(CycleOutcome::PlasticShakedown)
        } else if lasts(row.flow) && lasts(row.growth) {
            Some(CycleOutcome::Ratchetting)
        } else {
            None
        }
    }

    /// Records the end of a cycle of a program of at most `most` cycles, with the histories of the
    /// zone's elements. Returns whether another cycle follows. The first cycle began in the state
    /// `start` of an earlier run, if there was one.
    pub(super) fn begin_next(
        &mut self,
        (most, steady): (usize, f64),
        start: Option<&EndState>,
        elements: &[usize],
        history: impl FnOnce() -> PointHistory,
    ) -> bool {
        if most == 1 || self.is_over {
            return false;
        }
        if let Some(start) = start
            && self.rows.is_empty()
        {
            self.begin_with(start);
        }
        let was_last = self.is_last(most);
        self.end(elements, history().points, steady);
        self.is_over = was_last;
        !was_last
    }

    /// The outcome of the cycles; `None` if the program has no cycles.
    pub(super) fn outcome(&self, model: &Model) -> Option<Cycles> {
        if model.program.cycles == 1 {
            return None;
        }
        let body = model.mesh.element_body.get(self.place);
        let grows = self.rows.last().is_some_and(|row| row.growth > 0.0);
        Some(Cycles {
            outcome: self.outcome.unwrap_or_default(),
            body: body
                .filter(|_| grows)
                .map(|&body| model.mesh.bodies[body as usize].clone()),
            rows: self.rows.clone(),
        })
    }

    /// Sets the state before the first cycle to the state left by an earlier run.
    fn begin_with(&mut self, start: &EndState) {
        self.points = PointHistory::from(start).points;
        self.change = vec![PlasticState::default(); self.points.len()];
        self.elements.clone_from(&start.elements);
    }
}

/// Plastic states for the elements `to` of a zone, taken from those of another zone's elements
/// `from`; zero in elements that were not in that zone.
fn aligned(
    known: &[PlasticState<6>],
    from: &[usize],
    to: &[usize],
    stride: usize,
) -> Vec<PlasticState<6>> {
    let mut out = vec![PlasticState::default(); to.len() * stride];
    for (element, points) in to.iter().zip(out.chunks_mut(stride.max(1))) {
        if let Ok(i) = from.binary_search(element) {
            points.copy_from_slice(&known[i * stride..][..stride]);
        }
    }
    out
}

fn difference(a: &PlasticState<6>, b: &PlasticState<6>) -> PlasticState<6> {
    PlasticState {
        strain: std::array::from_fn(|k| a.strain[k] - b.strain[k]),
        equivalent: a.equivalent - b.equivalent,
    }
}

/// The equivalent strain `sqrt(2/3 e:e)` of a strain with engineering shear.
fn size(strain: &[f64; 6]) -> f64 {
    let [normal, shear] = [&strain[..3], &strain[3..]];
    let square = |part: &[f64]| part.iter().map(|e| e * e).sum::<f64>();
    (2.0 / 3.0 * (square(normal) + 0.5 * square(shear))).sqrt()
}

/// The largest value over points, with the index of its point.
fn largest(points: &[PlasticState<6>], of: impl Fn(&PlasticState<6>) -> f64) -> (usize, f64) {
    let values = points.iter().map(of).enumerate();
    values.fold(
        (0, 0.0),
        |most, next| if next.1 > most.1 { next } else { most },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The size of a strain is its equivalent strain, both in tension and in shear (engineering
    /// shear strains).
    #[test]
    fn the_size_of_flow_is_the_equivalent_strain() {
        assert!((size(&[1.0, -0.5, -0.5, 0.0, 0.0, 0.0]) - 1.0).abs() < 1e-15);
        let shear = size(&[0.0, 0.0, 0.0, 0.0, 3.0f64.sqrt(), 0.0]);
        assert!((shear - 1.0).abs() < 1e-15, "{shear}");
    }

    /// Cycles of one element with two points, whose plastic strains along x the closure returns.
    fn outcome(cycles: usize, strain: impl Fn(usize) -> [f64; 2]) -> (Option<CycleOutcome>, usize) {
        let mut record = CycleRecord::default();
        let (mut before, mut equivalent) = ([0.0; 2], [0.0; 2]);
        for cycle in 1..=cycles {
            let now = strain(cycle);
            let point = |k: usize| PlasticState {
                strain: [now[k], -0.5 * now[k], -0.5 * now[k], 0.0, 0.0, 0.0],
                equivalent: equivalent[k] + (now[k] - before[k]).abs(),
            };
            let points: Vec<PlasticState<6>> = [0, 1].map(point).to_vec();
            equivalent = [0, 1].map(|k| points[k].equivalent);
            before = now;
            record.end(&[7], points, 1e-3);
            if let Some(outcome) = record.outcome {
                return (Some(outcome), cycle);
            }
        }
        (None, cycles)
    }

    /// A change that goes on slowly is not steady, however little a single cycle changes.
    #[test]
    fn a_cycle_is_steady_once_those_to_come_change_little() {
        assert_eq!(outcome(5, |_| [0.0; 2]), (Some(CycleOutcome::Elastic), 1));
        let at_once = outcome(5, |_| [0.01, 0.0]);
        assert_eq!(at_once, (Some(CycleOutcome::ElasticShakedown), 2));
        let even = outcome(9, |k| [0.01 + 0.001 * k as f64, 0.0]);
        assert_eq!(even, (Some(CycleOutcome::Ratchetting), 3));
        // Flow falls by a hundredth in each cycle: after 600 cycles a thousandth is still to come.
        let slow = |k: usize| [1.0 - 0.99f64.powi(k as i32), 0.0];
        let (found, cycles) = outcome(2000, slow);
        assert_eq!(found, Some(CycleOutcome::ElasticShakedown));
        assert!((600..800).contains(&cycles), "{cycles}");
        // Growth in each cycle is a thousandth of the first flow, for ever.
        let little = outcome(50, |k| [1.0 + 2e-4 * k as f64, 0.0]);
        assert_eq!(little, (Some(CycleOutcome::Ratchetting), 3));
        // Growth falls to a constant rate, which is what remains.
        let (found, cycles) = outcome(200, |k| [1e-3 * k as f64 - 0.5f64.powi(k as i32), 0.0]);
        assert_eq!(found, Some(CycleOutcome::Ratchetting));
        assert!((9..14).contains(&cycles), "{cycles}");
    }

    /// If the zone grows, elements that were in no earlier zone had no plastic strain.
    #[test]
    fn cycles_of_another_zone_are_compared_element_by_element() {
        let point = |equivalent: f64| PlasticState {
            equivalent,
            ..PlasticState::default()
        };
        let known = [point(1.0), point(2.0), point(3.0), point(4.0)];
        let found = aligned(&known, &[3, 8], &[1, 3, 5, 8], 2);
        let found: Vec<f64> = found.iter().map(|point| point.equivalent).collect();
        assert_eq!(found, [0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 3.0, 4.0]);
    }
}
