//! What a run leaves in the material: the state that another may start from.

use serde::{Deserialize, Serialize};

/// Plastic history at the end of a run, of the elements that have any. Residual stresses follow
/// from it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EndState {
    /// The elements, ascending.
    pub elements: Vec<usize>,
    /// Plastic strain at each point of each of them, the same number of points for all: six
    /// components, engineering shear.
    pub strains: Vec<[f64; 6]>,
    /// Equivalent plastic strain there.
    pub equivalent: Vec<f64>,
    /// Strains of the back stresses that fade, as many at each point.
    pub back_strains: Vec<[f64; 6]>,
    /// Work per volume that was lost with them at each point; empty where there are none.
    pub lost_work: Vec<f64>,
}

impl EndState {
    /// Whether nothing has yielded.
    pub fn is_virgin(&self) -> bool {
        self.elements.is_empty()
    }

    /// Whether it is one of elements of a mesh whose elements have `stride` places for points, and
    /// its parts fit each other.
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
