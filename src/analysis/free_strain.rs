//! Free strains, of temperature or brought along ([`crate::model::Model::free_strains`]), at the
//! points of elements, taken off their strains.

use crate::element::{Components, Lanes};
use crate::model::{FreeStrain, Model};
use std::ops::Range;

/// Takes components of a free strain times a factor off strains.
#[inline]
pub(super) fn take_off<const S: usize, const P: usize>(
    strains: &mut Components<S, P>,
    factor: f64,
    (components, free): (&Range<usize>, &Lanes<P>),
) {
    // The plane has not all that space has.
    for lanes in strains
        .iter_mut()
        .take(components.end)
        .skip(components.start)
    {
        for (strain, free) in lanes.iter_mut().zip(free) {
            *strain -= factor * free;
        }
    }
}

/// Free strains at factor 1 at the points of some elements, kept load by load: nothing where no
/// load has any.
pub(super) struct FreeStrains<const P: usize> {
    of_loads: Vec<(usize, Range<usize>, Vec<Lanes<P>>)>,
}

impl<const P: usize> FreeStrains<P> {
    /// Of the given elements; `at_points` interpolates between the nodes of the i-th.
    pub(super) fn new<const N: usize>(
        model: &Model,
        elements: &[usize],
        at_points: impl Fn(usize, &[f64; N]) -> Lanes<P>,
    ) -> Self {
        let own = |load: usize| {
            model.loads[load]
                .free_strain
                .iter()
                .map(move |free| (load, free))
        };
        let all = (0..model.loads.len()).flat_map(own);
        let of_load = |(load, free): (usize, &FreeStrain)| {
            let body = model.loads[load].body;
            let lanes = elements.iter().enumerate().map(|(i, &element)| {
                match model.mesh.element_body[element] == body {
                    true => at_points(i, &model.free_strain(element, free)),
                    false => [0.0; P],
                }
            });
            (load, free.components.clone(), lanes.collect())
        };
        FreeStrains {
            of_loads: all.map(of_load).collect(),
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
        for (load, components, of_elements) in &self.of_loads {
            take_off(strains, factors[*load], (components, &of_elements[i]));
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let of_loads = self.of_loads.iter();
        of_loads
            .map(|(_, _, lanes)| size_of_val(lanes.as_slice()))
            .sum()
    }
}
