//! Polynomials through values that are known at places.

use crate::analysis::stress::patch_fit::{PatchFit, Terms};
use crate::balls::Balls;

/// Believed pairs that a quadratic is fitted to at least, one and a half times its terms.
const FITTED: usize = 9;
/// Pivot of the scaled normal equations below which they do not determine a fit.
const LEAST_PIVOT: f64 = 1e-4;
/// A quadratic, of which a plane is one.
type FittedQuadratic = PatchFit<2, 2>;
type FittedPlane = PatchFit<2, 1>;

/// A value at a place.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) at: [f64; 2],
    pub(super) value: f64,
}

/// Values that are known at many places.
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

    /// The polynomial round a place, through the values near it and some `more`.
    pub(super) fn fit(&self, origin: [f64; 2], more: &[Known]) -> Option<Fit> {
        let near = self.tree.nearest_few(in_space(origin), 2 * FITTED);
        let near = near.into_iter().map(|(_, item)| self.known[item]);
        let near: Vec<Known> = near.chain(more.iter().copied()).collect();
        Fit::new(&near, origin)
    }
}

fn in_space([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}

/// A polynomial round a place: quadratic, linear where the known values do not determine that.
pub(super) struct Fit {
    origin: [f64; 2],
    scale: f64,
    coefficients: Terms,
}

impl Fit {
    /// A fit by least squares through the nearest known values, weighted by nearness; `None` where
    /// they do not determine even a plane.
    fn new(known: &[Known], origin: [f64; 2]) -> Option<Self> {
        let off = |known: &Known| (known.at[0] - origin[0]).hypot(known.at[1] - origin[1]);
        let mut near: Vec<(f64, Known)> = known.iter().map(|known| (off(known), *known)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let fit = |degree: usize, least: usize, most: usize| {
            if near.len() < least {
                return None;
            }
            // Those as far away as the last one are used too: which of them came first means
            // nothing.
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
            Some(Fit {
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

    /// The sum of both second derivatives.
    pub(super) fn laplacian(&self) -> f64 {
        2.0 * (self.coefficients[3] + self.coefficients[5]) / self.scale.powi(2)
    }

    /// The size of the gradient at its place.
    pub(super) fn slope(&self) -> f64 {
        self.coefficients[1].hypot(self.coefficients[2]) / self.scale
    }
}
