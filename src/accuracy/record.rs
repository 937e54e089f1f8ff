//! The record of a run of a study.

use super::knobs::{Knob, Setting};
use super::meter::{Forecast, Usage, work};
use super::quantities::quantities;
use crate::error::Result;
use crate::results::{Counts, Results};
use serde::Serialize;

/// A setting with its results and its cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyRun {
    /// The curve that the run belongs to.
    pub series: String,
    /// The knob that was turned.
    pub knob: Knob,
    /// New value of the setting, in words.
    pub value: String,
    /// Element size over that of the scene.
    pub ratio: f64,
    /// Why there are no values, where the run failed.
    pub failed: Option<String>,
    /// Number of free freedoms.
    pub freedoms: usize,
    /// Lowest polynomial degree of the elements.
    pub degree: usize,
    /// Number of increments.
    pub increments: usize,
    /// Floating point operations of a factorisation, nonzeros of the factor and of its trailing
    /// columns.
    pub factor: [f64; 3],
    /// Machine-independent cost.
    pub counts: Counts,
    /// Cost in floating point operations ([`super::work()`]).
    pub work: f64,
    /// Time and memory.
    pub usage: Usage,
    /// Wall seconds by phase.
    pub timings: Vec<(String, f64)>,
    /// Quantities by path.
    pub values: Vec<(String, f64)>,
}

impl StudyRun {
    /// Records the run of a setting.
    pub(super) fn of(
        setting: &Setting,
        cost: &Forecast,
        usage: Usage,
        found: Result<Results>,
    ) -> Self {
        let mut out = StudyRun {
            series: setting.series.clone(),
            knob: setting.knob,
            value: setting.value.clone(),
            ratio: setting.ratio,
            failed: None,
            freedoms: 0,
            degree: 1,
            increments: 0,
            factor: [
                cost.factor.flops,
                cost.factor.factor_nonzeros,
                cost.factor.trailing_nonzeros,
            ],
            counts: Counts::default(),
            work: 0.0,
            usage,
            timings: Vec::new(),
            values: Vec::new(),
        };
        match found {
            Err(error) => out.failed = Some(error.to_string()),
            Ok(results) => {
                out.freedoms = results.sizes.freedoms;
                out.degree = results.sizes.degree;
                out.increments = results.history.len();
                let factor = &results.factor;
                out.factor = [
                    factor.flops,
                    factor.factor_nonzeros,
                    factor.trailing_nonzeros,
                ];
                out.counts = results.counts;
                out.work = work(&results);
                out.values = quantities(&results)
                    .into_iter()
                    .filter(|quantity| !quantity.is_of_part())
                    .map(|q| (q.path, q.value))
                    .collect();
                for row in &results.reference {
                    if out.values.iter().all(|v| v.0 != row.quantity) {
                        out.values.push((row.quantity.clone(), row.computed));
                    }
                }
                out.timings = results.timings;
            }
        }
        out
    }
}

/// Value of a quantity in a run; `None` if the run lacks it.
pub(super) fn value(run: &StudyRun, path: &str) -> Option<f64> {
    run.values.iter().find(|v| v.0 == path).map(|v| v.1)
}

/// Correction for the length of the increments in the scene's own run, and its uncertainty. The two
/// runs with the most increments on the same mesh, other than from event to event, are extrapolated
/// with first order; the last change is the uncertainty, which covers any order from first on.
pub(super) fn path_correction(runs: &[StudyRun], path: &str) -> Option<(f64, f64)> {
    let own = runs.iter().find(|r| is_own(r))?;
    let mut stepped: Vec<(usize, f64)> = runs
        .iter()
        .filter(|r| r.knob == Knob::Stepping && r.failed.is_none() && r.value != "events")
        .filter_map(|r| Some((r.increments, value(r, path)?)))
        .collect();
    stepped.sort_unstable_by_key(|s| std::cmp::Reverse(s.0));
    let [(fine, at_fine), (coarse, at_coarse)] = stepped.get(..2)?.try_into().ok()?;
    if fine <= coarse || fine <= own.increments {
        return None;
    }
    let last = (at_fine - at_coarse) / (fine as f64 / coarse as f64 - 1.0);
    Some((at_fine + last - value(own, path)?, last.abs()))
}

/// Whether this is the run of the scene as it stands.
pub(super) fn is_own(run: &StudyRun) -> bool {
    run.knob == Knob::Resolution && run.ratio == 1.0 && !run.series.contains(',')
}
