//! Recovered values by moving least squares over the samples around an element.
//!
//! # Source
//! P. Lancaster, K. Salkauskas, moving least squares (1981), doi:10.1090/S0025-5718-1981-0616367-1.

use super::patch_fit::{CUBIC, PatchFit, ScaledCoordinates};
use crate::model::images::Reflection;
use std::collections::HashMap;

/// Least pivot of the scaled normal equations with which a fit counts as determined.
const LEAST_PIVOT: f64 = 1e-2;
/// Radius of the weights, in distances between samples.
const REACH: f64 = 3.25;

/// Distance from the middle within which the points of an element lie, in extents of the element:
/// more than half, because curved sides bulge beyond their nodes.
const HALF: f64 = 0.6;

/// Radius of the weights, in sizes of an element with `n` samples. Elements with more samples need
/// fewer neighbours, and a fit over a smaller region is closer to the field (at a bore the error of
/// the cubic falls with the fourth power of the radius).
pub fn reach(dimension: usize, n: usize) -> f64 {
    match dimension {
        2 => REACH / (n as f64).sqrt(),
        _ => REACH / (n as f64).cbrt(),
    }
}

/// Largest number of points whose fits a patch keeps: the points of one search and some more.
const MOST_KEPT: usize = 300;

/// Samples around an element, in coordinates relative to it and scaled by its size.
#[derive(Debug, Clone)]
pub struct Patch<const D: usize> {
    /// Coordinates about the middle of the element.
    frame: ScaledCoordinates<D>,
    /// Reach of the weights in element sizes.
    reach: f64,
    /// All samples; samples within reach of a point of the element come first.
    samples: Vec<Sample<D>>,
    /// Number of samples within reach of a point of the element.
    n_near: usize,
    /// The samples with a weight in the value computed last: index, weight, and position relative
    /// to the point of evaluation.
    weighted: Vec<(u32, f64, [f64; D])>,
    /// Indices of samples, and their shares in the value computed last.
    shares: Vec<(u32, f64)>,
    /// Shares of samples in values computed earlier, by point of evaluation.
    kept: HashMap<[u64; D], Box<[(u32, f64)]>>,
}

/// A sample of a patch, or its mirror image.
#[derive(Debug, Clone, Copy)]
pub struct Sample<const D: usize> {
    /// Index of the sampled stress.
    pub index: u32,
    /// Position relative to the patch, scaled by the size of the element.
    pub position: [f64; D],
    /// Reflection of the sampled stress, if the sample is a mirror image.
    pub reflection: Option<Reflection>,
}

impl<const D: usize> Patch<D> {
    /// A patch round an element.
    pub fn new(frame: ScaledCoordinates<D>, reach: f64, samples: Vec<Sample<D>>) -> Self {
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

    /// Evaluates the moving least squares fit at a point, with the highest degree that the samples
    /// around determine. The share of each sample depends on the point alone. If `keep` is set, the
    /// shares are kept for the next call at this point.
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
        // Degrees are compile-time constants, so that loops over the terms are unrolled.
        if !(self.fit::<CUBIC>() || self.fit::<2>() || self.fit::<1>()) {
            self.weigh_all(x);
            self.fit::<0>();
        }
        if keep && self.kept.len() < MOST_KEPT {
            self.kept.insert(place, self.shares.as_slice().into());
        }
        self.sum(&self.shares, samples)
    }

    /// Number of points whose fits are kept.
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

    /// Computes the share of each weighted sample in the value of a fit of the given degree. Terms
    /// are centred at the point of evaluation, so the value is the constant term. Returns `false`,
    /// without shares, if the samples do not determine the fit.
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

    /// Collects all samples, with weights of unlimited reach, for a point at which the samples
    /// within reach determine no fit.
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
