//! Stresses and strains at the integration points of all elements.

use serde::{Deserialize, Serialize};

/// Values at the integration points of all elements, one element after the other, with as many
/// components as [`super::Fields::stress`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PointValues {
    /// Index of the first point of each element, and at the end the number of all points.
    pub offsets: Vec<usize>,
    /// `n_points x n_components` stresses.
    pub stress: Vec<f64>,
    /// `n_points x n_components` total strains, thermal and plastic ones included; shear strains
    /// are engineering strains, twice the tensor's.
    pub strain: Vec<f64>,
    /// `n_points` equivalent plastic strains.
    pub plastic_strain: Vec<f64>,
}

impl PointValues {
    /// Creates zeros at the given number of points of each element.
    pub fn zeros(n_points: impl Iterator<Item = usize>, n_components: usize) -> Self {
        let mut offsets = vec![0];
        let mut n = 0;
        offsets.extend(n_points.map(|of_element| {
            n += of_element;
            n
        }));
        PointValues {
            offsets,
            stress: vec![0.0; n_components * n],
            strain: vec![0.0; n_components * n],
            plastic_strain: vec![0.0; n],
        }
    }

    /// Returns the range of the points of an element.
    pub fn of(&self, element: usize) -> std::ops::Range<usize> {
        self.offsets[element]..self.offsets[element + 1]
    }

    /// Returns the number of components of stress and strain.
    pub fn n_components(&self) -> usize {
        (self.stress.len())
            .checked_div(self.plastic_strain.len())
            .unwrap_or(0)
    }

    /// Copies the values of some elements into their places: the i-th element of `values` is the
    /// element `elements[i]` of the mesh.
    pub(crate) fn put(&mut self, elements: &[usize], values: &PointValues) {
        let c = self.n_components();
        for (i, &element) in elements.iter().enumerate() {
            let (to, from) = (self.of(element), values.of(i));
            self.plastic_strain[to.clone()].copy_from_slice(&values.plastic_strain[from.clone()]);
            let (to, from) = (c * to.start..c * to.end, c * from.start..c * from.end);
            self.stress[to.clone()].copy_from_slice(&values.stress[from.clone()]);
            self.strain[to].copy_from_slice(&values.strain[from]);
        }
    }
}
