//! The onset of plastic flow along the load path, and the length of increments beyond it.
//!
//! Within an increment strains follow a straight path. The error of this assumption depends on how
//! far the edge of the contact moves in the increment, since flow moves with it. The size of a
//! contact is about proportional to the root of its load. Increments are therefore of equal length
//! in the root of the load since flow began, in units of the root of the load at first yield. Up to
//! ten times the load at first yield ([`MODERATE`]) every leg takes the same number of increments;
//! a longer leg takes more in proportion. Beyond full plasticity ([`DEEP`]) the contact grows
//! self-similarly, and increments grow with it.

use super::load_point::LoadPoint;
use serde::{Deserialize, Serialize};

/// Length of an increment in the root of the load since flow began, divided by this root at the end
/// of a leg, for the path error [`AT_STEP`]. The error is proportional to the square of this
/// length. The value is calibrated on the ball of `data/speed.md` at ten times its load at first
/// yield; the other scenes of that page check it.
const STEP: f64 = 0.07;
const AT_STEP: f64 = 1e-3;
/// Root of the load since flow began, divided by the root of the preceding elastic range, for the
/// leg on which [`STEP`] was found: from once to ten times the load at first yield.
const MODERATE: f64 = 3.0;
/// Root of the load since flow began, divided by the root of the preceding elastic range, at which
/// the contact of a ball is fully plastic. This is taken to be at `E* a/(Y R) = 30`, which is 2.5
/// at first yield; the mean pressure grows from 1.1 Y to nearly 3 Y, so the load is some 400 times
/// as large (after Johnson, *Contact Mechanics*, 1985, chapter 6).
const DEEP: f64 = 20.0;
/// Ratio of the load to the load at first yield beyond which only the leg sets the length of
/// increments. By the figures for [`DEEP`], a contact is then so wide, `a/R = 1500 Y/E*`, that
/// strains are no longer small in any metal.
const FAR: f64 = 1e6;

/// Load point at which flow began, and the loads before it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FlowOnset {
    /// Load point at which flow began last, after a stretch without flow.
    onset: LoadPoint,
    /// Load at first yield, as a distance from zero load; zero until something yields.
    range: f64,
    /// Largest distance from zero load at which the load turned round.
    farthest: f64,
}

impl FlowOnset {
    /// Flow at the start of a program: no load and nothing yielded.
    pub fn none(n_loads: usize) -> Self {
        FlowOnset {
            onset: LoadPoint::unloaded(n_loads),
            range: 0.0,
            farthest: 0.0,
        }
    }

    /// Whether the flow is of a program with `n_loads` loads.
    pub fn fits(&self, n_loads: usize) -> bool {
        self.onset.factors.len() == n_loads && self.range.is_finite() && self.farthest.is_finite()
    }

    /// Notes that the load turns round at this load point.
    pub fn turns(&mut self, at: &LoadPoint) {
        self.onset = at.clone();
        self.farthest = self.farthest.max(size(at));
    }

    /// Notes that flow begins at this load point.
    pub fn begins(&mut self, at: &LoadPoint) {
        self.onset = at.clone();
        if self.range == 0.0 {
            self.range = size(at);
        }
    }

    /// The share of the way from `at` to `end` that the next increment may cover.
    pub fn share(&self, at: &LoadPoint, end: &LoadPoint, path_error: f64) -> f64 {
        let left = at.distance(end);
        let gone = self.onset.distance(at);
        let leg = share_of(gone, left, gone + left, path_error);
        // Only load beyond the largest load so far drives flow deeper.
        let beyond = size(end) - size(at).max(self.range);
        let is_far = size(end) > FAR * self.range;
        if is_far || beyond <= 0.0 || size(end) <= self.farthest {
            return leg;
        }
        let gone = size(at).max(self.range) - self.range;
        let share = share_of(gone, beyond, self.range, path_error);
        leg.min(1.0 - (1.0 - share) * beyond / left)
    }
}

/// Distance of the loads from zero load. An interference does not count, not even while it grows
/// (`program.interference_until`): if flow begins under an interference alone, the range is zero,
/// and only the leg counts until flow begins anew under loads.
fn size(at: &LoadPoint) -> f64 {
    at.factors
        .iter()
        .fold(0.0, |most, factor| most.max(factor.abs()))
}

/// The share of the way `left` that the next increment may cover. `gone` is the way since flow
/// began, `range` the elastic way before that.
fn share_of(gone: f64, left: f64, range: f64, path_error: f64) -> f64 {
    let [from, to] = [gone, gone + left].map(|way| length(way / range));
    let n = increments(from, to, path_error).ceil();
    if n <= 1.0 {
        return 1.0;
    }
    ((way_of(from + (to - from) / n) * range - gone) / left).min(1.0)
}

/// Number of increments between two lengths, as [`length`] measures the way since flow began, for a
/// given path error.
pub(in crate::analysis) fn increments(from: f64, to: f64, path_error: f64) -> f64 {
    let each = STEP * to.min(MODERATE) * (path_error / AT_STEP).sqrt();
    if to > from { (to - from) / each } else { 0.0 }
}

/// Measure of the length of increments. `way` is the way since flow began, divided by the elastic
/// range. The measure is the root of `way`; beyond [`DEEP`] it grows with the logarithm of the
/// root.
pub(in crate::analysis) fn length(way: f64) -> f64 {
    let root = way.sqrt();
    if root > DEEP {
        DEEP * (1.0 + (root / DEEP).ln())
    } else {
        root
    }
}

/// The way whose [`length`] is given: the inverse function.
fn way_of(length: f64) -> f64 {
    let root = if length > DEEP {
        DEEP * (length / DEEP - 1.0).exp()
    } else {
        length
    };
    root * root
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(alpha: f64) -> LoadPoint {
        let factors = vec![1e-3 * alpha];
        LoadPoint {
            alpha,
            factors,
            interference_share: 1.0,
        }
    }

    /// The loads at which increments end on the way from `from` to `end`, if flow began at 1.
    fn ends(flow: &FlowOnset, from: f64, end: f64) -> Vec<f64> {
        let (mut loads, mut load) = (Vec::new(), from);
        while load < end && loads.len() < 10_000 {
            load += flow.share(&at(load), &at(end), AT_STEP) * (end - load);
            loads.push(load);
        }
        loads
    }

    /// All moderate legs take the same number of increments, of equal length in the root of the
    /// load. Beyond them the number grows in proportion to this root. If flow is deep, each tenfold
    /// load takes the same number.
    #[test]
    fn increments_are_of_equal_length_in_the_root_of_the_load_since_flow_began() {
        let mut flow = FlowOnset::none(1);
        flow.begins(&at(1.0));
        let each = (1.0 / STEP).ceil() as usize;
        for end in [1.01, 2.0, 10.0] {
            let loads = ends(&flow, 1.0, end);
            assert_eq!(loads.len(), each, "up to {end}");
            let second = (loads[1] - 1.0).sqrt() / (loads[0] - 1.0).sqrt();
            assert!((second - 2.0).abs() < 1e-9, "{second}");
            assert!((loads[each - 1] - end).abs() < 1e-9 * end);
        }
        assert_eq!(ends(&flow, 1.0, 145.0).len(), 4 * each - 2);
        let tenfold = |load: f64| ends(&flow, load, 10.0 * load).len();
        let deep = (0.5 * 10f64.ln() * DEEP / (MODERATE * STEP)).ceil() as usize;
        assert_eq!([tenfold(1e3), tenfold(1e4), tenfold(1e5)], [deep; 3]);
        assert_eq!(ends(&flow, 1.0, 1e300).len(), each);
        // After half a leg, half of the increments are left.
        let half = ends(&flow, 1.0 + 0.25 * 144.0, 145.0).len();
        assert!(half.abs_diff(2 * each) <= 1, "{half}");
    }

    /// Up to the previous largest load, a second leg is like any other; beyond that load, flow is
    /// deep again. Without an elastic range only the leg counts.
    #[test]
    fn only_load_beyond_all_that_was_before_is_deep() {
        let each = (1.0 / STEP).ceil() as usize;
        let mut flow = FlowOnset::none(1);
        assert_eq!(ends(&flow, 0.0, 1e9).len(), each);
        flow.begins(&at(1.0));
        let virgin = ends(&flow, 145.0, 400.0).len();
        flow.turns(&at(145.0));
        flow.turns(&at(0.0));
        flow.begins(&at(140.0));
        assert_eq!(ends(&flow, 140.0, 145.0).len(), each);
        let again = ends(&flow, 145.0, 400.0).len();
        assert!(again.abs_diff(virgin) <= 1, "{again} for {virgin}");
        // A leg to a load of the other sign begins with a short increment, whatever lies between.
        flow.turns(&at(145.0));
        let first = flow.share(&at(145.0), &at(-400.0), AT_STEP);
        assert!(first < 0.01, "{first}");
    }
}
