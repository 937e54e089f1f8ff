//! What is kept of a run of a study.

use super::knobs::{Knob, Setting};
use super::meter::{Forecast, Usage, work};
use super::quantities::quantities;
use crate::error::Result;
use crate::results::{Counts, Results};
use serde::Serialize;

/// A setting with what came out and what it took.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyRun {
    /// The curve it belongs to.
    pub series: String,
    /// What was turned.
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
    /// What a setting came to.
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
