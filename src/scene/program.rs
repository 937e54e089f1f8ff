//! The load program and the settings of its computation.

use super::Target;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// The smallest path error that can be requested: with a smaller one, a leg takes about ten
/// thousand increments or more.
pub const LEAST_PATH_ERROR: f64 = 1e-9;

/// The load program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Program {
    /// Meaning of a load factor of 1.
    #[serde(default)]
    pub unit: Unit,
    /// How the increments are chosen.
    #[serde(default)]
    pub stepping: Stepping,
    /// Number of increments from one target to the next with `stepping = "steps"`.
    #[serde(default = "super::defaults::steps")]
    pub steps: usize,
    /// Relative error of pressure and dent that the increments of `stepping = "auto"` may cause.
    /// The length of the increments is proportional to its square root. If few pairs carry the
    /// contact, the error is larger; the error estimate says by how much.
    #[serde(default = "super::defaults::path_error")]
    pub path_error: f64,
    /// Largest number of increments of the whole run, whatever the stepping. A run that reaches
    /// this number ends there with the results so far (exit code 5).
    #[serde(
        default = "super::defaults::max_increments",
        skip_serializing_if = "is_usual_most"
    )]
    pub max_increments: usize,
    /// Relative tolerance with which events are located: a change of contact (paper, eqs. 4.18,
    /// 4.23), and the maximum of the stress at first yield.
    #[serde(default = "super::defaults::gamma")]
    pub gamma: f64,
    /// Load factor up to which the interference of contacts grows in proportion to the load factor,
    /// from none at load factor zero. By default the interference is applied before the load factor
    /// leaves zero. Needs `unit = "load"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interference_until: Option<f64>,
    /// The targets, reached one after the other; each yields one state in the results.
    pub targets: Vec<Target>,
    /// Node sets or surfaces that every row of the history records: the mean displacement of their
    /// nodes and the external force on them (loads and supports, the sum over the model times
    /// `symmetry`). The approach of all bodies and the approach, force and area of each contact are
    /// recorded with them. This takes one additional solve per increment.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub history: Vec<String>,
    /// Largest number of cycles. The targets are repeated as one cycle until the next cycle would
    /// be like the last. The states are those of the last cycle.
    #[serde(default = "super::defaults::cycles", skip_serializing_if = "is_one")]
    pub cycles: usize,
    /// Criterion for the end of `cycles`. The change of the plastic strains over a cycle is
    /// compared with the change over the previous cycle. The cycles end when this difference, and
    /// the differences expected in all cycles to come taken together, are less than this fraction
    /// of the plastic flow in the first cycle.
    #[serde(default = "super::defaults::steady", skip_serializing_if = "is_steady")]
    pub steady: f64,
}

fn is_steady(steady: &f64) -> bool {
    *steady == super::defaults::steady()
}

fn is_usual_most(increments: &usize) -> bool {
    *increments == super::defaults::max_increments()
}

fn is_one(cycles: &usize) -> bool {
    *cycles == 1
}

impl Default for Program {
    /// A program of load factors relative to the loads as given, with automatic stepping and no
    /// targets yet.
    fn default() -> Self {
        Program {
            unit: Unit::default(),
            stepping: Stepping::default(),
            steps: super::defaults::steps(),
            path_error: super::defaults::path_error(),
            max_increments: super::defaults::max_increments(),
            gamma: super::defaults::gamma(),
            interference_until: None,
            targets: Vec::new(),
            history: Vec::new(),
            cycles: super::defaults::cycles(),
            steady: super::defaults::steady(),
        }
    }
}

/// The meaning of a load factor of 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// A factor of 1 means the loads as given in the scene.
    #[default]
    Load,
    /// A factor of 1 is the yield load: alpha = P/P* (paper, sec. 5.1, 5.3).
    Yield,
}

/// The choice of the increments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Stepping {
    /// Automatic: an elastic stretch ends at the next change of contact; increments with plastic
    /// flow are as long as `path_error` allows. In plane stress the same as `events`.
    #[default]
    Auto,
    /// Each increment ends at the next change of contact (paper, eqs. 4.10 to 4.23).
    Events,
    /// A fixed number of increments per target, with contact solved at the end of each increment.
    Steps,
}

impl Program {
    /// Names of the states of all targets, made unique: a generated name that is already in use
    /// gets a number, as in `alpha 1.25 (2)`. A scene that was read from text already holds these
    /// names.
    pub fn labels(&self) -> Vec<String> {
        let mut taken: BTreeSet<String> =
            self.targets.iter().filter_map(|t| t.name.clone()).collect();
        let mut next: BTreeMap<String, usize> = BTreeMap::new();
        self.targets
            .iter()
            .enumerate()
            .map(|(index, target)| {
                let label = target.label(index);
                if target.name.is_some() || taken.insert(label.clone()) {
                    return label;
                }
                // Lower numbers are already in use, so the count for each name continues from the
                // last number.
                let number = next.entry(label.clone()).or_insert(2);
                loop {
                    let numbered = format!("{label} ({number})");
                    *number += 1;
                    if taken.insert(numbered.clone()) {
                        return numbered;
                    }
                }
            })
            .collect()
    }
}

/// Settings of the computation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Computation of the yield load: the exact path or the paper's secant (3.14).
    pub yield_load: YieldMethod,
    /// Method of the plastic iteration.
    pub plastic_iteration: PlasticIteration,
    /// Tolerance of the plastic iteration: the out-of-balance force divided by the contact and
    /// applied forces.
    pub tolerance: f64,
    /// Largest number of plastic iterations per increment.
    pub max_iterations: usize,
    /// Whether to estimate the condition number of the factored matrix, which takes about six full
    /// solves. The estimate is made anyway if the accuracy is in doubt; a lower bound is in every
    /// summary.
    pub condition: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            yield_load: YieldMethod::Exact,
            plastic_iteration: PlasticIteration::Newton,
            tolerance: 1e-10,
            max_iterations: 200,
            condition: false,
        }
    }
}

/// The method by which the yield load is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum YieldMethod {
    /// Exactly, along the piecewise linear path.
    #[default]
    Exact,
    /// By the paper's secant iteration, equation 3.14, bracketed.
    Secant,
}

/// The method of the plastic iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PlasticIteration {
    /// Newton's method with the consistent tangent, solved by conjugate gradients preconditioned
    /// with the factored elastic stiffness.
    #[default]
    Newton,
    /// Anderson acceleration of the paper's initial-load iteration.
    Anderson,
    /// The paper's initial-load iteration without acceleration.
    Plain,
}
