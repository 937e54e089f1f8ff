//! Free strains of loads by temperature ([`crate::model::Model::free_strains`]) at the points of
//! elements, taken off their strains.

use crate::element::{Components, Lanes};
use crate::model::Model;

/// Takes a free strain times a factor off strains.
#[inline]
pub(super) fn take_off<const S: usize, const P: usize>(
    strains: &mut Components<S, P>,
    factor: f64,
    free: &Lanes<P>,
) {
    for lanes in &mut strains[..3] {
        for (strain, free) in lanes.iter_mut().zip(free) {
            *strain -= factor * free;
        }
    }
}

/// Free strains at factor 1 at the points of some elements, kept load by load: nothing where no load
/// changes a temperature.
pub(super) struct FreeStrains<const P: usize> {
    of_loads: Vec<(usize, Vec<Lanes<P>>)>,
}

impl<const P: usize> FreeStrains<P> {
    /// Of the given elements; `at_points` interpolates between the nodes of the i-th.
    pub(super) fn new<const N: usize>(
        model: &Model,
        elements: &[usize],
        at_points: impl Fn(usize, &[f64; N]) -> Lanes<P>,
    ) -> Self {
        let loads = 0..model.loads.len();
        let heated = loads.filter(|&l| model.loads[l].free_strain.is_some());
        let of_load = |load: usize| {
            let elements = elements.iter().enumerate().map(|(i, &element)| {
                let mut of_element = model.free_strains(element);
                let own = of_element.find(|(index, _)| *index == load);
                own.map_or([0.0; P], |(_, nodal)| at_points(i, &nodal))
            });
            (load, elements.collect())
        };
        FreeStrains {
            of_loads: heated.map(of_load).collect(),
        }
    }

    /// Takes those of the i-th element at some load factors off its strains.
    #[inline]
    pub(super) fn take_off<const S: usize>(
        &self,
        i: usize,
        factors: &[f64],
        strains: &mut Components<S, P>,
    ) {
        for (load, of_elements) in &self.of_loads {
            take_off(strains, factors[*load], &of_elements[i]);
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let of_loads = self.of_loads.iter();
        of_loads
            .map(|(_, lanes)| size_of_val(lanes.as_slice()))
            .sum()
    }
}
