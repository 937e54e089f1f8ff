//! Patches of contact between solids: area, centroid, half axes.
//!
//! Where bodies touch smoothly the square of the pressure falls to zero linearly at the edge. At the
//! last pairs that touch it is not believed (how they share their force depends on where in the face
//! the contact ends): there, and at the first open ones, it is what a polynomial through the pairs
//! further inside goes on to. The patch is where that is positive, cut out of the faces by straight
//! lines; half axes are those of the ellipse with the same moments of area
//!
//! ```text
//! A = int dA,   c = int x dA/A,   M = int (x - c)(x - c)' dA/A = Q diag(a^2, b^2)/4 Q'
//! ```
//!
//! Beyond a plane of symmetry the patch goes on as its mirror image.

mod fit;
mod moments;

use super::mirror::Mirror;
use crate::model::Model;
use crate::results::ContactPatch;
use crate::space::{Vector, along, cross, difference, direction, dot, unit};
use fit::{Fit, Known};
use moments::{Moments, Sums, mirror};
use std::collections::{BTreeMap, BTreeSet};

/// Layers of pairs at the edge whose pressures are not believed.
const SKIPPED: usize = 1;
/// Layers inside those whose pressures are corrected for being means.
const CORRECTED: usize = 3;

/// A patch with how it was read.
pub(super) struct ReadPatch {
    pub(super) patch: ContactPatch,
    /// How far another reading puts its smaller half axis off.
    pub(super) reading: f64,
    /// Closed pairs over the smaller half axis.
    pub(super) pairs: usize,
    /// Pressure at the centroid.
    pub(super) pole_pressure: f64,
}

/// The patches of all contacts, the strongest first; forces up to `vanishing` are none.
pub(super) fn patches(
    model: &Model,
    force: &[f64],
    pressure: &[f64],
    vanishing: f64,
) -> Vec<ReadPatch> {
    let mut out = Vec::new();
    for (contact, surface) in model.contacts.iter().enumerate() {
        let topology = Topology::new(surface.range.clone(), &surface.faces);
        let closed: BTreeSet<usize> = surface
            .range
            .clone()
            .filter(|&k| force[k] > vanishing)
            .collect();
        for members in topology.connected(&closed) {
            let shape = Shape::new(model, &topology, pressure, members);
            let moments = shape.moments(SKIPPED);
            let other = shape.moments(SKIPPED + 1);
            out.push(shape.read(contact, force, &moments, &other));
        }
    }
    out.sort_by(|a, b| b.patch.force.total_cmp(&a.patch.force));
    out
}

/// Which pairs of a contact share faces.
struct Topology<'m> {
    start: usize,
    faces: &'m [Vec<usize>],
    /// Faces at each pair.
    at: Vec<Vec<u32>>,
}

impl<'m> Topology<'m> {
    fn new(range: std::ops::Range<usize>, faces: &'m [Vec<usize>]) -> Self {
        let mut at = vec![Vec::new(); range.len()];
        for (face, corners) in faces.iter().enumerate() {
            for &k in corners {
                at[k - range.start].push(face as u32);
            }
        }
        Topology {
            start: range.start,
            faces,
            at,
        }
    }

    /// Pairs that share a face with a pair, itself included.
    fn around(&self, k: usize) -> impl Iterator<Item = usize> + '_ {
        let faces = self.at[k - self.start].iter();
        faces.flat_map(|&face| self.faces[face as usize].iter().copied())
    }

    /// The connected sets of some pairs.
    fn connected(&self, closed: &BTreeSet<usize>) -> Vec<BTreeSet<usize>> {
        let mut left = closed.clone();
        let mut out = Vec::new();
        while let Some(first) = left.pop_first() {
            let mut members = BTreeSet::from([first]);
            let mut edge = vec![first];
            while let Some(k) = edge.pop() {
                for other in self.around(k) {
                    if left.remove(&other) {
                        members.insert(other);
                        edge.push(other);
                    }
                }
            }
            out.push(members);
        }
        out
    }
}

/// A patch on the plane across its mean normal.
struct Shape<'a> {
    model: &'a Model,
    topology: &'a Topology<'a>,
    pressure: &'a [f64],
    members: BTreeSet<usize>,
    planes: Vec<Mirror>,
    origin: Vector,
    axes: [Vector; 2],
}

impl<'a> Shape<'a> {
    fn new(
        model: &'a Model,
        topology: &'a Topology<'a>,
        pressure: &'a [f64],
        members: BTreeSet<usize>,
    ) -> Self {
        let planes = Mirror::of_pairs(model, members.iter().copied());
        let mut normal = [0.0; 3];
        let mut origin = [0.0; 3];
        for &k in &members {
            let pair = &model.pairs[k];
            normal = along(normal, pair.area, pair.normal);
            origin = along(
                origin,
                1.0 / members.len() as f64,
                model.mesh.point(pair.second),
            );
        }
        for plane in &planes {
            origin = along(origin, -plane.beyond(origin), plane.normal());
            normal = along(normal, -dot(plane.normal(), normal), plane.normal());
        }
        let normal = direction(normal);
        let first = planes.first().map_or_else(
            || {
                let share = |d: &usize| normal[*d].abs();
                let axis = (0..3).min_by(|a, b| share(a).total_cmp(&share(b)));
                let axis = unit(axis.unwrap_or(0));
                direction(along(axis, -dot(axis, normal), normal))
            },
            |plane| plane.normal(),
        );
        Shape {
            model,
            topology,
            pressure,
            members,
            planes,
            origin,
            axes: [first, cross(normal, first)],
        }
    }

    fn place(&self, k: usize) -> [f64; 2] {
        let x = self.model.mesh.point(self.model.pairs[k].second);
        let from = difference(x, self.origin);
        self.axes.map(|axis| dot(axis, from))
    }

    /// Layer of each pair of the patch, counted from the open ones, and these with 0.
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
        // A patch that reaches the end of the candidates all round has no open pair beside it.
        for &k in &self.members {
            layers.entry(k).or_insert(usize::MAX);
        }
        layers
    }

    /// The square of the pressure at the pairs that are believed, and at their mirror images: those
    /// inside the `skipped` outer layers.
    ///
    /// A pair's pressure is a mean over the faces round it. Of `p = sqrt(s)` with a slope `g` of `s` it
    /// is `p + h^2/12 p''`, `p'' = -g^2/(4 s^1.5)` (the mean of `x^2` by a hat function is `h^2/6`), so
    /// that `s = p^2 + h^2 g^2/(24 p^2)`; `h^2` is the pair's area.
    fn believed(&self, layers: &BTreeMap<usize, usize>, skipped: usize) -> Vec<Known> {
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
        let means = known(&square);
        known(&|k| {
            let mean = square(k);
            if layers[&k] > skipped + CORRECTED {
                return mean;
            }
            let slope = Fit::new(&means, self.place(k)).map_or(0.0, |fit| fit.slope());
            let area = self.model.pairs[k].area * self.copies_of(k);
            mean + area * slope * slope / (24.0 * mean)
        })
    }

    /// How many images of a pair's area, its own included, lie round it.
    fn copies_of(&self, k: usize) -> f64 {
        let x = self.model.mesh.point(self.model.pairs[k].second);
        let on = |plane: &&Mirror| {
            let off = plane.beyond(x).abs();
            off <= 1e-6 * self.model.pairs[k].area.sqrt()
        };
        (1usize << self.planes.iter().filter(on).count()) as f64
    }

    /// The place of a pair and its mirror images.
    fn mirrored(&self, k: usize) -> Vec<[f64; 2]> {
        let size = self.model.pairs[k].area.sqrt();
        let mut images = vec![self.place(k)];
        for plane in &self.planes {
            let normal = self.axes.map(|axis| dot(axis, plane.normal()));
            // The origin lies on the plane.
            for i in 0..images.len() {
                let [x, y] = images[i];
                let beyond = -2.0 * (normal[0] * x + normal[1] * y);
                if beyond.abs() > 2e-6 * size {
                    images.push([x + beyond * normal[0], y + beyond * normal[1]]);
                }
            }
        }
        images
    }

    fn moments(&self, skipped: usize) -> Moments {
        let layers = self.layers();
        let believed = self.believed(&layers, skipped);
        let faces: BTreeSet<u32> = (self.members.iter())
            .flat_map(|&k| self.topology.at[k - self.topology.start].iter().copied())
            .collect();
        let mut sums = Sums::default();
        for face in faces {
            let corners = &self.topology.faces[face as usize];
            let places: Vec<[f64; 2]> = corners.iter().map(|k| self.place(*k)).collect();
            if corners.iter().all(|k| layers[k] > skipped) {
                sums.add_face(&places, |_| 1.0);
                continue;
            }
            let mean = |d: usize| places.iter().map(|x| x[d]).sum::<f64>() / places.len() as f64;
            let center = [mean(0), mean(1)];
            match Fit::new(&believed, center) {
                Some(fit) => {
                    // A pair that is open has no pressure: where the polynomial gives it some, it is
                    // made to vanish there.
                    let wrong = corners
                        .iter()
                        .filter(|k| !self.members.contains(k) && fit.value(self.place(**k)) > 0.0);
                    let zero = |&k: &usize| Known {
                        at: self.place(k),
                        value: 0.0,
                    };
                    let zeros: Vec<Known> = wrong.map(zero).collect();
                    let bounded = (!zeros.is_empty())
                        .then(|| Fit::new(&[believed.as_slice(), &zeros].concat(), center));
                    let fit = bounded.flatten().unwrap_or(fit);
                    sums.add_face(&places, |x| fit.value(x));
                }
                // Halfway between pairs that touch and pairs that do not.
                None => {
                    let sign = |k: &usize| if self.members.contains(k) { 1.0 } else { -1.0 };
                    let signs: Vec<f64> = corners.iter().map(sign).collect();
                    sums.add_corners(&places, &signs);
                }
            }
        }
        sums.moments(|center, second| {
            for plane in &self.planes {
                let n = self.axes.map(|axis| dot(axis, plane.normal()));
                mirror(n, center, second);
            }
        })
    }

    fn read(&self, contact: usize, force: &[f64], moments: &Moments, other: &Moments) -> ReadPatch {
        // A plane of symmetry of a model that is the whole is a wall.
        let copies = (1usize << self.planes.len()).min(self.model.scene.symmetry) as f64;
        let (semi_axes, major) = moments.axes();
        let closed = || self.members.iter().copied();
        // Pairs on a plane of symmetry carry their share of the whole's already halved.
        let total: f64 = closed().map(|k| force[k]).sum::<f64>() * copies;
        let area = moments.area * copies;
        let spacing = (moments.area / self.members.len().max(1) as f64).sqrt();
        let in_space =
            |[x, y]: [f64; 2], from: Vector| along(along(from, x, self.axes[0]), y, self.axes[1]);
        let pole_pressure = {
            let images = |k: usize| {
                let value = self.pressure[k];
                self.mirrored(k)
                    .into_iter()
                    .map(move |at| Known { at, value })
            };
            let known: Vec<Known> = closed().flat_map(images).collect();
            let off = |k: usize| {
                let x = self.place(k);
                (x[0] - moments.center[0]).hypot(x[1] - moments.center[1])
            };
            let nearest = closed().min_by(|&a, &b| off(a).total_cmp(&off(b)));
            match Fit::new(&known, moments.center) {
                Some(fit) => fit.value(moments.center),
                None => nearest.map_or(0.0, |k| self.pressure[k]),
            }
        };
        ReadPatch {
            patch: ContactPatch {
                contact,
                area,
                centroid: in_space(moments.center, self.origin),
                semi_axes,
                direction: in_space(major, [0.0; 3]),
                max_pressure: closed().map(|k| self.pressure[k]).fold(0.0, f64::max),
                mean_pressure: if area > 0.0 { total / area } else { 0.0 },
                force: total,
            },
            reading: (other.axes().0[1] - semi_axes[1]).abs(),
            pairs: (semi_axes[1] / spacing) as usize,
            pole_pressure,
        }
    }
}
