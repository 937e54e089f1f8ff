//! Free strains at the points of elements, to be subtracted from the total strains. They come from
//! temperature or are brought along by a body ([`FreeOfLoad`]).

use crate::element::{Components, Lanes};
use crate::mesh::Mesh;
use crate::model::{FreeOfLoad, Model};
use std::ops::Range;

/// Subtracts the free strains of an element, at the given load factors, from its strains;
/// `at_points` interpolates from its nodes to its points.
#[inline]
pub(in crate::analysis) fn take_off_all<const S: usize, const P: usize, const N: usize>(
    strains: &mut Components<S, P>,
    (mesh, element): (&Mesh, usize),
    (free, factors): (&[FreeOfLoad], &[f64]),
    at_points: impl Fn(&[f64; N]) -> Lanes<P>,
) {
    for free in free {
        if let Some(nodal) = free.at_nodes(mesh, element) {
            let free_strain = (free.components(), &at_points(&nodal));
            take_off(strains, factors[free.load], free_strain);
        }
    }
}

/// Subtracts `factor` times a free strain, given for a range of components, from `strains`.
#[inline]
fn take_off<const S: usize, const P: usize>(
    strains: &mut Components<S, P>,
    factor: f64,
    (components, free): (&Range<usize>, &Lanes<P>),
) {
    // A plane model has fewer components than a solid.
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

/// Free strains at factor 1 at the points of some elements, stored by load; empty if no load has
/// free strains.
pub(in crate::analysis) struct FreeStrains<const P: usize> {
    of_loads: Vec<(usize, Range<usize>, Vec<Lanes<P>>)>,
}

impl<const P: usize> FreeStrains<P> {
    /// Free strains of the given elements; `at_points` interpolates from the nodes of the i-th
    /// element.
    pub(in crate::analysis) fn new<const N: usize>(
        model: &Model,
        elements: &[usize],
        at_points: impl Fn(usize, &[f64; N]) -> Lanes<P>,
    ) -> Self {
        let of_load = |free: &FreeOfLoad| {
            let lanes = elements.iter().enumerate().map(|(i, &element)| {
                let nodal = free.at_nodes(&model.mesh, element);
                nodal.map_or([0.0; P], |nodal| at_points(i, &nodal))
            });
            (free.load, free.components().clone(), lanes.collect())
        };
        FreeStrains {
            of_loads: model.free_of_loads().iter().map(of_load).collect(),
        }
    }

    /// Subtracts the free strains of the i-th element, at the given load factors, from its strains.
    #[inline]
    pub(in crate::analysis) fn take_off<const S: usize>(
        &self,
        i: usize,
        factors: &[f64],
        strains: &mut Components<S, P>,
    ) {
        for (load, components, of_elements) in &self.of_loads {
            take_off(strains, factors[*load], (components, &of_elements[i]));
        }
    }

    /// Bytes of heap held.
    pub(in crate::analysis) fn bytes(&self) -> usize {
        let of_loads = self.of_loads.iter();
        of_loads
            .map(|(_, _, lanes)| size_of_val(lanes.as_slice()))
            .sum()
    }
}
