//! The state of the material at the end of a run, from which another run may start.

use crate::space::Space;
use serde::{Deserialize, Serialize};

/// Plastic history at the end of a run, for the elements that have any. Residual stresses follow
/// from it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EndState {
    /// Indices of the elements, ascending.
    pub elements: Vec<usize>,
    /// Plastic strain at each point of each of the elements, the same number of points for all: six
    /// components, engineering shear.
    pub strains: Vec<[f64; 6]>,
    /// Equivalent plastic strain at each of these points.
    pub equivalent: Vec<f64>,
    /// Strains of the fading back stresses, the same number at each point.
    pub back_strains: Vec<[f64; 6]>,
    /// Work per volume that was lost with the fading back stresses at each point; empty if there
    /// are none.
    pub lost_work: Vec<f64>,
    /// Model that left this state.
    pub left_by: Option<LeftBy>,
}

/// The model that left a state in the material, as far as it matters for another model that starts
/// from the state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftBy {
    /// Kind of the model: the components of strains and the relations between them.
    pub kind: Space,
    /// Bodies of the model, in the order of the mesh.
    pub bodies: Vec<LeftByBody>,
}

/// A body in which a state was left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftByBody {
    /// Rates at which the back stresses of the body fade, in the order of their strains.
    pub rates: Vec<f64>,
    /// Initial stresses and strains of the body, by key of the scene.
    pub brought_along: Vec<(String, Vec<Vec<f64>>)>,
}

impl EndState {
    /// Whether nothing has yielded.
    pub fn is_virgin(&self) -> bool {
        self.elements.is_empty()
    }

    /// Whether the state belongs to elements of a mesh whose elements have `stride` places for
    /// points, and its parts fit each other.
    pub(crate) fn is_of(&self, n_elements: usize, stride: usize) -> bool {
        let n = self.elements.len() * stride;
        let ascends = self.elements.windows(2).all(|pair| pair[0] < pair[1]);
        ascends
            && self.elements.last().is_none_or(|&e| e < n_elements)
            && self.strains.len() == n
            && self.equivalent.len() == n
            && self.back_strains.len().is_multiple_of(n.max(1))
            && self.lost_work.len() == if self.back_strains.is_empty() { 0 } else { n }
    }
}
