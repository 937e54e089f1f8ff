//! A patch projected on the plane across its mean normal: coordinates, moments and figures.

use super::fit::{Cloud, Known};
use super::moments::{Moments, PatchSums, Polygon};
use super::topology::Topology;
use crate::model::images::Images;
use crate::model::mirror::Mirror;
use crate::model::{ContactSurface, Model};
use crate::results::ContactPatch;
use crate::space::{Vector, along, cross, difference, direction, dot, length, unit};
use std::collections::BTreeSet;

/// Length of the mean normal relative to the area below which a patch closes round a body:
/// round-off.
const CLOSED: f64 = 1e-6;

/// A patch, with information on how it was read.
pub(in crate::analysis::figures) struct ReadPatch {
    pub(in crate::analysis::figures) patch: ContactPatch,
    /// Error of the smaller half axis, estimated from a second reading.
    pub(in crate::analysis::figures) reading: f64,
    /// Number of closed pairs along the half axis that has fewer of them.
    pub(in crate::analysis::figures) pairs: usize,
    /// Pressure at the centroid of the patch.
    pub(in crate::analysis::figures) pole_pressure: f64,
}

/// A unit vector perpendicular to a normal.
fn across(normal: Vector) -> Vector {
    let share = |d: &usize| normal[*d].abs();
    let axis = (0..3).min_by(|a, b| share(a).total_cmp(&share(b)));
    let axis = unit(axis.unwrap_or(0));
    direction(along(axis, -dot(axis, normal), normal))
}

pub(super) fn middle(places: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|d| places.iter().map(|x| x[d]).sum::<f64>() / places.len() as f64)
}

/// A patch projected on the plane across its mean normal.
pub(super) struct ProjectedPatch<'a> {
    pub(super) model: &'a Model,
    pub(super) topology: &'a Topology<'a>,
    pub(super) pressure: &'a [f64],
    pub(super) members: BTreeSet<usize>,
    pub(super) planes: Vec<Mirror>,
    pub(super) images: Images,
    /// Planes of symmetry opposite to one of `planes`.
    pub(super) opposite: Vec<Mirror>,
    /// Distance between the planes of symmetry at the two ends of the patch, and the direction
    /// across them; `None` unless the patch ends on both.
    pub(super) endless: Option<(f64, Vector)>,
    /// Whether the patch closes round a body.
    pub(super) closes: bool,
    pub(super) origin: Vector,
    pub(super) axes: [Vector; 2],
    /// The unit of each coordinate: the spacing of the pairs.
    pub(super) units: [f64; 2],
}

impl<'a> ProjectedPatch<'a> {
    pub(super) fn new(
        model: &'a Model,
        (surface, topology): (&'a ContactSurface, &'a Topology<'a>),
        pressure: &'a [f64],
        members: BTreeSet<usize>,
    ) -> Self {
        let ends_on = |plane: &&Mirror| {
            let mut places = members
                .iter()
                .map(|&k| model.mesh.point(model.pairs[k].slave));
            places.any(|x| plane.holds(x, surface.facet_length))
        };
        let ends = surface.mirrors.iter().filter(ends_on);
        let (planes, opposite) = Images::planes(ends.copied());
        let images = Images::of(&planes);
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
        let (origin, normal) = (images.mean(origin), images.mean_direction(normal));
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
                // Planes at right angles have another direction and contribute nothing.
                let parallel = dot(other.normal(), plane.normal()).abs().round();
                parallel
                    * plane
                        .beyond(along(origin, -other.beyond(origin), other.normal()))
                        .abs()
            });
            (between.fold(0.0, f64::max), plane.normal())
        });
        let mut shape = ProjectedPatch {
            model,
            topology,
            pressure,
            members,
            planes,
            images,
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

    /// Turns the axes into the principal directions of the pairs' places, unless planes of symmetry
    /// give the axes, and takes the spacing of the pairs along the axes as units.
    pub(super) fn measure(&mut self) {
        if self.planes.is_empty() {
            let mut sums = PatchSums::default();
            self.member_faces().for_each(|(_, corners)| {
                sums.add_parts(&[self.places(corners)], |_| 1.0);
            });
            let (_, [x, y]) = sums.moments(&[]).axes();
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
        let first = |plane: &Mirror| dot(plane.normal(), self.planes[0].normal()).abs();
        if self.planes.iter().skip(1).any(|plane| first(plane) > 1e-6) {
            // In a sector that fills the turn with its images, no axis is distinguished.
            self.units = [0.5 * (self.units[0] + self.units[1]); 2];
        }
    }

    /// The faces at the closed pairs of the patch, by number and corners.
    pub(super) fn member_faces(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let faces: BTreeSet<u32> = (self.members.iter())
            .flat_map(|&k| self.topology.at[k - self.topology.start].iter().copied())
            .collect();
        faces
            .into_iter()
            .map(|face| (face as usize, self.topology.faces[face as usize].as_slice()))
    }

    /// The covered parts of a face; `None` if the whole face is covered.
    pub(super) fn covered(&self, face: usize) -> Option<Vec<Polygon>> {
        let parts = self.topology.covered.get(&face)?;
        Some(self.in_plane(parts))
    }

    pub(super) fn in_plane(&self, parts: &[Vec<Vector>]) -> Vec<Polygon> {
        let places = |part: &Vec<Vector>| part.iter().map(|&x| self.place_of(x)).collect();
        parts.iter().map(places).collect()
    }

    pub(super) fn places(&self, pairs: &[usize]) -> Polygon {
        pairs.iter().map(|k| self.place(*k)).collect()
    }

    pub(super) fn place(&self, k: usize) -> [f64; 2] {
        self.place_of(self.model.mesh.point(self.model.pairs[k].slave))
    }

    pub(super) fn place_of(&self, x: Vector) -> [f64; 2] {
        let from = difference(x, self.origin);
        [0, 1].map(|d| dot(self.axes[d], from) / self.units[d])
    }

    /// Area of a pair in the coordinates of the patch.
    pub(super) fn area(&self, k: usize) -> f64 {
        self.model.pairs[k].area / (self.units[0] * self.units[1])
    }

    /// The places of a pair and of its mirror images.
    pub(super) fn mirrored(&self, k: usize) -> Vec<[f64; 2]> {
        let pair = &self.model.pairs[k];
        let near = 1e-6 * pair.area.sqrt();
        let x = self.model.mesh.point(pair.slave);
        let mut images: Vec<Vector> = Vec::new();
        for image in self.images.iter().map(|image| image.of(x)) {
            if images
                .iter()
                .all(|other| length(difference(image, *other)) > 2.0 * near)
            {
                images.push(image);
            }
        }
        for plane in &self.opposite {
            for i in 0..images.len() {
                if plane.beyond(images[i]).abs() > near {
                    images.push(plane.image(images[i]));
                }
            }
        }
        images.into_iter().map(|x| self.place_of(x)).collect()
    }

    /// Number of mirror images, including the model's part, that make up the whole, limited to the
    /// symmetry that the scene declares, if any. For an endless strip only images across its width
    /// count.
    pub(super) fn copies(&self) -> f64 {
        let images = self.images.count();
        let copies = match self.model.symmetry as usize {
            1 if self.endless.is_some() => images / 2,
            1 => images,
            declared => images.min(declared),
        };
        copies as f64
    }

    /// Half axes of the patch, the larger first.
    pub(super) fn semi_axes(&self, moments: &Moments) -> [f64; 2] {
        let Some((length, _)) = self.endless else {
            return moments.axes().0;
        };
        // Planes across the width divide the model's share of it into halves.
        let halves = (1usize << (self.planes.len() - 1)) as f64;
        [f64::INFINITY, 0.5 * halves * moments.area / length]
    }

    pub(super) fn read(
        &self,
        contact: usize,
        force: &[f64],
        moments: Moments,
        other: Option<Moments>,
    ) -> ReadPatch {
        let copies = self.copies();
        let in_space =
            |[x, y]: [f64; 2], from: Vector| along(along(from, x, self.axes[0]), y, self.axes[1]);
        let pole = moments.center;
        // The number of pairs is rounded, since it depends on where in an element the edge is read.
        let layers = moments.axes().0[1];
        let closed = || self.members.iter().copied();
        let scaled = |moments: Moments| {
            let scaled = moments.scaled(self.units);
            match self.closes {
                true => scaled.with_area(closed().map(|k| self.model.pairs[k].area).sum()),
                false => scaled,
            }
        };
        let (moments, other) = (scaled(moments), other.map(scaled));
        let (_, major) = moments.axes();
        let mut direction = in_space(major, [0.0; 3]);
        if let Some((_, along)) = self.endless {
            direction = along;
        }
        let semi_axes = self.semi_axes(&moments);
        let off = other.map_or(0.5 * semi_axes[1] / layers.max(1.0), |other| {
            (self.semi_axes(&other)[1] - semi_axes[1]).abs()
        });
        // Pairs on a plane of symmetry carry only their share of the force: already halved.
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
            let away = |k: usize| {
                let x = self.place(k);
                (x[0] - pole[0]).hypot(x[1] - pole[1])
            };
            let nearest = closed().min_by(|&a, &b| away(a).total_cmp(&away(b)));
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
            reading: off,
            pairs: layers.round() as usize,
            pole_pressure,
        }
    }
}
