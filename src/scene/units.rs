//! Names of units, for people who read results.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the scene's numbers are in. brinell computes in whatever consistent units the scene uses
/// (N, mm and MPa; N, m and Pa; ...) and converts nothing but materials of its own list: these
/// names stand beside numbers in tables and plots.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Of lengths and displacements, such as `"mm"`.
    pub length: String,
    /// Of forces, such as `"N"`.
    pub force: String,
    /// Of stresses, moduli and pressures: force over length squared, such as `"MPa"`.
    pub stress: String,
}
