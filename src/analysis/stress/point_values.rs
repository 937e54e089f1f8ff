//! Stresses and strains at the integration points of elements, as results keep them.

use super::stress_field::StressField;
use crate::element::Components;
use crate::results::PointValues;
use rayon::prelude::*;

/// Number of elements that are evaluated before their values are stored.
const BLOCK: usize = 2048;

/// The stresses and strains of the given elements, one after the other.
pub(super) fn of<const D: usize, const S: usize, const P: usize, const N: usize>(
    field: &StressField<D, S, P, N>,
    elements: &[usize],
) -> PointValues {
    let mesh = &field.continuum.mesh;
    let n_points = elements.iter().map(|&e| mesh.n_points(e));
    let mut out = PointValues::zeros(n_points, S);
    let evaluated = |e: &usize| {
        let element = field.at(*e);
        let strain = field.total_strain(&element);
        (element.stress, strain, element.history)
    };
    for (block, elements) in elements.chunks(BLOCK).enumerate() {
        let values: Vec<_> = elements.par_iter().map(evaluated).collect();
        for (i, (stress, strain, history)) in values.iter().enumerate() {
            let points = out.of(BLOCK * block + i);
            for (g, point) in points.enumerate() {
                put(stress, g, &mut out.stress[S * point..]);
                put(strain, g, &mut out.strain[S * point..]);
                out.plastic_strain[point] = history.get(g).map_or(0.0, |past| past.equivalent);
            }
        }
    }
    out
}

/// Writes the components of a tensor at one point to `to`.
fn put<const S: usize, const P: usize>(values: &Components<S, P>, g: usize, to: &mut [f64]) {
    for (to, lanes) in to.iter_mut().zip(values) {
        *to = lanes[g];
    }
}
