//! Moving least squares over the samples around an element.
//!
//! # Source
//! P. Lancaster, K. Salkauskas, moving least squares (1981), doi:10.1090/S0025-5718-1981-0616367-1.

use super::mirror::Reflection;
use std::collections::HashMap;

/// Highest degree of the polynomials: cubic, and then quadratic, linear, constant where the samples
/// do not determine it.
const CUBIC: usize = 3;
/// Terms of a cubic.
const N: usize = n_terms(CUBIC);
/// Monomials of twice its degree.
const MOMENTS: usize = n_terms(2 * CUBIC);
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
pub fn reach(n: usize) -> f64 {
    REACH / (n as f64).sqrt()
}

/// Places that are kept of a patch: those of one search and those beside.
const MOST_KEPT: usize = 300;

/// Samples around an element, in coordinates relative to it and scaled by its size.
#[derive(Debug, Clone)]
pub struct Patch {
    /// Middle of the element.
    center: [f64; 2],
    /// Its extents.
    scale: [f64; 2],
    /// Reach of the weights in element sizes.
    reach: f64,
    /// First those within reach of a point of the element.
    samples: Vec<Sample>,
    /// How many of the samples these are.
    n_near: usize,
    /// The samples that count in the value last asked for, with their weights and places relative
    /// to it.
    weighted: Vec<(u32, f64, [f64; 2])>,
    /// Indices of samples and their shares in that value.
    shares: Vec<(u32, f64)>,
    /// Shares in earlier values, by place.
    kept: HashMap<[u64; 2], Box<[(u32, f64)]>>,
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
    /// A patch round an element.
    pub fn new(center: [f64; 2], scale: [f64; 2], reach: f64, samples: Vec<Sample>) -> Self {
        let is_near = |sample: &Sample| {
            let [x, y] = sample.position.map(|x| (x.abs() - HALF).max(0.0));
            x * x + y * y < reach * reach
        };
        let (mut samples, far): (Vec<Sample>, Vec<Sample>) = samples.into_iter().partition(is_near);
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
    pub fn value(&mut self, samples: &[[f64; 4]], at: [f64; 2], keep: bool) -> [f64; 4] {
        let place = at.map(f64::to_bits);
        if let Some(shares) = self.kept.get(&place) {
            return self.sum(shares, samples);
        }
        let x = [
            (at[0] - self.center[0]) / self.scale[0],
            (at[1] - self.center[1]) / self.scale[1],
        ];
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

    fn sum(&self, shares: &[(u32, f64)], samples: &[[f64; 4]]) -> [f64; 4] {
        let mut out = [0.0; 4];
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
    fn fit<const D: usize>(&mut self) -> bool {
        self.shares.clear();
        let n = n_terms(D);
        if self.weighted.len() < n + n / 2 {
            return false;
        }
        let mut moments = [0.0; MOMENTS];
        for &(_, weight, [x, y]) in &self.weighted {
            let (along_x, along_y) = (powers(weight, x), powers(1.0, y));
            let exponents = &EXPONENTS[..n_terms(2 * D)];
            for (moment, [a, b]) in moments.iter_mut().zip(exponents) {
                *moment += along_x[*a] * along_y[*b];
            }
        }
        let Some(coefficients) = constant_term(&moments, n) else {
            return false;
        };
        let shares = self.weighted.iter().map(|&(i, weight, [x, y])| {
            let (along_x, along_y) = (powers(weight, x), powers(1.0, y));
            let terms = coefficients.iter().zip(&EXPONENTS[..n_terms(D)]);
            let share: f64 = terms.map(|(c, [a, b])| c * along_x[*a] * along_y[*b]).sum();
            (i, share)
        });
        self.shares.extend(shares);
        true
    }

    /// Collects the samples within reach of `x`.
    fn weigh(&mut self, x: [f64; 2]) {
        let unit = 1.0 / (self.reach * self.reach);
        self.weighted.clear();
        for (sample, i) in self.samples[..self.n_near].iter().zip(0..) {
            let d = [sample.position[0] - x[0], sample.position[1] - x[1]];
            let rest = 1.0 - (d[0] * d[0] + d[1] * d[1]) * unit;
            if rest > 0.0 {
                self.weighted.push((i, rest * rest * rest, d));
            }
        }
    }

    /// Collects all samples, where those within reach determine nothing: with weights that reach
    /// on.
    fn weigh_all(&mut self, x: [f64; 2]) {
        let unit = 1.0 / (self.reach * self.reach);
        let weighted = self.samples.iter().zip(0..).map(|(sample, i)| {
            let d = [sample.position[0] - x[0], sample.position[1] - x[1]];
            (i, 1.0 / (1.0 + (d[0] * d[0] + d[1] * d[1]) * unit), d)
        });
        self.weighted.clear();
        self.weighted.extend(weighted);
    }
}

/// Terms of a polynomial of a degree.
const fn n_terms(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// `first` times the powers of `x` up to twice the highest degree.
#[inline(always)]
fn powers(first: f64, x: f64) -> [f64; 2 * CUBIC + 1] {
    let mut out = [first; 2 * CUBIC + 1];
    for i in 1..out.len() {
        out[i] = out[i - 1] * x;
    }
    out
}

/// The exponents of x and y in the monomials: by degree and then by the power of y.
const EXPONENTS: [[usize; 2]; MOMENTS] = {
    let mut out = [[0; 2]; MOMENTS];
    let mut k = 0;
    while k < MOMENTS {
        let degree = degree_of(k);
        let of_y = k - n_terms_below(degree);
        out[k] = [degree - of_y, of_y];
        k += 1;
    }
    out
};

/// `c` of `G c = e_0`, by Cholesky's factor of `G` scaled to a unit diagonal; `None` where it has none, or hardly.
#[inline(always)]
fn constant_term(moments: &[f64; MOMENTS], n: usize) -> Option<[f64; N]> {
    let scaling: [f64; N] =
        std::array::from_fn(|i| 1.0 / moments[PRODUCTS[i][i]].max(f64::MIN_POSITIVE).sqrt());
    let mut l = [[0.0; N]; N];
    for i in 0..n {
        for j in 0..=i {
            let scaled = moments[PRODUCTS[i][j]] * scaling[i] * scaling[j];
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

/// Which monomial the product of two terms is.
const PRODUCTS: [[usize; N]; N] = {
    let mut out = [[0; N]; N];
    let mut a = 0;
    while a < N {
        let mut b = 0;
        while b < N {
            let (ta, tb) = (degree_of(a), degree_of(b));
            let power = a + b - n_terms_below(ta) - n_terms_below(tb);
            out[a][b] = n_terms_below(ta + tb) + power;
            b += 1;
        }
        a += 1;
    }
    out
};

/// Terms of lower degree.
const fn n_terms_below(degree: usize) -> usize {
    degree * (degree + 1) / 2
}

/// The degree of a term.
const fn degree_of(term: usize) -> usize {
    let mut degree = 0;
    while term >= n_terms(degree) {
        degree += 1;
    }
    degree
}
