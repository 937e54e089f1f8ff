//! The moments of a patch read from its pairs, and a second reading for comparison.

use super::edge::{Edge, EdgeFace};
use super::fit::{Cloud, Known};
use super::moments::{Moments, PatchSums, Polygon};
use super::shape::{ProjectedPatch, middle};
use crate::model::images::Reflection;
use crate::space::{difference, dot, length};
use std::collections::{BTreeMap, BTreeSet};

/// Number of layers of pairs at the edge whose pressures are not trusted one by one, for a smooth
/// contact ([`SMOOTH`]) and otherwise ([`STEEP`]). Under plastic flow the pressure stays high up to
/// the edge, and its extrapolation from the pairs further inside passes open pairs.
const SMOOTH: usize = 2;
const STEEP: usize = 1;
/// Number of trusted layers next to the edge whose pressures are corrected for being means over
/// faces.
const CORRECTED: usize = 3;

impl ProjectedPatch<'_> {
    /// The patch's moments, and a second reading of them: the difference is an estimate of the
    /// error. There is no second reading if the pairs are too few.
    pub(super) fn readings(&self) -> (Moments, Option<Moments>) {
        let layers = self.layers();
        let moments = |skipped| self.moments(&layers, skipped);
        let (smooth, steep) = rayon::join(|| moments(SMOOTH), || moments(STEEP));
        match (smooth, steep) {
            (Some((smooth, true)), steep) => (smooth, steep.map(|(steep, _)| steep)),
            (smooth, Some((steep, _))) => (steep, smooth.map(|(smooth, _)| smooth)),
            _ => (self.moments_of_few(), None),
        }
    }

    /// The patch's moments from the pairs inside the `skipped` outer layers, and whether the
    /// extrapolated pressure vanishes before open pairs. `None` if the pairs do not determine a
    /// polynomial at each face of the edge.
    fn moments(&self, layers: &BTreeMap<usize, usize>, skipped: usize) -> Option<(Moments, bool)> {
        let believed = self.believed(layers, skipped);
        let mut sums = PatchSums::default();
        let mut faces = Vec::new();
        for (face, corners) in self.member_faces() {
            let places = self.places(corners);
            let parts = || self.covered(face).unwrap_or_else(|| vec![places.clone()]);
            if corners.iter().all(|k| layers[k] > skipped) {
                sums.add_all(&parts());
                continue;
            }
            let left = |k: &usize| (skipped + 1).saturating_sub(layers[k]) as f64;
            let pressure = |k: &usize| match self.members.contains(k) {
                true => self.pressure[*k],
                false => 0.0,
            };
            faces.push(EdgeFace {
                fit: believed.fit(middle(&places), &[])?,
                layers: corners.iter().map(left).collect(),
                pressures: corners.iter().map(pressure).collect(),
                parts: parts(),
                corners: places,
            });
        }
        let edge = Edge::balanced(faces);
        edge.add_to(&mut sums);
        for (near, parts) in self.slivers() {
            let is_believed = |k: &usize| layers.get(k).is_some_and(|l| *l > skipped);
            if near.iter().all(is_believed) {
                sums.add_all(&parts);
            } else if let Some(fit) = believed.fit(middle(&self.places(near)), &[]) {
                sums.add_parts(&parts, |x| fit.value(x));
            }
        }
        Some((self.with_images(&sums), !edge.passes_open_pairs()))
    }

    /// Layer of each pair of the patch, counted from the open pairs next to it, which have layer 0.
    fn layers(&self) -> BTreeMap<usize, usize> {
        let mut layers: BTreeMap<usize, usize> = BTreeMap::new();
        for &k in &self.members {
            for other in self.topology.around(k) {
                if !self.members.contains(&other) {
                    layers.insert(other, 0);
                }
            }
        }
        let mut edge: Vec<usize> = layers.keys().copied().collect();
        for layer in 1.. {
            let mut next = BTreeSet::new();
            for k in edge {
                next.extend(
                    self.topology.around(k).filter(|other| {
                        self.members.contains(other) && !layers.contains_key(other)
                    }),
                );
            }
            if next.is_empty() {
                break;
            }
            layers.extend(next.iter().map(|&k| (k, layer)));
            edge = next.into_iter().collect();
        }
        // A patch that reaches the end of the candidates all round has no open pair next to it.
        for &k in &self.members {
            layers.entry(k).or_insert(usize::MAX);
        }
        layers
    }

    /// The square of the pressure at the trusted pairs (inside the `skipped` outer layers) and at
    /// their mirror images.
    ///
    /// A pair's pressure is a mean over the faces around it: along each axis it exceeds
    /// `p = sqrt(s)` by `h^2/12 p''` (the mean of `x^2` by a hat function is `h^2/6`),
    /// `p'' = s''/(2 p) - s'^2/(4 p^3)`, so that `s = p^2 + h^2 (s'^2/(24 p^2) - s''/12)`; `h^2` is
    /// the pair's area.
    fn believed(&self, layers: &BTreeMap<usize, usize>, skipped: usize) -> Cloud {
        let inner = layers.iter().filter(|(_, layer)| **layer > skipped);
        let known = |value: &dyn Fn(usize) -> f64| -> Vec<Known> {
            let images = |k: usize| {
                let value = value(k);
                self.mirrored(k)
                    .into_iter()
                    .map(move |at| Known { at, value })
            };
            inner.clone().flat_map(|(&k, _)| images(k)).collect()
        };
        let square = |k: usize| self.pressure[k].max(0.0).powi(2);
        let means = Cloud::new(known(&square));
        Cloud::new(known(&|k| {
            let mean = square(k);
            if layers[&k] > skipped + CORRECTED {
                return mean;
            }
            let area = self.area(k) * self.copies_of(k);
            means.fit(self.place(k), &[]).map_or(mean, |fit| {
                mean + area * (fit.slope().powi(2) / (24.0 * mean) - fit.laplacian() / 12.0)
            })
        }))
    }

    /// Number of mirror images of a pair's area, itself included, that lie around the pair.
    fn copies_of(&self, k: usize) -> f64 {
        let x = self.model.mesh.point(self.model.pairs[k].slave);
        let near = 2e-6 * self.model.pairs[k].area.sqrt();
        let stays = self
            .images
            .iter()
            .map(|image| length(difference(image.of(x), x)));
        stays.filter(|off| *off <= near).count() as f64
    }

    /// The moments of the patch if its edge lies halfway between closed and open pairs.
    fn moments_of_few(&self) -> Moments {
        let mut sums = PatchSums::default();
        for (face, corners) in self.member_faces() {
            let places = self.places(corners);
            let sign = |k: &usize| if self.members.contains(k) { 1.0 } else { -1.0 };
            let signs: Vec<f64> = corners.iter().map(sign).collect();
            match self.covered(face) {
                Some(parts) if signs.iter().all(|sign| *sign > 0.0) => {
                    sums.add_all(&parts);
                }
                _ => sums.add_corners(&places, &signs),
            }
        }
        self.with_images(&sums)
    }

    fn with_images(&self, sums: &PatchSums) -> Moments {
        let reflections = self.images.iter().filter_map(|image| image.reflection());
        let in_plane = |reflection: Reflection| {
            [0, 1].map(|i| {
                [0, 1].map(|j| {
                    let entry = dot(self.axes[i], reflection.of_direction(self.axes[j]));
                    entry * self.units[j] / self.units[i]
                })
            })
        };
        sums.moments(&reflections.map(in_plane).collect::<Vec<_>>())
    }

    /// Slivers next to a pair of the patch: pieces of faces with too few pairs of their own, with
    /// the pairs near them.
    fn slivers(&self) -> impl Iterator<Item = (&[usize], Vec<Polygon>)> {
        let slivers = self.topology.slivers.iter();
        let ours = slivers.filter(|(near, _)| near.iter().any(|k| self.members.contains(k)));
        ours.map(|(near, parts)| (near.as_slice(), self.in_plane(parts)))
    }
}
