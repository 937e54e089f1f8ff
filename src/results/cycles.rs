//! The outcome of a program of cycles.

use super::number::number;
#[cfg(feature = "report")]
use crate::number::number as short;
use serde::{Deserialize, Serialize};

/// The response of a structure to cycles of its loads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CycleOutcome {
    /// Nothing yields.
    Elastic,
    /// The material yields at first, but not any more.
    ElasticShakedown,
    /// Plastic strains alternate and return to the same values in each cycle.
    PlasticShakedown,
    /// Plastic strains grow by the same amount in each cycle.
    Ratchetting,
    /// The response has not settled: the next cycle would still differ from the last one.
    #[default]
    NotSteady,
}

impl CycleOutcome {
    /// Returns the outcome in words.
    pub fn words(self) -> &'static str {
        match self {
            CycleOutcome::Elastic => "elastic",
            CycleOutcome::ElasticShakedown => "elastic shakedown",
            CycleOutcome::PlasticShakedown => "plastic shakedown",
            CycleOutcome::Ratchetting => "ratchetting",
            CycleOutcome::NotSteady => "not steady",
        }
    }
}

/// A cycle of the load and the changes in it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct CycleRow {
    /// Number of the cycle, from 1.
    pub cycle: usize,
    /// The largest equivalent plastic strain that a point gained in the cycle.
    #[serde(deserialize_with = "number")]
    pub flow: f64,
    /// The largest change of a point's plastic strain from start to end of the cycle,
    /// `sqrt(2/3 e:e)`.
    #[serde(deserialize_with = "number")]
    pub growth: f64,
}

/// The cycles of a program.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Cycles {
    /// Outcome of the cycles.
    pub outcome: CycleOutcome,
    /// The body whose plastic strain grew most in the last cycle.
    pub body: Option<String>,
    /// A row for each cycle.
    pub rows: Vec<CycleRow>,
}

impl Cycles {
    /// Returns the outcome of the cycles in a sentence.
    #[cfg(feature = "report")]
    pub fn told(&self) -> String {
        let last = self.last();
        let body = self.body.as_deref().unwrap_or("no body");
        let what = match self.outcome {
            CycleOutcome::Elastic => "nothing yields".to_string(),
            CycleOutcome::ElasticShakedown if last.flow == 0.0 => {
                "nothing yields any more".to_string()
            }
            CycleOutcome::ElasticShakedown => format!(
                "the plastic strain gained in a cycle decreases, to {} at most in the last",
                short(last.flow)
            ),
            CycleOutcome::PlasticShakedown => format!(
                "in each cycle plastic strains alternate, by {} at most, and return",
                short(last.flow)
            ),
            CycleOutcome::Ratchetting => format!(
                "in each cycle the plastic strain of {body} grows by {} at most",
                short(last.growth)
            ),
            CycleOutcome::NotSteady => format!(
                "the last still changed: a plastic strain of {body} by {}, and {} flowed at most; \
                 raise program.cycles",
                short(last.growth),
                short(last.flow)
            ),
        };
        format!("{}; {what}", self.outcome.words())
    }

    /// Returns the last of the cycles.
    pub fn last(&self) -> CycleRow {
        self.rows.last().copied().unwrap_or_default()
    }
}
