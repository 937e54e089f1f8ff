//! Patches of contact between solids: area, centroid, half axes.
//!
//! Where bodies touch smoothly the square of the pressure falls to zero linearly at the edge. At
//! the last pairs that touch it is not believed (how they share their force depends on where in the
//! face the contact ends): there, and at the first open ones, it is what a polynomial through the
//! pairs further inside goes on to. The patch is where that is positive, cut out of the faces by
//! straight lines; half axes are those of the ellipse with the same moments of area
//!
//! ```text
//! A = int dA,   c = int x dA/A,   M = int (x - c)(x - c)' dA/A = Q diag(a^2, b^2)/4 Q'
//! ```
//!
//! Where the other body covers only part of a face, only that part counts.
//!
//! Beyond a plane of symmetry the patch goes on as its mirror image. A patch between two parallel
//! planes of symmetry is a strip without end: its larger half axis is infinite, the smaller one
//! half its width. A patch that closes round a body, as in a press fit, has no mean normal: its
//! area is that of its surface, and its half axes are those of what is seen of it from one side.
//!
//! All of this is done in coordinates along the patch's principal axes, each over the spacing of
//! the pairs along it: oblong faces are squares there, and as many of them lie near along both
//! axes.

mod fit;
mod moments;
mod topology;

use super::mirror::Mirror;
use crate::model::Model;
use crate::results::ContactPatch;
use crate::space::{Vector, along, cross, difference, direction, dot, length, unit};
use fit::{Cloud, Known};
use moments::{Moments, Sums, mirror};
use std::collections::{BTreeMap, BTreeSet};
use topology::Topology;

/// Layers of pairs at the edge whose pressures are not believed.
const SKIPPED: usize = 1;
/// Layers inside those whose pressures are corrected for being means.
const CORRECTED: usize = 3;
/// Mean normal, as a share of the area's, below which a patch closes round a body: round-off.
const CLOSED: f64 = 1e-6;

/// Share of the difference between readings that do not believe [`SKIPPED`] layers and one more
/// that is the error of the former. The pressures' square goes on by a quadratic over so many
/// spacings and a half, and what that leaves out grows with the cube of the way:
/// `1.5^3/(2.5^3 - 1.5^3)`.
const REMAINDER: f64 = 3.375 / (15.625 - 3.375);

/// A patch with how it was read.
pub(super) struct ReadPatch {
    pub(super) patch: ContactPatch,
    /// What its smaller half axis may be off by, from another reading.
    pub(super) reading: f64,
    /// Closed pairs over that half axis over which fewer lie.
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
        let topology = Topology::new(surface);
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

/// A unit vector across another.
fn across(normal: Vector) -> Vector {
    let share = |d: &usize| normal[*d].abs();
    let axis = (0..3).min_by(|a, b| share(a).total_cmp(&share(b)));
    let axis = unit(axis.unwrap_or(0));
    direction(along(axis, -dot(axis, normal), normal))
}

/// A patch on the plane across its mean normal.
struct Shape<'a> {
    model: &'a Model,
    topology: &'a Topology<'a>,
    pressure: &'a [f64],
    members: BTreeSet<usize>,
    planes: Vec<Mirror>,
    /// Those opposite to one of the planes.
    opposite: Vec<Mirror>,
    /// Distance between the planes of symmetry at its two ends and the direction across them, where
    /// it has both.
    endless: Option<(f64, Vector)>,
    /// Whether the patch closes round a body.
    closes: bool,
    origin: Vector,
    axes: [Vector; 2],
    /// The unit of each coordinate.
    units: [f64; 2],
}

impl<'a> Shape<'a> {
    fn new(
        model: &'a Model,
        topology: &'a Topology<'a>,
        pressure: &'a [f64],
        members: BTreeSet<usize>,
    ) -> Self {
        let (planes, opposite) = Mirror::of_pairs(model, members.iter().copied());
        let mut normal = [0.0; 3];
        let mut origin = [0.0; 3];
        let mut area = 0.0;
        for &k in &members {
            let pair = &model.pairs[k];
            area += pair.area;
            normal = along(normal, pair.area, pair.normal);
            origin = along(
                origin,
                1.0 / members.len() as f64,
                model.mesh.point(pair.slave),
            );
        }
        for plane in &planes {
            origin = along(origin, -plane.beyond(origin), plane.normal());
            normal = along(normal, -dot(plane.normal(), normal), plane.normal());
        }
        let closes = length(normal) <= CLOSED * area;
        let normal = match &planes[..] {
            _ if !closes => direction(normal),
            [] => unit(2),
            [one] => across(one.normal()),
            [one, two, ..] => direction(cross(one.normal(), two.normal())),
        };
        let first = planes
            .first()
            .map_or_else(|| across(normal), |plane| plane.normal());
        let endless = opposite.first().map(|plane| {
            let between = planes.iter().map(|other| {
                // Those at right angles differ in direction, and count nothing.
                let parallel = dot(other.normal(), plane.normal()).abs().round();
                parallel
                    * plane
                        .beyond(along(origin, -other.beyond(origin), other.normal()))
                        .abs()
            });
            (between.fold(0.0, f64::max), plane.normal())
        });
        let mut shape = Shape {
            model,
            topology,
            pressure,
            members,
            planes,
            opposite,
            endless,
            closes,
            origin,
            axes: [first, cross(normal, first)],
            units: [1.0; 2],
        };
        shape.measure();
        shape
    }

    /// Turns the axes along the principal ones of the pairs' places, unless planes of symmetry give
    /// them, and takes the spacing of the pairs along them as units.
    fn measure(&mut self) {
        if self.planes.is_empty() {
            let mut sums = Sums::default();
            self.member_faces().for_each(|(_, corners)| {
                let places: Vec<[f64; 2]> = corners.iter().map(|k| self.place(*k)).collect();
                sums.add_face(&places, |_| 1.0);
            });
            let (_, [x, y]) = sums.moments(|_, _| ()).axes();
            let [a, b] = self.axes;
            self.axes = [
                along(along([0.0; 3], x, a), y, b),
                along(along([0.0; 3], -y, a), x, b),
            ];
        }
        let (mut faces, mut extents) = (0.0, [0.0; 2]);
        for (_, corners) in self.member_faces() {
            let places = || corners.iter().map(|k| self.place(*k));
            faces += 1.0;
            for (d, extent) in extents.iter_mut().enumerate() {
                let low = places().map(|x| x[d]).fold(f64::INFINITY, f64::min);
                *extent += places().map(|x| x[d] - low).fold(0.0, f64::max);
            }
        }
        self.units = extents.map(|extent| extent / faces);
    }

    /// The faces at the pairs that touch, by number and corners.
    fn member_faces(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let faces: BTreeSet<u32> = (self.members.iter())
            .flat_map(|&k| self.topology.at[k - self.topology.start].iter().copied())
            .collect();
        faces
            .into_iter()
            .map(|face| (face as usize, self.topology.faces[face as usize].as_slice()))
    }

    /// What is covered of a face, where that is not all.
    fn covered(&self, face: usize) -> Option<Vec<Vec<[f64; 2]>>> {
        let parts = self.topology.covered.get(&face)?;
        Some(self.in_plane(parts))
    }

    fn in_plane(&self, parts: &[Vec<Vector>]) -> Vec<Vec<[f64; 2]>> {
        let places = |part: &Vec<Vector>| part.iter().map(|&x| self.place_of(x)).collect();
        parts.iter().map(places).collect()
    }

    fn place(&self, k: usize) -> [f64; 2] {
        self.place_of(self.model.mesh.point(self.model.pairs[k].slave))
    }

    fn place_of(&self, x: Vector) -> [f64; 2] {
        let from = difference(x, self.origin);
        [0, 1].map(|d| dot(self.axes[d], from) / self.units[d])
    }

    /// A pair's area in these coordinates.
    fn area(&self, k: usize) -> f64 {
        self.model.pairs[k].area / (self.units[0] * self.units[1])
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
    /// A pair's pressure is a mean over the faces round it: along each axis it exceeds
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

    /// How many images of a pair's area, its own included, lie round it.
    fn copies_of(&self, k: usize) -> f64 {
        let x = self.model.mesh.point(self.model.pairs[k].slave);
        let on = |plane: &&Mirror| {
            let off = plane.beyond(x).abs();
            off <= 1e-6 * self.model.pairs[k].area.sqrt()
        };
        (1usize << self.planes.iter().filter(on).count()) as f64
    }

    /// The place of a pair and its mirror images.
    fn mirrored(&self, k: usize) -> Vec<[f64; 2]> {
        let pair = &self.model.pairs[k];
        let near = 1e-6 * pair.area.sqrt();
        let mut images = vec![self.model.mesh.point(pair.slave)];
        for plane in self.planes.iter().chain(&self.opposite) {
            for i in 0..images.len() {
                if plane.beyond(images[i]).abs() > near {
                    images.push(plane.image(images[i]));
                }
            }
        }
        images.into_iter().map(|x| self.place_of(x)).collect()
    }

    fn moments(&self, skipped: usize) -> Moments {
        let layers = self.layers();
        let believed = self.believed(&layers, skipped);
        let mut sums = Sums::default();
        for (face, corners) in self.member_faces() {
            let places: Vec<[f64; 2]> = corners.iter().map(|k| self.place(*k)).collect();
            let parts = self.covered(face);
            if corners.iter().all(|k| layers[k] > skipped) {
                sums.add_parts(parts.as_deref().unwrap_or(&[places]), |_| 1.0);
                continue;
            }
            let mean = |d: usize| places.iter().map(|x| x[d]).sum::<f64>() / places.len() as f64;
            let center = [mean(0), mean(1)];
            match believed.fit(center, &[]) {
                Some(fit) => {
                    // A pair that is open has no pressure: where the polynomial gives it some, it
                    // is made to vanish there.
                    let wrong = corners
                        .iter()
                        .filter(|k| !self.members.contains(k) && fit.value(self.place(**k)) > 0.0);
                    let zero = |&k: &usize| Known {
                        at: self.place(k),
                        value: 0.0,
                    };
                    let zeros: Vec<Known> = wrong.map(zero).collect();
                    let bounded = (!zeros.is_empty()).then(|| believed.fit(center, &zeros));
                    let fit = bounded.flatten().unwrap_or(fit);
                    sums.add_parts(parts.as_deref().unwrap_or(&[places]), |x| fit.value(x));
                }
                // Halfway between pairs that touch and pairs that do not.
                None => {
                    let sign = |k: &usize| if self.members.contains(k) { 1.0 } else { -1.0 };
                    let signs: Vec<f64> = corners.iter().map(sign).collect();
                    sums.add_corners(&places, &signs);
                }
            }
        }
        for (near, parts) in self.topology.slivers {
            if near.iter().any(|k| self.members.contains(k)) {
                let parts = self.in_plane(parts);
                let mean = |d: usize| {
                    let sum: f64 = near.iter().map(|k| self.place(*k)[d]).sum();
                    sum / near.len() as f64
                };
                let is_believed = |k: &usize| layers.get(k).is_some_and(|l| *l > skipped);
                if near.iter().all(is_believed) {
                    sums.add_parts(&parts, |_| 1.0);
                } else if let Some(fit) = believed.fit([mean(0), mean(1)], &[]) {
                    sums.add_parts(&parts, |x| fit.value(x));
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
        let in_space =
            |[x, y]: [f64; 2], from: Vector| along(along(from, x, self.axes[0]), y, self.axes[1]);
        let pole = moments.center;
        // An element more or less follows from where in it the edge is read.
        let pairs = moments.axes().0[1].round() as usize;
        let closed = || self.members.iter().copied();
        let [moments, other] = [moments, other].map(|moments| {
            let scaled = moments.scaled(self.units);
            match self.closes {
                true => scaled.with_area(closed().map(|k| self.model.pairs[k].area).sum()),
                false => scaled,
            }
        });
        let (mut semi_axes, major) = moments.axes();
        let mut direction = in_space(major, [0.0; 3]);
        let mut other_axis = other.axes().0[1];
        if let Some((length, along)) = self.endless {
            direction = along;
            // Planes across the width halve the model's share of it.
            let halves = (1usize << (self.planes.len() - 1)) as f64;
            semi_axes = [f64::INFINITY, 0.5 * halves * moments.area / length];
            other_axis = 0.5 * halves * other.area / length;
        }
        // Pairs on a plane of symmetry carry their share of the whole's already halved.
        let total: f64 = closed().map(|k| force[k]).sum::<f64>() * copies;
        let area = moments.area * copies;
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
                (x[0] - pole[0]).hypot(x[1] - pole[1])
            };
            let nearest = closed().min_by(|&a, &b| off(a).total_cmp(&off(b)));
            match Cloud::new(known).fit(pole, &[]) {
                Some(fit) => fit.value(pole),
                None => nearest.map_or(0.0, |k| self.pressure[k]),
            }
        };
        ReadPatch {
            patch: ContactPatch {
                contact,
                area,
                centroid: in_space(moments.center, self.origin),
                semi_axes,
                direction,
                max_pressure: closed().map(|k| self.pressure[k]).fold(0.0, f64::max),
                mean_pressure: if area > 0.0 { total / area } else { 0.0 },
                force: total,
            },
            reading: REMAINDER * (other_axis - semi_axes[1]).abs(),
            pairs,
            pole_pressure,
        }
    }
}
