//! The polynomial that fits values around an element by weighted least squares.
//!
//! With the terms `p(x)` of a polynomial and weights `w_i` at the points `x_i`, the coefficients
//! are `c = G^-1 sum_i w_i p(x_i) s_i`, with `G = sum_i w_i p(x_i) p(x_i)'`. The entries of `G` are
//! moments of the weights: sums of monomials up to twice the degree. Recovered stresses
//! ([`super::patch`]), gradients of displacements ([`super::fitted`]) and the error indicator
//! ([`super::indicator`]) are fits of this kind.

use crate::mesh::Mesh;

/// Highest degree of the polynomials.
pub const CUBIC: usize = 3;
/// Number of terms of a cubic polynomial in three variables.
const N: usize = n_terms(3, CUBIC);
/// Number of monomials up to twice the degree of a cubic.
const MOMENTS: usize = n_terms(3, 2 * CUBIC);

/// One number for each term, by degree: the constant, the coordinates, and so on. Numbers beyond
/// the degree of a fit are zero.
pub type Terms = [f64; N];

/// Number of terms of a polynomial with the given number of variables and degree.
pub const fn n_terms(variables: usize, degree: usize) -> usize {
    match variables {
        2 => (degree + 1) * (degree + 2) / 2,
        _ => (degree + 1) * (degree + 2) * (degree + 3) / 6,
    }
}

/// Coordinates about an element, scaled so that they are of order 1 in the element.
#[derive(Debug, Clone, Copy)]
pub struct ScaledCoordinates<const D: usize> {
    /// Point at which the coordinates vanish.
    pub center: [f64; D],
    /// Extents of the element.
    pub scale: [f64; D],
}

impl<const D: usize> ScaledCoordinates<D> {
    /// Coordinates about the middle of an element's extents.
    pub fn about(mesh: &Mesh, element: usize) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for &node in mesh.nodes(element) {
            let x = mesh.point(node as usize);
            for d in 0..D {
                low[d] = low[d].min(x[d]);
                high[d] = high[d].max(x[d]);
            }
        }
        ScaledCoordinates {
            center: std::array::from_fn(|d| 0.5 * (low[d] + high[d])),
            scale: std::array::from_fn(|d| high[d] - low[d]),
        }
    }

    /// The coordinates of a point in this frame.
    #[inline(always)]
    pub fn relative(&self, at: impl std::ops::Index<usize, Output = f64>) -> [f64; D] {
        std::array::from_fn(|d| (at[d] - self.center[d]) / self.scale[d])
    }
}

/// A polynomial of degree `DEGREE` in `D` variables, with its normal equations factored.
pub struct PatchFit<const D: usize, const DEGREE: usize> {
    /// Cholesky factor of `G` after scaling to a unit diagonal.
    factor: [Terms; N],
    scaling: Terms,
}

impl<const D: usize, const DEGREE: usize> PatchFit<D, DEGREE> {
    /// Number of terms of the fit.
    pub const N_TERMS: usize = n_terms(D, DEGREE);
    /// The exponents of the variables in the monomials, by degree.
    const EXPONENTS: [[usize; 3]; MOMENTS] = exponents(D);
    /// Index of the monomial that is the product of two terms.
    const PRODUCTS: [[usize; N]; N] = products(&Self::EXPONENTS);

    /// Sets up the fit to values at points with the given weights; `None` if a pivot of the scaled
    /// normal equations is below `least_pivot`, so that they do not determine the fit.
    #[inline(always)]
    pub fn to(points: impl Iterator<Item = (f64, [f64; D])>, least_pivot: f64) -> Option<Self> {
        let n = Self::N_TERMS;
        let n_moments = const { n_terms(D, 2 * DEGREE) };
        let mut moments = [0.0; MOMENTS];
        for (weight, x) in points {
            let powers = powers(weight, &x);
            for (moment, exponents) in moments.iter_mut().zip(&Self::EXPONENTS).take(n_moments) {
                *moment += monomial(&powers, exponents);
            }
        }
        let products = &Self::PRODUCTS;
        let mut scaling = [0.0; N];
        for (i, scaling) in scaling.iter_mut().enumerate().take(n) {
            *scaling = 1.0 / moments[products[i][i]].max(f64::MIN_POSITIVE).sqrt();
        }
        let mut l = [[0.0; N]; N];
        for i in 0..n {
            for j in 0..=i {
                let scaled = moments[products[i][j]] * scaling[i] * scaling[j];
                let known: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
                let rest = scaled - known;
                l[i][j] = if i == j { rest.sqrt() } else { rest / l[j][j] };
            }
            // A pivot that is NaN is refused, too.
            if l[i][i].is_nan() || l[i][i] < least_pivot {
                return None;
            }
        }
        Some(PatchFit { factor: l, scaling })
    }

    /// The coefficients of the fit to weighted points with values; `None` as in [`Self::to`].
    pub fn through(
        points: impl Iterator<Item = (f64, [f64; D], f64)> + Clone,
        least_pivot: f64,
    ) -> Option<Terms> {
        let fit = Self::to(
            points.clone().map(|(weight, x, _)| (weight, x)),
            least_pivot,
        )?;
        let mut right = [0.0; N];
        for (weight, x, value) in points {
            let terms = Self::terms(weight * value, &x);
            right.iter_mut().zip(terms).for_each(|(r, term)| *r += term);
        }
        Some(fit.solve(&right))
    }

    /// Coefficients `G^-1 right` of the fit.
    #[inline(always)]
    pub fn solve(&self, right: &Terms) -> Terms {
        let (n, l) = (Self::N_TERMS, &self.factor);
        let mut c = [0.0; N];
        for i in 0..n {
            let known: f64 = (0..i).map(|k| l[i][k] * c[k]).sum();
            c[i] = (right[i] * self.scaling[i] - known) / l[i][i];
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| l[k][i] * c[k]).sum();
            c[i] = (c[i] - known) / l[i][i];
        }
        for (c, scaling) in c.iter_mut().zip(self.scaling) {
            *c *= scaling;
        }
        c
    }

    /// Returns `G^-1 e_k`. With these coefficients, a value `s` of weight `w` at `x` adds
    /// [`Self::value`] times `s` to the coefficient of term `k`.
    #[inline(always)]
    pub fn coefficient(&self, k: usize) -> Terms {
        let mut right = [0.0; N];
        right[k] = 1.0;
        self.solve(&right)
    }

    /// Returns `first` times the value at `x` of the polynomial with the given coefficients.
    #[inline(always)]
    pub fn value(coefficients: &Terms, first: f64, x: &[f64; D]) -> f64 {
        let powers = powers(first, x);
        let terms = coefficients.iter().zip(&Self::EXPONENTS);
        terms
            .take(Self::N_TERMS)
            .map(|(c, exponents)| c * monomial(&powers, exponents))
            .sum()
    }

    /// The terms of the polynomial at a point, times `first`.
    #[inline(always)]
    pub fn terms(first: f64, x: &[f64; D]) -> Terms {
        let powers = powers(first, x);
        let mut out = [0.0; N];
        for (out, exponents) in out.iter_mut().zip(&Self::EXPONENTS).take(Self::N_TERMS) {
            *out = monomial(&powers, exponents);
        }
        out
    }
}

/// Powers of a number up to twice the highest degree.
type Powers = [f64; 2 * CUBIC + 1];

/// Powers of each coordinate; the powers of the first coordinate are multiplied by `first`.
#[inline(always)]
fn powers<const D: usize>(first: f64, x: &[f64; D]) -> [Powers; D] {
    std::array::from_fn(|d| {
        let mut out = [if d == 0 { first } else { 1.0 }; 2 * CUBIC + 1];
        for i in 1..out.len() {
            out[i] = out[i - 1] * x[d];
        }
        out
    })
}

#[inline(always)]
fn monomial<const D: usize>(powers: &[Powers; D], exponents: &[usize; 3]) -> f64 {
    (1..D).fold(powers[0][exponents[0]], |product, d| {
        product * powers[d][exponents[d]]
    })
}

/// The exponents of the variables in the monomials, ordered by degree, then by the powers of the
/// later variables.
const fn exponents(variables: usize) -> [[usize; 3]; MOMENTS] {
    let mut out = [[0; 3]; MOMENTS];
    let (mut k, mut degree) = (0, 0);
    while degree <= 2 * CUBIC {
        let mut of_z = 0;
        while of_z <= if variables == 2 { 0 } else { degree } {
            let mut of_y = 0;
            while of_y <= degree - of_z {
                out[k] = [degree - of_z - of_y, of_y, of_z];
                k += 1;
                of_y += 1;
            }
            of_z += 1;
        }
        degree += 1;
    }
    out
}

/// Index of the monomial that is the product of two terms; 0 if its degree is too high.
const fn products(exponents: &[[usize; 3]; MOMENTS]) -> [[usize; N]; N] {
    let mut out = [[0; N]; N];
    let mut a = 0;
    while a < N {
        let mut b = 0;
        while b < N {
            let (p, q) = (exponents[a], exponents[b]);
            let mut k = 0;
            while k < MOMENTS {
                let r = exponents[k];
                if r[0] == p[0] + q[0] && r[1] == p[1] + q[1] && r[2] == p[2] + q[2] {
                    out[a][b] = k;
                    break;
                }
                k += 1;
            }
            b += 1;
        }
        a += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fit reproduces a polynomial of its own degree from values with any weights. Fewer values
    /// than terms determine nothing.
    #[test]
    fn a_polynomial_is_its_own_fit() {
        check::<2, 2>();
        check::<3, 2>();
        check::<2, 3>();
        check::<3, 3>();
    }

    fn check<const D: usize, const DEGREE: usize>() {
        let n = PatchFit::<D, DEGREE>::N_TERMS;
        let mut given = [0.0; N];
        for (k, c) in given.iter_mut().enumerate().take(n) {
            *c = 1.0 / (1.0 + k as f64) - 0.3;
        }
        // Kronecker's sequence distributes points evenly.
        let place = |i: usize| -> [f64; D] {
            let irrational = [0.819_172_513_4, 0.671_043_606_7, 0.549_700_477_9];
            std::array::from_fn(|d| 2.0 * (irrational[d] * i as f64).fract() - 1.0)
        };
        let weight = |i: usize| 1.0 + (i % 3) as f64;
        let points = |m: usize| (0..m).map(move |i| (weight(i), place(i)));
        let fit = PatchFit::<D, DEGREE>::to(points(4 * n), 1e-4).unwrap();
        let valued =
            points(4 * n).map(|(w, x)| (w, x, PatchFit::<D, DEGREE>::value(&given, 1.0, &x)));
        let found = PatchFit::<D, DEGREE>::through(valued, 1e-4).unwrap();
        for k in 0..n {
            // The bound is round-off divided by the square of the least pivot, which is above 1e-3
            // here.
            assert!((found[k] - given[k]).abs() < 1e-10, "{D} {DEGREE} {k}");
        }
        let slope = fit.coefficient(1);
        let sum: f64 = points(4 * n)
            .map(|(w, x)| {
                let value = PatchFit::<D, DEGREE>::value(&given, 1.0, &x);
                value * PatchFit::<D, DEGREE>::value(&slope, w, &x)
            })
            .sum();
        assert!((sum - given[1]).abs() < 1e-10, "{D} {DEGREE}: {sum}");
        assert!(PatchFit::<D, DEGREE>::to(points(n - 1), 1e-4).is_none());
    }
}
