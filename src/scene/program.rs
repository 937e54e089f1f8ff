//! The load program and how it is computed.

use super::Target;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// The least path error that can be asked for: with less a leg takes some ten thousand increments.
pub const LEAST_PATH_ERROR: f64 = 1e-9;

/// The load program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Program {
    /// What a load factor of 1 means.
    #[serde(default)]
    pub unit: Unit,
    /// How increments are chosen.
    #[serde(default)]
    pub stepping: Stepping,
    /// Increments from one target to the next with `stepping = "steps"`.
    #[serde(default = "super::defaults::steps")]
    pub steps: usize,
    /// Error of pressure and dent that the increments of `stepping = "auto"` may leave, as a share:
    /// they become shorter with its square root.
    #[serde(default = "super::defaults::path_error")]
    pub path_error: f64,
    /// Most increments of the whole run, whatever the stepping. A run that takes as many ends there
    /// with what it has reached (exit code 5).
    #[serde(
        default = "super::defaults::max_increments",
        skip_serializing_if = "is_usual_most"
    )]
    pub max_increments: usize,
    /// Relative tolerance with which events are landed on: a change of contact (paper 4.18, 4.23),
    /// and the maximum of the stress at first yield.
    #[serde(default = "super::defaults::gamma")]
    pub gamma: f64,
    /// The targets, reached one after the other; each leaves a state.
    pub targets: Vec<Target>,
    /// Node sets or surfaces that every row of the history follows: mean displacement of the nodes
    /// and the force that acts on them from outside (loads and supports, the modelled sum times
    /// `symmetry`). The approach of all bodies and each contact's approach, force and area come
    /// with them. It takes a solve for each increment.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub history: Vec<String>,
    /// The targets again and again, at most so often: until the next cycle would be like the last.
    /// The states are those of the last cycle.
    #[serde(default = "super::defaults::cycles", skip_serializing_if = "is_one")]
    pub cycles: usize,
    /// When a cycle counts as like the next: once all cycles to come would change plastic strains,
    /// against going on as it did, by less than this share of what flowed in the first.
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
    /// Load factors of the loads as given, event by event, no targets yet.
    fn default() -> Self {
        Program {
            unit: Unit::default(),
            stepping: Stepping::default(),
            steps: super::defaults::steps(),
            path_error: super::defaults::path_error(),
            max_increments: super::defaults::max_increments(),
            gamma: super::defaults::gamma(),
            targets: Vec::new(),
            history: Vec::new(),
            cycles: super::defaults::cycles(),
            steady: super::defaults::steady(),
        }
    }
}

/// What a load factor of 1 means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// The loads as given in the scene.
    #[default]
    Load,
    /// The yield load: alpha = P/P* (paper 5.1, 5.3).
    Yield,
}

/// How increments are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Stepping {
    /// As the path demands it: elastic stretches from change to change of contact, increments in
    /// which something flows as long as `path_error` allows. In plane stress as `events`.
    #[default]
    Auto,
    /// Each increment ends at the next change of contact (paper 4.10 to 4.23).
    Events,
    /// A fixed number of increments per target, contact solved at the end of each.
    Steps,
}

impl Program {
    /// Names of the states of all targets, made unlike each other: a made-up name that was used
    /// before gets a number, as in `alpha 1.25 (2)`. A scene that was read holds these names
    /// already.
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
                // Numbers below are taken already: each name is counted on from where it was last.
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

/// How to compute.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Yield load: the exact path or the paper's secant (3.14).
    pub yield_load: YieldMethod,
    /// How the plastic iteration is accelerated.
    pub plastic_iteration: PlasticIteration,
    /// Out-of-balance force of the plastic iteration over the contact and applied forces.
    pub tolerance: f64,
    /// Most plastic iterations per increment.
    pub max_iterations: usize,
    /// Estimate the condition of the factored matrix, which takes about six full solves (done
    /// anyway where accuracy is in doubt; a lower bound is in every summary).
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

/// How the yield load is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum YieldMethod {
    /// Along the piecewise linear path.
    #[default]
    Exact,
    /// The paper's secant, equation 3.14, bracketed.
    Secant,
}

/// How the plastic iteration runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PlasticIteration {
    /// Newton with the consistent tangent, solved by conjugate gradients on the factored elastic
    /// stiffness.
    #[default]
    Newton,
    /// Anderson acceleration of the plain iteration.
    Anderson,
    /// The paper's initial-load iteration.
    Plain,
}
