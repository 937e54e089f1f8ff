//! Moving least squares over the samples around an element.
//!
//! # Source
//! P. Lancaster, K. Salkauskas, moving least squares (1981), doi:10.1090/S0025-5718-1981-0616367-1.

use super::mirror::Reflection;
use nalgebra::{DMatrix, DVector};

/// Terms of the polynomials that are tried: cubic, quadratic, linear, constant.
const TERMS: [usize; 4] = [10, 6, 3, 1];
/// Reach of the weights in distances between samples.
const REACH: f64 = 3.25;

/// Reach of the weights in sizes of an element with `n` samples: elements with more of them need fewer neighbours, and a fit over
/// less of the field is closer to it (at a bore the error of the cubic falls with the fourth power of the reach).
pub fn reach(n: usize) -> f64 {
    REACH / (n as f64).sqrt()
}

/// Samples around an element, in coordinates relative to it and scaled by its size.
#[derive(Debug, Clone)]
pub struct Patch {
    /// Middle of the element.
    pub center: [f64; 2],
    /// Its extents.
    pub scale: [f64; 2],
    /// Reach of the weights in element sizes.
    pub reach: f64,
    /// The samples.
    pub samples: Vec<Sample>,
}

/// A sample of a patch, or its mirror image.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Index of its stress.
    pub index: u32,
    /// Relative to the patch and scaled.
    pub position: [f64; 2],
    /// How its stress is reflected, where it is an image.
    pub reflection: Option<Reflection>,
}

impl Patch {
    /// Moving least squares at a point: the fit of the highest degree that the samples around determine.
    pub fn value(&self, samples: &[[f64; 4]], at: [f64; 2]) -> [f64; 4] {
        let x = [
            (at[0] - self.center[0]) / self.scale[0],
            (at[1] - self.center[1]) / self.scale[1],
        ];
        TERMS
            .iter()
            .find_map(|&n| self.fit(samples, x, n))
            .unwrap_or([0.0; 4])
    }

    /// Value at `x` of the weighted fit with `n` terms, by the normal equations; terms are centred at `x`, so that the value
    /// is the constant term. `None` where the samples do not determine it.
    fn fit(&self, samples: &[[f64; 4]], x: [f64; 2], n: usize) -> Option<[f64; 4]> {
        let mut gram = DMatrix::<f64>::zeros(n, n);
        let mut right = DMatrix::<f64>::zeros(n, 4);
        let mut used = 0;
        for sample in &self.samples {
            let position = sample.position;
            let (dx, dy) = (position[0] - x[0], position[1] - x[1]);
            let distance = (dx * dx + dy * dy) / (self.reach * self.reach);
            if distance >= 1.0 && n > 1 {
                continue;
            }
            used += 1;
            let mut stress = samples[sample.index as usize];
            if let Some(reflection) = &sample.reflection {
                stress = reflection.of(stress);
            }
            let weight = if n > 1 {
                (1.0 - distance).powi(3)
            } else {
                1.0 / (1.0 + distance)
            };
            let terms = [
                1.0,
                dx,
                dy,
                dx * dx,
                dx * dy,
                dy * dy,
                dx * dx * dx,
                dx * dx * dy,
                dx * dy * dy,
                dy * dy * dy,
            ];
            for a in 0..n {
                for b in 0..n {
                    gram[(a, b)] += weight * terms[a] * terms[b];
                }
                for c in 0..4 {
                    right[(a, c)] += weight * terms[a] * stress[c];
                }
            }
        }
        if used < n + n / 2 {
            return None;
        }
        let scaling = DVector::from_fn(n, |i, _| 1.0 / gram[(i, i)].max(f64::MIN_POSITIVE).sqrt());
        let scaled = DMatrix::from_fn(n, n, |i, j| gram[(i, j)] * scaling[i] * scaling[j]);
        let factor = scaled.cholesky()?;
        if (0..n).any(|i| factor.l_dirty()[(i, i)] < 1e-2) {
            return None;
        }
        for mut column in right.column_iter_mut() {
            column.component_mul_assign(&scaling);
        }
        let solution = factor.solve(&right);
        Some(std::array::from_fn(|c| solution[(0, c)] * scaling[0]))
    }
}
