//! Polynomials through values that are known at places.

use crate::balls::Balls;
use nalgebra::{DMatrix, DVector};

/// Believed pairs that a quadratic is fitted to at least, one and a half times its terms.
const FITTED: usize = 9;
/// Share of the largest singular value below which a fit's equations count as dependent.
const DEPENDENT: f64 = 1e-4;
/// Most iterations of a singular value decomposition: each value takes two or three.
const ITERATIONS: usize = 1000;

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
    coefficients: [f64; 6],
}

impl Fit {
    /// By least squares through the nearest known values, weighted by nearness; `None` where they
    /// do not determine even a plane.
    fn new(known: &[Known], origin: [f64; 2]) -> Option<Self> {
        let off = |known: &Known| (known.at[0] - origin[0]).hypot(known.at[1] - origin[1]);
        let mut near: Vec<(f64, Known)> = known.iter().map(|known| (off(known), *known)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (terms, least, most) in [(6, FITTED, 2 * FITTED), (3, 4, 6)] {
            if near.len() < least {
                continue;
            }
            // Those as far away as the last one are used too: which of them came first means
            // nothing.
            let last = near[most.min(near.len()) - 1].0 * (1.0 + 1e-9);
            let used = &near[..near.partition_point(|(off, _)| *off <= last)];
            let scale = used[used.len() - 1].0;
            if scale <= 0.0 {
                continue;
            }
            let mut matrix = DMatrix::zeros(used.len(), terms);
            let mut right = DVector::zeros(used.len());
            for (i, (off, known)) in used.iter().enumerate() {
                let weight = 1.0 / (0.1 + (off / scale).powi(2));
                let place = [0, 1].map(|d| (known.at[d] - origin[d]) / scale);
                for (j, term) in monomials(place).into_iter().enumerate().take(terms) {
                    matrix[(i, j)] = weight * term;
                }
                right[i] = weight * known.value;
            }
            let decomposed = matrix.try_svd(true, true, 5.0 * f64::EPSILON, ITERATIONS)?;
            let largest = decomposed.singular_values.max();
            if decomposed.singular_values.min() <= DEPENDENT * largest {
                continue;
            }
            let solution = decomposed.solve(&right, 0.0).ok()?;
            let mut coefficients = [0.0; 6];
            coefficients[..terms].copy_from_slice(solution.as_slice());
            return Some(Fit {
                origin,
                scale,
                coefficients,
            });
        }
        None
    }

    pub(super) fn value(&self, at: [f64; 2]) -> f64 {
        let place = [0, 1].map(|d| (at[d] - self.origin[d]) / self.scale);
        let terms = monomials(place).into_iter().zip(self.coefficients);
        terms.map(|(term, c)| term * c).sum()
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

fn monomials([x, y]: [f64; 2]) -> [f64; 6] {
    [1.0, x, y, x * x, x * y, y * y]
}
