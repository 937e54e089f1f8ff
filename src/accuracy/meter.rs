//! Measurement of what a run takes from the machine, and forecast of what it will take.

use crate::analysis::check;
use crate::error::Result;
use crate::linalg::{Backend, Prediction};
use crate::memory;
use crate::model::Model;
use crate::results::Results;
use crate::scene::Scene;
use std::time::Instant;

/// Measures wall time, processor time and memory between [`Meter::start`] and [`Meter::stop`].
#[derive(Debug)]
pub struct Meter {
    start: Instant,
    processor: Option<f64>,
    reset: bool,
}

/// What was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Usage {
    /// Wall time in seconds.
    pub wall_seconds: f64,
    /// Processor time of all threads of this process in seconds; `None` if the system does not
    /// report it.
    pub cpu_seconds: Option<f64>,
    /// Most memory resident during the run, including what the process held before (the allocator
    /// returns large blocks at once, small ones late); `None` if the system cannot reset this peak
    /// (Linux: `clear_refs`).
    pub peak_memory_bytes: Option<u64>,
}

impl Usage {
    /// Time of the run if nothing had disturbed it: wall time, or processor time if that is less
    /// because the machine had other things to do.
    pub fn undisturbed_seconds(&self) -> f64 {
        self.cpu_seconds
            .map_or(self.wall_seconds, |cpu| self.wall_seconds.min(cpu))
    }
}

impl Meter {
    /// Begins to measure.
    pub fn start() -> Self {
        Meter {
            reset: std::fs::write("/proc/self/clear_refs", "5").is_ok(),
            processor: processor_seconds(),
            start: Instant::now(),
        }
    }

    /// Ends the measurement.
    pub fn stop(self) -> Usage {
        Usage {
            wall_seconds: self.start.elapsed().as_secs_f64(),
            cpu_seconds: processor_seconds()
                .zip(self.processor)
                .map(|(end, start)| end - start),
            peak_memory_bytes: memory::peak().filter(|_| self.reset),
        }
    }
}

/// Processor time of the process, all its threads.
#[cfg(unix)]
fn processor_seconds() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

#[cfg(not(unix))]
fn processor_seconds() -> Option<f64> {
    None
}

/// Operations of assembly, ordering and analysis per nonzero of the factor, in addition to those of
/// the factorisation (at the speeds that [`crate::analysis::check`] assumes). On small meshes they
/// take most of the time.
const PER_NONZERO: f64 = 250.0;
/// Operations of a solve per nonzero of the columns that it passes, forth and back: one
/// multiplication and one addition each.
const PER_SOLVE: f64 = 4.0;

/// Cost of a run in floating point operations: factorisations, the assembly and analysis before
/// them, and solves. The cost does not depend on the machine or on other work that the machine
/// does.
pub fn work(results: &Results) -> f64 {
    let (counts, factor) = (&results.counts, &results.factor);
    counts.factorizations as f64 * (factor.flops + PER_NONZERO * factor.factor_nonzeros)
        + PER_SOLVE * counts.full_solves as f64 * factor.factor_nonzeros
        + PER_SOLVE * counts.trailing_solves as f64 * factor.trailing_nonzeros
}

/// What a run will cost, from the symbolic factorisation of its matrix.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Forecast {
    /// The factorisation.
    pub factor: Prediction,
    /// Seconds at a typical speed. How much this machine and this scene differ from it is learnt
    /// from finished runs ([`Pace`]).
    pub seconds: f64,
}

/// Forecasts a run; nothing is factored.
///
/// # Errors
/// Errors of the model, and limits of the backend.
pub fn forecast(scene: &Scene, backend: Backend) -> Result<Forecast> {
    let check = check(&Model::new(scene)?, backend)?;
    Ok(Forecast {
        factor: check.prediction,
        seconds: check.predicted_seconds,
    })
}

/// How long runs take compared with their forecasts: `time = a forecast^b`, fitted to the finished
/// runs. The power `b` differs from 1 if increments, whose number grows with the resolution too,
/// cost more than the factorisation.
#[derive(Debug, Clone, Default)]
pub struct Pace {
    finished: Vec<(f64, f64)>,
}

/// Range to which the fitted power is limited.
const POWERS: [f64; 2] = [0.5, 2.0];

impl Pace {
    /// Takes note of a finished run.
    pub fn learn(&mut self, forecast: f64, seconds: f64) {
        if forecast > 0.0 && seconds > 0.0 {
            self.finished.push((forecast.ln(), seconds.ln()));
        }
    }

    /// Seconds that a run of this forecast will take.
    pub fn seconds(&self, forecast: f64) -> f64 {
        if self.finished.is_empty() || forecast <= 0.0 {
            return forecast;
        }
        let n = self.finished.len() as f64;
        let mean = |f: &dyn Fn(&(f64, f64)) -> f64| self.finished.iter().map(f).sum::<f64>() / n;
        let (mx, my) = (mean(&|p| p.0), mean(&|p| p.1));
        let variance = mean(&|p| (p.0 - mx).powi(2));
        // Runs of one size do not determine the power.
        let power = if variance > 0.1 {
            (mean(&|p| (p.0 - mx) * (p.1 - my)) / variance).clamp(POWERS[0], POWERS[1])
        } else {
            1.0
        };
        (my + power * (forecast.ln() - mx)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_follows_the_finished_runs() {
        let mut pace = Pace::default();
        assert_eq!(pace.seconds(3.0), 3.0);
        pace.learn(1.0, 5.0);
        assert!((pace.seconds(2.0) - 10.0).abs() < 1e-12);
        pace.learn(10.0, 5.0 * 10f64.powf(1.5));
        assert!((pace.seconds(100.0) / (5.0 * 1000.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_meter_sees_work_and_memory() {
        let meter = Meter::start();
        let block = vec![1u8; 64 << 20];
        let mut sum = 0u64;
        // At least one pass: on a busy machine, allocating the block may take as long by itself.
        loop {
            sum = block.iter().fold(sum, |s, b| s.wrapping_add(u64::from(*b)));
            if meter.start.elapsed().as_secs_f64() >= 0.1 {
                break;
            }
        }
        assert!(sum > 0);
        let usage = meter.stop();
        assert!(usage.wall_seconds >= 0.1);
        if cfg!(target_os = "linux") {
            assert!(usage.cpu_seconds.unwrap() > 0.0);
        }
        if let Some(peak) = usage.peak_memory_bytes {
            assert!(peak >= 64 << 20, "{peak}");
        }
    }

    #[test]
    fn work_counts_factorisations_and_solves() {
        let mut results = Results::default();
        results.counts.factorizations = 2;
        results.counts.trailing_solves = 3;
        results.counts.full_solves = 1;
        results.factor.flops = 1000.0;
        results.factor.factor_nonzeros = 50.0;
        results.factor.trailing_nonzeros = 10.0;
        assert_eq!(work(&results), 2.0 * (1000.0 + 12500.0) + 200.0 + 120.0);
    }
}
