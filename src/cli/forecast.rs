//! Predicted durations of phases: from the size of the model, the speed of this machine as far as
//! the run has shown it, and the phases that are complete.

use crate::analysis::RunSize;
use std::time::Instant;

/// Fraction of the run's own time that the estimate of its errors takes, in several phases of about
/// the same length.
const ESTIMATE: f64 = 0.4;
/// The shortest time that is predicted, which is the resolution of the display.
const LEAST: f64 = 0.01;

/// The data of a run on which predictions are based.
pub(super) struct TimeForecast {
    started: Instant,
    size: RunSize,
    /// Factor by which this machine is slower than expected.
    slower: f64,
    /// Number of phases that have ended, and the time at which the last of them did.
    ended: f64,
    last_end: f64,
}

impl TimeForecast {
    pub fn new(started: Instant) -> Self {
        TimeForecast {
            started,
            size: RunSize::default(),
            slower: 1.0,
            ended: 0.0,
            last_end: 0.0,
        }
    }

    /// Takes the number of the program's targets.
    pub fn program(&mut self, targets: usize) {
        self.size.targets = targets.max(1) as f64;
    }

    /// Takes the size of the model: the numbers of its freedoms and of its contact pairs.
    pub fn model(&mut self, freedoms: usize, pairs: usize) {
        (self.size.freedoms, self.size.pairs) = (freedoms as f64, pairs as f64);
    }

    /// Takes the time that a phase took.
    pub fn learn(&mut self, phase: &str, seconds: f64) {
        (self.ended, self.last_end) = (self.ended + 1.0, self.started.elapsed().as_secs_f64());
        let expected = self
            .size
            .seconds_of(phase)
            .filter(|expected| *expected > 0.0);
        // On a very small model the measured time would only be the resolution of the clock.
        if let ("assembly", Some(expected)) = (phase, expected) {
            self.slower = (seconds / expected).clamp(0.3, 10.0);
        }
    }

    /// Predicts the seconds that a phase will take.
    pub fn seconds(&self, phase: &str) -> f64 {
        let seconds = match self.size.seconds_of(phase) {
            Some(seconds) => self.slower * seconds,
            None if phase.starts_with("error estimate") => {
                0.25 * ESTIMATE * self.started.elapsed().as_secs_f64()
            }
            // Other phases take as long as the mean of the phases so far; the first takes about a
            // second.
            None if self.ended > 0.0 => self.last_end / self.ended,
            None => 1.0,
        };
        seconds.max(LEAST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assembly_tells_the_speed_of_the_machine() {
        let mut forecast = TimeForecast::new(Instant::now());
        forecast.model(1_000_000, 100);
        let [assembly, before] = ["assembly", "factorisation"].map(|of| forecast.seconds(of));
        forecast.learn("assembly", 2.0 * assembly);
        assert!((forecast.seconds("factorisation") / before - 2.0).abs() < 1e-12);
    }

    #[test]
    fn every_phase_has_a_prediction() {
        let mut forecast = TimeForecast::new(Instant::now());
        let phases = [
            "mesh and model",
            "assembly",
            "factorisation",
            "preload",
            "yield load",
            "load program",
            "going on after increment 7, load factor 0.5",
            "error estimate: coarser mesh 1 of 2",
            "output",
            "ties",
        ];
        for sizes in [[0, 0], [20_000, 50]] {
            forecast.model(sizes[0], sizes[1]);
            for phase in phases {
                let seconds = forecast.seconds(phase);
                assert!(seconds.is_finite() && seconds > 0.0, "{phase}: {seconds}");
            }
        }
    }
}
