//! A roller between two raceways: the half model (x >= 0) of its cross-section.
//!
//! The roller has a square core, from whose sides grid lines run to the circle. The mesh is fine at
//! the bottom and at the top, where the raceways are. Grid lines of the rings meet those of the
//! roller, so contact nodes face each other.

use super::grading::{Growth, even, even_then_grown};
use super::grid::{BodyBuilder, Side, empty_mesh};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Shape};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Name of the generator in messages.
const KEY: &str = "roller between raceways";
/// Ratio of neighbouring element sizes away from the contacts.
const GROWTH: f64 = 1.15;
/// Half the side of the square core divided by the roller's radius.
const CORE: f64 = 0.5;
/// Ratio of the depth to which elements are even below a contact to the length over which they are
/// even along it.
const DEPTH: f64 = 0.8;

/// Dimensions of a roller between two raceways. The roller's centre is the origin; the inner ring
/// lies below the roller.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raceways {
    /// Radius of the roller.
    pub roller: f64,
    /// Radius of the inner raceway, which is convex.
    pub inner: f64,
    /// Radius of the outer raceway, which is concave.
    pub outer: f64,
    /// Thickness of both rings.
    pub thickness: f64,
    /// Size of the elements at the contacts.
    pub size: f64,
    /// Distance from the middle of each contact over which elements have this size.
    pub reach: f64,
}

/// A ring: its raceway, and the side of the raceway on which the ring lies.
struct RacewayRing {
    name: &'static str,
    radius: f64,
    /// Height of the raceway's centre.
    center: f64,
    /// 1 if the ring lies outside its raceway, -1 if inside.
    out: f64,
    /// Name of the surface that faces away from the raceway.
    back: &'static str,
}

impl Raceways {
    /// Heights of the centres of the inner and the outer raceway.
    pub fn centers(&self) -> [f64; 2] {
        [-self.roller - self.inner, self.roller - self.outer]
    }

    /// Generates the mesh with bodies `roller`, `inner` and `outer`; surfaces `roller.inner`,
    /// `roller.outer`, `inner.raceway`, `outer.raceway`, `inner.bore`, `outer.seat`, and `symmetry`
    /// of each body.
    ///
    /// # Errors
    /// `Input` if the radii contradict each other, or if elements are too small to be told apart.
    pub fn mesh(&self, shape: Shape) -> Result<Mesh> {
        let wrong = |text: &str| Err(Error::input(format!("{KEY}: {text}")));
        if self.outer <= self.roller {
            return wrong("the outer raceway's radius must be greater than the roller's");
        }
        if self.thickness >= self.inner {
            return wrong("the rings must be thinner than the radius of the inner raceway");
        }
        if self.inner <= self.roller * FRAC_PI_4.sin() {
            return wrong("the inner raceway's radius must be greater than 0.71 of the roller's");
        }
        let mut mesh = empty_mesh();
        let along = self.graded(self.reach, self.roller * FRAC_PI_4)?;
        self.add_roller(&mut mesh, shape, &along)?;
        let [below, above] = self.centers();
        for ring in [
            RacewayRing {
                name: "inner",
                radius: self.inner,
                center: below,
                out: -1.0,
                back: "bore",
            },
            RacewayRing {
                name: "outer",
                radius: self.outer,
                center: above,
                out: 1.0,
                back: "seat",
            },
        ] {
            self.add_ring(&mut mesh, shape, &along, &ring)?;
        }
        Ok(mesh)
    }

    /// Positions by half steps, evenly spaced up to about `until`, then growing up to `end`.
    fn graded(&self, until: f64, end: f64) -> Result<Vec<f64>> {
        let n = (until.min(end) / self.size).ceil().max(1.0);
        if until + self.size >= end {
            return even(KEY, 0.0, end, (end / self.size).ceil().max(1.0) as usize);
        }
        let growth = Growth::new(GROWTH, None, 0.0);
        even_then_grown(KEY, self.size, n as usize, end, growth)
    }

    fn add_roller(&self, mesh: &mut Mesh, shape: Shape, along: &[f64]) -> Result<()> {
        let radius = self.roller;
        let core = CORE * radius;
        let depths = self.graded(DEPTH * self.reach, radius - core)?;
        let (nx, nd) = (along.len() - 1, depths.len() - 1);
        // Rows of elements about as long as the innermost layer is thick.
        let innermost = depths[nd] - depths[nd - 2];
        let rows = (2.0 * core / innermost).ceil().max(4.0) as usize;
        let x = |i: usize| core * along[i] / along[nx];
        let y = even(KEY, -core, core, rows)?;
        // A point between the square core and the circle, by half steps from the square outwards.
        let line = |square: [f64; 2], circle: [f64; 2], j: usize| {
            let t = 1.0 - depths[nd - j] / depths[nd];
            [0, 1].map(|d| match j {
                0 => square[d],
                j if j == nd => circle[d],
                _ => square[d] + t * (circle[d] - square[d]),
            })
        };
        let pole = |i: usize, up: f64| {
            let angle = along[i] / radius;
            [radius * angle.sin(), up * radius * angle.cos()]
        };
        let mut body = BodyBuilder::new(mesh, "roller", shape);
        let middle = body.patch([nx / 2, rows], false, |i, k| [x(i), y[k]], |_, _| None);
        let n_rows = 2 * rows;
        let bottom = body.patch(
            [nx / 2, nd / 2],
            false,
            |i, j| line([x(i), -core], pole(i, -1.0), nd - j),
            |i, j| (j == nd).then(|| middle.node(i, 0)),
        );
        let top = body.patch(
            [nx / 2, nd / 2],
            false,
            |i, j| line([x(i), core], pole(i, 1.0), j),
            |i, j| (j == 0).then(|| middle.node(i, n_rows)),
        );
        body.patch(
            [nd / 2, rows],
            false,
            |j, k| {
                let angle = FRAC_PI_4 * y[k] / core;
                let circle = [radius * angle.cos(), radius * angle.sin()];
                line([core, y[k]], circle, j)
            },
            |j, k| match (j, k) {
                (0, k) => Some(middle.node(nx, k)),
                (j, 0) => Some(bottom.node(nx, nd - j)),
                (j, k) if k == n_rows => Some(top.node(nx, j)),
                _ => None,
            },
        );
        let sides = [&bottom, &middle, &top].map(|patch| patch.side(Side::Left));
        body.surface("symmetry", sides.concat(), None)?;
        body.surface("inner", bottom.side(Side::Bottom), None)?;
        body.surface("outer", top.side(Side::Top), None)
    }

    fn add_ring(
        &self,
        mesh: &mut Mesh,
        shape: Shape,
        along: &[f64],
        ring: &RacewayRing,
    ) -> Result<()> {
        let angle = |arc: &f64| (self.roller * (arc / self.roller).sin() / ring.radius).asin();
        let mut angles: Vec<f64> = along.iter().map(angle).collect();
        let facing = angles.len() - 1;
        // Beyond the part that faces the roller, the ring continues by a length equal to its
        // thickness.
        let from = angles[facing];
        let end = (from + self.thickness / ring.radius).min(FRAC_PI_2);
        let more = ((end - from) / (from - angles[facing - 2])).ceil().max(1.0);
        angles.extend(&even(KEY, from, end, more as usize)?[1..]);
        let depths = self.graded(DEPTH * self.reach, self.thickness)?;
        let last = depths.len() - 1;
        // The second index increases with the distance from the raceway's centre, for both rings.
        let depth = |j: usize| match ring.out > 0.0 {
            true => depths[j],
            false => -depths[last - j],
        };
        let mut body = BodyBuilder::new(mesh, ring.name, shape);
        let grid = body.patch(
            [(angles.len() - 1) / 2, last / 2],
            false,
            |i, j| {
                let (sin, cos) = angles[i].sin_cos();
                let r = ring.radius + depth(j);
                [r * sin, ring.center + r * cos]
            },
            |_, _| None,
        );
        let [raceway, back] = match ring.out > 0.0 {
            true => [Side::Bottom, Side::Top],
            false => [Side::Top, Side::Bottom],
        };
        body.surface("raceway", grid.side_range(raceway, 0..facing / 2), None)?;
        body.surface(ring.back, grid.side(back), None)?;
        body.surface("symmetry", grid.side(Side::Left), None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::validate;

    const BEARING: Raceways = Raceways {
        roller: 5.0,
        inner: 20.0,
        outer: 30.0,
        thickness: 5.0,
        size: 0.01,
        reach: 0.1,
    };

    /// Nodes of both contacts face each other on their circles, and nothing but the section is
    /// meshed.
    #[test]
    fn rings_face_the_roller_node_by_node() {
        for shape in [Shape::Quad4, Shape::Quad8, Shape::Tri6] {
            let mesh = BEARING.mesh(shape).unwrap();
            validate(&mesh).unwrap();
            let [below, above] = BEARING.centers();
            for (roller, ring, center, radius) in [
                ("roller.inner", "inner.raceway", below, 20.0),
                ("roller.outer", "outer.raceway", above, 30.0),
            ] {
                let [own, others] = [roller, ring].map(|name| mesh.set_nodes(name).unwrap());
                assert_eq!(own.len(), others.len());
                let sorted = |nodes: &[usize]| {
                    let mut x: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.in_plane(n)).collect();
                    x.sort_by(|a, b| a[0].total_cmp(&b[0]));
                    x
                };
                for (a, b) in sorted(&own).iter().zip(sorted(&others)) {
                    assert!((a[0] - b[0]).abs() < 1e-12, "{a:?} {b:?}");
                    assert!((a[0].hypot(a[1]) - 5.0).abs() < 1e-12);
                    assert!((b[0].hypot(b[1] - center) - radius).abs() < 1e-12);
                    let gap = if center < 0.0 && radius == 20.0 {
                        a[1] - b[1]
                    } else {
                        b[1] - a[1]
                    };
                    assert!(gap > -1e-12, "{gap}");
                }
            }
        }
    }

    #[test]
    fn radii_that_do_not_go_together_are_refused() {
        for (wrong, words) in [
            (
                Raceways {
                    outer: 5.0,
                    ..BEARING
                },
                "outer raceway's radius",
            ),
            (
                Raceways {
                    thickness: 20.0,
                    ..BEARING
                },
                "thinner",
            ),
            (
                Raceways {
                    inner: 3.0,
                    thickness: 1.0,
                    ..BEARING
                },
                "0.71",
            ),
        ] {
            let error = wrong.mesh(Shape::Quad4).err().unwrap();
            assert!(error.to_string().contains(words), "{error}");
        }
    }
}
