//! Families of meshes: the same source with larger or smaller elements.
//!
//! Within a family every element size is multiplied by one ratio, even where elements grow with the
//! distance. Only then does the error of a value follow a single power of the element size, so that
//! it can be extrapolated. A growth `g` from element to element becomes `g^ratio`. A bias `B` of
//! `n` elements, which is a growth of `B^(1/(n-1))`, becomes the bias of `m` elements with the same
//! sizes along the line, `B^(n (m-1) / (m (n-1)))`. The parts of a mesh are scaled together, so
//! surfaces that face each other node by node continue to do so. The members of a mesh from a file
//! are its subdivisions.

use crate::mesh::Shape;
use crate::number::significant;
use crate::scene::{
    Block, CurvedBodies, CylinderOnHalfPlane, DiscInPlate, LocalRefinement, MeshSource, Part,
};

/// Largest relative difference in element ratio between parts of a mesh that rounding to whole
/// elements may cause.
const DISTORTION: f64 = 0.1;
/// Largest factor between the wanted ratio and the ratio of a member in exact proportion; within
/// this factor the member is preferred to rounded counts.
const NEAR: f64 = 1.2;
/// Largest growth that the generators accept.
const MOST_GROWTH: f64 = 100.0;
/// Distance, in elements, up to which the end of a piece and a node count as coinciding.
const ON_NODE: f64 = 1e-6;
/// Largest step to whose multiples an element count is rounded. If no step below it fits, the step
/// is the count of the scene itself.
const LARGEST_STEP: usize = 1000;
/// Largest number of elements along a line of a member: more than any machine can hold.
const MOST_ELEMENTS: f64 = 1e9;

/// A source of meshes that differ in their element size alone.
pub trait Family {
    /// Makes the elements about `ratio` times as large, and returns the exact ratio of the nearest
    /// mesh of the family.
    ///
    /// # Errors
    /// A message in words if no mesh of the family is near the ratio; the source is then unchanged.
    fn resize(&mut self, ratio: f64) -> Result<f64, String>;

    /// Resolution of the mesh, in the words of a scene.
    fn words(&self) -> String;

    /// Shape of the elements; `None` if a file determines it.
    fn shape(&self) -> Option<Shape>;

    /// Sets the shape of the elements, unless a file determines it.
    fn set_shape(&mut self, shape: Shape);

    /// The member whose elements are closest to `ratio` times as large, and the exact ratio of this
    /// member.
    ///
    /// # Errors
    /// Errors of [`Family::resize`].
    fn member(&self, ratio: f64) -> Result<(Self, f64), String>
    where
        Self: Clone,
    {
        let mut out = self.clone();
        let ratio = out.resize(ratio)?;
        Ok((out, ratio))
    }
}

impl MeshSource {
    /// The generator of the mesh; `None` for a mesh from a file.
    fn generator(&self) -> Option<&dyn Family> {
        let pairs: [Option<&dyn Family>; 4] = [
            self.cylinder_on_half_plane.as_ref().map(|p| p as _),
            self.disc_in_plate.as_ref().map(|p| p as _),
            self.curved_bodies.as_ref().map(|p| p as _),
            self.parts.as_ref().map(|p| p as _),
        ];
        pairs.into_iter().flatten().next()
    }

    fn generator_mut(&mut self) -> Option<&mut dyn Family> {
        let pairs: [Option<&mut dyn Family>; 4] = [
            self.cylinder_on_half_plane.as_mut().map(|p| p as _),
            self.disc_in_plate.as_mut().map(|p| p as _),
            self.curved_bodies.as_mut().map(|p| p as _),
            self.parts.as_mut().map(|p| p as _),
        ];
        pairs.into_iter().flatten().next()
    }

    /// Divides the elements of a file as often as the ratio asks for.
    fn subdivide(&mut self, ratio: f64) -> Result<f64, String> {
        let halvings = -ratio.log2().round();
        let subdivisions = self.subdivisions as f64 + halvings;
        if !(0.0..=f64::from(u16::MAX)).contains(&subdivisions) {
            return Err("a mesh from a file has no coarser member than the file".to_string());
        }
        self.subdivisions = subdivisions as usize;
        Ok(0.5f64.powf(halvings))
    }
}

impl Family for MeshSource {
    fn resize(&mut self, ratio: f64) -> Result<f64, String> {
        let ratio = match self.generator_mut() {
            Some(generator) => generator.resize(ratio)?,
            None => self.subdivide(ratio)?,
        };
        // A swept solid keeps its elements' proportions along the sweep.
        if let Some(extrude) = &mut self.extrude {
            extrude.elements = scaled(extrude.elements, 1, ratio);
        }
        if let Some(revolve) = &mut self.revolve {
            let least = (revolve.angle / 90.0).ceil() as usize;
            revolve.elements = scaled(revolve.elements, 1, ratio).max(least);
        }
        Ok(ratio)
    }

    fn words(&self) -> String {
        let of_file = || format!("subdivisions {}", self.subdivisions);
        let mut out = self.generator().map_or_else(of_file, Family::words);
        for LocalRefinement {
            at: [x, y], times, ..
        } in &self.refine
        {
            let [x, y] = [x, y].map(|c| significant(*c, 3));
            out += &format!(", refined {times} times at ({x}, {y})");
        }
        out
    }

    fn shape(&self) -> Option<Shape> {
        self.generator()?.shape()
    }

    fn set_shape(&mut self, shape: Shape) {
        if let Some(generator) = self.generator_mut() {
            generator.set_shape(shape);
        }
    }
}

/// The number of elements when `n` elements are scaled by a ratio, rounded to a multiple of `step`.
fn scaled(n: usize, step: usize, ratio: f64) -> usize {
    let steps = (n as f64 / (ratio * step as f64)).round();
    (steps.clamp(1.0, MOST_ELEMENTS) as usize).saturating_mul(step)
}

/// The growth in a mesh whose elements are `ratio` times as large.
fn grown(growth: f64, ratio: f64) -> f64 {
    growth.powf(ratio).min(MOST_GROWTH)
}

/// A generator of meshes that are even near a contact and grow from there on.
trait GrowsFromContact {
    /// Number of which the resolution is a multiple.
    const STEP: usize;
    /// Resolution, growth, growth far away if it differs, and shape of the elements.
    fn settings(&self) -> (usize, f64, Option<f64>, Shape);
    fn settings_mut(&mut self) -> (&mut usize, &mut f64, Option<&mut f64>, &mut Shape);
}

macro_rules! grows_from_contact {
    ($generator:ty, $step:literal $(, $far_growth:ident)?) => {
        impl GrowsFromContact for $generator {
            const STEP: usize = $step;

            fn settings(&self) -> (usize, f64, Option<f64>, Shape) {
                let far = None$(.or(self.$far_growth))?;
                (self.resolution, self.growth, far, self.element)
            }

            fn settings_mut(&mut self) -> (&mut usize, &mut f64, Option<&mut f64>, &mut Shape) {
                let far = None$(.or(self.$far_growth.as_mut()))?;
                (&mut self.resolution, &mut self.growth, far, &mut self.element)
            }
        }
    };
}

grows_from_contact!(CylinderOnHalfPlane, 1, far_growth);
grows_from_contact!(DiscInPlate, 2, far_growth);
grows_from_contact!(CurvedBodies, 1);

impl<G: GrowsFromContact> Family for G {
    fn resize(&mut self, ratio: f64) -> Result<f64, String> {
        let (resolution, growth, far, _) = self.settings_mut();
        let before = *resolution;
        *resolution = scaled(before, G::STEP, ratio);
        let ratio = before as f64 / *resolution as f64;
        for growth in far.into_iter().chain([growth]) {
            *growth = grown(*growth, ratio);
        }
        Ok(ratio)
    }

    fn words(&self) -> String {
        let (resolution, growth, far, _) = self.settings();
        let far = far.map_or(String::new(), |g| format!(", far_growth {g:.4}"));
        format!("resolution {resolution}, growth {growth:.4}{far}")
    }

    fn shape(&self) -> Option<Shape> {
        Some(self.settings().3)
    }

    fn set_shape(&mut self, shape: Shape) {
        *self.settings_mut().3 = shape;
    }
}

impl Family for Vec<Part> {
    /// Scales in exact proportion if the element counts have a common divisor that allows it;
    /// otherwise each count is rounded.
    fn resize(&mut self, ratio: f64) -> Result<f64, String> {
        if let Some(part) = self.iter().find(|part| !ends_on_nodes(part, None)) {
            return Err(format!(
                "a piece of the block of `{}` does not begin and end at nodes of an even mesh, so \
                 that it would be longer or shorter on another; give counts for which it does, \
                 without bias along it",
                part.body
            ));
        }
        let exact = proportional(self, ratio);
        let is_near = |other: f64| (ratio / other).max(other / ratio) <= NEAR;
        let near = exact.as_ref().filter(|(_, exact)| is_near(*exact));
        let found = near.cloned().or_else(|| rounded(self, ratio)).or(exact);
        let (parts, ratio) = found.ok_or_else(|| {
            "its element counts have no common divisor and are too small to be rounded; give \
             counts that are multiples of 4"
                .to_string()
        })?;
        *self = parts;
        Ok(ratio)
    }

    fn words(&self) -> String {
        let counts = self.iter().map(|p| match (&p.block, &p.ring, &p.disc) {
            _ if p.brick.is_some() => {
                let counts: Vec<String> = counts(p).iter().map(usize::to_string).collect();
                counts.join(" x ")
            }
            (Some(b), _, _) => format!("{} x {}", b.elements[0], b.elements[1]),
            (_, Some(r), _) => format!("{} x {}", r.elements[0], r.elements[1]),
            (_, _, Some(d)) => d.elements.to_string(),
            _ => "?".to_string(),
        });
        format!("elements {}", counts.collect::<Vec<_>>().join(", "))
    }

    fn shape(&self) -> Option<Shape> {
        self.first().map(|part| part.element)
    }

    fn set_shape(&mut self, shape: Shape) {
        self.iter_mut().for_each(|part| part.element = shape);
    }
}

/// Multiplies all counts by one fraction, the one nearest to the wanted ratio for which all counts
/// are whole and the mesh can be made.
fn proportional(parts: &[Part], ratio: f64) -> Option<(Vec<Part>, f64)> {
    let divisor = parts
        .iter()
        .flat_map(counts)
        .fold(0, greatest_common_divisor);
    let wanted = (divisor as f64 / ratio).min(MOST_ELEMENTS);
    let nearest = wanted.round() as usize;
    let mut multiples: Vec<usize> = (nearest.saturating_sub(LARGEST_STEP)..=nearest + LARGEST_STEP)
        .filter(|m| *m > 0)
        .collect();
    let distance = |m: usize| (m as f64 / wanted).ln().abs();
    multiples.sort_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    let made = |m: usize| with_counts(parts, |n| n / divisor * m);
    let found = multiples.into_iter().find(|m| {
        let parity_fits = parts
            .iter()
            .zip(made(*m))
            .all(|(old, new)| is_alike(old, &new));
        parity_fits && made(*m).iter().all(|part| ends_on_nodes(part, None))
    })?;
    Some((made(found), divisor as f64 / found as f64))
}

/// Rounds each count by itself, equal counts alike; `None` if the ratios then differ by more than
/// [`DISTORTION`].
fn rounded(parts: &[Part], ratio: f64) -> Option<(Vec<Part>, f64)> {
    let new = |n: usize| scaled(n, step(parts, n), ratio);
    let out = with_counts(parts, new);
    let all = parts.iter().flat_map(counts);
    let ratios: Vec<(usize, f64)> = all.map(|n| (n, n as f64 / new(n) as f64)).collect();
    let (_, of_most) = *ratios.iter().max_by_key(|r| r.0)?;
    let is_alike = ratios
        .iter()
        .all(|(_, r)| (r / of_most - 1.0).abs() <= DISTORTION);
    let fits = is_alike && out.iter().all(|part| ends_on_nodes(part, None));
    fits.then_some((out, of_most))
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

/// All element counts of a part; for a block along x and y.
fn counts(part: &Part) -> Vec<usize> {
    let block = part.block.iter().flat_map(|b| b.elements);
    let ring = part.ring.iter().flat_map(|r| r.elements);
    let disc = part.disc.iter().map(|d| d.elements);
    let brick = part.brick.iter().flat_map(|b| b.elements);
    block.chain(ring).chain(disc).chain(brick).collect()
}

/// The parts with new counts; biases are changed so that sizes along the lines stay the same up to
/// one factor.
fn with_counts(parts: &[Part], new: impl Fn(usize) -> usize) -> Vec<Part> {
    let mut out = parts.to_vec();
    let biased = |n: usize, bias: &mut f64| {
        let m = new(n);
        if n > 1 && m > 1 {
            let [n, m] = [n as f64, m as f64];
            *bias = bias.powf(n * (m - 1.0) / (m * (n - 1.0)));
        }
        m
    };
    for part in &mut out {
        if let Some(block) = &mut part.block {
            for axis in 0..2 {
                block.elements[axis] = biased(block.elements[axis], &mut block.bias[axis]);
            }
        }
        if let Some(brick) = &mut part.brick {
            for axis in 0..3 {
                brick.elements[axis] = biased(brick.elements[axis], &mut brick.bias[axis]);
            }
        }
        if let Some(ring) = &mut part.ring {
            ring.elements = [
                biased(ring.elements[0], &mut ring.bias),
                new(ring.elements[1]),
            ];
        }
        if let Some(disc) = &mut part.disc {
            disc.elements = new(disc.elements);
        }
    }
    out
}

/// Whether the new counts that must be even are even: all counts of a disc, and counts of triangles
/// that were even, because their diagonals alternate.
fn is_alike(old: &Part, new: &Part) -> bool {
    let is_disc = old.disc.is_some();
    let alternates = |n: usize| old.element.n_corners() == 3 && n.is_multiple_of(2);
    let pairs = counts(old).into_iter().zip(counts(new));
    pairs
        .into_iter()
        .all(|(n, m)| !(is_disc || alternates(n)) || m.is_multiple_of(2))
}

/// The step of which a count of `n` elements must remain a multiple. The step is common to all
/// counts equal to `n`, because surfaces in contact face each other node by node.
fn step(parts: &[Part], n: usize) -> usize {
    let fits = |part: &Part, step: usize| {
        let is_disc = part.disc.as_ref().is_some_and(|d| d.elements == n);
        let alternates = part.element.n_corners() == 3 && n.is_multiple_of(2);
        let even = !(is_disc || alternates) || step.is_multiple_of(2);
        even && ends_on_nodes(part, Some((n, step)))
    };
    let mut steps = 1..n.min(LARGEST_STEP);
    steps
        .find(|&step| parts.iter().all(|part| fits(part, step)))
        .unwrap_or(n)
}

/// Whether every piece of a block's sides begins and ends at a node, so that it is as long as in
/// the scene. With `count = (n, m)` only sides of `n` elements are checked, as if they had `m`.
fn ends_on_nodes(part: &Part, count: Option<(usize, usize)>) -> bool {
    let Some(block) = &part.block else {
        return true;
    };
    block.pieces.iter().all(|piece| {
        let axis = usize::from(matches!(piece.side.as_str(), "left" | "right"));
        let n = match count {
            Some((of, n)) if block.elements[axis] == of => n,
            Some(_) => return true,
            None => block.elements[axis],
        };
        block.bias[axis] == 1.0
            && [piece.from, piece.to]
                .iter()
                .all(|end| is_node(block, axis, n, *end))
    })
}

fn is_node(block: &Block, axis: usize, n: usize, at: f64) -> bool {
    let [from, to] = if axis == 0 { block.x } else { block.y };
    let at = (at - from) / (to - from) * n as f64;
    (at - at.round()).abs() < ON_NODE
}

#[cfg(test)]
mod tests;
