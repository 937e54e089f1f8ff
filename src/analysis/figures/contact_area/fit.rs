//! Polynomials fitted to values known at scattered places.

use crate::analysis::stress::patch_fit::{PatchFit, Terms};
use crate::balls::Balls;

/// Least number of trusted pairs to which a quadratic is fitted: one and a half times its terms.
const FITTED: usize = 9;
/// Pivot of the scaled normal equations below which a fit does not count as determined.
const LEAST_PIVOT: f64 = 1e-4;
/// Fit of a quadratic polynomial; a plane is a special case.
type FittedQuadratic = PatchFit<2, 2>;
type FittedPlane = PatchFit<2, 1>;

/// A value known at a place.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) at: [f64; 2],
    pub(super) value: f64,
}

/// Values known at many places, with a search tree.
pub(super) struct Cloud {
    known: Vec<Known>,
    tree: Balls,
}

impl Cloud {
    pub(super) fn new(known: Vec<Known>) -> Self {
        let items = known.iter().map(|known| (in_space(known.at), 0.0));
        Cloud {
            tree: Balls::new(items.collect()),
            known,
        }
    }

    /// Fits a polynomial around a place to the known values near it and to the values `more`.
    pub(super) fn fit(&self, origin: [f64; 2], more: &[Known]) -> Option<LocalPolynomial> {
        let near = self.tree.nearest_few(in_space(origin), 2 * FITTED);
        let near = near.into_iter().map(|(_, item)| self.known[item]);
        let near: Vec<Known> = near.chain(more.iter().copied()).collect();
        LocalPolynomial::new(&near, origin)
    }
}

fn in_space([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}

/// A polynomial around a place: quadratic, or linear if the known values do not determine a
/// quadratic.
pub(super) struct LocalPolynomial {
    origin: [f64; 2],
    scale: f64,
    coefficients: Terms,
}

impl LocalPolynomial {
    /// Fits the nearest known values by least squares, weighted by nearness; `None` if they do not
    /// determine even a plane.
    fn new(known: &[Known], origin: [f64; 2]) -> Option<Self> {
        let off = |known: &Known| (known.at[0] - origin[0]).hypot(known.at[1] - origin[1]);
        let mut near: Vec<(f64, Known)> = known.iter().map(|known| (off(known), *known)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let fit = |degree: usize, least: usize, most: usize| {
            if near.len() < least {
                return None;
            }
            // Values as far away as the last one are used too: their order is arbitrary.
            let last = near[most.min(near.len()) - 1].0 * (1.0 + 1e-9);
            let used = &near[..near.partition_point(|(off, _)| *off <= last)];
            let scale = used[used.len() - 1].0;
            let place = |known: &Known| [0, 1].map(|d| (known.at[d] - origin[d]) / scale);
            let points = used.iter().map(|(off, known)| {
                let weight = 1.0 / (0.1 + (off / scale).powi(2));
                (weight * weight, place(known), known.value)
            });
            let coefficients = match degree {
                1 => FittedPlane::through(points, LEAST_PIVOT),
                _ => FittedQuadratic::through(points, LEAST_PIVOT),
            }?;
            Some(LocalPolynomial {
                origin,
                scale,
                coefficients,
            })
        };
        fit(2, FITTED, 2 * FITTED).or_else(|| fit(1, 4, 6))
    }

    pub(super) fn value(&self, at: [f64; 2]) -> f64 {
        let place = [0, 1].map(|d| (at[d] - self.origin[d]) / self.scale);
        FittedQuadratic::value(&self.coefficients, 1.0, &place)
    }

    /// The sum of the two second derivatives.
    pub(super) fn laplacian(&self) -> f64 {
        2.0 * (self.coefficients[3] + self.coefficients[5]) / self.scale.powi(2)
    }

    /// The size of the gradient at the place of the fit.
    pub(super) fn slope(&self) -> f64 {
        self.coefficients[1].hypot(self.coefficients[2]) / self.scale
    }
}
