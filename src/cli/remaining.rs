//! The remaining time as it is shown: it never grows while time passes.
//!
//! If the share `p` of a load program is done in `e` seconds, and `P` seconds are predicted for all
//! of it, the share `rest` still takes `rest (w P + e) / (w + p)`: the prediction counts as much as
//! a share `w` of the program. Between two such estimates the last one counts down. The time shown
//! is the smallest so far: an estimate that rises stops the countdown until the run has caught up
//! with it.

/// Share of a load program that has as much weight as the prediction.
const WEIGHT: f64 = 0.05;
/// Fraction of an estimate below which it counts down more slowly than one second per second: no
/// phase is shown as complete before its end.
const LAST: f64 = 0.1;

/// The remaining time of a phase. All times are in seconds since the start of the phase.
#[derive(Debug, Clone)]
pub(super) struct Remaining {
    predicted: f64,
    /// The smallest value that was shown.
    shown: f64,
    /// The last estimate, and the time at which it was made.
    estimate: f64,
    made: f64,
    /// Time of the first accepted increment, and the share of the program that was done then.
    first: Option<(f64, f64)>,
}

impl Remaining {
    /// Creates the remaining time of a phase that is predicted to take this long.
    pub fn new(predicted: f64) -> Self {
        Remaining {
            predicted,
            shown: predicted,
            estimate: predicted,
            made: 0.0,
            first: None,
        }
    }

    /// Takes the share of the load program that is done.
    pub fn update(&mut self, now: f64, fraction: f64) {
        let (start, done) = *self.first.get_or_insert((now, fraction));
        let (elapsed, progress) = (now - start, (fraction - done).max(0.0));
        self.shown = self.at(now);
        let pace = (WEIGHT * self.predicted + elapsed) / (WEIGHT + progress);
        self.estimate = (1.0 - fraction).max(0.0) * pace;
        self.made = now;
    }

    /// Returns the estimated number of seconds remaining at time `now`.
    pub fn at(&self, now: f64) -> f64 {
        let (whole, passed) = (self.estimate, (now - self.made).max(0.0));
        let tail = LAST * whole;
        // The two curves meet when the share LAST is left; from there on the value falls ever more
        // slowly.
        let left = match passed + tail > 0.0 {
            true => (whole - passed).max(tail * whole / (passed + tail)),
            false => 0.0,
        };
        left.min(self.shown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns `[time, remaining time shown]` every 0.1 s for a run that has done `share` of its
    /// program, an increment every `pause` seconds.
    fn shown(predicted: f64, takes: f64, pause: f64, share: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut remaining = Remaining::new(predicted);
        let mut next = pause;
        let mut out = Vec::new();
        for tick in 0..(10.0 * takes) as usize {
            let now = 0.1 * tick as f64;
            if now >= next {
                remaining.update(now, share(now));
                next += pause;
            }
            out.push([now, remaining.at(now)]);
        }
        out
    }

    #[test]
    fn what_is_left_never_grows_and_is_never_over() {
        let slow_start = |t: f64| (t / 600.0).powi(3);
        let slow_end = |t: f64| (t / 600.0).powf(0.3);
        let standstill = |t: f64| {
            if t < 60.0 {
                t / 120.0
            } else {
                0.5 + (t - 60.0) / 1080.0
            }
        };
        for share in [&slow_start as &dyn Fn(f64) -> f64, &slow_end, &standstill] {
            for predicted in [0.01, 30.0, 600.0, 6000.0] {
                for pause in [0.1, 7.0, 200.0, 1e9] {
                    let shown = shown(predicted, 600.0, pause, share);
                    for pair in shown.windows(2) {
                        assert!(pair[1][1] <= pair[0][1], "{predicted} {pause}: {pair:?}");
                    }
                    assert!(shown.iter().all(|s| s[1] > 0.0), "{predicted} {pause}");
                }
            }
        }
    }

    #[test]
    fn a_steady_run_with_the_right_prediction_counts_down() {
        for [now, left] in shown(300.0, 300.0, 0.5, |t| t / 300.0) {
            // The first half second lies before the first increment, whose time is not known.
            assert!((left - (300.0 - now)).abs() <= 0.5 + 1e-9, "{now}: {left}");
        }
    }

    /// The prediction is half or twice the true time `T`: `rest (w P + e)/(w + p)` is off by
    /// `w (P/T - 1)/(w + p)`, which is 3 % and 6 % at three quarters. An estimate that was too low
    /// stays on display until then.
    #[test]
    fn a_wrong_prediction_is_made_up_for() {
        for (predicted, bound) in [(150.0, 0.04), (600.0, 0.07)] {
            let shown = shown(predicted, 300.0, 0.5, |t| t / 300.0);
            for [now, left] in &shown[2250..2900] {
                let truth = 300.0 - now;
                assert!(
                    (left / truth - 1.0).abs() <= bound + 0.5 / truth,
                    "{now}: {left}"
                );
            }
        }
    }

    /// With a prediction of 5 minutes for a run of a quarter of an hour, the time shown never
    /// exceeds 5 minutes.
    #[test]
    fn five_minutes_do_not_become_eleven() {
        let shown = shown(300.0, 900.0, 45.0, |t| t / 900.0);
        assert_eq!(shown[0][1], 300.0);
        assert!(shown.iter().all(|s| s[1] <= 300.0));
        // The estimate made at 765 s is shown, with p = 0.8 since the first increment: it is off by
        // the fraction `w (P/T - 1)/(w + p)` of the time that was left then.
        let off = WEIGHT * (1.0 - 300.0 / 900.0) / (WEIGHT + 0.8) * (900.0 - 765.0);
        let [now, left] = shown[8105];
        assert!((left - (900.0 - now)).abs() <= off + 1e-9, "{left}");
    }
}
