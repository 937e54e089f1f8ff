//! Moving least squares over the samples around an element.
//!
//! # Source
//! P. Lancaster, K. Salkauskas, moving least squares (1981), doi:10.1090/S0025-5718-1981-0616367-1.

use super::patch_fit::{CUBIC, Frame, PatchFit};
use crate::model::images::Reflection;
use std::collections::HashMap;

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

/// Places that are kept of a patch: those of one search and some more.
const MOST_KEPT: usize = 300;

/// Samples around an element, in coordinates relative to it and scaled by its size.
#[derive(Debug, Clone)]
pub struct Patch<const D: usize> {
    /// Coordinates about the middle of the element.
    frame: Frame<D>,
    /// Reach of the weights in element sizes.
    reach: f64,
    /// First those within reach of a point of the element.
    samples: Vec<Sample<D>>,
    /// Number of these samples.
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
    /// Reflection of the sample's stress, where the sample is an image.
    pub reflection: Option<Reflection>,
}

impl<const D: usize> Patch<D> {
    /// A patch round an element.
    pub fn new(frame: Frame<D>, reach: f64, samples: Vec<Sample<D>>) -> Self {
        let is_near = |sample: &Sample<D>| {
            let beyond = sample.position.map(|x| (x.abs() - HALF).max(0.0));
            square(beyond) < reach * reach
        };
        let (mut samples, far): (Vec<_>, Vec<_>) = samples.into_iter().partition(is_near);
        let n_near = samples.len();
        samples.extend(far);
        Patch {
            frame,
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
        let x = self.frame.relative(at);
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

    /// The share that each weighted sample has in the value of the fit of a degree; terms are
    /// centred at the point, so that the value is the constant term. `false`, and no shares, where
    /// the samples do not determine it.
    fn fit<const DEGREE: usize>(&mut self) -> bool {
        self.shares.clear();
        let n = PatchFit::<D, DEGREE>::N_TERMS;
        if self.weighted.len() < n + n / 2 {
            return false;
        }
        let points = self.weighted.iter().map(|(_, weight, x)| (*weight, *x));
        let Some(fit) = PatchFit::<D, DEGREE>::to(points, LEAST_PIVOT) else {
            return false;
        };
        let value = fit.coefficient(0);
        let share = |(i, weight, x): &(u32, f64, [f64; D])| {
            (*i, PatchFit::<D, DEGREE>::value(&value, *weight, x))
        };
        self.shares.extend(self.weighted.iter().map(share));
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

/// Squared length `x . x`.
#[inline(always)]
fn square<const D: usize>(x: [f64; D]) -> f64 {
    (1..D).fold(x[0] * x[0], |sum, d| sum + x[d] * x[d])
}
