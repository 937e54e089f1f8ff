//! Linear equations between displacements.

use super::Direction;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A linear equation `sum_k coefficient_k u_k = 0` between displacements of nodes. The displacement
/// of the first term is expressed by the others: it must be free, and no load, support, contact or
/// other equation may hold it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equation {
    /// The terms, at least two. If the first term is on a set of several nodes, there is one
    /// equation for each of these nodes. Every other term is then either on a set with the same
    /// number of nodes, matched in ascending order, or on a single node.
    pub terms: Vec<EquationTerm>,
}

/// A prescribed difference of displacements: `u_direction - sum_k coefficient_k u_k = value` for
/// each node of the load's set, reached when the load's factor is 1. If all terms are on the same
/// node, the node moves along an inclined line. The displacement along `direction` must meet the
/// conditions on the first term of an [`Equation`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Relative {
    /// Direction of the displacement that follows.
    pub direction: Direction,
    /// Value of the difference.
    pub value: f64,
    /// The terms that are subtracted. Each is on a set of as many nodes as the load's set, matched
    /// in ascending order, or on a single node.
    #[serde(default)]
    pub terms: Vec<EquationTerm>,
}

/// A term of a linear equation: coefficient times displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EquationTerm {
    /// Node set or surface of the term.
    pub on: String,
    /// Direction of the displacement.
    pub direction: Direction,
    /// Coefficient of the displacement.
    pub coefficient: f64,
}
