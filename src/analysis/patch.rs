//! Moving least squares over the samples around an element.
//!
//! # Source
//! P. Lancaster, K. Salkauskas, moving least squares (1981), doi:10.1090/S0025-5718-1981-0616367-1.

use super::mirror::Reflection;
use std::collections::HashMap;

/// Highest degree of the polynomials: cubic, and then quadratic, linear, constant where the samples
/// do not determine it.
const CUBIC: usize = 3;
/// Terms of a cubic in space.
const N: usize = n_terms(3, CUBIC);
/// Monomials of twice its degree.
const MOMENTS: usize = n_terms(3, 2 * CUBIC);
/// Least pivot of the scaled normal equations.
const LEAST_PIVOT: f64 = 1e-2;
/// Reach of the weights in distances between samples.
const REACH: f64 = 3.25;

/// How far from the middle points of an element may lie, in its extents: curved sides bulge beyond
/// their nodes.
const HALF: f64 = 0.6;

/// Reach of the weights in sizes of an element with `n` samples: elements with more of them need
/// fewer neighbours, and a fit over less of the field is closer to it (at a bore the error of the
/// cubic falls with the fourth power of the reach).
pub fn reach(dimension: usize, n: usize) -> f64 {
    match dimension {
        2 => REACH / (n as f64).sqrt(),
        _ => REACH / (n as f64).cbrt(),
    }
}

/// Places that are kept of a patch: those of one search and those beside.
const MOST_KEPT: usize = 300;

/// Samples around an element, in coordinates relative to it and scaled by its size.
#[derive(Debug, Clone)]
pub struct Patch<const D: usize> {
    /// Middle of the element.
    center: [f64; D],
    /// Its extents.
    scale: [f64; D],
    /// Reach of the weights in element sizes.
    reach: f64,
    /// First those within reach of a point of the element.
    samples: Vec<Sample<D>>,
    /// How many of the samples these are.
    n_near: usize,
    /// The samples that count in the value last asked for, with their weights and places relative
    /// to it.
    weighted: Vec<(u32, f64, [f64; D])>,
    /// Indices of samples and their shares in that value.
    shares: Vec<(u32, f64)>,
    /// Shares in earlier values, by place.
    kept: HashMap<[u64; D], Box<[(u32, f64)]>>,
}

/// A sample of a patch, or its mirror image.
#[derive(Debug, Clone, Copy)]
pub struct Sample<const D: usize> {
    /// Index of its stress.
    pub index: u32,
    /// Relative to the patch and scaled.
    pub position: [f64; D],
    /// How its stress is reflected, where it is an image.
    pub reflection: Option<Reflection>,
}

impl<const D: usize> Patch<D> {
    /// The exponents of the variables in the monomials, by degree.
    const EXPONENTS: [[usize; 3]; MOMENTS] = exponents(D);
    /// Which monomial the product of two terms is.
    const PRODUCTS: [[usize; N]; N] = products(&Self::EXPONENTS);

    /// A patch round an element.
    pub fn new(center: [f64; D], scale: [f64; D], reach: f64, samples: Vec<Sample<D>>) -> Self {
        let is_near = |sample: &Sample<D>| {
            let beyond = sample.position.map(|x| (x.abs() - HALF).max(0.0));
            square(beyond) < reach * reach
        };
        let (mut samples, far): (Vec<_>, Vec<_>) = samples.into_iter().partition(is_near);
        let n_near = samples.len();
        samples.extend(far);
        Patch {
            center,
            scale,
            reach,
            samples,
            n_near,
            shares: Vec::new(),
            weighted: Vec::new(),
            kept: HashMap::new(),
        }
    }

    /// Moving least squares at a point: the fit of the highest degree that the samples around
    /// determine. What each sample adds to it depends on the point alone; `keep` has that ready
    /// where the same point is asked for again.
    pub fn value<const S: usize>(
        &mut self,
        samples: &[[f64; S]],
        at: [f64; D],
        keep: bool,
    ) -> [f64; S] {
        let place = at.map(f64::to_bits);
        if let Some(shares) = self.kept.get(&place) {
            return self.sum(shares, samples);
        }
        let x = std::array::from_fn(|d| (at[d] - self.center[d]) / self.scale[d]);
        self.weigh(x);
        // Degrees as constants: the loops over the terms are unrolled.
        if !(self.fit::<CUBIC>() || self.fit::<2>() || self.fit::<1>()) {
            self.weigh_all(x);
            self.fit::<0>();
        }
        if keep && self.kept.len() < MOST_KEPT {
            self.kept.insert(place, self.shares.as_slice().into());
        }
        self.sum(&self.shares, samples)
    }

    /// Places that are kept.
    #[cfg(test)]
    pub fn n_kept(&self) -> usize {
        self.kept.len()
    }

    fn sum<const S: usize>(&self, shares: &[(u32, f64)], samples: &[[f64; S]]) -> [f64; S] {
        let mut out = [0.0; S];
        for &(i, share) in shares {
            let sample = &self.samples[i as usize];
            let mut stress = samples[sample.index as usize];
            if let Some(reflection) = &sample.reflection {
                stress = reflection.of(stress);
            }
            for (out, stress) in out.iter_mut().zip(stress) {
                *out += share * stress;
            }
        }
        out
    }

    /// The share that each weighted sample has in the value of the fit of a degree, by the normal
    /// equations; terms are centred at the point, so that the value is the constant term. `false`,
    /// and no shares, where the samples do not determine it.
    ///
    /// The matrix of the normal equations holds the moments of the weights, `G_ab = sum w p_a p_b`,
    /// which are monomials of twice the degree; a sample's share is `w (c . p)` with `G c = e_0`.
    fn fit<const DEGREE: usize>(&mut self) -> bool {
        self.shares.clear();
        let n = const { n_terms(D, DEGREE) };
        if self.weighted.len() < n + n / 2 {
            return false;
        }
        let n_moments = const { n_terms(D, 2 * DEGREE) };
        let mut moments = [0.0; MOMENTS];
        for (_, weight, x) in &self.weighted {
            let powers = powers(*weight, x);
            for (moment, exponents) in moments.iter_mut().zip(&Self::EXPONENTS).take(n_moments) {
                *moment += monomial(&powers, exponents);
            }
        }
        let Some(coefficients) = constant_term(&moments, &Self::PRODUCTS, n) else {
            return false;
        };
        let shares = self.weighted.iter().map(|(i, weight, x)| {
            let powers = powers(*weight, x);
            let terms = coefficients.iter().zip(&Self::EXPONENTS).take(n);
            let share: f64 = terms
                .map(|(c, exponents)| c * monomial(&powers, exponents))
                .sum();
            (*i, share)
        });
        self.shares.extend(shares);
        true
    }

    /// Collects the samples within reach of `x`.
    fn weigh(&mut self, x: [f64; D]) {
        let unit = 1.0 / (self.reach * self.reach);
        self.weighted.clear();
        for (sample, i) in self.samples[..self.n_near].iter().zip(0..) {
            let d: [f64; D] = std::array::from_fn(|d| sample.position[d] - x[d]);
            let rest = 1.0 - square(d) * unit;
            if rest > 0.0 {
                self.weighted.push((i, rest * rest * rest, d));
            }
        }
    }

    /// Collects all samples, where those within reach determine nothing: with weights that reach
    /// on.
    fn weigh_all(&mut self, x: [f64; D]) {
        let unit = 1.0 / (self.reach * self.reach);
        let weighted = self.samples.iter().zip(0..).map(|(sample, i)| {
            let d: [f64; D] = std::array::from_fn(|d| sample.position[d] - x[d]);
            (i, 1.0 / (1.0 + square(d) * unit), d)
        });
        self.weighted.clear();
        self.weighted.extend(weighted);
    }
}

/// `x . x`
#[inline(always)]
fn square<const D: usize>(x: [f64; D]) -> f64 {
    (1..D).fold(x[0] * x[0], |sum, d| sum + x[d] * x[d])
}

/// Terms of a polynomial of a degree in so many variables.
const fn n_terms(variables: usize, degree: usize) -> usize {
    match variables {
        2 => (degree + 1) * (degree + 2) / 2,
        _ => (degree + 1) * (degree + 2) * (degree + 3) / 6,
    }
}

/// Powers of a number up to twice the highest degree.
type Powers = [f64; 2 * CUBIC + 1];

/// Powers of each coordinate, those of the first times `first`.
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

/// The exponents of the variables in the monomials: by degree, then by the powers of the last
/// ones.
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

/// Which monomial the product of two terms is; 0 where there are no such terms.
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

/// `c` of `G c = e_0`, by Cholesky's factor of `G` scaled to a unit diagonal; `None` where it has none, or hardly.
#[inline(always)]
fn constant_term(
    moments: &[f64; MOMENTS],
    products: &[[usize; N]; N],
    n: usize,
) -> Option<[f64; N]> {
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
        // Also what is no number.
        if l[i][i].is_nan() || l[i][i] < LEAST_PIVOT {
            return None;
        }
    }
    let mut c = [0.0; N];
    c[0] = scaling[0];
    for i in 0..n {
        let known: f64 = (0..i).map(|k| l[i][k] * c[k]).sum();
        c[i] = (c[i] - known) / l[i][i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| l[k][i] * c[k]).sum();
        c[i] = (c[i] - known) / l[i][i];
    }
    for (c, scaling) in c.iter_mut().zip(scaling) {
        *c *= scaling;
    }
    Some(c)
}
