//! What cannot be reached is refused before it is tried, with its price.

use super::meter::{Pace, factor_seconds};
use crate::error::{Error, ErrorKind, Result};
use crate::memory::available as available_memory;
use crate::results::Results;

/// Share of the free memory that a run may take.
const MEMORY_SHARE: f64 = 0.9;
/// Bytes of the results, mesh and assembly per byte of the factor at its peak.
const BESIDE_FACTOR: f64 = 2.0;

/// Share of the free memory from which on a prediction from coarser meshes is not enough.
const DOUBT: f64 = 0.2;

/// Predicted cost of a mesh.
pub(super) struct Cost {
    /// Elements over what governs.
    pub fineness: f64,
    /// Bytes of the factor at its peak.
    pub memory: f64,
    /// Forecast seconds.
    pub forecast: f64,
}

impl Cost {
    /// That of a finished run.
    pub(super) fn of(fineness: f64, results: &Results) -> Self {
        Cost {
            fineness,
            memory: results.factor.memory_bytes,
            forecast: factor_seconds(&results.factor),
        }
    }
}

/// Whether the symbolic factorisation of a mesh has to be asked before it is run: it takes as long as assembly and ordering in the
/// run itself, which is most of the time of a small mesh.
pub(super) fn in_doubt(fineness: f64, costs: &[Cost]) -> bool {
    let Some(last) = costs.last() else {
        return true;
    };
    let memory = predicted_memory(fineness, costs, last);
    available_memory().is_none_or(|free| memory > DOUBT * free)
}

/// A power of the fineness through the first and the last of those known.
fn power(costs: &[Cost], last: &Cost, of: fn(&Cost) -> f64, [low, high]: [f64; 2]) -> f64 {
    match costs.first() {
        Some(first) if last.fineness > 1.3 * first.fineness => {
            ((of(last) / of(first)).ln() / (last.fineness / first.fineness).ln()).clamp(low, high)
        }
        _ => high,
    }
}

fn predicted_memory(fineness: f64, costs: &[Cost], last: &Cost) -> f64 {
    let finer = (fineness / last.fineness).max(1.0);
    let power = power(costs, last, |c| c.memory, [2.0, 2.4]);
    BESIDE_FACTOR * last.memory * finer.powf(power)
}

/// Refuses a demand that the algebra alone misses.
pub(super) fn refuse_round_off(demand: f64, algebraic: f64) -> Result<()> {
    if algebraic <= demand {
        return Ok(());
    }
    Err(Error::input(format!(
        "an accuracy of {} is below round-off: the algebra alone leaves {}, however fine the mesh; demand no less",
        percent(demand),
        percent(algebraic)
    )))
}

/// Refuses what does not fit into the free memory, with its price. Memory and time of a mesh as a power of its fineness, from those
/// predicted so far (two unknowns of the plane's factor: it fills a little faster than the mesh).
pub(super) fn refuse_beyond_memory(
    demand: f64,
    fineness: f64,
    costs: &[Cost],
    pace: &Pace,
) -> Result<()> {
    let Some(last) = costs.last() else {
        return Ok(());
    };
    let finer = (fineness / last.fineness).max(1.0);
    let memory = predicted_memory(fineness, costs, last);
    let power = power(costs, last, |c| c.forecast, [2.0, 3.2]);
    let seconds = pace.seconds(last.forecast * finer.powf(power));
    match available_memory() {
        Some(free) if memory > MEMORY_SHARE * free => Err(Error::new(
            ErrorKind::Input,
            format!(
                "{} would take about {} and {:.0} GB, and {:.0} GB are free: the mesh would have to be {finer:.0} times finer than the \
                 last one tried; demand less, or name fewer targets",
                percent(demand),
                duration(seconds),
                memory / 1e9,
                free / 1e9
            ),
        )),
        _ => Ok(()),
    }
}

/// A share in per cent, two digits.
pub(super) fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value {
        v if !v.is_finite() => "of unknown size".to_string(),
        v if v != 0.0 && v.abs() < 1e-3 => format!("{v:.1e} %"),
        v => {
            let digits = (1 - v.abs().max(1e-300).log10().floor() as i32).clamp(0, 6) as usize;
            format!("{v:.digits$} %")
        }
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.1e} days", s / 86400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_is_told_in_readable_units() {
        assert_eq!(percent(0.003), "0.30 %");
        assert_eq!(percent(0.1), "10 %");
        assert_eq!(percent(1e-8), "1.0e-6 %");
        assert_eq!(duration(10_800.0), "3 h");
        assert_eq!(duration(90.0), "90 s");
    }

    #[test]
    fn what_does_not_fit_is_refused_with_its_price() {
        let cost = |fineness: f64| Cost {
            fineness,
            memory: 1e9 * fineness * fineness,
            forecast: fineness.powi(3),
        };
        let costs = [cost(1.0), cost(2.0)];
        let pace = Pace::default();
        assert!(refuse_beyond_memory(0.01, 2.0, &costs[..1], &pace).is_ok());
        if available_memory().is_some() {
            let error = refuse_beyond_memory(1e-5, 2e4, &costs, &pace).unwrap_err();
            assert!(
                error.message().starts_with("0.0010 % would take about"),
                "{error}"
            );
            assert!(error.message().contains(" GB"), "{error}");
        }
    }
}
