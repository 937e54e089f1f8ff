//! Directions of the coordinates.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A coordinate direction; in an axisymmetric model x means r and y means z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Direction x; r in an axisymmetric model.
    X,
    /// Direction y; z in an axisymmetric model.
    Y,
    /// Direction z, in solids only.
    Z,
}

impl Direction {
    /// All directions, in the order of the axes.
    pub const ALL: [Direction; 3] = [Direction::X, Direction::Y, Direction::Z];

    /// Number of the axis, counted from 0.
    pub fn axis(self) -> usize {
        self as usize
    }

    /// `x`, `y` or `z`, as in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Direction::X => "x",
            Direction::Y => "y",
            Direction::Z => "z",
        }
    }
}
