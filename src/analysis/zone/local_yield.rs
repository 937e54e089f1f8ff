//! Yield stresses that vary within a body, and the ratio of von Mises stress to yield stress.

use crate::element::Components;
use crate::material::von_mises;
use crate::model::Continuum;

/// The yield stress at `n` places of an element; `None` if it is uniform in the body.
pub(super) fn at_places<const D: usize, const P: usize>(
    continuum: &Continuum,
    element: usize,
    places: &[[f64; P]; D],
    n: usize,
) -> Option<Vec<f64>> {
    let body = continuum.mesh.element_body[element] as usize;
    continuum.yield_by_depth[body].as_ref()?;
    let place = |g: usize| std::array::from_fn(|d| places.get(d).map_or(0.0, |lanes| lanes[g]));
    let stresses = (0..n).map(|g| continuum.yield_stress(body, place(g)));
    Some(stresses.collect())
}

/// The largest ratio of von Mises stress to yield stress at `n` places of an element.
#[inline]
pub(in crate::analysis) fn largest_ratio<const D: usize, const S: usize, const P: usize>(
    continuum: &Continuum,
    element: usize,
    stress: &Components<S, P>,
    (places, n): (impl FnOnce() -> [[f64; P]; D], usize),
) -> f64 {
    let body = continuum.mesh.element_body[element] as usize;
    if continuum.yield_by_depth[body].is_none() {
        return largest_von_mises(stress, n) / continuum.materials[body].yield_stress();
    }
    let limits = at_places(continuum, element, &places(), n).unwrap_or_default();
    let ratio = |(g, limit)| von_mises(&stress.each_ref().map(|lanes| lanes[g])) / limit;
    limits
        .into_iter()
        .enumerate()
        .map(ratio)
        .fold(0.0, f64::max)
}

/// The largest von Mises stress at the first `n` points of an element.
#[inline]
pub(in crate::analysis) fn largest_von_mises<const S: usize, const P: usize>(
    stress: &Components<S, P>,
    n: usize,
) -> f64 {
    let (x, y, z) = (&stress[0], &stress[1], &stress[2]);
    let mut square = 0.0f64;
    for g in 0..n {
        let [a, b, c] = [x[g] - y[g], y[g] - z[g], z[g] - x[g]];
        let shear: f64 = stress[3..].iter().map(|t| t[g] * t[g]).sum();
        square = square.max(0.5 * (a * a + b * b + c * c) + 3.0 * shear);
    }
    square.sqrt()
}
