//! Linear equations between displacements.

use super::Direction;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A linear equation `sum_k coefficient_k u_k = 0` between displacements of nodes. The first
/// displacement follows the others: it must be free, and no load, support, contact or other
/// equation may hold it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equation {
    /// The terms, at least two. Where the first is on a set of several nodes there is one equation
    /// for each of them: another term is on as many nodes, taken in ascending order, or on one.
    pub terms: Vec<EquationTerm>,
}

/// A term of a linear equation: coefficient times displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EquationTerm {
    /// Node set or surface.
    pub on: String,
    /// Direction of the displacement.
    pub direction: Direction,
    /// Coefficient of the displacement.
    pub coefficient: f64,
}
